//! What a dialog is made from: the table of parameters, and the design's values of the fabric.

use serde_json::Value;
use wovenfit_core::design::schema;
use wovenfit_core::parameters::{Kind as Range, PARAMETERS, Parameter as Row};
use wovenfit_core::{CHECK_PARAMETERS, PatternFormat};

use crate::ffi::{Format, Kind, Parameter, Wish};

/// Every parameter of the method, in the order in which dialogs show them.
pub(crate) fn parameters() -> Vec<Parameter> {
    PARAMETERS.iter().map(row).collect()
}

/// Those that bear on what a surface is.
pub(crate) fn check_parameters() -> Vec<Parameter> {
    PARAMETERS.iter().filter(|row| CHECK_PARAMETERS.contains(&row.name)).map(row).collect()
}

/// Every format of the pattern, in the order in which menus show them.
pub(crate) fn pattern_formats() -> Vec<Format> {
    PatternFormat::ALL
        .map(|format| Format {
            name: format.name().to_owned(),
            summary: format.summary().to_owned(),
        })
        .into()
}

fn row(row: &Row) -> Parameter {
    let (kind, least, most, choices) = match &row.kind {
        Range::Number(range) => (Kind::Number, *range.start(), *range.end(), Vec::new()),
        Range::Integer(range) => {
            (Kind::Integer, *range.start() as f64, *range.end() as f64, Vec::new())
        }
        Range::Switch => (Kind::Switch, f64::NAN, f64::NAN, Vec::new()),
        Range::Choice(names) => {
            let names = names.iter().map(|name| (*name).to_owned()).collect();
            (Kind::Choice, f64::NAN, f64::NAN, names)
        }
    };
    Parameter {
        name: row.name.to_owned(),
        unit: row.unit.to_owned(),
        summary: row.summary.to_owned(),
        text: row.text.to_owned(),
        kind,
        least,
        most,
        choices,
        default_value: row.default_text(),
    }
}

/// What a designer who paints his pressures must say of his fabric; the rest is for the design file.
const FABRIC: [&str; 4] = ["warp", "weft", "diagonal", "max_strain"];

/// The fabric's values with text and default as the schema of the design file has them.
pub(crate) fn fabric_wishes() -> Vec<Wish> {
    let schema = schema();
    let text = |key: &str, what: &str| match schema
        .pointer(&format!("/properties/fabric/properties/{key}/{what}"))
    {
        Some(Value::String(text)) => text.clone(),
        Some(value) => value.to_string(),
        None => String::new(),
    };
    let wish = |key: &str| Wish {
        place: format!("fabric.{key}"),
        text: text(key, "description"),
        default_value: text(key, "default"),
    };
    FABRIC.into_iter().map(wish).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_of_the_table_is_there_with_its_range() {
        let rows = parameters();
        assert_eq!(rows.len(), PARAMETERS.len());
        let spacing = rows.iter().find(|row| row.name == "spacing").unwrap();
        assert_eq!((spacing.kind, spacing.least, spacing.most), (Kind::Number, 0.5, 30.0));
        assert_eq!((spacing.unit.as_str(), spacing.default_value.as_str()), ("mm", "5"));
        let units = rows.iter().find(|row| row.name == "units").unwrap();
        assert_eq!(units.choices, ["auto", "mm", "cm", "m", "in"]);
        assert_eq!(check_parameters().len(), CHECK_PARAMETERS.len());
    }

    #[test]
    fn the_fabric_is_there_with_its_units_and_defaults() {
        let wishes = fabric_wishes();
        let warp = wishes.iter().find(|wish| wish.place == "fabric.warp").unwrap();
        assert!(warp.text.contains("N/mm") && warp.default_value == "0.5", "{warp:?}");
        assert!(wishes.iter().all(|wish| !wish.text.is_empty() && !wish.default_value.is_empty()));
    }
}
