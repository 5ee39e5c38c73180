//! Coarse to fine: a first fit begins where one of the same surface with fewer vertices has ended, and a later one
//! goes on by what that fit, made again, has moved.
//!
//! Lobes turn and rows find their place on the thinned surface, where a step costs little; what is
//! left to all of the vertices is mostly local. What a coarse fit finds is only a start: where it finds none, or
//! one that turns triangles over, the initial parameterization is the start.

use glam::{DMat2, DVec2, DVec3};

use super::thinned::{Thinned, walk};
use super::{Below, Earlier, Fit, FitError, FitInput, Solver};
use crate::fit::Stopped;
use crate::geometry::{Grading, SurfacePoint};
use crate::parameterize::rest_of_lengths;
use crate::parameters::Parameters;
use crate::pressure::{Annotation, Targets};
use crate::progress::{Progress, Stage};
use crate::seams::Seam;
use crate::surface::{Surface, TriangleId};

/// Surfaces with fewer triangles are fitted as they are.
const LEAST_TRIANGLES: usize = 4000;

/// Edges are longer by this.
const LONGER: f64 = 3.0;

/// A start is found to within this, in mm.
const TOLERANCE_MM: f64 = 0.05;

/// And in so many steps, however few are allowed to the fit of all vertices.
const STEPS: u64 = 100;

/// A surface with fewer vertices, prepared for fits.
pub struct Coarse {
    thinned: Thinned,
    solver: Solver,
}

/// Where a fit of all vertices is to begin.
pub struct Start {
    /// As if it were an earlier fit.
    pub fit: Fit,
    /// The coarse fit.
    pub below: Below,
}

/// Asks for the end of a job that says nothing.
pub struct Quiet<'a>(pub &'a dyn Progress);

impl Progress for Quiet<'_> {
    fn report(&self, _stage: Stage, _fraction: f64, _energy: Option<f64>) {}

    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

impl Coarse {
    /// That of a surface; `None` for one that is small enough, or cannot be thinned.
    ///
    /// # Errors
    /// If memory runs out.
    pub fn new(
        disk: &Surface,
        seams: &[Seam],
        omega: &[DVec2],
        equal_seams: bool,
        grading: &Grading,
    ) -> Result<Option<Self>, FitError> {
        if disk.triangle_count() < LEAST_TRIANGLES {
            return Ok(None);
        }
        let Some(thinned) = Thinned::new(disk, seams, omega, LONGER, grading) else {
            return Ok(None);
        };
        // Where triangles are to be small nearly everywhere, thinning leads nowhere.
        if 2 * thinned.disk.triangle_count() > disk.triangle_count() {
            return Ok(None);
        }
        let rest = rest_of_lengths(thinned.lengths(disk));
        let Thinned { disk, seams, origin, .. } = &thinned;
        let mut solver = Solver::with_shapes(disk, &rest, seams, equal_seams)?;
        let omega: Vec<DVec2> = origin.iter().map(|&v| omega[v]).collect();
        solver.coarsen(disk, seams, &omega, equal_seams, grading)?;
        Ok(Some(Self { thinned, solver }))
    }

    /// Where the fit of all vertices is to begin; `None` if the coarse one leads nowhere, or if the earlier fit
    /// has none.
    ///
    /// # Errors
    /// If the job is cancelled.
    pub fn start(
        &self,
        input: &FitInput<'_>,
        earlier: Option<Earlier<'_>>,
        progress: &dyn Progress,
    ) -> Result<Option<Start>, FitError> {
        let before = match earlier {
            None => None,
            Some(Earlier { fit, kept }) => {
                let Some(below) = kept.and_then(|kept| kept.coarse.as_deref()) else {
                    return Ok(None);
                };
                Some((fit, below))
            }
        };
        let Thinned { disk, origin, places, .. } = &self.thinned;
        let omega: Vec<DVec2> = origin.iter().map(|&v| input.omega[v]).collect();
        let moved = |point: &SurfacePoint| {
            let at = point.interpolate(input.disk, input.omega);
            let near = places[input.disk.triangle(point.triangle)[0].index()].0;
            let (triangle, barycentric) = walk(disk, &omega, at, near);
            SurfacePoint { triangle, barycentric }
        };
        let annotations: Vec<Annotation> = input
            .annotations
            .iter()
            .map(|annotation| Annotation { point: moved(&annotation.point), ..*annotation })
            .collect();
        let markers = [0, 1].map(|k| moved(&input.markers[k]));
        let tolerance = input.parameters.newton_tolerance.max(TOLERANCE_MM);
        let parameters = Parameters {
            newton_tolerance: tolerance,
            newton_steps: STEPS,
            ..input.parameters.clone()
        };
        let own = FitInput {
            disk,
            omega: &omega,
            markers: &markers,
            annotations: &annotations,
            parameters: &parameters,
            ..*input
        };
        let quiet = Quiet(progress);
        let below = before.map(|(_, below)| Earlier { fit: &below.fit, kept: below.kept.as_ref() });
        let (fit, run) = match self.solver.fit(&own, below, &quiet) {
            Ok(found) => found,
            Err(FitError::Cancelled) => return Err(FitError::Cancelled),
            Err(_) => return Ok(None),
        };
        if fit.stopped != Stopped::Gradient {
            return Ok(None);
        }
        let spread = |values: &[DVec2]| refined(disk, &omega, values, places, input.omega);
        let start = match before {
            // Targets that were corrected on fewer vertices are of use if that met the pressures: those of contrary
            // wishes made threads cycle.
            None => Fit {
                coordinates: spread(&fit.coordinates),
                targets: Targets {
                    threads: if run.met() { fit.targets.threads.clone() } else { Vec::new() },
                    ..fit.targets.clone()
                },
                ..fit.clone()
            },
            Some((earlier, below)) => {
                let pairs = fit.coordinates.iter().zip(&below.fit.coordinates);
                let moved: Vec<DVec2> = pairs.map(|(to, from)| *to - *from).collect();
                let places = earlier.coordinates.iter().zip(spread(&moved));
                Fit {
                    coordinates: places.map(|(from, moved)| *from + moved).collect(),
                    targets: changed(&earlier.targets, &below.fit.targets, &fit.targets),
                    ..earlier.clone()
                }
            }
        };
        Ok(Some(Start { fit: start, below: Below { fit, kept: run.leave() } }))
    }
}

