//! The whole flow, one readable line a stage, in the paper's words.

use glam::DVec2;

use crate::denoise::{Calm, calm};
use crate::design::Design;
use crate::error::Error;
use crate::export::Drawing;
use crate::field::{Field, FieldInput, everywhere};
use crate::fit::diffusion::diffuse;
use crate::fit::newton::Prepared;
use crate::fit::{Fit, FitError, FitInput};
use crate::geometry::{Curvature, Girth, Locator, Measures, guard_unit, measure};
use crate::mapping::Mapping;
use crate::parameterize::{initial, upright};
use crate::parameters::{Method, Parameters};
use crate::pattern::{Pattern, free_edges, pattern};
use crate::pressure::{Annotation, Brace, Judgement, judge};
use crate::progress::{Progress, Stage};
use crate::report::{Report, compose};
use crate::seams::{CutSurface, Markers, clip, open_to_disk, place};
use crate::surface::{RawMesh, Surface, SurfaceOptions, Validated, validate};
use crate::units::LengthUnit;
use crate::warning::Warning;

/// A flattened brace.
#[derive(Debug, Clone)]
pub struct Flattening {
    /// The cut surface, in mm.
    pub disk: Surface,
    /// Pattern coordinates of its vertices, in mm, x along warp, y along weft, the lower left
    /// corner of the pattern's extent at the origin.
    pub coordinates: Vec<DVec2>,
    /// Strain, pressure and friction at its vertices.
    pub field: Field,
    /// The girths of the covered limb, from the end near the body.
    pub girths: Vec<Girth>,
    /// The pattern as a drawing.
    pub drawing: Drawing,
    /// Every figure and warning.
    pub report: Report,
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
    let begin = |stage| {
        progress.report(stage, 0.0, None);
        if progress.cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    };

    begin(Stage::Surface)?;
    let Validated { surface, mut warnings, .. } =
        validate(raw, &surface_options(design, parameters))?;
    let (measures, calm) =
        rayon::join(|| measure(&surface, parameters.girth_step), || calm(&surface, parameters));
    warnings.extend(guard_size(&measures, design.unit, parameters)?);
    let Calm { smoothed, radius, warning } = calm;
    let surface = smoothed.unwrap_or(surface);
    // The measures are those of the brace too if it covers all of the surface as it was given.
    let whole = warning.is_none() && design.region.is_empty();
    let measures = whole.then_some(measures);
    warnings.extend(warning);
    // What the scan's noise allows goes before what was asked for.
    let given = parameters;
    let parameters = &Parameters { curvature_radius: radius, ..parameters.clone() };

    begin(Stage::Region)?;
    let region = clip(&surface, &design.region)?;
    warnings.extend(region.warnings);

    begin(Stage::Cut)?;
    let cut = with_orientation(open_to_disk(&region.surface, &design.seams)?, design);
    warnings.extend(cut.warnings.iter().cloned());
    let (markers, said) = place(&cut, design.orientation)?;
    warnings.extend(said);

    begin(Stage::Curvature)?;
    let annotations = annotate(&surface, &cut, design, parameters)?;

    begin(Stage::Parameterization)?;
    let omega = initial(&cut.disk, &markers.points)?;
    warnings.extend(omega.warnings);

    begin(Stage::Fit)?;
    let fit = fit(&cut, &omega.coordinates, &markers, &annotations, design, parameters, progress)?;
    let (coordinates, corner) = to_origin(&fit.coordinates);

    begin(Stage::Report)?;
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
    let judgements = judge(&brace, &annotations, &design.fabric, design.pressure_model, parameters);
    let field = everywhere(&FieldInput {
        scan: &surface,
        disk: &cut.disk,
        coordinates: &coordinates,
        seams: &cut.seams,
        free_edges: &free_edges,
        fabric: &design.fabric,
        pressure_model: design.pressure_model,
        parameters,
    });
    let measures = measures.unwrap_or_else(|| measure(&region.surface, parameters.girth_step));
    let found = Found {
        design,
        parameters: given,
        curvature_radius: radius,
        region: &region.surface,
        measures: &measures,
        annotations: &annotations,
        fit: &fit,
        pattern: &pattern,
        judgements: &judgements,
        disk: &cut.disk,
        coordinates: &coordinates,
        field: &field,
        y_zero: -corner.y,
    };
    let report = compose(&found, warnings);
    let drawing = draw(&found, &cut, &coordinates, &markers);
    let girths = measures.girths;
    Ok(Flattening { disk: cut.disk, coordinates, field, girths, drawing, report })
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
/// edge of the brace.
fn annotate(
    surface: &Surface,
    cut: &CutSurface,
    design: &Design,
    parameters: &Parameters,
) -> Result<Vec<Annotation>, Error> {
    /// Farthest that a wanted pressure may lie from the surface, in mm.
    const FARTHEST: f64 = 10.0;
    let curvature = Curvature::new(surface, parameters);
    let (whole, covered) = (Locator::new(surface), Locator::new(&cut.disk));
    let mut annotations = Vec::with_capacity(design.pressures.len());
    for (k, wanted) in design.pressures.iter().enumerate() {
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

/// Fits the fabric by the method chosen.
fn fit(
    cut: &CutSurface,
    omega: &[DVec2],
    markers: &Markers,
    annotations: &[Annotation],
    design: &Design,
    parameters: &Parameters,
    progress: &dyn Progress,
) -> Result<Fit, Error> {
    let input = FitInput {
        disk: &cut.disk,
        seams: &cut.seams,
        omega,
        markers: &markers.points,
        annotations,
        fabric: &design.fabric,
        pressure_model: design.pressure_model,
        parameters,
    };
    match parameters.method {
        Method::Newton => {
            let prepared = Prepared::new(&cut.disk, &cut.seams, parameters.equal_seams)?;
            Ok(prepared.fit(&input, None, progress)?)
        }
        Method::Diffusion => {
            let rest = diffuse(&input, progress)?;
            progress.report(Stage::Mapping, 0.0, None);
            let mapped = Mapping::new(&cut.disk, &rest.model).vertices().map_err(FitError::from)?;
            let coordinates = upright(&mapped, &cut.disk, &markers.points)?;
            let rise = mean_y(&coordinates) - mean_y(&mapped);
            Ok(rest.with_coordinates(coordinates, rise))
        }
    }
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
