//! What a surface is before it is cut: a tube, a tube slit already, or a disk.
//!
//! The boundary loops are those of the sewn surface: the sides of a slit are no edge of it. The two
//! longest are a tube's ends. Limit: a tube with a cut-out longer than one of its ends is taken
//! wrongly; the designer's own seams and markers settle it.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::error::SeamError;
use super::sewing::Sewing;
use crate::surface::{HalfEdgeId, Surface, VertexId};
use crate::warning::Warning;

/// A ring counts as a flat piece with a cut-out, not as a tube, if its edges turn by more than
/// this part of a full turn: it then lies flat with less than 10 % of strain around.
const FLAT_RING: f64 = 0.9;

/// What the surface is before it is cut.
pub(super) struct Shape {
    /// The boundary loops of the sewn surface, as vertices.
    pub(super) loops: Vec<Vec<VertexId>>,
    pub(super) lengths: Vec<f64>,
    /// The loop of each vertex.
    pub(super) loop_of: Vec<Option<usize>>,
    /// The two ends, longer first, if the sewn surface is a tube.
    pub(super) ends: Option<[usize; 2]>,
    /// The same, if it has yet to be cut.
    pub(super) tube: Option<[usize; 2]>,
    /// Vertices on sides that are sewn already; they must not part.
    pub(super) sewn: BTreeSet<VertexId>,
    pub(super) warnings: Vec<Warning>,
}

impl Shape {
    pub(super) fn of(surface: &Surface) -> Result<Self, SeamError> {
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

    pub(super) fn middle(&self, surface: &[DVec3], i: usize) -> DVec3 {
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
pub(super) fn same_edge(surface: &Surface, a: HalfEdgeId, b: HalfEdgeId) -> bool {
    surface.boundary_loops().iter().any(|l| l.half_edges.contains(&a) && l.half_edges.contains(&b))
}
