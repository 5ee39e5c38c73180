//! The surface-plane mapping (section 4.4): from the woven nodes to every vertex of the surface.
//!
//! Eqs. (8) and (9) give a vertex the planar place of its closest node plus its projections on that
//! node's warp and weft threads, each in the ratio of rest length to present length. Three
//! departures, so that the pattern has no steps of up to half a cell times the shear:
//!
//! - the two projections are solved together (Gram matrix), which is Eqs. (8) and (9) where threads
//!   cross at a right angle, and exact where the fabric is sheared;
//! - the projected offset keeps its length in space, as if the surface were rolled out: over two
//!   cells of a forearm the projection alone is 0.15 mm short;
//! - a vertex takes the mean of what the nodes round it say, with a smooth weight that ends a few cells
//!   away, so that the map is continuous where the closest node changes; inside the fabric and
//!   beyond its last cells alike. Where that still folds it is repaired, see `unfold`.

mod unfold;

use std::collections::VecDeque;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::geometry::SurfacePoint;
use crate::surface::Surface;
use crate::weave::{NodeIndex, NodeSearch, WovenModel};

/// A woven model that covers too little of the surface to map it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MappingError {
    /// No node near a point of the surface.
    #[error(
        "no woven node within {limit:.0} mm of ({:.1}, {:.1}, {:.1}) mm: the surface is narrower \
         than the spacing there; use a smaller `spacing`",
        place.x, place.y, place.z
    )]
    Uncovered {
        /// Where, in mm.
        place: DVec3,
        /// How far was searched, in mm.
        limit: f64,
    },
}

/// Nodes up to this many cells beyond the edge's depth have a say in a vertex's place.
const BLEND_CELLS: usize = 2;

/// What a node says counts by how deep it lies in the fabric: 1 from so many cells on, and
/// [`EDGE_WEIGHT`] times less for each cell nearer to the edge. The fabric ends in steps of whole
/// cells, and the short rows of a step follow their own wanted strain, up to a millimetre off the
/// rows behind them; a pattern that followed them would have a wavy outline.
const FULL_DEPTH: usize = 2;

/// See [`FULL_DEPTH`]. Never zero, for narrow places without deep nodes.
const EDGE_WEIGHT: f64 = 0.01;

/// Over more than this, in mm, a surface bends too far away for a thread to be prolonged straight:
/// the edge is less deep on a coarse level.
const FARTHEST_PROLONGED: f64 = 10.0;

/// An offset is given back no more than this times its projected length: a node seen at more than
/// 35° out of its plane says little, and should not say it loudly.
const MOST_UNROLL: f64 = 1.22;

/// The surface-plane mapping of a woven model.
pub struct Mapping<'a> {
    surface: &'a Surface,
    model: &'a WovenModel,
    search: NodeSearch<'a>,
    /// What each slot's node counts.
    weights: Vec<f64>,
    /// How far away, in cells, a node has a say.
    radius: f64,
}

impl<'a> Mapping<'a> {
    /// Prepares the mapping.
    #[must_use]
    pub fn new(surface: &'a Surface, model: &'a WovenModel) -> Self {
        let depth = FULL_DEPTH.min((FARTHEST_PROLONGED / model.spacing()).round() as usize);
        Self {
            surface,
            model,
            search: NodeSearch::new(surface, model),
            weights: weights(model, depth),
            radius: (BLEND_CELLS + depth) as f64,
        }
    }

    /// Planar coordinates (mm, x along warp, y along weft) of every vertex of the surface.
    ///
    /// # Errors
    /// If some vertex is far from every node.
    pub fn vertices(&self) -> Result<Vec<DVec2>, MappingError> {
        let closest = self.closest_nodes()?;
        let places = self.surface.points();
        let seen: Vec<Result<DVec2, MappingError>> = closest
            .par_iter()
            .zip(places)
            .map(|(&slot, &place)| self.seen_from(slot, place))
            .collect();
        // One after the other, so that of several errors the same one is reported every time.
        let plane = seen.into_iter().collect::<Result<Vec<DVec2>, MappingError>>()?;
        Ok(unfold::unfolded(self, &closest, plane))
    }

