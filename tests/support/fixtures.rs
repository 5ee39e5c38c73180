//! Surfaces named after what they are, each with its analytic truth. Lengths in mm.
//!
//! A mesh whose points lie on a curved surface is itself a polyhedron: round a tube it measures
//! the polygon's girth, not the circle's. Both are given; exact comparisons take the polygon's.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::mesh::{Mesh, Triangulation, disk, grid};

/// Rows that make cells of `length / rows` near as long as `width / columns` is wide.
fn rows(length: f64, width: f64, columns: usize) -> usize {
    ((length * columns as f64 / width).round() as usize).max(1)
}

/// A flat rectangle in the xy-plane, facing +z.
#[must_use]
pub fn plane(width: f64, height: f64, columns: usize, triangulation: Triangulation) -> Mesh {
    grid(columns, rows(height, width, columns), false, triangulation, |u, v| {
        DVec3::new(width * u, height * v, 0.0)
    })
}

/// An open cylinder round the z-axis.
#[derive(Debug, Clone)]
pub struct Tube {
    /// Its triangles.
    pub mesh: Mesh,
    /// Its radius.
    pub radius: f64,
    /// Its length.
    pub length: f64,
    /// Sides of its end loops.
    pub sides: usize,
}

/// An open cylinder of `sides` sides, from z = 0 to z = `length`.
#[must_use]
pub fn tube(radius: f64, length: f64, sides: usize, triangulation: Triangulation) -> Tube {
    let mesh = grid(sides, rows(length, TAU * radius, sides), true, triangulation, |u, v| {
        cylinder(radius, TAU * u, length * v)
    });
    Tube { mesh, radius, length, sides }
}

fn cylinder(radius: f64, angle: f64, z: f64) -> DVec3 {
    DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
}

impl Tube {
    /// Girth of the circle.
    #[must_use]
    pub fn girth(&self) -> f64 {
        TAU * self.radius
    }

    /// Girth of the polygon that the end loops are.
    #[must_use]
    pub fn polygon_girth(&self) -> f64 {
        let n = self.sides as f64;
        2.0 * n * self.radius * (PI / n).sin()
    }

    /// The point of the cylinder at an angle and a height.
    #[must_use]
    pub fn at(&self, angle: f64, z: f64) -> DVec3 {
        cylinder(self.radius, angle, z)
    }
}

/// An open cylinder with a slit of `gap` radians along it, facing outward: a disk that flattens
/// to a rectangle of radius · (2π − gap) by length.
#[must_use]
pub fn slit_tube(
    radius: f64,
    length: f64,
    gap: f64,
    columns: usize,
    triangulation: Triangulation,
) -> Mesh {
    let arc = TAU - gap;
    grid(columns, rows(length, radius * arc, columns), false, triangulation, |u, v| {
        cylinder(radius, 0.5 * gap + arc * u, length * v)
    })
}

/// A part of the cone whose apex is the origin and whose axis is −z.
#[derive(Debug, Clone)]
pub struct Cone {
    /// Its triangles.
    pub mesh: Mesh,
    /// Angle between axis and surface, in radians.
    pub half_angle: f64,
    /// Least distance from the apex along the surface.
    pub inner: f64,
    /// Greatest distance from the apex along the surface.
    pub outer: f64,
    /// Angle round the axis, in radians; 2π for a whole frustum.
    pub turn: f64,
}

impl Cone {
    fn new(
        half_angle: f64,
        [inner, outer]: [f64; 2],
        turn: f64,
        columns: usize,
        triangulation: Triangulation,
    ) -> Self {
        let closed = turn >= TAU;
        let width = 0.5 * (inner + outer) * half_angle.sin() * turn;
        let mesh =
            grid(columns, rows(outer - inner, width, columns), closed, triangulation, |u, v| {
                let (slant, angle) = (outer + (inner - outer) * v, turn * u);
                let r = slant * half_angle.sin();
                DVec3::new(r * angle.cos(), r * angle.sin(), -slant * half_angle.cos())
            });
        Self { mesh, half_angle, inner, outer, turn }
    }

