//! Eigenvalues of the small matrix of a triangle's gradients.

/// Components of ∇x and ∇y.
const SIZE: usize = 4;

/// A symmetric matrix.
pub type Square = [[f64; SIZE]; SIZE];

/// Whether a symmetric matrix is positive definite.
pub fn positive(mut a: Square) -> bool {
    for j in 0..SIZE {
        if a[j][j] <= 0.0 {
            return false;
        }
        for i in j + 1..SIZE {
            let factor = a[i][j] / a[j][j];
            for k in j + 1..=i {
                a[i][k] -= factor * a[k][j];
            }
        }
    }
    true
}

/// Eigenvalues of a symmetric matrix, and its eigenvectors as columns: Jacobi's rotations.
pub fn eigen(mut a: Square) -> ([f64; SIZE], Square) {
    /// Of the matrix's square norm: eigenvalues are then right to eight digits, their error being square.
    const LEFT: f64 = 1e-8;
    /// Sweeps; convergence is quadratic.
    const MOST: usize = 12;
    let mut vectors: Square =
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
    let whole: f64 = a.iter().flatten().map(|x| x * x).sum();
    for _ in 0..MOST {
        let off: f64 =
            (0..SIZE).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i][j].powi(2)).sum();
        if off <= LEFT * whole {
            break;
        }
        for p in 0..SIZE {
            for q in p + 1..SIZE {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for row in a.iter_mut().chain(&mut vectors) {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for k in 0..SIZE {
                    (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                }
            }
        }
    }
    (std::array::from_fn(|k| a[k][k]), vectors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_make_the_matrix() {
        let a: Square = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                ((i * j) as f64).cos() + if i == j { i as f64 - 1.5 } else { 0.0 }
            })
        });
        let (values, vectors) = eigen(a);
        assert!(values.iter().any(|&v| v < 0.0) && values.iter().any(|&v| v > 0.0));
        for i in 0..SIZE {
            for j in 0..SIZE {
                let made: f64 = (0..SIZE).map(|k| vectors[i][k] * values[k] * vectors[j][k]).sum();
                assert!((made - a[i][j]).abs() < 1e-3, "{i} {j}: {made} {}", a[i][j]);
            }
        }
    }
}
