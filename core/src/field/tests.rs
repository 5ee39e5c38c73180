//! Worn pieces whose pressure and friction are known from mathematics.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::*;
use crate::geometry::Grading;
use crate::geometry::shapes::{grid, noisy};
use crate::pressure::Stretch;
use crate::progress::Silent;
use crate::seams::CutSurface;
use crate::surface::VertexId;

/// A worn piece of fabric: the surface, its pattern, and what is sewn.
struct Worn {
    disk: Surface,
    coordinates: Vec<DVec2>,
    seams: Vec<Seam>,
}

impl Worn {
    /// A grid with this place on the limb and this place in the pattern by shares across and up.
    fn new(
        [columns, rows]: [usize; 2],
        limb: impl Fn(f64, f64) -> DVec3,
        pattern: impl Fn(f64, f64) -> DVec2,
    ) -> Self {
        let share = |k: usize, n: usize| k as f64 / n as f64;
        let coordinates = (0..=rows)
            .flat_map(|i| (0..=columns).map(move |j| (i, j)))
            .map(|(i, j)| pattern(share(j, columns), share(i, rows)))
            .collect();
        Self { disk: grid(rows, columns, false, limb), coordinates, seams: Vec::new() }
    }

    /// Sews the first column to the last, which lie at the same places.
    fn sewn(mut self, [columns, rows]: [usize; 2]) -> Self {
        let side = |j: usize| (0..=rows).map(|i| VertexId::new(i * (columns + 1) + j)).collect();
        self.seams = vec![Seam { left: side(0), right: side(columns) }];
        self
    }

    fn field_with(&self, scan: &Surface, fabric: &Fabric, parameters: &Parameters) -> Field {
        let sewn =
            |v: VertexId| self.seams.iter().any(|s| s.left.contains(&v) || s.right.contains(&v));
        let free: Vec<HalfEdgeId> = self
            .disk
            .boundary_loops()
            .iter()
            .flat_map(|boundary| &boundary.half_edges)
            .copied()
            .filter(|&h| !(sewn(self.disk.from(h)) && sewn(self.disk.to(h))))
            .collect();
        everywhere(&FieldInput {
            relief: &Relief::new(scan, &self.disk, &self.seams, parameters, &Silent).unwrap(),
            disk: &self.disk,
            coordinates: &self.coordinates,
            free_edges: &free,
            fabric,
            pressure_model: PressureModel::Laplace,
            parameters,
        })
    }

    fn field(&self, fabric: &Fabric) -> Field {
        self.field_with(&self.disk, fabric, &Parameters::default())
    }
}

fn fabric(warp: f64, weft: f64) -> Fabric {
    Fabric { warp, weft, ..Fabric::default() }
}

fn round(radius: f64, angle: f64, z: f64) -> DVec3 {
    let (sin, cos) = angle.sin_cos();
    DVec3::new(radius * cos, radius * sin, z)
}

#[track_caller]
fn assert_near(value: f64, want: f64, tolerance: f64, of: &str) {
    assert!((value - want).abs() <= tolerance, "{of}: {value} instead of {want}");
}

const TUBE: [usize; 2] = [112, 40];

/// A point of a tube of radius 45 mm, 100 mm long.
fn on_tube(s: f64, t: f64) -> DVec3 {
    // Once round is exactly where it began.
    round(45.0, TAU * (s % 1.0), 20.0 + 100.0 * t)
}

/// The limb under it, which goes on for 20 mm at both ends.
fn limb(edge: f64) -> Surface {
    crate::geometry::shapes::cylinder(45.0, 140.0, edge)
}

/// The tube stretched round by the same strain everywhere.
fn tube(strain: f64) -> Worn {
    let pattern = |s: f64, t: f64| DVec2::new(TAU * 45.0 * s / (1.0 + strain), 100.0 * t);
    Worn::new(TUBE, on_tube, pattern).sewn(TUBE)
}

/// The vertices for which friction is stated.
fn stated(field: &Field) -> impl Iterator<Item = (usize, f64)> + '_ {
    field.friction.iter().enumerate().filter_map(|(i, f)| f.map(|f| (i, f)))
}

