//! The region that the brace covers: what lies on the kept side of every plane.
//!
//! Triangles are split exactly along each plane, so that the ends are smooth curves in it whatever
//! the triangulation. Limit: planes only; a piece that hangs together with the rest elsewhere (the
//! other limb, cut off by no plane) stays.

use glam::DVec3;

use super::error::{SeamError, place};
use super::slivers::{SNAP, improve_round};
use super::triangulation::Triangulation;
use crate::design::RegionPlane;
use crate::surface::{HalfEdgeId, Surface, VertexId};
use crate::warning::Warning;

/// The covered part of a surface.
#[derive(Debug, Clone)]
pub struct Clipped {
    /// The surface within all planes.
    pub surface: Surface,
    /// What was dropped.
    pub warnings: Vec<Warning>,
}

/// Keeps what lies on the side to which each plane's normal points, splitting triangles along the
/// planes. Of several pieces the largest is kept (warning `region_pieces_dropped`).
///
/// # Errors
/// If a plane has no normal or leaves nothing.
pub fn clip(surface: &Surface, planes: &[RegionPlane]) -> Result<Clipped, SeamError> {
    if planes.is_empty() {
        return Ok(Clipped { surface: surface.clone(), warnings: Vec::new() });
    }
    let mut work = Triangulation::new(surface);
    for (i, plane) in planes.iter().enumerate() {
        let length = plane.normal.length();
        if !(length > 0.0 && length.is_finite()) {
            return Err(SeamError::PlaneWithoutNormal { plane: i + 1, point: plane.point });
        }
        let kept = clip_once(&mut work, plane.point, plane.normal / length);
        if !kept.contains(&true) {
            let (low, high) = bounds(work.points());
            let (point, normal) = (plane.point, plane.normal);
            return Err(SeamError::NothingLeft { plane: i + 1, point, normal, low, high });
        }
        work = work.retain(&kept);
    }
    keep_largest(&work.cut_open(&vec![false; work.half_edge_count()])?)
}

/// Refines along the plane and says which triangles lie on the kept side.
fn clip_once(work: &mut Triangulation, point: DVec3, normal: DVec3) -> Vec<bool> {
    let mut distance: Vec<f64> = work.points().iter().map(|&p| (p - point).dot(normal)).collect();
    let crossed = |d: &[f64], a: VertexId, b: VertexId| d[a.index()] * d[b.index()] < 0.0;
    // Vertices near the plane move onto it, each along its edge with the nearest crossing.
    for v in (0..work.vertex_count()).map(VertexId::new) {
        let own = distance[v.index()];
        let mut nearest: Option<(f64, DVec3)> = None;
        for w in work.neighbours(v) {
            if crossed(&distance, v, w) {
                let part = own / (own - distance[w.index()]);
                let place = work.point(v).lerp(work.point(w), part);
                let far = part * work.point(v).distance(work.point(w));
                if part < SNAP && nearest.is_none_or(|(best, _)| far < best) {
                    nearest = Some((far, place));
                }
            }
        }
        if let Some((_, place)) = nearest
            && work.may_move(v, place)
        {
            work.move_vertex(v, place);
            distance[v.index()] = 0.0;
        }
    }
    // Every edge that still crosses is split; the new edges have a vertex on the plane.
    let mut i = 0;
    while i < work.half_edge_count() {
        let h = HalfEdgeId::new(i);
        let (a, b) = (work.from(h), work.to(h));
        if crossed(&distance, a, b) {
            let (p, q) = (distance[a.index()], distance[b.index()]);
            // Seen from the kept side, so that the place does not depend on the triangle.
            let (from, to, part) = if p > 0.0 { (a, b, p / (p - q)) } else { (b, a, q / (q - p)) };
            work.split_edge(h, work.point(from).lerp(work.point(to), part));
            distance.push(0.0);
        } else {
            i += 1;
        }
    }
    for v in (0..work.vertex_count()).map(VertexId::new).filter(|v| distance[v.index()] == 0.0) {
        // Both triangles at an edge that leaves the plane lie on the same side of it.
        improve_round(work, v, |w| distance[w.index()] != 0.0);
    }
    let above = |v: &VertexId| distance[v.index()] > 0.0;
    work.triangles().iter().map(|corners| corners.iter().any(above)).collect()
}

fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    points
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
}

