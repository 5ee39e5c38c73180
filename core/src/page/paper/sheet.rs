//! Patterns side by side at one scale, coloured by strain.
//!
//! The report's own plan fills the width that it has; here patterns are compared, so that a
//! millimetre must be as long in each.

use glam::{DVec2, DVec3};

use crate::examples::Outcome;
use crate::page::draw::{
    Anchor, INK, Labels, circle, drawing, image, line, path, path_data, rimmed, text,
};
use crate::page::html::shown;
use crate::page::picture::data_address;
use crate::page::quantity::Quantity;
use crate::page::raster::{Camera, Raster};

/// Width of a drawing, in its units: that of a view of the limb.
const WIDTH: f64 = 260.0;
/// Largest height of a pattern.
const HEIGHT: f64 = 330.0;
/// White round a pattern.
const MARGIN: f64 = 8.0;
/// Room for the scale bar.
const FOOTER: f64 = 26.0;
/// Pixels in a unit.
const DENSITY: f64 = 2.2;
/// Size of lettering.
const SIZE: f64 = 17.0;

/// Patterns that are drawn at one scale.
pub(super) struct Sheets {
    /// Units in a mm.
    scale: f64,
    /// Height of every drawing.
    height: f64,
}

/// Lower left and upper right corner of a pattern, in mm.
fn extent(outcome: &Outcome) -> (DVec2, DVec2) {
    let first = outcome.flattening.coordinates[0];
    let points = outcome.flattening.coordinates.iter();
    points.fold((first, first), |(low, high), &p| (low.min(p), high.max(p)))
}

impl Sheets {
    /// For these patterns.
    pub(super) fn of(outcomes: &[&Outcome]) -> Self {
        let size = outcomes
            .iter()
            .map(|outcome| extent(outcome))
            .fold(DVec2::ONE, |most, (low, high)| most.max(high - low));
        let scale = ((WIDTH - 2.0 * MARGIN) / size.x).min(HEIGHT / size.y);
        Self { scale, height: scale * size.y + 2.0 * MARGIN + FOOTER }
    }

    /// A pattern; up is near the body.
    pub(super) fn drawing(&self, outcome: &Outcome, quantity: &Quantity) -> svg::Document {
        let flattening = &outcome.flattening;
        let (low, high) = extent(outcome);
        let middle = DVec2::new(0.5 * WIDTH, 0.5 * (self.height - FOOTER));
        let centre = 0.5 * (low + high);
        let place = |p: DVec2| middle + self.scale * (p - centre) * DVec2::new(1.0, -1.0);
        let pixels = ((high - low) * self.scale * DENSITY).ceil() + 2.0;
        let camera = Camera {
            right: DVec3::X,
            up: DVec3::Y,
            viewer: DVec3::Z,
            centre: centre.extend(0.0),
            scale: self.scale * DENSITY,
            size: [pixels.x as usize, pixels.y as usize],
        };
        let flat: Vec<DVec3> = flattening.coordinates.iter().map(|p| p.extend(0.0)).collect();
        let raster = Raster::new(flattening.disk(), &flat, &camera);
        let pixel = 1.0 / camera.scale;
        let address = data_address(flattening.disk(), &raster, &quantity.field(), None, pixel);
        let size = pixels / DENSITY;
        let words = format!("Pattern of {}, coloured by warp strain", outcome.example.title);
        let outline = flattening.drawing.outline.iter().filter(|points| !points.is_empty());
        let outline: String =
            outline.map(|points| path_data(points.iter().map(|&p| place(p))) + "Z").collect();
        let mut all = drawing(WIDTH, self.height, &words)
            .add(image(middle - 0.5 * size, size, address))
            .add(path(outline, INK, 1.4));
        let mut labels = Labels::new(DVec2::new(WIDTH, self.height - FOOTER));
        let points = &flattening.drawing.points;
        for (p, _) in points {
            let at = place(*p);
            all = all.add(circle(at, 5.0, "#ffffff", INK).set("stroke-width", 2.0));
            labels.keep_free(at, 5.0);
        }
        for (k, ((p, _), wanted)) in points.iter().zip(&flattening.report.pressures).enumerate() {
            let words = format!("{}: {}", k + 1, shown(wanted.asked_kpa, 2));
            // Bold letters are wider.
            let (at, anchor) = labels.place(place(*p), 8.0, 1.12 * SIZE, &words);
            all = all.add(rimmed(at, anchor, SIZE, &words).set("font-weight", "700"));
        }
        self.scale_bar(all)
    }

    fn scale_bar(&self, all: svg::Document) -> svg::Document {
        let left = DVec2::new(MARGIN, self.height - 12.0);
        let right = left + DVec2::new(50.0 * self.scale, 0.0);
        let tick = DVec2::new(0.0, 4.0);
        all.add(line(left, right, INK, 1.4))
            .add(line(left - tick, left + tick, INK, 1.4))
            .add(line(right - tick, right + tick, INK, 1.4))
            .add(text(right + DVec2::new(7.0, 5.0), Anchor::Start, 15.0, "50 mm"))
    }
}
