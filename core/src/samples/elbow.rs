//! A bent arm from the middle of the upper arm to above the wrist: a left one, flexed 45°.
//!
//! Sections perpendicular to a smooth bent centre line, each an ellipse with muscles and bones
//! added as smooth bumps. Their amplitudes differ from side to side, so that nothing is
//! mirror-symmetric and no two paths round the limb are equally short.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::shape::{Bump, bent, relief};
use super::tube::Limb;
use super::wishes::{ANISOTROPIC, Configuration, ISOTROPIC, Specimen, Weave, Wish, wish};

/// The arm: the front is the biceps and the crease of the elbow.
#[derive(Debug, Clone, Copy)]
pub(super) struct Elbow;

/// Length of the centre line, in mm.
const LENGTH: f64 = 236.0;
/// Station of the middle of the bend, in mm.
const ELBOW: f64 = 112.0;
/// Flexion, then the carrying angle by which the forearm leans outward, in radians.
const TURN: DVec2 = DVec2::new(46.0 * PI / 180.0, 7.0 * PI / 180.0);
/// The bend is a tanh over this length, in mm: its tightest radius 2 · 26 / 0.80 = 65 mm stays
/// well above the 40 mm from the centre line to the front, so no two sections cross.
const BEND: f64 = 26.0;

impl Limb for Elbow {
    fn length(&self) -> f64 {
        LENGTH
    }

    fn origin(&self) -> f64 {
        ELBOW
    }

    fn turned(&self, station: f64) -> DVec2 {
        bent(station, ELBOW, BEND) * TURN
    }

    fn section(&self, station: f64, angle: f64) -> DVec3 {
        let (sin, cos) = angle.sin_cos();
        radius(station, angle) * DVec3::new(cos, sin, 0.0)
    }
}

const BUMPS: [Bump; 10] = [
    // Biceps.
    Bump { height: 6.5, station: 22.0, long: 38.0, angle: -0.10, wide: 0.75 },
    // Triceps, with its longer outer head.
    Bump { height: 5.0, station: 18.0, long: 42.0, angle: PI - 0.25, wide: 0.70 },
    // Olecranon: the point of the elbow.
    Bump { height: 9.0, station: ELBOW + 3.0, long: 13.0, angle: PI + 0.08, wide: 0.34 },
    // The edge of the ulna that runs on from it.
    Bump { height: 3.0, station: ELBOW + 42.0, long: 30.0, angle: PI + 0.05, wide: 0.40 },
    // Inner and outer epicondyle.
    Bump { height: 4.0, station: ELBOW - 6.0, long: 14.0, angle: -FRAC_PI_2 - 0.25, wide: 0.45 },
    Bump { height: 2.5, station: ELBOW - 3.0, long: 13.0, angle: FRAC_PI_2 + 0.30, wide: 0.45 },
    // The crease in front.
    Bump { height: -3.5, station: ELBOW, long: 11.0, angle: 0.05, wide: 0.60 },
    // Brachioradialis and the extensors: the outer bulge of the forearm.
    Bump { height: 5.0, station: ELBOW + 42.0, long: 30.0, angle: 1.05, wide: 0.65 },
    // The flexors: its inner bulge.
    Bump { height: 4.5, station: ELBOW + 50.0, long: 32.0, angle: -1.10, wide: 0.70 },
    // Hollow beside the triceps' tendon.
    Bump { height: -1.5, station: ELBOW - 22.0, long: 14.0, angle: PI + 0.75, wide: 0.35 },
];

/// Distance from the centre line to the skin, in mm.
fn radius(station: f64, angle: f64) -> f64 {
    let forearm = bent(station, ELBOW, BEND);
    // From the upper arm to the forearm a little thinner, a waist above the elbow, then the
    // taper to the wrist.
    let waist = 2.2 * (-0.5 * ((station - ELBOW + 8.0) / 24.0).powi(2)).exp();
    let taper = 4.1 * (1.0 + ((station - 206.0) / 24.0).tanh());
    let mean = 41.6 - 3.0 * forearm - waist - taper;
    // Semi-axes: the upper arm is deeper than wide, the elbow and the wrist wider than deep.
    let flat = -0.03 + 0.10 * forearm;
    let (front, side) = (mean * (1.0 - flat), mean * (1.0 + flat));
    let ellipse = ((angle.cos() / front).powi(2) + (angle.sin() / side).powi(2)).sqrt().recip();
    // A third harmonic takes the ellipse's mirror symmetry away along the whole limb.
    let skew = 0.012 * mean * (3.0 * angle + 0.7).cos();
    ellipse + skew + relief(&BUMPS, station, angle)
}

