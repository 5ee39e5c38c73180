//! Pressure and strain: the formulas, both ways, and the wanted strain of every thread.

mod formula;
mod judgement;
#[cfg(test)]
mod judgement_tests;
mod reached;
mod strain_function;
mod targets;
mod woven;

pub use formula::{
    FLAT_CURVATURE, LocalCurvature, Stretch, Wish, pressing_curvature, pressure_kpa, warp_strain,
};
pub use judgement::{Brace, Judgement, Reason, judge};
pub use reached::{Reached, Reader, TriangleStretch, triangle_stretch};
pub use strain_function::{Datum, StrainCourse, StrainForm, StrainFunction};
pub use targets::{Annotation, Targets, ThreadTarget};
pub use woven::{TargetError, Woven, WovenTargets, target_strains};
