//! `wovenfit flatten`: the pattern of a brace from a surface and a design.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::thread;
use std::time::Instant;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde::Serialize;
use wovenfit_core::design::Design;
use wovenfit_core::export::json_text;
use wovenfit_core::parameters::Parameters;
use wovenfit_core::report::{PressureReport, Report, pressure_table};
use wovenfit_core::sheet::SheetUnit;
use wovenfit_core::surface::RawMesh;
use wovenfit_core::warning::Warning;
use wovenfit_core::{Flattening, PatternFormat, ResultFile, flatten};

use crate::clock::{Clock, StageTimes, peak_mib};
use crate::exit::Failure;
use crate::output::Named;
use crate::progress::Bar;
use crate::{flags, input, output};

/// The command's name.
pub const NAME: &str = "flatten";

/// What is printed for programs.
#[derive(Debug, Serialize)]
struct Summary<'a> {
    out: String,
    files: Vec<&'a str>,
    seconds: Seconds,
    /// Of `fit`, by stage.
    stages: StageTimes,
    /// The most memory that was resident, where the system says it.
    peak_mib: Option<f64>,
    converged: bool,
    pressures: &'a [PressureReport],
    warnings: &'a [Warning],
}

/// How long it took, by the clock on the wall.
#[derive(Debug, Clone, Copy, Serialize)]
struct Seconds {
    read: f64,
    fit: f64,
    write: f64,
    total: f64,
}

/// The command's description for the parser.
pub fn command() -> Command {
    let command = Command::new(NAME)
        .about("Make the flat pattern of a brace")
        .after_help(
            "Example:\n  wovenfit flatten scan.obj --design brace.json --out results\n\n\
             Writes into the folder:\n\
             \x20 report.html   the report as a page: open it in a browser, or print it\n\
             \x20 pattern.svg   the pattern at true size: print it at 100 % and cut\n\
             \x20               (--format pdf-a4,dxf-astm,… writes it as other formats)\n\
             \x20 report.json   every figure: pressures wanted and computed, girths, warnings\n\
             \x20 worn.obj      the cut surface, with the pattern as texture coordinates in mm\n\
             \x20 flat.obj      the flat pattern as a mesh, in mm\n\n\
             Exit code 0: done. 1: the surface or the design cannot be used; the reason is on \
             standard error and nothing is written. 2: the command was not understood.",
        )
        .arg(
            Arg::new("surface")
                .value_name("SURFACE")
                .help("The scanned limb: .obj, .stl or .ply")
                .required(true)
                .value_parser(value_parser!(PathBuf)),
        )
        .arg(
            Arg::new("design")
                .long("design")
                .value_name("DESIGN.json")
                .help("What is wanted: fabric, pressures, seams (see `wovenfit schema`)")
                .required(true)
                .value_parser(value_parser!(PathBuf)),
        )
        .arg(
            Arg::new("out")
                .long("out")
                .value_name("DIR")
                .help("Folder for the results; made if there is none")
                .required(true)
                .value_parser(value_parser!(PathBuf)),
        )
        .arg(
            Arg::new("json")
                .long("json")
                .help("Print a summary as JSON instead of the table, for programs")
                .action(ArgAction::SetTrue),
        )
        .arg(format_flag())
        .arg(units_flag())
        .arg(quiet_flag());
    flags::add(command, |_| true)
}

/// The flag `--format`.
pub fn format_flag() -> Arg {
    let list: String = PatternFormat::ALL
        .iter()
        .map(|format| {
            format!("\n  {:<10} {}: {}", format.name(), format.file_name(), format.summary())
        })
        .collect();
    let usual: Vec<&str> = PatternFormat::USUAL.iter().map(|format| format.name()).collect();
    Arg::new("format")
        .long("format")
        .value_name("FORMAT,…")
        .help("Formats of the pattern, for example svg,pdf-a4,dxf-astm")
        .long_help(format!("Formats of the pattern, one or more, with commas between them:{list}"))
        .value_delimiter(',')
        .action(ArgAction::Append)
        .hide_possible_values(true)
        .default_value(usual.join(","))
        .value_parser(PossibleValuesParser::new(PatternFormat::ALL.map(PatternFormat::name)))
}

/// The flag `--pattern-units`.
pub fn units_flag() -> Arg {
    Arg::new("pattern-units")
        .long("pattern-units")
        .value_name("mm|in")
        .help("Unit of the pattern's files: of numbers in SVG and DXF, of words in all")
        .default_value("mm")
        .hide_possible_values(true)
        .value_parser(PossibleValuesParser::new(["mm", "in"]))
}

/// How the pattern is wanted: formats, each once in the order of the list, and their unit.
pub fn wanted(matches: &ArgMatches) -> (Vec<PatternFormat>, SheetUnit) {
    let named: Vec<&String> = matches.get_many("format").into_iter().flatten().collect();
    let formats = PatternFormat::ALL
        .into_iter()
        .filter(|format| named.iter().any(|name| *name == format.name()))
        .collect();
    let unit = matches.get_one::<String>("pattern-units").and_then(|name| SheetUnit::named(name));
    (formats, unit.unwrap_or_default())
}

