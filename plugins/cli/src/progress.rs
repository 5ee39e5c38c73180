//! A progress bar on standard error, if a person is watching.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use wovenfit_core::progress::{Progress, Stage};

/// Steps of the bar per stage.
const STEPS: u64 = 1000;

/// A bar that shows the stage, how much of it is done, and the fit's energy.
#[derive(Debug)]
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar on standard error; it is invisible if `quiet` or if that is no terminal.
    pub fn new(quiet: bool) -> Self {
        let visible = !quiet && std::io::stderr().is_terminal();
        let target =
            if visible { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(STEPS), target);
        let template = "{prefix:16} [{bar:30}] {percent:>3} %  {elapsed}  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        Self(bar)
    }

    /// Takes the bar off the screen.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

impl Progress for Bar {
    fn report(&self, stage: Stage, fraction: f64, energy: Option<f64>) {
        self.0.set_prefix(stage.name());
        // The range keeps it a sensible number even if a stage misjudges itself.
        let steps = (fraction.clamp(0.0, 1.0) * STEPS as f64).round();
        self.0.set_position(steps as u64);
        self.0.set_message(energy.map_or_else(String::new, |e| format!("energy {e:.4} N·mm")));
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.finish();
    }
}
