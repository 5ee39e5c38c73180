//! Shortest paths on a surface as straight curves through triangles.
//!
//! Dijkstra's path along edges is the start. It is widened to the strip of triangles beside it,
//! the strip is unfolded into the plane and the shortest path within it pulled taut (the funnel of
//! Lee & Preparata 1984). Where the taut path bends round a vertex with less than π on the other
//! side, the strip is led round that other side, until nothing changes: the condition of a
//! geodesic as in Xin & Wang, *Efficiently determining a locally exact shortest path on polyhedral
//! surfaces* (2007), and Sharp & Crane, *You can find geodesic paths in triangle meshes by just
//! flipping edges* (2020). An end on the boundary then slides along it to where the path is
//! shortest. Limit: the result is locally shortest, in the neighbourhood of the edge path.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

use glam::DVec2;

use super::error::SeamError;
use super::strip::{Shapes, parts, pull, reduce};
use super::triangulation::Triangulation;
use crate::surface::{HalfEdgeId, TriangleId, VertexId};

/// Least turn that counts as a bend, in radians: 1e-7 over a limb of 1 m is 0.1 µm.
const STRAIGHT: f64 = 1e-7;

/// An end of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    /// At a vertex.
    Vertex(VertexId),
    /// On a boundary half-edge, this part of the way from its start, strictly inside it.
    Boundary(HalfEdgeId, f64),
}

/// A path as the strip of triangles that it runs through: the half-edges that it crosses, from the
/// half-edge's own triangle to its twin's.
#[derive(Debug, Clone)]
pub(super) struct Path {
    pub(super) start: End,
    pub(super) end: End,
    pub(super) crossings: Vec<HalfEdgeId>,
}

/// A vertex at which a taut path bends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bend {
    pub(super) vertex: VertexId,
    /// The vertex lies on the left of the path.
    pub(super) left: bool,
    /// The crossings, in a row, of edges at this vertex: first and last.
    pub(super) first: usize,
    pub(super) last: usize,
    /// By how much the path turns, in radians.
    pub(super) turn: f64,
}

/// The shortest path within a strip.
#[derive(Debug, Clone)]
pub(super) struct Taut {
    pub(super) length: f64,
    /// Where each crossed half-edge is crossed, as the part of the way from its start; known of a
    /// finished path alone.
    pub(super) parts: Vec<f64>,
    pub(super) bends: Vec<Bend>,
    /// The last straight piece, unfolded, and the unit direction of the boundary half-edge at the
    /// end, if the end is on one.
    pub(super) arrival: DVec2,
    pub(super) shore: Option<DVec2>,
}

/// Where paths may run.
pub(super) struct Space<'a> {
    pub(super) mesh: &'a Triangulation,
    /// Vertices that no triangle of a path may touch.
    pub(super) forbidden: Vec<bool>,
    /// Mean length of the edges, in mm.
    pub(super) edge: f64,
    shapes: Shapes<'a>,
}

impl<'a> Space<'a> {
    pub(super) fn new(mesh: &'a Triangulation, forbidden: Vec<bool>, edge: f64) -> Self {
        Self { mesh, forbidden, edge, shapes: Shapes::new(mesh) }
    }

    fn allowed(&self, t: TriangleId) -> bool {
        self.mesh.triangles()[t.index()].iter().all(|v| !self.forbidden[v.index()])
    }

    /// The straight path from vertex to vertex; `None` if there is no way. Where it touches the
    /// boundary loop of an end (`shores`) before that end, it begins or ends there.
    pub(super) fn between(
        &self,
        from: VertexId,
        to: VertexId,
        shores: [&[VertexId]; 2],
    ) -> Result<Option<(Path, Taut)>, SeamError> {
        let Some(vertices) = self.along_edges(&[from], &[to], &[from, to]) else {
            return Ok(None);
        };
        let mut path = self.widen(&vertices)?;
        let mut taut = self.tighten(&mut path)?;
        self.trim(&mut path, &mut taut, shores[1])?;
        self.reverse(&mut path)?;
        taut = self.tighten(&mut path)?;
        self.trim(&mut path, &mut taut, shores[0])?;
        self.reverse(&mut path)?;
        self.finish(path)
    }

