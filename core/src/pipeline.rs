//! The whole flow, one readable line a stage, in the paper's words.

mod flat;

use std::cell::LazyCell;
use std::sync::Arc;

use glam::DVec2;

use self::flat::Flat;
use crate::cutting::{Mark, MarkKind, Piece, Wanted, pieces};
use crate::denoise::{Calm, calm};
use crate::design::Design;
use crate::error::Error;
use crate::export::Drawing;
use crate::field::{Field, FieldInput, Relief, everywhere};
use crate::fit::diffusion::diffuse;
use crate::fit::newton::{self, Kept, Solver};
use crate::fit::{Fit, FitError, FitInput};
use crate::geometry::{Curvature, Girth, Locator, Measures, guard_unit, measure};
use crate::mapping::Mapping;
use crate::parameterize::upright;
use crate::parameters::Parameters;
use crate::pattern::{Pattern, free_edges, pattern};
use crate::pressure::{Annotation, Brace, Judgement, judge};
use crate::progress::{Progress, Stage};
use crate::report::{Report, compose};
use crate::seams::{CutSurface, Markers, clip, open_to_disk, place, select};
use crate::surface::{RawMesh, Scan, Surface, SurfaceOptions, Validated, validate};
use crate::units::LengthUnit;
use crate::warning::Warning;

/// A flattened brace.
#[derive(Debug, Clone)]
pub struct Flattening {
    /// The whole scan, with the way back to the mesh that was given.
    pub scan: Arc<Scan>,
    /// The cut surface with its seams, in mm.
    pub cut: Arc<CutSurface>,
    /// Pattern coordinates of its vertices, in mm, x along warp, y along weft, the lower left
    /// corner of the pattern's extent at the origin.
    pub coordinates: Vec<DVec2>,
    /// Strain, pressure and friction at its vertices.
    pub field: Field,
    /// The girths of the covered limb, from the end near the body.
    pub girths: Vec<Girth>,
    /// The pattern as a drawing.
    pub drawing: Drawing,
    /// The pieces to cut.
    pub pieces: Vec<Piece>,
    /// Every figure and warning.
    pub report: Report,
    /// What the next fit of the same surface starts from.
    fit: Fit,
    kept: Option<Arc<Kept>>,
    annotations: Vec<Annotation>,
}

impl Flattening {
    /// The cut surface, in mm.
    #[must_use]
    pub fn disk(&self) -> &Surface {
        &self.cut.disk
    }
}

/// What the stages found, for the report.
pub(crate) struct Found<'a> {
    pub design: &'a Design,
    pub parameters: &'a Parameters,
    /// Radius over which curvature was read, in mm.
    pub curvature_radius: f64,
    pub region: &'a Surface,
    pub measures: &'a Measures,
    pub annotations: &'a [Annotation],
    pub fit: &'a Fit,
    /// J_E if sewn edges had not to be of equal lengths, where they have, in N·mm.
    pub energy_of_free_seams: Option<f64>,
    pub pattern: &'a Pattern,
    pub judgements: &'a [Judgement],
    pub disk: &'a Surface,
    pub coordinates: &'a [DVec2],
    pub field: &'a Field,
    /// Where the fit's y = 0 lies in the pattern, in mm.
    pub y_zero: f64,
}

/// From a scanned limb and wanted pressures to a planar pattern.
///
/// # Errors
/// If the surface, the design or both together cannot be flattened; the error says what and where
/// and what to do.
pub fn flatten(
    raw: &RawMesh,
    design: &Design,
    parameters: &Parameters,
    progress: &dyn Progress,
) -> Result<Flattening, Error> {
    let mut prepared = Prepared::new(raw, design, parameters, progress)?;
    prepared.once = true;
    prepared.solve(design, parameters, None, progress)
}

