//! An ankle from the calf round the heel to the middle of the foot: a left one, the foot at 95° to
//! the leg.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::shape::{Bump, Sections, evenly_bent, relief};
use super::tube::Limb;
use super::wishes::{Specimen, wish};

/// The leg and foot: the front is the shin and the back of the foot, the back is the Achilles
/// tendon, the heel and the sole.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ankle;

/// Length of the centre line, in mm.
const LENGTH: f64 = 250.0;
/// Station of the middle of the bend, in mm: the section through the heel and the crease in front.
const HEEL: f64 = 150.0;
/// From the leg to the foot, and the toes' slight turn outward, in radians.
const TURN: DVec2 = DVec2::new(85.0 * PI / 180.0, 6.0 * PI / 180.0);
/// The bend is even over this length on both sides and then eases out, in mm: its radius
/// 2 · 46 / 1.48 = 62 mm stays well above the 38 mm to the front, so no two sections cross.
const BEND: (f64, f64) = (46.0, 14.0);

const SECTIONS: Sections = Sections {
    step: 20.0,
    rows: &[
        // Front, outer side, back, inner side.
        [45.0, 46.0, 52.0, 47.0],
        [43.0, 44.0, 51.0, 45.0],
        [40.0, 40.0, 47.0, 41.0],
        [37.0, 36.0, 43.0, 37.0],
        [35.0, 34.0, 39.0, 34.5],
        [34.5, 34.5, 40.0, 35.0],
        [36.0, 35.5, 50.0, 35.5],
        [38.0, 35.0, 67.0, 35.0],
        [38.0, 34.5, 69.0, 34.5],
        [36.0, 36.0, 48.0, 35.0],
        [34.0, 38.5, 40.5, 37.0],
        [33.0, 40.5, 36.0, 39.0],
        [32.0, 41.5, 34.0, 40.0],
        [31.0, 42.0, 33.5, 40.5],
    ],
};

const BUMPS: [Bump; 10] = [
    // The heel's ball.
    Bump { height: 9.0, station: HEEL - 2.0, long: 13.0, angle: PI - 0.03, wide: 0.50 },
    // Outer and inner malleolus: the outer one lower and further back.
    Bump { height: 7.0, station: HEEL - 28.0, long: 10.0, angle: FRAC_PI_2 + 0.16, wide: 0.30 },
    Bump { height: 6.5, station: HEEL - 36.0, long: 11.0, angle: -FRAC_PI_2 + 0.06, wide: 0.32 },
    // The hollows on both sides of the Achilles tendon.
    Bump { height: -5.0, station: HEEL - 50.0, long: 22.0, angle: PI - 0.72, wide: 0.32 },
    Bump { height: -4.5, station: HEEL - 52.0, long: 22.0, angle: PI + 0.74, wide: 0.32 },
    // The calf, its inner side lower.
    Bump { height: 3.0, station: 4.0, long: 26.0, angle: PI + 0.50, wide: 0.45 },
    // The shin's edge and the tendon that crosses the ankle in front.
    Bump { height: 2.0, station: 50.0, long: 40.0, angle: -0.15, wide: 0.26 },
    Bump { height: 2.0, station: HEEL - 10.0, long: 26.0, angle: -0.14, wide: 0.20 },
    // The arch of the foot, and the root of the little toe's bone.
    Bump { height: -5.0, station: HEEL + 68.0, long: 22.0, angle: PI + 0.70, wide: 0.45 },
    Bump { height: 2.5, station: HEEL + 72.0, long: 13.0, angle: FRAC_PI_2 + 0.50, wide: 0.25 },
];

impl Limb for Ankle {
    fn length(&self) -> f64 {
        LENGTH
    }

    fn origin(&self) -> f64 {
        HEEL
    }

    fn turned(&self, station: f64) -> DVec2 {
        evenly_bent(station, HEEL, BEND.0, BEND.1) * TURN
    }

    fn section(&self, station: f64, angle: f64) -> DVec3 {
        SECTIONS.at(station, angle, relief(&BUMPS, station, angle)).extend(0.0)
    }
}

/// The ankle and its designs.
pub(super) const SPECIMEN: Specimen = Specimen {
    name: "ankle",
    limb: &Ankle,
    markers: FRAC_PI_2,
    // Down the Achilles tendon, round the heel and along the sole, as such braces are sewn: along
    // the front, the shortest way, the heel would stay a cup that no weave lies flat in.
    seam: Some(PI),
    // Strain round the limb of 0.1 to 0.2.
    mmhg: &[
        wish(36.0, -1.38, 12.0),
        wish(70.0, -1.98, 14.0),
        wish(110.0, 1.75, 14.0),
        wish(219.0, 1.45, 14.0),
    ],
    configurations: &[],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn girths_are_those_of_a_slender_leg_and_foot() {
        assert!((290.0..310.0).contains(&Ankle.girth(0.0)));
        let above = Ankle.girth(85.0);
        assert!((215.0..235.0).contains(&above), "{above}");
        assert!(Ankle.girth(HEEL - 30.0) > above + 20.0, "the malleoli");
        assert!((270.0..320.0).contains(&Ankle.girth(HEEL)), "round heel and instep");
        assert!((225.0..250.0).contains(&Ankle.girth(LENGTH)));
    }

    #[test]
    fn the_foot_stands_out_from_the_leg_with_a_heel_behind() {
        let leg = Ankle.frame(0.0).along;
        let foot = Ankle.frame(LENGTH).along;
        let angle = 180.0 - leg.angle_between(foot).to_degrees();
        assert!((90.0..100.0).contains(&angle), "{angle}°");
        // The heel lies further back than the Achilles tendon, and lower than the sole's arch.
        let rearmost = |from: i32, to: i32| {
            let stations = (from..to).map(f64::from);
            stations.map(|station| Ankle.point(station, PI).x).fold(f64::MAX, f64::min)
        };
        let (tendon, heel) = (Ankle.point(85.0, PI).x, rearmost(110, 150));
        assert!(heel < tendon - 5.0, "{heel} {tendon}");
        let lowest = |from: i32| {
            let stations = (from..from + 30).map(f64::from);
            stations.map(|station| Ankle.point(station, PI).z).fold(f64::MAX, f64::min)
        };
        assert!(lowest(155) < lowest(205), "{} {}", lowest(155), lowest(205));
    }
}
