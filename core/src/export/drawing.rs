//! The pattern as it was computed, for the report's pictures. What is cut is drawn by `sheet`.

use glam::DVec2;

/// A flat pattern; lengths in mm, x along warp, y along weft and up.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// Closed loops, the closing point not repeated: the outer one first, counter-clockwise, then
    /// the cut-outs.
    pub outline: Vec<Vec<DVec2>>,
    /// Sides that are sewn together.
    pub seams: Vec<DrawingSeam>,
    /// The orientation markers; the first is near the body.
    pub markers: [DVec2; 2],
    /// Pressure points with their wanted value as text.
    pub points: Vec<(DVec2, String)>,
    /// What the piece is called; may be empty.
    pub name: String,
}

/// The two sides of a seam, sewn start to start and end to end.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrawingSeam {
    /// One side of the seam, a polyline.
    pub left: Vec<DVec2>,
    /// The other side.
    pub right: Vec<DVec2>,
    /// Length of `left` in mm.
    pub left_mm: f64,
    /// Length of `right` in mm.
    pub right_mm: f64,
}
