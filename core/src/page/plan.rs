//! The pattern, coloured by a quantity, with seams, orientation, asked points and values.
//!
//! Not to scale: `pattern.svg` is what is cut.

use glam::{DVec2, DVec3};

use super::PageInput;
use super::draw::{
    Anchor, INK, Labels, QUIET, circle, drawing, image, line, path, path_data, rimmed, text,
};
use super::html::shown;
use super::picture::data_address;
use super::quantity::Quantity;
use super::raster::{Camera, Raster};

/// Width of the drawing, in its units.
pub(super) const WIDTH: f64 = 500.0;
/// Largest height of the pattern.
const HEIGHT: f64 = 620.0;
/// Room on the left for the weft arrow, and below for the warp arrow.
const ARROWS: f64 = 34.0;
/// White round the pattern.
const MARGIN: f64 = 10.0;
/// Pixels in a unit.
const DENSITY: f64 = 2.0;
/// Size of lettering.
const SIZE: f64 = 15.0;
/// Distance of the values that are written on the pattern.
const VALUES: f64 = 62.0;
/// More points than this are drawn without labels.
const MOST_LABELS: usize = 40;

/// Where the pattern lies in a drawing.
pub(super) struct Frame {
    low: DVec2,
    high: DVec2,
    scale: f64,
    corner: DVec2,
    /// Size of the drawing.
    pub(super) size: DVec2,
}

impl Frame {
    /// Of a drawing of this width and at most this height of the pattern.
    pub(super) fn new(input: &PageInput<'_>, width: f64, height: f64) -> Self {
        let (low, high) = input.coordinates.iter().fold(
            (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY)),
            |(low, high), &p| (low.min(p), high.max(p)),
        );
        let extent = (high - low).max(DVec2::ONE);
        let room = width - ARROWS - 2.0 * MARGIN;
        let scale = (room / extent.x).min(height / extent.y);
        let left = ARROWS + MARGIN + 0.5 * (room - scale * extent.x);
        let corner = DVec2::new(left, MARGIN);
        let size = DVec2::new(width, scale * extent.y + ARROWS + 2.0 * MARGIN);
        Self { low, high, scale, corner, size }
    }

    /// Where a point of the pattern is in the drawing.
    pub(super) fn place(&self, p: DVec2) -> DVec2 {
        self.corner + self.scale * DVec2::new(p.x - self.low.x, self.high.y - p.y)
    }

    /// A closed outline, with cut-outs.
    pub(super) fn outline(&self, input: &PageInput<'_>) -> String {
        let loops = input.drawing.outline.iter().filter(|points| !points.is_empty());
        loops.map(|points| path_data(points.iter().map(|&p| self.place(p))) + "Z").collect()
    }
}

/// The pattern without colours, ready to be coloured.
pub(super) struct Plan<'a> {
    input: &'a PageInput<'a>,
    frame: Frame,
    camera: Camera,
    raster: Raster,
}

impl<'a> Plan<'a> {
    pub(super) fn new(input: &'a PageInput<'a>) -> Self {
        let frame = Frame::new(input, WIDTH, HEIGHT);
        let extent = frame.high - frame.low;
        let pixels = |mm: f64| (mm * frame.scale * DENSITY).ceil().max(1.0) as usize;
        let camera = Camera {
            right: DVec3::X,
            up: DVec3::Y,
            viewer: DVec3::Z,
            centre: (0.5 * (frame.low + frame.high)).extend(0.0),
            scale: frame.scale * DENSITY,
            size: [pixels(extent.x), pixels(extent.y)],
        };
        let flat: Vec<DVec3> = input.coordinates.iter().map(|p| p.extend(0.0)).collect();
        let raster = Raster::new(input.disk, &flat, &camera);
        Self { input, frame, camera, raster }
    }

    /// The pattern coloured by a quantity.
    pub(super) fn drawing(&self, quantity: &Quantity) -> svg::Document {
        let words = format!("The flat pattern, coloured by {}", quantity.name);
        let frame = &self.frame;
        let pixel = 1.0 / self.camera.scale;
        let address = data_address(self.input.disk, &self.raster, &quantity.field(), None, pixel);
        let pixels = DVec2::new(self.raster.width as f64, self.raster.height as f64);
        let middle = frame.place(0.5 * (frame.low + frame.high));
        let size = pixels / DENSITY;
        let mut all = drawing(frame.size.x, frame.size.y, &words)
            .add(image(middle - 0.5 * size, size, address))
            .add(path(frame.outline(self.input), INK, 1.4));
        for seam in &self.input.drawing.seams {
            for side in [&seam.left, &seam.right] {
                let data = path_data(side.iter().map(|&p| frame.place(p)));
                all = all
                    .add(path(data.clone(), "#ffffff", 4.4))
                    .add(path(data, INK, 2.2).set("stroke-dasharray", "7 5"));
            }
        }
        all = orientation(all, frame);
        let mut labels = Labels::new(frame.size);
        for marker in self.input.drawing.markers {
            let at = frame.place(marker);
            let corners = [(0.0, -6.0), (6.0, 0.0), (0.0, 6.0), (-6.0, 0.0)];
            let data = path_data(corners.map(|c| at + DVec2::from(c))) + "Z";
            all = all.add(path(data, INK, 1.6).set("fill", "#ffffff"));
            labels.keep_free(at, 7.0);
        }
        all = self.points(all, &mut labels);
        if let Some(v) = quantity.largest {
            let at = frame.place(self.input.coordinates[v.index()]);
            let corners = [(0.0, -7.0), (6.5, 4.5), (-6.5, 4.5)];
            let data = path_data(corners.map(|c| at + DVec2::from(c))) + "Z";
            all = all.add(path(data, INK, 1.8).set("fill", "#ffffff"));
            let words = format!("most {}", shown(quantity.values[v.index()], 0));
            let (place, anchor) = labels.place(at, 10.0, SIZE, &words);
            all = all.add(rimmed(place, anchor, SIZE, &words));
        }
        for (k, seam) in self.input.drawing.seams.iter().enumerate() {
            for (side, mm) in [(&seam.left, seam.left_mm), (&seam.right, seam.right_mm)] {
                let Some(&p) = side.get(side.len() / 2) else { continue };
                let words = format!("seam {}: {} mm", k + 1, shown(mm, 1));
                let (place, anchor) = labels.place(frame.place(p), 8.0, SIZE, &words);
                all = all.add(rimmed(place, anchor, SIZE, &words));
            }
        }
        self.values(all, quantity, &mut labels)
    }

