//! Designs that cannot be meant, each refused with the key, the value and the remedy.

use serde_json::{Value, json};
use support::broken::sound;
use support::cli::Bench;
use support::design::wanting;
use support::write;

use super::assert_nothing_written;

/// Flattens the sound tube with a design text that must be refused with these words.
#[track_caller]
fn refused_text(text: &str, words: &[&str]) {
    let bench = Bench::new();
    let surface = bench.write("limb.obj", write::obj(&sound()));
    let design = bench.write("broken.json", text);
    let out = bench.path("out");
    let run = support::cli::run([
        "flatten".as_ref(),
        surface.as_os_str(),
        "--design".as_ref(),
        design.as_os_str(),
        "--out".as_ref(),
        out.as_os_str(),
    ]);
    run.refused(1, words);
    assert_nothing_written(&bench, &run);
}

#[track_caller]
fn refused(change: impl Fn(&mut Value), words: &[&str]) {
    let mut design = wanting(&[(glam::DVec3::new(40.0, 0.0, 45.0), 2.0)]);
    change(&mut design);
    refused_text(&design.to_string(), words);
}

#[test]
fn an_unknown_key_names_the_nearest() {
    refused(|d| d["presures"] = json!([]), &["presures", "`pressures`"]);
    refused(|d| d["fabric"]["wrap"] = json!(0.5), &["wrap", "`warp`"]);
    refused(|d| d["pressures"][0]["kPa"] = json!(2.0), &["kPa", "`kpa`"]);
    refused(|d| d["limits"] = json!({"max_kPa": 3.0}), &["max_kPa", "`max_kpa`"]);
}

#[test]
fn mmhg_typed_as_kpa_are_refused() {
    refused(|d| d["pressures"][0]["kpa"] = json!(20.0), &["pressures[0]", "20", "mmhg"]);
}

#[test]
fn the_highest_pressure_is_a_limit_and_can_be_raised() {
    let at = json!([40.0, 0.0, 45.0]);
    let wish = |kpa: f64| json!([{"at": at, "kpa": kpa}]);
    refused(|d| d["pressures"] = wish(13.4), &["13.3"]);
    refused(|d| d["pressures"] = json!([{"at": at, "mmhg": 101.0}]), &["100", "mmhg"]);
    let raised = |max: f64| {
        move |d: &mut Value| {
            d["limits"] = json!({"max_kpa": max});
            // Stiff enough that the strain of 14 kPa at 40 mm is 0.28.
            d["fabric"] = json!({"warp": 2.0, "weft": 2.0, "diagonal": 0.2});
        }
    };
    refused(
        |d| {
            raised(13.9)(d);
            d["pressures"] = wish(14.0);
        },
        &["13.9"],
    );
    let mut design = wanting(&[]);
    raised(14.5)(&mut design);
    design["pressures"] = wish(14.0);
    let bench = Bench::new();
    let args = ["--quiet", "--spacing", "12"];
    let _ = bench.flatten(&sound(), &design, &args).succeeded();
}

#[test]
fn a_pressure_must_have_one_value_and_a_place() {
    let at = json!([40.0, 0.0, 45.0]);
    refused(
        |d| d["pressures"] = json!([{"at": at, "kpa": 2.0, "mmhg": 15.0}]),
        &["pressures[0]", "kpa", "mmhg"],
    );
    refused(|d| d["pressures"] = json!([{"at": at}]), &["pressures[0]", "kpa"]);
    refused(|d| d["pressures"] = json!([{"kpa": 2.0}]), &["pressures[0]", "at"]);
    refused(|d| d["pressures"] = json!([{"at": at, "kpa": -1.0}]), &["pressures[0]", "-1"]);
    refused(|d| d["pressures"] = json!([{"at": [1.0, 2.0], "kpa": 2.0}]), &["pressures[0].at"]);
}

#[test]
fn a_point_far_from_the_surface_is_refused_and_a_near_one_taken() {
    // The tube's radius is 40 mm.
    let wish = |x: f64| json!([{"at": [x, 0.0, 45.0], "kpa": 2.0}]);
    refused(|d| d["pressures"] = wish(51.0), &["10 mm"]);
    let mut design = wanting(&[]);
    design["pressures"] = wish(49.0);
    let bench = Bench::new();
    let args = ["--quiet", "--spacing", "12"];
    let _ = bench.flatten(&sound(), &design, &args).succeeded();
}

#[test]
fn a_fabric_must_be_possible() {
    for key in ["warp", "weft", "diagonal", "max_strain"] {
        refused(|d| d["fabric"][key] = json!(0.0), &[key]);
        refused(|d| d["fabric"][key] = json!(-0.5), &[key]);
        refused(|d| d["fabric"][key] = json!("soft"), &[key]);
    }
}

#[test]
fn other_values_that_cannot_be_meant() {
    refused(|d| d["units"] = json!("ft"), &["units", "ft"]);
    refused(|d| d["pressure_model"] = json!("laplac"), &["pressure_model", "laplace"]);
    refused(|d| d["orientation"] = json!([[40.0, 0.0, 80.0]]), &["orientation"]);
    refused(|d| d["orientation"] = json!([[40.0, 0.0, 8.0], [40.0, 0.0, 8.0]]), &["orientation"]);
    refused(|d| d["seams"] = json!([[[40.0, 0.0, 8.0]]]), &["seams[0]"]);
    let plane = json!([{"point": [0.0, 0.0, 10.0], "normal": [0.0, 0.0, 0.0]}]);
    refused(|d| d["region"] = plane.clone(), &["region[0].normal"]);
    let nothing = json!([{"point": [0.0, 0.0, 500.0], "normal": [0.0, 0.0, 1.0]}]);
    refused(|d| d["region"] = nothing.clone(), &["region"]);
}

#[test]
fn a_file_that_is_no_design() {
    refused_text("", &["empty"]);
    refused_text("{\"pressures\": [", &["line 1"]);
    refused_text("[]", &[]);
    refused_text("{}", &["pressures"]);
    refused_text("{\"pressures\": [], \"pressures\": []}", &["pressures"]);
}
