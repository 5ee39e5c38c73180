//! A triangle mesh as the tests see it, and how a rectangle or disk is triangulated.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use wovenfit_core::surface::RawMesh;

use crate::random::Random;

/// Points and triangles, counter-clockwise seen from outside; lengths in mm unless said.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// The points.
    pub points: Vec<DVec3>,
    /// The corners of each triangle.
    pub triangles: Vec<[usize; 3]>,
}

/// How a fixture is cut into triangles; results must not depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Triangulation {
    /// A regular grid with parallel diagonals: the easiest and the most biased.
    Structured,
    /// A regular grid with diagonals that change from cell to cell: no preferred direction.
    Alternating,
    /// Interior points moved at random on the surface, the shorter diagonal taken, vertices and
    /// triangles in random order.
    Jittered(u64),
}

impl Triangulation {
    /// One of each.
    pub const ALL: [Self; 3] = [Self::Structured, Self::Alternating, Self::Jittered(1)];
}

impl Mesh {
    /// The mesh as the core takes it.
    #[must_use]
    pub fn raw(&self) -> RawMesh {
        RawMesh::from_triangles(self.points.clone(), &self.triangles)
    }

    /// The same mesh with every coordinate multiplied: mm to another unit.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { points: self.points.iter().map(|p| factor * *p).collect(), ..self.clone() }
    }

    /// The same mesh with every triangle turned over.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let triangles = self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        Self { triangles, ..self.clone() }
    }

    /// The same vertices with the other diagonal in as many pairs of neighbours as there are, the longest edges first;
    /// none that would leave an angle under 20 degrees.
    #[must_use]
    pub fn with_flipped_diagonals(&self) -> Self {
        const LEAST_ANGLE: f64 = 0.35;
        let mut sides: BTreeMap<[usize; 2], Vec<[usize; 4]>> = BTreeMap::new();
        for (t, &[a, b, c]) in self.triangles.iter().enumerate() {
            for [a, b, c] in [[a, b, c], [b, c, a], [c, a, b]] {
                sides.entry([a.min(b), a.max(b)]).or_default().push([t, a, b, c]);
            }
        }
        let mut edges: BTreeSet<[usize; 2]> = sides.keys().copied().collect();
        let mut order: Vec<[usize; 2]> = sides.keys().copied().collect();
        let length = |[a, b]: [usize; 2]| self.points[a].distance(self.points[b]);
        order.sort_by(|&a, &b| length(b).total_cmp(&length(a)));
        let least_angle = |corners: [usize; 3]| {
            let p = corners.map(|v| self.points[v]);
            let angle = |k: usize| (p[(k + 1) % 3] - p[k]).angle_between(p[(k + 2) % 3] - p[k]);
            (0..3).map(angle).fold(f64::INFINITY, f64::min)
        };
        let mut triangles = self.triangles.clone();
        let mut used = vec![false; triangles.len()];
        for edge in order {
            let [[t, a, b, c], [s, _, _, d]] = sides[&edge][..] else { continue };
            let others = [[a, d, c], [d, b, c]];
            let good = others.into_iter().all(|corners| least_angle(corners) >= LEAST_ANGLE);
            if !used[t] && !used[s] && good && edges.insert([c.min(d), c.max(d)]) {
                (used[t], used[s]) = (true, true);
                [triangles[t], triangles[s]] = others;
            }
        }
        Self { triangles, ..self.clone() }
    }

    /// The same surface with one more vertex in every triangle of so many, `height` beside the middle of its first
    /// edge: a sliver each, as marching cubes leave.
    #[must_use]
    pub fn with_slivers(&self, every: usize, height: f64) -> Self {
        let mut mesh = Self { points: self.points.clone(), triangles: Vec::new() };
        for (t, &[a, b, c]) in self.triangles.iter().enumerate() {
            if t % every != 0 {
                mesh.triangles.push([a, b, c]);
                continue;
            }
            let [p, q, r] = [a, b, c].map(|v| self.points[v]);
            let middle = p.midpoint(q);
            let inward = (r - middle).reject_from(q - p).normalize_or_zero();
            let v = mesh.points.len();
            mesh.points.push(middle + height * inward);
            mesh.triangles.extend([[a, b, v], [b, c, v], [c, a, v]]);
        }
        mesh
    }

    /// Both meshes side by side in one, sharing nothing.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let mut both = self.clone();
        both.points.extend(&other.points);
        let shift = self.points.len();
        both.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + shift)));
        both
    }

    /// The same mesh moved by a vector.
    #[must_use]
    pub fn translated(&self, by: DVec3) -> Self {
        Self { points: self.points.iter().map(|p| *p + by).collect(), ..self.clone() }
    }

    /// Area, in mm².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.corners().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    /// The corners of every triangle.
    pub fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|v| self.points[v]))
    }

    /// The edges that belong to one triangle only, as that triangle runs along them.
    #[must_use]
    pub fn boundary_edges(&self) -> Vec<[usize; 2]> {
        boundary_edges(&self.triangles)
    }

    /// The closed loops of boundary edges.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<Vec<usize>> {
        boundary_loops(&self.triangles)
    }

    /// Vertices and triangles put in random order.
    #[must_use]
    pub fn shuffled(&self, random: &mut Random) -> Self {
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        random.shuffle(&mut order);
        let mut place = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        let mut triangles: Vec<[usize; 3]> = self
            .triangles
            .iter()
            .map(|t| {
                let turn = random.below(3);
                std::array::from_fn(|k| place[t[(k + turn) % 3]])
            })
            .collect();
        random.shuffle(&mut triangles);
        Self { points: order.iter().map(|&old| self.points[old]).collect(), triangles }
    }
}

