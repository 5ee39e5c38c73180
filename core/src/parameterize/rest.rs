//! The triangles' own shapes, from edge lengths alone, with slivers opened by a hair.
//!
//! Sharp & Crane, *A Laplacian for Nonmanifold Triangle Meshes* (2020), section 4.5, intrinsic
//! mollification: one small length added to every edge makes each triangle inequality hold with
//! room, so that no cotangent is infinite. A mesh without slivers is left exactly as it is.

use glam::DVec2;

use crate::surface::{HalfEdgeId, Surface};

/// Room demanded in every triangle inequality, in mean edge lengths: a sliver of mean length then
/// has an angle of at least 0.4°, and no edge grows by more than this share of the mean.
const ROOM: f64 = 1e-5;

/// The shape of a triangle laid in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RestTriangle {
    /// Its corners, counter-clockwise, the first at the origin, the second on the x axis, in mm.
    pub(super) corners: [DVec2; 3],
    /// Cotangents of the angles at its corners.
    pub(super) cotangents: [f64; 3],
    /// Its area, in mm².
    pub(crate) area: f64,
}

impl RestTriangle {
    /// The triangle with these edge lengths, edge `k` from corner `k` to corner `k + 1`.
    fn new([a, b, c]: [f64; 3]) -> Self {
        // Kahan's formula for the area of a needle, on sorted lengths.
        let mut sorted = [a, b, c];
        sorted.sort_by(|p, q| q.total_cmp(p));
        let [l, m, s] = sorted;
        let product = (l + (m + s)) * (s - (l - m)) * (s + (l - m)) * (l + (m - s));
        let area = 0.25 * product.max(0.0).sqrt();
        let cot =
            |x: f64, y: f64, opposite: f64| (x * x + y * y - opposite * opposite) / (4.0 * area);
        let x = (a * a + c * c - b * b) / (2.0 * a);
        Self {
            corners: [DVec2::ZERO, DVec2::new(a, 0.0), DVec2::new(x, 2.0 * area / a)],
            cotangents: [cot(a, c, b), cot(a, b, c), cot(b, c, a)],
            area,
        }
    }

    /// Gradients of the corners' hat functions, in 1/mm.
    pub(crate) fn gradients(&self) -> [DVec2; 3] {
        let p = self.corners;
        std::array::from_fn(|k| (p[(k + 2) % 3] - p[(k + 1) % 3]).perp() / (2.0 * self.area))
    }
}

/// The shapes of all triangles of a surface, mollified where it needs to be.
pub(crate) fn rest_triangles(surface: &Surface) -> Vec<RestTriangle> {
    let of = |t| std::array::from_fn(|k| surface.length(HalfEdgeId::of(t, k)));
    rest_of_lengths(surface.triangle_ids().map(of).collect())
}

/// The same of the lengths of their edges, in mm, edge `k` of a triangle from corner `k` to corner `k + 1`.
pub(crate) fn rest_of_lengths(lengths: Vec<[f64; 3]>) -> Vec<RestTriangle> {
    let edges = 3 * lengths.len().max(1);
    let room = ROOM * lengths.iter().flatten().sum::<f64>() / edges as f64;
    let lacking = lengths
        .iter()
        .flat_map(|&[a, b, c]| [room - (a + b - c), room - (b + c - a), room - (c + a - b)])
        .fold(0.0, f64::max);
    lengths.into_iter().map(|l| RestTriangle::new(l.map(|x| x + lacking))).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::surface::VertexId;

    #[test]
    fn a_right_triangle_is_itself() {
        let t = RestTriangle::new([3.0, 5.0, 4.0]);
        assert!((t.area - 6.0).abs() < 1e-14);
        assert!((t.corners[2] - DVec2::new(0.0, 4.0)).length() < 1e-14);
        assert!(t.cotangents[0].abs() < 1e-15 && (t.cotangents[1] - 0.75).abs() < 1e-15);
        let g = t.gradients();
        assert!((g[1] - DVec2::new(1.0 / 3.0, 0.0)).length() < 1e-15);
        assert!((g[0] + g[1] + g[2]).length() < 1e-15);
    }

    #[test]
    fn a_flat_triangle_is_opened_and_stays_finite() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(0.5, 0.0, 0.0), DVec3::Y];
        let ids = |t: [usize; 3]| t.map(VertexId::new);
        let s = Surface::new(points, vec![ids([0, 1, 2]), ids([1, 0, 3])]).unwrap();
        let rest = rest_triangles(&s);
        assert!(rest.iter().all(|t| t.area > 0.0 && t.cotangents.iter().all(|c| c.is_finite())));
        assert!((rest[1].area - 0.5).abs() < 1e-4);
    }
}
