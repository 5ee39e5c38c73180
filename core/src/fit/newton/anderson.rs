//! Acceleration of the last steps.
//!
//! Near the minimum the fit is a fixed-point iteration: turning springs, threads and a kept Hessian
//! follow the fabric with a delay, and some motions come back at half their size or with the other sign
//! in every step. Anderson (1965), as in Walker & Ni, *Anderson Acceleration for Fixed-Point
//! Iterations* (2011): of the last few steps the combination is taken that would have left the least
//! to do.

use glam::DVec2;

/// Differences that are remembered.
const DEPTH: usize = 4;

/// Directions that differ by less than this share of their length from others count as the same.
const INDEPENDENT: f64 = 1e-8;

/// The memory of the last steps.
#[derive(Default)]
pub struct Anderson {
    last: Option<(Vec<DVec2>, Vec<DVec2>)>,
    /// Differences of places and of steps, the latest last.
    differences: Vec<(Vec<DVec2>, Vec<DVec2>)>,
}

fn dot(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

impl Anderson {
    /// The next steps are of another problem.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The accelerated motion at a place where the fit's own step is `motion`.
    pub fn motion(&mut self, place: &[DVec2], motion: &[DVec2]) -> Vec<DVec2> {
        if let Some((p, m)) = self.last.take() {
            let minus = |a: &[DVec2], b: &[DVec2]| a.iter().zip(b).map(|(&a, &b)| a - b).collect();
            self.differences.push((minus(place, &p), minus(motion, &m)));
            if self.differences.len() > DEPTH {
                self.differences.remove(0);
            }
        }
        self.last = Some((place.to_vec(), motion.to_vec()));
        // Gram–Schmidt on the differences of steps, the latest first, taking their places along.
        let mut basis: Vec<(Vec<DVec2>, Vec<DVec2>)> = Vec::with_capacity(DEPTH);
        let mut left = motion.to_vec();
        let mut result = motion.to_vec();
        for (dp, dm) in self.differences.iter().rev() {
            let (mut dp, mut dm) = (dp.clone(), dm.clone());
            let length = dot(&dm, &dm);
            for (bp, bm) in &basis {
                let part = dot(&dm, bm);
                for k in 0..dm.len() {
                    dm[k] -= part * bm[k];
                    dp[k] -= part * bp[k];
                }
            }
            let rest = dot(&dm, &dm);
            if rest.is_nan() || rest <= INDEPENDENT * length {
                continue;
            }
            let scale = 1.0 / rest.sqrt();
            for k in 0..dm.len() {
                dm[k] *= scale;
                dp[k] *= scale;
            }
            let part = dot(&left, &dm);
            for k in 0..dm.len() {
                left[k] -= part * dm[k];
                result[k] -= part * (dp[k] + dm[k]);
            }
            basis.push((dp, dm));
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_iteration_with_few_slow_motions_ends_at_once() {
        // Four motions come back at 0.9, 0.6, −0.95 and 0.1 of their size.
        let rates = [0.9, 0.6, -0.95, 0.1];
        let mut place: Vec<DVec2> = (0..4).map(|k| DVec2::new(f64::from(k) + 1.0, -2.0)).collect();
        let step = |p: &[DVec2]| -> Vec<DVec2> {
            p.iter().zip(rates).map(|(&p, rate)| (rate - 1.0) * p).collect()
        };
        let mut anderson = Anderson::default();
        for _ in 0..6 {
            let motion = anderson.motion(&place, &step(&place));
            place.iter_mut().zip(&motion).for_each(|(p, d)| *p += *d);
        }
        let left = place.iter().map(|p| p.length()).fold(0.0, f64::max);
        assert!(left < 1e-8, "{left}");
    }
}
