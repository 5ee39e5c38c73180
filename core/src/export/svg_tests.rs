use roxmltree::{Document as Parsed, Node};

use super::*;
use crate::sheet::SheetUnit;
use crate::sheet::tests::{heading, sleeve};

fn drawn(unit: SheetUnit) -> String {
    let pieces = [sleeve()];
    pattern_svg(&crate::sheet::sheet(&pieces, heading(), unit))
}

fn by_id<'a, 'i>(document: &'a Parsed<'i>, id: &str) -> Node<'a, 'i> {
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
fn true_size_is_declared_and_a_user_unit_is_the_unit() {
    for (unit, symbol, mm) in [(SheetUnit::Millimetre, "mm", 1.0), (SheetUnit::Inch, "in", 25.4)] {
        let text = drawn(unit);
        let document = Parsed::parse(&text).unwrap();
        let root = document.root_element();
        let side = |name: &str| -> f64 {
            root.attribute(name).unwrap().strip_suffix(symbol).unwrap().parse().unwrap()
        };
        let (width, height) = (side("width"), side("height"));
        let view: Vec<f64> =
            root.attribute("viewBox").unwrap().split(' ').map(|n| n.parse().unwrap()).collect();
        assert_eq!(view, [0.0, 0.0, width, height]);
        let outline = numbers(by_id(&document, "outline").attribute("d").unwrap());
        let xs = || outline.iter().map(|p| p[0]);
        let wide = xs().fold(f64::MIN, f64::max) - xs().fold(f64::MAX, f64::min);
        // Both sides wave alike, so the widest places are the extremes of one wave.
        let wanted = sleeve().bounds();
        assert!((mm * wide - (wanted.1.x - wanted.0.x)).abs() < 1e-3, "{wide}");
    }
}

#[test]
fn outline_and_cut_out_come_back_flipped_upright_and_closed() {
    let text = drawn(SheetUnit::Millimetre);
    let document = Parsed::parse(&text).unwrap();
    let paths: Vec<&str> =
        by_id(&document, "cut_line").descendants().filter_map(|n| n.attribute("d")).collect();
    assert_eq!(paths.len(), 2);
    let piece = sleeve();
    let top = piece.bounds().1.y;
    for (path, points) in paths.iter().zip(&piece.cut) {
        assert!(path.ends_with(" Z"));
        let read = numbers(path);
        assert_eq!(read.len(), points.len());
        for ([_, y], p) in read.iter().zip(points) {
            // The border is 10 mm wide.
            assert!((y - (top - p.y + 10.0)).abs() < 1e-4);
        }
    }
}

#[test]
fn layers_are_groups_and_words_are_escaped() {
    let text = drawn(SheetUnit::Millimetre);
    let document = Parsed::parse(&text).unwrap();
    for layer in ["cut_line", "sew_line", "grain", "stretch", "marks", "scale", "text"] {
        assert_eq!(by_id(&document, layer).tag_name().name(), "g");
    }
    let words: Vec<String> = by_id(&document, "text")
        .descendants()
        .filter(|n| n.tag_name().name() == "text")
        .map(|n| n.text().unwrap().trim().to_owned())
        .collect();
    assert!(words.iter().any(|w| w == "Knee <left> & \"right\""), "{words:?}");
    let inner = numbers(by_id(&document, "scale_box_100_by_50_mm").attribute("d").unwrap());
    assert!((inner[1][0] - inner[0][0] - 100.0).abs() < 1e-9);
    assert!((inner[1][1] - inner[2][1] - 50.0).abs() < 1e-9);
    let outer = numbers(by_id(&document, "scale_box_4_by_2_inch").attribute("d").unwrap());
    assert!((outer[1][0] - outer[0][0] - 101.6).abs() < 1e-9);
    // Both sides from the seam's start: the upper end.
    for side in ["seam_1_left", "seam_1_right"] {
        let points = numbers(by_id(&document, side).attribute("d").unwrap());
        assert!(points[0][1] < points[18][1], "{side}");
    }
}

#[test]
fn the_same_sheet_gives_the_same_bytes_and_no_sheet_has_odd_numbers() {
    assert_eq!(drawn(SheetUnit::Inch), drawn(SheetUnit::Inch));
    let empty = pattern_svg(&crate::sheet::sheet(&[], heading(), SheetUnit::Millimetre));
    assert!(!empty.contains("NaN") && !empty.contains("inf"));
}
