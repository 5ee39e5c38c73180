//! One step of the diffusion of elastic energy (section 5.2 of the paper).
//!
//! Every node moves by −λ ∂J_E/∂V (Eqs. 12, 13) along a straightest path of the surface. The
//! gradient's part along the normal does nothing on a surface, so the node moves by the tangential
//! part. Threads shorter than wanted are kept from buckling, see [`gradient`]. All nodes move from the same old places (Jacobi), so threads do not change the result.

use glam::DVec3;
use rayon::prelude::*;

use crate::design::Fabric;
use crate::fit::stiffness;
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

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::fit::Misfit;
    use crate::geometry::shapes::grid;
    use crate::weave::{NodeIndex, lay};

    fn fabric() -> Fabric {
        Fabric { warp: 0.7, weft: 1.9, diagonal: 0.11, ..Fabric::default() }
    }

    /// A stretched, sheared and unevenly laid square; `wanted` is the strain asked of its rows.
    fn uneven(wanted: f64) -> (Surface, WovenModel, RestLengths) {
        let surface = grid(30, 30, false, |s, t| DVec3::new(90.0 * s, 90.0 * t, 0.0));
        let plane: Vec<DVec2> = surface
            .points()
            .iter()
            .map(|p| {
                let (x, y) = (p.x / 1.3, p.y / 1.2);
                DVec2::new(x + 0.1 * y + (y / 9.0).sin(), y + 0.7 * (x / 11.0).cos()) + 0.4
            })
            .collect();
        let model = lay(&surface, &plane, 6.0);
        let rows = vec![wanted, 0.5 * wanted, wanted, 0.2 * wanted];
        (surface, model, RestLengths::new(6.0, 2, rows, 0.02))
    }

    #[test]
    fn the_gradient_is_that_of_the_energy_where_threads_are_stretched() {
        let (_, model, rest) = uneven(0.05);
        let shortest = model
            .springs()
            .filter_map(|s| Some(s.length / 6.0 - 1.0 - rest.strain(s.kind, s.a)?))
            .fold(f64::INFINITY, f64::min);
        assert!(shortest > 0.0, "{shortest}: a thread is short, and bends");
        let h = 1e-6;
        for slot in model.filled() {
            let energy_at = |offset: DVec3| {
                let nodes = (0..model.slot_count())
                    .map(|s| {
                        let off = if s == slot { offset } else { DVec3::ZERO };
                        model.point_in(s).map(|p| (p, model.place_in(s) + off))
                    })
                    .collect();
                Misfit::of(&model.with_nodes(nodes), &rest, &fabric()).energy
            };
            let difference = DVec3::from_array(
                [DVec3::X, DVec3::Y, DVec3::Z]
                    .map(|axis| (energy_at(h * axis) - energy_at(-h * axis)) / (2.0 * h)),
            );
            let force = gradient(&model, slot, &rest, &fabric());
            assert!(force.distance(difference) < 1e-7, "{force} {difference}");
        }
    }

    #[test]
    fn steps_lower_the_energy_and_do_not_depend_on_threads() {
        let (surface, start, rest) = uneven(0.05);
        let lambda = step_length(0.125, &fabric());
        let energy = |model: &WovenModel| {
            let misfit = Misfit::of(model, &rest, &fabric());
            misfit.energy / misfit.springs as f64
        };
        let mut model = start.clone();
        for _ in 0..20 {
            let next = step(&surface, &model, &rest, &fabric(), lambda);
            assert!(energy(&next) < energy(&model));
            model = next;
        }
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again = alone.install(|| {
            (0..20).fold(start, |model, _| step(&surface, &model, &rest, &fabric(), lambda))
        });
        assert_eq!(again, model);
    }

    #[test]
    fn a_shortened_row_straightens_instead_of_buckling() {
        let surface = grid(40, 40, false, |s, t| DVec3::new(120.0 * s, 120.0 * t, 0.0));
        let plane: Vec<DVec2> =
            surface.points().iter().map(|p| p.truncate() / DVec2::new(0.9, 1.0) + 0.4).collect();
        // Every warp thread is a tenth shorter than wanted, and zigzags by a twentieth of a mm.
        let laid = lay(&surface, &plane, 5.0);
        let nodes = (0..laid.slot_count())
            .map(|slot| {
                let odd = laid.index(slot).j.rem_euclid(2) == 1;
                let off = if odd { 0.05 } else { -0.05 } * DVec3::Y;
                let path = walk(&surface, &laid.point_in(slot)?, off, off.length());
                Some((path.end, path.end.position(&surface)))
            })
            .collect();
        let mut model = laid.with_nodes(nodes);
        let soft = Fabric { diagonal: 0.0, ..Fabric::default() };
        let rest = RestLengths::new(5.0, 0, vec![0.0], 0.0);
        let middle = |model: &WovenModel| {
            let at = |j| model.place(NodeIndex { i: 12, j }).unwrap().y;
            ((at(12) - 2.0 * at(13) + at(14)) / 4.0).abs()
        };
        let before = middle(&model);
        assert!((before - 0.05).abs() < 1e-9);
        for _ in 0..20 {
            model = step(&surface, &model, &rest, &soft, step_length(0.125, &soft));
        }
        assert!(middle(&model) < 0.5 * before, "{} {before}", middle(&model));
    }
}
