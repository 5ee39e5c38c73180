//! `wovenfit demo`: what the README shows first.

use std::path::{Path, PathBuf};
use std::process::Command;

use support::check::WornObj;
use support::cli::{Bench, program};

#[test]
fn the_demo_reaches_its_pressures_and_says_where_the_files_are() {
    let bench = Bench::new();
    let work = bench.path("");
    let output = Command::new(program()).arg("demo").current_dir(&work).output().unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert!(stdout.contains("mmHg") && stdout.contains("kPa"), "{stdout}");
    // Every word that is a file or folder there.
    let named: Vec<PathBuf> = stdout
        .split_whitespace()
        .map(|word| work.join(word.trim_matches(|c: char| "`'\",:;()".contains(c))))
        .map(|path| if path.is_file() { path.parent().unwrap().into() } else { path })
        .filter(|path: &PathBuf| path.join("worn.obj").is_file())
        .collect();
    let out: &Path = named.first().unwrap_or_else(|| panic!("no folder is named in:\n{stdout}"));
    for name in ["worn.obj", "flat.obj", "pattern.svg", "report.json", "report.html"] {
        assert!(out.join(name).is_file(), "{name} in {}", out.display());
    }
    let last = work.join(stdout.split_whitespace().last().unwrap());
    assert_eq!(last, out.join("report.html"), "the demo ends by naming the page");
    let worn = WornObj::parse(&std::fs::read_to_string(out.join("worn.obj")).unwrap());
    assert_eq!((worn.flipped(), worn.overlaps(), worn.wound_twice()), (0, 0, 0));
    let report: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(out.join("report.json")).unwrap()).unwrap();
    assert_eq!(report["fit"]["converged"], true);
    let pressures = report["pressures"].as_array().unwrap();
    assert!(pressures.len() >= 3);
    for pressure in pressures {
        let [asked, got] = ["asked_kpa", "got_kpa"].map(|key| pressure[key].as_f64().unwrap());
        // The design was made reachable.
        assert!((got / asked - 1.0).abs() < 0.1, "{pressure}");
    }
}
