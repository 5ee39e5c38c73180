//! The files of a result: which there are, what they are called, and their contents.

use crate::design::{Design, Limits};
use crate::export::dxf::{Dialect, pattern_astm, pattern_dxf};
use crate::export::pdf::{Paper, pattern_pdf};
use crate::export::{flat_obj, pattern_hpgl, pattern_png, pattern_svg, worn_obj};
use crate::page::{PageInput, report_html};
use crate::pipeline::Flattening;
use crate::report::{Workshop, WorkshopInput, girth_pairs, workshop};
use crate::sheet::{Heading, Sheet, SheetUnit, sheet};

/// A file that every result is written as. The pattern has more: [`PatternFormat`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultFile {
    /// The cut surface with the pattern as texture coordinates, in mm.
    WornObj,
    /// The pattern as a flat mesh, in mm.
    FlatObj,
    /// The pattern at true size.
    PatternSvg,
    /// Every figure.
    ReportJson,
    /// The page that is read first.
    ReportHtml,
}

impl ResultFile {
    /// Every file, in the order in which they are listed.
    pub const ALL: [Self; 5] =
        [Self::WornObj, Self::FlatObj, Self::PatternSvg, Self::ReportJson, Self::ReportHtml];

    /// What the file is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::WornObj => "worn.obj",
            Self::FlatObj => "flat.obj",
            Self::PatternSvg => "pattern.svg",
            Self::ReportJson => "report.json",
            Self::ReportHtml => "report.html",
        }
    }
}

/// A format of the pattern: what a workshop's machines read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PatternFormat {
    /// SVG.
    Svg,
    /// One PDF page at full size, and the workshop sheet.
    Pdf,
    /// PDF in tiles of A4.
    PdfA4,
    /// PDF in tiles of US Letter.
    PdfLetter,
    /// DXF R2000.
    Dxf,
    /// DXF by ASTM D6673 (AAMA), R13.
    DxfAstm,
    /// The same for Gerber's reader, R12.
    DxfGerber,
    /// HPGL for plotters and cutters.
    Hpgl,
    /// A picture to look at.
    Png,
}

impl PatternFormat {
    /// Every format, in the order in which they are listed.
    pub const ALL: [Self; 9] = [
        Self::Svg,
        Self::Pdf,
        Self::PdfA4,
        Self::PdfLetter,
        Self::Dxf,
        Self::DxfAstm,
        Self::DxfGerber,
        Self::Hpgl,
        Self::Png,
    ];

    /// The formats that are written unless others are chosen.
    pub const USUAL: [Self; 1] = [Self::Svg];

    /// Its short name, for options and menus.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Pdf => "pdf",
            Self::PdfA4 => "pdf-a4",
            Self::PdfLetter => "pdf-letter",
            Self::Dxf => "dxf",
            Self::DxfAstm => "dxf-astm",
            Self::DxfGerber => "dxf-gerber",
            Self::Hpgl => "hpgl",
            Self::Png => "png",
        }
    }

    /// The format of a short name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// What its file is called.
    #[must_use]
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Svg => "pattern.svg",
            Self::Pdf => "pattern.pdf",
            Self::PdfA4 => "pattern-a4.pdf",
            Self::PdfLetter => "pattern-letter.pdf",
            Self::Dxf => "pattern.dxf",
            Self::DxfAstm => "pattern-astm.dxf",
            Self::DxfGerber => "pattern-gerber.dxf",
            Self::Hpgl => "pattern.plt",
            Self::Png => "pattern.png",
        }
    }

    /// What it is for, in one line.
    #[must_use]
    pub fn summary(self) -> &'static str {
        match self {
            Self::Svg => "true size, layers as groups; for laser cutters and drawing programs",
            Self::Pdf => "one page at full size for a plotter, and the workshop sheet",
            Self::PdfA4 => "tiles of A4 with marks to join them, and the workshop sheet",
            Self::PdfLetter => "tiles of US Letter with marks to join them, and the workshop sheet",
            Self::Dxf => "DXF R2000 with units and layers; for CAD, lasers and knives",
            Self::DxfAstm => "DXF by ASTM D6673 (AAMA), R13; for apparel CAD",
            Self::DxfGerber => "the same as R12 without tables; for Gerber AccuMark",
            Self::Hpgl => "HPGL, 40 steps to the millimetre; for plotters and cutters",
            Self::Png => "a picture to look at, not to cut from",
        }
    }
}

/// A file of the pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatternFile {
    /// Its contents.
    pub bytes: Vec<u8>,
    /// Texts that the format cannot hold, with what is written instead; for people.
    pub notes: Vec<String>,
}

