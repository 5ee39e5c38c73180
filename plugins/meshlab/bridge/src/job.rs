//! A computation on a thread of its own, that the host's thread watches.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use wovenfit_core::flatten;
use wovenfit_core::progress::{Progress as Watcher, Stage};

use crate::ffi::Progress;
use crate::guard::{Failure, guarded, guarded_in_pool};
use crate::input::Input;
use crate::pattern::Pattern;

/// A computation under way or ended. Dropping it cancels it and waits until it has stopped.
pub struct Job {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// What the job's thread and the host's share.
struct Shared {
    cancel: AtomicBool,
    state: Mutex<State>,
    ended: Condvar,
}

struct State {
    stage: Stage,
    fraction: f64,
    ended: bool,
    outcome: Option<Result<Pattern, Failure>>,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Watcher for Shared {
    fn report(&self, stage: Stage, fraction: f64, _energy: Option<f64>) {
        let mut state = self.state();
        (state.stage, state.fraction) = (stage, fraction);
    }

    fn cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

/// Starts to flatten.
pub(crate) fn start(input: Box<Input>) -> Result<Box<Job>, Failure> {
    /// As a program's main thread has.
    const STACK: usize = 8 << 20;
    guarded(|| {
        let state = State { stage: Stage::Surface, fraction: 0.0, ended: false, outcome: None };
        let shared = Arc::new(Shared {
            cancel: AtomicBool::new(false),
            state: Mutex::new(state),
            ended: Condvar::new(),
        });
        let own = Arc::clone(&shared);
        let work = move || {
            let outcome = guarded_in_pool(|| run(*input, &own));
            let mut state = own.state();
            state.outcome = Some(outcome);
            state.ended = true;
            drop(state);
            own.ended.notify_all();
        };
        let thread = thread::Builder::new()
            .name("wovenfit job".to_owned())
            .stack_size(STACK)
            .spawn(work)
            .map_err(|error| {
                Failure(format!("the system gives no thread to work with: {error}"))
            })?;
        Ok(Box::new(Job { shared, thread: Some(thread) }))
    })
}

fn run(input: Input, watcher: &Shared) -> Result<Pattern, Failure> {
    let Input { parameters, design, raw, formats, sheet_unit } = input;
    let flattening = flatten(&raw, &design, &parameters, watcher).map_err(Failure::new)?;
    Ok(Pattern { flattening, design, raw, formats, sheet_unit })
}

impl Job {
    /// Waits, at most so long; whether the job has ended.
    pub(crate) fn wait(&self, milliseconds: u64) -> bool {
        let until = Instant::now() + Duration::from_millis(milliseconds);
        let mut state = self.shared.state();
        while !state.ended {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return false;
            }
            let woken = self.shared.ended.wait_timeout(state, left);
            state = woken.unwrap_or_else(PoisonError::into_inner).0;
        }
        true
    }

    /// How far it is.
    pub(crate) fn progress(&self) -> Progress {
        let state = self.shared.state();
        Progress {
            percent: percent(state.stage, state.fraction),
            stage: state.stage.name().to_owned(),
            ended: state.ended,
        }
    }

    /// Asks it to stop.
    pub(crate) fn cancel(&self) {
        self.shared.cancel.store(true, Ordering::Relaxed);
    }

    /// The pattern, once; or why there is none.
    pub(crate) fn result(&mut self) -> Result<Box<Pattern>, Failure> {
        guarded(|| {
            let outcome = self.shared.state().outcome.take();
            let outcome = outcome.ok_or_else(|| {
                Failure::new("the job still runs, or its pattern was taken: please report this")
            })?;
            Ok(Box::new(outcome?))
        })
    }
}

impl Drop for Job {
    fn drop(&mut self) {
        self.cancel();
        if let Some(thread) = self.thread.take() {
            // Its panic was caught inside.
            drop(thread.join());
        }
    }
}

/// Where a stage begins and ends on one bar, as measured on limbs of 20,000 triangles; only its order
/// matters.
fn percent(stage: Stage, fraction: f64) -> i32 {
    let (from, to) = match stage {
        Stage::Surface => (0.0, 15.0),
        Stage::Region => (15.0, 18.0),
        Stage::Cut => (18.0, 25.0),
        Stage::Parameterization => (25.0, 40.0),
        Stage::Curvature => (40.0, 45.0),
        Stage::Fit => (45.0, 90.0),
        Stage::Mapping => (90.0, 93.0),
        Stage::Report => (93.0, 99.0),
    };
    (from + (to - from) * fraction.clamp(0.0, 1.0)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::new_input;

    #[test]
    fn the_bar_never_goes_back_from_stage_to_stage() {
        use Stage::{Curvature, Cut, Fit, Mapping, Parameterization, Region, Report, Surface};
        let stages = [Surface, Region, Cut, Parameterization, Curvature, Fit, Mapping, Report];
        let mut last = 0;
        for stage in stages {
            for fraction in [0.0, 0.5, 1.0] {
                assert!(percent(stage, fraction) >= last);
                last = percent(stage, fraction);
            }
        }
        assert!(last < 100);
    }

    #[test]
    fn a_job_that_cannot_be_done_ends_with_its_reason() {
        let mut job = start(new_input()).unwrap();
        while !job.wait(100) {}
        assert!(job.progress().ended);
        let said = job.result().err().unwrap().0;
        assert!(said.contains("the mesh has no faces"), "{said}");
        assert!(job.result().err().unwrap().0.contains("report this"));
    }
}
