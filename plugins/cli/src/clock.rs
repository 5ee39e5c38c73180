//! How long the stages take and how much memory was used: for scripts that watch both.
//!
//! The core has no clock. It says when a stage begins, and here the time is taken.

use std::fs;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde::{Serialize, Serializer};
use wovenfit_core::progress::{Progress, Stage};

/// Passes progress on, and takes the time of each stage.
pub struct Clock<'a> {
    inner: &'a dyn Progress,
    begun: Mutex<Vec<(Stage, Instant)>>,
}

impl<'a> Clock<'a> {
    /// A clock that passes on to `inner`.
    pub fn new(inner: &'a dyn Progress) -> Self {
        Self { inner, begun: Mutex::new(Vec::new()) }
    }

    /// The stages up to now; the last one ends now.
    pub fn stages(&self) -> StageTimes {
        let now = Instant::now();
        let begun = self.begun();
        let ends = begun.iter().skip(1).map(|&(_, end)| end).chain([now]);
        let times = begun.iter().zip(ends);
        StageTimes(
            times.map(|(&(stage, start), end)| (stage, (end - start).as_secs_f64())).collect(),
        )
    }

    fn begun(&self) -> MutexGuard<'_, Vec<(Stage, Instant)>> {
        self.begun.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress for Clock<'_> {
    fn report(&self, stage: Stage, fraction: f64, energy: Option<f64>) {
        let mut begun = self.begun();
        if begun.last().is_none_or(|&(last, _)| last != stage) {
            begun.push((stage, Instant::now()));
        }
        drop(begun);
        self.inner.report(stage, fraction, energy);
    }

    fn cancelled(&self) -> bool {
        self.inner.cancelled()
    }
}

/// Seconds by stage, in the order in which they ran; an object of names in JSON.
#[derive(Debug, Clone, PartialEq)]
pub struct StageTimes(Vec<(Stage, f64)>);

impl Serialize for StageTimes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(stage, seconds)| (stage.name(), seconds)))
    }
}

/// The most memory that this process has had resident, in MiB; `None` where the system does not
/// say it (other than on Linux).
pub fn peak_mib() -> Option<f64> {
    peak_in(&fs::read_to_string("/proc/self/status").ok()?)
}

fn peak_in(status: &str) -> Option<f64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}

#[cfg(test)]
mod tests {
    use wovenfit_core::progress::Silent;

    use super::*;

    #[test]
    fn a_stage_lasts_until_the_next_one_begins() {
        let clock = Clock::new(&Silent);
        clock.report(Stage::Surface, 0.0, None);
        clock.report(Stage::Fit, 0.0, None);
        clock.report(Stage::Fit, 0.5, Some(1.0));
        let StageTimes(times) = clock.stages();
        assert_eq!(
            times.iter().map(|&(stage, _)| stage).collect::<Vec<_>>(),
            [Stage::Surface, Stage::Fit]
        );
        assert!(times.iter().all(|&(_, seconds)| seconds >= 0.0));
    }

    #[test]
    fn times_are_an_object_by_name() {
        let times = StageTimes(vec![(Stage::Surface, 0.5), (Stage::Fit, 2.0)]);
        assert_eq!(serde_json::to_string(&times).unwrap(), r#"{"surface":0.5,"fit":2.0}"#);
    }

    #[test]
    fn the_peak_is_read_from_the_systems_own_words() {
        assert_eq!(peak_in("Name:\twovenfit\nVmHWM:\t    2048 kB\nVmRSS:\t 12 kB\n"), Some(2.0));
        assert_eq!(peak_in("Name:\twovenfit\n"), None);
    }
}
