//! Results on the mesh that was given: each cut element knows where it came from, and what is laid
//! out per corner of the caller's triangles is the pattern.

use glam::{DVec2, DVec3};
use serde_json::{Value, json};
use support::cli::library;
use support::fixtures::slit_tube;
use support::mesh::{Mesh, Triangulation};

use crate::host::{
    ABI, GIVEN_PATTERN_PER_CORNER, GIVEN_PRESSURE_KPA, GIVEN_WARP_STRAIN, Handle, Host, NONE,
    PATTERN, POSITIONS, PRESSURE_KPA, TRIANGLE_TO_GIVEN_TRIANGLE, TRIANGLES,
    VERTEX_TO_GIVEN_TRIANGLE, VERTEX_TO_GIVEN_VERTEX, VERTEX_WEIGHTS, WARP_STRAIN,
};
use crate::limb;

/// How far the surface gives way beside a cut on this mesh of 6 mm edges, in mm; see
/// `core/src/seams/slivers.rs`.
const GIVES_WAY: f64 = 0.3;

const FAST: [(&str, &str); 1] = [("spacing", "9")];

fn points3(numbers: &[f64]) -> Vec<DVec3> {
    numbers.chunks_exact(3).map(DVec3::from_slice).collect()
}

fn points2(numbers: &[f64]) -> Vec<DVec2> {
    numbers.chunks_exact(2).map(DVec2::from_slice).collect()
}

/// The limb, and its pattern between two planes.
fn banded(host: &Host) -> (Mesh, Handle) {
    let (mesh, _) = limb();
    let result = between_planes(host, &mesh);
    (mesh, result)
}

fn between_planes(host: &Host, mesh: &Mesh) -> Handle {
    let (_, mut design) = limb();
    design["region"] = json!([
        {"point": [0, 0, 102], "normal": [0.1, 0, -1]},
        {"point": [0, 0, 9], "normal": [0, 0, 1]}
    ]);
    host.pattern(mesh, &design.to_string(), &FAST)
}

#[test]
fn every_cut_vertex_and_triangle_lies_where_the_given_mesh_says() {
    let host = Host::load(library(), ABI).unwrap();
    let (mesh, result) = banded(&host);
    lies_where_it_says(&host, &mesh, result);
    // The core turns these triangles; weights are in the caller's order all the same.
    let reversed = mesh.reversed();
    let result = between_planes(&host, &reversed);
    lies_where_it_says(&host, &reversed, result);
}

fn lies_where_it_says(host: &Host, mesh: &Mesh, result: Handle) {
    let positions = points3(&host.doubles(result, POSITIONS));
    let weights = points3(&host.doubles(result, VERTEX_WEIGHTS));
    let vertex = host.indices(result, VERTEX_TO_GIVEN_VERTEX);
    let triangle = host.indices(result, VERTEX_TO_GIVEN_TRIANGLE);
    let mut same = 0;
    for (i, &p) in positions.iter().enumerate() {
        let corners = mesh.triangles[triangle[i] as usize].map(|v| mesh.points[v]);
        let w = weights[i];
        assert!((w.element_sum() - 1.0).abs() < 1e-9 && w.min_element() >= 0.0, "{w}");
        let laid = w.x * corners[0] + w.y * corners[1] + w.z * corners[2];
        assert!(p.distance(laid) < GIVES_WAY, "{i}: {p} {laid}");
        if vertex[i] != NONE {
            same += 1;
            // A millionth of a millimetre is the grid that coordinates are rounded to.
            assert!(p.distance(mesh.points[vertex[i] as usize]) < 2e-6, "{i}");
            assert!(w.max_element() == 1.0);
        }
    }
    // Only beside the two planes and the seam are vertices new.
    assert!(same > positions.len() * 3 / 4 && same < positions.len(), "{same}");

    let cut = host.indices(result, TRIANGLES);
    let under = host.indices(result, TRIANGLE_TO_GIVEN_TRIANGLE);
    assert_eq!(cut.len(), 3 * under.len());
    for (corners, &under) in cut.chunks_exact(3).zip(&under) {
        let middle: DVec3 = corners.iter().map(|&v| positions[v as usize]).sum::<DVec3>() / 3.0;
        let given = mesh.triangles[under as usize].map(|v| mesh.points[v]);
        let normal = (given[1] - given[0]).cross(given[2] - given[0]).normalize();
        assert!((middle - given[0]).dot(normal).abs() < GIVES_WAY);
        let longest = (0..3).map(|k| given[k].distance(given[(k + 1) % 3])).fold(0.0, f64::max);
        assert!(given.iter().all(|p| p.distance(middle) < longest));
    }
    host.free("wovenfit_result_free", result);
}

