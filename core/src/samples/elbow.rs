//! A bent arm from the middle of the upper arm to above the wrist: a left one, flexed 45°.
//!
//! Sections perpendicular to a smooth bent centre line, each an ellipse with muscles and bones
//! added as smooth bumps. Their amplitudes differ from side to side, so that nothing is
//! mirror-symmetric and no two paths round the limb are equally short.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::tube::Limb;
use crate::design::{Design, Fabric, Piece, PressureModel, WantedPressure};
use crate::units::kpa_from_mmhg;

/// The arm. Station 0 is in the upper arm; angle 0 is the front (biceps, crease of the elbow),
/// π/2 the outer (lateral) side, π the back. At station 0 the limb points down (−z), the front
/// is +x and the outer side +y; the elbow's centre is the origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Elbow;

/// Length of the centre line, in mm.
const LENGTH: f64 = 236.0;
/// Station of the middle of the bend, in mm.
const ELBOW: f64 = 112.0;
/// Flexion, in radians.
const FLEXION: f64 = 46.0 * PI / 180.0;
/// Carrying angle: the forearm leans outward by this, in radians.
const CARRYING: f64 = 7.0 * PI / 180.0;
/// The bend is a tanh over this length, in mm: its tightest radius 2 · 26 / FLEXION = 65 mm stays
/// well above the 40 mm from the centre line to the front, so no two sections cross.
const BEND: f64 = 26.0;

impl Limb for Elbow {
    fn length(&self) -> f64 {
        LENGTH
    }

    fn point(&self, station: f64, angle: f64) -> DVec3 {
        let [_, front, side] = frame(station);
        let (sin, cos) = angle.sin_cos();
        centre(station) + radius(station, angle) * (cos * front + sin * side)
    }
}

/// How much of the bend lies behind a station, from 0 to 1.
fn bent(station: f64) -> f64 {
    0.5 * (1.0 + ((station - ELBOW) / BEND).tanh())
}

/// Direction of the centre line, then the front and the outer side, all unit and perpendicular.
fn frame(station: f64) -> [DVec3; 3] {
    let (sin_f, cos_f) = (FLEXION * bent(station)).sin_cos();
    let (sin_c, cos_c) = (CARRYING * bent(station)).sin_cos();
    let along = DVec3::new(sin_f * cos_c, sin_c, -cos_f * cos_c);
    let front = DVec3::new(cos_f, 0.0, sin_f);
    [along, front, front.cross(along)]
}

/// The centre line: the integral of its direction from the elbow, by Simpson's rule in 64
/// steps of at most 2 mm (error under 1e-6 mm).
fn centre(station: f64) -> DVec3 {
    let steps = 64;
    let step = (station - ELBOW) / f64::from(steps);
    let sum: DVec3 = (0..=steps)
        .map(|k| {
            let weight = match k {
                0 => 1.0,
                k if k == steps => 1.0,
                k if k % 2 == 1 => 4.0,
                _ => 2.0,
            };
            weight * frame(ELBOW + f64::from(k) * step)[0]
        })
        .sum();
    sum * step / 3.0
}

/// A muscle, bone or crease.
struct Bump {
    /// How far it stands out, in mm; negative for a hollow.
    height: f64,
    /// Its middle along the limb, in mm.
    station: f64,
    /// Its half width along the limb (one deviation), in mm.
    long: f64,
    /// Its middle round the limb, in radians.
    angle: f64,
    /// Its half width round the limb (one deviation), in radians.
    wide: f64,
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
    let forearm = bent(station);
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
    let bumps: f64 = BUMPS
        .iter()
        .map(|b| {
            let along = 0.5 * ((station - b.station) / b.long).powi(2);
            // The periodic Gaussian (von Mises): smooth all the way round.
            let round = (1.0 - (angle - b.angle).cos()) / b.wide.powi(2);
            b.height * (-along - round).exp()
        })
        .sum();
    ellipse + skew + bumps
}

