//! SVG of a pattern at true size: one user unit is one millimetre.
//!
//! The drawing's x (warp, round the limb) goes right and its y (weft, along the limb) goes up, as
//! on the cutting table; SVG's own y goes down and is flipped here. Whoever prints it has to print
//! at 100 %: the scale bar is there to be measured.

use glam::DVec2;
use svg::Document;
use svg::node::element::{Circle, Group, Line, Path, Text, Title};

use super::drawing::Drawing;
use super::layout::{Stretch, beside, bounds, inside, upright};
use super::number::fixed;

/// White border round the pattern, in mm: what ordinary printers cannot reach.
const MARGIN: f64 = 10.0;
/// Height of the strip for the scale bar below the pattern, in mm.
const FOOTER: f64 = 14.0;
/// Length of the scale bar, in mm.
const SCALE_BAR: f64 = 100.0;
/// Stroke width in mm: thin enough to cut along, thick enough to print.
const STROKE: f64 = 0.3;
/// Size of small lettering, in mm.
const SMALL: f64 = 3.5;
/// Size of large lettering, in mm.
const LARGE: f64 = 5.0;
/// Smallest lettering, in mm.
const LEAST: f64 = 3.0;
/// Decimals of a millimetre.
const DECIMALS: usize = 4;
/// Mean width of a letter over its height in sans-serif fonts.
const LETTER_WIDTH: f64 = 0.6;

/// The pattern as an SVG document, at true size in millimetres.
///
/// Groups by `id`: `cut_line` (outline and cut-outs), `sew_line` (the sides that are sewn
/// together), `grain` (an arrow along weft), `marks` (pressure points and orientation markers),
/// `scale` (a bar of 100 mm), `text`.
#[must_use]
pub fn pattern_svg(drawing: &Drawing) -> String {
    let sheet = Sheet::of(drawing);
    let (width, height) = (number(sheet.size.x), number(sheet.size.y));
    let grain = upright(drawing);
    let document = Document::new()
        .set("width", format!("{width}mm"))
        .set("height", format!("{height}mm"))
        .set("viewBox", format!("0 0 {width} {height}"))
        .add(Title::new(title(drawing)))
        .add(cut_line(drawing, &sheet))
        .add(sew_line(drawing, &sheet))
        .add(grain_arrow(grain, &sheet))
        .add(marks(drawing, &sheet))
        .add(scale_bar(&sheet))
        .add(lettering(drawing, grain, &sheet));
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{document}\n")
}

/// Where the pattern lies on the sheet.
struct Sheet {
    /// Upper left corner of the pattern, in the drawing's coordinates.
    corner: DVec2,
    /// Width and height of the sheet.
    size: DVec2,
}

impl Sheet {
    fn of(drawing: &Drawing) -> Self {
        let (low, high) = bounds(drawing);
        let pattern = high - low;
        let size = DVec2::new(pattern.x.max(SCALE_BAR), pattern.y + FOOTER) + 2.0 * MARGIN;
        Self { corner: DVec2::new(low.x, high.y), size }
    }

    /// A point of the drawing on the sheet: x right, y down.
    fn place(&self, p: DVec2) -> DVec2 {
        DVec2::new(p.x - self.corner.x + MARGIN, self.corner.y - p.y + MARGIN)
    }

    fn path(&self, points: &[DVec2], closed: bool) -> String {
        let mut data = String::new();
        for (i, p) in points.iter().enumerate() {
            let p = self.place(*p);
            let command = if i == 0 { "M" } else { " L" };
            data.push_str(&format!("{command} {} {}", number(p.x), number(p.y)));
        }
        if closed {
            data.push_str(" Z");
        }
        data
    }
}

fn number(value: f64) -> String {
    fixed(value, DECIMALS)
}

fn title(drawing: &Drawing) -> String {
    let name = printable(&drawing.name);
    if name.is_empty() { "brace pattern".to_owned() } else { name }
}

/// XML has no control characters, not even escaped ones.
fn printable(text: &str) -> String {
    let allowed = |c: char| !c.is_control() && c != '\u{fffe}' && c != '\u{ffff}';
    text.chars().map(|c| if allowed(c) { c } else { ' ' }).collect::<String>().trim().to_owned()
}

