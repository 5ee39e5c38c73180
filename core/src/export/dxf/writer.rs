//! Entities as group codes.

use glam::DVec2;

use crate::export::number::fixed;

/// Decimals of numbers: a ten-thousandth of a millimetre or of an inch.
const DECIMALS: usize = 4;

/// The releases of DXF that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Release {
    /// No handles, no subclasses, no owner.
    R12,
    /// No lightweight polylines.
    R13,
    /// R2000.
    R2000,
}

/// A DXF file being written.
pub(super) struct Writer {
    pub(super) text: String,
    pub(super) release: Release,
    /// The next free handle.
    handle: u32,
    /// Millimetres in a unit of the file.
    mm_per_unit: f64,
    /// The handle of the block record that entities belong to.
    pub(super) owner: u32,
}

impl Writer {
    pub(super) fn new(release: Release, mm_per_unit: f64) -> Self {
        // Below stand the handles of the tables.
        Self { text: String::new(), release, handle: 0x100, mm_per_unit, owner: 0 }
    }

    pub(super) fn tag(&mut self, code: u16, value: impl AsRef<str>) {
        self.text.push_str(&format!("{code:>3}\n{}\n", value.as_ref()));
    }

    pub(super) fn whole(&mut self, code: u16, value: impl Into<i64>) {
        self.tag(code, value.into().to_string());
    }

    /// A number that is no length.
    pub(super) fn number(&mut self, code: u16, value: f64) {
        self.tag(code, fixed(value, DECIMALS));
    }

    /// A length in mm in the unit of the file.
    pub(super) fn length(&mut self, code: u16, mm: f64) {
        self.number(code, mm / self.mm_per_unit);
    }

    /// A point in mm in the unit of the file, by the code of its x.
    pub(super) fn point_at(&mut self, code: u16, p: DVec2) {
        self.length(code, p.x);
        self.length(code + 10, p.y);
        self.number(code + 20, 0.0);
    }

    pub(super) fn hexadecimal(&mut self, code: u16, handle: u32) {
        self.tag(code, format!("{handle:X}"));
    }

    pub(super) fn handle(&mut self) -> u32 {
        self.handle += 1;
        self.handle - 1
    }

    pub(super) fn modern(&self) -> bool {
        self.release != Release::R12
    }

    /// The beginning of an entity on a layer; gives its handle.
    pub(super) fn entity(&mut self, kind: &str, layer: &str) -> u32 {
        let owner = self.owner;
        self.entity_of(kind, layer, owner)
    }

    fn entity_of(&mut self, kind: &str, layer: &str, owner: u32) -> u32 {
        self.tag(0, kind);
        let handle = self.handle();
        if self.modern() {
            self.hexadecimal(5, handle);
            if self.release == Release::R2000 {
                self.hexadecimal(330, owner);
            }
            self.tag(100, "AcDbEntity");
        }
        self.tag(8, layer);
        handle
    }

    pub(super) fn subclass(&mut self, name: &str) {
        if self.modern() {
            self.tag(100, name);
        }
    }

    /// A line through points; what has but two and is open is a LINE.
    pub(super) fn line(&mut self, layer: &str, points: &[DVec2], closed: bool) {
        match points {
            [] | [_] => {}
            [a, b] if !closed => {
                self.entity("LINE", layer);
                self.subclass("AcDbLine");
                self.point_at(10, *a);
                self.point_at(11, *b);
            }
            _ => self.polyline(layer, points, closed),
        }
    }

    /// A polyline, lightweight where the release has them.
    pub(super) fn polyline(&mut self, layer: &str, points: &[DVec2], closed: bool) {
        let flag = i64::from(closed);
        if self.release == Release::R2000 {
            self.entity("LWPOLYLINE", layer);
            self.subclass("AcDbPolyline");
            self.whole(90, points.len() as i64);
            self.whole(70, flag);
            for p in points {
                self.length(10, p.x);
                self.length(20, p.y);
            }
            return;
        }
        let handle = self.entity("POLYLINE", layer);
        self.subclass("AcDb2dPolyline");
        self.whole(66, 1);
        self.point_at(10, DVec2::ZERO);
        self.whole(70, flag);
        for p in points {
            self.entity_of("VERTEX", layer, handle);
            self.subclass("AcDbVertex");
            self.subclass("AcDb2dVertex");
            self.point_at(10, *p);
        }
        self.entity_of("SEQEND", layer, handle);
    }

    pub(super) fn circle(&mut self, layer: &str, centre: DVec2, radius: f64) {
        self.entity("CIRCLE", layer);
        self.subclass("AcDbCircle");
        self.point_at(10, centre);
        self.length(40, radius);
    }

    /// Words that begin at a point, on their base line.
    pub(super) fn words(&mut self, layer: &str, at: DVec2, size: f64, angle: f64, text: &str) {
        self.entity("TEXT", layer);
        self.subclass("AcDbText");
        self.point_at(10, at);
        self.length(40, size);
        self.tag(1, text);
        if angle != 0.0 {
            self.number(50, angle);
        }
        self.subclass("AcDbText");
    }

    /// Words about their middle.
    pub(super) fn centred(&mut self, layer: &str, at: DVec2, size: f64, angle: f64, text: &str) {
        self.entity("TEXT", layer);
        self.subclass("AcDbText");
        self.point_at(10, at);
        self.length(40, size);
        self.tag(1, text);
        if angle != 0.0 {
            self.number(50, angle);
        }
        // Centred both ways about the second point.
        self.whole(72, 1);
        self.point_at(11, at);
        self.subclass("AcDbText");
        self.whole(73, 2);
    }
}