    /// The straight path between two boundary loops that starts from the shortest edge path, its
    /// ends slid along the loops; `None` if there is no way.
    pub(super) fn across(
        &self,
        from: &[VertexId],
        to: &[VertexId],
    ) -> Result<Option<(Path, Taut)>, SeamError> {
        let Some(vertices) = self.along_edges(from, to, &[]) else { return Ok(None) };
        let mut path = self.widen(&vertices)?;
        let mut taut = self.tighten(&mut path)?;
        // Each end in turn; two or three rounds do, unless both ends follow one another.
        for _ in 0..20 {
            let before = taut.length;
            self.slide_end(&mut path, &mut taut, to)?;
            self.reverse(&mut path)?;
            self.slide_end(&mut path, &mut taut, from)?;
            self.reverse(&mut path)?;
            if taut.length > before * (1.0 - 1e-9) {
                break;
            }
        }
        self.finish(path)
    }

    /// Dijkstra's shortest path over edges. Lengths are whole numbers, so that equal paths stay
    /// equal when the limb is turned in space; ties go to the lowest index. `ends` may lie beside what is
    /// forbidden: a path has a strip of triangles beside it only between its ends.
    fn along_edges(
        &self,
        from: &[VertexId],
        to: &[VertexId],
        ends: &[VertexId],
    ) -> Option<Vec<VertexId>> {
        let mesh = self.mesh;
        let count = mesh.vertex_count();
        // The strip beside the path takes in the neighbours' triangles.
        let mut blocked = self.forbidden.clone();
        for corners in mesh.triangles() {
            if corners.iter().any(|v| self.forbidden[v.index()]) {
                for v in corners {
                    blocked[v.index()] = true;
                }
            }
        }
        for v in ends {
            blocked[v.index()] = self.forbidden[v.index()];
        }
        let mut target = vec![false; count];
        for v in to {
            target[v.index()] = true;
        }
        let mut best = vec![u64::MAX; count];
        let mut parent: Vec<Option<VertexId>> = vec![None; count];
        let mut settled = vec![false; count];
        let mut heap = BinaryHeap::new();
        for &v in from {
            if !blocked[v.index()] {
                best[v.index()] = 0;
                heap.push(Reverse((0, v)));
            }
        }
        while let Some(Reverse((distance, v))) = heap.pop() {
            if std::mem::replace(&mut settled[v.index()], true) {
                continue;
            }
            if target[v.index()] {
                let mut path = vec![v];
                while let Some(p) = parent[path[path.len() - 1].index()] {
                    path.push(p);
                }
                path.reverse();
                return Some(path);
            }
            for w in mesh.neighbours(v) {
                if settled[w.index()] || blocked[w.index()] {
                    continue;
                }
                let length = mesh.point(v).distance(mesh.point(w)) / self.edge;
                let next = distance + (length * 1e6).round() as u64;
                let known = best[w.index()];
                if next < known || (next == known && parent[w.index()].is_some_and(|p| v < p)) {
                    best[w.index()] = next;
                    parent[w.index()] = Some(v);
                    heap.push(Reverse((next, w)));
                }
            }
        }
        None
    }

    /// The strip beside a path of edges, at each inner vertex on the side of the smaller angle.
    fn widen(&self, vertices: &[VertexId]) -> Result<Path, SeamError> {
        let broken = || SeamError::Internal("the edge path is broken".to_owned());
        let (Some(&first), Some(&last)) = (vertices.first(), vertices.last()) else {
            return Err(broken());
        };
        let mut crossings: Vec<HalfEdgeId> = Vec::new();
        let mut was_left: Option<bool> = None;
        for around in vertices.windows(3) {
            let [before, v, after] = [around[0], around[1], around[2]];
            let sides = [self.fan(before, v, after, true), self.fan(before, v, after, false)];
            let [left, right] = sides;
            let is_left = match (&left, &right) {
                (Some((_, l)), Some((_, r))) => l <= r,
                (Some(_), None) => true,
                (None, Some(_)) => false,
                (None, None) => return Err(broken()),
            };
            if was_left.is_some_and(|was| was != is_left) {
                let (a, b) = if is_left { (v, before) } else { (before, v) };
                crossings.push(self.mesh.half_edge(a, b).ok_or_else(broken)?);
            }
            let fan = if is_left { left } else { right };
            crossings.extend(fan.ok_or_else(broken)?.0);
            was_left = Some(is_left);
        }
        Ok(Path { start: End::Vertex(first), end: End::Vertex(last), crossings })
    }

