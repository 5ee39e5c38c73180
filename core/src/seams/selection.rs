//! The region as faces of the scan that the designer selected.
//!
//! The edge of the brace then follows the triangles' own edges. What closes a hole of the scan was
//! never there to be selected: it is covered if all faces round the hole are.

use super::error::SeamError;
use super::region::{Clipped, keep_largest};
use super::triangulation::Triangulation;
use crate::surface::{HalfEdgeId, Scan, TriangleId};

/// Keeps the selected faces of the raw mesh, numbered from 0, in any order. Of several pieces the
/// largest is kept (warning `region_pieces_dropped`).
///
/// # Errors
/// If a face does not exist, or none of those selected belongs to the surface.
pub fn select(scan: &Scan, faces: &[usize]) -> Result<Clipped, SeamError> {
    let count = scan.origin.face_count;
    let mut selected = vec![false; count];
    for &face in faces {
        *selected.get_mut(face).ok_or(SeamError::NoSuchFace { face, count })? = true;
    }
    let mut keep: Vec<bool> =
        scan.origin.faces.iter().map(|face| face.is_some_and(|face| selected[face])).collect();
    if !keep.contains(&true) {
        return Err(SeamError::NothingSelected { selected: faces.len() });
    }
    cover_patches(scan, &mut keep);
    let work = Triangulation::new(&scan.surface).retain(&keep);
    keep_largest(&work.cut_open(&vec![false; work.half_edge_count()])?)
}

/// Keeps the triangles that close a hole where all triangles round it are kept.
fn cover_patches(scan: &Scan, keep: &mut [bool]) {
    let surface = &scan.surface;
    let is_patch = |t: TriangleId| scan.origin.faces[t.index()].is_none();
    let mut seen = vec![false; keep.len()];
    for first in surface.triangle_ids().filter(|&t| is_patch(t)) {
        if seen[first.index()] {
            continue;
        }
        seen[first.index()] = true;
        let (mut patch, mut around) = (vec![first], true);
        let mut next = 0;
        while next < patch.len() {
            let t = patch[next];
            next += 1;
            for k in 0..3 {
                match surface.twin(HalfEdgeId::of(t, k)).map(HalfEdgeId::triangle) {
                    Some(n) if !is_patch(n) => around &= keep[n.index()],
                    Some(n) if !seen[n.index()] => {
                        seen[n.index()] = true;
                        patch.push(n);
                    }
                    Some(_) => {}
                    None => around = false,
                }
            }
        }
        patch.iter().for_each(|t| keep[t.index()] = around);
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{Mesh, cylinder};
    use super::*;
    use crate::surface::Origin;

    /// A cylinder as the scan of its own faces, turned back to front: face 0 is the last triangle.
    fn scan() -> Scan {
        let surface = cylinder(40.0, 200.0, Mesh::Right);
        let count = surface.triangle_count();
        let origin = Origin {
            source: (0..surface.vertex_count()).collect(),
            vertices: surface.vertex_ids().map(Some).collect(),
            faces: (0..count).rev().map(Some).collect(),
            face_count: count,
        };
        Scan { surface, origin }
    }

    /// The faces whose middle lies between two heights.
    fn between(scan: &Scan, low: f64, high: f64) -> Vec<usize> {
        let middle = |t: TriangleId| scan.surface.corners(t).iter().map(|p| p.z).sum::<f64>() / 3.0;
        scan.surface
            .triangle_ids()
            .filter(|&t| (low..high).contains(&middle(t)))
            .filter_map(|t| scan.origin.faces[t.index()])
            .collect()
    }

    #[test]
    fn the_selected_faces_are_covered_and_no_other() {
        let scan = scan();
        let faces = between(&scan, 50.0, 150.0);
        let covered = select(&scan, &faces).unwrap();
        assert!(covered.warnings.is_empty());
        let surface = &covered.surface;
        assert_eq!(surface.triangle_count(), faces.len());
        assert_eq!(surface.boundary_loops().len(), 2);
        assert!(surface.points().iter().all(|p| (40.0..160.0).contains(&p.z)));
    }

    #[test]
    fn a_closed_hole_is_covered_where_all_round_it_is_selected() {
        let mut scan = scan();
        let faces = between(&scan, 50.0, 150.0);
        let inside = |scan: &Scan, z: f64| {
            scan.surface.triangle_ids().find(|&t| {
                let p = scan.surface.corners(t);
                p.iter().all(|p| (p.z - z).abs() < 12.0)
            })
        };
        // One well inside, one well outside, as if they had closed holes.
        let (inner, outer) = (inside(&scan, 100.0).unwrap(), inside(&scan, 20.0).unwrap());
        let lost = scan.origin.faces[inner.index()].take().unwrap();
        scan.origin.faces[outer.index()] = None;
        let without: Vec<usize> = faces.iter().copied().filter(|&f| f != lost).collect();
        assert_eq!(select(&scan, &without).unwrap().surface.triangle_count(), faces.len());
        // With one of its neighbours not selected it stays open.
        let beside = scan.surface.twin(HalfEdgeId::of(inner, 0)).unwrap().triangle();
        let beside = scan.origin.faces[beside.index()].unwrap();
        let fewer: Vec<usize> = without.into_iter().filter(|&f| f != beside).collect();
        assert_eq!(select(&scan, &fewer).unwrap().surface.triangle_count(), faces.len() - 2);
    }

    #[test]
    fn two_islands_leave_the_larger_and_wrong_selections_are_named() {
        let scan = scan();
        let mut faces = between(&scan, 0.0, 40.0);
        let small = faces.len();
        faces.extend(between(&scan, 80.0, 200.0));
        let covered = select(&scan, &faces).unwrap();
        assert_eq!(covered.warnings[0].code, "region_pieces_dropped");
        assert_eq!(covered.surface.triangle_count(), faces.len() - small);

        let count = scan.origin.face_count;
        assert_eq!(
            select(&scan, &[1, count]).unwrap_err(),
            SeamError::NoSuchFace { face: count, count }
        );
        assert_eq!(select(&scan, &[]).unwrap_err(), SeamError::NothingSelected { selected: 0 });
    }
}
