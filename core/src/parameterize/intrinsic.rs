//! The intrinsic parameterization with a natural boundary.
//!
//! Desbrun, Meyer & Alliez, *Intrinsic Parameterizations of Surface Meshes* (2002), section 4:
//! the discrete conformal map, least in Dirichlet energy (cotangents) minus area, with a free
//! boundary and two vertices held. Conformal, so it keeps angles and pays in area: on a limb that
//! is far from developable parts of the map shrink. It can also flip triangles and overlap
//! itself; the caller checks.

use glam::DVec2;

use super::rest::rest_triangles;
use crate::progress::Progress;
use crate::sparse::{Element, Matrix, SparseError};
use crate::surface::{Surface, VertexId};

/// Two boundary vertices as far apart as any. Pairs within this share of the greatest distance
/// count as equal and the first in order is taken, so that rounding does not choose.
const TIE: f64 = 1e-9;

/// The map of the vertices of a disk, or of a disk with holes, to the plane, in mm, with the
/// surface's own area in total. `matrix` is that of the surface.
///
/// # Errors
/// If the system is singular to rounding, or the job is cancelled.
pub(super) fn intrinsic(
    surface: &Surface,
    matrix: &Matrix,
    progress: &dyn Progress,
) -> Result<Vec<DVec2>, SparseError> {
    let pins = farthest_pair(surface);
    let apart = surface.point(pins[0]).distance(surface.point(pins[1]));
    let held = [DVec2::ZERO, DVec2::new(0.0, -apart)];
    let pinned = |v: VertexId| pins.iter().position(|&pin| pin == v).map(|k| held[k]);

    let mut right = vec![0.0; 2 * surface.vertex_count()];
    let elements: Vec<Element> = surface
        .triangles()
        .iter()
        .zip(rest_triangles(surface))
        .map(|(&corners, rest)| {
            let mut conformal = conformal(rest.cotangents);
            for (k, place) in corners.map(pinned).into_iter().enumerate() {
                let Some(place) = place else { continue };
                for (i, v) in corners.into_iter().enumerate() {
                    for axis in 0..2 {
                        let row = &mut conformal[2 * i + axis];
                        right[2 * v.index() + axis] -=
                            row[2 * k] * place.x + row[2 * k + 1] * place.y;
                        (row[2 * k], row[2 * k + 1]) = (0.0, 0.0);
                    }
                }
                (conformal[2 * k], conformal[2 * k + 1]) = ([0.0; 6], [0.0; 6]);
            }
            let mut lower = (0..6).flat_map(|i| (0..=i).map(move |j| (i, j)));
            let entry = |(i, j): (usize, usize)| conformal[i][j];
            Element { stiffness: std::array::from_fn(|_| lower.next().map_or(0.0, entry)) }
        })
        .collect();
    let mut values = Vec::new();
    matrix.set_triangles(&mut values, &elements);
    let mean = matrix.mean_diagonal(&values);
    for pin in pins {
        matrix.add_diagonal(&mut values, pin.index(), mean);
        right[2 * pin.index()] = 0.0;
        right[2 * pin.index() + 1] = 0.0;
    }
    let factor = matrix
        .factorize(&values, progress)?
        .ok_or(SparseError::NotPositiveDefinite(pins[0].index()))?;
    let solution = matrix.solve(&factor, &[&right]).swap_remove(0);
    matrix.take_back(factor);
    let coordinates: Vec<DVec2> = surface
        .vertex_ids()
        .zip(solution.chunks_exact(2))
        .map(|(v, xy)| pinned(v).unwrap_or(DVec2::new(xy[0], xy[1])))
        .collect();
    Ok(at_true_scale(surface, coordinates))
}

/// Second derivatives of a triangle's Dirichlet energy minus its area, by x₀, y₀, x₁, y₁, x₂, y₂.
fn conformal(cotangents: [f64; 3]) -> [[f64; 6]; 6] {
    let mut a = [[0.0; 6]; 6];
    for k in 0..3 {
        let half = 0.5 * cotangents[k];
        let (i, j) = (2 * ((k + 1) % 3), 2 * ((k + 2) % 3));
        for axis in 0..2 {
            let (i, j) = (i + axis, j + axis);
            a[i][i] += half;
            a[j][j] += half;
            a[i][j] -= half;
            a[j][i] -= half;
        }
        // Twice the area is the sum of x_i y_j − x_j y_i over the sides.
        for (i, j, sign) in [(i, j, -0.5), (j, i, 0.5)] {
            a[i][j + 1] += sign;
            a[j + 1][i] += sign;
        }
    }
    a
}

/// The same map, scaled so that its area is the surface's.
pub(super) fn at_true_scale(surface: &Surface, mut coordinates: Vec<DVec2>) -> Vec<DVec2> {
    let area: f64 = surface
        .triangles()
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| coordinates[v.index()]);
            0.5 * (b - a).perp_dot(c - a)
        })
        .sum();
    let scale = (surface.total_area() / area).sqrt();
    for p in &mut coordinates {
        *p *= scale;
    }
    coordinates
}

fn farthest_pair(surface: &Surface) -> [VertexId; 2] {
    let boundary: Vec<VertexId> =
        surface.vertex_ids().filter(|&v| surface.is_boundary_vertex(v)).collect();
    let mut best = ([boundary[0], boundary[1]], 0.0);
    for (k, &a) in boundary.iter().enumerate() {
        for &b in &boundary[k + 1..] {
            let squared = surface.point(a).distance_squared(surface.point(b));
            if squared > best.1 * (1.0 + 2.0 * TIE) {
                best = ([a, b], squared);
            }
        }
    }
    best.0
}
