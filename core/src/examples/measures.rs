//! What is read from an example's outcome: its threads and the course of its fit.

use glam::DVec2;

use crate::pipeline::Flattening;
use crate::report::FitReport;
use crate::surface::Surface;

/// A warp thread of a pattern: all of the fabric at one height.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Thread {
    /// Its place along the brace: 0 at the pattern's lower edge, 1 at its upper, near the body.
    pub t: f64,
    /// Its length at rest, in mm.
    pub rest_mm: f64,
    /// Its length over its rest length when worn, less one.
    pub strain: f64,
}

/// The warp threads of a pattern.
#[derive(Debug, Clone, Copy)]
pub struct Threads<'a> {
    disk: &'a Surface,
    coordinates: &'a [DVec2],
    top: f64,
}

/// Threads nearer to the pattern's upper or lower edge than this share of its height are cut by
/// the slanting ends.
const MARGIN: f64 = 0.06;

/// Threads in a profile.
const PROFILE: usize = 45;

impl<'a> Threads<'a> {
    /// Of a finished pattern.
    #[must_use]
    pub fn of(flattening: &'a Flattening) -> Self {
        let (disk, coordinates) = (flattening.disk(), &flattening.coordinates);
        let top = coordinates.iter().map(|p| p.y).fold(0.0, f64::max);
        Self { disk, coordinates, top }
    }

    /// The thread at a height of the pattern in mm; `None` where there is no fabric.
    #[must_use]
    pub fn at(&self, y: f64) -> Option<Thread> {
        let (mut rest, mut worn) = (0.0, 0.0);
        for t in self.disk.triangle_ids() {
            let plane = self.disk.triangle(t).map(|v| self.coordinates[v.index()]);
            let corners = self.disk.corners(t);
            let mut ends = Vec::with_capacity(2);
            for k in 0..3 {
                let (a, b) = (plane[k], plane[(k + 1) % 3]);
                // Half-open: a line through a vertex crosses a triangle twice or not at all.
                if (a.y < y) != (b.y < y) {
                    let f = (y - a.y) / (b.y - a.y);
                    ends.push((a.x + f * (b.x - a.x), corners[k].lerp(corners[(k + 1) % 3], f)));
                }
            }
            if let [(x0, p0), (x1, p1)] = ends[..] {
                rest += (x1 - x0).abs();
                worn += p0.distance(p1);
            }
        }
        (rest > 0.0).then(|| Thread { t: y / self.top, rest_mm: rest, strain: worn / rest - 1.0 })
    }

    /// Threads at equal distances, from the lowest.
    #[must_use]
    pub fn profile(&self) -> Vec<Thread> {
        let part = |k: usize| MARGIN + (1.0 - 2.0 * MARGIN) * k as f64 / (PROFILE - 1) as f64;
        (0..PROFILE).filter_map(|k| self.at(part(k) * self.top)).collect()
    }

    /// Mean strain of the threads in a range of t.
    #[must_use]
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        let strains: Vec<f64> =
            self.profile().iter().filter(|p| p.t >= from && p.t <= to).map(|p| p.strain).collect();
        strains.iter().sum::<f64>() / strains.len().max(1) as f64
    }
}

/// The course of a fit on its finest level.
pub mod course {
    use super::FitReport;
    use crate::report::HistoryEntry;

    /// The entries of the finest level; all, where there is one level.
    pub fn finest(fit: &FitReport) -> impl Iterator<Item = &HistoryEntry> + Clone {
        fit.history.iter().filter(|entry| entry.spacing_mm == fit.spacing_mm)
    }

    /// Root mean square strain difference of a warp or weft spring: √(E_SSD / springs).
    #[must_use]
    pub fn rms(entry: &HistoryEntry) -> f64 {
        (entry.e_ssd / entry.springs.max(1) as f64).sqrt()
    }

    /// First and last E_SSD.
    #[must_use]
    pub fn ends(fit: &FitReport) -> [f64; 2] {
        let mut values = finest(fit).map(|entry| entry.e_ssd);
        let first = values.next().unwrap_or_default();
        [first, values.last().unwrap_or(first)]
    }

    /// The most that E_SSD was above its least value so far, as a share of its whole fall.
    #[must_use]
    pub fn largest_rise(fit: &FitReport) -> f64 {
        let [first, last] = ends(fit);
        let (mut least, mut most) = (f64::INFINITY, 0.0);
        for entry in finest(fit) {
            least = entry.e_ssd.min(least);
            most = (entry.e_ssd - least).max(most);
        }
        most / (first - last).abs().max(f64::MIN_POSITIVE)
    }

    /// How often E_SSD rises from one entry to the next by more than this share of its whole fall.
    #[must_use]
    pub fn jumps(fit: &FitReport, share: f64) -> usize {
        let [first, last] = ends(fit);
        let pairs = finest(fit).zip(finest(fit).skip(1));
        pairs.filter(|(a, b)| b.e_ssd - a.e_ssd > share * (first - last)).count()
    }

    /// Steps until E_SSD has made this share of its whole fall.
    #[must_use]
    pub fn steps_to(fit: &FitReport, share: f64) -> u64 {
        let [first, last] = ends(fit);
        let begin = finest(fit).next().map_or(0, |entry| entry.iteration);
        let there = finest(fit).find(|entry| entry.e_ssd <= first - share * (first - last));
        there.map_or(0, |entry| entry.iteration - begin)
    }
}