#[test]
fn a_tube_stretched_alike_presses_alike_and_needs_no_friction() {
    let worn = tube(0.24);
    // The seam is no edge of the limb: curvature there is the tube's, from the closed scan.
    let field = worn.field_with(&limb(2.5), &fabric(0.5, 0.5), &Parameters::default());
    for i in 0..worn.disk.vertex_count() {
        assert_near(field.warp_strain[i], 0.24, 0.001, "warp strain");
        assert_near(field.weft_strain[i], 0.0, 1e-9, "weft strain");
        // 0.5 · 0.24 N/mm over 45 mm.
        assert_near(field.pressure_kpa[i], 2.6667, 0.04, "pressure");
        let fine = field.fine_pressure_kpa[i].expect("a clean scan");
        assert_near(fine, 2.6667, 0.06, "pressure over 5 mm");
    }
    assert_eq!(field.fine_unreadable, None);
    // Off the two ends, across the seam too.
    let share = stated(&field).map(|(i, _)| field.area_mm2[i]).sum::<f64>()
        / field.area_mm2.iter().sum::<f64>();
    assert_near(share, 0.8, 0.05, "share with friction");
    for (i, friction) in stated(&field) {
        assert!(friction < 0.002, "{friction} at {}", worn.disk.points()[i]);
        let z = worn.disk.points()[i].z;
        assert!(z > 29.9 && z < 110.1, "{z}");
    }
}

#[test]
fn a_hoop_on_a_cone_slides_off_but_for_the_tangent_of_its_half_angle() {
    // A hoop of tension T on radius ρ: normal T cos α / ρ, up the slope T sin α / ρ.
    for degrees in [10.0f64, 25.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // Slant from 300 mm down to 200 mm from the apex, scaled to a limb's girth.
        let slant = |t: f64| (300.0 - 100.0 * t) * 0.17 / sin;
        let angle = |s: f64| 2.4 * (s - 0.5);
        let size = slant(0.0) - slant(1.0);
        let worn = Worn::new(
            [48, (size / 2.5) as usize],
            |s, t| round(slant(t) * sin, angle(s), -slant(t) * cos),
            // Every parallel stretched by 0.2; the weft has no stiffness.
            |s, t| DVec2::new(slant(t) * sin * angle(s) / 1.2, -slant(t)),
        );
        let field = worn.field(&fabric(0.5, 0.0));
        let mut count = 0;
        for (i, friction) in stated(&field) {
            assert_near(field.warp_strain[i], 0.2, 0.001, "warp strain");
            assert_near(friction, sin / cos, 0.02 * sin / cos, "friction");
            let rho = worn.disk.points()[i].truncate().length();
            // 0.5 · 0.2 N/mm: area stretch is the hoop's alone, sheared or not.
            let want = 100.0 * cos / rho;
            assert_near(field.pressure_kpa[i], want, 0.02 * want, "pressure");
            count += 1;
        }
        assert!(count > 300, "{count}");
    }
}

#[test]
fn a_thread_whose_tension_grows_round_a_tube_needs_eytelweins_friction() {
    // T = T₀ e^{μθ}: x(θ) = ∫ r dθ / (1 + ε₀ e^{μθ}) in closed form.
    let (mu, start, radius) = (0.35, 0.1, 40.0);
    let angle = |s: f64| 2.5 * s;
    let worn = Worn::new(
        [60, 36],
        |s, t| round(radius, angle(s), 60.0 * t),
        |s, t| {
            let theta = angle(s);
            let log = (1.0 + start * (mu * theta).exp()).ln() / mu;
            DVec2::new(radius * (theta - log), 60.0 * t)
        },
    );
    let field = worn.field(&fabric(0.5, 0.5));
    let mut count = 0;
    for (_, friction) in stated(&field) {
        assert_near(friction, mu, 0.03 * mu, "friction");
        count += 1;
    }
    assert!(count > 500, "{count}");
}

#[test]
fn a_helix_of_one_tension_is_a_geodesic_of_the_tube() {
    // The pattern turned by 30° on the limb: both threads are helices with constant strain.
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let worn = Worn::new(
        [60, 36],
        |s, t| round(40.0, 2.5 * s, 60.0 * t),
        |s, t| {
            let (u, v) = (100.0 * s, 60.0 * t);
            DVec2::new((cos * u + sin * v) / 1.15, (cos * v - sin * u) / 1.3)
        },
    );
    let field = worn.field(&fabric(0.5, 0.9));
    for (i, friction) in stated(&field) {
        assert!(friction < 0.01, "{friction}");
        // Euler: κ of a helix is cos² or sin² of its slope over r; forces per present width.
        let want = (0.5 * 0.15 / 1.3 * cos * cos + 0.9 * 0.3 / 1.15 * sin * sin) / 40.0 * 1e3;
        assert_near(field.pressure_kpa[i], want, 0.02 * want, "pressure");
    }
    assert!(stated(&field).count() > 500);
}

