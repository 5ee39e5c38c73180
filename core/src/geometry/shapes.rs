//! Surfaces of known answers for the tests of this crate's geometry.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use crate::surface::{Surface, VertexId};

/// A grid of `rows` × `columns` cells; closed in the column direction when `closed`. Alternating
/// diagonals; counter-clockwise when rows run upward and columns to the right.
pub(crate) fn grid(
    rows: usize,
    columns: usize,
    closed: bool,
    place: impl Fn(f64, f64) -> DVec3,
) -> Surface {
    let across = if closed { columns } else { columns + 1 };
    let mut points = Vec::new();
    for i in 0..=rows {
        for j in 0..across {
            points.push(place(j as f64 / columns as f64, i as f64 / rows as f64));
        }
    }
    let id = |i: usize, j: usize| VertexId::new(i * across + j % across);
    let mut triangles = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let (a, b, c, d) = (id(i, j), id(i, j + 1), id(i + 1, j + 1), id(i + 1, j));
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    Surface::new(points, triangles).unwrap()
}

fn cells(length: f64, edge: f64) -> usize {
    (length / edge).round().max(3.0) as usize
}

/// A cylinder about z, from z = 0.
pub(crate) fn cylinder(radius: f64, height: f64, edge: f64) -> Surface {
    grid(cells(height, edge), cells(TAU * radius, edge), true, |s, t| {
        let (sin, cos) = (TAU * s).sin_cos();
        DVec3::new(radius * cos, radius * sin, height * t)
    })
}

/// A cone about z that goes from radius `from` at z = 0 to radius `to` at z = `height`.
pub(crate) fn cone(from: f64, to: f64, height: f64, edge: f64) -> Surface {
    grid(cells(height, edge), cells(TAU * from, edge), true, |s, t| {
        let (sin, cos) = (TAU * s).sin_cos();
        let radius = from + t * (to - from);
        DVec3::new(radius * cos, radius * sin, height * t)
    })
}

/// A tube of radius `tube` bent by 90° round a ring of radius `ring` about z: an elbow.
pub(crate) fn torus_quarter(ring: f64, tube: f64, edge: f64) -> Surface {
    grid(cells(FRAC_PI_2 * ring, edge), cells(TAU * tube, edge), true, |s, t| {
        torus_point(ring, tube, s, t)
    })
}

/// The point of the bent tube at share `s` round it and share `t` along it.
pub(crate) fn torus_point(ring: f64, tube: f64, s: f64, t: f64) -> DVec3 {
    // Clockwise round the direction of travel, so that the outside is outside.
    let (sin, cos) = (-TAU * s).sin_cos();
    let (sa, ca) = (FRAC_PI_2 * t).sin_cos();
    let out = ring + tube * cos;
    DVec3::new(out * ca, out * sa, tube * sin)
}

/// A sphere about the origin within `angle` of the z axis, without a small hole round the axis.
pub(crate) fn sphere_cap(radius: f64, angle: f64, edge: f64) -> Surface {
    let rows = cells(radius * (angle - 0.2), edge);
    grid(rows, cells(TAU * radius * 0.6, edge), true, |s, t| {
        let (sin, cos) = (TAU * s).sin_cos();
        let (sa, ca) = (angle + (0.2 - angle) * t).sin_cos();
        radius * DVec3::new(sa * cos, sa * sin, ca)
    })
}

/// The same surface with gaussian noise on every coordinate, in mm, from a seed.
pub(crate) fn noisy(surface: &Surface, deviation: f64, seed: u64) -> Surface {
    let mut state = seed;
    // splitmix64 (Steele, Lea, Flood 2014).
    let mut uniform = move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut gauss = move || {
        let (a, b) = (uniform(), uniform());
        (-2.0 * (1.0 - a).ln()).sqrt() * (TAU * b).cos()
    };
    let points = surface
        .points()
        .iter()
        .map(|p| *p + deviation * DVec3::new(gauss(), gauss(), gauss()))
        .collect();
    surface.with_points(points)
}
