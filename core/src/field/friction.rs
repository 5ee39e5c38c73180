//! The friction needed to hold the worn fabric where it lies.
//!
//! The fit balances springs that are to have their *wanted* lengths; the worn brace has threads
//! that pull with what they are stretched. A thread under tension rests on a frictionless surface
//! only along a geodesic and with the same tension all along; elsewhere a tangential force is left
//! over that friction has to carry. Per area it is the divergence of the tension in the surface,
//! div(T_warp t ⊗ t + T_weft f ⊗ f): a thread's tension times its geodesic curvature, and its
//! change along it (Euler 1769, Eytelwein 1808 for one rope: μ = d ln T / dθ).
//!
//! It is computed from the nodal forces of the linear triangles, minus the gradient with respect to
//! the places in space of
//!
//! E = Σ area₀ ½ (k_warp (ε⁺_warp)² + k_weft (ε⁺_weft)²),
//!
//! rest strain zero, no diagonals (as in the pressure, Lemma 2), threads that pull and never push.
//! Sums of tangential and normal parts over the curvature radius are divided by each other: what
//! noise and triangulation do to neighbouring vertices cancels, because inner forces do.
//!
//! Limits: at a free edge nodal forces are those of the cut threads; within the radius of one
//! nothing is stated. Where nothing presses, or less than a sensor resolves, friction has nothing
//! to work with and none is stated. It is what holds the brace as it is put on; a brace that
//! creeps finds another rest and is not computed. Always from tension, whatever the pressure's
//! formula.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::places::Places;
use super::sampling::Sampling;
use super::surroundings::Surroundings;
use crate::design::Fabric;
use crate::pressure::triangle_stretch;
use crate::surface::{HalfEdgeId, Surface};
use crate::units::N_PER_MM2_PER_KPA;

/// Pressure below which no friction is stated, in kPa: half a mmHg, what a sensor resolves.
const LEAST_KPA: f64 = 0.067;

/// What the worn fabric does to the limb at the places, as means over the radius.
pub(super) struct Pull {
    /// Tangential force per area that friction has to carry, in N/mm².
    pub(super) tangential: Vec<DVec3>,
    /// Normal force per area, in N/mm², positive where it presses.
    pub(super) normal: Vec<f64>,
    /// Whether the place is far enough from the free edges.
    pub(super) inside: Vec<bool>,
}

/// Nodal forces of the tension on the limb's places, in N, by vertex.
fn nodal_forces(disk: &Surface, coordinates: &[DVec2], fabric: &Fabric) -> Vec<DVec3> {
    let mut forces = vec![DVec3::ZERO; disk.vertex_count()];
    for t in disk.triangle_ids() {
        let Some(stretch) = triangle_stretch(disk, coordinates, t) else { continue };
        let corners = disk.triangle(t);
        let [a, b, c] = corners.map(|v| coordinates[v.index()]);
        // Force per width times direction: the derivative of the energy density by F's columns.
        let pull = |k: f64, column: DVec3| {
            let length = column.length();
            if length > 1.0 { k * (length - 1.0) / length * column } else { DVec3::ZERO }
        };
        let warp = pull(fabric.warp, stretch.warp);
        let weft = pull(fabric.weft, stretch.weft);
        for (v, opposite) in corners.into_iter().zip([c - b, a - c, b - a]) {
            // Gradient of the corner's linear function times the area: half the opposite edge,
            // turned inward.
            let gradient = 0.5 * stretch.rest_area.signum() * opposite.perp();
            forces[v.index()] -= gradient.x * warp + gradient.y * weft;
        }
    }
    forces
}

impl Pull {
    #[expect(clippy::too_many_arguments, reason = "one private caller")]
    pub(super) fn new(
        disk: &Surface,
        coordinates: &[DVec2],
        free_edges: &[HalfEdgeId],
        fabric: &Fabric,
        places: &Places,
        sampling: &Sampling,
        surroundings: &Surroundings,
        (normals, areas): (&[DVec3], &[f64]),
    ) -> Self {
        let forces = places.sums(&nodal_forces(disk, coordinates, fabric), DVec3::ZERO);
        let areas = places.sums(areas, 0.0);
        let computed: Vec<(DVec3, f64)> = surroundings
            .all()
            .with_min_len(64)
            .map(|round| {
                let (mut tangential, mut pressing, mut area) = (DVec3::ZERO, 0.0, 0.0);
                for (place, weight) in round {
                    let (force, normal) = (forces[place], normals[place]);
                    let outward = force.dot(normal);
                    tangential += weight * (force - outward * normal);
                    pressing -= weight * outward;
                    area += weight * areas[place];
                }
                if area > 0.0 { (tangential / area, pressing / area) } else { (tangential, 0.0) }
            })
            .collect();
        let (tangential, normal): (Vec<DVec3>, Vec<f64>) = computed.into_iter().unzip();
        // A carried value comes from computed places up to two spacings away.
        let margin = surroundings.radius + 2.0 * sampling.spacing.unwrap_or(0.0);
        let mut inside = vec![true; places.count()];
        let mut visits = places.visits();
        for edge in free_edges.iter().flat_map(|&h| [disk.from(h), disk.to(h)]) {
            for (place, _) in places.within(&mut visits, places.of(edge), margin) {
                inside[place] = false;
            }
        }
        // Tangents of a patch that bends away lean out of its middle's tangent plane.
        let tangential = sampling.spread(&tangential);
        let flat = |(&force, &normal): (&DVec3, &DVec3)| force - force.dot(normal) * normal;
        Self {
            tangential: tangential.iter().zip(normals).map(flat).collect(),
            normal: sampling.spread(&normal),
            inside,
        }
    }

    /// The coefficient of friction needed at each place, where one can be stated.
    pub(super) fn friction(&self) -> Vec<Option<f64>> {
        (0..self.normal.len())
            .map(|k| {
                let presses = self.normal[k] > LEAST_KPA * N_PER_MM2_PER_KPA;
                (self.inside[k] && presses).then(|| self.tangential[k].length() / self.normal[k])
            })
            .collect()
    }
}
