//! The worn triangles as the fit needs them, and the energy's sums over them.

mod lay;
mod relax;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub use self::relax::Forces;
use super::element::{
    Gradients, NEGATIVE, Order, Springs, Stretches, bend, energy, force_at_corners, slope,
    stiffening_energy, turn,
};
use super::straight::{Directions, Means};
use crate::fit::Misfit;
use crate::parameterize::{RestTriangle, first_root};
use crate::pressure::{StrainCourse, Targets};
use crate::sparse::Element;
use crate::surface::Surface;

/// Fewer triangles than this a task cost more than they save.
const PER_TASK: usize = 1024;

/// A worn triangle.
#[derive(Debug, Clone, Copy)]
struct Worn {
    corners: [u32; 3],
    hats: [DVec2; 3],
    area: f64,
    /// The frame in which the hats' gradients are given.
    frame: [DVec3; 2],
}

/// All of them.
pub struct Triangles {
    worn: Vec<Worn>,
    /// Corners of the given triangles that have made way for these.
    given: Vec<[u32; 3]>,
    /// The corners at each vertex: those of v are `corners[starts[v]..starts[v + 1]]`, in order, each as three
    /// times its triangle plus its place there.
    starts: Vec<u32>,
    corners: Vec<u32>,
}

/// The wanted stretches along the pattern, as the fit counts weft coordinates.
pub struct Wanted {
    course: StrainCourse,
    low: f64,
    length: f64,
    weft: f64,
}

impl Wanted {
    /// Those of these targets.
    pub fn new(targets: &Targets, weft_strain: f64) -> Self {
        let [low, high] = targets.extent;
        Self {
            course: targets.function.course(),
            low,
            length: (high - low).max(f64::MIN_POSITIVE),
            weft: 1.0 + weft_strain,
        }
    }

    /// At a weft coordinate.
    fn at(&self, y: f64) -> Stretches {
        let [strain, slope] = self.course.at((y - self.low) / self.length);
        Stretches { warp: [1.0 + strain, slope / self.length], weft: self.weft }
    }
}

/// Springs that turn a triangle's threads into the directions of their neighbourhood; per worn area.
#[derive(Debug, Clone, Copy, Default)]
pub struct Turning {
    /// Direction of the warp thread, in the triangle's frame.
    warp: DVec2,
    weft: DVec2,
    /// Stiffness against ∇y along `warp`, and against ∇x along `weft`, in N·mm.
    stiffness: [f64; 2],
}

impl Turning {
    fn energy(&self, g: &Gradients) -> f64 {
        let [warp, weft] = self.stiffness;
        0.5 * (warp * g.y.dot(self.warp).powi(2) + weft * g.x.dot(self.weft).powi(2))
    }
}

/// The turning springs outweigh the buckling force so many times.
const OUTWEIGHS: f64 = 2.0;

/// Share of the turning springs in the Hessian: between a course that the neighbourhood follows (none
/// of them is felt) and a zigzag, which feels all of them.
const FELT: f64 = 0.6;

