//! Region and seams: from a validated surface to a disk.

mod error;
mod region;
mod triangulation;

#[cfg(test)]
mod fixtures;

pub use error::{REACH_MM, SeamError};
pub use region::{Clipped, clip};
