//! A limb as a smooth open tube round a bent centre line, and its triangulation.
//!
//! Sections stand perpendicular to the centre line. In the mesh rows stand at equal stations,
//! every other one turned by half a column, so that triangles are nearly equilateral where rows
//! are √3/2 of a column apart; in a bend they are squeezed on the inner and stretched on the
//! outer side. Any number of triangles samples the same surface.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::noise::Noise;
use super::opening::Opening;
use crate::surface::RawMesh;

/// A limb as a smooth open tube. Station 0 is the end near the body; there the limb points down
/// (−z), the front is +x and the outer (lateral) side +y: all are left limbs. Angle 0 is the
/// front, π/2 the outer side.
pub(super) trait Limb: Sync {
    /// Length of the centre line, in mm: stations run from 0 to this.
    fn length(&self) -> f64;

    /// The station at the origin of coordinates, in mm: the joint.
    fn origin(&self) -> f64;

    /// How far the centre line has turned until a station, in radians: toward the front, and
    /// toward the outer side.
    fn turned(&self, station: f64) -> DVec2;

    /// Where the skin is from the centre line, in mm, in the directions front, outer side and
    /// along. Seen along increasing stations the angle turns counter-clockwise, so that
    /// ∂/∂station × ∂/∂angle faces outward.
    fn section(&self, station: f64, angle: f64) -> DVec3;

    /// The opening that can be cut into the limb, if there is a place for one.
    fn opening(&self) -> Option<Opening> {
        None
    }

    /// The centre line at a station.
    fn frame(&self, station: f64) -> Frame {
        // The integral of its direction from the origin, by Simpson's rule in 64 steps of a few
        // mm (error under 1e-6 mm).
        let steps = 64;
        let step = (station - self.origin()) / f64::from(steps);
        let sum: DVec3 = (0..=steps)
            .map(|k| {
                let weight = match k {
                    0 => 1.0,
                    k if k == steps => 1.0,
                    k if k % 2 == 1 => 4.0,
                    _ => 2.0,
                };
                weight * along(self.turned(self.origin() + f64::from(k) * step))
            })
            .sum();
        let turned = self.turned(station);
        let front = DVec3::new(turned.x.cos(), 0.0, turned.x.sin());
        let along = along(turned);
        Frame { centre: sum * step / 3.0, front, outer: front.cross(along), along }
    }

    /// The point at a station and an angle, in mm.
    fn point(&self, station: f64, angle: f64) -> DVec3 {
        self.frame(station).place(self.section(station, angle))
    }

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
        let frame = self.frame(station);
        let at = |k: usize| frame.place(self.section(station, TAU * k as f64 / sides as f64));
        (0..sides).map(|k| at(k).distance(at(k + 1))).sum()
    }
}

/// The direction of a centre line that has turned by these angles.
fn along(turned: DVec2) -> DVec3 {
    let (sin_f, cos_f) = turned.x.sin_cos();
    let (sin_o, cos_o) = turned.y.sin_cos();
    DVec3::new(sin_f * cos_o, sin_o, -cos_f * cos_o)
}

/// A place on the centre line with its unit directions, perpendicular to each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    /// The point of the centre line, in mm.
    pub(super) centre: DVec3,
    /// Toward the front.
    pub(super) front: DVec3,
    /// Toward the outer side.
    pub(super) outer: DVec3,
    /// Along the limb, away from the body.
    pub(super) along: DVec3,
}

impl Frame {
    /// The point with these coordinates (front, outer side, along) from here.
    pub(super) fn place(&self, from_centre: DVec3) -> DVec3 {
        self.centre
            + from_centre.x * self.front
            + from_centre.y * self.outer
            + from_centre.z * self.along
    }
}

/// Samples the limb with near `triangles` triangles, each vertex moved along the normal by
/// Gaussian noise of deviation `noise_mm`.
pub(super) fn triangulate(
    limb: &dyn Limb,
    triangles: usize,
    noise_mm: f64,
    opening: Option<Opening>,
) -> RawMesh {
    let (rows, columns) = grid(limb, triangles);
    let mut places = Vec::with_capacity((rows + 1) * columns);
    for row in 0..=rows {
        let station = limb.length() * row as f64 / rows as f64;
        let turn = if row % 2 == 1 { PI / columns as f64 } else { 0.0 };
        places.extend(
            (0..columns)
                .map(|column| DVec2::new(station, TAU * column as f64 / columns as f64 + turn)),
        );
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
    if let Some(opening) = opening {
        opening.cut(&mut places, &mut faces);
    }
    let mut noise = Noise::new(SEED);
    let point = |place: &DVec2| {
        let point = limb.point(place.x, place.y);
        if noise_mm > 0.0 {
            point + noise_mm * noise.gaussian() * limb.normal(place.x, place.y)
        } else {
            point
        }
    };
    RawMesh::from_triangles(places.iter().map(point).collect(), &faces)
}

/// Any number does; a fixed one makes the same noise every time.
const SEED: u64 = 45;

/// Numbers of rows and columns: equilateral triangles of edge h on a tube of length L and mean
/// girth G are 4 L G / (√3 h²) in number.
fn grid(limb: &dyn Limb, triangles: usize) -> (usize, usize) {
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
