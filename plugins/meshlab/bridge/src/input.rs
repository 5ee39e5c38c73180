//! What is to be flattened or checked: a mesh, wishes and parameters, as the host gives them.

use glam::DVec3;
use serde_json::Value;
use wovenfit_core::PatternFormat;
use wovenfit_core::design::{Design, WantedPressure, condense, parse, schema};
use wovenfit_core::parameters::Parameters;
use wovenfit_core::sheet::SheetUnit;
use wovenfit_core::surface::{RawMesh, on_grid};
use wovenfit_core::units::{LengthUnit, kpa_from_mmhg};

use crate::guard::{Failure, guarded, guarded_in_pool};

/// A mesh with what is wanted of it. Set the parameters first (`units` bears on all coordinates), then
/// the design, then the mesh.
pub struct Input {
    pub(crate) parameters: Parameters,
    pub(crate) design: Design,
    pub(crate) raw: RawMesh,
    pub(crate) formats: Vec<PatternFormat>,
    pub(crate) sheet_unit: SheetUnit,
}

/// Nothing yet: defaults, no wishes, no mesh.
pub(crate) fn new_input() -> Box<Input> {
    Box::new(Input {
        parameters: Parameters::default(),
        design: Design::default(),
        raw: RawMesh::default(),
        formats: PatternFormat::USUAL.to_vec(),
        sheet_unit: SheetUnit::default(),
    })
}

impl Input {
    /// Sets a parameter of the table from text.
    pub(crate) fn set_parameter(&mut self, name: &str, value: &str) -> Result<(), Failure> {
        guarded(|| self.parameters.set(name, value).map_err(Failure::new))
    }

    /// Takes the design from the bytes of a design file.
    pub(crate) fn read_design(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        guarded(|| {
            let json = str::from_utf8(bytes).map_err(|error| {
                let place = error.valid_up_to();
                Failure(format!("byte {place} is not UTF-8 text: save the design as UTF-8"))
            })?;
            self.design = parse(json, self.parameters.units).map_err(Failure::new)?;
            Ok(())
        })
    }

    /// Sets a single value by its place in the design file from text.
    pub(crate) fn set_wish(&mut self, place: &str, value: &str) -> Result<(), Failure> {
        guarded(|| {
            let pointer = format!("/properties/{}/type", place.replace('.', "/properties/"));
            let number = schema().pointer(&pointer).and_then(Value::as_str) == Some("number");
            let value = if number {
                let refused =
                    || Failure(format!("`{place}` is `{value}`: give a number, or nothing"));
                let number: f64 = value.trim().parse().map_err(|_| refused())?;
                Value::Number(serde_json::Number::from_f64(number).ok_or_else(refused)?)
            } else {
                Value::String(value.to_owned())
            };
            self.design.set(place, value).map_err(Failure::new)
        })
    }

    /// Says in which formats the pattern is written, their names with commas between them, and in which
    /// unit, `mm` or `in`.
    pub(crate) fn set_formats(&mut self, names: &str, unit: &str) -> Result<(), Failure> {
        guarded(|| {
            let known = || PatternFormat::ALL.map(PatternFormat::name).join(", ");
            let named = |name: &str| {
                PatternFormat::named(name).ok_or_else(|| {
                    Failure(format!(
                        "`{name}` is no format of the pattern: give some of {}",
                        known()
                    ))
                })
            };
            let names = names.split(',').map(str::trim).filter(|name| !name.is_empty());
            self.formats = names.map(named).collect::<Result<_, _>>()?;
            self.sheet_unit = SheetUnit::named(unit).ok_or_else(|| {
                Failure(format!("`{unit}` is no unit of the pattern: give mm or in"))
            })?;
            Ok(())
        })
    }

    /// Takes the mesh: x, y, z of every vertex, three vertices for every triangle.
    pub(crate) fn set_mesh(&mut self, points: &[f64], triangles: &[u32]) -> Result<(), Failure> {
        guarded(|| {
            self.raw = RawMesh {
                points: points.chunks_exact(3).map(DVec3::from_slice).collect(),
                polygons: triangles
                    .chunks_exact(3)
                    .map(|corners| corners.iter().map(|&v| v as usize).collect())
                    .collect(),
            };
            Ok(())
        })
    }

    /// The unit of the mesh: what the parameter says, else the design, else millimetres.
    fn length_unit(&self) -> LengthUnit {
        self.parameters.units.or(self.design.unit).unwrap_or(LengthUnit::Millimetre)
    }

    /// Its name.
    pub(crate) fn unit(&self) -> String {
        self.length_unit().symbol().to_owned()
    }

    /// Millimetres in one of it.
    pub(crate) fn mm_per_unit(&self) -> f64 {
        self.length_unit().millimetres()
    }

    fn in_mm(&self, point: DVec3) -> DVec3 {
        on_grid(point, self.mm_per_unit())
    }

    /// Adds a wanted pressure at a point in the mesh's unit; `unit` is that of the pressure.
    pub(crate) fn add_pressure(
        &mut self,
        at: [f64; 3],
        value: f64,
        unit: &str,
    ) -> Result<(), Failure> {
        guarded(|| {
            let at = self.in_mm(DVec3::from_array(at));
            let wanted = WantedPressure { at, kpa: kpa(value, unit)? };
            self.change(|design| design.pressures.push(wanted))
        })
    }

