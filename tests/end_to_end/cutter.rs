//! The pattern as a workshop gets it: formats, allowances, notches, pieces, refusals.

use glam::DVec2;
use roxmltree::Document;
use serde_json::{Value, json};
use support::check::WornObj;
use support::cli::Bench;
use support::fixtures::tube_with_hole;

use super::{FAST, limb};

const FILES: [&str; 9] = [
    "pattern.svg",
    "pattern.pdf",
    "pattern-a4.pdf",
    "pattern-letter.pdf",
    "pattern.dxf",
    "pattern-astm.dxf",
    "pattern-gerber.dxf",
    "pattern.plt",
    "pattern.png",
];
const ALL: &str = "svg,pdf,pdf-a4,pdf-letter,dxf,dxf-astm,dxf-gerber,hpgl,png";

fn with_piece(design: &Value, piece: Value) -> Value {
    let mut changed = design.clone();
    changed["piece"] = piece;
    changed
}

/// The points of every path of an SVG whose id is asked for.
fn paths(svg: &str, wanted: impl Fn(&str) -> bool) -> Vec<(String, Vec<DVec2>)> {
    let document = Document::parse(svg).unwrap();
    document
        .descendants()
        .filter(|n| n.attribute("id").is_some_and(&wanted) && n.has_attribute("d"))
        .map(|n| {
            let numbers: Vec<f64> =
                n.attribute("d").unwrap().split(' ').filter_map(|x| x.parse().ok()).collect();
            let points = numbers.chunks_exact(2).map(DVec2::from_slice).collect();
            (n.attribute("id").unwrap().to_owned(), points)
        })
        .collect()
}

fn length(points: &[DVec2]) -> f64 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn extent(points: &[DVec2]) -> DVec2 {
    let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max) - low
}

#[test]
fn every_format_is_written_and_the_same_input_gives_the_same_bytes() {
    let (mesh, design) = limb();
    let design = with_piece(&design, json!({"name": "sleeve", "seam_allowance_mm": 8}));
    let args = [&FAST[..], &["--format", ALL]].concat();
    let (one, other) = (Bench::new(), Bench::new());
    let _ = one.flatten(&mesh, &design, &args).succeeded();
    let _ = other.flatten(&mesh, &design, &args).succeeded();
    let mut names: Vec<&str> = FILES.to_vec();
    names.extend(["flat.obj", "report.html", "report.json", "worn.obj"]);
    names.sort_unstable();
    assert_eq!(one.results(), names);
    for name in FILES {
        assert!(one.out(name) == other.out(name), "{name} differs");
        assert!(one.out(name).len() > 1000, "{name}");
    }
    // Only what is asked for, and inches where they are asked for.
    let inch = Bench::new();
    let args = [&FAST[..], &["--format", "dxf", "--pattern-units", "in"]].concat();
    let _ = inch.flatten(&mesh, &design, &args).succeeded();
    assert_eq!(
        inch.results(),
        ["flat.obj", "pattern.dxf", "report.html", "report.json", "worn.obj"]
    );
    let text = String::from_utf8(inch.out("pattern.dxf")).unwrap();
    assert!(text.contains("$INSUNITS\n 70\n1\n"), "inches");
}

#[test]
fn the_cut_line_lies_outside_the_sew_line_by_the_allowances() {
    let (mesh, design) = limb();
    let piece = json!({"seam_allowance_mm": 10, "top_allowance_mm": 20, "bottom_allowance_mm": 5});
    let bench = Bench::new();
    let _ = bench.flatten(&mesh, &with_piece(&design, piece), &FAST).succeeded();
    let svg = String::from_utf8(bench.out("pattern.svg")).unwrap();
    let outline = &paths(&svg, |id| id == "outline")[0].1;
    let sewn = paths(&svg, |id| id.starts_with("seam_1_"));
    // Every point of the cut line beside the middle of a side is 10 mm from it.
    for (_, side) in &sewn {
        for k in side.len() / 4..3 * side.len() / 4 {
            let gap = |p: DVec2| {
                let way = (side[k + 1] - side[k]).normalize();
                let along = (p - side[k]).dot(way);
                ((0.0..side[k].distance(side[k + 1])).contains(&along))
                    .then(|| (p - side[k]).perp_dot(way).abs())
            };
            let near = outline.iter().filter_map(|p| gap(*p)).fold(f64::MAX, f64::min);
            assert!(near > 9.9, "{near}");
        }
    }
    // Both sides of the seam kept their lengths, within what smoothing may change.
    let worn: WornObj = bench.worn();
    let seam = &worn.seams()[0];
    let mut before = [seam.left_mm, seam.right_mm];
    let mut after = [length(&sewn[0].1), length(&sewn[1].1)];
    before.sort_by(f64::total_cmp);
    after.sort_by(f64::total_cmp);
    for (a, b) in before.iter().zip(after) {
        assert!((a - b).abs() < 0.025, "{before:?} {after:?}");
    }
    assert!((extent(outline).x - worn.size().x - 20.0).abs() < 6.0);
}

#[test]
fn every_wish_of_the_piece_changes_the_pattern() {
    let (mesh, design) = limb();
    let svg = |piece: Value| {
        let bench = Bench::new();
        let _ = bench.flatten(&mesh, &with_piece(&design, piece), &FAST).succeeded();
        bench.out("pattern.svg")
    };
    let before = svg(json!({}));
    for piece in [
        json!({"name": "left"}),
        json!({"reference": "job 17"}),
        json!({"date": "2026-11-26"}),
        json!({"quantity": 2}),
        json!({"material": "knit"}),
        json!({"seam_allowance_mm": 6}),
        json!({"top_allowance_mm": 6}),
        json!({"bottom_allowance_mm": 6}),
        json!({"notch_spacing_mm": 0}),
    ] {
        assert!(svg(piece.clone()) != before, "{piece} changes nothing");
    }
    assert!(svg(json!({"quantity": 1})) == before);
}

