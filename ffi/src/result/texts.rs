//! The files of a result as text: the very bytes that the command line writes.

use std::ffi::c_char;
use std::sync::OnceLock;

use wovenfit_core::ResultFile;
use wovenfit_core::report::pressure_table;

use super::{Computed, FitResult};
use crate::buffers::fill_text;
use crate::failure::{Error, Failure};
use crate::guard::{borrow, guard};
use crate::pool::in_pool;
use crate::status::Status;

/// A text of a result. All but the table are the files that `wovenfit flatten` writes.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultText {
    /// report.json: every figure.
    ReportJson = 1,
    /// report.html: the page to read first. Drawn when it is asked for, in about a second.
    ReportHtml = 2,
    /// pattern.svg: the pattern at true size in mm.
    PatternSvg = 3,
    /// worn.obj: the cut surface in mm with the pattern as texture coordinates.
    WornObj = 4,
    /// flat.obj: the pattern as a flat mesh in mm.
    FlatObj = 5,
    /// The table of pressures for a terminal.
    Table = 6,
}

/// Texts that were made, by their number.
#[derive(Default)]
pub(super) struct Texts([OnceLock<String>; 7]);

impl Computed {
    fn text(&self, what: i32) -> Result<&str, Failure> {
        let flattening = &self.flattening;
        let file = match what {
            w if w == ResultText::ReportJson as i32 => Some(ResultFile::ReportJson),
            w if w == ResultText::ReportHtml as i32 => Some(ResultFile::ReportHtml),
            w if w == ResultText::PatternSvg as i32 => Some(ResultFile::PatternSvg),
            w if w == ResultText::WornObj as i32 => Some(ResultFile::WornObj),
            w if w == ResultText::FlatObj as i32 => Some(ResultFile::FlatObj),
            w if w == ResultText::Table as i32 => None,
            _ => return Err(Failure::invalid(format!("`what` is {what}: there is no such text"))),
        };
        let kept = usize::try_from(what).ok().and_then(|what| self.texts.0.get(what));
        let kept = kept.ok_or_else(|| Failure::new(Status::Internal, "a text has no place"))?;
        if kept.get().is_none() {
            let text = in_pool(|| match file {
                Some(file) => flattening.file(file, &self.wishes),
                None => pressure_table(&flattening.report),
            })?;
            // Of two threads that made it at once one is first, with the same text.
            drop(kept.set(text));
        }
        Ok(kept.get().map_or("", String::as_str))
    }
}

/// A text of a result; `what` is a wovenfit_result_file. The first call for one makes it.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_text(
    result: *const FitResult,
    what: i32,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let text = borrow(result, "result")?.0.text(what)?;
            fill_text(buffer, capacity, needed, text)
        })
    }
}