/// The edges that belong to one triangle only, as that triangle runs along them, in order.
#[must_use]
pub fn boundary_edges(triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let mut edges: Vec<[usize; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    edges.sort_unstable();
    edges.iter().copied().filter(|&[a, b]| edges.binary_search(&[b, a]).is_err()).collect()
}

/// The closed loops of boundary edges, each from its lowest vertex.
///
/// # Panics
/// If the boundary branches or does not close.
#[must_use]
pub fn boundary_loops(triangles: &[[usize; 3]]) -> Vec<Vec<usize>> {
    let edges = boundary_edges(triangles);
    let mut used = vec![false; edges.len()];
    let mut loops = Vec::new();
    for first in 0..edges.len() {
        let mut around = Vec::new();
        let mut at = first;
        while !used[at] {
            used[at] = true;
            around.push(edges[at][0]);
            let to = edges[at][1];
            at = edges.partition_point(|e| e[0] < to);
            assert!(at < edges.len() && edges[at][0] == to, "the boundary stops at vertex {to}");
            assert!(edges.get(at + 1).is_none_or(|e| e[0] != to), "it branches at vertex {to}");
        }
        if !around.is_empty() {
            loops.push(around);
        }
    }
    loops
}

/// A rectangle of `columns` × `rows` cells, u and v from 0 to 1, carried into space by `map`;
/// with `closed` the side u = 1 is the side u = 0. ∂map/∂u × ∂map/∂v faces outward.
#[must_use]
pub fn grid(
    columns: usize,
    rows: usize,
    closed: bool,
    triangulation: Triangulation,
    map: impl Fn(f64, f64) -> DVec3,
) -> Mesh {
    let width = if closed { columns } else { columns + 1 };
    let mut random = match triangulation {
        Triangulation::Jittered(seed) => Some(Random::new(seed)),
        _ => None,
    };
    let mut points = Vec::with_capacity(width * (rows + 1));
    for j in 0..=rows {
        for i in 0..width {
            let (mut u, mut v) = (i as f64, j as f64);
            let inner = j > 0 && j < rows && (closed || (i > 0 && i < columns));
            if let (Some(random), true) = (&mut random, inner) {
                // By at most a fifth of a cell every cell stays convex.
                u += 0.2 * random.signed();
                v += 0.2 * random.signed();
            }
            points.push(map(u / columns as f64, v / rows as f64));
        }
    }
    let mut triangles = Vec::with_capacity(2 * columns * rows);
    for j in 0..rows {
        for i in 0..columns {
            let right = (i + 1) % width;
            let [a, b, c, d] =
                [j * width + i, j * width + right, (j + 1) * width + right, (j + 1) * width + i];
            let rising = match triangulation {
                Triangulation::Structured => true,
                Triangulation::Alternating => (i + j) % 2 == 0,
                Triangulation::Jittered(_) => {
                    points[a].distance(points[c]) < points[b].distance(points[d])
                }
            };
            if rising {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    let mesh = Mesh { points, triangles };
    match &mut random {
        Some(random) => mesh.shuffled(random),
        None => mesh,
    }
}

/// A disk of `rings` rings round a middle, carried into space by `map(radius, angle)` with the
/// radius from 0 to 1; ring k has 6 k points. ∂map/∂radius × ∂map/∂angle faces outward.
#[must_use]
pub fn disk(rings: usize, triangulation: Triangulation, map: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let mut random = match triangulation {
        Triangulation::Jittered(seed) => Some(Random::new(seed)),
        _ => None,
    };
    let mut points = vec![map(0.0, 0.0)];
    let mut angles = vec![vec![0.0]];
    for k in 1..=rings {
        let count = 6 * k;
        // Every other ring turned by half a step changes who is joined to whom.
        let turn =
            if triangulation == Triangulation::Alternating && k % 2 == 1 { 0.5 } else { 0.0 };
        let mut ring = Vec::with_capacity(count);
        for i in 0..count {
            let (mut radius, mut step) = (k as f64, i as f64 + turn);
            if let (Some(random), true) = (&mut random, k < rings) {
                radius += 0.2 * random.signed();
                step += 0.2 * random.signed();
            }
            let angle = std::f64::consts::TAU * step / count as f64;
            points.push(map(radius / rings as f64, angle));
            ring.push(angle);
        }
        angles.push(ring);
    }
    let mut triangles: Vec<[usize; 3]> = (0..6).map(|i| [0, 1 + i, 1 + (i + 1) % 6]).collect();
    let mut inner = 1;
    for k in 2..=rings {
        let (n, m) = (angles[k - 1].len(), angles[k].len());
        let outer = inner + n;
        let full = |ring: &[f64], i: usize| {
            ring[i % ring.len()] + std::f64::consts::TAU * (i / ring.len()) as f64
        };
        let (mut i, mut o) = (0, 0);
        while i < n || o < m {
            let (a, b) = (inner + i % n, outer + o % m);
            // Whichever next point comes first round the middle.
            if i == n || (o < m && full(&angles[k], o + 1) <= full(&angles[k - 1], i + 1)) {
                o += 1;
                triangles.push([a, b, outer + o % m]);
            } else {
                i += 1;
                triangles.push([a, b, inner + i % n]);
            }
        }
        inner = outer;
    }
    let mesh = Mesh { points, triangles };
    match &mut random {
        Some(random) => mesh.shuffled(random),
        None => mesh,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn euler(mesh: &Mesh) -> i64 {
        let edges = (3 * mesh.triangles.len() + mesh.boundary_edges().len()) / 2;
        mesh.points.len() as i64 - edges as i64 + mesh.triangles.len() as i64
    }

    #[test]
    fn every_triangulation_covers_the_same_square_once() {
        for triangulation in Triangulation::ALL {
            let mesh = grid(7, 5, false, triangulation, |u, v| DVec3::new(u, v, 0.0));
            assert_eq!(mesh.triangles.len(), 70);
            assert_eq!((euler(&mesh), mesh.boundary_loops().len()), (1, 1));
            assert!(mesh.corners().all(|[a, b, c]| (b - a).cross(c - a).z > 0.0));
            assert!((mesh.area() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn every_triangulation_covers_the_same_disk_once() {
        for triangulation in Triangulation::ALL {
            let mesh = disk(6, triangulation, |r, a| DVec3::new(r * a.cos(), r * a.sin(), 0.0));
            assert_eq!(mesh.triangles.len(), 6 * 36);
            assert_eq!((euler(&mesh), mesh.boundary_loops().len()), (1, 1));
            assert!(mesh.corners().all(|[a, b, c]| (b - a).cross(c - a).z > 0.0));
            // The rim is a polygon of 36 sides.
            let polygon = 18.0 * (std::f64::consts::TAU / 36.0).sin();
            assert!((mesh.area() - polygon).abs() < 1e-12);
        }
    }

    #[test]
    fn a_closed_grid_is_a_tube() {
        let tau = std::f64::consts::TAU;
        let map = |u: f64, v: f64| DVec3::new((tau * u).cos(), (tau * u).sin(), v);
        for triangulation in Triangulation::ALL {
            let mesh = grid(8, 3, true, triangulation, map);
            assert_eq!((euler(&mesh), mesh.boundary_loops().len()), (0, 2));
            let outward = |[a, b, c]: [DVec3; 3]| {
                (b - a).cross(c - a).dot((a + b + c) * DVec3::new(1.0, 1.0, 0.0)) > 0.0
            };
            assert!(mesh.corners().all(outward));
        }
    }
}
