//! A wrist from the forearm to the knuckles with the base of the thumb: a left one, palm to the
//! front, the hand bent back a little.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::opening::Opening;
use super::shape::{Bump, Sections, bent, relief};
use super::tube::Limb;
use super::wishes::{Configuration, Specimen, Weave, wish};

/// The hand: the front is the palm, the outer side the thumb's.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wrist;

/// Length of the centre line, in mm.
const LENGTH: f64 = 198.0;
/// Station of the wrist, in mm.
const WRIST: f64 = 92.0;
/// The hand bends back and leans toward the little finger, in radians.
const TURN: DVec2 = DVec2::new(-16.0 * PI / 180.0, -6.0 * PI / 180.0);
/// The bend is a tanh over this length, in mm: its tightest radius is 2 · 20 / 0.28 = 143 mm.
const BEND: f64 = 20.0;

const SECTIONS: Sections = Sections {
    step: 20.0,
    rows: &[
        // Front, outer side, back, inner side.
        [31.0, 36.0, 31.0, 35.0],
        [30.0, 34.5, 30.0, 33.5],
        [28.0, 32.0, 28.0, 31.5],
        [25.0, 30.5, 25.0, 30.0],
        [21.5, 30.0, 22.0, 29.5],
        [19.5, 31.0, 20.0, 30.0],
        [18.5, 34.0, 19.0, 32.0],
        [17.5, 38.0, 17.5, 36.0],
        [16.5, 42.0, 16.5, 40.0],
        [15.5, 44.0, 15.5, 42.0],
        [15.0, 44.5, 15.0, 42.5],
        [15.0, 44.0, 15.0, 42.0],
    ],
};

const BUMPS: [Bump; 8] = [
    // Thenar: the ball of the thumb in the palm.
    Bump { height: 9.0, station: 132.0, long: 20.0, angle: 0.85, wide: 0.50 },
    // Hypothenar: the ball of the little finger.
    Bump { height: 5.5, station: 138.0, long: 24.0, angle: -0.90, wide: 0.50 },
    // The palm's hollow.
    Bump { height: -3.0, station: 162.0, long: 20.0, angle: 0.0, wide: 0.45 },
    // Head of the ulna.
    Bump { height: 4.0, station: 78.0, long: 9.0, angle: PI + 0.80, wide: 0.32 },
    // Knuckles of the index to the ring finger.
    Bump { height: 2.5, station: 182.0, long: 9.0, angle: PI - 0.95, wide: 0.22 },
    Bump { height: 3.0, station: 184.0, long: 9.0, angle: PI - 0.28, wide: 0.22 },
    Bump { height: 2.5, station: 182.0, long: 9.0, angle: PI + 0.35, wide: 0.22 },
    Bump { height: 2.0, station: 178.0, long: 9.0, angle: PI + 0.95, wide: 0.22 },
];

/// The thumb's base, as far as a brace covers it.
const THUMB: Bump =
    Bump { height: 21.0, station: 136.0, long: 14.5, angle: FRAC_PI_2 - 0.15, wide: 0.68 };
/// Where the thumb points, per height: to the palm, to the outer side, to the fingers. Its skin
/// moves this way rather than along the hand's normal, which would fan out round the hand's edge
/// and make a mushroom of it.
const THUMB_AXIS: DVec3 = DVec3::new(0.25, 0.95, 0.65);

impl Limb for Wrist {
    fn length(&self) -> f64 {
        LENGTH
    }

    fn origin(&self) -> f64 {
        WRIST
    }

    fn turned(&self, station: f64) -> DVec2 {
        bent(station, WRIST, BEND) * TURN
    }

    fn section(&self, station: f64, angle: f64) -> DVec3 {
        let hand = SECTIONS.at(station, angle, relief(&BUMPS, station, angle)).extend(0.0);
        hand + THUMB.at(station, angle) * THUMB_AXIS
    }

    fn opening(&self) -> Option<Opening> {
        // Where the thumb leaves the brace: some 70 mm round.
        Some(Opening { bump: THUMB, height: 0.82 * THUMB.height })
    }
}

/// The wrist and its designs.
pub(super) const SPECIMEN: Specimen = Specimen {
    name: "wrist",
    limb: &Wrist,
    markers: FRAC_PI_2,
    seam: None,
    // Strain round the limb of 0.1 to 0.2.
    mmhg: &[
        wish(36.0, FRAC_PI_2, 14.0),
        wish(68.0, FRAC_PI_2, 17.0),
        wish(104.0, -0.78, 14.0),
        wish(138.0, -0.68, 14.0),
    ],
    configurations: &[Configuration {
        name: "paper",
        summary: "high pressure near the base of the thumb",
        weaves: &[Weave {
            name: "stiff round the limb",
            stiffness: [0.75, 0.5, 0.05],
            kpa: &[wish(40.0, FRAC_PI_2, 0.5), wish(112.0, 1.0, 6.0), wish(165.0, -1.2, 0.5)],
        }],
    }],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn girths_are_those_of_a_grown_hand() {
        assert!((200.0..215.0).contains(&Wrist.girth(0.0)));
        assert!((160.0..172.0).contains(&Wrist.girth(WRIST)));
        assert!((190.0..210.0).contains(&Wrist.girth(LENGTH)));
        assert!(Wrist.girth(THUMB.station) > Wrist.girth(LENGTH) + 25.0, "the thumb's base");
    }
}
