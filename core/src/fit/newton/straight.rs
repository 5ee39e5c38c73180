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

/// A regular grid over the pattern.
struct Grid {
    origin: DVec2,
    step: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Over triangles with these middles.
    fn over(middles: &[DVec2], step: f64) -> Self {
        let first = middles.first().copied().unwrap_or_default();
        let (low, high) =
            middles.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
        /// No more grid points than this along either side, for patterns without measure.
        const MOST: f64 = 1000.0;
        let step = step.max((high - low).max_element() / MOST);
        let count = |extent: f64| (extent / step).ceil() as usize + 2;
        let (columns, rows) = (count(high.x - low.x), count(high.y - low.y));
        Self { origin: low, step, columns, rows }
    }

    /// The four points round a place and their weights.
    fn corners(&self, place: DVec2) -> [(usize, f64); 4] {
        let p = (place - self.origin) / self.step;
        let (i, j) = (p.y.max(0.0).floor(), p.x.max(0.0).floor());
        let (i, j) = ((i as usize).min(self.rows - 2), (j as usize).min(self.columns - 2));
        let (v, u) = (p.y - i as f64, p.x - j as f64);
        let at = i * self.columns + j;
        [
            (at, (1.0 - u) * (1.0 - v)),
            (at + 1, u * (1.0 - v)),
            (at + self.columns, (1.0 - u) * v),
            (at + self.columns + 1, u * v),
        ]
    }
}

/// The means of two vector fields round every triangle, over `step` mm of the pattern; the triangles
/// have these middles (mm) and areas (mm²) there.
pub fn means(
    middles: &[DVec2],
    areas: &[f64],
    fields: &[[DVec3; 2]],
    step: f64,
) -> Vec<[DVec3; 2]> {
    /// Parts that are gathered side by side; a fixed number, so that sums do not depend on threads.
    const PARTS: usize = 8;
    let grid = Grid::over(middles, step);
    let size = (middles.len() / PARTS).max(1024);
    type Sums = Vec<(f64, [DVec3; 2])>;
    let parts: Vec<Sums> = middles
        .par_chunks(size)
        .zip(areas.par_chunks(size).zip(fields.par_chunks(size)))
        .map(|(middles, (areas, fields))| {
            let mut sums = vec![(0.0, [DVec3::ZERO; 2]); grid.columns * grid.rows];
            for ((&middle, &area), field) in middles.iter().zip(areas).zip(fields) {
                for (at, w) in grid.corners(middle) {
                    let (weight, sum) = &mut sums[at];
                    *weight += w * area;
                    sum[0] += w * area * field[0];
                    sum[1] += w * area * field[1];
                }
            }
            sums
        })
        .collect();
    let mut parts = parts.into_iter();
    let mut sums = parts.next().unwrap_or_default();
    for part in parts {
        for ((weight, sum), (more, other)) in sums.iter_mut().zip(part) {
            *weight += more;
            sum[0] += other[0];
            sum[1] += other[1];
        }
    }
    for (weight, sum) in &mut sums {
        if *weight > 0.0 {
            *sum = sum.map(|s| s / *weight);
        }
    }
    middles
        .par_iter()
        .with_min_len(4096)
        .map(|&middle| {
            grid.corners(middle).iter().fold([DVec3::ZERO; 2], |mean, &(at, w)| {
                [mean[0] + w * sums[at].1[0], mean[1] + w * sums[at].1[1]]
            })
        })
        .collect()
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
        let constant = DVec3::new(1.0, 2.0, 3.0);
        let fields: Vec<[DVec3; 2]> = middles
            .iter()
            .map(|p| [constant, DVec3::Y * if p.x % 2.0 == 0.0 { 1.0 } else { -1.0 }])
            .collect();
        let means = means(&middles, &areas, &fields, 5.0);
        assert!(means.iter().all(|mean| mean[0].distance(constant) < 1e-12));
        assert!(means[30 * 80 + 40][1].length() < 0.05, "{}", means[30 * 80 + 40][1]);
    }

    #[test]
    fn a_linear_field_stays_in_the_middle() {
        let middles = middles();
        let areas = vec![1.0; middles.len()];
        let linear: Vec<[DVec3; 2]> =
            middles.iter().map(|p| [p.extend(0.0) / 10.0, DVec3::ZERO]).collect();
        let means = means(&middles, &areas, &linear, 5.0);
        let at = 30 * 80 + 40;
        assert!(means[at][0].distance(linear[at][0]) < 0.02, "{:?} {:?}", means[at], linear[at]);
    }
}
