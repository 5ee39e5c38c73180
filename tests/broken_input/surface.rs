//! Surfaces with a defect, and surfaces that can be repaired.

use std::path::Path;

use glam::DVec3;
use support::broken;
use support::cli::{Bench, Run, run};
use support::design::wanting;
use support::fixtures::{plane, tube};
use support::mesh::{Mesh, Triangulation};
use support::write::{self, PlyEncoding, PlyScalar};

use super::{assert_names_place, assert_nothing_written, refused};

fn refused_mesh(mesh: &Mesh, words: &[&str]) -> String {
    let bench = Bench::new();
    let file = bench.write("limb.obj", write::obj(mesh));
    refused(&bench, &file, words)
}

fn vertex(index: usize) -> String {
    index.to_string()
}

#[test]
fn three_triangles_at_an_edge() {
    let mesh = broken::non_manifold_edge();
    let [b, a, _] = *mesh.triangles.last().unwrap();
    let message = refused_mesh(&mesh, &["edge", &vertex(a), &vertex(b)]);
    assert_names_place(&message, 0.5 * (mesh.points[a] + mesh.points[b]));
}

#[test]
fn two_fans_at_a_vertex() {
    let mesh = broken::non_manifold_vertex();
    let tip = mesh.triangles.last().unwrap()[0];
    let message = refused_mesh(&mesh, &["vertex", &vertex(tip)]);
    assert_names_place(&message, mesh.points[tip]);
}

#[test]
fn a_band_with_one_side() {
    refused_mesh(&broken::moebius(), &["one side"]);
}

#[test]
fn a_triangle_without_area() {
    let mesh = broken::degenerate_triangle();
    let message = refused_mesh(&mesh, &["100", "area"]);
    assert_names_place(&message, mesh.points[mesh.triangles[100][2]]);
}

#[test]
fn a_triangle_twice() {
    let mesh = broken::duplicate_triangle();
    let last = vertex(mesh.triangles.len() - 1);
    let message = refused_mesh(&mesh, &["5", &last, "same corners"]);
    assert_names_place(&message, mesh.points[mesh.triangles[5][0]]);
}

#[test]
fn a_coordinate_that_is_no_number() {
    for (value, words) in [(f64::NAN, "not a number"), (f64::INFINITY, "infinite")] {
        let bench = Bench::new();
        let mesh = broken::bad_coordinate(value);
        let bytes = write::ply(&mesh, PlyEncoding::LittleEndian, PlyScalar::Double);
        let file = bench.write("limb.ply", bytes);
        refused(&bench, &file, &["vertex 10", words]);
    }
}

#[test]
fn an_index_out_of_range() {
    let bench = Bench::new();
    let file = bench.write("limb.obj", broken::index_out_of_range());
    // 99999 in the file, which counts from 1.
    let message = refused(&bench, &file, &[]);
    assert!(message.contains("99998") || message.contains("99999"), "{message}");
}

#[test]
fn a_closed_surface_is_told_what_to_do() {
    let bench = Bench::new();
    let file = bench.write("limb.obj", write::obj(&broken::closed()));
    let flatten = bench.flatten_file(&file, &wanting(&[]), &[], &[]);
    flatten.refused(1, &["closed", "region"]);
    assert_nothing_written(&bench, &flatten);
    // It is sound, and two planes make a tube of it.
    let check = run([Path::new("check"), &file]).succeeded();
    assert!(check.stdout.contains("closed") && check.stdout.contains("region"), "{check:?}");
}

#[test]
fn a_handle_is_named() {
    refused_mesh(&broken::handle(), &["handle"]);
}

#[test]
fn several_pieces_are_listed_and_dropped_on_request() {
    let mesh = broken::two_components();
    let message = refused_mesh(&mesh, &["2 separate pieces", "largest"]);
    assert_names_place(&message, DVec3::new(120.0, 0.0, 12.0));
    let bench = Bench::new();
    let args = ["--keep-largest", "--quiet", "--spacing", "12"];
    let _ = bench.flatten(&mesh, &wanting(&[]), &args).succeeded();
    // Nothing of the crumb beyond the tube is in the result.
    assert!(bench.worn().v.iter().all(|p| p.x < 60.0));
}

#[test]
fn a_flat_piece_does_not_show_its_outside() {
    let bench = Bench::new();
    let mesh = plane(120.0, 80.0, 12, Triangulation::Alternating);
    let flatten = bench.flatten(&mesh, &wanting(&[]), &["--units", "mm"]);
    flatten.refused(1, &["facing", "outward", "inward"]);
    assert_nothing_written(&bench, &flatten);
}

#[test]
fn a_limb_in_metres_is_told_so_unless_the_unit_was_given() {
    let bench = Bench::new();
    for (factor, unit) in [(1e-3, "m"), (1.0 / 25.4, "in")] {
        let tube = tube(45.0, 90.0, 32, Triangulation::Alternating);
        let file = bench.write("limb.obj", write::obj(&tube.mesh.scaled(factor)));
        // 0.28 m and 11 in round: no limb in mm.
        let mut design = wanting(&[]);
        design.as_object_mut().unwrap().remove("units");
        let flatten = bench.flatten_file(&file, &design, &[], &[]);
        let message = flatten.refused(1, &["girth", "units"]);
        let named = message.split(|c: char| !c.is_alphanumeric()).any(|word| {
            word == unit || (unit == "m" && word.starts_with("metre")) || word.starts_with("inch")
        });
        assert!(named, "`{unit}` is not in:\n{message}");
        assert_nothing_written(&bench, &flatten);
        let check = run(["check", file.to_str().unwrap(), "--units", unit]);
        assert_eq!(check.code, Some(0), "{}", check.stderr);
    }
}

