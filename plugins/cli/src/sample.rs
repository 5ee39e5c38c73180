//! `wovenfit sample`: writes a procedural limb and a design for it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Command, value_parser};
use wovenfit_core::export::raw_obj;
use wovenfit_core::samples::{self, MAX_NOISE_MM, MAX_TRIANGLES, MIN_TRIANGLES};

use crate::exit::Failure;
use crate::output::{self, Named};

/// The command's name.
pub const NAME: &str = "sample";

/// The command's description for the parser.
pub fn command() -> Command {
    Command::new(NAME)
        .about("Write a sample limb and a design for it")
        .after_help(
            "Example:\n  wovenfit sample elbow --triangles 20000 --noise 0.3 --out elbow.obj\n\n\
             Writes elbow.obj (in mm) and elbow.design.json. The limbs are plausible, of real \
             size, and of nobody.",
        )
        .arg(
            Arg::new("name")
                .value_name("NAME")
                .help("Which limb")
                .required(true)
                .value_parser(PossibleValuesParser::new(samples::NAMES)),
        )
        .arg(
            Arg::new("triangles")
                .long("triangles")
                .value_name("N")
                .help(format!("About how many triangles, {MIN_TRIANGLES} to {MAX_TRIANGLES}"))
                .default_value("20000")
                .value_parser(
                    value_parser!(u64).range(MIN_TRIANGLES as u64..=MAX_TRIANGLES as u64),
                ),
        )
        .arg(
            Arg::new("noise")
                .long("noise")
                .value_name("MM")
                .help(format!("Noise of a scanner in mm, 0 to {MAX_NOISE_MM}"))
                .default_value("0")
                .allow_negative_numbers(true)
                .value_parser(noise),
        )
        .arg(
            Arg::new("out")
                .long("out")
                .value_name("FILE.obj")
                .help("Where to write the limb; the design is written beside it")
                .required(true)
                .value_parser(obj_file),
        )
}

fn noise(text: &str) -> Result<f64, String> {
    let noise = text.parse().ok().filter(|noise| (0.0..=MAX_NOISE_MM).contains(noise));
    noise.ok_or_else(|| format!("give a number from 0 to {MAX_NOISE_MM}"))
}

fn obj_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_obj = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"));
    if is_obj { Ok(path) } else { Err("samples are OBJ: give a name that ends in .obj".to_owned()) }
}

/// Runs the command.
pub fn run(matches: &ArgMatches) -> Result<ExitCode, Failure> {
    let required = || Failure::new("an argument is missing: see `wovenfit sample --help`");
    let name = matches.get_one::<String>("name").ok_or_else(required)?;
    let triangles = *matches.get_one::<u64>("triangles").ok_or_else(required)?;
    let noise = *matches.get_one::<f64>("noise").ok_or_else(required)?;
    let out = matches.get_one::<PathBuf>("out").ok_or_else(required)?;
    let triangles = usize::try_from(triangles).map_err(|error| Failure::of(&error))?;

    let stem = out.file_stem().ok_or_else(required)?.to_string_lossy().into_owned();
    let files = files(name, triangles, noise, &stem)?;
    let folder = match out.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    output::write_together(folder, &files)?;
    for (file, _) in &files {
        let path = if folder == Path::new(".") { file.into() } else { folder.join(file) };
        output::say(&format!("{}\n", path.display()));
    }
    Ok(ExitCode::SUCCESS)
}

/// The files of a sample: `STEM.obj` and `STEM.design.json`.
pub fn files(
    name: &str,
    triangles: usize,
    noise_mm: f64,
    stem: &str,
) -> Result<[Named; 2], Failure> {
    let sample = samples::sample(name, triangles, noise_mm).map_err(|e| Failure::of(&e))?;
    let title = format!("sample {name}, noise {noise_mm} mm");
    let obj = raw_obj(&sample.mesh, &title).into_bytes();
    let design = sample.design.to_json().into_bytes();
    Ok([(format!("{stem}.obj"), obj), (format!("{stem}.design.json"), design)])
}
