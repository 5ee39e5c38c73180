//! What `flatten` writes: every figure of the report that can be is recomputed from worn.obj.

use glam::DVec2;
use serde_json::Value;
use support::cli::Bench;
use support::fixtures::tube_with_hole;

use super::{FAST, limb};

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer}: {value}"))
}

#[test]
fn the_report_agrees_with_the_worn_surface() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let _ = bench.flatten(&mesh, &design, &FAST).succeeded();
    assert_eq!(
        bench.results(),
        ["flat.obj", "pattern.svg", "report.html", "report.json", "worn.obj"]
    );
    let (worn, report) = (bench.worn(), bench.report());

    assert_eq!(number(&report, "/pattern/flipped") as usize, worn.flipped());
    assert_eq!(number(&report, "/pattern/overlaps") as usize, worn.overlaps());
    assert_eq!((worn.flipped(), worn.overlaps(), worn.wound_twice()), (0, 0, 0));
    let size = worn.size();
    assert!((number(&report, "/pattern/width_mm") - size.x).abs() < 1e-6);
    assert!((number(&report, "/pattern/height_mm") - size.y).abs() < 1e-6);
    assert!((number(&report, "/pattern/area_mm2") / worn.area() - 1.0).abs() < 1e-6);

    assert_eq!(number(&report, "/surface/vertices") as usize, mesh.points.len());
    assert_eq!(number(&report, "/surface/triangles") as usize, mesh.triangles.len());
    assert_eq!(number(&report, "/surface/boundary_loops"), 2.0);
    assert!((number(&report, "/surface/area_mm2") / mesh.area() - 1.0).abs() < 1e-9);
    // Cutting neither adds nor removes surface.
    let worn_area: f64 = worn
        .faces
        .iter()
        .map(|f| {
            let [a, b, c] = f.map(|(v, _)| worn.v[v]);
            0.5 * (b - a).cross(c - a).length()
        })
        .sum();
    assert!((worn_area / mesh.area() - 1.0).abs() < 1e-6, "{worn_area}");

    let seams = worn.seams();
    let reported = report["seams"].as_array().unwrap();
    assert_eq!((seams.len(), reported.len()), (1, 1));
    let mut sides = [seams[0].left_mm, seams[0].right_mm];
    let mut said = [number(&reported[0], "/left_mm"), number(&reported[0], "/right_mm")];
    sides.sort_by(f64::total_cmp);
    said.sort_by(f64::total_cmp);
    for (a, b) in sides.iter().zip(said) {
        assert!((a - b).abs() < 1e-5, "{sides:?} {said:?}");
    }
    // A twentieth is what careful hands ease in when sewing.
    assert!(sides[1] - sides[0] < 0.05 * sides[1], "{sides:?}");
}

#[test]
fn the_report_has_every_key_of_the_contract() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let _ = bench.flatten(&mesh, &design, &FAST).succeeded();
    let report = bench.report();
    for key in ["method", "iterations", "converged", "energy", "e_ssd", "history"] {
        assert!(!report["fit"][key].is_null(), "fit.{key} in {}", report["fit"]);
    }
    assert_eq!(report["fit"]["method"], "newton");
    assert!(report["fit"]["history"].as_array().is_some_and(|h| h.len() > 1));
    assert_eq!(number(&report, "/curvature_radius_mm"), 10.0);
    assert!(report["surface"]["girths"].as_array().is_some_and(|g| g.len() >= 4));
    assert!(report["warnings"].is_array());
    let pressures = report["pressures"].as_array().unwrap();
    assert_eq!(pressures.len(), 2);
    for (pressure, wanted) in pressures.iter().zip([1.6, 2.0]) {
        assert_eq!(number(pressure, "/asked_kpa"), wanted);
        assert_eq!(pressure["at"].as_array().map(Vec::len), Some(3));
        for key in [
            "got_kpa",
            "got_local_kpa",
            "mean_curvature_per_m",
            "warp_curvature_per_m",
            "weft_curvature_per_m",
            "warp_strain",
            "weft_strain",
        ] {
            assert!(number(pressure, &format!("/{key}")).is_finite());
        }
        assert!(pressure.get("reason").is_some());
        // A limb of some 42 mm radius: 24 per metre.
        assert!((12.0..40.0).contains(&number(pressure, "/warp_curvature_per_m")));
    }
}

#[test]
fn the_reached_pressure_is_the_strain_of_the_pattern_times_the_curvature() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let _ = bench.flatten(&mesh, &design, &["--quiet", "--spacing", "6"]).succeeded();
    let (worn, report) = (bench.worn(), bench.report());
    let stretches = worn.stretches();
    for pressure in report["pressures"].as_array().unwrap() {
        let at = [0, 1, 2].map(|k| pressure["at"][k].as_f64().unwrap());
        let at = glam::DVec3::from_array(at);
        let near: Vec<_> = stretches.iter().filter(|s| s.worn.distance(at) < 10.0).collect();
        assert!(near.len() > 5);
        let area: f64 = near.iter().map(|s| s.area).sum();
        let mean = |of: &dyn Fn(&support::check::Stretch) -> f64| -> f64 {
            near.iter().map(|s| s.area * of(s)).sum::<f64>() / area
        };
        let (warp, weft) = (mean(&|s| s.warp), mean(&|s| s.weft));
        // Laplace with tension per worn width: T_warp = k ε / λ_weft, T_weft = k ε / λ_warp.
        let bend = |key: &str| number(pressure, key) * 1e-3;
        let kpa = 1e3
            * 0.5
            * ((warp - 1.0).max(0.0) / weft * bend("/warp_curvature_per_m")
                + (weft - 1.0).max(0.0) / warp * bend("/weft_curvature_per_m"));
        let local = number(pressure, "/got_local_kpa");
        // The program averages its threads, this the pattern's triangles.
        assert!((kpa / local - 1.0).abs() < 0.1, "{kpa} kPa recomputed, {local} kPa reported");
    }
}

