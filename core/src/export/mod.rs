//! Files from results: bytes in memory, no geometry decisions, no file system.

mod charset;
mod drawing;
pub mod dxf;
mod hpgl;
mod json;
mod number;
mod obj;
pub mod pdf;
mod png;
mod strokes;
mod svg;

pub use drawing::{Drawing, DrawingSeam};
pub use hpgl::pattern_hpgl;
pub use json::json_text;
pub use obj::{flat_obj, raw_obj, worn_obj};
pub use png::pattern_png;
pub use svg::pattern_svg;