    /// The edges at `v` crossed when passing it on one side from `before` to `after`, and the
    /// angle there; `None` if the boundary or a forbidden triangle is in the way.
    fn fan(
        &self,
        before: VertexId,
        v: VertexId,
        after: VertexId,
        left: bool,
    ) -> Option<(Vec<HalfEdgeId>, f64)> {
        let mesh = self.mesh;
        let mut crossings = Vec::new();
        let mut angle = 0.0;
        let entry = if left { mesh.half_edge(before, v)? } else { mesh.half_edge(v, before)? };
        let mut h = if left { entry.next() } else { entry.prev() };
        loop {
            if !self.allowed(h.triangle()) {
                return None;
            }
            angle += mesh.angle(if left { h } else { h.next() });
            if (if left { mesh.to(h) } else { mesh.from(h) }) == after {
                return Some((crossings, angle));
            }
            crossings.push(h);
            let twin = mesh.twin(h)?;
            h = if left { twin.next() } else { twin.prev() };
        }
    }

    /// The path at its end, with all that is to be known of it.
    fn finish(&self, mut path: Path) -> Result<Option<(Path, Taut)>, SeamError> {
        let mut taut = self.tighten(&mut path)?;
        taut.parts = parts(&self.shapes, &path)?;
        Ok(Some((path, taut)))
    }

    /// Pulls the path taut and leads it round vertices until it is straight.
    fn tighten(&self, path: &mut Path) -> Result<Taut, SeamError> {
        reduce(self.mesh, path);
        let mut taut = pull(&self.shapes, path)?;
        // Leading round a vertex always shortens; rounding alone could go on without end.
        let mut idle = 0;
        while idle < 8 && self.lead_round(path, &taut.bends) {
            reduce(self.mesh, path);
            let next = pull(&self.shapes, path)?;
            idle = if next.length < taut.length * (1.0 - 1e-14) { 0 } else { idle + 1 };
            taut = next;
        }
        Ok(taut)
    }

    /// Leads the strip round the other side of every vertex with less than π there; whether any.
    fn lead_round(&self, path: &mut Path, bends: &[Bend]) -> bool {
        let mut crossings = Vec::with_capacity(path.crossings.len());
        let mut copied = 0;
        let mut changed = false;
        for bend in bends {
            // A bend whose strip was changed in this pass waits for the next one.
            if (changed && bend.first <= copied) || bend.turn < STRAIGHT {
                continue;
            }
            let other_side = self.mesh.total_angle(bend.vertex) - PI - bend.turn;
            if other_side > PI - STRAIGHT {
                continue;
            }
            let entry = path.crossings[bend.first].triangle();
            let Some(exit) = self.mesh.twin(path.crossings[bend.last]) else { continue };
            if let Some(fan) = self.turn(bend.vertex, entry, exit.triangle(), !bend.left) {
                crossings.extend_from_slice(&path.crossings[copied..bend.first]);
                crossings.extend(fan);
                copied = bend.last + 1;
                changed = true;
            }
        }
        crossings.extend_from_slice(&path.crossings[copied..]);
        path.crossings = crossings;
        changed
    }

    /// The edges at `v` crossed when turning from one of its triangles to another, `v` on the left
    /// (counter-clockwise) or on the right.
    fn turn(
        &self,
        v: VertexId,
        entry: TriangleId,
        exit: TriangleId,
        left: bool,
    ) -> Option<Vec<HalfEdgeId>> {
        let mesh = self.mesh;
        let corner = mesh.triangles()[entry.index()].iter().position(|&w| w == v)?;
        let out = HalfEdgeId::of(entry, corner);
        let mut h = if left { out.prev() } else { out };
        let mut crossings = Vec::new();
        while h.triangle() != exit {
            crossings.push(h);
            let twin = mesh.twin(h)?;
            if !self.allowed(twin.triangle()) || twin.triangle() == entry {
                return None;
            }
            h = if left { twin.prev() } else { twin.next() };
        }
        Some(crossings)
    }

