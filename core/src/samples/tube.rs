//! Triangulates a limb that is given as a smooth map from (station, angle) to space.
//!
//! Rows stand at equal stations, every other one turned by half a column, so that triangles are
//! nearly equilateral where rows are √3/2 of a column apart; in a bend they are squeezed on the
//! inner and stretched on the outer side. Any number of triangles samples the same surface.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::noise::Noise;
use crate::surface::RawMesh;

/// A limb as a smooth open tube.
pub(super) trait Limb {
    /// Length of the centre line, in mm: stations run from 0 (near the body) to this.
    fn length(&self) -> f64;

    /// The point at a station (mm) and an angle round the limb (radians), in mm. Seen along
    /// increasing stations the angle turns counter-clockwise, so that ∂/∂station × ∂/∂angle
    /// faces outward.
    fn point(&self, station: f64, angle: f64) -> DVec3;

    /// Outward unit normal, by central differences: at steps of 1e-4 mm and 1e-4 rad both
    /// truncation and rounding stay under 1e-8.
    fn normal(&self, station: f64, angle: f64) -> DVec3 {
        let step = 1e-4;
        let along = self.point(station + step, angle) - self.point(station - step, angle);
        let round = self.point(station, angle + step) - self.point(station, angle - step);
        along.cross(round).normalize()
    }

    /// Girth at a station, in mm: a polygon of 720 sides, short by less than 1e-4.
    fn girth(&self, station: f64) -> f64 {
        let sides = 720;
        let at = |k: usize| self.point(station, TAU * k as f64 / sides as f64);
        (0..sides).map(|k| at(k).distance(at(k + 1))).sum()
    }
}

/// Samples the limb with near `triangles` triangles, each vertex moved along the normal by
/// Gaussian noise of deviation `noise_mm`.
pub(super) fn triangulate(limb: &impl Limb, triangles: usize, noise_mm: f64) -> RawMesh {
    let (rows, columns) = grid(limb, triangles);
    let mut noise = Noise::new(SEED);
    let mut points = Vec::with_capacity((rows + 1) * columns);
    for row in 0..=rows {
        let station = limb.length() * row as f64 / rows as f64;
        let turn = if row % 2 == 1 { PI / columns as f64 } else { 0.0 };
        for column in 0..columns {
            let angle = TAU * column as f64 / columns as f64 + turn;
            let mut point = limb.point(station, angle);
            if noise_mm > 0.0 {
                point += noise_mm * noise.gaussian() * limb.normal(station, angle);
            }
            points.push(point);
        }
    }
    let mut faces = Vec::with_capacity(2 * rows * columns);
    for row in 0..rows {
        let at = |r: usize, column: usize| (row + r) * columns + column % columns;
        for c in 0..columns {
            if row % 2 == 0 {
                faces.push([at(0, c), at(1, c), at(0, c + 1)]);
                faces.push([at(0, c + 1), at(1, c), at(1, c + 1)]);
            } else {
                faces.push([at(0, c), at(1, c), at(1, c + 1)]);
                faces.push([at(0, c), at(1, c + 1), at(0, c + 1)]);
            }
        }
    }
    RawMesh::from_triangles(points, &faces)
}

/// Any number does; a fixed one makes the same noise every time.
const SEED: u64 = 45;

/// Numbers of rows and columns: equilateral triangles of edge h on a tube of length L and mean
/// girth G are 4 L G / (√3 h²) in number.
fn grid(limb: &impl Limb, triangles: usize) -> (usize, usize) {
    let stations = 32;
    let girth = (0..stations)
        .map(|k| limb.girth(limb.length() * (k as f64 + 0.5) / f64::from(stations)))
        .sum::<f64>()
        / f64::from(stations);
    let edge = (4.0 * limb.length() * girth / (3f64.sqrt() * triangles as f64)).sqrt();
    let columns = ((girth / edge).round() as usize).max(3);
    let rows = ((triangles as f64 / (2 * columns) as f64).round() as usize).max(1);
    (rows, columns)
}