#[test]
fn bad_values_are_refused_with_the_key_and_nothing_is_written() {
    let (mesh, design) = limb();
    for (piece, words) in [
        (json!({"seam_allowance_mm": -1}), &["`piece.seam_allowance_mm` is -1", "at least 0"][..]),
        (json!({"top_allowance_mm": 1e6}), &["`piece.top_allowance_mm`", "at most 100"]),
        (json!({"quantity": 0}), &["`piece.quantity` is 0", "at least 1"]),
        (json!({"quantity": 1.5}), &["`piece.quantity` is 1.5", "whole number"]),
        (json!({"notch_spacing_mm": 3}), &["`piece.notch_spacing_mm` is 3", "10 mm or more"]),
        (json!({"allowance": 3}), &["`piece.allowance` is not a known key"]),
    ] {
        let bench = Bench::new();
        bench.flatten(&mesh, &with_piece(&design, piece), &FAST).refused(1, words);
        assert!(bench.results().is_empty());
    }
    let bench = Bench::new();
    let args = [&FAST[..], &["--format", "docx"]].concat();
    bench.flatten(&mesh, &design, &args).refused(2, &["docx", "dxf-astm"]);
    let args = [&FAST[..], &["--pattern-units", "cm"]].concat();
    bench.flatten(&mesh, &design, &args).refused(2, &["cm"]);
}

#[test]
fn names_that_a_format_cannot_hold_are_said_with_what_is_written() {
    let (mesh, design) = limb();
    let piece = json!({"name": "Käthes sehr langer Ärmel, 膝", "material": "Gewebe β"});
    let bench = Bench::new();
    let args = [&FAST[..], &["--format", "svg,dxf,pdf,dxf-gerber"]].concat();
    let run = bench.flatten(&mesh, &with_piece(&design, piece), &args).succeeded();
    let note = |file: &str| {
        run.stderr.lines().filter(|l| l.starts_with(&format!("note: {file} "))).count()
    };
    assert!(note("pattern-gerber.dxf") >= 2 && note("pattern.pdf") >= 1, "{}", run.stderr);
    assert_eq!((note("pattern.svg"), note("pattern.dxf")), (0, 0), "{}", run.stderr);
    let gerber = String::from_utf8(bench.out("pattern-gerber.dxf")).unwrap();
    assert!(gerber.is_ascii() && gerber.contains("Piece Name: Kaethes sehr langer\n"));
    assert!(gerber.contains("Material: Gewebe ?\n"));
    let dxf = String::from_utf8(bench.out("pattern.dxf")).unwrap();
    assert!(dxf.is_ascii() && dxf.contains("K\\U+00E4thes"));
}

#[test]
fn an_allowance_that_would_cross_itself_is_made_narrower_and_told() {
    let mesh = tube_with_hole(42.0, 120.0, 12.0, 48);
    let design = with_piece(&support::design::wanting(&[]), json!({"edge_allowance_mm": 30}));
    let bench = Bench::new();
    let run = bench.flatten(&mesh, &design, &FAST).succeeded();
    assert!(run.stderr.contains("with 30 mm of allowance at an edge"), "{}", run.stderr);
    let report = bench.report();
    let warnings = report["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|w| w["code"] == "allowance_narrowed"), "{warnings:?}");
    let svg = String::from_utf8(bench.out("pattern.svg")).unwrap();
    let hole = &paths(&svg, |id| id == "cut_out_1")[0].1;
    // The hole is 24 mm wide: some of it is left.
    let left = extent(hole);
    assert!(left.min_element() > 0.5 && left.max_element() < 24.0, "{left}");
}

#[test]
fn seams_that_split_the_limb_give_pieces_side_by_side() {
    let (mesh, mut design) = limb();
    let seam = |angle: f64| {
        let at = |z: f64| json!([42.0 * angle.cos(), 42.0 * angle.sin(), z]);
        json!([at(0.0), at(55.0), at(110.0)])
    };
    design["seams"] = json!([seam(2.5), seam(4.5)]);
    design["piece"] = json!({"name": "arm", "seam_allowance_mm": 8});
    let bench = Bench::new();
    let args = [&FAST[..], &["--format", "svg,dxf-astm"]].concat();
    let run = bench.flatten(&mesh, &design, &args).succeeded();
    assert!(run.stderr.contains("split the brace into 2 pieces"), "{}", run.stderr);
    let svg = String::from_utf8(bench.out("pattern.svg")).unwrap();
    let outlines = paths(&svg, |id| id.starts_with("outline"));
    assert_eq!(outlines.len(), 2);
    // Side by side: their boxes do not meet.
    let ends = |points: &[DVec2]| {
        let xs = || points.iter().map(|p| p.x);
        (xs().fold(f64::MAX, f64::min), xs().fold(f64::MIN, f64::max))
    };
    let (first, second) = (ends(&outlines[0].1), ends(&outlines[1].1));
    assert!(first.1 < second.0, "{first:?} {second:?}");
    // Of each seam both sides, equally long.
    for seam in 1..=2 {
        let sides = paths(&svg, |id| id.starts_with(&format!("seam_{seam}_")));
        assert_eq!(sides.len(), 2, "seam {seam}");
        let gap = (length(&sides[0].1) - length(&sides[1].1)).abs();
        assert!(gap < 0.1, "seam {seam}: {gap}");
    }
    let astm = String::from_utf8(bench.out("pattern-astm.dxf")).unwrap();
    assert!(astm.contains("Piece Name: arm 1\n") && astm.contains("Piece Name: arm 2\n"));
}
