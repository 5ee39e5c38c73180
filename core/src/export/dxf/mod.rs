//! DXF: group codes as text, in three dialects.
//!
//! `plain` is R2000 with units, for CAD, lasers and knives; `astm` is what apparel
//! CAD reads, ASTM D6673, in its own R13 and in the R12 that Gerber's reader wants.

mod astm;
mod plain;
mod skeleton;
mod writer;

pub use astm::{Dialect, pattern_astm};
pub use plain::pattern_dxf;
