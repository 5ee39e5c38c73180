//! Threads shorter than wanted are kept from buckling in the surface.
//!
//! J_E pushes apart the ends of a thread that is shorter than its wanted length, with
//! N = k |F e| (λ − |F e|) for each unit of width. Sideways that is a negative stiffness, held only by
//! the weak diagonals, and where N is larger the energy falls by a zigzag as fine as the mesh allows:
//! a drift that depends on the triangulation alone and is no better pattern, for the worn thread is
//! under tension and straight. So the thread's direction is measured against its mean over the
//! neighbourhood of one thread spacing, as the woven grid cannot see a crimp shorter than its cell,
//! and a turning spring of stiffness N holds it there. It costs nothing where threads have their
//! wanted length or run straight; on smooth shapes, where the mean is the direction itself, it is of
//! the second order in spacing over radius. The diffusion's bending stiffness
//! ([`diffusion::gradient`](crate::fit::diffusion::gradient)) does the same for woven nodes.
//!
//! The mean is a hat function's over a regular grid of the pattern: the triangles' directions are
//! gathered at the grid's points, weighted by area, and read off again.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// A vector field on the triangles, smoothed over the pattern.
pub struct Smoothing {
    origin: DVec2,
    step: f64,
    columns: usize,
    rows: usize,
    weight: Vec<f64>,
}

/// The grid points round a place and their weights.
struct Corners([(usize, f64); 4]);

impl Smoothing {
    /// For triangles with these middles (mm) and areas in the pattern (mm²), over `step` mm.
    pub fn new(middles: &[DVec2], areas: &[f64], step: f64) -> Self {
        let first = middles.first().copied().unwrap_or_default();
        let (low, high) =
            middles.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
        /// No more grid points than this along either side, for patterns without measure.
        const MOST: f64 = 4000.0;
        let step = step.max((high - low).max_element() / MOST);
        let count = |extent: f64| (extent / step).ceil() as usize + 2;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        let mut smoothing =
            Self { origin: low, step, columns, rows, weight: vec![0.0; columns * rows] };
        for (&middle, &area) in middles.iter().zip(areas) {
            for (at, w) in smoothing.corners(middle).0 {
                smoothing.weight[at] += w * area;
            }
        }
        smoothing
    }

    fn corners(&self, place: DVec2) -> Corners {
        let p = (place - self.origin) / self.step;
        let (i, j) = (p.y.max(0.0).floor(), p.x.max(0.0).floor());
        let (i, j) = ((i as usize).min(self.rows - 2), (j as usize).min(self.columns - 2));
        let (v, u) = (p.y - i as f64, p.x - j as f64);
        let at = i * self.columns + j;
        Corners([
            (at, (1.0 - u) * (1.0 - v)),
            (at + 1, u * (1.0 - v)),
            (at + self.columns, (1.0 - u) * v),
            (at + self.columns + 1, u * v),
        ])
    }

    /// The mean of a field round every triangle.
    pub fn mean(&self, middles: &[DVec2], areas: &[f64], field: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.weight.len()];
        for ((&middle, &area), &value) in middles.iter().zip(areas).zip(field) {
            for (at, w) in self.corners(middle).0 {
                sums[at] += w * area * value;
            }
        }
        for (sum, &weight) in sums.iter_mut().zip(&self.weight) {
            if weight > 0.0 {
                *sum /= weight;
            }
        }
        middles
            .par_iter()
            .with_min_len(4096)
            .map(|&middle| self.corners(middle).0.iter().map(|&(at, w)| w * sums[at]).sum())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Middles of a fine regular pattern, each of the area 1.
    fn middles() -> Vec<DVec2> {
        (0..60).flat_map(|i| (0..80).map(move |j| DVec2::new(f64::from(j), f64::from(i)))).collect()
    }

    #[test]
    fn a_constant_stays_and_a_zigzag_goes() {
        let middles = middles();
        let areas = vec![1.0; middles.len()];
        let smoothing = Smoothing::new(&middles, &areas, 5.0);
        let constant = vec![DVec3::new(1.0, 2.0, 3.0); middles.len()];
        for mean in smoothing.mean(&middles, &areas, &constant) {
            assert!(mean.distance(constant[0]) < 1e-12);
        }
        let zigzag: Vec<DVec3> =
            middles.iter().map(|p| DVec3::Y * if p.x % 2.0 == 0.0 { 1.0 } else { -1.0 }).collect();
        let means = smoothing.mean(&middles, &areas, &zigzag);
        assert!(means[30 * 80 + 40].length() < 0.05, "{}", means[30 * 80 + 40]);
    }

    #[test]
    fn a_linear_field_stays_in_the_middle() {
        let middles = middles();
        let areas = vec![1.0; middles.len()];
        let smoothing = Smoothing::new(&middles, &areas, 5.0);
        let linear: Vec<DVec3> = middles.iter().map(|p| p.extend(0.0) / 10.0).collect();
        let means = smoothing.mean(&middles, &areas, &linear);
        let at = 30 * 80 + 40;
        assert!(means[at].distance(linear[at]) < 0.02, "{} {}", means[at], linear[at]);
    }
}
