//! The table of parameters, for dialogs, and values for it.

use std::ffi::c_char;

use wovenfit_core::parameters::{Kind, PARAMETERS, Parameter, Parameters as Values};

use crate::buffers::{fill_text, text};
use crate::failure::{Error, Failure};
use crate::guard::{Out, borrow, borrow_mut, free, guard};
use crate::status::Status;

/// A value for every parameter of the table. One thread at a time may change it; while nobody does,
/// any may read.
pub struct Parameters(pub(crate) Values);

/// What a parameter may be.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterKind {
    /// A number in a closed range.
    Number = 1,
    /// A whole number in a closed range.
    Integer = 2,
    /// "true" or "false".
    Switch = 3,
    /// One of some names.
    Choice = 4,
}

/// A text about a parameter.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterText {
    /// Its name in snake case.
    Name = 1,
    /// Its unit, empty where it has none.
    Unit = 2,
    /// Its default, as text.
    Default = 3,
    /// What it does, in one line.
    Summary = 4,
    /// When and why to change it, in a paragraph.
    Paragraph = 5,
}

/// What a parameter may be.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterRange {
    /// A wovenfit_parameter_kind.
    pub kind: i32,
    /// How many names it may be; 0 unless it is a choice.
    pub choices: u32,
    /// The least number; NaN where there is none.
    pub least: f64,
    /// The largest number; NaN where there is none.
    pub most: f64,
}

/// Number of parameters in the table. They are counted from 0 in the order in which dialogs show
/// them.
///
/// Any thread.
#[unsafe(no_mangle)]
pub extern "C" fn wovenfit_parameter_count() -> usize {
    PARAMETERS.len()
}

fn row(index: usize) -> Result<&'static Parameter, Failure> {
    PARAMETERS.get(index).ok_or_else(|| {
        let text =
            format!("parameter {index} does not exist: there are {}, from 0", PARAMETERS.len());
        Failure::new(Status::OutOfRange, text)
    })
}

/// A text about a parameter; `what` is a wovenfit_parameter_text.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_parameter_describe(
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
            let row = row(index)?;
            let text = match what {
                w if w == ParameterText::Name as i32 => row.name.to_owned(),
                w if w == ParameterText::Unit as i32 => row.unit.to_owned(),
                w if w == ParameterText::Default as i32 => row.default_text(),
                w if w == ParameterText::Summary as i32 => row.summary.to_owned(),
                w if w == ParameterText::Paragraph as i32 => row.text.to_owned(),
                _ => {
                    return Err(Failure::invalid(format!(
                        "`what` is {what}: there is no such text"
                    )));
                }
            };
            fill_text(buffer, capacity, needed, &text)
        })
    }
}

/// What a parameter may be.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_parameter_range(
    index: usize,
    range: *mut ParameterRange,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let out = Out::new(range, "range")?;
            let none = |kind: ParameterKind, choices: usize| ParameterRange {
                kind: kind as i32,
                choices: u32::try_from(choices).unwrap_or(u32::MAX),
                least: f64::NAN,
                most: f64::NAN,
            };
            out.put(match &row(index)?.kind {
                Kind::Number(range) => ParameterRange {
                    least: *range.start(),
                    most: *range.end(),
                    ..none(ParameterKind::Number, 0)
                },
                Kind::Integer(range) => ParameterRange {
                    least: *range.start() as f64,
                    most: *range.end() as f64,
                    ..none(ParameterKind::Integer, 0)
                },
                Kind::Switch => none(ParameterKind::Switch, 0),
                Kind::Choice(names) => none(ParameterKind::Choice, names.len()),
            })
        })
    }
}

/// A name that a parameter may be; `choice` counts from 0.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_parameter_choice(
    index: usize,
    choice: usize,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let row = row(index)?;
            let names = match &row.kind {
                Kind::Choice(names) => names.as_slice(),
                _ => &[],
            };
            let name = names.get(choice).ok_or_else(|| {
                let text = format!("parameter `{}` has {} choices, from 0", row.name, names.len());
                Failure::new(Status::OutOfRange, text)
            })?;
            fill_text(buffer, capacity, needed, name)
        })
    }
}

/// Makes parameters with the table's defaults.
///
/// Any thread. Free `parameters` with wovenfit_parameters_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_parameters_new(
    parameters: *mut *mut Parameters,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || Out::new(parameters, "parameters")?.give(Parameters(Values::default())))
    }
}

/// Makes a copy of parameters.
///
/// Any thread, while nobody changes `parameters`. Free `copy` with wovenfit_parameters_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_parameters_copy(
    parameters: *const Parameters,
    copy: *mut *mut Parameters,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let values = borrow(parameters, "parameters")?.0.clone();
            Out::new(copy, "copy")?.give(Parameters(values))
        })
    }
}

/// Sets a parameter by its name from text: "5.5", "true", "newton". WOVENFIT_STATUS_PARAMETER says
/// the nearest name, or the range.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_parameters_set(
    parameters: *mut Parameters,
    name: *const c_char,
    value: *const c_char,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let parameters = borrow_mut(parameters, "parameters")?;
            Ok(parameters.0.set(text(name, "name")?, text(value, "value")?)?)
        })
    }
}

/// The value of a parameter as text.
///
/// Any thread, while nobody changes `parameters`.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_parameters_get(
    parameters: *const Parameters,
    name: *const c_char,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let value = borrow(parameters, "parameters")?.0.get(text(name, "name")?)?;
            fill_text(buffer, capacity, needed, &value)
        })
    }
}

/// Frees parameters; NULL is fine. Jobs started with them stay.
///
/// No other thread may be using the handle.
///
/// # Safety
/// `parameters` is NULL or an object that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_parameters_free(parameters: *mut Parameters) {
    // SAFETY: the caller gives NULL or a living object and never uses it again.
    unsafe { free(parameters) }
}
