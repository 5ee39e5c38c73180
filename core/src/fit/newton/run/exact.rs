//! Steps that are made exact where the Hessian at hand is much stiffer than the fabric.
//!
//! What is left to the forces here is to become nothing: J p = −F, with J all of what changes them, the
//! turning springs' directions, the strain function and negative curvature included. J times a vector is a difference
//! of the fabric's forces, with what the seams hold along the Hessian's courses; the factorized Hessian M makes the
//! equations M⁻¹ J p = −M⁻¹ F, in which few directions are far from 1: those in which M is wrong. GMRES finds them. On an ankle whose lobe swings about a notch, steps by M of 0.5 mm a
//! time had 3 mm to go; a kept Hessian's steps of 0.007 mm, within the tolerance, 0.4 mm.

use glam::DVec2;

use super::{KEPT_MM, Run, SHRINKS, TRUSTED_MM};
use crate::fit::FitError;
use crate::fit::newton::krylov::gmres;
use crate::fit::newton::problem::{Model, Place, Problem};
use crate::fit::newton::seam::Courses;
use crate::fit::newton::step::Step;

/// Larger steps are not made exact: so far the fabric bends on its way, and another Hessian serves better (a wrist without
/// seams took 27 steps and not 20).
const SLOW_MM: f64 = 2.0;

/// Products of J for one step, each shorter than a step by a kept Hessian.
const PRODUCTS: usize = 15;

/// The share of a step that may be left.
const LEFT: f64 = 0.2;

/// Near rest no more is left than this share of the tolerance: what is left may be of the softest directions.
const LEFT_AT_REST: f64 = 0.2;

/// Rest is near at so many times the tolerance.
const NEAR_REST: f64 = 10.0;

/// A step of which more is left is none: another Hessian is needed.
const USELESS: f64 = 0.5;

/// Forces are compared over so many mm: most of the digits are left to the difference, and no spring changes its ways.
const DIFFERENCE_MM: f64 = 1e-4;

/// What came of making a step exact.
pub(super) enum Exact {
    /// The exact step.
    Found(Step),
    /// It is none that leads down.
    Astray,
    /// By this Hessian it is not found.
    NotFound,
}

impl Exact {
    /// The step, if there is one.
    pub(super) fn found(self) -> Option<Step> {
        if let Self::Found(step) = self { Some(step) } else { None }
    }
}