fn group(id: &str, colour: &str) -> Group {
    Group::new()
        .set("id", id)
        .set("fill", "none")
        .set("stroke", colour)
        .set("stroke-width", STROKE)
        .set("stroke-linejoin", "round")
}

fn cut_line(drawing: &Drawing, sheet: &Sheet) -> Group {
    let mut all = group("cut_line", "black");
    for (i, points) in drawing.outline.iter().filter(|points| !points.is_empty()).enumerate() {
        let id = if i == 0 { "outline".to_owned() } else { format!("cut_out_{i}") };
        all = all.add(Path::new().set("id", id).set("d", sheet.path(points, true)));
    }
    all
}

fn sew_line(drawing: &Drawing, sheet: &Sheet) -> Group {
    let mut all = group("sew_line", "#e00000").set("stroke-dasharray", "4 4");
    for (i, seam) in drawing.seams.iter().enumerate() {
        let i = i + 1;
        let side = |points: &[DVec2], name: &str| {
            Path::new().set("id", format!("seam_{i}_{name}")).set("d", sheet.path(points, false))
        };
        let pair = Group::new()
            .set("id", format!("seam_{i}"))
            .add(side(&seam.left, "left"))
            .add(side(&seam.right, "right"));
        all = all.add(pair);
    }
    all
}

fn line(from: DVec2, to: DVec2) -> Line {
    Line::new()
        .set("x1", number(from.x))
        .set("y1", number(from.y))
        .set("x2", number(to.x))
        .set("y2", number(to.y))
}

/// The middle half of a stretch: the rest is left to the lettering at its ends.
fn arrow_of(stretch: Stretch) -> (DVec2, DVec2) {
    (stretch.bottom.lerp(stretch.top, 0.25), stretch.bottom.lerp(stretch.top, 0.75))
}

fn grain_arrow(stretch: Option<Stretch>, sheet: &Sheet) -> Group {
    let all = group("grain", "#0050a0");
    let Some(stretch) = stretch else { return all };
    let (from, to) = arrow_of(stretch);
    let head = |tip: DVec2, way: f64| {
        let arms = [DVec2::new(-1.5, -4.0 * way), DVec2::ZERO, DVec2::new(1.5, -4.0 * way)];
        Path::new().set("d", sheet.path(&arms.map(|arm| tip + arm), false))
    };
    all.add(line(sheet.place(from), sheet.place(to))).add(head(to, 1.0)).add(head(from, -1.0))
}

fn marks(drawing: &Drawing, sheet: &Sheet) -> Group {
    let mut points = Group::new().set("id", "pressure_points");
    for (place, label) in &drawing.points {
        let p = sheet.place(*place);
        let (x, y) = (DVec2::new(2.0, 0.0), DVec2::new(0.0, 2.0));
        let mark = Group::new()
            .add(Title::new(printable(label)))
            .add(Circle::new().set("cx", number(p.x)).set("cy", number(p.y)).set("r", number(1.2)))
            .add(line(p - x, p + x))
            .add(line(p - y, p + y));
        points = points.add(mark);
    }
    let mut markers = Group::new().set("id", "orientation_markers");
    for (place, id) in drawing.markers.iter().zip(["marker_top", "marker_bottom"]) {
        let corners = [DVec2::Y, DVec2::X, DVec2::NEG_Y, DVec2::NEG_X].map(|d| *place + 1.8 * d);
        markers = markers.add(Path::new().set("id", id).set("d", sheet.path(&corners, true)));
    }
    group("marks", "#007030").add(points).add(markers)
}

fn scale_bar(sheet: &Sheet) -> Group {
    let left = DVec2::new(MARGIN, sheet.size.y - MARGIN);
    let right = left + DVec2::new(SCALE_BAR, 0.0);
    let tick = DVec2::new(0.0, 2.0);
    group("scale", "black")
        .add(line(left, right).set("id", "scale_bar_100_mm"))
        .add(line(left - tick, left + tick))
        .add(line(right - tick, right + tick))
}

