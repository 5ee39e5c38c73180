//! Hostile input through the ABI: nothing crashes, hangs or asks for memory without bound, and every
//! refusal has its text. Whatever once went wrong stays below, by name.
//!
//! A panic inside is caught by the library and would come back as `Internal`: that is a failure here.

mod walk;

use std::cell::Cell;
use std::ffi::CString;
use std::ptr::{null, null_mut};

use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};
use walk::{Case, go, honest, tube, walk};
use wovenfit::*;

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
