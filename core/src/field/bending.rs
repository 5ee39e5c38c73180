//! How the limb curves under every place of the brace, over the curvature radius and, where the
//! scan is clean enough, over 5 mm.
//!
//! # When a reading over 5 mm is believed
//!
//! A patch of N points over a radius R whose heights carry independent noise of standard deviation
//! σ has a normal curvature of standard deviation
//!
//! σ_κ = 10.7 σ / (R² √N),
//!
//! for a uniform disk of points fitted by a quadric with the weight 1 − (d/R)² (the sum of both
//! curvatures has variance 307.2 σ² / (N R⁴), their difference 153.6; one of them a quarter of
//! both together, 115.2 = 10.7²). It falls with R³, as measured: 0.3 mm on edges of 2 mm give
//! 30, 4.1 and 1.2 1/m over 5, 10 and 15 mm.
//!
//! σ comes from the scan itself: a patch's residual is σ √(1 − 6/N), six coefficients being fitted.
//! The median over all patches is taken: noise is the scanner's and alike everywhere, whereas a
//! crest that no quadric follows leaves a residual of its own, which must not make its curvature
//! unbelievable just there.
//!
//! A pressure over 5 mm is believed where its standard deviation is at most a twentieth of it. The
//! largest of a thousand patches (5 mm on an elbow) lies some 3.2 standard deviations too high by
//! noise alone: then at most 16 %. With 0.05 mm on edges of 2 mm (σ_κ = 5 1/m) a crest of radius
//! 10 mm is read and a smooth limb is not; with 0.3 mm nothing is.
//!
//! Limit: noise of neighbouring vertices is taken as independent. A scanner that smooths its own
//! noise leaves bumps wider than that, which no residual shows. At an edge of the scan patches are
//! one-sided and several times as uncertain as said.

use std::ops::{Add, Mul};
use std::sync::LazyLock;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::places::Places;
use super::sampling::Sampling;
use crate::geometry::{
    Curvature, ExactPlaces, Locator, ScaleCurvature, ScaleFit, ShapeOperator, SurfacePoint,
};
use crate::parameters::{CurvatureEstimate, Parameters};
use crate::progress::{Progress, in_parts};
use crate::surface::Surface;

/// The smaller radius over which pressure is stated, in mm: about a crest's own.
pub const FINE_RADIUS_MM: f64 = 5.0;

/// A patch of 5 mm with too few points is taken a quarter larger (as on edges of 2.5 mm, where it
/// holds nine to twelve); one that had to grow further says nothing about 5 mm.
const MOST_GROWN_MM: f64 = 1.3 * FINE_RADIUS_MM;

/// σ_κ R² √N / σ, see above: √115.2.
const CURVATURE_PER_NOISE: f64 = 10.733;

/// Coefficients of a patch.
const COEFFICIENTS: f64 = 6.0;

/// Computed places lie this share of the radius apart on fine meshes: over that distance a
/// quadric's curvature over the radius changes by a few per cent of its own range at most.
const SPACING_SHARE: f64 = 0.25;

/// Why no pressure is stated over 5 mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unreadable {
    /// The curvature asked for is already over 5 mm or less, or from the triangles alone.
    NotFiner,
    /// The scan's triangles are too large for a patch of 5 mm.
    TooCoarse {
        /// Mean length of the scan's edges, in mm.
        mean_edge_mm: f64,
    },
    /// The scan's noise hides curvature over 5 mm.
    Noise {
        /// Standard deviation of the noise along the normal, in mm.
        noise_mm: f64,
        /// Standard deviation of a curvature over 5 mm, in 1/mm.
        deviation: f64,
    },
    /// Nothing presses anywhere.
    Slack,
}

impl Unreadable {
    /// What it means, for people.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::NotFiner => {
                "curvature is not taken over a radius larger than 5 mm here".to_owned()
            }
            Self::TooCoarse { mean_edge_mm } => format!(
                "the scan's triangles are too large (edges of {mean_edge_mm:.1} mm) to read \
                 curvature over 5 mm"
            ),
            Self::Noise { noise_mm, deviation } => format!(
                "the scan's noise of {noise_mm:.2} mm makes curvature over 5 mm uncertain by \
                 {:.0} per m",
                1000.0 * deviation
            ),
            Self::Slack => "nothing presses".to_owned(),
        }
    }
}