    fn points(&self, mut all: svg::Document, labels: &mut Labels) -> svg::Document {
        let points = &self.input.drawing.points;
        let labelled = points.len() <= MOST_LABELS;
        for (place, _) in points {
            let at = self.frame.place(*place);
            let (radius, width) = if labelled { (5.0, 2.0) } else { (2.0, 0.8) };
            all = all.add(circle(at, radius, "#ffffff", INK).set("stroke-width", width));
            labels.keep_free(at, radius);
        }
        for (k, (place, label)) in points.iter().enumerate().filter(|_| labelled) {
            let words = format!("{}: {label}", k + 1);
            // Bold letters are wider.
            let (at, anchor) = labels.place(self.frame.place(*place), 8.0, 1.12 * SIZE, &words);
            all = all.add(rimmed(at, anchor, SIZE, &words).set("font-weight", "700"));
        }
        all
    }

    /// Values on a grid, where nothing else is written.
    fn values(
        &self,
        mut all: svg::Document,
        quantity: &Quantity,
        labels: &mut Labels,
    ) -> svg::Document {
        let size = 13.0;
        let pixels = DVec2::new(self.raster.width as f64, self.raster.height as f64);
        let corner =
            self.frame.place(0.5 * (self.frame.low + self.frame.high)) - 0.5 * pixels / DENSITY;
        let rows = (self.frame.size.y / VALUES) as u32;
        let columns = (self.frame.size.x / VALUES) as u32;
        for (row, column) in (0..=rows).flat_map(|r| (0..=columns).map(move |c| (r, c))) {
            let grid = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let at = VALUES * grid;
            let value = |p: DVec2| {
                let pixel = ((p - corner) * DENSITY).floor();
                let inside = pixel.min_element() >= 0.0 && (pixels - pixel).min_element() > 0.0;
                let seen = self.raster.seen(if inside {
                    pixel.y as usize * self.raster.width + pixel.x as usize
                } else {
                    return None;
                })?;
                let corners = self.input.disk.triangle(seen.triangle);
                let values = corners.map(|v| quantity.values[v.index()]);
                Some((0..3).map(|k| seen.weights[k] * values[k]).sum::<f64>())
            };
            let around = [(-16.0, 0.0), (16.0, 0.0), (0.0, -12.0), (0.0, 12.0)].map(DVec2::from);
            let Some(here) = value(at).filter(|v| v.is_finite()) else { continue };
            let words = shown(here, 0);
            if around.iter().all(|&d| value(at + d).is_some()) && labels.claim(at, size, &words) {
                let base = at + DVec2::new(0.0, 0.35 * size);
                all = all.add(rimmed(base, Anchor::Middle, size, &words).set("fill", QUIET));
            }
        }
        all
    }
}

/// Arrows beside the pattern: weft up to the body, warp round the limb.
fn orientation(all: svg::Document, frame: &Frame) -> svg::Document {
    let (low, high) = (frame.place(frame.low), frame.place(frame.high));
    let x = 15.0;
    let up = |tip: DVec2, way: DVec2| {
        let across = way.perp();
        path_data([tip - 9.0 * way + 4.5 * across, tip, tip - 9.0 * way - 4.5 * across])
    };
    let (foot, head) = (DVec2::new(x, low.y), DVec2::new(x, high.y));
    let y = low.y + ARROWS - 4.0;
    let (left, right) = (DVec2::new(low.x, y), DVec2::new(high.x, y));
    let middle = DVec2::new(x + 18.0, 0.5 * (low.y + high.y));
    let turned = format!("rotate(-90 {} {})", middle.x, middle.y);
    all.add(line(foot, head, INK, 1.6))
        .add(path(up(head, DVec2::NEG_Y), INK, 1.6))
        .add(text(middle, Anchor::Middle, SIZE, "weft, up: near the body").set("transform", turned))
        .add(line(left, right, INK, 1.6))
        .add(path(up(right, DVec2::X), INK, 1.6))
        .add(path(up(left, DVec2::NEG_X), INK, 1.6))
        .add(text(
            DVec2::new(0.5 * (left.x + right.x), y - 7.0),
            Anchor::Middle,
            SIZE,
            "warp, round the limb",
        ))
}
