//! The files of a result: which there are, what they are called, and their contents.

use crate::design::{Design, Limits};
use crate::export::{flat_obj, pattern_svg, worn_obj};
use crate::page::{PageInput, report_html};
use crate::pipeline::Flattening;

/// A file that a result is written as.
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

impl Flattening {
    /// The text of a file of this result, which was computed for `design`.
    #[must_use]
    pub fn file(&self, file: ResultFile, design: &Design) -> String {
        match file {
            ResultFile::WornObj => worn_obj(self.disk(), &self.coordinates),
            ResultFile::FlatObj => flat_obj(self.disk(), &self.coordinates),
            ResultFile::PatternSvg => pattern_svg(&self.drawing),
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
            }),
        }
    }
}
