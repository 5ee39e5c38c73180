//! Laying the planar woven mesh on the surface through a planar parameterization Ω (section 3).

use glam::{DVec2, DVec3};

use super::{NodeIndex, WovenModel};
use crate::geometry::SurfacePoint;
use crate::surface::Surface;

/// The woven model whose nodes lie, through the map Ω, at the multiples of `spacing` mm.
///
/// A node in a triangle of Ω takes the same barycentric coordinates in the same triangle of the
/// surface. Nodes that no whole cell holds are dropped. `omega` is by vertex, in mm, x along warp.
#[must_use]
pub fn lay(surface: &Surface, omega: &[DVec2], spacing: f64) -> WovenModel {
    let (low, high) = omega
        .iter()
        .fold((DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY)), |(low, high), &p| {
            (low.min(p), high.max(p))
        });
    let index = |p: DVec2| NodeIndex { i: p.y as i32, j: p.x as i32 };
    let mut model =
        WovenModel::empty(spacing, index((low / spacing).floor()), index((high / spacing).ceil()));
    for triangle in surface.triangle_ids() {
        let corners = surface.triangle(triangle).map(|v| omega[v.index()]);
        let low = corners[0].min(corners[1]).min(corners[2]) / spacing;
        let high = corners[0].max(corners[1]).max(corners[2]) / spacing;
        for i in low.y.ceil() as i32..=high.y.floor() as i32 {
            for j in low.x.ceil() as i32..=high.x.floor() as i32 {
                let node = NodeIndex { i, j };
                // Of several triangles (a node on an edge, a fold of Ω) the first takes the node.
                if model.point(node).is_some() {
                    continue;
                }
                if let Some(barycentric) = inside(model.planar(node), corners) {
                    model.put(node, SurfacePoint { triangle, barycentric }, surface);
                }
            }
        }
    }
    model.drop_loose_nodes();
    model
}

/// The barycentric coordinates of `p` in a counter-clockwise triangle that holds it.
fn inside(p: DVec2, [a, b, c]: [DVec2; 3]) -> Option<DVec3> {
    let weights =
        DVec3::new((c - b).perp_dot(p - b), (a - c).perp_dot(p - c), (b - a).perp_dot(p - a));
    let area = (b - a).perp_dot(c - a);
    (area > 0.0 && weights.min_element() >= 0.0).then(|| weights / weights.element_sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::VertexId;
    use crate::weave::SpringKind;

    #[test]
    fn laid_through_a_squeezed_map_every_warp_spring_is_stretched() {
        let points: Vec<DVec3> = [(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)]
            .map(|(x, y)| DVec3::new(x, y, 7.0))
            .to_vec();
        let omega: Vec<DVec2> =
            points.iter().map(|p| DVec2::new(0.75 * p.x + 0.2, p.y + 0.3)).collect();
        let id = VertexId::new;
        let surface =
            Surface::new(points, vec![[id(0), id(1), id(2)], [id(0), id(2), id(3)]]).unwrap();
        let model = lay(&surface, &omega, 2.0);
        // Ω is 30 by 30 mm, so 15 by 15 nodes.
        assert_eq!(model.node_count(), 225);
        for spring in model.springs() {
            let expected = match spring.kind {
                SpringKind::Warp => 2.0 / 0.75,
                SpringKind::Weft => 2.0,
                SpringKind::Diagonal => (2.0f64 / 0.75).hypot(2.0),
            };
            assert!((spring.length - expected).abs() < 1e-9, "{spring:?}");
        }
    }
}
