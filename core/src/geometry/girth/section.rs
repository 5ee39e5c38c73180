//! The curves in which a plane cuts a surface.

use glam::DVec3;

use crate::surface::{HalfEdgeId, Surface};

/// A connected piece of a plane section.
#[derive(Debug)]
pub(super) struct Piece {
    /// Its points in order; of a closed one the first is not repeated.
    pub(super) points: Vec<DVec3>,
    /// The edges on which the points lie.
    pub(super) edges: Vec<HalfEdgeId>,
    /// Whether it returns to its first point.
    pub(super) closed: bool,
}

impl Piece {
    /// Its length, in mm.
    pub(super) fn length(&self) -> f64 {
        let open: f64 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        open + if self.closed {
            self.points[self.points.len() - 1].distance(self.points[0])
        } else {
            0.0
        }
    }

    /// How far it turns round the line through `centre` along `axis`, in radians, counter-clockwise
    /// positive.
    pub(super) fn turning(&self, centre: DVec3, axis: DVec3) -> f64 {
        let n = self.points.len();
        let last = if self.closed { n } else { n - 1 };
        (0..last)
            .map(|i| {
                let (a, b) = (self.points[i] - centre, self.points[(i + 1) % n] - centre);
                a.cross(b).dot(axis).atan2(a.dot(b) - a.dot(axis) * b.dot(axis))
            })
            .sum()
    }
}

/// The pieces of the section of a surface with the plane through `point` across `normal`. A
/// vertex exactly in the plane counts as lying on the side to which the normal points.
pub(super) fn plane_section(surface: &Surface, point: DVec3, normal: DVec3) -> Vec<Piece> {
    let above: Vec<f64> = surface.points().iter().map(|&p| (p - point).dot(normal)).collect();
    let height = |v: crate::surface::VertexId| above[v.index()];
    // The section enters a triangle through the half-edge that rises through the plane and
    // leaves it through the one that falls.
    let rises = |h: HalfEdgeId| height(surface.from(h)) < 0.0 && height(surface.to(h)) >= 0.0;
    let falls = |h: HalfEdgeId| height(surface.from(h)) >= 0.0 && height(surface.to(h)) < 0.0;
    let place = |h: HalfEdgeId| {
        let (a, b) = (height(surface.from(h)), height(surface.to(h)));
        surface.point(surface.from(h)).lerp(surface.point(surface.to(h)), a / (a - b))
    };
    let entries: Vec<HalfEdgeId> = surface.half_edges().filter(|&h| rises(h)).collect();
    let mut seen = vec![false; surface.triangle_count()];
    let mut pieces = Vec::new();
    let open = entries.iter().copied().filter(|&h| surface.twin(h).is_none());
    for start in open.chain(entries.iter().copied()) {
        if seen[start.triangle().index()] {
            continue;
        }
        let (mut points, mut edges) = (vec![place(start)], vec![start]);
        let mut h = start;
        let closed = loop {
            seen[h.triangle().index()] = true;
            let out = if falls(h.next()) { h.next() } else { h.prev() };
            match surface.twin(out) {
                Some(next) if next == start => break true,
                next => {
                    points.push(place(out));
                    edges.push(out);
                    match next {
                        Some(next) => h = next,
                        None => break false,
                    }
                }
            }
        };
        pieces.push(Piece { points, edges, closed });
    }
    pieces
}
