//! The pattern: the surface's own boundary laid flat, with its seams and figures.

use glam::{DVec2, DVec3};

use crate::parameterize::{crossing_edges, flipped_triangles};
use crate::seams::{CutSurface, Seam};
use crate::surface::{BoundaryLoop, HalfEdgeId, Surface, VertexId};

/// A flat pattern in mm, x along warp, y along weft, the end near the body on top.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// Closed loops of the boundary: the outer one first, counter-clockwise, then the cut-outs.
    pub outline: Vec<Vec<DVec2>>,
    /// The two sides of every seam.
    pub seams: Vec<PatternSeam>,
    /// Extent along warp, in mm.
    pub width: f64,
    /// Extent along weft, in mm.
    pub height: f64,
    /// Area, in mm².
    pub area: f64,
    /// Number of triangles that lie the wrong way round or have no area.
    pub flipped: usize,
    /// Where the outline crosses itself: of each crossing the two places on the limb, in mm, that
    /// would lie on each other in the pattern.
    pub overlaps: Vec<[DVec3; 2]>,
}

/// The two sides of a seam in the pattern, start sewn to start.
#[derive(Debug, Clone, PartialEq)]
pub struct PatternSeam {
    /// One side.
    pub left: Vec<DVec2>,
    /// The other side.
    pub right: Vec<DVec2>,
    /// Length of the left side, in mm.
    pub left_mm: f64,
    /// Length of the right side, in mm.
    pub right_mm: f64,
}

/// The pattern of a cut surface whose vertices have these pattern coordinates, in mm.
#[must_use]
pub fn pattern(cut: &CutSurface, coordinates: &[DVec2]) -> Pattern {
    let disk = &cut.disk;
    let place = |v: VertexId| coordinates[v.index()];
    let outline: Vec<Vec<DVec2>> = outline(disk)
        .into_iter()
        .map(|boundary| boundary.into_iter().map(place).collect())
        .collect();
    let (low, high) = coordinates
        .iter()
        .fold((DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY)), |(low, high), &p| {
            (low.min(p), high.max(p))
        });
    Pattern {
        area: outline.iter().map(|points| signed_area(points)).sum(),
        outline,
        seams: cut.seams.iter().map(|seam| sides(seam, place)).collect(),
        width: high.x - low.x,
        height: high.y - low.y,
        flipped: flipped_triangles(disk, coordinates).count(),
        overlaps: crossing_edges(disk, coordinates)
            .into_iter()
            .map(|pair| pair.map(|v| disk.point(v)))
            .collect(),
    }
}

/// The vertices along the boundary's loops: the outer one first, then the cut-outs.
#[must_use]
pub fn outline(disk: &Surface) -> Vec<Vec<VertexId>> {
    outer_first(disk).into_iter().map(|boundary| disk.loop_vertices(boundary).collect()).collect()
}

/// The boundary half-edges that are not sewn to others.
#[must_use]
pub fn free_edges(cut: &CutSurface) -> Vec<HalfEdgeId> {
    let mut sewn: Vec<(VertexId, VertexId)> = Vec::new();
    for side in cut.seams.iter().flat_map(|seam| [&seam.left, &seam.right]) {
        for pair in side.windows(2) {
            sewn.extend([(pair[0], pair[1]), (pair[1], pair[0])]);
        }
    }
    sewn.sort_unstable();
    cut.disk
        .boundary_loops()
        .iter()
        .flat_map(|boundary| &boundary.half_edges)
        .copied()
        .filter(|&h| sewn.binary_search(&(cut.disk.from(h), cut.disk.to(h))).is_err())
        .collect()
}

/// The boundary loops, the longest on the surface first: cut-outs are shorter than the outline.
fn outer_first(disk: &Surface) -> Vec<&BoundaryLoop> {
    let mut loops: Vec<&BoundaryLoop> = disk.boundary_loops().iter().collect();
    loops.sort_by(|a, b| disk.loop_length(b).total_cmp(&disk.loop_length(a)));
    loops
}

fn sides(seam: &Seam, place: impl Fn(VertexId) -> DVec2) -> PatternSeam {
    let side = |ids: &[VertexId]| ids.iter().map(|&v| place(v)).collect::<Vec<_>>();
    let length = |points: &[DVec2]| points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let (left, right) = (side(&seam.left), side(&seam.right));
    PatternSeam { left_mm: length(&left), right_mm: length(&right), left, right }
}

/// Area inside a closed polygon, positive if it turns counter-clockwise, in mm².
fn signed_area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_of_a_polygon_by_hand() {
        let square = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (0.0, 2.0)].map(DVec2::from);
        assert!((signed_area(&square) - 6.0).abs() < 1e-15);
        let reversed: Vec<DVec2> = square.iter().rev().copied().collect();
        assert!((signed_area(&reversed) + 6.0).abs() < 1e-15);
    }
}
