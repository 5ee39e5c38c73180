//! ASTM D6673 (AAMA): a block for each piece, layers by number, what a piece is as text.
//!
//! ASTM D6673-10, *Standard Practice for Sewn Products Pattern Data Interchange*. Layers: 1 boundary and
//! system text, 2 turn points, 3 curve points, 4 notches, 7 grain line, 8 internal lines (drawn, not
//! cut), 11 cut-outs, 13 drill holes, 14 sew lines, 15 annotation, 84 to 87 copies of 1, 8, 11 and 14 by
//! which a reader checks its curves. The standard is on DXF R13; Gerber's reader wants R12 with an empty
//! header and no tables. Texts have 7 bits, names at most 20 characters. Not written: grading, mirror
//! lines, stripes: a brace has one size.

use glam::DVec2;

use super::skeleton::{FileLayer, begin_block, end_block, head, layouts, tail};
use super::writer::{Release, Writer};
use crate::cutting::{MarkKind, TOLERANCE};
use crate::export::charset::ascii;
use crate::sheet::{Layer, Placed, Shape, Sheet, SheetUnit};

/// Longest name of a style or a piece.
const LONGEST_NAME: usize = 20;

/// A boundary turns at a point if it turns by more than this, in degrees; else the point is of a curve.
const TURN: f64 = 30.0;

/// Height of the system text, in mm.
const TEXT: f64 = 3.5;

/// The layers that are used.
const LAYERS: [&str; 14] =
    ["1", "2", "3", "4", "7", "8", "11", "13", "14", "15", "84", "85", "86", "87"];

/// Which reader it is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// The standard's own, DXF R13.
    Standard,
    /// Gerber's: R12, an empty header, no tables.
    Gerber,
}

/// A sheet as ASTM D6673, and the names that it could not hold with what stands for them.
#[must_use]
pub fn pattern_astm(sheet: &Sheet<'_>, dialect: Dialect) -> (String, Vec<[String; 2]>) {
    let mut file = File::new(sheet, dialect);
    let names = file.names();
    let blocks: Vec<(String, u32)> =
        names.iter().map(|name| (name.clone(), file.w.handle())).collect();
    if dialect == Dialect::Standard {
        let layers =
            LAYERS.map(|name| FileLayer { name: name.to_owned(), colour: 7, dashed: false });
        head(&mut file.w, sheet.size, sheet.unit, &layers, &blocks);
    } else {
        file.section("HEADER");
        file.w.tag(0, "ENDSEC");
    }
    file.section("BLOCKS");
    if dialect == Dialect::Standard {
        layouts(&mut file.w);
    }
    for (placed, (name, record)) in sheet.pieces.iter().zip(&blocks) {
        file.w.owner = *record;
        begin_block(&mut file.w, "1", name);
        file.piece(placed);
        end_block(&mut file.w, "1");
    }
    file.w.tag(0, "ENDSEC");
    file.section("ENTITIES");
    file.w.owner = super::skeleton::MODEL;
    file.style();
    for name in &names {
        file.w.entity("INSERT", "1");
        file.w.subclass("AcDbBlockReference");
        file.w.tag(2, name);
        file.w.point_at(10, DVec2::ZERO);
    }
    file.w.tag(0, "ENDSEC");
    match dialect {
        Dialect::Standard => tail(&mut file.w),
        Dialect::Gerber => file.w.tag(0, "EOF"),
    }
    file.changed.sort();
    file.changed.dedup();
    (file.w.text, file.changed)
}

struct File<'a> {
    sheet: &'a Sheet<'a>,
    w: Writer,
    changed: Vec<[String; 2]>,
}

impl<'a> File<'a> {
    fn new(sheet: &'a Sheet<'a>, dialect: Dialect) -> Self {
        let release = match dialect {
            Dialect::Standard => Release::R13,
            Dialect::Gerber => Release::R12,
        };
        let mm_per_unit = if sheet.unit == SheetUnit::Millimetre { 1.0 } else { 25.4 };
        Self { sheet, w: Writer::new(release, mm_per_unit), changed: Vec::new() }
    }

    fn section(&mut self, name: &str) {
        self.w.tag(0, "SECTION");
        self.w.tag(2, name);
    }

    /// A text in 7 bits; that it was changed is remembered.
    fn seven_bits(&mut self, text: &str) -> String {
        let plain = ascii(text);
        if plain != text {
            self.changed.push([text.to_owned(), plain.clone()]);
        }
        plain
    }

    /// A name in 7 bits, cut to what readers take.
    fn short(&mut self, text: &str) -> String {
        let plain: String = ascii(text).trim().chars().take(LONGEST_NAME).collect();
        let plain = plain.trim_end().to_owned();
        if plain != text {
            self.changed.push([text.to_owned(), plain.clone()]);
        }
        plain
    }

    /// Names of the blocks: capitals, figures and low lines, each once.
    fn names(&mut self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for placed in &self.sheet.pieces {
            let plain = self.short(&placed.piece.name).to_ascii_uppercase();
            let keep = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
            let plain: String = plain.chars().map(keep).collect();
            let plain = if plain.is_empty() { "PIECE".to_owned() } else { plain };
            let mut name = plain.clone();
            let mut number = 2;
            while names.contains(&name) {
                let ending = format!("_{number}");
                let kept: String = plain.chars().take(LONGEST_NAME - ending.len()).collect();
                name = kept + &ending;
                number += 1;
            }
            names.push(name);
        }
        names
    }

