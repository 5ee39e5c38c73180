//! Lines and lettering of the page's drawings, and labels that keep out of each other's way.

use glam::DVec2;
use svg::Document;
use svg::node::element::{Circle, Image, Line, Path, Rectangle, Text};

use super::html::{coordinate, printable};

/// Ink of lines and lettering.
pub(super) const INK: &str = "#1d1d1b";
/// Lines that should not catch the eye.
pub(super) const FAINT: &str = "#c9c7c2";
/// Lettering of less weight.
pub(super) const QUIET: &str = "#5a5853";

/// A drawing of this size that fits the width that it is given, with words for who cannot see it.
pub(super) fn drawing(width: f64, height: f64, words: &str) -> Document {
    Document::new()
        .set("viewBox", format!("0 0 {} {}", coordinate(width), coordinate(height)))
        .set("role", "img")
        .set("aria-label", printable(words))
        .set("font-family", "system-ui, 'Segoe UI', 'DejaVu Sans', Arial, sans-serif")
        .set("fill", "none")
}

/// A straight line.
pub(super) fn line(from: DVec2, to: DVec2, colour: &str, width: f64) -> Line {
    Line::new()
        .set("x1", coordinate(from.x))
        .set("y1", coordinate(from.y))
        .set("x2", coordinate(to.x))
        .set("y2", coordinate(to.y))
        .set("stroke", colour)
        .set("stroke-width", coordinate(width))
}

/// The data of a path through points.
pub(super) fn path_data(points: impl IntoIterator<Item = DVec2>) -> String {
    let mut data = String::new();
    for (i, p) in points.into_iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        data.push_str(&format!("{command}{} {}", coordinate(p.x), coordinate(p.y)));
    }
    data
}

/// A path.
pub(super) fn path(data: String, colour: &str, width: f64) -> Path {
    Path::new()
        .set("d", data)
        .set("stroke", colour)
        .set("stroke-width", coordinate(width))
        .set("stroke-linejoin", "round")
}

/// A circle, hollow if `fill` is `none`.
pub(super) fn circle(at: DVec2, radius: f64, fill: &str, stroke: &str) -> Circle {
    Circle::new()
        .set("cx", coordinate(at.x))
        .set("cy", coordinate(at.y))
        .set("r", coordinate(radius))
        .set("fill", fill)
        .set("stroke", stroke)
}

/// A rectangle from its upper left corner.
pub(super) fn rectangle(corner: DVec2, size: DVec2, fill: &str) -> Rectangle {
    Rectangle::new()
        .set("x", coordinate(corner.x))
        .set("y", coordinate(corner.y))
        .set("width", coordinate(size.x))
        .set("height", coordinate(size.y))
        .set("fill", fill)
}

/// An image that is in its own address.
pub(super) fn image(corner: DVec2, size: DVec2, address: String) -> Image {
    Image::new()
        .set("x", coordinate(corner.x))
        .set("y", coordinate(corner.y))
        .set("width", coordinate(size.x))
        .set("height", coordinate(size.y))
        .set("href", address)
}

/// The end of a line of text that stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    /// Its first letter.
    Start,
    /// Its middle.
    Middle,
    /// Its last letter.
    End,
}

/// A line of text on its base line.
pub(super) fn text(at: DVec2, anchor: Anchor, size: f64, words: &str) -> Text {
    let anchor = match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    Text::new(printable(words))
        .set("x", coordinate(at.x))
        .set("y", coordinate(at.y))
        .set("font-size", coordinate(size))
        .set("text-anchor", anchor)
        .set("fill", INK)
}

/// The same with a white rim, legible on any ground.
pub(super) fn rimmed(at: DVec2, anchor: Anchor, size: f64, words: &str) -> Text {
    text(at, anchor, size, words)
        .set("stroke", "#ffffff")
        .set("stroke-width", coordinate(0.28 * size))
        .set("stroke-linejoin", "round")
        .set("paint-order", "stroke")
}

