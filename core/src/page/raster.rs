//! Which triangle is seen in which pixel: a depth buffer.
//!
//! Orthographic, one sample in the middle of a pixel, nearest wins and of equals the first: the
//! same bytes on any machine that rounds as IEEE 754 says. Limit: no smoothing of edges; pictures
//! are made finer than they are shown.

use glam::{DVec2, DVec3};

use crate::surface::{Surface, TriangleId};

/// No triangle.
const NOTHING: u32 = u32::MAX;

/// A view of points in space: pixels right and down, depth towards the viewer in mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    /// Unit direction that is right in the picture.
    pub(super) right: DVec3,
    /// Unit direction that is up in the picture.
    pub(super) up: DVec3,
    /// Unit direction towards the viewer.
    pub(super) viewer: DVec3,
    /// What is in the middle of the picture.
    pub(super) centre: DVec3,
    /// Pixels in a mm.
    pub(super) scale: f64,
    /// Width and height of the picture in pixels.
    pub(super) size: [usize; 2],
}

impl Camera {
    /// The pixel place of a point.
    pub(super) fn pixel(&self, p: DVec3) -> DVec2 {
        let d = self.scale * (p - self.centre);
        let middle = DVec2::new(self.size[0] as f64, self.size[1] as f64) / 2.0;
        middle + DVec2::new(d.dot(self.right), -d.dot(self.up))
    }

    /// How far a point is towards the viewer, in mm.
    pub(super) fn depth(&self, p: DVec3) -> f64 {
        (p - self.centre).dot(self.viewer)
    }
}

/// A triangle seen in a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seen {
    /// The triangle.
    pub(super) triangle: TriangleId,
    /// Barycentric coordinates of the place in it.
    pub(super) weights: [f64; 3],
    /// How far it is towards the viewer, in mm.
    pub(super) depth: f64,
    /// Whether its outside is seen.
    pub(super) outside: bool,
}

/// What is seen in every pixel.
#[derive(Debug, Clone)]
pub(super) struct Raster {
    /// Width in pixels.
    pub(super) width: usize,
    /// Height in pixels.
    pub(super) height: usize,
    pixels: Vec<Pixel>,
}

/// What is nearest in a pixel.
#[derive(Debug, Clone, Copy)]
struct Pixel {
    triangle: u32,
    /// Barycentric coordinates of the first two corners.
    weights: [f32; 2],
    depth: f32,
    outside: bool,
}

/// A pixel in which there is nothing yet.
const EMPTY: Pixel =
    Pixel { triangle: NOTHING, weights: [0.0; 2], depth: f32::NEG_INFINITY, outside: false };

impl Raster {
    /// What a camera sees of a surface whose vertices are at `points`.
    pub(super) fn new(surface: &Surface, points: &[DVec3], camera: &Camera) -> Self {
        let [width, height] = camera.size;
        let mut raster = Self { width, height, pixels: vec![EMPTY; width * height] };
        let places: Vec<DVec2> = points.iter().map(|&p| camera.pixel(p)).collect();
        let depths: Vec<f64> = points.iter().map(|&p| camera.depth(p)).collect();
        for t in surface.triangle_ids() {
            let corners = surface.triangle(t).map(|v| v.index());
            raster.draw(t, corners.map(|v| places[v]), corners.map(|v| depths[v]));
        }
        raster
    }

    fn draw(&mut self, t: TriangleId, [a, b, c]: [DVec2; 3], depths: [f64; 3]) {
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let range = |low: f64, high: f64, size: usize| {
            // Pixels whose middle may lie inside; a cast rounds down, and to zero what is below it.
            let before = (low - 0.5) as usize;
            let first = before + usize::from((before as f64) < low - 0.5);
            first..((high + 0.5) as usize).min(size)
        };
        let sides = [c - b, a - c, b - a].map(|side| area.signum() * side);
        let share = 1.0 / area.abs();
        let columns = range(low.x, high.x, self.width);
        for y in range(low.y, high.y, self.height) {
            for x in columns.clone() {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let parts =
                    [sides[0].perp_dot(p - b), sides[1].perp_dot(p - c), sides[2].perp_dot(p - a)];
                if parts.iter().any(|&part| part < 0.0) {
                    continue;
                }
                let weights = parts.map(|part| share * part);
                let depth = (0..3).map(|k| weights[k] * depths[k]).sum::<f64>() as f32;
                let pixel = &mut self.pixels[y * self.width + x];
                if depth > pixel.depth {
                    *pixel = Pixel {
                        triangle: t.index() as u32,
                        weights: [weights[0] as f32, weights[1] as f32],
                        depth,
                        // Pixels count downward, which mirrors the sense of turning.
                        outside: area < 0.0,
                    };
                }
            }
        }
    }

