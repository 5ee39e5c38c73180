//! Draws seams into a triangulation: the automatic one and the designer's.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::carve::{carve, insert, insert_on_boundary};
use super::error::{REACH_MM, SeamError, place};
use super::path::{Path, Space, Taut};
use super::shape::Shape;
use super::triangulation::Triangulation;
use crate::geometry::closest_on_triangle;
use crate::surface::{HalfEdgeId, Surface, TriangleId, VertexId};
use crate::warning::Warning;

/// Distances, in mm, that the automatic seam keeps from cut-outs, the first that leaves a way: the
/// seam allowance and the cut-out's own hem want about 10 mm of fabric between them.
const MARGINS_MM: [f64; 4] = [10.0, 5.0, 2.5, 0.0];

/// Cuts seam after seam into a triangulation.
pub(super) struct Cutter {
    mesh: Triangulation,
    /// Vertices that must not move: those of seams.
    pinned: BTreeSet<VertexId>,
    /// Chains of vertices along which the surface is cut.
    chains: Vec<Vec<VertexId>>,
    /// Mean length of the edges before the first cut, in mm.
    edge: f64,
}

impl Cutter {
    pub(super) fn new(surface: &Surface, shape: &Shape) -> Self {
        let mesh = Triangulation::new(surface);
        Self { edge: mesh.mean_edge(), mesh, pinned: shape.sewn.clone(), chains: Vec::new() }
    }

    pub(super) fn automatic(
        &mut self,
        shape: &Shape,
        ends: [usize; 2],
    ) -> Result<Warning, SeamError> {
        let cut_outs: Vec<VertexId> = (0..shape.loops.len())
            .filter(|i| !ends.contains(i))
            .flat_map(|i| shape.loops[i].iter().copied())
            .collect();
        let [proximal, distal] = ends.map(|i| &shape.loops[i][..]);
        for margin in MARGINS_MM {
            let space = Space::new(&self.mesh, self.within(&cut_outs, margin), self.edge);
            let Some((path, taut)) = space.across(proximal, distal)? else { continue };
            self.carve(&path, &taut)?;
            let chain = &self.chains[self.chains.len() - 1];
            let [first, last] = [chain.first(), chain.last()]
                .map(|v| v.map_or(DVec3::ZERO, |&v| self.mesh.point(v)));
            return Ok(Warning::at(
                "seam_automatic",
                format!(
                    "the seam was placed automatically: the shortest way along the limb, {:.0} mm \
                     from ({}) to ({}); to have it elsewhere, draw a seam",
                    taut.length,
                    place(first),
                    place(last)
                ),
                first,
            ));
        }
        let [proximal, distal] = ends.map(|i| shape.middle(self.mesh.points(), i));
        Err(SeamError::NoAutomaticSeam { proximal, distal })
    }

    /// The vertices within `margin` mm of the given ones along edges.
    fn within(&self, vertices: &[VertexId], margin: f64) -> Vec<bool> {
        let mut distance = BTreeMap::new();
        let mut front: Vec<VertexId> = vertices.to_vec();
        for &v in vertices {
            distance.insert(v, 0.0);
        }
        // Few vertices: relaxing again whatever came nearer is quick enough.
        while let Some(v) = front.pop() {
            let own = distance[&v];
            for w in self.mesh.neighbours(v) {
                let next = own + self.mesh.point(v).distance(self.mesh.point(w));
                if next <= margin && distance.get(&w).is_none_or(|&d: &f64| next < d) {
                    distance.insert(w, next);
                    front.push(w);
                }
            }
        }
        let mut result = vec![false; self.mesh.vertex_count()];
        for v in distance.into_keys() {
            result[v.index()] = true;
        }
        result
    }

    fn carve(&mut self, path: &Path, taut: &Taut) -> Result<(), SeamError> {
        let chain = carve(&mut self.mesh, path, taut, &self.pinned)?;
        // Where the new chain crosses an edge of an older one, that edge has become two.
        for old in &mut self.chains {
            let mut i = 0;
            while i + 1 < old.len() {
                let (a, b) = (old[i], old[i + 1]);
                if self.mesh.edge(a, b).is_none() {
                    let joins = |&&x: &&VertexId| {
                        self.mesh.edge(a, x).is_some() && self.mesh.edge(x, b).is_some()
                    };
                    let x = *chain.iter().find(joins).ok_or_else(|| {
                        SeamError::Internal(format!("a seam broke between {a} and {b}"))
                    })?;
                    old.insert(i + 1, x);
                }
                i += 1;
            }
        }
        self.pinned.extend(&chain);
        self.chains.push(chain);
        Ok(())
    }

