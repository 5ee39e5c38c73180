//! One step of the diffusion of elastic energy (section 5.2 of the paper).
//!
//! Every node moves by −λ ∂J_E/∂V (Eqs. 12, 13) along a straightest path of the surface. The
//! gradient's part along the normal does nothing on a surface, so the node moves by the tangential
//! part. All nodes move from the same old places (Jacobi), so threads do not change the result.

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

/// ∂J_E/∂V of the node in a slot, Eq. (12), in N.
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
}
