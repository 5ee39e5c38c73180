//! The C ABI of wovenfit: what a host (a CAD program, a script) sees of the core, and all it sees.
//!
//! `include/wovenfit.h` is generated from here; its preamble (`preamble.h`) states the conventions
//! once. A file is one C object. Every entry goes through `guard`: it catches panics, turns a
//! `Failure` into a status and an error object, and is the only way out.
//! Nothing here computes geometry; the core does.

#![deny(unsafe_op_in_unsafe_fn)]
#![deny(clippy::undocumented_unsafe_blocks)]

mod buffers;
mod check;
mod design;
mod failure;
mod formats;
mod guard;
mod job;
mod limits;
mod mesh;
mod parameters;
mod pool;
mod prepared;
mod result;
mod status;
mod version;
mod wishes;

pub use check::*;
pub use design::*;
pub use failure::{Error, wovenfit_error_free, wovenfit_error_status, wovenfit_error_text};
pub use formats::{
    FormatText, wovenfit_format_count, wovenfit_format_describe, wovenfit_result_pattern,
    wovenfit_result_pattern_notes,
};
pub use job::*;
pub use limits::*;
pub use mesh::*;
pub use parameters::*;
pub use prepared::{Prepared, wovenfit_prepared_free};
pub use result::*;
pub use status::{Status, wovenfit_status_name};
pub use version::*;
pub use wishes::*;
