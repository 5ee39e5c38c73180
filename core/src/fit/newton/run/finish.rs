//! What is asked of a run when it has ended.

use std::sync::Arc;

use glam::DVec2;

use super::{Run, Step};
use crate::fit::newton::anderson::Anderson;
use crate::fit::newton::problem::{Model, Place, Solved};
use crate::fit::newton::{Kept, Solver};
use crate::fit::{Fit, FitError};

/// A step that promises less than this share of what letting go of the seams has won is the last: some hundredths of it
/// are left then.
const LAST_FREE: f64 = 0.2;

/// After so many steps another Hessian is needed.
const FREE_STEPS: usize = 6;

/// The fabric without its seams.
struct LetGo {
    /// J_E, in N·mm.
    energy: f64,
    /// Whether it has come to rest.
    rests: bool,
}

impl Run<'_> {
    /// Whether the pressures were met when the targets were last corrected.
    pub fn met(&self) -> bool {
        self.threads.met()
    }

    /// Lays the given triangles the right way round where the fit was made on others.
    pub fn lay_right(&mut self, fit: &mut Fit) {
        let triangles = &self.problem.solver.triangles;
        triangles.lay_right(&mut self.coordinates, self.problem.held());
        fit.coordinates.clone_from(&self.coordinates);
    }

    /// J_E without the condition that sewn edges have equal lengths, in N·mm, where there are any; and what
    /// is left to the next fit, if there is to be one.
    ///
    /// # Errors
    /// If memory runs out or the job is cancelled.
    pub fn finish(mut self, last: bool) -> Result<(Option<f64>, Option<Kept>), FitError> {
        if last || self.stale {
            // Its room serves for the Hessian without seams.
            self.forget();
        }
        let energy = self.energy_of_free_seams()?;
        if last {
            self.free = None;
            self.problem.solver.matrix.let_go();
        }
        Ok((energy, self.leave()))
    }

    /// What is left to the next fit.
    pub fn leave(self) -> Option<Kept> {
        let Self { model, free, problem, threads, pull, below, .. } = self;
        model.map(|model| Kept {
            model,
            free,
            springs: problem.springs,
            upright: problem.upright().to_vec(),
            answers: threads.into_answers(),
            tensions: pull.into_tensions(),
            coarse: below,
        })
    }

    /// J_E of the fabric at rest after its seams are let go, with the targets that it has; `None` if it has none.
    fn energy_of_free_seams(&mut self) -> Result<Option<f64>, FitError> {
        let (springs, spacing) = (self.problem.springs, self.problem.input.parameters.spacing);
        let Solver { triangles, sewn, .. } = self.problem.solver;
        if sewn.cliques().is_empty() {
            return Ok(None);
        }
        self.problem.ask()?;
        let wanted = self.wanted(&self.threads.targets(&self.coordinates));
        let turning = triangles.turning(&self.coordinates, &springs, &wanted, spacing);
        let at = Place { coordinates: &self.coordinates, wanted: &wanted, turning: &turning };
        if let Some(free) = &self.free {
            let let_go = self.let_go(&at, free, self.free_step(&at, free).0)?;
            if let_go.rests {
                return Ok(Some(let_go.energy));
            }
        }
        self.free = None;
        let Some(Solved { model, motion, .. }) = self.problem.unsewn(&at, &mut self.room)? else {
            return Ok(None);
        };
        let let_go = self.let_go(&at, &model, motion)?;
        self.free = Some(Arc::new(model));
        Ok(Some(let_go.energy))
    }

    /// The step of a Hessian without seams, and what that promises of the energy, in N·mm.
    fn free_step(&self, at: &Place<'_>, free: &Model) -> (Vec<DVec2>, f64) {
        let force: Vec<f64> = self.problem.fabric(at).iter().map(|f| -f).collect();
        let step = Step::new(self.problem.answers(free, &[&force]).swap_remove(0), &force);
        let promised = -0.5 * step.slope;
        (step.motion, promised)
    }

    /// Where steps of a Hessian without seams lead, given the first.
    fn let_go(&self, at: &Place<'_>, free: &Model, first: Vec<DVec2>) -> Result<LetGo, FitError> {
        let triangles = &self.problem.solver.triangles;
        let (springs, spacing) = (&self.problem.springs, self.problem.input.parameters.spacing);
        let energy = |plane: &[DVec2]| triangles.misfit(plane, springs, at.wanted, spacing).energy;
        let flat =
            |plane: &[DVec2]| -> Vec<f64> { plane.iter().flat_map(|p| p.to_array()).collect() };
        let (mut there, mut motion) = (at.coordinates.to_vec(), first);
        let sewn = energy(&there);
        let mut found = LetGo { energy: sewn, rests: false };
        let mut anderson = Anderson::default();
        for _ in 0..FREE_STEPS {
            let taken = anderson.step(&flat(&there), &flat(&motion));
            motion = taken.chunks_exact(2).map(DVec2::from_slice).collect();
            let length = triangles.longest_step(&there, &motion);
            there.iter_mut().zip(&motion).for_each(|(p, &d)| *p += length * d);
            let now = energy(&there);
            if now >= found.energy {
                break;
            }
            found.energy = now;
            if found.rests {
                break;
            }
            self.problem.ask()?;
            let (next, promised) = self.free_step(&Place { coordinates: &there, ..*at }, free);
            found.rests = promised <= LAST_FREE * (sewn - now);
            motion = next;
        }
        Ok(found)
    }
}
