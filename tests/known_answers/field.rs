//! Pressure everywhere, recomputed from the written pattern and the fixture's own curvature.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use serde_json::{Value, json};
use support::check::WornObj;
use support::cli::Bench;
use support::design::{upright, wanting};
use support::fixtures::{Tube, bumpy, tube};
use support::mesh::Triangulation;

const ARGS: [&str; 5] = ["--quiet", "--units", "mm", "--spacing", "7"];

/// A place of the limb with what the fabric does there.
#[derive(Debug, Clone, Copy, Default)]
struct Place {
    kpa: f64,
    area: f64,
}

/// Pressure at every place of a round tube by Laplace's law, with strains that are the means round
/// it, by area in the pattern, and the tube's own radius. Both sides of a seam count by their area.
fn pressures(worn: &WornObj, radius: f64, stiffness: f64) -> Vec<Place> {
    let mut corner = vec![[0.0; 4]; worn.vt.len()];
    for (face, stretch) in worn.faces.iter().zip(worn.stretches()) {
        let [a, b, c] = face.map(|(v, _)| worn.v[v]);
        let on_limb = 0.5 * (b - a).cross(c - a).length();
        for (_, vt) in face {
            corner[*vt][0] += stretch.area;
            corner[*vt][1] += stretch.area * stretch.warp;
            corner[*vt][2] += on_limb;
        }
    }
    let mut places: BTreeMap<[u64; 3], (f64, f64)> = BTreeMap::new();
    let mut seen = vec![false; worn.vt.len()];
    for &(v, vt) in worn.faces.iter().flatten() {
        if std::mem::replace(&mut seen[vt], true) {
            continue;
        }
        let [rest, stretched, on_limb, _] = corner[vt];
        let (warp, area_stretch) = (stretched / rest, on_limb / rest);
        let kpa = 1e3 * stiffness * (warp - 1.0).max(0.0) * warp / area_stretch / radius;
        let place = places.entry(worn.v[v].to_array().map(f64::to_bits)).or_default();
        place.0 += on_limb / 3.0 * kpa;
        place.1 += on_limb / 3.0;
    }
    places.into_values().map(|(force, area)| Place { kpa: force / area, area }).collect()
}

/// Friction needed and area at the vertices of a round tube more than 10 mm from its ends, without
/// any nodal force in space: the tube is unrolled round each place, where the mean divergence of the
/// stress σ (force per present width) with the weight ψ is −∫ σ ∇ψ / ∫ ψ, and the mean pressure
/// ∫ ψ σ_hoop / r / ∫ ψ. ψ is 1 − (d/10)² at the vertices and linear between.
fn frictions(worn: &WornObj, tube: &Tube, stiffness: f64) -> Vec<(f64, f64)> {
    let flat = |p: DVec3, from: f64| {
        let turn = (p.y.atan2(p.x) - from + PI).rem_euclid(TAU) - PI;
        DVec2::new(tube.radius * turn, p.z)
    };
    let azimuth = |p: DVec3| p.y.atan2(p.x);
    // Area on the limb and the rows of σ of each triangle, x round the tube, y along it.
    let stresses: Vec<(f64, [DVec2; 2])> = worn
        .faces
        .iter()
        .map(|face| {
            let from = azimuth(worn.v[face[0].0]);
            let p = face.map(|(v, _)| flat(worn.v[v], from));
            let q = face.map(|(_, vt)| worn.vt[vt]);
            let (a, b) = (q[1] - q[0], q[2] - q[0]);
            let (u, v) = (p[1] - p[0], p[2] - p[0]);
            let columns = [u * b.y - v * a.y, v * a.x - u * b.x].map(|c| c / a.perp_dot(b));
            let stretch = u.perp_dot(v) / a.perp_dot(b);
            let rows = columns.iter().fold([DVec2::ZERO; 2], |[x, y], c| {
                let pull = stiffness * (c.length() - 1.0).max(0.0) / c.length() / stretch;
                [x + pull * c.x * *c, y + pull * c.y * *c]
            });
            (0.5 * u.perp_dot(v), rows)
        })
        .collect();
    let mut areas = vec![0.0; worn.v.len()];
    for (face, (area, _)) in worn.faces.iter().zip(&stresses) {
        face.iter().for_each(|&(v, _)| areas[v] += area / 3.0);
    }
    (0..worn.v.len())
        .filter(|&v| worn.v[v].z > 10.0 && worn.v[v].z < tube.length - 10.0)
        .map(|v| {
            let from = azimuth(worn.v[v]);
            let (mut left_over, mut pressing) = (DVec2::ZERO, 0.0);
            for (face, (area, [x, y])) in worn.faces.iter().zip(&stresses) {
                let corners = face.map(|(k, _)| worn.v[k]);
                let weights =
                    corners.map(|p| (1.0 - p.distance_squared(worn.v[v]) / 100.0).max(0.0));
                let whole: f64 = weights.iter().sum();
                if whole == 0.0 {
                    continue;
                }
                let p = corners.map(|p| flat(p, from));
                let gradient = weights[0] * (p[2] - p[1]).perp()
                    + weights[1] * (p[0] - p[2]).perp()
                    + weights[2] * (p[1] - p[0]).perp();
                left_over -= 0.5 * DVec2::new(x.dot(gradient), y.dot(gradient));
                pressing += area * whole / 3.0 * x.x / tube.radius;
            }
            (left_over.length() / pressing, areas[v])
        })
        .collect()
}

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn codes(report: &Value) -> Vec<&str> {
    let warnings = report["warnings"].as_array().expect("a list of warnings");
    warnings.iter().map(|warning| warning["code"].as_str().expect("a code")).collect()
}

