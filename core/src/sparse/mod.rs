//! Sparse symmetric positive definite systems; what of faer is used stands in this folder.
//!
//! `Matrix` is that of a surface, two unknowns a vertex: analysed once (`dissection`), factorized as often as
//! wanted (`multifrontal`), on all cores and with the same bits on any number of them. The initial
//! parameterization and the fit's every step share one. `Pattern` takes any other system, on one thread.

mod cholesky;
mod dissection;
mod matrix;
mod multifrontal;

pub use cholesky::{Factor, Pattern, SparseError};
pub use matrix::{Element, Matrix, SurfaceFactor};
