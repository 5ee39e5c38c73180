//! What is asked of a run when it has ended.

use glam::DVec2;

use super::Run;
use crate::fit::FitError;
use crate::fit::newton::problem::{Place, Solved};
use crate::fit::newton::{Kept, Solver};

impl Run<'_> {
    /// Whether the pressures were met when the targets were last corrected.
    pub fn met(&self) -> bool {
        self.threads.met()
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
            self.problem.solver.matrix.let_go();
        }
        Ok((energy, self.leave()))
    }

    /// What is left to the next fit.
    pub fn leave(self) -> Option<Kept> {
        let Self { model, problem, threads, pull, below, .. } = self;
        model.map(|model| Kept {
            model,
            springs: problem.springs,
            upright: problem.upright().to_vec(),
            answers: threads.into_answers(),
            tensions: pull.into_tensions(),
            coarse: below,
        })
    }

    /// One Newton step after the seams are let go, which is exact to the second order in what they move.
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
        let Some(Solved { model, motion, .. }) = self.problem.unsewn(&at, &mut self.room)? else {
            return Ok(None);
        };
        let energy = |coordinates: &[DVec2]| {
            triangles.misfit(coordinates, &springs, &wanted, spacing).energy
        };
        self.problem.solver.matrix.take_back(model.into_factor());
        let length = triangles.longest_step(&self.coordinates, &motion);
        let there: Vec<DVec2> =
            self.coordinates.iter().zip(&motion).map(|(&p, &d)| p + length * d).collect();
        Ok(Some(energy(&self.coordinates).min(energy(&there))))
    }
}
