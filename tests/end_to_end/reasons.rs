//! Each reason for a missed pressure has a limb that gives it and a near twin that does not.

use glam::DVec3;
use serde_json::{Value, json};
use support::cli::Bench;
use support::design::wanting;
use support::fixtures::{Tube, tube};
use support::mesh::{Mesh, Triangulation, grid};

const TAU: f64 = std::f64::consts::TAU;

/// The reason's code at each wanted pressure, empty where it was met, and the whole table.
fn reasons(mesh: &Mesh, design: &Value, args: &[&str]) -> (Vec<String>, Vec<Value>) {
    let bench = Bench::new();
    let args = [&["--quiet", "--units", "mm", "--spacing", "6"], args].concat();
    let _ = bench.flatten(mesh, design, &args).succeeded();
    let pressures = bench.report()["pressures"].as_array().unwrap().clone();
    let code = |p: &Value| match &p["reason"] {
        Value::Null => String::new(),
        reason => {
            assert!(reason["text"].as_str().is_some_and(|text| text.len() > 20), "{reason}");
            reason["code"].as_str().unwrap().to_owned()
        }
    };
    (pressures.iter().map(code).collect(), pressures)
}

fn cylinder() -> Tube {
    tube(45.0, 120.0, 56, Triangulation::Alternating)
}

/// A limb that is doubly curved: 50 mm round its middle, 35 mm at its ends.
fn barrel() -> Mesh {
    grid(56, 24, true, Triangulation::Alternating, |u, v| on_barrel(TAU * u, 120.0 * v))
}

fn on_barrel(angle: f64, z: f64) -> DVec3 {
    let r = 50.0 - 15.0 * ((z - 60.0) / 60.0).powi(2);
    DVec3::new(r * angle.cos(), r * angle.sin(), z)
}

/// A cylinder of 45 mm with a furrow along it, 12 mm deep at angle 0.
fn furrowed() -> Mesh {
    grid(120, 40, true, Triangulation::Alternating, |u, v| on_furrowed(TAU * u, 120.0 * v))
}

fn on_furrowed(angle: f64, z: f64) -> DVec3 {
    let off = (angle + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
    let r = 45.0 - 12.0 * (-(off / 0.35).powi(2)).exp();
    DVec3::new(r * angle.cos(), r * angle.sin(), z)
}

#[test]
fn in_a_furrow_no_tension_presses() {
    let inside = wanting(&[(on_furrowed(0.0, 60.0), 2.0)]);
    assert_eq!(reasons(&furrowed(), &inside, &[]).0, ["flat_or_hollow"]);
    let behind = wanting(&[(on_furrowed(3.0, 60.0), 2.0)]);
    assert_eq!(reasons(&furrowed(), &behind, &[]).0, [""]);
}

#[test]
fn a_fabric_that_does_not_bear_the_strain_is_named() {
    let tube = cylinder();
    // 2 kPa on 45 mm with 0.5 N/mm is a strain of 0.18.
    let mut design = wanting(&[(tube.at(2.4, 60.0), 2.0)]);
    design["fabric"]["max_strain"] = json!(0.16);
    let (codes, table) = reasons(&tube.mesh, &design, &[]);
    assert_eq!(codes, ["over_strain"]);
    assert!(table[0]["reason"]["text"].as_str().unwrap().contains("0.16"), "{table:?}");
    design["fabric"]["max_strain"] = json!(0.2);
    assert_eq!(reasons(&tube.mesh, &design, &[]).0, [""]);
}

#[test]
fn two_points_of_one_thread_that_want_different_things_name_each_other() {
    let tube = cylinder();
    let wish = |kpa: [f64; 3]| {
        let places = [(2.4, 60.0), (3.6, 60.0), (2.4, 100.0)];
        let wishes: Vec<_> =
            places.iter().zip(kpa).map(|(&(a, z), kpa)| (tube.at(a, z), kpa)).collect();
        let mut design = wanting(&wishes);
        let ends = [tube.at(3.0, 118.0), tube.at(3.0, 2.0)].map(|p| p.to_array());
        design["orientation"] = json!(ends);
        design
    };
    let (codes, table) = reasons(&tube.mesh, &wish([1.2, 2.2, 1.7]), &[]);
    assert_eq!(codes, ["thread_conflict", "thread_conflict", ""]);
    let text = |k: usize| table[k]["reason"]["text"].as_str().unwrap();
    assert!(text(0).contains("point 2") && text(1).contains("point 1"), "{table:?}");
    assert_eq!(reasons(&tube.mesh, &wish([1.7, 1.7, 1.7]), &[]).0, ["", "", ""]);
}

#[test]
fn a_run_cut_short_is_named() {
    let tube = cylinder();
    let design = wanting(&[(tube.at(2.4, 60.0), 2.0)]);
    let (codes, _) = reasons(&tube.mesh, &design, &["--newton-steps", "1"]);
    assert_eq!(codes, ["not_converged"]);
    assert_eq!(reasons(&tube.mesh, &design, &[]).0, [""]);
}

/// On a barrel no pattern gives every thread its strain: without correction a wish is missed.
const UNCORRECTED: [&str; 1] = ["--correct-pressures=false"];

#[test]
fn near_the_edge_the_edge_is_named_and_away_from_it_the_shape() {
    for (z, wanted) in [(5.0, "free_edge"), (115.0, "free_edge"), (40.0, "shape")] {
        let design = wanting(&[(on_barrel(2.4, z), 2.0)]);
        let (codes, table) = reasons(&barrel(), &design, &UNCORRECTED);
        assert_eq!(codes, [wanted], "{z} mm from the end: {table:?}");
        // 5 mm along the axis are 6.4 mm along the barrel's surface.
        let text = table[0]["reason"]["text"].as_str().unwrap();
        assert_eq!(text.contains("lies 6 mm from"), wanted == "free_edge", "{text}");
    }
}

#[test]
fn what_the_shape_denies_the_correction_gives() {
    let design = wanting(&[(on_barrel(2.4, 60.0), 2.0)]);
    assert_eq!(reasons(&barrel(), &design, &UNCORRECTED).0, ["shape"]);
    assert_eq!(reasons(&barrel(), &design, &[]).0, [""]);
}