/// A reachable design: strain round the limb about 0.15 everywhere, by Laplace's law
/// P = k ε κ on the limb's own curvature.
pub(super) fn design() -> Design {
    let wanted = |station: f64, angle: f64, mmhg: f64| WantedPressure {
        at: Elbow.point(station, angle),
        kpa: kpa_from_mmhg(mmhg),
    };
    Design {
        fabric: Fabric {
            name: "sample weave".to_owned(),
            warp: 0.5,
            weft: 0.5,
            diagonal: 0.05,
            max_strain: 0.5,
            ..Fabric::default()
        },
        pressure_model: PressureModel::Laplace,
        pressures: vec![
            wanted(36.0, 1.3, 12.0),
            wanted(80.0, FRAC_PI_2, 13.0),
            wanted(158.0, 1.1, 15.0),
            wanted(200.0, 1.3, 14.0),
        ],
        orientation: Some([Elbow.point(12.0, FRAC_PI_2), Elbow.point(LENGTH - 12.0, FRAC_PI_2)]),
        piece: Piece { name: "elbow brace".to_owned(), ..Piece::default() },
        ..Design::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Station and angle of a point near the limb: where the plane across the centre line meets
    /// it, by bisection on the side of that plane, which grows with the station.
    fn locate(point: DVec3) -> (f64, f64) {
        let ahead = |station: f64| (point - centre(station)).dot(frame(station)[0]);
        let (mut low, mut high) = (-1.0, LENGTH + 1.0);
        assert!(ahead(low) > 0.0 && ahead(high) < 0.0);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if ahead(middle) > 0.0 { low = middle } else { high = middle }
        }
        let [_, front, side] = frame(low);
        let from_centre = point - centre(low);
        (low, from_centre.dot(side).atan2(from_centre.dot(front)))
    }

    #[test]
    fn every_resolution_samples_the_same_surface() {
        for triangles in [700, 1_400, 2_800] {
            let mesh = crate::samples::sample("elbow", triangles, 0.0).unwrap().mesh;
            for &point in &mesh.points {
                let (station, angle) = locate(point);
                let gap = Elbow.point(station, angle).distance(point);
                assert!(gap < 1e-9, "{gap} mm at {point}");
            }
        }
    }

    #[test]
    fn girths_are_those_of_a_grown_arm() {
        assert!((275.0..290.0).contains(&Elbow.girth(20.0)));
        assert!((250.0..265.0).contains(&Elbow.girth(ELBOW)));
        let forearm = Elbow.girth(160.0);
        assert!((255.0..270.0).contains(&forearm));
        assert!(forearm > Elbow.girth(200.0) + 15.0, "the forearm tapers");
        assert!((190.0..205.0).contains(&Elbow.girth(LENGTH)));
    }

    #[test]
    fn sections_do_not_cross_on_the_inner_side_of_the_bend() {
        // Sections cross where walking along the limb goes backward against the centre line.
        for station in (0..=236).map(f64::from) {
            for angle in (0..360).map(|k| f64::from(k).to_radians()) {
                let step = 1e-3;
                let walk = Elbow.point(station + step, angle) - Elbow.point(station - step, angle);
                let forward = walk.dot(frame(station)[0]) / (2.0 * step);
                assert!(forward > 0.25, "{forward} at station {station}, angle {angle}");
            }
        }
    }

    #[test]
    fn no_plane_mirrors_the_limb() {
        // Against the plane of flexion every section differs by millimetres.
        for station in [0.0, 60.0, ELBOW, 170.0, LENGTH] {
            let most = (0..180)
                .map(|k| f64::from(k).to_radians())
                .map(|angle| (radius(station, angle) - radius(station, -angle)).abs())
                .fold(0.0, f64::max);
            assert!(most > 0.5, "{most} mm at station {station}");
        }
    }

    /// Normal curvature round the limb, in 1/mm: −⟨X'', n⟩ / |X'|² along the section.
    fn curvature_round(station: f64, angle: f64) -> f64 {
        let step = 1e-3;
        let [a, b, c] = [-step, 0.0, step].map(|d| Elbow.point(station, angle + d));
        let (first, second) = ((c - a) / (2.0 * step), (c - 2.0 * b + a) / (step * step));
        -second.dot(Elbow.normal(station, angle)) / first.length_squared()
    }

    #[test]
    fn the_design_asks_for_what_a_weave_can_give() {
        let design = design();
        let places: Vec<(f64, f64)> = design.pressures.iter().map(|p| locate(p.at)).collect();
        for (wanted, &(station, angle)) in design.pressures.iter().zip(&places) {
            assert!(Elbow.point(station, angle).distance(wanted.at) < 1e-9, "on the surface");
            let curvature = curvature_round(station, angle);
            // Laplace: P = k ε κ, with 1 kPa = 1e-3 N/mm².
            let strain = wanted.kpa * 1e-3 / (design.fabric.warp * curvature);
            assert!((0.10..0.20).contains(&strain), "strain {strain} at station {station}");
            // The same within a curvature radius: no sharp crest, no hollow nearby.
            for (ds, dw) in [(10.0, 0.0), (-10.0, 0.0), (0.0, 0.25), (0.0, -0.25)] {
                let near = curvature_round(station + ds, angle + dw);
                assert!((0.7..1.4).contains(&(near / curvature)), "{near} against {curvature}");
            }
        }
        let mut stations: Vec<f64> = places.iter().map(|place| place.0).collect();
        stations.insert(0, 0.0);
        stations.push(LENGTH);
        assert!(stations.windows(2).all(|pair| pair[1] - pair[0] >= 30.0), "{stations:?}");
        let markers = design.orientation.unwrap().map(locate);
        assert!(markers[0].0 < 20.0 && markers[1].0 > LENGTH - 20.0);
    }
}
