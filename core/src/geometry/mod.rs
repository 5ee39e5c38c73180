//! Geometry of a surface: location, curvature, straightest paths, girths.

mod location;

pub use location::{Locator, SurfacePoint, closest_on_triangle};
