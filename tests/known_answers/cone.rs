//! A cone flattens without strain.

use glam::{DVec2, DVec3};
use serde_json::json;
use support::check::congruence_gap;
use support::cli::Bench;
use support::design::{upright, wanting};
use support::fixtures::{cone_frustum, cone_sector};
use support::mesh::Triangulation;

#[test]
fn a_piece_of_a_cone_unrolls_to_its_sector() {
    for triangulation in [Triangulation::Structured, Triangulation::Jittered(5)] {
        let bench = Bench::new();
        // 200 mm round the middle, 100 mm along: flat angle 2 rad · sin 30° = 1 rad.
        let cone = cone_sector(30f64.to_radians(), [150.0, 250.0], 2.0, 36, triangulation);
        let on_generator = |slant: f64| {
            let r = 0.5 * slant;
            DVec3::new(r * 1f64.cos(), r * 1f64.sin(), -slant * 30f64.to_radians().cos())
        };
        let mut design = upright(wanting(&[]), on_generator(155.0), on_generator(245.0));
        design["facing"] = json!("outward");
        let args = ["--quiet", "--units", "mm", "--spacing", "7"];
        let _ = bench.flatten(&cone.mesh, &design, &args).succeeded();
        let worn = bench.worn();
        super::assert_without_strain(&worn);
        let unrolled: Vec<DVec2> = worn.v.iter().map(|&p| cone.unrolled(p)).collect();
        let gap = congruence_gap(&worn.vt, &unrolled);
        // 1 % of the sector's mean width.
        assert!(gap < 2.0, "{gap} mm, {triangulation:?}");
    }
}

#[test]
fn a_frustum_is_cut_and_unrolls_without_strain() {
    let bench = Bench::new();
    // Radii 45 and 35 mm, 72 mm along the surface: flat angle 2π sin 8° = 50°.
    let sine = 8f64.to_radians().sin();
    let cone =
        cone_frustum(8f64.to_radians(), [35.0 / sine, 45.0 / sine], 60, Triangulation::Alternating);
    let args = ["--quiet", "--units", "mm", "--spacing", "6"];
    let _ = bench.flatten(&cone.mesh, &wanting(&[]), &args).succeeded();
    let worn = bench.worn();
    super::assert_without_strain(&worn);
    assert_eq!(worn.outline().len(), 1);
    let seams = worn.seams();
    assert_eq!(seams.len(), 1);
    let slant = cone.outer - cone.inner;
    assert!((seams[0].left_mm / slant - 1.0).abs() < 0.01, "{seams:?}");
    assert!((seams[0].right_mm / slant - 1.0).abs() < 0.01, "{seams:?}");
    let area = 0.5 * cone.flat_angle() * (cone.outer.powi(2) - cone.inner.powi(2));
    assert!((worn.area() / area - 1.0).abs() < 0.01, "{} of {area}", worn.area());
}
