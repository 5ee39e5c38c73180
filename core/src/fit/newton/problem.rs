//! The equations of one Newton step: gradient, Hessian, and what holds the fabric.

use glam::DVec2;

use super::Solver;
use super::element::{Order, Springs};
use super::seam::Courses;
use super::triangles::{Turning, Wanted};
use crate::fit::{FitError, FitInput};
use crate::progress::Progress;
use crate::sparse::{Element, SurfaceFactor};

/// Added to the Hessian's diagonal, relative to its mean: it holds the rotation that may cost nothing
/// and is far below any stiffness of the fabric.
const HOLD: f64 = 1e-7;

/// Stiffness that holds one vertex, relative to the mean of the Hessian's diagonal.
const PIN: f64 = 1e4;

/// The vertex that is held while a step is computed, where the fabric may slide: any will do.
const PINNED: usize = 0;

/// A fit without its state.
pub struct Problem<'a> {
    /// The surface.
    pub solver: &'a Solver,
    /// What is wanted.
    pub input: &'a FitInput<'a>,
    /// The fabric's stiffness.
    pub springs: Springs,
    /// The row of the linear constraint on the coordinates (index among x₀, y₀, x₁, …; factor):
    /// difference of the markers' x.
    upright: Vec<(usize, f64)>,
    /// Whom to tell how far it is.
    pub progress: &'a dyn Progress,
}

/// A factorized Hessian.
pub struct Model {
    factor: SurfaceFactor,
    /// Pattern coordinates at which it was taken.
    pub place: Vec<DVec2>,
    /// Along which the sewn edges pull: a force across the course that was factorized would move the
    /// fabric as if nothing held it.
    pub courses: Courses,
    /// How the pinned fabric answers to the force of the markers' constraint.
    upright: Vec<f64>,
    /// How it answers to a unit of force along weft, shared out over the fabric.
    slide: Vec<f64>,
}

/// A factorized Hessian with the step that it makes.
pub struct Solved {
    /// The Hessian.
    pub model: Model,
    /// Minus the gradient, in N.
    pub downhill: Vec<f64>,
    /// The full step, in mm.
    pub motion: Vec<DVec2>,
}

impl Model {
    /// What is factorized.
    pub fn into_factor(self) -> SurfaceFactor {
        self.factor
    }
}

/// A state of the fabric.
pub struct Place<'a> {
    /// Pattern coordinates by vertex, in mm.
    pub coordinates: &'a [DVec2],
    /// The strains wanted.
    pub wanted: &'a Wanted,
    /// The turning springs.
    pub turning: &'a [Turning],
}

/// Memory that is used again for every Hessian.
#[derive(Default)]
pub struct Room {
    elements: Vec<Element>,
    values: Vec<f64>,
}

impl<'a> Problem<'a> {
    /// The fit of a solver surface.
    pub fn new(solver: &'a Solver, input: &'a FitInput<'a>, progress: &'a dyn Progress) -> Self {
        let mut upright = Vec::with_capacity(6);
        for (marker, sign) in input.markers.iter().zip([1.0, -1.0]) {
            let weights = marker.barycentric.to_array();
            for (v, w) in input.disk.triangle(marker.triangle).iter().zip(weights) {
                upright.push((2 * v.index(), sign * w));
            }
        }
        let fabric = input.fabric;
        let springs = Springs { warp: fabric.warp, weft: fabric.weft, diagonal: fabric.diagonal };
        Self { solver, input, springs, upright, progress }
    }

    /// Asks whether to go on.
    ///
    /// # Errors
    /// If the job is cancelled.
    pub fn ask(&self) -> Result<(), FitError> {
        if self.progress.cancelled() { Err(FitError::Cancelled) } else { Ok(()) }
    }

    /// Energy with turning springs and seams, in N·mm.
    pub fn value(&self, at: &Place<'_>) -> f64 {
        let Solver { triangles, sewn, .. } = self.solver;
        triangles.energy(at.coordinates, &self.springs, at.wanted, at.turning)
            + sewn.energy(at.coordinates, self.input.fabric)
    }

    /// Minus the gradient of it, in N, where the seams pull along `courses`, and by what is `turned`, too.
    pub fn downhill(&self, at: &Place<'_>, courses: &Courses, turned: &[f64]) -> Vec<f64> {
        let mut force = self.fabric(at);
        let Solver { sewn, .. } = self.solver;
        sewn.add_forces(&mut force, at.coordinates, courses, self.input.fabric);
        force.iter_mut().zip(turned).for_each(|(force, turned)| *force += turned);
        for f in &mut force {
            *f = -*f;
        }
        force
    }

    /// The fabric's part of the gradient, in N.
    pub fn fabric(&self, at: &Place<'_>) -> Vec<f64> {
        let triangles = &self.solver.triangles;
        triangles.gradient(at.coordinates, &self.springs, at.wanted, at.turning)
    }

