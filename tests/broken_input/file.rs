//! Files that are empty, cut short, or something else.

use support::broken::sound;
use support::cli::Bench;
use support::write::{self, PlyEncoding, PlyScalar};

use super::refused;

#[test]
fn an_empty_file() {
    let bench = Bench::new();
    for name in ["limb.obj", "limb.stl", "limb.ply"] {
        let file = bench.write(name, b"");
        refused(&bench, &file, &["empty"]);
    }
}

#[test]
fn a_file_cut_short() {
    let bench = Bench::new();
    let files = [
        ("a.stl", write::stl_binary(&sound())),
        ("b.stl", write::stl_ascii(&sound())),
        ("a.ply", write::ply(&sound(), PlyEncoding::LittleEndian, PlyScalar::Float)),
        ("b.ply", write::ply(&sound(), PlyEncoding::BigEndian, PlyScalar::Double)),
        ("c.ply", write::ply(&sound(), PlyEncoding::Ascii, PlyScalar::Double)),
    ];
    for (name, bytes) in files {
        let file = bench.write(name, &bytes[..bytes.len() * 7 / 10]);
        refused(&bench, &file, &["truncated"]);
    }
    // A binary file says how long it should be and how long it is.
    let whole = write::stl_binary(&sound());
    let file = bench.write("c.stl", &whole[..1000]);
    refused(&bench, &file, &["truncated", &whole.len().to_string(), "1000"]);
}

#[test]
fn a_number_that_is_none() {
    let bench = Bench::new();
    let text = String::from_utf8(write::obj(&sound())).unwrap();
    let line = text.lines().nth(5).unwrap();
    let file = bench.write("limb.obj", text.replacen(line, "v 1.0 2,5 3.0", 1));
    refused(&bench, &file, &["line 6"]);
}

#[test]
fn a_cloud_of_points() {
    let bench = Bench::new();
    let file = bench.write("limb.obj", "v 0 0 0\nv 50 0 0\nv 0 50 0\nv 0 0 50\n");
    refused(&bench, &file, &["no faces"]);
}

#[test]
fn something_else_under_the_name_of_a_mesh() {
    let bench = Bench::new();
    for name in ["limb.obj", "limb.stl", "limb.ply"] {
        let file = bench.write(name, b"%PDF-1.7\n1 0 obj\n<< /Type /Catalog >>\nendobj\n");
        refused(&bench, &file, &[]);
    }
}

#[test]
fn no_file_at_all() {
    let bench = Bench::new();
    refused(&bench, &bench.path("missing.obj"), &["missing.obj"]);
}
