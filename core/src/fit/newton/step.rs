//! A step, and when steps are so small that the fabric is at rest.

use glam::DVec2;

/// At rest the acceleration, too, moves no vertex by more than the tolerance times this.
const FURTHER: f64 = 2.0;

/// So many steps within the tolerance, one after the other, are rest whatever the acceleration wants.
const RESTING: usize = 6;

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
