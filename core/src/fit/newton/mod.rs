//! The default fit: the paper's energy minimised over the pattern coordinates of the surface's vertices,
//! by Newton steps.
//!
//! The same J_E as the woven nodes' (`element`), with nothing to insert, to remove or to interpolate:
//! the outline is exact and the sparsity never changes. Each step takes the Gauss–Newton matrix with
//! as much of the second-order part as keeps it positive definite, one sparse Cholesky factorization
//! (`matrix`), and a line search that never lets a triangle turn over. Sewn edges keep equal lengths
//! (`seam`), shortened threads do not buckle (`straight`), the markers stay on one weft line as a
//! linear constraint, and the target strains are corrected until the pressures are met (`pressures`).
//! The row's target strain ε(t) follows the vertices' weft coordinates as they move, and its slope is
//! part of the derivatives; what follows in turn (the threads through the annotated points, the
//! directions of the turning springs) is brought up to date before every step.
//!
//! It ends when the full step, which is the gradient scaled by the Hessian, moves no vertex by more
//! than `newton_tolerance`.
//!
//! Limit: triangles never turn over, but the outline may cross itself on a limb that cannot be
//! flattened in one piece; the pattern says where.

mod element;
mod matrix;
mod pressures;
mod seam;
mod straight;
mod triangles;
#[cfg(test)]
mod tests;

use glam::DVec2;

use self::element::{Element, Springs};
use self::matrix::{Factored, Matrix};
use self::pressures::Threads;
use self::seam::Sewn;
use self::triangles::{Triangles, Turning, Wanted};
use super::{Fit, FitError, FitInput, HistoryEntry, Misfit, Stopped};
use crate::design::Fabric;
use crate::pressure::Targets;
use crate::progress::{Progress, Stage};
use crate::seams::Seam;
use crate::surface::Surface;

/// Added to the Hessian's diagonal, relative to its mean: it holds the rotation that may cost nothing
/// and is far below any stiffness of the fabric.
const HOLD: f64 = 1e-7;

/// Stiffness that holds one vertex, relative to the mean of the Hessian's diagonal.
const PIN: f64 = 1e4;

/// Targets are corrected when a step moves no vertex by more than this, in mm: then a thread's strain is
/// known to some 0.1 %.
const NEAR_MM: f64 = 1.0;

/// Steps that move no vertex by more than this are taken as they are: quantities that follow the fabric
/// (see above) are then exact enough that the energy cannot be asked to fall.
const TRUSTED_MM: f64 = 0.5;

/// A step halved this often is no step.
const HALVINGS: usize = 12;

/// What of the problem does not change with pressures, fabric and markers.
pub struct Prepared {
    triangles: Triangles,
    sewn: Sewn,
    matrix: Matrix,
}

impl std::fmt::Debug for Prepared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Prepared").field("factor_len", &self.matrix.factor_len()).finish()
    }
}

impl Prepared {
    /// Prepares a cut surface.
    ///
    /// # Errors
    /// If memory runs out.
    pub fn new(disk: &Surface, seams: &[Seam], equal_seams: bool) -> Result<Self, FitError> {
        let sewn = Sewn::new(disk, if equal_seams { seams } else { &[] });
        let matrix = Matrix::new(disk, sewn.cliques())?;
        Ok(Self { triangles: Triangles::new(disk), sewn, matrix })
    }

    /// The fit from the initial parameterization, or from an earlier fit of the same surface.
    ///
    /// # Errors
    /// If memory runs out or the job is cancelled.
    pub fn fit(
        &self,
        input: &FitInput<'_>,
        earlier: Option<&Fit>,
        progress: &dyn Progress,
    ) -> Result<Fit, FitError> {
        Run::new(self, input, earlier, progress).settle()
    }
}

/// The row of a linear constraint on coordinates: (index among x₀, y₀, x₁, …; factor).
type Row = Vec<(usize, f64)>;

/// What a run does not change.
#[derive(Clone)]
struct Problem<'a> {
    prepared: &'a Prepared,
    input: &'a FitInput<'a>,
    springs: Springs,
    /// Difference of the markers' x.
    upright: Row,
}

