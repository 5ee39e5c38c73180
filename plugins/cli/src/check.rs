//! `wovenfit check`: what a surface is, and what is wrong with it.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use wovenfit_core::CHECK_PARAMETERS;
use wovenfit_core::design::Facing;
use wovenfit_core::report::{CheckReport, Defect};

use crate::exit::{BAD_INPUT, Failure};
use crate::input::SurfaceFailure;
use crate::{flags, input, output};

/// The command's name.
pub const NAME: &str = "check";

/// The command's description for the parser.
pub fn command() -> Command {
    let command = Command::new(NAME)
        .about("Say what a scan is, and whether a brace can be made from it")
        .after_help(
            "Example:\n  wovenfit check scan.stl --units cm\n\n\
             Says size, girths, openings and curvature, and every defect with its place. Exit \
             code 1 if a defect stops flattening.",
        )
        .arg(
            Arg::new("surface")
                .value_name("SURFACE")
                .help("The scan: .obj, .stl or .ply")
                .required(true)
                .value_parser(value_parser!(PathBuf)),
        )
        .arg(
            Arg::new("json")
                .long("json")
                .help("Print the same as JSON, for programs")
                .action(ArgAction::SetTrue),
        )
        .arg(
            Arg::new("facing")
                .long("facing")
                .value_name("outward|inward")
                .help("Which way the triangles face, where the shape does not show it")
                .hide_possible_values(true)
                .value_parser(PossibleValuesParser::new(["outward", "inward"])),
        );
    flags::add(command, |name| CHECK_PARAMETERS.contains(&name))
}

/// Runs the command.
pub fn run(matches: &ArgMatches) -> Result<ExitCode, Failure> {
    let path = matches
        .get_one::<PathBuf>("surface")
        .ok_or_else(|| Failure::new("give a surface: see `wovenfit check --help`"))?;
    let parameters = flags::parameters(matches)?;
    let facing = matches.get_one::<String>("facing").map(|facing| match facing.as_str() {
        "inward" => Facing::Inward,
        _ => Facing::Outward,
    });
    let mut report = match input::surface(path) {
        Ok(mesh) => wovenfit_core::check(&mesh, facing, &parameters),
        // There is no file to say anything about.
        Err(SurfaceFailure::File(failure)) => return Err(failure),
        Err(SurfaceFailure::Contents(failure)) => refused("unreadable", failure.to_string()),
    };
    report.file = Some(path.display().to_string());
    output::say(&if matches.get_flag("json") { report.to_json() } else { report.to_text() });
    if report.defects.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    output::tell(&reasons(&report.defects, matches.get_flag("json")));
    Ok(ExitCode::from(BAD_INPUT))
}

/// The report of a surface of which nothing can be said but what is wrong with it.
fn refused(code: &str, message: String) -> CheckReport {
    let defect = Defect { code: code.to_owned(), message, ..Defect::default() };
    CheckReport { defects: vec![defect], ..CheckReport::default() }
}

/// The reasons for standard error; in text they already stand on standard output.
fn reasons(defects: &[Defect], json: bool) -> String {
    /// A mesh that is broken everywhere has thousands; the JSON has them all.
    const SHOWN: usize = 5;
    if !json {
        return "error: the surface has defects, listed above\n".to_owned();
    }
    let mut text: String =
        defects.iter().take(SHOWN).map(|defect| format!("error: {}\n", defect.message)).collect();
    if defects.len() > SHOWN {
        text.push_str(&format!("error: and {} more defects\n", defects.len() - SHOWN));
    }
    text
}
