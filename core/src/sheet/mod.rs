//! The pieces on a sheet as lines, circles and words in layers: what every format writes.
//!
//! All that is a matter of place is decided here, so that an exporter only writes. A sheet is in mm,
//! x to the right, y up, its lower left corner at the origin; words are in the unit that was chosen.

mod compose;
mod items;
mod place;
mod room;
mod title;
pub mod width;

use glam::DVec2;

use crate::cutting::{Notch, Piece};

pub use compose::sheet;
pub(crate) use title::{allowances, boxes};

/// The unit of a drawing's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SheetUnit {
    /// Millimetres.
    #[default]
    Millimetre,
    /// Inches.
    Inch,
}

impl SheetUnit {
    /// By its symbol, `mm` or `in`.
    #[must_use]
    pub fn named(symbol: &str) -> Option<Self> {
        [Self::Millimetre, Self::Inch].into_iter().find(|unit| unit.symbol() == symbol)
    }

    /// Its symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Inch => "in",
        }
    }

    /// How many of it a length in mm is.
    #[must_use]
    pub fn from_mm(self, mm: f64) -> f64 {
        match self {
            Self::Millimetre => mm,
            Self::Inch => mm / 25.4,
        }
    }

    /// A length in mm as words, to a tenth of a millimetre or a two-hundredth of an inch.
    #[must_use]
    pub fn words(self, mm: f64) -> String {
        match self {
            Self::Millimetre => format!("{mm:.1} mm"),
            Self::Inch => format!("{:.2} in", self.from_mm(mm)),
        }
    }
}

/// What an item of a drawing is for; a layer or group in every format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// Where it is cut: the outline.
    Cut,
    /// Where it is cut inside the outline.
    CutOut,
    /// Where it is sewn.
    Sew,
    /// Slits and marks that are laid on each other.
    Notch,
    /// An arrow along weft.
    Grain,
    /// An arrow along warp, the way it is stretched.
    Stretch,
    /// Points.
    Mark,
    /// Words.
    Text,
    /// What is measured to see whether the size is true.
    Scale,
}

impl Layer {
    /// Every layer, in the order in which they are drawn.
    pub const ALL: [Self; 9] = [
        Self::Cut,
        Self::CutOut,
        Self::Sew,
        Self::Notch,
        Self::Grain,
        Self::Stretch,
        Self::Mark,
        Self::Scale,
        Self::Text,
    ];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cut => "cut_line",
            Self::CutOut => "cut_out",
            Self::Sew => "sew_line",
            Self::Notch => "notches",
            Self::Grain => "grain",
            Self::Stretch => "stretch",
            Self::Mark => "marks",
            Self::Text => "text",
            Self::Scale => "scale",
        }
    }

    /// Its colour, red, green, blue.
    #[must_use]
    pub fn colour(self) -> [u8; 3] {
        match self {
            Self::Cut | Self::CutOut | Self::Text | Self::Scale => [0, 0, 0],
            Self::Sew => [0xe0, 0, 0],
            Self::Notch => [0xa0, 0, 0xa0],
            Self::Grain => [0, 0x50, 0xa0],
            Self::Stretch => [0xb0, 0x50, 0],
            Self::Mark => [0, 0x70, 0x30],
        }
    }
}

/// A line, a circle or words.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A line through points.
    Line {
        /// Its points, in mm; of a closed one the first is not repeated.
        points: Vec<DVec2>,
        /// Whether it goes back to the first.
        closed: bool,
    },
    /// A circle.
    Circle {
        /// Its centre, in mm.
        centre: DVec2,
        /// Its radius, in mm.
        radius: f64,
    },
    /// A line of words.
    Words {
        /// The middle of the words, or where they begin, at half the height of small letters; in mm.
        at: DVec2,
        /// Height of the letters from line to line, in mm.
        size: f64,
        /// How they are turned, in degrees, counter-clockwise.
        angle: f64,
        /// Whether `at` is their beginning.
        from_start: bool,
        /// The words.
        text: String,
    },
}

/// A shape on a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// What it is for.
    pub layer: Layer,
    /// A name that is unique on the sheet; empty where none is needed.
    pub id: String,
    /// The line, circle or words.
    pub shape: Shape,
}

/// A piece on the sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed<'a> {
    /// The piece.
    pub piece: &'a Piece,
    /// Where its origin lies on the sheet, in mm.
    pub offset: DVec2,
    /// All that is drawn of it, on the sheet.
    pub items: Vec<Item>,
    /// Its notches, on the sheet.
    pub notches: Vec<Notch>,
}

/// What stands on the sheet for all pieces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Heading {
    /// Name of the brace.
    pub name: String,
    /// Patient or job reference; may be empty.
    pub reference: String,
    /// Date as the designer wrote it; may be empty.
    pub date: String,
}

/// A sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet<'a> {
    /// Width and height, in mm.
    pub size: DVec2,
    /// The unit of its words and, in formats that have one, of its numbers.
    pub unit: SheetUnit,
    /// What it is of.
    pub heading: Heading,
    /// The pieces.
    pub pieces: Vec<Placed<'a>>,
    /// The scale box and the title.
    pub items: Vec<Item>,
}

impl Sheet<'_> {
    /// Everything on it.
    pub fn all(&self) -> impl Iterator<Item = &Item> + Clone {
        self.pieces.iter().flat_map(|placed| &placed.items).chain(&self.items)
    }
}

/// Width and height of the outer box that is measured, in mm: 4 by 2 inches.
pub const OUTER_BOX: DVec2 = DVec2::new(101.6, 50.8);

/// Width and height of the inner box that is measured, in mm.
pub const INNER_BOX: DVec2 = DVec2::new(100.0, 50.0);

#[cfg(test)]
pub(crate) mod tests;
