//! Keeping the two orientation markers on a vertical line (section 5.2).
//!
//! The paper turns the planar vertices and lays the fabric anew. Laying anew after every pass would
//! add the error of the mapping every time, so the nodes are moved instead: where the plane should
//! turn by an angle, each node goes to the point of the surface that the turned plane assigns to
//! it, along its own threads. That is the same turn, without any interpolation.

use glam::{DVec2, DVec3};

use crate::geometry::{SurfacePoint, walk};
use crate::surface::Surface;
use crate::weave::{NodeIndex, WovenModel};

/// No node moves farther than this many cells in one turn: beyond, a straight step along the threads
/// is no longer close to the turned place. What is left is turned after the next pass.
const MOST_CELLS: f64 = 0.5;

/// Angle by which the line from `lower` to `upper` leans to the right of the vertical, in radians.
#[must_use]
pub fn lean(upper: DVec2, lower: DVec2) -> f64 {
    let up = upper - lower;
    up.x.atan2(up.y)
}

/// The model after turning its plane by `angle` radians counter-clockwise about `centre` (mm); nodes
/// that leave the surface are gone.
#[must_use]
pub fn turn(surface: &Surface, model: &WovenModel, angle: f64, centre: DVec2) -> WovenModel {
    let farthest = model
        .filled()
        .map(|slot| model.planar(model.index(slot)).distance(centre))
        .fold(model.spacing(), f64::max);
    let most = MOST_CELLS * model.spacing() / farthest;
    let back = DVec2::from_angle(-angle.clamp(-most, most));
    let moved = (0..model.slot_count())
        .map(|slot| {
            let point = model.point_in(slot)?;
            let node = model.index(slot);
            let from = model.planar(node);
            let cells = (back.rotate(from - centre) + centre - from) / model.spacing();
            let along = cells.x * thread(model, node, 0, 1) + cells.y * thread(model, node, 1, 0);
            moved_by(surface, &point, along)
        })
        .collect();
    model.with_nodes(moved)
}

fn moved_by(
    surface: &Surface,
    point: &SurfacePoint,
    along: DVec3,
) -> Option<(SurfacePoint, DVec3)> {
    let path = walk(surface, point, along, along.length());
    (!path.met_boundary).then(|| (path.end, path.end.position(surface)))
}

/// One cell along a thread at a node, in mm; zero where the thread has no other node here.
fn thread(model: &WovenModel, node: NodeIndex, di: i32, dj: i32) -> DVec3 {
    let here = model.place(node);
    let to = |sign: i32| {
        let there = model.place(node.offset(sign * di, sign * dj));
        there.zip(here).map(|(there, here)| f64::from(sign) * (there - here))
    };
    match (to(1), to(-1)) {
        (Some(ahead), Some(behind)) => 0.5 * (ahead + behind),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => DVec3::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::Mapping;
    use crate::surface::VertexId;
    use crate::weave::lay;

    #[test]
    fn small_turns_add_up_and_bring_a_leaning_map_upright() {
        let size = 100.0;
        let points: Vec<DVec3> = [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)]
            .map(|(x, y)| DVec3::new(x, y, 3.0))
            .to_vec();
        let id = VertexId::new;
        let surface =
            Surface::new(points.clone(), vec![[id(0), id(1), id(2)], [id(0), id(2), id(3)]])
                .unwrap();
        // A plane laid leaning by 4° to the right.
        let leaning: Vec<DVec2> = points
            .iter()
            .map(|p| DVec2::from_angle(-4f64.to_radians()).rotate(p.truncate()))
            .collect();
        let mut model = lay(&surface, &leaning, 5.0);
        let planar = |model: &WovenModel| {
            let plane = Mapping::new(&surface, model).vertices().unwrap();
            (plane[3], plane[0], plane[1])
        };
        let (upper, lower, _) = planar(&model);
        assert!((lean(upper, lower).to_degrees() - 4.0).abs() < 1e-9);
        for _ in 0..12 {
            let (upper, lower, _) = planar(&model);
            model = turn(&surface, &model, lean(upper, lower), 0.5 * (upper + lower));
        }
        let (upper, lower, right) = planar(&model);
        assert!(lean(upper, lower).abs() < 1e-9);
        assert!((upper.distance(lower) - size).abs() < 1e-9, "a turn does not stretch");
        assert!(((right - lower).normalize().x - 1.0).abs() < 1e-9);
    }
}
