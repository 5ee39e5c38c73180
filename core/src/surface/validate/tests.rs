use std::f64::consts::TAU;

use super::*;
use crate::surface::{DefectKind, Format, Shape, SurfaceError, read, shape_of};

const OPTIONS: SurfaceOptions = SurfaceOptions {
    unit: LengthUnit::Millimetre,
    keep_largest: false,
    close_holes: 0.0,
    facing: None,
};

/// A tube along z, 100 mm round and `10 rows` mm long, of `2 × 20 × rows` outward triangles;
/// triangle `2 (20 j + i)` and the next make the square in column `i` and row `j`.
fn tube(rows: usize) -> RawMesh {
    grid(20, rows, true)
}

/// The tube, closed round by sharing vertices or left with a cut at its first column.
fn grid(columns: usize, rows: usize, closed: bool) -> RawMesh {
    let stride = if closed { columns } else { columns + 1 };
    let radius = 100.0 / TAU;
    let points = (0..=rows).flat_map(|j| {
        (0..stride).map(move |i| {
            let angle = TAU * (i % columns) as f64 / columns as f64;
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 10.0 * j as f64)
        })
    });
    let mut triangles = Vec::new();
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let id = |i: usize, j: usize| i % stride + stride * j;
        let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        triangles.push([a, b, c]);
        triangles.push([a, c, d]);
    }
    RawMesh::from_triangles(points.collect(), &triangles)
}

fn reversed(mut raw: RawMesh) -> RawMesh {
    raw.polygons.iter_mut().for_each(|p| p.reverse());
    raw
}

/// Every triangle with points of its own.
fn soup(raw: &RawMesh) -> RawMesh {
    let points: Vec<DVec3> = raw.polygons.iter().flatten().map(|&v| raw.points[v]).collect();
    let polygons = (0..raw.polygons.len()).map(|t| vec![3 * t, 3 * t + 1, 3 * t + 2]).collect();
    RawMesh { points, polygons }
}

/// Both meshes in one, as separate pieces.
fn together(a: &RawMesh, b: &RawMesh) -> RawMesh {
    let mut all = a.clone();
    all.points.extend(&b.points);
    let shifted = |p: &Vec<usize>| p.iter().map(|v| v + a.points.len()).collect();
    all.polygons.extend(b.polygons.iter().map(shifted));
    all
}

fn moved(mut raw: RawMesh, by: DVec3) -> RawMesh {
    raw.points.iter_mut().for_each(|p| *p += by);
    raw
}

fn codes(valid: &Validated) -> Vec<&'static str> {
    valid.warnings.iter().map(|w| w.code).collect()
}

fn error(raw: &RawMesh) -> SurfaceError {
    validate(raw, &OPTIONS).unwrap_err()
}

/// The only defect's kind, message and place.
fn only(raw: &RawMesh) -> (DefectKind, String, Option<[f64; 3]>) {
    let error = error(raw);
    assert_eq!(error.defects().len(), 1, "{error}");
    let defect = &error.defects()[0];
    (defect.kind, defect.to_string(), defect.at)
}

/// Whether the surface encloses a positive volume when the ends of the tube are capped.
fn is_outward(surface: &Surface) -> bool {
    surface.triangle_ids().all(|t| {
        let [a, b, c] = surface.corners(t);
        let axial = (a + b + c) / 3.0;
        surface.normal(t).dot(DVec3::new(axial.x, axial.y, 0.0)) > 0.0
    })
}

#[test]
fn a_sound_tube_passes_unchanged() {
    let raw = tube(6);
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert!(valid.warnings.is_empty(), "{:?}", valid.warnings);
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(valid.source, (0..raw.points.len()).collect::<Vec<_>>());
    assert!(is_outward(&valid.surface));
    let off = |(p, q): (&DVec3, &DVec3)| p.distance(*q);
    let most = valid.surface.points().iter().zip(&raw.points).map(off).fold(0.0, f64::max);
    assert!(most < 1e-6 && most > 0.0, "the grid moves points by a nanometre: {most}");
}

