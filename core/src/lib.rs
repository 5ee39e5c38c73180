//! From a scanned limb, a fabric's stiffness and wanted normal pressures to the flat pattern of
//! an elastic brace that, by its model, presses so when worn.
//!
//! The method is Wang & Tang, *Woven Model Based Geometric Design of Elastic Medical Braces*.
//! `ARCHITECTURE.md` is the map of this crate; `pipeline.rs` is the whole flow on one page.

#![forbid(unsafe_code)]

mod check;
pub mod cutting;
mod denoise;
pub mod design;
mod error;
pub mod examples;
pub mod export;
pub mod field;
mod files;
pub mod fit;
pub mod geometry;
pub mod mapping;
pub mod page;
pub mod parameterize;
pub mod parameters;
pub mod pattern;
mod pipeline;
pub mod pressure;
pub mod progress;
pub mod report;
pub mod samples;
pub mod seams;
pub mod sheet;
pub mod sparse;
pub mod surface;
pub mod transfer;
pub mod units;
pub mod warning;
pub mod weave;

pub use check::{CHECK_PARAMETERS, check, check_for};
pub use error::Error;
pub use files::{PatternFile, PatternFormat, ResultFile};
pub use pipeline::{Flattening, Prepared, flatten};
