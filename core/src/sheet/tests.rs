use super::*;
use crate::cutting::{Edge, EdgeKind, Mark, MarkKind, SeamNote, Side};

/// A sleeve of 240 × 180 mm with a thumb hole, two sewn sides and two points.
pub(crate) fn sleeve() -> Piece {
    let wave = |x: f64, y: f64| DVec2::new(x + 6.0 * (y / 30.0).sin(), y);
    let heights: Vec<f64> = (0..=18).map(|i| 10.0 * f64::from(i)).collect();
    let left: Vec<DVec2> = heights.iter().rev().map(|y| wave(-120.0, *y)).collect();
    let right: Vec<DVec2> = heights.iter().map(|y| wave(120.0, *y)).collect();
    let edge = |kind, points: Vec<DVec2>| Edge { kind, points, allowance: 0.0 };
    let mut hole: Vec<DVec2> = (0..24)
        .map(|i| DVec2::new(60.0, 120.0) + 15.0 * DVec2::from_angle(-0.2618 * f64::from(i)))
        .collect();
    let cut_out = hole.clone();
    hole.push(hole[0]);
    let mut outline = left.clone();
    outline.extend(&right);
    let mark = |kind, x: f64, y: f64, words: &str| Mark {
        kind,
        at: DVec2::new(x, y),
        words: words.to_owned(),
    };
    let note = |edge, name: &str, other: &str| SeamNote {
        edge,
        name: name.to_owned(),
        sewn_to: other.to_owned(),
        length_mm: 187.25,
    };
    Piece {
        name: "Knee <left> & \"right\" \u{1}".to_owned(),
        quantity: 2,
        material: "power weave".to_owned(),
        edges: vec![
            vec![
                edge(EdgeKind::Sewn(0, Side::Left), left.clone()),
                edge(EdgeKind::Bottom, vec![left[18], right[0]]),
                edge(EdgeKind::Sewn(0, Side::Right), right.clone()),
                edge(EdgeKind::Top, vec![right[18], left[0]]),
            ],
            vec![edge(EdgeKind::Free, hole)],
        ],
        cut: vec![outline, cut_out],
        extensions: Vec::new(),
        notches: Vec::new(),
        marks: vec![
            mark(MarkKind::Upper, 0.0, 175.0, ""),
            mark(MarkKind::Lower, 0.0, 5.0, ""),
            mark(MarkKind::Pressure, -60.0, 60.0, "1: 17.2 mmHg"),
            mark(MarkKind::Pressure, 112.0, 40.0, "2: 20 mmHg"),
        ],
        seams: vec![
            note([0, 0], "seam 1 left", "seam 1 right"),
            note([0, 2], "seam 1 right", "seam 1 left"),
        ],
    }
}

pub(crate) fn heading() -> Heading {
    Heading {
        name: "Knee <left> & \"right\" \u{1}".to_owned(),
        reference: "job 17".to_owned(),
        date: "2026-11-26".to_owned(),
    }
}

fn texts<'a>(sheet: &'a Sheet<'_>) -> Vec<&'a str> {
    sheet
        .all()
        .filter_map(|item| match &item.shape {
            Shape::Words { text, .. } => Some(text.as_str()),
            _ => None,
        })
        .collect()
}

/// The corners of the box of words.
fn corners(shape: &Shape) -> Option<[DVec2; 4]> {
    let Shape::Words { at, size, angle, from_start: false, text } = shape else { return None };
    let way = DVec2::from_angle(angle.to_radians());
    let (x, y) = (0.5 * width::width(text, *size) * way, 0.5 * size * way.perp());
    Some([*at - x - y, *at + x - y, *at + x + y, *at - x + y])
}

