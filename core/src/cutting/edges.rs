//! The outline of a piece as edges: what each is sewn to, or which end of the brace it is.

use std::collections::{BTreeSet, HashMap};

use glam::DVec2;

use super::allowance::{area, closed};
use crate::seams::CutSurface;
use crate::surface::{HalfEdgeId, Surface, VertexId};

/// Which side of a seam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The side that lies left in the pattern when the seam's start is on top.
    Left,
    /// The other side.
    Right,
}

/// What an edge of a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EdgeKind {
    /// A side of a seam, by the seam's index among all that the pieces have.
    Sewn(usize, Side),
    /// The end near the body.
    Top,
    /// The far end.
    Bottom,
    /// Any other: a cut-out, the edge of a piece that does not go round the limb.
    Free,
}

/// A run of the outline of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// What it is.
    pub kind: EdgeKind,
    /// Its points in mm, both ends included, the piece on the left of one who walks along it. Of a
    /// loop that is one edge the first point stands at the end again.
    pub points: Vec<DVec2>,
    /// Allowance outside it, in mm.
    pub allowance: f64,
}

impl Edge {
    /// Whether it is a side of a seam.
    #[must_use]
    pub fn sewn(&self) -> bool {
        matches!(self.kind, EdgeKind::Sewn(..))
    }
}

/// Of every piece of a cut surface the loops of its outline as edges, the outer loop first; and what
/// the seams are called.
pub(super) fn edges(cut: &CutSurface, coordinates: &[DVec2]) -> (Vec<Vec<Vec<Edge>>>, Vec<String>) {
    let (kinds, names) = kinds(cut);
    let disk = &cut.disk;
    // Where a seam that cuts the pattern apart runs there is no way on.
    let split: BTreeSet<(VertexId, VertexId)> = cut
        .splits
        .iter()
        .flat_map(|chain| chain.windows(2))
        .flat_map(|pair| [(pair[0], pair[1]), (pair[1], pair[0])])
        .collect();
    let across =
        |h: HalfEdgeId| disk.twin(h).filter(|_| !split.contains(&(disk.from(h), disk.to(h))));
    let kind =
        |h: HalfEdgeId| kinds.get(&(disk.from(h), disk.to(h))).copied().unwrap_or(EdgeKind::Free);
    let (piece, count) = pieces_of(disk, across);
    let mut pieces: Vec<Vec<Vec<Edge>>> = vec![Vec::new(); count];
    let mut seen = vec![false; 3 * disk.triangle_count()];
    for start in disk.half_edges().filter(|&h| across(h).is_none()) {
        let mut around = Vec::new();
        let mut h = start;
        while !std::mem::replace(&mut seen[h.index()], true) {
            around.push(h);
            // The next edge of the outline: round the vertex, inside the piece.
            h = h.next();
            while let Some(twin) = across(h) {
                h = twin.next();
            }
        }
        if !around.is_empty() {
            let points: Vec<DVec2> =
                around.iter().map(|&h| coordinates[disk.from(h).index()]).collect();
            let kinds: Vec<EdgeKind> = around.iter().map(|&h| kind(h)).collect();
            pieces[piece[start.triangle().index()]].push(runs(&points, &kinds));
        }
    }
    // The outer loop is the one that turns counter-clockwise about the most.
    let turned = |edges: &Vec<Edge>| area(&closed(edges));
    for loops in &mut pieces {
        loops.sort_by(|a, b| turned(b).total_cmp(&turned(a)));
    }
    (pieces, names)
}

/// The piece of every triangle, numbered by their first triangle, and how many there are.
fn pieces_of(
    disk: &Surface,
    across: impl Fn(HalfEdgeId) -> Option<HalfEdgeId>,
) -> (Vec<usize>, usize) {
    let mut piece = vec![usize::MAX; disk.triangle_count()];
    let mut count = 0;
    for start in disk.triangle_ids() {
        if piece[start.index()] != usize::MAX {
            continue;
        }
        piece[start.index()] = count;
        let mut waiting = vec![start];
        while let Some(t) = waiting.pop() {
            for twin in (0..3).filter_map(|k| across(HalfEdgeId::of(t, k))) {
                let next = twin.triangle();
                if piece[next.index()] == usize::MAX {
                    piece[next.index()] = count;
                    waiting.push(next);
                }
            }
        }
        count += 1;
    }
    (piece, count)
}

type Kinds = HashMap<(VertexId, VertexId), EdgeKind>;