#[test]
fn a_limb_in_any_unit_is_the_same_to_the_last_bit() {
    // Coordinates as a file in millimetres with six decimals has them.
    let mut millimetres = moved(tube(6), DVec3::new(123.4, -56.7, 200.1));
    millimetres.points.iter_mut().for_each(|p| *p = (*p * 1e6).round() / 1e6);
    let want = validate(&millimetres, &OPTIONS).unwrap();
    for unit in LengthUnit::ALL {
        let mut raw = millimetres.clone();
        raw.points.iter_mut().for_each(|p| *p /= unit.millimetres());
        let got = validate(&raw, &SurfaceOptions { unit, ..OPTIONS }).unwrap();
        assert_eq!(got, want, "{unit:?}");
    }
}

#[test]
fn empty_meshes_are_named() {
    let nothing = RawMesh::default();
    let cloud = RawMesh { points: vec![DVec3::X], polygons: Vec::new() };
    for raw in [nothing, cloud] {
        assert_eq!(
            only(&raw),
            (
                DefectKind::Empty,
                "the mesh has no faces: export the surface as a mesh of triangles".to_owned(),
                None
            )
        );
    }
}

#[test]
fn coordinates_that_are_no_numbers_are_named() {
    let mut raw = tube(2);
    raw.points[7].y = f64::NAN;
    raw.points[9] = DVec3::new(1.0, 2.0, f64::NEG_INFINITY);
    raw.points[11] = DVec3::new(1.0, 2.0, 1e10);
    // One that no face uses does no harm.
    raw.points.push(DVec3::NAN);
    let error = error(&raw);
    let found: Vec<_> = error.defects().iter().map(|d| (d.kind, d.vertices.clone())).collect();
    assert_eq!(found, [7, 9, 11].map(|v| (DefectKind::NotFinite, vec![v])));
    assert!(
        error.defects()[0].message.starts_with("vertex 7 has a coordinate that is not a number, (")
    );
    assert_eq!(
        error.defects()[1].to_string(),
        "vertex 9 has an infinite coordinate, (1, 2, -inf) mm: delete the vertex or export again"
    );
    assert_eq!(
        error.defects()[2].to_string(),
        "vertex 11 has a coordinate of more than a thousand kilometres, (1, 2, 10000000000) mm: \
         delete the vertex or export again"
    );
    assert_eq!(error.defects()[2].at, Some([1.0, 2.0, 1e10]));
    assert_eq!(error.defects()[1].at, None);
}

#[test]
fn an_index_out_of_range_is_named() {
    let raw = RawMesh::from_triangles(
        vec![DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::Y],
        &[[0, 1, 2], [0, 1, 99]],
    );
    assert_eq!(
        only(&raw),
        (
            DefectKind::IndexOutOfRange,
            "face 1 at (1.00, 0.00, 0.00) mm names vertex 99, but there are 3 vertices: export \
             the mesh again"
                .to_owned(),
            Some([1.0, 0.0, 0.0])
        )
    );
}

#[test]
fn degenerate_triangles_are_named() {
    // A vertex between two others, on the last ring of a tube whose other vertices stay.
    let mut raw = tube(2);
    let [a, b] = [raw.points[40], raw.points[41]];
    raw.points.push(0.5 * (a + b));
    raw.polygons.push(vec![41, 40, 60]);
    let (kind, message, at) = only(&raw);
    assert_eq!(kind, DefectKind::DegenerateTriangle);
    assert_eq!(
        message,
        "face 80 at (15.53, 2.46, 20.00) mm has no area (its corners 41, 40 and 60 lie on one \
         line or point): delete it or merge its close vertices"
    );
    assert!(DVec3::from(at.unwrap()).distance(0.5 * (a + b)) < 1e-5);

    let mut raw = tube(2);
    raw.polygons.push(vec![40, 41, 41]);
    let (kind, message, _) = only(&raw);
    assert_eq!(kind, DefectKind::DegenerateTriangle);
    assert_eq!(
        message,
        "face 80 at (15.53, 2.46, 20.00) mm has no area (2 corners): delete it or merge its close \
         vertices"
    );
}

