//! A patch z = a + b x + c y + ½ xᵀ A x + ½ g (z − a)² fitted to weighted points; see `scale.rs`.

use glam::{DVec2, DVec3};

use super::operator::ShapeOperator;
use super::scale::ScaleFit;

/// Rounds of the fixed point for normal and g, at most. On a cylinder with radius / r = 2/3, far
/// beyond use, the error after n rounds is about 10⁻ⁿ.
const ROUNDS: usize = 8;

/// The fixed point is reached when no curvature changes by more than this (times the radius)
/// and the normal turns by no more: 0.01 1/m over 10 mm.
const SETTLED: f64 = 1e-4;

/// A fit that still changes by more than this (times the radius) in the last round does not settle:
/// its points do not lie on a patch of one curvature. The same points are then fitted without g.
const UNSETTLED: f64 = 1e-2;

/// A coefficient that the others explain but for this share of its square is not determined by
/// the points. No share is below 0.5 in a whole disk, 0.04 in half a disk (a free edge), 0.01 in a
/// quarter (a corner). A few points near a conic, or all others of next to no weight at the rim,
/// have far less, and would turn 0.01 mm of noise into any curvature.
const DETERMINED: f64 = 1e-3;

/// Fits the patch to points relative to its middle, in radii, with weights, `bent` with the term of g and
/// else the usual quadric; `None` if they do not determine it or it does not settle.
pub(super) fn fit_patch(
    mut normal: DVec3,
    near: &[(DVec3, f64)],
    radius: f64,
    bent: bool,
) -> Option<ScaleFit> {
    // κ of the height function in the frame's own tangents, times the radius (lengths are in
    // radii inside the fit, so that its matrix has entries near one).
    let mut curved = [0.0; 3];
    let mut offset = 0.0;
    let mut u = normal.any_orthonormal_vector();
    let mut v = normal.cross(u);
    let total: f64 = near.iter().map(|(_, w)| w).sum();
    let mut residual = 0.0;
    for round in 0..ROUNDS {
        let mut system = [[0.0; 7]; 6];
        let mut squares = 0.0;
        for &(p, weight) in near {
            let (x, y, z) = (p.dot(u), p.dot(v), p.dot(normal));
            let gradient = DVec2::new(curved[0] * x + curved[1] * y, curved[1] * x + curved[2] * y);
            let steepest = gradient.length_squared();
            let g = if bent && steepest > 0.0 {
                (curved[0] * gradient.x * gradient.x
                    + 2.0 * curved[1] * gradient.x * gradient.y
                    + curved[2] * gradient.y * gradient.y)
                    / steepest
            } else {
                0.0
            };
            let above = z - offset;
            let row = [1.0, x, y, 0.5 * x * x, x * y, 0.5 * y * y];
            let right = z - 0.5 * g * above * above;
            for i in 0..6 {
                for j in 0..=i {
                    system[i][j] += weight * row[i] * row[j];
                }
                system[i][6] += weight * row[i] * right;
            }
            squares += weight * right * right;
        }
        let solution = solve_symmetric(&system)?;
        let explained: f64 = (0..6).map(|i| solution[i] * system[i][6]).sum();
        residual = radius * ((squares - explained).max(0.0) / total).sqrt();
        let [a, b, c, auu, auv, avv] = solution;
        offset = a;
        let change = (0..3).map(|i| (curved[i] - [auu, auv, avv][i]).abs()).fold(0.0, f64::max);
        curved = [auu, auv, avv];
        let change = change.max(b.abs()).max(c.abs());
        if change < SETTLED {
            break;
        }
        if round + 1 == ROUNDS {
            if change < UNSETTLED {
                break;
            }
            return None;
        }
        // Turn the frame so that the patch's own gradient vanishes, and its curvatures with it.
        let turned = (normal - b * u - c * v).normalize();
        let turn = glam::DQuat::from_rotation_arc(normal, turned);
        (u, normal) = ((turn * u).normalize(), turned);
        v = normal.cross(u);
    }
    let k = -1.0 / radius;
    let shape =
        ShapeOperator { normal, u, v, kuu: k * curved[0], kuv: k * curved[1], kvv: k * curved[2] };
    let finite = shape.tensor().is_finite() && normal.is_finite();
    finite.then_some(ScaleFit {
        shape,
        radius_used: radius,
        points: near.len(),
        residual_mm: residual,
        offset_mm: radius * offset,
    })
}

/// Solves a symmetric positive definite 6 × 6 system (lower triangle, right-hand side in column
/// 6) by LDLᵀ; `None` if it is singular or near it.
fn solve_symmetric(system: &[[f64; 7]; 6]) -> Option<[f64; 6]> {
    let mut l = [[0.0; 6]; 6];
    let mut d = [0.0; 6];
    for j in 0..6 {
        let pivot = system[j][j] - (0..j).map(|k| l[j][k] * l[j][k] * d[k]).sum::<f64>();
        if pivot.is_nan() || pivot <= DETERMINED * system[j][j] {
            return None;
        }
        d[j] = pivot;
        for i in j + 1..6 {
            let sum: f64 = (0..j).map(|k| l[i][k] * l[j][k] * d[k]).sum();
            l[i][j] = (system[i][j] - sum) / pivot;
        }
    }
    let mut x = [0.0; 6];
    for i in 0..6 {
        x[i] = system[i][6] - (0..i).map(|k| l[i][k] * x[k]).sum::<f64>();
    }
    for i in 0..6 {
        x[i] /= d[i];
    }
    for i in (0..6).rev() {
        x[i] -= (i + 1..6).map(|k| l[k][i] * x[k]).sum::<f64>();
    }
    Some(x)
}
