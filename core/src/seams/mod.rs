//! Region and seams: from a validated surface to a disk.
//!
//! [`clip`] keeps what the brace covers, [`open_to_disk`] cuts it open along smooth seams, and
//! [`place`] finds the two orientation markers.

mod carve;
mod cut;
mod error;
mod markers;
mod path;
mod region;
mod sewing;
mod strip;
mod triangulation;

#[cfg(test)]
mod fixtures;

pub use cut::{CutSurface, Ends, open_to_disk};
pub use error::{REACH_MM, SeamError};
pub use markers::{Markers, place};
pub use region::{Clipped, clip};
pub use sewing::Seam;