    /// What holds for the whole file.
    fn style(&mut self) {
        let heading = &self.sheet.heading;
        let name = self.short(&heading.name);
        let mut lines = vec![format!("Style Name: {name}")];
        if !heading.date.is_empty() {
            let date = self.seven_bits(&heading.date);
            lines.push(format!("Creation Date: {date}"));
        }
        lines.push(format!("Author: wovenfit;wovenfit;{}", env!("CARGO_PKG_VERSION")));
        lines.push("Sample Size: ONE".to_owned());
        lines.push("Grade Rule Table: NONE".to_owned());
        let unit = self.sheet.unit;
        let units = if unit == SheetUnit::Millimetre { "METRIC" } else { "ENGLISH" };
        lines.push(format!("Units: {units}"));
        lines.push(format!("Curve Tolerance: {:.4}", unit.from_mm(TOLERANCE)));
        lines.push("ASTM/D13Proposal 1 Version: D 6673-04".to_owned());
        for (i, line) in lines.iter().enumerate() {
            self.w.words("1", DVec2::new(0.0, 1.5 * TEXT * i as f64), TEXT, 0.0, line);
        }
    }

    fn piece(&mut self, placed: &Placed<'_>) {
        let piece = placed.piece;
        let (low, high) = piece.bounds();
        let middle = placed.offset + 0.5 * (low + high);
        let name = self.short(&piece.name);
        let material = self.seven_bits(&piece.material);
        let lines = [
            format!("Piece Name: {name}"),
            format!("Quantity: {},0", piece.quantity),
            format!("Material: {material}"),
        ];
        for (i, line) in lines.iter().enumerate() {
            let at = middle - DVec2::new(0.0, 1.5 * TEXT * i as f64);
            self.w.words("1", at, TEXT, 0.0, line);
        }
        let reference = &self.sheet.heading.reference;
        if !reference.is_empty() {
            let reference = self.seven_bits(reference);
            let at = middle - DVec2::new(0.0, 4.5 * TEXT);
            self.w.words("15", at, TEXT, 0.0, &format!("Reference: {reference}"));
        }
        // Without allowance the sew line is the boundary: once is enough.
        let inner = piece.edges.iter().flatten().any(|edge| edge.allowance > 0.0);
        for item in &placed.items {
            match (&item.shape, item.layer) {
                (Shape::Line { points, closed }, Layer::Cut) => {
                    self.line(["1", "84"], points, *closed);
                }
                (Shape::Line { points, closed }, Layer::CutOut) => {
                    self.line(["11", "86"], points, *closed);
                }
                (Shape::Line { points, closed }, Layer::Sew) if inner => {
                    self.line(["14", "87"], points, *closed);
                }
                // The arrow's shaft alone: readers draw heads of their own.
                (Shape::Line { points, .. }, Layer::Grain) if points.len() == 2 => {
                    self.w.line("7", points, false);
                }
                (Shape::Line { points, closed }, Layer::Stretch) => {
                    self.line(["8", "85"], points, *closed);
                }
                (Shape::Words { at, size, angle, text, .. }, Layer::Text) => {
                    let text = ascii(text);
                    self.w.centred("15", *at, 0.72 * size, *angle, &text);
                }
                _ => {}
            }
        }
        for notch in &placed.notches {
            if notch.slit {
                self.notch(notch.at, notch.end);
            } else {
                // Drawn, not cut: without allowance a slit would go through the seam.
                self.line(["8", "85"], &[notch.at, notch.end], false);
            }
        }
        for mark in &piece.marks {
            if mark.kind == MarkKind::Pressure {
                self.w.entity("POINT", "13");
                self.w.subclass("AcDbPoint");
                self.w.point_at(10, placed.offset + mark.at);
            }
        }
    }

    /// A slit: where it begins, how deep it is (the point's thickness) and which way it goes.
    fn notch(&mut self, at: DVec2, end: DVec2) {
        let way = end - at;
        self.w.entity("POINT", "4");
        self.w.subclass("AcDbPoint");
        self.w.point_at(10, at);
        self.w.length(39, way.length());
        self.w.number(50, way.y.atan2(way.x).to_degrees().rem_euclid(360.0));
    }

    /// A line with its copy for checks, and its points by kind.
    fn line(&mut self, [layer, copy]: [&str; 2], points: &[DVec2], closed: bool) {
        self.w.polyline(layer, points, closed);
        self.w.polyline(copy, points, closed);
        let count = points.len();
        let sharp = TURN.to_radians().cos();
        for (i, p) in points.iter().enumerate() {
            let end = !closed && (i == 0 || i + 1 == count);
            let before = *p - points[(i + count - 1) % count];
            let after = points[(i + 1) % count] - *p;
            let turns = before.normalize_or_zero().dot(after.normalize_or_zero()) < sharp;
            self.w.entity("POINT", if end || turns { "2" } else { "3" });
            self.w.subclass("AcDbPoint");
            self.w.point_at(10, *p);
        }
    }
}
