//! The field in the report: its figures and the warnings that follow from them.

use glam::{DVec2, DVec3};

use super::json::PressureReport;
use crate::design::{Design, Limits};
use crate::field::{COMPRESSED_BELOW, FINE_RADIUS_MM, Field, SKIN_FRICTION, Summary};
use crate::surface::Surface;
use crate::units::mmhg_from_kpa;
use crate::warning::Warning;

/// A rise of pressure toward the body of less than this, in kPa, is not warned of: 2 mmHg, what
/// braces of one make differ by.
const LEAST_RISE_KPA: f64 = 0.27;

/// Nor is one of less than this share of the mean: personalised garments press within some 10 % of
/// their design (Shi et al. 2024).
const LEAST_RISE_SHARE: f64 = 0.1;

/// Farthest that a bony place may lie from the brace and be under it, in mm: as far as a wanted
/// pressure may lie from the scan.
const FARTHEST_BONE_MM: f64 = 10.0;

/// Pressure, strain and friction everywhere on the brace. Computed, not measured.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct FieldReport {
    /// Largest pressure with curvature over `curvature_radius_mm`, in kPa.
    pub max_kpa: f64,
    /// Where, in mm.
    pub max_at: [f64; 3],
    /// Largest pressure with curvature over 5 mm, in kPa, where the scan's noise allows to state
    /// one.
    pub max_5mm_kpa: Option<f64>,
    /// Where, in mm.
    pub max_5mm_at: Option<[f64; 3]>,
    /// Why there is none.
    pub max_5mm_reason: Option<String>,
    /// Share of the brace where pressure over 5 mm could be stated, from 0 to 1.
    pub share_5mm: f64,
    /// Standard deviation of the scan's noise along its normal as seen over 5 mm, in mm.
    pub noise_mm: Option<f64>,
    /// Mean pressure by area, in kPa.
    pub mean_kpa: f64,
    /// Pressure that 95 % of the area do not exceed, in kPa.
    pub p95_kpa: f64,
    /// The limit in kPa: the design's, or 6.5.
    pub limit_kpa: f64,
    /// Area on the limb where pressure (over the radius or over 5 mm) is above it, in mm².
    pub area_over_limit_mm2: f64,
    /// Area where the fabric would lift off the limb, in mm².
    pub area_lifting_mm2: f64,
    /// Area where warp or weft is compressed, in mm².
    pub area_compressed_mm2: f64,
    /// Area where warp is, in mm².
    pub area_warp_compressed_mm2: f64,
    /// Area where weft is, in mm².
    pub area_weft_compressed_mm2: f64,
    /// The strain below which fabric counts as compressed.
    pub compressed_below_strain: f64,
    /// Largest strain of warp or weft.
    pub max_strain: f64,
    /// Where, in mm.
    pub max_strain_at: [f64; 3],
    /// Area where a strain is more than the fabric bears, in mm².
    pub area_over_strain_mm2: f64,
    /// Largest friction coefficient needed to hold the fabric in its place.
    pub friction_max: Option<f64>,
    /// Where, in mm.
    pub friction_max_at: Option<[f64; 3]>,
    /// Friction coefficient that is enough for 95 % of `friction_area_mm2`.
    pub friction_p95: Option<f64>,
    /// Area for which a coefficient can be stated: off the free edges, where something presses.
    pub friction_area_mm2: f64,
    /// A high friction coefficient of fabric on dry skin.
    pub skin_friction: f64,
    /// Area where more than that is needed, in mm²: the fabric creeps there.
    pub area_over_skin_friction_mm2: f64,
    /// How much pressure rises from the far end to the end near the body, in kPa: a straight line
    /// through `rows`.
    pub rise_to_body_kpa: f64,
    /// Mean pressure across the limb, from the far end to the end near the body.
    pub rows: Vec<PressureRow>,
    /// Distance of the places where curvature and friction were computed, in mm; null: everywhere.
    pub sampled_every_mm: Option<f64>,
}

