//! Which boundary edges of a surface are sewn together, and what the sewn surface's edge is.
//!
//! Two boundary edges whose ends coincide exactly in space are the two sides of a seam: so are
//! those that our own cut makes, and those of a limb that came already slit. Limit: sides that a
//! program has moved apart, by rounding alone, are no seam.

use std::collections::HashMap;

use glam::DVec3;

use crate::surface::{HalfEdgeId, Surface, VertexId};

/// A seam's two sides.
///
/// With the seam's first point on top and the outer face seen, the copy at the left edge of the
/// flat pattern (smaller x) is `left`: its triangles lie to the left of one who walks down the
/// seam on the limb's outside, and to its right in the pattern lies the piece.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seam {
    /// The vertices of the left side, from the proximal end.
    pub left: Vec<VertexId>,
    /// The vertices of the right side; `right[i]` and `left[i]` coincide in space, and are one
    /// vertex where the seam ends inside the piece.
    pub right: Vec<VertexId>,
}

impl Seam {
    /// The same seam from its other end.
    #[must_use]
    pub(super) fn reversed(mut self) -> Self {
        self.left.reverse();
        self.right.reverse();
        Self { left: self.right, right: self.left }
    }
}

/// The sewn pairs among a surface's boundary edges.
pub(super) struct Sewing<'a> {
    surface: &'a Surface,
    /// For each half-edge the one that it is sewn to.
    partner: Vec<Option<HalfEdgeId>>,
}

impl<'a> Sewing<'a> {
    pub(super) fn new(surface: &'a Surface) -> Self {
        let key = |p: DVec3| p.to_array().map(|x| (x + 0.0).to_bits());
        let shore = || surface.half_edges().filter(|&h| surface.twin(h).is_none());
        let ends = |h| (key(surface.point(surface.from(h))), key(surface.point(surface.to(h))));
        // Three edges at one place are no seam.
        let mut by_ends: HashMap<_, Option<HalfEdgeId>> = HashMap::new();
        for h in shore() {
            by_ends.entry(ends(h)).and_modify(|found| *found = None).or_insert(Some(h));
        }
        let mut partner = vec![None; 3 * surface.triangle_count()];
        for h in shore() {
            let (from, to) = ends(h);
            let alone = by_ends.get(&(from, to)).copied().flatten().is_some();
            partner[h.index()] = by_ends.get(&(to, from)).copied().flatten().filter(|_| alone);
        }
        Self { surface, partner }
    }

    pub(super) fn partner(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.partner[h.index()]
    }

    /// The boundary half-edge after a boundary half-edge.
    fn next(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.surface.outgoing(self.surface.to(h)).next().unwrap_or(h)
    }

    /// The boundary half-edge before a boundary half-edge.
    fn previous(&self, h: HalfEdgeId) -> HalfEdgeId {
        self.surface.outgoing(self.surface.from(h)).last().map_or(h, HalfEdgeId::prev)
    }

    /// The boundary loops of the sewn surface as half-edges of this one.
    pub(super) fn sewn_loops(&self) -> Vec<Vec<HalfEdgeId>> {
        let free = |h: HalfEdgeId| self.surface.twin(h).is_none() && self.partner(h).is_none();
        let mut seen = vec![false; self.partner.len()];
        let mut loops = Vec::new();
        for start in self.surface.half_edges().filter(|&h| free(h)) {
            let mut around = Vec::new();
            let mut h = start;
            while !std::mem::replace(&mut seen[h.index()], true) {
                around.push(h);
                h = self.next(h);
                // Past every seam that begins here.
                while let Some(other) = self.partner(h) {
                    h = self.next(other);
                }
            }
            if !around.is_empty() {
                loops.push(around);
            }
        }
        loops
    }

    /// The seams, ordered by their lowest half-edge; their direction is arbitrary.
    pub(super) fn seams(&self) -> Vec<Seam> {
        let mut seams = Vec::new();
        let mut used = vec![false; self.partner.len()];
        for start in self.surface.half_edges() {
            if used[start.index()] || self.partner(start).is_none() {
                continue;
            }
            // Back to where the seam begins, or once round.
            let mut h = start;
            while let Some(before) = self.neighbour(h, false).filter(|&b| b != start) {
                h = before;
            }
            let mut seam = Seam { left: Vec::new(), right: Vec::new() };
            let mut walk = Some(h);
            while let Some(h) = walk {
                let Some(g) = self.partner(h) else { break };
                if seam.left.is_empty() {
                    seam.left.push(self.surface.from(h));
                    seam.right.push(self.surface.to(g));
                }
                seam.left.push(self.surface.to(h));
                seam.right.push(self.surface.from(g));
                used[h.index()] = true;
                used[g.index()] = true;
                walk = self.neighbour(h, true).filter(|n| !used[n.index()]);
            }
            seams.push(seam);
        }
        seams
    }

    /// The half-edge of the same seam after or before `h`, unless the seam ends there.
    fn neighbour(&self, h: HalfEdgeId, after: bool) -> Option<HalfEdgeId> {
        let g = self.partner(h)?;
        let (n, m) =
            if after { (self.next(h), self.previous(g)) } else { (self.previous(h), self.next(g)) };
        // At the tip of a slit the two sides follow one another.
        (n != g && self.partner(n) == Some(m)).then_some(n)
    }
}
