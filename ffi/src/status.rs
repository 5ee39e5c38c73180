//! Status codes. Their numbers are frozen: a code may be added, none changes.

use std::ffi::{CStr, c_char};

/// What a function returns: 0 is success, all else a reason.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// A pointer that must not be NULL is.
    NullArgument = 1,
    /// An argument that cannot be: no number, out of its range, of the wrong length.
    InvalidArgument = 2,
    /// The buffer holds less than there is; the count says how much that is.
    BufferTooSmall = 3,
    /// More than the library takes; the text states the limit.
    TooLarge = 4,
    /// A text is not UTF-8.
    NotUtf8 = 5,
    /// The caller was made for another ABI number.
    AbiMismatch = 6,
    /// The job has not got that far.
    NotReady = 7,
    /// The time to wait is over and the job runs.
    Timeout = 8,
    /// The job was cancelled.
    Cancelled = 9,
    /// No element has this index.
    OutOfRange = 10,
    /// The design breaks a rule of the design file.
    Design = 20,
    /// No parameter has this name, or it cannot take the value.
    Parameter = 21,
    /// The surface is broken; `wovenfit_check_run` lists every defect.
    Surface = 22,
    /// The surface is not of a limb's size in its unit.
    Unit = 23,
    /// Region, seams or orientation are impossible.
    Seam = 24,
    /// A wanted pressure lies off the surface or outside the region.
    Pressure = 25,
    /// The cut surface has no parameterization.
    Parameterization = 26,
    /// The fit is impossible.
    Fit = 27,
    /// The fabric does not cover the surface.
    Mapping = 28,
    /// The prepared limb is for another region, seams, facing, unit or parameter: start a job on the
    /// mesh instead.
    PreparedForAnother = 29,
    /// A fault of the library, to be reported with its text.
    Internal = 100,
}

impl Status {
    /// Every status.
    pub const ALL: [Self; 22] = [
        Self::Ok,
        Self::NullArgument,
        Self::InvalidArgument,
        Self::BufferTooSmall,
        Self::TooLarge,
        Self::NotUtf8,
        Self::AbiMismatch,
        Self::NotReady,
        Self::Timeout,
        Self::Cancelled,
        Self::OutOfRange,
        Self::Design,
        Self::Parameter,
        Self::Surface,
        Self::Unit,
        Self::Seam,
        Self::Pressure,
        Self::Parameterization,
        Self::Fit,
        Self::Mapping,
        Self::PreparedForAnother,
        Self::Internal,
    ];

    fn name(self) -> &'static CStr {
        match self {
            Self::Ok => c"ok",
            Self::NullArgument => c"null_argument",
            Self::InvalidArgument => c"invalid_argument",
            Self::BufferTooSmall => c"buffer_too_small",
            Self::TooLarge => c"too_large",
            Self::NotUtf8 => c"not_utf8",
            Self::AbiMismatch => c"abi_mismatch",
            Self::NotReady => c"not_ready",
            Self::Timeout => c"timeout",
            Self::Cancelled => c"cancelled",
            Self::OutOfRange => c"out_of_range",
            Self::Design => c"design",
            Self::Parameter => c"parameter",
            Self::Surface => c"surface",
            Self::Unit => c"unit",
            Self::Seam => c"seam",
            Self::Pressure => c"pressure",
            Self::Parameterization => c"parameterization",
            Self::Fit => c"fit",
            Self::Mapping => c"mapping",
            Self::PreparedForAnother => c"prepared_for_another",
            Self::Internal => c"internal",
        }
    }
}

/// A status' short name, such as "buffer_too_small", for logs; "unknown" for other numbers. It is
/// never freed.
///
/// Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn wovenfit_status_name(status: i32) -> *const c_char {
    let known = Status::ALL.into_iter().find(|known| *known as i32 == status);
    known.map_or(c"unknown", Status::name).as_ptr()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_and_names_are_frozen() {
        let all: Vec<(i32, &str)> =
            Status::ALL.iter().map(|s| (*s as i32, s.name().to_str().unwrap())).collect();
        assert_eq!(
            all,
            [
                (0, "ok"),
                (1, "null_argument"),
                (2, "invalid_argument"),
                (3, "buffer_too_small"),
                (4, "too_large"),
                (5, "not_utf8"),
                (6, "abi_mismatch"),
                (7, "not_ready"),
                (8, "timeout"),
                (9, "cancelled"),
                (10, "out_of_range"),
                (20, "design"),
                (21, "parameter"),
                (22, "surface"),
                (23, "unit"),
                (24, "seam"),
                (25, "pressure"),
                (26, "parameterization"),
                (27, "fit"),
                (28, "mapping"),
                (29, "prepared_for_another"),
                (100, "internal"),
            ]
        );
    }
}
