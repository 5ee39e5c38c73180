//! What stands in a DXF of R13 and later beside the drawing: header, tables, layouts, dictionary.

use glam::DVec2;

use super::writer::{Release, Writer};
use crate::sheet::SheetUnit;

/// A layer of the file: its name, its colour by AutoCAD's number, its line type.
pub(super) struct FileLayer {
    pub(super) name: String,
    pub(super) colour: i64,
    pub(super) dashed: bool,
}

/// Handles of the tables and of what is named from elsewhere.
const BLOCK_RECORDS: u32 = 0x08;
/// The block record of the drawing.
pub(super) const MODEL: u32 = 0x1f;
const PAPER: u32 = 0x1e;
const ROOT: u32 = 0x0c;
const GROUPS: u32 = 0x0d;

/// Header and tables; `blocks` are the names and handles of further block records.
pub(super) fn head(
    w: &mut Writer,
    size: DVec2,
    unit: SheetUnit,
    layers: &[FileLayer],
    blocks: &[(String, u32)],
) {
    w.tag(0, "SECTION");
    w.tag(2, "HEADER");
    w.tag(9, "$ACADVER");
    w.tag(1, if w.release == Release::R2000 { "AC1015" } else { "AC1012" });
    w.tag(9, "$DWGCODEPAGE");
    w.tag(3, "ANSI_1252");
    w.tag(9, "$EXTMIN");
    w.point_at(10, DVec2::ZERO);
    w.tag(9, "$EXTMAX");
    w.point_at(10, size);
    if w.release == Release::R2000 {
        w.tag(9, "$INSUNITS");
        w.whole(70, if unit == SheetUnit::Millimetre { 4 } else { 1 });
    }
    w.tag(9, "$MEASUREMENT");
    w.whole(70, i64::from(unit == SheetUnit::Millimetre));
    w.tag(9, "$HANDSEED");
    // Above every handle that is given.
    w.tag(5, "FFFFFF");
    w.tag(0, "ENDSEC");
    if w.release == Release::R2000 {
        w.tag(0, "SECTION");
        w.tag(2, "CLASSES");
        w.tag(0, "ENDSEC");
    }
    tables(w, size, layers, blocks);
}

fn tables(w: &mut Writer, size: DVec2, layers: &[FileLayer], blocks: &[(String, u32)]) {
    w.tag(0, "SECTION");
    w.tag(2, "TABLES");
    table(w, "VPORT", 0x01, 1);
    record(w, "VPORT", 0x20, 0x01, "AcDbViewportTableRecord", "*ACTIVE");
    for (code, value) in [(10, DVec2::ZERO), (11, DVec2::ONE)] {
        w.number(code, value.x);
        w.number(code + 10, value.y);
    }
    w.length(12, 0.5 * size.x);
    w.length(22, 0.5 * size.y);
    w.length(40, size.y);
    w.number(41, size.x / size.y);
    w.tag(0, "ENDTAB");

    table(w, "LTYPE", 0x02, 4);
    for (handle, name, dashes) in [
        (0x21, "ByBlock", &[][..]),
        (0x22, "ByLayer", &[]),
        (0x23, "Continuous", &[]),
        (0x24, "DASHED", &[4.0, -4.0]),
    ] {
        record(w, "LTYPE", handle, 0x02, "AcDbLinetypeTableRecord", name);
        w.tag(3, "");
        w.whole(72, 65);
        w.whole(73, dashes.len() as i64);
        w.length(40, dashes.iter().map(|dash: &f64| dash.abs()).sum());
        for dash in dashes {
            w.length(49, *dash);
            w.whole(74, 0);
        }
    }
    w.tag(0, "ENDTAB");

    table(w, "LAYER", 0x03, layers.len() + 1);
    let zero = FileLayer { name: "0".to_owned(), colour: 7, dashed: false };
    for (i, layer) in [&zero].into_iter().chain(layers).enumerate() {
        record(w, "LAYER", 0x30 + i as u32, 0x03, "AcDbLayerTableRecord", &layer.name);
        w.whole(62, layer.colour);
        w.tag(6, if layer.dashed { "DASHED" } else { "Continuous" });
    }
    w.tag(0, "ENDTAB");

    table(w, "STYLE", 0x04, 1);
    record(w, "STYLE", 0x25, 0x04, "AcDbTextStyleTableRecord", "Standard");
    for (code, value) in [(40, 0.0), (41, 1.0), (50, 0.0)] {
        w.number(code, value);
    }
    w.whole(71, 0);
    w.length(42, 3.5);
    w.tag(3, "txt");
    w.tag(4, "");
    w.tag(0, "ENDTAB");

    for (name, handle) in [("VIEW", 0x05), ("UCS", 0x06)] {
        table(w, name, handle, 0);
        w.tag(0, "ENDTAB");
    }
    table(w, "APPID", 0x07, 1);
    record(w, "APPID", 0x26, 0x07, "AcDbRegAppTableRecord", "ACAD");
    w.tag(0, "ENDTAB");

    table(w, "DIMSTYLE", 0x09, 1);
    if w.release == Release::R2000 {
        w.tag(100, "AcDbDimStyleTable");
    }
    w.tag(0, "DIMSTYLE");
    // A dimension style's handle has a code of its own.
    w.hexadecimal(105, 0x27);
    if w.release == Release::R2000 {
        w.hexadecimal(330, 0x09);
    }
    w.tag(100, "AcDbSymbolTableRecord");
    w.tag(100, "AcDbDimStyleTableRecord");
    w.tag(2, "Standard");
    w.whole(70, 0);
    w.tag(0, "ENDTAB");

    table(w, "BLOCK_RECORD", BLOCK_RECORDS, 2 + blocks.len());
    let own = [("*Model_Space".to_owned(), MODEL), ("*Paper_Space".to_owned(), PAPER)];
    for (name, handle) in own.iter().chain(blocks) {
        w.tag(0, "BLOCK_RECORD");
        w.hexadecimal(5, *handle);
        if w.release == Release::R2000 {
            w.hexadecimal(330, BLOCK_RECORDS);
        }
        w.tag(100, "AcDbSymbolTableRecord");
        w.tag(100, "AcDbBlockTableRecord");
        w.tag(2, name);
    }
    w.tag(0, "ENDTAB");
    w.tag(0, "ENDSEC");
}