    /// Adds the pressures painted onto the mesh, a value for every vertex, 0 where nothing is asked;
    /// a value of 1 stands for `scale` of the `unit`.
    pub(crate) fn paint(&mut self, values: &[f64], scale: f64, unit: &str) -> Result<(), Failure> {
        guarded_in_pool(|| {
            if !(scale.is_finite() && scale > 0.0) {
                let text = format!(
                    "the pressure at quality 1 is {scale} {unit}: give a number above 0, the pressure \
                     that a vertex quality of 1 asks for"
                );
                return Err(Failure(text));
            }
            let points: Vec<DVec3> = self.raw.points.iter().map(|&p| self.in_mm(p)).collect();
            let wrong = |value: f64| !(value.is_finite() && value >= 0.0);
            if let Some(v) = values.iter().position(|&value| wrong(value)) {
                let [x, y, z] = points[v].to_array();
                return Err(Failure(format!(
                    "vertex {v} at ({x:.1}, {y:.1}, {z:.1}) mm has the quality {}, which is no \
                     pressure: paint 0 where nothing is asked and positive values elsewhere",
                    values[v]
                )));
            }
            let values = values.iter().map(|value| kpa(scale * value, unit));
            let values = values.collect::<Result<Vec<f64>, Failure>>()?;
            let painted = condense(&points, &self.raw.polygons, &values);
            if painted.pressures.is_empty() {
                return Err(Failure::new(
                    "the vertex quality is 0 everywhere: give vertices the pressure that is wanted \
                     there as their quality, or take the pressures from a file",
                ));
            }
            self.change(|design| {
                design.pressures.extend(painted.pressures);
                design.warnings.extend(painted.warning);
            })
        })
    }

    /// Sets the triangles that the brace covers.
    pub(crate) fn select(&mut self, triangles: &[u32]) -> Result<(), Failure> {
        guarded(|| {
            if triangles.is_empty() {
                return Err(Failure::new(
                    "no face is selected: select the faces that the brace covers, or switch off \
                     \"Selected faces only\" to cover all",
                ));
            }
            self.design.region_faces = Some(triangles.iter().map(|&t| t as usize).collect());
            Ok(())
        })
    }

    /// Changes the wishes, if the rules of the design file allow it.
    fn change(&mut self, change: impl FnOnce(&mut Design)) -> Result<(), Failure> {
        let mut design = self.design.clone();
        change(&mut design);
        self.design = design.checked().map_err(Failure::new)?;
        Ok(())
    }
}

fn kpa(value: f64, unit: &str) -> Result<f64, Failure> {
    match unit {
        "kPa" => Ok(value),
        "mmHg" => Ok(kpa_from_mmhg(value)),
        _ => Err(Failure(format!("`{unit}` is no unit of pressure: give kPa or mmHg"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_in_the_parameters_unit_and_pressures_in_theirs() {
        let mut input = new_input();
        input.set_parameter("units", "cm").unwrap();
        input.read_design(br#"{"pressures": [{"at": [1, 0, 0], "kpa": 1}]}"#).unwrap();
        input.add_pressure([0.0, 2.0, 0.0], 10.0, "mmHg").unwrap();
        let [file, picked] = input.design.pressures[..] else { panic!() };
        assert_eq!((file.at, file.kpa), (DVec3::new(10.0, 0.0, 0.0), 1.0));
        assert_eq!(picked.at, DVec3::new(0.0, 20.0, 0.0));
        assert!((picked.kpa - 1.33322).abs() < 1e-12);
        assert_eq!(input.unit(), "cm");
        assert!(input.add_pressure([0.0; 3], 1.0, "bar").unwrap_err().0.contains("kPa or mmHg"));
        assert!(input.add_pressure([0.0; 3], 20.0, "kPa").unwrap_err().0.contains("13.3"));
        assert_eq!(input.design.pressures.len(), 2);
    }

    #[test]
    fn painted_values_are_scaled_and_what_is_no_pressure_is_refused_with_its_place() {
        let mut input = new_input();
        let points = [0.0, 0.0, 0.0, 30.0, 0.0, 0.0, 0.0, 30.0, 0.0];
        input.set_mesh(&points, &[0, 1, 2]).unwrap();
        input.paint(&[0.0, 0.5, 0.0], 4.0, "kPa").unwrap();
        let wanted = WantedPressure { at: DVec3::new(30.0, 0.0, 0.0), kpa: 2.0 };
        assert_eq!(input.design.pressures, [wanted]);
        let mut said = |values: &[f64], scale| input.paint(values, scale, "kPa").unwrap_err().0;
        assert!(said(&[0.0, 0.0, -1.0], 1.0).starts_with("vertex 2 at (0.0, 30.0, 0.0) mm"));
        assert!(said(&[0.0, f64::NAN, 0.0], 1.0).contains("NaN"));
        assert!(said(&[0.0; 3], 1.0).contains("0 everywhere"));
        assert!(said(&[1.0; 3], 0.0).contains("above 0"));
    }

    #[test]
    fn single_wishes_are_numbers_or_texts_as_the_schema_says() {
        let mut input = new_input();
        input.set_wish("fabric.warp", " 0.8 ").unwrap();
        input.set_wish("fabric.name", "12").unwrap();
        assert_eq!((input.design.fabric.warp, input.design.fabric.name.as_str()), (0.8, "12"));
        assert!(input.set_wish("fabric.weft", "much").unwrap_err().0.contains("give a number"));
        assert!(input.set_wish("fabric.weft", "0").unwrap_err().0.starts_with("`fabric.weft`"));
        assert!(input.select(&[]).unwrap_err().0.contains("no face is selected"));
    }
}
