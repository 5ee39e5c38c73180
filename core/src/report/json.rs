//! The data of `report.json`.
//!
//! Plain data in the order in which it is written. All numbers are finite; what is unknown is
//! `None` and becomes `null`. There are no times in it: the same input gives the same bytes.

use serde::ser::{Serialize, SerializeMap, Serializer};

use super::field::FieldReport;
use crate::design::{Fabric, Piece, PressureModel};
use crate::export::json_text;
use crate::parameters::{PARAMETERS, Parameters};
use crate::units::mmhg_from_kpa;
use crate::warning::Warning;

/// Everything that a run found out.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Report {
    /// Version of this program.
    pub wovenfit: &'static str,
    /// What is written on the piece.
    pub piece: Piece,
    /// The formula between tension and pressure.
    pub pressure_model: PressureModel,
    /// The fabric, with what was left to its default.
    pub fabric: Fabric,
    /// Every parameter with the value used.
    pub parameters: ParameterValues,
    /// Radius over which curvature was estimated, in mm: the scale at which pressure is stated.
    pub curvature_radius_mm: f64,
    /// The surface that the brace covers.
    pub surface: SurfaceReport,
    /// How the fit went.
    pub fit: FitReport,
    /// The warp strain wanted along the limb.
    pub strain_function: StrainFunctionReport,
    /// The wanted pressures and what was reached, in the order of the design.
    pub pressures: Vec<PressureReport>,
    /// Pressure, strain and friction everywhere.
    pub field: FieldReport,
    /// The flat pattern.
    pub pattern: PatternReport,
    /// The seams of the pattern.
    pub seams: Vec<SeamReport>,
    /// What the designer should know.
    pub warnings: Vec<Warning>,
}

impl Report {
    /// The report as indented JSON; numbers have the fewest digits that read back as the same.
    #[must_use]
    pub fn to_json(&self) -> String {
        json_text(self)
    }
}

/// Every parameter of the table with its value as text, in the order of the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParameterValues(Vec<(&'static str, String)>);

impl ParameterValues {
    /// Name and value, in the order of the table.
    #[must_use]
    pub fn entries(&self) -> &[(&'static str, String)] {
        &self.0
    }
}

impl From<&Parameters> for ParameterValues {
    fn from(parameters: &Parameters) -> Self {
        let value = |name| parameters.get(name).ok().map(|value| (name, value));
        Self(PARAMETERS.iter().filter_map(|parameter| value(parameter.name)).collect())
    }
}

impl Serialize for ParameterValues {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

/// The surface that the brace covers, after repair and region, before the cut.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SurfaceReport {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of boundary loops.
    pub boundary_loops: usize,
    /// Area in mm².
    pub area_mm2: f64,
    /// Length along the limb's centre line in mm, where there is one.
    pub length_mm: Option<f64>,
    /// Girths along the limb, from the end near the body.
    pub girths: Vec<GirthReport>,
}

/// A girth.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct GirthReport {
    /// Distance from the end near the body along the centre line, in mm.
    pub at_mm: f64,
    /// Girth in mm.
    pub girth_mm: f64,
}

/// The unit of the fit's energies.
pub const ENERGY_UNIT: &str = "N·mm";

/// How the fit went.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FitReport {
    /// The method, by its name among the parameters.
    pub method: String,
    /// Steps taken, all levels together.
    pub iterations: u64,
    /// Whether it ended before its maximum, at its tolerance or its plateau.
    pub converged: bool,
    /// Why it ended: `gradient`; `unsettled` (at rest, with the targets that came nearest to the pressures);
    /// `strain_tolerance` or `plateau` (diffusion); `max_iterations`.
    pub stopped_by: &'static str,
    /// Energy of all springs, in the unit of `energy_unit`.
    pub energy: f64,
    /// Energy without the condition that sewn edges have equal lengths, in the same unit, where they
    /// have: what the seams cost is the difference.
    pub energy_of_free_seams: Option<f64>,
    /// [`ENERGY_UNIT`].
    pub energy_unit: &'static str,
    /// Sum of squared strain differences of warp and weft springs, Eq. (14).
    pub e_ssd: f64,
    /// Number of warp and weft springs: what `e_ssd` is a sum over.
    pub springs: usize,
    /// Number of woven nodes, or of the surface's vertices.
    pub nodes: usize,
    /// Distance of neighbouring threads at rest, in mm.
    pub spacing_mm: f64,
    /// The course of the fit.
    pub history: Vec<HistoryEntry>,
}

