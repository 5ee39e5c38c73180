//! Shapes whose pattern is known by hand. The fit must reach them within 1 %, judged from the
//! written pattern and the fixture's own geometry, never from the program's curvature.

mod cone;
mod cylinder;
mod field;
mod plane;

use support::check::WornObj;

/// Root mean square over the pattern's area of what `of` says of each triangle's stretch.
fn rms(worn: &WornObj, of: impl Fn(&support::check::Stretch) -> f64) -> f64 {
    let stretches = worn.stretches();
    let area: f64 = stretches.iter().map(|s| s.area).sum();
    (stretches.iter().map(|s| s.area * of(s).powi(2)).sum::<f64>() / area).sqrt()
}

/// Demands a pattern without flips and overlaps that is nowhere stretched.
#[track_caller]
fn assert_without_strain(worn: &WornObj) {
    assert_eq!((worn.flipped(), worn.overlaps(), worn.wound_twice()), (0, 0, 0));
    let [warp, weft, shear] = [
        rms(worn, |s| s.warp - 1.0),
        rms(worn, |s| s.weft - 1.0),
        // The cosine of the threads' angle is the shear strain.
        rms(worn, |s| s.shear),
    ];
    assert!(warp < 0.01 && weft < 0.01 && shear < 0.02, "RMS strain {warp} {weft} {shear}");
}
