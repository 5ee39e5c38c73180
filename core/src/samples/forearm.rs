//! A forearm from below the elbow to the wrist: a left one, palm to the front.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::shape::{Bump, Sections, bent, relief};
use super::tube::Limb;
use super::wishes::{Specimen, wish};

/// The forearm: the front is the palm's side, the outer side the thumb's.
#[derive(Debug, Clone, Copy)]
pub(super) struct Forearm;

/// Length of the centre line, in mm.
const LENGTH: f64 = 225.0;
/// The radius is bowed: the arm turns by this toward the back and the outer side, in radians,
/// round the middle.
const TURN: DVec2 = DVec2::new(-5.0 * PI / 180.0, 6.0 * PI / 180.0);
/// The bow is a tanh over this length, in mm: hardly more than a long curve.
const BEND: f64 = 50.0;

const SECTIONS: Sections = Sections {
    step: 25.0,
    rows: &[
        // Front, outer side, back, inner side.
        [39.0, 41.5, 38.5, 40.0],
        [39.5, 43.0, 38.5, 41.0],
        [38.5, 42.5, 37.5, 40.5],
        [36.0, 40.5, 35.5, 38.5],
        [33.0, 37.5, 33.0, 36.0],
        [29.5, 34.5, 30.0, 33.0],
        [26.5, 32.0, 27.5, 30.5],
        [24.0, 30.0, 25.0, 29.0],
        [22.0, 29.5, 22.5, 28.5],
        [21.0, 30.5, 21.5, 29.0],
    ],
};

const BUMPS: [Bump; 7] = [
    // Brachioradialis and the extensors beside it.
    Bump { height: 4.0, station: 42.0, long: 30.0, angle: 0.75, wide: 0.50 },
    // The flexors.
    Bump { height: 4.0, station: 58.0, long: 32.0, angle: -0.90, wide: 0.50 },
    // The groove between them.
    Bump { height: -2.0, station: 30.0, long: 32.0, angle: -0.02, wide: 0.28 },
    // The edge of the ulna, and its head above the wrist.
    Bump { height: 2.0, station: 90.0, long: 55.0, angle: PI + 0.75, wide: 0.26 },
    Bump { height: 4.5, station: 206.0, long: 9.0, angle: PI + 0.85, wide: 0.30 },
    // The end of the radius.
    Bump { height: 2.0, station: 214.0, long: 12.0, angle: FRAC_PI_2 + 0.2, wide: 0.45 },
    // The flexors' tendons in front of the wrist.
    Bump { height: 1.8, station: 198.0, long: 26.0, angle: -0.06, wide: 0.20 },
];

impl Limb for Forearm {
    fn length(&self) -> f64 {
        LENGTH
    }

    fn origin(&self) -> f64 {
        0.5 * LENGTH
    }

    fn turned(&self, station: f64) -> DVec2 {
        bent(station, 0.5 * LENGTH, BEND) * TURN
    }

    fn section(&self, station: f64, angle: f64) -> DVec3 {
        SECTIONS.at(station, angle, relief(&BUMPS, station, angle)).extend(0.0)
    }
}

/// The forearm and its designs.
pub(super) const SPECIMEN: Specimen = Specimen {
    name: "forearm",
    limb: &Forearm,
    markers: FRAC_PI_2,
    seam: None,
    // Strain round the limb of 0.1 to 0.2.
    mmhg: &[
        wish(40.0, 1.3, 12.0),
        wish(85.0, 1.3, 13.0),
        wish(130.0, 1.3, 15.0),
        wish(180.0, 1.4, 18.0),
    ],
    configurations: &[],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn girths_are_those_of_a_grown_arm() {
        assert!((250.0..270.0).contains(&Forearm.girth(30.0)));
        assert!((160.0..172.0).contains(&Forearm.girth(LENGTH)));
        let girths: Vec<f64> = (2..=9).map(|k| Forearm.girth(25.0 * f64::from(k))).collect();
        assert!(girths.is_sorted_by(|a, b| a > b), "it tapers: {girths:?}");
    }
}
