//! Keeping the surface covered: new nodes where a gap has opened near the boundary (section 5.2).
//!
//! The paper says that nodes are inserted and not how. Extrapolating every missing neighbour of a
//! boundary node lays fabric over fabric that is already there, and the number of nodes explodes.
//! So a node is inserted only where (a) a thread that is already there, prolonged straight on, stays
//! inside the surface with some room to spare, (b) no node lies nearer than half a thread's
//! distance, (c) the cells it closes lie the right way round, (d) a whole cell holds it, and (e) it
//! has not left the surface several times already: at an edge that runs along a thread a node would
//! be put in and fall out for ever.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::geometry::{SurfacePoint, walk};
use crate::surface::Surface;
use crate::weave::{NodeIndex, NodeSearch, RestLengths, WovenModel};

/// A thread is prolonged only where the surface goes on for this many times its wanted length: a
/// node on the very edge would leave again at the next step.
const ROOM: f64 = 1.1;

/// No node may lie nearer than this many times the spacing: half a cell, below which two threads
/// would be one.
const CLEARANCE: f64 = 0.5;

/// A node that has left the surface this often on one level is not put in again.
const MOST_RETURNS: u32 = 2;

/// How often each node has left the surface.
#[derive(Debug, Clone, Default)]
pub struct Departures(BTreeMap<NodeIndex, u32>);

impl Departures {
    /// Counts the nodes that `before` has and `after` has not.
    pub fn count(&mut self, before: &WovenModel, after: &WovenModel) {
        for node in before.filled().map(|slot| before.index(slot)) {
            if after.point(node).is_none() {
                *self.0.entry(node).or_default() += 1;
            }
        }
    }

    fn barred(&self, node: NodeIndex) -> bool {
        self.0.get(&node).is_some_and(|&times| times >= MOST_RETURNS)
    }
}

/// The model with one ring of nodes added wherever a gap has opened, and their number.
#[must_use]
pub fn grow(
    surface: &Surface,
    model: &WovenModel,
    rest: &RestLengths,
    departures: &Departures,
) -> (WovenModel, usize) {
    let search = NodeSearch::new(surface, model);
    let mut grown = model.clone();
    let mut added: Vec<NodeIndex> = Vec::new();
    for node in gaps(model).into_iter().filter(|&node| !departures.barred(node)) {
        let Some(point) = prolong(surface, model, rest, node) else { continue };
        if search.any_within(&point, CLEARANCE * model.spacing()) {
            continue;
        }
        let place = point.position(surface);
        let crowded = added.iter().any(|&other| {
            grown.place(other).is_some_and(|p| p.distance(place) < CLEARANCE * model.spacing())
        });
        if !crowded {
            grown.put(node, point, surface);
            added.push(node);
        }
    }
    // One pass over the new nodes: a cell that lies the wrong way round loses its new corners.
    let folded: Vec<NodeIndex> =
        added.iter().copied().filter(|&node| folds(surface, &grown, node)).collect();
    for node in folded {
        if let Some(slot) = grown.slot(node) {
            grown.remove(slot);
        }
    }
    grown.drop_loose_nodes();
    let count = added.iter().filter(|&&node| grown.point(node).is_some()).count();
    (grown, count)
}

/// The empty places beside a node, in order.
fn gaps(model: &WovenModel) -> Vec<NodeIndex> {
    let mut gaps = Vec::new();
    for slot in model.filled() {
        let node = model.index(slot);
        for (di, dj) in [(0, 1), (0, -1), (1, 0), (-1, 0)] {
            let beside = node.offset(di, dj);
            if model.point(beside).is_none() {
                gaps.push(beside);
            }
        }
    }
    gaps.sort_unstable();
    gaps.dedup();
    gaps
}

/// Where the threads that end beside a gap would go on: the mean of their ends.
fn prolong(
    surface: &Surface,
    model: &WovenModel,
    rest: &RestLengths,
    gap: NodeIndex,
) -> Option<SurfacePoint> {
    let mut ends: Vec<SurfacePoint> = Vec::new();
    for (di, dj) in [(0, -1), (0, 1), (-1, 0), (1, 0)] {
        let Some(from) = model.point(gap.offset(di, dj)) else { continue };
        let Some(before) = model.place(gap.offset(2 * di, 2 * dj)) else { continue };
        let wanted = if di == 0 { rest.warp(gap.i) } else { rest.weft() };
        let direction = from.position(surface) - before;
        if walk(surface, &from, direction, ROOM * wanted).met_boundary {
            return None;
        }
        ends.push(walk(surface, &from, direction, wanted).end);
    }
    let first = *ends.first()?;
    let mean: DVec3 =
        ends.iter().map(|end| end.position(surface)).sum::<DVec3>() / ends.len() as f64;
    let off = mean - first.position(surface);
    let path = walk(surface, &first, off, off.length());
    (!path.met_boundary).then_some(path.end)
}