/// Curvature over 5 mm.
pub(super) struct Fine {
    /// Curvature tensors by place.
    pub(super) tensor: Vec<DMat3>,
    /// Standard deviation of a normal curvature by place, in 1/mm; not finite where the patch had
    /// to be taken larger.
    pub(super) deviation: Vec<f64>,
    /// Standard deviation of the scan's noise along the normal, in mm.
    pub(super) noise_mm: f64,
    /// Median of the finite deviations.
    pub(super) typical_deviation: f64,
}

/// How the limb curves under the places of a brace.
pub(super) struct Bending {
    /// Outward unit normals, smoothed over the radius.
    pub(super) normal: Vec<DVec3>,
    /// Curvature tensors over the curvature radius.
    pub(super) tensor: Vec<DMat3>,
    /// The same over 5 mm.
    pub(super) fine: Result<Fine, Unreadable>,
    /// Where things stated over the radius are computed.
    pub(super) sampling: Sampling,
}

impl Bending {
    /// Curvature of `scan`, the whole surface, at the places; none if the job is cancelled.
    pub(super) fn new(
        scan: &Surface,
        places: &Places,
        parameters: &Parameters,
        progress: &dyn Progress,
    ) -> Option<Self> {
        let mean_edge = scan.mean_edge_length();
        let radius = parameters.curvature_radius;
        let finer = parameters.curvature == CurvatureEstimate::Scale && radius > FINE_RADIUS_MM;
        let (sampling, fine) = rayon::join(
            || Sampling::new(places, mean_edge, SPACING_SHARE * radius),
            || finer.then(|| Sampling::new(places, mean_edge, SPACING_SHARE * FINE_RADIUS_MM)),
        );
        if progress.cancelled() {
            return None;
        }
        let under = Under::new(scan, places, [Some(&sampling), fine.as_ref()], progress)?;
        // What is prepared for either is done one after the other.
        let (shapes, fine) = rayon::join(
            || {
                let curvature = Curvature::new(scan, parameters);
                in_parts(&under.of(&sampling), progress, |_, points| curvature.at_all(points))
            },
            || match &fine {
                Some(sampling) => read_fine(scan, &under, sampling, mean_edge, progress),
                None => Some(Err(Unreadable::NotFiner)),
            },
        );
        let (shapes, fine) = (shapes?, fine?);
        let normals: Vec<DVec3> = shapes.iter().map(|shape| shape.normal).collect();
        let tensors: Vec<DMat3> = shapes.iter().map(ShapeOperator::tensor).collect();
        let unit = |n: DVec3| n.try_normalize().unwrap_or(DVec3::Z);
        Some(Self {
            normal: sampling.spread(&normals).into_iter().map(unit).collect(),
            tensor: sampling.spread(&tensors),
            fine,
            sampling,
        })
    }

    /// The same with further places, each of them between two others.
    pub(super) fn finer(
        mut self,
        places: &Places,
        between: &[[usize; 2]],
        parameters: &Parameters,
        mean_edge: f64,
    ) -> Self {
        extend(&mut self.tensor, between);
        extend(&mut self.normal, between);
        for normal in &mut self.normal {
            *normal = normal.try_normalize().unwrap_or(DVec3::Z);
        }
        if let Ok(fine) = &mut self.fine {
            extend(&mut fine.tensor, between);
            extend(&mut fine.deviation, between);
        }
        self.sampling =
            Sampling::new(places, mean_edge, SPACING_SHARE * parameters.curvature_radius);
        self
    }
}

/// Adds what lies between two values.
fn extend<T>(values: &mut Vec<T>, between: &[[usize; 2]])
where
    T: Copy + Add<Output = T> + Mul<f64, Output = T>,
{
    values.reserve(between.len());
    for &[a, b] in between {
        values.push((values[a] + values[b]) * 0.5);
    }
}