/// The flag `--quiet`.
pub fn quiet_flag() -> Arg {
    Arg::new("quiet")
        .long("quiet")
        .short('q')
        .help("No progress bar, table and times; warnings and errors remain")
        .action(ArgAction::SetTrue)
}

/// Runs the command.
pub fn run(matches: &ArgMatches) -> Result<ExitCode, Failure> {
    let start = Instant::now();
    let path = |name: &str| {
        matches
            .get_one::<PathBuf>(name)
            .ok_or_else(|| Failure::new(format!("{name} is missing: see `wovenfit {NAME} --help`")))
    };
    let (surface, design, out) = (path("surface")?, path("design")?, path("out")?);
    let (json, quiet) = (matches.get_flag("json"), matches.get_flag("quiet"));
    let parameters = flags::parameters(matches)?;

    let mesh = input::surface(surface)?;
    let design = input::design(design, parameters.units)?;
    output::ready(out)?;
    let read = start.elapsed();
    let (flattening, stages) = fit(&mesh, &design, &parameters, quiet)?;
    let fitted = start.elapsed();
    let (formats, unit) = wanted(matches);
    let (files, notes) = files(&flattening, &design, &formats, unit);
    output::write_together(out, &files)?;
    let total = start.elapsed();

    let seconds = Seconds {
        read: read.as_secs_f64(),
        fit: (fitted - read).as_secs_f64(),
        write: (total - fitted).as_secs_f64(),
        total: total.as_secs_f64(),
    };
    let report = &flattening.report;
    warn(report);
    tell_notes(&notes);
    if json {
        let summary = Summary {
            out: out.display().to_string(),
            files: files.iter().map(|(name, _)| name.as_str()).collect(),
            seconds,
            stages,
            peak_mib: peak_mib(),
            converged: report.fit.converged,
            pressures: &report.pressures,
            warnings: &report.warnings,
        };
        output::say(&json_text(&summary));
    } else if !quiet {
        output::say(&pressure_table(report));
        output::say(&places(out, &files));
        tell_times(seconds);
    }
    Ok(ExitCode::SUCCESS)
}

/// Flattens, with a progress bar; how long the stages took.
pub fn fit(
    mesh: &RawMesh,
    design: &Design,
    parameters: &Parameters,
    quiet: bool,
) -> Result<(Flattening, StageTimes), Failure> {
    let bar = Bar::new(quiet);
    let clock = Clock::new(&bar);
    let result = flatten(mesh, design, parameters, &clock);
    let stages = clock.stages();
    // Off the screen before anything else is written there.
    bar.finish();
    result.map(|flattening| (flattening, stages)).map_err(|error| Failure::of(&error))
}

/// The files of a result with its pattern in these formats, and what the formats could not hold.
pub fn files(
    flattening: &Flattening,
    design: &Design,
    formats: &[PatternFormat],
    unit: SheetUnit,
) -> (Vec<Named>, Vec<String>) {
    let text =
        |file: ResultFile| (file.name().to_owned(), flattening.file(file, design).into_bytes());
    let pattern = |format: PatternFormat| {
        let file = flattening.pattern(format, unit, design);
        ((format.file_name().to_owned(), file.bytes), file.notes)
    };
    // The meshes while the page's pictures are drawn.
    thread::scope(|scope| {
        let others = ResultFile::ALL.into_iter().filter(|file| *file != ResultFile::PatternSvg);
        let others: Vec<_> = others.map(|file| scope.spawn(move || text(file))).collect();
        let (mut files, notes): (Vec<Named>, Vec<Vec<String>>) =
            formats.iter().copied().map(pattern).unzip();
        let joined = others
            .into_iter()
            .map(|task| task.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        files.extend(joined);
        (files, notes.concat())
    })
}

/// What formats could not hold, on standard error.
pub fn tell_notes(notes: &[String]) {
    for note in notes {
        output::tell(&format!("note: {note}\n"));
    }
}

/// The warnings, on standard error: also for those who asked for quiet.
pub fn warn(report: &Report) {
    for warning in &report.warnings {
        let place = warning
            .at
            .map_or_else(String::new, |[x, y, z]| format!(" [at ({x:.2}, {y:.2}, {z:.2}) mm]"));
        output::tell(&format!("warning: {}{place}\n", warning.message));
    }
}

/// Where the files are.
pub fn places(folder: &Path, files: &[Named]) -> String {
    let lines = files.iter().map(|(name, _)| format!("  {}\n", folder.join(name).display()));
    format!("\nFiles:\n{}", lines.collect::<String>())
}

fn tell_times(seconds: Seconds) {
    let Seconds { read, fit, write, total } = seconds;
    output::tell(&format!(
        "read {read:.2} s, fit {fit:.2} s, write {write:.2} s, total {total:.2} s\n"
    ));
}
