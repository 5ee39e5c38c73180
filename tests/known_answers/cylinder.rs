//! A cylinder of radius r asked for a pressure P comes back with girth / (1 + ε).
//!
//! Laplace's law: P = T / r with T = k ε, so ε = P r / k; 1 kPa = 1e-3 N/mm². The paper's Eq. (2)
//! with mean curvature 1 / (2 r) and no strain along weft: ε = 2 P r / (s π k). The girth is the
//! polygon's that the mesh has.

use std::f64::consts::PI;

use glam::DVec3;
use serde_json::{Value, json};
use support::check::WornObj;
use support::cli::Bench;
use support::design::wanting;
use support::fixtures::{Tube, tube};
use support::mesh::Triangulation;

/// Flattens the tube and demands that its pattern is girth / (1 + strain) wide at every height
/// away from the ends, and as high as the tube is long.
#[track_caller]
fn assert_pattern(tube: &Tube, design: &Value, strain: f64) -> WornObj {
    let bench = Bench::new();
    let args = ["--quiet", "--units", "mm", "--spacing", "7"];
    let _ = bench.flatten(&tube.mesh, design, &args).succeeded();
    let worn = bench.worn();
    assert_eq!((worn.flipped(), worn.overlaps(), worn.wound_twice()), (0, 0, 0));
    let low = worn.vt.iter().map(|p| p.y).fold(f64::MAX, f64::min);
    let high = low + worn.size().y;
    let expected = tube.polygon_girth() / (1.0 + strain);
    for share in [0.15, 0.31, 0.5, 0.67, 0.85] {
        let width = worn.width_at(low + share * (high - low));
        assert!(
            (width / expected - 1.0).abs() < 0.01,
            "{width} mm wide instead of {expected} at {share} of the height"
        );
    }
    let height = worn.area() / (0.5 * (worn.width_at(low + 0.3 * (high - low)) + expected));
    assert!((height / tube.length - 1.0).abs() < 0.015, "{height} mm high");
    let seams = worn.seams();
    assert_eq!(seams.len(), 1);
    assert!((seams[0].left_mm / tube.length - 1.0).abs() < 0.01, "{seams:?}");
    assert!((seams[0].right_mm / tube.length - 1.0).abs() < 0.01, "{seams:?}");
    worn
}

fn places(tube: &Tube) -> [DVec3; 3] {
    // Away from the start angle, where an automatic seam may lie, and on three heights.
    [0.25, 0.5, 0.75].map(|share| tube.at(2.2 + share, share * tube.length))
}

/// Asks for one pressure everywhere with Laplace's law; the strain that it takes.
fn laplace(tube: &Tube, kpa: f64, warp: f64, weft: f64) -> (Value, f64) {
    let mut design = wanting(&places(tube).map(|at| (at, kpa)));
    design["fabric"] = json!({"warp": warp, "weft": weft, "diagonal": 0.1 * warp});
    (design, kpa * 1e-3 * tube.radius / warp)
}

#[test]
fn an_elbow_sized_cylinder_at_15_mmhg() {
    for triangulation in Triangulation::ALL {
        let tube = tube(45.0, 90.0, 64, triangulation);
        let (design, strain) = laplace(&tube, 2.0, 0.5, 0.5);
        assert!((strain - 0.18).abs() < 1e-12);
        assert_pattern(&tube, &design, strain);
    }
}

#[test]
fn a_wrist_sized_cylinder_in_a_weak_fabric() {
    let tube = tube(28.0, 80.0, 48, Triangulation::Alternating);
    let (design, strain) = laplace(&tube, 3.0, 0.3, 0.3);
    assert!((strain - 0.28).abs() < 1e-12);
    assert_pattern(&tube, &design, strain);
}

#[test]
fn a_knee_sized_cylinder_in_a_fabric_stiffer_along_weft() {
    let tube = tube(60.0, 100.0, 64, Triangulation::Jittered(2));
    let (design, strain) = laplace(&tube, 1.5, 0.9, 1.4);
    assert!((strain - 0.1).abs() < 1e-12);
    assert_pattern(&tube, &design, strain);
}

