//! Why a limb cannot be flattened: the sum of the stages' errors.

use glam::{DVec2, DVec3};

use crate::fit::FitError;
use crate::geometry::UnitError;
use crate::mapping::MappingError;
use crate::parameterize::ParameterizeError;
use crate::seams::SeamError;
use crate::surface::SurfaceError;

/// Why [`flatten`](crate::flatten) cannot give a pattern. The text says what, where and what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// The surface is broken.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The surface is no limb in this unit.
    #[error(transparent)]
    Unit(#[from] UnitError),
    /// Region, cut or orientation are impossible.
    #[error(transparent)]
    Seam(#[from] SeamError),
    /// A wanted pressure far from the surface.
    #[error(
        "pressure {number} at ({:.1}, {:.1}, {:.1}) mm lies {distance:.1} mm from the surface; at \
         most 10 mm is taken: check its place and the design's `units`",
        at.x, at.y, at.z
    )]
    PressureFar {
        /// Which pressure, from 1.
        number: usize,
        /// Where it was asked, in mm.
        at: DVec3,
        /// Its distance, in mm.
        distance: f64,
    },
    /// A wanted pressure on the limb and outside the brace.
    #[error(
        "pressure {number} at ({:.1}, {:.1}, {:.1}) mm lies {distance:.1} mm outside the region \
         that the brace covers: move it, or let the region reach further",
        at.x, at.y, at.z
    )]
    PressureOutside {
        /// Which pressure, from 1.
        number: usize,
        /// Where it was asked, in mm.
        at: DVec3,
        /// Distance to the covered region, in mm.
        distance: f64,
    },
    /// No initial parameterization.
    #[error(transparent)]
    Parameterize(ParameterizeError),
    /// No fit.
    #[error(transparent)]
    Fit(FitError),
    /// The fabric does not cover the surface.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// Threads so close that their nodes do not fit into memory.
    #[error(
        "threads {spacing} mm apart on a pattern of {:.0} × {:.0} mm are {:.0} million nodes; \
         {most} million are the most: use a spacing of at least {least:.1} mm",
        size.x, size.y, nodes / 1e6
    )]
    TooManyNodes {
        /// The spacing, in mm.
        spacing: f64,
        /// Size of the initial parameterization, in mm.
        size: DVec2,
        /// How many nodes a grid over it has.
        nodes: f64,
        /// The most, in millions.
        most: f64,
        /// A spacing that gives no more, in mm.
        least: f64,
    },
    /// A design was solved on a surface that was prepared for another.
    #[error("the surface was prepared with another `{what}`: prepare it anew for this design")]
    PreparedForAnother {
        /// What differs.
        what: &'static str,
    },
    /// The job was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl From<ParameterizeError> for Error {
    fn from(error: ParameterizeError) -> Self {
        match error {
            ParameterizeError::Cancelled => Self::Cancelled,
            other => Self::Parameterize(other),
        }
    }
}

impl From<FitError> for Error {
    fn from(error: FitError) -> Self {
        match error {
            FitError::Cancelled => Self::Cancelled,
            other => Self::Fit(other),
        }
    }
}
