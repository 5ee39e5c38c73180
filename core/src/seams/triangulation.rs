//! A triangulation that can be refined in place: the workbench of clipping and carving.
//!
//! A [`Surface`] never changes. Clipping and carving split many edges one after the other, so they
//! work on this copy with half-edges `3 t + k` as in a surface, and hand back a new surface.

use glam::DVec3;

use super::error::SeamError;
use crate::surface::{HalfEdgeId, Surface, TopologyError, TriangleId, VertexId};

/// Points, triangles and twins, open to local changes that keep them an oriented manifold.
#[derive(Debug, Clone)]
pub(super) struct Triangulation {
    points: Vec<DVec3>,
    triangles: Vec<[VertexId; 3]>,
    twins: Vec<Option<HalfEdgeId>>,
    /// One half-edge that leaves each vertex, any.
    leaving: Vec<HalfEdgeId>,
}

impl Triangulation {
    pub(super) fn new(surface: &Surface) -> Self {
        let mut leaving = vec![HalfEdgeId::new(0); surface.vertex_count()];
        for h in surface.half_edges() {
            leaving[surface.from(h).index()] = h;
        }
        Self {
            points: surface.points().to_vec(),
            triangles: surface.triangles().to_vec(),
            twins: surface.half_edges().map(|h| surface.twin(h)).collect(),
            leaving,
        }
    }

    pub(super) fn into_surface(self) -> Result<Surface, TopologyError> {
        Surface::new(self.points, self.triangles)
    }

    pub(super) fn points(&self) -> &[DVec3] {
        &self.points
    }

