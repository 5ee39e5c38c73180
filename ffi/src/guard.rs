//! The one way in and out: panics caught, pointers checked, errors handed out.
//!
//! Pointers come as the header's preamble says: NULL where that is allowed, else valid for what the
//! function reads or writes, of any alignment. That they are cannot be checked here; every function
//! below that is `unsafe` asks it of the caller, and NULL is looked for.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::failure::{Error, Failure};
use crate::status::Status;

/// What the body of an entry gives.
pub(crate) type Outcome = Result<(), Failure>;

/// Runs the body of an entry. `error` becomes NULL or, if the call fails, a new error object.
///
/// # Safety
/// `error` is NULL or can be written.
pub(crate) unsafe fn guard(error: *mut *mut Error, body: impl FnOnce() -> Outcome) -> Status {
    let outcome = catch_unwind(AssertUnwindSafe(body))
        .unwrap_or_else(|panic| Err(Failure::of_panic(&*panic)));
    let (status, object) = match outcome {
        Ok(()) => (Status::Ok, std::ptr::null_mut()),
        Err(failure) if error.is_null() => (failure.status, std::ptr::null_mut()),
        Err(failure) => (failure.status, Box::into_raw(Box::new(Error(failure)))),
    };
    if !error.is_null() {
        // SAFETY: not NULL, and the caller says that it can be written.
        unsafe { error.write_unaligned(object) };
    }
    status
}

/// The same for functions that give no error object.
pub(crate) fn guard_bare(body: impl FnOnce() -> Outcome) -> Status {
    // SAFETY: NULL is never written.
    unsafe { guard(std::ptr::null_mut(), body) }
}

fn null(name: &str) -> Failure {
    Failure::new(Status::NullArgument, format!("`{name}` is NULL"))
}

/// An object that must be there.
///
/// # Safety
/// `object` is NULL or a living object that nobody changes during the call.
pub(crate) unsafe fn borrow<'a, T>(object: *const T, name: &str) -> Result<&'a T, Failure> {
    // SAFETY: by the caller; our objects are made by `Box` and so aligned.
    unsafe { object.as_ref() }.ok_or_else(|| null(name))
}

/// An object that may be NULL.
///
/// # Safety
/// As [`borrow`].
pub(crate) unsafe fn borrow_if_any<'a, T>(object: *const T) -> Option<&'a T> {
    // SAFETY: by the caller.
    unsafe { object.as_ref() }
}

/// An object that is changed.
///
/// # Safety
/// `object` is NULL or a living object that nobody else uses during the call.
pub(crate) unsafe fn borrow_mut<'a, T>(object: *mut T, name: &str) -> Result<&'a mut T, Failure> {
    // SAFETY: by the caller.
    unsafe { object.as_mut() }.ok_or_else(|| null(name))
}

/// Frees an object made by [`Out::give`]; NULL is fine. A panic while it is dropped ends here.
///
/// # Safety
/// `object` is NULL or was given out and not freed.
pub(crate) unsafe fn free<T>(object: *mut T) {
    if !object.is_null() {
        // SAFETY: by the caller it is ours and used no more.
        let object = unsafe { Box::from_raw(object) };
        drop(catch_unwind(AssertUnwindSafe(|| drop(object))));
    }
}

/// A place for an output, looked at before any work is done for it.
pub(crate) struct Out<T>(*mut T);

impl<T> Out<T> {
    pub(crate) fn new(place: *mut T, name: &str) -> Result<Self, Failure> {
        if place.is_null() { Err(null(name)) } else { Ok(Self(place)) }
    }

    /// # Safety
    /// The place can be written.
    pub(crate) unsafe fn put(self, value: T) -> Outcome {
        // SAFETY: not NULL, and writable by the caller.
        unsafe { self.0.write_unaligned(value) };
        Ok(())
    }
}

impl<T> Out<*mut T> {
    /// Gives an object to the caller, who frees it.
    ///
    /// # Safety
    /// The place can be written.
    pub(crate) unsafe fn give(self, object: T) -> Outcome {
        // SAFETY: by the caller.
        unsafe { self.put(Box::into_raw(Box::new(object))) }
    }
}

#[cfg(test)]
mod tests {
    use std::ptr;

    use super::*;

    #[test]
    fn a_panic_becomes_an_internal_error_with_its_text() {
        let mut error = ptr::null_mut();
        // SAFETY: a place of our own.
        let status = unsafe { guard(&raw mut error, || panic!("the answer is {}", 42)) };
        assert_eq!(status, Status::Internal);
        // SAFETY: given out by the call above and freed here alone.
        let error = unsafe { Box::from_raw(error) };
        assert!(error.0.text.ends_with("the answer is 42"), "{}", error.0.text);
        // SAFETY: NULL is allowed.
        assert_eq!(unsafe { guard(ptr::null_mut(), || panic!("x")) }, Status::Internal);
    }

    #[test]
    fn success_clears_the_error_and_failure_writes_no_output() {
        let mut error = ptr::dangling_mut::<Error>();
        let mut number = 7;
        // SAFETY: places of our own.
        let status = unsafe {
            guard(&raw mut error, || {
                Out::new(ptr::null_mut::<i32>(), "count")?.put(1)?;
                Out::new(&raw mut number, "number")?.put(8)
            })
        };
        assert_eq!((status, number), (Status::NullArgument, 7));
        // SAFETY: given out above and freed here alone.
        let said = unsafe { Box::from_raw(error) };
        assert_eq!(said.0.text, "`count` is NULL");
        // SAFETY: a place of our own.
        assert_eq!(unsafe { guard(&raw mut error, || Ok(())) }, Status::Ok);
        assert!(error.is_null());
    }
}
