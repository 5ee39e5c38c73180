//! Least squares with bounds, for the few targets of a fit.

/// A small least-squares problem with bounds.
pub struct LeastSquares {
    normal: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl LeastSquares {
    /// Of so many unknowns, without any terms.
    pub fn new(unknowns: usize) -> Self {
        Self { normal: vec![vec![0.0; unknowns]; unknowns], right: vec![0.0; unknowns] }
    }

    /// Adds weight (row · x − value)².
    pub fn add(&mut self, row: &[f64], value: f64, weight: f64) {
        for (i, a) in row.iter().enumerate() {
            self.right[i] += weight * a * value;
            for (j, b) in row.iter().enumerate() {
                self.normal[i][j] += weight * a * b;
            }
        }
    }

    /// The minimum within the limits, coordinate by coordinate: the problem is convex, so that this
    /// comes to the one minimum there is.
    pub fn solve(&self, limits: &[[f64; 2]]) -> Vec<f64> {
        let mut x = vec![0.0; self.right.len()];
        for _ in 0..10_000 {
            let mut change = 0.0f64;
            for i in 0..x.len() {
                let diagonal = self.normal[i][i];
                if diagonal <= 0.0 {
                    continue;
                }
                let sum: f64 = self.normal[i].iter().zip(&x).map(|(a, b)| a * b).sum();
                let next =
                    (x[i] + (self.right[i] - sum) / diagonal).clamp(limits[i][0], limits[i][1]);
                change = change.max((next - x[i]).abs());
                x[i] = next;
            }
            if change < 1e-10 {
                break;
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_squares_with_a_bound_by_hand() {
        // x + y = 3 and x − y = 1: x = 2, y = 1; with x ≤ 1.5 the best y is 1.
        let mut problem = LeastSquares::new(2);
        problem.add(&[1.0, 1.0], 3.0, 1.0);
        problem.add(&[1.0, -1.0], 1.0, 1.0);
        let free = problem.solve(&[[-9.0, 9.0], [-9.0, 9.0]]);
        assert!((free[0] - 2.0).abs() < 1e-9 && (free[1] - 1.0).abs() < 1e-9);
        let held = problem.solve(&[[-9.0, 1.5], [-9.0, 9.0]]);
        assert!((held[0] - 1.5).abs() < 1e-9 && (held[1] - 1.0).abs() < 1e-9);
    }
}
