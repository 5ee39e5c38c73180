//! What a surface is and what is wrong with it, before any brace is designed on it.

use std::ffi::c_char;

use wovenfit_core::check_for;
use wovenfit_core::report::{CheckReport, Defect};
use wovenfit_core::warning::Warning;

use crate::buffers::{fill, fill_text};
use crate::design::Design;
use crate::failure::{Error, Failure};
use crate::guard::{Out, Outcome, borrow, borrow_if_any, free, guard};
use crate::mesh::Mesh;
use crate::parameters::Parameters;
use crate::pool::in_pool;
use crate::prepared::agree;
use crate::status::Status;

/// What a check found. It never changes: any number of threads may use it at once.
pub struct Check(CheckReport);

/// A text about a defect or a warning.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoteText {
    /// A frozen short name that programs can test, such as "non_manifold_edge".
    Code = 1,
    /// What it is, where, and what to do, for people.
    Message = 2,
}

/// Checks a mesh as a job would take it. A mesh with defects is no failure: they are in the check.
///
/// `design` may be NULL; of it the facing bears on the check. `parameters` may be NULL for the
/// defaults. Takes about a second for 250,000 triangles.
///
/// Any thread. Free `check` with wovenfit_check_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_run(
    mesh: *const Mesh,
    design: *const Design,
    parameters: *const Parameters,
    check: *mut *mut Check,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let mesh = &borrow(mesh, "mesh")?.0;
            let out = Out::new(check, "check")?;
            let values = borrow_if_any(parameters).map(|p| p.0.clone()).unwrap_or_default();
            agree(&values, mesh)?;
            let mut wishes = borrow_if_any(design).map(|d| d.wishes.clone()).unwrap_or_default();
            wishes.unit = Some(mesh.unit);
            out.give(Check(in_pool(|| check_for(&mesh.raw, &wishes, &values))?))
        })
    }
}

/// The check as the JSON that `wovenfit check --json` prints: unit, size, girths, openings, curvature,
/// warnings, defects.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_json(
    check: *const Check,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || fill_text(buffer, capacity, needed, &borrow(check, "check")?.0.to_json()))
    }
}

/// Numbers of defects and of warnings. A mesh without defects can be flattened.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_count(
    check: *const Check,
    defects: *mut usize,
    warnings: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let report = &borrow(check, "check")?.0;
            let (defects, warnings) =
                (Out::new(defects, "defects")?, Out::new(warnings, "warnings")?);
            defects.put(report.defects.len())?;
            warnings.put(report.warnings.len())
        })
    }
}

/// The element `index` of a list.
pub(crate) fn element<'a, T>(list: &'a [T], index: usize, name: &str) -> Result<&'a T, Failure> {
    list.get(index).ok_or_else(|| {
        let text = format!("{name} {index} does not exist: there are {}, from 0", list.len());
        Failure::new(Status::OutOfRange, text)
    })
}

fn defect(report: &CheckReport, index: usize) -> Result<&Defect, Failure> {
    element(&report.defects, index, "defect")
}

/// A note's text to the caller.
///
/// # Safety
/// As [`fill_text`].
pub(crate) unsafe fn note(
    (code, message): (&str, &str),
    what: i32,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
) -> Outcome {
    let text = match what {
        w if w == NoteText::Code as i32 => code,
        w if w == NoteText::Message as i32 => message,
        _ => return Err(Failure::invalid(format!("`what` is {what}: there is no such text"))),
    };
    // SAFETY: by the caller.
    unsafe { fill_text(buffer, capacity, needed, text) }
}

/// A warning's text and place, for all that has warnings.
pub(crate) fn warning(list: &[Warning], index: usize) -> Result<&Warning, Failure> {
    element(list, index, "warning")
}

/// A place that may be none.
pub(crate) fn place(at: Option<[f64; 3]>) -> [f64; 3] {
    at.unwrap_or([f64::NAN; 3])
}

/// A text about defect `index`, counted from 0; `what` is a wovenfit_note_text.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_defect_text(
    check: *const Check,
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
            let defect = defect(&borrow(check, "check")?.0, index)?;
            note((&defect.code, &defect.message), what, buffer, capacity, needed)
        })
    }
}

/// The place of defect `index`: x, y, z in mm, NaN if it is at no one place.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says; `at` can be written for three numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_defect_place(
    check: *const Check,
    index: usize,
    at: *mut f64,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let defect = defect(&borrow(check, "check")?.0, index)?;
            Out::new(at.cast::<[f64; 3]>(), "at")?.put(place(defect.at))
        })
    }
}

/// The vertices of the mesh given that defect `index` is about; may be none.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_defect_vertices(
    check: *const Check,
    index: usize,
    buffer: *mut u32,
    capacity: usize,
    count: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let defect = defect(&borrow(check, "check")?.0, index)?;
            fill(buffer, capacity, count, &narrow(&defect.vertices))
        })
    }
}

/// The triangles of the mesh given that defect `index` is about; may be none.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_defect_triangles(
    check: *const Check,
    index: usize,
    buffer: *mut u32,
    capacity: usize,
    count: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let defect = defect(&borrow(check, "check")?.0, index)?;
            fill(buffer, capacity, count, &narrow(&defect.faces))
        })
    }
}

/// Indices of a mesh, which has fewer than 2^32 elements: what a triangle names may be anything of
/// 32 bits, too.
fn narrow(indices: &[usize]) -> Vec<u32> {
    indices.iter().map(|&i| u32::try_from(i).unwrap_or(u32::MAX)).collect()
}

/// A text about warning `index`, counted from 0; `what` is a wovenfit_note_text.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_warning_text(
    check: *const Check,
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
            let warning = warning(&borrow(check, "check")?.0.warnings, index)?;
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
pub unsafe extern "C" fn wovenfit_check_warning_place(
    check: *const Check,
    index: usize,
    at: *mut f64,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let warning = warning(&borrow(check, "check")?.0.warnings, index)?;
            Out::new(at.cast::<[f64; 3]>(), "at")?.put(place(warning.at))
        })
    }
}

/// Frees a check; NULL is fine.
///
/// No other thread may be using the handle.
///
/// # Safety
/// `check` is NULL or an object that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_check_free(check: *mut Check) {
    // SAFETY: the caller gives NULL or a living object and never uses it again.
    unsafe { free(check) }
}
