//! Geometry of a surface: location, curvature, straightest paths, girths.

mod curvature;
mod delaunay;
mod girth;
mod grading;
mod location;
#[cfg(test)]
pub(crate) mod shapes;
mod smoothing;
mod straightest;

pub use curvature::{
    Curvature, MeyerCurvature, ScaleCurvature, ScaleFit, ShapeOperator, VertexCurvature,
    meyer_mean_and_gaussian,
};
pub use delaunay::Delaunay;
pub use girth::{Girth, Measures, UnitError, guard_unit, measure};
pub use grading::{FINEST_MM, Grading};
pub use location::{ExactPlaces, Locator, SurfacePoint, closest_on_triangle};
pub use smoothing::{curvature_noise, noise, smooth};
pub use straightest::{Walk, walk};