/// A line of text centred on a point of the sheet, turned by an angle in degrees, y up.
fn label(at: DVec2, size: f64, angle: f64, words: &str) -> Text {
    let (x, y) = (number(at.x), number(at.y));
    let text = Text::new(printable(words))
        .set("x", x.clone())
        .set("y", y.clone())
        .set("font-size", number(size))
        .set("text-anchor", "middle")
        // The middle of small letters: not every program knows dominant-baseline.
        .set("dy", number(0.35 * size));
    if angle == 0.0 {
        text
    } else {
        text.set("transform", format!("rotate({} {x} {y})", number(-angle)))
    }
}

fn lettering(drawing: &Drawing, grain: Option<Stretch>, sheet: &Sheet) -> Group {
    let mut all = Group::new()
        .set("id", "text")
        .set("fill", "black")
        .set("stroke", "none")
        .set("font-family", "sans-serif");
    if let Some(stretch) = grain {
        let (top, bottom) = (sheet.place(stretch.top), sheet.place(stretch.bottom));
        let (from, to) = arrow_of(stretch);
        let middle = sheet.place(from.midpoint(to));
        let gap = 0.125 * (bottom.y - top.y);
        let side = DVec2::new(LARGE, 0.0);
        all = all
            .add(label(top + DVec2::new(0.0, gap), LARGE, 0.0, "top"))
            .add(label(bottom - DVec2::new(0.0, gap), LARGE, 0.0, "bottom"))
            .add(label(middle - side, SMALL, 90.0, "weft: along the limb"));
        if !drawing.name.is_empty() {
            // A long name on a short piece is lettered smaller, down to what can be read.
            let letters = drawing.name.chars().count() as f64;
            let fitting = (bottom.y - top.y) / (LETTER_WIDTH * letters);
            let size = fitting.clamp(LEAST, LARGE);
            all = all.add(label(middle + side, size, 90.0, &drawing.name));
        }
    }
    for (i, seam) in drawing.seams.iter().enumerate() {
        let i = i + 1;
        for (side, length, name) in
            [(&seam.left, seam.left_mm, "left"), (&seam.right, seam.right_mm, "right")]
        {
            if let Some((place, angle)) = beside(drawing, side, SMALL) {
                let words = format!("seam {i} {name}: {} mm", fixed(length, 1));
                all = all.add(label(sheet.place(place), SMALL, angle, &words));
            }
        }
    }
    for (place, words) in &drawing.points {
        all = all.add(point_label(drawing, sheet, *place, words));
    }
    let footer = DVec2::new(MARGIN + SCALE_BAR / 2.0, sheet.size.y - MARGIN - 4.0);
    all.add(label(footer, SMALL, 0.0, "100 mm: print at 100 %, then measure this line"))
}

/// The wanted value, right of its mark, or left of it where the piece ends on the right.
fn point_label(drawing: &Drawing, sheet: &Sheet, place: DVec2, words: &str) -> Text {
    let width = LETTER_WIDTH * SMALL * words.chars().count() as f64;
    let offset = 3.5 + width / 2.0;
    let fits = |way: f64| inside(drawing, place + DVec2::new(way * (3.5 + width), 0.0));
    let way = if !fits(1.0) && fits(-1.0) { -1.0 } else { 1.0 };
    label(sheet.place(place + DVec2::new(way * offset, 0.0)), SMALL, 0.0, words)
}

#[cfg(test)]
mod tests {
    use roxmltree::{Document, Node};

    use super::*;
    use crate::export::DrawingSeam;

