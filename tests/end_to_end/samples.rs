//! The sample limbs: each comes with a design that can be reached, and the noise of a scanner does
//! not change what is reached.

use std::path::{Path, PathBuf};

use serde_json::Value;
use support::cli::{Bench, Run, run};

/// Writes a sample into the folder; its surface and its design.
fn sample(bench: &Bench, name: &str, options: &[&str]) -> (PathBuf, Value) {
    let surface = bench.path("limb.obj");
    let _ = try_sample(&surface, name, options).succeeded();
    let design = std::fs::read(bench.path("limb.design.json")).unwrap();
    (surface, serde_json::from_slice(&design).unwrap())
}

fn try_sample(out: &Path, name: &str, options: &[&str]) -> Run {
    let args = ["sample", name, "--out"].map(Path::new);
    run(args.into_iter().chain([out]).chain(options.iter().map(Path::new)))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

/// Makes the sample's own brace: it rests, lies flat in one piece and gives what it asks for.
fn reaches_its_design(name: &str, triangles: &str, options: &[&str]) {
    let bench = Bench::new();
    let (surface, design) = sample(&bench, name, &["--triangles", triangles]);
    assert!(design.get("pressure_model").is_none_or(|model| model == "laplace"));
    let options = [&["--quiet"], options].concat();
    let _ = bench.flatten_file(&surface, &design, &options, &[]).succeeded();
    let (worn, report) = (bench.worn(), bench.report());
    assert_eq!((worn.flipped(), worn.overlaps(), worn.wound_twice()), (0, 0, 0), "{name}");
    assert_eq!(report["fit"]["converged"], true, "{name}: {}", report["fit"]);
    let pressures = report["pressures"].as_array().unwrap();
    assert_eq!(pressures.len(), 4);
    for pressure in pressures {
        let [asked, got] = ["asked_kpa", "got_kpa"].map(|key| number(&pressure[key]));
        assert!((got / asked - 1.0).abs() <= 0.05, "{name}: {got} instead of {asked} kPa");
        assert_eq!(pressure["reason"], Value::Null, "{name}: {pressure}");
    }
}

#[test]
fn the_elbow_reaches_its_design() {
    reaches_its_design("elbow", "5000", &[]);
}

#[test]
fn the_knee_reaches_its_design() {
    // The largest limb: wider threads keep this short.
    reaches_its_design("knee", "5000", &["--spacing", "7"]);
}

#[test]
fn the_wrist_reaches_its_design() {
    reaches_its_design("wrist", "5000", &[]);
}

#[test]
fn the_ankle_reaches_its_design() {
    reaches_its_design("ankle", "5000", &[]);
}

#[test]
fn the_forearm_reaches_its_design() {
    reaches_its_design("forearm", "5000", &[]);
}

#[test]
fn a_scanners_noise_changes_pressures_and_strains_by_less_than_a_tenth() {
    // Noise of a good scanner, curvature over a radius that is wide enough for it: white noise of
    // σ mm on edges of 2.6 mm is an error of some 14 σ per metre over 10 mm, 2 σ over 20 mm.
    let options = ["--quiet", "--curvature-radius", "20"];
    let [clean, noisy] = [&[][..], &["--noise", "0.1"]].map(|noise| {
        let bench = Bench::new();
        let (surface, design) = sample(&bench, "elbow", noise);
        let _ = bench.flatten_file(&surface, &design, &options, &[]).succeeded();
        bench.report()
    });
    assert_eq!(noisy["fit"]["converged"], true);
    let [clean, noisy] = [&clean, &noisy].map(|report| report["pressures"].as_array().unwrap());
    assert_eq!((clean.len(), noisy.len()), (4, 4));
    for (a, b) in clean.iter().zip(noisy) {
        // The pressure alone would not show a curvature misread: the fit asks for the strain that
        // gives the pressure with the curvature it read. The limb has its own, so strains must
        // stay as well.
        for key in ["got_kpa", "warp_strain", "warp_curvature_per_m"] {
            let [before, after] = [a, b].map(|pressure| number(&pressure[key]));
            assert!((after / before - 1.0).abs() < 0.1, "{key}: {before} became {after}");
        }
    }
}

#[test]
fn the_thumb_has_an_opening_if_asked_for() {
    for (options, loops) in [(&[][..], 2), (&["--opening"], 3)] {
        let bench = Bench::new();
        let (surface, _) = sample(&bench, "wrist", &[&["--triangles", "5000"], options].concat());
        let args = [Path::new("check"), surface.as_path(), Path::new("--json")];
        let json = run(args).succeeded().json();
        assert_eq!(json["loops"].as_array().map(Vec::len), Some(loops));
        assert_eq!(json["defects"].as_array().map(Vec::len), Some(0));
    }
}

#[test]
fn the_papers_examples_name_its_formula_and_fabrics() {
    let bench = Bench::new();
    let read = |name: &str, options: &[&str]| -> ([f64; 3], Vec<f64>) {
        let options = [&["--triangles", "500", "--config"], options].concat();
        let (_, design) = sample(&bench, name, &options);
        assert_eq!(design["pressure_model"], "paper");
        let fabric = ["warp", "weft", "diagonal"].map(|key| number(&design["fabric"][key]));
        let pressures = design["pressures"].as_array().unwrap();
        (fabric, pressures.iter().map(|pressure| number(&pressure["kpa"])).collect())
    };
    for (options, fabric) in [
        (&[][..], [0.5, 0.5, 0.05]),
        (&["--fabric", "isotropic"], [0.5, 0.5, 0.05]),
        (&["--fabric", "anisotropic"], [0.5, 5.0, 0.05]),
    ] {
        let with = |config| read("elbow", &[&[config], options].concat());
        let (a, b, c, d) = (with("a"), with("b"), with("c"), with("d"));
        assert!([&a, &b, &c, &d].iter().all(|example| example.0 == fabric));
        assert!(a.1.is_empty());
        assert!(matches!(b.1[..], [e1, m, e2] if m > 20.0 * e1 && m > 20.0 * e2), "{b:?}");
        assert!(matches!(c.1[..], [high, low] if high > 20.0 * low), "{c:?}");
        assert!(matches!(d.1[..], [e1, m, e2] if e1 > 20.0 * m && e2 > 20.0 * m), "{d:?}");
    }
    let (fabric, mut knee) = read("knee", &["paper"]);
    knee.sort_by(f64::total_cmp);
    assert_eq!((fabric, knee), ([0.5, 5.0, 0.05], vec![0.06, 0.26, 2.29, 3.18]));
    assert_eq!(read("wrist", &["paper"]).0, [0.75, 0.5, 0.05]);
}

#[test]
fn what_a_sample_does_not_have_is_a_usage_error_with_the_nearest_name() {
    let bench = Bench::new();
    let out = bench.path("limb.obj");
    for (name, options, words) in [
        ("kneee", &[][..], &["kneee", "'knee'"][..]),
        ("elbow", &["--config", "paper"], &["`paper`", "nearest name is `a`", "a, b, c, d"]),
        ("knee", &["--config", "papr"], &["`papr`", "nearest name is `paper`"]),
        ("forearm", &["--config", "a"], &["`forearm` has no configuration", "elbow, knee, wrist"]),
        ("elbow", &["--config", "b", "--fabric", "isotropc"], &["nearest name is `isotropic`"]),
        ("elbow", &["--fabric", "isotropic"], &["--config"]),
        ("ankle", &["--opening"], &["`ankle` has no opening", "wrist"]),
    ] {
        try_sample(&out, name, options).refused(2, words);
        assert!(!out.exists());
    }
}

#[test]
fn the_demo_takes_every_limb() {
    let bench = Bench::new();
    let out = bench.path("out");
    let args = ["demo", "forearm", "--quiet", "--out"].map(Path::new);
    let _ = run(args.into_iter().chain([out.as_path()])).succeeded();
    for file in ["forearm.obj", "forearm.design.json", "worn.obj", "pattern.svg", "report.json"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    let help = run(["demo", "--help"]).succeeded().stdout;
    for limb in ["elbow", "knee", "wrist", "ankle", "forearm"] {
        assert!(help.contains(limb), "{help}");
    }
    let args = ["demo", "toe", "--out"].map(Path::new);
    run(args.into_iter().chain([bench.path("toe").as_path()])).refused(2, &["toe", "elbow"]);
}