struct Run<'a> {
    problem: Problem<'a>,
    progress: &'a dyn Progress,
    coordinates: Vec<DVec2>,
    threads: Threads<'a>,
    history: Vec<HistoryEntry>,
    iterations: u64,
    /// Share of the second-order part in the Hessian.
    share: f64,
    elements: Vec<Element>,
    values: Vec<f64>,
    /// Room for a factor.
    room: Vec<f64>,
}

/// A Newton step.
struct Step<'a> {
    motion: Vec<DVec2>,
    /// Largest movement of a vertex, in mm.
    largest: f64,
    /// Derivative of the energy along it, in N·mm.
    slope: f64,
    factor: Factored<'a>,
    answers: Answers,
}

/// How the fabric answers to the forces that hold it, for solves with one factor.
struct Answers {
    /// To the force of the markers' constraint.
    upright: Vec<f64>,
    /// To a unit of force along weft, shared out over the fabric.
    slide: Vec<f64>,
}

fn springs(fabric: &Fabric) -> Springs {
    Springs { warp: fabric.warp, weft: fabric.weft, diagonal: fabric.diagonal }
}

fn turned_upright(coordinates: &[DVec2], input: &FitInput<'_>) -> Vec<DVec2> {
    let [upper, lower] = input.markers.map(|m| m.interpolate(input.disk, coordinates));
    let up = (upper - lower).normalize_or(DVec2::Y);
    let turn = DVec2::new(up.y, up.x);
    coordinates.iter().map(|&p| turn.rotate(p)).collect()
}

impl Problem<'_> {
    /// The vertex that is held while a step is computed, where the fabric may slide: any will do.
    const PINNED: usize = 0;

    /// Shares of the vertices in the pattern's area, as forces along weft.
    fn slide(&self, coordinates: &[DVec2]) -> Vec<f64> {
        let shares = self.prepared.triangles.shares(coordinates);
        let whole: f64 = shares.iter().sum();
        shares.iter().flat_map(|share| [0.0, share / whole]).collect()
    }

    fn upright(&self, unknowns: usize) -> Vec<f64> {
        let mut row = vec![0.0; unknowns];
        for &(i, w) in &self.upright {
            row[i] += w;
        }
        row
    }

    /// The motion by which the fabric answers to forces, given what the pinned fabric does.
    ///
    /// The strain function is built anew round the annotated points before every step, so that sliding
    /// along it wins nothing; a net force along weft is borne by all of the fabric alike, as a
    /// woven model that slides steadily would bear it. So to the pinned fabric's answer are added
    /// those to the shared force and to the markers' constraint that make the pin bear nothing and the
    /// markers stand upright. The fabric's middle stays where it is.
    fn free(&self, pinned: &[f64], answers: &Answers, slide: &[f64]) -> Vec<DVec2> {
        let lean = |x: &[f64]| self.upright.iter().map(|&(i, w)| w * x[i]).sum::<f64>();
        let pin = |x: &[f64]| x[2 * Self::PINNED + 1];
        let Answers { upright: u, slide: s } = answers;
        let (a, b, c, d) = (lean(u), lean(s), pin(u), pin(s));
        let (e, f) = (-lean(pinned), -pin(pinned));
        let determinant = a * d - b * c;
        let (alpha, beta) = ((e * d - b * f) / determinant, (a * f - e * c) / determinant);
        let mut motion: Vec<DVec2> = pinned
            .chunks_exact(2)
            .zip(u.chunks_exact(2).zip(s.chunks_exact(2)))
            .map(|(x, (u, s))| {
                DVec2::new(x[0] + alpha * u[0] + beta * s[0], x[1] + alpha * u[1] + beta * s[1])
            })
            .collect();
        let middle: f64 = motion.iter().zip(slide.chunks_exact(2)).map(|(m, s)| s[1] * m.y).sum();
        for m in &mut motion {
            m.y -= middle;
        }
        motion
    }
}

impl<'a> Run<'a> {
    fn new(
        prepared: &'a Prepared,
        input: &'a FitInput<'a>,
        earlier: Option<&Fit>,
        progress: &'a dyn Progress,
    ) -> Self {
        let start = earlier.map_or(input.omega, |fit| &fit.coordinates);
        let coordinates = turned_upright(start, input);
        let mut threads = Threads::new(input, &coordinates);
        if let Some(fit) = earlier {
            threads.resume(&fit.targets);
        }
        let mut upright: Row = Vec::with_capacity(6);
        for (marker, sign) in input.markers.iter().zip([1.0, -1.0]) {
            let weights = marker.barycentric.to_array();
            for (v, w) in input.disk.triangle(marker.triangle).iter().zip(weights) {
                upright.push((2 * v.index(), sign * w));
            }
        }
        let springs = springs(input.fabric);
        Self {
            problem: Problem { prepared, input, springs, upright },
            progress,
            coordinates,
            threads,
            history: Vec::new(),
            iterations: 0,
            share: 1.0,
            elements: Vec::new(),
            values: prepared.matrix.zeros(),
            room: Vec::new(),
        }
    }

