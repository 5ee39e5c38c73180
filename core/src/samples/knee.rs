//! A knee from the lower thigh to below the thickest place of the calf: a left one, flexed 24°.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::shape::{Bump, Sections, bent, relief};
use super::tube::Limb;
use super::wishes::{ANISOTROPIC, Configuration, Specimen, Weave, wish};

/// The leg: the front is the kneecap and the shin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Knee;

/// Length of the centre line, in mm.
const LENGTH: f64 = 300.0;
/// Station of the middle of the kneecap, in mm.
const KNEE: f64 = 150.0;
/// Flexion, toward the back, and the shank's slight lean outward, in radians.
const TURN: DVec2 = DVec2::new(-24.0 * PI / 180.0, 3.0 * PI / 180.0);
/// The bend is a tanh over this length, in mm: its tightest radius is 2 · 32 / 0.42 = 150 mm.
const BEND: f64 = 32.0;

const SECTIONS: Sections = Sections {
    step: 25.0,
    rows: &[
        // Front, outer side, back, inner side.
        [67.0, 65.0, 68.0, 66.0],
        [66.0, 64.0, 67.0, 65.0],
        [63.0, 62.0, 65.0, 64.0],
        [60.0, 59.0, 63.0, 62.0],
        [57.0, 57.0, 60.0, 60.0],
        [56.0, 56.0, 56.0, 59.0],
        [57.0, 57.0, 53.0, 58.0],
        [54.0, 54.0, 53.0, 56.0],
        [51.0, 51.0, 57.0, 54.0],
        [48.0, 50.0, 62.0, 54.0],
        [45.0, 50.0, 65.0, 54.0],
        [44.0, 50.0, 67.0, 54.0],
        [43.0, 49.0, 66.0, 53.0],
    ],
};

const BUMPS: [Bump; 14] = [
    // Kneecap, the hollows beside it, the tendon under it and where that ends on the shin.
    Bump { height: 9.0, station: KNEE, long: 17.0, angle: 0.04, wide: 0.33 },
    Bump { height: -3.0, station: KNEE + 10.0, long: 16.0, angle: 0.72, wide: 0.26 },
    Bump { height: -3.5, station: KNEE + 8.0, long: 16.0, angle: -0.66, wide: 0.26 },
    Bump { height: 3.5, station: KNEE + 38.0, long: 14.0, angle: 0.03, wide: 0.22 },
    Bump { height: 4.5, station: KNEE + 58.0, long: 12.0, angle: 0.05, wide: 0.22 },
    // Vastus medialis, the drop above the kneecap on the inner side; vastus lateralis.
    Bump { height: 7.0, station: KNEE - 42.0, long: 22.0, angle: -0.80, wide: 0.42 },
    Bump { height: 4.0, station: KNEE - 74.0, long: 32.0, angle: 0.85, wide: 0.45 },
    // The dip above the kneecap.
    Bump { height: -2.5, station: KNEE - 38.0, long: 14.0, angle: 0.05, wide: 0.30 },
    // The tendons on both sides of the hollow of the knee, and that hollow.
    Bump { height: 4.5, station: KNEE - 12.0, long: 30.0, angle: PI + 0.62, wide: 0.26 },
    Bump { height: 4.0, station: KNEE - 16.0, long: 30.0, angle: PI - 0.66, wide: 0.26 },
    Bump { height: -3.0, station: KNEE + 4.0, long: 20.0, angle: PI - 0.02, wide: 0.34 },
    // The calf's two heads, the inner one lower and thicker.
    Bump { height: 5.0, station: KNEE + 96.0, long: 32.0, angle: PI + 0.48, wide: 0.42 },
    Bump { height: 3.5, station: KNEE + 86.0, long: 30.0, angle: PI - 0.46, wide: 0.40 },
    // Head of the fibula.
    Bump { height: 3.0, station: KNEE + 42.0, long: 12.0, angle: 1.80, wide: 0.22 },
];

impl Limb for Knee {
    fn length(&self) -> f64 {
        LENGTH
    }

    fn origin(&self) -> f64 {
        KNEE
    }

    fn turned(&self, station: f64) -> DVec2 {
        bent(station, KNEE, BEND) * TURN
    }

    fn section(&self, station: f64, angle: f64) -> DVec3 {
        SECTIONS.at(station, angle, relief(&BUMPS, station, angle)).extend(0.0)
    }
}

/// The knee and its designs.
pub(super) const SPECIMEN: Specimen = Specimen {
    name: "knee",
    limb: &Knee,
    markers: FRAC_PI_2,
    seam: None,
    // Strain round the limb of 0.1 to 0.2.
    mmhg: &[
        wish(40.0, 1.2, 10.0),
        wish(100.0, FRAC_PI_2, 10.0),
        wish(212.0, 1.45, 12.0),
        wish(255.0, FRAC_PI_2, 12.0),
    ],
    configurations: &[Configuration {
        name: "paper",
        summary: "the paper's four pressures, two of which no fabric can give",
        weaves: &[Weave {
            name: ANISOTROPIC.0,
            stiffness: ANISOTROPIC.1,
            kpa: &[
                // On neighbouring threads, on both sides of the leg, with similar curvature:
                // "impossible to realize" in the paper's words, as a thread has one strain.
                wish(76.0, -FRAC_PI_2, 0.06),
                wish(185.0, 1.18, 3.18),
                wish(76.0, FRAC_PI_2, 2.29),
                wish(255.0, FRAC_PI_2, 0.26),
            ],
        }],
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn girths_are_those_of_a_grown_leg() {
        assert!((380.0..440.0).contains(&Knee.girth(0.0)));
        assert!((355.0..380.0).contains(&Knee.girth(KNEE)));
        let calf = Knee.girth(250.0);
        assert!((340.0..365.0).contains(&calf), "{calf}");
        assert!(calf > Knee.girth(LENGTH), "the calf is thickest above the end");
    }

    #[test]
    fn the_kneecap_stands_out_in_front() {
        let front = |station: f64| Knee.section(station, 0.04).x;
        assert!(front(KNEE) > front(KNEE - 40.0) + 5.0 && front(KNEE) > front(KNEE + 25.0) + 3.0);
    }
}
