//! Rigid motions of meshes and of design files.

use glam::{DQuat, DVec3};
use serde_json::Value;

use crate::mesh::Mesh;

/// A rotation about the origin, then a translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// The rotation.
    pub rotation: DQuat,
    /// The translation.
    pub translation: DVec3,
}

impl Motion {
    /// A turn about an axis, in radians, then a translation.
    #[must_use]
    pub fn new(axis: DVec3, angle: f64, translation: DVec3) -> Self {
        Self { rotation: DQuat::from_axis_angle(axis.normalize(), angle), translation }
    }

    /// Where a point comes to lie.
    #[must_use]
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.rotation * p + self.translation
    }

    /// The moved mesh.
    #[must_use]
    pub fn mesh(&self, mesh: &Mesh) -> Mesh {
        Mesh { points: mesh.points.iter().map(|&p| self.point(p)).collect(), ..mesh.clone() }
    }

    /// The moved design: wanted points, markers, seams, bony places and the region's planes. The
    /// design's coordinates must be in the translation's unit.
    #[must_use]
    pub fn design(&self, design: &Value) -> Value {
        let mut moved = design.clone();
        let point = |p: DVec3| self.point(p);
        for path in ["/orientation", "/seams", "/limits/bony"] {
            if let Some(value) = moved.pointer_mut(path) {
                each_point(value, &point);
            }
        }
        for wanted in items(&mut moved, "pressures") {
            each_point(&mut wanted["at"], &point);
        }
        for plane in items(&mut moved, "region") {
            each_point(&mut plane["point"], &point);
            each_point(&mut plane["normal"], &|n| self.rotation * n);
        }
        moved
    }
}

fn items<'a>(design: &'a mut Value, key: &str) -> impl Iterator<Item = &'a mut Value> {
    design.get_mut(key).and_then(Value::as_array_mut).into_iter().flatten()
}

/// Applies `to` to every array of three numbers inside a value.
fn each_point(value: &mut Value, to: &impl Fn(DVec3) -> DVec3) {
    let Some(array) = value.as_array_mut() else { return };
    if let [Some(x), Some(y), Some(z)] =
        array.iter().map(Value::as_f64).collect::<Vec<_>>().as_slice()
    {
        let moved = to(DVec3::new(*x, *y, *z));
        *value = moved.to_array().to_vec().into();
    } else {
        array.iter_mut().for_each(|inner| each_point(inner, to));
    }
}

/// The same design with every coordinate multiplied and the unit's name set.
#[must_use]
pub fn design_in_unit(design: &Value, unit: &str, per_mm: f64) -> Value {
    let mut scaled = design.clone();
    let scale = |p: DVec3| per_mm * p;
    for path in ["/orientation", "/seams", "/limits/bony"] {
        if let Some(value) = scaled.pointer_mut(path) {
            each_point(value, &scale);
        }
    }
    for wanted in items(&mut scaled, "pressures") {
        each_point(&mut wanted["at"], &scale);
    }
    for plane in items(&mut scaled, "region") {
        each_point(&mut plane["point"], &scale);
    }
    scaled["units"] = unit.into();
    scaled
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_quarter_turn_moves_points_and_turns_normals() {
        let motion = Motion::new(DVec3::Z, std::f64::consts::FRAC_PI_2, DVec3::new(0.0, 0.0, 5.0));
        let design = json!({
            "pressures": [{"at": [1.0, 0.0, 0.0], "kpa": 2.0}],
            "orientation": [[2, 0, 0], [0, 2, 0]],
            "region": [{"point": [1.0, 0.0, 0.0], "normal": [1.0, 0.0, 0.0]}],
            "seams": [[[3.0, 0.0, 0.0]]],
        });
        let moved = motion.design(&design);
        let at = |pointer: &str| -> Vec<f64> {
            let value = moved.pointer(pointer).unwrap().as_array().unwrap();
            value.iter().map(|x| (x.as_f64().unwrap() * 1e9).round() / 1e9).collect()
        };
        assert_eq!(at("/pressures/0/at"), [0.0, 1.0, 5.0]);
        assert_eq!(moved["pressures"][0]["kpa"], 2.0);
        assert_eq!(at("/orientation/1"), [-2.0, 0.0, 5.0]);
        assert_eq!(at("/region/0/normal"), [0.0, 1.0, 0.0]);
        assert_eq!(at("/seams/0/0"), [0.0, 3.0, 5.0]);
        let metres = design_in_unit(&design, "m", 1e-3);
        assert_eq!(metres["pressures"][0]["at"][0], 1e-3);
        assert_eq!(metres["region"][0]["normal"][0], 1.0);
        assert_eq!(metres["units"], "m");
    }
}
