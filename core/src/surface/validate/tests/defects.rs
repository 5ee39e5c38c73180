//! Every defect by its kind, message and place.

use super::*;

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