/// Whether a whole cell at this node is turned over against the surface.
fn folds(surface: &Surface, model: &WovenModel, node: NodeIndex) -> bool {
    let Some(point) = model.point(node) else { return false };
    let normal = surface.normal(point.triangle);
    [(0, 0), (-1, 0), (0, -1), (-1, -1)].into_iter().any(|(di, dj)| {
        let corner = node.offset(di, dj);
        let at = |i, j| model.place(corner.offset(i, j));
        let (Some(a), Some(b), Some(c), Some(d)) = (at(0, 0), at(0, 1), at(1, 1), at(1, 0)) else {
            return false;
        };
        (c - a).cross(d - b).dot(normal) <= 0.0
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::geometry::shapes::grid;
    use crate::weave::lay;

    const SIZE: f64 = 100.0;

    fn square() -> (Surface, Vec<DVec2>) {
        let surface = grid(20, 20, false, |s, t| DVec3::new(SIZE * s, SIZE * t, 0.0));
        let plane = surface.points().iter().map(|p| p.truncate() + DVec2::new(0.9, 1.3)).collect();
        (surface, plane)
    }

    fn rest() -> RestLengths {
        RestLengths::new(5.0, 0, vec![0.0], 0.0)
    }

    fn filled(surface: &Surface, mut model: WovenModel) -> WovenModel {
        for _ in 0..40 {
            let (grown, added) = grow(surface, &model, &rest(), &Departures::default());
            model = grown;
            if added == 0 {
                return model;
            }
        }
        panic!("still growing after 40 rings: {} nodes", model.node_count());
    }

    #[test]
    fn a_patch_of_fabric_grows_until_the_surface_is_covered_once() {
        let (surface, plane) = square();
        let whole = lay(&surface, &plane, 5.0);
        let mut patch = whole.clone();
        for slot in whole.filled() {
            let p = whole.place_in(slot);
            if p.distance(DVec3::new(40.0, 55.0, 0.0)) > 20.0 {
                patch.remove(slot);
            }
        }
        patch.drop_loose_nodes();
        assert!(patch.node_count() * 5 < whole.node_count());
        let grown = filled(&surface, patch);
        // Within the room that a new node keeps from the edge, the same nodes at the same places.
        for slot in grown.filled() {
            let there = whole.place(grown.index(slot)).unwrap();
            assert!(there.distance(grown.place_in(slot)) < 1e-9);
        }
        let inner = |p: DVec3| (p - SIZE / 2.0).truncate().abs().max_element() < SIZE / 2.0 - 0.6;
        for slot in whole.filled().filter(|&slot| inner(whole.place_in(slot))) {
            assert!(grown.place(whole.index(slot)).is_some(), "{}", whole.place_in(slot));
        }
    }

    #[test]
    fn fabric_is_never_laid_over_fabric() {
        // Two patches whose numbering does not meet: the gap between them is filled from both
        // sides, and neither grows over the other.
        let (surface, plane) = square();
        let whole = lay(&surface, &plane, 5.0);
        let mut split =
            WovenModel::empty(5.0, NodeIndex { i: 0, j: 0 }, NodeIndex { i: 22, j: 40 });
        for slot in whole.filled() {
            let (node, p) = (whole.index(slot), whole.place_in(slot));
            let point = whole.point_in(slot).unwrap();
            if p.x < 30.0 {
                split.put(node, point, &surface);
            } else if p.x > 62.0 {
                split.put(node.offset(0, 10), point, &surface);
            }
        }
        let grown = filled(&surface, split);
        let area = grown.cell_count() as f64 * 25.0;
        assert!(area < SIZE * SIZE, "{area}");
        let places: Vec<DVec3> = grown.filled().map(|slot| grown.place_in(slot)).collect();
        for (k, p) in places.iter().enumerate() {
            let nearest = places[..k].iter().map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min);
            assert!(nearest > 2.4, "{nearest} at {p}");
        }
    }

    #[test]
    fn a_node_that_keeps_leaving_is_not_put_in_again() {
        let (surface, plane) = square();
        let whole = lay(&surface, &plane, 5.0);
        let mut without = whole.clone();
        let node = NodeIndex { i: 10, j: 10 };
        without.remove(whole.slot(node).unwrap());
        let mut departures = Departures::default();
        departures.count(&whole, &without);
        assert!(grow(&surface, &without, &rest(), &departures).0.point(node).is_some());
        departures.count(&whole, &without);
        assert!(grow(&surface, &without, &rest(), &departures).0.point(node).is_none());
    }
}
