//! A flip-free start, for surfaces on which the intrinsic parameterization fails.
//!
//! First a convex combination map onto a circle (Tutte 1963; Floater 1997): with positive
//! symmetric weights and a strictly convex boundary no triangle is turned over. The weights are
//! cotangents held positive; mean value weights (Floater 2003) would be positive by themselves
//! but not symmetric. A hole is filled with one vertex tied to its rim. Then the boundary is let
//! go and the symmetric Dirichlet energy σ₁² + σ₂² + σ₁⁻² + σ₂⁻² lowered by Newton steps whose
//! Hessian is made positive triangle by triangle (Smith, de Goes & Kim, *Analytic Eigensystems
//! for Isotropic Distortion Energies*, 2019). A step stays short of the first triangle to
//! collapse (Smith & Schaefer, *Bijective Parameterization with Free Boundaries*, 2015, section
//! 3.3) and is shortened further while the outline crosses itself, so the map stays one to one.
//!
//! Limit: a start, not an optimum. It ends when the energy stops falling quickly; a surface whose
//! flattening must overlap stays squeezed.

use glam::{DMat2, DVec2};

use super::intrinsic::at_true_scale;
use super::quality::{flipped_triangles, outline_crossings, planar};
use super::rest::{RestTriangle, rest_triangles};
use crate::sparse::{Pattern, SparseError};
use crate::surface::{BoundaryLoop, HalfEdgeId, Surface};

/// Cotangent weights (sum of two) outside this range are brought into it: the range of angles
/// from about 3° to 87° on both sides.
const WEIGHTS: (f64, f64) = (0.1, 40.0);

/// No boundary edge takes less of the circle than this share of the mean edge's, so that the
/// corners stay convex in floating point.
const LEAST_ARC: f64 = 1e-2;

/// Newton steps at most; limbs need about ten.
const STEPS: usize = 30;

/// Improvement ends when a step lowers the energy by less than this share.
const ENOUGH: f64 = 1e-3;

/// Share of the way to the first collapse that a step may go.
const SHORT_OF_COLLAPSE: f64 = 0.8;

/// A step halved this often is no step.
const HALVINGS: usize = 20;

/// Added to the Hessian's diagonal, relative to its mean: it holds the three rigid motions that
/// cost nothing and is far below any stiffness of the map.
const HOLD: f64 = 1e-7;

/// A map without flipped triangles and without crossings of the outline, at the surface's own
/// area in total; flipped triangles remain only where rounding defeats the convex map.
///
/// # Errors
/// If memory runs out, or the convex map is singular to rounding.
pub(super) fn flip_free(surface: &Surface) -> Result<Vec<DVec2>, SparseError> {
    let round = at_true_scale(surface, convex_map(surface)?);
    let healthy = flipped_triangles(surface, &round).next().is_none();
    if !healthy {
        return Ok(round);
    }
    Ok(at_true_scale(surface, improved(surface, round)?))
}

/// The outer loop of a disk with holes: the longest.
fn outer_loop(surface: &Surface) -> usize {
    let lengths: Vec<f64> =
        surface.boundary_loops().iter().map(|l| surface.loop_length(l)).collect();
    (0..lengths.len()).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b])).unwrap_or(0)
}

fn on_circle(surface: &Surface, boundary: &BoundaryLoop, place: &mut [Option<DVec2>]) {
    let mean = surface.loop_length(boundary) / boundary.half_edges.len() as f64;
    let arc = |h: HalfEdgeId| surface.length(h).max(LEAST_ARC * mean);
    let whole: f64 = boundary.half_edges.iter().map(|&h| arc(h)).sum();
    let mut along = 0.0;
    for &h in &boundary.half_edges {
        let angle = std::f64::consts::TAU * along / whole;
        place[surface.from(h).index()] = Some(DVec2::from_angle(angle));
        along += arc(h);
    }
}

