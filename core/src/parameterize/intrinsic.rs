//! The intrinsic parameterization with a natural boundary.
//!
//! Desbrun, Meyer & Alliez, *Intrinsic Parameterizations of Surface Meshes* (2002), section 4:
//! the discrete conformal map, least in Dirichlet energy (cotangents) minus area, with a free
//! boundary and two vertices held. Conformal, so it keeps angles and pays in area: on a limb that
//! is far from developable parts of the map shrink. It can also flip triangles and overlap
//! itself; the caller checks.

use glam::DVec2;

use super::rest::rest_triangles;
use super::sparse::{Pattern, SparseError};
use crate::surface::{Surface, VertexId};

/// Two boundary vertices as far apart as any. Pairs within this share of the greatest distance
/// count as equal and the first in order is taken, so that rounding does not choose.
const TIE: f64 = 1e-9;

/// The map of the vertices of a disk, or of a disk with holes, to the plane, in mm, with the
/// surface's own area in total.
///
/// # Errors
/// If the system is singular to rounding.
pub(super) fn intrinsic(surface: &Surface) -> Result<Vec<DVec2>, SparseError> {
    let pins = farthest_pair(surface);
    let n = surface.vertex_count();
    let mut column = vec![usize::MAX; n];
    let mut unknowns = 0;
    for v in surface.vertex_ids().filter(|v| !pins.contains(v)) {
        column[v.index()] = unknowns;
        unknowns += 2;
    }
    let apart = surface.point(pins[0]).distance(surface.point(pins[1]));
    let mut held = vec![DVec2::ZERO; n];
    held[pins[1].index()] = DVec2::new(0.0, -apart);

    let mut entries = Vec::with_capacity(12 * surface.triangle_count());
    let mut values = Vec::with_capacity(entries.capacity());
    let mut right = vec![0.0; unknowns];
    // Adds `value` at coordinate `a` of vertex i and coordinate `b` of vertex j, both ways.
    let mut add = |i: VertexId, a: usize, j: VertexId, b: usize, value: f64| {
        let (row, col) = (column[i.index()], column[j.index()]);
        match (row == usize::MAX, col == usize::MAX) {
            (false, false) => {
                let (row, col) = (row + a, col + b);
                entries.push((row.max(col), row.min(col)));
                values.push(value);
            }
            (false, true) => right[row + a] -= value * held[j.index()][b],
            (true, false) => right[col + b] -= value * held[i.index()][a],
            (true, true) => {}
        }
    };
    for (corners, rest) in surface.triangles().iter().zip(rest_triangles(surface)) {
        for k in 0..3 {
            let half = 0.5 * rest.cotangents[k];
            let (i, j) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            for axis in 0..2 {
                add(i, axis, j, axis, -half);
                // The diagonal is symmetric by itself: once, not both ways.
                for v in [i, j] {
                    if column[v.index()] != usize::MAX {
                        add(v, axis, v, axis, half);
                    }
                }
            }
        }
    }
    // Twice the area is the sum of x_i y_j − x_j y_i along the boundary.
    for &h in surface.boundary_loops().iter().flat_map(|l| &l.half_edges) {
        let (i, j) = (surface.from(h), surface.to(h));
        add(i, 0, j, 1, -0.5);
        add(j, 0, i, 1, 0.5);
    }
    let solution = Pattern::new(unknowns, &entries)?.factorize(&values)?.solve(&[right]);
    let coordinates: Vec<DVec2> = surface
        .vertex_ids()
        .map(|v| match column[v.index()] {
            usize::MAX => held[v.index()],
            c => DVec2::new(solution[0][c], solution[0][c + 1]),
        })
        .collect();
    Ok(at_true_scale(surface, coordinates))
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
