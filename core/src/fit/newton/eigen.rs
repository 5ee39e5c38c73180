//! What is negative of the small matrix of a triangle's gradients.

/// Components of ∇x and ∇y.
const SIZE: usize = 4;

/// A symmetric matrix.
pub type Square = [[f64; SIZE]; SIZE];

/// Whether a symmetric matrix is positive definite; if not, a direction along which it is not.
pub fn positive(mut a: Square) -> Result<(), [f64; SIZE]> {
    for j in 0..SIZE {
        if a[j][j] <= 0.0 {
            // The lower part is that of L D Lᵀ up to here: the direction is Lᵀ⁻¹ eⱼ.
            let mut direction = [0.0; SIZE];
            direction[j] = 1.0;
            for i in (0..j).rev() {
                direction[i] = -(i + 1..=j).map(|k| a[k][i] * direction[k]).sum::<f64>();
            }
            return Err(direction);
        }
        let column: [f64; SIZE] = std::array::from_fn(|i| a[i][j]);
        for i in j + 1..SIZE {
            a[i][j] = column[i] / column[j];
            for k in j + 1..=i {
                a[i][k] -= a[i][j] * column[k];
            }
        }
    }
    Ok(())
}

/// The adjugate of a symmetric matrix: its inverse times its determinant, also where that is zero.
fn adjugate(a: &Square) -> Square {
    let minor = |i: usize, j: usize, p: usize, q: usize| a[i][p] * a[j][q] - a[i][q] * a[j][p];
    let upper = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].map(|(p, q)| minor(0, 1, p, q));
    let lower = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)].map(|(p, q)| minor(2, 3, p, q));
    // Expansions by three of the minors of the other two rows, for columns 0 to 3.
    let expand = |row: &[f64; SIZE], m: &[f64; 6]| {
        [
            row[1] * m[5] - row[2] * m[4] + row[3] * m[3],
            -row[0] * m[5] + row[2] * m[2] - row[3] * m[1],
            row[0] * m[4] - row[1] * m[2] + row[3] * m[0],
            -row[0] * m[3] + row[1] * m[1] - row[2] * m[0],
        ]
    };
    let [first, second] = [expand(&a[1], &lower), expand(&a[0], &lower).map(|x| -x)];
    let [third, fourth] = [expand(&a[3], &upper), expand(&a[2], &upper).map(|x| -x)];
    [first, second, third, fourth]
}

fn dot(a: &[f64; SIZE], b: &[f64; SIZE]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The negative eigenvalue and its eigenvector of a symmetric matrix that has one alone, from a direction of
/// negative curvature; `None` if it is not found soon, or is not alone.
///
/// Rayleigh's iteration, which trebles the digits at every step (Parlett, *The Symmetric Eigenvalue Problem*,
/// 1980, chapter 4).
pub fn negative(a: &Square, direction: [f64; SIZE]) -> Option<(f64, [f64; SIZE])> {
    /// Steps.
    const MOST: usize = 5;
    /// Of the matrix's square norm: the eigenvector is then right to eight digits.
    const LEFT: f64 = 1e-16;
    let unit = |v: [f64; SIZE]| {
        let by = 1.0 / dot(&v, &v).sqrt();
        v.map(|x| x * by)
    };
    let whole: f64 = a.iter().flatten().map(|x| x * x).sum();
    let mut v = unit(direction);
    for _ in 0..MOST {
        let av: [f64; SIZE] = std::array::from_fn(|i| dot(&a[i], &v));
        let value = dot(&v, &av);
        let left: f64 = (0..SIZE).map(|i| (av[i] - value * v[i]).powi(2)).sum();
        if left <= LEFT * whole {
            // Turned round, it leaves a positive definite matrix if there is no other.
            let turned = std::array::from_fn(|i| {
                std::array::from_fn(|j| a[i][j] - 2.0 * value * v[i] * v[j])
            });
            return (value < 0.0 && positive(turned).is_ok()).then_some((value, v));
        }
        let mut shifted = *a;
        (0..SIZE).for_each(|i| shifted[i][i] -= value);
        let adjugate = adjugate(&shifted);
        v = unit(std::array::from_fn(|i| dot(&adjugate[i], &v)));
    }
    None
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

    /// Symmetric, with this on the diagonal besides.
    fn matrix(diagonal: [f64; SIZE]) -> Square {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| ((i * j) as f64).cos() + if i == j { diagonal[i] } else { 0.0 })
        })
    }

    #[test]
    fn the_adjugate_is_the_inverse_times_the_determinant() {
        let a = matrix([-1.5, -0.5, 0.5, 1.5]);
        let adjugate = adjugate(&a);
        let determinant = dot(&a[0], &std::array::from_fn(|k| adjugate[k][0]));
        assert!(determinant.abs() > 0.1);
        for i in 0..SIZE {
            for j in 0..SIZE {
                let product: f64 = (0..SIZE).map(|k| a[i][k] * adjugate[k][j]).sum();
                let wanted = if i == j { determinant } else { 0.0 };
                assert!((product - wanted).abs() < 1e-12, "{i} {j}: {product}");
            }
        }
    }

    #[test]
    fn one_negative_eigenvalue_is_found_and_two_are_told() {
        let mut found = 0;
        for k in 0..40 {
            let a = matrix([3.0, -1.3 + 0.1 * f64::from(k % 8), 2.0, 1.0 + 0.2 * f64::from(k / 8)]);
            let (values, _) = eigen(a);
            let negatives: Vec<f64> = values.into_iter().filter(|&v| v < 0.0).collect();
            let Err(direction) = positive(a) else {
                assert!(negatives.is_empty());
                continue;
            };
            let along: [f64; SIZE] = std::array::from_fn(|i| dot(&a[i], &direction));
            assert!(dot(&along, &direction) < 0.0);
            if let Some((value, _)) = negative(&a, direction) {
                assert_eq!(negatives.len(), 1);
                assert!((value - negatives[0]).abs() < 1e-3, "{value} {negatives:?}");
                found += 1;
            }
        }
        assert!(found > 10, "{found}");
        let two = matrix([-3.0, 2.0, -4.0, 1.0]);
        assert_eq!(negative(&two, positive(two).unwrap_err()), None);
    }

    #[test]
    fn eigenvectors_make_the_matrix() {
        let a = matrix([-1.5, -0.5, 0.5, 1.5]);
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
