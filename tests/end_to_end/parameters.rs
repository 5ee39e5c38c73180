//! Each parameter and each wish changes the result: none is read and then forgotten.

use std::collections::BTreeMap;

use serde_json::{Value, json};
use support::cli::Bench;
use support::mesh::Mesh;
use support::motion::design_in_unit;
use wovenfit_core::parameters::PARAMETERS;

use super::limb;

const SHORT: [&str; 5] = ["--quiet", "--spacing", "10", "--max-iterations", "400"];

/// Results without the report's list of the parameters themselves.
fn results(mesh: &Mesh, design: &Value, args: &[&str]) -> String {
    let bench = Bench::new();
    let _ = bench.flatten(mesh, design, args).succeeded();
    let mut report = bench.report();
    if let Some(report) = report.as_object_mut() {
        for echoed in ["parameters", "fabric", "piece", "pressure_model", "wovenfit"] {
            report.remove(echoed);
        }
        report.remove("curvature_radius_mm");
    }
    String::from_utf8(bench.out("worn.obj")).unwrap() + &report.to_string()
}

/// A run and the options that it gets instead of [`SHORT`]'s or besides.
struct Change {
    mesh: Mesh,
    design: Value,
    base: Vec<&'static str>,
    changed: Vec<&'static str>,
}

/// For each parameter a case in which its change must show.
fn changes() -> BTreeMap<&'static str, Change> {
    let (mesh, design) = limb();
    let plain = |changed: &[&'static str]| Change {
        mesh: mesh.clone(),
        design: design.clone(),
        base: SHORT.to_vec(),
        changed: [&SHORT[..], changed].concat(),
    };
    let replaced = |base: &[&'static str], changed: &[&'static str]| Change {
        base: base.to_vec(),
        changed: changed.to_vec(),
        ..plain(&[])
    };
    const DIFFUSION: [&str; 6] =
        ["--quiet", "--method=diffusion", "--spacing", "10", "--max-iterations", "400"];
    let diffused = |changed: &[&'static str]| Change {
        base: DIFFUSION.to_vec(),
        changed: [&DIFFUSION[..], changed].concat(),
        ..plain(&[])
    };
    let long = ["--quiet", "--method=diffusion", "--spacing", "12"];
    let mut cases = BTreeMap::new();
    // The same numbers read as centimetres are another limb.
    let mut unitless = design_in_unit(&design, "cm", 0.1);
    unitless.as_object_mut().unwrap().remove("units");
    cases.insert(
        "units",
        Change {
            mesh: mesh.scaled(0.1),
            design: unitless,
            base: [&SHORT[..], &["--units", "cm"]].concat(),
            changed: [&SHORT[..], &["--units", "in"]].concat(),
        },
    );
    let crumbs = support::broken::two_components();
    cases.insert("keep_largest", Change { mesh: crumbs, ..plain(&["--keep-largest"]) });
    let holed = support::broken::small_hole();
    cases.insert(
        "close_holes",
        Change {
            mesh: holed,
            design: support::design::wanting(&[]),
            base: [&SHORT[..], &["--close-holes", "0"]].concat(),
            changed: [&SHORT[..], &["--close-holes", "120"]].concat(),
        },
    );
    let noisy = wovenfit_core::samples::sample("elbow", 6000, 0.3).unwrap();
    let triangles = noisy.mesh.polygons.iter().map(|p| [p[0], p[1], p[2]]).collect();
    cases.insert(
        "denoise",
        Change {
            mesh: Mesh { points: noisy.mesh.points, triangles },
            design: support::design::wanting(&[]),
            ..plain(&["--denoise", "off"])
        },
    );
    cases.insert("curvature", plain(&["--curvature", "meyer"]));
    cases.insert("curvature_radius", plain(&["--curvature-radius", "20"]));
    cases.insert("spacing", replaced(&long, &["--quiet", "--method=diffusion", "--spacing", "14"]));
    cases.insert("start_warp", diffused(&["--start-warp", "0.9"]));
    cases.insert("start_weft", diffused(&["--start-weft", "0.9"]));
    cases.insert("damping", diffused(&["--damping", "0.05"]));
    cases.insert("steps_per_pass", diffused(&["--steps-per-pass", "13"]));
    cases.insert("coarse_levels", diffused(&["--coarse-levels", "0"]));
    cases.insert(
        "strain_tolerance",
        replaced(&long, &[&long[..], &["--strain-tolerance", "0.1"]].concat()),
    );
    cases.insert("plateau", replaced(&long, &[&long[..], &["--plateau", "0.9"]].concat()));
    cases.insert(
        "max_iterations",
        replaced(
            &DIFFUSION,
            &["--quiet", "--method=diffusion", "--spacing", "10", "--max-iterations", "100"],
        ),
    );
    // Two different wishes 8 mm apart.
    let mut close = design.clone();
    let wish =
        |z: f64, kpa: f64| json!({"at": [42.0 * 0.6f64.cos(), 42.0 * 0.6f64.sin(), z], "kpa": kpa});
    close["pressures"] = json!([wish(50.0, 1.2), wish(58.0, 2.4)]);
    cases.insert(
        "row_spacing",
        Change {
            design: close.clone(),
            base: [&SHORT[..], &["--row-spacing", "0"]].concat(),
            changed: [&SHORT[..], &["--row-spacing", "30"]].concat(),
            ..plain(&[])
        },
    );
    // What is missed by smoothing counts as missed or not.
    cases.insert(
        "miss_tolerance",
        Change {
            design: close,
            base: [&SHORT[..], &["--row-spacing", "30", "--miss-tolerance", "0.001"]].concat(),
            changed: [&SHORT[..], &["--row-spacing", "30", "--miss-tolerance", "0.5"]].concat(),
            ..plain(&[])
        },
    );
    cases.insert("method", plain(&["--method=diffusion"]));
    cases.insert("newton_tolerance", plain(&["--newton-tolerance", "0.0000001"]));
    cases.insert("newton_steps", plain(&["--newton-steps", "2"]));
    cases.insert("equal_seams", plain(&["--equal-seams=false"]));
    cases.insert("correct_pressures", plain(&["--correct-pressures=false"]));
    cases.insert("girth_step", plain(&["--girth-step", "7"]));
    cases
}

