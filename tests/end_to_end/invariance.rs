//! What must not change the pattern: threads, units, where the limb is in space, triangulation.

use glam::DVec3;
use support::check::congruence_gap;
use support::cli::Bench;
use support::fixtures::tube;
use support::mesh::{Mesh, Triangulation};
use support::motion::{Motion, design_in_unit};
use support::write;

use super::{FAST, limb};

#[test]
fn the_same_input_gives_the_same_bytes_on_any_number_of_threads() {
    let (mesh, design) = limb();
    let runs: Vec<Vec<Vec<u8>>> = ["1", "4", "4"]
        .iter()
        .map(|threads| {
            let bench = Bench::new();
            let surface = bench.write("surface.obj", write::obj(&mesh));
            let variables = [("RAYON_NUM_THREADS", *threads)];
            let _ = bench.flatten_file(&surface, &design, &FAST, &variables).succeeded();
            bench.results().iter().map(|name| bench.out(name)).collect()
        })
        .collect();
    assert_eq!(runs[0].len(), 5);
    assert!(runs[0] == runs[1], "one thread and four");
    assert!(runs[1] == runs[2], "the same twice");
}

#[test]
fn millimetres_metres_and_inches_give_the_same_pattern() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let _ = bench.flatten(&mesh, &design, &FAST).succeeded();
    let millimetres = bench.worn();
    for (unit, per_mm) in [("m", 1e-3), ("cm", 0.1), ("in", 1.0 / 25.4)] {
        let other = Bench::new();
        let design = design_in_unit(&design, unit, per_mm);
        let args = [&FAST[..], &["--units", unit]].concat();
        let _ = other.flatten(&mesh.scaled(per_mm), &design, &args).succeeded();
        let worn = other.worn();
        assert_eq!(worn.faces, millimetres.faces, "{unit}");
        let gap =
            worn.vt.iter().zip(&millimetres.vt).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(gap < 1e-6, "{gap} mm between mm and {unit}");
    }
}

#[test]
fn a_scan_of_32_bits_with_picked_points_is_the_same_in_every_unit() {
    // Half of the 32-bit numbers from 4 to 8 lie midway between millionths of a binary fraction.
    let (mesh, mut design) = limb();
    let mesh =
        Mesh { points: mesh.points.iter().map(|p| p.as_vec3().as_dvec3()).collect(), ..mesh };
    for (k, v) in [345, 177].into_iter().enumerate() {
        design["pressures"][k]["at"] = serde_json::json!(mesh.points[v].to_array());
    }
    let run = |unit: &str, per_mm: f64| {
        let bench = Bench::new();
        let design = design_in_unit(&design, unit, per_mm);
        let args = [&FAST[..], &["--units", unit]].concat();
        let _ = bench.flatten(&mesh.scaled(per_mm), &design, &args).succeeded();
        bench.out("worn.obj")
    };
    let millimetres = run("mm", 1.0);
    for (unit, per_mm) in [("m", 1e-3), ("in", 1.0 / 25.4)] {
        assert!(run(unit, per_mm) == millimetres, "{unit}");
    }
}

#[test]
fn turning_and_moving_the_limb_changes_nothing() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let _ = bench.flatten(&mesh, &design, &FAST).succeeded();
    let here = bench.worn();
    let motions = [
        Motion::new(DVec3::new(1.0, 2.0, -0.5), 2.3, DVec3::new(300.0, -150.0, 80.0)),
        // A scanner's table: the limb upside down and far from the origin.
        Motion::new(DVec3::X, std::f64::consts::PI, DVec3::new(0.0, 2500.0, 0.0)),
    ];
    for motion in motions {
        let other = Bench::new();
        let _ = other.flatten(&motion.mesh(&mesh), &motion.design(&design), &FAST).succeeded();
        let there = other.worn();
        assert_eq!(there.faces, here.faces, "{motion:?}");
        let gap = congruence_gap(&there.vt, &here.vt);
        assert!(gap < 1e-3, "{gap} mm, {motion:?}");
        let pressure =
            |bench: &Bench, i: usize| bench.report()["pressures"][i]["got_kpa"].as_f64().unwrap();
        for i in 0..2 {
            assert!((pressure(&other, i) / pressure(&bench, i) - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn the_triangulation_does_not_change_the_pattern() {
    // On a polyhedral tube every triangulation has the same truth.
    let areas: Vec<f64> = Triangulation::ALL
        .into_iter()
        .map(|triangulation| {
            let tube = tube(42.0, 100.0, 48, triangulation);
            let design = support::design::wanting(&[(tube.at(1.9, 50.0), 2.0)]);
            let bench = Bench::new();
            let _ = bench.flatten(&tube.mesh, &design, &FAST).succeeded();
            let worn = bench.worn();
            assert_eq!((worn.flipped(), worn.overlaps()), (0, 0));
            worn.area()
        })
        .collect();
    for area in &areas {
        assert!((area / areas[0] - 1.0).abs() < 0.01, "{areas:?}");
    }
}