    /// The closest node of every vertex, by slot: from vertex to vertex along the surface, each
    /// starting at the node of the one before and going from node to node while that gets closer.
    fn closest_nodes(&self) -> Result<Vec<usize>, MappingError> {
        let mut closest: Vec<Option<usize>> = vec![None; self.surface.vertex_count()];
        let mut queue = VecDeque::new();
        for t in self.surface.triangle_ids() {
            // A new component: its first corner is searched for from scratch.
            let first = self.surface.triangle(t)[0];
            if closest[first.index()].is_none() {
                let corner = SurfacePoint { triangle: t, barycentric: DVec3::X };
                closest[first.index()] = Some(self.search_closest(&corner)?);
                queue.push_back(first);
            }
            while let Some(v) = queue.pop_front() {
                let Some(start) = closest[v.index()] else { continue };
                for n in self.surface.neighbours(v) {
                    if closest[n.index()].is_none() {
                        closest[n.index()] = Some(self.descend(start, self.surface.point(n)));
                        queue.push_back(n);
                    }
                }
            }
        }
        Ok(closest.into_iter().flatten().collect())
    }

    fn search_closest(&self, point: &SurfacePoint) -> Result<usize, MappingError> {
        // Corners of the surface can be a few cells from the last whole cell of the fabric.
        let limit = 8.0 * self.model.spacing();
        let found = self.search.closest(point, limit);
        let uncovered = || MappingError::Uncovered { place: point.position(self.surface), limit };
        found.map(|(slot, _)| slot).ok_or_else(uncovered)
    }

    /// The node at which no neighbouring node is closer to a place.
    fn descend(&self, mut slot: usize, place: DVec3) -> usize {
        let distance = |slot: usize| self.model.place_in(slot).distance_squared(place);
        loop {
            let node = self.model.index(slot);
            let next = (-1..=1)
                .flat_map(|di| (-1..=1).map(move |dj| node.offset(di, dj)))
                .filter_map(|n| self.model.slot(n).filter(|&s| self.model.point_in(s).is_some()))
                .fold(slot, |best, s| if distance(s) < distance(best) { s } else { best });
            if next == slot {
                return slot;
            }
            slot = next;
        }
    }

    /// Planar coordinates (mm) of one point of the surface.
    ///
    /// # Errors
    /// If it is far from every node.
    pub fn point(&self, point: &SurfacePoint) -> Result<DVec2, MappingError> {
        self.seen_from(self.search_closest(point)?, point.position(self.surface))
    }

    /// Planar coordinates (mm) of a place whose closest node is in `slot`.
    fn seen_from(&self, slot: usize, place: DVec3) -> Result<DVec2, MappingError> {
        let first = predict(self.model, self.model.index(slot), place)
            .ok_or(MappingError::Uncovered { place, limit: self.model.spacing() })?;
        // Again round the first mean: the closest node alone may be one at the edge.
        let mean = self.blend(place, first);
        Ok(self.blend(place, mean) * self.model.spacing())
    }

    /// Planar coordinates (mm) of a place as one node alone sees it, Eqs. (8) and (9).
    fn seen_alone(&self, slot: usize, place: DVec3) -> Option<DVec2> {
        let says = predict(self.model, self.model.index(slot), place)?;
        Some(says * self.model.spacing())
    }

    /// The mean of what the nodes round the index coordinates `about` say of a place.
    fn blend(&self, place: DVec3, about: DVec2) -> DVec2 {
        let reach = self.radius.ceil() as i32;
        let middle = NodeIndex { i: about.y.round() as i32, j: about.x.round() as i32 };
        let mut sum = DVec2::ZERO;
        let mut total = 0.0;
        for di in -reach..=reach {
            for dj in -reach..=reach {
                let node = middle.offset(di, dj);
                let off = DVec2::new(f64::from(node.j), f64::from(node.i)) - about;
                let near = 1.0 - off.length_squared() / (self.radius * self.radius);
                if near <= 0.0 {
                    continue;
                }
                let Some(slot) = self.model.slot(node) else { continue };
                if let Some(says) = predict(self.model, node, place) {
                    // The sixth power: inside the fabric the nearest nodes decide.
                    let weight = self.weights[slot] * near.powi(6);
                    sum += weight * says;
                    total += weight;
                }
            }
        }
        if total > 0.0 { sum / total } else { about }
    }
}

/// What each slot's node counts, by its depth in the fabric.
fn weights(model: &WovenModel, depth: usize) -> Vec<f64> {
    let filled: Vec<bool> =
        (0..model.slot_count()).map(|slot| model.point_in(slot).is_some()).collect();
    let mut weights = vec![EDGE_WEIGHT.powi(depth as i32); filled.len()];
    let mut inside = filled;
    let up = model.stride();
    for _ in 0..depth {
        // The model keeps a ring of empty slots, so a node's neighbours all have slots.
        inside = (0..inside.len())
            .map(|slot| {
                inside[slot]
                    && [slot - up, slot, slot + up]
                        .into_iter()
                        .all(|s| inside[s - 1] && inside[s] && inside[s + 1])
            })
            .collect();
        for (weight, inside) in weights.iter_mut().zip(&inside) {
            if *inside {
                *weight /= EDGE_WEIGHT;
            }
        }
    }
    weights
}

