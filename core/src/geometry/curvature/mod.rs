//! Curvature of a surface, as a shape operator at any of its points.
//!
//! Two estimates behind one type: over a stated radius in mm, for scans ([`ScaleCurvature`]), and
//! from the triangles round each vertex, for clean meshes ([`MeyerCurvature`]). Curvatures are
//! signed: where the surface bulges outward they are positive.

mod clusters;
mod meyer;
mod operator;
mod patch;
mod scale;

pub use meyer::{MeyerCurvature, VertexCurvature, meyer_mean_and_gaussian};
pub use operator::ShapeOperator;
pub use scale::{ScaleCurvature, ScaleFit};

use super::location::SurfacePoint;
use crate::parameters::{CurvatureEstimate, Parameters};
use crate::surface::{Surface, VertexId};

/// The curvature of a surface by the estimate that the parameters name.
#[derive(Debug)]
pub enum Curvature<'a> {
    /// Over a radius: for scans.
    Scale(ScaleCurvature<'a>),
    /// From the triangles round each vertex: for clean, smooth meshes.
    Meyer(MeyerCurvature<'a>),
}

impl<'a> Curvature<'a> {
    /// Prepares the estimate `parameters.curvature` of a surface, with
    /// `parameters.curvature_radius` where it has a radius.
    #[must_use]
    pub fn new(surface: &'a Surface, parameters: &Parameters) -> Self {
        match parameters.curvature {
            CurvatureEstimate::Scale => {
                Self::Scale(ScaleCurvature::new(surface, parameters.curvature_radius))
            }
            CurvatureEstimate::Meyer => Self::Meyer(MeyerCurvature::new(surface)),
        }
    }

    /// The shape operator at a point of the surface.
    #[must_use]
    pub fn at(&self, point: &SurfacePoint) -> ShapeOperator {
        match self {
            Self::Scale(scale) => scale.at(point),
            Self::Meyer(meyer) => meyer.at(point),
        }
    }

    /// The shape operators at points of the surface.
    #[must_use]
    pub fn at_all(&self, points: &[SurfacePoint]) -> Vec<ShapeOperator> {
        match self {
            Self::Scale(scale) => scale.fit_all(points).into_iter().map(|fit| fit.shape).collect(),
            Self::Meyer(meyer) => points.iter().map(|point| meyer.at(point)).collect(),
        }
    }

    /// The shape operator at a vertex of the surface.
    #[must_use]
    pub fn at_vertex(&self, v: VertexId) -> ShapeOperator {
        match self {
            Self::Scale(scale) => scale.at_vertex(v),
            Self::Meyer(meyer) => meyer.at_vertex(v),
        }
    }

    /// The shape operators at all vertices, by vertex.
    #[must_use]
    pub fn at_vertices(&self) -> Vec<ShapeOperator> {
        match self {
            Self::Scale(scale) => scale.at_vertices(),
            Self::Meyer(meyer) => meyer.at_vertices().to_vec(),
        }
    }
}