#[test]
fn a_face_without_corners_is_named() {
    let mut raw = tube(2);
    raw.polygons.push(Vec::new());
    let (_, message, at) = only(&raw);
    assert_eq!(message, "face 80 has no area (0 corners): delete it or merge its close vertices");
    assert_eq!(at, None);
}

#[test]
fn duplicate_triangles_are_named() {
    let mut raw = tube(2);
    let mut copy = raw.polygons[3].clone();
    copy.rotate_left(1);
    raw.polygons.push(copy);
    let (kind, message, at) = only(&raw);
    assert_eq!(kind, DefectKind::DuplicateTriangle);
    assert_eq!(
        message,
        "faces 3 and 80 at (14.38, 6.40, 6.67) mm have the same corners 1, 21 and 22: delete one \
         of them"
    );
    assert!(at.is_some());
}

#[test]
fn non_manifold_edges_are_named() {
    let mut raw = tube(2);
    raw.points.push(DVec3::new(40.0, 0.0, 15.0));
    // Vertices 20 and 40 are above each other at angle 0.
    raw.polygons.push(vec![20, 40, 60]);
    let (kind, message, at) = only(&raw);
    assert_eq!(kind, DefectKind::NonManifoldEdge);
    assert_eq!(
        message,
        "the edge between vertices 20 and 40 at (15.92, 0.00, 15.00) mm belongs to 3 faces (41, \
         78 and 80) instead of one or two: delete the faces that stick out or lie inside"
    );
    assert_eq!(at.unwrap()[2], 15.0);
}

#[test]
fn a_bow_tie_is_named_at_its_vertex() {
    // Two squares of the tube taken out corner to corner: around vertex 21 remain two fans.
    let mut raw = tube(4);
    let squares = [(0, 0), (1, 1)].map(|(i, j)| 2 * (20 * j + i));
    let gone: Vec<usize> = squares.iter().flat_map(|&t| [t, t + 1]).collect();
    raw.polygons =
        (0..160).filter(|t| !gone.contains(t)).map(|t| raw.polygons[t].clone()).collect();
    let (kind, message, at) = only(&raw);
    assert_eq!(kind, DefectKind::NonManifoldVertex);
    assert_eq!(
        message,
        "the surface touches itself at vertex 21 at (15.14, 4.92, 10.00) mm: its faces form 2 \
         separate fans (faces 1 and 38 are one of each): split the vertex or delete all fans but \
         one"
    );
    assert_eq!(at.unwrap()[2], 10.0);
}

#[test]
fn a_moebius_strip_is_named_at_an_edge() {
    let n = 30;
    let point = |i: usize, side: f64| {
        let turn = TAU * i as f64 / n as f64;
        let r = 40.0 + 8.0 * side * (turn / 2.0).cos();
        DVec3::new(r * turn.cos(), r * turn.sin(), 8.0 * side * (turn / 2.0).sin())
    };
    let points = (0..n).flat_map(|i| [point(i, -1.0), point(i, 1.0)]).collect();
    let mut triangles = Vec::new();
    for i in 0..n {
        let [a, b] = [2 * i, 2 * i + 1];
        let [c, d] = if i + 1 < n { [a + 2, b + 2] } else { [1, 0] };
        triangles.push([a, c, b]);
        triangles.push([b, c, d]);
    }
    let raw = RawMesh::from_triangles(points, &triangles);
    let found = error(&raw);
    assert_eq!(found.defects().len(), 1, "{found}");
    let defect = &found.defects()[0];
    assert_eq!(defect.kind, DefectKind::NotOrientable);
    let [a, b] = [defect.vertices[0], defect.vertices[1]];
    let middle = 0.5 * (raw.points[a] + raw.points[b]);
    assert!(DVec3::from(defect.at.unwrap()).distance(middle) < 1e-5);
    for &face in &defect.faces {
        assert!(raw.polygons[face].contains(&a) && raw.polygons[face].contains(&b));
    }
    assert!(defect.message.starts_with(&format!(
        "the surface has only one side: followed all round, front meets back at the edge between \
         vertices {a} and {b} at ("
    )));
    assert!(defect.message.ends_with("cut out the twisted strip"));
}

