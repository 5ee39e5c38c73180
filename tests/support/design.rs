//! Design files for the fixtures.

use glam::DVec3;
use serde_json::{Value, json};

/// A design in mm with the fabric 0.5 / 0.5 / 0.05 N/mm that wants these pressures in kPa.
#[must_use]
pub fn wanting(pressures: &[(DVec3, f64)]) -> Value {
    let pressures: Vec<Value> =
        pressures.iter().map(|(at, kpa)| json!({"at": at.to_array(), "kpa": kpa})).collect();
    json!({
        "units": "mm",
        "fabric": {"name": "test", "warp": 0.5, "weft": 0.5, "diagonal": 0.05},
        "pressures": pressures,
    })
}

/// The same design with these orientation markers, the first near the body.
#[must_use]
pub fn upright(mut design: Value, first: DVec3, second: DVec3) -> Value {
    design["orientation"] = json!([first.to_array(), second.to_array()]);
    design
}
