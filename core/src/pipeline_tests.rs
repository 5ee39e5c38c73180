//! A prepared limb solved again and again.

use glam::DVec3;

use super::*;
use crate::design::RegionPlane;
use crate::progress::Silent;
use crate::samples::sample;

fn gap(a: &Flattening, b: &Flattening) -> f64 {
    let pairs = a.coordinates.iter().zip(&b.coordinates);
    pairs.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max)
}

#[test]
fn a_changed_pressure_stiffness_or_marker_is_solved_from_the_last_pattern() {
    let limb = sample("elbow", 4000, 0.0).unwrap();
    let parameters = Parameters::default();
    let prepared = Prepared::new(&limb.mesh, &limb.design, &parameters, &Silent).unwrap();
    let solve =
        |design: &Design, earlier| prepared.solve(design, &parameters, earlier, &Silent).unwrap();
    let first = solve(&limb.design, None);
    let whole = flatten(&limb.mesh, &limb.design, &parameters, &Silent).unwrap();
    assert_eq!(first.coordinates, whole.coordinates, "the two halves are the whole");
    assert_eq!(first.report, whole.report);

    let mut pressure = limb.design.clone();
    pressure.pressures[1].kpa *= 1.2;
    let mut fabric = limb.design.clone();
    fabric.fabric.warp *= 1.1;
    let mut marker = limb.design.clone();
    let [upper, _] = marker.orientation.unwrap();
    marker.orientation = Some([upper, limb.design.pressures[2].at]);
    for changed in [pressure, fabric, marker] {
        let again = solve(&changed, Some(&first));
        let afresh = solve(&changed, None);
        assert!(gap(&again, &first) > 0.3, "nothing changed");
        assert!(gap(&again, &afresh) < 0.2, "{} mm", gap(&again, &afresh));
        assert!(again.report.fit.converged);
        for (asked, got) in changed.pressures.iter().zip(&again.report.pressures) {
            let share = got.got_kpa.unwrap() / asked.kpa;
            assert!((share - 1.0).abs() < 0.02, "{share}");
        }
    }
}

#[test]
fn what_would_need_another_preparation_is_refused_by_name() {
    let limb = sample("forearm", 3000, 0.0).unwrap();
    let parameters = Parameters::default();
    let prepared = Prepared::new(&limb.mesh, &limb.design, &parameters, &Silent).unwrap();
    let refused = |design: &Design, parameters: &Parameters| {
        let error = prepared.solve(design, parameters, None, &Silent).map(|_| ()).unwrap_err();
        error.to_string()
    };
    let mut design = limb.design.clone();
    design.region = vec![RegionPlane { point: DVec3::ZERO, normal: DVec3::Z }];
    assert!(refused(&design, &parameters).contains("another `region`"));
    let free = Parameters { equal_seams: false, ..parameters.clone() };
    assert!(refused(&limb.design, &free).contains("another `equal-seams`"));
}
