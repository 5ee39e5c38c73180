//! `wovenfit demo`: a sample limb, its brace, and where to look at them.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Arg, ArgMatches, Command, value_parser};
use wovenfit_core::ResultFile;
use wovenfit_core::design;
use wovenfit_core::parameters::Parameters;
use wovenfit_core::report::pressure_table;
use wovenfit_core::samples::SampleOptions;
use wovenfit_core::surface::{self, Format};

use crate::exit::Failure;
use crate::{flatten, output, sample};

/// The command's name.
pub const NAME: &str = "demo";

/// The limb unless another is named.
const LIMB: &str = "elbow";

/// Triangles of 3 to 4 mm: finer than the woven model, and quickly read.
const TRIANGLES: usize = 10_000;

/// The command's description for the parser.
pub fn command() -> Command {
    Command::new(NAME)
        .about("Make a sample limb and a brace for it")
        .after_help(
            "Examples:\n  wovenfit demo\n  wovenfit demo knee --out try\n\n\
             Writes the limb, its design and the results into the folder, and prints the \
             pressures wanted and computed.",
        )
        .arg(sample::limb().default_value(LIMB))
        .arg(
            Arg::new("out")
                .long("out")
                .value_name("DIR")
                .help("Folder for all files; made if there is none")
                .default_value("wovenfit-demo")
                .value_parser(value_parser!(PathBuf)),
        )
        .arg(flatten::format_flag())
        .arg(flatten::units_flag())
        .arg(flatten::quiet_flag())
}

/// Runs the command.
pub fn run(matches: &ArgMatches) -> Result<ExitCode, Failure> {
    let out = matches
        .get_one::<PathBuf>("out")
        .ok_or_else(|| Failure::new("give a folder: see `wovenfit demo --help`"))?;
    let quiet = matches.get_flag("quiet");
    output::ready(out)?;

    let name = matches.get_one::<String>("name").map_or(LIMB, String::as_str);
    let options = SampleOptions { triangles: TRIANGLES, ..SampleOptions::default() };
    let [limb, wish] = sample::files(name, &options, name).map_err(|e| Failure::of(&e))?;
    // From the bytes that are written, so that `flatten` on these files gives the same result.
    let mesh = surface::read(&limb.1, Format::Obj).map_err(|e| Failure::of(&e))?;
    let text = String::from_utf8_lossy(&wish.1);
    let design = design::parse(&text, None).map_err(|e| Failure::of(&e))?;
    let (flattening, _) = flatten::fit(&mesh, &design, &Parameters::default(), quiet)?;

    let command = format!(
        "\nThe same by hand:\n  wovenfit flatten {} --design {} --out {}\n",
        out.join(&limb.0).display(),
        out.join(&wish.0).display(),
        out.display()
    );
    let mut files = vec![limb, wish];
    let (formats, unit) = flatten::wanted(matches);
    let (results, notes) = flatten::files(&flattening, &design, &formats, unit);
    files.extend(results);
    output::write_together(out, &files)?;
    flatten::warn(&flattening.report);
    flatten::tell_notes(&notes);
    if !quiet {
        output::say(&pressure_table(&flattening.report));
        output::say(&flatten::places(out, &files));
        output::say(&command);
        let page = out.join(ResultFile::ReportHtml.name());
        output::say(&format!("\nLook at it in a browser:\n  {}\n", page.display()));
    }
    Ok(ExitCode::SUCCESS)
}