/// A state in the course of the fit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct HistoryEntry {
    /// Steps taken until then, all levels together.
    pub iteration: u64,
    /// Distance of neighbouring threads of the level, in mm.
    pub spacing_mm: f64,
    /// Number of woven nodes.
    pub nodes: usize,
    /// Number of warp and weft springs: what `e_ssd` is a sum over.
    pub springs: usize,
    /// Energy of all springs in N·mm.
    pub energy: f64,
    /// Sum of squared strain differences, Eq. (14).
    pub e_ssd: f64,
}

/// The strain function ε(t), Eqs. (10) and (11).
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct StrainFunctionReport {
    /// How the data were met: `zero` (none), `constant` (one), `squared` (Eq. 11), `floored`
    /// (Eq. 10, floored at zero) or `smoothed` (too close to be met).
    pub form: &'static str,
    /// The wanted warp strain of each thread.
    pub rows: Vec<StrainRow>,
    /// What the function goes through or was smoothed from.
    pub data: Vec<StrainDatum>,
}

/// The wanted warp strain of a thread.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct StrainRow {
    /// Where the thread lies in the pattern along weft, in mm.
    pub y_mm: f64,
    /// The same as the function's parameter, from 0 to 1.
    pub t: f64,
    /// The wanted warp strain.
    pub strain: f64,
}

/// A strain that wanted pressures ask of a thread.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct StrainDatum {
    /// Where, from 0 to 1.
    pub t: f64,
    /// The strain that the wanted pressures need, Eq. (3).
    pub wanted: f64,
    /// What the fit was asked for: `wanted` within the fabric's limits, corrected by what the
    /// thread took.
    pub asked: f64,
    /// The strain function's value there.
    pub fitted: f64,
    /// `fitted − asked`; zero where the function interpolates.
    pub residual: f64,
}

/// A wanted pressure and what was reached; in JSON also in mmHg.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureReport {
    /// Where it is wanted, in mm.
    pub at: [f64; 3],
    /// Wanted, in kPa.
    pub asked_kpa: f64,
    /// Computed with the tension equal along the thread (Lemma 3) and the curvature here, in kPa.
    pub got_kpa: Option<f64>,
    /// Computed with the fit's own strains averaged over the curvature radius, in kPa.
    pub got_local_kpa: Option<f64>,
    /// Mean curvature per metre, outward positive.
    pub mean_curvature_per_m: f64,
    /// Normal curvature along warp per metre, outward positive.
    pub warp_curvature_per_m: f64,
    /// Normal curvature along weft per metre, outward positive.
    pub weft_curvature_per_m: f64,
    /// Strain along warp.
    pub warp_strain: Option<f64>,
    /// Strain along weft.
    pub weft_strain: Option<f64>,
    /// Least and largest pressure that warp strains from zero to the fabric's limit give here, in
    /// kPa; negative where the fabric would lift off.
    pub reachable_kpa: Option<[f64; 2]>,
    /// The row of the warp thread, where there is one.
    pub thread: Option<i64>,
    /// Why it misses what was wanted; `None` where it does not.
    pub reason: Option<Reason>,
}

impl Serialize for PressureReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(16))?;
        map.serialize_entry("at", &self.at)?;
        map.serialize_entry("asked_kpa", &self.asked_kpa)?;
        map.serialize_entry("got_kpa", &self.got_kpa)?;
        map.serialize_entry("got_local_kpa", &self.got_local_kpa)?;
        map.serialize_entry("asked_mmhg", &mmhg_from_kpa(self.asked_kpa))?;
        map.serialize_entry("got_mmhg", &self.got_kpa.map(mmhg_from_kpa))?;
        map.serialize_entry("got_local_mmhg", &self.got_local_kpa.map(mmhg_from_kpa))?;
        map.serialize_entry("mean_curvature_per_m", &self.mean_curvature_per_m)?;
        map.serialize_entry("warp_curvature_per_m", &self.warp_curvature_per_m)?;
        map.serialize_entry("weft_curvature_per_m", &self.weft_curvature_per_m)?;
        map.serialize_entry("warp_strain", &self.warp_strain)?;
        map.serialize_entry("weft_strain", &self.weft_strain)?;
        map.serialize_entry("reachable_kpa", &self.reachable_kpa)?;
        let reachable = self.reachable_kpa.map(|range| range.map(mmhg_from_kpa));
        map.serialize_entry("reachable_mmhg", &reachable)?;
        map.serialize_entry("thread", &self.thread)?;
        map.serialize_entry("reason", &self.reason)?;
        map.end()
    }
}

