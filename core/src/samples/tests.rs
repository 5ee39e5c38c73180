//! What every limb must be.

use std::f64::consts::PI;

use glam::DVec3;

use super::tube::Limb;
use super::*;
use crate::surface::{Surface, VertexId};
use crate::units::kpa_from_mmhg;

fn surface(mesh: &RawMesh) -> Surface {
    let triangles = mesh.polygons.iter().map(|p| [p[0], p[1], p[2]].map(VertexId::new)).collect();
    Surface::new(mesh.points.clone(), triangles).unwrap()
}

/// The smallest angle of all triangles, in degrees.
fn smallest_angle(surface: &Surface) -> f64 {
    let angles = surface.triangle_ids().flat_map(|t| {
        let p = surface.corners(t);
        (0..3).map(move |k| (p[(k + 1) % 3] - p[k]).angle_between(p[(k + 2) % 3] - p[k]))
    });
    angles.fold(PI, f64::min).to_degrees()
}

#[test]
fn every_limb_is_an_outward_tube_of_well_shaped_triangles() {
    for name in NAMES {
        for triangles in [500, 2_000, 20_000] {
            let surface = surface(&sample(name, triangles, 0.0).unwrap().mesh);
            assert_eq!(surface.euler_characteristic(), 0);
            assert_eq!(surface.boundary_loops().len(), 2);
            assert_eq!(surface.components().1, 1);
            let count = surface.triangle_count() as f64;
            assert!((count / triangles as f64 - 1.0).abs() < 0.1, "{count} of {triangles}");
            let smallest = smallest_angle(&surface);
            assert!(smallest > 15.0, "{name} {triangles}: {smallest}°");
            // Divergence theorem: the volume of all rays from the origin, inside the limb, to
            // its skin; negative if the triangles faced inward.
            let corners = surface.triangle_ids().map(|t| surface.corners(t));
            let volume: f64 = corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
            assert!(volume > 1e5, "{volume} mm³");
        }
    }
}

#[test]
fn every_resolution_samples_the_same_surface() {
    for name in NAMES {
        let fine = sample(name, 20_000, 0.0).unwrap().mesh;
        let coarse = sample(name, 700, 0.0).unwrap().mesh;
        for &point in &coarse.points {
            let gap =
                fine.points.iter().map(|q| q.distance_squared(point)).fold(f64::MAX, f64::min);
            // Edges of the fine mesh are 2 to 4 mm long, 8 where a bend stretches them.
            assert!(gap.sqrt() < 4.5, "{name}: {} mm at {point}", gap.sqrt());
        }
    }
}

#[test]
fn sections_do_not_cross_on_the_inner_side_of_a_bend() {
    // Sections cross where walking along the limb goes backward against the centre line.
    for Specimen { name, limb, .. } in &SPECIMENS {
        let step = 1e-3;
        for station in (0..=limb.length() as i32).map(f64::from) {
            let [before, after] = [-step, step].map(|d| limb.frame(station + d));
            let along = limb.frame(station).along;
            for angle in (0..180).map(|k| f64::from(2 * k).to_radians()) {
                let walk = after.place(limb.section(station + step, angle))
                    - before.place(limb.section(station - step, angle));
                let forward = walk.dot(along) / (2.0 * step);
                assert!(forward > 0.25, "{name}: {forward} at station {station}, angle {angle}");
            }
        }
    }
}

#[test]
fn no_plane_mirrors_a_limb() {
    // Against the plane of flexion every section differs by millimetres.
    for Specimen { name, limb, .. } in &SPECIMENS {
        for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let station = part * limb.length();
            let most = (0..180)
                .map(|k| f64::from(k).to_radians())
                .map(|angle| {
                    let [a, b] = [angle, -angle].map(|angle| limb.section(station, angle).length());
                    (a - b).abs()
                })
                .fold(0.0, f64::max);
            assert!(most > 0.5, "{name}: {most} mm at station {station}");
        }
    }
}

/// Normal curvature round the limb and mean curvature, in 1/mm, outward positive: from the first
/// and second fundamental form by central differences (do Carmo 1976, 3-3).
fn curvature(limb: &dyn Limb, station: f64, angle: f64) -> (f64, f64) {
    let (h, w) = (1e-2, 1e-3);
    let at = |i: f64, j: f64| limb.point(station + i * h, angle + j * w);
    let here = at(0.0, 0.0);
    let u = (at(1.0, 0.0) - at(-1.0, 0.0)) / (2.0 * h);
    let v = (at(0.0, 1.0) - at(0.0, -1.0)) / (2.0 * w);
    let uu = (at(1.0, 0.0) - 2.0 * here + at(-1.0, 0.0)) / (h * h);
    let vv = (at(0.0, 1.0) - 2.0 * here + at(0.0, -1.0)) / (w * w);
    let uv = (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * h * w);
    let inward = -limb.normal(station, angle);
    let [e, f, g] = [u.dot(u), u.dot(v), v.dot(v)];
    let [l, m, n] = [uu, uv, vv].map(|second| second.dot(inward));
    (n / g, (e * n - 2.0 * f * m + g * l) / (2.0 * (e * g - f * f)))
}