fn tube_with_crumb() -> RawMesh {
    let crumb = RawMesh::from_triangles(
        vec![DVec3::new(60.0, 0.0, 0.0), DVec3::new(64.0, 0.0, 0.0), DVec3::new(60.0, 3.0, 2.0)],
        &[[0, 1, 2]],
    );
    together(&crumb, &tube(2))
}

#[test]
fn several_components_are_listed_from_the_largest() {
    let (kind, message, _) = only(&tube_with_crumb());
    assert_eq!(kind, DefectKind::SeveralComponents);
    assert_eq!(
        message,
        "the surface is in 2 separate pieces: 80 triangles of 32 × 32 × 20 mm round (0.00, 0.00, \
         10.00) mm; 1 triangle of 4 × 3 × 2 mm round (62.00, 1.50, 1.00) mm: delete what does not \
         belong to the limb, or keep only the largest with keep_largest"
    );
    assert_eq!(error(&tube_with_crumb()).defects()[0].faces, [1, 0]);
}

#[test]
fn keep_largest_drops_crumbs_and_their_defects() {
    let mut raw = tube_with_crumb();
    // The crumb is a bow tie and touches the limb at a vertex.
    raw.points.extend([DVec3::new(66.0, 1.0, 0.0), DVec3::new(66.0, 2.0, 3.0)]);
    let [a, b] = [raw.points.len() - 2, raw.points.len() - 1];
    raw.polygons.push(vec![1, a, b]);
    raw.polygons.push(vec![3, a, b]);
    let valid = validate(&raw, &SurfaceOptions { keep_largest: true, ..OPTIONS }).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(valid.surface.triangle_count(), 80);
    assert_eq!(valid.source[0], 3);
    assert_eq!(codes(&valid), ["components_dropped"]);
    assert_eq!(
        valid.warnings[0].message,
        "2 pieces beside the largest were dropped: 2 triangles of 50 × 2 × 3 mm round (40.96, \
         1.00, 1.50) mm; 1 triangle of 4 × 3 × 2 mm round (62.00, 1.50, 1.00) mm"
    );
}

#[test]
fn triangles_against_their_neighbours_are_turned_and_said() {
    let mut raw = tube(3);
    for t in [5, 17, 18] {
        raw.polygons[t].reverse();
    }
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert!(is_outward(&valid.surface));
    assert_eq!(codes(&valid), ["orientation_repaired"]);
    assert_eq!(
        valid.warnings[0].message,
        "3 of 120 triangles faced the other way than the rest and were turned"
    );
}

#[test]
fn an_inside_out_tube_is_reversed_cut_or_not() {
    for closed in [true, false] {
        let outward = grid(20, 20, closed);
        let valid = validate(&outward, &OPTIONS).unwrap();
        assert!(is_outward(&valid.surface));
        assert!(!codes(&valid).contains(&"reversed"));
        let valid = validate(&reversed(outward), &OPTIONS).unwrap();
        assert!(is_outward(&valid.surface));
        assert!(codes(&valid).contains(&"reversed"));
        let said = valid.warnings.iter().find(|w| w.code == "reversed").unwrap();
        assert_eq!(
            said.message,
            "the surface faced inward, by its shape, and all triangles were turned"
        );
    }
}