    /// A sleeve of 240 × 180 mm with a thumb hole, a name that XML has to escape and two points.
    fn sleeve() -> Drawing {
        let wave = |x: f64, y: f64| DVec2::new(x + 6.0 * (y / 30.0).sin(), y);
        let heights: Vec<f64> = (0..=18).map(|i| 10.0 * f64::from(i)).collect();
        let left: Vec<DVec2> = heights.iter().map(|y| wave(-120.0, *y)).collect();
        let right: Vec<DVec2> = heights.iter().map(|y| wave(120.0, *y)).collect();
        let mut outline: Vec<DVec2> = left.iter().rev().copied().collect();
        outline.extend(&right);
        let hole = (0..24)
            .map(|i| DVec2::new(60.0, 120.0) + 15.0 * DVec2::from_angle(-0.2618 * f64::from(i)))
            .collect();
        Drawing {
            outline: vec![outline, hole],
            seams: vec![DrawingSeam { left, right, left_mm: 187.25, right_mm: 187.31 }],
            markers: [DVec2::new(0.0, 175.0), DVec2::new(0.0, 5.0)],
            points: vec![
                (DVec2::new(-60.0, 60.0), "17.2 mmHg".to_owned()),
                (DVec2::new(112.0, 40.0), "20 mmHg".to_owned()),
            ],
            name: "Knee <left> & \"right\" \u{1}".to_owned(),
        }
    }

    fn by_id<'a, 'i>(document: &'a Document<'i>, id: &str) -> Node<'a, 'i> {
        document
            .descendants()
            .find(|n| n.attribute("id") == Some(id))
            .unwrap_or_else(|| panic!("no element `{id}`"))
    }

