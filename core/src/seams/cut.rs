//! Cuts a tube open into a disk, along smooth curves through the triangles.
//!
//! The automatic seam is the shortest straight path between the tube's two end loops; a designer's
//! seam joins the given points by straight paths. Each is carved into the triangulation and cut.
//! Limits: planar surfaces only (no handles), and a path is locally shortest.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::carve::{carve, insert, insert_on_boundary};
use super::error::{REACH_MM, SeamError, place};
use super::path::{Path, Space, Taut};
use super::sewing::{Seam, Sewing};
use super::triangulation::Triangulation;
use crate::geometry::closest_on_triangle;
use crate::surface::{HalfEdgeId, Surface, TriangleId, VertexId};
use crate::warning::Warning;

/// Distances, in mm, that the automatic seam keeps from cut-outs, the first that leaves a way: the
/// seam allowance and the cut-out's own hem want about 10 mm of fabric between them.
const MARGINS_MM: [f64; 4] = [10.0, 5.0, 2.5, 0.0];

/// A ring counts as a flat piece with a cut-out, not as a tube, if its edges turn by more than
/// this part of a full turn: it then lies flat with less than 10 % of strain around.
const FLAT_RING: f64 = 0.9;

/// A surface cut open to a disk, perhaps with cut-outs.
#[derive(Debug, Clone, PartialEq)]
pub struct CutSurface {
    /// The disk, in mm. Its first triangles are those of the surface in their order, split where a
    /// seam runs; a vertex cut in two keeps its index on one side.
    pub disk: Surface,
    /// What is sewn together again.
    pub seams: Vec<Seam>,
    /// The two ends of the limb, if the sewn surface is a tube.
    pub ends: Option<Ends>,
    /// What the designer should know.
    pub warnings: Vec<Warning>,
}

/// The two ends of a cut tube: the edges of the brace that go round the limb.
///
/// Each is a run of boundary vertices of the disk in the boundary's direction (the surface on the
/// left), from one copy of a seam's end to the other. Where another seam begins in between, both
/// copies of its end are listed.
#[derive(Debug, Clone, PartialEq)]
pub struct Ends {
    /// The end near the body: of the two longest edges the longer.
    pub proximal: Vec<VertexId>,
    /// The far end.
    pub distal: Vec<VertexId>,
    /// Girths of the proximal and the distal end, in mm.
    pub girths: [f64; 2],
}

impl CutSurface {
    /// The same cut with the end nearer to `marker` as the proximal one, and the seams in order
    /// from there.
    #[must_use]
    pub fn with_proximal_at(mut self, marker: DVec3) -> Self {
        let Some(ends) = &mut self.ends else { return self };
        let gap = |end: &[VertexId]| {
            end.iter().map(|&v| self.disk.point(v).distance(marker)).fold(f64::INFINITY, f64::min)
        };
        if gap(&ends.distal) < gap(&ends.proximal) {
            std::mem::swap(&mut ends.proximal, &mut ends.distal);
            ends.girths.reverse();
            self.seams = self.seams.into_iter().map(Seam::reversed).collect();
        }
        self
    }
}

/// Cuts the surface open: a disk is taken as it is unless there are `seams`; a tube is cut along
/// them, polylines of points in mm near the surface, or where there are none along its shortest
/// straight seam. The two longest edges of a tube are its ends, further ones stay as cut-outs.
///
/// # Errors
/// If the surface is closed or has handles, if a seam's point is far from it, or if the seams do
/// not leave one piece that is open from end to end.
pub fn open_to_disk(surface: &Surface, seams: &[Vec<DVec3>]) -> Result<CutSurface, SeamError> {
    let shape = Shape::of(surface)?;
    let mut warnings = shape.warnings.clone();
    if seams.is_empty() && shape.tube.is_none() {
        return finish(surface.clone(), &shape, warnings);
    }
    let mut cutter = Cutter {
        mesh: Triangulation::new(surface),
        pinned: shape.sewn.clone(),
        chains: Vec::new(),
    };
    if let (true, Some(ends)) = (seams.is_empty(), shape.tube) {
        warnings.push(cutter.automatic(&shape, ends)?);
    }
    for (i, seam) in seams.iter().enumerate() {
        cutter.designed(i + 1, seam, &shape.sewn)?;
    }
    finish(cutter.cut()?, &shape, warnings)
}

/// What the surface is before it is cut.
struct Shape {
    /// The boundary loops of the sewn surface, as vertices.
    loops: Vec<Vec<VertexId>>,
    lengths: Vec<f64>,
    /// The loop of each vertex.
    loop_of: Vec<Option<usize>>,
    /// The two ends, longer first, if the sewn surface is a tube.
    ends: Option<[usize; 2]>,
    /// The same, if it has yet to be cut.
    tube: Option<[usize; 2]>,
    /// Vertices on sides that are sewn already; they must not part.
    sewn: BTreeSet<VertexId>,
    warnings: Vec<Warning>,
}