fn square() -> RawMesh {
    let points = (0..9).map(|i| DVec3::new(10.0 * (i % 3) as f64, 10.0 * (i / 3) as f64, 0.0));
    let mut raw = RawMesh { points: points.collect(), polygons: Vec::new() };
    raw.polygons = [0, 1, 3, 4].map(|i| vec![i, i + 1, i + 4, i + 3]).to_vec();
    raw
}

#[test]
fn a_flat_surface_needs_the_designers_word() {
    let (kind, message, at) = only(&square());
    assert_eq!(kind, DefectKind::AmbiguousFacing);
    assert_eq!(at, None);
    assert_eq!(
        message,
        "the surface is so flat, or bulges and hollows so alike, that its shape does not show \
         which side is outside: set \"facing\" in the design to \"outward\" if its faces are \
         counter-clockwise seen from outside the body, otherwise to \"inward\""
    );
    for (facing, z) in [(Facing::Outward, 1.0), (Facing::Inward, -1.0)] {
        let options = SurfaceOptions { facing: Some(facing), ..OPTIONS };
        let valid = validate(&square(), &options).unwrap();
        assert_eq!(shape_of(&valid.surface), Shape::Disk);
        assert!(valid.surface.triangle_ids().all(|t| valid.surface.normal(t).z == z));
        assert_eq!(codes(&valid), if z > 0.0 { vec![] } else { vec!["reversed"] });
    }
}

#[test]
fn the_designers_word_wins_against_the_shape_and_is_doubted() {
    let options = |facing| SurfaceOptions { facing: Some(facing), ..OPTIONS };
    let valid = validate(&tube(3), &options(Facing::Inward)).unwrap();
    assert!(!is_outward(&valid.surface));
    assert_eq!(codes(&valid), ["facing_unlikely", "reversed"]);
    let valid = validate(&reversed(tube(3)), &options(Facing::Outward)).unwrap();
    assert!(!is_outward(&valid.surface));
    assert_eq!(codes(&valid), ["facing_unlikely"]);
    let valid = validate(&tube(3), &options(Facing::Outward)).unwrap();
    assert!(codes(&valid).is_empty());
}

#[test]
fn a_quarter_of_a_tube_tells_its_side_and_a_slight_bend_does_not() {
    let patch = |columns: usize| {
        let whole = grid(20, 6, true);
        let kept = (0..whole.polygons.len()).filter(|t| (t / 2) % 20 < columns);
        let polygons = kept.map(|t| whole.polygons[t].clone()).collect();
        RawMesh { points: whole.points, polygons }
    };
    let valid = validate(&reversed(patch(5)), &OPTIONS).unwrap();
    assert!(is_outward(&valid.surface));
    assert!(codes(&valid).contains(&"reversed"));
    assert_eq!(only(&patch(1)).0, DefectKind::AmbiguousFacing);
}

