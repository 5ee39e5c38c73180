//! Broken and awkward limbs, named after their defect. Lengths in mm.

use glam::DVec3;

use crate::fixtures::{sphere_cap, tube};
use crate::mesh::{Mesh, Triangulation, grid};
use crate::write;

/// The sound tube that most defects are made from: radius 40, length 90, facing outward.
#[must_use]
pub fn sound() -> Mesh {
    tube(40.0, 90.0, 24, Triangulation::Alternating).mesh
}

/// A point of triangle `t` of [`sound`] pulled into a fin: its first edge has three triangles.
#[must_use]
pub fn non_manifold_edge() -> Mesh {
    let mut mesh = sound();
    let [a, b, _] = mesh.triangles[100];
    let out = mesh.points[a] + mesh.points[b];
    mesh.points.push(out);
    mesh.triangles.push([b, a, mesh.points.len() - 1]);
    mesh
}

/// Two pieces of one tube that touch in a single vertex.
#[must_use]
pub fn non_manifold_vertex() -> Mesh {
    let mut mesh = sound();
    let tip = mesh.triangles[0][0];
    let p = mesh.points[tip];
    let first = mesh.points.len();
    mesh.points.extend([p + DVec3::new(9.0, 3.0, -8.0), p + DVec3::new(9.0, -3.0, -8.0)]);
    mesh.triangles.push([tip, first, first + 1]);
    mesh
}

/// One triangle of [`sound`] turned over: which one is wrong is plain, so it can be repaired.
#[must_use]
pub fn one_triangle_turned() -> Mesh {
    let mut mesh = sound();
    mesh.triangles[37].swap(0, 1);
    mesh
}

/// A Möbius band of limb size.
#[must_use]
pub fn moebius() -> Mesh {
    let columns = 40;
    let rows = 6;
    let point = |i: usize, j: usize| {
        let angle = std::f64::consts::TAU * i as f64 / columns as f64;
        let across = 40.0 * (j as f64 / rows as f64 - 0.5);
        let r = 60.0 + across * (0.5 * angle).cos();
        DVec3::new(r * angle.cos(), r * angle.sin(), across * (0.5 * angle).sin())
    };
    let mut mesh = grid(columns - 1, rows, false, Triangulation::Structured, |u, v| {
        point((u * (columns - 1) as f64).round() as usize, (v * rows as f64).round() as usize)
    });
    for j in 0..rows {
        // The last column meets the first one upside down.
        let last = |j: usize| j * columns + columns - 1;
        let first = |j: usize| (rows - j) * columns;
        mesh.triangles.push([last(j), first(j), first(j + 1)]);
        mesh.triangles.push([last(j), first(j + 1), last(j + 1)]);
    }
    mesh
}

/// [`sound`] with a triangle of no area: three vertices on a line.
#[must_use]
pub fn degenerate_triangle() -> Mesh {
    let mut mesh = sound();
    // The third corner is put on the opposite edge; its other triangles stay sound.
    let [a, b, c] = mesh.triangles[100];
    mesh.points[c] = 0.5 * (mesh.points[a] + mesh.points[b]);
    mesh
}

/// [`sound`] with one triangle listed twice.
#[must_use]
pub fn duplicate_triangle() -> Mesh {
    let mut mesh = sound();
    mesh.triangles.push(mesh.triangles[5]);
    mesh
}

/// [`sound`] with this number as one coordinate of vertex 10.
#[must_use]
pub fn bad_coordinate(value: f64) -> Mesh {
    let mut mesh = sound();
    mesh.points[10].y = value;
    mesh
}

/// [`sound`] and a crumb of scan beside it.
#[must_use]
pub fn two_components() -> Mesh {
    let crumb = tube(3.0, 4.0, 8, Triangulation::Structured).mesh;
    sound().with(&crumb.translated(DVec3::new(120.0, 0.0, 10.0)))
}

/// A closed ball.
#[must_use]
pub fn closed() -> Mesh {
    let half = sphere_cap(40.0, std::f64::consts::FRAC_PI_2, 8, Triangulation::Structured).mesh;
    let rings = 8;
    let rim = half.points.len() - 6 * rings;
    let mut mesh = half.clone();
    // The lower half is the upper one turned about the x-axis by half a turn; both share the rim.
    let mut place: Vec<usize> = Vec::new();
    for (i, p) in half.points.iter().enumerate() {
        if i < rim {
            place.push(mesh.points.len());
            mesh.points.push(DVec3::new(p.x, -p.y, -p.z));
        } else {
            place.push(rim + (6 * rings - (i - rim)) % (6 * rings));
        }
    }
    mesh.triangles.extend(half.triangles.iter().map(|t| t.map(|v| place[v])));
    mesh
}

