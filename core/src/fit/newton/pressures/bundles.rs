//! Threads of a painted field whose targets are corrected as one.
//!
//! A painted field has threads every few millimetres, and the function of strain smooths what lies closer than the
//! row spacing: answers of neighbours are alike. So where threads are many, neighbours change together, by as much
//! as one another; what Eq. (3) wants of each stays its own. Each by itself, without the others' answers, they
//! were corrected too little or too much.
//!
//! Limit: a correction that varies within a bundle is not found.

use std::ops::Range;

/// No more bundles than this are made: each is a solve with the factorized Hessian.
const MOST: usize = 24;

/// What a bundle's width grows by where there would be too many.
const GROWTH: f64 = 1.1;

/// The bundles of threads at these heights along weft (from the lowest, in mm), no wider than has to be.
pub fn bundled(heights: &[f64]) -> Vec<Range<usize>> {
    let whole = heights.first().zip(heights.last()).map_or(0.0, |(low, high)| high - low);
    let mut width = 0.0;
    loop {
        let bundles = no_wider(heights, width);
        if bundles.len() <= MOST || width >= whole {
            return bundles;
        }
        width = f64::max(GROWTH * width, 1e-3 * whole);
    }
}

fn no_wider(heights: &[f64], width: f64) -> Vec<Range<usize>> {
    let mut bundles: Vec<Range<usize>> = Vec::new();
    for (i, &y) in heights.iter().enumerate() {
        match bundles.last_mut() {
            Some(bundle) if y - heights[bundle.start] <= width => bundle.end = i + 1,
            _ => bundles.push(i..i + 1),
        }
    }
    bundles
}

#[cfg(test)]
mod tests {
    use super::*;

    fn every(mm: f64, count: usize) -> Vec<f64> {
        (0..count).map(|k| mm * k as f64).collect()
    }

    #[test]
    fn up_to_as_many_as_are_solved_for_each_thread_is_by_itself() {
        for count in [0, 1, MOST] {
            let bundles = bundled(&every(3.0, count));
            assert!(bundles.into_iter().eq((0..count).map(|i| i..i + 1)));
        }
    }

    #[test]
    fn more_are_bundled_with_their_neighbours_and_not_across_a_gap() {
        let mut heights = every(3.0, 25);
        heights.extend(every(3.0, 25).iter().map(|y| y + 200.0));
        let bundles = bundled(&heights);
        assert!((MOST / 2..=MOST).contains(&bundles.len()), "{bundles:?}");
        assert!(bundles.iter().any(|bundle| bundle.end == 25), "{bundles:?}");
        assert!(bundles.into_iter().flatten().eq(0..50));
    }
}
