//! Region and seams: from a validated surface to a disk.
//!
//! [`select`] and [`clip`] keep what the brace covers, [`open_to_disk`] cuts it open along smooth seams, and
//! [`place`] finds the two orientation markers.

mod carve;
mod cut;
mod cutter;
mod error;
mod finer;
mod markers;
mod path;
mod pieces;
mod region;
mod selection;
mod sewing;
mod shape;
mod slivers;
mod strip;
mod triangulation;

#[cfg(test)]
mod fixtures;

pub use cut::{CutSurface, Ends, open_to_disk};
pub use error::{REACH_MM, SeamError};
pub use finer::Finer;
pub use markers::{Markers, place};
pub use region::{Clipped, clip};
pub use selection::select;
pub use sewing::Seam;