#[test]
fn an_stl_tube_is_welded_to_two_loops() {
    let want = tube(4);
    let mut bytes = vec![b' '; 80];
    bytes.extend(160u32.to_le_bytes());
    for polygon in &want.polygons {
        bytes.extend([0u8; 12]);
        for &v in polygon {
            // −0 and 0 are one place.
            let p = want.points[v].to_array().map(|x| x as f32);
            bytes.extend(p.iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend([0u8; 2]);
    }
    let raw = read(&bytes, Format::Stl).unwrap();
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(valid.surface.vertex_count(), want.points.len());
    assert_eq!(codes(&valid), ["welded"]);
    assert_eq!(
        valid.warnings[0].message,
        "the faces of the file share no points: its 480 points were welded into 100 vertices by \
         their places"
    );
    for v in valid.surface.vertex_ids() {
        let from = raw.points[valid.source[v.index()]];
        assert!(valid.surface.point(v).distance(from) < 1e-6);
    }
}

#[test]
fn copies_a_rounding_apart_are_welded_and_what_collapses_is_said() {
    let mut raw = soup(&tube(4));
    for (i, p) in raw.points.iter_mut().enumerate() {
        *p += DVec3::splat(4e-6 * (i % 3) as f64);
    }
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert_eq!(valid.surface.vertex_count(), 100);
    // A sliver between the squares of row 1: two vertices where there was one.
    let mut split = tube(4);
    split.points.push(split.points[45] + DVec3::new(0.0, 0.0, 2e-5));
    let extra = split.points.len() - 1;
    for t in 0..160 {
        if t / 40 >= 2 {
            split.polygons[t].iter_mut().filter(|v| **v == 45).for_each(|v| *v = extra);
        }
    }
    split.polygons.extend([vec![44, 45, extra], vec![45, 46, extra]]);
    let valid = validate(&soup(&split), &OPTIONS).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(valid.surface.triangle_count(), 160);
    assert_eq!(codes(&valid), ["welded", "collapsed_dropped"]);
    assert!(
        valid.warnings[1].message.starts_with("2 triangles with a side shorter than "),
        "{}",
        valid.warnings[1].message
    );
}

#[test]
fn a_crumb_far_away_does_not_coarsen_the_welding() {
    let far = |x: f64| DVec3::new(1e8 + x, 0.0, x * x);
    let crumb = RawMesh::from_triangles(vec![far(0.0), far(1.0), far(2.0)], &[[0, 1, 2]]);
    let raw = soup(&together(&tube(4), &crumb));
    let valid = validate(&raw, &SurfaceOptions { keep_largest: true, ..OPTIONS }).unwrap();
    assert_eq!(valid.surface.vertex_count(), 100);
    assert_eq!(codes(&valid), ["welded", "components_dropped"]);
}

#[test]
fn a_cut_given_by_index_stays_open_and_is_said() {
    let valid = validate(&grid(20, 6, false), &OPTIONS).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Disk);
    assert_eq!(codes(&valid), ["cut_kept"]);
    assert_eq!(
        valid.warnings[0].message,
        "the boundary lies on itself along 60.0 mm: taken as a cut and left open; merge the \
         vertices there in the file if it is none"
    );
}

#[test]
fn patches_whose_borders_lie_on_each_other_are_joined() {
    // Two tubes end to end, each with its own vertices where they meet.
    let raw = together(&tube(3), &moved(tube(2), DVec3::new(0.0, 0.0, 30.0)));
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(valid.surface.vertex_count(), 6 * 20);
    assert_eq!(codes(&valid), ["welded"]);
    assert_eq!(
        valid.warnings[0].message,
        "20 points on the borders between pieces of the surface were welded: borders lay exactly \
         on each other"
    );
    // A copy on the same place is no patch, whichever way it faces.
    for copy in [tube(3), reversed(tube(3))] {
        let (kind, _, _) = only(&together(&tube(3), &copy));
        assert_eq!(kind, DefectKind::SeveralComponents);
    }
}

#[test]
fn unused_points_are_dropped_and_said() {
    let mut raw = tube(2);
    raw.points.insert(0, DVec3::splat(1e12));
    raw.polygons.iter_mut().flatten().for_each(|v| *v += 1);
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert_eq!(codes(&valid), ["unused_vertices"]);
    assert_eq!(valid.warnings[0].message, "1 point belongs to no face and was dropped");
    assert_eq!(valid.source[0], 1);
}

#[test]
fn polygons_are_split_into_triangles() {
    let mut raw = tube(3);
    raw.polygons = (0..60)
        .map(|q| {
            let [t, u] = [&raw.polygons[2 * q], &raw.polygons[2 * q + 1]];
            vec![t[0], t[1], t[2], u[2]]
        })
        .collect();
    // A triangle written as a quadrangle.
    let last = raw.polygons.pop().unwrap();
    raw.polygons
        .extend([vec![last[0], last[1], last[2], last[2]], vec![last[0], last[2], last[3]]]);
    // The lower end closed by one face of twenty corners, wound to face down.
    raw.polygons.push((0..20).rev().collect());
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Disk);
    assert_eq!(valid.surface.triangle_count(), 120 + 18);
    assert!(valid.warnings.is_empty());
    let mut crossed = tube(2);
    crossed.polygons.push(vec![0, 1, 5, 3, 9, 6]);
    let (kind, message, _) = only(&crossed);
    assert_eq!(kind, DefectKind::CrossedPolygon);
    assert!(message.starts_with("face 80 at (") && message.ends_with(
        ") mm with 6 corners crosses itself and cannot be split into triangles: triangulate it"
    ));
}

