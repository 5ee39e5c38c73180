//! A small report for the tests of this folder.

use super::field::FieldReport;
use super::json::{
    ENERGY_UNIT, FitReport, GirthReport, HistoryEntry, ParameterValues, PatternReport,
    PressureReport, Reason, Report, SeamReport, StrainDatum, StrainFunctionReport, StrainRow,
    SurfaceReport,
};
use crate::design::{Fabric, Piece, PressureModel};
use crate::parameters::Parameters;
use crate::warning::Warning;

/// One pressure reached, one on a concave place.
pub(super) fn report() -> Report {
    let reached = PressureReport {
        at: [45.0, 0.1 + 0.2, 100.0],
        asked_kpa: 2.29,
        got_kpa: Some(2.28),
        got_local_kpa: Some(2.25),
        mean_curvature_per_m: 12.0,
        warp_curvature_per_m: 22.0,
        weft_curvature_per_m: 2.0,
        warp_strain: Some(0.149),
        weft_strain: Some(-0.001),
        reachable_kpa: Some([-0.01, 7.7]),
        thread: Some(-3),
        reason: None,
    };
    let missed = PressureReport {
        asked_kpa: 20.0 * 0.133322,
        got_kpa: None,
        got_local_kpa: None,
        warp_strain: None,
        weft_strain: None,
        reachable_kpa: None,
        thread: None,
        reason: Some(Reason {
            code: "concave",
            text: "the limb is concave here along warp: no tension presses on it; put a pad here \
                   or move the point to a convex place"
                .to_owned(),
        }),
        ..reached.clone()
    };
    Report {
        wovenfit: "0.1.0",
        piece: Piece { name: "Elbow".to_owned(), ..Piece::default() },
        pressure_model: PressureModel::Laplace,
        fabric: Fabric::default(),
        parameters: ParameterValues::from(&Parameters::default()),
        curvature_radius_mm: 10.0,
        surface: SurfaceReport {
            vertices: 1000,
            triangles: 1960,
            boundary_loops: 2,
            area_mm2: 61_234.5,
            length_mm: Some(250.0),
            girths: vec![GirthReport { at_mm: 20.0, girth_mm: 268.0 }],
        },
        fit: FitReport {
            method: "diffusion".to_owned(),
            iterations: 4000,
            converged: true,
            stopped_by: "plateau",
            energy: 12.5,
            energy_of_free_seams: Some(0.0),
            energy_unit: ENERGY_UNIT,
            e_ssd: 3.5,
            springs: 5000,
            nodes: 2600,
            spacing_mm: 5.0,
            history: vec![HistoryEntry {
                iteration: 50,
                spacing_mm: 20.0,
                nodes: 160,
                springs: 4200,
                energy: 80.0,
                e_ssd: 20.0,
            }],
        },
        strain_function: StrainFunctionReport {
            form: "smoothed",
            rows: vec![StrainRow { y_mm: 0.0, t: 0.0, strain: 0.149 }],
            data: vec![StrainDatum {
                t: 0.5,
                wanted: 0.15,
                asked: 0.15,
                fitted: 0.149,
                residual: -0.001,
            }],
        },
        pressures: vec![reached, missed],
        field: FieldReport { max_kpa: 3.1, limit_kpa: 6.5, ..FieldReport::default() },
        pattern: PatternReport {
            width_mm: 230.0,
            height_mm: 250.0,
            area_mm2: 55_000.0,
            flipped: 0,
            overlaps: 0,
        },
        seams: vec![SeamReport { left_mm: 250.1, right_mm: 250.2 }],
        warnings: vec![Warning::new("concave", "a pressure is wanted where the limb is concave")],
    }
}