/// Mean pressure on a band across the limb.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct PressureRow {
    /// Its middle in the pattern along weft, in mm.
    pub y_mm: f64,
    /// Mean pressure by area, in kPa.
    pub mean_kpa: f64,
}

/// The figures of a field and what the designer should know of it.
pub(crate) fn report_field(
    field: &Field,
    disk: &Surface,
    coordinates: &[DVec2],
    design: &Design,
) -> (FieldReport, Vec<Warning>) {
    let limit = design.limits.max_kpa.unwrap_or(Limits::WARN_KPA);
    let summary = field.summary(disk, coordinates, limit, design.fabric.max_strain);
    let mut warnings = Vec::new();
    warnings.extend(over_limit(&summary, limit));
    warnings.extend(bony(field, disk, design, limit));
    warnings.extend(rising(&summary));
    warnings.extend(over_strain(&summary, design.fabric.max_strain));
    (figures(field, &summary, limit), warnings)
}

fn figures(field: &Field, summary: &Summary, limit_kpa: f64) -> FieldReport {
    let fine = summary.max_fine_kpa;
    FieldReport {
        max_kpa: summary.max_kpa.value,
        max_at: summary.max_kpa.at.to_array(),
        max_5mm_kpa: fine.ok().map(|peak| peak.value),
        max_5mm_at: fine.ok().map(|peak| peak.at.to_array()),
        max_5mm_reason: fine.err().map(|why| why.text()),
        share_5mm: summary.fine_share,
        noise_mm: field.noise_mm,
        mean_kpa: summary.mean_kpa,
        p95_kpa: summary.p95_kpa,
        limit_kpa,
        area_over_limit_mm2: summary.area_over_limit,
        area_lifting_mm2: summary.area_lifting,
        area_compressed_mm2: summary.area_compressed,
        area_warp_compressed_mm2: summary.area_warp_compressed,
        area_weft_compressed_mm2: summary.area_weft_compressed,
        compressed_below_strain: COMPRESSED_BELOW,
        max_strain: summary.max_strain.value,
        max_strain_at: summary.max_strain.at.to_array(),
        area_over_strain_mm2: summary.area_over_strain,
        friction_max: summary.max_friction.map(|peak| peak.value),
        friction_max_at: summary.max_friction.map(|peak| peak.at.to_array()),
        friction_p95: summary.p95_friction,
        friction_area_mm2: summary.friction_area,
        skin_friction: SKIN_FRICTION,
        area_over_skin_friction_mm2: summary.area_over_friction,
        rise_to_body_kpa: summary.rise_kpa,
        rows: summary
            .rows
            .iter()
            .map(|row| PressureRow { y_mm: row.y, mean_kpa: row.kpa })
            .collect(),
        sampled_every_mm: field.sampled_every_mm,
    }
}

fn over_limit(summary: &Summary, limit: f64) -> Option<Warning> {
    let coarse = summary.max_kpa;
    let fine = summary.max_fine_kpa.ok().filter(|fine| fine.value > coarse.value);
    let (most, over) = fine.map_or((coarse, ""), |fine| (fine, " with curvature over 5 mm"));
    (most.value > limit).then(|| {
        Warning::at(
            "field_over_limit",
            format!(
                "the brace presses with up to {:.2} kPa ({:.0} mmHg){over} at {}, and on {:.0} mm² \
                 with more than the limit of {limit:.2} kPa ({:.0} mmHg): ask less on these \
                 threads, or pad the place",
                most.value,
                mmhg_from_kpa(most.value),
                place(most.at),
                summary.area_over_limit,
                mmhg_from_kpa(limit)
            ),
            most.at,
        )
    })
}

