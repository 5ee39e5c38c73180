//! What was done to the input or could not be done for it, said to the designer.

use glam::DVec3;
use serde::Serialize;

/// A warning: something the designer should know, with where it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Warning {
    /// A frozen short name that programs can test.
    pub code: &'static str,
    /// What it is and what to do about it, for people.
    pub message: String,
    /// Where it is on the surface, in mm, if it is at one place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
}

impl Warning {
    /// A warning about the whole.
    #[must_use]
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), at: None }
    }

    /// A warning about a place.
    #[must_use]
    pub fn at(code: &'static str, message: impl Into<String>, place: DVec3) -> Self {
        Self { code, message: message.into(), at: Some(place.to_array()) }
    }
}
