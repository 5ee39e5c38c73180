//! The course of a fit: steps until nothing moves any more and the pressures are met.

mod correct;
mod exact;
mod finish;

use std::sync::Arc;

use glam::DVec2;

use self::exact::Exact;
use super::anderson::Anderson;
use super::course::NEAR_MM;
use super::element::Order;
use super::pressures::Threads;
use super::problem::{Model, Place, Problem, Room, Solved};
use super::seam::Pull;
use super::step::{Damping, Rest, Step};
use super::triangles::{Forces, Turning, Wanted};
use super::{Below, Earlier, Solver};
use crate::fit::{Fit, FitError, FitInput, HistoryEntry, Misfit, Stopped};
use crate::pressure::Targets;
use crate::progress::{Progress, Stage};
use crate::sparse::SparseError;

/// Steps that move no vertex by more than this are taken as they are: what follows the fabric (threads,
/// turning springs, a seam's course) makes the energy an uncertain judge of them.
const TRUSTED_MM: f64 = 1.0;

/// From steps this small on a Hessian serves for several steps.
const KEPT_MM: f64 = 4.0;

/// A Hessian is kept while each step shrinks to less than this share of the last.
const SHRINKS: f64 = 0.5;

/// After steps this large the next is taken by the Gauss–Newton matrix: far from the minimum the
/// second-order part is rarely positive and seldom of use.
const FAR_MM: f64 = 10.0;

/// After so many hundredths of the steps allowed the strain function is drawn taut: a steep one keeps contrary wishes from
/// coming to rest.
const TAUT: u64 = 66;

/// After so many the targets are no longer corrected, nor follow the fabric: the rest is for coming to rest.
const LATE: u64 = 80;

/// After a step no larger than this, in mm, the seams pull along their courses as these turn with the fabric, not along
/// those of the Hessian.
const FOLLOW_MM: f64 = 1.0;

/// Where a vertex has moved so far since the Hessian was taken, in mm, and its steps shrink slowly, another is taken
/// before a step is made exact: what is near rest needs fewer products, and the seams have turned.
const AWAY_MM: f64 = 1.0;

/// So far where it is that of an earlier fit: the next needs room of its own.
const AWAY_FROM_EARLIER_MM: f64 = 10.0;

/// An exact step leaves less than this share of itself to go: rest is where that is within the tolerance.
const LEAVES: f64 = 0.5;

/// A step halved this often is no step.
const HALVINGS: usize = 12;

/// After steps smaller than this no vertices are relaxed: a fresh Hessian serves everywhere, and what is moved by
/// itself confuses the acceleration (an ankle of 250,000 triangles took 113 steps and not 51).
const LINEAR_MM: f64 = 0.05;

/// Accelerated steps that would move a vertex by more than this are not taken.
const ACCELERATED_MM: f64 = 4.0;

/// A fit on its way.
pub struct Run<'a> {
    problem: Problem<'a>,
    coordinates: Vec<DVec2>,
    threads: Threads<'a>,
    history: Vec<HistoryEntry>,
    iterations: u64,
    model: Option<Arc<Model>>,
    /// A Hessian without seams, for what these cost.
    free: Option<Arc<Model>>,
    room: Room,
    anderson: Anderson,
    /// Largest movement of a vertex in the last step, in mm.
    last: f64,
    /// Whether the Hessian at hand is from an earlier step.
    kept: bool,
    /// Whether it is from a place too far away to serve for another step.
    stale: bool,
    /// Whether the run began with the Hessian of an earlier fit: it serves as long as steps shrink.
    resumed: bool,
    /// Whether the last step was a large one.
    far: bool,
    damping: Damping,
    /// Whether a step had to be made exact: the last ones are then to be exact, too.
    slow: bool,
    /// Whether the seams pull along their courses here, while the Hessian has those of another place.
    follows: bool,
    /// By what a target strain counts beside a coordinate in mm: what it moves the vertices.
    scale: f64,
    pull: Pull,
    /// The fit of fewer vertices from which it began, for the next.
    pub below: Option<Box<Below>>,
}

/// How the vertices were moved.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Advance {
    /// By a small step, as it is.
    Trusted,
    /// As far along a step as the energy falls, or not with a Hessian that is let go for it.
    Searched,
    /// Not at all: there is no way down.
    Nowhere,
}

/// The plane turned so that the first marker stands vertically above the second.
fn turned_upright(coordinates: &[DVec2], input: &FitInput<'_>) -> Vec<DVec2> {
    let [upper, lower] = input.markers.map(|m| m.interpolate(input.disk, coordinates));
    let up = (upper - lower).normalize_or(DVec2::Y);
    let turn = DVec2::new(up.y, up.x);
    coordinates.iter().map(|&p| turn.rotate(p)).collect()
}

