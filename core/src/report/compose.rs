//! Gathers what the stages found into a report, and the warnings that follow from it.

use super::field::{missed, report_field};
use super::{
    ENERGY_UNIT, FitReport, GirthReport, HistoryEntry, PatternReport, PressureReport, Reason,
    Report, SeamReport, StrainDatum, StrainFunctionReport, StrainRow, SurfaceReport,
};
use crate::design::Limits;
use crate::field::reachable_kpa;
use crate::fit::Stopped;
use crate::parameters::Method;
use crate::pipeline::Found;
use crate::pressure::ThreadTarget;
use crate::units::{PER_M_PER_PER_MM, mmhg_from_kpa};
use crate::warning::Warning;

/// No more rows of the strain function are listed.
const MOST_ROWS: f64 = 1000.0;

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
        curvature_radius_mm: found.curvature_radius,
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
            overlaps: found.pattern.overlaps.len(),
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
        energy_of_free_seams: found.energy_of_free_seams,
        energy_unit: ENERGY_UNIT,
        e_ssd: fit.misfit.e_ssd,
        springs: fit.misfit.springs,
        nodes: fit.history.last().map_or(0, |entry| entry.nodes),
        spacing_mm: found.parameters.spacing,
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
    let targets = &found.fit.targets;
    let [low, high] = targets.extent;
    let rows = ((high - low) / found.parameters.spacing).round().clamp(1.0, MOST_ROWS) as usize;
    StrainFunctionReport {
        form: targets.function.form().name(),
        rows: (0..=rows)
            .map(|row| {
                let t = row as f64 / rows as f64;
                let y_mm = low + t * (high - low) + found.y_zero;
                StrainRow { y_mm, t, strain: targets.function.at(t) }
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
            thread: Some((judgement.place.y / found.parameters.spacing).round() as i64),
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
                 its pressures are not those of the finished pattern; raise {}",
                found.fit.iterations,
                match found.parameters.method {
                    Method::Newton => "newton-steps",
                    Method::Diffusion => "max-iterations",
                }
            ),
        ));
    }
    if found.fit.stopped == Stopped::Unsettled {
        warnings.push(Warning::new(
            "unsettled",
            "no target strains were found that bring the pressures nearer to all that was asked; the pattern \
             has those that came nearest, and the table says what it presses: ask for values closer to each \
             other, or move the points apart",
        ));
    }
    let mut smoothed = Vec::new();
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
            Some(wanted) if (given(thread, wanted) - wanted).abs() > 0.005 => {
                smoothed.push((numbers, wanted, given(thread, wanted)));
            }
            _ => {}
        }
    }
    warnings.extend(smoothed_warning(&smoothed));
    warnings
}

/// What the strain function gives a thread that wants `wanted`, correction aside.
fn given(thread: &ThreadTarget, wanted: f64) -> f64 {
    thread.asked.map_or(wanted, |asked| wanted + thread.fitted - asked)
}

/// One warning for all threads that are smoothed: a painted field has dozens.
fn smoothed_warning(smoothed: &[(String, f64, f64)]) -> Option<Warning> {
    let off = |entry: &(String, f64, f64)| (entry.2 - entry.1).abs();
    let worst = smoothed.iter().reduce(|a, b| if off(b) > off(a) { b } else { a })?;
    let (numbers, wanted, given) = worst;
    let count = match smoothed.len() {
        1 => "a thread".to_owned(),
        many => format!("{many} threads, the most for"),
    };
    let message = if smoothed.len() == 1 {
        format!(
            "{count} of pressure {numbers} wants a strain of {wanted:.3} and is given {given:.3}: \
             threads closer than row-spacing cannot differ freely"
        )
    } else {
        format!(
            "{count} pressure {numbers} (wanted {wanted:.3}, given {given:.3}), are given another \
             strain than wanted: threads closer than row-spacing cannot differ freely"
        )
    };
    Some(Warning::new("strain_smoothed", message))
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
    if let Some(&[one, other]) = pattern.overlaps.first() {
        warnings.push(Warning::at(
            "overlaps",
            format!(
                "the pattern's outline crosses itself in {} places and cannot be cut from one \
                 piece: cloth for the limb at ({:.0}, {:.0}, {:.0}) mm would lie on cloth for ({:.0}, \
                 {:.0}, {:.0}) mm; draw a dart (a seam from the edge inward) between the two, lead \
                 the seam elsewhere, or cover less of the limb",
                pattern.overlaps.len(),
                one.x,
                one.y,
                one.z,
                other.x,
                other.y,
                other.z
            ),
            one,
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
