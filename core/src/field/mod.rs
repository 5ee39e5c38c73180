//! Strain, pressure and the friction needed at every vertex of the worn brace, not only where
//! pressure was wanted.
//!
//! Everything is read from the pattern (pattern coordinates against places in space) and the scan,
//! so that it holds for every way of fitting and can be recomputed from the written files:
//!
//! - strain: means of the triangles round a vertex, by their area in the pattern;
//! - curvature along the threads: that of the whole scan over `curvature_radius`, and over 5 mm
//!   where the scan's noise allows;
//! - pressure: the design's own formula from these;
//! - friction: the tangential force that the threads' tension leaves over, against its normal
//!   force.
//!
//! At a seam strain and pressure are the means of both sides: strains by area in the pattern,
//! pressures by area on the limb, each side with its own threads' directions.
//!
//! Limit: on meshes much finer than the radius, curvature and friction are computed at places a
//! quarter of the radius apart and carried to the others; [`Field::sampled_every_mm`] says so.

mod bending;
mod cloth;
mod friction;
mod places;
mod reachable;
mod sampling;
mod summary;
mod surroundings;
#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

pub use bending::{FINE_RADIUS_MM, Unreadable};
pub use reachable::reachable_kpa;
pub use summary::{COMPRESSED_BELOW, LIFTING_BELOW_KPA, Peak, RowMean, SKIN_FRICTION, Summary};

use crate::design::{Fabric, PressureModel};
use crate::parameters::Parameters;
use crate::pressure::{LocalCurvature, pressure_kpa};
use crate::progress::Progress;
use crate::seams::{Finer, Seam};
use crate::surface::{HalfEdgeId, Surface};
use bending::{Bending, along, mean};
use cloth::Cloth;
use friction::Pull;
use places::Places;
use surroundings::Surroundings;

/// The most that a pressure over 5 mm may be uncertain, as a share of it; see `bending.rs`.
const MOST_UNCERTAIN: f64 = 0.05;

/// How the limb curves under the cut surface: what of the field does not change with the pattern.
pub struct Relief {
    places: Places,
    bending: Bending,
    surroundings: Surroundings,
    /// Of the scan's edges, in mm.
    mean_edge: f64,
}

impl std::fmt::Debug for Relief {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Relief").field("spacing", &self.bending.sampling.spacing).finish()
    }
}

impl Relief {
    /// Reads it from the whole scan, uncut: the limb goes on under the edge of the brace. `parameters`
    /// give `curvature` and `curvature_radius`. None if the job is cancelled.
    #[must_use]
    pub fn new(
        scan: &Surface,
        disk: &Surface,
        seams: &[Seam],
        parameters: &Parameters,
        progress: &dyn Progress,
    ) -> Option<Self> {
        let places = Places::new(disk, seams);
        let mean_edge = scan.mean_edge_length();
        let bending = Bending::new(scan, &places, parameters, progress)?;
        Self::with(disk, places, bending, mean_edge, parameters, progress)
    }

    /// The same on smaller triangles of the same cut surface: what was read is carried to the further vertices. None if
    /// the job is cancelled.
    #[must_use]
    pub fn finer(
        self,
        finer: &Finer,
        parameters: &Parameters,
        progress: &dyn Progress,
    ) -> Option<Self> {
        let Self { places: before, bending, mean_edge, .. } = self;
        let places = Places::new(&finer.cut.disk, &finer.cut.seams);
        let between = places.between(before.count(), finer);
        let bending = bending.finer(&places, &between, parameters, mean_edge);
        Self::with(&finer.cut.disk, places, bending, mean_edge, parameters, progress)
    }

    fn with(
        disk: &Surface,
        places: Places,
        bending: Bending,
        mean_edge: f64,
        parameters: &Parameters,
        progress: &dyn Progress,
    ) -> Option<Self> {
        /// The radius of the means is at least this many edges: less is a single ring of triangles.
        const LEAST_EDGES: f64 = 2.0;
        let radius = parameters.curvature_radius.max(LEAST_EDGES * disk.mean_edge_length());
        let surroundings = Surroundings::new(&places, &bending.sampling, radius, progress)?;
        Some(Self { places, bending, surroundings, mean_edge })
    }
}

/// A worn brace whose field is wanted.
#[derive(Clone, Copy)]
pub struct FieldInput<'a> {
    /// How the limb curves.
    pub relief: &'a Relief,
    /// The cut surface.
    pub disk: &'a Surface,
    /// Pattern coordinates of its vertices, in mm.
    pub coordinates: &'a [DVec2],
    /// The boundary half-edges that are not sewn.
    pub free_edges: &'a [HalfEdgeId],
    /// The fabric.
    pub fabric: &'a Fabric,
    /// The formula between tension and pressure.
    pub pressure_model: PressureModel,
    /// Those of the relief.
    pub parameters: &'a Parameters,
}