/// The points of the scan under the computed places, each looked for once.
struct Under {
    /// By place; none where nothing is computed.
    points: Vec<Option<SurfacePoint>>,
}

impl Under {
    fn new(
        scan: &Surface,
        places: &Places,
        samplings: [Option<&Sampling>; 2],
        progress: &dyn Progress,
    ) -> Option<Self> {
        let vertices = ExactPlaces::new(scan);
        let locator = LazyLock::new(|| Locator::new(scan));
        let mut wanted = vec![false; places.count()];
        for &seed in samplings.into_iter().flatten().flat_map(|sampling| &sampling.seeds) {
            wanted[seed] = true;
        }
        let nearest = |point: DVec3| {
            vertices.at(point).or_else(|| locator.closest(point).map(|(point, _)| point))
        };
        let points = in_parts(&wanted, progress, |first, wanted| {
            let place = |k: usize| wanted[k].then(|| nearest(places.point(first + k))).flatten();
            (0..wanted.len()).into_par_iter().map(place).collect()
        })?;
        Some(Self { points })
    }

    fn of(&self, sampling: &Sampling) -> Vec<SurfacePoint> {
        // A brace's scan has triangles, and then there is a nearest point.
        sampling.seeds.iter().filter_map(|&seed| self.points[seed]).collect()
    }
}

/// None if the job is cancelled.
fn read_fine(
    scan: &Surface,
    under: &Under,
    sampling: &Sampling,
    mean_edge: f64,
    progress: &dyn Progress,
) -> Option<Result<Fine, Unreadable>> {
    let curvature = ScaleCurvature::new(scan, FINE_RADIUS_MM);
    let fits = in_parts(&under.of(sampling), progress, |_, points| curvature.fit_all(points))?;
    Some(fine_of(&fits, sampling, mean_edge))
}

fn fine_of(fits: &[ScaleFit], sampling: &Sampling, mean_edge: f64) -> Result<Fine, Unreadable> {
    let fits: Vec<Option<ScaleFit>> = fits
        .iter()
        .copied()
        .map(|fit| Some(fit).filter(|f| f.radius_used > 0.0 && f.radius_used <= MOST_GROWN_MM))
        .collect();
    let noise = |fit: &ScaleFit| fit.residual_mm / (1.0 - COEFFICIENTS / fit.points as f64).sqrt();
    let noise_mm = median(fits.iter().flatten().map(noise).collect())
        .ok_or(Unreadable::TooCoarse { mean_edge_mm: mean_edge })?;
    let deviation: Vec<f64> = fits
        .iter()
        .map(|fit| {
            fit.map_or(f64::INFINITY, |fit| {
                let squared = fit.radius_used * fit.radius_used;
                CURVATURE_PER_NOISE * noise_mm / (squared * (fit.points as f64).sqrt())
            })
        })
        .collect();
    let tensors: Vec<DMat3> =
        fits.iter().map(|fit| fit.map_or(DMat3::ZERO, |fit| fit.shape.tensor())).collect();
    let finite: Vec<f64> = deviation.iter().copied().filter(|d| d.is_finite()).collect();
    Ok(Fine {
        tensor: sampling.spread(&tensors),
        deviation: sampling.spread(&deviation),
        noise_mm,
        typical_deviation: median(finite).unwrap_or(f64::INFINITY),
    })
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Normal curvature along a direction by a tensor at a place with this normal, in 1/mm.
pub(super) fn along(tensor: &DMat3, normal: DVec3, direction: DVec3) -> f64 {
    let tangent = direction - direction.dot(normal) * normal;
    let squared = tangent.length_squared();
    if squared > 0.0 { tangent.dot(*tensor * tangent) / squared } else { 0.0 }
}

/// Mean curvature by a tensor, in 1/mm.
pub(super) fn mean(tensor: &DMat3) -> f64 {
    0.5 * (tensor.x_axis.x + tensor.y_axis.y + tensor.z_axis.z)
}
