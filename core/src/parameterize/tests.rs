//! Known answers of the initial parameterization.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, DVec3};

use super::*;
use crate::geometry::Locator;
use crate::geometry::shapes::{grid, noisy, torus_point};
use crate::progress::Silent;
use crate::surface::VertexId;

fn flat(
    disk: &Surface,
    markers: &[SurfacePoint; 2],
) -> Result<Parameterization, ParameterizeError> {
    initial(disk, &Matrix::new(disk, &[]).unwrap(), markers, &Silent)
}

/// Markers at the surface points nearest to two places.
fn markers(surface: &Surface, places: [DVec3; 2]) -> [SurfacePoint; 2] {
    let locator = Locator::new(surface);
    places.map(|p| locator.closest(p).unwrap().0)
}

fn slit_cone(from: f64, to: f64, height: f64) -> Surface {
    grid(40, 90, false, |s, t| {
        let (sin, cos) = (TAU * s).sin_cos();
        let radius = from + t * (to - from);
        DVec3::new(radius * cos, radius * sin, height * t)
    })
}

/// A bent tube slit along its inner side.
fn slit_elbow() -> Surface {
    grid(56, 80, false, |s, t| torus_point(90.0, 40.0, s + 0.5, t))
}

#[test]
fn a_plane_comes_back_as_itself_upright() {
    let s = grid(20, 30, false, |x, y| DVec3::new(60.0 * x, 5.0, -40.0 * y));
    let m = markers(&s, [DVec3::new(30.0, 5.0, -40.0), DVec3::new(30.0, 5.0, 0.0)]);
    let p = flat(&s, &m).unwrap();
    assert!(p.warnings.is_empty());
    // Seen from outside (−y … the normal is −x × −z): the first marker up, x to its right.
    let normal = s.normal(s.triangle_ids().next().unwrap());
    let up = DVec3::NEG_Z;
    for v in s.vertex_ids() {
        let q = s.point(v) - DVec3::new(30.0, 5.0, -20.0);
        let want = DVec2::new(q.dot(up.cross(normal)), q.dot(up));
        assert!((p.coordinates[v.index()] - want).length() < 1e-9, "{v}");
    }
}

#[test]
fn cylinders_and_cones_develop_without_stretch() {
    for (from, to) in [(40.0, 40.0), (45.0, 30.0)] {
        let s = slit_cone(from, to, 120.0);
        let m = markers(&s, [DVec3::new(-to, 0.0, 120.0), DVec3::new(-from, 0.0, 0.0)]);
        let p = flat(&s, &m).unwrap();
        assert!(p.warnings.is_empty());
        assert_eq!((p.quality.flipped, p.quality.crossings), (0, 0));
        assert!(p.quality.stretch_rms < 1e-8, "{:?}", p.quality);
        let [a, b] = m.map(|m| m.interpolate(&s, &p.coordinates));
        assert!((a.x - b.x).abs() < 1e-9 && a.y > b.y);
        let chord = 2.0 * 90.0 * from * (TAU / 180.0).sin();
        let first: Vec<DVec2> = p.coordinates[..91].to_vec();
        let girth: f64 = first.windows(2).map(|w| w[0].distance(w[1])).sum();
        assert!((girth - chord).abs() < 1e-6, "{girth} {chord}");
    }
}

#[test]
fn turning_moving_and_another_unit_change_nothing() {
    let s = slit_elbow();
    let m = markers(&s, [DVec3::new(0.0, 130.0, 0.0), DVec3::new(130.0, 0.0, 0.0)]);
    let p = flat(&s, &m).unwrap();
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -2.0);
    let moved = |q: DVec3| (turn * (q / 25.4) + DVec3::new(7.0, -3.0, 1.0)) * 25.4;
    let again = s.with_points(s.points().iter().map(|&q| moved(q)).collect());
    let other = flat(&again, &m).unwrap();
    for (a, b) in p.coordinates.iter().zip(&other.coordinates) {
        assert!(a.distance(*b) < 1e-7, "{a} {b}");
    }
}

#[test]
fn a_noisy_bent_tube_starts_without_flips() {
    let s = noisy(&slit_elbow(), 0.4, 3);
    let m = markers(&s, [DVec3::new(0.0, 130.0, 0.0), DVec3::new(130.0, 0.0, 0.0)]);
    let p = flat(&s, &m).unwrap();
    assert_eq!((p.quality.flipped, p.quality.crossings), (0, 0), "{:?}", p.warnings);
    assert!(p.quality.factor_rms < 1.0, "{:?}", p.quality);
}

#[test]
fn the_flip_free_start_is_nearly_isometric() {
    for (s, most) in [(slit_cone(45.0, 30.0, 120.0), 0.02), (slit_elbow(), 0.2)] {
        let map = flip_free::flip_free(&s).unwrap();
        let q = map_quality(&s, &map);
        assert_eq!((q.flipped, q.crossings), (0, 0));
        assert!(q.stretch_rms < most, "{q:?}");
        let area: f64 = s
            .triangle_ids()
            .map(|t| {
                let [a, b, c] = quality::planar(&s, &map, t);
                0.5 * signed_area(a, b, c)
            })
            .sum();
        assert!((area / s.total_area() - 1.0).abs() < 1e-12);
    }
}