impl Shape {
    fn of(surface: &Surface) -> Result<Self, SeamError> {
        let pieces = surface.components().1;
        if pieces != 1 {
            return Err(SeamError::Internal(format!("a surface of {pieces} pieces is to be cut")));
        }
        let boundary = i64::try_from(surface.boundary_loops().len()).unwrap_or(i64::MAX);
        let genus = (2 - boundary - surface.euler_characteristic()) / 2;
        if genus > 0 {
            let centre = surface.points().iter().sum::<DVec3>() / surface.vertex_count() as f64;
            return Err(SeamError::Handles { genus, centre });
        }
        if boundary == 0 {
            return Err(SeamError::Closed);
        }
        let sewing = Sewing::new(surface);
        let around = sewing.sewn_loops();
        let lengths: Vec<f64> =
            around.iter().map(|l| l.iter().map(|&h| surface.length(h)).sum()).collect();
        let loops: Vec<Vec<VertexId>> =
            around.iter().map(|l| l.iter().map(|&h| surface.from(h)).collect()).collect();
        let mut loop_of = vec![None; surface.vertex_count()];
        for (i, vertices) in loops.iter().enumerate() {
            for v in vertices {
                loop_of[v.index()] = Some(i);
            }
        }
        let sewn = surface
            .half_edges()
            .filter(|&h| sewing.partner(h).is_some())
            .flat_map(|h| [surface.from(h), surface.to(h)])
            .collect();
        let mut shape =
            Self { loops, lengths, loop_of, ends: None, tube: None, sewn, warnings: Vec::new() };
        let mut order: Vec<usize> = (0..shape.loops.len()).collect();
        order.sort_by(|&a, &b| shape.lengths[b].total_cmp(&shape.lengths[a]).then(a.cmp(&b)));
        if let [proximal, distal, ..] = order[..] {
            let ends = [proximal, distal];
            if same_edge(surface, around[proximal][0], around[distal][0]) {
                shape.ends = Some(ends);
            } else if shape.is_flat_ring(surface, &around, ends) {
                shape.warnings.push(Warning::new(
                    "taken_as_patch",
                    format!(
                        "the surface is taken as a flat piece with {} cut-out{}, not as a tube; if \
                         it goes round a limb, give a seam from its inner to its outer edge",
                        order.len() - 1,
                        if order.len() > 2 { "s" } else { "" }
                    ),
                ));
            } else {
                shape.ends = Some(ends);
                shape.tube = Some(ends);
            }
        }
        Ok(shape)
    }

    /// Whether the outer edge turns nearly once round as a disk's does and the inner one nearly
    /// once back, as a cut-out's does; the edges of a tube do not turn (Gauss–Bonnet).
    fn is_flat_ring(
        &self,
        surface: &Surface,
        around: &[Vec<HalfEdgeId>],
        ends: [usize; 2],
    ) -> bool {
        let turn = |i: usize| -> f64 {
            around[i]
                .iter()
                .map(|&h| {
                    let fan = surface.outgoing(surface.from(h));
                    PI - fan.map(|k| corner_angle(surface, k)).sum::<f64>()
                })
                .sum()
        };
        turn(ends[0]) > FLAT_RING * TAU && turn(ends[1]) < -FLAT_RING * TAU
    }

    fn middle(&self, surface: &[DVec3], i: usize) -> DVec3 {
        let vertices = &self.loops[i];
        vertices.iter().map(|v| surface[v.index()]).sum::<DVec3>() / vertices.len() as f64
    }
}

fn corner_angle(surface: &Surface, h: HalfEdgeId) -> f64 {
    let at = surface.point(surface.from(h));
    let (u, v) = (surface.point(surface.to(h)) - at, surface.point(surface.from(h.prev())) - at);
    u.cross(v).length().atan2(u.dot(v))
}

/// Whether two boundary half-edges lie on one boundary loop.
fn same_edge(surface: &Surface, a: HalfEdgeId, b: HalfEdgeId) -> bool {
    surface.boundary_loops().iter().any(|l| l.half_edges.contains(&a) && l.half_edges.contains(&b))
}

/// Cuts seam after seam into a triangulation.
struct Cutter {
    mesh: Triangulation,
    /// Vertices that must not move: those of seams.
    pinned: BTreeSet<VertexId>,
    /// Chains of vertices along which the surface is cut.
    chains: Vec<Vec<VertexId>>,
}

