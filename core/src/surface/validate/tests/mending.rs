//! What passes, what is mended, and what is said about it.

use super::*;

#[test]
fn a_sound_tube_passes_unchanged() {
    let raw = tube(6);
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert!(valid.warnings.is_empty(), "{:?}", valid.warnings);
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(valid.origin.source, (0..raw.points.len()).collect::<Vec<_>>());
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
    assert_eq!(valid.origin.source[0], 3);
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
        let whole = grid(20, 12, true);
        let kept = (0..whole.polygons.len()).filter(|t| (t / 2) % 20 < columns);
        let polygons = kept.map(|t| whole.polygons[t].clone()).collect();
        RawMesh { points: whole.points, polygons }
    };
    let valid = validate(&reversed(patch(5)), &OPTIONS).unwrap();
    assert!(is_outward(&valid.surface));
    assert!(codes(&valid).contains(&"reversed"));
    // Flat, and bent by 18° along its middle.
    assert_eq!(only(&patch(1)).0, DefectKind::AmbiguousFacing);
    assert_eq!(only(&patch(2)).0, DefectKind::AmbiguousFacing);
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
        let from = raw.points[valid.origin.source[v.index()]];
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
    // One that faces the other way is joined and turned.
    let other = reversed(moved(tube(2), DVec3::new(0.0, 0.0, 30.0)));
    let valid = validate(&together(&tube(3), &other), &OPTIONS).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(codes(&valid), ["welded", "orientation_repaired"]);
    assert!(is_outward(&valid.surface));
    // A cut through both stays.
    let above = moved(grid(20, 2, false), DVec3::new(0.0, 0.0, 30.0));
    let valid = validate(&together(&grid(20, 3, false), &above), &OPTIONS).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Disk);
    assert_eq!(codes(&valid), ["welded", "cut_kept"]);
    assert!(valid.warnings[1].message.contains("along 50.0 mm"));
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
    assert_eq!(valid.origin.source[0], 1);
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
    // From thigh to ankle, the lower end four tenths of the upper.
    let mut leg = tube(8);
    for p in &mut leg.points {
        let scale = 1.0 - 0.6 * p.z / 80.0;
        *p = DVec3::new(scale * p.x, scale * p.y, p.z);
    }
    let valid = validate(&leg, &all).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Tube);
    assert_eq!(codes(&valid), ["opening_kept", "opening_kept"]);
    // On a disk the second loop is a hole.
    let square = SurfaceOptions { facing: Some(Facing::Outward), ..all };
    let mut raw = grid(20, 20, false);
    raw.polygons.drain(410..412);
    let valid = validate(&raw, &square).unwrap();
    assert_eq!(shape_of(&valid.surface), Shape::Disk);
    assert_eq!(codes(&valid), ["cut_kept", "hole_closed"]);
}

#[test]
fn thin_triangles_of_a_scan_pass() {
    // A ring a thousandth of a millimetre above the end: slivers of 0.01°.
    let mut raw = tube(3);
    raw.points[20..40].iter_mut().for_each(|p| p.z = 1e-3);
    let valid = validate(&raw, &OPTIONS).unwrap();
    assert_eq!(valid.surface.triangle_count(), 120);
    assert!(valid.warnings.is_empty());
}

/// Every raw point and face leads to the vertex and triangle that it became.
fn comes_from(raw: &RawMesh, valid: &Validated) {
    let (surface, origin) = (&valid.surface, &valid.origin);
    assert_eq!(origin.vertices.len(), raw.points.len());
    assert_eq!(origin.face_count, raw.polygons.len());
    for (p, vertex) in raw.points.iter().zip(&origin.vertices) {
        assert!(vertex.is_none_or(|v| surface.point(v).distance(*p) < 1e-4));
    }
    for (v, &p) in origin.source.iter().enumerate() {
        assert_eq!(origin.vertices[p], Some(VertexId::new(v)));
    }
    for (t, face) in origin.faces.iter().enumerate() {
        let Some(face) = *face else { continue };
        let corners: Vec<_> = raw.polygons[face].iter().map(|&p| origin.vertices[p]).collect();
        let own = surface.triangles()[t];
        assert!(own.iter().all(|&v| corners.contains(&Some(v))), "{t} {face}");
    }
}

#[test]
fn what_was_mended_still_knows_where_it_came_from() {
    let largest = SurfaceOptions { keep_largest: true, ..OPTIONS };
    let crumb = tube_with_crumb();
    let valid = validate(&crumb, &largest).unwrap();
    comes_from(&crumb, &valid);
    assert!(valid.origin.vertices.contains(&None));

    let loose = soup(&tube(10));
    let valid = validate(&loose, &OPTIONS).unwrap();
    comes_from(&loose, &valid);
    assert!(valid.origin.vertices.iter().all(Option::is_some));

    let inward = reversed(tube(10));
    let valid = validate(&inward, &OPTIONS).unwrap();
    comes_from(&inward, &valid);
    assert_eq!(valid.origin.faces, (0..inward.polygons.len()).map(Some).collect::<Vec<_>>());

    let torn = with_holes(20, &[(5, 8)]);
    let valid = validate(&torn, &SurfaceOptions { close_holes: 60.0, ..OPTIONS }).unwrap();
    comes_from(&torn, &valid);
    let patch = valid.surface.triangle_count() - torn.polygons.len();
    assert!(patch > 0 && valid.origin.faces.iter().filter(|face| face.is_none()).count() == patch);
    assert_eq!(valid.origin.faces.iter().rev().take_while(|face| face.is_none()).count(), patch);
}
