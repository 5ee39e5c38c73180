//! A step, and when steps are so small that the fabric is at rest.

use glam::DVec2;

/// At rest the acceleration, too, moves no vertex by more than the tolerance times this.
const FURTHER: f64 = 2.0;

/// So many steps within the tolerance, one after the other, are rest whatever the acceleration wants.
const RESTING: usize = 6;

/// A step larger than this share of the last has not shrunk.
const STAYS: f64 = 0.7;

/// No less of a step is taken.
const LEAST_SHARE: f64 = 0.25;

/// A step on trial.
pub struct Step {
    /// Of every vertex, in mm.
    pub motion: Vec<DVec2>,
    /// Largest movement of a vertex, in mm.
    pub largest: f64,
    /// Derivative of the energy along it, in N·mm.
    pub slope: f64,
    /// Largest movement of a vertex by the step that the Hessian at hand makes, in mm: that of this one, unless it
    /// was made exact.
    pub rough: f64,
}

impl Step {
    /// That motion, where `downhill` is minus the gradient.
    pub fn new(motion: Vec<DVec2>, downhill: &[f64]) -> Self {
        let slope = -motion
            .iter()
            .zip(downhill.chunks_exact(2))
            .map(|(m, d)| m.x * d[0] + m.y * d[1])
            .sum::<f64>();
        let largest = motion.iter().map(|m| m.length()).fold(0.0, f64::max);
        Self { motion, largest, slope, rough: largest }
    }

    /// Whether it was made exact.
    pub fn is_exact(&self) -> bool {
        self.rough != self.largest
    }
}

/// How much of exact steps is taken.
///
/// They are exact for springs and targets as they stand, which follow the fabric; whole ones can come round in a circle.
pub struct Damping {
    share: f64,
    /// The last of them, in mm.
    last: f64,
}

impl Default for Damping {
    fn default() -> Self {
        Self { share: 1.0, last: f64::INFINITY }
    }
}

impl Damping {
    /// The share of a step that is taken, given those before.
    pub fn share(&mut self, largest: f64) -> f64 {
        let factor = if largest < STAYS * self.last { 2.0 } else { 0.5 };
        self.share = (factor * self.share).clamp(LEAST_SHARE, 1.0);
        self.last = largest;
        self.share
    }
}

/// Whether the fabric has come to rest.
pub struct Rest {
    /// In mm.
    tolerance: f64,
    /// Steps within it, up to the last.
    steps: usize,
}

impl Rest {
    /// Rest within a tolerance in mm.
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, steps: 0 }
    }

    /// Whether something moves so little.
    pub fn within(&self, mm: f64) -> bool {
        mm < self.tolerance
    }

    /// Whether it has come, after a step within the tolerance or not, from which the acceleration wanted to go on
    /// by `further` mm.
    pub fn comes(&mut self, within: bool, further: f64) -> bool {
        self.steps = if within { self.steps + 1 } else { 0 };
        within && (further < FURTHER * self.tolerance || self.steps >= RESTING)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_steps_that_do_not_shrink_are_taken_by_ever_less() {
        let mut damping = Damping::default();
        let shares = [0.6, 0.3, 0.29, 0.31, 0.3, 0.1, 0.02].map(|mm| damping.share(mm));
        assert_eq!(shares, [1.0, 1.0, 0.5, 0.25, 0.25, 0.5, 1.0]);
    }

    #[test]
    fn rest_comes_with_the_acceleration_or_after_some_steps() {
        let mut rest = Rest::new(0.01);
        assert!(rest.within(0.009) && !rest.within(0.01));
        assert!(!rest.comes(true, 0.05) && rest.comes(true, 0.019));
        let mut rest = Rest::new(0.01);
        for _ in 1..RESTING {
            assert!(!rest.comes(true, 0.05));
        }
        assert!(!rest.comes(false, 0.0));
        for _ in 1..RESTING {
            assert!(!rest.comes(true, 0.05));
        }
        assert!(rest.comes(true, 0.05));
    }
}