/// A closed ring (a torus) with one triangle's worth of opening: a handle that one cut leaves.
#[must_use]
pub fn handle() -> Mesh {
    let (columns, rows) = (32, 12);
    let mut mesh = Mesh::default();
    for j in 0..rows {
        for i in 0..columns {
            let angle = std::f64::consts::TAU * i as f64 / columns as f64;
            let round = std::f64::consts::TAU * j as f64 / rows as f64;
            let r = 70.0 + 25.0 * round.cos();
            mesh.points.push(DVec3::new(r * angle.cos(), r * angle.sin(), 25.0 * round.sin()));
        }
    }
    let at = |i: usize, j: usize| (j % rows) * columns + i % columns;
    for j in 0..rows {
        for i in 0..columns {
            // An opening of 4 × 3 cells, longer round than what counts as a scan's hole.
            if i < 4 && j < 3 {
                continue;
            }
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    drop_unused(&mut mesh);
    mesh
}

/// [`sound`] with vertices that no triangle uses, far away.
#[must_use]
pub fn unused_vertices() -> Mesh {
    let mut mesh = sound();
    mesh.points.insert(7, DVec3::splat(5000.0));
    for t in &mut mesh.triangles {
        *t = t.map(|v| if v >= 7 { v + 1 } else { v });
    }
    mesh.points.push(DVec3::splat(-5000.0));
    mesh
}

/// [`sound`] with a small gap of the scanner: one vertex and its triangles are missing.
#[must_use]
pub fn small_hole() -> Mesh {
    let mut mesh = sound();
    let missing = mesh.triangles[100][0];
    mesh.triangles.retain(|t| !t.contains(&missing));
    drop_unused(&mut mesh);
    mesh
}

/// An OBJ file whose last triangle names a vertex that does not exist.
#[must_use]
pub fn index_out_of_range() -> Vec<u8> {
    let mut bytes = write::obj(&sound());
    bytes.extend(b"f 1 2 99999\n");
    bytes
}

fn drop_unused(mesh: &mut Mesh) {
    let mut place = vec![usize::MAX; mesh.points.len()];
    let mut points = Vec::new();
    for v in mesh.triangles.iter_mut().flatten() {
        if place[*v] == usize::MAX {
            place[*v] = points.len();
            points.push(mesh.points[*v]);
        }
        *v = place[*v];
    }
    mesh.points = points;
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// How many triangles each edge has, without direction.
    fn uses(mesh: &Mesh) -> BTreeMap<[usize; 2], usize> {
        let mut uses = BTreeMap::new();
        for &[a, b, c] in &mesh.triangles {
            for (p, q) in [(a, b), (b, c), (c, a)] {
                *uses.entry([p.min(q), p.max(q)]).or_default() += 1;
            }
        }
        uses
    }

    fn is_sound(mesh: &Mesh) -> bool {
        let euler =
            mesh.points.len() as i64 - uses(mesh).len() as i64 + mesh.triangles.len() as i64;
        uses(mesh).values().all(|&n| n <= 2) && euler == 0 && mesh.boundary_loops().len() == 2
    }

    #[test]
    fn each_broken_limb_has_its_defect_and_the_sound_one_none() {
        assert!(is_sound(&sound()));
        assert_eq!(uses(&non_manifold_edge()).values().filter(|&&n| n == 3).count(), 1);
        let touching = non_manifold_vertex();
        assert!(uses(&touching).values().all(|&n| n <= 2));
        let tip = touching.triangles.last().unwrap()[0];
        let ends = touching.boundary_edges().iter().filter(|e| e.contains(&tip)).count();
        assert_eq!(ends, 4, "two fans at one boundary vertex");
        let areas = |m: &Mesh| {
            m.corners().map(|[a, b, c]| (b - a).cross(c - a).length()).fold(f64::MAX, f64::min)
        };
        assert!(areas(&sound()) > 10.0 && areas(&degenerate_triangle()) < 1e-9);
        assert!(closed().boundary_edges().is_empty());
        assert!(closed().corners().all(|[a, b, c]| (b - a).cross(c - a).dot(a + b + c) > 0.0));
        let moebius = moebius();
        assert!(uses(&moebius).values().all(|&n| n <= 2));
        let twice = |m: &Mesh| {
            let mut seen = BTreeMap::new();
            for &[a, b, c] in &m.triangles {
                for edge in [[a, b], [b, c], [c, a]] {
                    *seen.entry(edge).or_insert(0) += 1;
                }
            }
            seen.values().filter(|&&n| n > 1).count()
        };
        assert_eq!(twice(&sound()), 0);
        assert!(twice(&moebius) > 0 && twice(&one_triangle_turned()) > 0);
        let holed = small_hole();
        assert_eq!(holed.boundary_loops().len(), 3);
        let handle = handle();
        let euler =
            handle.points.len() as i64 - uses(&handle).len() as i64 + handle.triangles.len() as i64;
        assert_eq!((euler, handle.boundary_loops().len()), (-1, 1), "one handle, one opening");
    }
}