/// The tube without some squares, given as (column, row).
fn with_holes(rows: usize, squares: &[(usize, usize)]) -> RawMesh {
    let mut raw = tube(rows);
    let gone: Vec<usize> = squares.iter().map(|&(i, j)| 20 * j + i).collect();
    raw.polygons = (0..40 * rows)
        .filter(|t| !gone.contains(&(t / 2)))
        .map(|t| raw.polygons[t].clone())
        .collect();
    raw
}

#[test]
fn small_holes_are_closed_and_larger_openings_stay() {
    // Rims of two chords of 4.979 mm with 2 and 4 sides of 10 mm: 29.96 and 49.96 mm.
    let raw = with_holes(8, &[(3, 2), (10, 4), (10, 5)]);
    for (close_holes, loops) in [(29.0, 4), (31.0, 3), (51.0, 2)] {
        let valid = validate(&raw, &SurfaceOptions { close_holes, ..OPTIONS }).unwrap();
        assert_eq!(valid.surface.boundary_loops().len(), loops, "{close_holes}");
        assert_eq!(codes(&valid), vec!["hole_closed"; 4 - loops]);
        assert!(is_outward(&valid.surface));
        if loops == 2 {
            // A flat patch spans chords, as the squares did.
            let whole = validate(&tube(8), &OPTIONS).unwrap().surface.total_area();
            assert!((valid.surface.total_area() - whole).abs() < 1e-4);
            assert_eq!(
                valid.warnings[0].message,
                "a hole with a rim of 30.0 mm (4 vertices) at (7.14, 14.01, 25.00) mm was closed \
                 with 2 triangles"
            );
            assert!(valid.warnings[0].at.is_some());
        }
    }
}

#[test]
fn the_ends_of_a_tube_and_an_outline_are_never_closed() {
    let all = SurfaceOptions { close_holes: 200.0, ..OPTIONS };
    let valid = validate(&with_holes(8, &[(3, 2)]), &all).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(codes(&valid), ["opening_kept", "hole_closed", "opening_kept"]);
    // On a disk the second loop is a hole.
    let square = SurfaceOptions { facing: Some(Facing::Outward), ..all };
    let mut raw = grid(20, 20, false);
    raw.polygons.drain(410..412);
    let valid = validate(&raw, &square).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Disk);
    assert_eq!(codes(&valid), ["cut_kept", "hole_closed"]);
}