/// The elbow and its designs.
pub(super) const SPECIMEN: Specimen = Specimen {
    name: "elbow",
    limb: &Elbow,
    markers: FRAC_PI_2,
    seam: None,
    // Strain round the limb of 0.1 to 0.2.
    mmhg: &[
        wish(36.0, 1.3, 12.0),
        wish(80.0, FRAC_PI_2, 13.0),
        wish(158.0, 1.1, 15.0),
        wish(200.0, 1.3, 14.0),
    ],
    configurations: &CONFIGURATIONS,
};

/// The paper's first example in the isotropic fabric, its second in the anisotropic one with
/// other pressures. The paper names places and orders of size only; these give strains up to
/// 0.22, near the top of its colour bar (0.25).
const CONFIGURATIONS: [Configuration; 4] = [
    Configuration {
        name: "a",
        summary: "no pressures: the fabric is stretched as little as the shape allows",
        weaves: &[
            Weave { name: ISOTROPIC.0, stiffness: ISOTROPIC.1, kpa: &[] },
            Weave { name: ANISOTROPIC.0, stiffness: ANISOTROPIC.1, kpa: &[] },
        ],
    },
    Configuration {
        name: "b",
        summary: "high pressure in the middle, very small at both ends",
        weaves: &[
            Weave {
                name: ISOTROPIC.0,
                stiffness: ISOTROPIC.1,
                kpa: &[UPPER.of(0.10), MIDDLE.of(4.20), LOWER.of(0.10)],
            },
            Weave {
                name: ANISOTROPIC.0,
                stiffness: ANISOTROPIC.1,
                kpa: &[UPPER.of(0.10), MIDDLE.of(3.00), LOWER.of(0.10)],
            },
        ],
    },
    Configuration {
        name: "c",
        summary: "high pressure at the end near the body, very small at the other",
        weaves: &[
            Weave {
                name: ISOTROPIC.0,
                stiffness: ISOTROPIC.1,
                kpa: &[UPPER.of(2.90), LOWER.of(0.10)],
            },
            Weave {
                name: ANISOTROPIC.0,
                stiffness: ANISOTROPIC.1,
                kpa: &[UPPER.of(2.10), LOWER.of(0.10)],
            },
        ],
    },
    Configuration {
        name: "d",
        summary: "high pressure at both ends, nearly none in the middle",
        // Without a point in the middle the strain function would be constant between the ends.
        weaves: &[
            Weave {
                name: ISOTROPIC.0,
                stiffness: ISOTROPIC.1,
                kpa: &[UPPER.of(2.90), MIDDLE.of(0.05), LOWER.of(4.60)],
            },
            Weave {
                name: ANISOTROPIC.0,
                stiffness: ANISOTROPIC.1,
                kpa: &[UPPER.of(2.10), MIDDLE.of(0.05), LOWER.of(3.30)],
            },
        ],
    },
];

/// The places of the examples: on the outer side, where the arm is convex all along.
const UPPER: Wish = wish(40.0, 1.3, 0.0);
const MIDDLE: Wish = wish(ELBOW + 20.0, 1.3, 0.0);
const LOWER: Wish = wish(196.0, 1.3, 0.0);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn girths_are_those_of_a_grown_arm() {
        assert!((275.0..290.0).contains(&Elbow.girth(20.0)));
        assert!((250.0..265.0).contains(&Elbow.girth(ELBOW)));
        let forearm = Elbow.girth(160.0);
        assert!((255.0..270.0).contains(&forearm));
        assert!(forearm > Elbow.girth(200.0) + 15.0, "the forearm tapers");
        assert!((190.0..205.0).contains(&Elbow.girth(LENGTH)));
    }
}
