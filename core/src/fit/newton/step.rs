//! A step, by how much it counts, and when steps are so small that the fabric is at rest.

use glam::DVec2;

/// Share of the vertices that may still move by more than the tolerance at rest: where a fold has triangles that
/// are stretched beyond any fabric, a dozen go to and fro for ever and move nothing else.
const RESTLESS: f64 = 1e-3;

/// By no more than so many times the tolerance.
const RESTLESS_MOST: f64 = 3.0;

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
        Self { motion, largest, slope }
    }
}

/// How much a motion counts at rest, in mm: its largest movement of a vertex, but for those that may be restless.
pub fn most(motion: &[DVec2]) -> f64 {
    let mut lengths: Vec<f64> = motion.iter().map(|m| m.length()).collect();
    let largest = lengths.iter().copied().fold(0.0, f64::max);
    let restless = (RESTLESS * lengths.len() as f64) as usize;
    let Some(rank) = lengths.len().checked_sub(1 + restless) else { return largest };
    let (_, most, _) = lengths.select_nth_unstable_by(rank, f64::total_cmp);
    most.max(largest / RESTLESS_MOST)
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
    fn one_vertex_in_a_thousand_may_be_restless_and_by_no_more_than_three_times() {
        let with = |others: &[f64], count: usize| {
            let mut motion = vec![DVec2::new(0.0, 0.006); count];
            motion.iter_mut().step_by(7).zip(others).for_each(|(m, &mm)| m.x = mm);
            most(&motion)
        };
        // Two of two thousand are left out as far as three times what the others move.
        assert!((with(&[0.02, 0.01], 2000) - 0.02f64.hypot(0.006) / 3.0).abs() < 1e-15);
        assert_eq!(with(&[0.015, 0.015], 2000), 0.006);
        assert!((with(&[0.09, 0.01], 2000) - 0.09f64.hypot(0.006) / 3.0).abs() < 1e-15);
        // A third is not, nor is one of a few.
        assert!(with(&[0.015; 3], 2000) > 0.015);
        assert!(with(&[0.015], 900) > 0.015);
        assert_eq!(most(&[]), 0.0);
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
