//! Arrays and texts in and out. What comes in is copied, so that the caller's memory is his again;
//! what goes out is copied into the caller's buffer, of whatever alignment.

use std::ffi::{CStr, c_char};

use glam::DVec3;

use crate::failure::Failure;
use crate::guard::{Out, Outcome};
use crate::limits::WOVENFIT_MOST_TEXT;
use crate::status::Status;

/// Numbers of which every pattern of bits is one.
pub(crate) trait Plain: Copy + Default {}
impl Plain for f32 {}
impl Plain for f64 {}
impl Plain for u32 {}
impl Plain for u8 {}

/// `count` numbers, of which `most` are allowed. NULL is fine for none.
///
/// # Safety
/// `values` is NULL or can be read for `count` numbers.
pub(crate) unsafe fn copied<T: Plain>(
    values: *const T,
    count: usize,
    most: usize,
    name: &str,
) -> Result<Vec<T>, Failure> {
    if count == 0 {
        return Ok(Vec::new());
    }
    if values.is_null() {
        return Err(Failure::new(Status::NullArgument, format!("`{name}` is NULL")));
    }
    if count > most {
        return Err(Failure::too_large(format!("{count} {name} are given; {most} are the most")));
    }
    let mut copy = vec![T::default(); count];
    // SAFETY: readable by the caller; as bytes it has any alignment, and any bits are a number.
    unsafe {
        let bytes = count * size_of::<T>();
        values.cast::<u8>().copy_to_nonoverlapping(copy.as_mut_ptr().cast::<u8>(), bytes);
    }
    Ok(copy)
}

/// Three numbers for each of `count` points, finite; in the unit in which they were given.
///
/// # Safety
/// `values` is NULL or can be read for `3 * count` numbers.
pub(crate) unsafe fn points(
    values: *const f64,
    count: usize,
    most: usize,
    name: &str,
) -> Result<Vec<DVec3>, Failure> {
    if count > most {
        return Err(Failure::too_large(format!("{count} {name} are given; {most} are the most")));
    }
    // SAFETY: by the caller; the product is small now.
    let numbers = unsafe { copied(values, 3 * count, 3 * most, name) }?;
    let points: Vec<DVec3> = numbers.chunks_exact(3).map(DVec3::from_slice).collect();
    match points.iter().position(|p| !p.is_finite()) {
        Some(i) => Err(Failure::invalid(format!(
            "point {i} of `{name}` is ({}, {}, {}): give finite numbers",
            points[i].x, points[i].y, points[i].z
        ))),
        None => Ok(points),
    }
}

/// A text that ends with NUL.
///
/// # Safety
/// `text` is NULL or can be read up to its NUL and is not changed during the call.
pub(crate) unsafe fn text<'a>(text: *const c_char, name: &str) -> Result<&'a str, Failure> {
    if text.is_null() {
        return Err(Failure::new(Status::NullArgument, format!("`{name}` is NULL")));
    }
    // SAFETY: by the caller.
    let bytes = unsafe { CStr::from_ptr(text) };
    if bytes.count_bytes() > WOVENFIT_MOST_TEXT as usize {
        return Err(Failure::too_large(format!(
            "`{name}` has {} bytes; {WOVENFIT_MOST_TEXT} are the most",
            bytes.count_bytes()
        )));
    }
    bytes.to_str().map_err(|error| {
        let place = error.valid_up_to();
        Failure::new(Status::NotUtf8, format!("byte {place} of `{name}` is not UTF-8 text"))
    })
}

