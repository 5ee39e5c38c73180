//! Checks a JSON value against a JSON schema: the part of draft 2020-12 that the design uses.
//!
//! The schema is generated from the types that are read ([`super::file`]), so known keys, ranges
//! and descriptions have one source. Unlike a deserialiser this names the full path of what is
//! wrong and the nearest known key.

use serde_json::{Map, Value};

use super::error::DesignError;
use crate::parameters::nearest_name;

/// Longest piece of JSON shown in a message.
const SHOWN: usize = 60;

/// Checks `value` at `path` (empty for the whole) against `schema`.
pub(super) fn check(value: &Value, schema: &Value, path: &str) -> Result<(), DesignError> {
    if let Some(names) = choices(schema) {
        let known = value.as_str().is_some_and(|text| names.contains(&text));
        return if known { Ok(()) } else { Err(refuse(value, schema, path, &one_of(&names))) };
    }
    match (schema.get("type").and_then(Value::as_str), value) {
        (Some("object"), Value::Object(object)) => check_object(object, schema, path),
        (Some("object"), _) => Err(refuse(value, schema, path, "give an object, { … }")),
        (Some("array"), Value::Array(items)) => check_array(value, items, schema, path),
        (Some("array"), _) => Err(refuse(value, schema, path, &list_wanted(schema))),
        (Some("number"), Value::Number(_)) => check_range(value, schema, path),
        (Some("number"), _) => Err(refuse(value, schema, path, "give a number")),
        (Some("integer"), Value::Number(number)) if number.is_u64() => {
            check_range(value, schema, path)
        }
        (Some("integer"), _) => Err(refuse(value, schema, path, "give a whole number, 0 or more")),
        (Some("string"), Value::String(_)) => Ok(()),
        (Some("string"), _) => Err(refuse(value, schema, path, "give a text in quotes")),
        _ => Ok(()),
    }
}

fn check_object(
    object: &Map<String, Value>,
    schema: &Value,
    path: &str,
) -> Result<(), DesignError> {
    let Some(properties) = schema.get("properties").and_then(Value::as_object) else {
        return Ok(());
    };
    for (key, value) in object {
        let place = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let Some(wanted) = properties.get(key) else {
            let nearest = nearest_name(key, properties.keys().map(String::as_str));
            return Err(DesignError::UnknownKey {
                path: place,
                nearest: nearest.unwrap_or_default().to_owned(),
            });
        };
        check(value, wanted, &place)?;
    }
    let required = schema.get("required").and_then(Value::as_array).into_iter().flatten();
    let mut required = required.filter_map(Value::as_str);
    if let Some(key) = required.find(|key| !object.contains_key(*key)) {
        let place = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        let remedy = properties.get(key).and_then(description).unwrap_or("give it");
        return Err(DesignError::Missing { path: place, remedy: remedy.to_owned() });
    }
    Ok(())
}

fn check_array(
    value: &Value,
    items: &[Value],
    schema: &Value,
    path: &str,
) -> Result<(), DesignError> {
    let bound = |key: &str| schema.get(key).and_then(Value::as_u64);
    let count = items.len() as u64;
    if bound("minItems").is_some_and(|least| count < least)
        || bound("maxItems").is_some_and(|most| count > most)
    {
        return Err(refuse(value, schema, path, &list_wanted(schema)));
    }
    let Some(wanted) = schema.get("items") else { return Ok(()) };
    let mut items = items.iter().enumerate();
    items.try_for_each(|(i, item)| check(item, wanted, &format!("{path}[{i}]")))
}

fn check_range(value: &Value, schema: &Value, path: &str) -> Result<(), DesignError> {
    let bound = |key: &str| schema.get(key).and_then(Value::as_f64);
    let number = value.as_f64().unwrap_or(f64::NAN);
    let low = bound("minimum").map(|low| (number >= low, format!("at least {low}")));
    let above = bound("exclusiveMinimum").map(|low| (number > low, format!("more than {low}")));
    let high = bound("maximum").map(|high| (number <= high, format!("at most {high}")));
    let bounds: Vec<(bool, String)> = [low, above, high].into_iter().flatten().collect();
    if number.is_finite() && bounds.iter().all(|(holds, _)| *holds) {
        return Ok(());
    }
    let range: Vec<&str> = bounds.iter().map(|(_, words)| words.as_str()).collect();
    Err(refuse(value, schema, path, &format!("give a number, {}", range.join(" and "))))
}

/// An error with the remedy and, in brackets, what the value is for.
fn refuse(value: &Value, schema: &Value, path: &str, remedy: &str) -> DesignError {
    let path = if path.is_empty() { "the design" } else { path };
    let meaning = description(schema).map_or_else(String::new, |text| {
        let first = text.split(". ").next().unwrap_or(text).trim_end_matches('.');
        format!(" ({first})")
    });
    DesignError::value(path, shown(value), format!("{remedy}{meaning}"))
}

fn description(schema: &Value) -> Option<&str> {
    schema.get("description").and_then(Value::as_str)
}

/// The value as JSON, shortened.
pub(super) fn shown(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= SHOWN {
        return text;
    }
    text.chars().take(SHOWN).chain(['…']).collect()
}

/// The texts that a value may be, if it is a choice.
fn choices(schema: &Value) -> Option<Vec<&str>> {
    if let Some(names) = schema.get("enum").and_then(Value::as_array) {
        return Some(names.iter().filter_map(Value::as_str).collect());
    }
    let variants = schema.get("oneOf").and_then(Value::as_array)?;
    // Objects use `oneOf` for keys of which one is needed; those variants name no texts.
    let names: Vec<&str> = variants
        .iter()
        .flat_map(|variant| match variant.get("enum").and_then(Value::as_array) {
            Some(names) => names.iter().collect(),
            None => variant.get("const").into_iter().collect::<Vec<_>>(),
        })
        .filter_map(Value::as_str)
        .collect();
    if names.is_empty() { None } else { Some(names) }
}

fn one_of(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    format!("give one of {}", quoted.join(", "))
}

fn list_wanted(schema: &Value) -> String {
    let bound = |key: &str| schema.get(key).and_then(Value::as_u64);
    let of = match schema.pointer("/items/type").and_then(Value::as_str) {
        Some("number") => "numbers",
        Some("integer") => "whole numbers",
        Some("array") => "points, each [x, y, z]",
        _ => "objects, each { … }",
    };
    let of = match schema.pointer("/items/items/type").and_then(Value::as_str) {
        Some("array") => "polylines, each [[x, y, z], …]",
        _ => of,
    };
    match (bound("minItems"), bound("maxItems")) {
        (Some(least), Some(most)) if least == most => format!("give a list of {least} {of}"),
        (Some(least), _) if least > 0 => format!("give a list of {least} or more {of}"),
        _ => format!("give a list of {of}"),
    }
}