#[test]
fn a_ball_is_pressed_by_both_threads() {
    // A cap stretched by 0.2 both ways at its pole: P = T (1/R + 1/R), T = k ε λ / J = k ε / λ.
    let (ball, half) = (50.0, 25.0);
    let at = |s: f64, t: f64| DVec2::new(s - 0.5, t - 0.5) * 2.0 * half;
    let worn = Worn::new(
        [30, 30],
        |s, t| {
            let p = at(s, t);
            p.extend((ball * ball - p.length_squared()).sqrt())
        },
        |s, t| at(s, t) / 1.2,
    );
    let field = worn.field(&fabric(0.6, 0.6));
    let pole = worn.disk.points().iter().position(|p| p.truncate().length() < 1e-9).unwrap();
    let tension = 0.6 * 0.2 / 1.2;
    let want = 2.0 * tension / ball * 1e3;
    assert_near(field.pressure_kpa[pole], want, 0.01 * want, "pressure");
    assert_near(field.friction[pole].unwrap(), 0.0, 1e-9, "friction at the pole");
    // Everywhere: the formula with the ball's own curvature.
    for i in 0..worn.disk.vertex_count() {
        let stretch = Stretch {
            warp: field.warp_strain[i],
            weft: field.weft_strain[i],
            area: field.area_stretch[i],
        };
        let curvature = LocalCurvature { warp: 0.02, weft: 0.02, mean: 0.02 };
        let want = pressure_kpa(PressureModel::Laplace, &fabric(0.6, 0.6), &curvature, &stretch);
        assert_near(field.pressure_kpa[i], want, 0.01 * want, "pressure");
    }
}

#[test]
fn the_inner_bend_of_an_elbow_lifts_the_fabric_that_runs_along_it() {
    // The inner quarter of a bent tube, warp along the bend: hollow there.
    let at = |s: f64, t: f64| {
        let (around, along) = (std::f64::consts::PI + 1.2 * (t - 0.5), 1.2 * s);
        let out = 100.0 + 40.0 * around.cos();
        DVec3::new(out * along.cos(), out * along.sin(), 40.0 * around.sin())
    };
    // Rows of the grid run round the tube: the limb's outside is on the other hand.
    let worn =
        Worn::new([32, 24], |s, t| at(1.0 - s, 1.0 - t), |s, t| DVec2::new(60.0 * s, 48.0 * t));
    let field = worn.field(&fabric(0.5, 0.5));
    let summary = field.summary(&worn.disk, &worn.coordinates, 6.5, 0.5);
    let total: f64 = field.area_mm2.iter().sum();
    assert_near(total, worn.disk.total_area(), 1e-6, "area");
    let lifting: f64 = (0..field.area_mm2.len())
        .filter(|&i| {
            let p = worn.disk.points()[i];
            // Signed curvatures of the torus by place: along the bend cos / (R + r cos).
            let cosine = (p.truncate().length() - 100.0) / 40.0;
            let bend = cosine / (100.0 + 40.0 * cosine);
            let pull = |strain: f64| 0.5 * strain.max(0.0) * (1.0 + strain);
            pull(field.warp_strain[i]) * bend + pull(field.weft_strain[i]) / 40.0 < 0.0
        })
        .map(|i| field.area_mm2[i])
        .sum();
    assert!(lifting > 0.2 * total, "{lifting} of {total}");
    assert_near(summary.area_lifting, lifting, 0.06 * total, "lifting area");
    assert!(field.friction.iter().flatten().all(|f| f.is_finite()));
}

#[test]
fn nodal_forces_press_as_the_formula_says() {
    // Two roads to one pressure: springs' forces on the nodes, and tension times curvature. A bent
    // tube's outside with strains that vary in both directions.
    let at = |s: f64, t: f64| {
        let (around, along) = (1.4 * (s - 0.5), 0.9 * t);
        let out = 110.0 + 45.0 * around.cos();
        DVec3::new(out * along.cos(), 45.0 * around.sin(), out * along.sin())
    };
    let worn = Worn::new([40, 56], at, |s, t| {
        DVec2::new(45.0 * 1.4 * s * (0.8 + 0.1 * t), 110.0 * t + 4.0 * s * s)
    });
    let fabric = fabric(0.5, 0.8);
    let places = Places::new(&worn.disk, &[]);
    let cloth = Cloth::new(&worn.disk, &worn.coordinates);
    let bending = Bending::new(&worn.disk, &places, &Parameters::default(), &Silent).unwrap();
    let free: Vec<HalfEdgeId> =
        worn.disk.boundary_loops().iter().flat_map(|l| l.half_edges.clone()).collect();
    let round = Surroundings::new(&places, &bending.sampling, 10.0, &Silent).unwrap();
    let pull = Pull::new(
        &worn.disk,
        &worn.coordinates,
        &free,
        &fabric,
        &places,
        &bending.sampling,
        &round,
        (&bending.normal, &cloth.worn_area),
    );
    let field = worn.field(&fabric);
    let mut count = 0;
    for i in (0..places.count()).filter(|&i| pull.inside[i]) {
        let from_forces = 1e3 * pull.normal[i];
        // Means over 10 mm against values: a few per cent where strain varies.
        let want = field.pressure_kpa[i];
        assert_near(from_forces, want, 0.03 * want, "pressure");
        count += 1;
    }
    assert!(count > 500, "{count}");
}

