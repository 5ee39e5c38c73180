use glam::DVec3;

use super::*;
use crate::cutting::{Side, TOLERANCE};
use crate::geometry::shapes::grid;
use crate::seams::open_to_disk;
use crate::surface::Surface;

/// A tube of radius 40 mm and 120 mm long, already slit, and its pattern: 200 mm wide, leaning.
fn tube() -> (CutSurface, Vec<DVec2>) {
    let surface: Surface = grid(24, 40, false, |s, t| {
        let (sin, cos) = (std::f64::consts::TAU * (s % 1.0)).sin_cos();
        DVec3::new(40.0 * cos, 40.0 * sin, 120.0 * t)
    });
    let cut = open_to_disk(&surface, &[]).unwrap();
    let lean =
        |i: u32, j: u32| DVec2::new(5.0 * f64::from(j) + 1.5 * f64::from(i), 5.0 * f64::from(i));
    let plane = (0..=24).flat_map(|i| (0..=40).map(move |j| lean(i, j))).collect();
    (cut, plane)
}

fn wanted<'a>(tube: &'a (CutSurface, Vec<DVec2>), piece: &'a design::Piece) -> Wanted<'a> {
    let marks = vec![Mark {
        kind: MarkKind::Pressure,
        at: DVec2::new(100.0, 60.0),
        words: "1: 20 mmHg".to_owned(),
    }];
    let (cut, coordinates) = tube;
    Wanted { cut, coordinates, piece, fabric: "weave", marks, overlaps: false }
}

#[test]
fn a_tube_has_two_sewn_sides_a_top_and_a_bottom() {
    let tube = tube();
    let design = design::Piece::default();
    let (pieces, warnings) = pieces(&wanted(&tube, &design));
    assert!(warnings.is_empty(), "{warnings:?}");
    let [piece] = &pieces[..] else { panic!("{}", pieces.len()) };
    assert_eq!(piece.edges.len(), 1);
    let kinds: Vec<EdgeKind> = piece.edges[0].iter().map(|edge| edge.kind).collect();
    for kind in [
        EdgeKind::Top,
        EdgeKind::Bottom,
        EdgeKind::Sewn(0, Side::Left),
        EdgeKind::Sewn(0, Side::Right),
    ] {
        assert_eq!(kinds.iter().filter(|other| **other == kind).count(), 1, "{kinds:?}");
    }
    let side = f64::hypot(36.0, 120.0);
    for note in &piece.seams {
        assert!((note.length_mm - side).abs() < 1e-6, "{note:?}");
    }
    let mut names: Vec<&str> = piece.seams.iter().map(|note| note.name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["seam 1 left", "seam 1 right"]);
    assert_eq!(piece.name, "brace");
    assert_eq!(piece.material, "weave");
    // Without allowance it is as large as the pattern.
    assert!((piece.cut_area() - 200.0 * 120.0).abs() < 1e-6);
    let (low, high) = piece.bounds();
    assert!((high - low).distance(DVec2::new(236.0, 120.0)) < 1e-9);
}

