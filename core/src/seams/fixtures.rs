//! Analytic surfaces for the tests of this folder.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::surface::{Surface, VertexId};

/// How a grid is triangulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mesh {
    /// Straight rows and columns, diagonals all one way.
    Right,
    /// Diagonals the other way, columns that wind round the axis.
    Wound,
    /// Odd rows moved by half a cell.
    Bricks,
    /// Vertices moved at random by up to a third of a cell, diagonals at random.
    Random(u64),
}

impl Mesh {
    pub const ALL: [Self; 5] =
        [Self::Right, Self::Wound, Self::Bricks, Self::Random(1), Self::Random(7)];
}

/// Steele, Lea & Flood 2014 (SplitMix64): uniform in [-1, 1).
pub struct Noise(pub u64);

impl Noise {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

pub fn surface(points: Vec<DVec3>, triangles: &[[usize; 3]]) -> Surface {
    Surface::new(points, triangles.iter().map(|t| t.map(VertexId::new)).collect()).unwrap()
}

/// A tube over the unit square: `place(u, v)`, u round (counter-clockwise from above), v along.
/// `skip` leaves out cells (column, row).
pub fn tube(
    around: usize,
    along: usize,
    mesh: Mesh,
    place: impl Fn(f64, f64) -> DVec3,
    skip: impl Fn(usize, usize) -> bool,
) -> Surface {
    let mut noise = Noise(if let Mesh::Random(seed) = mesh { seed } else { 0 });
    let mut points = Vec::new();
    for j in 0..=along {
        for i in 0..around {
            let (mut u, mut v) = (i as f64, j as f64);
            match mesh {
                Mesh::Right => {}
                Mesh::Wound => u += 0.37 * v,
                Mesh::Bricks => u += if j % 2 == 1 { 0.5 } else { 0.0 },
                Mesh::Random(_) => {
                    u += noise.next() / 3.0;
                    v += if j == 0 || j == along { 0.0 } else { noise.next() / 3.0 };
                }
            }
            points.push(place(u / around as f64, v / along as f64));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..along {
        for i in 0..around {
            let flip = match mesh {
                Mesh::Right => false,
                Mesh::Wound => true,
                Mesh::Bricks => j % 2 == 0,
                Mesh::Random(_) => noise.next() > 0.0,
            };
            if skip(i, j) {
                continue;
            }
            let next = (i + 1) % around;
            let (a, b) = (j * around + i, j * around + next);
            let (c, d) = (a + around, b + around);
            triangles.extend(if flip { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] });
        }
    }
    let mut index = vec![usize::MAX; points.len()];
    let mut used = Vec::new();
    for v in triangles.iter_mut().flatten() {
        if index[*v] == usize::MAX {
            index[*v] = used.len();
            used.push(points[*v]);
        }
        *v = index[*v];
    }
    surface(used, &triangles)
}

pub fn round(radius: f64, u: f64, z: f64) -> DVec3 {
    DVec3::new(radius * (TAU * u).cos(), radius * (TAU * u).sin(), z)
}

/// A cylinder round the z axis, from z = 0 to `height`.
pub fn cylinder(radius: f64, height: f64, mesh: Mesh) -> Surface {
    tube(48, 40, mesh, |u, v| round(radius, u, v * height), |_, _| false)
}

/// A frustum of a cone round the z axis, `low` and `high` its radii.
pub fn frustum(low: f64, high: f64, height: f64, mesh: Mesh) -> Surface {
    tube(48, 40, mesh, |u, v| round(low + v * (high - low), u, v * height), |_, _| false)
}

/// A cylinder with a window of 8 by 6 cells, some 42 by 30 mm, centred at angle 0.
pub fn cylinder_with_hole(mesh: Mesh) -> Surface {
    let place = |u: f64, v: f64| round(40.0, u - 0.5, 200.0 * v);
    tube(48, 40, mesh, place, |i, j| (20..28).contains(&i) && (17..23).contains(&j))
}

/// A cylinder slit along a generator: a disk with two coincident sides.
pub fn slit_cylinder(radius: f64, height: f64) -> Surface {
    let (around, along) = (48, 40);
    let mut points = Vec::new();
    for j in 0..=along {
        for i in 0..=around {
            let u = (i % around) as f64 / around as f64;
            points.push(round(radius, u, height * j as f64 / along as f64));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..along {
        for i in 0..around {
            let a = j * (around + 1) + i;
            let c = a + around + 1;
            triangles.extend([[a, a + 1, c + 1], [a, c + 1, c]]);
        }
    }
    surface(points, &triangles)
}

/// A flat strip in the plane z = 0, `width` along x and `height` along y, seen from above.
pub fn strip(width: f64, height: f64) -> Surface {
    let (across, along) = (20, 50);
    let mut points = Vec::new();
    for j in 0..=along {
        for i in 0..=across {
            let (u, v) = (i as f64 / across as f64, j as f64 / along as f64);
            points.push(DVec3::new(width * u, height * v, 0.0));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..along {
        for i in 0..across {
            let a = j * (across + 1) + i;
            let c = a + across + 1;
            triangles.extend([[a, a + 1, c + 1], [a, c + 1, c]]);
        }
    }
    surface(points, &triangles)
}

pub fn torus(big: f64, small: f64) -> Surface {
    let (n, m) = (60, 30);
    let mut points = Vec::new();
    for j in 0..m {
        for i in 0..n {
            let (u, v) = (TAU * i as f64 / n as f64, TAU * j as f64 / m as f64);
            points.push(DVec3::new(
                (big + small * v.cos()) * u.cos(),
                (big + small * v.cos()) * u.sin(),
                small * v.sin(),
            ));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..m {
        for i in 0..n {
            let at = |i: usize, j: usize| (j % m) * n + i % n;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    surface(points, &triangles)
}

pub fn sphere(radius: f64) -> Surface {
    let (n, m) = (60, 40);
    let mut points = vec![DVec3::new(0.0, 0.0, -radius)];
    for j in 1..m {
        for i in 0..n {
            let tilt = PI * j as f64 / m as f64;
            points.push(round(radius * tilt.sin(), i as f64 / n as f64, -radius * tilt.cos()));
        }
    }
    points.push(DVec3::new(0.0, 0.0, radius));
    let at = |i: usize, j: usize| 1 + (j - 1) * n + i % n;
    let mut triangles = Vec::new();
    for i in 0..n {
        triangles.push([0, at(i + 1, 1), at(i, 1)]);
        triangles.push([points.len() - 1, at(i, m - 1), at(i + 1, m - 1)]);
        for j in 1..m - 1 {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    surface(points, &triangles)
}