/// What the worn brace is and does at every vertex of the disk.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Strain along warp.
    pub warp_strain: Vec<f64>,
    /// Strain along weft.
    pub weft_strain: Vec<f64>,
    /// Present area over rest area.
    pub area_stretch: Vec<f64>,
    /// Direction of the warp thread in space, of unit length, from the vertex's own side of a seam.
    pub warp_direction: Vec<DVec3>,
    /// Direction of the weft thread.
    pub weft_direction: Vec<DVec3>,
    /// Curvature over `radius_mm` along the threads, in 1/mm, outward positive.
    pub curvature: Vec<LocalCurvature>,
    /// Pressure by the design's formula, in kPa; negative where the fabric would lift off.
    pub pressure_kpa: Vec<f64>,
    /// The same with curvature over 5 mm, where the scan is clean enough for it.
    pub fine_pressure_kpa: Vec<Option<f64>>,
    /// Why it is nowhere.
    pub fine_unreadable: Option<Unreadable>,
    /// Standard deviation of the scan's noise along the normal, in mm, where curvature was read
    /// over 5 mm at all.
    pub noise_mm: Option<f64>,
    /// The coefficient of friction needed to hold the fabric; `None` within the radius of a free
    /// edge and where less than half a mmHg presses.
    pub friction: Vec<Option<f64>>,
    /// A third of the area of the vertex's triangles on the limb, in mm².
    pub area_mm2: Vec<f64>,
    /// The curvature radius, in mm.
    pub radius_mm: f64,
    /// How far apart curvature and friction were computed, in mm; `None` for every vertex.
    pub sampled_every_mm: Option<f64>,
}

/// The field of a worn brace.
#[must_use]
pub fn everywhere(input: &FieldInput<'_>) -> Field {
    let Relief { places, bending, surroundings, .. } = input.relief;
    let cloth = Cloth::new(input.disk, input.coordinates);

    let pull = Pull::new(
        input.disk,
        input.coordinates,
        input.free_edges,
        input.fabric,
        places,
        &bending.sampling,
        surroundings,
        (&bending.normal, &cloth.worn_area),
    );

    let curvature: Vec<LocalCurvature> = input
        .disk
        .vertex_ids()
        .map(|v| {
            let (i, place) = (v.index(), places.of(v));
            let (tensor, normal) = (&bending.tensor[place], bending.normal[place]);
            LocalCurvature {
                warp: along(tensor, normal, cloth.warp[i]),
                weft: along(tensor, normal, cloth.weft[i]),
                mean: mean(tensor),
            }
        })
        .collect();
    let press = |i: usize, curvature: &LocalCurvature| {
        pressure_kpa(input.pressure_model, input.fabric, curvature, &cloth.stretch[i])
    };
    let own: Vec<f64> = curvature.iter().enumerate().map(|(i, c)| press(i, c)).collect();
    let (fine_pressure_kpa, fine_unreadable) = fine(input, places, &cloth, bending);
    let means = |of: &dyn Fn(usize) -> f64| {
        let own: Vec<f64> = (0..cloth.stretch.len()).map(of).collect();
        places.means(&own, &cloth.rest_area)
    };
    Field {
        warp_strain: means(&|i| cloth.stretch[i].warp),
        weft_strain: means(&|i| cloth.stretch[i].weft),
        area_stretch: means(&|i| cloth.stretch[i].area),
        curvature,
        pressure_kpa: places.means(&own, &cloth.worn_area),
        fine_pressure_kpa,
        fine_unreadable,
        noise_mm: bending.fine.as_ref().ok().map(|fine| fine.noise_mm),
        friction: places.to_vertices(&pull.friction()),
        radius_mm: input.parameters.curvature_radius,
        sampled_every_mm: bending.sampling.spacing,
        warp_direction: cloth.warp,
        weft_direction: cloth.weft,
        area_mm2: cloth.worn_area,
    }
}

/// Pressure with curvature over 5 mm where it is certain enough, by vertex; why it is nowhere.
fn fine(
    input: &FieldInput<'_>,
    places: &Places,
    cloth: &Cloth,
    bending: &Bending,
) -> (Vec<Option<f64>>, Option<Unreadable>) {
    let none = || vec![None; input.disk.vertex_count()];
    let fine = match &bending.fine {
        Ok(fine) => fine,
        Err(why) => return (none(), Some(*why)),
    };
    let (own, uncertain): (Vec<f64>, Vec<f64>) = input
        .disk
        .vertex_ids()
        .map(|v| {
            let (i, place) = (v.index(), places.of(v));
            let (tensor, normal) = (&fine.tensor[place], bending.normal[place]);
            let read = LocalCurvature {
                warp: along(tensor, normal, cloth.warp[i]),
                weft: along(tensor, normal, cloth.weft[i]),
                mean: mean(tensor),
            };
            let d = fine.deviation[place];
            // Both threads at once: no less than the truth.
            let off = LocalCurvature { warp: d, weft: d, mean: d };
            let press = |curvature: &LocalCurvature| {
                pressure_kpa(input.pressure_model, input.fabric, curvature, &cloth.stretch[i])
            };
            (press(&read), if d.is_finite() { press(&off) } else { f64::INFINITY })
        })
        .unzip();
    let own = places.means(&own, &cloth.worn_area);
    let uncertain = places.means(&uncertain, &cloth.worn_area);
    let believed: Vec<Option<f64>> = own
        .iter()
        .zip(&uncertain)
        .map(|(&kpa, &off)| (kpa > 0.0 && off <= MOST_UNCERTAIN * kpa).then_some(kpa))
        .collect();
    if believed.iter().any(Option::is_some) {
        return (believed, None);
    }
    let why = if own.iter().all(|&kpa| kpa <= 0.0) {
        Unreadable::Slack
    } else if fine.typical_deviation.is_finite() {
        Unreadable::Noise { noise_mm: fine.noise_mm, deviation: fine.typical_deviation }
    } else {
        Unreadable::TooCoarse { mean_edge_mm: input.relief.mean_edge }
    };
    (believed, Some(why))
}
