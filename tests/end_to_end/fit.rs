//! The default fit from outside: seams that can be sewn, pressures that are met, one pattern for one limb,
//! and a pattern that cannot be cut said so.

use std::path::Path;

use glam::{DVec2, DVec3};
use serde_json::{Value, json};
use support::check::{WornObj, outline_gap};
use support::cli::Bench;
use support::design::wanting;
use support::mesh::{Mesh, Triangulation, grid};

use super::samples::sample;

/// A sample limb of so many triangles flattened by the design of the one with 6,000.
fn flattened(limb: &str, triangles: usize, options: &[&str]) -> (WornObj, Value) {
    let bench = Bench::new();
    let (_, design) = sample(&bench, limb, &["--triangles", "6000"]);
    let (surface, _) = sample(&bench, limb, &["--triangles", &triangles.to_string()]);
    let options = [&["--quiet"], options].concat();
    let _ = bench.flatten_file(&surface, &design, &options, &[]).succeeded();
    (bench.worn(), bench.report())
}

/// A sample's mesh.
fn read(file: &Path) -> Mesh {
    let (models, _) = tobj::load_obj(file, &tobj::LoadOptions::default()).unwrap();
    let [tobj::Model { mesh, .. }] = &models[..] else { panic!("{} models", models.len()) };
    let corners = mesh.indices.chunks_exact(3);
    Mesh {
        points: mesh.positions.chunks_exact(3).map(|p| DVec3::from_slice(p)).collect(),
        triangles: corners.map(|t| [0, 1, 2].map(|k| t[k] as usize)).collect(),
    }
}

/// Pressures round the annotated points, in kPa.
fn local_pressures(report: &Value) -> Vec<f64> {
    let pressures = report["pressures"].as_array().unwrap();
    pressures.iter().map(|p| p["got_local_kpa"].as_f64().unwrap()).collect()
}

/// Both sides of every seam agree: the whole within 0.1 mm, any 20 mm within 0.5 %.
fn assert_sewable(limb: &str, worn: &WornObj) {
    let seams = worn.seams();
    assert!(!seams.is_empty(), "{limb} has no seam");
    for seam in &seams {
        assert!((seam.left_mm - seam.right_mm).abs() < 0.1, "{limb}: {seam:?}");
        let rest = |[a, b]: [usize; 2]| worn.vt[a].distance(worn.vt[b]);
        for start in 0..seam.pairs.len() {
            let (mut left, mut right) = (0.0, 0.0);
            for pair in &seam.pairs[start..] {
                left += rest(pair[0]);
                right += rest(pair[1]);
                if left >= 20.0 {
                    break;
                }
            }
            if left >= 20.0 {
                assert!((left / right - 1.0).abs() < 0.005, "{limb}: {left} and {right} mm");
            }
        }
    }
}

#[test]
fn every_sample_can_be_sewn_and_presses_as_asked() {
    for limb in ["elbow", "knee", "wrist", "ankle", "forearm"] {
        let (worn, report) = flattened(limb, 6000, &[]);
        assert_eq!((worn.flipped(), worn.overlaps(), worn.wound_twice()), (0, 0, 0), "{limb}");
        assert_sewable(limb, &worn);
        let pressures = report["pressures"].as_array().expect("a list");
        assert!(pressures.len() >= 4);
        for pressure in pressures {
            let share =
                pressure["got_kpa"].as_f64().unwrap() / pressure["asked_kpa"].as_f64().unwrap();
            assert!((share - 1.0).abs() < 0.02, "{limb}: {pressure}");
        }
        let fit = &report["fit"];
        assert_eq!(fit["stopped_by"], "gradient", "{limb}");
        // Seams cost energy, and not much of it.
        let (with, without) =
            (fit["energy"].as_f64().unwrap(), fit["energy_of_free_seams"].as_f64().unwrap());
        assert!(without <= with && with < 1.15 * without, "{limb}: {with} {without}");
        // Every target stands in the report before and after its correction.
        for datum in report["strain_function"]["data"].as_array().unwrap() {
            assert!(datum["wanted"].is_f64() && datum["asked"].is_f64(), "{datum}");
        }
    }
}

#[test]
fn seams_that_are_let_go_do_not_meet() {
    let (worn, report) = flattened("knee", 6000, &["--equal-seams=false"]);
    let seam = &worn.seams()[0];
    assert!((seam.left_mm - seam.right_mm).abs() > 1.0, "{seam:?}: nothing to hold");
    assert!(report["fit"]["energy_of_free_seams"].is_null());
    let codes = report["warnings"].to_string();
    assert!(codes.contains("seam_lengths"), "{codes}");
}

#[test]
fn finer_triangles_give_the_same_outline_and_pressures() {
    for limb in ["elbow", "knee", "wrist", "forearm", "ankle"] {
        let runs = [5_000, 20_000, 80_000].map(|triangles| flattened(limb, triangles, &[]));
        let outline = |worn: &WornObj| -> Vec<DVec2> {
            worn.outline()[0].iter().map(|&k| worn.vt[k]).collect()
        };
        let fine = outline(&runs[2].0);
        for ((worn, report), most) in runs.iter().zip([1.0, 0.3]) {
            let gap = outline_gap(&outline(worn), &fine);
            assert!(gap < most, "{limb}: {gap} mm");
            for (a, b) in local_pressures(report).iter().zip(local_pressures(&runs[2].1)) {
                assert!((a / b - 1.0).abs() < 0.02, "{limb}: {a} and {b} kPa");
            }
        }
    }
}

