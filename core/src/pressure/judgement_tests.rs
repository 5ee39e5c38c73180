//! Every reason for a missed pressure has a case that gives it and a near twin that does not.
//!
//! The brace is a slit cylinder of radius 45 mm and length 120 mm whose pattern is known: the
//! development, narrower by a strain that the test chooses.

use glam::{DVec2, DVec3};

use super::{Annotation, Brace, Judgement, Reason, judge, target_strains};
use crate::design::{Fabric, PressureModel};
use crate::geometry::{Locator, ShapeOperator};
use crate::parameters::Parameters;
use crate::pressure::Woven;
use crate::surface::{HalfEdgeId, Surface, VertexId};
use crate::weave::lay;

const RADIUS: f64 = 45.0;
const LENGTH: f64 = 120.0;

fn slit_cylinder() -> (Surface, Vec<DVec2>) {
    let (n, rows) = (90, 40);
    let (mut points, mut plane) = (Vec::new(), Vec::new());
    for i in 0..=rows {
        let z = LENGTH * f64::from(i) / f64::from(rows);
        for j in 0..=n {
            let a = std::f64::consts::TAU * f64::from(j) / f64::from(n);
            points.push(DVec3::new(RADIUS * a.cos(), RADIUS * a.sin(), z));
            plane.push(DVec2::new(RADIUS * a, z));
        }
    }
    let id = |i: i32, j: i32| VertexId::new((i * (n + 1) + j) as usize);
    let mut triangles = Vec::new();
    for i in 0..rows {
        for j in 0..n {
            triangles.push([id(i, j), id(i, j + 1), id(i + 1, j + 1)]);
            triangles.push([id(i, j), id(i + 1, j + 1), id(i + 1, j)]);
        }
    }
    (Surface::new(points, triangles).unwrap(), plane)
}

/// A wish at a height and an angle (degrees) on a surface of this curvature round the limb.
struct Wish {
    z: f64,
    degrees: f64,
    kpa: f64,
    curvature: f64,
}

fn wish(z: f64, kpa: f64) -> Wish {
    Wish { z, degrees: 180.0, kpa, curvature: 1.0 / RADIUS }
}

/// Judges wishes on a pattern narrower by `reached` than the cylinder.
fn judged(wishes: &[Wish], reached: f64, converged: bool) -> Vec<Judgement> {
    judged_along(wishes, reached, 0.0, converged)
}

/// The same on a pattern that is also shorter by `weft`, on a limb that bulges along its length.
fn judged_along(wishes: &[Wish], reached: f64, weft: f64, converged: bool) -> Vec<Judgement> {
    judged_with(wishes, reached, weft, converged, false)
}

/// The same, with the threads of a woven model if wanted.
fn judged_with(
    wishes: &[Wish],
    reached: f64,
    weft: f64,
    converged: bool,
    with_threads: bool,
) -> Vec<Judgement> {
    let (disk, development) = slit_cylinder();
    let plane: Vec<DVec2> =
        development.iter().map(|p| DVec2::new(p.x / (1.0 + reached), p.y / (1.0 + weft))).collect();
    let shifted: Vec<DVec2> = plane.iter().map(|&p| p + DVec2::new(1.3, 1.7)).collect();
    let model = lay(&disk, &shifted, 5.0);
    let locator = Locator::new(&disk);
    let annotations: Vec<Annotation> = wishes
        .iter()
        .map(|wish| {
            let a = wish.degrees.to_radians();
            let normal = DVec3::new(a.cos(), a.sin(), 0.0);
            let at = RADIUS * normal + wish.z * DVec3::Z;
            let shape = ShapeOperator {
                normal,
                u: DVec3::Z.cross(normal),
                v: DVec3::Z,
                kuu: wish.curvature,
                kuv: 0.0,
                kvv: 0.01,
            };
            let (point, _) = locator.closest(at).unwrap();
            Annotation { at, point, kpa: wish.kpa, shape }
        })
        .collect();
    let fabric = Fabric::default();
    let model_name = PressureModel::Laplace;
    let targets =
        target_strains(&disk, &model, &annotations, &fabric, model_name, 10.0, None).unwrap();
    let free_edges: Vec<HalfEdgeId> = disk
        .boundary_loops()
        .iter()
        .flat_map(|boundary| boundary.half_edges.clone())
        .filter(|&h| disk.point(disk.from(h)).z == disk.point(disk.to(h)).z)
        .collect();
    let spacing = model.spacing();
    let woven = Woven { model, nodes: targets.nodes.clone() };
    let brace = Brace {
        disk: &disk,
        coordinates: &plane,
        free_edges: &free_edges,
        woven: with_threads.then_some(&woven),
        spacing,
        targets: &targets.targets,
        converged,
    };
    judge(&brace, &annotations, &fabric, model_name, &Parameters::default())
}

