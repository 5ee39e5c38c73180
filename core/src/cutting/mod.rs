//! From the pattern to pieces that a workshop can cut and sew: sew lines, allowances, notches, marks.
//!
//! A piece is the pattern's outline as edges, each with its allowance. Nothing here is rescaled; the
//! outline is smoothed within [`TOLERANCE`]. How a piece is drawn stands in `sheet`.

mod allowance;
mod crossing;
mod edges;
mod notch;
mod piece;
mod smooth;

pub use edges::{Edge, EdgeKind, Side, along, length};
pub use notch::Notch;
pub use piece::{Mark, MarkKind, Piece, SeamNote};
pub(crate) use piece::{Wanted, pieces};
pub use smooth::{LENGTH_TOLERANCE, TOLERANCE, smooth};
