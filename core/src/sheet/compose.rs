//! Puts pieces, boxes and title on a sheet.

use glam::DVec2;

use super::items::items;
use super::place::rows;
use super::title::strip;
use super::{Heading, Item, Placed, Shape, Sheet, SheetUnit};
use crate::cutting::Piece;

/// White border, in mm: what ordinary printers cannot reach.
const MARGIN: f64 = 10.0;

/// Between the pieces and the strip below them, in mm.
const ABOVE_STRIP: f64 = 10.0;

/// The sheet of pieces with words in a unit.
#[must_use]
pub fn sheet<'a>(pieces: &'a [Piece], heading: Heading, unit: SheetUnit) -> Sheet<'a> {
    let sizes: Vec<DVec2> = pieces
        .iter()
        .map(|piece| {
            let (low, high) = piece.bounds();
            high - low
        })
        .collect();
    let (corners, extent) = rows(&sizes);
    let drawn: Vec<(Vec<Item>, Vec<String>)> = pieces
        .iter()
        .enumerate()
        .map(|(i, piece)| {
            let suffix = if i == 0 { String::new() } else { format!("_of_piece_{}", i + 1) };
            items(piece, unit, &suffix)
        })
        .collect();
    let left_over: Vec<String> = drawn
        .iter()
        .enumerate()
        .flat_map(|(i, (_, words))| {
            let piece = if pieces.len() > 1 { format!("piece {}: ", i + 1) } else { String::new() };
            words.iter().map(move |words| format!("{piece}{words}"))
        })
        .collect();
    let (strip, strip_size) = strip(&heading, pieces, &left_over, unit);
    let floor = DVec2::splat(MARGIN) + DVec2::new(0.0, strip_size.y + ABOVE_STRIP);
    let placed = pieces
        .iter()
        .zip(drawn)
        .zip(corners)
        .map(|((piece, (items, _)), corner)| {
            let offset = floor + corner - piece.bounds().0;
            let notches = piece.notches.iter().map(|notch| crate::cutting::Notch {
                sewn_at: notch.sewn_at + offset,
                at: notch.at + offset,
                end: notch.end + offset,
                ..*notch
            });
            Placed {
                piece,
                offset,
                notches: notches.collect(),
                items: items.into_iter().map(|item| moved(item, offset)).collect(),
            }
        })
        .collect();
    let size = DVec2::new(extent.x.max(strip_size.x), extent.y + ABOVE_STRIP + strip_size.y)
        + 2.0 * MARGIN;
    let items = strip.into_iter().map(|item| moved(item, DVec2::splat(MARGIN))).collect();
    Sheet { size, unit, heading, pieces: placed, items }
}

/// An item moved.
pub(crate) fn moved(mut item: Item, by: DVec2) -> Item {
    match &mut item.shape {
        Shape::Line { points, .. } => points.iter_mut().for_each(|p| *p += by),
        Shape::Circle { centre, .. } => *centre += by,
        Shape::Words { at, .. } => *at += by,
    }
    item
}