#[test]
fn flipped_diagonals_give_the_same_outline_and_pressures() {
    // Samples have nearly equilateral triangles: theirs with the other diagonals have angles of 120 degrees. Seams are
    // drawn where the shortest way is nearly as short a millimetre beside it.
    let seams = [
        ("knee", json!([])),
        ("ankle", json!([])),
        ("elbow", json!([[[38.6, 12.0, 111.2], [102.4, 20.1, -69.1]]])),
        ("wrist", json!([[[-25.2, -15.4, 91.9], [-41.3, -21.6, -96.6]]])),
    ];
    for (limb, seams) in seams {
        let bench = Bench::new();
        let (file, mut design) = sample(&bench, limb, &["--triangles", "20000"]);
        if seams[0].is_array() {
            design["seams"] = seams;
        }
        let mesh = read(&file);
        let flipped = mesh.with_flipped_diagonals();
        let others = mesh.triangles.iter().zip(&flipped.triangles).filter(|(a, b)| a != b);
        assert!(others.count() > mesh.triangles.len() * 3 / 4);
        let [(one, local), (other, flipped)] = [mesh, flipped].map(|mesh| {
            let _ = bench.flatten(&mesh, &design, &["--quiet", "--units", "mm"]).succeeded();
            let (worn, report) = (bench.worn(), bench.report());
            assert_eq!(worn.flipped(), 0, "{limb}");
            let outline = worn.outline()[0].iter().map(|&k| worn.vt[k]).collect::<Vec<_>>();
            (outline, local_pressures(&report))
        });
        let gap = outline_gap(&one, &other);
        assert!(gap < 0.3, "{limb}: {gap} mm");
        for (a, b) in local.iter().zip(&flipped) {
            assert!((a / b - 1.0).abs() < 0.02, "{limb}: {a} and {b} kPa");
        }
    }
}

#[test]
fn slivers_neither_stop_the_fit_nor_turn_over() {
    // Of heights that are nothing beside what the fit moves: held back by them it did not come to rest.
    for (limb, every, height) in [("wrist", 20, 5e-4), ("ankle", 20, 1e-3), ("elbow", 10, 1e-3)] {
        let bench = Bench::new();
        let (file, design) = sample(&bench, limb, &["--triangles", "6000"]);
        let mesh = read(&file);
        let [(worn, report), (others, other)] =
            [mesh.with_slivers(every, height), mesh].map(|mesh| {
                let _ = bench.flatten(&mesh, &design, &["--quiet", "--units", "mm"]).succeeded();
                (bench.worn(), bench.report())
            });
        assert_eq!((worn.flipped(), worn.overlaps()), (0, 0), "{limb}");
        assert_eq!(report["fit"]["stopped_by"], "gradient", "{limb}");
        assert_sewable(limb, &worn);
        let outline = |worn: &WornObj| -> Vec<DVec2> {
            worn.outline()[0].iter().map(|&k| worn.vt[k]).collect()
        };
        let gap = outline_gap(&outline(&worn), &outline(&others));
        assert!(gap < 0.5, "{limb}: {gap} mm");
        for (a, b) in local_pressures(&report).iter().zip(local_pressures(&other)) {
            assert!((a / b - 1.0).abs() < 0.02, "{limb}: {a} and {b} kPa");
        }
    }
}

#[test]
fn a_pattern_that_overlaps_names_both_places_and_a_dart() {
    // A spiral ramp of one and a quarter turns is nearly flat: laid flat, its end lies on its beginning.
    let ramp = grid(90, 8, false, Triangulation::Alternating, |s, t| {
        let (angle, r) = (s * 2.5 * std::f64::consts::PI, 30.0 + 20.0 * t);
        DVec3::new(r * angle.cos(), r * angle.sin(), 4.0 * angle)
    });
    let mut design = wanting(&[]);
    design["facing"] = "outward".into();
    let bench = Bench::new();
    let _ = bench.flatten(&ramp, &design, &["--quiet", "--units", "mm"]).succeeded();
    let (worn, report) = (bench.worn(), bench.report());
    assert!(worn.overlaps() > 0 && worn.flipped() == 0);
    assert_eq!(report["pattern"]["overlaps"].as_u64().unwrap() as usize, worn.overlaps());
    let warnings = report["warnings"].as_array().unwrap();
    let said = warnings.iter().find(|w| w["code"] == "overlaps").expect("it is said");
    let text = said["message"].as_str().unwrap();
    assert!(text.contains("dart") && text.matches(" mm").count() >= 2, "{text}");
    let at: Vec<f64> = said["at"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let nearest = ramp
        .points
        .iter()
        .map(|p| p.distance(DVec3::new(at[0], at[1], at[2])))
        .fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-6, "{text}");
}