/// The convex combination map onto the unit circle.
fn convex_map(surface: &Surface) -> Result<Vec<DVec2>, SparseError> {
    let n = surface.vertex_count();
    let outer = outer_loop(surface);
    let mut held = vec![None; n];
    on_circle(surface, &surface.boundary_loops()[outer], &mut held);
    held.resize(n + surface.boundary_loops().len() - 1, None);

    let mut links: Vec<(usize, usize, f64)> = Vec::with_capacity(surface.edge_count());
    let rest = rest_triangles(surface);
    let cot = |h: HalfEdgeId| rest[h.triangle().index()].cotangents[(h.corner() + 2) % 3];
    for h in surface.half_edges() {
        let twin = surface.twin(h);
        if twin.is_some_and(|t| t < h) {
            continue;
        }
        let weight = (cot(h) + twin.map_or(0.0, cot)).clamp(WEIGHTS.0, WEIGHTS.1);
        links.push((surface.from(h).index(), surface.to(h).index(), weight));
    }
    let holes = surface.boundary_loops().iter().enumerate().filter(|(i, _)| *i != outer);
    for (k, (_, hole)) in holes.enumerate() {
        links.extend(surface.loop_vertices(hole).map(|v| (v.index(), n + k, 1.0)));
    }

    let mut column = vec![usize::MAX; held.len()];
    let free: Vec<usize> = (0..held.len()).filter(|&i| held[i].is_none()).collect();
    for (c, &i) in free.iter().enumerate() {
        column[i] = c;
    }
    let (mut entries, mut values) = (Vec::new(), Vec::new());
    let mut right = vec![vec![0.0; free.len()]; 2];
    for (i, j, weight) in links {
        for (a, b) in [(i, j), (j, i)] {
            if held[a].is_some() {
                continue;
            }
            entries.push((column[a], column[a]));
            values.push(weight);
            if let Some(place) = held[b] {
                right[0][column[a]] += weight * place.x;
                right[1][column[a]] += weight * place.y;
            } else if column[a] > column[b] {
                entries.push((column[a], column[b]));
                values.push(-weight);
            }
        }
    }
    let x = if free.is_empty() {
        right
    } else {
        Pattern::new(free.len(), &entries)?.factorize(&values)?.solve(&right)
    };
    Ok((0..n)
        .map(|i| held[i].unwrap_or_else(|| DVec2::new(x[0][column[i]], x[1][column[i]])))
        .collect())
}

/// The map after the boundary was let go.
fn improved(surface: &Surface, mut map: Vec<DVec2>) -> Result<Vec<DVec2>, SparseError> {
    let problem = Problem::new(surface)?;
    let mut energy = problem.energy(&map);
    for _ in 0..STEPS {
        let Some(step) = problem.newton_step(&map)? else { break };
        let slope = step.slope;
        let mut length = problem.longest_step(&map, &step.motion).min(1.0);
        let mut accepted = None;
        for _ in 0..HALVINGS {
            let tried: Vec<DVec2> =
                map.iter().zip(&step.motion).map(|(p, d)| *p + length * *d).collect();
            let value = problem.energy(&tried);
            // Armijo's rule with its usual share.
            if value <= energy + 1e-4 * length * slope
                && flipped_triangles(surface, &tried).next().is_none()
                && outline_crossings(surface, &tried) == 0
            {
                accepted = Some((tried, value));
                break;
            }
            length *= 0.5;
        }
        let Some((next, value)) = accepted else { break };
        let gain = energy - value;
        (map, energy) = (next, value);
        if gain < ENOUGH * energy {
            break;
        }
    }
    Ok(map)
}

struct Problem<'a> {
    surface: &'a Surface,
    rest: Vec<RestTriangle>,
    pattern: Pattern,
}

struct Step {
    motion: Vec<DVec2>,
    /// Derivative of the energy along the motion; negative.
    slope: f64,
}

impl<'a> Problem<'a> {
    fn new(surface: &'a Surface) -> Result<Self, SparseError> {
        let mut entries = Vec::with_capacity(21 * surface.triangle_count());
        for t in surface.triangles() {
            for (i, j) in lower_pairs() {
                let row = 2 * t[i / 2].index() + i % 2;
                let col = 2 * t[j / 2].index() + j % 2;
                entries.push((row.max(col), row.min(col)));
            }
        }
        let unknowns = 2 * surface.vertex_count();
        entries.extend((0..unknowns).map(|i| (i, i)));
        let pattern = Pattern::new(unknowns, &entries)?;
        Ok(Self { surface, rest: rest_triangles(surface), pattern })
    }