    /// How far what is seen in a pixel is towards the viewer, in mm.
    pub(super) fn depth(&self, pixel: usize) -> f64 {
        f64::from(self.pixels[pixel].depth)
    }

    /// What is seen in a pixel.
    pub(super) fn seen(&self, pixel: usize) -> Option<Seen> {
        let Pixel { triangle, weights, depth, outside } = self.pixels[pixel];
        (triangle != NOTHING).then(|| {
            let [a, b] = weights.map(f64::from);
            Seen {
                triangle: TriangleId::new(triangle as usize),
                weights: [a, b, 1.0 - a - b],
                depth: f64::from(depth),
                outside,
            }
        })
    }

    /// Whether a point on the surface is seen: nothing lies more than `slack` mm before it in any
    /// of the pixels about it that show something.
    pub(super) fn shows(&self, camera: &Camera, p: DVec3, slack: f64) -> bool {
        let (place, depth) = (camera.pixel(p), camera.depth(p));
        let (x, y) = (place.x.floor() as i64, place.y.floor() as i64);
        let about = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
        let mut nearest = f64::INFINITY;
        for (x, y) in about {
            let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { continue };
            if x < self.width && y < self.height {
                let seen = self.depth(y * self.width + x);
                if seen.is_finite() {
                    nearest = nearest.min(seen);
                }
            }
        }
        nearest <= depth + slack
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::VertexId;

    /// Two unit squares facing +z, at z = 0 and, the left half only, at z = 1.
    fn two() -> Surface {
        let square = |x: f64, z: f64| {
            [(0.0, 0.0), (x, 0.0), (x, 1.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z))
        };
        let points = [square(1.0, 0.0), square(0.5, 1.0)].concat();
        let id = VertexId::new;
        let triangles = [0, 4]
            .into_iter()
            .flat_map(|k| [[id(k), id(k + 1), id(k + 2)], [id(k), id(k + 2), id(k + 3)]])
            .collect();
        Surface::new(points, triangles).unwrap()
    }

    fn camera(viewer: DVec3) -> Camera {
        let up = DVec3::Y;
        Camera {
            right: up.cross(viewer),
            up,
            viewer,
            centre: DVec3::new(0.5, 0.5, 0.5),
            scale: 10.0,
            size: [12, 12],
        }
    }

    #[test]
    fn the_nearer_square_hides_the_other_and_all_pixels_are_covered_once() {
        let surface = two();
        let front = camera(DVec3::Z);
        let raster = Raster::new(&surface, surface.points(), &front);
        let seen: Vec<Seen> = (0..144).filter_map(|p| raster.seen(p)).collect();
        assert_eq!(seen.len(), 100);
        assert_eq!(seen.iter().filter(|s| s.depth > 0.0).count(), 50);
        assert!(seen.iter().all(|s| s.outside));
        assert!(raster.shows(&front, DVec3::new(0.75, 0.5, 0.0), 0.1));
        assert!(!raster.shows(&front, DVec3::new(0.25, 0.5, 0.0), 0.1));
        assert!(raster.shows(&front, DVec3::new(0.25, 0.5, 1.0), 0.1));
        // Pixel (1, 1) is the upper left corner of the nearer square.
        let corner = raster.seen(12 + 1).unwrap();
        let place: f64 =
            (0..3).map(|k| corner.weights[k] * surface.corners(corner.triangle)[k].y).sum();
        assert!((place - 0.95).abs() < 1e-6, "{place}");
    }

    #[test]
    fn from_behind_the_inside_is_seen() {
        let surface = two();
        let raster = Raster::new(&surface, surface.points(), &camera(DVec3::NEG_Z));
        let seen: Vec<Seen> = (0..144).filter_map(|p| raster.seen(p)).collect();
        assert_eq!(seen.len(), 100);
        assert!(seen.iter().all(|s| !s.outside && (s.depth - 0.5).abs() < 1e-6));
    }
}
