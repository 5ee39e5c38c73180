//! Changing a design that is no file: by a program, wish by wish, under the rules of the file.
//!
//! The design is written as a file, changed there and read again, so that every limit and every
//! message has one source. What no file holds or what is long and has no limits stays aside.

use serde_json::{Map, Value};

use super::Design;
use super::error::DesignError;
use super::file::{from_value, to_value};
use crate::parameters::nearest_name;

impl Design {
    /// Sets one value by its place in the design file: `fabric.warp`, `piece.name`, `facing`.
    ///
    /// # Errors
    /// As [`parse`](super::parse); the design is then as before.
    pub fn set(&mut self, path: &str, value: Value) -> Result<(), DesignError> {
        if path == "units" {
            let remedy = "say the unit where coordinates are given; here they are in mm";
            return Err(DesignError::value(path, value, remedy));
        }
        self.put(path, Some(whole(value)))
    }

    /// Takes a wish out by its place in the design file, so that its default holds.
    ///
    /// # Errors
    /// If there is no such wish, or what remains breaks a rule; the design is then as before.
    pub fn clear(&mut self, path: &str) -> Result<(), DesignError> {
        match path {
            "pressures" => {
                self.pressures.clear();
                // What was said of how they came to be.
                self.warnings.clear();
            }
            "region_faces" => self.region_faces = None,
            _ => {
                known(path)?;
                self.put(path, None)?;
            }
        }
        Ok(())
    }

    fn put(&mut self, path: &str, value: Option<Value>) -> Result<(), DesignError> {
        *self = self.clone().through_file(|file| {
            let mut place = file;
            let keys: Vec<&str> = path.split('.').collect();
            let Some((last, parents)) = keys.split_last() else { return };
            for key in parents {
                let Some(object) = place.as_object_mut() else { return };
                place = object.entry(*key).or_insert_with(|| Value::Object(Map::new()));
            }
            match (place, value) {
                (Value::Object(object), Some(value)) => {
                    drop(object.insert((*last).to_owned(), value))
                }
                (Value::Object(object), None) => drop(object.remove(*last)),
                // No key has keys of its own here: what it is instead is refused below.
                (place, _) => {
                    *place = Value::Object(Map::from_iter([((*last).to_owned(), Value::Null)]));
                }
            }
        })?;
        Ok(())
    }

    /// The design if every wish keeps the rules of the design file.
    ///
    /// # Errors
    /// As [`parse`](super::parse), with the place that the wish would have in the file.
    pub fn checked(self) -> Result<Self, DesignError> {
        self.through_file(|_| {})
    }

    fn through_file(mut self, change: impl FnOnce(&mut Value)) -> Result<Self, DesignError> {
        let region_faces = self.region_faces.take();
        let warnings = std::mem::take(&mut self.warnings);
        let mut file = to_value(&self)?;
        change(&mut file);
        Ok(Self { unit: self.unit, region_faces, warnings, ..from_value(file)? })
    }
}

/// A number without a fraction as a whole one: a program may hold all its numbers as floating ones.
fn whole(value: Value) -> Value {
    /// Up to here they are exact.
    const MOST: f64 = (1u64 << 53) as f64;
    match value.as_f64() {
        Some(x) if value.is_f64() && x.fract() == 0.0 && (0.0..=MOST).contains(&x) => {
            Value::from(x as u64)
        }
        _ => value,
    }
}

/// Refuses a place that the design file does not have.
fn known(path: &str) -> Result<(), DesignError> {
    let schema = super::schema();
    let mut place = &schema;
    for (i, key) in path.split('.').enumerate() {
        let properties = place.get("properties").and_then(Value::as_object);
        let keys = properties.into_iter().flat_map(|p| p.keys()).map(String::as_str);
        place = properties.and_then(|p| p.get(key)).ok_or_else(|| DesignError::UnknownKey {
            path: path.split('.').take(i + 1).collect::<Vec<_>>().join("."),
            nearest: nearest_name(key, keys).unwrap_or_default().to_owned(),
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use serde_json::json;

    use super::*;
    use crate::design::{Facing, WantedPressure};
    use crate::units::LengthUnit;
    use crate::warning::Warning;

    #[test]
    fn a_value_is_set_and_taken_out_by_its_place_in_the_file() {
        let mut design = Design { unit: Some(LengthUnit::Metre), ..Design::default() };
        design.region_faces = Some(vec![3]);
        design.warnings = vec![Warning::new("said", "before")];
        design.set("fabric.warp", json!(0.1 + 0.2)).unwrap();
        design.set("piece.name", json!("left")).unwrap();
        design.set("facing", json!("inward")).unwrap();
        design.set("limits.max_kpa", json!(20.0)).unwrap();
        assert_eq!(design.fabric.warp.to_bits(), (0.1f64 + 0.2).to_bits());
        assert_eq!((design.piece.name.as_str(), design.facing), ("left", Some(Facing::Inward)));
        assert_eq!(design.limits.max_kpa, Some(20.0));
        design.clear("facing").unwrap();
        design.clear("limits.max_kpa").unwrap();
        assert_eq!((design.facing, design.limits.max_kpa), (None, None));
        // What is no part of the file is still there.
        assert_eq!(
            (design.unit, design.region_faces.as_deref()),
            (Some(LengthUnit::Metre), Some(&[3][..]))
        );
        assert_eq!(design.warnings.len(), 1);
        design.clear("region_faces").unwrap();
        design.clear("pressures").unwrap();
        design.clear("fabric").unwrap();
        design.clear("piece").unwrap();
        assert_eq!(design, Design { unit: Some(LengthUnit::Metre), ..Design::default() });
        let said = design.clear("fabric.wrap").unwrap_err().to_string();
        assert!(said.ends_with("the nearest known key is `warp`"), "{said}");
    }

    #[test]
    fn a_refusal_says_what_the_file_would_say_and_changes_nothing() {
        let mut design = Design::default();
        let mut said = |path: &str, value: Value| design.set(path, value).unwrap_err().to_string();
        assert_eq!(
            said("fabric.wrap", json!(1.0)),
            "`fabric.wrap` is not a known key; the nearest known key is `warp`"
        );
        assert!(said("fabric.warp", json!(0.0)).starts_with("`fabric.warp` is 0"));
        assert!(said("fabric.weft_strain", json!(0.6)).contains("max_strain"));
        assert!(said("pressure_model", json!("laplac")).contains("\"laplace\""));
        assert!(said("facing.x", json!(1.0)).starts_with("`facing`"));
        assert!(said("units", json!("cm")).starts_with("`units`"));
        assert!(said("", json!(1.0)).contains("not a known key"));
        assert_eq!(design, Design::default());
    }

    #[test]
    fn wishes_of_a_program_keep_the_rules_of_the_file() {
        let at = DVec3::new(1.0, 2.0, 3.0);
        let wish =
            |kpa| Design { pressures: vec![WantedPressure { at, kpa }], ..Design::default() };
        assert_eq!(wish(2.5).checked().unwrap(), wish(2.5));
        let said = wish(25.0).checked().unwrap_err().to_string();
        assert!(
            said.starts_with("`pressures[0].kpa` is 25") && said.contains("limits.max_kpa"),
            "{said}"
        );
        assert!(wish(-1.0).checked().is_err() && wish(f64::NAN).checked().is_err());
        let far = Design { orientation: Some([at, 1e9 * at]), ..Design::default() };
        assert!(far.checked().unwrap_err().to_string().starts_with("`orientation[1]`"));
    }
}