impl Flattening {
    /// The text of a file of this result, which was computed for `design`.
    #[must_use]
    pub fn file(&self, file: ResultFile, design: &Design) -> String {
        match file {
            ResultFile::WornObj => worn_obj(self.disk(), &self.coordinates),
            ResultFile::FlatObj => flat_obj(self.disk(), &self.coordinates),
            ResultFile::PatternSvg => pattern_svg(&self.sheet(SheetUnit::Millimetre)),
            ResultFile::ReportJson => self.report.to_json(),
            ResultFile::ReportHtml => report_html(&PageInput {
                disk: self.disk(),
                coordinates: &self.coordinates,
                drawing: &self.drawing,
                report: &self.report,
                girths: &self.girths,
                warp_strain: &self.field.warp_strain,
                pressure_kpa: Some(&self.field.pressure_kpa),
                limit_kpa: design.limits.max_kpa.unwrap_or(Limits::WARN_KPA),
                workshop: Some(&self.workshop(SheetUnit::Millimetre, design)),
            }),
        }
    }

    /// The pattern of this result, which was computed for `design`, in a format. SVG and DXF are in
    /// `unit`; the others have a unit of their own and say lengths in it.
    #[must_use]
    pub fn pattern(&self, format: PatternFormat, unit: SheetUnit, design: &Design) -> PatternFile {
        let sheet = self.sheet(unit);
        let plain = |text: String| (text.into_bytes(), Vec::new());
        let pdf = |paper| pattern_pdf(&sheet, &self.workshop(unit, design), paper);
        let astm = |dialect| {
            let (text, changed) = pattern_astm(&sheet, dialect);
            (text.into_bytes(), changed)
        };
        let (bytes, changed) = match format {
            PatternFormat::Svg => plain(pattern_svg(&sheet)),
            PatternFormat::Pdf => pdf(Paper::Whole),
            PatternFormat::PdfA4 => pdf(Paper::A4),
            PatternFormat::PdfLetter => pdf(Paper::Letter),
            PatternFormat::Dxf => plain(pattern_dxf(&sheet)),
            PatternFormat::DxfAstm => astm(Dialect::Standard),
            PatternFormat::DxfGerber => astm(Dialect::Gerber),
            PatternFormat::Hpgl => plain(pattern_hpgl(&sheet)),
            PatternFormat::Png => (pattern_png(&sheet), Vec::new()),
        };
        let file = format.file_name();
        let notes = told_once(&changed).into_iter().map(|[asked, written]| {
            format!("{file} cannot hold \u{201c}{asked}\u{201d}: it says \u{201c}{written}\u{201d}")
        });
        PatternFile { bytes, notes: notes.collect() }
    }

    /// The pieces on a sheet with words in a unit.
    #[must_use]
    pub fn sheet(&self, unit: SheetUnit) -> Sheet<'_> {
        let piece = &self.report.piece;
        let name = match piece.name.trim() {
            "" => "brace",
            name => name,
        };
        let heading = Heading {
            name: name.to_owned(),
            reference: piece.reference.trim().to_owned(),
            date: piece.date.trim().to_owned(),
        };
        sheet(&self.pieces, heading, unit)
    }

    /// What goes to the workshop with the pattern.
    #[must_use]
    pub fn workshop(&self, unit: SheetUnit, design: &Design) -> Workshop {
        workshop(&WorkshopInput {
            report: &self.report,
            pieces: &self.pieces,
            girths: &girth_pairs(self.disk(), &self.coordinates, &self.girths),
            field: &self.field,
            coordinates: &self.coordinates,
            design_sha256: design.sha256(),
            unit,
        })
    }
}

/// What was written otherwise, without the lines that only repeat a name in them.
fn told_once(changed: &[[String; 2]]) -> Vec<&[String; 2]> {
    let repeats = |asked: &str| {
        changed.iter().any(|[other, _]| other.len() < asked.len() && asked.contains(other.as_str()))
    };
    changed.iter().filter(|[asked, _]| !repeats(asked)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_a_format_cannot_hold_is_told_once() {
        let pair = |asked: &str| [asked.to_owned(), asked.replace('手', "?")];
        let changed =
            [pair("手: page 1 of 2"), pair("手"), pair("job 手手"), pair("手: page 2 of 2")];
        assert_eq!(told_once(&changed), [&pair("手")]);
        let apart = [pair("brace 手"), pair("material 手"), pair("brace 手, page 1")];
        assert_eq!(told_once(&apart), [&apart[0], &apart[1]]);
    }
}