    fn reverse(&self, path: &mut Path) -> Result<(), SeamError> {
        std::mem::swap(&mut path.start, &mut path.end);
        path.crossings.reverse();
        for h in &mut path.crossings {
            *h = self
                .mesh
                .twin(*h)
                .ok_or_else(|| SeamError::Internal("a path crosses the boundary".to_owned()))?;
        }
        Ok(())
    }

    /// Slides the path's end along the boundary loop with the vertices `shore` to where the path
    /// is shortest. The foot of the perpendicular, unfolded, is the first try; where the boundary
    /// is not straight enough for it, steps to either side that grow and shrink.
    fn slide_end(
        &self,
        path: &mut Path,
        taut: &mut Taut,
        shore: &[VertexId],
    ) -> Result<(), SeamError> {
        *taut = self.tighten(path)?;
        self.trim(path, taut, shore)?;
        let finest = 1e-4 * self.edge;
        let mut step = self.edge;
        for _ in 0..500 {
            if step < finest || path.crossings.is_empty() {
                break;
            }
            let foot = taut.shore.map(|along| -taut.arrival.dot(along));
            let mut moved = false;
            for (by, grows) in
                foot.map(|by| (by, false)).into_iter().chain([(step, true), (-step, true)])
            {
                if by.abs() < 1e-3 * finest {
                    continue;
                }
                let Some(mut trial) = self.slid(path, by) else { continue };
                let mut pulled = self.tighten(&mut trial)?;
                self.trim(&mut trial, &mut pulled, shore)?;
                if pulled.length < taut.length * (1.0 - 1e-12) {
                    (*path, *taut) = (trial, pulled);
                    moved = true;
                    if grows {
                        step *= 2.0;
                    }
                    break;
                }
            }
            if !moved {
                step /= 4.0;
            }
        }
        Ok(())
    }

    /// Ends the path where it first touches the loop on which it is to end.
    fn trim(&self, path: &mut Path, taut: &mut Taut, shore: &[VertexId]) -> Result<(), SeamError> {
        while let Some(&touch) = taut.bends.iter().find(|bend| shore.contains(&bend.vertex)) {
            path.crossings.truncate(touch.first);
            path.end = End::Vertex(touch.vertex);
            *taut = self.tighten(path)?;
        }
        Ok(())
    }

    /// The path with its end moved along the boundary, `by` mm in the boundary's direction.
    fn slid(&self, path: &Path, by: f64) -> Option<Path> {
        let mesh = self.mesh;
        let mut moved = path.clone();
        let forward = by >= 0.0;
        let mut rest = by.abs();
        // `h` and the part of it that lies behind the end.
        let (mut h, mut behind) = match path.end {
            End::Boundary(h, part) => (h, if forward { part } else { 1.0 - part }),
            End::Vertex(v) => {
                let t = mesh.twin(*path.crossings.last()?)?.triangle();
                let corner = mesh.triangles()[t.index()].iter().position(|&w| w == v)?;
                let out = HalfEdgeId::of(t, corner);
                (self.to_shore(if forward { out } else { out.prev() }, forward, &mut moved)?, 0.0)
            }
        };
        loop {
            let length = mesh.length(h);
            let ahead = (1.0 - behind) * length;
            if rest < ahead {
                let part = behind + rest / length;
                let part = if forward { part } else { 1.0 - part };
                moved.end = if part < 1e-9 {
                    End::Vertex(mesh.from(h))
                } else if part > 1.0 - 1e-9 {
                    End::Vertex(mesh.to(h))
                } else {
                    End::Boundary(h, part)
                };
                return Some(moved);
            }
            rest -= ahead;
            h = self.to_shore(if forward { h.next() } else { h.prev() }, forward, &mut moved)?;
            behind = 0.0;
        }
    }