/// A limb that is cut open and ready to be fitted: what does not change with pressures, fabric and
/// markers.
#[derive(Debug)]
pub struct Prepared {
    /// The whole scan, smoothed if it was noisy.
    scan: Arc<Scan>,
    /// What the brace covers.
    region: Surface,
    cut: Arc<CutSurface>,
    /// Its markers, and what is to be said about them.
    placed: (Markers, Vec<Warning>),
    /// The initial parameterization Ω.
    omega: Vec<DVec2>,
    solver: Option<Solver>,
    relief: Relief,
    measures: Measures,
    /// Radius over which curvature is read, in mm.
    radius: f64,
    warnings: Vec<Warning>,
    design: Design,
    parameters: Parameters,
    /// Whether nothing is to be kept for another fit.
    once: bool,
}

/// A stage begins.
fn begin(progress: &dyn Progress, stage: Stage) -> Result<(), Error> {
    progress.report(stage, 0.0, None);
    go_on(progress)
}

/// Asks whether to go on.
fn go_on(progress: &dyn Progress) -> Result<(), Error> {
    if progress.cancelled() { Err(Error::Cancelled) } else { Ok(()) }
}

impl Prepared {
    /// Reads a limb for designs that want the same region, seams, facing and unit as this one.
    ///
    /// # Errors
    /// If the surface cannot be used or cut.
    pub fn new(
        raw: &RawMesh,
        design: &Design,
        parameters: &Parameters,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        begin(progress, Stage::Surface)?;
        let Validated { surface, mut warnings, origin } =
            validate(raw, &surface_options(design, parameters))?;
        go_on(progress)?;
        let (measures, calm) =
            rayon::join(|| measure(&surface, parameters.girth_step), || calm(&surface, parameters));
        warnings.extend(guard_size(&measures, design.unit, parameters)?);
        let Calm { smoothed, radius, warning } = calm;
        let surface = smoothed.unwrap_or(surface);
        // The measures are those of the brace too if it covers all of the surface as it was given.
        let whole = warning.is_none() && design.region.is_empty() && design.region_faces.is_none();
        warnings.extend(warning);

        begin(progress, Stage::Region)?;
        let scan = Arc::new(Scan { surface, origin });
        let selected =
            design.region_faces.as_ref().map(|faces| select(&scan, faces)).transpose()?;
        let region = clip(selected.as_ref().map_or(&scan.surface, |s| &s.surface), &design.region)?;
        warnings.extend(selected.into_iter().flat_map(|selected| selected.warnings));
        warnings.extend(region.warnings);
        let region = region.surface;

        begin(progress, Stage::Cut)?;
        let cut = with_orientation(open_to_disk(&region, &design.seams)?, design);
        warnings.extend(cut.warnings.iter().cloned());

        begin(progress, Stage::Parameterization)?;
        let (markers, _) = place(&cut, design.orientation)?;
        let read = Parameters { curvature_radius: radius, ..parameters.clone() };
        let Flat { cut, omega, solver, relief } =
            Flat::new(&scan.surface, cut, &markers, &read, progress)?;
        warnings.extend(omega.warnings);
        let measures = if whole { measures } else { measure(&region, parameters.girth_step) };
        Ok(Self {
            scan,
            region,
            placed: place(&cut, design.orientation)?,
            cut: Arc::new(cut),
            omega: omega.coordinates,
            solver,
            relief,
            measures,
            radius,
            warnings,
            design: design.clone(),
            parameters: parameters.clone(),
            once: false,
        })
    }

