//! The pattern through the ABI is the command line's, byte for byte.

use serde_json::Value;
use support::cli::{Bench, library, run};
use support::write::{PlyEncoding, PlyScalar, ply};

use crate::host::{ABI, Host};
use crate::limb;

/// The result's texts by their number in the header, and the command line's files.
const FILES: [(i32, &str); 5] =
    [(1, "report.json"), (2, "report.html"), (3, "pattern.svg"), (4, "worn.obj"), (5, "flat.obj")];

#[test]
fn every_file_has_the_bytes_that_the_command_line_writes() {
    let (mesh, design) = limb();
    let host = Host::load(library(), ABI).unwrap();
    let result = host.pattern(&mesh, &design.to_string(), &[("spacing", "9")]);
    let bench = Bench::new();
    let file = bench.write("limb.ply", ply(&mesh, PlyEncoding::LittleEndian, PlyScalar::Double));
    let _ = bench.flatten_file(&file, &design, &["--quiet", "--spacing", "9"], &[]).succeeded();
    for (what, name) in FILES {
        let bytes = bench.out(name);
        assert!(bytes.len() > 500, "{name}");
        assert!(host.result_text(result, what).into_bytes() == bytes, "{name} differs");
    }
    host.free("wovenfit_result_free", result);
}

#[test]
fn the_check_is_the_command_lines() {
    let (mesh, _) = limb();
    let host = Host::load(library(), ABI).unwrap();
    let handle = host.mesh(&mesh, 1.0);
    let mut ours: Value = serde_json::from_str(&host.check(handle)).unwrap();
    host.free("wovenfit_mesh_free", handle);
    let bench = Bench::new();
    let file = bench.write("limb.ply", ply(&mesh, PlyEncoding::LittleEndian, PlyScalar::Double));
    let told = run(["check".as_ref(), file.as_os_str(), "--json".as_ref()]).json();
    // A mesh from buffers has no file.
    ours["file"] = told["file"].clone();
    assert_eq!(ours, told);
}

#[test]
fn a_limb_in_metres_or_in_a_unit_without_a_name_is_the_same_limb() {
    let (mesh, design) = limb();
    let host = Host::load(library(), ABI).unwrap();
    let text = design.to_string();
    let in_mm = host.pattern(&mesh, &text, &[("spacing", "9")]);
    let worn = host.result_text(in_mm, 4);
    for mm_per_unit in [1000.0, 7.0] {
        let handle = host.mesh(&mesh.scaled(1.0 / mm_per_unit), mm_per_unit);
        let design = host.design(&text).unwrap();
        let parameters = host.parameters(&[("spacing", "9")]);
        let result = host.flatten(handle, design, parameters).unwrap();
        assert!(host.result_text(result, 4) == worn, "{mm_per_unit}");
        host.free("wovenfit_mesh_free", handle);
        host.free("wovenfit_design_free", design);
        host.free("wovenfit_parameters_free", parameters);
        host.free("wovenfit_result_free", result);
    }
    host.free("wovenfit_result_free", in_mm);
}

#[test]
fn a_limb_that_cannot_be_is_refused_unless_the_parameter_says_its_unit() {
    let (mesh, design) = limb();
    let host = Host::load(library(), ABI).unwrap();
    // Millimetres taken for metres: girths of 264 m.
    let handle = host.mesh(&mesh, 1000.0);
    let design = host.design(&design.to_string()).unwrap();
    let parameters = host.parameters(&[]);
    let refusal = host.flatten(handle, design, parameters).unwrap_err();
    assert_eq!(refusal.status, 23, "{}", refusal.text);
    assert!(refusal.text.contains("the coordinates are probably in mm"), "{}", refusal.text);
    host.free("wovenfit_mesh_free", handle);
    host.free("wovenfit_design_free", design);
    host.free("wovenfit_parameters_free", parameters);
}
