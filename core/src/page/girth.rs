//! The lines on which girths were measured, in the pattern.

use glam::DVec2;

use super::PageInput;
use super::draw::{Anchor, INK, Labels, drawing, path, path_data, rimmed};
use super::html::shown;
use super::plan::Frame;
use crate::report::GirthPair;

/// The pattern with the lines on which the girths were measured.
pub(super) fn lines(input: &PageInput<'_>, pairs: &[GirthPair]) -> svg::Document {
    const SIZE: f64 = 15.0;
    let frame = Frame::new(input, super::plan::WIDTH, 420.0);
    let mut all = drawing(frame.size.x, frame.size.y, "Where the girths were measured")
        .add(path(frame.outline(input), INK, 1.4).set("fill", "#f1efea"));
    let mut labels = Labels::new(frame.size);
    for pair in pairs {
        let data: String =
            pair.line.iter().map(|ends| path_data(ends.map(|p| frame.place(p)))).collect();
        if data.is_empty() {
            continue;
        }
        all = all.add(path(data, "#00599c", 1.6));
        // At the left end of the line.
        let ends = pair.line.iter().flatten().copied();
        if let Some(p) = ends.min_by(|a, b| a.x.total_cmp(&b.x)) {
            let words = shown(pair.limb.at_mm, 0);
            let at = frame.place(p) + DVec2::new(22.0, 0.0);
            if labels.claim(at, SIZE, &words) {
                let base = at + DVec2::new(0.0, 0.35 * SIZE);
                all = all.add(rimmed(base, Anchor::Middle, SIZE, &words));
            }
        }
    }
    all
}
