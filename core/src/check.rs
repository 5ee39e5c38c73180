//! What a surface is and what is wrong with it, before any brace is designed on it.

use glam::DVec3;

use crate::denoise::{Calm, calm};
use crate::design::{Design, Facing};
use crate::geometry::{Curvature, guard_unit, measure};
use crate::parameters::Parameters;
use crate::pipeline::surface_options;
use crate::report::{CheckReport, CurvatureReport, Defect, GirthReport, LoopReport};
use crate::surface::{DefectKind, RawMesh, Shape, Surface, Validated, shape_of, validate};
use crate::units::{LengthUnit, PER_M_PER_PER_MM};
use crate::warning::Warning;

/// The parameters that bear on what a surface is: what a dialog or a command for it offers.
pub const CHECK_PARAMETERS: [&str; 6] =
    ["units", "keep_largest", "close_holes", "curvature", "curvature_radius", "girth_step"];

/// Checks a surface as [`flatten`](crate::flatten) would take it.
///
/// Never fails: what stops flattening is in the report's `defects`.
#[must_use]
pub fn check(raw: &RawMesh, facing: Option<Facing>, parameters: &Parameters) -> CheckReport {
    check_for(raw, &Design { facing, ..Design::default() }, parameters)
}

/// Checks a surface as [`flatten`](crate::flatten) would take it with this design, of which the unit
/// and the facing bear on it.
///
/// Never fails: what stops flattening is in the report's `defects`.
#[must_use]
pub fn check_for(raw: &RawMesh, design: &Design, parameters: &Parameters) -> CheckReport {
    let options = surface_options(design, parameters);
    let unit = options.unit;
    match validate(raw, &options) {
        Ok(validated) => describe(validated, unit, parameters),
        Err(error) => CheckReport {
            unit: Some(unit.symbol()),
            vertices: raw.points.len(),
            triangles: raw.polygons.len(),
            defects: error
                .defects()
                .iter()
                .map(|defect| Defect {
                    code: code(defect.kind),
                    message: defect.message.clone(),
                    vertices: defect.vertices.clone(),
                    faces: defect.faces.clone(),
                    at: defect.at,
                })
                .collect(),
            ..CheckReport::default()
        },
    }
}

fn describe(validated: Validated, unit: LengthUnit, parameters: &Parameters) -> CheckReport {
    let Validated { surface, mut warnings, .. } = validated;
    let (measures, calm) =
        rayon::join(|| measure(&surface, parameters.girth_step), || calm(&surface, parameters));
    let mut defects = Vec::new();
    match guard_unit(&measures, unit, parameters.units.is_some()) {
        Ok(said) => warnings.extend(said),
        Err(error) => {
            defects.push(of_the_whole("unit", error.to_string()));
        }
    }
    let Calm { smoothed, radius, warning } = calm;
    let surface = smoothed.unwrap_or(surface);
    warnings.extend(warning);
    let parameters = &Parameters { curvature_radius: radius, ..parameters.clone() };
    let shape = shape_of(&surface);
    match shape {
        Shape::Closed => warnings.push(Warning::new(
            "closed",
            "the surface is closed: the design must give a region, two planes across the limb \
             between which the brace lies",
        )),
        Shape::Handles { genus, .. } => defects.push(of_the_whole(
            "handles",
            format!(
                "the surface has {genus} handles (a bridge such as fingers touching): no seam \
                 opens it; remove the bridge in the scan, or keep it outside the region"
            ),
        )),
        Shape::Disk | Shape::Tube | Shape::WithOpenings { .. } => {}
    }
    let (low, high) =
        surface.points().iter().fold(
            (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY)),
            |(low, high), &p| (low.min(p), high.max(p)),
        );
    CheckReport {
        file: None,
        unit: Some(unit.symbol()),
        shape: Some(in_words(shape)),
        vertices: surface.vertex_count(),
        triangles: surface.triangle_count(),
        size_mm: Some((high - low).to_array()),
        area_mm2: Some(surface.total_area()),
        length_mm: (measures.length_mm > 0.0).then_some(measures.length_mm),
        girths: measures
            .girths
            .iter()
            .map(|girth| GirthReport { at_mm: girth.at_mm, girth_mm: girth.girth_mm })
            .collect(),
        loops: loops(&surface),
        curvature_per_m: curvature(&surface, parameters),
        warnings,
        defects,
    }
}

/// A defect of the surface as a whole.
fn of_the_whole(code: &str, message: String) -> Defect {
    Defect { code: code.to_owned(), message, ..Defect::default() }
}

/// The defect's frozen short name, as in its JSON.
fn code(kind: DefectKind) -> String {
    let name = serde_json::to_value(kind).ok();
    name.as_ref().and_then(serde_json::Value::as_str).unwrap_or_default().to_owned()
}

fn in_words(shape: Shape) -> String {
    match shape {
        Shape::Disk => "disk: laid flat as it is".to_owned(),
        Shape::Tube => "tube: cut along a seam".to_owned(),
        Shape::WithOpenings { loops } => {
            format!("tube with {} further openings, kept as cut-outs", loops - 2)
        }
        Shape::Closed => "closed: needs a region".to_owned(),
        Shape::Handles { genus, loops } => {
            format!("{genus} handles and {loops} openings: cannot be laid flat")
        }
    }
}

/// The boundary loops, the longest first.
fn loops(surface: &Surface) -> Vec<LoopReport> {
    let mut loops: Vec<LoopReport> = surface
        .boundary_loops()
        .iter()
        .map(|boundary| {
            let count = boundary.half_edges.len() as f64;
            let sum: DVec3 = surface.loop_vertices(boundary).map(|v| surface.point(v)).sum();
            LoopReport { length_mm: surface.loop_length(boundary), at: (sum / count).to_array() }
        })
        .collect();
    loops.sort_by(|a, b| b.length_mm.total_cmp(&a.length_mm));
    loops
}

/// How mean curvature is distributed over the vertices.
fn curvature(surface: &Surface, parameters: &Parameters) -> Option<CurvatureReport> {
    let operators = Curvature::new(surface, parameters).at_vertices();
    let mut means: Vec<f64> =
        operators.iter().map(|operator| operator.mean() * PER_M_PER_PER_MM).collect();
    means.sort_by(f64::total_cmp);
    let last = means.len().checked_sub(1)?;
    let quantile = |q: f64| means[(q * last as f64).round() as usize];
    Some(CurvatureReport {
        radius_mm: parameters.curvature_radius,
        min: quantile(0.0),
        percent_5: quantile(0.05),
        median: quantile(0.5),
        percent_95: quantile(0.95),
        max: quantile(1.0),
    })
}
