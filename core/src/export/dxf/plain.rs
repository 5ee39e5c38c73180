//! A sheet as a plain DXF, R2000: closed lightweight polylines, a layer for each kind of line, its unit
//! stated.

use super::skeleton::{FileLayer, MODEL, head, layouts, tail};
use super::writer::{Release, Writer};
use crate::export::charset::escaped;
use crate::sheet::{Layer, Shape, Sheet, SheetUnit};

/// Height of capitals over the size of letters: DXF counts capitals.
const CAPITALS: f64 = 0.72;

/// A sheet as a plain DXF.
#[must_use]
pub fn pattern_dxf(sheet: &Sheet<'_>) -> String {
    let mm_per_unit = match sheet.unit {
        SheetUnit::Millimetre => 1.0,
        SheetUnit::Inch => 25.4,
    };
    let mut w = Writer::new(Release::R2000, mm_per_unit);
    let layers = Layer::ALL.map(|layer| FileLayer {
        name: layer.name().to_uppercase(),
        colour: colour(layer),
        dashed: layer == Layer::Sew,
    });
    head(&mut w, sheet.size, sheet.unit, &layers, &[]);
    w.tag(0, "SECTION");
    w.tag(2, "BLOCKS");
    layouts(&mut w);
    w.tag(0, "ENDSEC");
    w.tag(0, "SECTION");
    w.tag(2, "ENTITIES");
    w.owner = MODEL;
    for item in sheet.all() {
        let layer = item.layer.name().to_uppercase();
        match &item.shape {
            // A line of the cutter is a polyline even if it has but two points.
            Shape::Line { points, closed } if item.layer <= Layer::Sew => {
                w.polyline(&layer, points, *closed);
            }
            Shape::Line { points, closed } => w.line(&layer, points, *closed),
            Shape::Circle { centre, radius } => w.circle(&layer, *centre, *radius),
            Shape::Words { at, size, angle, from_start, text } => {
                let text = escaped(text);
                let size = CAPITALS * size;
                if *from_start {
                    let base = *at - glam::DVec2::new(0.0, 0.5 * size);
                    w.words(&layer, base, size, *angle, &text);
                } else {
                    w.centred(&layer, *at, size, *angle, &text);
                }
            }
        }
    }
    w.tag(0, "ENDSEC");
    tail(&mut w);
    w.text
}

/// AutoCAD's number of the colour nearest to the layer's.
fn colour(layer: Layer) -> i64 {
    match layer {
        Layer::Cut | Layer::CutOut | Layer::Text | Layer::Scale => 7,
        Layer::Sew => 1,
        Layer::Notch => 6,
        Layer::Grain => 5,
        Layer::Stretch => 30,
        Layer::Mark => 3,
    }
}
