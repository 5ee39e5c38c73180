//! Every broken input is refused with what is wrong, where, and nothing written; what can be
//! repaired is, and said.

mod design;
mod file;
mod surface;

use std::path::Path;

use glam::DVec3;
use support::cli::{Bench, Run, run};
use support::design::wanting;

/// Runs `check` and `flatten` on a file; both must refuse it with these words. The message of
/// `flatten`.
#[track_caller]
fn refused(bench: &Bench, file: &Path, words: &[&str]) -> String {
    let check = run([Path::new("check"), file]);
    assert_eq!(check.code, Some(1), "check: {}{}", check.stdout, check.stderr);
    let said = (check.stdout + &check.stderr).to_lowercase();
    for word in words {
        assert!(said.contains(&word.to_lowercase()), "check: `{word}` is not in:\n{said}");
    }
    let flatten = bench.flatten_file(file, &wanting(&[]), &[], &[]);
    let message = flatten.refused(1, words).to_owned();
    assert_nothing_written(bench, &flatten);
    message
}

#[track_caller]
fn assert_nothing_written(bench: &Bench, run: &Run) {
    assert!(bench.results().is_empty(), "{:?} after:\n{}", bench.results(), run.stderr);
    assert!(!run.stdout.contains("worn.obj"), "{}", run.stdout);
}

/// The places "(x, y, z)" that a message names.
fn places(message: &str) -> Vec<DVec3> {
    message
        .split('(')
        .skip(1)
        .filter_map(|rest| rest.split_once(')'))
        .filter_map(|(inside, _)| {
            let numbers: Vec<f64> =
                inside.split(',').map_while(|x| x.trim().parse().ok()).collect();
            (numbers.len() == 3).then(|| DVec3::from_slice(&numbers))
        })
        .collect()
}

/// Demands that a message names a place within a triangle's size of `place`.
#[track_caller]
fn assert_names_place(message: &str, place: DVec3) {
    let near = places(message).iter().any(|p| p.distance(place) < 12.0);
    assert!(near, "no place near {place} in:\n{message}");
}
