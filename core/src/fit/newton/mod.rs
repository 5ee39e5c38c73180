//! The default fit: the paper's energy minimised over the pattern coordinates of the surface's vertices,
//! by Newton steps.
//!
//! The same J_E as the woven nodes' (`element`), with nothing to insert, to remove or to interpolate:
//! the outline is exact and the sparsity never changes. Each step takes the Gauss–Newton matrix, or near
//! the minimum the Hessian with a part of its negative curvature left out (`element`), one sparse Cholesky
//! factorization (the crate's `sparse`), and a line search that never lets a
//! triangle turn over. Sewn edges keep equal lengths (`seam`), shortened threads do not buckle
//! (`straight`), springs that are stretched beyond any fabric stiffen (`element::stiffening`), the
//! markers stay on one weft line as a linear constraint, and the target strains are corrected until the pressures are met (`pressures`).
//! The row's target strain ε(t) follows the vertices' weft coordinates as they move, and its slope is
//! part of the derivatives; what follows in turn (the threads through the annotated points, the
//! directions of the turning springs) is brought up to date before every step.
//!
//! Where steps shrink slowly the fabric is softer than that matrix: a lobe swings about a fold whose
//! triangles are far from convex. Then the step is made exact: the equations with the forces' true
//! derivatives, as differences, are solved by GMRES with the factorized matrix as preconditioner
//! (`run::exact`, `krylov`; a Newton–Krylov method, Knoll & Keyes, *Jacobian-free Newton–Krylov
//! methods*, 2004).
//!
//! It ends when the full step, which is the gradient scaled by the Hessian, moves no vertex by more
//! than `newton_tolerance` (`step`); where steps had to be made exact, the exact one. Where a notch is
//! stretched so, vertices come to rest one by one on the way (`triangles::relax`).
//!
//! Limit: triangles never turn over, but the outline may cross itself on a limb that cannot be
//! flattened in one piece; the pattern says where.

mod anderson;
mod coarse;
mod course;
mod eigen;
mod element;
mod folds;
mod krylov;
mod least_squares;
mod pressures;
mod problem;
mod run;
mod seam;
mod step;
mod straight;
#[cfg(test)]
mod tests;
mod thinned;
mod triangles;

use std::sync::Arc;

use glam::DVec2;

use self::coarse::{Coarse, Quiet, Start};
use self::element::Springs;
pub use self::folds::folds;
use self::pressures::Answers;
use self::problem::Model;
pub use self::run::Run;
use self::seam::Sewn;
use self::triangles::Triangles;
use super::{Fit, FitError, FitInput, Stopped};
use crate::geometry::{Delaunay, Grading};
use crate::parameterize::{RestTriangle, rest_of_lengths, rest_triangles};
use crate::progress::Progress;
use crate::seams::Seam;
use crate::sparse::Matrix;
use crate::surface::Surface;

/// A prepared surface: what of the fit does not change with pressures, fabric and markers.
pub struct Solver {
    triangles: Triangles,
    sewn: Sewn,
    matrix: Matrix,
    /// Shares of the vertices in the worn area.
    shares: Vec<f64>,
    /// The same surface with fewer vertices, from which a first fit begins.
    coarse: Option<Box<Coarse>>,
}

/// What a fit leaves to the next one of the same surface: its last Hessian, how the pressures answer to
/// the targets, and the fit on fewer vertices.
pub struct Kept {
    model: Arc<Model>,
    /// That without seams, if it was asked what these cost.
    free: Option<Arc<Model>>,
    springs: Springs,
    upright: Vec<(usize, f64)>,
    answers: Option<Arc<Answers>>,
    /// Of the seams' edges, in N.
    tensions: Vec<f64>,
    coarse: Option<Box<Below>>,
}

/// A fit of the thinned surface, and what it leaves to the next.
pub struct Below {
    fit: Fit,
    kept: Option<Kept>,
}

impl std::fmt::Debug for Kept {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Kept").field("springs", &self.springs).finish_non_exhaustive()
    }
}

/// An earlier fit of the same surface.
#[derive(Clone, Copy)]
pub struct Earlier<'a> {
    /// Its result.
    pub fit: &'a Fit,
    /// What it has left.
    pub kept: Option<&'a Kept>,
}

impl std::fmt::Debug for Solver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Solver").field("factor_len", &self.matrix.factor_len()).finish()
    }
}

