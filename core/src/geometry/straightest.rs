//! Straightest paths: walking on from a point of a surface in a direction.
//!
//! Inside a triangle the path is a straight line; across an edge it goes on straight in the
//! unfolded plane of the next triangle (Polthier & Schmies, *Straightest Geodesics on Polyhedral
//! Surfaces*, 1998). The paper follows the intersection with the plane of tangent and normal at
//! every point (Ravi Kumar et al. 2003, the paper's [29]); the two differ by the turn of the normal
//! within one triangle and have the same limit, and unfolding keeps the length exactly.

use glam::DVec3;

use super::SurfacePoint;
use crate::surface::{HalfEdgeId, Surface};

/// Where a straightest path ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walk {
    /// The last point, in the surface or on its boundary.
    pub end: SurfacePoint,
    /// The unit direction in which the path arrived, in the plane of the last triangle.
    pub direction: DVec3,
    /// Length of the path, in mm; the wanted length unless it met the boundary.
    pub travelled: f64,
    /// Whether the path met the boundary before its wanted length.
    pub met_boundary: bool,
}

/// A path crosses at most this many edges: more would be a path winding round one vertex of a
/// needle-like fan without getting on.
const MOST_CROSSINGS: usize = 100_000;

/// Walks `length` mm from `start` straight on in `direction`.
///
/// The direction need not lie in the triangle's plane: it is turned into it by projection. A
/// vanishing direction or length stays where it is.
#[must_use]
pub fn walk(surface: &Surface, start: &SurfacePoint, direction: DVec3, length: f64) -> Walk {
    let mut triangle = start.triangle;
    let mut barycentric = start.barycentric;
    let normal = surface.normal(triangle);
    let mut direction = (direction - normal.dot(direction) * normal).normalize_or_zero();
    let mut remaining = if direction == DVec3::ZERO { 0.0 } else { length };
    let mut travelled = 0.0;
    let stay = |triangle, barycentric, direction, travelled, met_boundary| Walk {
        end: SurfacePoint { triangle, barycentric },
        direction,
        travelled,
        met_boundary,
    };
    for _ in 0..MOST_CROSSINGS {
        if remaining <= 0.0 {
            break;
        }
        let corners = surface.corners(triangle);
        let rate = barycentric_rate(corners, direction);
        // The first edge that the line reaches, as the corner opposite to it.
        let exit = (0..3)
            .filter(|&k| rate[k] < 0.0)
            .map(|k| (barycentric[k].max(0.0) / -rate[k], k))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((reach, opposite)) = exit.filter(|(reach, _)| *reach < remaining) else {
            barycentric = normalised(barycentric + remaining * rate);
            return stay(triangle, barycentric, direction, travelled + remaining, false);
        };
        travelled += reach;
        remaining -= reach;
        barycentric += reach * rate;
        barycentric[opposite] = 0.0;
        barycentric = normalised(barycentric);
        let edge = HalfEdgeId::of(triangle, (opposite + 1) % 3);
        let Some(twin) = surface.twin(edge) else {
            return stay(triangle, barycentric, direction, travelled, true);
        };
        let (from, to) = (surface.point(surface.from(edge)), surface.point(surface.to(edge)));
        let along = (to - from).normalize_or_zero();
        let parallel = direction.dot(along);
        let across = (1.0 - parallel * parallel).max(0.0).sqrt();
        let next = twin.triangle();
        // In the next triangle the left-hand side of its own half-edge points inward.
        let inward = surface.normal(next).cross(-along);
        direction = (parallel * along + across * inward).normalize_or_zero();
        let mut entered = DVec3::ZERO;
        entered[twin.corner()] = barycentric[(opposite + 2) % 3];
        entered[(twin.corner() + 1) % 3] = barycentric[(opposite + 1) % 3];
        barycentric = entered;
        triangle = next;
    }
    stay(triangle, barycentric, direction, travelled, false)
}

/// How fast the barycentric coordinates change along a direction in the triangle's plane, per mm.
fn barycentric_rate([a, b, c]: [DVec3; 3], direction: DVec3) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let scale = 1.0 / normal.length_squared();
    let rate = |edge: DVec3| normal.cross(edge).dot(direction) * scale;
    DVec3::new(rate(c - b), rate(a - c), rate(b - a))
}

fn normalised(barycentric: DVec3) -> DVec3 {
    let inside = barycentric.max(DVec3::ZERO);
    inside / inside.element_sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{TriangleId, VertexId};

    /// A tube round the z axis with `n` facets and `rows` rings of quads of height `h`.
    fn tube(radius: f64, n: usize, rows: usize, h: f64) -> Surface {
        let mut points = Vec::new();
        for i in 0..=rows {
            for j in 0..n {
                let a = std::f64::consts::TAU * j as f64 / n as f64;
                points.push(DVec3::new(radius * a.cos(), radius * a.sin(), i as f64 * h));
            }
        }
        let id = |i: usize, j: usize| VertexId::new(i * n + j % n);
        let mut triangles = Vec::new();
        for i in 0..rows {
            for j in 0..n {
                triangles.push([id(i, j), id(i, j + 1), id(i + 1, j + 1)]);
                triangles.push([id(i, j), id(i + 1, j + 1), id(i + 1, j)]);
            }
        }
        Surface::new(points, triangles).unwrap()
    }

    #[test]
    fn a_straightest_path_on_a_cylinder_is_a_helix() {
        let (radius, n) = (40.0, 360);
        let surface = tube(radius, n, 40, 5.0);
        let start =
            SurfacePoint { triangle: TriangleId::new(0), barycentric: DVec3::new(0.5, 0.3, 0.2) };
        let from = start.position(&surface);
        // 30° against the horizontal: 150 mm climb 75 mm and turn 150 cos 30° / r.
        let round = DVec3::Z.cross(DVec3::new(from.x, from.y, 0.0)).normalize();
        let slope = 30f64.to_radians();
        let result = walk(&surface, &start, slope.cos() * round + slope.sin() * DVec3::Z, 150.0);
        let to = result.end.position(&surface);
        assert!(!result.met_boundary && (result.travelled - 150.0).abs() < 1e-9);
        assert!((to.z - from.z - 75.0).abs() < 0.02, "{}", to.z - from.z);
        let turned = to.y.atan2(to.x) - from.y.atan2(from.x);
        let expected = 150.0 * slope.cos() / radius;
        let difference = (turned - expected).rem_euclid(std::f64::consts::TAU);
        let difference = difference.min(std::f64::consts::TAU - difference);
        assert!(difference < 1e-3, "{difference}");
    }

    #[test]
    fn a_path_stops_at_the_boundary() {
        let surface = tube(40.0, 60, 4, 5.0);
        let start =
            SurfacePoint { triangle: TriangleId::new(0), barycentric: DVec3::new(0.4, 0.3, 0.3) };
        let height = start.position(&surface).z;
        let result = walk(&surface, &start, DVec3::Z, 100.0);
        assert!(result.met_boundary);
        assert!((result.end.position(&surface).z - 20.0).abs() < 1e-9);
        assert!((result.travelled - (20.0 - height)).abs() < 1e-9);
    }

    #[test]
    fn a_path_through_a_vertex_goes_on() {
        let surface = tube(40.0, 60, 6, 5.0);
        let start = SurfacePoint { triangle: TriangleId::new(0), barycentric: DVec3::X };
        let result = walk(&surface, &start, DVec3::Z, 28.0);
        assert!(!result.met_boundary);
        assert!((result.end.position(&surface).z - 28.0).abs() < 1e-9);
    }
}
