//! Version and ABI number.

use std::ffi::{CStr, c_char};

use crate::failure::{Error, Failure};
use crate::guard::guard;
use crate::status::Status;

/// The number of this ABI. It grows when a function or a struct changes so that an older caller
/// would misread it; what is only added leaves it.
pub const WOVENFIT_ABI_VERSION: u32 = 1;

/// NUL ends what C reads.
const VERSION: &CStr =
    match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"unknown",
    };

/// The ABI number of the library that is loaded.
///
/// Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn wovenfit_abi_version() -> u32 {
    WOVENFIT_ABI_VERSION
}

/// The library's version, such as "0.1.0"; never freed. Results of different versions may differ.
///
/// Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn wovenfit_version() -> *const c_char {
    VERSION.as_ptr()
}

/// Refuses a caller who was made for another ABI number: call it first, with WOVENFIT_ABI_VERSION.
/// WOVENFIT_STATUS_ABI_MISMATCH names both numbers.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_abi(abi: u32, error: *mut *mut Error) -> Status {
    // SAFETY: `error` is as the header's preamble asks.
    unsafe {
        guard(error, || {
            if abi == WOVENFIT_ABI_VERSION {
                return Ok(());
            }
            Err(Failure::new(
                Status::AbiMismatch,
                format!(
                    "the caller was made for ABI {abi} of wovenfit, and this library (version {}) \
                     has ABI {WOVENFIT_ABI_VERSION}: install those that belong together",
                    env!("CARGO_PKG_VERSION")
                ),
            ))
        })
    }
}