#[test]
fn everything_that_a_workshop_reads_is_on_it() {
    let pieces = [sleeve()];
    let sheet = sheet(&pieces, heading(), SheetUnit::Millimetre);
    let texts = texts(&sheet);
    for wanted in [
        "top: near the body",
        "bottom",
        "grain: weft, along the limb",
        "stretch: warp, round the limb",
        "cut 2 \u{d7} from power weave",
        "seam 1 left: 187.2 mm, sewn to seam 1 right",
        "seam 1 right: 187.2 mm, sewn to seam 1 left",
        "1: 17.2 mmHg",
        "2: 20 mmHg",
        "Reference: job 17   Date: 2026-11-26",
        "Allowances: none: the cut line is the sew line.",
    ] {
        assert!(texts.contains(&wanted), "{wanted}: {texts:?}");
    }
    let grain = sheet.all().find(|item| item.id == "grain").unwrap();
    let Shape::Line { points, .. } = &grain.shape else { panic!() };
    assert_eq!(points[0].x, points[1].x);
    assert!((points[1].y - points[0].y).abs() > 50.0);
    let stretch = sheet.all().find(|item| item.id == "stretch").unwrap();
    let Shape::Line { points, .. } = &stretch.shape else { panic!() };
    assert_eq!(points[0].y, points[1].y);
}

#[test]
fn words_stand_inside_their_piece_clear_of_its_edge_and_of_one_another() {
    let pieces = [sleeve()];
    let sheet = sheet(&pieces, heading(), SheetUnit::Millimetre);
    let placed = &sheet.pieces[0];
    let loops: Vec<Vec<DVec2>> = placed
        .piece
        .cut
        .iter()
        .map(|points| points.iter().map(|p| *p + placed.offset).collect())
        .collect();
    let boxes: Vec<[DVec2; 4]> =
        placed.items.iter().filter_map(|item| corners(&item.shape)).collect();
    assert!(boxes.len() >= 9, "{}", boxes.len());
    for corner in boxes.iter().flatten() {
        assert!(room::inside(&loops, *corner), "{corner}");
    }
    // Middles of one are in no other.
    for (i, a) in boxes.iter().enumerate() {
        for b in boxes.iter().skip(i + 1) {
            assert!(!room::inside(&[b.to_vec()], 0.25 * a.iter().sum::<DVec2>()));
        }
    }
}

#[test]
fn two_pieces_do_not_overlap_and_no_words_of_one_are_in_the_other() {
    let pieces = [sleeve(), Piece { name: "second".to_owned(), ..sleeve() }];
    let sheet = sheet(&pieces, heading(), SheetUnit::Inch);
    let extent = |placed: &Placed<'_>| {
        let (low, high) = placed.piece.bounds();
        (low + placed.offset, high + placed.offset)
    };
    let [(low, high), (other_low, other_high)] = [0, 1].map(|i| extent(&sheet.pieces[i]));
    assert!(high.x + 10.0 < other_low.x, "{high} {other_low}");
    for (placed, low, high) in [(0, low, high), (1, other_low, other_high)] {
        for item in &sheet.pieces[placed].items {
            for corner in corners(&item.shape).into_iter().flatten() {
                assert!(corner.cmpge(low).all() && corner.cmple(high).all(), "{item:?}");
            }
        }
    }
    // The title lies below both.
    for item in &sheet.items {
        for corner in corners(&item.shape).into_iter().flatten() {
            assert!(corner.y < low.y, "{item:?}");
        }
    }
    assert!(texts(&sheet).contains(&"seam 1 left: 7.37 in, sewn to seam 1 right"));
    assert!(sheet.all().any(|item| item.id == "outline_of_piece_2"));
}

#[test]
fn what_finds_no_place_on_a_small_piece_stands_in_the_title() {
    let mut small = sleeve();
    for points in
        small.cut.iter_mut().chain(small.edges.iter_mut().flatten().map(|e| &mut e.points))
    {
        points.iter_mut().for_each(|p| *p *= 0.08);
    }
    small.marks.iter_mut().for_each(|mark| mark.at *= 0.08);
    let pieces = [small];
    let sheet = sheet(&pieces, heading(), SheetUnit::Millimetre);
    let texts = texts(&sheet);
    assert!(texts.iter().any(|text| text.starts_with("1: 17.2 mmHg at")), "{texts:?}");
    assert!(texts.iter().any(|text| text.contains("Knee")), "{texts:?}");
    assert!(sheet.size.min_element() > 50.0 && sheet.size.is_finite());
}
