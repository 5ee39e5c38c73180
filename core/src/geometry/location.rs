//! Points on a surface, and the point of a surface nearest to a place in space.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::surface::{HalfEdgeId, Surface, TriangleId, VertexId};

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

/// The vertices of a surface by their exact places: most of a cut surface's are the scan's own.
#[derive(Debug)]
pub struct ExactPlaces<'a> {
    surface: &'a Surface,
    /// The vertices, ascending by place.
    sorted: Vec<VertexId>,
}

impl<'a> ExactPlaces<'a> {
    /// Sorts them.
    #[must_use]
    pub fn new(surface: &'a Surface) -> Self {
        let mut sorted: Vec<VertexId> = surface.vertex_ids().collect();
        sorted.par_sort_unstable_by(|&a, &b| {
            along_axes(surface.point(a), surface.point(b)).then(a.cmp(&b))
        });
        Self { surface, sorted }
    }

    /// The first vertex at a place, as a point of the first of its triangles.
    #[must_use]
    pub fn at(&self, place: DVec3) -> Option<SurfacePoint> {
        let first =
            self.sorted.partition_point(|&v| along_axes(self.surface.point(v), place).is_lt());
        let v = *self.sorted.get(first).filter(|&&v| self.surface.point(v) == place)?;
        let triangle = self.surface.outgoing(v).map(HalfEdgeId::triangle).min()?;
        let corner = self.surface.triangle(triangle).iter().position(|&c| c == v)?;
        Some(SurfacePoint { triangle, barycentric: DVec3::AXES[corner] })
    }
}

/// By x, then y, then z.
fn along_axes(a: DVec3, b: DVec3) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
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

/// Triangles in a leaf of the tree.
const IN_LEAF: usize = 4;

/// Nodes that wait at most: one a level, and triangles are numbered by 32 bits.
const DEEPEST: usize = 40;

/// Bits of a place along one axis on the curve on which triangles are ordered.
const BITS: u32 = 21;

/// A box along the axes: its lower and upper corner.
type Box3 = [DVec3; 2];

/// Finds the point of a surface nearest to a place in space.
///
/// A tree of boxes over the triangles in the order of their middles on a space-filling curve
/// (Morton 1966; Lauterbach et al., *Fast BVH Construction on GPUs*, 2009). Of triangles equally
/// near the first is found.
pub struct Locator {
    /// Triangles in the order of the leaves, and their corners.
    order: Vec<u32>,
    corners: Vec<[DVec3; 3]>,
    /// A complete binary tree: node k has the children 2 k and 2 k + 1, node 1 is the root, the
    /// second half are leaves.
    boxes: Vec<Box3>,
}

impl Locator {
    /// Prepares the search on a surface.
    #[must_use]
    pub fn new(surface: &Surface) -> Self {
        let (low, high) = surface
            .points()
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
        let cells = f64::from(1u32 << BITS) - 1.0;
        let scale = cells / (high - low).max_element().max(f64::MIN_POSITIVE);
        let mut keyed: Vec<(u64, u32)> = surface
            .triangles()
            .par_iter()
            .enumerate()
            .map(|(t, corners)| {
                let sum: DVec3 = corners.iter().map(|&v| surface.point(v) - low).sum();
                // Triangles, as their half-edges, are numbered by 32 bits.
                (on_curve(sum / 3.0 * scale), t as u32)
            })
            .collect();
        keyed.par_sort_unstable();
        let order: Vec<u32> = keyed.into_iter().map(|(_, t)| t).collect();
        let corners: Vec<[DVec3; 3]> =
            order.iter().map(|&t| surface.corners(TriangleId::new(t as usize))).collect();
        let leaves = order.len().div_ceil(IN_LEAF).next_power_of_two();
        let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let mut boxes = vec![nothing; 2 * leaves];
        for (leaf, triangles) in corners.chunks(IN_LEAF).enumerate() {
            boxes[leaves + leaf] = triangles
                .iter()
                .flatten()
                .fold(nothing, |[low, high], &p| [low.min(p), high.max(p)]);
        }
        for k in (1..leaves).rev() {
            let ([a, b], [c, d]) = (boxes[2 * k], boxes[2 * k + 1]);
            boxes[k] = [a.min(c), b.max(d)];
        }
        Self { order, corners, boxes }
    }

