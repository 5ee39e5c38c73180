//! The strip below the pieces: the boxes that are measured, and what the sheet is of.

use glam::DVec2;

use super::width::width;
use super::{Heading, INNER_BOX, Item, Layer, OUTER_BOX, Shape, SheetUnit};
use crate::cutting::{EdgeKind, Piece, TOLERANCE};

/// Size of the name and of the other lines, in mm.
const NAME: f64 = 6.0;
const LINE: f64 = 3.6;
/// From line to line, in mm.
const STEP: f64 = 5.4;
/// Between the boxes and the words, in mm.
const GAP: f64 = 8.0;

/// The strip: its items with their lower left corner at the origin, and its size.
pub(super) fn strip(
    heading: &Heading,
    pieces: &[Piece],
    left_over: &[String],
    unit: SheetUnit,
) -> (Vec<Item>, DVec2) {
    let lines = lines(heading, pieces, left_over, unit);
    let high = (NAME + 3.0 + STEP * lines.len() as f64).max(OUTER_BOX.y);
    let mut items = boxes(DVec2::new(0.0, high - OUTER_BOX.y));
    let x = OUTER_BOX.x + GAP;
    let words = |y: f64, size: f64, text: &str| Item {
        layer: Layer::Text,
        id: String::new(),
        shape: Shape::Words {
            at: DVec2::new(x, y),
            size,
            angle: 0.0,
            from_start: true,
            text: text.to_owned(),
        },
    };
    items.push(words(high - 0.5 * NAME, NAME, &heading.name));
    let first = high - NAME - 5.0;
    for (i, line) in lines.iter().enumerate() {
        items.push(words(first - STEP * i as f64, LINE, line));
    }
    let widest =
        lines.iter().map(|line| width(line, LINE)).fold(width(&heading.name, NAME), f64::max);
    (items, DVec2::new(x + widest, high))
}

/// The two boxes, one inside the other, with their lower left corner at a place.
pub(crate) fn boxes(corner: DVec2) -> Vec<Item> {
    let inset = 0.5 * (OUTER_BOX - INNER_BOX);
    let rectangle = |id: &str, low: DVec2, size: DVec2| Item {
        layer: Layer::Scale,
        id: id.to_owned(),
        shape: Shape::Line {
            points: vec![
                low,
                low + DVec2::new(size.x, 0.0),
                low + size,
                low + DVec2::new(0.0, size.y),
            ],
            closed: true,
        },
    };
    let words = |up: f64, text: &str| Item {
        layer: Layer::Text,
        id: String::new(),
        shape: Shape::Words {
            at: corner + DVec2::new(0.5 * OUTER_BOX.x, up),
            size: LINE,
            angle: 0.0,
            from_start: false,
            text: text.to_owned(),
        },
    };
    vec![
        rectangle("scale_box_4_by_2_inch", corner, OUTER_BOX),
        rectangle("scale_box_100_by_50_mm", corner + inset, INNER_BOX),
        words(34.0, "Print at 100 %, then measure:"),
        words(25.4, "inner box 100 \u{d7} 50 mm"),
        words(18.0, "outer box 4 \u{d7} 2 inch"),
    ]
}

fn lines(
    heading: &Heading,
    pieces: &[Piece],
    left_over: &[String],
    unit: SheetUnit,
) -> Vec<String> {
    let mut lines = Vec::new();
    let about: Vec<String> = [("Reference", &heading.reference), ("Date", &heading.date)]
        .into_iter()
        .filter(|(_, text)| !text.is_empty())
        .map(|(name, text)| format!("{name}: {text}"))
        .collect();
    if !about.is_empty() {
        lines.push(about.join("   "));
    }
    if let Some(piece) = pieces.first() {
        let count = match pieces.len() {
            1 => String::new(),
            n => format!("{n} pieces, each "),
        };
        lines.push(format!("{count}cut {} \u{d7} from {}", piece.quantity, piece.material));
        lines.push(format!("Allowances: {}.", allowances(pieces, unit)));
        let seams = seams(pieces, unit);
        if !seams.is_empty() {
            lines.push(seams);
        }
    }
    lines.push(format!(
        "Outline smoothed within {TOLERANCE} mm. Outer side of the fabric up. Lengths in {}.",
        match unit {
            SheetUnit::Millimetre => "millimetres",
            SheetUnit::Inch => "inches",
        }
    ));
    lines.extend(left_over.iter().cloned());
    lines.push(format!(
        "wovenfit {}. Pressures are computed, not measured.",
        env!("CARGO_PKG_VERSION")
    ));
    lines
}

/// The allowances of all edges in words.
pub(crate) fn allowances(pieces: &[Piece], unit: SheetUnit) -> String {
    let edges = || pieces.iter().flat_map(|piece| &piece.edges).flatten();
    let name = |kind: EdgeKind| match kind {
        EdgeKind::Sewn(..) => "seams",
        EdgeKind::Top => "top",
        EdgeKind::Bottom => "bottom",
        EdgeKind::Free => "other edges",
    };
    if edges().all(|edge| edge.allowance == 0.0) {
        return "none: the cut line is the sew line".to_owned();
    }
    let mut parts: Vec<String> = Vec::new();
    for what in ["seams", "top", "bottom", "other edges"] {
        let mut widths: Vec<f64> =
            edges().filter(|edge| name(edge.kind) == what).map(|edge| edge.allowance).collect();
        widths.sort_by(f64::total_cmp);
        widths.dedup();
        match widths[..] {
            [] => {}
            [0.0] => parts.push(format!("{what} none")),
            [one] => parts.push(format!("{what} {}", unit.words(one))),
            [least, .., most] => {
                parts.push(format!("{what} {} to {}", unit.words(least), unit.words(most)));
            }
        }
    }
    format!("{}, drawn outside the sew line", parts.join(", "))
}

fn seams(pieces: &[Piece], unit: SheetUnit) -> String {
    let sides = pieces.iter().flat_map(|piece| &piece.seams);
    let words = sides.filter(|side| side.name.ends_with("left"));
    words
        .take(6)
        .map(|side| {
            let other = pieces.iter().flat_map(|p| &p.seams).find(|s| s.name == side.sewn_to);
            let other = other.map_or(side.length_mm, |s| s.length_mm);
            let seam = side.name.trim_end_matches(" left");
            format!("{seam}: {} left, {} right", unit.words(side.length_mm), unit.words(other))
        })
        .collect::<Vec<_>>()
        .join("; ")
}
