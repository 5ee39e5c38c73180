//! When the targets are corrected, and how the fabric goes along.

use glam::DVec2;

use super::{Run, Step};
use crate::fit::newton::course::NEAR_MM;
use crate::fit::newton::pressures::Correction;
use crate::fit::newton::problem::Place;
use crate::fit::newton::triangles::Wanted;
use crate::pressure::Targets;

/// Targets are corrected when a step moves no vertex by more than [`NEAR_MM`], or promises less than this
/// share of the energy: then most of what is left is local, and a whole thread's strain hardly changes.
const NEAR_ENERGY: f64 = 0.02;

/// They are corrected for the first time after a step that moves no vertex by more than this, in mm: the
/// fabric is then still on its way, and goes to another place at no cost.
const FIRST_MM: f64 = 35.0;

impl Run<'_> {
    /// Whether the fabric is near enough to where it goes for the targets to be corrected.
    pub(super) fn ripe(&self, step: &Step) -> bool {
        let energy = self.history.last().map_or(0.0, |entry| entry.misfit.energy);
        let near = step.largest < NEAR_MM || -step.slope < NEAR_ENERGY * energy;
        near || if self.threads.untouched() { step.largest < FIRST_MM } else { !self.stale }
    }

    /// How the targets are to be corrected here.
    pub(super) fn correction(&mut self, largest: f64) -> Correction {
        if self.stale {
            self.threads.forget_answers();
        }
        let (problem, coordinates, model) = (&self.problem, &self.coordinates, &self.model);
        let gradient = |targets: &Targets| {
            let wanted = Wanted::new(targets, problem.input.fabric.weft_strain);
            problem.solver.triangles.gradient(coordinates, &problem.springs, &wanted, &[])
        };
        let now = self.threads.targets(coordinates);
        self.threads.correction(coordinates, largest, |others| {
            let Some(model) = model else { return Vec::new() };
            if problem.ask().is_err() {
                return Vec::new();
            }
            let here = gradient(&now);
            let forces: Vec<Vec<f64>> = others
                .iter()
                .map(|other| here.iter().zip(gradient(other)).map(|(a, b)| a - b).collect())
                .collect();
            if problem.ask().is_err() {
                return Vec::new();
            }
            let forces: Vec<&[f64]> = forces.iter().map(Vec::as_slice).collect();
            problem.answers(model, &forces)
        })
    }

    /// Corrects them.
    pub(super) fn take(&mut self, correction: &Correction) {
        let motion = self.threads.take(correction);
        if !correction.counts() {
            return;
        }
        // The next step is not to be measured against the last.
        self.last = f64::INFINITY;
        let triangles = &self.problem.solver.triangles;
        if motion.is_empty() || triangles.longest_step(&self.coordinates, &motion) < 1.0 {
            return;
        }
        // The vertices go along at once, unless the answers are from a place too far away.
        let there: Vec<DVec2> =
            self.coordinates.iter().zip(&motion).map(|(&p, &d)| p + d).collect();
        let value = |coordinates: &[DVec2]| {
            let wanted = self.wanted(&self.threads.targets(coordinates));
            self.problem.value(&Place { coordinates, wanted: &wanted, turning: &[] })
        };
        if value(&there) < value(&self.coordinates) {
            self.coordinates = there;
        }
    }
}