impl Cutter {
    fn automatic(&mut self, shape: &Shape, ends: [usize; 2]) -> Result<Warning, SeamError> {
        let cut_outs: Vec<VertexId> = (0..shape.loops.len())
            .filter(|i| !ends.contains(i))
            .flat_map(|i| shape.loops[i].iter().copied())
            .collect();
        let [proximal, distal] = ends.map(|i| &shape.loops[i][..]);
        for margin in MARGINS_MM {
            let space = Space::new(&self.mesh, self.within(&cut_outs, margin));
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

    fn designed(
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
            if !(distance <= REACH_MM) {
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
        let edge = Space::new(&self.mesh, Vec::new()).edge;
        let mut stops: Vec<(VertexId, usize)> = Vec::new();
        stops.extend(first_end.map(|v| (v, 1)));
        for (i, &p) in places.iter().enumerate() {
            let end = match i {
                0 => first_end,
                i if i == last => last_end,
                _ => None,
            };
            // A last point beside the edge to which the seam is extended would only kink it.
            if end.is_some_and(|v| self.mesh.point(v).distance(p) < 2.0 * edge) {
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
            let space = Space::new(&self.mesh, forbidden);
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

    fn cut(&self) -> Result<Surface, SeamError> {
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

/// Checks the cut surface and finds its seams and ends.
fn finish(disk: Surface, shape: &Shape, warnings: Vec<Warning>) -> Result<CutSurface, SeamError> {
    one_piece(&disk)?;
    let sewing = Sewing::new(&disk);
    let around = sewing.sewn_loops();
    // The loops of the sewn surface are those from before; every one has vertices from then.
    let old = |l: &[HalfEdgeId]| {
        l.iter().find_map(|&h| shape.loop_of.get(disk.from(h).index()).copied().flatten())
    };
    let find = |i: usize| around.iter().find(|l| old(l) == Some(i));
    let mut ends = None;
    if let Some([proximal, distal]) = shape.ends {
        let lost = || SeamError::Internal("an end of the tube is lost in the cut".to_owned());
        let (p, d) = (find(proximal).ok_or_else(lost)?, find(distal).ok_or_else(lost)?);
        if !same_edge(&disk, p[0], d[0]) {
            let middles = [proximal, distal].map(|i| shape.middle(disk.points(), i));
            let uncut = [p, d].map(|l| run(&disk, l).1);
            return Err(match uncut {
                [false, false] => {
                    SeamError::EndsNotJoined { proximal: middles[0], distal: middles[1] }
                }
                [true, _] => {
                    SeamError::EndNotReached { girth: shape.lengths[proximal], near: middles[0] }
                }
                [_, true] => {
                    SeamError::EndNotReached { girth: shape.lengths[distal], near: middles[1] }
                }
            });
        }
        ends = Some(Ends {
            proximal: run(&disk, p).0,
            distal: run(&disk, d).0,
            girths: [p, d].map(|l| l.iter().map(|&h| disk.length(h)).sum()),
        });
    }
    let seams = sewing.seams().into_iter().map(|seam| direct(&disk, seam, ends.as_ref())).collect();
    Ok(CutSurface { seams, ends, warnings, disk })
}

/// The vertices along a loop of the sewn surface, beginning where the disk's boundary leaves it;
/// and whether the disk's boundary never does.
fn run(disk: &Surface, around: &[HalfEdgeId]) -> (Vec<VertexId>, bool) {
    let count = around.len();
    let breaks = |i: usize| disk.to(around[(i + count - 1) % count]) != disk.from(around[i]);
    let start = (0..count).find(|&i| breaks(i));
    let mut vertices = Vec::with_capacity(count + 1);
    for i in 0..count {
        let i = (start.unwrap_or(0) + i) % count;
        if vertices.last() != Some(&disk.from(around[i])) {
            vertices.push(disk.from(around[i]));
        }
        vertices.push(disk.to(around[i]));
    }
    (vertices, start.is_none())
}

/// The seam from its proximal end; on a piece without ends from where it opens.
fn direct(disk: &Surface, seam: Seam, ends: Option<&Ends>) -> Seam {
    let (Some(&[first, one]), Some(&[last, other])) = (
        seam.left.first().zip(seam.right.first()).map(|(&a, &b)| [a, b]).as_ref(),
        seam.left.last().zip(seam.right.last()).map(|(&a, &b)| [a, b]).as_ref(),
    ) else {
        return seam;
    };
    let Some(ends) = ends else {
        return if first == one && last != other { seam.reversed() } else { seam };
    };
    let touches = |end: &[VertexId], a: VertexId, b: VertexId| end.contains(&a) || end.contains(&b);
    let backward = if touches(&ends.proximal, first, one) {
        false
    } else if touches(&ends.proximal, last, other) || touches(&ends.distal, first, one) {
        true
    } else if touches(&ends.distal, last, other) {
        false
    } else {
        let sum: DVec3 = ends.proximal.iter().map(|&v| disk.point(v)).sum();
        let middle = sum / ends.proximal.len() as f64;
        disk.point(last).distance(middle) < disk.point(first).distance(middle)
    };
    if backward { seam.reversed() } else { seam }
}

fn one_piece(disk: &Surface) -> Result<(), SeamError> {
    let (component, pieces) = disk.components();
    if pieces == 1 {
        return Ok(());
    }
    let mut area = vec![0.0; pieces];
    let mut middle = vec![DVec3::ZERO; pieces];
    for t in disk.triangle_ids() {
        let c = component[t.index()];
        area[c] += disk.area(t);
        middle[c] += disk.area(t) * disk.corners(t).iter().sum::<DVec3>() / 3.0;
    }
    let least = (0..pieces).fold(0, |best, c| if area[c] < area[best] { c } else { best });
    Err(SeamError::Split { pieces, area: area[least], near: middle[least] / area[least] })
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{
        Mesh, cylinder, cylinder_with_hole, frustum, round, slit_cylinder, sphere, strip, torus,
    };
    use super::super::triangulation::smallest_angle;
    use super::*;

    fn worst(s: &Surface) -> f64 {
        s.triangle_ids().map(|t| smallest_angle(s.corners(t))).fold(f64::INFINITY, f64::min)
    }

    fn length(s: &Surface, chain: &[VertexId]) -> f64 {
        chain.windows(2).map(|w| s.point(w[0]).distance(s.point(w[1]))).sum()
    }

    /// What every cut must keep: pairs coincide, the area stays, the surface is a planar piece.
    fn check(before: &Surface, cut: &CutSurface, loops: usize) {
        let disk = &cut.disk;
        assert_eq!(disk.components().1, 1);
        assert_eq!(disk.boundary_loops().len(), loops);
        assert_eq!(disk.euler_characteristic(), 2 - i64::try_from(loops).unwrap());
        assert!((disk.total_area() / before.total_area() - 1.0).abs() < 1e-3);
        let sewing = Sewing::new(disk);
        let mut pairs = 0;
        for seam in &cut.seams {
            assert_eq!(seam.left.len(), seam.right.len());
            for (l, r) in seam.left.iter().zip(&seam.right) {
                assert_eq!(disk.point(*l), disk.point(*r));
            }
            // The surface is on the left of `left` and on the right of `right`, in order.
            for i in 1..seam.left.len() {
                let edge = |a: VertexId, b: VertexId| disk.outgoing(a).find(|&h| disk.to(h) == b);
                let left = edge(seam.left[i - 1], seam.left[i]).unwrap();
                let right = edge(seam.right[i], seam.right[i - 1]).unwrap();
                assert!(disk.twin(left).is_none() && disk.twin(right).is_none());
                assert_eq!(sewing.partner(left), Some(right));
                pairs += 1;
            }
        }
        let sewn = disk.half_edges().filter(|&h| sewing.partner(h).is_some()).count();
        assert_eq!(sewn, 2 * pairs);
    }

    #[test]
    fn the_automatic_seam_of_a_cylinder_is_a_straight_generator_on_any_triangulation() {
        for mesh in Mesh::ALL {
            let s = cylinder(40.0, 200.0, mesh);
            let cut = open_to_disk(&s, &[]).unwrap();
            check(&s, &cut, 1);
            assert_eq!(cut.seams.len(), 1);
            let seam = &cut.seams[0];
            let long = length(&cut.disk, &seam.left);
            let angles: Vec<f64> = seam
                .left
                .iter()
                .map(|&v| cut.disk.point(v))
                .map(|p| {
                    (p.y.atan2(p.x)
                        - cut.disk.point(seam.left[0]).to_array()[1]
                            .atan2(cut.disk.point(seam.left[0]).x)
                        + 9.0 * PI)
                        .rem_euclid(TAU)
                        - PI
                })
                .collect();
            let aside = angles.iter().map(|a| 40.0 * a.abs()).fold(0.0, f64::max);
            println!(
                "{mesh:?}: length {long:.6}, aside {aside:.6} mm, points {}, corner {:.2} -> {:.2} deg",
                seam.left.len(),
                worst(&s).to_degrees(),
                worst(&cut.disk).to_degrees()
            );
            assert!((long / 200.0 - 1.0).abs() < 1e-3, "{mesh:?} {long}");
        }
    }
}
