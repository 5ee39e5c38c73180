//! Carves a straight path into the triangulation: afterwards it is a chain of edges.
//!
//! Every edge that the path crosses is split at the crossing, in order; each split joins the new
//! vertex to the one before, so that the chain appears by itself. To avoid slivers a vertex near
//! the path moves onto it instead (see [`SNAP`]): the path keeps its place exactly, the surface
//! gives way by hundredths of a millimetre. A vertex that must not move (another seam's, one whose
//! triangles would turn over) takes the path to itself if it is very near. Limit: two paths that
//! run less than an edge apart leave slivers between them.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::error::SeamError;
use super::path::{End, Path, Taut};
use super::slivers::{SNAP, TOUCH, YIELD, improve_round};
use super::triangulation::Triangulation;
use crate::surface::{HalfEdgeId, TriangleId, VertexId};

/// A designer's point whose weight of a corner is below this moves onto the opposite edge: by a
/// tenth of the triangle's height, less than a point is placed by hand.
const BESIDE: f64 = 0.1;

/// One crossing: the half-edge by its ends, and the place.
struct Crossing {
    from: VertexId,
    to: VertexId,
    part: f64,
    place: DVec3,
}

/// How a vertex becomes part of the chain.
#[derive(Clone, Copy)]
struct Snapped {
    /// The crossing whose place it takes.
    crossing: usize,
    /// How far that is, in mm.
    distance: f64,
    /// Where it was before it moved there.
    before: DVec3,
}

/// Carves the path into the mesh and returns its chain of vertices, in order. Vertices in `pinned`
/// do not move.
pub(super) fn carve(
    mesh: &mut Triangulation,
    path: &Path,
    taut: &Taut,
    pinned: &BTreeSet<VertexId>,
) -> Result<Vec<VertexId>, SeamError> {
    let (crossings, ends) = crossings(mesh, path, taut);
    let snapped = snap(mesh, &crossings, ends, pinned);
    let mut chain: Vec<VertexId> = Vec::new();
    let mut taken = BTreeSet::new();
    if let End::Vertex(v) = path.start {
        chain.push(v);
        taken.insert(v);
    }
    for (i, c) in crossings.iter().enumerate() {
        let mut through: Vec<(usize, VertexId)> = [c.from, c.to]
            .into_iter()
            .filter_map(|v| snapped.get(&v).map(|snap| (snap.crossing, v)))
            .collect();
        if through.is_empty() {
            let h = mesh.edge(c.from, c.to).ok_or_else(|| lost(i, c.place))?;
            chain.push(mesh.split_edge(h, c.place));
        } else {
            through.sort_unstable();
            chain.extend(through.into_iter().map(|(_, v)| v).filter(|&v| taken.insert(v)));
        }
    }
    if let End::Vertex(v) = path.end {
        chain.push(v);
    }
    chain.dedup();
    for (i, pair) in chain.windows(2).enumerate() {
        mesh.edge(pair[0], pair[1]).ok_or_else(|| lost(i, mesh.point(pair[0])))?;
    }
    smooth(mesh, &chain, pinned);
    Ok(chain)
}

fn lost(i: usize, at: DVec3) -> SeamError {
    SeamError::Internal(format!("a seam lost its way at step {i} near {at:.1}"))
}

/// The crossings, with the ends that lie on the boundary as first and last; whether there are such.
fn crossings(mesh: &Triangulation, path: &Path, taut: &Taut) -> (Vec<Crossing>, [bool; 2]) {
    let on_boundary = |end: End| match end {
        End::Vertex(_) => None,
        End::Boundary(h, part) => Some((h, part)),
    };
    let (first, last) = (on_boundary(path.start), on_boundary(path.end));
    let inner = path.crossings.iter().copied().zip(taut.parts.iter().copied());
    let all = first
        .into_iter()
        .chain(inner)
        .chain(last)
        .map(|(h, part)| {
            let (from, to) = (mesh.from(h), mesh.to(h));
            Crossing { from, to, part, place: mesh.point(from).lerp(mesh.point(to), part) }
        })
        .collect();
    (all, [first.is_some(), last.is_some()])
}

