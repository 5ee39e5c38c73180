//! `wovenfit paper`: the paper's examples by its own method, on one page.

use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use clap::{Arg, ArgMatches, Command, value_parser};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use wovenfit_core::examples::{
    EXAMPLES, Example, Extent, Outcome, Settings, Watch, course, examples_json, findings,
    run as run_all,
};
use wovenfit_core::export::worn_obj;
use wovenfit_core::page::paper_html;
use wovenfit_core::progress::Stage;
use wovenfit_core::samples::{MAX_TRIANGLES, MIN_TRIANGLES};

use crate::exit::Failure;
use crate::output::Named;
use crate::{flags, flatten, output};

/// The command's name.
pub const NAME: &str = "paper";

/// The page that is read first.
const PAGE: &str = "paper.html";

/// The parameters that the examples leave open: those of one woven model and its diffusion. Method,
/// levels and uncorrected strains are what makes it the paper's.
const OPEN: [&str; 10] = [
    "curvature",
    "curvature_radius",
    "spacing",
    "start_warp",
    "start_weft",
    "damping",
    "steps_per_pass",
    "strain_tolerance",
    "plateau",
    "max_iterations",
];

/// The command's description for the parser.
pub fn command() -> Command {
    let defaults = Settings::default();
    let command = Command::new(NAME)
        .about("Run the paper's examples and show them on one page")
        .after_help(format!(
            "Example:\n  wovenfit paper --out examples\n\n\
             Wang & Tang's examples (elbow, knee, wrist) by their own method, the diffusion. Writes \
             into the folder:\n\
             \x20 {PAGE}       our versions of their Figs. 2 and 7 to 14, and what differs\n\
             \x20 paper.json       every figure of every example\n\
             \x20 NAME.worn.obj    the worn brace of each example, with its pattern in mm\n\n\
             A few minutes; a wider spacing is much faster."
        ))
        .arg(
            Arg::new("out")
                .long("out")
                .value_name("DIR")
                .help("Folder for the results; made if there is none")
                .required(true)
                .value_parser(value_parser!(PathBuf)),
        )
        .arg(
            Arg::new("triangles")
                .long("triangles")
                .value_name("N")
                .help(format!(
                    "About how many triangles a limb has, {MIN_TRIANGLES} to {MAX_TRIANGLES}"
                ))
                .default_value(defaults.triangles.to_string())
                .value_parser(
                    value_parser!(u64).range(MIN_TRIANGLES as u64..=MAX_TRIANGLES as u64),
                ),
        )
        .arg(flatten::quiet_flag());
    flags::add_to(command, &defaults.parameters, |name| OPEN.contains(&name))
}

/// Runs the command.
pub fn run(matches: &ArgMatches) -> Result<ExitCode, Failure> {
    let missing = || Failure::new(format!("an argument is missing: see `wovenfit {NAME} --help`"));
    let out = matches.get_one::<PathBuf>("out").ok_or_else(missing)?;
    let triangles = *matches.get_one::<u64>("triangles").ok_or_else(missing)?;
    let quiet = matches.get_flag("quiet");
    let settings = Settings {
        triangles: usize::try_from(triangles).map_err(|error| Failure::of(&error))?,
        parameters: flags::parameters_over(Settings::default().parameters, matches)?,
    };
    output::ready(out)?;

    let lines = Lines::new(quiet);
    let outcomes = run_all(&settings, &lines);
    lines.finish();
    let outcomes = outcomes.map_err(|error| Failure::of(&error))?;
    let claims = findings(&outcomes);
    let mut files: Vec<Named> = vec![
        (PAGE.to_owned(), paper_html(&settings, &outcomes, &claims).into_bytes()),
        ("paper.json".to_owned(), examples_json(&settings, &outcomes, &claims).into_bytes()),
    ];
    files.extend(outcomes.iter().map(|outcome| {
        let worn = worn_obj(outcome.flattening.disk(), &outcome.flattening.coordinates);
        (format!("{}.worn.obj", outcome.example.name), worn.into_bytes())
    }));
    output::write_together(out, &files)?;
    if !quiet {
        for claim in &claims {
            output::say(&format!(
                "Fig. {:<3} {:<20} {}\n",
                claim.figure,
                claim.verdict.words(),
                claim.code
            ));
        }
        output::say(&format!("\nLook at it in a browser:\n  {}\n", out.join(PAGE).display()));
    }
    Ok(ExitCode::SUCCESS)
}

/// A line for what is at work, and one for each example that has ended.
#[derive(Debug)]
struct Lines {
    bar: ProgressBar,
    quiet: bool,
    /// What is at work, by name.
    now: Mutex<BTreeMap<&'static str, String>>,
}

impl Lines {
    fn new(quiet: bool) -> Self {
        let visible = !quiet && std::io::stderr().is_terminal();
        let target =
            if visible { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(EXAMPLES.len() as u64), target);
        if let Ok(style) = ProgressStyle::with_template("{pos}/{len} examples  {elapsed}  {msg}") {
            bar.set_style(style);
        }
        Self { bar, quiet, now: Mutex::default() }
    }

    fn show(&self, change: impl FnOnce(&mut BTreeMap<&'static str, String>)) {
        let mut now = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut now);
        let parts: Vec<String> =
            now.iter().map(|(name, words)| format!("{name}: {words}")).collect();
        self.bar.set_message(parts.join("; "));
    }

    fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Watch for Lines {
    fn report(&self, example: &'static Example, stage: Stage, energy: Option<f64>) {
        let energy = energy.map_or_else(String::new, |e| format!(", energy {e:.2} N\u{b7}mm"));
        self.show(|now| {
            now.insert(example.name, format!("{}{energy}", stage.name()));
        });
    }

    fn done(&self, outcome: &Outcome) {
        let (name, fit) = (outcome.example.name, &outcome.flattening.report.fit);
        self.show(|now| {
            now.remove(name);
        });
        self.bar.inc(1);
        if self.quiet {
            return;
        }
        let [first, last] = course::ends(fit);
        let words = if outcome.example.extent == Extent::Start {
            format!("{name}: laid, E_SSD {first:.2}\n")
        } else {
            let rest = if fit.converged { "converged" } else { "not converged" };
            format!(
                "{name}: {rest} after {} steps, E_SSD {first:.2} to {last:.2}\n",
                fit.iterations
            )
        };
        self.bar.suspend(|| output::tell(&words));
    }
}
