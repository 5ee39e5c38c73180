//! How the corrections of the targets go: what makes them stop short of running away.

/// A step that moves no vertex by more leaves the fabric nearly at rest, in mm.
pub const NEAR_MM: f64 = 1.0;

/// After one as small as this it is at rest, as far as pressures go.
const REST_MM: f64 = 0.1;

/// No correction changes a target by more.
const MOST_REACH: f64 = 0.1;

/// Nor by more than this while the fabric is on its way, but for the first: what it answers there is not to be relied on,
/// and contrary wishes were driven to the ends of their range.
const REACH_ON_ITS_WAY: f64 = 0.03;

/// Of what is missed, kPa²: where less was missed before, it is gone back there.
const GOOD_AS_BEST: f64 = 0.8;

/// How the corrections have gone so far.
pub struct Course {
    /// What was wanted of the pressures and missed at the last correction, in kPa², and whether that changed a
    /// target.
    pub missed: Option<(f64, bool)>,
    /// The least of it while the fabric was at rest, with the targets then and whether their function was drawn taut.
    pub best: Option<(f64, Vec<Option<f64>>, bool)>,
    /// The largest change of a target at the last correction.
    pub last: f64,
    /// A target changes by no more at a time.
    pub reach: f64,
    /// Whether the answers were read where the fabric was nearly at rest.
    pub near: bool,
}

impl Default for Course {
    fn default() -> Self {
        Self { missed: None, best: None, last: 0.0, reach: MOST_REACH, near: false }
    }
}

impl Course {
    /// Whether the last correction has made worse what is missed. On its way the fabric may miss more for a
    /// while.
    pub fn worse(&self, missed: f64, near: bool) -> bool {
        /// So many times as much.
        const ON_ITS_WAY: f64 = 1.5;
        self.missed.is_some_and(|(before, changed)| {
            changed && missed > before * if near { 1.0 } else { ON_ITS_WAY }
        })
    }

    /// Each correction that made it worse halves the reach of the next.
    pub fn adapt(&mut self, worse: bool) {
        if worse {
            self.reach = 0.5 * self.last.min(self.reach);
        } else if self.missed.is_some() {
            self.reach = (2.0 * self.reach).min(MOST_REACH);
        }
    }

    /// By how much a target may change at the correction of this number, counted from 1.
    pub fn reach_of(&self, round: usize, near: bool) -> f64 {
        if near || round == 1 { self.reach } else { self.reach.min(REACH_ON_ITS_WAY) }
    }

    /// Remembers targets with which at rest less is missed than with any before.
    pub fn remember(&mut self, missed: f64, largest: f64, targets: &[Option<f64>], taut: bool) {
        if largest < REST_MM && self.best.as_ref().is_none_or(|(least, ..)| missed < *least) {
            self.best = Some((missed, targets.to_vec(), taut));
        }
    }

    /// Whether clearly less was missed before.
    pub fn was_better(&self, missed: f64) -> bool {
        self.best.as_ref().is_some_and(|(least, ..)| *least < GOOD_AS_BEST * missed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_correction_that_made_it_worse_halves_the_next_and_the_best_is_kept() {
        let mut course = Course::default();
        for (missed, targets) in [(1.0, 0.1), (4.0, 0.2)] {
            let worse = course.worse(missed, true);
            assert_eq!(worse, missed > 1.0);
            course.adapt(worse);
            course.remember(missed, 0.05, &[Some(targets)], false);
            (course.missed, course.last) = (Some((missed, true)), 0.06);
        }
        assert_eq!(course.reach, 0.03);
        assert_eq!(course.best, Some((1.0, vec![Some(0.1)], false)));
        assert!(course.was_better(4.0) && !course.was_better(1.2));
        // Nor does it change much on its way, but for the first.
        course.reach = 0.06;
        assert_eq!(
            [(1, false), (2, true), (2, false)].map(|(n, near)| course.reach_of(n, near)),
            [0.06, 0.06, 0.03]
        );
        // Far from rest somewhat more is no bad sign, and nothing is remembered.
        course.remember(0.1, 5.0, &[Some(0.3)], true);
        assert_eq!(course.best, Some((1.0, vec![Some(0.1)], false)));
        course.missed = Some((1.0, true));
        assert!(!course.worse(1.4, false) && course.worse(1.4, true));
    }
}
