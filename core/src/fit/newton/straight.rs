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
    /// Over these triangles.
    fn over(triangles: &[Directions], step: f64) -> Self {
        let first = triangles.first().map(|t| t.middle).unwrap_or_default();
        let (low, high) = triangles
            .iter()
            .fold((first, first), |(low, high), t| (low.min(t.middle), high.max(t.middle)));
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
        let (i, j) = ((p.y as usize).min(self.rows - 2), (p.x as usize).min(self.columns - 2));
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

/// The threads of a triangle in the pattern.
#[derive(Debug, Clone, Copy)]
pub struct Directions {
    /// The triangle's middle in the pattern, in mm.
    pub middle: DVec2,
    /// Its area there, in mm².
    pub area: f64,
    /// Its warp and weft directions on the worn surface.
    pub threads: [DVec3; 2],
}

/// Area and directions gathered at a point.
type Sum = (f64, [DVec3; 2]);

/// The means of the threads' directions round every place.
pub struct Means {
    grid: Grid,
    at: Vec<[DVec3; 2]>,
}

impl Means {
    /// Over `step` mm of the pattern.
    pub fn new(triangles: &[Directions], step: f64) -> Self {
        /// Parts that are gathered side by side; a fixed number, so that sums do not depend on threads.
        const PARTS: usize = 8;
        /// Fewer points than this a task cost more than they save.
        const PER_TASK: usize = 512;
        let grid = Grid::over(triangles, step);
        let size = triangles.len().div_ceil(PARTS).max(1024);
        let parts: Vec<Vec<Sum>> = triangles
            .par_chunks(size)
            .map(|triangles| {
                let mut sums = vec![(0.0, [DVec3::ZERO; 2]); grid.columns * grid.rows];
                for Directions { middle, area, threads } in triangles {
                    for (at, w) in grid.corners(*middle) {
                        let (weight, sum) = &mut sums[at];
                        *weight += w * area;
                        sum[0] += w * area * threads[0];
                        sum[1] += w * area * threads[1];
                    }
                }
                sums
            })
            .collect();
        let at = (0..grid.columns * grid.rows)
            .into_par_iter()
            .with_min_len(PER_TASK)
            .map(|k| {
                let (weight, sum) = parts.iter().fold((0.0, [DVec3::ZERO; 2]), |whole, part| {
                    let (weight, sum) = &part[k];
                    (whole.0 + weight, [whole.1[0] + sum[0], whole.1[1] + sum[1]])
                });
                if weight > 0.0 { sum.map(|s| s / weight) } else { sum }
            })
            .collect();
        Self { grid, at }
    }

    /// Those round a place.
    pub fn round(&self, place: DVec2) -> [DVec3; 2] {
        self.grid.corners(place).iter().fold([DVec3::ZERO; 2], |mean, &(at, w)| {
            [mean[0] + w * self.at[at][0], mean[1] + w * self.at[at][1]]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Middles of a fine regular pattern, each of the area 1.
    fn middles() -> Vec<DVec2> {
        (0..60).flat_map(|i| (0..80).map(move |j| DVec2::new(f64::from(j), f64::from(i)))).collect()
    }

    /// Means at the middles of triangles with these threads, each of the area 1.
    fn means(
        middles: &[DVec2],
        threads: impl Fn(DVec2) -> [DVec3; 2],
        step: f64,
    ) -> Vec<[DVec3; 2]> {
        let triangles: Vec<Directions> = middles
            .iter()
            .map(|&middle| Directions { middle, area: 1.0, threads: threads(middle) })
            .collect();
        let means = Means::new(&triangles, step);
        middles.iter().map(|&middle| means.round(middle)).collect()
    }

    #[test]
    fn a_constant_stays_and_a_zigzag_goes() {
        let constant = DVec3::new(1.0, 2.0, 3.0);
        let zigzag = |p: DVec2| DVec3::Y * if p.x % 2.0 == 0.0 { 1.0 } else { -1.0 };
        let means = means(&middles(), |p| [constant, zigzag(p)], 5.0);
        assert!(means.iter().all(|mean| mean[0].distance(constant) < 1e-12));
        assert!(means[30 * 80 + 40][1].length() < 0.05, "{}", means[30 * 80 + 40][1]);
    }

    #[test]
    fn a_linear_field_stays_in_the_middle() {
        let linear = |p: DVec2| [p.extend(0.0) / 10.0, DVec3::ZERO];
        let middles = middles();
        let means = means(&middles, linear, 5.0);
        let at = 30 * 80 + 40;
        let there = linear(middles[at])[0];
        assert!(means[at][0].distance(there) < 0.02, "{:?} {there:?}", means[at]);
    }
}