fn table(w: &mut Writer, name: &str, handle: u32, entries: usize) {
    w.tag(0, "TABLE");
    w.tag(2, name);
    w.hexadecimal(5, handle);
    if w.release == Release::R2000 {
        w.hexadecimal(330, 0);
    }
    w.tag(100, "AcDbSymbolTable");
    w.whole(70, entries as i64);
}

fn record(w: &mut Writer, kind: &str, handle: u32, owner: u32, subclass: &str, name: &str) {
    w.tag(0, kind);
    w.hexadecimal(5, handle);
    if w.release == Release::R2000 {
        w.hexadecimal(330, owner);
    }
    w.tag(100, "AcDbSymbolTableRecord");
    w.tag(100, subclass);
    w.tag(2, name);
    w.whole(70, 0);
}

/// The blocks that every drawing has.
pub(super) fn layouts(w: &mut Writer) {
    for (name, owner) in [("*Model_Space", MODEL), ("*Paper_Space", PAPER)] {
        w.owner = owner;
        begin_block(w, "0", name);
        end_block(w, "0");
    }
    w.owner = MODEL;
}

pub(super) fn begin_block(w: &mut Writer, layer: &str, name: &str) {
    w.entity("BLOCK", layer);
    w.subclass("AcDbBlockBegin");
    w.tag(2, name);
    w.whole(70, 0);
    w.point_at(10, DVec2::ZERO);
    w.tag(3, name);
    if w.modern() {
        w.tag(1, "");
    }
}

pub(super) fn end_block(w: &mut Writer, layer: &str) {
    w.entity("ENDBLK", layer);
    w.subclass("AcDbBlockEnd");
}

/// The dictionary, and the end of the file.
pub(super) fn tail(w: &mut Writer) {
    w.tag(0, "SECTION");
    w.tag(2, "OBJECTS");
    for (handle, owner, entries) in [(ROOT, 0, &[("ACAD_GROUP", GROUPS)][..]), (GROUPS, ROOT, &[])]
    {
        w.tag(0, "DICTIONARY");
        w.hexadecimal(5, handle);
        w.hexadecimal(330, owner);
        w.tag(100, "AcDbDictionary");
        if w.release == Release::R2000 {
            w.whole(281, 1);
        }
        for (name, entry) in entries {
            w.tag(3, name);
            w.hexadecimal(350, *entry);
        }
    }
    w.tag(0, "ENDSEC");
    w.tag(0, "EOF");
}
