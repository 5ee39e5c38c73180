//! The command line: its commands, exit codes and what it prints where.

use std::path::Path;

use serde_json::Value;
use support::cli::{Bench, run};
use support::fixtures::tube;
use support::mesh::Triangulation;
use support::write;

use super::{FAST, limb};

#[test]
fn help_and_version_end_well() {
    let help = run(["--help"]).succeeded().stdout;
    for command in ["demo", "sample", "check", "flatten", "schema"] {
        assert!(help.contains(command), "{help}");
    }
    let version = run(["--version"]).succeeded().stdout;
    assert!(version.starts_with("wovenfit "), "{version}");
    let flatten = run(["flatten", "--help"]).succeeded().stdout;
    for flag in ["--design", "--out", "--method", "--units", "--spacing", "--max-iterations"] {
        assert!(flatten.contains(flag), "{flag} in {flatten}");
    }
}

#[test]
fn wrong_usage_ends_with_two() {
    let wrong: [&[&str]; 8] = [
        &[],
        &["flaten"],
        &["flatten"],
        &["flatten", "limb.obj", "--out", "x"],
        &["flatten", "limb.obj", "--design", "d.json", "--out", "x", "--units", "ft"],
        &["flatten", "limb.obj", "--design", "d.json", "--out", "x", "--spacing", "0"],
        &["flatten", "limb.obj", "--design", "d.json", "--out", "x", "--speed", "9"],
        &["sample", "elbow"],
    ];
    for args in wrong {
        let run = run(args);
        assert_eq!(run.code, Some(2), "{args:?}: {}", run.stderr);
        assert!(!run.stderr.is_empty() && !run.stderr.contains("panicked"), "{}", run.stderr);
        assert!(run.stdout.is_empty(), "{}", run.stdout);
    }
}

#[test]
fn the_schema_is_one_and_knows_every_key_of_the_contract() {
    let schema = run(["schema"]).succeeded().json();
    assert!(schema["$schema"].as_str().unwrap().contains("json-schema.org"));
    assert_eq!(schema["type"], "object");
    assert_eq!(schema["additionalProperties"], Value::Bool(false));
    assert_eq!(schema["required"], serde_json::json!(["pressures"]));
    let keys = [
        "units",
        "fabric",
        "pressure_model",
        "pressures",
        "orientation",
        "seams",
        "region",
        "limits",
        "piece",
    ];
    for key in keys {
        let described = schema["properties"][key]["description"].as_str();
        assert!(described.is_some_and(|text| text.len() > 10), "{key}");
    }
}

#[test]
fn a_sample_comes_with_its_design_and_both_are_taken() {
    let bench = Bench::new();
    let out = bench.path("limb.obj");
    let args = ["sample", "elbow", "--triangles", "2000", "--noise", "0.2", "--out"];
    let args: Vec<&Path> = args.iter().map(Path::new).chain([out.as_path()]).collect();
    let _ = run(args.clone()).succeeded();
    let first = std::fs::read(&out).unwrap();
    let triangles = String::from_utf8(first.clone()).unwrap().matches("\nf ").count();
    assert!((1_800..=2_200).contains(&triangles), "{triangles}");
    let design: Value =
        serde_json::from_slice(&std::fs::read(bench.path("limb.design.json")).unwrap()).unwrap();
    assert!(design["pressures"].as_array().is_some_and(|p| !p.is_empty()));
    let _ = run(args).succeeded();
    assert_eq!(std::fs::read(&out).unwrap(), first, "the same noise every time");
    let flatten =
        bench.flatten_file(&out, &design, &["--quiet", "--spacing", "12"], &[]).succeeded();
    assert_eq!(bench.results().len(), 5, "{flatten:?}");
}

#[test]
fn an_unknown_sample_names_the_nearest() {
    let bench = Bench::new();
    let out = bench.path("limb.obj");
    let args = ["sample", "elbo", "--triangles", "2000", "--out"].map(Path::new);
    let run = run(args.into_iter().chain([out.as_path()]));
    assert!(matches!(run.code, Some(1 | 2)), "{run:?}");
    assert!(run.stderr.contains("elbow"), "{}", run.stderr);
    assert!(!out.exists());
}

/// Whether a number within this fraction of `wanted` is anywhere in a value.
fn holds(value: &Value, wanted: f64, within: f64) -> bool {
    match value {
        Value::Number(x) => x.as_f64().is_some_and(|x| (x / wanted - 1.0).abs() < within),
        Value::Array(items) => items.iter().any(|v| holds(v, wanted, within)),
        Value::Object(map) => map.values().any(|v| holds(v, wanted, within)),
        _ => false,
    }
}