#[test]
fn the_designs_ask_for_what_a_weave_can_give() {
    for specimen in &SPECIMENS {
        let Specimen { name, limb, mmhg, .. } = specimen;
        let design = specimen.demonstration();
        assert_eq!((mmhg.len(), design.pressures.len()), (4, 4));
        for (wish, wanted) in mmhg.iter().zip(&design.pressures) {
            assert!((8.0..=20.0).contains(&wish.pressure), "{name} {wish:?}");
            assert_eq!(wanted.kpa, kpa_from_mmhg(wish.pressure));
            assert!(limb.point(wish.station, wish.angle).distance(wanted.at) < 1e-9);
            let (round, _) = curvature(*limb, wish.station, wish.angle);
            // Laplace: P = k ε κ, with 1 kPa = 1e-3 N/mm².
            let strain = wanted.kpa * 1e-3 / (design.fabric.warp * round);
            assert!((0.06..0.22).contains(&strain), "{name} {wish:?}: strain {strain}");
            // No sharp crest and no hollow within a curvature radius.
            for (ds, dw) in [(8.0, 0.0), (-8.0, 0.0), (0.0, 0.15), (0.0, -0.15)] {
                let (near, _) = curvature(*limb, wish.station + ds, wish.angle + dw);
                assert!((0.5..1.7).contains(&(near / round)), "{name} {wish:?}: {near}, {round}");
            }
        }
        let mut stations: Vec<f64> = mmhg.iter().map(|wish| wish.station).collect();
        stations.insert(0, 0.0);
        stations.push(limb.length());
        assert!(stations.windows(2).all(|p| p[1] - p[0] >= 30.0), "{name} {stations:?}");
        let markers = design.orientation.unwrap();
        assert!(markers[0].z > markers[1].z, "the first is the end near the body");
    }
}

#[test]
fn the_papers_examples_want_strains_of_its_colour_bar() {
    let mut count = 0;
    for specimen in &SPECIMENS {
        for configuration in specimen.configurations {
            for weave in configuration.weaves {
                let design = specimen.example(configuration, weave);
                assert_eq!(design.pressure_model, crate::design::PressureModel::Paper);
                let fabric = &design.fabric;
                assert_eq!([fabric.warp, fabric.weft, fabric.diagonal], weave.stiffness);
                assert_eq!(fabric.s, 1.0);
                for (wish, wanted) in weave.kpa.iter().zip(&design.pressures) {
                    assert_eq!(wanted.kpa, wish.pressure);
                    let (_, mean) = curvature(specimen.limb, wish.station, wish.angle);
                    // Eq. (3) for one point: ε = P / (s π κ_H k_warp).
                    let strain = wanted.kpa * 1e-3 / (PI * mean * fabric.warp);
                    let place = format!("{} {} {wish:?}", specimen.name, configuration.name);
                    assert!((0.0..0.25).contains(&strain), "{place}: strain {strain}");
                    assert!(wish.pressure < 1.0 || strain > 0.1, "{place}: strain {strain}");
                }
                count += 1;
            }
        }
    }
    assert_eq!(count, 4 * 2 + 1 + 1);
}

#[test]
fn two_of_the_papers_knee_pressures_meet_on_one_thread() {
    let [knee] = configurations("knee") else { panic!("one example") };
    let [weave] = knee.weaves else { panic!("one fabric") };
    let of = |kpa: f64| weave.kpa.iter().find(|wish| wish.pressure == kpa).unwrap();
    let (low, high) = (of(0.06), of(2.29));
    assert!(of(3.18).pressure > of(0.26).pressure);
    assert!((low.station - high.station).abs() < 12.0, "close along the leg");
    assert!((low.angle - high.angle).cos() < -0.9, "on opposite sides of it");
    let [a, b] = [low, high].map(|w| curvature(&knee::Knee, w.station, w.angle).1);
    assert!((a / b - 1.0).abs() < 0.15, "alike in mean curvature: {a} and {b} per mm");
}

#[test]
fn the_thumbs_opening_is_round_and_of_its_size() {
    for triangles in [3_000, 20_000] {
        let options = SampleOptions { triangles, opening: true, ..SampleOptions::default() };
        let surface = surface(&sample_with("wrist", &options).unwrap().mesh);
        assert_eq!((surface.components().1, surface.euler_characteristic()), (1, -1));
        let loops = surface.boundary_loops();
        assert_eq!(loops.len(), 3);
        let smallest = smallest_angle(&surface);
        assert!(smallest > 12.0, "{triangles}: {smallest}°");
        let rims: Vec<Vec<DVec3>> = loops
            .iter()
            .map(|rim| rim.half_edges.iter().map(|&h| surface.point(surface.from(h))).collect())
            .collect();
        let length = |rim: &Vec<DVec3>| -> f64 {
            (0..rim.len()).map(|k| rim[k].distance(rim[(k + 1) % rim.len()])).sum()
        };
        let rim = rims.iter().min_by(|a, b| length(a).total_cmp(&length(b))).unwrap();
        assert!((64.0..76.0).contains(&length(rim)), "{} mm", length(rim));
        let centre = rim.iter().sum::<DVec3>() / rim.len() as f64;
        let radii: Vec<f64> = rim.iter().map(|p| p.distance(centre)).collect();
        let [least, most] =
            [f64::min as fn(f64, f64) -> f64, f64::max].map(|f| radii.iter().copied().reduce(f));
        assert!(most.unwrap() / least.unwrap() < 1.45, "{least:?} {most:?}");
    }
}

