//! What a surface is and what is wrong with it.

use wovenfit_core::check_for;
use wovenfit_core::report::CheckReport;

use crate::ffi::Defect;
use crate::guard::{Failure, guarded_in_pool};
use crate::input::Input;

/// What a check found.
pub struct Check(CheckReport);

/// Checks a mesh as a job would take it. A mesh with defects is no failure: they are in the check.
pub(crate) fn check_surface(input: &Input) -> Result<Box<Check>, Failure> {
    guarded_in_pool(|| {
        let Input { parameters, design, raw, .. } = input;
        Ok(Box::new(Check(check_for(raw, design, parameters))))
    })
}

impl Check {
    /// The report for people.
    pub(crate) fn text(&self) -> String {
        self.0.to_text()
    }

    /// What stops flattening.
    pub(crate) fn defects(&self) -> Vec<Defect> {
        // What a triangle names has 32 bits.
        let narrow = |indices: &[usize]| indices.iter().map(|&i| i as u32).collect();
        let defect = |defect: &wovenfit_core::report::Defect| Defect {
            vertices: narrow(&defect.vertices),
            triangles: narrow(&defect.faces),
        };
        self.0.defects.iter().map(defect).collect()
    }

    /// How many warnings there are.
    pub(crate) fn warning_count(&self) -> usize {
        self.0.warnings.len()
    }
}