/// A small tube in every format, each byte string with its format.
fn files() -> Vec<(Format, Vec<u8>)> {
    let raw = grid(5, 3, true);
    let (mut obj, mut text) = (String::new(), String::from("solid\n"));
    let head = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n\
         property double z\nelement face {}\nproperty list uchar int vertex_index\nend_header\n",
        raw.points.len(),
        raw.polygons.len()
    );
    let mut ply = head.clone();
    let mut binary_ply = head.replace("ascii", "binary_little_endian").into_bytes();
    let mut stl = vec![b' '; 80];
    stl.extend(u32::try_from(raw.polygons.len()).unwrap().to_le_bytes());
    for p in &raw.points {
        obj += &format!("v {:.3} {:.3} {:.3}\n", p.x, p.y, p.z);
        ply += &format!("{:.3} {:.3} {:.3}\n", p.x, p.y, p.z);
        binary_ply.extend(p.to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    for t in &raw.polygons {
        obj += &format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
        ply += &format!("3 {} {} {}\n", t[0], t[1], t[2]);
        binary_ply.push(3);
        binary_ply.extend(t.iter().flat_map(|&i| i32::try_from(i).unwrap().to_le_bytes()));
        text += "facet normal 0 0 1\nouter loop\n";
        stl.extend([0u8; 12]);
        for p in t.iter().map(|&v| raw.points[v]) {
            text += &format!("vertex {:.3} {:.3} {:.3}\n", p.x, p.y, p.z);
            stl.extend(p.to_array().iter().flat_map(|&x| (x as f32).to_le_bytes()));
        }
        text += "endloop\nendfacet\n";
        stl.extend([0u8; 2]);
    }
    text += "endsolid\n";
    vec![
        (Format::Obj, obj.into_bytes()),
        (Format::Ply, ply.into_bytes()),
        (Format::Ply, binary_ply),
        (Format::Stl, text.into_bytes()),
        (Format::Stl, stl),
    ]
}

#[test]
fn every_format_gives_the_same_tube() {
    for (format, bytes) in files() {
        let valid = validate(&read(&bytes, format).unwrap(), &OPTIONS).unwrap();
        assert_eq!(shape_of(&valid.surface), Shape::Tube, "{format}");
        assert_eq!(valid.surface.vertex_count(), 20);
        // Five chords round a circle of 100 mm: 5 · 2 r sin 36° · 30 mm.
        let area = 5.0 * 2.0 * 100.0 / TAU * (TAU / 10.0).sin() * 30.0;
        assert!((valid.surface.total_area() - area).abs() < 0.1, "{format}");
    }
}

#[test]
fn damaged_files_are_refused_or_mended_and_never_a_fault() {
    let files = files();
    // xorshift64 (Marsaglia 2003): the same damage in every run.
    let mut state = 0x1234_5678_9abc_def1u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let (mut refused, mut mended) = (0, 0);
    for _ in 0..4000 {
        let (format, whole) = &files[random(files.len())];
        let mut bytes = whole.clone();
        for _ in 0..=random(4) {
            let at = random(bytes.len());
            match random(5) {
                0 => bytes[at] = u8::try_from(random(256)).unwrap(),
                1 => drop(bytes.remove(at)),
                2 => bytes[at] ^= 1 << random(8),
                3 => bytes[at] = b"0123456789-. \n/"[random(15)],
                _ => bytes[at] = bytes[random(bytes.len())],
            }
        }
        let options =
            SurfaceOptions { keep_largest: random(2) == 0, close_holes: 500.0, ..OPTIONS };
        match read(&bytes, *format).map(|raw| validate(&raw, &options)) {
            Ok(Ok(_)) => mended += 1,
            Ok(Err(error)) => assert!(!error.is_fault(), "{error}"),
            Err(_) => refused += 1,
        }
    }
    assert!(refused > 1000 && mended > 100, "{refused} refused, {mended} mended");
}

#[test]
fn every_defect_is_reported_and_the_message_shows_the_first() {
    let mut raw = tube(3);
    for t in 0..7 {
        raw.polygons.push(raw.polygons[10 * t].clone());
    }
    let error = error(&raw);
    assert_eq!(error.defects().len(), 7);
    assert!(!error.is_fault());
    let text = error.to_string();
    assert_eq!(text.lines().count(), 7);
    assert!(text.starts_with(
        "the surface has 7 defects (faces and vertices are counted from 0):\n  faces 0 and 120 at ("
    ));
    assert!(text.ends_with("\n  and 2 more"));
    let json = serde_json::to_value(&error).unwrap();
    let first = &json["defects"][0];
    assert_eq!(first["kind"], "duplicate_triangle");
    assert_eq!(first["faces"], serde_json::json!([0, 120]));
    assert_eq!(first["vertices"], serde_json::json!([0, 1, 21]));
    assert!(first["at"][2].as_f64().unwrap() > 0.0);
    assert!(first["message"].as_str().unwrap().ends_with("delete one of them"));
}