    /// What makes this preparation useless for a design and parameters, if anything.
    fn changed(&self, design: &Design, parameters: &Parameters) -> Option<&'static str> {
        let (d, p) = (&self.design, &self.parameters);
        [
            ("region", design.region == d.region),
            ("region_faces", design.region_faces == d.region_faces),
            ("seams", design.seams == d.seams),
            ("facing", design.facing == d.facing),
            ("units", design.unit == d.unit && parameters.units == p.units),
            ("keep-largest", parameters.keep_largest == p.keep_largest),
            ("close-holes", parameters.close_holes == p.close_holes),
            ("denoise", parameters.denoise == p.denoise),
            ("curvature", parameters.curvature == p.curvature),
            ("curvature-radius", parameters.curvature_radius == p.curvature_radius),
            ("girth-step", parameters.girth_step == p.girth_step),
            ("equal-seams", parameters.equal_seams == p.equal_seams),
            ("method", parameters.method == p.method),
        ]
        .into_iter()
        .find_map(|(name, same)| (!same).then_some(name))
    }

    /// The pattern for a design, from an earlier one of the same preparation if there is one: after a
    /// changed pressure, stiffness or marker that takes a part of the time.
    ///
    /// # Errors
    /// If the design cannot be flattened, or wants another region, seams, facing, unit or parameter of
    /// the preparation.
    pub fn solve(
        &self,
        design: &Design,
        parameters: &Parameters,
        earlier: Option<&Flattening>,
        progress: &dyn Progress,
    ) -> Result<Flattening, Error> {
        if let Some(what) = self.changed(design, parameters) {
            return Err(Error::PreparedForAnother { what });
        }
        // What the scan's noise allows goes before what was asked for.
        let given = parameters;
        let parameters = &Parameters { curvature_radius: self.radius, ..parameters.clone() };
        let (cut, (markers, said)) = if design.orientation == self.design.orientation {
            (Arc::clone(&self.cut), self.placed.clone())
        } else {
            let cut = with_orientation((*self.cut).clone(), design);
            let placed = place(&cut, design.orientation)?;
            (Arc::new(cut), placed)
        };
        let mut warnings = self.warnings.clone();
        warnings.extend(said);
        warnings.extend(design.warnings.iter().cloned());

        begin(progress, Stage::Curvature)?;
        let known = earlier.map_or(&[][..], |earlier| &earlier.annotations);
        let annotations = annotate(&self.scan.surface, &cut, design, parameters, known)?;

        begin(progress, Stage::Fit)?;
        let omega = upright(&self.omega, &cut.disk, &markers.points)?;
        let input = FitInput {
            disk: &cut.disk,
            omega: &omega,
            markers: &markers.points,
            annotations: &annotations,
            fabric: &design.fabric,
            pressure_model: design.pressure_model,
            parameters,
        };
        let (fit, run) = self.fit(&input, earlier, progress)?;
        let (coordinates, corner) = to_origin(&fit.coordinates);

        begin(progress, Stage::Report)?;
        let pattern = pattern(&cut, &coordinates);
        let free_edges = free_edges(&cut);
        let brace = Brace {
            disk: &cut.disk,
            coordinates: &coordinates,
            free_edges: &free_edges,
            woven: fit.woven.as_ref(),
            spacing: parameters.spacing,
            targets: &fit.targets,
            converged: fit.stopped.converged(),
        };
        let judgements =
            judge(&brace, &annotations, &design.fabric, design.pressure_model, parameters);
        let worn = FieldInput {
            relief: &self.relief,
            disk: &cut.disk,
            coordinates: &coordinates,
            free_edges: &free_edges,
            fabric: &design.fabric,
            pressure_model: design.pressure_model,
            parameters,
        };
        let (finished, field) = rayon::join(
            || run.map_or(Ok((None, None)), |run| run.finish(self.once)),
            || everywhere(&worn),
        );
        let (energy_of_free_seams, kept) = finished?;
        go_on(progress)?;
        let found = Found {
            design,
            parameters: given,
            curvature_radius: self.radius,
            region: &self.region,
            measures: &self.measures,
            annotations: &annotations,
            fit: &fit,
            energy_of_free_seams,
            pattern: &pattern,
            judgements: &judgements,
            disk: &cut.disk,
            coordinates: &coordinates,
            field: &field,
            y_zero: -corner.y,
        };
        let drawing = draw(&found, &cut, &coordinates, &markers);
        let (pieces, said) = pieces(&Wanted {
            cut: &cut,
            coordinates: &coordinates,
            piece: &design.piece,
            fabric: &design.fabric.name,
            marks: marks(&drawing),
            overlaps: !pattern.overlaps.is_empty(),
        });
        warnings.extend(said);
        let report = compose(&found, warnings);
        // Nobody is given what he has cancelled.
        go_on(progress)?;
        let girths = self.measures.girths.clone();
        let (scan, kept) = (Arc::clone(&self.scan), kept.map(Arc::new));
        Ok(Flattening {
            scan,
            cut,
            coordinates,
            field,
            girths,
            drawing,
            pieces,
            report,
            fit,
            kept,
            annotations,
        })
    }

    /// Fits the fabric by the method chosen.
    fn fit<'a>(
        &'a self,
        input: &'a FitInput<'a>,
        earlier: Option<&Flattening>,
        progress: &'a dyn Progress,
    ) -> Result<(Fit, Option<newton::Run<'a>>), Error> {
        if let Some(solver) = &self.solver {
            let earlier = earlier.map(|earlier| newton::Earlier {
                fit: &earlier.fit,
                kept: earlier.kept.as_deref(),
            });
            let (fit, run) = solver.fit(input, earlier, progress)?;
            return Ok((fit, Some(run)));
        }
        guard_nodes(input.omega, input.parameters.spacing)?;
        let rest = diffuse(input, progress)?;
        begin(progress, Stage::Mapping)?;
        let mapped = Mapping::new(input.disk, &rest.model).vertices().map_err(FitError::from)?;
        let coordinates = upright(&mapped, input.disk, input.markers)?;
        let rise = mean_y(&coordinates) - mean_y(&mapped);
        Ok((rest.with_coordinates(coordinates, rise), None))
    }
}

