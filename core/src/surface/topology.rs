//! The validated surface: an oriented triangulated 2-manifold with its half-edges.
//!
//! Everything downstream takes a [`Surface`]; nothing downstream sees raw triangles.

use glam::DVec3;

use super::connectivity::Buckets;
use super::index::{HalfEdgeId, TriangleId, VertexId};

/// A connected or unconnected, oriented, triangulated 2-manifold with or without boundary, in mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    points: Vec<DVec3>,
    triangles: Vec<[VertexId; 3]>,
    twins: Vec<Option<HalfEdgeId>>,
    /// One half-edge that leaves each vertex; at the boundary the one from which turning
    /// counter-clockwise reaches all others.
    outgoing: Vec<HalfEdgeId>,
    loops: Vec<BoundaryLoop>,
}

/// A closed loop of boundary half-edges, each beginning where the one before ended, with the
/// surface on the left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BoundaryLoop {
    /// The half-edges in order.
    pub half_edges: Vec<HalfEdgeId>,
}

/// Why raw triangles are no [`Surface`]. [`validate`](super::validate) finds and names all such
/// defects before; meeting one later is a fault of the program.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TopologyError {
    /// A triangle names a vertex that does not exist.
    #[error("{triangle} names vertex {vertex}, but there are {count} vertices")]
    IndexOutOfRange {
        /// The triangle.
        triangle: TriangleId,
        /// The vertex index it names.
        vertex: usize,
        /// How many vertices there are.
        count: usize,
    },
    /// A triangle uses a vertex twice.
    #[error("{0} uses a vertex twice")]
    Degenerate(TriangleId),
    /// Two half-edges run the same way between two vertices.
    #[error("the edge {0} – {1} is used twice in the same direction")]
    EdgeUsedTwice(VertexId, VertexId),
    /// The triangles at a vertex do not form one fan.
    #[error("the triangles at {0} form more than one fan")]
    NonManifoldVertex(VertexId),
    /// A vertex belongs to no triangle.
    #[error("{0} belongs to no triangle")]
    Unused(VertexId),
}

