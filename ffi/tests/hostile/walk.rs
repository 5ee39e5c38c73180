//! One hostile case, walked through everything that takes input; shared with the fuzzer.

use std::ffi::{CString, c_char};
use std::ptr::null_mut;

use wovenfit::*;

/// Ends the test on a fault of the library; else the status. Frees the error.
pub fn honest(status: Status, error: *mut Error) -> Status {
    if error.is_null() {
        return status;
    }
    let mut text = vec![0u8; 1 << 20];
    let mut needed = 0;
    // SAFETY: a living error object, a buffer of the capacity stated; freed once.
    unsafe {
        assert_eq!(wovenfit_error_status(error), status);
        let place = text.as_mut_ptr().cast::<c_char>();
        assert_eq!(wovenfit_error_text(error, place, text.len(), &raw mut needed), Status::Ok);
        wovenfit_error_free(error);
    }
    let text = String::from_utf8_lossy(&text[..needed.saturating_sub(1)]).into_owned();
    assert!(needed > 10, "{status:?} says nothing");
    assert_ne!(status, Status::Internal, "{text}");
    status
}

/// Runs one call with a place for its error.
macro_rules! go {
    ($function:ident($($argument:expr),* $(,)?)) => {{
        let mut error = null_mut();
        // SAFETY: arguments are living objects, NULL, or as long as they say.
        let status = unsafe { $function($($argument),*, &raw mut error) };
        honest(status, error)
    }};
}

/// Points and corners of a mesh, and what is wanted on it.
#[derive(Debug, Clone)]
pub struct Case {
    pub positions: Vec<f64>,
    pub triangles: Vec<u32>,
    pub mm_per_unit: f64,
    /// Values for the vertices.
    pub paint: Vec<f64>,
    /// Elements that are selected, vertices and triangles alike.
    pub picked: Vec<u32>,
    /// Numbers for points, planes, fabric.
    pub numbers: Vec<f64>,
    /// Parameters as text.
    pub values: Vec<(usize, String)>,
}

#[allow(unused_imports, reason = "of the users of this file one calls nothing else")]
pub(crate) use go;

/// Walks a case through everything that takes input; whether it had a result.
pub fn walk(case: &Case) -> bool {
    let (mut mesh, mut design, mut parameters) = (null_mut(), null_mut(), null_mut());
    let vertices = case.positions.len() / 3;
    let made = go!(wovenfit_mesh_new_f64(
        case.positions.as_ptr(),
        vertices,
        0,
        case.triangles.as_ptr(),
        case.triangles.len() / 3,
        case.mm_per_unit,
        &raw mut mesh,
    ));
    if made != Status::Ok {
        assert!(mesh.is_null());
        return false;
    }
    let mut check = null_mut();
    go!(wovenfit_parameters_new(&raw mut parameters));
    for (index, value) in &case.values {
        let mut name = [0u8; 64];
        let (place, what) = (name.as_mut_ptr().cast::<c_char>(), ParameterText::Name as i32);
        let index = index % wovenfit_parameter_count();
        let mut needed = 0;
        go!(wovenfit_parameter_describe(index, what, place, name.len(), &raw mut needed));
        let value = CString::new(value.replace('\0', "")).unwrap();
        go!(wovenfit_parameters_set(parameters, name.as_ptr().cast(), value.as_ptr()));
    }
    go!(wovenfit_design_new(case.mm_per_unit, &raw mut design));
    wish(case, mesh, design);
    if go!(wovenfit_check_run(mesh, design, parameters, &raw mut check)) == Status::Ok {
        let (mut defects, mut warnings, mut needed) = (0, 0, 0);
        go!(wovenfit_check_count(check, &raw mut defects, &raw mut warnings));
        go!(wovenfit_check_json(check, null_mut(), 0, &raw mut needed));
        for defect in 0..defects.min(20) {
            let (mut at, mut elements) = ([0.0; 3], [0u32; 4]);
            go!(wovenfit_check_defect_place(check, defect, at.as_mut_ptr()));
            let (place, count) = (elements.as_mut_ptr(), &raw mut needed);
            go!(wovenfit_check_defect_vertices(check, defect, place, elements.len(), count));
        }
    }
    // SAFETY: made above or NULL, freed once.
    unsafe { wovenfit_check_free(check) };
    let (mut job, mut solved) = (null_mut(), false);
    if go!(wovenfit_job_start(mesh, design, parameters, &raw mut job)) == Status::Ok {
        // A case of some triangles that takes longer hangs.
        assert_eq!(go!(wovenfit_job_wait(job, 120.0)), Status::Ok);
        let mut result = null_mut();
        if go!(wovenfit_job_result(job, &raw mut result)) == Status::Ok {
            read(result, vertices);
            solved = true;
        }
        // SAFETY: made above or NULL, freed once.
        unsafe { wovenfit_result_free(result) };
    }
    // SAFETY: made above or NULL, freed once.
    unsafe {
        wovenfit_job_free(job);
        wovenfit_parameters_free(parameters);
        wovenfit_design_free(design);
        wovenfit_mesh_free(mesh);
    }
    solved
}