/// Refuses a grid of threads over the plane that does not fit into memory.
fn guard_nodes(plane: &[DVec2], spacing: f64) -> Result<(), Error> {
    /// Of nodes: a whole leg at half a millimetre has a quarter of it; some GB.
    const MOST_MILLIONS: f64 = 10.0;
    let high = plane.iter().copied().reduce(DVec2::max).unwrap_or_default();
    let size = high - to_origin(plane).1;
    let nodes = size.x * size.y / (spacing * spacing);
    if nodes <= MOST_MILLIONS * 1e6 {
        return Ok(());
    }
    // Rounded up, so that what is advised is taken.
    let least = (10.0 * (size.x * size.y / (MOST_MILLIONS * 1e6)).sqrt()).ceil() / 10.0;
    Err(Error::TooManyNodes { spacing, size, nodes, most: MOST_MILLIONS, least })
}

/// How the design and the parameters want the triangles read.
pub(crate) fn surface_options(design: &Design, parameters: &Parameters) -> SurfaceOptions {
    SurfaceOptions {
        unit: parameters.units.or(design.unit).unwrap_or(LengthUnit::Millimetre),
        keep_largest: parameters.keep_largest,
        close_holes: parameters.close_holes,
        facing: design.facing,
    }
}

/// Refuses a limb of impossible girth unless its unit was given for the surface itself.
pub(crate) fn guard_size(
    measures: &Measures,
    design_unit: Option<LengthUnit>,
    parameters: &Parameters,
) -> Result<Option<Warning>, Error> {
    let unit = parameters.units.or(design_unit).unwrap_or(LengthUnit::Millimetre);
    Ok(guard_unit(measures, unit, parameters.units.is_some())?)
}

/// The cut with the end at the designer's first marker as the one near the body.
fn with_orientation(cut: CutSurface, design: &Design) -> CutSurface {
    match design.orientation {
        Some([first, _]) => cut.with_proximal_at(first),
        None => cut,
    }
}