impl Surface {
    /// The surface of these points (mm) and triangles (counter-clockwise seen from outside).
    ///
    /// # Errors
    /// If the triangles are not an oriented manifold that uses every vertex.
    pub fn new(points: Vec<DVec3>, triangles: Vec<[VertexId; 3]>) -> Result<Self, TopologyError> {
        for (i, corners) in triangles.iter().enumerate() {
            let triangle = TriangleId::new(i);
            let count = points.len();
            if let Some(vertex) = corners.iter().map(|v| v.index()).find(|&v| v >= count) {
                return Err(TopologyError::IndexOutOfRange { triangle, vertex, count });
            }
            if corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0] {
                return Err(TopologyError::Degenerate(triangle));
            }
        }
        let twins = find_twins(points.len(), &triangles)?;
        let mut surface =
            Self { outgoing: Vec::new(), loops: Vec::new(), points, triangles, twins };
        surface.outgoing = surface.find_outgoing()?;
        surface.loops = surface.find_loops();
        Ok(surface)
    }

    /// The same connectivity with other points.
    ///
    /// # Panics
    /// If the number of points differs.
    #[must_use]
    pub fn with_points(&self, points: Vec<DVec3>) -> Self {
        assert_eq!(points.len(), self.points.len());
        Self { points, ..self.clone() }
    }

    fn find_outgoing(&self) -> Result<Vec<HalfEdgeId>, TopologyError> {
        let mut outgoing: Vec<Option<HalfEdgeId>> = vec![None; self.points.len()];
        let mut degree = vec![0usize; self.points.len()];
        for h in self.half_edges() {
            let v = self.from(h);
            degree[v.index()] += 1;
            // A boundary half-edge is the clockwise end of its vertex's fan.
            if outgoing[v.index()].is_none() || self.twin(h).is_none() {
                outgoing[v.index()] = Some(h);
            }
        }
        let mut result = Vec::with_capacity(outgoing.len());
        for (i, start) in outgoing.into_iter().enumerate() {
            let v = VertexId::new(i);
            let start = start.ok_or(TopologyError::Unused(v))?;
            let mut seen = 0;
            let mut h = Some(start);
            while let Some(current) = h {
                seen += 1;
                h = self.twin(current.prev()).filter(|&n| n != start);
                if seen > degree[i] {
                    break;
                }
            }
            if seen != degree[i] {
                return Err(TopologyError::NonManifoldVertex(v));
            }
            result.push(start);
        }
        Ok(result)
    }

    fn find_loops(&self) -> Vec<BoundaryLoop> {
        let mut seen = vec![false; self.twins.len()];
        let mut loops = Vec::new();
        for start in self.half_edges() {
            if self.twin(start).is_some() || seen[start.index()] {
                continue;
            }
            let mut half_edges = Vec::new();
            let mut h = start;
            while !seen[h.index()] {
                seen[h.index()] = true;
                half_edges.push(h);
                h = self.outgoing[self.to(h).index()];
            }
            loops.push(BoundaryLoop { half_edges });
        }
        loops
    }

    /// The points, in mm, by vertex.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The place of a vertex, in mm.
    #[inline]
    #[must_use]
    pub fn point(&self, v: VertexId) -> DVec3 {
        self.points[v.index()]
    }

    /// The corners of every triangle, counter-clockwise seen from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles
    }

    /// The corners of a triangle.
    #[inline]
    #[must_use]
    pub fn triangle(&self, t: TriangleId) -> [VertexId; 3] {
        self.triangles[t.index()]
    }

    /// The places of a triangle's corners, in mm.
    #[inline]
    #[must_use]
    pub fn corners(&self, t: TriangleId) -> [DVec3; 3] {
        self.triangle(t).map(|v| self.point(v))
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.points.len()
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Number of edges.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        let boundary = self.twins.iter().filter(|twin| twin.is_none()).count();
        usize::midpoint(self.twins.len(), boundary)
    }

    /// V − E + F.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        let count = |n: usize| i64::try_from(n).expect("counts fit 32 bits");
        count(self.vertex_count()) - count(self.edge_count()) + count(self.triangle_count())
    }

    /// Every vertex.
    pub fn vertex_ids(&self) -> impl Iterator<Item = VertexId> + use<> {
        (0..self.points.len()).map(VertexId::new)
    }

    /// Every triangle.
    pub fn triangle_ids(&self) -> impl Iterator<Item = TriangleId> + use<> {
        (0..self.triangles.len()).map(TriangleId::new)
    }

    /// Every half-edge.
    pub fn half_edges(&self) -> impl Iterator<Item = HalfEdgeId> + use<> {
        (0..3 * self.triangles.len()).map(HalfEdgeId::new)
    }

    /// The half-edge on the other side, if the edge is not on the boundary.
    #[inline]
    #[must_use]
    pub fn twin(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.twins[h.index()]
    }

    /// Where a half-edge starts.
    #[inline]
    #[must_use]
    pub fn from(&self, h: HalfEdgeId) -> VertexId {
        self.triangles[h.index() / 3][h.corner()]
    }

    /// Where a half-edge ends.
    #[inline]
    #[must_use]
    pub fn to(&self, h: HalfEdgeId) -> VertexId {
        self.triangles[h.index() / 3][(h.corner() + 1) % 3]
    }

    /// The half-edges that leave a vertex, counter-clockwise; at the boundary the first one is a
    /// boundary half-edge and the edge that enters last has no outgoing half-edge.
    pub fn outgoing(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let start = self.outgoing[v.index()];
        std::iter::successors(Some(start), move |&h| {
            self.twin(h.prev()).filter(|&next| next != start)
        })
    }

    /// The vertices that share an edge with `v`, counter-clockwise.
    pub fn neighbours(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let last = self
            .is_boundary_vertex(v)
            .then(|| self.outgoing(v).last())
            .flatten()
            .map(|h| self.from(h.prev()));
        self.outgoing(v).map(|h| self.to(h)).chain(last)
    }

    /// Whether a vertex lies on the boundary.
    #[must_use]
    pub fn is_boundary_vertex(&self, v: VertexId) -> bool {
        self.twin(self.outgoing[v.index()]).is_none()
    }

    /// The boundary loops, ordered by their lowest half-edge.
    #[must_use]
    pub fn boundary_loops(&self) -> &[BoundaryLoop] {
        &self.loops
    }

    /// The vertices of a boundary loop, in its order.
    pub fn loop_vertices<'a>(
        &'a self,
        boundary: &'a BoundaryLoop,
    ) -> impl Iterator<Item = VertexId> + 'a {
        boundary.half_edges.iter().map(|&h| self.from(h))
    }

    /// Length of a boundary loop, in mm.
    #[must_use]
    pub fn loop_length(&self, boundary: &BoundaryLoop) -> f64 {
        boundary.half_edges.iter().map(|&h| self.length(h)).sum()
    }

    /// Length of a half-edge, in mm.
    #[inline]
    #[must_use]
    pub fn length(&self, h: HalfEdgeId) -> f64 {
        self.point(self.from(h)).distance(self.point(self.to(h)))
    }

    /// Mean length of the edges, in mm.
    #[must_use]
    pub fn mean_edge_length(&self) -> f64 {
        let sum: f64 = self.half_edges().map(|h| self.length(h)).sum();
        sum / self.twins.len().max(1) as f64
    }

    /// Twice the area of a triangle times its outward unit normal, in mm².
    #[must_use]
    pub fn area_vector(&self, t: TriangleId) -> DVec3 {
        let [a, b, c] = self.corners(t);
        (b - a).cross(c - a)
    }

    /// Outward unit normal of a triangle.
    #[inline]
    #[must_use]
    pub fn normal(&self, t: TriangleId) -> DVec3 {
        self.area_vector(t).normalize_or_zero()
    }

    /// Area of a triangle, in mm².
    #[inline]
    #[must_use]
    pub fn area(&self, t: TriangleId) -> f64 {
        0.5 * self.area_vector(t).length()
    }

    /// Area of the whole surface, in mm².
    #[must_use]
    pub fn total_area(&self) -> f64 {
        self.triangle_ids().map(|t| self.area(t)).sum()
    }

    /// Outward unit normals by vertex: the triangles' normals weighted by their angle there.
    #[must_use]
    pub fn vertex_normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.vertex_count()];
        for t in self.triangle_ids() {
            let p = self.corners(t);
            let n = self.normal(t);
            for k in 0..3 {
                let angle = (p[(k + 1) % 3] - p[k]).angle_between(p[(k + 2) % 3] - p[k]);
                if angle.is_finite() {
                    normals[self.triangle(t)[k].index()] += angle * n;
                }
            }
        }
        normals.into_iter().map(DVec3::normalize_or_zero).collect()
    }

    /// The connected component of every triangle, numbered from 0 by lowest triangle, and their
    /// number.
    #[must_use]
    pub fn components(&self) -> (Vec<usize>, usize) {
        let mut component = vec![usize::MAX; self.triangles.len()];
        let mut count = 0;
        for start in self.triangle_ids() {
            if component[start.index()] != usize::MAX {
                continue;
            }
            let mut stack = vec![start];
            component[start.index()] = count;
            while let Some(t) = stack.pop() {
                for k in 0..3 {
                    if let Some(twin) = self.twin(HalfEdgeId::of(t, k)) {
                        let n = twin.triangle();
                        if component[n.index()] == usize::MAX {
                            component[n.index()] = count;
                            stack.push(n);
                        }
                    }
                }
            }
            count += 1;
        }
        (component, count)
    }
}

