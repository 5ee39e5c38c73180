//! Curvature at a stated scale: a patch fitted to the vertices within a radius.
//!
//! In a frame whose third axis is the patch's own normal, heights are fitted by weighted least
//! squares with z = a + b x + c y + ½ xᵀ A x + ½ g (z − a)². Without the last term this is the
//! usual quadric, which reads a cylinder of radius 28 mm 2.5 % too curved over 10 mm, because a
//! circle leaves its parabola. With g the normal curvature of the patch along the steepest
//! ascent A x, known from the round before, it is exact for cylinders, spheres and planes (of a
//! circle of curvature κ, z = ½ κ (x² + z²) to all orders) and third-order elsewhere.
//!
//! A vertex weighs its share of the area, so the triangulation does not matter, times 1 − (d/R)²,
//! which vanishes at the radius and lets a quarter less noise through than smoother functions of
//! the same reach. Vertices are reached through edges inside the radius and
//! must face the way the point does: the other side of a thin limb or finger is not fitted.
//!
//! Limits: features smaller than the radius are smoothed away; that is its purpose. At a free edge
//! the patch is one-sided: its curvature across the edge is four times as sensitive to noise, that
//! along the edge 1.3 times. A cut through a limb is such an edge: ask before cutting. Gaussian
//! noise of 0.3 mm on edges of 2 mm gives a standard deviation of 30, 4.1 and 1.2 1/m over 5, 10
//! and 15 mm.

use glam::DVec3;
use rayon::prelude::*;

use super::super::location::SurfacePoint;
use super::clusters::{clusters, joined};
use super::operator::ShapeOperator;
use super::patch::fit_patch;
use crate::surface::{Surface, VertexId};

/// A patch of fewer points than this does not determine its six coefficients well.
const FEWEST_POINTS: usize = 10;

/// On a mesh whose mean edge is shorter than this share of the radius (300 vertices in a patch),
/// near vertices are fitted as one.
const DENSE_SHARE: f64 = 1.0 / 9.0;

/// Near are vertices within this share of the radius of each other: the cost of a patch does not
/// grow with the mesh and none of its noise is left out. The middle of such a piece, of radius ρ,
/// lies ¼ κ ρ² under the surface, 0.01 mm at worst and everywhere much alike.
const SAMPLE_SHARE: f64 = 1.0 / 12.0;

/// How much the radius grows when too few vertices lie within it.
const GROWTH: f64 = 1.25;

/// The radius grows no further than this many times; beyond, the surface is smaller than a patch.
const MOST_GROWTHS: usize = 24;

/// Patches that one thread fits at least: a search begins with clearing what it remembers.
const AT_ONCE: usize = 64;

/// Cosine of the angle to the point's normal beyond which a vertex is not fitted at all: a height
/// function needs less than 90°, and at 73° a point weighs little in the tangent plane.
const LEAST_COSINE: f64 = 0.3;

/// The cosine from which a vertex weighs fully.
const FULL_COSINE: f64 = 0.6;

/// Curvature over a radius in mm.
#[derive(Debug)]
pub struct ScaleCurvature<'a> {
    surface: &'a Surface,
    radius: f64,
    /// Outward unit normals by vertex.
    normals: Vec<DVec3>,
    /// The sample that stands for each vertex.
    sample_of: Vec<u32>,
    samples: Vec<Sample>,
    /// Where each sample's neighbours begin in `neighbours`; one more at the end.
    starts: Vec<u32>,
    /// The samples joined to each by an edge of the surface, in order.
    neighbours: Vec<u32>,
}

/// What the search for a patch's vertices remembers, to be used again for the next patch.
#[derive(Debug)]
struct Visits {
    /// The search in which each sample was last met.
    seen: Vec<u32>,
    round: u32,
    queue: Vec<u32>,
    /// The samples found, in radii from the point, with their weights.
    found: Vec<(DVec3, f64)>,
}

/// Vertices near to each other that are fitted as one: their middle, area and normal.
#[derive(Debug, Clone, Copy)]
struct Sample {
    place: DVec3,
    area: f64,
    normal: DVec3,
}

/// A fitted patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaleFit {
    /// The shape operator of the patch at the point.
    pub shape: ShapeOperator,
    /// The radius over which it was fitted, in mm: the one asked for, or more where the mesh is
    /// too coarse for it.
    pub radius_used: f64,
    /// How many points were fitted: vertices, or several as one where they are dense.
    pub points: usize,
    /// Root mean square distance of the vertices from the patch along its normal, in mm.
    pub residual_mm: f64,
    /// How far the patch lies above the point, along its normal, in mm.
    pub offset_mm: f64,
}

