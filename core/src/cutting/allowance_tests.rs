use super::*;
use crate::cutting::edges::{EdgeKind, Side};

fn edge(kind: EdgeKind, points: &[(f64, f64)]) -> Edge {
    Edge { kind, points: points.iter().map(|p| DVec2::from(*p)).collect(), allowance: 0.0 }
}

/// 100 × 60 mm: bottom, right side, top, left side; `lean` moves the top to the right.
fn plate(lean: f64) -> [Edge; 4] {
    let (a, b, c, d) = ((0.0, 0.0), (100.0, 0.0), (100.0 + lean, 60.0), (lean, 60.0));
    [
        edge(EdgeKind::Bottom, &[a, b]),
        edge(EdgeKind::Sewn(0, Side::Right), &[b, c]),
        edge(EdgeKind::Top, &[c, d]),
        edge(EdgeKind::Sewn(0, Side::Left), &[d, a]),
    ]
}

fn wide(edges: &[Edge], seam: f64, top: f64, bottom: f64) -> Vec<Edge> {
    let of = |kind| match kind {
        EdgeKind::Sewn(..) => seam,
        EdgeKind::Top => top,
        EdgeKind::Bottom => bottom,
        EdgeKind::Free => 0.0,
    };
    edges.iter().map(|edge| Edge { allowance: of(edge.kind), ..edge.clone() }).collect()
}

/// Whether a loop has a corner within a hundredth of a millimetre of a place.
fn has(line: &CutLine, x: f64, y: f64) -> bool {
    line.loops.iter().flatten().any(|p| p.distance(DVec2::new(x, y)) < 0.01)
}

#[test]
fn without_allowance_the_cut_line_is_the_sew_line() {
    let edges = plate(0.0);
    let line = cut_line(&[wide(&edges, 0.0, 0.0, 0.0)]);
    assert_eq!(
        line.loops[0],
        [(0.0, 0.0), (100.0, 0.0), (100.0, 60.0), (0.0, 60.0)].map(DVec2::from)
    );
    assert!(line.extensions.is_empty());
}

#[test]
fn an_upright_plate_has_rectangular_allowances_of_their_own_widths() {
    let edges = plate(0.0);
    let line = cut_line(&[wide(&edges, 10.0, 20.0, 5.0)]);
    assert_eq!(line.loops.len(), 1);
    for (x, y) in [(-10.0, -5.0), (110.0, -5.0), (110.0, 80.0), (-10.0, 80.0)] {
        assert!(has(&line, x, y), "{x} {y}: {line:?}");
    }
    assert!((area(&line.loops[0]) - 120.0 * 85.0).abs() < 0.01);
    // The sew lines go on to the cut edges: 20 mm at the top, 5 mm at the bottom.
    let mut lengths: Vec<f64> = line.extensions.iter().map(|[a, b]| a.distance(*b)).collect();
    lengths.sort_by(f64::total_cmp);
    for (got, wanted) in lengths.iter().zip([5.0, 5.0, 20.0, 20.0]) {
        assert!((got - wanted).abs() < 1e-9);
    }
}

#[test]
fn a_seams_allowance_pressed_open_ends_where_the_brace_ends() {
    // Leaning by 20 over 60: the top left corner is obtuse, the bottom left one acute.
    let edges = plate(20.0);
    let line = cut_line(&[wide(&edges, 10.0, 0.0, 0.0)]);
    let (top, bottom) = (DVec2::new(20.0, 60.0), DVec2::ZERO);
    let seam = (top - bottom).normalize();
    for corner in [top, bottom, DVec2::new(100.0, 0.0), DVec2::new(120.0, 60.0)] {
        // The end of the allowance, 10 mm from the sew line, mirrored in it, lies on the edge.
        let ends: Vec<DVec2> = line.loops[0]
            .iter()
            .filter(|p| ((**p - corner).perp_dot(seam).abs() - 10.0).abs() < 0.01)
            .map(|p| 2.0 * (*p - corner).dot(seam) * seam - (*p - corner) + corner)
            .filter(|p| (p.y - corner.y).abs() < 0.01)
            .collect();
        assert_eq!(ends.len(), 1, "{corner}: {line:?}");
        assert!(ends[0].x > bottom.x && ends[0].x < 120.0);
    }
}

#[test]
fn a_hem_turned_down_is_as_wide_as_the_brace() {
    let edges = plate(20.0);
    let line = cut_line(&[wide(&edges, 0.0, 15.0, 0.0)]);
    // The sides mirrored in the top: leaning back by 5 over 15.
    assert!(has(&line, 15.0, 75.0) && has(&line, 115.0, 75.0), "{line:?}");
    assert!((area(&line.loops[0]) - 100.0 * 75.0).abs() < 0.01);
    // Both sides of the seam go on by the same length, so that they can be sewn through.
    let [one, other] = [line.extensions[0], line.extensions[1]].map(|[a, b]| a.distance(b));
    assert!((one - other).abs() < 1e-9 && (one - f64::hypot(5.0, 15.0)).abs() < 1e-9);
}

#[test]
fn a_hole_becomes_smaller_and_a_mitre_is_square() {
    let outer = [(0.0, 0.0), (80.0, 0.0), (80.0, 80.0), (0.0, 80.0), (0.0, 0.0)];
    let hole = [(30.0, 30.0), (30.0, 50.0), (50.0, 50.0), (50.0, 30.0), (30.0, 30.0)];
    let of = |points: &[(f64, f64)]| vec![Edge { allowance: 4.0, ..edge(EdgeKind::Free, points) }];
    let line = cut_line(&[of(&outer), of(&hole)]);
    assert_eq!(line.loops.len(), 2);
    assert!((area(&line.loops[0]) - 88.0 * 88.0).abs() < 0.01, "{:?}", line.loops[0]);
    assert!((area(&line.loops[1]) + 12.0 * 12.0).abs() < 0.01, "{:?}", line.loops[1]);
}

#[test]
fn round_a_circle_the_allowance_is_everywhere_as_wide() {
    let circle: Vec<(f64, f64)> = (0..=180)
        .map(|i| (60.0 * DVec2::from_angle(f64::from(i) * std::f64::consts::PI / 90.0)).into())
        .collect();
    let line = cut_line(&[vec![Edge { allowance: 8.0, ..edge(EdgeKind::Free, &circle) }]]);
    assert_eq!(line.loops.len(), 1);
    for p in &line.loops[0] {
        // The polygon's corners are mitred: 68 mm over the cosine of a degree.
        assert!((p.length() - 68.0).abs() < 0.012, "{}", p.length());
    }
}