/// Index coordinates (j, i) of a place as seen from one node: Eqs. (8), (9) over the spacing.
fn predict(model: &WovenModel, node: NodeIndex, place: DVec3) -> Option<DVec2> {
    let origin = model.place(node)?;
    let at = |di, dj| model.place(node.offset(di, dj)).map(|p| p - origin);
    let offset = place - origin;
    let warp = thread(offset, at(0, 1), at(0, -1))?;
    let weft = thread(offset, at(1, 0), at(-1, 0))?;
    // Least squares of offset = u warp + v weft.
    let (ww, wf, ff) = (warp.length_squared(), warp.dot(weft), weft.length_squared());
    let (dw, df) = (offset.dot(warp), offset.dot(weft));
    let determinant = ww * ff - wf * wf;
    // Threads that have become parallel span no plane.
    if determinant <= 1e-6 * ww * ff {
        return None;
    }
    let u = (dw * ff - df * wf) / determinant;
    let v = (df * ww - dw * wf) / determinant;
    // The projection foreshortens an offset that bends away with the surface: it gets its length
    // back, as if the surface were rolled out here.
    let projected = (u * warp + v * weft).length();
    let unroll = if projected > 0.0 { offset.length() / projected } else { 1.0 };
    let (u, v) = (u * unroll.min(MOST_UNROLL), v * unroll.min(MOST_UNROLL));
    Some(DVec2::new(f64::from(node.j) + u, f64::from(node.i) + v))
}

/// The thread on the side of the offset, pointing to growing index; the existing one at the edge.
fn thread(offset: DVec3, ahead: Option<DVec3>, behind: Option<DVec3>) -> Option<DVec3> {
    match (ahead, behind) {
        (Some(a), Some(b)) => Some(if offset.dot(a - b) >= 0.0 { a } else { -b }),
        (Some(a), None) => Some(a),
        (None, Some(b)) => Some(-b),
        (None, None) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::VertexId;
    use crate::weave::lay;

    fn grid(nx: usize, ny: usize, f: impl Fn(f64, f64) -> DVec3) -> (Surface, Vec<DVec2>) {
        let mut points = Vec::new();
        let mut plane = Vec::new();
        for i in 0..=ny {
            for j in 0..=nx {
                let p = DVec2::new(j as f64, i as f64) * 2.0 + DVec2::new(0.3, 0.7);
                plane.push(p);
                points.push(f(p.x, p.y));
            }
        }
        let id = |i: usize, j: usize| VertexId::new(i * (nx + 1) + j);
        let mut triangles = Vec::new();
        for i in 0..ny {
            for j in 0..nx {
                triangles.push([id(i, j), id(i, j + 1), id(i + 1, j + 1)]);
                triangles.push([id(i, j), id(i + 1, j + 1), id(i + 1, j)]);
            }
        }
        (Surface::new(points, triangles).unwrap(), plane)
    }

    #[test]
    fn an_affine_map_with_shear_is_recovered_exactly() {
        let (surface, plane) = grid(30, 20, |x, y| DVec3::new(1.2 * x + 0.3 * y, 0.9 * y, 4.0));
        let model = lay(&surface, &plane, 5.0);
        let mapped = Mapping::new(&surface, &model).vertices().unwrap();
        for (got, want) in mapped.iter().zip(&plane) {
            assert!(got.distance(*want) < 1e-9, "{got} {want}");
        }
    }

    #[test]
    fn a_cylinder_is_mapped_to_a_tenth_of_a_millimetre() {
        let r = 40.0;
        let (surface, plane) =
            grid(60, 20, |x, y| DVec3::new(r * (x / r).sin(), y, r * (x / r).cos()));
        let model = lay(&surface, &plane, 5.0);
        let mapped = Mapping::new(&surface, &model).vertices().unwrap();
        let worst = mapped.iter().zip(&plane).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(worst < 0.1, "{worst}");
    }

    #[test]
    fn a_surface_without_fabric_is_refused_by_place() {
        let (surface, _) = grid(2, 2, |x, y| DVec3::new(x, y, 0.0));
        let empty = WovenModel::empty(1.0, NodeIndex { i: 0, j: 0 }, NodeIndex { i: 1, j: 1 });
        let message = Mapping::new(&surface, &empty).vertices().unwrap_err().to_string();
        assert!(message.contains("(0.3, 0.7, 0.0) mm"), "{message}");
    }
}