    fn gradients(&self, map: &[DVec2]) -> impl Iterator<Item = (&RestTriangle, DMat2)> {
        self.surface.triangle_ids().zip(&self.rest).map(|(t, rest)| {
            let (p, g) = (planar(self.surface, map, t), rest.gradients());
            let column = |axis: usize| (0..3).map(|k| p[k] * g[k][axis]).sum::<DVec2>();
            (rest, DMat2::from_cols(column(0), column(1)))
        })
    }

    /// The symmetric Dirichlet energy in mm²; infinite where a triangle is not positive.
    fn energy(&self, map: &[DVec2]) -> f64 {
        self.gradients(map)
            .map(|(rest, f)| {
                let det = f.determinant();
                if det <= 0.0 {
                    return f64::INFINITY;
                }
                let squares = f.x_axis.length_squared() + f.y_axis.length_squared();
                rest.area * squares * (1.0 + 1.0 / (det * det))
            })
            .sum()
    }

    /// The Newton step with the Hessian made positive; `None` at the minimum.
    fn newton_step(&self, map: &[DVec2]) -> Result<Option<Step>, SparseError> {
        let unknowns = 2 * map.len();
        let mut downhill = vec![0.0; unknowns];
        let mut values = Vec::with_capacity(21 * self.rest.len() + unknowns);
        let mut trace = 0.0;
        for ((rest, f), corners) in self.gradients(map).zip(self.surface.triangles()) {
            let g = rest.gradients();
            let modes = modes(f);
            // The corners' parts of each mode.
            let parts: [[f64; 6]; 4] = modes.map(|mode| {
                let at = g.map(|g| mode.direction * g);
                [at[0].x, at[0].y, at[1].x, at[1].y, at[2].x, at[2].y]
            });
            for i in 0..6 {
                let slope: f64 = (0..4).map(|m| modes[m].slope * parts[m][i]).sum();
                downhill[2 * corners[i / 2].index() + i % 2] -= rest.area * slope;
            }
            for (i, j) in lower_pairs() {
                let sum: f64 = (0..4).map(|m| modes[m].bend * parts[m][i] * parts[m][j]).sum();
                values.push(rest.area * sum);
                trace += if i == j { rest.area * sum } else { 0.0 };
            }
        }
        values.extend(std::iter::repeat_n(HOLD * trace / unknowns as f64, unknowns));
        let motion = self.pattern.factorize(&values)?.solve(std::slice::from_ref(&downhill));
        let slope = -motion[0].iter().zip(&downhill).map(|(m, d)| m * d).sum::<f64>();
        let motion: Vec<DVec2> =
            motion[0].chunks_exact(2).map(|c| DVec2::new(c[0], c[1])).collect();
        Ok((slope < 0.0).then_some(Step { motion, slope }))
    }

    /// The longest step along `motion` that collapses no triangle, less a margin: the least
    /// positive root of each triangle's area, a quadratic in the step.
    fn longest_step(&self, map: &[DVec2], motion: &[DVec2]) -> f64 {
        let mut longest = f64::INFINITY;
        for t in self.surface.triangle_ids() {
            let [a, b, c] = planar(self.surface, map, t);
            let [da, db, dc] = planar(self.surface, motion, t);
            let (e, f, de, df) = (b - a, c - a, db - da, dc - da);
            let area = e.perp_dot(f);
            let linear = e.perp_dot(df) + de.perp_dot(f);
            let square = de.perp_dot(df);
            longest = longest.min(first_root(square, linear, area));
        }
        SHORT_OF_COLLAPSE * longest
    }
}

