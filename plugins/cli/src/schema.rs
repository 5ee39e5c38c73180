//! `wovenfit schema`: what can stand in a design file.

use std::process::ExitCode;

use clap::Command;
use wovenfit_core::design;
use wovenfit_core::export::json_text;

use crate::exit::Failure;
use crate::output;

/// The command's name.
pub const NAME: &str = "schema";

/// The command's description for the parser.
pub fn command() -> Command {
    Command::new(NAME).about("Print the JSON schema of design files")
}

/// Runs the command.
pub fn run() -> Result<ExitCode, Failure> {
    output::say(&json_text(&design::schema()));
    Ok(ExitCode::SUCCESS)
}
