//! Wishes by the hundred, and what the woven model may never do.

use glam::DVec3;
use serde_json::{Value, json};
use support::cli::Bench;
use support::design::wanting;
use support::fixtures::{tube, tube_with_hole};
use support::mesh::{Mesh, Triangulation};
use support::random::Random;

use super::limb;

/// Demands that every strain that the strain function asks for is in 0..=`max`, at every row and
/// at every datum.
fn assert_in_bounds(report: &Value, max: f64) {
    let function = &report["strain_function"];
    let rows = function["rows"].as_array().unwrap();
    assert!(rows.len() > 5, "{function}");
    for row in rows {
        let strain = row["strain"].as_f64().unwrap();
        assert!((0.0..=max).contains(&strain), "{row}");
    }
    for datum in function["data"].as_array().unwrap() {
        let fitted = datum["fitted"].as_f64().unwrap();
        assert!((0.0..=max).contains(&fitted), "{datum}");
        let residual = fitted - datum["asked"].as_f64().unwrap();
        assert!((datum["residual"].as_f64().unwrap() - residual).abs() < 1e-9, "{datum}");
    }
}

#[test]
fn a_painted_field_of_300_points_gives_its_gradient() {
    let tube = tube(45.0, 160.0, 56, Triangulation::Alternating);
    let mut random = Random::new(11);
    let wanted = |z: f64| 1.0 + z / 160.0;
    // Painted all over but for the last 8 mm of the ends.
    let wishes: Vec<(DVec3, f64)> = (0..300)
        .map(|_| {
            let (angle, z) = (3.1 * random.signed(), 80.0 + 72.0 * random.signed());
            (tube.at(angle, z), wanted(z))
        })
        .collect();
    let mut design = wanting(&wishes);
    let ends = [tube.at(2.4, 158.0), tube.at(2.4, 2.0)].map(|p| p.to_array());
    design["orientation"] = json!(ends);
    let bench = Bench::new();
    let args = ["--quiet", "--units", "mm", "--spacing", "7"];
    let _ = bench.flatten(&tube.mesh, &design, &args).succeeded();
    let (worn, report) = (bench.worn(), bench.report());
    assert_eq!((worn.flipped(), worn.overlaps(), worn.wound_twice()), (0, 0, 0));
    assert_eq!(report["pressures"].as_array().map(Vec::len), Some(300));
    assert_eq!(report["fit"]["converged"], true);
    assert_in_bounds(&report, 0.5);
    let low = worn.vt.iter().map(|p| p.y).fold(f64::MAX, f64::min);
    for share in [0.2, 0.35, 0.5, 0.65, 0.8] {
        let width = worn.width_at(low + share * worn.size().y);
        let expected = tube.polygon_girth() / (1.0 + wanted(160.0 * share) * 1e-3 * 45.0 / 0.5);
        // A thread stands for 7 mm of limb, over which the wish changes by 4 %.
        assert!((width / expected - 1.0).abs() < 0.015, "{width} instead of {expected} at {share}");
    }
}

#[test]
fn wishes_that_no_function_can_follow_never_leave_the_fabrics_bounds() {
    let tube = tube(45.0, 120.0, 48, Triangulation::Alternating);
    // Strains of 0.01 and 0.36, 4 mm apart, three times.
    let wishes: Vec<(DVec3, f64)> = [30.0, 60.0, 90.0]
        .into_iter()
        .flat_map(|z| [(tube.at(2.4, z), 0.11), (tube.at(2.4, z + 4.0), 4.0)])
        .collect();
    let mut design = wanting(&wishes);
    for max in [0.5, 0.2] {
        design["fabric"]["max_strain"] = json!(max);
        for row_spacing in ["0", "10"] {
            let bench = Bench::new();
            let args = ["--quiet", "--spacing", "8", "--row-spacing", row_spacing];
            let args = [&args[..], &["--max-iterations", "1500"]].concat();
            let _ = bench.flatten(&tube.mesh, &design, &args).succeeded();
            assert_in_bounds(&bench.report(), max);
        }
    }
}

/// Rest area of the woven model's cells, in mm²: a disk with `holes` holes has as many cells as
/// Euler's formula says.
fn cell_area(report: &Value, holes: f64) -> f64 {
    let figure = |key: &str| report["fit"][key].as_f64().unwrap();
    let cells = figure("springs") - figure("nodes") + 1.0 - holes;
    cells * figure("spacing_mm").powi(2)
}

#[test]
fn fabric_is_never_laid_twice() {
    let (bumpy, design) = limb();
    let holed = tube_with_hole(42.0, 120.0, 12.0, 48);
    let plain = tube(45.0, 120.0, 48, Triangulation::Jittered(3));
    let pull = wanting(&[(plain.at(2.4, 60.0), 2.5)]);
    let cases: [(&Mesh, &Value, f64); 3] =
        [(&bumpy, &design, 0.0), (&holed, &wanting(&[]), 1.0), (&plain.mesh, &pull, 0.0)];
    for (mesh, design, holes) in cases {
        for spacing in ["5", "8", "12"] {
            let bench = Bench::new();
            let args = ["--quiet", "--units", "mm", "--method=diffusion", "--spacing", spacing];
            let _ = bench.flatten(mesh, design, &args).succeeded();
            let report = bench.report();
            let share = cell_area(&report, holes) / bench.worn().area();
            // Whole cells only, so that the rim of the pattern has none.
            assert!((0.7..1.02).contains(&share), "{share} at spacing {spacing}");
        }
    }
}
