//! The paper's method: woven nodes on the surface, moved until the springs have their wanted lengths.
//!
//! The paper's loop (section 5): determine the expected strain of every spring, move the nodes
//! through energy diffusion, keep the markers on a vertical line, repeat until E_SSD is small or
//! nothing changes any more. Run coarse to fine: a wide woven model finds the overall shape in few
//! steps and covers the surface, then the spacing is halved.

mod correction;
mod cover;
mod orientation;
mod step;

use glam::DVec2;

pub use correction::Corrections;
pub use cover::{Departures, grow};
pub use orientation::{lean, turn};
pub use step::{gradient, step, step_length};

use super::{Fit, FitError, FitInput, HistoryEntry, Misfit, Stopped, at_plateau};
use crate::design::Fabric;
use crate::mapping::{Mapping, MappingError};
use crate::pressure::{TargetError, Woven, WovenTargets, target_strains};
use crate::progress::{Progress, Stage};
use crate::weave::{WovenModel, lay};

/// A woven model at rest on the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Rest {
    /// The nodes.
    pub model: WovenModel,
    /// The wanted strains for these nodes.
    pub targets: WovenTargets,
    /// One entry a pass.
    pub history: Vec<HistoryEntry>,
    /// Diffusion steps, all levels together.
    pub iterations: u64,
    /// Why it ended.
    pub stopped: Stopped,
    /// J_E and E_SSD of the nodes with the wanted strains.
    pub misfit: Misfit,
}

impl Rest {
    /// The fit with these pattern coordinates of the vertices, which lie `rise` mm higher along weft
    /// than the nodes' own.
    #[must_use]
    pub fn with_coordinates(self, coordinates: Vec<DVec2>, rise: f64) -> Fit {
        let mut targets = self.targets.targets;
        targets.extent = targets.extent.map(|y| y + rise);
        for thread in &mut targets.threads {
            thread.y += rise;
        }
        Fit {
            coordinates,
            woven: Some(Woven { model: self.model, nodes: self.targets.nodes }),
            targets,
            history: self.history,
            iterations: self.iterations,
            stopped: self.stopped,
            misfit: self.misfit,
        }
    }
}

/// A coarse level is of use only with at least this many cells.
const FEWEST_CELLS: usize = 30;

/// Steps over which the plateau is measured at a spacing of 5 mm in a fabric no stiffer along weft
/// than along warp.
const PLATEAU_WINDOW: f64 = 1000.0;

/// Steps in which a level changes as much as 5 mm does in a thousand: a disturbance diffuses over a
/// length in a number of steps that goes with the square of the number of nodes, and λ is set by the
/// stiffest thread, so that weaker warp threads move more slowly.
fn window(spacing: f64, fabric: &Fabric) -> u64 {
    let stiffest = fabric.warp.max(fabric.weft).max(fabric.diagonal);
    (PLATEAU_WINDOW * (5.0 / spacing).powi(2) * stiffest / fabric.warp).ceil() as u64
}

/// After so many windows a coarse level has given what it can, and threads that have not settled
/// will not.
const MOST_WINDOWS: u64 = 6;

/// The paper's diffusion, coarse to fine.
///
/// # Errors
/// If the fabric cannot be laid or mapped, or the job is cancelled.
pub fn diffuse(input: &FitInput<'_>, progress: &dyn Progress) -> Result<Rest, FitError> {
    let parameters = input.parameters;
    let mut run = Run {
        input,
        progress,
        history: Vec::new(),
        iterations: 0,
        corrections: Corrections::none(input.annotations.len()),
    };
    let squeeze = DVec2::new(parameters.start_warp, parameters.start_weft);
    let mut plane: Vec<DVec2> = input.omega.iter().map(|&p| p * squeeze).collect();
    let mut level = parameters.coarse_levels;
    loop {
        let spacing = parameters.spacing * f64::from(1u32 << level);
        let model = lay(input.disk, &centred(&plane, spacing), spacing);
        if level > 0 && model.cell_count() < FEWEST_CELLS {
            level -= 1;
            continue;
        }
        let rest = run.settle(model, level)?;
        if level == 0 {
            return Ok(rest);
        }
        plane = Mapping::new(input.disk, &rest.model).vertices()?;
        level -= 1;
    }
}