    pub(super) fn designed(
        &mut self,
        seam: usize,
        points: &[DVec3],
        sewn: &BTreeSet<VertexId>,
    ) -> Result<(), SeamError> {
        if points.len() < 2 {
            return Err(SeamError::SeamTooShort { seam, count: points.len() });
        }
        let mut places = Vec::with_capacity(points.len());
        for (i, &at) in points.iter().enumerate() {
            let (triangle, weights, distance) = self.nearest(at);
            if distance > REACH_MM {
                return Err(SeamError::SeamPointFar { seam, point: i + 1, at, distance });
            }
            let p = self.mesh.corners(triangle);
            places.push(weights.x * p[0] + weights.y * p[1] + weights.z * p[2]);
        }
        let last = points.len() - 1;
        let first_end = self.attach(places[0], sewn);
        let last_end = self.attach(places[last], sewn);
        if first_end.is_none() && last_end.is_none() {
            return Err(SeamError::SeamInside { seam, start: points[0], end: points[last] });
        }
        // The vertices that the seam passes, each with the number of its point.
        let mut stops: Vec<(VertexId, usize)> = Vec::new();
        stops.extend(first_end.map(|v| (v, 1)));
        for (i, &p) in places.iter().enumerate() {
            let end = match i {
                0 => first_end,
                i if i == last => last_end,
                _ => None,
            };
            // A last point beside the edge to which the seam is extended would only kink it.
            if end.is_some_and(|v| self.mesh.point(v).distance(p) < 2.0 * self.edge) {
                continue;
            }
            let (triangle, weights, _) = self.nearest(p);
            let v = insert(&mut self.mesh, triangle, weights, &self.pinned);
            self.pinned.insert(v);
            stops.push((v, i + 1));
        }
        stops.extend(last_end.map(|v| (v, last + 1)));
        stops.dedup_by_key(|stop| stop.0);
        for (i, pair) in stops.windows(2).enumerate() {
            let ((from, point), (to, _)) = (pair[0], pair[1]);
            // Only at its ends may the seam touch the surface's edge.
            let shores = [
                if i == 0 { self.shore(from) } else { Vec::new() },
                if i + 2 == stops.len() { self.shore(to) } else { Vec::new() },
            ];
            let mut forbidden: Vec<bool> = vec![false; self.mesh.vertex_count()];
            for h in (0..self.mesh.half_edge_count()).map(HalfEdgeId::new) {
                if self.mesh.twin(h).is_none() {
                    forbidden[self.mesh.from(h).index()] = true;
                }
            }
            for v in shores.iter().flatten() {
                forbidden[v.index()] = false;
            }
            let space = Space::new(&self.mesh, forbidden, self.edge);
            let Some((path, taut)) = space.between(from, to, [&shores[0], &shores[1]])? else {
                let [from, to] = [from, to].map(|v| self.mesh.point(v));
                return Err(SeamError::NoWay { seam, point, from, to });
            };
            self.carve(&path, &taut)?;
        }
        Ok(())
    }

    /// The nearest place: triangle, barycentric coordinates, distance in mm.
    fn nearest(&self, at: DVec3) -> (TriangleId, DVec3, f64) {
        let mut best = (TriangleId::new(0), DVec3::X, f64::INFINITY);
        for i in 0..self.mesh.triangles().len() {
            let t = TriangleId::new(i);
            let p = self.mesh.corners(t);
            let w = closest_on_triangle(at, p);
            let distance = at.distance(w.x * p[0] + w.y * p[1] + w.z * p[2]);
            if distance < best.2 {
                best = (t, w, distance);
            }
        }
        best
    }

    /// The vertex at which a seam with an end here begins: on the nearest edge of the surface, or
    /// on an earlier seam; `None` if neither is within reach.
    fn attach(&mut self, at: DVec3, sewn: &BTreeSet<VertexId>) -> Option<VertexId> {
        let mut best: Option<(f64, HalfEdgeId, f64)> = None;
        for h in (0..self.mesh.half_edge_count()).map(HalfEdgeId::new) {
            let (a, b) = (self.mesh.from(h), self.mesh.to(h));
            // The sides of a seam are no edge of the brace.
            if self.mesh.twin(h).is_some() || (sewn.contains(&a) && sewn.contains(&b)) {
                continue;
            }
            let (p, q) = (self.mesh.point(a), self.mesh.point(b));
            let part = ((at - p).dot(q - p) / (q - p).length_squared()).clamp(0.0, 1.0);
            let distance = at.distance(p.lerp(q, part));
            if distance <= REACH_MM && best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, h, part));
            }
        }
        if let Some((_, h, part)) = best {
            let v = insert_on_boundary(&mut self.mesh, h, part, &self.pinned);
            self.pinned.insert(v);
            return Some(v);
        }
        let mut near: Option<(f64, VertexId)> = None;
        for &v in self.chains.iter().flatten() {
            let distance = at.distance(self.mesh.point(v));
            if distance <= REACH_MM && near.is_none_or(|(least, _)| distance < least) {
                near = Some((distance, v));
            }
        }
        near.map(|(_, v)| v)
    }

    /// The boundary loop through a vertex; empty inside the surface.
    fn shore(&self, v: VertexId) -> Vec<VertexId> {
        let mut around = Vec::new();
        let mut next = self.mesh.boundary_after(v);
        while let Some(h) = next {
            around.push(self.mesh.from(h));
            let to = self.mesh.to(h);
            next = self.mesh.boundary_after(to).filter(|_| to != v);
        }
        around
    }

    pub(super) fn cut(&self) -> Result<Surface, SeamError> {
        let mut cut = vec![false; self.mesh.half_edge_count()];
        for pair in self.chains.iter().flat_map(|chain| chain.windows(2)) {
            let h = self.mesh.edge(pair[0], pair[1]).ok_or_else(|| {
                SeamError::Internal(format!("no edge between {} and {}", pair[0], pair[1]))
            })?;
            cut[h.index()] = true;
            if let Some(g) = self.mesh.twin(h) {
                cut[g.index()] = true;
            }
        }
        self.mesh.cut_open(&cut)
    }
}
