//! `wovenfit`: from a scanned limb and wanted pressures to the flat pattern of an elastic brace.
//!
//! A door to the core, a file a command: no geometry and no physics here. Exit code 0 is success,
//! 1 bad input (the reason on standard error, nothing written), 2 a command not understood.

#![forbid(unsafe_code)]

mod check;
mod clock;
mod demo;
mod exit;
mod flags;
mod flatten;
mod input;
mod output;
mod paper;
mod progress;
mod sample;
mod schema;

use std::process::ExitCode;

use clap::Command;

const ABOUT: &str = "From a scanned limb and wanted pressures to the flat pattern of an elastic \
    brace.\n\nThe pressures that it prints are computed from a model (a linear woven fabric on a \
    rigid limb, without friction), not measured: have a brace checked before it is worn.";

const EXAMPLES: &str = "\
Examples:
  wovenfit demo
      Make a sample elbow and a brace for it: the quickest way to see what this does.
  wovenfit check scan.obj
      What is this scan, and can a brace be made from it?
  wovenfit flatten scan.obj --design brace.json --out results
      Make the pattern: results/pattern.svg is what you print and cut.
  wovenfit sample elbow --triangles 20000 --out elbow.obj
      Write a sample limb, and beside it elbow.design.json to start a design from.
  wovenfit paper --out examples
      The examples of the paper by its own method, on one page.
  wovenfit schema
      What can stand in a design file, as a JSON schema.

`wovenfit flatten --help` explains every option.";

fn command() -> Command {
    Command::new("wovenfit")
        .version(env!("CARGO_PKG_VERSION"))
        .about(ABOUT)
        .after_help(EXAMPLES)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .disable_help_subcommand(true)
        .max_term_width(100)
        .subcommand(demo::command())
        .subcommand(check::command())
        .subcommand(flatten::command())
        .subcommand(sample::command())
        .subcommand(paper::command())
        .subcommand(schema::command())
}

fn main() -> ExitCode {
    let matches = command().get_matches();
    exit::code(match matches.subcommand() {
        Some((demo::NAME, matches)) => demo::run(matches),
        Some((check::NAME, matches)) => check::run(matches),
        Some((flatten::NAME, matches)) => flatten::run(matches),
        Some((sample::NAME, matches)) => sample::run(matches),
        Some((paper::NAME, matches)) => paper::run(matches),
        Some((schema::NAME, _)) => schema::run(),
        other => unreachable!("a subcommand is required and all are known: {other:?}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        command().debug_assert();
    }

    #[test]
    fn help_shows_every_command_with_an_example() {
        let help = command().render_long_help().to_string();
        for subcommand in command().get_subcommands() {
            let example = format!("  wovenfit {}", subcommand.get_name());
            assert!(help.contains(&example), "{example}\n{help}");
        }
    }

    #[test]
    fn what_is_not_understood_is_a_usage_error() {
        for words in [
            &["wovenfit", "flaten"][..],
            &["wovenfit", "flatten", "limb.obj"],
            &["wovenfit", "flatten", "limb.obj", "--design", "d.json"],
            &["wovenfit", "flatten", "--design", "d.json", "--out", "o"],
            &["wovenfit", "sample", "toe", "--out", "toe.obj"],
            &["wovenfit", "sample", "elbow", "--out", "elbow.stl"],
            &["wovenfit", "check"],
        ] {
            let error = command().try_get_matches_from(words).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{words:?}");
        }
    }
}
