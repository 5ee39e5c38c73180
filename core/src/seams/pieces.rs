//! A brace of several pieces: seams that split the surface.
//!
//! The fabric is fitted as one piece of cloth, so some of the seams that the designer drew are joined
//! again until one disk is left, the longest first, and the pattern is cut apart along them afterwards.
//! Both sides of such a seam so have the same shape and length. Limit: the cloth is fitted as if it were
//! continuous there; cut apart it could follow the limb more closely than it does.

use std::collections::BTreeMap;

use super::error::SeamError;
use super::sewing::{Seam, Sewing};
use crate::surface::{HalfEdgeId, Surface, VertexId};
use crate::warning::Warning;

/// A surface of one piece, and the chains of its inner vertices along which it is to be cut apart.
pub(super) struct Joined {
    pub(super) disk: Surface,
    pub(super) splits: Vec<Vec<VertexId>>,
    pub(super) warning: Option<Warning>,
}

/// Joins the pieces of a cut surface along seams that lie between two of them.
pub(super) fn join(cut: Surface) -> Result<Joined, SeamError> {
    let (piece, count) = cut.components();
    if count <= 1 {
        return Ok(Joined { disk: cut, splits: Vec::new(), warning: None });
    }
    let mut seams: Vec<(Seam, [usize; 2])> = Sewing::new(&cut)
        .seams()
        .into_iter()
        .filter_map(|seam| {
            let left = edge(&cut, seam.left[0], seam.left[1])?;
            let right = edge(&cut, seam.right[1], seam.right[0])?;
            let sides = [left, right].map(|h| piece[h.triangle().index()]);
            Some((seam, sides))
        })
        .collect();
    let length = |seam: &Seam| -> f64 {
        seam.left.windows(2).map(|w| cut.point(w[0]).distance(cut.point(w[1]))).sum()
    };
    // Longest first; equal ones stay in their order.
    seams.sort_by(|a, b| length(&b.0).total_cmp(&length(&a.0)));
    let mut root: Vec<usize> = (0..count).collect();
    let mut same: Vec<usize> = (0..cut.vertex_count()).collect();
    let mut welded = Vec::new();
    for (seam, sides) in seams {
        let [one, other] = sides.map(|side| find(&mut root, side));
        if one == other {
            continue;
        }
        root[one.max(other)] = one.min(other);
        for (l, r) in seam.left.iter().zip(&seam.right) {
            // The lower index stays: it is that of the surface before the cut.
            let [a, b] = [l, r].map(|v| find(&mut same, v.index()));
            same[a.max(b)] = a.min(b);
        }
        welded.push(seam);
    }
    // What nothing joins is told as it was: pieces that do not touch.
    let mut number = BTreeMap::new();
    for v in 0..cut.vertex_count() {
        if find(&mut same, v) == v {
            number.insert(v, VertexId::new(number.len()));
        }
    }
    let mut fresh = |v: VertexId| number[&find(&mut same, v.index())];
    let triangles = cut.triangles().iter().map(|corners| corners.map(&mut fresh)).collect();
    let splits: Vec<Vec<VertexId>> =
        welded.iter().map(|seam| seam.left.iter().map(|&v| fresh(v)).collect()).collect();
    let points = number.keys().map(|&v| cut.point(VertexId::new(v))).collect();
    let disk = Surface::new(points, triangles)?;
    let warning = Warning::new(
        "cut_apart",
        format!(
            "the seams split the brace into {count} pieces: the fabric is fitted as one piece of \
             cloth, and the pattern is cut apart along {} of them; both sides of those have the same \
             shape",
            splits.len()
        ),
    );
    Ok(Joined { disk, splits, warning: Some(warning) })
}

/// The half-edge between two vertices.
fn edge(surface: &Surface, from: VertexId, to: VertexId) -> Option<HalfEdgeId> {
    surface.outgoing(from).find(|&h| surface.to(h) == to)
}

fn find(root: &mut [usize], mut i: usize) -> usize {
    while root[i] != i {
        root[i] = root[root[i]];
        i = root[i];
    }
    i
}
