//! The report: every figure of a run as data, and the few of them that a terminal shows.

mod check;
mod compose;
#[cfg(test)]
mod example;
mod field;
mod girth;
mod json;
mod table;
mod workshop;

pub use check::{CheckReport, CurvatureReport, Defect, LoopReport};
pub(crate) use compose::compose;
pub use field::{FieldReport, PressureRow};
pub use girth::{GirthPair, girth_pairs};
pub use json::{
    ENERGY_UNIT, FitReport, GirthReport, HistoryEntry, ParameterValues, PatternReport,
    PressureReport, Reason, Report, SeamReport, StrainDatum, StrainFunctionReport, StrainRow,
    SurfaceReport,
};
pub use table::pressure_table;
pub use workshop::{Section, Workshop, WorkshopInput, workshop};