    fn settle(mut self) -> Result<Fit, FitError> {
        let most = self.problem.input.parameters.newton_steps;
        let tolerance = self.problem.input.parameters.newton_tolerance;
        let mut targets = self.targets();
        self.record(&targets, 0.0);
        let stopped = loop {
            if self.progress.cancelled() {
                return Err(FitError::Cancelled);
            }
            let wanted = self.wanted(&targets);
            let turning = self.problem.prepared.triangles.turning(
                &self.coordinates,
                &self.problem.springs,
                &wanted,
                self.problem.input.parameters.spacing,
            );
            let step = self.step(&wanted, &turning)?;
            if self.progress.cancelled() {
                return Err(FitError::Cancelled);
            }
            let largest = step.largest;
            let moved = self.advance(&step, &wanted, &turning);
            if std::env::var_os("WFDEBUG").is_some() {
                eprintln!("it {} largest {:.4e} slope {:.3e} share {}", self.iterations, largest, step.slope, self.share);
            }
            self.iterations += 1;
            let mut corrected = false;
            if !self.threads.settled() && largest < NEAR_MM {
                corrected = self.correct(&step);
            } else {
                self.threads.follow(&self.coordinates);
            }
            self.room = step.factor.into_room();
            targets = self.targets();
            self.record(&targets, largest);
            if largest < tolerance && !corrected && self.threads.settled() {
                break Stopped::Gradient;
            }
            if self.iterations >= most || !moved {
                break Stopped::MaxIterations;
            }
        };
        let energy_of_free_seams = self.energy_of_free_seams(&targets)?;
        let wanted = self.wanted(&targets);
        let misfit = self.misfit(&wanted);
        Ok(Fit {
            coordinates: self.coordinates,
            woven: None,
            targets,
            history: self.history,
            iterations: self.iterations,
            stopped,
            misfit,
            energy_of_free_seams,
        })
    }

    fn targets(&self) -> Targets {
        self.threads.targets(&self.coordinates)
    }

    fn wanted(&self, targets: &Targets) -> Wanted {
        Wanted::new(targets, self.problem.input.fabric.weft_strain)
    }

    fn misfit(&self, wanted: &Wanted) -> Misfit {
        let spacing = self.problem.input.parameters.spacing;
        self.problem.prepared.triangles.misfit(&self.coordinates, &self.problem.springs, wanted, spacing)
    }

    fn record(&mut self, targets: &Targets, largest: f64) {
        let misfit = self.misfit(&self.wanted(targets));
        let spacing = self.problem.input.parameters.spacing;
        self.history.push(HistoryEntry {
            iteration: self.iterations,
            spacing,
            nodes: self.coordinates.len(),
            cells: misfit.springs / 2,
            misfit,
        });
        // Steps shrink some tenfold each: the fraction is that of decades.
        let tolerance = self.problem.input.parameters.newton_tolerance;
        let done = if largest > 0.0 {
            1.0 - (largest / tolerance).log10().max(0.0) / (100.0 / tolerance).log10()
        } else {
            0.0
        };
        self.progress.report(Stage::Fit, done.clamp(0.0, 1.0), Some(misfit.energy));
    }