/// Strain for a pressure on the cylinder: P r / k.
fn strain(kpa: f64) -> f64 {
    kpa * 1e-3 * RADIUS / Fabric::default().warp
}

fn reasons(judgements: &[Judgement]) -> Vec<Option<&'static str>> {
    judgements.iter().map(|j| j.reason.as_ref().map(Reason::code)).collect()
}

#[test]
fn what_is_reached_has_no_reason() {
    let met = judged(&[wish(60.0, 2.0)], strain(2.0), true);
    assert_eq!(reasons(&met), [None]);
    // The polygon of 90 sides is 0.02 % shorter than the circle.
    assert!((met[0].got_kpa - 2.0).abs() < 0.005, "{}", met[0].got_kpa);
    assert!((met[0].got_local_kpa - 2.0).abs() < 0.005);
    assert!((met[0].warp_strain - strain(2.0)).abs() < 0.001);
    assert!(met[0].weft_strain.abs() < 1e-9);
}

#[test]
fn flat_and_hollow_places_say_so_and_a_little_curvature_does_not() {
    for curvature in [0.0, -0.01] {
        let flat = judged(&[Wish { curvature, ..wish(60.0, 2.0) }], 0.1, true);
        assert_eq!(reasons(&flat), [Some("flat_or_hollow")]);
    }
    let round = judged(&[Wish { curvature: 0.01, ..wish(60.0, 2.0) }], 0.1, true);
    assert_eq!(reasons(&round), [Some("shape")]);
}

#[test]
fn a_strain_over_the_fabrics_limit_says_so_and_one_under_does_not() {
    // 0.5 N/mm at strain 0.5 on 45 mm is 5.56 kPa.
    assert_eq!(reasons(&judged(&[wish(60.0, 5.7)], 0.4, true)), [Some("over_strain")]);
    assert_eq!(reasons(&judged(&[wish(60.0, 5.4)], 0.4, true)), [Some("shape")]);
}

#[test]
fn two_wishes_on_one_thread_name_each_other_and_two_alike_do_not() {
    let second = |kpa| Wish { degrees: 90.0, ..wish(60.0, kpa) };
    let between = judged(&[wish(60.0, 1.0), second(3.0)], strain(2.0), true);
    assert_eq!(reasons(&between), [Some("thread_conflict"); 2]);
    assert_eq!(between[0].reason, Some(Reason::ThreadConflict { others: vec![1] }));
    let alike = judged(&[wish(60.0, 2.0), second(2.0)], strain(1.0), true);
    assert_eq!(reasons(&alike), [Some("shape"); 2]);
}

#[test]
fn wishes_on_neighbouring_threads_name_each_other_and_distant_ones_do_not() {
    let near = [wish(50.0, 1.0), wish(80.0, 3.0)];
    let between = judged(&near, strain(2.0), true);
    assert_eq!(reasons(&between), [Some("neighbour_conflict"); 2]);
    assert_eq!(between[1].reason, Some(Reason::NeighbourConflict { others: vec![0] }));
    // Both pressed too much: neither draws the other there.
    assert_eq!(reasons(&judged(&near, strain(4.0), true))[1], Some("shape"));
    let distant = [wish(15.0, 1.0), wish(100.0, 3.0)];
    assert_eq!(reasons(&judged(&distant, strain(2.0), true)), [Some("shape"); 2]);
}

