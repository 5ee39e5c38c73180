//! The noise of a scan, and a surface without it.
//!
//! Noise makes lengths on a scan longer than those of a fabric that lies on the limb (0.3 mm on
//! edges of 2.4 mm: 1.6 %) and curvature uncertain. A noisy surface is replaced by its own patches:
//! every vertex moves along the normal onto the patch fitted to the vertices within a radius, the
//! one that curvature is read from (moving least squares, Levin, *Mesh-independent surface
//! interpolation*, 2003, with one projection).
//!
//! Limits: what is smaller than the radius goes with the noise, a bony crest too. Holes and edges keep
//! their outline but for the move along the normal.

use std::f64::consts::PI;

use super::curvature::{ScaleCurvature, ScaleFit};
use crate::surface::Surface;

/// Noise is read from patches of these many mean edges in radius, some 17 and 40 vertices.
const NOISE_EDGES: [f64; 2] = [2.2, 3.3];

/// The limb's own shape leaves a patch by the cube of its radius (and squared by the sixth power);
/// noise leaves patches of any radius alike.
const SHAPE_POWER: i32 = 6;

/// In a patch of more than this radius, in mm, a limb's own shape has no simple power: half a wrist.
const LARGEST_PATCH: f64 = 20.0;

/// Noise is read at this many vertices at most.
const NOISE_SAMPLES: usize = 2000;

/// A patch has six coefficients.
const COEFFICIENTS: usize = 6;

/// Standard deviation of a surface's noise along its normal, in mm: the median over its vertices, so
/// that creases and edges do not count.
///
/// What patches of two radii leave unexplained is told apart into shape, which grows with the
/// radius, and noise, which does not. Zero for a mesh too coarse to tell them apart.
#[must_use]
pub fn noise(surface: &Surface) -> f64 {
    let edge = surface.mean_edge_length();
    if NOISE_EDGES[1] * edge > LARGEST_PATCH {
        return 0.0;
    }
    let patches = NOISE_EDGES.map(|edges| ScaleCurvature::new(surface, edges * edge));
    let shape = (NOISE_EDGES[0] / NOISE_EDGES[1]).powi(SHAPE_POWER);
    let step = surface.vertex_count().div_ceil(NOISE_SAMPLES).max(1);
    let [near, far] = patches.map(|patches| patches.fit_vertices(step));
    let mut variances: Vec<f64> = near
        .iter()
        .zip(&far)
        .filter_map(|(near, far)| {
            let [near, far] = [unexplained(near)?, unexplained(far)?];
            Some(((near - shape * far) / (1.0 - shape)).max(0.0))
        })
        .collect();
    variances.sort_by(f64::total_cmp);
    variances.get(variances.len() / 2).map_or(0.0, |variance| variance.sqrt())
}

/// Variance that a patch leaves unexplained, in mm².
fn unexplained(fit: &ScaleFit) -> Option<f64> {
    // The fit has taken up part of the noise.
    let free = fit.points.checked_sub(COEFFICIENTS).filter(|&free| free > 0)?;
    Some(fit.residual_mm.powi(2) * fit.points as f64 / free as f64)
}

/// The surface with every vertex on the patch fitted within `radius` mm of it.
#[must_use]
pub fn smooth(surface: &Surface, radius: f64) -> Surface {
    let fits = ScaleCurvature::new(surface, radius).fit_vertices(1);
    let moved = surface.points().iter().zip(&fits);
    let points = moved.map(|(&p, fit)| p + fit.offset_mm * fit.shape.normal).collect();
    surface.with_points(points)
}

/// Standard deviation of curvature read over a radius (mm) on a surface with so much noise (mm), in
/// 1/mm.
///
/// A patch of N vertices gives 13 σ / (R² √N): the factor holds within a tenth for patches of 23, 90
/// and 204 vertices (0.3 mm on edges of 2 mm over 5, 10 and 15 mm: 30, 4.1 and 1.2 1/m).
#[must_use]
pub fn curvature_noise(surface: &Surface, noise: f64, radius: f64) -> f64 {
    let density = surface.vertex_count() as f64 / surface.total_area().max(f64::MIN_POSITIVE);
    let vertices = (PI * radius * radius * density).max(COEFFICIENTS as f64);
    13.0 * noise / (radius * radius * vertices.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shapes::{cylinder, noisy, torus_quarter};
    use crate::surface::VertexId;

    const RADIUS: f64 = 45.0;

    fn spread(values: impl Iterator<Item = f64>) -> f64 {
        let values: Vec<f64> = values.collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
    }

    /// Vertices away from the ends.
    fn inner(surface: &Surface) -> Vec<VertexId> {
        let inside = |v: &VertexId| (20.0..100.0).contains(&surface.point(*v).z);
        surface.vertex_ids().filter(inside).collect()
    }

    #[test]
    fn noise_is_measured() {
        let clean = cylinder(RADIUS, 120.0, 2.4);
        assert!(noise(&clean) < 0.005, "{}", noise(&clean));
        for edge in [5.0, 12.0] {
            let coarse = torus_quarter(80.0, 40.0, edge);
            assert!(noise(&coarse) < 0.02, "{edge}: {}", noise(&coarse));
        }
        for deviation in [0.1, 0.3] {
            let measured = noise(&noisy(&clean, deviation, 3));
            assert!((measured / deviation - 1.0).abs() < 0.15, "{deviation}: {measured}");
        }
    }

    #[test]
    fn a_clean_surface_stays_where_it_is() {
        let clean = cylinder(RADIUS, 120.0, 2.4);
        let smoothed = smooth(&clean, 10.0);
        let moves = clean.points().iter().zip(smoothed.points()).map(|(a, b)| a.distance(*b));
        assert!(moves.fold(0.0, f64::max) < 0.01);
    }

    #[test]
    fn a_noisy_cylinder_is_round_again_and_its_curvature_calmer() {
        let rough = noisy(&cylinder(RADIUS, 120.0, 2.4), 0.3, 7);
        let smoothed = smooth(&rough, 10.0);
        let off = |s: &Surface| {
            spread(inner(s).into_iter().map(|v| s.point(v).truncate().length() - RADIUS))
        };
        let curvature = |s: &Surface| {
            let field = ScaleCurvature::new(s, 10.0);
            spread(inner(s).into_iter().map(|v| {
                let round = glam::DVec3::Z.cross(s.point(v));
                1000.0 * field.at_vertex(v).normal_curvature(round)
            }))
        };
        eprintln!(
            "{} {} {} {}",
            off(&rough),
            off(&smoothed),
            curvature(&rough),
            curvature(&smoothed)
        );
        assert!(off(&smoothed) < 0.4 * off(&rough));
        assert!(curvature(&smoothed) < 0.75 * curvature(&rough));
    }
}