    /// Angle of the flat sector that it unrolls to, in radians.
    #[must_use]
    pub fn flat_angle(&self) -> f64 {
        self.turn * self.half_angle.sin()
    }

    /// Where a point of the cone lies when unrolled isometrically, apex at the origin, azimuth 0
    /// on the x-axis. Azimuths are taken in [0, 2π).
    #[must_use]
    pub fn unrolled(&self, point: DVec3) -> DVec2 {
        let azimuth = point.y.atan2(point.x).rem_euclid(TAU);
        // Rounding may turn azimuth 0 into nearly 2π.
        let azimuth = if TAU - azimuth < 1e-9 { 0.0 } else { azimuth };
        point.length() * DVec2::from_angle(azimuth * self.half_angle.sin())
    }
}

/// A disk-shaped piece of a cone: `turn` radians of it (under 2π), between two distances from
/// the apex along the surface.
#[must_use]
pub fn cone_sector(
    half_angle: f64,
    slant: [f64; 2],
    turn: f64,
    columns: usize,
    triangulation: Triangulation,
) -> Cone {
    assert!(turn < TAU, "a sector leaves a gap");
    Cone::new(half_angle, slant, turn, columns, triangulation)
}

/// An open tube: the cone all the way round between two distances from the apex.
#[must_use]
pub fn cone_frustum(
    half_angle: f64,
    slant: [f64; 2],
    sides: usize,
    triangulation: Triangulation,
) -> Cone {
    Cone::new(half_angle, slant, TAU, sides, triangulation)
}

/// A cap of a sphere round the origin, its pole on +z.
#[derive(Debug, Clone)]
pub struct SphereCap {
    /// Its triangles.
    pub mesh: Mesh,
    /// Radius of the sphere.
    pub radius: f64,
    /// Angle from the pole to the rim, in radians.
    pub polar: f64,
}

/// A cap of a sphere out to the polar angle, of `rings` rings of triangles.
#[must_use]
pub fn sphere_cap(
    radius: f64,
    polar: f64,
    rings: usize,
    triangulation: Triangulation,
) -> SphereCap {
    let mesh = disk(rings, triangulation, |r, angle| {
        let (sin, cos) = (polar * r).sin_cos();
        radius * DVec3::new(sin * angle.cos(), sin * angle.sin(), cos)
    });
    SphereCap { mesh, radius, polar }
}

impl SphereCap {
    /// Area of the smooth cap.
    #[must_use]
    pub fn area(&self) -> f64 {
        TAU * self.radius * self.radius * (1.0 - self.polar.cos())
    }

    /// Both principal curvatures, in 1/mm.
    #[must_use]
    pub fn curvature(&self) -> f64 {
        1.0 / self.radius
    }
}

/// A patch of a torus round the z-axis, outward.
#[derive(Debug, Clone)]
pub struct TorusPatch {
    /// Its triangles.
    pub mesh: Mesh,
    /// Distance from the axis to the middle of the tube.
    pub major: f64,
    /// Radius of the tube.
    pub minor: f64,
}

/// A patch of a torus: `turn` radians round the axis, and round the tube from `tube[0]` to
/// `tube[1]` radians, 0 being farthest from the axis.
#[must_use]
pub fn torus_patch(
    [major, minor]: [f64; 2],
    turn: f64,
    tube: [f64; 2],
    columns: usize,
    triangulation: Triangulation,
) -> TorusPatch {
    let (width, length) = (major * turn, minor * (tube[1] - tube[0]));
    let mesh = grid(columns, rows(length, width, columns), false, triangulation, |u, v| {
        let (angle, round) = (turn * u, tube[0] + (tube[1] - tube[0]) * v);
        let r = major + minor * round.cos();
        DVec3::new(r * angle.cos(), r * angle.sin(), minor * round.sin())
    });
    TorusPatch { mesh, major, minor }
}