#[test]
fn the_flat_file_is_the_pattern() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let args = [&FAST[..], &["--max-iterations", "200"]].concat();
    let _ = bench.flatten(&mesh, &design, &args).succeeded();
    let worn = bench.worn();
    let flat = String::from_utf8(bench.out("flat.obj")).unwrap();
    let points: Vec<Vec<f64>> = flat
        .lines()
        .filter_map(|line| line.strip_prefix("v "))
        .map(|rest| rest.split_whitespace().map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(points.len(), worn.vt.len());
    for (point, vt) in points.iter().zip(&worn.vt) {
        assert!(DVec2::new(point[0], point[1]).distance(*vt) < 1e-6 && point[2] == 0.0);
    }
    let faces = flat.lines().filter(|line| line.starts_with("f ")).count();
    assert_eq!(faces, worn.faces.len());
}

/// The numbers of an SVG path's data, in pairs.
fn pairs(data: &str) -> Vec<DVec2> {
    let numbers: Vec<f64> = data
        .split(|c: char| c.is_ascii_alphabetic() || c == ',' || c.is_whitespace())
        .filter_map(|x| x.parse().ok())
        .collect();
    numbers.chunks_exact(2).map(DVec2::from_slice).collect()
}

#[test]
fn the_drawing_has_the_patterns_true_size() {
    let (mesh, design) = limb();
    let bench = Bench::new();
    let args = [&FAST[..], &["--max-iterations", "200"]].concat();
    let _ = bench.flatten(&mesh, &design, &args).succeeded();
    let text = String::from_utf8(bench.out("pattern.svg")).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let svg = document.root_element();
    let mm = |name: &str| -> f64 {
        let value = svg.attribute(name).unwrap();
        value.strip_suffix("mm").unwrap_or_else(|| panic!("{name}={value}")).parse().unwrap()
    };
    let view: Vec<f64> =
        svg.attribute("viewBox").unwrap().split_whitespace().map(|x| x.parse().unwrap()).collect();
    // One user unit is one millimetre.
    assert_eq!(view, [0.0, 0.0, mm("width"), mm("height")]);
    let cut = document
        .descendants()
        .find(|n| n.attribute("id").is_some_and(|id| id.starts_with("cut")))
        .expect("a group with the cut line");
    let scaled = |node: roxmltree::Node| node.attribute("transform").is_some();
    assert!(!cut.ancestors().chain(cut.descendants()).any(scaled), "nothing scales below the root");
    let outline: Vec<DVec2> = cut
        .descendants()
        .filter_map(|n| n.attribute("d").or(n.attribute("points")))
        .flat_map(pairs)
        .collect();
    let low = outline.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let gap = (high - low) - bench.worn().size();
    // The outline is smoothed within a tenth of a millimetre.
    assert!(gap.abs().max_element() < 0.1, "{gap} mm");
    assert!(low.min_element() >= 0.0 && high.x <= mm("width") && high.y <= mm("height"));
}

#[test]
fn a_hole_stays_a_cut_out() {
    let bench = Bench::new();
    let mesh = tube_with_hole(42.0, 120.0, 12.0, 48);
    let design = support::design::wanting(&[]);
    // A rim of 75 mm is an opening, not a gap of the scan.
    let _ = bench.flatten(&mesh, &design, &FAST).succeeded();
    let worn = bench.worn();
    assert_eq!((worn.flipped(), worn.overlaps()), (0, 0));
    let outline = worn.outline();
    assert_eq!(outline.len(), 2);
    let length = |around: &Vec<usize>| -> f64 {
        (0..around.len())
            .map(|k| worn.vt[around[k]].distance(worn.vt[around[(k + 1) % around.len()]]))
            .sum()
    };
    let rim = outline.iter().map(length).fold(f64::MAX, f64::min);
    assert!((rim / (std::f64::consts::TAU * 12.0) - 1.0).abs() < 0.03, "{rim} mm");
}

#[test]
fn a_region_covers_what_lies_between_its_planes() {
    let (mesh, mut design) = limb();
    // The limb's own markers lie outside of the region.
    design.as_object_mut().unwrap().remove("orientation");
    design["region"] = serde_json::json!([
        {"point": [0.0, 0.0, 20.0], "normal": [0.0, 0.1, 1.0]},
        {"point": [0.0, 0.0, 92.0], "normal": [0.0, 0.0, -1.0]},
    ]);
    let bench = Bench::new();
    let _ = bench.flatten(&mesh, &design, &FAST).succeeded();
    let worn = bench.worn();
    assert_eq!((worn.flipped(), worn.overlaps()), (0, 0));
    let below = |p: &glam::DVec3| (p.z - 20.0 + 0.1 * p.y) / 1.01f64.sqrt();
    assert!(worn.v.iter().all(|p| below(p) > -1e-6 && p.z < 92.0 + 1e-6));
    // The ends are smooth: they lie in the planes, except where the seam ends.
    let ends = worn.v.iter().filter(|p| below(p).abs() < 1e-6 || (p.z - 92.0).abs() < 1e-6);
    assert!(ends.count() > 80);
}