/// The half-edge that runs the other way along each half-edge's edge.
fn find_twins(
    vertices: usize,
    triangles: &[[VertexId; 3]],
) -> Result<Vec<Option<HalfEdgeId>>, TopologyError> {
    let ends = |h: usize| {
        let corners = &triangles[h / 3];
        (corners[h % 3].index(), corners[(h % 3 + 1) % 3].index())
    };
    let half_edges = 0..3 * triangles.len();
    let leaving = Buckets::new(vertices, half_edges.clone().map(|h| (ends(h).0, ends(h).1, h)));
    half_edges
        .map(|h| {
            let (from, to) = ends(h);
            if leaving.find(from, to) != Some(h) {
                return Err(TopologyError::EdgeUsedTwice(VertexId::new(from), VertexId::new(to)));
            }
            Ok(leaving.find(to, from).map(HalfEdgeId::new))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ids(triangles: &[[usize; 3]]) -> Vec<[VertexId; 3]> {
        triangles.iter().map(|t| t.map(VertexId::new)).collect()
    }

    fn square() -> Surface {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        Surface::new(points, ids(&[[0, 1, 2], [0, 2, 3]])).unwrap()
    }

    #[test]
    fn a_square_has_one_loop_and_its_neighbours_turn_counter_clockwise() {
        let s = square();
        assert_eq!(s.euler_characteristic(), 1);
        assert_eq!(s.boundary_loops().len(), 1);
        let around: Vec<usize> =
            s.loop_vertices(&s.boundary_loops()[0]).map(VertexId::index).collect();
        assert_eq!(around, [0, 1, 2, 3]);
        let near: Vec<usize> = s.neighbours(VertexId::new(0)).map(VertexId::index).collect();
        assert_eq!(near, [1, 2, 3]);
        assert!((s.total_area() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_tetrahedron_is_closed() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let s = Surface::new(points, ids(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])).unwrap();
        assert!(s.boundary_loops().is_empty());
        assert_eq!(s.euler_characteristic(), 2);
        assert_eq!(s.outgoing(VertexId::new(3)).count(), 3);
    }

    #[test]
    fn broken_triangles_are_refused_by_name() {
        let points = || vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X];
        let error = |t: &[[usize; 3]]| Surface::new(points(), ids(t)).unwrap_err();
        assert!(matches!(error(&[[0, 1, 9]]), TopologyError::IndexOutOfRange { vertex: 9, .. }));
        assert!(matches!(error(&[[0, 1, 1]]), TopologyError::Degenerate(_)));
        assert!(matches!(error(&[[0, 1, 2], [0, 1, 3]]), TopologyError::EdgeUsedTwice(..)));
        assert!(matches!(error(&[[0, 1, 2], [0, 3, 4]]), TopologyError::NonManifoldVertex(_)));
        assert!(matches!(error(&[[0, 1, 2]]), TopologyError::Unused(_)));
    }
}