/// The plane shifted so that the middle of its extent lies at no simple fraction of a cell: on
/// regular surfaces nodes would otherwise fall exactly on the boundary, in or out by rounding.
fn centred(plane: &[DVec2], spacing: f64) -> Vec<DVec2> {
    let first = plane.first().copied().unwrap_or_default();
    let (low, high) =
        plane.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
    let shift = DVec2::new(0.37, 0.41) * spacing - 0.5 * (low + high);
    plane.iter().map(|&p| p + shift).collect()
}

struct Run<'a> {
    input: &'a FitInput<'a>,
    progress: &'a dyn Progress,
    history: Vec<HistoryEntry>,
    iterations: u64,
    corrections: Corrections,
}

impl Run<'_> {
    /// Steps 2 and 3 on one level until it rests.
    fn settle(&mut self, mut model: WovenModel, level: u64) -> Result<Rest, FitError> {
        let FitInput { disk, fabric, parameters, .. } = *self.input;
        let lambda = step_length(parameters.damping, fabric);
        let window = window(model.spacing(), fabric).max(parameters.steps_per_pass);
        let (begin, first) = (self.history.len(), self.iterations);
        let mut departures = Departures::default();
        let mut targets = self.targets(&model)?;
        self.record(&model, &targets);
        loop {
            if self.progress.cancelled() {
                return Err(FitError::Cancelled);
            }
            let left = parameters.max_iterations - self.iterations;
            let steps = parameters.steps_per_pass.min(left);
            let before = model.clone();
            for _ in 0..steps {
                model = step(disk, &model, &targets.rest, fabric, lambda);
            }
            self.iterations += steps;
            model.drop_loose_nodes();
            model = self.upright(model)?;
            model.drop_loose_nodes();
            departures.count(&before, &model);
            let (grown, added) = grow(disk, &model, &targets.rest, &departures);
            model = grown;
            if parameters.correct_pressures {
                self.corrections.update(&model, &targets.targets, fabric, lambda, steps);
            }
            targets = self.targets(&model)?;
            let misfit = self.record(&model, &targets);
            let course = &self.history[begin..];
            // A thread that does not answer to its correction does not hold up the fit for ever.
            let settled = self.corrections.settled()
                || at_plateau(course, MOST_WINDOWS * window, parameters.plateau);
            let coarse_enough = level > 0 && self.iterations - first >= MOST_WINDOWS * window;
            let stopped = if added == 0
                && settled
                && misfit.rms_strain() < parameters.strain_tolerance
            {
                Stopped::Tolerance
            } else if coarse_enough || (settled && at_plateau(course, window, parameters.plateau)) {
                Stopped::Plateau
            } else if self.iterations >= parameters.max_iterations {
                Stopped::MaxIterations
            } else {
                continue;
            };
            return Ok(Rest {
                model,
                targets,
                history: self.history.clone(),
                iterations: self.iterations,
                stopped,
                misfit,
            });
        }
    }

    fn targets(&self, model: &WovenModel) -> Result<WovenTargets, TargetError> {
        target_strains(
            self.input.disk,
            model,
            self.input.annotations,
            self.input.fabric,
            self.input.pressure_model,
            self.input.parameters.row_spacing,
            self.input.parameters.correct_pressures.then(|| self.corrections.strains()),
        )
    }

    fn record(&mut self, model: &WovenModel, targets: &WovenTargets) -> Misfit {
        let misfit = Misfit::of(model, &targets.rest, self.input.fabric);
        self.history.push(HistoryEntry {
            iteration: self.iterations,
            spacing: model.spacing(),
            nodes: model.node_count(),
            cells: model.cell_count(),
            misfit,
        });
        let done = self.iterations as f64 / self.input.parameters.max_iterations as f64;
        self.progress.report(Stage::Fit, done, Some(misfit.energy));
        misfit
    }

    /// The model with its markers on a vertical line.
    fn upright(&self, model: WovenModel) -> Result<WovenModel, MappingError> {
        let disk = self.input.disk;
        let mapping = Mapping::new(disk, &model);
        let [upper, lower] = self.input.markers;
        let (upper, lower) = (mapping.point(upper)?, mapping.point(lower)?);
        Ok(turn(disk, &model, lean(upper, lower), 0.5 * (upper + lower)))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::design::PressureModel;
    use crate::geometry::{Locator, SurfacePoint};
    use crate::parameters::Parameters;
    use crate::pressure::Annotation;
    use crate::progress::Silent;
    use crate::surface::{Surface, VertexId};

    /// A slit cylinder about z and its development, the slit at the back.
    fn slit_cylinder(radius: f64, length: f64, n: usize, rows: usize) -> (Surface, Vec<DVec2>) {
        let mut points = Vec::new();
        let mut plane = Vec::new();
        for i in 0..=rows {
            let z = length * i as f64 / rows as f64;
            for j in 0..=n {
                let a = std::f64::consts::TAU * j as f64 / n as f64;
                points.push(DVec3::new(radius * a.cos(), radius * a.sin(), z));
                plane.push(DVec2::new(radius * a, z));
            }
        }
        let id = |i: usize, j: usize| VertexId::new(i * (n + 1) + j);
        let mut triangles = Vec::new();
        for i in 0..rows {
            for j in 0..n {
                triangles.push([id(i, j), id(i, j + 1), id(i + 1, j + 1)]);
                triangles.push([id(i, j), id(i + 1, j + 1), id(i + 1, j)]);
            }
        }
        (Surface::new(points, triangles).unwrap(), plane)
    }

    fn point_at(surface: &Surface, place: DVec3) -> SurfacePoint {
        Locator::new(surface).closest(place).unwrap().0
    }

    #[test]
    fn a_cylinder_comes_back_narrower_by_the_strain() {
        let (radius, length) = (45.0, 120.0);
        let (disk, omega) = slit_cylinder(radius, length, 96, 40);
        let markers = [length, 0.0].map(|z| point_at(&disk, DVec3::new(-radius, 0.0, z)));
        let at = DVec3::new(-radius, 0.0, 60.0);
        let shape = crate::geometry::ShapeOperator {
            normal: DVec3::NEG_X,
            u: DVec3::Y,
            v: DVec3::Z,
            kuu: 1.0 / radius,
            kuv: 0.0,
            kvv: 0.0,
        };
        let annotations = [Annotation { at, point: point_at(&disk, at), kpa: 2.0, shape }];
        let parameters = Parameters::default();
        let input = FitInput {
            disk: &disk,
            omega: &omega,
            markers: &markers,
            annotations: &annotations,
            fabric: &Fabric::default(),
            pressure_model: PressureModel::Laplace,
            parameters: &parameters,
        };
        let fit = diffuse(&input, &Silent).unwrap();
        assert!(fit.stopped.converged());
        let plane = Mapping::new(&disk, &fit.model).vertices().unwrap();
        let strain = 0.002 * radius / 0.5;
        let girth = 2.0 * 96.0 * radius * (std::f64::consts::PI / 96.0).sin();
        let row = |i: usize| plane[i * 97 + 96].x - plane[i * 97].x;
        for i in [0, 20, 40] {
            let width = row(i);
            eprintln!(
                "{} {} {}",
                width,
                girth / (1.0 + strain),
                width / (girth / (1.0 + strain)) - 1.0
            );
            assert!((width * (1.0 + strain) / girth - 1.0).abs() < 0.01, "{width}");
        }
        let height = plane[40 * 97 + 48].y - plane[48].y;
        assert!((height / length - 1.0).abs() < 0.01, "{height}");
    }
}
