//! A limb bent by the fuzzer's bytes, with wishes and parameters from them.

#![no_main]

use libfuzzer_sys::arbitrary::{Arbitrary, Result, Unstructured};
use libfuzzer_sys::fuzz_target;
use walk::{Case, tube, walk};

#[path = "../../ffi/tests/hostile/walk.rs"]
mod walk;

/// A number that is often that of a limb.
fn number(bytes: &mut Unstructured) -> Result<f64> {
    Ok(match bytes.int_in_range(0..=7)? {
        0 => f64::arbitrary(bytes)?,
        1 => f64::from(i32::arbitrary(bytes)?),
        _ => f64::from(bytes.int_in_range(-15_000..=15_000)?) / 100.0,
    })
}

fn case(bytes: &mut Unstructured) -> Result<Case> {
    let (sides, rings) = (bytes.int_in_range(3..=12)?, bytes.int_in_range(2..=8)?);
    let radius = f64::from(bytes.int_in_range(100..=800)?) / 10.0;
    let length = f64::from(bytes.int_in_range(100..=3000)?) / 10.0;
    let (mut positions, mut triangles) = tube(sides, rings, radius, length);
    for _ in 0..bytes.int_in_range(0..=4)? {
        let i = bytes.choose_index(positions.len())?;
        positions[i] = number(bytes)?;
    }
    for _ in 0..bytes.int_in_range(0..=3)? {
        let i = bytes.choose_index(triangles.len())?;
        triangles[i] = bytes.int_in_range(0..=positions.len() as u32 / 3)?;
    }
    if bool::arbitrary(bytes)? {
        let kept = 3 * bytes.choose_index(triangles.len() / 3)?;
        triangles.truncate(kept);
    }
    let mut paint = vec![0.0; positions.len() / 3];
    for _ in 0..bytes.int_in_range(0..=3)? {
        let i = bytes.choose_index(paint.len())?;
        paint[i] = number(bytes)?.abs() / 10.0;
    }
    let mut picked = Vec::new();
    for _ in 0..bytes.int_in_range(0..=20)? {
        picked.push(bytes.int_in_range(0..=200)?);
    }
    let mut numbers = Vec::new();
    for _ in 0..bytes.int_in_range(0..=12)? {
        numbers.push(number(bytes)?);
    }
    let mut values = Vec::new();
    for _ in 0..bytes.int_in_range(0..=3)? {
        values.push((bytes.int_in_range(0..=63)?, number(bytes)?.abs().to_string()));
    }
    let mm_per_unit = if bool::arbitrary(bytes)? { 1.0 } else { number(bytes)? };
    Ok(Case { positions, triangles, mm_per_unit, paint, picked, numbers, values })
}

fuzz_target!(|bytes: &[u8]| {
    if let Ok(case) = case(&mut Unstructured::new(bytes)) {
        walk(&case);
    }
});