    /// The nearest point of the surface and its distance in mm; `None` only for a surface
    /// without triangles.
    #[must_use]
    pub fn closest(&self, place: DVec3) -> Option<(SurfacePoint, f64)> {
        let leaves = self.boxes.len() / 2;
        // Square of the distance, triangle and place in it.
        let mut best = (f64::INFINITY, u32::MAX, DVec3::X);
        // The nearer child is looked at first; one of the farther waits a level.
        let mut waiting = [(0.0, 1); DEEPEST];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (gap, node) = waiting[count];
            if gap > best.0 {
                continue;
            }
            if node < leaves {
                let children = [2 * node, 2 * node + 1];
                let [a, b] = children.map(|k| (squared_gap(&self.boxes[k], place), k));
                waiting[count..count + 2].copy_from_slice(&if a.0 <= b.0 {
                    [b, a]
                } else {
                    [a, b]
                });
                count += 2;
                continue;
            }
            let first = (node - leaves) * IN_LEAF;
            let last = (first + IN_LEAF).min(self.order.len());
            for k in first.min(last)..last {
                let [a, b, c] = self.corners[k];
                let w = closest_on_triangle(place, [a, b, c]);
                let squared = place.distance_squared(w.x * a + w.y * b + w.z * c);
                if squared < best.0 || (squared == best.0 && self.order[k] < best.1) {
                    best = (squared, self.order[k], w);
                }
            }
        }
        let (squared, triangle, barycentric) = best;
        let triangle = (triangle != u32::MAX).then(|| TriangleId::new(triangle as usize))?;
        Some((SurfacePoint { triangle, barycentric }, squared.sqrt()))
    }
}

/// Square of the distance from a place to a box; infinite for an empty box.
fn squared_gap([low, high]: &Box3, place: DVec3) -> f64 {
    (*low - place).max(place - *high).max(DVec3::ZERO).length_squared()
}

/// Where cell `place` lies on the curve: its coordinates' bits in turn.
fn on_curve(place: DVec3) -> u64 {
    let spread = |x: f64| {
        let mut bits = x as u64 & ((1 << BITS) - 1);
        for (shift, mask) in [
            (32, 0x001f_0000_0000_ffff),
            (16, 0x001f_0000_ff00_00ff),
            (8, 0x100f_00f0_0f00_f00f),
            (4, 0x10c3_0c30_c30c_30c3),
            (2, 0x1249_2492_4924_9249),
        ] {
            bits = (bits | bits << shift) & mask;
        }
        bits
    };
    spread(place.x) | spread(place.y) << 1 | spread(place.z) << 2
}

#[cfg(test)]
mod tests {
    use super::super::shapes::torus_quarter;
    use super::*;

    #[test]
    fn a_vertex_is_found_by_its_place_and_nothing_else_is() {
        let s = torus_quarter(80.0, 40.0, 9.0);
        let (exact, locator) = (ExactPlaces::new(&s), Locator::new(&s));
        for &place in s.points() {
            let found = exact.at(place).unwrap();
            assert_eq!(found.position(&s), place);
            assert_eq!(found.triangle, locator.closest(place).unwrap().0.triangle);
            assert_eq!(exact.at(place + DVec3::new(1e-12, 0.0, 0.0)), None);
        }
    }

    #[test]
    fn the_nearest_point_is_that_of_all_triangles_and_the_first_of_equals() {
        let s = torus_quarter(80.0, 40.0, 9.0);
        let locator = Locator::new(&s);
        let all = |place: DVec3| {
            let gap = |t: TriangleId| {
                let [a, b, c] = s.corners(t);
                let w = closest_on_triangle(place, [a, b, c]);
                place.distance_squared(w.x * a + w.y * b + w.z * c)
            };
            s.triangle_ids().min_by(|&a, &b| gap(a).total_cmp(&gap(b))).map(|t| (t, gap(t)))
        };
        let beside = s.points().iter().map(|&p| 1.1 * p + DVec3::new(3.0, -7.0, 2.0));
        for place in s.points().iter().copied().chain(beside) {
            let (found, distance) = locator.closest(place).unwrap();
            let (triangle, squared) = all(place).unwrap();
            assert_eq!((found.triangle, distance), (triangle, squared.sqrt()), "{place}");
        }
    }

    #[test]
    fn neighbours_on_the_curve_are_cells_with_neighbouring_bits() {
        let at = |x: f64, y: f64, z: f64| on_curve(DVec3::new(x, y, z));
        assert_eq!([at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 0.0, 1.0)], [1, 2, 4]);
        assert_eq!(at(2.0, 3.0, 0.0), 0b01_1010);
        let last = f64::from((1u32 << BITS) - 1);
        assert_eq!(at(last, last, last), (1 << (3 * BITS)) - 1);
    }
}
