//! SVG of a sheet at true size: one user unit is one millimetre, or one inch.
//!
//! SVG's own y goes down and is flipped here. Whoever prints it has to print at 100 %: the boxes are
//! there to be measured.

use std::collections::BTreeMap;

use svg::Document;
use svg::node::element::{Circle, Group, Path, Text, Title};

use super::number::fixed;
use crate::sheet::{Item, Layer, Shape, Sheet};

/// Stroke width in mm: thin enough to cut along, thick enough to print.
const STROKE: f64 = 0.3;
/// Decimals of the unit: less than a thousandth of a millimetre.
const DECIMALS: usize = 5;

/// A sheet as an SVG document, at true size.
///
/// A group for each layer, by `id`: `cut_line` (outlines and cut-outs), `sew_line`, `notches`, `grain`
/// (weft), `stretch` (warp), `marks` (pressure points, orientation markers), `scale`, `text`.
#[must_use]
pub fn pattern_svg(sheet: &Sheet<'_>) -> String {
    let page = Page { sheet };
    let (width, height) = (page.number(sheet.size.x), page.number(sheet.size.y));
    let symbol = sheet.unit.symbol();
    let mut document = Document::new()
        .set("width", format!("{width}{symbol}"))
        .set("height", format!("{height}{symbol}"))
        .set("viewBox", format!("0 0 {width} {height}"))
        .add(Title::new(printable(&sheet.heading.name)));
    let mut layers: BTreeMap<&str, Group> = BTreeMap::new();
    for item in sheet.all() {
        let name = group_name(item.layer);
        let group = layers.remove(name).unwrap_or_else(|| page.group(item.layer));
        layers.insert(name, page.add(group, item));
    }
    for layer in Layer::ALL {
        if let Some(group) = layers.remove(group_name(layer)) {
            document = document.add(group);
        }
    }
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{document}\n")
}

/// Cut-outs are cut as outlines are: one group for the knife.
fn group_name(layer: Layer) -> &'static str {
    match layer {
        Layer::CutOut => Layer::Cut.name(),
        other => other.name(),
    }
}

/// XML has no control characters, not even escaped ones.
fn printable(text: &str) -> String {
    let allowed = |c: char| !c.is_control() && c != '\u{fffe}' && c != '\u{ffff}';
    text.chars().map(|c| if allowed(c) { c } else { ' ' }).collect::<String>().trim().to_owned()
}

struct Page<'a> {
    sheet: &'a Sheet<'a>,
}

impl Page<'_> {
    /// A length in mm in the unit of the file.
    fn number(&self, mm: f64) -> String {
        fixed(self.sheet.unit.from_mm(mm), DECIMALS)
    }

    fn down(&self, y: f64) -> f64 {
        self.sheet.size.y - y
    }

    fn group(&self, layer: Layer) -> Group {
        let [r, g, b] = layer.colour();
        let colour = format!("#{r:02x}{g:02x}{b:02x}");
        let group = Group::new().set("id", group_name(layer));
        if layer == Layer::Text {
            return group
                .set("fill", colour)
                .set("stroke", "none")
                .set("font-family", "Helvetica, Arial, sans-serif");
        }
        let group = group
            .set("fill", "none")
            .set("stroke", colour)
            .set("stroke-width", self.number(STROKE))
            .set("stroke-linejoin", "round");
        if layer == Layer::Sew {
            let dash = self.number(4.0);
            return group.set("stroke-dasharray", format!("{dash} {dash}"));
        }
        group
    }

    fn add(&self, group: Group, item: &Item) -> Group {
        match &item.shape {
            Shape::Line { points, closed } => {
                let mut data = String::new();
                for (i, p) in points.iter().enumerate() {
                    let command = if i == 0 { "M" } else { " L" };
                    let (x, y) = (self.number(p.x), self.number(self.down(p.y)));
                    data.push_str(&format!("{command} {x} {y}"));
                }
                if *closed {
                    data.push_str(" Z");
                }
                let path = Path::new().set("d", data);
                group.add(if item.id.is_empty() { path } else { path.set("id", item.id.as_str()) })
            }
            Shape::Circle { centre, radius } => group.add(
                Circle::new()
                    .set("cx", self.number(centre.x))
                    .set("cy", self.number(self.down(centre.y)))
                    .set("r", self.number(*radius)),
            ),
            Shape::Words { at, size, angle, from_start, text } => {
                let (x, y) = (self.number(at.x), self.number(self.down(at.y)));
                let words = Text::new(printable(text))
                    .set("x", x.clone())
                    .set("y", y.clone())
                    .set("font-size", self.number(*size))
                    // The middle of small letters: not every program knows dominant-baseline.
                    .set("dy", self.number(0.35 * size));
                let words = if *from_start { words } else { words.set("text-anchor", "middle") };
                group.add(if *angle == 0.0 {
                    words
                } else {
                    words.set("transform", format!("rotate({} {x} {y})", fixed(-angle, 4)))
                })
            }
        }
    }
}

#[cfg(test)]
#[path = "svg_tests.rs"]
mod tests;
