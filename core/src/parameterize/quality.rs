//! What a map of a surface into the plane does to it: flips, stretch, crossings of its outline.
//!
//! Orientation and crossings are decided by exact predicates (Shewchuk 1997, crate `robust`).

use glam::DVec2;
use robust::{Coord, orient2d};
use rstar::{AABB, RTree, RTreeObject};

use super::rest::rest_triangles;
use crate::surface::{Surface, TriangleId, VertexId};

/// The quality of a map into the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapQuality {
    /// Triangles that are not counter-clockwise in the plane: turned over, of no area, or with a
    /// coordinate that is not finite.
    pub flipped: usize,
    /// Pairs of boundary edges that cross; see [`outline_crossings`].
    pub crossings: usize,
    /// Least area in the plane per area on the surface, of all triangles.
    pub least_area_ratio: f64,
    /// Greatest area in the plane per area on the surface, of all triangles.
    pub greatest_area_ratio: f64,
    /// Root mean square of both principal stretches (length in the plane per length on the
    /// surface) about 1, by area on the surface.
    pub stretch_rms: f64,
    /// Least principal stretch of all triangles.
    pub least_stretch: f64,
    /// Greatest principal stretch of all triangles.
    pub greatest_stretch: f64,
    /// Root mean square of the factor, less one, by which the worse of its two stretches is off
    /// either way: 1 means that a typical piece is drawn at half or at double its length.
    pub factor_rms: f64,
}

/// Twice the area of a triangle of the plane, positive counter-clockwise; its sign is exact.
#[must_use]
pub fn signed_area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// The corners of a triangle in the plane.
pub(super) fn planar(surface: &Surface, coordinates: &[DVec2], t: TriangleId) -> [DVec2; 3] {
    surface.triangle(t).map(|v| coordinates[v.index()])
}

/// The triangles that are not counter-clockwise in the plane.
pub fn flipped_triangles<'a>(
    surface: &'a Surface,
    coordinates: &'a [DVec2],
) -> impl Iterator<Item = TriangleId> + 'a {
    surface.triangle_ids().filter(|&t| {
        let [a, b, c] = planar(surface, coordinates, t);
        !(a.is_finite() && b.is_finite() && c.is_finite() && signed_area(a, b, c) > 0.0)
    })
}

/// The quality of the map that takes the vertices of `surface` to `coordinates` (mm).
#[must_use]
pub fn map_quality(surface: &Surface, coordinates: &[DVec2]) -> MapQuality {
    let mut q = MapQuality {
        flipped: flipped_triangles(surface, coordinates).count(),
        crossings: outline_crossings(surface, coordinates),
        least_area_ratio: f64::INFINITY,
        greatest_area_ratio: f64::NEG_INFINITY,
        stretch_rms: 0.0,
        least_stretch: f64::INFINITY,
        greatest_stretch: 0.0,
        factor_rms: 0.0,
    };
    let mut total = 0.0;
    for (t, rest) in surface.triangle_ids().zip(rest_triangles(surface)) {
        let p = planar(surface, coordinates, t);
        let g = rest.gradients();
        let (along, across) = (0..3)
            .fold((DVec2::ZERO, DVec2::ZERO), |(x, y), k| (x + p[k] * g[k].x, y + p[k] * g[k].y));
        let [large, small] = stretches(along, across);
        let ratio = along.perp_dot(across);
        q.least_area_ratio = q.least_area_ratio.min(ratio);
        q.greatest_area_ratio = q.greatest_area_ratio.max(ratio);
        q.least_stretch = q.least_stretch.min(small);
        q.greatest_stretch = q.greatest_stretch.max(large);
        let factor = large.max(1.0 / small);
        total += rest.area;
        q.stretch_rms += rest.area * 0.5 * ((large - 1.0).powi(2) + (small - 1.0).powi(2));
        q.factor_rms += rest.area * (factor - 1.0).powi(2);
    }
    q.stretch_rms = (q.stretch_rms / total).sqrt();
    q.factor_rms = (q.factor_rms / total).sqrt();
    q
}

/// The singular values of the matrix with these columns, the larger first; the smaller is never
/// negative.
fn stretches(along: DVec2, across: DVec2) -> [f64; 2] {
    let turning = DVec2::new(along.x + across.y, along.y - across.x).length();
    let mirrored = DVec2::new(along.x - across.y, along.y + across.x).length();
    [0.5 * (turning + mirrored), 0.5 * (turning - mirrored).abs()]
}

struct Edge {
    ends: [DVec2; 2],
    vertices: [VertexId; 2],
    index: usize,
}

impl RTreeObject for Edge {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners(self.ends[0].to_array(), self.ends[1].to_array())
    }
}

/// Number of pairs of boundary edges without a common vertex that cross in the plane, or lie on
/// one another with the surface on the same side (cloth on cloth). Edges that only touch from
/// outside (the two sides of a slit that closes) do not count, nor do edges with a coordinate
/// that is not finite.
#[must_use]
pub fn outline_crossings(surface: &Surface, coordinates: &[DVec2]) -> usize {
    crossing_edges(surface, coordinates).len()
}

