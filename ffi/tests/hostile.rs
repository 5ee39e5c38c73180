//! Hostile input through the ABI: nothing crashes, hangs or asks for memory without bound, and every
//! refusal has its text. Whatever once went wrong stays below, by name.
//!
//! A panic inside is caught by the library and would come back as `Internal`: that is a failure here.

use std::cell::Cell;
use std::ffi::{CString, c_char};
use std::ptr::{null, null_mut};

use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};
use wovenfit::*;

/// Ends the test on a fault of the library; else the status. Frees the error.
fn honest(status: Status, error: *mut Error) -> Status {
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
struct Case {
    positions: Vec<f64>,
    triangles: Vec<u32>,
    mm_per_unit: f64,
    /// Values for the vertices.
    paint: Vec<f64>,
    /// Elements that are selected, vertices and triangles alike.
    picked: Vec<u32>,
    /// Numbers for points, planes, fabric.
    numbers: Vec<f64>,
    /// Parameters as text.
    values: Vec<(usize, String)>,
}

/// Walks a case through everything that takes input; whether it had a result.
fn walk(case: &Case) -> bool {
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
    for what in [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 20, 21, 22, 23] {
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
fn tube(sides: usize, rings: usize, radius: f64, length: f64) -> (Vec<f64>, Vec<u32>) {
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

/// Numbers that programs get wrong.
fn nasty() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -150.0..150.0,
        1 => Just(0.0),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => any::<f64>(),
        1 => -1e-6..1e-6,
        1 => -1e9..1e9,
    ]
}

/// A parameter's value: in its range, absurd, or no value at all.
fn text() -> impl Strategy<Value = String> {
    prop_oneof![
        4 => (0.0..30.0).prop_map(|x: f64| format!("{x:.3}")),
        1 => any::<f64>().prop_map(|x| x.to_string()),
        1 => Just("1e-9".to_owned()),
        1 => Just("1e18".to_owned()),
        1 => Just("true".to_owned()),
        1 => Just("false".to_owned()),
        1 => Just("m".to_owned()),
        1 => "\\PC{0,8}",
    ]
}

prop_compose! {
    /// A tube of which some numbers and corners are replaced, and wishes for it.
    fn tubes()(
        sides in 3usize..14,
        rings in 2usize..9,
        radius in prop_oneof![4 => 20.0..80.0, 1 => 1e-6..1e6],
        length in prop_oneof![4 => 20.0..200.0, 1 => 1e-6..1e6],
        bent in prop::collection::vec((any::<prop::sample::Index>(), nasty()), 0..3),
        named in prop::collection::vec((any::<prop::sample::Index>(), any::<u32>()), 0..2),
        sound in prop::bool::weighted(0.7),
        mm_per_unit in prop_oneof![6 => Just(1.0), 1 => nasty(), 1 => Just(10.0)],
        paint in prop::collection::vec(prop_oneof![3 => Just(0.0), 3 => 0.0..5.0, 1 => nasty()], 0..1),
        picked in prop::collection::vec(0u32..120, 0..60),
        numbers in prop::collection::vec(nasty(), 0..12),
        values in prop::collection::vec((0usize..64, text()), 0..4),
    ) -> Case {
        let (mut positions, mut triangles) = tube(sides, rings, radius, length);
        if !sound {
            for (index, value) in bent {
                let i = index.index(positions.len());
                positions[i] = value;
            }
            for (index, value) in named {
                let i = index.index(triangles.len());
                triangles[i] = value % (positions.len() as u32);
            }
        }
        let paint = vec![paint.first().copied().unwrap_or(0.0); positions.len() / 3];
        Case { positions, triangles, mm_per_unit, paint, picked, numbers, values }
    }
}

prop_compose! {
    /// Numbers that were never a mesh.
    fn noise()(
        positions in prop::collection::vec(nasty(), 0..90),
        triangles in prop::collection::vec(prop_oneof![5 => 0u32..30, 1 => any::<u32>()], 0..120),
        mm_per_unit in nasty(),
        paint in prop::collection::vec(nasty(), 0..30),
        picked in prop::collection::vec(any::<u32>(), 0..10),
        numbers in prop::collection::vec(nasty(), 0..12),
        values in prop::collection::vec((0usize..64, text()), 0..4),
    ) -> Case {
        Case { positions, triangles, mm_per_unit, paint, picked, numbers, values }
    }
}

/// As many cases as are told, the same in every run. `HOSTILE=20` takes twenty times as many others.
fn cases(count: u32) -> TestRunner {
    let times: Option<u32> = std::env::var("HOSTILE").ok().and_then(|times| times.parse().ok());
    let times = times.unwrap_or(1);
    TestRunner::new(ProptestConfig {
        cases: count * times,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(times.into()),
        ..ProptestConfig::default()
    })
}

#[test]
fn bent_limbs_and_absurd_wishes_are_solved_or_refused() {
    let solved = Cell::new(0);
    cases(150)
        .run(&tubes(), |case| {
            solved.set(solved.get() + u32::from(walk(&case)));
            Ok(())
        })
        .unwrap();
    // Or hostile input would never come past the door.
    assert!(solved.get() > 10, "{}", solved.get());
}

#[test]
fn numbers_that_are_no_mesh_are_refused() {
    cases(150)
        .run(&noise(), |case| {
            walk(&case);
            Ok(())
        })
        .unwrap();
}

#[test]
fn any_bytes_as_a_design_are_read_or_refused() {
    let bytes = prop_oneof![
        prop::collection::vec(1u8..=255, 0..200),
        "[\\[\\]{}\",:0-9a-z.eE+-]{0,120}".prop_map(String::into_bytes),
        "\\{\"(pressures|fabric|seams|region_faces|units)\": ?[\\[{]?[-0-9e.,\\]}]{0,30}\\}"
            .prop_map(String::into_bytes),
    ];
    let read = Cell::new(0);
    cases(2000)
        .run(&(bytes, prop_oneof![Just(1.0), nasty()]), |(bytes, scale)| {
            let json = CString::new(bytes).unwrap();
            let mut design = null_mut();
            let status = go!(wovenfit_design_from_json(json.as_ptr(), scale, &raw mut design));
            prop_assert_eq!(status == Status::Ok, !design.is_null());
            read.set(read.get() + u32::from(status == Status::Design));
            // SAFETY: made above or NULL, freed once.
            unsafe { wovenfit_design_free(design) };
            Ok(())
        })
        .unwrap();
    assert!(read.get() > 500, "{}", read.get());
}

#[test]
fn a_null_in_every_place_is_refused_by_name() {
    let mut needed = 0;
    assert_eq!(go!(wovenfit_mesh_size(null(), &raw mut needed, null_mut())), Status::NullArgument);
    assert_eq!(go!(wovenfit_design_from_json(null(), 1.0, null_mut())), Status::NullArgument);
}

/// A sound limb with these parameters.
fn limb(values: &[(&str, &str)], mm_per_unit: f64, scale: f64) -> Case {
    let (positions, triangles) = tube(12, 8, 40.0 * scale, 120.0 * scale);
    let row = |name: &str| {
        (0..wovenfit_parameter_count())
            .find(|&i| {
                let mut text = [0u8; 64];
                let (place, what) = (text.as_mut_ptr().cast(), ParameterText::Name as i32);
                let mut needed = 0;
                go!(wovenfit_parameter_describe(i, what, place, text.len(), &raw mut needed));
                &text[..needed - 1] == name.as_bytes()
            })
            .unwrap()
    };
    Case {
        paint: vec![0.0; positions.len() / 3],
        positions,
        triangles,
        mm_per_unit,
        picked: Vec::new(),
        numbers: vec![0.0; 3],
        values: values.iter().map(|(name, value)| (row(name), (*value).to_owned())).collect(),
    }
}

#[test]
fn a_limb_as_long_as_a_country_asks_for_no_memory_without_bound() {
    // Its unit is believed, threads are half a millimetre apart, girths a millimetre.
    for method in ["newton", "diffusion"] {
        let finest = [("units", "mm"), ("spacing", "0.5"), ("girth_step", "1"), ("method", method)];
        walk(&limb(&finest, 1.0, 1e5));
    }
}
