//! Files from results: bytes in memory, no geometry decisions, no file system.

mod drawing;
mod json;
mod layout;
mod number;
mod obj;
mod svg;

pub use drawing::{Drawing, DrawingSeam};
pub use json::json_text;
pub use obj::{flat_obj, raw_obj, worn_obj};
pub use svg::pattern_svg;