/// Why a wanted pressure is missed.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Reason {
    /// A frozen short name that programs can test.
    pub code: &'static str,
    /// The same for people, with the remedy.
    pub text: String,
}

/// The flat pattern.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct PatternReport {
    /// Width (along warp) in mm.
    pub width_mm: f64,
    /// Height (along weft) in mm.
    pub height_mm: f64,
    /// Area in mm².
    pub area_mm2: f64,
    /// Number of triangles that lie upside down.
    pub flipped: usize,
    /// Number of places where the pattern's edge crosses itself.
    pub overlaps: usize,
}

/// A seam of the pattern.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct SeamReport {
    /// Length of its left side in the pattern, in mm.
    pub left_mm: f64,
    /// Length of its right side, in mm.
    pub right_mm: f64,
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::super::example::report;
    use super::*;

    #[test]
    fn the_contracts_keys_are_there() {
        let json: Value = serde_json::from_str(&report().to_json()).unwrap();
        let keys = |pointer: &str| -> Vec<String> {
            json.pointer(pointer).unwrap().as_object().unwrap().keys().cloned().collect()
        };
        for (pointer, wanted) in [
            ("", "wovenfit curvature_radius_mm surface fit pressures field pattern seams warnings"),
            ("/surface", "vertices triangles boundary_loops area_mm2 girths"),
            ("/surface/girths/0", "at_mm girth_mm"),
            ("/fit", "method iterations converged energy e_ssd history"),
            (
                "/pressures/0",
                "at asked_kpa got_kpa got_local_kpa mean_curvature_per_m warp_curvature_per_m \
                 weft_curvature_per_m warp_strain weft_strain reason asked_mmhg got_mmhg \
                 reachable_kpa reachable_mmhg",
            ),
            (
                "/field",
                "max_kpa max_at max_5mm_kpa max_5mm_reason p95_kpa area_over_limit_mm2 \
                 area_lifting_mm2 area_compressed_mm2 friction_max friction_p95 limit_kpa",
            ),
            ("/pattern", "width_mm height_mm area_mm2 flipped overlaps"),
            ("/seams/0", "left_mm right_mm"),
            ("/warnings/0", "code message"),
        ] {
            let known = keys(pointer);
            for key in wanted.split_whitespace() {
                assert!(known.iter().any(|k| k == key), "{pointer}/{key}");
            }
        }
        assert_eq!(json["pressures"][0]["reason"], Value::Null);
        assert_eq!(json["pressures"][1]["got_kpa"], Value::Null);
        assert_eq!(json["pressures"][1]["reason"]["code"], json!("concave"));
        assert_eq!(json["pressure_model"], json!("laplace"));
        let mmhg = json["pressures"][1]["asked_mmhg"].as_f64().unwrap();
        assert!((mmhg - 20.0).abs() < 1e-9);
    }

    #[test]
    fn parameters_stand_in_the_order_of_the_table_with_their_values() {
        let mut parameters = Parameters::default();
        parameters.set("spacing", "4.5").unwrap();
        let values = ParameterValues::from(&parameters);
        let names: Vec<&str> = values.entries().iter().map(|(name, _)| *name).collect();
        let table: Vec<&str> = PARAMETERS.iter().map(|p| p.name).collect();
        assert_eq!(names, table);
        let text = json_text(&values);
        assert!(text.contains("\"spacing\": \"4.5\""), "{text}");
        assert!(text.find("\"units\"") < text.find("\"spacing\""));
    }

    #[test]
    fn numbers_read_back_exactly_and_bytes_do_not_change() {
        let text = report().to_json();
        assert!(text.contains("\"at\": [45.0, 0.30000000000000004, 100.0]"), "{text}");
        assert_eq!(text, report().to_json());
        assert!(text.ends_with("}\n"));
    }
}
