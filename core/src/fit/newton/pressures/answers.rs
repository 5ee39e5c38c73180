//! How pressures and pattern answer to the target strains, and the targets that follow from it.

use std::ops::Range;

use glam::DVec2;

use super::Threads;
use crate::design::{Fabric, PressureModel};
use crate::fit::FitInput;
use crate::fit::newton::least_squares::LeastSquares;
use crate::geometry::SurfacePoint;
use crate::pressure::{Reached, Stretch, Targets, pressure_kpa};

/// α.
const EFFORT: f64 = 1e-3;

/// Pressures whose answers are solved for together.
const AT_ONCE: usize = 4;

/// Change of a target strain by which the pattern's answer to it is taken: a function of strain through two
/// threads side by side swings by many times as much at its ends, and bends the rows there.
pub const PROBE: f64 = 1e-4;

/// How pressures and pattern answer to the targets.
pub struct Answers {
    /// The annotations of each thread, and where they are.
    groups: Vec<Vec<usize>>,
    bundles: Vec<Range<usize>>,
    points: Vec<SurfacePoint>,
    /// What makes pressures of strains.
    fabric: Fabric,
    pressure_model: PressureModel,
    /// Pressures by bundle then by annotation, in kPa per strain.
    pressures: Vec<Vec<f64>>,
    /// Motions of the vertices by bundle, in mm per strain; none where they were not solved for.
    pub(super) motions: Vec<Vec<DVec2>>,
}

impl Answers {
    /// Whether they are those of these threads.
    pub(super) fn serve(&self, threads: &Threads<'_>) -> bool {
        let FitInput { annotations, fabric, pressure_model, .. } = *threads.input;
        let points = annotations.iter().map(|annotation| annotation.point);
        self.groups == threads.groups
            && self.bundles == threads.bundles
            && self.points.iter().copied().eq(points)
            && self.fabric == *fabric
            && self.pressure_model == pressure_model
    }
}

impl Threads<'_> {
    /// Pressure per strain of a thread by itself, in kPa.
    fn own(&self, reached: &Reached) -> f64 {
        let FitInput { fabric, pressure_model, .. } = *self.input;
        let Reached { curvature, threads, .. } = reached;
        let [now, more] = [0.0, 0.01].map(|more| {
            let stretch = Stretch::without_shear(threads.warp.max(0.0) + more, threads.weft);
            pressure_kpa(pressure_model, fabric, curvature, &stretch)
        });
        (more - now) / 0.01
    }

    /// How pressures and pattern answer to the targets here.
    pub(super) fn answers(
        &self,
        coordinates: &[DVec2],
        got: &[f64],
        answers: impl Fn(&[Targets]) -> Vec<Vec<DVec2>>,
    ) -> Answers {
        let FitInput { annotations, fabric, pressure_model, .. } = *self.input;
        let count = self.bundles.len();
        let solved: Vec<(usize, f64)> = (0..count)
            .filter_map(|i| {
                let asked = self.asked_of(i);
                // Away from the nearer end of the range, where the function is held.
                let mean = asked.iter().sum::<f64>() / asked.len() as f64;
                let step = if mean > 0.5 * fabric.max_strain { -PROBE } else { PROBE };
                (!asked.is_empty()).then_some((i, step))
            })
            .collect();
        let others: Vec<Targets> = solved
            .iter()
            .map(|(i, step)| {
                let mut other = self.asked.clone();
                for asked in &mut other[self.bundles[*i].clone()] {
                    *asked = asked.map(|asked| asked + step);
                }
                self.with(coordinates, &other)
            })
            .collect();
        let mut pressures = vec![vec![0.0; annotations.len()]; count];
        // A few at a time, between which the job can be cancelled.
        let moved = others.chunks(AT_ONCE).flat_map(answers);
        let mut motions = vec![Vec::new(); count];
        for (&(i, step), moved) in solved.iter().zip(moved) {
            let there: Vec<DVec2> = coordinates.iter().zip(&moved).map(|(&p, &d)| p + d).collect();
            for (k, there) in self.pressures(&self.reader.read(&there)).into_iter().enumerate() {
                pressures[i][k] = (there - got[k]) / step;
            }
            motions[i] = moved.into_iter().map(|d| d / step).collect();
        }
        Answers {
            groups: self.groups.clone(),
            bundles: self.bundles.clone(),
            points: annotations.iter().map(|annotation| annotation.point).collect(),
            fabric: fabric.clone(),
            pressure_model,
            pressures,
            motions,
        }
    }

    /// The targets of the threads of a bundle that can be pressed on.
    fn asked_of(&self, bundle: usize) -> Vec<f64> {
        self.asked[self.bundles[bundle].clone()].iter().copied().flatten().collect()
    }

    /// The changes that bring the pressures nearest to what was asked, by the answers.
    pub(super) fn changes(&self, here: &[Reached], got: &[f64], counts: &[bool]) -> Vec<f64> {
        let FitInput { annotations, fabric, .. } = *self.input;
        let count = self.bundles.len();
        let answers = self.answers.as_ref().map_or(&[][..], |answers| &answers.pressures);
        let mut problem = LeastSquares::new(count);
        for k in (0..annotations.len()).filter(|&k| counts[k]) {
            let row: Vec<f64> = (0..count).map(|i| answers[i][k]).collect();
            problem.add(&row, annotations[k].kpa - got[k], 1.0);
        }
        let mut limits = vec![[0.0, 0.0]; count];
        for (i, bundle) in self.bundles.iter().enumerate() {
            for thread in bundle.clone() {
                let (Some(asked), Some(wanted)) = (self.asked[thread], self.wanted[thread]) else {
                    continue;
                };
                let wanted = wanted.clamp(0.0, fabric.max_strain);
                let own = self.groups[thread].iter().map(|&k| self.own(&here[k]).powi(2));
                let mut row = vec![0.0; count];
                row[i] = own.sum::<f64>().sqrt();
                problem.add(&row, row[i] * (wanted - asked), EFFORT);
                // As far as any of them can go; those that cannot stay at the end of their range.
                let [low, high] = limits[i];
                limits[i] = [f64::min(low, -asked), f64::max(high, fabric.max_strain - asked)];
            }
        }
        problem.solve(&limits)
    }
}
