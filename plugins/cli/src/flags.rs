//! The method's parameters as flags, made from the one table.

use clap::builder::{PossibleValuesParser, ValueParser};
use clap::{Arg, ArgMatches, Command};
use wovenfit_core::parameters::{Kind, PARAMETERS, Parameter, ParameterError, Parameters};

use crate::exit::Failure;

const HEADING: &str = "Parameters of the method (the defaults are meant to be left alone)";

/// The command with a flag for every parameter that `wanted` accepts, by its name in the table.
pub fn add(command: Command, wanted: impl Fn(&str) -> bool) -> Command {
    add_to(command, &Parameters::default(), wanted)
}

/// The same with other defaults than the table's.
pub fn add_to(command: Command, defaults: &Parameters, wanted: impl Fn(&str) -> bool) -> Command {
    let parameters = PARAMETERS.iter().filter(|parameter| wanted(parameter.name));
    command.args(parameters.map(|parameter| flag(parameter, defaults)))
}

/// The parameters that the flags give; the rest has its default.
pub fn parameters(matches: &ArgMatches) -> Result<Parameters, Failure> {
    parameters_over(Parameters::default(), matches)
}

/// The same with other defaults than the table's.
pub fn parameters_over(
    mut parameters: Parameters,
    matches: &ArgMatches,
) -> Result<Parameters, Failure> {
    for parameter in PARAMETERS.iter() {
        if let Ok(Some(value)) = matches.try_get_one::<String>(parameter.name) {
            parameters.set(parameter.name, value).map_err(|error| Failure::of(&error))?;
        }
    }
    Ok(parameters)
}

fn flag(parameter: &'static Parameter, defaults: &Parameters) -> Arg {
    let default = defaults.get(parameter.name).unwrap_or_default();
    let summary = parameter.summary.trim_end_matches('.');
    let arg = Arg::new(parameter.name)
        .long(parameter.name.replace('_', "-"))
        .value_name(value_name(parameter))
        .value_parser(parser(parameter))
        .allow_negative_numbers(true)
        .hide_possible_values(true)
        .help_heading(HEADING)
        .help(format!("{summary} [default: {default}]"))
        .long_help(format!(
            "{}\n{}\n[{}; default: {default}]",
            parameter.summary,
            parameter.text,
            range(parameter)
        ));
    match parameter.kind {
        // `--keep-largest` alone switches on; `--keep-largest=false` off.
        Kind::Switch => arg.num_args(0..=1).require_equals(true).default_missing_value("true"),
        _ => arg,
    }
}

/// What stands for the value in the help: its unit, or what kind of thing it is.
fn value_name(parameter: &Parameter) -> String {
    match &parameter.kind {
        Kind::Choice(names) => names.join("|"),
        Kind::Switch => "true|false".to_owned(),
        Kind::Integer(_) => "N".to_owned(),
        Kind::Number(_) if parameter.unit.is_empty() || parameter.unit.contains(' ') => {
            "NUMBER".to_owned()
        }
        Kind::Number(_) => parameter.unit.to_uppercase(),
    }
}

fn range(parameter: &Parameter) -> String {
    let unit =
        if parameter.unit.is_empty() { String::new() } else { format!(" {}", parameter.unit) };
    match &parameter.kind {
        Kind::Number(range) => format!("{} to {}{unit}", range.start(), range.end()),
        Kind::Integer(range) => format!("{} to {}{unit}", range.start(), range.end()),
        Kind::Switch => "true or false".to_owned(),
        Kind::Choice(names) => format!("one of {}", names.join(", ")),
    }
}

/// Refuses at once what the table refuses: a wrong value is a usage error.
fn parser(parameter: &'static Parameter) -> ValueParser {
    if let Kind::Choice(names) = &parameter.kind {
        return PossibleValuesParser::new(names).into();
    }
    let name = parameter.name;
    ValueParser::from(move |text: &str| {
        match Parameters::default().set(name, text) {
            Ok(()) => Ok(text.to_owned()),
            // The flag and the value are named by the command line parser.
            Err(ParameterError::Value { remedy, .. }) => Err(remedy),
            Err(error) => Err(error.to_string()),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Command {
        add(Command::new("test"), |_| true)
    }

    #[test]
    fn every_parameter_has_a_flag_that_sets_it() {
        for parameter in PARAMETERS.iter() {
            let default = parameter.default_text();
            let other = match &parameter.kind {
                Kind::Switch => (default != "true").to_string(),
                Kind::Choice(names) => {
                    let other = names.iter().find(|name| **name != default);
                    other.unwrap_or(&names[0]).to_string()
                }
                Kind::Number(range) => range.end().to_string(),
                Kind::Integer(range) => range.end().to_string(),
            };
            let flag = format!("--{}={other}", parameter.name.replace('_', "-"));
            let matches = all().try_get_matches_from(["test", &flag]).unwrap();
            let parameters = parameters(&matches).unwrap();
            assert_eq!(parameters.get(parameter.name).unwrap(), other, "{flag}");
        }
    }

    #[test]
    fn without_flags_all_is_default_even_where_a_flag_is_not_offered() {
        let command = add(Command::new("test"), |name| name == "units");
        let matches = command.clone().try_get_matches_from(["test"]).unwrap();
        assert_eq!(parameters(&matches).unwrap(), Parameters::default());
        assert!(command.try_get_matches_from(["test", "--spacing=4"]).is_err());
    }

    #[test]
    fn a_switch_needs_no_value() {
        let on = all().try_get_matches_from(["test", "--keep-largest", "--spacing", "4"]).unwrap();
        let on = parameters(&on).unwrap();
        assert!(on.keep_largest);
        assert_eq!(on.spacing, 4.0);
        let off = all().try_get_matches_from(["test", "--keep-largest=false"]).unwrap();
        assert!(!parameters(&off).unwrap().keep_largest);
    }

    #[test]
    fn a_wrong_value_is_a_usage_error_with_the_range() {
        for value in ["0", "-1", "NaN", "much"] {
            let error = all().try_get_matches_from(["test", "--spacing", value]).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            let text = error.to_string();
            assert!(text.contains("--spacing <MM>"), "{text}");
            assert!(text.contains("give a number from 0.5 to 30"), "{text}");
        }
        let error = all().try_get_matches_from(["test", "--units", "ft"]).unwrap_err().to_string();
        assert!(error.contains("[possible values: auto, mm, cm, m, in]"), "{error}");
    }
}