    /// Turns round a vertex, clockwise (`forward`) or back, until the boundary.
    fn to_shore(&self, mut h: HalfEdgeId, forward: bool, path: &mut Path) -> Option<HalfEdgeId> {
        while let Some(twin) = self.mesh.twin(h) {
            if !self.allowed(twin.triangle()) {
                return None;
            }
            path.crossings.push(h);
            h = if forward { twin.next() } else { twin.prev() };
        }
        Some(h)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::fixtures::{Mesh, Noise, cylinder, strip, surface};
    use super::*;

    fn nearest(mesh: &Triangulation, p: DVec3) -> VertexId {
        let distance = |v: &VertexId| mesh.point(*v).distance(p);
        let all = (0..mesh.vertex_count()).map(VertexId::new);
        all.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()
    }

    fn length(mesh: &Triangulation, from: VertexId, to: VertexId) -> f64 {
        let space = Space::new(mesh, vec![false; mesh.vertex_count()], mesh.mean_edge());
        let (path, taut) = space.between(from, to, [&[], &[]]).unwrap().unwrap();
        assert_eq!(path.crossings.len(), taut.parts.len());
        taut.length
    }

    #[test]
    fn in_the_plane_every_path_is_the_straight_line() {
        // A strip with its inner vertices moved at random.
        let s = strip(80.0, 300.0);
        let mut noise = Noise(5);
        let shift = |(i, p): (usize, &DVec3)| {
            let by = DVec3::new(1.2 * noise.next(), 1.8 * noise.next(), 0.0);
            if s.is_boundary_vertex(VertexId::new(i)) { *p } else { *p + by }
        };
        let points = s.points().iter().enumerate().map(shift).collect();
        let mesh = Triangulation::new(&s.with_points(points));
        let mut noise = Noise(9);
        for _ in 0..60 {
            let mut any = || VertexId::new(((noise.next() + 1.0) * 535.0) as usize);
            let (a, b) = (any(), any());
            if a != b {
                let exact = mesh.point(a).distance(mesh.point(b));
                let found = length(&mesh, a, b);
                assert!((found - exact).abs() < 1e-9 * exact, "{a} {b} {found} {exact}");
            }
        }
    }

    #[test]
    fn across_a_cube_from_corner_to_corner_it_is_the_root_of_five() {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
        let s = surface(
            (0..8).map(corner).collect(),
            &[
                [0, 2, 3],
                [0, 3, 1],
                [4, 5, 7],
                [4, 7, 6],
                [0, 1, 5],
                [0, 5, 4],
                [2, 6, 7],
                [2, 7, 3],
                [0, 4, 6],
                [0, 6, 2],
                [1, 3, 7],
                [1, 7, 5],
            ],
        );
        let found = length(&Triangulation::new(&s), VertexId::new(0), VertexId::new(7));
        assert!((found - 5f64.sqrt()).abs() < 1e-12, "{found}");
    }

    #[test]
    fn round_a_cylinder_it_is_a_helix() {
        for mesh in Mesh::ALL {
            let mesh = Triangulation::new(&cylinder(40.0, 200.0, mesh));
            let a = nearest(&mesh, DVec3::new(40.0, 0.0, 20.0));
            let b = nearest(&mesh, DVec3::new(-20.0, 34.0, 170.0));
            let (p, q) = (mesh.point(a), mesh.point(b));
            let turn = q.y.atan2(q.x) - p.y.atan2(p.x);
            let exact = f64::hypot(40.0 * turn, q.z - p.z);
            let found = length(&mesh, a, b);
            // The polyhedron is inscribed: chords are shorter than arcs by (π / 48)² / 6 = 0.07 %.
            assert!((found / exact - 1.0).abs() < 1e-3, "{found} {exact}");
        }
    }

    #[test]
    fn it_goes_round_what_is_forbidden_or_says_that_there_is_no_way() {
        let mesh = Triangulation::new(&strip(80.0, 300.0));
        let (a, b) = (
            nearest(&mesh, DVec3::new(40.0, 60.0, 0.0)),
            nearest(&mesh, DVec3::new(40.0, 240.0, 0.0)),
        );
        let wall = |reach: f64| -> Vec<bool> {
            mesh.points().iter().map(|p| (p.y - 150.0).abs() < 1.0 && p.x < reach).collect()
        };
        let found =
            Space::new(&mesh, wall(50.0), 6.0).between(a, b, [&[], &[]]).unwrap().unwrap().1;
        // The triangles at the wall's last vertex (48, 150) reach to (52, 150) and (52, 156).
        let exact = f64::hypot(12.0, 90.0) + 6.0 + f64::hypot(12.0, 84.0);
        assert!((found.length - exact).abs() < 1e-9, "{} {exact}", found.length);
        assert!(Space::new(&mesh, wall(90.0), 6.0).between(a, b, [&[], &[]]).unwrap().is_none());
    }
}
