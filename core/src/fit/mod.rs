//! The fit: from a parameterization and wanted strains to pattern coordinates at the minimum of the
//! paper's energy.
//!
//! Two descriptions of the same energy (Eqs. 4–7): `newton` moves the pattern coordinates of the
//! surface's vertices and is the default; `diffusion` moves woven nodes on the surface and is the
//! paper's method, the reference.

pub mod diffusion;
mod energy;
mod history;
pub mod newton;

use glam::DVec2;

pub use energy::{Misfit, stiffness};
pub use history::{HistoryEntry, Stopped, at_plateau};

use crate::design::{Fabric, PressureModel};
use crate::geometry::SurfacePoint;
use crate::mapping::MappingError;
use crate::parameters::Parameters;
use crate::pressure::{Annotation, TargetError, Targets, Woven};
use crate::sparse::SparseError;
use crate::surface::Surface;

/// What a fit starts from.
#[derive(Clone, Copy)]
pub struct FitInput<'a> {
    /// The cut surface.
    pub disk: &'a Surface,
    /// The initial parameterization Ω, in mm at true scale, by vertex.
    pub omega: &'a [DVec2],
    /// The orientation markers, the upper one first.
    pub markers: &'a [SurfacePoint; 2],
    /// The wanted pressures.
    pub annotations: &'a [Annotation],
    /// The fabric.
    pub fabric: &'a Fabric,
    /// The formula of pressure.
    pub pressure_model: PressureModel,
    /// Spacing, damping, stopping.
    pub parameters: &'a Parameters,
}

/// A fabric at rest on the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Pattern coordinates by vertex, in mm, the first marker vertically above the second.
    pub coordinates: Vec<DVec2>,
    /// The woven nodes, where the method has them.
    pub woven: Option<Woven>,
    /// The wanted strains; y as in `coordinates`.
    pub targets: Targets,
    /// The course.
    pub history: Vec<HistoryEntry>,
    /// Steps, all levels together.
    pub iterations: u64,
    /// Why it ended.
    pub stopped: Stopped,
    /// J_E and E_SSD with the wanted strains.
    pub misfit: Misfit,
}

impl Fit {
    /// Puts the course by which its start was found before its own.
    fn prepend(&mut self, mut history: Vec<HistoryEntry>, iterations: u64) {
        for entry in &mut self.history {
            entry.iteration += iterations;
        }
        history.append(&mut self.history);
        self.history = history;
        self.iterations += iterations;
    }
}

/// Why a fit is impossible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Strains could not be determined.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// The surface could not be mapped between two levels.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The linear system failed.
    #[error("the fit cannot be solved: {0}")]
    System(#[from] SparseError),
    /// Stopped from outside.
    #[error("cancelled")]
    Cancelled,
}