/// Numbers to the caller: `count` becomes how many there are, and they are copied if `buffer` is not
/// NULL.
///
/// # Safety
/// `count` is NULL or can be written, `buffer` is NULL or can be written for `capacity` numbers.
pub(crate) unsafe fn fill<T: Plain>(
    buffer: *mut T,
    capacity: usize,
    count: *mut usize,
    values: &[T],
) -> Outcome {
    let count = Out::new(count, "count")?;
    if buffer.is_null() && capacity > 0 {
        return Err(Failure::new(Status::NullArgument, "`buffer` is NULL, `capacity` is not 0"));
    }
    // SAFETY: writable by the caller.
    unsafe { count.put(values.len()) }?;
    if buffer.is_null() {
        return Ok(());
    }
    if capacity < values.len() {
        return Err(Failure::new(
            Status::BufferTooSmall,
            format!("the buffer holds {capacity} and {} are there", values.len()),
        ));
    }
    // SAFETY: `capacity` numbers can be written, and there are no more; as bytes of any alignment.
    unsafe {
        let bytes = size_of_val(values);
        values.as_ptr().cast::<u8>().copy_to_nonoverlapping(buffer.cast::<u8>(), bytes);
    }
    Ok(())
}

/// A text to the caller, with a NUL after it that counts.
///
/// # Safety
/// As [`fill`].
pub(crate) unsafe fn fill_text(
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    text: &str,
) -> Outcome {
    let mut bytes = Vec::with_capacity(text.len() + 1);
    bytes.extend_from_slice(text.as_bytes());
    bytes.push(0);
    // SAFETY: by the caller.
    unsafe { fill(buffer.cast::<u8>(), capacity, needed, &bytes) }
}

#[cfg(test)]
mod tests {
    use std::ptr;

    use super::*;

    #[test]
    fn sizes_are_asked_first_and_small_buffers_stay_as_they_were() {
        let mut count = 0;
        let mut buffer = [9.0; 3];
        let values = [1.0, 2.0, 3.0];
        let place = (&raw mut buffer).cast::<f64>();
        let go = |buffer, capacity, count| {
            // SAFETY: buffers of our own, of the sizes stated.
            unsafe { fill(buffer, capacity, count, &values) }.map_err(|failure| failure.status)
        };
        assert_eq!(go(ptr::null_mut(), 0, &raw mut count), Ok(()));
        assert_eq!(count, 3);
        assert_eq!(go(ptr::null_mut(), 3, &raw mut count), Err(Status::NullArgument));
        assert_eq!(go(place, 3, ptr::null_mut()), Err(Status::NullArgument));
        assert_eq!(go(place, 2, &raw mut count), Err(Status::BufferTooSmall));
        assert_eq!(buffer, [9.0; 3]);
        assert_eq!(go(place, 3, &raw mut count), Ok(()));
        assert_eq!(buffer, values);
    }

    #[test]
    fn misaligned_numbers_are_read_and_counts_are_limited() {
        let bytes: Vec<u8> = [0u8].into_iter().chain(1.5f64.to_ne_bytes()).collect();
        // SAFETY: eight bytes lie there.
        let read = unsafe { copied(bytes[1..].as_ptr().cast::<f64>(), 1, 5, "values") };
        assert_eq!(read.unwrap(), [1.5]);
        // SAFETY: refused before anything is read.
        let refused = unsafe { copied(bytes.as_ptr().cast::<f64>(), usize::MAX, 5, "values") };
        assert_eq!(refused.unwrap_err().status, Status::TooLarge);
        // SAFETY: refused before anything is read.
        let refused = unsafe { points(bytes.as_ptr().cast::<f64>(), usize::MAX / 2, 5, "points") };
        assert_eq!(refused.unwrap_err().status, Status::TooLarge);
        // SAFETY: NULL is looked for.
        let refused = unsafe { copied::<f64>(ptr::null(), 1, 5, "values") };
        assert_eq!(refused.unwrap_err().status, Status::NullArgument);
        let line = [0.0, 1.0, f64::NAN];
        // SAFETY: three numbers lie there.
        let refused = unsafe { points(line.as_ptr(), 1, 5, "seam") }.unwrap_err();
        assert_eq!(refused.text, "point 0 of `seam` is (0, 1, NaN): give finite numbers");
    }
}