#[test]
fn the_same_arguments_give_the_same_limb() {
    for name in NAMES {
        let [a, b] = [(); 2].map(|()| sample(name, 3_000, 0.3).unwrap());
        let bits = |s: &Sample| -> Vec<[u64; 3]> {
            s.mesh.points.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
        };
        assert_eq!(bits(&a), bits(&b));
        assert_eq!(a, b);
    }
}

#[test]
fn noise_is_along_the_normal_and_as_large_as_asked() {
    let clean = sample("elbow", 20_000, 0.0).unwrap().mesh;
    let noisy = sample("elbow", 20_000, 0.4).unwrap().mesh;
    assert_eq!(clean.polygons, noisy.polygons);
    let normals = surface(&clean).vertex_normals();
    let count = clean.points.len() as f64;
    let (mut square, mut sideways) = (0.0, 0.0);
    for ((a, b), n) in clean.points.iter().zip(&noisy.points).zip(normals) {
        let moved = *b - *a;
        square += moved.length_squared();
        sideways += (moved - moved.dot(n) * n).length_squared();
    }
    let deviation = (square / count).sqrt();
    // The standard error of a deviation over 10,000 draws is 0.7 %.
    assert!((deviation / 0.4 - 1.0).abs() < 0.03, "{deviation} mm");
    assert!((sideways / square).sqrt() < 0.1);
}

#[test]
fn a_wrong_argument_is_named_with_the_remedy() {
    let message = |name, triangles, noise| sample(name, triangles, noise).unwrap_err();
    assert_eq!(
        message("elbwo", 1_000, 0.0).to_string(),
        "there is no sample `elbwo`; the nearest name is `elbow` (there are: elbow, knee, wrist, \
         ankle, forearm)"
    );
    assert_eq!(
        message("elbow", 499, 0.0).to_string(),
        "a sample cannot have 499 triangles: ask for 500 to 2000000"
    );
    assert!(matches!(message("elbow", 2_000_001, 0.0), SampleError::Triangles { .. }));
    for noise in [-0.1, 2.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(message("elbow", 1_000, noise), SampleError::Noise { .. }));
    }
}

#[test]
fn what_a_limb_does_not_have_is_named_with_the_nearest() {
    let message = |name, opening, configuration: Option<&str>, fabric: Option<&str>| {
        let [configuration, fabric] = [configuration, fabric].map(|text| text.map(str::to_owned));
        let options =
            SampleOptions { triangles: 500, noise_mm: 0.0, opening, configuration, fabric };
        sample_with(name, &options).unwrap_err().to_string()
    };
    assert_eq!(
        message("knee", true, None, None),
        "the sample `knee` has no opening; these can have one: wrist"
    );
    assert_eq!(
        message("ankle", false, Some("a"), None),
        "the sample `ankle` has no configuration; these have: elbow, knee, wrist"
    );
    assert_eq!(
        message("elbow", false, Some("paper"), None),
        "the sample `elbow` has no configuration `paper`; the nearest name is `a` (there are: a, \
         b, c, d)"
    );
    assert_eq!(
        message("elbow", false, Some("b"), Some("isotropc")),
        "configuration `b` of the sample `elbow` is not made in the fabric `isotropc`; the \
         nearest name is `isotropic` (there are: isotropic, anisotropic)"
    );
    assert_eq!(
        message("elbow", false, None, Some("isotropic")),
        "a fabric goes with a configuration: name that too, or leave the fabric out"
    );
}

#[test]
fn the_bends_are_what_they_are_said_to_be() {
    use shape::{bent, evenly_bent};
    assert!(bent(-300.0, 0.0, 20.0) < 1e-9 && (bent(300.0, 0.0, 20.0) - 1.0).abs() < 1e-9);
    assert!((bent(5.0, 5.0, 20.0) - 0.5).abs() < 1e-15);
    let even = |station: f64| evenly_bent(station, 100.0, 40.0, 8.0);
    assert!(even(0.0) < 1e-4 && (even(200.0) - 1.0).abs() < 1e-4);
    assert!((even(100.0) - 0.5).abs() < 1e-12);
    // Even in the middle: the slope there is 1 / (2 · 40).
    for station in [90.0, 100.0, 115.0] {
        let slope = (even(station + 0.01) - even(station - 0.01)) / 0.02;
        assert!((slope * 80.0 - 1.0).abs() < 0.01, "{slope} at {station}");
    }
}