#[test]
fn a_scanners_noise_is_measured_and_hides_what_it_must() {
    let clean = limb(2.0);
    let worn = tube(0.24);
    for deviation in [0.1, 0.3] {
        let scan = noisy(&clean, deviation, 5);
        let field = worn.field_with(&scan, &fabric(0.5, 0.5), &Parameters::default());
        let Some(Unreadable::Noise { noise_mm, deviation: uncertain }) = field.fine_unreadable
        else {
            panic!("{:?}", field.fine_unreadable)
        };
        assert_near(noise_mm, deviation, 0.12 * deviation, "noise");
        // Measured in the module of the scale fit: 30 1/m for 0.3 mm on 2 mm.
        assert_near(uncertain, 0.1 * deviation, 0.02 * deviation, "deviation of curvature");
        assert!(field.fine_pressure_kpa.iter().all(Option::is_none));
    }
    // Triangles of 9 mm carry no patch of 5 mm.
    let coarse = limb(9.0);
    let field = worn.field_with(&coarse, &fabric(0.5, 0.5), &Parameters::default());
    assert!(matches!(field.fine_unreadable, Some(Unreadable::TooCoarse { .. })));
    // A radius of 5 mm is read once.
    let parameters = Parameters { curvature_radius: 5.0, ..Parameters::default() };
    let field = worn.field_with(&clean, &fabric(0.5, 0.5), &parameters);
    assert_eq!(field.fine_unreadable, Some(Unreadable::NotFiner));
}

#[test]
fn a_crest_is_read_over_5_mm_and_half_lost_over_10() {
    // A ridge along the limb of radius 12 mm on a limb of 45 mm, smooth between.
    let profile = |angle: f64| 45.0 + 6.0 * (-(angle / 0.16).powi(2)).exp();
    let at = |s: f64, t: f64| {
        let angle = 2.4 * (s - 0.5);
        round(profile(angle), angle, 60.0 * t)
    };
    let curvature = |angle: f64| {
        // Of the curve r(θ): (r² + 2 r'² − r r'') / (r² + r'²)^{3/2}, by differences.
        let h = 1e-4;
        let (r, a, b) = (profile(angle), profile(angle + h), profile(angle - h));
        let (first, second) = ((a - b) / (2.0 * h), (a - 2.0 * r + b) / (h * h));
        (r * r + 2.0 * first * first - r * second) / (r * r + first * first).powf(1.5)
    };
    let worn = Worn::new([100, 50], at, |s, t| DVec2::new(90.0 * s, 60.0 * t));
    let field = worn.field(&fabric(0.5, 0.5));
    let summary = field.summary(&worn.disk, &worn.coordinates, 3.0, 0.5);
    let fine = summary.max_fine_kpa.expect("a clean scan");
    assert!(fine.at.y.abs() < 2.0, "{}", fine.at);
    let i = worn.disk.points().iter().position(|p| *p == fine.at).unwrap();
    let truth = 0.5 * field.warp_strain[i] * curvature(0.0) * 1e3;
    assert!(fine.value > 0.75 * truth && fine.value < 1.05 * truth, "{} {truth}", fine.value);
    assert!(field.pressure_kpa[i] < 0.8 * fine.value, "{}", field.pressure_kpa[i]);
    assert!(summary.max_kpa.value < 0.8 * fine.value, "{}", summary.max_kpa.value);
    assert!(summary.area_over_limit > 0.0);
}