#[test]
fn check_measures_a_tube() {
    let bench = Bench::new();
    let tube = tube(43.0, 130.0, 48, Triangulation::Alternating);
    let file = bench.write("limb.obj", write::obj(&tube.mesh));
    let args = [Path::new("check"), file.as_path(), Path::new("--json")];
    let json = run(args).succeeded().json();
    for figure in [
        tube.polygon_girth(),
        tube.length,
        tube.mesh.points.len() as f64,
        tube.mesh.triangles.len() as f64,
        tube.mesh.area(),
    ] {
        assert!(holds(&json, figure, 0.005), "{figure} is not in {json}");
    }
    assert_eq!(json["loops"].as_array().map(Vec::len), Some(2));
    assert_eq!(json["defects"].as_array().map(Vec::len), Some(0));
    let text = run([Path::new("check"), file.as_path()]).succeeded().stdout;
    assert!(text.contains("girth"), "{text}");
    // 269.99 mm round.
    assert!(text.contains("269") || text.contains("270"), "{text}");
}

#[test]
fn json_goes_to_standard_output_and_quiet_is_quiet() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let args = ["--spacing", "12", "--max-iterations", "300"];
    let loud = bench.flatten(&mesh, &design, &args).succeeded();
    assert!(loud.stdout.contains("mmHg") && loud.stdout.contains("kPa"), "{}", loud.stdout);
    let json = bench.flatten(&mesh, &design, &[&args[..], &["--json"]].concat()).succeeded();
    let said = json.json();
    assert_eq!(Path::new(said["out"].as_str().unwrap()).file_name().unwrap(), "out");
    for key in ["read", "fit", "total"] {
        assert!(said["seconds"][key].as_f64().is_some_and(|s| s >= 0.0), "{said}");
    }
    let stages = said["stages"].as_object().unwrap();
    for stage in ["surface", "cut", "fit", "report"] {
        assert!(stages[stage].as_f64().is_some_and(|s| s >= 0.0), "{said}");
    }
    let whole: f64 = stages.values().filter_map(Value::as_f64).sum();
    assert!(whole <= said["seconds"]["fit"].as_f64().unwrap(), "{said}");
    assert_eq!(said["peak_mib"].as_f64().is_some_and(|m| m > 1.0), cfg!(target_os = "linux"));
    let quiet = bench.flatten(&mesh, &design, &[&args[..], &["--quiet"]].concat()).succeeded();
    assert_eq!(quiet.stdout, "");
    // No bar, no times; what the designer must know is said all the same.
    assert!(quiet.stderr.lines().all(|line| line.starts_with("warning: ")), "{}", quiet.stderr);
}

#[test]
fn the_maximum_of_iterations_is_said_everywhere() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    for (args, remedy) in [
        (&["--newton-steps", "2"][..], "newton-steps"),
        (&["--method", "diffusion", "--spacing", "9", "--max-iterations", "10"], "max-iterations"),
    ] {
        let run = bench.flatten(&mesh, &design, args).succeeded();
        assert!(run.stdout.to_lowercase().contains("not converged"), "{}", run.stdout);
        let report = bench.report();
        assert_eq!(report["fit"]["converged"], false);
        assert!(report["fit"]["iterations"].as_u64().unwrap() <= 10);
        let warnings = report["warnings"].to_string();
        assert!(warnings.contains("not converged") && warnings.contains(remedy), "{warnings}");
    }
    let _ = bench.flatten(&mesh, &design, &["--spacing", "9"]).succeeded();
    let report = bench.report();
    assert_eq!(report["fit"]["converged"], true);
    assert!(!report["warnings"].to_string().to_lowercase().contains("not converged"));
}

#[test]
fn a_failed_run_leaves_earlier_results_whole() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let args = [&FAST[..], &["--max-iterations", "100"]].concat();
    let _ = bench.flatten(&mesh, &design, &args).succeeded();
    let names = bench.results();
    let before: Vec<Vec<u8>> = names.iter().map(|name| bench.out(name)).collect();
    let mut too_high = design.clone();
    too_high["pressures"][0]["kpa"] = 50.0.into();
    bench.flatten(&mesh, &too_high, &args).refused(1, &["50"]);
    assert_eq!(bench.results(), names);
    let after: Vec<Vec<u8>> = names.iter().map(|name| bench.out(name)).collect();
    assert!(before == after);
}

#[test]
fn a_folder_that_cannot_be_written_is_an_error() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    // A file stands where the folder should be.
    bench.write("out", b"");
    let args = [&FAST[..], &["--max-iterations", "100"]].concat();
    bench.flatten(&mesh, &design, &args).refused(1, &["out"]);
    assert_eq!(std::fs::read(bench.path("out")).unwrap(), b"");
}
