//! The initial planar parameterization Ω.

mod sparse;

pub use sparse::{Factor, Pattern, SparseError};
