//! `wovenfit sample`: writes a procedural limb and a design for it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use wovenfit_core::export::raw_obj;
use wovenfit_core::samples::{
    self, MAX_NOISE_MM, MAX_TRIANGLES, MIN_TRIANGLES, SampleError, SampleOptions,
};

use crate::exit::Failure;
use crate::output::{self, Named};

/// The command's name.
pub const NAME: &str = "sample";

/// The command's description for the parser.
pub fn command() -> Command {
    let defaults = SampleOptions::default();
    Command::new(NAME)
        .about("Write a sample limb and a design for it")
        .after_help(after_help())
        .arg(limb().required(true))
        .arg(
            Arg::new("triangles")
                .long("triangles")
                .value_name("N")
                .help(format!("About how many triangles, {MIN_TRIANGLES} to {MAX_TRIANGLES}"))
                .default_value(defaults.triangles.to_string())
                .value_parser(
                    value_parser!(u64).range(MIN_TRIANGLES as u64..=MAX_TRIANGLES as u64),
                ),
        )
        .arg(
            Arg::new("noise")
                .long("noise")
                .value_name("MM")
                .help(format!("Noise of a scanner in mm, 0 to {MAX_NOISE_MM}"))
                .default_value(defaults.noise_mm.to_string())
                .allow_negative_numbers(true)
                .value_parser(noise),
        )
        .arg(
            Arg::new("opening")
                .long("opening")
                .help("Cut the opening that the limb can have: the wrist's for the thumb")
                .action(ArgAction::SetTrue),
        )
        .arg(
            Arg::new("config")
                .long("config")
                .value_name("CONFIG")
                .help("One of the paper's examples instead of the reachable design (see below)"),
        )
        .arg(
            Arg::new("fabric")
                .long("fabric")
                .value_name("FABRIC")
                .help("The fabric of the example, where it is made in more than one (see below)")
                .requires("config"),
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

/// The argument that names a limb.
pub fn limb() -> Arg {
    Arg::new("name")
        .value_name("NAME")
        .help("Which limb")
        .value_parser(PossibleValuesParser::new(samples::NAMES))
}

fn after_help() -> String {
    let mut text = "\
Examples:
  wovenfit sample elbow --triangles 20000 --noise 0.3 --out elbow.obj
  wovenfit sample wrist --opening --out wrist.obj
  wovenfit sample elbow --config d --fabric anisotropic --out elbow.obj

Writes elbow.obj (in mm) and elbow.design.json. The limbs are plausible, of real size, and of \
nobody.

Configurations, the examples of Wang & Tang in their formula for the pressure:
"
    .to_owned();
    for name in samples::NAMES {
        for configuration in samples::configurations(name) {
            let fabrics: Vec<&str> = configuration.fabrics().collect();
            text += &format!(
                "  {name} --config {:<6} {} ({})\n",
                configuration.name,
                configuration.summary,
                fabrics.join(" or ")
            );
        }
    }
    text.truncate(text.trim_end().len());
    text
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
    let out = matches.get_one::<PathBuf>("out").ok_or_else(required)?;
    let options = SampleOptions {
        triangles: usize::try_from(triangles).map_err(|error| Failure::of(&error))?,
        noise_mm: *matches.get_one::<f64>("noise").ok_or_else(required)?,
        opening: matches.get_flag("opening"),
        configuration: matches.get_one::<String>("config").cloned(),
        fabric: matches.get_one::<String>("fabric").cloned(),
    };

    let stem = out.file_stem().ok_or_else(required)?.to_string_lossy().into_owned();
    let files = match files(name, &options, &stem) {
        Ok(files) => files,
        // All that can be wrong now is the command: which limb has which configuration.
        Err(error) => return Ok(misunderstood(&error)),
    };
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

/// Says what was not understood as the command line parser says it.
fn misunderstood(error: &SampleError) -> ExitCode {
    let mut command = command().bin_name(format!("wovenfit {NAME}"));
    let error = command.error(ErrorKind::InvalidValue, error);
    // Standard error may be closed; the exit code says it all the same.
    let _ = error.print();
    u8::try_from(error.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}

/// The files of a sample: `STEM.obj` and `STEM.design.json`.
pub fn files(name: &str, options: &SampleOptions, stem: &str) -> Result<[Named; 2], SampleError> {
    let sample = samples::sample_with(name, options)?;
    let title = format!("sample {name}, noise {} mm", options.noise_mm);
    let obj = raw_obj(&sample.mesh, &title).into_bytes();
    let design = sample.design.to_json().into_bytes();
    Ok([(format!("{stem}.obj"), obj), (format!("{stem}.design.json"), design)])
}
