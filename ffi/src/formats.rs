//! The pattern in the formats that a workshop's machines read.

use std::ffi::c_char;
use std::sync::OnceLock;

use wovenfit_core::sheet::SheetUnit;
use wovenfit_core::{PatternFile, PatternFormat};

use crate::buffers::{fill, fill_text, text};
use crate::failure::{Error, Failure};
use crate::guard::{borrow, guard};
use crate::pool::in_pool;
use crate::result::{Computed, FitResult};
use crate::status::Status;

/// A text about a format of the pattern.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormatText {
    /// Its short name: "pdf-a4".
    Name = 1,
    /// What its file is called: "pattern-a4.pdf".
    FileName = 2,
    /// What it is for, in one line.
    Summary = 3,
}

const FORMATS: usize = PatternFormat::ALL.len();

/// Patterns that were made, by format and unit.
#[derive(Default)]
pub(crate) struct Patterns([[OnceLock<PatternFile>; FORMATS]; 2]);

impl Computed {
    fn pattern(&self, format: &str, unit: &str) -> Result<&PatternFile, Failure> {
        let index = PatternFormat::ALL.iter().position(|known| known.name() == format);
        let index = index.ok_or_else(|| {
            let names = PatternFormat::ALL.map(PatternFormat::name).join(", ");
            Failure::invalid(format!("`format` is \"{format}\": give one of {names}"))
        })?;
        let known = SheetUnit::named(unit).ok_or_else(|| {
            Failure::invalid(format!("`unit` is \"{unit}\": give \"mm\" or \"in\""))
        })?;
        let kept = &self.patterns.0[usize::from(known == SheetUnit::Inch)][index];
        if kept.get().is_none() {
            let format = PatternFormat::ALL[index];
            let file = in_pool(|| self.flattening.pattern(format, known, &self.wishes))?;
            // Of two threads that made it at once one is first, with the same bytes.
            drop(kept.set(file));
        }
        kept.get().ok_or_else(|| Failure::new(Status::Internal, "a pattern has no place"))
    }
}

/// Number of formats of the pattern. They are counted from 0 in the order in which menus show them.
///
/// Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn wovenfit_format_count() -> usize {
    FORMATS
}

/// A text about a format of the pattern; `what` is a wovenfit_format_text.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_format_describe(
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
            let format = PatternFormat::ALL.get(index).ok_or_else(|| {
                let text = format!("format {index} does not exist: there are {FORMATS}, from 0");
                Failure::new(Status::OutOfRange, text)
            })?;
            let text = match what {
                w if w == FormatText::Name as i32 => format.name(),
                w if w == FormatText::FileName as i32 => format.file_name(),
                w if w == FormatText::Summary as i32 => format.summary(),
                _ => {
                    return Err(Failure::invalid(format!(
                        "`what` is {what}: there is no such text"
                    )));
                }
            };
            fill_text(buffer, capacity, needed, text)
        })
    }
}

/// The pattern of a result as a file's bytes, with the pieces of its design: allowances, notches, what
/// is written on them. `format` is a format's short name; `unit`, "mm" or "in", is that of the numbers
/// in SVG and DXF and of the words in all. The first call for one makes it.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_pattern(
    result: *const FitResult,
    format: *const c_char,
    unit: *const c_char,
    buffer: *mut u8,
    capacity: usize,
    count: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let result = borrow(result, "result")?;
            let file = result.0.pattern(text(format, "format")?, text(unit, "unit")?)?;
            fill(buffer, capacity, count, &file.bytes)
        })
    }
}

/// What a format of the pattern cannot hold and says instead, a line each: letters of a name, a name
/// that is too long. Empty where it holds all. Arguments as for wovenfit_result_pattern.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_pattern_notes(
    result: *const FitResult,
    format: *const c_char,
    unit: *const c_char,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let result = borrow(result, "result")?;
            let file = result.0.pattern(text(format, "format")?, text(unit, "unit")?)?;
            fill_text(buffer, capacity, needed, &file.notes.join("\n"))
        })
    }
}