impl Solver {
    /// Prepares a cut surface.
    ///
    /// # Errors
    /// If memory runs out.
    pub fn new(disk: &Surface, seams: &[Seam], equal_seams: bool) -> Result<Self, FitError> {
        Self::with_shapes(disk, &rest_triangles(disk), seams, equal_seams)
    }

    /// Prepares a cut surface with other triangles over its vertices where its own are badly shaped, given the initial
    /// parameterization; `None` where none are.
    ///
    /// # Errors
    /// If memory runs out.
    pub fn well_shaped(
        disk: &Surface,
        seams: &[Seam],
        omega: &[DVec2],
        equal_seams: bool,
    ) -> Result<Option<Self>, FitError> {
        let Some(Delaunay { surface, lengths }) = Delaunay::new(disk, omega) else {
            return Ok(None);
        };
        let rest = rest_of_lengths(lengths);
        let mut solver = Self::with_shapes(&surface, &rest, seams, equal_seams)?;
        solver.triangles.made_way(disk);
        Ok(Some(solver))
    }

    /// Prepares a cut surface with triangles of these shapes.
    fn with_shapes(
        disk: &Surface,
        rest: &[RestTriangle],
        seams: &[Seam],
        equal_seams: bool,
    ) -> Result<Self, FitError> {
        let sewn = Sewn::new(disk, if equal_seams { seams } else { &[] });
        let matrix = Matrix::new(disk, sewn.cliques())?;
        let triangles = Triangles::new(disk, rest);
        let shares = triangles.worn_shares(disk.vertex_count());
        Ok(Self { triangles, sewn, matrix, shares, coarse: None })
    }

    /// Prepares the surface with fewer vertices, too, given the initial parameterization.
    ///
    /// # Errors
    /// If memory runs out.
    pub fn coarsen(
        &mut self,
        disk: &Surface,
        seams: &[Seam],
        omega: &[DVec2],
        equal_seams: bool,
        grading: &Grading,
    ) -> Result<(), FitError> {
        self.coarse = Coarse::new(disk, seams, omega, equal_seams, grading)?.map(Box::new);
        Ok(())
    }

    /// Where a fit of all vertices is to begin, found on fewer; `None` where that leads nowhere, or the earlier fit has
    /// none.
    fn start(
        &self,
        input: &FitInput<'_>,
        earlier: Option<Earlier<'_>>,
        progress: &dyn Progress,
    ) -> Result<Option<Start>, FitError> {
        let Some(coarse) = &self.coarse else { return Ok(None) };
        let start = coarse.start(input, earlier, progress)?;
        Ok(start.filter(|start| self.triangles.lie_right(&start.fit.coordinates)))
    }

    /// A fit of fewer vertices carried to all of them; `None` if it leads nowhere.
    ///
    /// # Errors
    /// If the job is cancelled.
    fn draft(
        &self,
        input: &FitInput<'_>,
        progress: &dyn Progress,
    ) -> Result<Option<Fit>, FitError> {
        match &self.coarse {
            Some(_) => Ok(self.start(input, None, progress)?.map(|start| start.fit)),
            None => match self.fit(input, None, &Quiet(progress)) {
                Ok((fit, _)) => Ok((fit.stopped == Stopped::Gradient).then_some(fit)),
                Err(FitError::Cancelled) => Err(FitError::Cancelled),
                Err(_) => Ok(None),
            },
        }
    }

    /// The surface's matrix, for what else is solved on it.
    #[must_use]
    pub fn matrix(&self) -> &Matrix {
        &self.matrix
    }

    /// The fit from the initial parameterization, or from an earlier fit of the same surface; and its
    /// run, which can still tell what the seams cost and leave something to the next fit.
    ///
    /// # Errors
    /// If memory runs out or the job is cancelled.
    pub fn fit<'a>(
        &'a self,
        input: &'a FitInput<'a>,
        earlier: Option<Earlier<'_>>,
        progress: &'a dyn Progress,
    ) -> Result<(Fit, Run<'a>), FitError> {
        let start = self.start(input, earlier, progress)?;
        let begun = start.as_ref().map(|start| Earlier {
            fit: &start.fit,
            kept: earlier.and_then(|earlier| earlier.kept),
        });
        let (mut fit, mut run) = Run::new(self, input, begun.or(earlier), progress).settle()?;
        run.lay_right(&mut fit);
        if let Some(start) = start {
            let Fit { history, iterations, .. } = &start.below.fit;
            fit.prepend(history.clone(), *iterations);
            run.below = Some(Box::new(start.below));
        }
        Ok((fit, run))
    }
}
