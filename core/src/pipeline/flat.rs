//! A cut surface laid flat: what the fit of it starts from, with triangles as small as that needs.

use glam::DVec2;

use super::go_on;
use crate::design::{Fabric, PressureModel};
use crate::error::Error;
use crate::field::Relief;
use crate::fit::newton::{Solver, folds};
use crate::fit::{FitError, FitInput};
use crate::geometry::Grading;
use crate::parameterize::{Parameterization, ParameterizeError, initial, upright};
use crate::parameters::{Method, Parameters};
use crate::pattern::free_edges;
use crate::progress::Progress;
use crate::seams::{CutSurface, Finer, Markers, place};
use crate::sparse::Matrix;
use crate::surface::Surface;

/// A cut surface laid flat.
pub(super) struct Flat {
    /// The cut surface, with smaller triangles at its folds.
    pub cut: CutSurface,
    /// The initial parameterization Ω.
    pub omega: Parameterization,
    /// What the default fit prepares.
    pub solver: Option<Solver>,
    /// What the field at every vertex is computed from.
    pub relief: Relief,
}

impl Flat {
    /// Lays a cut surface flat, the markers upright.
    ///
    /// # Errors
    /// If it cannot be laid flat, memory runs out or the job is cancelled.
    pub fn new(
        scan: &Surface,
        cut: CutSurface,
        markers: &Markers,
        parameters: &Parameters,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        let (laid, relief) = rayon::join(
            || laid(&cut, markers, parameters, progress),
            || Relief::new(scan, &cut.disk, &cut.seams, parameters, progress),
        );
        let ((mut omega, solver, grading), relief) = (laid?, relief.ok_or(Error::Cancelled)?);
        let Some(solver) = solver else {
            return Ok(Self { cut, omega, solver: None, relief });
        };
        let Some(finer) = Finer::new(&cut, &grading) else {
            return Ok(Self { cut, omega, solver: Some(solver), relief });
        };
        omega.coordinates = finer.extended(&omega.coordinates);
        let (solver, relief) = rayon::join(
            || another(&finer.cut, &omega.coordinates, &solver, &grading, parameters),
            || relief.finer(&finer, parameters, progress),
        );
        let (solver, relief) = (Some(solver?), relief.ok_or(Error::Cancelled)?);
        Ok(Self { cut: finer.cut, omega, solver, relief })
    }
}

/// What the fit of a surface with smaller triangles prepares, with the room of that of the surface as it was.
fn another(
    cut: &CutSurface,
    omega: &[DVec2],
    before: &Solver,
    grading: &Grading,
    parameters: &Parameters,
) -> Result<Solver, FitError> {
    let (disk, seams, equal) = (&cut.disk, &cut.seams, parameters.equal_seams);
    let mut solver = match Solver::well_shaped(disk, seams, omega, equal)? {
        Some(solver) => solver,
        None => Solver::new(disk, seams, equal)?,
    };
    solver.matrix().take_over(before.matrix());
    solver.coarsen(disk, seams, omega, equal, grading)?;
    Ok(solver)
}

/// The initial parameterization, and what the default fit prepares: both are solved on one matrix. And how small that
/// wants the triangles.
fn laid(
    cut: &CutSurface,
    markers: &Markers,
    parameters: &Parameters,
    progress: &dyn Progress,
) -> Result<(Parameterization, Option<Solver>, Grading), Error> {
    match parameters.method {
        Method::Newton => {
            let (disk, seams, equal) = (&cut.disk, &cut.seams, parameters.equal_seams);
            let mut solver = Solver::new(disk, seams, equal)?;
            go_on(progress)?;
            let omega = initial(disk, solver.matrix(), &markers.points, progress)?;
            if let Some(shaped) = Solver::well_shaped(disk, seams, &omega.coordinates, equal)? {
                shaped.matrix().take_over(solver.matrix());
                solver = shaped;
            }
            solver.coarsen(disk, seams, &omega.coordinates, equal, &Grading::default())?;
            let grading = graded(cut, &solver, &omega.coordinates, parameters, progress)?;
            Ok((omega, Some(solver), grading))
        }
        Method::Diffusion => {
            let matrix = Matrix::new(&cut.disk, &[]).map_err(ParameterizeError::from)?;
            go_on(progress)?;
            let omega = initial(&cut.disk, &matrix, &markers.points, progress)?;
            Ok((omega, None, Grading::default()))
        }
    }
}

/// Small triangles at the folds. Where these are depends on the limb and its cut alone, so that changed wishes have the
/// pattern that they would have had from the start.
fn graded(
    cut: &CutSurface,
    solver: &Solver,
    omega: &[DVec2],
    parameters: &Parameters,
    progress: &dyn Progress,
) -> Result<Grading, Error> {
    if !Finer::is_of_use(&cut.disk) {
        return Ok(Grading::default());
    }
    let Ok((markers, _)) = place(cut, None) else { return Ok(Grading::default()) };
    let Ok(omega) = upright(omega, &cut.disk, &markers.points) else {
        return Ok(Grading::default());
    };
    let input = FitInput {
        disk: &cut.disk,
        omega: &omega,
        markers: &markers.points,
        annotations: &[],
        fabric: &Fabric::default(),
        pressure_model: PressureModel::default(),
        parameters: &Parameters { equal_seams: parameters.equal_seams, ..Parameters::default() },
    };
    Ok(Grading::new(folds(solver, &input, &free_edges(cut), progress)?))
}
