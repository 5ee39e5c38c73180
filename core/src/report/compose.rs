//! Gathers what the stages found into a report, and the warnings that follow from it.

use super::field::{missed, report_field};
use super::{
    ENERGY_UNIT, FitReport, GirthReport, HistoryEntry, PatternReport, PressureReport, Reason,
    Report, SeamReport, StrainDatum, StrainFunctionReport, StrainRow, SurfaceReport,
};
use crate::design::Limits;
use crate::field::reachable_kpa;
use crate::pipeline::Found;
use crate::units::{PER_M_PER_PER_MM, mmhg_from_kpa};
use crate::warning::Warning;

/// The report of a run; `warnings` are those of the stages so far.
pub(crate) fn compose(found: &Found<'_>, mut warnings: Vec<Warning>) -> Report {
    warnings.extend(fit_warnings(found));
    warnings.extend(pressure_warnings(found));
    let pressures = pressures(found);
    warnings.extend(missed(&pressures));
    let (field, said) = report_field(found.field, found.disk, found.coordinates, found.design);
    warnings.extend(said);
    warnings.extend(pattern_warnings(found));
    Report {
        wovenfit: env!("CARGO_PKG_VERSION"),
        piece: found.design.piece.clone(),
        pressure_model: found.design.pressure_model,
        fabric: found.design.fabric.clone(),
        parameters: found.parameters.into(),
        curvature_radius_mm: found.parameters.curvature_radius,
        surface: surface(found),
        fit: fit(found),
        strain_function: strain_function(found),
        pressures,
        field,
        pattern: PatternReport {
            width_mm: found.pattern.width,
            height_mm: found.pattern.height,
            area_mm2: found.pattern.area,
            flipped: found.pattern.flipped,
            overlaps: found.pattern.overlaps,
        },
        seams: found
            .pattern
            .seams
            .iter()
            .map(|seam| SeamReport { left_mm: seam.left_mm, right_mm: seam.right_mm })
            .collect(),
        warnings,
    }
}

fn surface(found: &Found<'_>) -> SurfaceReport {
    SurfaceReport {
        vertices: found.region.vertex_count(),
        triangles: found.region.triangle_count(),
        boundary_loops: found.region.boundary_loops().len(),
        area_mm2: found.region.total_area(),
        length_mm: (found.measures.length_mm > 0.0).then_some(found.measures.length_mm),
        girths: found
            .measures
            .girths
            .iter()
            .map(|girth| GirthReport { at_mm: girth.at_mm, girth_mm: girth.girth_mm })
            .collect(),
    }
}

fn fit(found: &Found<'_>) -> FitReport {
    let fit = found.fit;
    FitReport {
        method: found.parameters.get("method").unwrap_or_default(),
        iterations: fit.iterations,
        converged: fit.stopped.converged(),
        stopped_by: fit.stopped.name(),
        energy: fit.misfit.energy,
        energy_unit: ENERGY_UNIT,
        e_ssd: fit.misfit.e_ssd,
        springs: fit.misfit.springs,
        nodes: fit.model.node_count(),
        spacing_mm: fit.model.spacing(),
        history: fit
            .history
            .iter()
            .map(|entry| HistoryEntry {
                iteration: entry.iteration,
                spacing_mm: entry.spacing,
                nodes: entry.nodes,
                springs: entry.misfit.springs,
                energy: entry.misfit.energy,
                e_ssd: entry.misfit.e_ssd,
            })
            .collect(),
    }
}

fn strain_function(found: &Found<'_>) -> StrainFunctionReport {
    let (model, targets) = (&found.fit.model, &found.fit.targets);
    let (first, last) = model.row_range().unwrap_or((0, 0));
    let rows = f64::from((last - first).max(1));
    StrainFunctionReport {
        form: targets.function.form().name(),
        rows: (first..=last)
            .map(|row| StrainRow {
                y_mm: f64::from(row) * model.spacing() + found.row_zero,
                t: f64::from(row - first) / rows,
                strain: targets.rest.warp_strain(row),
            })
            .collect(),
        data: targets
            .threads
            .iter()
            .filter_map(|thread| {
                thread.wanted.map(|strain| StrainDatum {
                    t: thread.t,
                    wanted: strain,
                    asked: thread.asked.unwrap_or(strain),
                    fitted: thread.fitted,
                    residual: thread.fitted - thread.asked.unwrap_or(strain),
                })
            })
            .collect(),
    }
}