impl TorusPatch {
    /// Principal curvatures at an angle round the tube, in 1/mm, outward positive: along the
    /// tube's circle, then round the axis (negative on the inner side).
    #[must_use]
    pub fn curvatures(&self, round: f64) -> [f64; 2] {
        [1.0 / self.minor, round.cos() / (self.major + self.minor * round.cos())]
    }
}

/// A tube with a round hole of `hole` mm radius (measured along the surface) at angle π and half
/// its length: three boundary loops.
///
/// # Panics
/// If the hole does not fit.
#[must_use]
pub fn tube_with_hole(radius: f64, length: f64, hole: f64, sides: usize) -> Mesh {
    let cell = TAU * radius / sides as f64;
    let count = rows(length, TAU * radius, sides);
    let tall = length / count as f64;
    // A square block of cells round the hole is replaced by rings from the block to the circle.
    let half = (1.6 * hole / cell).ceil() as usize;
    let (left, low) = (sides / 2 - half, count / 2 - half);
    assert!(sides > 4 * half && count >= 2 * half + 2, "the hole does not fit");
    let mut mesh = grid(sides, count, true, Triangulation::Alternating, |u, v| {
        cylinder(radius, TAU * u, length * v)
    });
    let size = 2 * half;
    let vertex = |i: usize, j: usize| (low + j) * sides + left + i;
    let inside = |v: usize| {
        let (i, j) = (v % sides, v / sides);
        i > left && i < left + size && j > low && j < low + size
    };
    let block = |t: &[usize; 3]| {
        let (i, j): (Vec<_>, Vec<_>) = t.iter().map(|v| (v % sides, v / sides)).unzip();
        i.iter().all(|&i| i >= left && i <= left + size)
            && j.iter().all(|&j| j >= low && j <= low + size)
    };
    mesh.triangles.retain(|t| !block(t));
    // The block's rim, counter-clockwise, from its lower left corner.
    let rim: Vec<usize> = (0..size)
        .map(|k| vertex(k, 0))
        .chain((0..size).map(|k| vertex(size, k)))
        .chain((0..size).map(|k| vertex(size - k, size)))
        .chain((0..size).map(|k| vertex(0, size - k)))
        .collect();
    let middle = DVec2::new((left + half) as f64 * cell, (low + half) as f64 * tall);
    let flat = |v: usize| DVec2::new((v % sides) as f64 * cell, (v / sides) as f64 * tall);
    let rings = ((half as f64 - hole / cell).round() as usize).max(1);
    let mut ring = rim.clone();
    for k in 1..=rings {
        let share = k as f64 / rings as f64;
        let first = mesh.points.len();
        for &v in &rim {
            let out = flat(v) - middle;
            let place = middle + out.lerp(hole * out.normalize(), share);
            mesh.points.push(cylinder(radius, place.x / radius, place.y));
        }
        let next: Vec<usize> = (first..mesh.points.len()).collect();
        for i in 0..ring.len() {
            let n = (i + 1) % ring.len();
            mesh.triangles.extend([[ring[i], ring[n], next[n]], [ring[i], next[n], next[i]]]);
        }
        ring = next;
    }
    // Drop the vertices that only the block used.
    let mut place = vec![usize::MAX; mesh.points.len()];
    let mut points = Vec::new();
    for (v, &point) in mesh.points.iter().enumerate() {
        if v >= sides * (count + 1) || !inside(v) {
            place[v] = points.len();
            points.push(point);
        }
    }
    let triangles = mesh.triangles.iter().map(|t| t.map(|v| place[v])).collect();
    Mesh { points, triangles }
}