/// Finds the wanted pressures on the surface and the curvature there.
///
/// Curvature is that of the whole scan, not of the covered region alone: the limb goes on under the
/// edge of the brace. What is `known` from an earlier run is taken from there.
fn annotate(
    surface: &Surface,
    cut: &CutSurface,
    design: &Design,
    parameters: &Parameters,
    known: &[Annotation],
) -> Result<Vec<Annotation>, Error> {
    /// Farthest that a wanted pressure may lie from the surface, in mm.
    const FARTHEST: f64 = 10.0;
    // Trees over the whole surface, for places that are not known.
    let curvature = LazyCell::new(|| Curvature::new(surface, parameters));
    let whole = LazyCell::new(|| Locator::new(surface));
    let covered = LazyCell::new(|| Locator::new(&cut.disk));
    let mut annotations = Vec::with_capacity(design.pressures.len());
    for (k, wanted) in design.pressures.iter().enumerate() {
        if let Some(before) = known.iter().find(|before| before.at == wanted.at) {
            annotations.push(Annotation { kpa: wanted.kpa, ..*before });
            continue;
        }
        let far = |distance| Error::PressureFar { number: k + 1, at: wanted.at, distance };
        let (on_scan, distance) = whole.closest(wanted.at).ok_or_else(|| far(f64::INFINITY))?;
        if distance > FARTHEST {
            return Err(far(distance));
        }
        let place = on_scan.position(surface);
        let outside = |distance| Error::PressureOutside { number: k + 1, at: wanted.at, distance };
        let (point, distance) = covered.closest(place).ok_or_else(|| outside(f64::INFINITY))?;
        if distance > FARTHEST {
            return Err(outside(distance));
        }
        let shape = curvature.at(&on_scan);
        annotations.push(Annotation { at: wanted.at, point, kpa: wanted.kpa, shape });
    }
    Ok(annotations)
}

/// The mean y of a plane's points; turning by a hair about them does not change it.
fn mean_y(plane: &[DVec2]) -> f64 {
    plane.iter().map(|p| p.y).sum::<f64>() / plane.len().max(1) as f64
}

/// The plane shifted so that the lower left corner of its extent is the origin, and that corner.
fn to_origin(plane: &[DVec2]) -> (Vec<DVec2>, DVec2) {
    let corner = plane.iter().copied().reduce(DVec2::min).unwrap_or_default();
    (plane.iter().map(|&p| p - corner).collect(), corner)
}

/// What is marked on the pieces.
fn marks(drawing: &Drawing) -> Vec<Mark> {
    let markers = [MarkKind::Upper, MarkKind::Lower].into_iter().zip(drawing.markers);
    let markers = markers.map(|(kind, at)| Mark { kind, at, words: String::new() });
    let points = drawing.points.iter().enumerate().map(|(k, (at, value))| {
        let words = format!("{}: {value}", k + 1);
        Mark { kind: MarkKind::Pressure, at: *at, words }
    });
    markers.chain(points).collect()
}

/// The pattern as a drawing, with the wanted pressures as labels.
fn draw(found: &Found<'_>, cut: &CutSurface, coordinates: &[DVec2], markers: &Markers) -> Drawing {
    let labels =
        found.annotations.iter().map(|a| format!("{:.1} mmHg", crate::units::mmhg_from_kpa(a.kpa)));
    let places = found.judgements.iter().map(|judgement| judgement.place);
    Drawing {
        outline: found.pattern.outline.clone(),
        seams: found
            .pattern
            .seams
            .iter()
            .map(|seam| crate::export::DrawingSeam {
                left: seam.left.clone(),
                right: seam.right.clone(),
                left_mm: seam.left_mm,
                right_mm: seam.right_mm,
            })
            .collect(),
        markers: markers.points.map(|point| point.interpolate(&cut.disk, coordinates)),
        points: places.zip(labels).collect(),
        name: found.design.piece.name.clone(),
    }
}

#[cfg(test)]
#[path = "pipeline_tests.rs"]
mod tests;