fn pressures(found: &Found<'_>) -> Vec<PressureReport> {
    found
        .annotations
        .iter()
        .zip(found.judgements)
        .map(|(annotation, judgement)| PressureReport {
            at: annotation.at.to_array(),
            asked_kpa: annotation.kpa,
            got_kpa: Some(judgement.got_kpa),
            got_local_kpa: Some(judgement.got_local_kpa),
            mean_curvature_per_m: judgement.curvature.mean * PER_M_PER_PER_MM,
            warp_curvature_per_m: judgement.curvature.warp * PER_M_PER_PER_MM,
            weft_curvature_per_m: judgement.curvature.weft * PER_M_PER_PER_MM,
            warp_strain: Some(judgement.warp_strain),
            weft_strain: Some(judgement.weft_strain),
            reachable_kpa: Some(reachable_kpa(
                found.design.pressure_model,
                &found.design.fabric,
                &judgement.curvature,
                judgement.weft_strain,
            )),
            thread: Some(i64::from(judgement.row)),
            reason: judgement
                .reason
                .as_ref()
                .map(|reason| Reason { code: reason.code(), text: reason.text() }),
        })
        .collect()
}

fn fit_warnings(found: &Found<'_>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if !found.fit.stopped.converged() {
        warnings.push(Warning::new(
            "not_converged",
            format!(
                "not converged: the fit was stopped after {} iterations before it came to rest; \
                 its pressures are not those of the finished pattern; raise max-iterations",
                found.fit.iterations
            ),
        ));
    }
    let limit = found.design.fabric.max_strain;
    for thread in &found.fit.targets.threads {
        let numbers = numbers(&thread.annotations);
        match thread.wanted {
            Some(wanted) if wanted > limit => warnings.push(Warning::new(
                "over_strain",
                format!(
                    "the thread of pressure {numbers} would need a strain of {wanted:.2}; the \
                     fabric bears {limit:.2} and is asked for no more"
                ),
            )),
            Some(wanted) if wanted < 0.0 => warnings.push(Warning::new(
                "under_strain",
                format!(
                    "the wanted weft strain alone presses more than pressure {numbers} asks; \
                     its thread is left unstretched"
                ),
            )),
            // Half a per cent of strain is some 3 % of a usual one.
            Some(wanted) if (thread.fitted - thread.asked.unwrap_or(wanted)).abs() > 0.005 => {
                warnings.push(Warning::new(
                    "strain_smoothed",
                    format!(
                        "the thread of pressure {numbers} wants a strain of {wanted:.3} and gets \
                         {:.3}: threads closer than row-spacing cannot differ freely",
                        thread.fitted
                    ),
                ));
            }
            _ => {}
        }
    }
    warnings
}

fn pressure_warnings(found: &Found<'_>) -> Vec<Warning> {
    let limit = found.design.limits.max_kpa.unwrap_or(Limits::WARN_KPA);
    found
        .annotations
        .iter()
        .zip(found.judgements)
        .enumerate()
        .filter_map(|(k, (annotation, judgement))| {
            let most = annotation.kpa.max(judgement.got_kpa).max(judgement.got_local_kpa);
            (most > limit).then(|| {
                Warning::at(
                    "over_limit",
                    format!(
                        "pressure {} asks {:.2} kPa and gets {:.2} kPa ({:.2} kPa at its place): \
                         above the limit of {limit:.2} kPa ({:.0} mmHg)",
                        k + 1,
                        annotation.kpa,
                        judgement.got_kpa,
                        judgement.got_local_kpa,
                        mmhg_from_kpa(limit)
                    ),
                    annotation.at,
                )
            })
        })
        .collect()
}

fn pattern_warnings(found: &Found<'_>) -> Vec<Warning> {
    let pattern = found.pattern;
    let mut warnings = Vec::new();
    if pattern.flipped > 0 {
        warnings.push(Warning::new(
            "flipped",
            format!(
                "{} triangles of the pattern lie the wrong way round: the fabric folds there; \
                 use a smaller spacing or another seam",
                pattern.flipped
            ),
        ));
    }
    if pattern.overlaps > 0 {
        warnings.push(Warning::new(
            "overlaps",
            format!(
                "the pattern's outline crosses itself in {} places: it cannot be cut from one \
                 piece; add a seam or shorten the region",
                pattern.overlaps
            ),
        ));
    }
    for (k, seam) in pattern.seams.iter().enumerate() {
        let difference = (seam.left_mm - seam.right_mm).abs();
        // Up to half a per cent a sewer eases in.
        if difference > 0.005 * seam.left_mm.max(seam.right_mm) {
            warnings.push(Warning::new(
                "seam_lengths",
                format!(
                    "the sides of seam {} differ: {:.1} mm and {:.1} mm; the longer one has to be \
                     eased in",
                    k + 1,
                    seam.left_mm,
                    seam.right_mm
                ),
            ));
        }
    }
    warnings
}

/// "2", "2 and 5": annotations as people count them.
fn numbers(annotations: &[usize]) -> String {
    annotations.iter().map(|k| (k + 1).to_string()).collect::<Vec<_>>().join(" and ")
}