/// Mean width of a letter over its height in sans-serif fonts.
const LETTER_WIDTH: f64 = 0.58;

/// Width that a line of text takes, about.
pub(super) fn text_width(words: &str, size: f64) -> f64 {
    LETTER_WIDTH * size * words.chars().count() as f64
}

/// Places for labels beside their points, where the frame and former labels leave room.
#[derive(Debug, Clone)]
pub(super) struct Labels {
    frame: DVec2,
    taken: Vec<(DVec2, DVec2)>,
}

impl Labels {
    /// In a frame from the origin to `frame`.
    pub(super) fn new(frame: DVec2) -> Self {
        Self { frame, taken: Vec::new() }
    }

    /// Keeps a box about a point free.
    pub(super) fn keep_free(&mut self, at: DVec2, half: f64) {
        self.taken.push((at - half, at + half));
    }

    /// Where a label of a point goes: right above it, or wherever else beside it is most room.
    pub(super) fn place(&mut self, at: DVec2, gap: f64, size: f64, words: &str) -> (DVec2, Anchor) {
        let extent = DVec2::new(text_width(words, size), size);
        let mut best: Option<(f64, DVec2, DVec2, Anchor)> = None;
        for way in [(1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (1.0, 0.0), (-1.0, 0.0)] {
            let (right, down) = way;
            let near = at + DVec2::new(gap * right, 0.8 * gap * down);
            let low = DVec2::new(
                if right > 0.0 { near.x } else { near.x - extent.x },
                near.y - extent.y * (1.0 - down) / 2.0,
            );
            let high = low + extent;
            let out = DVec2::ZERO.max(-low) + DVec2::ZERO.max(high - self.frame);
            let hidden: f64 = self.taken.iter().map(|&(l, h)| overlap((low, high), (l, h))).sum();
            let cost = hidden + 100.0 * (out.x + out.y);
            if best.is_none_or(|(least, ..)| cost < least) {
                let anchor = if right > 0.0 { Anchor::Start } else { Anchor::End };
                // The base line of capitals lies a little above the box's lower edge.
                let base = DVec2::new(near.x, high.y - 0.15 * size);
                best = Some((cost, low, base, anchor));
            }
        }
        let (_, low, base, anchor) = best.unwrap_or((0.0, at, at, Anchor::Start));
        self.taken.push((low, low + extent));
        (base, anchor)
    }

    /// Whether a centred line of text has its place to itself; takes it then.
    pub(super) fn claim(&mut self, middle: DVec2, size: f64, words: &str) -> bool {
        let half = DVec2::new(text_width(words, size), size) / 2.0;
        let (low, high) = (middle - half, middle + half);
        let free = self.taken.iter().all(|&taken| overlap((low, high), taken) == 0.0);
        if free {
            self.taken.push((low, high));
        }
        free
    }
}

fn overlap(a: (DVec2, DVec2), b: (DVec2, DVec2)) -> f64 {
    let size = (a.1.min(b.1) - a.0.max(b.0)).max(DVec2::ZERO);
    size.x * size.y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_near_points_do_not_overlap_and_stay_in_the_frame() {
        let mut labels = Labels::new(DVec2::splat(100.0));
        let points = [(50.0, 50.0), (52.0, 51.0), (97.0, 50.0), (50.0, 2.0)].map(DVec2::from);
        for p in points {
            labels.place(p, 4.0, 10.0, "12");
        }
        for (i, &a) in labels.taken.iter().enumerate() {
            assert!(a.0.min_element() >= 0.0 && a.1.max_element() <= 100.0, "{a:?}");
            for &b in &labels.taken[..i] {
                assert_eq!(overlap(a, b), 0.0);
            }
        }
        assert!(!labels.claim(labels.taken[0].0, 10.0, "x"));
        assert!(labels.claim(DVec2::new(10.0, 90.0), 10.0, "x"));
    }
}
