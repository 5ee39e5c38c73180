//! Over which places the means round a computed place go: of the limb alone, so read once.

use rayon::prelude::*;

use super::places::Places;
use super::sampling::Sampling;
use crate::progress::{Progress, in_parts};

/// The places round every computed one, and their weights.
pub(super) struct Surroundings {
    /// How far they go, in mm.
    pub(super) radius: f64,
    /// Where each computed place's begin in `weights`; one more at the end.
    starts: Vec<usize>,
    /// Places with weights of half the precision: there may be a thousand round each.
    weights: Vec<(u32, f32)>,
}

impl Surroundings {
    /// Those within `radius` mm, with weights that fall to zero there. None if the job is cancelled.
    pub(super) fn new(
        places: &Places,
        sampling: &Sampling,
        radius: f64,
        progress: &dyn Progress,
    ) -> Option<Self> {
        let round = in_parts(&sampling.seeds, progress, |_, seeds| {
            seeds
                .par_iter()
                .with_min_len(64)
                .map_init(
                    || places.visits(),
                    |visits, &seed| -> Vec<(u32, f32)> {
                        let found = places.within(visits, seed, radius).into_iter();
                        let weight = |distance: f64| 1.0 - (distance / radius).powi(2);
                        // Places are numbered by 32 bits.
                        found.map(|(place, far)| (place as u32, weight(far) as f32)).collect()
                    },
                )
                .collect()
        })?;
        let mut starts = Vec::with_capacity(round.len() + 1);
        starts.push(0);
        starts.extend(round.iter().scan(0, |end, weights| {
            *end += weights.len();
            Some(*end)
        }));
        Some(Self { radius, starts, weights: round.concat() })
    }

    /// Those of every computed place: places and their weights.
    pub(super) fn all(
        &self,
    ) -> impl IndexedParallelIterator<Item = impl Iterator<Item = (usize, f64)> + '_> + '_ {
        self.starts.par_windows(2).map(|ends| {
            let weights = self.weights[ends[0]..ends[1]].iter();
            weights.map(|&(place, weight)| (place as usize, f64::from(weight)))
        })
    }
}