#[test]
fn on_a_fine_mesh_few_places_are_computed_and_the_others_follow() {
    // Waves of 35 mm on a tube, edges of 1 mm: curvature every 2.5 mm.
    let at = |s: f64, t: f64| {
        let (angle, z) = (1.6 * s, 60.0 * t);
        let wave = 0.6 * (7.0 * angle).sin() * (z / 6.0).cos();
        round(40.0 + wave, angle, z)
    };
    let worn = Worn::new([64, 60], at, |s, t| DVec2::new(52.0 * s, 57.0 * t));
    let field = worn.field(&fabric(0.5, 0.5));
    assert_eq!(field.sampled_every_mm, Some(2.5));
    let curvature = crate::geometry::ScaleCurvature::new(&worn.disk, 10.0);
    let (mut off, mut range) = (0.0f64, [f64::INFINITY, f64::NEG_INFINITY]);
    for v in worn.disk.vertex_ids() {
        let direct = curvature.at_vertex(v).normal_curvature(field.warp_direction[v.index()]);
        off = off.max((direct - field.curvature[v.index()].warp).abs());
        range = [range[0].min(direct), range[1].max(direct)];
    }
    assert!(off < 0.06 * (range[1] - range[0]), "{off} of {range:?}");
    assert!(stated(&field).count() > 200);
}

#[test]
fn what_was_read_is_carried_to_the_vertices_of_smaller_triangles() {
    let worn = Worn::new([56, 20], on_tube, |s, t| DVec2::new(TAU * 45.0 * s, 100.0 * t));
    let worn = worn.sewn([56, 20]);
    let cut = CutSurface {
        disk: worn.disk.clone(),
        seams: worn.seams.clone(),
        splits: Vec::new(),
        ends: None,
        warnings: Vec::new(),
    };
    // Beside the seam, and away from it.
    let places = vec![on_tube(0.02, 0.5), on_tube(0.4, 0.9)];
    let finer = Finer::new(&cut, &Grading::new(places)).unwrap();
    let (scan, parameters) = (limb(2.5), Parameters::default());
    let of = |disk: &Surface, seams: &[Seam]| {
        Relief::new(&scan, disk, seams, &parameters, &Silent).unwrap()
    };
    let afresh = of(&finer.cut.disk, &finer.cut.seams);
    let carried = of(&cut.disk, &cut.seams).finer(&finer, &parameters, &Silent).unwrap();
    assert_eq!(carried.places.count(), afresh.places.count());
    assert!(carried.places.count() > of(&cut.disk, &cut.seams).places.count() + 200);
    assert_eq!(carried.surroundings.radius, afresh.surroundings.radius);
    for (place, (a, b)) in carried.bending.tensor.iter().zip(&afresh.bending.tensor).enumerate() {
        let off = (*a - *b).to_cols_array().into_iter().fold(0.0f64, |most, x| most.max(x.abs()));
        assert!(off < 0.02 / 45.0, "{place}: {off}");
        let turned = carried.bending.normal[place].dot(afresh.bending.normal[place]);
        assert!(turned > 0.9999, "{place}: {turned}");
    }
    let [a, b] = [&carried, &afresh].map(|relief| relief.bending.fine.as_ref().ok());
    assert_eq!(a.map(|fine| fine.tensor.len()), b.map(|fine| fine.tensor.len()));
}

#[test]
fn the_sides_of_a_seam_share_their_pressure() {
    // The left half of the tube stretched by 0.1, the right by 0.3: at the seam their mean, once by
    // area in the pattern (strain), once by area on the limb (pressure).
    let columns = TUBE[0] as f64;
    let worn = Worn::new(TUBE, on_tube, |s, t| {
        let x = if s < 0.5 { s / 1.1 } else { 0.5 / 1.1 + (s - 0.5) / 1.3 };
        DVec2::new(TAU * 45.0 * x, 100.0 * t)
    })
    .sewn(TUBE);
    let field = worn.field_with(&limb(2.5), &fabric(0.5, 0.5), &Parameters::default());
    let middle = 20 * (TUBE[0] + 1);
    let [left, right] = [middle, middle + TUBE[0]];
    assert_eq!(field.pressure_kpa[left], field.pressure_kpa[right]);
    let chord = (TAU * 0.5 / columns).sin() / (TAU * 0.5 / columns);
    let (a, b) = (1.1 * chord - 1.0, 1.3 * chord - 1.0);
    let strain = (a / 1.1 + b / 1.3) / (1.0 / 1.1 + 1.0 / 1.3);
    assert_near(field.warp_strain[left], strain, 1e-9, "strain");
    assert_near(field.pressure_kpa[left], 0.5 * 0.5 * (a + b) / 45.0 * 1e3, 0.01, "pressure");
}