#[test]
fn the_figures_of_a_tube_are_those_of_its_pattern() {
    let tube = tube(30.0, 100.0, 76, Triangulation::Jittered(3));
    // Two pressures, so that percentiles and areas say something.
    let wishes: Vec<(DVec3, f64)> = [(0.15, 1.4), (0.3, 1.4), (0.7, 2.2), (0.85, 2.2)]
        .map(|(share, kpa)| (tube.at(2.4, share * tube.length), kpa))
        .to_vec();
    let mut design = upright(wanting(&wishes), tube.at(2.4, 98.0), tube.at(2.4, 2.0));
    design["limits"] = json!({"max_kpa": 2.25});
    let bench = Bench::new();
    let _ = bench.flatten(&tube.mesh, &design, &ARGS).succeeded();
    let report = bench.report();
    let field = &report["field"];
    let mut places = pressures(&bench.worn(), tube.radius, 0.5);
    places.sort_by(|a, b| a.kpa.total_cmp(&b.kpa));
    let total: f64 = places.iter().map(|place| place.area).sum();
    let most = places[places.len() - 1].kpa;
    // Curvature over 10 mm reads a round tube to 1 %, on jittered triangles too.
    assert!((number(&field["max_kpa"]) / most - 1.0).abs() < 0.02, "{most} {field}");
    assert!((number(&field["max_5mm_kpa"]) / most - 1.0).abs() < 0.04, "{most} {field}");
    let mut below = 0.0;
    let p95 = places.iter().find(|place| {
        below += place.area;
        below >= 0.95 * total
    });
    let p95 = p95.expect("somewhere").kpa;
    assert!((number(&field["p95_kpa"]) / p95 - 1.0).abs() < 0.02, "{p95} {field}");
    let mean = places.iter().map(|place| place.area * place.kpa).sum::<f64>() / total;
    assert!((number(&field["mean_kpa"]) / mean - 1.0).abs() < 0.01, "{mean} {field}");
    // The area above the limit lies between those of limits 2 % off.
    let over = |limit: f64| -> f64 {
        places.iter().filter(|place| place.kpa > limit).map(|place| place.area).sum()
    };
    let area = number(&field["area_over_limit_mm2"]);
    assert!(area >= over(2.25 * 1.03) && area <= over(2.25 / 1.03), "{area} {}", over(2.25));
    assert_eq!(codes(&report).contains(&"field_over_limit"), most > 2.25);
    // A tube lifts nothing, and all of it but 10 mm at the ends is judged.
    assert_eq!(number(&field["area_lifting_mm2"]), 0.0);
    let judged = number(&field["friction_area_mm2"]) / total;
    assert!((judged - 80.0 / 100.0).abs() < 0.04, "{judged}");
    let mut needed: Vec<(f64, f64)> = frictions(&bench.worn(), &tube, 0.5);
    needed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let stated: f64 = needed.iter().map(|(_, area)| area).sum();
    let mut below = 0.0;
    let p95 = needed.iter().find(|(_, area)| {
        below += area;
        below >= 0.95 * stated
    });
    let (p95, most) = (p95.expect("somewhere").0, needed[needed.len() - 1].0);
    assert!(p95 > 0.1, "threads of different lengths side by side pull at each other: {p95}");
    assert!((number(&field["friction_p95"]) / p95 - 1.0).abs() < 0.03, "{p95} {field}");
    assert!((number(&field["friction_max"]) / most - 1.0).abs() < 0.03, "{most} {field}");
    // Warp of 0.5 N/mm stretched by 0.5 at most: 8.33 kPa on 30 mm.
    for pressure in report["pressures"].as_array().expect("pressures") {
        let low = number(&pressure["reachable_kpa"][0]);
        let high = number(&pressure["reachable_kpa"][1]);
        assert!(low.abs() < 0.01 && (high / 8.333 - 1.0).abs() < 0.03, "{low} {high}");
        assert!((number(&pressure["reachable_mmhg"][1]) * 0.133_322 - high).abs() < 1e-9);
    }
}