/// The least positive root of a t² + b t + c with c > 0; infinite if there is none.
pub(crate) fn first_root(a: f64, b: f64, c: f64) -> f64 {
    let under = b * b - 4.0 * a * c;
    if under < 0.0 {
        return f64::INFINITY;
    }
    // The stable pair of formulas; q has b's sign.
    let q = -0.5 * (b + under.sqrt().copysign(b));
    [q / a, c / q].into_iter().filter(|&t| t > 0.0).fold(f64::INFINITY, f64::min)
}

/// The lower triangle of a symmetric 6 × 6 matrix, row by row.
fn lower_pairs() -> impl Iterator<Item = (usize, usize)> {
    (0..6).flat_map(|i| (0..=i).map(move |j| (i, j)))
}

#[derive(Clone, Copy)]
struct Mode {
    direction: DMat2,
    /// Derivative of the energy density along it.
    slope: f64,
    /// Second derivative along it, at least zero.
    bend: f64,
}

/// The eigensystem of the symmetric Dirichlet energy density at F: stretch along both singular
/// directions, twist and flip (Smith, de Goes & Kim 2019, section 4).
fn modes(f: DMat2) -> [Mode; 4] {
    // F = U diag(σ) Vᵀ with two rotations: half sum and half difference of their angles.
    let sum = DVec2::new(f.x_axis.x + f.y_axis.y, f.x_axis.y - f.y_axis.x);
    let difference = DVec2::new(f.x_axis.x - f.y_axis.y, f.x_axis.y + f.y_axis.x);
    let (turn, mirror) = (sum.to_angle(), difference.to_angle());
    let u = DMat2::from_angle(0.5 * (mirror + turn));
    let vt = DMat2::from_angle(0.5 * (turn - mirror));
    let large = 0.5 * (sum.length() + difference.length());
    let small = f.determinant() / large;
    let matrix = |a: f64, b: f64, c: f64, d: f64| {
        u * DMat2::from_cols(DVec2::new(a, c), DVec2::new(b, d)) * vt
    };
    let slope = |s: f64| 2.0 * (s - 1.0 / (s * s * s));
    let bend = |s: f64| 2.0 + 6.0 / (s * s * s * s);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let twist = (slope(large) + slope(small)) / (large + small);
    let cube = (large * small).powi(3);
    let flip = 2.0 + 2.0 * (large * large + large * small + small * small) / cube;
    [
        Mode { direction: matrix(1.0, 0.0, 0.0, 0.0), slope: slope(large), bend: bend(large) },
        Mode { direction: matrix(0.0, 0.0, 0.0, 1.0), slope: slope(small), bend: bend(small) },
        Mode { direction: matrix(0.0, -half, half, 0.0), slope: 0.0, bend: twist.max(0.0) },
        Mode { direction: matrix(0.0, half, half, 0.0), slope: 0.0, bend: flip },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eigensystem_is_that_of_the_energy() {
        let density = |f: DMat2| {
            let squares = f.x_axis.length_squared() + f.y_axis.length_squared();
            squares * (1.0 + 1.0 / f.determinant().powi(2))
        };
        let f = DMat2::from_cols(DVec2::new(1.3, 0.2), DVec2::new(-0.5, 0.9));
        for mode in modes(f) {
            let along = |t: f64| density(f + t * mode.direction);
            let step = 1e-4;
            let first = (along(step) - along(-step)) / (2.0 * step);
            let second = (along(step) - 2.0 * along(0.0) + along(-step)) / (step * step);
            assert!((first - mode.slope).abs() < 1e-5, "{first} {}", mode.slope);
            assert!((second - mode.bend).abs() < 1e-4, "{second} {}", mode.bend);
        }
    }

    #[test]
    fn the_first_root_is_the_first_collapse() {
        assert!((first_root(1.0, -3.0, 2.0) - 1.0).abs() < 1e-15);
        assert!((first_root(0.0, -2.0, 1.0) - 0.5).abs() < 1e-15);
        assert!((first_root(-1.0, 0.0, 4.0) - 2.0).abs() < 1e-15);
        assert!(first_root(1.0, 1.0, 1.0).is_infinite());
        assert!(first_root(0.0, 0.0, 1.0).is_infinite());
        assert!(first_root(1.0, 3.0, 2.0).is_infinite());
    }
}