#[test]
fn neighbours_missed_in_opposite_directions_name_each_other() {
    // They want strains of 0.072 and 0.082: less than a hundredth apart.
    let pair = |[low, high]: [f64; 2]| [wish(low, 0.8), wish(high, 0.91)];
    let between = judged(&pair([50.0, 80.0]), strain(0.855), true);
    assert_eq!(between[0].reason, Some(Reason::NeighbourConflict { others: vec![1] }));
    assert_eq!(between[1].reason, Some(Reason::NeighbourConflict { others: vec![0] }));
    // Both too much, or too far from each other.
    assert_eq!(reasons(&judged(&pair([50.0, 80.0]), strain(1.1), true)), [Some("shape"); 2]);
    assert_eq!(reasons(&judged(&pair([15.0, 100.0]), strain(0.855), true)), [Some("shape"); 2]);
}

#[test]
fn weft_threads_that_press_are_named_and_slack_ones_are_not() {
    // 0.5 N/mm at 4 % on a curvature of 0.01 per mm is 0.2 kPa, less what the warp loses.
    let pressed = judged_along(&[wish(60.0, 2.0)], strain(2.0) + 0.005, 0.04, true);
    assert!(
        matches!(pressed[0].reason, Some(Reason::WeftTension { strain, kpa })
        if (strain - 0.04).abs() < 1e-6 && (0.05..0.2).contains(&kpa)),
        "{pressed:?}"
    );
    assert_eq!(reasons(&judged(&[wish(60.0, 2.0)], strain(2.0) + 0.005, true)), [None]);
}

#[test]
fn a_thread_with_its_strain_and_another_pressure_is_between_threads_where_there_are_threads() {
    // 2.0 and 2.1 kPa are one wish for a thread; it has 2.7 % more than their mean.
    let second = Wish { degrees: 90.0, ..wish(60.0, 2.1) };
    let pair = [wish(60.0, 2.0), second];
    let reached = 1.027 * strain(2.05);
    let woven = judged_with(&pair, reached, 0.0, true, true);
    assert_eq!(reasons(&woven), [Some("between_threads"), None]);
    // A smaller spacing changes nothing where the fit has no threads of a model.
    let plain = judged(&pair, reached, true);
    assert!(
        matches!(plain[0].reason, Some(Reason::Shape { wanted, reached: got })
            if (wanted - strain(2.0)).abs() < 1e-9 && (got - reached).abs() < 1e-3),
        "{plain:?}"
    );
    assert_eq!(plain[1].reason, None);
}

#[test]
fn an_unfinished_fit_says_so_and_a_finished_one_does_not() {
    assert_eq!(reasons(&judged(&[wish(60.0, 2.0)], 0.1, false)), [Some("not_converged")]);
    assert_eq!(reasons(&judged(&[wish(60.0, 2.0)], 0.1, true)), [Some("shape")]);
}

#[test]
fn near_a_free_edge_is_said_and_far_from_it_is_not() {
    let near = judged(&[wish(4.0, 2.0)], 0.1, true);
    assert!(
        matches!(near[0].reason, Some(Reason::FreeEdge { distance }) if (distance - 4.0).abs() < 0.1)
    );
    assert_eq!(reasons(&judged(&[wish(14.0, 2.0)], 0.1, true)), [Some("shape")]);
    // The slit is sewn: it is no free edge.
    let at_the_seam = Wish { degrees: 3.0, ..wish(60.0, 2.0) };
    assert_eq!(reasons(&judged(&[at_the_seam], 0.1, true)), [Some("shape")]);
}