/// A tube closed at its far end like a glove's finger, and not slit: a disk on which a conformal
/// map shrinks the tip.
fn finger() -> Surface {
    let tube = grid(60, 24, true, |s, t| {
        let (sin, cos) = (TAU * s).sin_cos();
        let (z, radius) = if t < 0.8 {
            (100.0 * t / 0.8, 10.0)
        } else {
            let (sa, ca) = (FRAC_PI_2 * (t - 0.8) / 0.2 * 0.95).sin_cos();
            (100.0 + 10.0 * sa, 10.0 * ca)
        };
        DVec3::new(radius * cos, radius * sin, z)
    });
    let tip = VertexId::new(tube.vertex_count());
    let mut points = tube.points().to_vec();
    points.push(DVec3::new(0.0, 0.0, 110.0));
    let mut triangles = tube.triangles().to_vec();
    for l in tube.boundary_loops() {
        if tube.point(tube.from(l.half_edges[0])).z > 50.0 {
            triangles.extend(l.half_edges.iter().map(|&h| [tube.to(h), tube.from(h), tip]));
        }
    }
    Surface::new(points, triangles).unwrap()
}

#[test]
fn a_finger_that_a_conformal_map_shrinks_is_replaced_and_said() {
    let s = finger();
    let m = markers(&s, [DVec3::new(10.0, 0.0, 5.0), DVec3::new(-10.0, 0.0, 5.0)]);
    let p = flat(&s, &m).unwrap();
    assert_eq!(p.warnings.len(), 1);
    assert_eq!(p.warnings[0].code, "start_replaced");
    assert_eq!((p.quality.flipped, p.quality.crossings), (0, 0));
    let natural = map_quality(
        &s,
        &intrinsic::intrinsic(&s, &Matrix::new(&s, &[]).unwrap(), &Silent).unwrap(),
    );
    println!("{:?} {natural:?}", p.quality);
    assert!(p.quality.factor_rms < 1e-2 * natural.factor_rms, "{:?} {natural:?}", p.quality);
}

#[test]
fn slivers_give_finite_maps_and_holes_stay_open() {
    // Rows a millionth of a millimetre high between rows of 5 mm, and a hole of four cells.
    let whole = grid(20, 30, false, |x, y| {
        let row = (20.0 * y).round();
        let z = 2.5 * (row + row % 2.0) - 2.5 * 0.999_999_8 * (row % 2.0);
        let (sin, cos) = (4.0 * x).sin_cos();
        DVec3::new(30.0 * cos, 30.0 * sin, z)
    });
    let inside = |t: &[VertexId; 3]| {
        t.iter()
            .all(|v| (8..=11).contains(&(v.index() / 31)) && (14..=16).contains(&(v.index() % 31)))
    };
    let kept: Vec<_> = whole.triangles().iter().copied().filter(|t| !inside(t)).collect();
    let mut number = vec![None; whole.vertex_count()];
    let mut points = Vec::new();
    for v in kept.iter().flatten() {
        number[v.index()].get_or_insert_with(|| {
            points.push(whole.point(*v));
            VertexId::new(points.len() - 1)
        });
    }
    let triangles = kept.iter().map(|t| t.map(|v| number[v.index()].unwrap())).collect();
    let s = Surface::new(points, triangles).unwrap();
    assert_eq!(s.boundary_loops().len(), 2);
    let m = markers(&s, [DVec3::new(30.0, 0.0, 50.0), DVec3::new(30.0, 0.0, 0.0)]);
    let p = flat(&s, &m).unwrap();
    assert!(p.coordinates.iter().all(|q| q.is_finite()));
    assert_eq!((p.quality.flipped, p.quality.crossings), (0, 0));
    assert!(p.quality.stretch_rms < 0.05, "{:?}", p.quality);
    let map = flip_free::flip_free(&s).unwrap();
    assert_eq!(map_quality(&s, &map).flipped, 0);
}

#[test]
fn a_spiral_that_would_lie_on_itself_is_kept_apart() {
    // A flat ring of one turn and a third, as a ramp: flat it must overlap, so it is squeezed.
    let s = grid(6, 120, false, |x, y| {
        let angle = 1.35 * TAU * x;
        let radius = 60.0 - 20.0 * y;
        DVec3::new(radius * angle.cos(), radius * angle.sin(), 10.0 * x)
    });
    let m = markers(&s, [DVec3::new(60.0, 0.0, 0.0), DVec3::new(-60.0, 0.0, 3.7)]);
    let natural = intrinsic::intrinsic(&s, &Matrix::new(&s, &[]).unwrap(), &Silent).unwrap();
    assert!(outline_crossings(&s, &natural) > 0);
    let p = flat(&s, &m).unwrap();
    assert_eq!(p.warnings[0].code, "start_replaced");
    assert!(p.warnings[0].message.contains("crosses its own outline"));
    assert_eq!((p.quality.flipped, p.quality.crossings), (0, 0));
}

#[test]
fn what_cannot_be_laid_flat_is_refused_with_the_reason() {
    let tube = grid(4, 12, true, |s, t| torus_point(90.0, 40.0, s, t));
    let disk = slit_elbow();
    let place = DVec3::new(130.0, 0.0, 0.0);
    let same = markers(&disk, [place, place]);
    let error = flat(&disk, &same).unwrap_err();
    assert!(matches!(error, ParameterizeError::MarkersCoincide { .. }));
    assert!(error.to_string().contains("(130.0, 0.0, 0.0)"), "{error}");
    let two = Surface::new(
        [tube.points(), tube.points()].concat(),
        tube.triangles()
            .iter()
            .copied()
            .chain(
                tube.triangles()
                    .iter()
                    .map(|t| t.map(|v| VertexId::new(v.index() + tube.vertex_count()))),
            )
            .collect(),
    )
    .unwrap();
    let error = flat(&two, &same).unwrap_err();
    assert!(matches!(error, ParameterizeError::NotADisk { components: 2, loops: 4, .. }));
}
