//! Pressure and strain: the formulas, both ways, and the wanted strain of every thread.

mod formula;
mod judgement;
#[cfg(test)]
mod judgement_tests;
mod reached;
mod strain_function;
mod targets;

pub use formula::{
    FLAT_CURVATURE, LocalCurvature, Stretch, Wish, pressing_curvature, pressure_kpa, warp_strain,
};
pub use judgement::{Brace, Judgement, Reason, judge};
pub use reached::{Along, Patch, TriangleStretch, patch, thread_strain, triangle_stretch};
pub use strain_function::{Datum, StrainForm, StrainFunction};
pub use targets::{Annotation, TargetError, Targets, ThreadTarget, target_strains};