/// The pairs of boundary edges that [`outline_crossings`] counts, each by its beginning.
#[must_use]
pub fn crossing_edges(surface: &Surface, coordinates: &[DVec2]) -> Vec<[VertexId; 2]> {
    let mut edges = Vec::new();
    for h in surface.boundary_loops().iter().flat_map(|l| &l.half_edges) {
        let vertices = [surface.from(*h), surface.to(*h)];
        let ends = vertices.map(|v| coordinates[v.index()]);
        if ends[0].is_finite() && ends[1].is_finite() {
            edges.push(Edge { ends, vertices, index: edges.len() });
        }
    }
    let tree = RTree::bulk_load(edges);
    let mut crossings: Vec<[VertexId; 2]> = tree
        .iter()
        .flat_map(|edge| {
            tree.locate_in_envelope_intersecting(edge.envelope())
                .filter(|other| other.index > edge.index)
                .filter(|other| !other.vertices.iter().any(|v| edge.vertices.contains(v)))
                .filter(|other| cross(edge.ends, other.ends))
                .map(|other| [edge.vertices[0], other.vertices[0]])
        })
        .collect();
    crossings.sort_unstable();
    crossings
}

/// Whether two boundary edges, each with the surface on its left, cross or cover the same cloth.
/// An end exactly on the other edge counts as lying outside, on its right; edges whose ends
/// coincide touch.
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let (c_side, d_side) = (signed_area(a, b, c), signed_area(a, b, d));
    if c_side == 0.0 && d_side == 0.0 {
        let along = b - a;
        let place = |p: DVec2| (p - a).dot(along);
        return along.dot(d - c) > 0.0 && place(c).max(0.0) < place(d).min(along.length_squared());
    }
    if [a, b].iter().any(|end| *end == c || *end == d) {
        return false;
    }
    let (a_side, b_side) = (signed_area(c, d, a), signed_area(c, d, b));
    (c_side > 0.0) != (d_side > 0.0) && (a_side > 0.0) != (b_side > 0.0)
}

#[cfg(test)]
mod tests {
    use super::super::super::geometry::shapes::grid;
    use super::*;
    use glam::DVec3;

    fn strip() -> (Surface, Vec<DVec2>) {
        let s = grid(1, 10, false, |x, y| DVec3::new(10.0 * x, y, 0.0));
        let flat = s.points().iter().map(|p| p.truncate()).collect();
        (s, flat)
    }

    #[test]
    fn a_plane_is_undistorted_and_a_doubled_one_is_stretched_by_two() {
        let (s, flat) = strip();
        let q = map_quality(&s, &flat);
        assert_eq!((q.flipped, q.crossings), (0, 0));
        assert!(q.stretch_rms < 1e-14 && q.factor_rms < 1e-14);
        let wide: Vec<DVec2> = flat.iter().map(|p| DVec2::new(2.0 * p.x, p.y)).collect();
        let q = map_quality(&s, &wide);
        assert!((q.greatest_stretch - 2.0).abs() < 1e-14 && (q.least_stretch - 1.0).abs() < 1e-14);
        assert!((q.stretch_rms - 0.5_f64.sqrt()).abs() < 1e-14);
        assert!((q.factor_rms - 1.0).abs() < 1e-14 && (q.least_area_ratio - 2.0).abs() < 1e-14);
    }

    #[test]
    fn a_mirrored_or_undefined_triangle_is_flipped() {
        let (s, flat) = strip();
        let mirrored: Vec<DVec2> = flat.iter().map(|p| DVec2::new(-p.x, p.y)).collect();
        assert_eq!(map_quality(&s, &mirrored).flipped, s.triangle_count());
        let mut broken = flat;
        broken[0].x = f64::NAN;
        let touched = s.triangles().iter().filter(|t| t.contains(&VertexId::new(0))).count();
        assert_eq!(map_quality(&s, &broken).flipped, touched);
    }

    #[test]
    fn a_strip_rolled_over_itself_crosses_and_a_closed_ring_only_touches() {
        let (s, flat) = strip();
        let roll = |turns: f64| -> Vec<DVec2> {
            flat.iter()
                .map(|p| {
                    let angle = -turns * std::f64::consts::TAU * p.x / 10.0;
                    (2.0 + p.y) * DVec2::from_angle(angle)
                })
                .collect()
        };
        assert_eq!(outline_crossings(&s, &roll(0.9)), 0);
        assert!(outline_crossings(&s, &roll(1.05)) > 0);
        assert_eq!(map_quality(&s, &roll(1.05)).flipped, 0);
        let mut ring = roll(1.0);
        (ring[10], ring[21]) = (ring[0], ring[11]);
        assert_eq!(outline_crossings(&s, &ring), 0);
    }

    #[test]
    fn edges_on_one_another_count_only_with_cloth_on_the_same_side() {
        let p = DVec2::new;
        let edge = [p(0.0, 0.0), p(2.0, 0.0)];
        assert!(cross(edge, [p(1.0, 0.0), p(3.0, 0.0)]));
        assert!(!cross(edge, [p(3.0, 0.0), p(1.0, 0.0)]));
        assert!(!cross(edge, [p(2.0, 0.0), p(3.0, 0.0)]));
        assert!(cross(edge, [p(1.0, -1.0), p(1.0, 1.0)]));
        assert!(!cross(edge, [p(1.0, -1.0), p(1.0, 0.0)]));
        assert!(!cross(edge, [p(3.0, -1.0), p(3.0, 1.0)]));
    }
}