/// The corners of a given triangle in the pattern, and how its edges' lengths compare with those on
/// the limb.
fn stretches(mesh: &Mesh, t: usize, corners: &[DVec2]) -> [f64; 3] {
    let p = mesh.triangles[t].map(|v| mesh.points[v]);
    [0, 1, 2].map(|k| {
        let next = (k + 1) % 3;
        corners[3 * t + k].distance(corners[3 * t + next]) / p[k].distance(p[next])
    })
}

#[test]
fn each_given_triangle_is_laid_out_whole_on_its_own_side_of_the_seam() {
    let host = Host::load(library(), ABI).unwrap();
    let (mesh, result) = banded(&host);
    let corners = points2(&host.doubles(result, GIVEN_PATTERN_PER_CORNER));
    assert_eq!(corners.len(), 3 * mesh.triangles.len());
    let mut at: Vec<Vec<DVec2>> = vec![Vec::new(); mesh.points.len()];
    for t in 0..mesh.triangles.len() {
        let middle = mesh.triangles[t].iter().map(|&v| mesh.points[v]).sum::<DVec3>() / 3.0;
        let inside = (middle.z - 9.0).min(102.0 - middle.z + 0.1 * middle.x);
        let covered = corners[3 * t].is_finite();
        // Within a millimetre of a plane the surface's giving way decides.
        assert!(inside.abs() < 1.0 || covered == (inside > 0.0), "{t}: {inside} {covered}");
        if covered {
            // The fabric is stretched round the limb by up to a fifth.
            for stretch in stretches(&mesh, t, &corners) {
                assert!((0.75..1.1).contains(&stretch), "{t}: {stretch}");
            }
            (0..3).for_each(|k| at[mesh.triangles[t][k]].push(corners[3 * t + k]));
        }
    }
    // Away from the seam all triangles of a vertex lay it at one place; along it at two.
    let mut torn = 0;
    for places in at.iter().filter(|places| places.len() > 1) {
        let far = |p: &&DVec2| p.distance(places[0]) > 100.0;
        let apart = |p: &&DVec2| (1e-6..100.0).contains(&p.distance(places[0]));
        torn += usize::from(places.iter().any(|p| far(&p)));
        let kinked = places.iter().filter(apart).count();
        assert!(kinked == 0 || places.iter().any(|p| p.distance(places[0]) < 3.0), "{places:?}");
    }
    // The seam crosses some twenty rows.
    assert!((10..120).contains(&torn), "{torn}");
    host.free("wovenfit_result_free", result);
}

#[test]
fn values_at_given_vertices_are_those_of_the_cut_surface() {
    let host = Host::load(library(), ABI).unwrap();
    let (mesh, result) = banded(&host);
    let vertex = host.indices(result, VERTEX_TO_GIVEN_VERTEX);
    for (cut, given) in [(PRESSURE_KPA, GIVEN_PRESSURE_KPA), (WARP_STRAIN, GIVEN_WARP_STRAIN)] {
        let (cut, given) = (host.doubles(result, cut), host.doubles(result, given));
        assert_eq!(given.len(), mesh.points.len());
        for (i, &v) in vertex.iter().enumerate().filter(|(_, v)| **v != NONE) {
            assert_eq!(cut[i], given[v as usize]);
        }
        let (low, high) = (
            cut.iter().copied().fold(f64::INFINITY, f64::min),
            cut.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        );
        for (p, value) in mesh.points.iter().zip(&given) {
            let inside = (p.z - 9.0).min(102.0 - p.z + 0.1 * p.x);
            assert!(inside.abs() < 1.5 || value.is_finite() == (inside > 0.0), "{p} {value}");
            assert!(!value.is_finite() || (low..=high).contains(value));
        }
    }
    host.free("wovenfit_result_free", result);
}

