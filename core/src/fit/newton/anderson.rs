//! Acceleration of the last steps.
//!
//! Near the minimum the fit is a fixed-point iteration: turning springs, threads and a kept Hessian
//! follow the fabric with a delay, and some motions come back at half their size or with the other sign
//! in every step. Anderson (1965), as in Walker & Ni, *Anderson Acceleration for Fixed-Point
//! Iterations* (2011): of the last few steps the combination is taken that would have left the least
//! to do.

/// Differences that are remembered.
const DEPTH: usize = 6;

/// Directions that differ by less than this share of their length from others count as the same.
const INDEPENDENT: f64 = 1e-8;

/// After a step that has grown so much what is remembered no longer serves; less, and a slow motion of the whole
/// fabric that it has come to know would be forgotten (an ankle's sole then ended 0.09 mm off instead of 0.01).
const GROWS: f64 = 1.5;

/// The memory of the last steps of a state, given as numbers whose squares can be added.
#[derive(Default)]
pub struct Anderson {
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Differences of states and of steps, the latest last.
    differences: Vec<(Vec<f64>, Vec<f64>)>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    /// Sums side by side, so that they are not one long chain.
    const SIDE: usize = 8;
    let mut sums = [0.0; SIDE];
    let (parts_a, parts_b) = (a.chunks_exact(SIDE), b.chunks_exact(SIDE));
    let rest: f64 = parts_a.remainder().iter().zip(parts_b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in parts_a.zip(parts_b) {
        for k in 0..SIDE {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// a − part · b.
fn take(a: &mut [f64], part: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a -= part * b);
}

impl Anderson {
    /// The next steps are of another problem.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The accelerated step at a state where the iteration's own is `step`.
    pub fn step(&mut self, state: &[f64], step: &[f64]) -> Vec<f64> {
        if let Some((s, f)) = self.last.take() {
            let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
            self.differences.push((minus(state, &s), minus(step, &f)));
            if dot(step, step) > (GROWS * GROWS) * dot(&f, &f) {
                self.differences.clear();
            }
            if self.differences.len() > DEPTH {
                self.differences.remove(0);
            }
        }
        self.last = Some((state.to_vec(), step.to_vec()));
        // Gram–Schmidt on the differences of steps, the latest first, taking their states along.
        let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::with_capacity(DEPTH);
        let mut left = step.to_vec();
        let mut result = step.to_vec();
        for (ds, df) in self.differences.iter().rev() {
            let (mut ds, mut df) = (ds.clone(), df.clone());
            let length = dot(&df, &df);
            for (bs, bf) in &basis {
                let part = dot(&df, bf);
                take(&mut df, part, bf);
                take(&mut ds, part, bs);
            }
            let rest = dot(&df, &df);
            if rest.is_nan() || rest <= INDEPENDENT * length {
                continue;
            }
            let scale = 1.0 / rest.sqrt();
            ds.iter_mut().chain(&mut df).for_each(|x| *x *= scale);
            let part = dot(&left, &df);
            take(&mut left, part, &df);
            take(&mut result, part, &ds);
            take(&mut result, part, &df);
            basis.push((ds, df));
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
        let mut state: Vec<f64> = (0..20).map(|k| f64::from(k % 7) - 2.0).collect();
        let step = |state: &[f64]| -> Vec<f64> {
            state.iter().zip(rates.iter().cycle()).map(|(s, rate)| (rate - 1.0) * s).collect()
        };
        let mut anderson = Anderson::default();
        for _ in 0..6 {
            let taken = anderson.step(&state, &step(&state));
            state.iter_mut().zip(&taken).for_each(|(s, d)| *s += d);
        }
        let left = state.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        assert!(left < 1e-8, "{left}");
    }
}
