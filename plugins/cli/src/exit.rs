//! How the program ends: 0 when it did its work, 1 for bad input, 2 for a command it does not
//! understand (which the command line parser says itself).

use std::error::Error;
use std::fmt;
use std::process::ExitCode;

/// Why nothing was written: a reason with its place, for people.
#[derive(Debug)]
pub struct Failure(String);

/// The exit code for bad input.
pub const BAD_INPUT: u8 = 1;

impl Failure {
    /// A failure with its reason.
    pub fn new(reason: impl Into<String>) -> Self {
        Self(reason.into())
    }

    /// The failure that an error of the core is, with the errors that caused it.
    pub fn of(error: &dyn Error) -> Self {
        let mut text = error.to_string();
        let mut cause = error.source();
        while let Some(error) = cause {
            let words = error.to_string();
            if !text.contains(&words) {
                text.push_str(": ");
                text.push_str(&words);
            }
            cause = error.source();
        }
        Self(text)
    }

    /// The same, at a place: a file or a folder.
    pub fn at(self, place: &std::path::Path) -> Self {
        Self(format!("{}: {}", place.display(), self.0))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The exit code of a command; a failure is told on standard error.
pub fn code(result: Result<ExitCode, Failure>) -> ExitCode {
    result.unwrap_or_else(|failure| {
        crate::output::tell(&format!("error: {failure}\n"));
        ExitCode::from(BAD_INPUT)
    })
}