impl Triangles {
    /// Those of a surface, of these shapes.
    pub fn new(surface: &Surface, rest: &[RestTriangle]) -> Self {
        let ids: Vec<_> = surface.triangle_ids().collect();
        let worn: Vec<Worn> = ids
            .par_iter()
            .with_min_len(PER_TASK)
            .zip(rest)
            .map(|(&t, rest)| {
                let [a, b, c] = surface.corners(t);
                let along = (b - a).normalize_or_zero();
                let across = (c - a).reject_from(along).normalize_or_zero();
                Worn {
                    // A surface has fewer than 2^28 vertices: the matrix has refused more.
                    corners: surface.triangle(t).map(|v| v.index() as u32),
                    hats: rest.gradients(),
                    area: rest.area,
                    frame: [along, across],
                }
            })
            .collect();
        let vertices = surface.vertex_count();
        let mut starts = vec![0u32; vertices + 1];
        worn.iter().flat_map(|worn| worn.corners).for_each(|v| starts[v as usize + 1] += 1);
        for v in 0..vertices {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut corners = vec![0; 3 * worn.len()];
        for (corner, v) in worn.iter().flat_map(|worn| worn.corners).enumerate() {
            let at = &mut next[v as usize];
            corners[*at as usize] = corner as u32;
            *at += 1;
        }
        Self { worn, given: Vec::new(), starts, corners }
    }

    /// The vertices of a triangle.
    pub fn corners_of(&self, t: usize) -> [usize; 3] {
        self.worn[t].corners.map(|v| v as usize)
    }

    /// The corners at a vertex.
    fn corners_at(&self, v: usize) -> &[u32] {
        &self.corners[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    fn gradients(worn: &Worn, coordinates: &[DVec2]) -> (Gradients, f64) {
        let p = worn.corners.map(|v| coordinates[v as usize]);
        (Gradients::new(&worn.hats, p), (p[0].y + p[1].y + p[2].y) / 3.0)
    }

    /// Sums over all triangles in order, the same on any number of threads.
    fn sums<const N: usize>(&self, of: impl Fn(usize, &Worn) -> [f64; N] + Sync) -> [f64; N] {
        let parts: Vec<[f64; N]> = self
            .worn
            .par_chunks(PER_TASK)
            .enumerate()
            .map(|(chunk, part)| {
                part.iter().enumerate().fold([0.0; N], |mut sums, (k, worn)| {
                    let values = of(chunk * PER_TASK + k, worn);
                    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                    sums
                })
            })
            .collect();
        parts.iter().fold([0.0; N], |mut sums, part| {
            sums.iter_mut().zip(part).for_each(|(sum, value)| *sum += value);
            sums
        })
    }

    /// The energy at these pattern coordinates with the turning springs (none if empty), in N·mm.
    pub fn energy(
        &self,
        coordinates: &[DVec2],
        springs: &Springs,
        wanted: &Wanted,
        turning: &[Turning],
    ) -> f64 {
        let [energy] = self.sums(|k, worn| {
            let (g, y) = Self::gradients(worn, coordinates);
            let turned = turning.get(k).map_or(0.0, |turning| turning.energy(&g));
            [worn.area * (stiffening_energy(&g, springs, &wanted.at(y)) + turned)]
        });
        energy
    }

    /// J_E, and E_SSD as a woven grid of this spacing would count it.
    pub fn misfit(
        &self,
        coordinates: &[DVec2],
        springs: &Springs,
        wanted: &Wanted,
        spacing: f64,
    ) -> Misfit {
        let cell = spacing * spacing;
        let [energy, e_ssd, cells] = self.sums(|_, worn| {
            let (g, y) = Self::gradients(worn, coordinates);
            let wanted = wanted.at(y);
            let [warp, weft] = g.stretches();
            let off = (warp - wanted.warp[0]).powi(2) + (weft - wanted.weft).powi(2);
            let rest = worn.area * g.determinant() / cell;
            [worn.area * energy(&g, springs, &wanted), rest * off, rest]
        });
        Misfit { energy, e_ssd, springs: (2.0 * cells).round().max(0.0) as usize }
    }

    /// The turning springs at these pattern coordinates: stiff where threads are shorter than wanted.
    pub fn turning(
        &self,
        coordinates: &[DVec2],
        springs: &Springs,
        wanted: &Wanted,
        spacing: f64,
    ) -> Vec<Turning> {
        let (here, push): (Vec<Directions>, Vec<[f64; 2]>) = self
            .worn
            .par_iter()
            .with_min_len(PER_TASK)
            .map(|worn| {
                let (g, y) = Self::gradients(worn, coordinates);
                let d = g.determinant();
                let wanted = wanted.at(y);
                let (nx, ny) = (g.x.length(), g.y.length());
                let push = |k: f64, stretch: f64, wanted: f64, n: f64| {
                    OUTWEIGHS * d * k * stretch * (wanted - stretch).max(0.0) / (n * n)
                };
                let [u, v] = worn.frame;
                let p = worn.corners.map(|v| coordinates[v as usize]);
                let here = Directions {
                    middle: (p[0] + p[1] + p[2]) / 3.0,
                    area: d * worn.area,
                    threads: [(g.y.y * u - g.y.x * v) / ny, (g.x.x * v - g.x.y * u) / nx],
                };
                let push = [
                    push(springs.warp, ny / d, wanted.warp[0], ny),
                    push(springs.weft, nx / d, wanted.weft, nx),
                ];
                (here, push)
            })
            .unzip();
        let means = Means::new(&here, spacing);
        self.worn
            .par_iter()
            .with_min_len(PER_TASK)
            .zip(&here)
            .zip(&push)
            .map(|((worn, here), &stiffness)| {
                let in_frame = |mean: DVec3| {
                    let [u, v] = worn.frame;
                    DVec2::new(u.dot(mean), v.dot(mean)).normalize_or_zero()
                };
                let [warp, weft] = means.round(here.middle).map(in_frame);
                Turning { warp, weft, stiffness }
            })
            .collect()
    }

    /// Every triangle's part of the Hessian, into `elements`.
    pub fn elements(
        &self,
        coordinates: &[DVec2],
        springs: &Springs,
        wanted: &Wanted,
        turning: &[Turning],
        order: Order,
        elements: &mut Vec<Element>,
    ) {
        self.worn
            .par_iter()
            .with_min_len(PER_TASK)
            .zip(turning)
            .map(|(worn, turning)| {
                let (g, y) = Self::gradients(worn, coordinates);
                let mut bend = bend(&g, springs, &wanted.at(y), order);
                let [warp, weft] = turning.stiffness;
                bend.turn(true, turning.warp, FELT * warp);
                bend.turn(false, turning.weft, FELT * weft);
                match order {
                    Order::First | Order::Full => {}
                    Order::Second => bend.leave_negative(NEGATIVE),
                    Order::Convex => bend.leave_negative(0.0),
                }
                bend.at_corners(&worn.hats, worn.area)
            })
            .collect_into_vec(elements);
    }

    /// The gradient of the energy with the turning springs (none if empty) by every coordinate
    /// (x₀, y₀, x₁, …), in N.
    pub fn gradient(
        &self,
        coordinates: &[DVec2],
        springs: &Springs,
        wanted: &Wanted,
        turning: &[Turning],
    ) -> Vec<f64> {
        let forces: Vec<[f64; 6]> = self
            .worn
            .par_iter()
            .enumerate()
            .with_min_len(PER_TASK)
            .map(|(k, worn)| {
                let (g, y) = Self::gradients(worn, coordinates);
                let mut slope = slope(&g, springs, &wanted.at(y));
                if let Some(turning) = turning.get(k) {
                    turn(&mut slope, &g, true, turning.warp, turning.stiffness[0]);
                    turn(&mut slope, &g, false, turning.weft, turning.stiffness[1]);
                }
                force_at_corners(&slope, &worn.hats, worn.area)
            })
            .collect();
        // At every vertex the corners in order, whatever the threads.
        let mut sums = vec![0.0; 2 * coordinates.len()];
        sums.par_chunks_mut(2).zip(self.starts.par_windows(2)).with_min_len(PER_TASK).for_each(
            |(sum, range)| {
                for &corner in &self.corners[range[0] as usize..range[1] as usize] {
                    let force = &forces[corner as usize / 3];
                    let k = 2 * (corner as usize % 3);
                    sum[0] += force[k];
                    sum[1] += force[k + 1];
                }
            },
        );
        sums
    }

    /// A third of the pattern's area round each vertex, in mm².
    pub fn shares(&self, coordinates: &[DVec2]) -> Vec<f64> {
        let mut shares = vec![0.0; coordinates.len()];
        for worn in &self.worn {
            let area = worn.area * Self::gradients(worn, coordinates).0.determinant();
            for v in worn.corners {
                shares[v as usize] += area / 3.0;
            }
        }
        shares
    }

    /// Shares of the vertices in the worn area.
    pub fn worn_shares(&self, vertices: usize) -> Vec<f64> {
        let whole: f64 = self.worn.iter().map(|worn| worn.area).sum();
        let mut shares = vec![0.0; vertices];
        for worn in &self.worn {
            for v in worn.corners {
                shares[v as usize] += worn.area / (3.0 * whole);
            }
        }
        shares
    }

    /// The triangles of which a thread is stretched to more than so many times what is wanted.
    pub fn overstretched(&self, coordinates: &[DVec2], wanted: &Wanted, times: f64) -> Vec<usize> {
        let is_so = |worn: &Worn| {
            let (g, y) = Self::gradients(worn, coordinates);
            let [warp, weft] = g.stretches();
            let wanted = wanted.at(y);
            warp > times * wanted.warp[0] || weft > times * wanted.weft
        };
        (0..self.worn.len()).filter(|&t| is_so(&self.worn[t])).collect()
    }

    /// The longest step along `motion`, up to 1, that leaves every triangle a fair share of its area.
    pub fn longest_step(&self, coordinates: &[DVec2], motion: &[DVec2]) -> f64 {
        /// Share of the way to the first collapse that a step may go.
        const SHORT_OF_COLLAPSE: f64 = 0.8;
        let collapse = self.worn.par_iter().with_min_len(PER_TASK).map(|worn| {
            let [a, b, c] = worn.corners.map(|v| coordinates[v as usize]);
            let [da, db, dc] = worn.corners.map(|v| motion[v as usize]);
            let (e, f, de, df) = (b - a, c - a, db - da, dc - da);
            let linear = e.perp_dot(df) + de.perp_dot(f);
            first_root(de.perp_dot(df), linear, e.perp_dot(f))
        });
        // The least of numbers is the same in any order.
        (SHORT_OF_COLLAPSE * collapse.reduce(|| f64::INFINITY, f64::min)).min(1.0)
    }
}