/// Parameters with a single value cannot change anything.
fn has_a_choice(name: &str) -> bool {
    let parameter = PARAMETERS.iter().find(|p| p.name == name).unwrap();
    !matches!(&parameter.kind, wovenfit_core::parameters::Kind::Choice(names) if names.len() < 2)
}

#[test]
fn every_parameter_of_the_table_changes_the_result() {
    let cases = changes();
    for parameter in PARAMETERS.iter().filter(|p| has_a_choice(p.name)) {
        let case = cases
            .get(parameter.name)
            .unwrap_or_else(|| panic!("no case changes the parameter `{}`", parameter.name));
        if parameter.name == "keep_largest" {
            // Without it the run is refused.
            let bench = Bench::new();
            bench.flatten(&case.mesh, &support::design::wanting(&[]), &case.base).refused(1, &[]);
            let _ = results(&case.mesh, &support::design::wanting(&[]), &case.changed);
            continue;
        }
        let before = results(&case.mesh, &case.design, &case.base);
        let after = results(&case.mesh, &case.design, &case.changed);
        assert!(before != after, "`{}` changes nothing", parameter.name);
    }
}

#[test]
fn every_wish_of_the_design_changes_the_result() {
    let (mesh, design) = limb();
    let before = results(&mesh, &design, &SHORT);
    let low = |t: &[usize; 3]| t.iter().all(|&v| mesh.points[v].z < 100.0);
    let faces: Vec<usize> =
        (0..mesh.triangles.len()).filter(|&t| low(&mesh.triangles[t])).collect();
    let wishes: [(&str, Value); 12] = [
        ("/fabric/warp", json!(0.6)),
        ("/fabric/weft", json!(0.6)),
        ("/fabric/diagonal", json!(0.1)),
        ("/fabric/weft_strain", json!(0.05)),
        // Below what the wishes take, 0.13 and 0.17.
        ("/fabric/max_strain", json!(0.1)),
        ("/pressure_model", json!("paper")),
        ("/pressures/0/kpa", json!(1.8)),
        ("/pressures/1/at", json!([42.0 * 0.7f64.cos(), 42.0 * 0.7f64.sin(), 85.0])),
        ("/orientation/1", json!([42.0 * 0.8f64.cos(), 42.0 * 0.8f64.sin(), 5.0])),
        ("/region", json!([{"point": [0, 0, 100], "normal": [0, 0, -1]}])),
        ("/region_faces", json!(faces)),
        // Along the back of the limb.
        ("/seams", json!([[[-44.0, 5.0, 0.0], [-44.0, 0.0, 110.0]]])),
    ];
    for (pointer, value) in wishes {
        let mut changed = design.clone();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        let parent = changed.pointer_mut(parent).unwrap();
        match key.parse::<usize>() {
            Ok(index) => parent[index] = value,
            Err(_) => parent[key] = value,
        }
        assert!(results(&mesh, &changed, &SHORT) != before, "{pointer} changes nothing");
    }
    let mut paper = design.clone();
    paper["pressure_model"] = json!("paper");
    let mut softer = paper.clone();
    softer["fabric"]["s"] = json!(0.8);
    assert!(results(&mesh, &paper, &SHORT) != results(&mesh, &softer, &SHORT), "s");
    let mut limited = design.clone();
    limited["limits"] =
        json!({"max_kpa": 2.0, "bony": [[42.0 * 0.6f64.cos(), 42.0 * 0.6f64.sin(), 55.0]]});
    assert!(results(&mesh, &limited, &SHORT) != before, "limits");
}