    fn numbers(path: &str) -> Vec<[f64; 2]> {
        let values: Vec<f64> = path
            .split_whitespace()
            .filter(|word| !matches!(*word, "M" | "L" | "Z"))
            .map(|word| word.parse().unwrap())
            .collect();
        values.chunks(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    #[test]
    fn true_size_is_declared_in_millimetres_and_the_unit_is_one_millimetre() {
        let text = pattern_svg(&sleeve());
        let document = Document::parse(&text).unwrap();
        let root = document.root_element();
        let width: f64 =
            root.attribute("width").unwrap().strip_suffix("mm").unwrap().parse().unwrap();
        let height: f64 =
            root.attribute("height").unwrap().strip_suffix("mm").unwrap().parse().unwrap();
        let view: Vec<f64> =
            root.attribute("viewBox").unwrap().split(' ').map(|n| n.parse().unwrap()).collect();
        assert_eq!(view, [0.0, 0.0, width, height]);
        // Both sides wave alike, so the widest places are the extremes of one wave over 6·π·30 mm.
        let xs = || sleeve().outline[0].clone().into_iter().map(|p| p.x);
        let wide = xs().fold(f64::MIN, f64::max) - xs().fold(f64::MAX, f64::min);
        assert!((width - wide - 20.0).abs() < 1e-3, "{width}");
        assert!((height - 180.0 - 34.0).abs() < 1e-3, "{height}");
    }

    #[test]
    fn outline_and_cut_out_come_back_flipped_upright_and_closed() {
        let drawing = sleeve();
        let text = pattern_svg(&drawing);
        let document = Document::parse(&text).unwrap();
        let cut = by_id(&document, "cut_line");
        let paths: Vec<&str> = cut.descendants().filter_map(|n| n.attribute("d")).collect();
        assert_eq!(paths.len(), 2);
        let low_x = drawing.outline[0].iter().map(|p| p.x).fold(f64::MAX, f64::min);
        for (path, points) in paths.iter().zip(&drawing.outline) {
            assert!(path.ends_with(" Z"));
            let read = numbers(path);
            assert_eq!(read.len(), points.len());
            for ([x, y], p) in read.iter().zip(points) {
                assert!((x - (p.x - low_x + 10.0)).abs() < 1e-4);
                assert!((y - (180.0 - p.y + 10.0)).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn seam_sides_grain_marks_and_scale_bar_are_where_they_belong() {
        let text = pattern_svg(&sleeve());
        let document = Document::parse(&text).unwrap();
        let seam = by_id(&document, "seam_1");
        assert_eq!(seam.parent().unwrap().attribute("id"), Some("sew_line"));
        assert_eq!(numbers(by_id(&document, "seam_1_left").attribute("d").unwrap()).len(), 19);
        assert_eq!(numbers(by_id(&document, "seam_1_right").attribute("d").unwrap()).len(), 19);

        let value =
            |node: Node, key: &str| -> f64 { node.attribute(key).unwrap().parse().unwrap() };
        let bar = by_id(&document, "scale_bar_100_mm");
        assert!((value(bar, "x2") - value(bar, "x1") - 100.0).abs() < 1e-9);
        let arrow =
            by_id(&document, "grain").children().find(|n| n.tag_name().name() == "line").unwrap();
        assert_eq!(arrow.attribute("x1"), arrow.attribute("x2"));
        assert!(value(arrow, "y1") - value(arrow, "y2") > 50.0);

        let top = numbers(by_id(&document, "marker_top").attribute("d").unwrap());
        let bottom = numbers(by_id(&document, "marker_bottom").attribute("d").unwrap());
        assert!(top[0][1] < bottom[0][1] && (top[0][0] - bottom[0][0]).abs() < 1e-9);
        let circles = by_id(&document, "marks")
            .descendants()
            .filter(|n| n.tag_name().name() == "circle")
            .count();
        assert_eq!(circles, 2);
    }

    #[test]
    fn the_lettering_says_all_and_is_escaped() {
        let text = pattern_svg(&sleeve());
        let document = Document::parse(&text).unwrap();
        let words: Vec<String> = by_id(&document, "text")
            .descendants()
            .filter(|n| n.tag_name().name() == "text")
            .map(|n| n.text().unwrap().trim().to_owned())
            .collect();
        for wanted in [
            "top",
            "bottom",
            "weft: along the limb",
            "Knee <left> & \"right\"",
            "seam 1 left: 187.2 mm",
            "seam 1 right: 187.3 mm",
            "17.2 mmHg",
            "20 mmHg",
            "100 mm: print at 100 %, then measure this line",
        ] {
            assert!(words.iter().any(|w| w == wanted), "{wanted}: {words:?}");
        }
        for node in by_id(&document, "text").descendants() {
            if let Some(size) = node.attribute("font-size") {
                assert!(size.parse::<f64>().unwrap() >= 3.0);
            }
        }
    }

    #[test]
    fn a_label_near_the_right_edge_stands_on_the_left_of_its_mark() {
        let text = pattern_svg(&sleeve());
        let document = Document::parse(&text).unwrap();
        let x_of = |words: &str| -> f64 {
            let mut texts = document.descendants().filter(|n| n.tag_name().name() == "text");
            let node = texts.find(|n| n.text().map(str::trim) == Some(words)).unwrap();
            node.attribute("x").unwrap().parse().unwrap()
        };
        let low_x = sleeve().outline[0].iter().map(|p| p.x).fold(f64::MAX, f64::min);
        assert!(x_of("20 mmHg") < 112.0 - low_x + 10.0);
        assert!(x_of("17.2 mmHg") > -60.0 - low_x + 10.0);
    }

    #[test]
    fn a_long_name_is_lettered_smaller_but_legibly() {
        let size_of = |letters: usize| -> f64 {
            let text = pattern_svg(&Drawing { name: "n".repeat(letters), ..sleeve() });
            let document = Document::parse(&text).unwrap();
            let mut texts = document.descendants().filter(|n| n.tag_name().name() == "text");
            let node =
                texts.find(|n| n.text().is_some_and(|t| t.trim().starts_with("nn"))).unwrap();
            node.attribute("font-size").unwrap().parse().unwrap()
        };
        // The piece is 180 mm high: 75 letters of 0.6 times 4 mm.
        assert_eq!([size_of(10), size_of(75), size_of(400)], [5.0, 4.0, 3.0]);
    }

    #[test]
    fn a_small_or_empty_piece_still_has_its_scale_bar_on_the_sheet() {
        let text = pattern_svg(&Drawing::default());
        let document = Document::parse(&text).unwrap();
        assert_eq!(document.root_element().attribute("width"), Some("120.0000mm"));
        assert!(!text.contains("NaN") && !text.contains("inf"));
    }

    #[test]
    fn the_same_drawing_gives_the_same_bytes() {
        assert_eq!(pattern_svg(&sleeve()), pattern_svg(&sleeve()));
    }
}
