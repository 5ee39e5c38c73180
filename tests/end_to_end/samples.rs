//! The sample limbs: each comes with a design that can be reached, and the noise of a scanner does
//! not change what is reached.

use std::path::{Path, PathBuf};

use serde_json::Value;
use support::cli::{Bench, Run, run};

/// Writes a sample into the folder; its surface and its design.
pub fn sample(bench: &Bench, name: &str, options: &[&str]) -> (PathBuf, Value) {
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

/// Noise of 0.3 mm against the clean limb, with the program's own settings.
///
/// Pressures are held to a tenth: at the asked points, their mean and their 95th percentile. Two
/// figures are not, for reasons:
///
/// - The largest is one vertex's, on the sharpest crest. Noise makes the program read curvature over
///   a wider radius, which flattens crests, and it says so: what the noise itself does shows
///   against the clean limb read over that radius. A single vertex is held to 15 %, and to a third
///   where it lies in cloth strained beyond its limit, as at the ankle's instep: the report warns
///   of it, and a figure from beyond the linear range has no digits to keep.
/// - The strain at a point shows whether its curvature was misread, which the pressure does not:
///   the fit asks for what gives the pressure with the curvature that it read. It is held to a
///   tenth, or to three times the uncertainty of curvature that the report states, whichever is
///   more: the knee's first point is off by a sixth, at some 2.5 times.
fn noise_of_a_scanner_stays_within_a_tenth(limb: &str) {
    let flattened = |noise: &str, radius: Option<f64>| {
        let bench = Bench::new();
        let (surface, design) = sample(&bench, limb, &["--noise", noise]);
        // Wider threads keep this short; noise is that of 20,000 triangles.
        let mut options = vec!["--quiet".to_owned(), "--spacing=8".to_owned()];
        options.extend(radius.map(|radius| format!("--curvature-radius={radius}")));
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        let _ = bench.flatten_file(&surface, &design, &options, &[]).succeeded();
        let worn = bench.worn();
        assert_eq!((worn.flipped(), worn.overlaps(), worn.wound_twice()), (0, 0, 0), "{limb}");
        bench.report()
    };
    let (clean, noisy) = (flattened("0", None), flattened("0.3", None));
    let change = |a: &Value, b: &Value| number(b) / number(a) - 1.0;

    let warnings = noisy["warnings"].as_array().unwrap();
    let warning = warnings.iter().find(|w| w["code"] == "noisy_scan").expect("noise is said");
    let words = warning["message"].as_str().unwrap();
    let (_, rest) = words.split_once("known to about ").expect("the uncertainty is said");
    let per_m: f64 = rest.split(' ').next().unwrap().parse().unwrap();
    let [before, after] = [&clean, &noisy].map(|report| report["pressures"].as_array().unwrap());
    assert_eq!((before.len(), after.len()), (4, 4));
    for (k, (a, b)) in before.iter().zip(after).enumerate() {
        let point = format!("{limb}, point {}", k + 1);
        let pressure = change(&a["got_kpa"], &b["got_kpa"]);
        assert!(pressure.abs() < 0.1, "{point}: pressure {pressure:+.3}");
        let strain = change(&a["warp_strain"], &b["warp_strain"]);
        let bound = (3.0 * per_m / number(&a["warp_curvature_per_m"])).max(0.1);
        assert!(strain.abs() < bound, "{point}: strain {strain:+.3}, bound {bound:.3}");
    }
    for key in ["mean_kpa", "p95_kpa"] {
        let field = change(&clean["field"][key], &noisy["field"][key]);
        assert!(field.abs() < 0.1, "{limb}: {key} {field:+.3}");
    }
    let radius = number(&noisy["curvature_radius_mm"]);
    assert!(radius > number(&clean["curvature_radius_mm"]));
    let alike = flattened("0", Some(radius));
    let most = change(&alike["field"]["max_kpa"], &noisy["field"]["max_kpa"]);
    let torn = number(&alike["field"]["max_strain"]) > number(&alike["fabric"]["max_strain"]);
    let bound = if torn { 0.33 } else { 0.15 };
    assert!(most.abs() < bound, "{limb}: the largest pressure {most:+.3}");
}

#[test]
fn the_noisy_elbow_keeps_its_pressures() {
    noise_of_a_scanner_stays_within_a_tenth("elbow");
}

#[test]
fn the_noisy_knee_keeps_its_pressures() {
    noise_of_a_scanner_stays_within_a_tenth("knee");
}

#[test]
fn the_noisy_wrist_keeps_its_pressures() {
    noise_of_a_scanner_stays_within_a_tenth("wrist");
}

#[test]
fn the_noisy_ankle_keeps_its_pressures() {
    noise_of_a_scanner_stays_within_a_tenth("ankle");
}

#[test]
fn the_noisy_forearm_keeps_its_pressures() {
    noise_of_a_scanner_stays_within_a_tenth("forearm");
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