/// Chooses the vertices that become part of the chain and moves them onto the path.
fn snap(
    mesh: &mut Triangulation,
    crossings: &[Crossing],
    ends: [bool; 2],
    pinned: &BTreeSet<VertexId>,
) -> BTreeMap<VertexId, Snapped> {
    let is_end = |i: usize| (ends[0] && i == 0) || (ends[1] && i + 1 == crossings.len());
    // The ends of a boundary edge on which the path ends may only go to that end: elsewhere on the
    // path they would leave the seam running along the boundary.
    let mut bound: BTreeMap<VertexId, usize> = BTreeMap::new();
    for i in (0..crossings.len()).filter(|&i| is_end(i)) {
        bound.insert(crossings[i].from, i);
        bound.insert(crossings[i].to, i);
    }
    let mut nearest: BTreeMap<VertexId, (f64, usize, f64)> = BTreeMap::new();
    for (i, c) in crossings.iter().enumerate() {
        let (v, part) = if c.part < 0.5 { (c.from, c.part) } else { (c.to, 1.0 - c.part) };
        if part >= SNAP || bound.get(&v).is_some_and(|&only| only != i) {
            continue;
        }
        let distance = c.place.distance(mesh.point(v));
        if nearest.get(&v).is_none_or(|&(best, ..)| distance < best) {
            nearest.insert(v, (distance, i, part));
        }
    }
    let mut order: Vec<(f64, usize, f64, VertexId)> =
        nearest.into_iter().map(|(v, (distance, i, part))| (distance, i, part, v)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut chosen = BTreeMap::new();
    for (distance, crossing, part, v) in order {
        let place = crossings[crossing].place;
        let before = mesh.point(v);
        if part > TOUCH {
            // Through another vertex of the boundary the seam would leave the surface.
            let passes_boundary = mesh.is_boundary(v) && !is_end(crossing);
            if !passes_boundary && !pinned.contains(&v) && mesh.may_move(v, place) {
                mesh.move_vertex(v, place);
            } else if passes_boundary || part > YIELD {
                continue;
            }
        }
        chosen.insert(v, Snapped { crossing, distance, before });
    }
    for (v, snap) in drop_inversions(crossings, &mut chosen) {
        mesh.move_vertex(v, snap.before);
    }
    chosen
}

/// Two chosen vertices whose order along the path contradicts the order in which their edges are
/// crossed would fold the chain: the farther one is dropped.
fn drop_inversions(
    crossings: &[Crossing],
    chosen: &mut BTreeMap<VertexId, Snapped>,
) -> Vec<(VertexId, Snapped)> {
    let mut dropped = Vec::new();
    loop {
        let mut taken = BTreeSet::new();
        let mut order: Vec<VertexId> = Vec::new();
        for c in crossings {
            let mut through: Vec<VertexId> =
                [c.from, c.to].into_iter().filter(|v| chosen.contains_key(v)).collect();
            through.sort_by_key(|v| (chosen[v].crossing, *v));
            order.extend(through.into_iter().filter(|&v| taken.insert(v)));
        }
        let Some(folded) =
            order.windows(2).find(|w| chosen[&w[0]].crossing > chosen[&w[1]].crossing)
        else {
            return dropped;
        };
        let (a, b) = (folded[0], folded[1]);
        let farther = if chosen[&a].distance > chosen[&b].distance { a } else { b };
        dropped.extend(chosen.remove(&farther).map(|snap| (farther, snap)));
    }
}

/// Exchanges diagonals beside the chain where that widens the smallest angle and the two triangles
/// are flat.
fn smooth(mesh: &mut Triangulation, chain: &[VertexId], pinned: &BTreeSet<VertexId>) {
    let on_chain: BTreeSet<VertexId> = chain.iter().chain(pinned).copied().collect();
    for _ in 0..4 {
        let mut changed = false;
        for &v in chain {
            // Edges between two vertices of seams may be seams.
            changed |= improve_round(mesh, v, |w| !on_chain.contains(&w));
        }
        if !changed {
            break;
        }
    }
}

/// Makes a place on the surface a vertex: a near vertex moves there, a near edge is split, or the
/// triangle. `barycentric` is the place in `triangle`; a pinned vertex that is near is taken as it
/// is.
pub(super) fn insert(
    mesh: &mut Triangulation,
    triangle: TriangleId,
    barycentric: DVec3,
    pinned: &BTreeSet<VertexId>,
) -> VertexId {
    let corners = mesh.triangles()[triangle.index()];
    let w = barycentric.to_array();
    let p = mesh.corners(triangle);
    let place = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
    let k = (0..3).fold(0, |best, k| if w[k] > w[best] { k } else { best });
    let v = corners[k];
    if w[k] > 1.0 - SNAP {
        if pinned.contains(&v) || w[k] > 1.0 - TOUCH {
            return v;
        }
        let on_boundary = mesh.is_boundary(v);
        if !on_boundary && mesh.may_move(v, place) {
            mesh.move_vertex(v, place);
            return v;
        }
    }
    let least = (0..3).fold(0, |best, k| if w[k] < w[best] { k } else { best });
    let h = HalfEdgeId::of(triangle, (least + 1) % 3);
    if w[least] < BESIDE {
        let (a, b) = ((least + 1) % 3, (least + 2) % 3);
        let part = (w[b] / (w[a] + w[b])).clamp(0.0, 1.0);
        // A place on the very corner of an edge that cannot be moved there is that corner.
        if part < YIELD {
            return corners[a];
        }
        if part > 1.0 - YIELD {
            return corners[b];
        }
        return mesh.split_edge(h, p[a].lerp(p[b], part));
    }
    mesh.split_triangle(triangle, place)
}

/// Makes a place on a boundary half-edge a vertex: a near end of it moves there along it, or it is
/// split.
pub(super) fn insert_on_boundary(
    mesh: &mut Triangulation,
    h: HalfEdgeId,
    part: f64,
    pinned: &BTreeSet<VertexId>,
) -> VertexId {
    let (v, near) = if part < 0.5 { (mesh.from(h), part) } else { (mesh.to(h), 1.0 - part) };
    let place = mesh.point(mesh.from(h)).lerp(mesh.point(mesh.to(h)), part);
    if near < TOUCH {
        return v;
    }
    if near < SNAP && !pinned.contains(&v) && mesh.may_move(v, place) {
        mesh.move_vertex(v, place);
        return v;
    }
    if near < YIELD { v } else { mesh.split_edge(h, place) }
}