#[test]
fn one_wish_in_mmhg_holds_for_the_whole_cylinder() {
    let tube = tube(40.0, 80.0, 56, Triangulation::Structured);
    let mut design = wanting(&[]);
    design["pressures"] = json!([{"at": places(&tube)[1].to_array(), "mmhg": 18.0}]);
    // 18 mmHg = 2.399796 kPa.
    assert_pattern(&tube, &design, 2.399_796e-3 * 40.0 / 0.5);
}

#[test]
fn without_wishes_the_pattern_is_as_wide_as_the_girth() {
    let tube = tube(45.0, 90.0, 56, Triangulation::Alternating);
    let worn = assert_pattern(&tube, &wanting(&[]), 0.0);
    super::assert_without_strain(&worn);
}

/// Asks for one pressure everywhere with the paper's formula; the strain that it takes.
fn paper(tube: &Tube, kpa: f64, warp: f64, s: f64) -> (Value, f64) {
    let mut design = wanting(&places(tube).map(|at| (at, kpa)));
    design["fabric"] = json!({"warp": warp, "weft": 0.5, "diagonal": 0.05, "s": s});
    design["pressure_model"] = json!("paper");
    (design, 2.0 * kpa * 1e-3 * tube.radius / (s * PI * warp))
}

#[test]
fn the_papers_formula_takes_less_strain_by_two_over_pi() {
    let tube = tube(45.0, 90.0, 56, Triangulation::Alternating);
    let (design, strain) = paper(&tube, 2.5, 0.5, 1.0);
    assert!((strain - 0.225 * 2.0 / PI).abs() < 1e-12);
    assert_pattern(&tube, &design, strain);
}

#[test]
fn the_papers_formula_with_s_of_two_over_pi_is_laplaces_law_on_a_cylinder() {
    let tube = tube(36.0, 80.0, 48, Triangulation::Jittered(4));
    let (design, strain) = paper(&tube, 2.5, 0.6, 2.0 / PI);
    assert!((strain - 2.5e-3 * 36.0 / 0.6).abs() < 1e-12);
    assert_pattern(&tube, &design, strain);
}

#[test]
fn two_wishes_on_one_cylinder_give_two_widths() {
    // 25 % of the length from either end; in between the strain function is smooth.
    let tube = tube(45.0, 160.0, 56, Triangulation::Alternating);
    let strain = |kpa: f64| kpa * 1e-3 * 45.0 / 0.5;
    let at = |share: f64| tube.at(2.4, share * tube.length);
    // Three points each keep the function flat where the width is measured.
    let wishes: Vec<(DVec3, f64)> = [0.1, 0.2, 0.3]
        .map(|share| (at(share), 1.0))
        .into_iter()
        .chain([0.7, 0.8, 0.9].map(|share| (at(share), 2.5)))
        .collect();
    let mut design = wanting(&wishes);
    let [top, bottom] = [tube.at(2.4, 158.0), tube.at(2.4, 2.0)];
    design["orientation"] = json!([top.to_array(), bottom.to_array()]);
    let bench = Bench::new();
    let args = ["--quiet", "--units", "mm", "--spacing", "7"];
    let _ = bench.flatten(&tube.mesh, &design, &args).succeeded();
    let worn = bench.worn();
    let low = worn.vt.iter().map(|p| p.y).fold(f64::MAX, f64::min);
    for (share, kpa) in [(0.2, 1.0), (0.8, 2.5)] {
        let width = worn.width_at(low + share * worn.size().y);
        let expected = tube.polygon_girth() / (1.0 + strain(kpa));
        // Neighbouring threads pull at each other where the width changes: 2 %.
        assert!((width / expected - 1.0).abs() < 0.02, "{width} instead of {expected}");
    }
}