impl<'a> ScaleCurvature<'a> {
    /// Prepares the estimate over `radius_mm` (positive) on a surface.
    #[must_use]
    pub fn new(surface: &'a Surface, radius_mm: f64) -> Self {
        let mut areas = vec![0.0; surface.vertex_count()];
        for t in surface.triangle_ids() {
            let third = surface.area(t) / 3.0;
            for v in surface.triangle(t) {
                areas[v.index()] += third;
            }
        }
        let normals = surface.vertex_normals();
        let dense = surface.mean_edge_length() < DENSE_SHARE * radius_mm;
        let reach = if dense { SAMPLE_SHARE * radius_mm } else { 0.0 };
        let (sample_of, seeds) = clusters(surface, reach * reach);
        let zero = Sample { place: DVec3::ZERO, area: 0.0, normal: DVec3::ZERO };
        let mut samples = vec![zero; seeds.len()];
        for v in surface.vertex_ids() {
            let (i, sample) = (v.index(), &mut samples[sample_of[v.index()] as usize]);
            sample.area += areas[i];
            sample.place += areas[i] * surface.point(v);
            sample.normal += areas[i] * normals[i];
        }
        for (sample, &seed) in samples.iter_mut().zip(&seeds) {
            let whole = sample.area > 0.0;
            sample.place = if whole { sample.place / sample.area } else { surface.point(seed) };
            sample.normal = sample.normal.normalize_or_zero();
        }
        let (starts, neighbours) = joined(surface, &sample_of, samples.len());
        Self { surface, radius: radius_mm, normals, sample_of, samples, starts, neighbours }
    }

    /// The radius asked for, in mm.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The shape operator at a point of the surface.
    #[must_use]
    pub fn at(&self, point: &SurfacePoint) -> ShapeOperator {
        self.fit(point).shape
    }

    /// The shape operator at a vertex.
    #[must_use]
    pub fn at_vertex(&self, v: VertexId) -> ShapeOperator {
        self.fit_vertex(v).shape
    }

    /// The shape operators at all vertices, by vertex.
    #[must_use]
    pub fn at_vertices(&self) -> Vec<ShapeOperator> {
        self.fit_vertices(1).into_iter().map(|fit| fit.shape).collect()
    }

    /// The patch round a point of the surface.
    #[must_use]
    pub fn fit(&self, point: &SurfacePoint) -> ScaleFit {
        self.fit_point(&mut self.visits(), point)
    }

    /// The patches round points of the surface.
    #[must_use]
    pub fn fit_all(&self, points: &[SurfacePoint]) -> Vec<ScaleFit> {
        points
            .par_iter()
            .with_min_len(AT_ONCE)
            .map_init(|| self.visits(), |visits, point| self.fit_point(visits, point))
            .collect()
    }

    /// The patch round a vertex.
    #[must_use]
    pub fn fit_vertex(&self, v: VertexId) -> ScaleFit {
        self.fit_at_vertex(&mut self.visits(), v)
    }

    /// The patches round the vertices 0, `step`, 2 · `step`, …
    #[must_use]
    pub fn fit_vertices(&self, step: usize) -> Vec<ScaleFit> {
        (0..self.surface.vertex_count().div_ceil(step))
            .into_par_iter()
            .with_min_len(AT_ONCE)
            .map_init(
                || self.visits(),
                |visits, i| self.fit_at_vertex(visits, VertexId::new(i * step)),
            )
            .collect()
    }

    fn visits(&self) -> Visits {
        let (queue, found) = (Vec::with_capacity(256), Vec::with_capacity(256));
        Visits { seen: vec![0; self.samples.len()], round: 0, queue, found }
    }

    fn fit_point(&self, visits: &mut Visits, point: &SurfacePoint) -> ScaleFit {
        let corners = self.surface.triangle(point.triangle);
        let w = point.barycentric.to_array();
        let normal = (0..3).map(|k| w[k] * self.normals[corners[k].index()]).sum::<DVec3>();
        let normal = normal.try_normalize().unwrap_or_else(|| self.surface.normal(point.triangle));
        self.fit_from(visits, point.position(self.surface), normal, &corners)
    }

    fn fit_at_vertex(&self, visits: &mut Visits, v: VertexId) -> ScaleFit {
        self.fit_from(visits, self.surface.point(v), self.normals[v.index()], &[v])
    }

