//! A preview of a sheet as a PNG: to look at, not to cut from.

use glam::DVec2;

use super::hpgl::lines_of;
use crate::sheet::{Layer, Sheet};

/// Pixels per millimetre, unless the picture would be too large.
const DENSITY: f64 = 5.0;

/// The longest side, in pixels.
const LONGEST: f64 = 4000.0;

/// Width of lines, in mm.
const LINE: f64 = 0.35;

/// A sheet as a PNG; its physical size is stated in it.
#[must_use]
pub fn pattern_png(sheet: &Sheet<'_>) -> Vec<u8> {
    let density = DENSITY.min(LONGEST / sheet.size.max_element());
    let size = (density * sheet.size).ceil();
    let (width, height) = (size.x as usize, size.y as usize);
    let mut canvas = Canvas { width, height, pixels: vec![255; 3 * width * height] };
    for layer in Layer::ALL {
        let dash = (layer == Layer::Sew).then_some(4.0 * density);
        for item in sheet.all().filter(|item| item.layer == layer) {
            for line in lines_of(&item.shape) {
                let place = |p: DVec2| density * DVec2::new(p.x, sheet.size.y - p.y);
                let points: Vec<DVec2> = line.into_iter().map(place).collect();
                canvas.line(&points, LINE * density, dash, layer.colour());
            }
        }
    }
    encoded(&canvas, density)
}

struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
}

impl Canvas {
    /// A line through points in pixels, `dash` on and off.
    fn line(&mut self, points: &[DVec2], width: f64, dash: Option<f64>, colour: [u8; 3]) {
        let mut run = 0.0;
        for pair in points.windows(2) {
            let length = pair[0].distance(pair[1]);
            let Some(way) = (pair[1] - pair[0]).try_normalize() else { continue };
            let mut from = 0.0;
            while from < length {
                let (drawn, next) = match dash {
                    None => (true, length),
                    Some(dash) => {
                        let phase = ((run + from) / dash + 1e-9).floor();
                        (phase % 2.0 == 0.0, ((phase + 1.0) * dash - run).min(length))
                    }
                };
                let next = next.max(from + 1e-6);
                if drawn {
                    self.segment(pair[0] + from * way, pair[0] + next * way, width, colour);
                }
                from = next;
            }
            run += length;
        }
    }

    /// A segment with round ends: each pixel is covered by how near it is.
    fn segment(&mut self, a: DVec2, b: DVec2, width: f64, colour: [u8; 3]) {
        let reach = 0.5 * width + 1.0;
        let low = (a.min(b) - reach).max(DVec2::ZERO);
        let high = (a.max(b) + reach).min(DVec2::new(self.width as f64, self.height as f64));
        let along = b - a;
        for y in low.y as usize..(high.y.ceil().max(0.0) as usize).min(self.height) {
            for x in low.x as usize..(high.x.ceil().max(0.0) as usize).min(self.width) {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let part = ((p - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
                let cover = (0.5 * width + 0.5 - p.distance(a + part * along)).clamp(0.0, 1.0);
                for (k, ink) in colour.into_iter().enumerate() {
                    let pixel = &mut self.pixels[3 * (y * self.width + x) + k];
                    // Two pieces of a line that meet do not make its joint darker.
                    let mixed = f64::from(*pixel) + cover * (f64::from(ink) - f64::from(*pixel));
                    *pixel = mixed.round() as u8;
                }
            }
        }
    }
}

fn encoded(canvas: &Canvas, density: f64) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, canvas.width as u32, canvas.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let per_metre = (1000.0 * density).round() as u32;
    let unit = png::Unit::Meter;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit }));
    // Into memory, of a size that fits: it cannot fail.
    if let Ok(mut writer) = encoder.write_header() {
        let _ = writer.write_image_data(&canvas.pixels);
    }
    bytes
}