#[test]
fn allowances_lie_outside_and_notches_of_both_sides_meet() {
    let tube = tube();
    let design = design::Piece {
        seam_allowance_mm: 8.0,
        top_allowance_mm: 12.0,
        name: " Brace ".to_owned(),
        material: "knit".to_owned(),
        quantity: 2,
        ..design::Piece::default()
    };
    let (pieces, warnings) = pieces(&wanted(&tube, &design));
    assert!(warnings.is_empty(), "{warnings:?}");
    let piece = &pieces[0];
    assert_eq!(
        (piece.name.as_str(), piece.material.as_str(), piece.quantity),
        ("Brace", "knit", 2)
    );
    assert_eq!(piece.cut.len(), 1);
    // No slit along the seam's way through the allowance of the top: the outline is short.
    let outline = &piece.cut[0];
    let around: f64 =
        outline.iter().zip(outline.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum();
    assert!(around < 2.0 * (200.0 + 16.0) + 2.0 * (126.0 + 14.0) + 10.0, "{around}");
    let sides = |side: Side| -> Vec<f64> {
        piece.notches.iter().filter(|n| n.side == side).map(|n| n.along_mm).collect()
    };
    let (left, right) = (sides(Side::Left), sides(Side::Right));
    // 125.3 mm in three parts of 50, about; the first is double.
    assert_eq!(left.len(), 4.min(left.len()));
    assert!(left.len() >= 2);
    for (l, r) in left.iter().zip(&right) {
        assert!((l - r).abs() < 0.05, "{l} {r}");
    }
    assert!(piece.notches.iter().all(|n| n.slit && (n.at.distance(n.sewn_at) - 8.0).abs() < 1e-9));
}

#[test]
fn an_outline_that_crosses_itself_gets_no_allowance_and_says_so() {
    let tube = tube();
    let design = design::Piece { seam_allowance_mm: 8.0, ..design::Piece::default() };
    let crossing = Wanted { overlaps: true, ..wanted(&tube, &design) };
    let (pieces, warnings) = pieces(&crossing);
    assert_eq!(warnings[0].code, "allowance_left_out");
    assert!(pieces[0].edges.iter().flatten().all(|edge| edge.allowance == 0.0));
}

#[test]
fn an_allowance_that_is_too_wide_is_told_with_what_is_used() {
    // The bottom bends round in a bay, 40 mm wide.
    let (cut, mut plane) = tube();
    for p in &mut plane {
        let share = 1.0 - p.y / 120.0;
        let bay = ((p.x - 80.0 - 0.3 * p.y) / 20.0).powi(2);
        p.y += 90.0 * share * (-bay * bay).exp();
    }
    let tube = (cut, plane);
    let design = design::Piece { bottom_allowance_mm: 60.0, ..design::Piece::default() };
    let (pieces, warnings) = pieces(&wanted(&tube, &design));
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert_eq!(warnings[0].code, "allowance_narrowed");
    let bottom = pieces[0].edges.iter().flatten().find(|edge| edge.kind == EdgeKind::Bottom);
    let used = bottom.unwrap().allowance;
    assert!((5.0..30.0).contains(&used), "{used}");
    let said = "with 60 mm of allowance at the bottom the cut line would cross itself";
    assert!(warnings[0].message.starts_with(said), "{}", warnings[0].message);
    let remedy = format!("set piece.bottom_allowance_mm to {used:.0} or less");
    assert!(warnings[0].message.contains(&remedy), "{}", warnings[0].message);
}

#[test]
fn smoothing_stays_within_its_tolerance() {
    let tube = tube();
    let design = design::Piece::default();
    let raw = edges(&tube.0, &tube.1).0.remove(0);
    let (pieces, _) = pieces(&wanted(&tube, &design));
    for (edge, before) in pieces[0].edges.iter().flatten().zip(raw.iter().flatten()) {
        for (p, q) in edge.points.iter().zip(&before.points) {
            assert!(p.distance(*q) <= TOLERANCE);
        }
    }
}

#[test]
fn a_pattern_cut_apart_gives_two_pieces_whose_sides_are_alike() {
    // Along the column of vertices at 75 mm, where the tube's vertices are 41 to a row.
    let (cut, plane) = tube();
    let chain: Vec<crate::surface::VertexId> =
        (0..=24).rev().map(|i| crate::surface::VertexId::new(41 * i + 15)).collect();
    let tube = (CutSurface { splits: vec![chain], ..cut }, plane);
    let design = design::Piece { name: "arm".to_owned(), ..design::Piece::default() };
    let (pieces, warnings) = pieces(&wanted(&tube, &design));
    assert!(warnings.is_empty(), "{warnings:?}");
    let names: Vec<&str> = pieces.iter().map(|piece| piece.name.as_str()).collect();
    assert_eq!(names, ["arm 1", "arm 2"]);
    let mut areas: Vec<f64> = pieces.iter().map(Piece::cut_area).collect();
    areas.sort_by(f64::total_cmp);
    assert!((areas[0] - 75.0 * 120.0).abs() < 1.0 && (areas[1] - 125.0 * 120.0).abs() < 1.0);
    // Each side of both seams once, the new seam's sides on different pieces and equally long.
    let side = |name: &str| {
        let has = |piece: &Piece| piece.seams.iter().find(|note| note.name == name).cloned();
        let found: Vec<(usize, SeamNote)> =
            pieces.iter().enumerate().filter_map(|(i, p)| Some((i, has(p)?))).collect();
        assert_eq!(found.len(), 1, "{name}");
        found[0].clone()
    };
    let [(one, left), (other, right)] = [side("seam 2 left"), side("seam 2 right")];
    assert!(one != other && (left.length_mm - right.length_mm).abs() < 1e-9);
    let (own, _) = side("seam 1 left");
    let (opposite, _) = side("seam 1 right");
    assert_ne!(own, opposite);
    // The point at (100, 60) lies on one of them alone.
    assert_eq!(pieces.iter().map(|piece| piece.marks.len()).sum::<usize>(), 1);
    for piece in &pieces {
        assert!(piece.edges[0].iter().any(|edge| edge.kind == EdgeKind::Top));
        assert!(piece.edges[0].iter().any(|edge| edge.kind == EdgeKind::Bottom));
    }
}

#[test]
fn a_seam_across_which_pieces_part_is_named_in_two_parts() {
    // Round the limb, along the row of vertices at 50 mm.
    let (cut, plane) = tube();
    let chain: Vec<crate::surface::VertexId> =
        (0..=40).map(|j| crate::surface::VertexId::new(41 * 10 + j)).collect();
    let tube = (CutSurface { splits: vec![chain], ..cut }, plane);
    let design = design::Piece::default();
    let (pieces, _) = pieces(&wanted(&tube, &design));
    assert_eq!(pieces.len(), 2);
    let mut names: Vec<(String, f64)> = pieces
        .iter()
        .flat_map(|piece| &piece.seams)
        .map(|note| (note.name.clone(), note.length_mm.round()))
        .collect();
    names.sort_by(|a, b| a.0.cmp(&b.0));
    let names: Vec<(&str, f64)> = names.iter().map(|(name, mm)| (name.as_str(), *mm)).collect();
    // The seam leans by 1.5 in 5: 50 and 70 mm of height.
    let (one, other) = (names[0].1, names[2].1);
    assert_eq!(one.min(other), 52.0);
    assert_eq!(one.max(other), 73.0);
    assert_eq!(
        names,
        [
            ("seam 1a left", one),
            ("seam 1a right", one),
            ("seam 1b left", other),
            ("seam 1b right", other),
            ("seam 2 left", 200.0),
            ("seam 2 right", 200.0),
        ]
    );
}