/// The kind of every edge of an outline that is not [`EdgeKind::Free`], by its ends; and what the seams
/// are called. A seam that another one ends at, across which pieces part, becomes two, `1a` and `1b`.
fn kinds(cut: &CutSurface) -> (Kinds, Vec<String>) {
    let mut kinds = Kinds::new();
    let mut names = Vec::new();
    if let Some(ends) = &cut.ends {
        for (end, kind) in [(&ends.proximal, EdgeKind::Top), (&ends.distal, EdgeKind::Bottom)] {
            kinds.extend(end.windows(2).map(|pair| ((pair[0], pair[1]), kind)));
        }
    }
    let stops: BTreeSet<VertexId> = cut
        .splits
        .iter()
        .flat_map(|chain| [chain.first(), chain.last()])
        .flatten()
        .copied()
        .collect();
    let own = cut.seams.iter().map(|seam| [&seam.left, &seam.right]);
    // Of a seam that cuts the disk apart both sides are the same vertices.
    let splits = cut.splits.iter().map(|chain| [chain, chain]);
    for (k, [left, right]) in own.chain(splits).enumerate() {
        let stop = |i: &usize| stops.contains(&left[*i]) || stops.contains(&right[*i]);
        let inner = 1..left.len().saturating_sub(1);
        let mut ends: Vec<usize> =
            if k < cut.seams.len() { inner.filter(stop).collect() } else { Vec::new() };
        ends.push(left.len() - 1);
        let parts = ends.len();
        let mut from = 0;
        for (part, to) in ends.into_iter().enumerate() {
            let index = names.len();
            let letter = char::from(b'a' + (part % 26) as u8);
            names.push(match parts {
                1 => format!("seam {}", k + 1),
                _ => format!("seam {}{letter}", k + 1),
            });
            let kind = EdgeKind::Sewn(index, Side::Left);
            kinds.extend(left[from..=to].windows(2).map(|pair| ((pair[0], pair[1]), kind)));
            let kind = EdgeKind::Sewn(index, Side::Right);
            kinds.extend(right[from..=to].windows(2).map(|pair| ((pair[1], pair[0]), kind)));
            from = to;
        }
    }
    (kinds, names)
}

/// A loop as runs of one kind; `kinds` are those of the edges that begin at the points.
fn runs(around: &[DVec2], kinds: &[EdgeKind]) -> Vec<Edge> {
    let count = around.len();
    let of = |i: usize| kinds[i % count];
    let start = (0..count).find(|&i| of(i + count - 1) != of(i)).unwrap_or(0);
    let place = |i: usize| around[i % count];
    let mut edges: Vec<Edge> = Vec::new();
    for i in start..start + count {
        match edges.last_mut() {
            Some(edge) if edge.kind == of(i) => edge.points.push(place(i + 1)),
            _ => edges.push(Edge {
                kind: of(i),
                points: vec![place(i), place(i + 1)],
                allowance: 0.0,
            }),
        }
    }
    edges
}

/// Length of a polyline, in mm.
#[must_use]
pub fn length(points: &[DVec2]) -> f64 {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// The point at a length along a polyline, and the unit direction of the line there.
#[must_use]
pub fn along(points: &[DVec2], wanted: f64) -> Option<(DVec2, DVec2)> {
    let mut run = 0.0;
    let mut last = None;
    for pair in points.windows(2) {
        let step = pair[0].distance(pair[1]);
        let Some(direction) = (pair[1] - pair[0]).try_normalize() else { continue };
        if run + step >= wanted {
            return Some((pair[0] + (wanted - run) * direction, direction));
        }
        run += step;
        last = Some((pair[1], direction));
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_along_a_bent_line_by_hand() {
        let line = [(0.0, 0.0), (3.0, 0.0), (3.0, 0.0), (3.0, 4.0)].map(DVec2::from);
        assert_eq!(length(&line), 7.0);
        assert_eq!(along(&line, 2.0), Some((DVec2::new(2.0, 0.0), DVec2::X)));
        assert_eq!(along(&line, 5.0), Some((DVec2::new(3.0, 2.0), DVec2::Y)));
        assert_eq!(along(&line, 9.0), Some((DVec2::new(3.0, 4.0), DVec2::Y)));
        assert_eq!(along(&line[..1], 0.0), None);
    }

    #[test]
    fn a_loop_is_split_where_its_kind_changes_and_a_loop_of_one_kind_is_closed() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        use EdgeKind::{Free, Top};
        let edges = runs(&square, &[Top, Free, Free, Top]);
        assert_eq!(edges.len(), 2);
        assert_eq!((edges[0].kind, edges[1].kind), (Free, Top));
        assert_eq!(edges[0].points, [square[1], square[2], square[3]]);
        assert_eq!(edges[1].points, [square[3], square[0], square[1]]);
        let whole = runs(&square, &[Free; 4]);
        assert_eq!(whole.len(), 1);
        assert_eq!(whole[0].points.first(), whole[0].points.last());
        assert_eq!(whole[0].points.len(), 5);
    }
}
