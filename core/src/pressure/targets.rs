//! Step 2 of the paper: the wanted strain of every thread.
//!
//! All points of one warp thread make one equation (3) for it; the strain function interpolates for
//! the threads without points.

use glam::DVec3;

use super::formula::Wish;
use super::strain_function::{Datum, StrainFunction};
use crate::geometry::{ShapeOperator, SurfacePoint};

/// A wanted pressure, found on the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Annotation {
    /// Where the designer put it, in mm.
    pub at: DVec3,
    /// The nearest point of the cut surface.
    pub point: SurfacePoint,
    /// Wanted normal pressure, in kPa.
    pub kpa: f64,
    /// Shape of the surface there.
    pub shape: ShapeOperator,
}

/// The wanted strain of a warp thread with annotated points.
#[derive(Debug, Clone, PartialEq)]
pub struct ThreadTarget {
    /// Where it lies along weft, in mm, as the fit counts.
    pub y: f64,
    /// The same as the strain function's parameter, in [0, 1].
    pub t: f64,
    /// The annotations on it, by number.
    pub annotations: Vec<usize>,
    /// What Eq. (3) gives, before the fabric's limits; `None` where nothing on it can be pressed.
    pub wanted: Option<f64>,
    /// What is asked of the fit: `wanted` corrected by what the thread has reached so far, within
    /// the fabric's limits.
    pub asked: Option<f64>,
    /// What the strain function gives.
    pub fitted: f64,
}

/// The wanted strains of a fabric.
#[derive(Debug, Clone, PartialEq)]
pub struct Targets {
    /// The strain function ε(t).
    pub function: StrainFunction,
    /// Where t is 0 and where it is 1 along weft, in mm, as the fit counts.
    pub extent: [f64; 2],
    /// The threads with annotated points, from the lowest.
    pub threads: Vec<ThreadTarget>,
    /// Every annotation as a wish on its thread.
    pub wishes: Vec<Wish>,
}

impl Targets {
    /// From threads (from the lowest; their `t` and `fitted` are found here). `row_spacing` in mm is
    /// the distance of threads below which strains are smoothed; `taut` is whether the function is drawn taut.
    #[must_use]
    pub fn new(
        mut threads: Vec<ThreadTarget>,
        wishes: Vec<Wish>,
        extent: [f64; 2],
        max_strain: f64,
        row_spacing: f64,
        taut: bool,
    ) -> Self {
        let length = (extent[1] - extent[0]).max(f64::MIN_POSITIVE);
        for thread in &mut threads {
            thread.t = ((thread.y - extent[0]) / length).clamp(0.0, 1.0);
        }
        let data: Vec<Datum> = threads
            .iter()
            .filter_map(|thread| thread.asked.map(|strain| Datum { t: thread.t, strain }))
            .collect();
        let closest = (row_spacing / length).min(0.5);
        let through = if taut { StrainFunction::taut } else { StrainFunction::new };
        let function = through(&data, max_strain, closest);
        for thread in &mut threads {
            thread.fitted = function.at(thread.t);
        }
        Self { function, extent, threads, wishes }
    }

    /// What the strain function gives the thread of an annotation, correction aside.
    #[must_use]
    pub fn given(&self, annotation: usize) -> Option<f64> {
        let thread = self.threads.iter().find(|t| t.annotations.contains(&annotation))?;
        Some(thread.wanted? + thread.fitted - thread.asked?)
    }
}
