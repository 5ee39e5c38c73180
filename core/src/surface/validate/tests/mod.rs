//! Tubes 100 mm round, and what is wrong with them.

mod defects;
mod files;
mod mending;

use std::f64::consts::TAU;

use super::*;
use crate::surface::{DefectKind, Format, Shape, SurfaceError, read, shape_of};

const OPTIONS: SurfaceOptions = SurfaceOptions {
    unit: LengthUnit::Millimetre,
    keep_largest: false,
    close_holes: 0.0,
    facing: None,
};

/// A tube along z, 100 mm round and `10 rows` mm long, of `2 × 20 × rows` outward triangles;
/// triangle `2 (20 j + i)` and the next make the square in column `i` and row `j`.
fn tube(rows: usize) -> RawMesh {
    grid(20, rows, true)
}

/// The tube, closed round by sharing vertices or left with a cut at its first column.
fn grid(columns: usize, rows: usize, closed: bool) -> RawMesh {
    let stride = if closed { columns } else { columns + 1 };
    let radius = 100.0 / TAU;
    let points = (0..=rows).flat_map(|j| {
        (0..stride).map(move |i| {
            let angle = TAU * (i % columns) as f64 / columns as f64;
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 10.0 * j as f64)
        })
    });
    let mut triangles = Vec::new();
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let id = |i: usize, j: usize| i % stride + stride * j;
        let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        triangles.push([a, b, c]);
        triangles.push([a, c, d]);
    }
    RawMesh::from_triangles(points.collect(), &triangles)
}

fn reversed(mut raw: RawMesh) -> RawMesh {
    raw.polygons.iter_mut().for_each(|p| p.reverse());
    raw
}

/// Every triangle with points of its own.
fn soup(raw: &RawMesh) -> RawMesh {
    let points: Vec<DVec3> = raw.polygons.iter().flatten().map(|&v| raw.points[v]).collect();
    let polygons = (0..raw.polygons.len()).map(|t| vec![3 * t, 3 * t + 1, 3 * t + 2]).collect();
    RawMesh { points, polygons }
}

/// Both meshes in one, as separate pieces.
fn together(a: &RawMesh, b: &RawMesh) -> RawMesh {
    let mut all = a.clone();
    all.points.extend(&b.points);
    let shifted = |p: &Vec<usize>| p.iter().map(|v| v + a.points.len()).collect();
    all.polygons.extend(b.polygons.iter().map(shifted));
    all
}

fn moved(mut raw: RawMesh, by: DVec3) -> RawMesh {
    raw.points.iter_mut().for_each(|p| *p += by);
    raw
}

fn codes(valid: &Validated) -> Vec<&'static str> {
    valid.warnings.iter().map(|w| w.code).collect()
}

fn error(raw: &RawMesh) -> SurfaceError {
    validate(raw, &OPTIONS).unwrap_err()
}

/// The only defect's kind, message and place.
fn only(raw: &RawMesh) -> (DefectKind, String, Option<[f64; 3]>) {
    let error = error(raw);
    assert_eq!(error.defects().len(), 1, "{error}");
    let defect = &error.defects()[0];
    (defect.kind, defect.to_string(), defect.at)
}

/// Whether the surface encloses a positive volume when the ends of the tube are capped.
fn is_outward(surface: &Surface) -> bool {
    surface.triangle_ids().all(|t| {
        let [a, b, c] = surface.corners(t);
        let axial = (a + b + c) / 3.0;
        surface.normal(t).dot(DVec3::new(axial.x, axial.y, 0.0)) > 0.0
    })
}

fn tube_with_crumb() -> RawMesh {
    let crumb = RawMesh::from_triangles(
        vec![DVec3::new(60.0, 0.0, 0.0), DVec3::new(64.0, 0.0, 0.0), DVec3::new(60.0, 3.0, 2.0)],
        &[[0, 1, 2]],
    );
    together(&crumb, &tube(2))
}

fn square() -> RawMesh {
    let points = (0..9).map(|i| DVec3::new(10.0 * (i % 3) as f64, 10.0 * (i / 3) as f64, 0.0));
    let mut raw = RawMesh { points: points.collect(), polygons: Vec::new() };
    raw.polygons = [0, 1, 3, 4].map(|i| vec![i, i + 1, i + 4, i + 3]).to_vec();
    raw
}