/// Sets every kind of wish from the case's numbers.
fn wish(case: &Case, mesh: *const Mesh, design: *mut Design) {
    let (numbers, picked) = (&case.numbers, &case.picked);
    let number = |i: usize| numbers.get(i).copied().unwrap_or(1.0);
    let pick = |i: usize| picked.get(i).copied().unwrap_or(u32::MAX);
    go!(wovenfit_design_paint_pressures(design, mesh, case.paint.as_ptr(), case.paint.len()));
    let points = numbers.len() / 4;
    go!(wovenfit_design_add_pressures(design, numbers.as_ptr(), numbers.as_ptr(), points));
    let count = picked.len().min(numbers.len());
    let (which, kpa) = (picked.as_ptr(), numbers.as_ptr());
    go!(wovenfit_design_add_pressures_at_vertices(design, mesh, which, kpa, count));
    if number(0) > 0.0 {
        go!(wovenfit_design_set_region_triangles(design, mesh, which, picked.len()));
    }
    if number(1) > 0.0 {
        go!(wovenfit_design_add_seams_along_edges(design, mesh, which, picked.len() / 2));
    }
    if points > 1 {
        go!(wovenfit_design_set_orientation(design, kpa));
        go!(wovenfit_design_add_region_plane(design, kpa, numbers[3..].as_ptr()));
        go!(wovenfit_design_add_bony(design, kpa, points));
        if number(2) > 0.0 {
            go!(wovenfit_design_add_seam(design, kpa, points));
        }
    }
    go!(wovenfit_design_set_orientation_at_vertices(design, mesh, pick(0), pick(1)));
    for (i, name) in [c"fabric.warp", c"fabric.max_strain", c"limits.max_kpa"].iter().enumerate() {
        go!(wovenfit_design_set_number(design, name.as_ptr(), number(i)));
    }
}

/// Asks a result for everything.
fn read(result: *const FitResult, vertices: usize) {
    let mut needed = 0;
    for what in [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 20, 21, 22, 23] {
        let status = go!(wovenfit_result_doubles(result, what, null_mut(), 0, &raw mut needed));
        assert_eq!(status, Status::Ok, "{what}");
        assert!(what < 21 || needed == vertices);
    }
    for what in 1..=9 {
        let status = go!(wovenfit_result_indices(result, what, null_mut(), 0, &raw mut needed));
        assert_eq!(status, Status::Ok, "{what}");
    }
    for what in 1..=6 {
        let status = go!(wovenfit_result_text(result, what, null_mut(), 0, &raw mut needed));
        assert_eq!(status, Status::Ok, "{what}");
    }
}

/// An open tube of some sides and rings: what hostile changes begin with.
pub fn tube(sides: usize, rings: usize, radius: f64, length: f64) -> (Vec<f64>, Vec<u32>) {
    let mut positions = Vec::new();
    for ring in 0..rings {
        for side in 0..sides {
            let angle = std::f64::consts::TAU * side as f64 / sides as f64;
            let z = length * ring as f64 / (rings - 1) as f64;
            positions.extend([radius * angle.cos(), 0.9 * radius * angle.sin(), z]);
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..rings - 1 {
        for side in 0..sides {
            let at = |ring: usize, side: usize| (ring * sides + side % sides) as u32;
            let (a, b) = (at(ring, side), at(ring, side + 1));
            let (c, d) = (at(ring + 1, side), at(ring + 1, side + 1));
            triangles.extend([a, b, d, a, d, c]);
        }
    }
    (positions, triangles)
}