/// A tube with smooth waves of `height` mm round and along it; no symmetry.
#[must_use]
pub fn bumpy(
    radius: f64,
    length: f64,
    height: f64,
    sides: usize,
    triangulation: Triangulation,
) -> Mesh {
    grid(sides, rows(length, TAU * radius, sides), true, triangulation, |u, v| {
        let angle = TAU * u;
        let wave = (3.0 * angle + 0.4).sin() * (1.3 * PI * v + 0.2).cos()
            + 0.5 * (2.0 * angle - 1.0 + 2.0 * v).cos();
        cylinder(radius + height * wave, angle, length * v)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tube_measures_what_it_says() {
        for triangulation in Triangulation::ALL {
            let tube = tube(40.0, 100.0, 60, triangulation);
            let loops = tube.mesh.boundary_loops();
            assert_eq!(loops.len(), 2);
            for around in loops {
                let girth: f64 = (0..around.len())
                    .map(|k| {
                        let next = around[(k + 1) % around.len()];
                        tube.mesh.points[around[k]].distance(tube.mesh.points[next])
                    })
                    .sum();
                assert!((girth - tube.polygon_girth()).abs() < 1e-9);
            }
            assert!((tube.mesh.area() / (tube.girth() * tube.length) - 1.0).abs() < 2e-3);
        }
        // A square in a circle of radius 1 has girth 4 √2.
        assert!(
            (tube(1.0, 1.0, 4, Triangulation::Structured).polygon_girth() - 32f64.sqrt()).abs()
                < 1e-12
        );
    }

    #[test]
    fn a_cone_unrolls_to_its_sector() {
        let half = 30f64.to_radians();
        let sector = cone_sector(half, [100.0, 200.0], 3.0, 60, Triangulation::Jittered(3));
        assert!((sector.flat_angle() - 1.5).abs() < 1e-12);
        // Every triangle keeps its shape up to the chord's error of second order.
        let signed = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|v| sector.unrolled(sector.mesh.points[v]));
            0.5 * (b - a).perp_dot(c - a)
        };
        let flat: f64 = sector.mesh.triangles.iter().map(signed).sum();
        assert!((flat / sector.mesh.area() - 1.0).abs() < 1e-3);
        assert!(sector.mesh.triangles.iter().all(|t| signed(t) > 0.0), "seen from outside");
        let exact = 0.5 * 1.5 * (200.0f64.powi(2) - 100.0f64.powi(2));
        assert!((flat / exact - 1.0).abs() < 2e-3);
    }

    #[test]
    fn a_cap_and_a_torus_face_outward() {
        for triangulation in Triangulation::ALL {
            let cap = sphere_cap(50.0, 1.0, 16, triangulation);
            assert!(cap.mesh.corners().all(|[a, b, c]| (b - a).cross(c - a).dot(a + b + c) > 0.0));
            assert!((cap.mesh.area() / cap.area() - 1.0).abs() < 5e-3);
            let patch = torus_patch([90.0, 30.0], 1.0, [-1.0, 1.0], 20, triangulation);
            for [a, b, c] in patch.mesh.corners() {
                let middle = (a + b + c) / 3.0;
                let ring = 90.0 * (middle * DVec3::new(1.0, 1.0, 0.0)).normalize();
                assert!((b - a).cross(c - a).dot(middle - ring) > 0.0);
            }
        }
    }

    #[test]
    fn a_hole_is_a_third_loop_of_its_own_size() {
        let mesh = tube_with_hole(40.0, 120.0, 12.0, 64);
        let loops = mesh.boundary_loops();
        assert_eq!(loops.len(), 3);
        let used: std::collections::BTreeSet<usize> =
            mesh.triangles.iter().flatten().copied().collect();
        assert_eq!(used.len(), mesh.points.len());
        let length = |around: &Vec<usize>| -> f64 {
            (0..around.len())
                .map(|k| {
                    mesh.points[around[k]].distance(mesh.points[around[(k + 1) % around.len()]])
                })
                .sum()
        };
        let hole = loops.iter().map(length).fold(f64::MAX, f64::min);
        assert!((hole / (TAU * 12.0) - 1.0).abs() < 0.01, "{hole}");
        for [a, b, c] in mesh.corners() {
            let outward = (a + b + c) * DVec3::new(1.0, 1.0, 0.0);
            assert!((b - a).cross(c - a).dot(outward) > 0.0);
        }
        let expected = TAU * 40.0 * 120.0 - PI * 12.0 * 12.0;
        assert!((mesh.area() / expected - 1.0).abs() < 3e-3);
    }
}
