//! A plane comes back as itself.

use glam::{DVec2, DVec3};
use serde_json::json;
use support::check::congruence_gap;
use support::cli::Bench;
use support::design::{upright, wanting};
use support::fixtures::plane;
use support::mesh::Triangulation;

#[test]
fn a_plane_comes_back_as_itself() {
    for triangulation in Triangulation::ALL {
        let bench = Bench::new();
        let mesh = plane(120.0, 80.0, 24, triangulation);
        let top = DVec3::new(60.0, 75.0, 0.0);
        let bottom = DVec3::new(60.0, 5.0, 0.0);
        let mut design = upright(wanting(&[]), top, bottom);
        design["facing"] = json!("outward");
        let args = ["--quiet", "--units", "mm", "--spacing", "6"];
        let _ = bench.flatten(&mesh, &design, &args).succeeded();
        let worn = bench.worn();
        super::assert_without_strain(&worn);
        assert_eq!(worn.v.len(), worn.vt.len(), "a disk is not cut");
        let itself: Vec<DVec2> = worn.v.iter().map(|p| p.truncate()).collect();
        let gap = congruence_gap(&worn.vt, &itself);
        // 1 % of the shorter side.
        assert!(gap < 0.8, "{gap} mm, {triangulation:?}");
        let size = worn.size();
        assert!((size.x / 120.0 - 1.0).abs() < 0.01, "{size}");
        assert!((size.y / 80.0 - 1.0).abs() < 0.01, "{size}");
    }
}

#[test]
fn the_markers_turn_the_pattern_and_the_first_is_on_top() {
    let bench = Bench::new();
    let mesh = plane(120.0, 80.0, 16, Triangulation::Alternating);
    // Along +x: in the pattern the plane's x must point down, its y to the right.
    let near = DVec3::new(10.0, 40.0, 0.0);
    let far = DVec3::new(110.0, 40.0, 0.0);
    let mut design = upright(wanting(&[]), near, far);
    design["facing"] = json!("outward");
    let args = ["--quiet", "--units", "mm", "--spacing", "8"];
    let _ = bench.flatten(&mesh, &design, &args).succeeded();
    let worn = bench.worn();
    let at = |x: f64, y: f64| {
        let i = (0..worn.v.len())
            .min_by(|&i, &j| {
                let gap = |k: usize| worn.v[k].truncate().distance(DVec2::new(x, y));
                gap(i).total_cmp(&gap(j))
            })
            .unwrap();
        worn.vt[i]
    };
    let down = at(120.0, 40.0) - at(0.0, 40.0);
    assert!((down.y / -120.0 - 1.0).abs() < 0.01 && down.x.abs() < 1.2, "{down}");
    let right = at(60.0, 80.0) - at(60.0, 0.0);
    assert!((right.x / 80.0 - 1.0).abs() < 0.01 && right.y.abs() < 1.2, "{right}");
}