/// Targets with the changes of those of the same threads.
fn changed(targets: &Targets, before: &Targets, after: &Targets) -> Targets {
    let mut targets = targets.clone();
    for thread in &mut targets.threads {
        let same = |others: &Targets| {
            let found = others.threads.iter().find(|t| t.annotations == thread.annotations);
            found.and_then(|t| Some((t.wanted?, t.asked?)))
        };
        if let (Some(before), Some(after)) = (same(before), same(after)) {
            thread.wanted = thread.wanted.map(|wanted| wanted + after.0 - before.0);
            thread.asked = thread.asked.map(|asked| asked + after.1 - before.1);
        }
    }
    targets
}

/// Values at the vertices of a plane triangulation, `omega`, at other places `at` of the plane, each in the
/// triangle and with the barycentric coordinates given.
///
/// The mean of the linear interpolation and of one of linear functions through the vertices, with the mean
/// slopes round them: exact for quadratic functions as far as the slopes are.
fn refined(
    surface: &Surface,
    omega: &[DVec2],
    values: &[DVec2],
    places: &[(TriangleId, DVec3)],
    at: &[DVec2],
) -> Vec<DVec2> {
    let mut slopes = vec![(DMat2::ZERO, 0.0); omega.len()];
    for corners in surface.triangles() {
        let corners = corners.map(|v| v.index());
        let edges = |of: &[DVec2]| {
            let [a, b, c] = corners.map(|v| of[v]);
            DMat2::from_cols(b - a, c - a)
        };
        let plane = edges(omega);
        let area = plane.determinant();
        for v in corners {
            slopes[v].0 += area * (edges(values) * plane.inverse());
            slopes[v].1 += area;
        }
    }
    at.iter()
        .zip(places)
        .map(|(&at, (triangle, weights))| {
            let corners = surface.triangle(*triangle).map(|v| v.index());
            corners
                .into_iter()
                .zip(weights.to_array())
                .map(|(v, weight)| {
                    let (slope, area) = slopes[v];
                    weight * (values[v] + 0.5 / area * (slope * (at - omega[v])))
                })
                .sum()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::VertexId;

    #[test]
    fn a_quadratic_function_comes_back_where_its_slopes_are_known() {
        // A regular grid of triangles: the mean slope round an inner vertex is the slope there.
        let n = 9;
        let omega: Vec<DVec2> = (0..n * n)
            .map(|k| {
                DVec2::new((k % n) as f64 + 0.5 * (k / n) as f64, (k / n) as f64 * 0.75f64.sqrt())
            })
            .collect();
        let id = |i: usize, j: usize| VertexId::new(i * n + j);
        let mut triangles = Vec::new();
        for i in 0..n - 1 {
            for j in 0..n - 1 {
                triangles.push([id(i, j), id(i, j + 1), id(i + 1, j)]);
                triangles.push([id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)]);
            }
        }
        let surface =
            Surface::new(omega.iter().map(|p| p.extend(0.0)).collect(), triangles).unwrap();
        let of = |p: DVec2| {
            let bent = DVec2::new(p.x * p.x - 2.0 * p.x * p.y, 0.5 * p.y * p.y + p.x * p.y);
            3.0 * p + 0.01 * bent
        };
        let values: Vec<DVec2> = omega.iter().map(|&p| of(p)).collect();
        let weights = DVec3::new(0.2, 0.5, 0.3);
        let inner = (0..surface.triangle_count())
            .map(TriangleId::new)
            .filter(|&t| surface.triangle(t).iter().all(|&v| !surface.is_boundary_vertex(v)));
        let places: Vec<(TriangleId, DVec3)> = inner.map(|t| (t, weights)).collect();
        let at: Vec<DVec2> = places
            .iter()
            .map(|&(triangle, barycentric)| {
                SurfacePoint { triangle, barycentric }.interpolate(&surface, &omega)
            })
            .collect();
        assert!(at.len() > 50);
        for (got, at) in refined(&surface, &omega, &values, &places, &at).into_iter().zip(at) {
            assert!(got.distance(of(at)) < 1e-10, "{at}: {got} and not {}", of(at));
        }
    }
}