/// Warns of bony places under the brace with more than the limit within 5 mm: no nearer does a
/// hand point.
fn bony(field: &Field, disk: &Surface, design: &Design, limit: f64) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (k, &bone) in design.limits.bony.iter().enumerate() {
        let distance = |at: DVec3| at.distance(bone);
        let Some(nearest) = disk
            .points()
            .iter()
            .copied()
            .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
            .filter(|&at| distance(at) <= FARTHEST_BONE_MM.max(disk.mean_edge_length()))
        else {
            continue;
        };
        let Some((v, kpa)) = disk
            .vertex_ids()
            .filter(|&v| disk.point(v).distance(nearest) <= FINE_RADIUS_MM)
            .map(|v| (v, field.highest_kpa(v.index())))
            .reduce(|best, next| if next.1 > best.1 { next } else { best })
        else {
            continue;
        };
        if kpa > limit {
            let fine = field.fine_pressure_kpa[v.index()].is_some();
            let radius = if fine { FINE_RADIUS_MM } else { field.radius_mm };
            warnings.push(Warning::at(
                "bony_over_limit",
                format!(
                    "bony place {} gets {kpa:.2} kPa ({:.0} mmHg) with curvature over \
                     {radius:.0} mm: above the limit of {limit:.2} kPa ({:.0} mmHg); bone lies \
                     under the skin here: pad it or leave it out",
                    k + 1,
                    mmhg_from_kpa(kpa),
                    mmhg_from_kpa(limit)
                ),
                bone,
            ));
        }
    }
    warnings
}

fn rising(summary: &Summary) -> Option<Warning> {
    let least = LEAST_RISE_KPA.max(LEAST_RISE_SHARE * summary.mean_kpa);
    (summary.rise_kpa > least).then(|| {
        Warning::new(
            "rising_to_body",
            format!(
                "pressure rises by {:.2} kPa ({:.1} mmHg) from the far end to the end near the \
                 body (mean {:.2} kPa): it hinders the blood's way back like a tourniquet; ask \
                 less near the body or more at the far end",
                summary.rise_kpa,
                mmhg_from_kpa(summary.rise_kpa),
                summary.mean_kpa
            ),
        )
    })
}

fn over_strain(summary: &Summary, limit: f64) -> Option<Warning> {
    let most = summary.max_strain;
    (most.value > limit).then(|| {
        Warning::at(
            "strain_over_limit",
            format!(
                "the fabric is stretched by up to {:.2} at {}, and on {:.0} mm² by more than the \
                 {limit:.2} that it bears: ask less there, or take a stiffer fabric",
                most.value,
                place(most.at),
                summary.area_over_strain
            ),
            most.at,
        )
    })
}

/// Tells for every missed pressure what can be reached at its point.
pub(crate) fn missed(pressures: &[PressureReport]) -> Vec<Warning> {
    pressures
        .iter()
        .enumerate()
        .filter_map(|(k, pressure)| {
            let (reason, got) = (pressure.reason.as_ref()?, pressure.got_kpa?);
            let [low, high] = pressure.reachable_kpa?;
            let lifts = if low < 0.0 { "; below zero the fabric lifts off" } else { "" };
            Some(Warning::at(
                "pressure_missed",
                format!(
                    "pressure {} asks {:.2} kPa and gets {got:.2} kPa: {}. With this fabric \
                     {low:.2} to {high:.2} kPa ({:.0} to {:.0} mmHg) can be had here, where the \
                     limb curves by {:.1} per m along warp and {:.1} per m along weft{lifts}",
                    k + 1,
                    pressure.asked_kpa,
                    reason.text,
                    mmhg_from_kpa(low),
                    mmhg_from_kpa(high),
                    pressure.warp_curvature_per_m,
                    pressure.weft_curvature_per_m
                ),
                DVec3::from_array(pressure.at),
            ))
        })
        .collect()
}

fn place(at: DVec3) -> String {
    format!("({:.1}, {:.1}, {:.1}) mm", at.x, at.y, at.z)
}