/// A tube that wants 1 kPa near one end and 2 kPa near the other.
fn uneven(tube: &Tube) -> Vec<(DVec3, f64)> {
    [(0.1, 1.0), (0.3, 1.0), (0.7, 2.0), (0.9, 2.0)]
        .map(|(share, kpa)| (tube.at(2.4, share * tube.length), kpa))
        .to_vec()
}

#[test]
fn a_tourniquet_is_told_from_a_graded_brace() {
    let tube = tube(45.0, 120.0, 56, Triangulation::Alternating);
    let ends = [tube.at(2.4, 118.0), tube.at(2.4, 2.0)];
    for (near, far, rises) in [(ends[0], ends[1], true), (ends[1], ends[0], false)] {
        let bench = Bench::new();
        let design = upright(wanting(&uneven(&tube)), near, far);
        let _ = bench.flatten(&tube.mesh, &design, &ARGS).succeeded();
        let report = bench.report();
        assert_eq!(codes(&report).contains(&"rising_to_body"), rises, "{}", report["warnings"]);
        let rise = number(&report["field"]["rise_to_body_kpa"]);
        // The line through a step of 1 kPa rises by 1 if it is a ramp and by 1.5 if it is abrupt.
        assert!(rise.abs() > 0.9 && rise.abs() < 1.6 && (rise > 0.0) == rises, "{rise}");
    }
}

#[test]
fn a_crest_above_the_limit_is_found_where_nothing_was_asked() {
    // Waves of 3 mm: where the tube bulges the same thread presses harder.
    let mesh = bumpy(42.0, 100.0, 3.0, 80, Triangulation::Alternating);
    let at = DVec3::new(42.0 * 2.2f64.cos(), 42.0 * 2.2f64.sin(), 50.0);
    let flatten = |limits: Value| {
        let bench = Bench::new();
        let mut design = wanting(&[(at, 2.0)]);
        design["limits"] = limits;
        let _ = bench.flatten(&mesh, &design, &ARGS).succeeded();
        bench.report()
    };
    let report = flatten(json!({}));
    let most = number(&report["field"]["max_kpa"]);
    assert!(most > 2.6, "{most}");
    assert!(!codes(&report).contains(&"field_over_limit"), "{}", report["warnings"]);
    let crest = report["field"]["max_at"].clone();
    let beside: Vec<f64> =
        crest.as_array().expect("a place").iter().map(|x| number(x) + 1.5).collect();
    let far = [at.x, at.y, 500.0];
    let report = flatten(json!({"max_kpa": 0.5 * (2.0 + most), "bony": [far, beside]}));
    let bony: Vec<&Value> = report["warnings"]
        .as_array()
        .expect("a list")
        .iter()
        .filter(|warning| warning["code"] == "bony_over_limit")
        .collect();
    assert_eq!(bony.len(), 1, "{}", report["warnings"]);
    // The design's places are kept to a millionth of a millimetre.
    for axis in 0..3 {
        assert!((number(&bony[0]["at"][axis]) - beside[axis]).abs() < 1e-6);
    }
    let over = codes(&report).contains(&"field_over_limit");
    assert!(over && number(&report["field"]["area_over_limit_mm2"]) > 0.0);
}