impl<'a> Run<'a> {
    /// From the initial parameterization, or from an earlier fit.
    pub fn new(
        solver: &'a Solver,
        input: &'a FitInput<'a>,
        earlier: Option<Earlier<'_>>,
        progress: &'a dyn Progress,
    ) -> Self {
        let start = earlier.map_or(input.omega, |earlier| &earlier.fit.coordinates);
        let coordinates = turned_upright(start, input);
        let mut threads = Threads::new(input, &coordinates);
        let problem = Problem::new(solver, input, progress);
        let (mut model, mut free) = (None, None);
        let mut pull = Pull::default();
        let mut known = false;
        if let Some(Earlier { fit, kept }) = earlier {
            let kept = kept.filter(|kept| problem.like(&kept.springs, &kept.upright));
            known = threads.resume(&fit.targets, kept.and_then(|kept| kept.answers.as_ref()));
            model = kept.map(|kept| Arc::clone(&kept.model));
            free = kept.and_then(|kept| kept.free.clone());
            pull = kept.map_or_else(Pull::default, |kept| Pull::resumed(kept.tensions.clone()));
        }
        let resumed = model.is_some();
        let [low, high] = coordinates
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], p| [l.min(p.x), h.max(p.x)]);
        // Root mean square of what an even strain moves the vertices, over all of them.
        let scale = (high - low) / 12f64.sqrt() * (coordinates.len() as f64).sqrt();
        let mut run = Self {
            problem,
            coordinates,
            threads,
            history: Vec::new(),
            iterations: 0,
            resumed,
            model,
            free,
            room: Room::default(),
            anderson: Anderson::default(),
            last: if earlier.is_some() && !resumed { KEPT_MM } else { f64::INFINITY },
            kept: false,
            stale: false,
            far: earlier.is_none(),
            damping: Damping::default(),
            slow: false,
            follows: false,
            scale,
            pull,
            below: None,
        };
        if let Some(model) = &run.model {
            // Where the earlier fit has ended.
            run.pull.follow(&run.problem.solver.sewn, &run.coordinates, &model.courses);
        }
        if known {
            // The fabric is where the earlier targets have brought it.
            let correction = run.correction(0.5 * NEAR_MM);
            run.take(&correction);
        }
        run
    }

    /// Steps until nothing moves; the fit, and the run as it ended.
    ///
    /// # Errors
    /// If memory runs out or the job is cancelled.
    pub fn settle(mut self) -> Result<(Fit, Self), FitError> {
        let parameters = self.problem.input.parameters;
        let mut targets = self.threads.targets(&self.coordinates);
        self.record(&targets);
        let mut rest = Rest::new(parameters.newton_tolerance);
        let stopped = loop {
            let wanted = self.wanted(&targets);
            let turning = self.problem.solver.triangles.turning(
                &self.coordinates,
                &self.problem.springs,
                &wanted,
                parameters.spacing,
            );
            let step = self.step(&wanted, &turning)?;
            let before = self.state();
            let share = if step.is_exact() { self.damping.share(step.largest) } else { 1.0 };
            let advance = self.advance(&step, share, &wanted, &turning);
            let relaxed = self.relax(&step, &wanted, &turning);
            self.iterations += 1;
            self.last = step.rough;
            if step.is_exact() {
                self.slow = true;
                self.anderson.forget();
            }
            self.far = step.largest > FAR_MM;
            self.follows |= step.largest < FOLLOW_MM;
            let correction = (self.model.is_some() && self.threads.corrects() && self.ripe(&step))
                .then(|| self.correction(step.largest));
            let settled = correction.as_ref().map_or(!self.threads.corrects(), |c| c.settled);
            let lost = correction.as_ref().is_some_and(|c| c.lost);
            let [taut, late] = [TAUT, LATE].map(|share| parameters.newton_steps * share / 100);
            let moves = self.threads.corrects() && (!settled || step.largest > KEPT_MM);
            let uneasy = moves && [taut, late].contains(&self.iterations);
            if uneasy && self.iterations == late {
                // What threads want of each other may keep the fabric on its way for ever.
                self.threads.hold(&self.coordinates);
            } else if uneasy {
                self.threads.draw_taut();
            }
            if uneasy || correction.as_ref().is_some_and(|c| c.worse) {
                self.anderson.forget();
                self.last = f64::INFINITY;
            }
            let goes_on = if step.is_exact() { LEAVES * step.largest } else { step.largest };
            let rests = rest.within(goes_on.max(relaxed)) && settled;
            match correction {
                Some(correction) if !rests => self.take(&correction),
                Some(_) => {}
                None => self.threads.follow(&self.coordinates),
            }
            let further = if advance == Advance::Trusted && !step.is_exact() {
                self.accelerate(&before)
            } else {
                step.largest
            };
            targets = self.threads.targets(&self.coordinates);
            self.record(&targets);
            if rest.comes(rests, further) {
                break if lost { Stopped::Unsettled } else { Stopped::Gradient };
            }
            if self.iterations >= parameters.newton_steps || advance == Advance::Nowhere {
                break Stopped::MaxIterations;
            }
        };
        let misfit = self.history.last().map(|entry| entry.misfit).unwrap_or_default();
        let fit = Fit {
            coordinates: self.coordinates.clone(),
            woven: None,
            targets,
            history: std::mem::take(&mut self.history),
            iterations: self.iterations,
            stopped,
            misfit,
        };
        Ok((fit, self))
    }

    fn wanted(&self, targets: &Targets) -> Wanted {
        Wanted::new(targets, self.problem.input.fabric.weft_strain)
    }

    fn misfit(&self, wanted: &Wanted) -> Misfit {
        let Problem { solver, springs, input, .. } = &self.problem;
        solver.triangles.misfit(&self.coordinates, springs, wanted, input.parameters.spacing)
    }

    fn record(&mut self, targets: &Targets) {
        let misfit = self.misfit(&self.wanted(targets));
        let parameters = self.problem.input.parameters;
        self.history.push(HistoryEntry {
            iteration: self.iterations,
            spacing: parameters.spacing,
            nodes: self.coordinates.len(),
            cells: misfit.springs / 2,
            misfit,
        });
        /// What a first step typically moves, in mm.
        const FIRST_MM: f64 = 100.0;
        // Steps shrink some tenfold each: the fraction is that of decades.
        let decades = |mm: f64| (mm / parameters.newton_tolerance).max(1.0).log10();
        let done = 1.0 - decades(self.last) / decades(FIRST_MM).max(1.0);
        self.problem.progress.report(Stage::Fit, done.clamp(0.0, 1.0), Some(misfit.energy));
    }

    /// The step from here, by the Hessian at hand if that still serves.
    fn step(&mut self, wanted: &Wanted, turning: &[Turning]) -> Result<Step, FitError> {
        self.problem.ask()?;
        if self.stale {
            self.forget();
        }
        let at = Place { coordinates: &self.coordinates, wanted, turning };
        let (mut astray, mut renewed) = (false, false);
        if let Some(model) = self.model.take() {
            if self.follows {
                self.pull.follow(&self.problem.solver.sewn, at.coordinates, &model.courses);
            }
            let downhill = self.problem.downhill(&at, &model.courses, self.pull.turned());
            let motion = self.problem.answers(&model, &[&downhill]).swap_remove(0);
            let step = Step::new(motion, &downhill);
            self.pull.left(self.tensions(&model, &step));
            let slow = self.is_slow(&step);
            renewed = slow && self.is_away(&model);
            let serves = if renewed {
                None
            } else if slow {
                let exact = self.exact(&step, &model, &downhill)?;
                astray = matches!(exact, Exact::Astray);
                exact.found()
            } else {
                (step.largest < SHRINKS * self.last).then_some(step)
            };
            if let Some(step) = serves {
                self.kept = true;
                self.model = Some(model);
                return Ok(step);
            }
            self.make_room(model);
        }
        self.kept = false;
        self.stale = false;
        self.pull = Pull::default();
        self.follows = false;
        let orders: &[Order] = match (renewed, self.far, self.iterations) {
            (true, ..) => &[Order::Full, Order::Second, Order::Convex, Order::First],
            (_, true, _) => &[Order::First],
            (_, _, 0) => &[Order::Convex, Order::First],
            _ => &[Order::Second, Order::Convex, Order::First],
        };
        for &order in orders {
            self.problem.ask()?;
            let at = Place { coordinates: &self.coordinates, wanted, turning };
            let solved = self.problem.model(&at, order, &mut self.room)?;
            if let Some(Solved { model, downhill, motion }) = solved {
                let step = Step::new(motion, &downhill);
                self.pull.left(self.tensions(&model, &step));
                // It would be the same by any Hessian.
                let exact = if self.iterations > 0 && !astray && self.is_slow(&step) {
                    self.exact(&step, &model, &downhill)?.found()
                } else {
                    None
                };
                self.model = Some(Arc::new(model));
                return Ok(exact.unwrap_or(step));
            }
        }
        // The Gauss–Newton matrix is never negative and is held: only numbers without bounds come here.
        Err(FitError::System(SparseError::NotPositiveDefinite(0)))
    }

    /// Whether a vertex is far from where it was when that Hessian was taken.
    fn is_away(&self, model: &Model) -> bool {
        let pairs = model.place.iter().zip(&self.coordinates);
        let away = pairs.map(|(then, now)| then.distance(*now)).fold(0.0, f64::max);
        away > if self.resumed { AWAY_FROM_EARLIER_MM } else { AWAY_MM }
    }

    /// The seams' tensions after a step that a Hessian makes, in N.
    fn tensions(&self, model: &Model, step: &Step) -> Vec<f64> {
        let Problem { solver, input, .. } = &self.problem;
        solver.sewn.tensions(&self.coordinates, &model.courses, &step.motion, input.fabric)
    }

    /// Coordinates and targets as numbers that count alike.
    fn state(&self) -> Vec<f64> {
        let coordinates = self.coordinates.iter().flat_map(|p| p.to_array());
        coordinates.chain(self.threads.asked().map(|asked| self.scale * asked)).collect()
    }

    /// Goes further, or less far, than from `before` to here; how far that wants to move a vertex, in mm: a
    /// motion that comes to its end by small steps alone has as long a way to go.
    fn accelerate(&mut self, before: &[f64]) -> f64 {
        let after = self.state();
        if after.len() != before.len() {
            // The threads were found anew.
            self.anderson.forget();
            return f64::INFINITY;
        }
        let step: Vec<f64> = after.iter().zip(before).map(|(to, from)| to - from).collect();
        let taken = self.anderson.step(before, &step);
        let coordinates = 2 * self.coordinates.len();
        let from: Vec<DVec2> =
            before[..coordinates].chunks_exact(2).map(DVec2::from_slice).collect();
        let motion: Vec<DVec2> =
            taken[..coordinates].chunks_exact(2).map(DVec2::from_slice).collect();
        let largest = motion.iter().map(|m| m.length()).fold(0.0, f64::max);
        let longest = self.problem.solver.triangles.longest_step(&from, &motion);
        if largest >= ACCELERATED_MM || longest < 1.0 {
            return largest;
        }
        self.coordinates = from.iter().zip(&motion).map(|(&p, &d)| p + d).collect();
        let targets = before[coordinates..].iter().zip(&taken[coordinates..]);
        self.threads.accelerate(targets.map(|(from, step)| (from + step) / self.scale));
        largest
    }

    /// Lets vertices come to rest where the Hessian at hand does not serve; how far they were from it, in mm.
    fn relax(&mut self, step: &Step, wanted: &Wanted, turning: &[Turning]) -> f64 {
        let bends = LINEAR_MM < step.largest && step.largest < KEPT_MM;
        let Some(model) = self.model.as_ref().filter(|_| bends) else { return 0.0 };
        let Problem { solver, springs, input, .. } = &self.problem;
        let forces = Forces { springs, wanted, turning };
        let tolerance = input.parameters.newton_tolerance;
        solver.triangles.relax(
            &mut self.coordinates,
            &model.place,
            self.problem.held(),
            &forces,
            tolerance,
        )
    }

    /// Moves the vertices, by no more than a share of the step.
    fn advance(
        &mut self,
        step: &Step,
        share: f64,
        wanted: &Wanted,
        turning: &[Turning],
    ) -> Advance {
        let longest = self.problem.solver.triangles.longest_step(&self.coordinates, &step.motion);
        if longest == 1.0 && step.largest < TRUSTED_MM {
            self.coordinates.iter_mut().zip(&step.motion).for_each(|(p, d)| *p += share * *d);
            return Advance::Trusted;
        }
        self.anderson.forget();
        let tried = |length: f64| -> Vec<DVec2> {
            self.coordinates.iter().zip(&step.motion).map(|(&p, &d)| p + length * d).collect()
        };
        let value =
            |coordinates: &[DVec2]| self.problem.value(&Place { coordinates, wanted, turning });
        let before = value(&self.coordinates);
        let mut length = longest.min(share);
        for _ in 0..HALVINGS {
            let there = tried(length);
            // Armijo's rule with its usual share.
            if value(&there) <= before + 1e-4 * length * step.slope {
                self.coordinates = there;
                self.stale = length < 1.0 || (step.largest > KEPT_MM && !self.resumed);
                return Advance::Searched;
            }
            length *= 0.5;
        }
        if self.kept {
            // A Hessian from elsewhere may be the reason.
            self.forget();
            return Advance::Searched;
        }
        // What follows the fabric may be: as far as a step is taken as it is.
        let length = 0.5 * longest.min(TRUSTED_MM / step.largest);
        if step.largest.is_finite() && length > 0.0 {
            self.coordinates = tried(length);
            self.stale = true;
            return Advance::Searched;
        }
        self.forget();
        Advance::Nowhere
    }

    /// The Hessian no longer serves.
    fn forget(&mut self) {
        if let Some(model) = self.model.take() {
            self.make_room(model);
        }
    }

    /// The room of a Hessian for the next, unless an earlier fit still needs it.
    fn make_room(&mut self, model: Arc<Model>) {
        self.resumed = false;
        if let Ok(model) = Arc::try_unwrap(model) {
            self.problem.solver.matrix.take_back(model.into_factor());
        }
    }
}
