//! The result of a job: figures, the table of pressures, warnings. Its arrays and texts are beside.

mod arrays;
mod texts;

use std::ffi::c_char;
use std::sync::{Arc, OnceLock};

use wovenfit_core::Flattening;
use wovenfit_core::design::Design as Wishes;

pub use arrays::{
    ResultDoubles, ResultIndices, WOVENFIT_NONE, wovenfit_result_doubles, wovenfit_result_indices,
};
pub use texts::{ResultText, wovenfit_result_text};

use crate::check::{element, note, place, warning};
use crate::failure::Error;
use crate::formats::Patterns;
use crate::guard::{Out, borrow, free, guard};
use crate::prepared::{Prepared, Ready};
use crate::status::Status;
use arrays::Ways;
use texts::Texts;

/// A flattened brace. It never changes: any number of threads may use it at once.
pub struct FitResult(pub(crate) Arc<Computed>);

/// What a result holds.
pub(crate) struct Computed {
    pub(crate) ready: Arc<Ready>,
    pub(crate) flattening: Flattening,
    pub(crate) wishes: Wishes,
    /// Asked for twice, for the size and for the contents, and made once.
    texts: Texts,
    pub(crate) patterns: Patterns,
    ways: OnceLock<Ways>,
}

impl Computed {
    pub(crate) fn new(ready: Arc<Ready>, flattening: Flattening, wishes: Wishes) -> Self {
        Self {
            ready,
            flattening,
            wishes,
            texts: Texts::default(),
            patterns: Patterns::default(),
            ways: OnceLock::new(),
        }
    }
}

/// The figures of a result.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResultFigures {
    /// Extent of the pattern along warp, in mm.
    pub width_mm: f64,
    /// Extent of the pattern along weft, in mm.
    pub height_mm: f64,
    /// Area of the pattern, in mm2.
    pub area_mm2: f64,
    /// Energy of the fit, in N mm.
    pub energy: f64,
    /// Radius over which curvature was read, in mm: the scale at which pressure is stated.
    pub curvature_radius_mm: f64,
    /// Steps of the fit.
    pub steps: u64,
    /// 1 if the fit has converged, else 0.
    pub converged: u32,
    /// Triangles of the pattern that lie upside down.
    pub flipped: u32,
    /// Places where the pattern's edge crosses itself.
    pub overlaps: u32,
    /// Wanted pressures.
    pub pressures: u32,
    /// Warnings.
    pub warnings: u32,
    /// 0.
    pub reserved: u32,
}

/// A row of the table of pressures. NaN stands for what is not known.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResultPressure {
    /// Where it is wanted, in mm.
    pub at: [f64; 3],
    /// Wanted, in kPa.
    pub asked_kpa: f64,
    /// Computed with the tension equal along the thread, in kPa.
    pub got_kpa: f64,
    /// Computed from the fabric's strain near the point alone, in kPa.
    pub got_local_kpa: f64,
    /// Mean curvature per metre, outward positive.
    pub mean_curvature_per_m: f64,
    /// Curvature along warp per metre.
    pub warp_curvature_per_m: f64,
    /// Curvature along weft per metre.
    pub weft_curvature_per_m: f64,
    /// Strain along warp.
    pub warp_strain: f64,
    /// Strain along weft.
    pub weft_strain: f64,
    /// Least pressure that strains from zero to the fabric's limit give here, in kPa.
    pub reachable_least_kpa: f64,
    /// Largest such pressure, in kPa.
    pub reachable_most_kpa: f64,
    /// 1 if it is met; 0 if it is missed, and then there is a reason.
    pub met: u32,
    /// 0.
    pub reserved: u32,
}

/// The figures of a result.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_figures(
    result: *const FitResult,
    figures: *mut ResultFigures,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let report = &borrow(result, "result")?.0.flattening.report;
            let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
            Out::new(figures, "figures")?.put(ResultFigures {
                width_mm: report.pattern.width_mm,
                height_mm: report.pattern.height_mm,
                area_mm2: report.pattern.area_mm2,
                energy: report.fit.energy,
                curvature_radius_mm: report.curvature_radius_mm,
                steps: report.fit.iterations,
                converged: report.fit.converged.into(),
                flipped: count(report.pattern.flipped),
                overlaps: count(report.pattern.overlaps),
                pressures: count(report.pressures.len()),
                warnings: count(report.warnings.len()),
                reserved: 0,
            })
        })
    }
}

