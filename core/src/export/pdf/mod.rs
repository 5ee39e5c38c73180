//! PDF of a sheet at true size: on one page for a plotter, or in tiles for an office printer; the
//! workshop sheet comes last.
//!
//! Fonts are the standard Helvetica, which every reader has or has a stand-in of the same widths for;
//! nothing is embedded. Layers are optional content, so that a reader can hide words or sew lines.

mod document;
mod table;
mod tiles;

use glam::DVec2;

use crate::report::Workshop;
use crate::sheet::Sheet;
use document::{Document, drawing};

/// What it is printed on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paper {
    /// One page as large as the sheet.
    Whole,
    /// Tiles of 210 by 297 mm.
    A4,
    /// Tiles of 8.5 by 11 inches.
    Letter,
}

impl Paper {
    /// Width and height in mm; the workshop sheet of a plotter's file is on A4.
    fn size(self) -> DVec2 {
        match self {
            Self::Whole | Self::A4 => DVec2::new(210.0, 297.0),
            Self::Letter => DVec2::new(215.9, 279.4),
        }
    }
}

/// A sheet as PDF, and the texts that its font could not hold with what stands for them.
#[must_use]
pub fn pattern_pdf(
    sheet: &Sheet<'_>,
    workshop: &Workshop,
    paper: Paper,
) -> (Vec<u8>, Vec<[String; 2]>) {
    let mut document = Document::new(&sheet.heading.name);
    match paper {
        Paper::Whole => {
            let mut page = document.page(sheet.size);
            drawing(&mut page, sheet.all(), DVec2::ZERO);
            document.add(page);
        }
        Paper::A4 | Paper::Letter => tiles::add(&mut document, sheet, paper.size()),
    }
    table::add(&mut document, workshop, paper.size());
    document.finish()
}