    fn fit_from(
        &self,
        visits: &mut Visits,
        place: DVec3,
        normal: DVec3,
        seeds: &[VertexId],
    ) -> ScaleFit {
        let normal = normal.try_normalize().unwrap_or(DVec3::Z);
        let mut radius = self.radius;
        for _ in 0..MOST_GROWTHS {
            self.gather(visits, place, normal, seeds, radius);
            let near = &visits.found;
            if near.len() >= FEWEST_POINTS
                && let Some(fit) = fit_patch(normal, near, radius, true)
                    .or_else(|| fit_patch(normal, near, radius, false))
            {
                return fit;
            }
            if near.len() == self.samples.len() {
                break;
            }
            radius *= GROWTH;
        }
        // The whole surface is too small to say how it curves: flat, over no radius.
        let flat = ShapeOperator::from_tensor(normal, glam::DMat3::ZERO);
        ScaleFit { shape: flat, radius_used: 0.0, points: 0, residual_mm: 0.0, offset_mm: 0.0 }
    }

    fn neighbours(&self, sample: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|k| self.starts[sample as usize + k] as usize);
        &self.neighbours[start..end]
    }

    /// Finds the vertices connected to the seeds within a radius, with their weights.
    fn gather(
        &self,
        visits: &mut Visits,
        place: DVec3,
        normal: DVec3,
        seeds: &[VertexId],
        radius: f64,
    ) {
        let Visits { seen, round, queue, found } = visits;
        *round += 1;
        queue.clear();
        found.clear();
        queue.extend(seeds.iter().map(|v| self.sample_of[v.index()]));
        queue.sort_unstable();
        queue.dedup();
        let seeds = queue.len();
        for &seed in queue.iter() {
            seen[seed as usize] = *round;
        }
        let mut next = 0;
        while next < queue.len() {
            let at = queue[next];
            let sample = &self.samples[at as usize];
            next += 1;
            let p = sample.place - place;
            let share = p.length_squared() / (radius * radius);
            let cosine = sample.normal.dot(normal);
            let facing = ((cosine - LEAST_COSINE) / (FULL_COSINE - LEAST_COSINE)).clamp(0.0, 1.0);
            if share < 1.0 && facing > 0.0 {
                let smooth = facing * facing * (3.0 - 2.0 * facing);
                found.push((p / radius, sample.area * smooth * (1.0 - share)));
            } else if next > seeds {
                continue;
            }
            for &n in self.neighbours(at) {
                if seen[n as usize] != *round {
                    seen[n as usize] = *round;
                    queue.push(n);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::shapes::{cylinder, noisy, sphere_cap, torus_quarter};
    use super::*;

    fn axial(s: &Surface, r: f64, lo: f64, hi: f64) -> (f64, f64) {
        let c = ScaleCurvature::new(s, r);
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        for v in s.vertex_ids() {
            let p = s.point(v);
            if p.z < lo || p.z > hi {
                continue;
            }
            let k = c.at_vertex(v).normal_curvature(DVec3::Z.cross(p));
            low = low.min(k);
            high = high.max(k);
        }
        (low, high)
    }

    #[test]
    fn cylinders_are_read_without_bias() {
        for radius in [20.0, 28.0, 45.0, 60.0] {
            let s = cylinder(radius, 60.0, 2.5);
            for over in [5.0, 10.0, 15.0, 20.0] {
                let (low, high) = axial(&s, over, 0.0, 60.0);
                let worst = (low * radius - 1.0).abs().max((high * radius - 1.0).abs());
                assert!(worst < 1e-3, "r {radius} R {over}: {worst}");
            }
        }
    }

    #[test]
    fn a_mesh_far_finer_than_the_radius_is_read_without_bias_from_few_samples() {
        let s = cylinder(20.0, 30.0, 0.5);
        let c = ScaleCurvature::new(&s, 10.0);
        for v in s.vertex_ids().step_by(41) {
            let fit = c.fit_vertex(v);
            let k = fit.shape.normal_curvature(DVec3::Z.cross(s.point(v)));
            assert!((k * 20.0 - 1.0).abs() < 2e-3, "{k} {fit:?}");
            assert!(fit.points < 400, "{fit:?}");
        }
    }

    #[test]
    fn a_sphere_has_one_over_its_radius_every_way_and_points_inside_triangles_too() {
        let s = sphere_cap(50.0, 1.2, 2.5);
        let c = ScaleCurvature::new(&s, 10.0);
        for t in s.triangle_ids().step_by(7) {
            let point = SurfacePoint { triangle: t, barycentric: DVec3::new(0.2, 0.3, 0.5) };
            let shape = c.at(&point);
            for (k, _) in shape.principal() {
                assert!((k * 50.0 - 1.0).abs() < 1e-3, "{t} {k}");
            }
            assert!((shape.gaussian() * 2500.0 - 1.0).abs() < 2e-3);
            assert!(shape.normal.dot(point.position(&s).normalize()) > 1.0 - 1e-6);
        }
    }

    #[test]
    fn a_saddle_is_negative_one_way() {
        // The inner side of a torus, tube 30 mm round a ring of 90 mm: 1/30 and −1/60.
        let s = torus_quarter(90.0, 30.0, 2.0);
        let inner = s
            .vertex_ids()
            .min_by(|&a, &b| {
                let far = |v| {
                    let p: DVec3 = s.point(v);
                    p.distance(DVec3::new(60.0, 60.0, 0.0) / f64::sqrt(2.0))
                };
                far(a).total_cmp(&far(b))
            })
            .unwrap();
        let [(large, _), (small, _)] = ScaleCurvature::new(&s, 8.0).at_vertex(inner).principal();
        assert!((large * 30.0 - 1.0).abs() < 0.02, "{large}");
        assert!((small * -60.0 - 1.0).abs() < 0.03, "{small}");
    }

    #[test]
    fn the_other_side_of_a_thin_limb_is_not_fitted() {
        let (low, high) = axial(&cylinder(6.0, 60.0, 1.0), 20.0, 20.0, 40.0);
        assert!((low * 6.0 - 1.0).abs() < 0.02 && (high * 6.0 - 1.0).abs() < 0.02, "{low} {high}");
    }

    #[test]
    fn a_coarse_mesh_takes_a_larger_radius_and_says_so() {
        let s = cylinder(45.0, 120.0, 12.0);
        let c = ScaleCurvature::new(&s, 5.0);
        for v in s.vertex_ids() {
            let fit = c.fit_vertex(v);
            assert!(fit.radius_used > 12.0 && fit.points >= FEWEST_POINTS, "{fit:?}");
            let k = fit.shape.normal_curvature(DVec3::Z.cross(s.point(v)));
            assert!((k * 45.0 - 1.0).abs() < 5e-3, "{k} {fit:?}");
        }
    }

    #[test]
    fn a_coarse_and_rough_mesh_never_curves_without_bound() {
        for edge in [6.0, 7.5, 9.0, 11.0, 14.0] {
            for seed in 0..8 {
                let s = noisy(&cylinder(40.0, 120.0, edge), 0.08 * edge, seed);
                let c = ScaleCurvature::new(&s, 10.0);
                for v in s.vertex_ids() {
                    let fit = c.fit_vertex(v);
                    for (k, _) in fit.shape.principal() {
                        // 0.1 of an edge over a patch of two edges: 2 · 0.1 e / (2 e)².
                        assert!(k.abs() < 1.5 / edge, "edge {edge} seed {seed}: {k} {fit:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn noise_of_a_scan_is_averaged_over_the_radius() {
        let s = noisy(&cylinder(45.0, 120.0, 2.0), 0.3, 7);
        // Along the girth and along the limb, in 1/m.
        let deviation = |over: f64, lo: f64, hi: f64| {
            let c = ScaleCurvature::new(&s, over);
            let inside: Vec<VertexId> =
                s.vertex_ids().filter(|&v| (lo..hi).contains(&s.point(v).z)).collect();
            let mut squares = [0.0; 2];
            for &v in &inside {
                let shape = c.at_vertex(v);
                let round = shape.normal_curvature(DVec3::Z.cross(s.point(v)));
                squares[0] += (round - 1.0 / 45.0).powi(2);
                squares[1] += shape.normal_curvature(DVec3::Z).powi(2);
            }
            squares.map(|sum| 1000.0 * (sum / inside.len() as f64).sqrt())
        };
        for (over, most) in [(5.0, 33.0), (10.0, 4.5), (15.0, 1.4)] {
            let inside = deviation(over, 20.0, 100.0);
            let edge = deviation(over, -1.0, 1.0);
            println!("R {over}: {inside:?} 1/m inside, {edge:?} 1/m at the edge");
            assert!(inside[0] < most, "R {over}: {inside:?} 1/m");
            assert!(edge[0] < 1.6 * most && edge[1] < 8.0 * most, "R {over}: {edge:?} 1/m");
        }
    }

    #[test]
    fn a_surface_of_one_triangle_is_flat_and_says_it_was_not_measured() {
        let ids = [0, 1, 2].map(VertexId::new);
        let s = Surface::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![ids]).unwrap();
        let fit = ScaleCurvature::new(&s, 10.0).fit_vertex(ids[0]);
        assert_eq!((fit.points, fit.shape.mean()), (0, 0.0));
        assert_eq!(fit.shape.normal, DVec3::Z);
    }
}
