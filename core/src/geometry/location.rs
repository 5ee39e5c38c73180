//! Points on a surface, and the point of a surface nearest to a place in space.

use glam::{DVec2, DVec3};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

use crate::surface::{Surface, TriangleId};

/// A point on a surface: a triangle and barycentric coordinates in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// The triangle.
    pub triangle: TriangleId,
    /// Weights of its corners, in order; they sum to 1.
    pub barycentric: DVec3,
}

impl SurfacePoint {
    /// Its place in space, in mm.
    #[must_use]
    pub fn position(&self, surface: &Surface) -> DVec3 {
        let [a, b, c] = surface.corners(self.triangle);
        let w = self.barycentric;
        w.x * a + w.y * b + w.z * c
    }

    /// The value of a piecewise linear map of the vertices into the plane.
    #[must_use]
    pub fn interpolate(&self, surface: &Surface, values: &[DVec2]) -> DVec2 {
        let [a, b, c] = surface.triangle(self.triangle).map(|v| values[v.index()]);
        let w = self.barycentric;
        w.x * a + w.y * b + w.z * c
    }
}

/// The barycentric coordinates of the point of triangle `abc` nearest to `p`.
///
/// Ericson, *Real-Time Collision Detection* (2004), section 5.1.5: the Voronoi regions of the
/// triangle's features, in order.
#[must_use]
pub fn closest_on_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return DVec3::X;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return DVec3::Y;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return DVec3::new(1.0 - v, v, 0.0);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return DVec3::Z;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return DVec3::new(1.0 - w, 0.0, w);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return DVec3::new(0.0, 1.0 - w, w);
    }
    let sum = va + vb + vc;
    let (v, w) = (vb / sum, vc / sum);
    DVec3::new(1.0 - v - w, v, w)
}

struct Leaf {
    triangle: TriangleId,
    corners: [DVec3; 3],
}

impl RTreeObject for Leaf {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        let [a, b, c] = self.corners;
        AABB::from_corners(a.min(b).min(c).to_array(), a.max(b).max(c).to_array())
    }
}

impl PointDistance for Leaf {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        let p = DVec3::from_array(*point);
        let w = closest_on_triangle(p, self.corners);
        let [a, b, c] = self.corners;
        p.distance_squared(w.x * a + w.y * b + w.z * c)
    }
}

/// Finds the point of a surface nearest to a place in space.
pub struct Locator {
    tree: RTree<Leaf>,
}

impl Locator {
    /// Prepares the search on a surface.
    #[must_use]
    pub fn new(surface: &Surface) -> Self {
        let leaves = surface
            .triangle_ids()
            .map(|triangle| Leaf { triangle, corners: surface.corners(triangle) })
            .collect();
        Self { tree: RTree::bulk_load(leaves) }
    }

    /// The nearest point of the surface and its distance in mm; `None` only for a surface
    /// without triangles.
    #[must_use]
    pub fn closest(&self, place: DVec3) -> Option<(SurfacePoint, f64)> {
        let leaf = self.tree.nearest_neighbor(place.to_array())?;
        let barycentric = closest_on_triangle(place, leaf.corners);
        let [a, b, c] = leaf.corners;
        let nearest = barycentric.x * a + barycentric.y * b + barycentric.z * c;
        let point = SurfacePoint { triangle: leaf.triangle, barycentric };
        Some((point, place.distance(nearest)))
    }
}
