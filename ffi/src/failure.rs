//! Why a call failed, inside as [`Failure`] and outside as the object [`Error`].

use std::any::Any;
use std::ffi::c_char;
use std::fmt::Display;

use wovenfit_core::seams::SeamError;

use crate::buffers::fill_text;
use crate::guard::{borrow, free, guard_bare};
use crate::status::Status;

/// A status with its text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    pub(crate) status: Status,
    pub(crate) text: String,
}

impl Failure {
    pub(crate) fn new(status: Status, text: impl Display) -> Self {
        Self { status, text: text.to_string() }
    }

    pub(crate) fn invalid(text: impl Display) -> Self {
        Self::new(Status::InvalidArgument, text)
    }

    pub(crate) fn too_large(text: impl Display) -> Self {
        Self::new(Status::TooLarge, text)
    }

    pub(crate) fn of_panic(panic: &(dyn Any + Send)) -> Self {
        let said = panic
            .downcast_ref::<&str>()
            .copied()
            .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
            .unwrap_or("without a text");
        let text = format!("a fault of the library, please report it with the input: {said}");
        Self::new(Status::Internal, text)
    }
}

impl From<wovenfit_core::Error> for Failure {
    fn from(error: wovenfit_core::Error) -> Self {
        use wovenfit_core::Error as Core;
        let status = match &error {
            Core::Surface(error) if error.is_fault() => Status::Internal,
            Core::Surface(_) => Status::Surface,
            Core::Unit(_) => Status::Unit,
            Core::Seam(SeamError::Internal(_)) => Status::Internal,
            Core::Seam(_) => Status::Seam,
            Core::PressureFar { .. } | Core::PressureOutside { .. } => Status::Pressure,
            Core::Parameterize(_) => Status::Parameterization,
            Core::Fit(_) => Status::Fit,
            Core::Mapping(_) => Status::Mapping,
            Core::TooManyNodes { .. } => Status::TooLarge,
            Core::PreparedForAnother { .. } => Status::PreparedForAnother,
            Core::Cancelled => Status::Cancelled,
        };
        Self::new(status, error)
    }
}

impl From<wovenfit_core::design::DesignError> for Failure {
    fn from(error: wovenfit_core::design::DesignError) -> Self {
        Self::new(Status::Design, error)
    }
}

impl From<wovenfit_core::parameters::ParameterError> for Failure {
    fn from(error: wovenfit_core::parameters::ParameterError) -> Self {
        Self::new(Status::Parameter, error)
    }
}

/// Why a call failed: a status and a text that says what, where and what to do.
pub struct Error(pub(crate) Failure);

/// The status of an error; WOVENFIT_STATUS_OK for NULL.
///
/// Any thread.
///
/// # Safety
/// `error` is NULL or a living error object.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_error_status(error: *const Error) -> Status {
    // SAFETY: the caller gives NULL or a living object.
    unsafe { borrow(error, "error") }.map_or(Status::Ok, |error| error.0.status)
}

/// The text of an error: what, where (places in mm, elements counted from 0) and what to do.
/// `needed` becomes its size in bytes with the NUL.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_error_text(
    error: *const Error,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
) -> Status {
    // SAFETY: pointers are as the header's preamble asks; each is checked for NULL.
    guard_bare(|| unsafe {
        let error = borrow(error, "error")?;
        fill_text(buffer, capacity, needed, &error.0.text)
    })
}

/// Frees an error object; NULL is fine.
///
/// The object must not be in use by another thread.
///
/// # Safety
/// `error` is NULL or an object that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_error_free(error: *mut Error) {
    // SAFETY: the caller gives NULL or a living object and never uses it again.
    unsafe { free(error) }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use wovenfit_core::Error as Core;

    use super::*;

    #[test]
    fn every_error_of_the_core_has_its_status_and_keeps_its_text() {
        let at = DVec3::ONE;
        for (error, status) in [
            (Core::Cancelled, Status::Cancelled),
            (Core::PreparedForAnother { what: "seams" }, Status::PreparedForAnother),
            (Core::PressureFar { number: 1, at, distance: 12.0 }, Status::Pressure),
            (Core::PressureOutside { number: 1, at, distance: 12.0 }, Status::Pressure),
            (SeamError::Closed.into(), Status::Seam),
            (SeamError::Internal("x".to_owned()).into(), Status::Internal),
        ] {
            let text = error.to_string();
            assert_eq!(Failure::from(error), Failure { status, text });
        }
    }
}