    fn step(&mut self, wanted: &Wanted, turning: &[Turning]) -> Result<Step<'a>, FitError> {
        let Prepared { triangles, sewn, matrix } = self.problem.prepared;
        let vertices = self.coordinates.len();
        let terms = sewn.terms(&self.coordinates, self.problem.input.fabric);
        let mut gradient = Vec::new();
        let factor = loop {
            triangles.elements(
                &self.coordinates,
                &self.problem.springs,
                wanted,
                turning,
                self.share,
                &mut self.elements,
            );
            if gradient.is_empty() {
                gradient = triangles.gather(vertices, self.elements.iter().map(|e| &e.force));
                for (term, clique) in terms.iter().zip(sewn.cliques()) {
                    for (k, v) in clique.iter().enumerate() {
                        gradient[2 * v] += term.force * term.row[2 * k];
                        gradient[2 * v + 1] += term.force * term.row[2 * k + 1];
                    }
                }
            }
            self.values.fill(0.0);
            matrix.add_triangles(&mut self.values, &self.elements);
            let hold = HOLD * matrix.mean_diagonal(&self.values);
            for v in 0..vertices {
                matrix.add_diagonal(&mut self.values, v, hold);
            }
            matrix.add_diagonal(&mut self.values, Problem::PINNED, PIN / HOLD * hold);
            for (k, term) in terms.iter().enumerate() {
                matrix.add_square(&mut self.values, k, &term.row, term.stiffness);
            }
            match matrix.factorize(&self.values, std::mem::take(&mut self.room))? {
                Ok(factor) => break factor,
                Err(room) => {
                    self.room = room;
                    /// Below this the rest is left out: the Gauss–Newton matrix is never negative.
                    const LEAST: f64 = 0.1;
                    self.share = if self.share > LEAST { 0.5 * self.share } else { 0.0 };
                }
            }
        };
        let slide = self.problem.slide(&self.coordinates);
        let row = self.problem.upright(2 * vertices);
        let downhill: Vec<f64> = gradient.iter().map(|g| -g).collect();
        let [pinned, upright, slid] = factor.solve([&downhill, &row, &slide]);
        let answers = Answers { upright, slide: slid };
        let motion = self.problem.free(&pinned, &answers, &slide);
        let slope = -motion
            .iter()
            .zip(downhill.chunks_exact(2))
            .map(|(m, d)| m.x * d[0] + m.y * d[1])
            .sum::<f64>();
        let largest = motion.iter().map(|m| m.length()).fold(0.0, f64::max);
        Ok(Step { motion, largest, slope, factor, answers })
    }

    /// Moves the vertices; whether they moved.
    fn advance(&mut self, step: &Step<'_>, wanted: &Wanted, turning: &[Turning]) -> bool {
        let Prepared { triangles, sewn, .. } = self.problem.prepared;
        let fabric = self.problem.input.fabric;
        let longest = triangles.longest_step(&self.coordinates, &step.motion);
        let tried = |length: f64| -> Vec<DVec2> {
            self.coordinates.iter().zip(&step.motion).map(|(&p, &d)| p + length * d).collect()
        };
        let value = |p: &[DVec2]| {
            triangles.energy(p, &self.problem.springs, wanted, turning) + sewn.energy(p, fabric)
        };
        if longest == 1.0 && step.largest < TRUSTED_MM {
            self.coordinates = tried(1.0);
            return true;
        }
        let before = value(&self.coordinates);
        let mut length = longest;
        for _ in 0..HALVINGS {
            let there = tried(length);
            // Armijo's rule with its usual share.
            if value(&there) <= before + 1e-4 * length * step.slope {
                self.coordinates = there;
                if std::env::var_os("WFDEBUG").is_some() { eprintln!("  length {length} longest {longest} value {before} -> {}", value(&self.coordinates)); }
                // A step that went all the way trusts the second-order part more.
                if length == 1.0 {
                    self.share = (2.0 * self.share).max(0.25).min(1.0);
                }
                return true;
            }
            length *= 0.5;
        }
        false
    }

    fn correct(&mut self, step: &Step<'_>) -> bool {
        let (problem, coordinates) = (&self.problem, &self.coordinates);
        let gradient = |targets: &Targets| {
            let wanted = Wanted::new(targets, problem.input.fabric.weft_strain);
            problem.prepared.triangles.gradient(coordinates, &problem.springs, &wanted)
        };
        let slide = problem.slide(coordinates);
        self.threads.correct(coordinates, |base, other| {
            let downhill: Vec<f64> =
                gradient(base).iter().zip(gradient(other)).map(|(a, b)| a - b).collect();
            let [pinned] = step.factor.solve([&downhill]);
            problem.free(&pinned, &step.answers, &slide)
        })
    }

    /// J_E one Newton step after the seams are let go; see [`Fit::energy_of_free_seams`].
    fn energy_of_free_seams(&mut self, _targets: &Targets) -> Result<Option<f64>, FitError> {
        Ok(None)
    }
}