    pub(super) fn triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles
    }

    pub(super) fn point(&self, v: VertexId) -> DVec3 {
        self.points[v.index()]
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.points.len()
    }

    pub(super) fn half_edge_count(&self) -> usize {
        self.twins.len()
    }

    pub(super) fn corners(&self, t: TriangleId) -> [DVec3; 3] {
        self.triangles[t.index()].map(|v| self.point(v))
    }

    pub(super) fn from(&self, h: HalfEdgeId) -> VertexId {
        self.triangles[h.index() / 3][h.corner()]
    }

    pub(super) fn to(&self, h: HalfEdgeId) -> VertexId {
        self.triangles[h.index() / 3][(h.corner() + 1) % 3]
    }

    /// The corner of `h`'s triangle that `h` does not touch.
    pub(super) fn apex(&self, h: HalfEdgeId) -> VertexId {
        self.from(h.prev())
    }

    pub(super) fn twin(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.twins[h.index()]
    }

    pub(super) fn length(&self, h: HalfEdgeId) -> f64 {
        self.point(self.from(h)).distance(self.point(self.to(h)))
    }

    /// Mean length of the edges, in mm.
    pub(super) fn mean_edge(&self) -> f64 {
        let count = self.half_edge_count();
        let sum: f64 = (0..count).map(|h| self.length(HalfEdgeId::new(h))).sum();
        sum / count.max(1) as f64
    }

    /// The half-edges that leave `v`, counter-clockwise, beginning at the boundary if there is one.
    pub(super) fn outgoing(&self, v: VertexId) -> Vec<HalfEdgeId> {
        let mut start = self.leaving[v.index()];
        // Turn clockwise to the boundary, or once round.
        let first = start;
        while let Some(twin) = self.twin(start) {
            start = twin.next();
            if start == first {
                break;
            }
        }
        let mut fan = vec![start];
        let mut h = start;
        while let Some(next) = self.twin(h.prev()).filter(|&next| next != start) {
            fan.push(next);
            h = next;
        }
        fan
    }

    pub(super) fn is_boundary(&self, v: VertexId) -> bool {
        let mut h = self.leaving[v.index()];
        let first = h;
        while let Some(twin) = self.twin(h) {
            h = twin.next();
            if h == first {
                return false;
            }
        }
        true
    }

    /// The vertices that share an edge with `v`.
    pub(super) fn neighbours(&self, v: VertexId) -> Vec<VertexId> {
        let fan = self.outgoing(v);
        let mut result: Vec<VertexId> = fan.iter().map(|&h| self.to(h)).collect();
        if let Some(&last) = fan.last()
            && self.twin(last.prev()).is_none()
        {
            result.push(self.apex(last));
        }
        result
    }

    /// The half-edge from `a` to `b`, if the triangle on its left exists.
    pub(super) fn half_edge(&self, a: VertexId, b: VertexId) -> Option<HalfEdgeId> {
        self.outgoing(a).into_iter().find(|&h| self.to(h) == b)
    }

    /// The edge between `a` and `b` as either of its half-edges.
    pub(super) fn edge(&self, a: VertexId, b: VertexId) -> Option<HalfEdgeId> {
        self.half_edge(a, b).or_else(|| self.half_edge(b, a))
    }

    /// The boundary half-edge that leaves a boundary vertex.
    pub(super) fn boundary_after(&self, v: VertexId) -> Option<HalfEdgeId> {
        self.outgoing(v).first().copied().filter(|&h| self.twin(h).is_none())
    }

    /// Sum of the angles at `v`, in radians.
    pub(super) fn total_angle(&self, v: VertexId) -> f64 {
        self.outgoing(v).into_iter().map(|h| self.angle(h)).sum()
    }

    /// The angle at the start of `h` in its triangle, in radians.
    pub(super) fn angle(&self, h: HalfEdgeId) -> f64 {
        let at = self.point(self.from(h));
        angle_between(self.point(self.to(h)) - at, self.point(self.apex(h)) - at)
    }

    pub(super) fn move_vertex(&mut self, v: VertexId, place: DVec3) {
        self.points[v.index()] = place;
    }

    fn join(&mut self, a: HalfEdgeId, b: Option<HalfEdgeId>) {
        self.twins[a.index()] = b;
        if let Some(b) = b {
            self.twins[b.index()] = Some(a);
        }
    }

    fn set_triangle(&mut self, t: TriangleId, corners: [VertexId; 3]) {
        self.triangles[t.index()] = corners;
        for k in 0..3 {
            self.leaving[corners[k].index()] = HalfEdgeId::of(t, k);
        }
    }

    fn push_triangle(&mut self, corners: [VertexId; 3]) -> TriangleId {
        let t = TriangleId::new(self.triangles.len());
        self.triangles.push(corners);
        self.twins.extend([None; 3]);
        self.set_triangle(t, corners);
        t
    }

    fn push_point(&mut self, place: DVec3) -> VertexId {
        self.points.push(place);
        self.leaving.push(HalfEdgeId::new(0));
        VertexId::new(self.points.len() - 1)
    }

    /// Splits the edge of `h` at `place` and joins the new vertex to the apexes on both sides.
    pub(super) fn split_edge(&mut self, h: HalfEdgeId, place: DVec3) -> VertexId {
        let x = self.push_point(place);
        let twin = self.twin(h);
        let (near, far) = self.split_side(h, x);
        if let Some(g) = twin {
            // Seen from the other side the halves come in the opposite order.
            let (far_twin, near_twin) = self.split_side(g, x);
            self.join(near, Some(near_twin));
            self.join(far, Some(far_twin));
        }
        x
    }

    /// Splits `h`'s triangle `(a, b, o)` into `(a, x, o)` and `(x, b, o)`; the half-edges `a x` and
    /// `x b`, yet without twins.
    fn split_side(&mut self, h: HalfEdgeId, x: VertexId) -> (HalfEdgeId, HalfEdgeId) {
        let (a, b, o) = (self.from(h), self.to(h), self.apex(h));
        let (after_b, after_o) = (self.twin(h.next()), self.twin(h.prev()));
        let t = h.triangle();
        self.set_triangle(t, [a, x, o]);
        let other = self.push_triangle([x, b, o]);
        let of = HalfEdgeId::of;
        self.join(of(t, 0), None);
        self.join(of(t, 1), Some(of(other, 2)));
        self.join(of(t, 2), after_o);
        self.join(of(other, 0), None);
        self.join(of(other, 1), after_b);
        (of(t, 0), of(other, 0))
    }

    /// Splits a triangle into three at `place`.
    pub(super) fn split_triangle(&mut self, t: TriangleId, place: DVec3) -> VertexId {
        let x = self.push_point(place);
        let of = HalfEdgeId::of;
        let [a, b, c] = self.triangles[t.index()];
        let [ab, bc, ca] = [0, 1, 2].map(|k| self.twin(of(t, k)));
        self.set_triangle(t, [a, b, x]);
        let u = self.push_triangle([b, c, x]);
        let w = self.push_triangle([c, a, x]);
        for (i, outer) in [(t, ab), (u, bc), (w, ca)] {
            self.join(of(i, 0), outer);
        }
        self.join(of(t, 1), Some(of(u, 2)));
        self.join(of(u, 1), Some(of(w, 2)));
        self.join(of(w, 1), Some(of(t, 2)));
        x
    }

    /// Replaces the edge of `h` by the other diagonal of its two triangles, if that is an edge yet
    /// unknown.
    pub(super) fn flip(&mut self, h: HalfEdgeId) -> bool {
        let Some(g) = self.twin(h) else { return false };
        let (a, b, o, p) = (self.from(h), self.to(h), self.apex(h), self.apex(g));
        if o == p || self.edge(o, p).is_some() {
            return false;
        }
        let (bo, oa) = (self.twin(h.next()), self.twin(h.prev()));
        let (ap, pb) = (self.twin(g.next()), self.twin(g.prev()));
        let (t, u) = (h.triangle(), g.triangle());
        let of = HalfEdgeId::of;
        self.set_triangle(t, [a, p, o]);
        self.set_triangle(u, [p, b, o]);
        self.join(of(t, 0), ap);
        self.join(of(t, 1), Some(of(u, 2)));
        self.join(of(t, 2), oa);
        self.join(of(u, 0), pb);
        self.join(of(u, 1), bo);
        true
    }

    /// Whether `v` may move to `place` without spoiling the triangles round it: none turns by more
    /// than 30° or loses more than half of its smallest angle (or of 30°, where it had more).
    pub(super) fn may_move(&self, v: VertexId, place: DVec3) -> bool {
        let enough = 30f64.to_radians();
        self.outgoing(v).into_iter().all(|h| {
            let before = self.corners(h.triangle());
            let mut after = before;
            after[h.corner()] = place;
            let (n, m) = (normal(before), normal(after));
            n.dot(m) > 0.866 * n.length() * m.length()
                && smallest_angle(after) >= 0.5 * smallest_angle(before).min(enough)
        })
    }

    /// Keeps the marked triangles, in their order, and the vertices that they use.
    pub(super) fn retain(&self, keep: &[bool]) -> Self {
        let mut vertex = vec![None; self.points.len()];
        let mut triangle = vec![None; self.triangles.len()];
        let mut count = 0;
        for (i, corners) in self.triangles.iter().enumerate().filter(|&(i, _)| keep[i]) {
            triangle[i] = Some(TriangleId::new(count));
            count += 1;
            for v in corners {
                vertex[v.index()] = Some(VertexId::new(0));
            }
        }
        let mut points = Vec::new();
        for (i, new) in vertex.iter_mut().enumerate() {
            if new.is_some() {
                *new = Some(VertexId::new(points.len()));
                points.push(self.points[i]);
            }
        }
        let mut kept = Self {
            leaving: vec![HalfEdgeId::new(0); points.len()],
            points,
            triangles: Vec::with_capacity(count),
            twins: Vec::with_capacity(3 * count),
        };
        for (i, corners) in self.triangles.iter().enumerate().filter(|&(i, _)| keep[i]) {
            let t = kept.push_triangle(corners.map(|v| vertex[v.index()].unwrap_or(v)));
            for k in 0..3 {
                let twin = self.twins[3 * i + k].and_then(|g| {
                    triangle[g.triangle().index()].map(|u| HalfEdgeId::of(u, g.corner()))
                });
                kept.twins[3 * t.index() + k] = twin;
            }
        }
        kept
    }

    /// Splits the surface along the half-edges marked in `cut` and separates fans that meet in a
    /// vertex only. Triangles keep their order; the first fan of a vertex keeps its index, further
    /// ones come last, ordered by triangle.
    pub(super) fn cut_open(&self, cut: &[bool]) -> Result<Surface, SeamError> {
        let mut points = self.points.clone();
        let mut triangles = self.triangles.clone();
        let mut done = vec![false; self.twins.len()];
        let mut taken = vec![false; self.points.len()];
        let crosses = |h: HalfEdgeId| self.twin(h).filter(|_| !cut[h.index()]);
        for start in (0..self.twins.len()).map(HalfEdgeId::new) {
            if done[start.index()] {
                continue;
            }
            let v = self.from(start);
            let label = if taken[v.index()] {
                points.push(self.point(v));
                VertexId::new(points.len() - 1)
            } else {
                taken[v.index()] = true;
                v
            };
            let mut first = start;
            while let Some(twin) = crosses(first) {
                first = twin.next();
                if first == start {
                    break;
                }
            }
            let mut h = Some(first);
            while let Some(current) = h {
                done[current.index()] = true;
                triangles[current.index() / 3][current.corner()] = label;
                h = crosses(current.prev()).filter(|n| !done[n.index()]);
            }
        }
        Ok(Surface::new(points, triangles)?)
    }
}

/// Normal of a triangle, of twice its area.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Smallest angle of a triangle, in radians; 0 for one without area.
pub(super) fn smallest_angle(p: [DVec3; 3]) -> f64 {
    (0..3)
        .map(|k| angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]))
        .fold(f64::INFINITY, f64::min)
}

/// Angle between two directions, in radians; unlike the arc cosine exact to rounding near 0 and π.
fn angle_between(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length().atan2(u.dot(v))
}
