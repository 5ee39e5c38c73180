//! One step of the diffusion of elastic energy (section 5.2 of the paper).
//!
//! Every node moves by −λ ∂J_E/∂V (Eqs. 12, 13) along a straightest path of the surface. The
//! gradient's part along the normal does nothing on a surface, so the node moves by the tangential
//! part. Threads shorter than wanted are kept from buckling, see [`gradient`]. All nodes move from the same old places (Jacobi), so threads do not change the result.

use glam::DVec3;
use rayon::prelude::*;

use super::energy::stiffness;
use crate::design::Fabric;
use crate::geometry::{SurfacePoint, walk};
use crate::surface::Surface;
use crate::weave::{RestLengths, SpringKind, WovenModel};

/// λ of Eq. (13) in mm/N: the damping parameter over the largest stiffness.
#[must_use]
pub fn step_length(damping: f64, fabric: &Fabric) -> f64 {
    damping / fabric.warp.max(fabric.weft).max(fabric.diagonal)
}

/// The woven model after one step; nodes that met the boundary are gone, with their springs.
#[must_use]
pub fn step(
    surface: &Surface,
    model: &WovenModel,
    rest: &RestLengths,
    fabric: &Fabric,
    lambda: f64,
) -> WovenModel {
    // Below this many slots a task costs more than it saves.
    const SLOTS_PER_TASK: usize = 256;
    let moved: Vec<Option<(SurfacePoint, DVec3)>> = (0..model.slot_count())
        .into_par_iter()
        .with_min_len(SLOTS_PER_TASK)
        .map(|slot| {
            let point = model.point_in(slot)?;
            let force = gradient(model, slot, rest, fabric);
            let normal = surface.normal(point.triangle);
            let along = force - normal.dot(force) * normal;
            let path = walk(surface, &point, -along, lambda * along.length());
            (!path.met_boundary).then(|| (path.end, path.end.position(surface)))
        })
        .collect();
    model.with_nodes(moved)
}

/// ∂J_E/∂V of the node in a slot, Eq. (12), in N, with the bending of shortened threads.
#[must_use]
pub fn gradient(model: &WovenModel, slot: usize, rest: &RestLengths, fabric: &Fabric) -> DVec3 {
    let place = model.place_in(slot);
    let row = model.index(slot).i;
    let up = model.stride();
    let pull = |other: usize, kind: SpringKind, wanted: f64| {
        if model.point_in(other).is_none() {
            return DVec3::ZERO;
        }
        let spring = place - model.place_in(other);
        let length = spring.length();
        if length > 0.0 {
            stiffness(fabric, kind) * (length - wanted) / length * spring
        } else {
            DVec3::ZERO
        }
    };
    let (warp, weft) = (rest.warp(row), rest.weft());
    let (above, below) = (rest.diagonal(row), rest.diagonal(row - 1));
    pull(slot + 1, SpringKind::Warp, warp)
        + pull(slot - 1, SpringKind::Warp, warp)
        + pull(slot + up, SpringKind::Weft, weft)
        + pull(slot - up, SpringKind::Weft, weft)
        + pull(slot + up + 1, SpringKind::Diagonal, above)
        + pull(slot + up - 1, SpringKind::Diagonal, above)
        + pull(slot - up + 1, SpringKind::Diagonal, below)
        + pull(slot - up - 1, SpringKind::Diagonal, below)
        + straighten(model, slot, 1, fabric.warp, warp)
        + straighten(model, slot, up, fabric.weft, weft)
}

/// In-plane bending of the thread through a node, where it is shorter than wanted.
///
/// A spring below its wanted length pushes its ends apart, and a row of them lowers J_E by buckling
/// into a zigzag in the surface, node by node, since little but the weak diagonals holds it. That
/// drift depends on the grid alone and is no better pattern: the worn thread is under tension and
/// straight. A zigzag of amplitude a is driven by 4 k e a (e the relative shortness) and resisted by
/// 16 k_b a with a bending stiffness k_b, so k_b = k e / 2 outweighs it twice over. It vanishes
/// where threads have their wanted length, and on smooth shapes of n cells it is weaker than the
/// springs by a factor of e (2π / n)² / 2.
fn straighten(
    model: &WovenModel,
    slot: usize,
    stride: usize,
    stiffness: f64,
    wanted: f64,
) -> DVec3 {
    let bend = |centre: usize| {
        // A node's neighbours have slots; their own neighbours are asked for only if they exist.
        let (behind, ahead) = (centre - stride, centre + stride);
        let all = [behind, centre, ahead].into_iter().all(|s| model.point_in(s).is_some());
        if !all {
            return DVec3::ZERO;
        }
        let [a, b, c] = [behind, centre, ahead].map(|s| model.place_in(s));
        let length = 0.5 * (a.distance(b) + b.distance(c));
        let short = (wanted / length - 1.0).max(0.0);
        let along = (c - a).normalize_or_zero();
        let bent = a - 2.0 * b + c;
        0.5 * stiffness * short * (bent - bent.dot(along) * along)
    };
    let beside = |s: usize| if model.point_in(s).is_some() { bend(s) } else { DVec3::ZERO };
    beside(slot - stride) - 2.0 * bend(slot) + beside(slot + stride)
}