/// Flattens a mesh that must be repaired, and demands that it is said.
#[track_caller]
fn repaired(mesh: &Mesh, words: &[&str]) -> (Bench, Run) {
    let bench = Bench::new();
    let run = bench.flatten(mesh, &wanting(&[]), &["--spacing", "12"]).succeeded();
    let warnings = bench.report()["warnings"].to_string().to_lowercase();
    for word in words {
        assert!(warnings.contains(word), "`{word}` is not in {warnings}");
    }
    let worn = bench.worn();
    assert_eq!((worn.flipped(), worn.overlaps()), (0, 0));
    (bench, run)
}

#[test]
fn a_sound_tube_needs_no_repair() {
    let (bench, _) = repaired(&broken::sound(), &[]);
    let warnings = bench.report()["warnings"].to_string();
    for word in ["revers", "turned", "closed", "unused", "weld"] {
        assert!(!warnings.contains(word), "{warnings}");
    }
}

#[test]
fn a_turned_triangle_is_turned_back_and_said() {
    let (bench, _) = repaired(&broken::one_triangle_turned(), &["1"]);
    assert_ne!(bench.report()["warnings"].as_array().map(Vec::len), Some(0));
    // As outward as the sound one, triangle by triangle.
    for s in bench.worn().stretches() {
        assert!(s.area > 0.0);
    }
}

#[test]
fn an_inside_out_tube_is_reversed_and_said_and_gives_the_same_pattern() {
    let (inside_out, _) = repaired(&broken::sound().reversed(), &["inward"]);
    let (sound, _) = repaired(&broken::sound(), &[]);
    let (a, b) = (inside_out.worn(), sound.worn());
    let outward = |worn: &support::check::WornObj| {
        worn.faces.iter().all(|f| {
            let [a, b, c] = f.map(|(v, _)| worn.v[v]);
            (b - a).cross(c - a).dot((a + b + c) * DVec3::new(1.0, 1.0, 0.0)) > 0.0
        })
    };
    assert!(outward(&a) && outward(&b));
    assert!((a.area() / b.area() - 1.0).abs() < 1e-3);
}

#[test]
fn unused_vertices_are_dropped() {
    let (bench, _) = repaired(&broken::unused_vertices(), &[]);
    assert!(bench.worn().v.iter().all(|p| p.length() < 200.0));
}

#[test]
fn a_small_hole_is_closed_and_said_unless_forbidden() {
    // A vertex of six triangles about 10 mm wide leaves a rim of some 60 mm.
    let mesh = broken::small_hole();
    let bench = Bench::new();
    let args = ["--spacing", "12", "--quiet", "--close-holes"];
    let _ = bench.flatten(&mesh, &wanting(&[]), &[&args[..], &["100"]].concat()).succeeded();
    assert_eq!(bench.worn().outline().len(), 1);
    assert!(bench.report()["warnings"].to_string().contains("hole"));
    let _ = bench.flatten(&mesh, &wanting(&[]), &[&args[..], &["0"]].concat()).succeeded();
    assert_eq!(bench.worn().outline().len(), 2, "it stays as a cut-out");
}

#[test]
fn every_format_gives_the_same_surface() {
    let bench = Bench::new();
    // Eighths of a millimetre are exact in 32 bits.
    let mut mesh = broken::sound();
    for p in &mut mesh.points {
        *p = (*p * 8.0).round() / 8.0;
    }
    let files = [
        ("a.obj", write::obj(&mesh)),
        ("a.stl", write::stl_ascii(&mesh)),
        ("b.stl", write::stl_binary(&mesh)),
        ("a.ply", write::ply(&mesh, PlyEncoding::Ascii, PlyScalar::Float)),
        ("b.ply", write::ply(&mesh, PlyEncoding::Ascii, PlyScalar::Double)),
        ("c.ply", write::ply(&mesh, PlyEncoding::LittleEndian, PlyScalar::Float)),
        ("d.ply", write::ply(&mesh, PlyEncoding::LittleEndian, PlyScalar::Double)),
        ("e.ply", write::ply(&mesh, PlyEncoding::BigEndian, PlyScalar::Float)),
        ("f.ply", write::ply(&mesh, PlyEncoding::BigEndian, PlyScalar::Double)),
    ];
    for (name, bytes) in files {
        let file = bench.write(name, bytes);
        let design = wanting(&[]);
        let args = ["--spacing", "12", "--quiet", "--max-iterations", "200"];
        let _ = bench.flatten_file(&file, &design, &args, &[]).succeeded();
        let report = bench.report();
        let count = |key: &str| report["surface"][key].as_u64().unwrap() as usize;
        assert_eq!(count("vertices"), mesh.points.len(), "{name}");
        assert_eq!(count("triangles"), mesh.triangles.len(), "{name}");
        let area = report["surface"]["area_mm2"].as_f64().unwrap();
        assert!((area / mesh.area() - 1.0).abs() < 1e-9, "{name}: {area}");
    }
}

#[test]
fn an_unknown_extension_names_the_known_ones() {
    let bench = Bench::new();
    let file = bench.write("limb.xyz", write::obj(&broken::sound()));
    let run = run([Path::new("check"), &file]);
    assert!(matches!(run.code, Some(1 | 2)), "{run:?}");
    for known in ["obj", "stl", "ply"] {
        assert!(run.stderr.to_lowercase().contains(known), "{}", run.stderr);
    }
}