#[test]
fn a_mesh_without_shared_vertices_gets_its_values_at_every_corner() {
    let host = Host::load(library(), ABI).unwrap();
    let (mesh, design) = limb();
    let soup = Mesh {
        points: mesh.corners().flatten().collect(),
        triangles: (0..mesh.triangles.len()).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
    };
    let whole = host.pattern(&mesh, &design.to_string(), &FAST);
    let loose = host.pattern(&soup, &design.to_string(), &FAST);
    let (pressure, corners) = (GIVEN_PRESSURE_KPA, GIVEN_PATTERN_PER_CORNER);
    let by_vertex = host.doubles(whole, pressure);
    let by_corner = host.doubles(loose, pressure);
    for (k, &v) in mesh.triangles.iter().flatten().enumerate() {
        // The vertices are numbered otherwise and sums come in another order.
        assert!((by_corner[k] - by_vertex[v]).abs() < 0.05 * by_vertex[v].abs() + 0.02, "{k}");
    }
    let laid = host.doubles(loose, corners);
    assert!(laid.iter().all(|x| x.is_finite()));
    host.free("wovenfit_result_free", whole);
    host.free("wovenfit_result_free", loose);
}

#[test]
fn both_sides_of_a_limb_that_came_slit_keep_their_own_places() {
    let host = Host::load(library(), ABI).unwrap();
    let tube = slit_tube(40.0, 100.0, 0.0, 36, Triangulation::Alternating);
    let design = json!({"pressures": []});
    let result = host.pattern(&tube, &design.to_string(), &FAST);
    let pattern = points2(&host.doubles(result, PATTERN));
    let vertex = host.indices(result, VERTEX_TO_GIVEN_VERTEX);
    // Nothing was cut: every vertex is its own, each once.
    assert_eq!(vertex.len(), tube.points.len());
    let mut sorted = vertex.clone();
    sorted.sort_unstable();
    assert!(sorted.iter().enumerate().all(|(i, &v)| v as usize == i));
    let corners = points2(&host.doubles(result, GIVEN_PATTERN_PER_CORNER));
    let mut of_given = vec![DVec2::NAN; vertex.len()];
    vertex.iter().enumerate().for_each(|(i, &v)| of_given[v as usize] = pattern[i]);
    for (k, &v) in tube.triangles.iter().flatten().enumerate() {
        assert_eq!(corners[k], of_given[v]);
    }
    host.free("wovenfit_result_free", result);
}

#[test]
fn selected_faces_of_a_design_file_are_the_region() {
    let host = Host::load(library(), ABI).unwrap();
    let (mesh, mut design) = limb();
    let inside = |t: &[usize; 3]| t.iter().all(|&v| (10.0..100.0).contains(&mesh.points[v].z));
    let faces: Vec<usize> =
        (0..mesh.triangles.len()).filter(|&t| inside(&mesh.triangles[t])).collect();
    // In another order than the mesh's, as a set would give them.
    design["region_faces"] = Value::from(faces.iter().rev().copied().collect::<Vec<_>>());
    let result = host.pattern(&mesh, &design.to_string(), &FAST);
    let corners = points2(&host.doubles(result, GIVEN_PATTERN_PER_CORNER));
    let covered: Vec<usize> =
        (0..mesh.triangles.len()).filter(|&t| corners[3 * t].is_finite()).collect();
    assert_eq!(covered, faces);
    host.free("wovenfit_result_free", result);
}