/// The largest piece of a surface, and what was dropped.
pub(super) fn keep_largest(surface: &Surface) -> Result<Clipped, SeamError> {
    let (component, count) = surface.components();
    if count <= 1 {
        return Ok(Clipped { surface: surface.clone(), warnings: Vec::new() });
    }
    let mut area = vec![0.0; count];
    let mut middle = vec![DVec3::ZERO; count];
    for t in surface.triangle_ids() {
        let c = component[t.index()];
        area[c] += surface.area(t);
        middle[c] += surface.area(t) * surface.corners(t).iter().sum::<DVec3>() / 3.0;
    }
    let largest = (0..count).fold(0, |best, c| if area[c] > area[best] { c } else { best });
    let dropped: Vec<usize> = (0..count).filter(|&c| c != largest).collect();
    let list: Vec<String> = dropped
        .iter()
        .take(5)
        .map(|&c| format!("{:.0} mm² near ({})", area[c], place(middle[c] / area[c])))
        .collect();
    let more = dropped.len() - list.len();
    let warning = Warning::at(
        "region_pieces_dropped",
        format!(
            "the region leaves {count} pieces; the largest ({:.0} mm²) is kept, dropped: {}{}",
            area[largest],
            list.join("; "),
            if more > 0 { format!("; and {more} more") } else { String::new() },
        ),
        middle[dropped[0]] / area[dropped[0]],
    );
    let keep: Vec<bool> = component.iter().map(|&c| c == largest).collect();
    let kept = Triangulation::new(surface).retain(&keep).into_surface()?;
    Ok(Clipped { surface: kept, warnings: vec![warning] })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::fixtures::{Mesh, cylinder, smallest_corner, sphere, torus};
    use super::*;

    fn plane(point: DVec3, normal: DVec3) -> RegionPlane {
        RegionPlane { point, normal }
    }

    #[test]
    fn a_slanted_plane_ends_the_cylinder_in_a_smooth_ellipse() {
        for mesh in Mesh::ALL {
            let s = cylinder(40.0, 200.0, mesh);
            let before = smallest_corner(&s);
            let normal = DVec3::new(0.3, 0.0, -2.0);
            let planes = [
                plane(DVec3::new(0.0, 0.0, 151.7), normal),
                plane(DVec3::new(3.0, 0.0, 40.3), DVec3::Z),
            ];
            let clipped = clip(&s, &planes).unwrap();
            assert!(clipped.warnings.is_empty());
            let c = &clipped.surface;
            assert_eq!((c.euler_characteristic(), c.boundary_loops().len()), (0, 2), "{mesh:?}");
            for boundary in c.boundary_loops() {
                let off = |p: &RegionPlane| {
                    c.loop_vertices(boundary)
                        .map(|v| (c.point(v) - p.point).dot(p.normal.normalize()).abs())
                        .fold(0.0, f64::max)
                };
                let (upper, lower) = (off(&planes[0]), off(&planes[1]));
                assert!(upper.min(lower) < 1e-9, "{mesh:?} {upper} {lower}");
                let length = c.loop_length(boundary);
                // Perimeter of the ellipse of half axes 40 and 40 / cos: 2π of the mean of squares.
                let tilt = (0.3f64 / 2.0).atan();
                let a = if upper < lower { 40.0 / tilt.cos() } else { 40.0 };
                let exact = TAU * ((a * a + 1600.0) / 2.0).sqrt();
                assert!((length / exact - 1.0).abs() < 4e-3, "{mesh:?} {length} {exact}");
            }
            assert!(smallest_corner(c) > before.min(0.35) / 4.0, "{mesh:?}");
            // Twin check: the area between the planes is 2πr times the mean height.
            let exact = TAU * 40.0 * (151.7 - 40.3);
            assert!((c.total_area() / exact - 1.0).abs() < 5e-3, "{mesh:?} {}", c.total_area());
        }
    }

    #[test]
    fn of_two_pieces_the_larger_stays_and_the_other_is_named() {
        // A vertical plane through a torus leaves a C; a second one across it leaves two arcs.
        let s = torus(60.0, 20.0);
        let planes =
            [plane(DVec3::ZERO, DVec3::X), plane(DVec3::new(20.0, 0.0, 0.0), DVec3::NEG_X)];
        let clipped = clip(&s, &planes[..1]).unwrap();
        assert!(clipped.warnings.is_empty());
        assert_eq!(clipped.surface.boundary_loops().len(), 2);
        let both = clip(&s, &planes).unwrap();
        assert_eq!(both.surface.components().1, 1);
        assert_eq!(both.warnings.len(), 1);
        assert_eq!(both.warnings[0].code, "region_pieces_dropped");
        assert!(both.warnings[0].message.contains("2 pieces"), "{}", both.warnings[0].message);
    }

    #[test]
    fn a_closed_sphere_becomes_a_band_of_the_right_area() {
        let s = sphere(50.0);
        let planes = [
            plane(DVec3::new(0.0, 0.0, -20.0), DVec3::Z),
            plane(DVec3::new(0.0, 0.0, 25.0), DVec3::NEG_Z),
        ];
        let c = clip(&s, &planes).unwrap().surface;
        assert_eq!((c.euler_characteristic(), c.boundary_loops().len()), (0, 2));
        // Archimedes: a zone of height h has the area 2πRh.
        assert!((c.total_area() / (TAU * 50.0 * 45.0) - 1.0).abs() < 0.01);
    }

    #[test]
    fn planes_through_vertices_and_along_edges_split_nothing() {
        let s = cylinder(40.0, 200.0, Mesh::Right);
        let rows: Vec<f64> = s.points().iter().map(|p| p.z).filter(|&z| z > 50.0).collect();
        let z = rows.into_iter().fold(f64::INFINITY, f64::min);
        let c = clip(&s, &[plane(DVec3::new(0.0, 0.0, z), DVec3::Z)]).unwrap().surface;
        assert!(c.points().iter().all(|p| s.points().contains(p)));
        assert!(c.points().iter().all(|p| p.z >= z));
    }

    #[test]
    fn wrong_planes_are_named() {
        let s = cylinder(40.0, 200.0, Mesh::Right);
        let error = |p: &[RegionPlane]| clip(&s, p).unwrap_err().to_string();
        let good = plane(DVec3::ZERO, DVec3::Z);
        let text = error(&[good, plane(DVec3::new(0.0, 0.0, 900.0), DVec3::Z)]);
        assert!(text.starts_with("region plane 2 (through 0.0, 0.0, 900.0"), "{text}");
        let text = error(&[plane(DVec3::ONE, DVec3::ZERO)]);
        assert!(text.starts_with("region plane 1") && text.contains("0, 0, 0"), "{text}");
    }
}