impl Run<'_> {
    /// Whether a step by the Hessian at hand is to be made exact: it does not shrink as it should, or
    /// is the last of a run of such ones.
    pub(super) fn is_slow(&self, step: &Step) -> bool {
        let rests = step.largest < self.problem.input.parameters.newton_tolerance;
        step.largest < SLOW_MM && (step.largest >= SHRINKS * self.last || (rests && self.slow))
    }

    /// The exact step, or as much of it as leads down.
    ///
    /// # Errors
    /// If the job is cancelled.
    pub(super) fn exact(
        &self,
        step: &Step,
        model: &Model,
        downhill: &[f64],
    ) -> Result<Exact, FitError> {
        let parameters = self.problem.input.parameters;
        let Problem { solver, input, .. } = &self.problem;
        let here = self.fabric_of(downhill, &model.courses);
        let product = |v: &[DVec2]| {
            self.problem.ask().ok()?;
            let difference = DIFFERENCE_MM / largest(v);
            let there: Vec<DVec2> =
                self.coordinates.iter().zip(v).map(|(&p, &v)| p + difference * v).collect();
            let forces = self.fabric(&there);
            let mut change: Vec<f64> =
                here.iter().zip(forces).map(|(here, there)| (there - here) / difference).collect();
            solver.sewn.add_change(&mut change, v, &model.courses, input.fabric);
            Some(self.problem.answers(model, &[&change]).swap_remove(0))
        };
        let tolerance = parameters.newton_tolerance;
        let at_rest = LEFT.min(LEFT_AT_REST * tolerance / step.largest);
        let near = step.largest < NEAR_REST * tolerance;
        let mut found = gmres(&step.motion, product, PRODUCTS, if near { at_rest } else { LEFT });
        if found.as_ref().is_some_and(|f| f.left > at_rest && largest(&f.x) < tolerance) {
            // It is rest if what is left is less still.
            found = gmres(&step.motion, product, PRODUCTS, at_rest);
        }
        self.problem.ask()?;
        let Some(found) = found.filter(|found| found.left < USELESS) else {
            return Ok(Exact::NotFound);
        };
        let exact = Step::new(found.x, downhill);
        // Where the energy falls backwards along it, its curvature is negative, and that is the way out.
        let way = if exact.slope > 0.0 { -1.0 } else { 1.0 };
        let no_longer_than = |most: f64| {
            let length = way * (most / exact.largest).min(1.0);
            let motion = exact.motion.iter().map(|&m| length * m).collect();
            Step { rough: step.largest, ..Step::new(motion, downhill) }
        };
        let long = no_longer_than(KEPT_MM);
        if long.largest < TRUSTED_MM || self.leads(&long, step) {
            return Ok(if long.slope < 0.0 { Exact::Found(long) } else { Exact::Astray });
        }
        // So far it may lead anywhere; a little of it is still better than the other if it is steeper.
        let short = no_longer_than(0.99 * TRUSTED_MM);
        Ok(if short.slope < step.slope { Exact::Found(short) } else { Exact::Astray })
    }

    /// Whether a long step lowers the energy by more than another one: where negative curvature is only a part of it
    /// it may lead anywhere.
    fn leads(&self, step: &Step, other: &Step) -> bool {
        let wanted = self.wanted(&self.threads.targets(&self.coordinates));
        let spacing = self.problem.input.parameters.spacing;
        let triangles = &self.problem.solver.triangles;
        let turning = triangles.turning(&self.coordinates, &self.problem.springs, &wanted, spacing);
        let value = |step: &Step| {
            let length = triangles.longest_step(&self.coordinates, &step.motion);
            let there: Vec<DVec2> =
                self.coordinates.iter().zip(&step.motion).map(|(&p, &d)| p + length * d).collect();
            self.problem.value(&Place { coordinates: &there, wanted: &wanted, turning: &turning })
        };
        value(step) < value(other)
    }

    /// The fabric's part of the gradient of which `downhill` is minus all, in N.
    fn fabric_of(&self, downhill: &[f64], courses: &Courses) -> Vec<f64> {
        let Problem { solver, input, .. } = &self.problem;
        let mut seams = vec![0.0; downhill.len()];
        solver.sewn.add_forces(&mut seams, &self.coordinates, courses, input.fabric);
        seams.iter_mut().zip(self.pull.turned()).for_each(|(force, turned)| *force += turned);
        downhill.iter().zip(seams).map(|(downhill, seams)| -downhill - seams).collect()
    }

    /// The fabric's gradient at other pattern coordinates, with all that follows it, in N.
    fn fabric(&self, coordinates: &[DVec2]) -> Vec<f64> {
        let wanted = self.wanted(&self.threads.targets(coordinates));
        let spacing = self.problem.input.parameters.spacing;
        let triangles = &self.problem.solver.triangles;
        let turning = triangles.turning(coordinates, &self.problem.springs, &wanted, spacing);
        self.problem.fabric(&Place { coordinates, wanted: &wanted, turning: &turning })
    }
}

/// The largest length.
fn largest(motion: &[DVec2]) -> f64 {
    motion.iter().map(|m| m.length()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use crate::parameters::Parameters;
    use crate::pipeline::Prepared;
    use crate::progress::Silent;
    use crate::samples::sample;

    /// An ankle's lobe swings about a notch, where the Hessian is too stiff: steps within the tolerance had left it 0.12 mm
    /// short; and the seams pulled along the courses of whatever Hessian was the last. Nor do the triangles give way
    /// at the notch: one of 20,000 had been stretched to 2.6 times its size, of 100,000 to 6.7 times.
    #[test]
    fn a_lobe_that_swings_about_a_fold_comes_to_rest_where_it_does_by_a_small_tolerance() {
        let limb = sample("ankle", 50_000, 0.0).unwrap();
        let usual = Parameters::default();
        let tight = Parameters { newton_tolerance: 0.01 * usual.newton_tolerance, ..usual.clone() };
        let prepared = Prepared::new(&limb.mesh, &limb.design, &usual, &Silent).unwrap();
        let [usual, tight] = [usual, tight].map(|parameters| {
            let worn = prepared.solve(&limb.design, &parameters, None, &Silent).unwrap();
            assert!(worn.report.fit.converged && worn.report.field.max_strain < 1.5);
            let middle = worn.coordinates.iter().sum::<DVec2>() / worn.coordinates.len() as f64;
            worn.coordinates.iter().map(|&p| p - middle).collect::<Vec<DVec2>>()
        });
        let off = usual.iter().zip(&tight).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        assert!(off < 0.02, "{off} mm");
    }
}
