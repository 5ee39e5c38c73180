//! The closest woven node to a point of the surface, searched along the surface.
//!
//! Each triangle knows the nodes in it (the paper's pointers, section 4.4). The search spreads from
//! the point's triangle over neighbouring triangles, nearest first, so that it never jumps across a
//! seam or through a thin limb to a node that is close in space only.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};

use glam::DVec3;

use super::WovenModel;
use crate::geometry::{SurfacePoint, closest_on_triangle};
use crate::surface::{HalfEdgeId, Surface, TriangleId};

/// The nodes of a woven model by triangle.
pub struct NodeSearch<'a> {
    surface: &'a Surface,
    /// Slots sorted by triangle, and where each triangle's slots begin.
    slots: Vec<usize>,
    begins: Vec<usize>,
    places: Vec<DVec3>,
}

/// A distance that orders (never NaN).
struct Distance(f64);

impl PartialEq for Distance {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Distance {}

impl PartialOrd for Distance {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Distance {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl<'a> NodeSearch<'a> {
    /// Sorts the nodes of a model on its surface by triangle.
    #[must_use]
    pub fn new(surface: &'a Surface, model: &WovenModel) -> Self {
        let mut begins = vec![0; surface.triangle_count() + 1];
        let triangle = |slot| {
            let point: Option<SurfacePoint> = model.point_in(slot);
            point.map_or(0, |p| p.triangle.index())
        };
        for slot in model.filled() {
            begins[triangle(slot) + 1] += 1;
        }
        for t in 1..begins.len() {
            begins[t] += begins[t - 1];
        }
        let mut slots: Vec<usize> = model.filled().collect();
        slots.sort_by_key(|&slot| (triangle(slot), slot));
        let places = slots.iter().map(|&slot| model.place_in(slot)).collect();
        Self { surface, slots, begins, places }
    }

    /// The slot of the closest node and its distance in space in mm, within `limit` mm.
    #[must_use]
    pub fn closest(&self, point: &SurfacePoint, limit: f64) -> Option<(usize, f64)> {
        let place = point.position(self.surface);
        let mut best: Option<(usize, f64)> = None;
        self.spread(point.triangle, place, limit, |t, reach| {
            for k in self.begins[t.index()]..self.begins[t.index() + 1] {
                let distance = place.distance(self.places[k]);
                let better = best.is_none_or(|(slot, d)| {
                    distance < d || (distance == d && self.slots[k] < slot)
                });
                if distance <= limit && better {
                    best = Some((self.slots[k], distance));
                }
            }
            best.map_or(reach, |(_, distance)| distance.min(reach))
        });
        best
    }

    /// Whether a node lies within `radius` mm of the point.
    #[must_use]
    pub fn any_within(&self, point: &SurfacePoint, radius: f64) -> bool {
        self.closest(point, radius).is_some()
    }

    /// Visits triangles in the order of their distance from `place`, connected to `start`, as long
    /// as they are nearer than what `visit` returns.
    fn spread(
        &self,
        start: TriangleId,
        place: DVec3,
        limit: f64,
        mut visit: impl FnMut(TriangleId, f64) -> f64,
    ) {
        let mut reach = limit;
        // Asked and never iterated, so its order does not matter.
        let mut seen = HashSet::from([start]);
        let mut heap = BinaryHeap::from([Reverse((Distance(0.0), start))]);
        while let Some(Reverse((Distance(distance), t))) = heap.pop() {
            if distance > reach {
                return;
            }
            reach = visit(t, reach);
            for k in 0..3 {
                let Some(twin) = self.surface.twin(HalfEdgeId::of(t, k)) else { continue };
                let next = twin.triangle();
                if seen.insert(next) {
                    let corners = self.surface.corners(next);
                    let w = closest_on_triangle(place, corners);
                    let nearest = w.x * corners[0] + w.y * corners[1] + w.z * corners[2];
                    let distance = place.distance(nearest);
                    if distance <= reach {
                        heap.push(Reverse((Distance(distance), next)));
                    }
                }
            }
        }
    }
}