/// A row of the table of pressures; `index` counts from 0 in the order of the design.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_pressure(
    result: *const FitResult,
    index: usize,
    pressure: *mut ResultPressure,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let report = &borrow(result, "result")?.0.flattening.report;
            let row = element(&report.pressures, index, "pressure")?;
            let known = |value: Option<f64>| value.unwrap_or(f64::NAN);
            Out::new(pressure, "pressure")?.put(ResultPressure {
                at: row.at,
                asked_kpa: row.asked_kpa,
                got_kpa: known(row.got_kpa),
                got_local_kpa: known(row.got_local_kpa),
                mean_curvature_per_m: row.mean_curvature_per_m,
                warp_curvature_per_m: row.warp_curvature_per_m,
                weft_curvature_per_m: row.weft_curvature_per_m,
                warp_strain: known(row.warp_strain),
                weft_strain: known(row.weft_strain),
                reachable_least_kpa: known(row.reachable_kpa.map(|range| range[0])),
                reachable_most_kpa: known(row.reachable_kpa.map(|range| range[1])),
                met: row.reason.is_none().into(),
                reserved: 0,
            })
        })
    }
}

/// Why pressure `index` is missed; empty where it is met. `what` is a wovenfit_note_text.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_pressure_reason(
    result: *const FitResult,
    index: usize,
    what: i32,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let report = &borrow(result, "result")?.0.flattening.report;
            let row = element(&report.pressures, index, "pressure")?;
            let said = row.reason.as_ref().map_or(("", ""), |reason| (reason.code, &reason.text));
            note(said, what, buffer, capacity, needed)
        })
    }
}

/// A text about warning `index`, counted from 0; `what` is a wovenfit_note_text.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_warning_text(
    result: *const FitResult,
    index: usize,
    what: i32,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let report = &borrow(result, "result")?.0.flattening.report;
            let warning = warning(&report.warnings, index)?;
            note((warning.code, &warning.message), what, buffer, capacity, needed)
        })
    }
}

/// The place of warning `index`: x, y, z in mm, NaN if it is at no one place.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says; `at` can be written for three numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_warning_place(
    result: *const FitResult,
    index: usize,
    at: *mut f64,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let report = &borrow(result, "result")?.0.flattening.report;
            let warning = warning(&report.warnings, index)?;
            Out::new(at.cast::<[f64; 3]>(), "at")?.put(place(warning.at))
        })
    }
}

/// The prepared limb of a result, to solve again on.
///
/// Any thread. Free `prepared` with wovenfit_prepared_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_prepared(
    result: *const FitResult,
    prepared: *mut *mut Prepared,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let ready = Arc::clone(&borrow(result, "result")?.0.ready);
            Out::new(prepared, "prepared")?.give(Prepared(ready))
        })
    }
}

/// Frees a result; NULL is fine.
///
/// No other thread may be using the handle.
///
/// # Safety
/// `result` is NULL or a result that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_free(result: *mut FitResult) {
    // SAFETY: the caller gives NULL or a living object and never uses it again.
    unsafe { free(result) }
}

#[cfg(test)]
mod tests {
    use std::mem::{offset_of, size_of};

    use super::*;

    #[test]
    fn the_structs_have_no_hidden_padding_and_their_places_are_frozen() {
        assert_eq!(size_of::<ResultFigures>(), 5 * 8 + 8 + 6 * 4);
        assert_eq!(offset_of!(ResultFigures, steps), 40);
        assert_eq!(offset_of!(ResultFigures, converged), 48);
        assert_eq!(size_of::<ResultPressure>(), 13 * 8 + 2 * 4);
        assert_eq!(offset_of!(ResultPressure, met), 104);
    }
}
