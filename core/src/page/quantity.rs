//! What the pictures are coloured by, and its legend.

use glam::DVec2;

use super::draw::{Anchor, INK, drawing, line, rectangle, text};
use super::html::{Tag, shown, tag};
use super::picture::{Field, INSIDE, NEGATIVE, UNKNOWN};
use super::scale::{Bands, Scale, css, weighted_percentile};
use crate::field::{COMPRESSED_BELOW, LIFTING_BELOW_KPA};
use crate::surface::{Surface, VertexId};
use crate::units::mmhg_from_kpa;

/// Bands of less than a per cent of strain, or a mmHg, would show noise.
const LEAST_STEP: f64 = 1.0;

/// A value at every vertex that pictures are coloured by.
#[derive(Debug, Clone)]
pub(super) struct Quantity {
    /// Its name at the start of a sentence.
    pub(super) name: &'static str,
    /// The unit that is shown.
    pub(super) unit: &'static str,
    /// What less than the bands' floor means.
    pub(super) negative: &'static str,
    /// By vertex, in that unit.
    pub(super) values: Vec<f64>,
    /// How values are shown.
    pub(super) bands: Bands,
    /// Value above which the picture is hatched.
    pub(super) limit: Option<f64>,
    /// The vertex of the largest value, where that is to be pointed out.
    pub(super) largest: Option<VertexId>,
    /// Between these lies all but the hundredth of the area at either end.
    pub(super) range: [f64; 2],
}

impl Quantity {
    /// Warp strain in per cent; `weights` are the vertices' shares of the area.
    pub(super) fn strain(strain: &[f64], weights: &[f64]) -> Self {
        let values: Vec<f64> = strain.iter().map(|s| 100.0 * s).collect();
        Self {
            name: "Warp strain",
            unit: "%",
            negative: "compressed",
            bands: bands(Scale::Cividis, &values, weights, 100.0 * COMPRESSED_BELOW),
            range: range(&values, weights),
            values,
            limit: None,
            largest: None,
        }
    }

    /// Pressure in mmHg from kPa.
    pub(super) fn pressure(kpa: &[f64], weights: &[f64], limit_kpa: f64) -> Self {
        let values: Vec<f64> = kpa.iter().map(|&p| mmhg_from_kpa(p)).collect();
        let largest = (0..values.len())
            .filter(|&v| values[v].is_finite())
            .max_by(|&a, &b| values[a].total_cmp(&values[b]).then(b.cmp(&a)))
            .map(VertexId::new);
        Self {
            name: "Computed pressure",
            unit: "mmHg",
            negative: "lifts off",
            bands: bands(Scale::Magma, &values, weights, mmhg_from_kpa(LIFTING_BELOW_KPA)),
            range: range(&values, weights),
            values,
            limit: Some(mmhg_from_kpa(limit_kpa)),
            largest,
        }
    }

    /// For the painter.
    pub(super) fn field(&self) -> Field<'_> {
        Field { values: &self.values, bands: self.bands, limit: self.limit }
    }

    /// The colours with their values, and the kinds of hatching that occur.
    pub(super) fn legend(&self) -> Tag {
        let (edge, size) = (30.0, 15.0);
        let bands = &self.bands;
        let full = 520.0;
        let width = full / bands.count as f64;
        let words = format!(
            "{} in {}: {} bands of {} from {}, the darker the more",
            self.name,
            self.unit,
            bands.count,
            shown(bands.step, bands.decimals()),
            shown(bands.low, bands.decimals())
        );
        let mut bar = drawing(full + 2.0 * edge, 44.0, &words);
        for band in 0..bands.count {
            let corner = DVec2::new(edge + width * band as f64, 1.0);
            let box_ = rectangle(corner, DVec2::new(width, 20.0), &css(bands.colour(band)));
            bar = bar.add(box_.set("stroke", INK).set("stroke-width", "0.8"));
        }
        for k in 0..=bands.count {
            let x = edge + width * k as f64;
            let foot = DVec2::new(x, 21.0);
            bar = bar.add(line(foot, foot + DVec2::new(0.0, 5.0), INK, 0.8));
            let number = shown(bands.edge(k), bands.decimals());
            bar = bar.add(text(DVec2::new(x, 40.0), Anchor::Middle, size, &number));
        }
        let mut keys = tag("p").class("keys").text(format!(
            "{} in {}. Colour scale {}: darker is more; a line stands where the colour changes, \
             and the colours at both ends hold all beyond.",
            self.name,
            self.unit,
            bands.scale.name()
        ));
        let has = |test: &dyn Fn(f64) -> bool| self.values.iter().any(|&value| test(value));
        if has(&|value| value < bands.floor) {
            keys = keys.child(self.key(css(NEGATIVE), INK, -1.0, self.negative));
        }
        if let Some(limit) = self.limit.filter(|&limit| has(&|value| value > limit)) {
            let ground = css(bands.colour(bands.count - 1));
            let words = format!("above the limit of {} {}", shown(limit, 0), self.unit);
            keys = keys.child(self.key(ground, "#ffffff", 1.0, &words));
        }
        if has(&|value| !value.is_finite()) {
            keys = keys.child(self.key(css(UNKNOWN), "none", 1.0, "not known"));
        }
        keys = keys.child(self.key(css(INSIDE), "none", 1.0, "the limb's inside"));
        tag("div").class("legend").child(bar).child(keys)
    }

    /// A hatched patch and what it means.
    fn key(&self, ground: String, ink: &str, way: f64, words: &str) -> Tag {
        let mut patch = drawing(26.0, 14.0, words);
        patch =
            patch.add(rectangle(DVec2::ZERO, DVec2::new(26.0, 14.0), &ground).set("stroke", INK));
        for k in 0..4 {
            let x = 3.0 + 6.0 * f64::from(k);
            let (low, high) = (DVec2::new(x, 14.0), DVec2::new(x + 6.0, 0.0));
            let (low, high) = if way > 0.0 {
                (DVec2::new(x + 6.0, 14.0), DVec2::new(x, 0.0))
            } else {
                (low, high)
            };
            patch = patch.add(line(low, high, ink, 1.6));
        }
        tag("span").class("key").child(patch.set("width", "26").set("height", "14")).text(words)
    }
}

fn pairs<'a>(values: &'a [f64], weights: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    values.iter().copied().zip(weights.iter().copied())
}

fn bands(scale: Scale, values: &[f64], weights: &[f64], floor: f64) -> Bands {
    Bands::of(scale, pairs(values, weights), LEAST_STEP, floor)
}

fn range(values: &[f64], weights: &[f64]) -> [f64; 2] {
    let mut sorted: Vec<(f64, f64)> =
        pairs(values, weights).filter(|(value, _)| value.is_finite()).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    [0.01, 0.99].map(|part| weighted_percentile(&sorted, part).unwrap_or_default())
}

/// A third of the area of the triangles at each vertex, in mm².
pub(super) fn vertex_areas(surface: &Surface) -> Vec<f64> {
    let mut areas = vec![0.0; surface.vertex_count()];
    for t in surface.triangle_ids() {
        for v in surface.triangle(t) {
            areas[v.index()] += surface.area(t) / 3.0;
        }
    }
    areas
}