    /// The Hessian to the given order, minus the gradient, and the full step; `None` if the Hessian is not
    /// positive definite.
    ///
    /// # Errors
    /// If memory runs out or the job is cancelled.
    pub fn model(
        &self,
        at: &Place<'_>,
        order: Order,
        room: &mut Room,
    ) -> Result<Option<Solved>, FitError> {
        let Solver { sewn, matrix, .. } = self.solver;
        let courses = sewn.courses(at.coordinates);
        self.assemble(at, order, room);
        let stiffnesses = sewn.stiffnesses(self.input.fabric);
        for (k, (row, stiffness)) in courses.rows().iter().zip(stiffnesses).enumerate() {
            matrix.add_square(&mut room.values, k, row, stiffness);
        }
        self.solved(at, courses, room)
    }

    /// The same without the seams.
    ///
    /// # Errors
    /// If memory runs out or the job is cancelled.
    pub fn unsewn(&self, at: &Place<'_>, room: &mut Room) -> Result<Option<Solved>, FitError> {
        self.assemble(at, Order::Convex, room);
        self.solved(at, Courses::default(), room)
    }

    /// The triangles' Hessian and what holds the fabric, into the room's values.
    fn assemble(&self, at: &Place<'_>, order: Order, room: &mut Room) {
        let Solver { triangles, matrix, .. } = self.solver;
        let Room { elements, values, .. } = room;
        triangles.elements(at.coordinates, &self.springs, at.wanted, at.turning, order, elements);
        matrix.set_triangles(values, elements);
        let mean = matrix.mean_diagonal(values);
        for v in 0..at.coordinates.len() {
            matrix.add_diagonal(values, v, HOLD * mean);
        }
        matrix.add_diagonal(values, PINNED, PIN * mean);
    }

    /// The room's values factorized, and the step that they make; `None` if they are not positive definite.
    fn solved(
        &self,
        at: &Place<'_>,
        courses: Courses,
        room: &Room,
    ) -> Result<Option<Solved>, FitError> {
        let matrix = &self.solver.matrix;
        let downhill = self.downhill(at, &courses, &[]);
        self.ask()?;
        let Some(factor) = matrix.factorize(&room.values, self.progress)? else {
            self.ask()?;
            return Ok(None);
        };
        self.ask()?;
        let (row, slide) = (self.lean(at.coordinates.len()), self.shares(at.coordinates));
        let mut solutions = matrix.solve(&factor, &[&row, &slide, &downhill]).into_iter();
        let mut next = || solutions.next().unwrap_or_default();
        let (upright, slide, pinned) = (next(), next(), next());
        let place = at.coordinates.to_vec();
        let model = Model { factor, place, courses, upright, slide };
        let motion = self.freed(&model, &pinned);
        Ok(Some(Solved { model, downhill, motion }))
    }

    /// Whether a Hessian of that problem serves for this one: the same fabric and the same markers.
    pub fn like(&self, springs: &Springs, upright: &[(usize, f64)]) -> bool {
        self.springs == *springs && self.upright == upright
    }

    /// The row of the markers' constraint, in short.
    pub fn upright(&self) -> &[(usize, f64)] {
        &self.upright
    }

    /// Vertices that are not moved by themselves: what seams hold, and what holds the markers upright.
    pub fn held(&self) -> impl Iterator<Item = usize> + '_ {
        let sewn = self.solver.sewn.cliques().iter().flatten().copied();
        sewn.chain(self.upright.iter().map(|&(i, _)| i / 2))
    }

    /// The row of the markers' constraint.
    fn lean(&self, vertices: usize) -> Vec<f64> {
        let mut row = vec![0.0; 2 * vertices];
        for &(i, w) in &self.upright {
            row[i] += w;
        }
        row
    }

    /// Shares of the vertices in the pattern's area, as forces along weft.
    fn shares(&self, coordinates: &[DVec2]) -> Vec<f64> {
        let shares = self.solver.triangles.shares(coordinates);
        let whole: f64 = shares.iter().sum();
        shares.iter().flat_map(|share| [0.0, share / whole]).collect()
    }

    /// The motions by which the fabric answers to forces.
    pub fn answers(&self, model: &Model, forces: &[&[f64]]) -> Vec<Vec<DVec2>> {
        let pinned = self.solver.matrix.solve(&model.factor, forces);
        pinned.iter().map(|pinned| self.freed(model, pinned)).collect()
    }

    /// The motion of a fabric that is not pinned.
    ///
    /// The strain function is built anew round the annotated points before every step, so that sliding
    /// along it wins nothing; a net force along weft is borne by all of the fabric alike, as a
    /// woven model that slides steadily would bear it. So to the pinned fabric's answer are added
    /// those to the shared force and to the markers' constraint that make the pin bear nothing and the
    /// markers stand upright. The fabric's middle stays where it is.
    fn freed(&self, model: &Model, pinned: &[f64]) -> Vec<DVec2> {
        let lean = |x: &[f64]| self.upright.iter().map(|&(i, w)| w * x[i]).sum::<f64>();
        let pin = |x: &[f64]| x[2 * PINNED + 1];
        let (u, s) = (&model.upright, &model.slide);
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
        let shares = &self.solver.shares;
        let middle: f64 = motion.iter().zip(shares).map(|(m, share)| share * m.y).sum();
        for m in &mut motion {
            m.y -= middle;
        }
        motion
    }
}
