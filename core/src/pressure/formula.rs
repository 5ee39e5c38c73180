//! Normal pressure from tension and curvature, and the strain that a wanted pressure needs.
//!
//! Two formulas by name:
//!
//! - [`PressureModel::Laplace`]: P = T_warp κ(warp) + T_weft κ(weft), with the normal curvature along
//!   each thread and T the force per *present* width. Stiffness is per *rest* width, so with
//!   λ = 1 + ε and J the area stretch
//!   P = (k_warp ε⁺_warp λ_warp κ_warp + k_weft ε⁺_weft λ_weft κ_weft) / J,
//!   which is T / r on a cylinder (Laplace 1806; a rigid cylinder measured with a pressure sensor
//!   agrees to about 0.5 mmHg, Teyeme et al. 2021). ε⁺ = max(ε, 0): a thread pulls, never pushes.
//! - [`PressureModel::Paper`]: P = s π κ_H (k_warp ε_warp + k_weft ε_weft), Wang & Tang Eq. (2) with
//!   Lemma 3. On a cylinder, where κ_H = 1/(2r), s = 1 gives π/2 times Laplace's law.
//!
//! Diagonal springs stay out of both (Lemma 2), although as springs they would carry some 11 % of
//! the hoop tension at k_diag = k_warp / 10.

use std::f64::consts::PI;

use crate::design::{Fabric, PressureModel};
use crate::units::N_PER_MM2_PER_KPA;

/// Curvature at or below which a surface counts as flat, in 1/mm: a radius of 2 m, an eighth of
/// the curvature of the thickest limb taken (girth 1500 mm). No strain is returned from a division
/// by less.
pub const FLAT_CURVATURE: f64 = 0.0005;

/// Curvature of the surface at a point, in 1/mm, outward positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalCurvature {
    /// Normal curvature along the warp thread.
    pub warp: f64,
    /// Normal curvature along the weft thread.
    pub weft: f64,
    /// Mean curvature κ_H.
    pub mean: f64,
}

/// How the fabric is stretched at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Strain along warp.
    pub warp: f64,
    /// Strain along weft.
    pub weft: f64,
    /// Present area over rest area, J.
    pub area: f64,
}

impl Stretch {
    /// The stretch of fabric whose threads still cross at a right angle.
    #[must_use]
    pub fn without_shear(warp: f64, weft: f64) -> Self {
        Self { warp, weft, area: (1.0 + warp) * (1.0 + weft) }
    }
}

/// Normal pressure in kPa; negative where the fabric would lift off.
#[must_use]
pub fn pressure_kpa(
    model: PressureModel,
    fabric: &Fabric,
    curvature: &LocalCurvature,
    stretch: &Stretch,
) -> f64 {
    let newton_per_mm2 = match model {
        PressureModel::Laplace => {
            let pull = |k: f64, strain: f64| k * strain.max(0.0) * (1.0 + strain);
            (pull(fabric.warp, stretch.warp) * curvature.warp
                + pull(fabric.weft, stretch.weft) * curvature.weft)
                / stretch.area
        }
        PressureModel::Paper => {
            fabric.s
                * PI
                * curvature.mean
                * (fabric.warp * stretch.warp + fabric.weft * stretch.weft)
        }
    };
    newton_per_mm2 / N_PER_MM2_PER_KPA
}

/// The curvature through which warp tension presses: along warp, or κ_H in the paper's formula.
#[must_use]
pub fn pressing_curvature(model: PressureModel, curvature: &LocalCurvature) -> f64 {
    match model {
        PressureModel::Laplace => curvature.warp,
        PressureModel::Paper => curvature.mean,
    }
}

/// A wanted pressure on a thread, with what decides the strain that it needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// Wanted normal pressure, in kPa.
    pub kpa: f64,
    /// Curvature there.
    pub curvature: LocalCurvature,
    /// Strain of the weft thread there, as far as it is known.
    pub weft_strain: f64,
}

/// The warp strain with which one thread best gives the wanted pressures at its points, Eq. (3):
/// least squares. Not limited to what the fabric bears. `None` where no point is curved enough to be pressed upon.
///
/// `Laplace`: ε_warp = Σ κ_warp (P − κ_weft T_weft) / Σ κ_warp² k_warp, with
/// T_weft = k_weft ε⁺_weft / λ_warp; `Paper`: Eq. (3) as printed.
#[must_use]
pub fn warp_strain(model: PressureModel, fabric: &Fabric, points: &[Wish]) -> Option<f64> {
    let pressed: Vec<_> = points
        .iter()
        .filter(|wish| pressing_curvature(model, &wish.curvature) > FLAT_CURVATURE)
        .collect();
    if pressed.is_empty() {
        return None;
    }
    let mut strain = 0.0;
    // Under Laplace's law a stretched weft thread loses width as the warp stretches, so the
    // equation is solved again with the last strain; with a weft strain of zero the first
    // round is exact, otherwise the change shrinks by about k_weft ε_weft / k_warp a round.
    for _ in 0..50 {
        let (mut numerator, mut denominator) = (0.0, 0.0);
        for Wish { kpa, curvature, weft_strain: weft } in &pressed {
            let weft = *weft;
            let (per_strain, from_weft) = match model {
                PressureModel::Laplace => (
                    fabric.warp * curvature.warp / (1.0 + weft),
                    fabric.weft * weft.max(0.0) * curvature.weft / (1.0 + strain),
                ),
                PressureModel::Paper => {
                    let c = fabric.s * PI * curvature.mean;
                    (c * fabric.warp, c * fabric.weft * weft)
                }
            };
            numerator += per_strain * (kpa * N_PER_MM2_PER_KPA - from_weft);
            denominator += per_strain * per_strain;
        }
        let next: f64 = (numerator / denominator).max(-0.9);
        let change = (next - strain).abs();
        strain = next;
        if change < 1e-14 {
            break;
        }
    }
    Some(strain)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cylinder(radius: f64) -> LocalCurvature {
        LocalCurvature { warp: 1.0 / radius, weft: 0.0, mean: 0.5 / radius }
    }

    fn wish(kpa: f64, curvature: LocalCurvature) -> Wish {
        Wish { kpa, curvature, weft_strain: 0.0 }
    }

    fn fabric(warp: f64, weft: f64) -> Fabric {
        Fabric { warp, weft, ..Fabric::default() }
    }

    #[test]
    fn on_a_cylinder_laplace_is_tension_over_radius() {
        // 120 N/m on a radius of 45 mm is 20 mmHg.
        let stretch = Stretch::without_shear(0.24, 0.0);
        let kpa =
            pressure_kpa(PressureModel::Laplace, &fabric(0.5, 0.5), &cylinder(45.0), &stretch);
        assert!((kpa - 0.5 * 0.24 / 45.0 * 1000.0).abs() < 1e-12);
        assert!((crate::units::mmhg_from_kpa(kpa) - 20.0).abs() < 0.01);
    }

    #[test]
    fn the_papers_formula_is_half_pi_times_laplace_on_a_cylinder() {
        let stretch = Stretch::without_shear(0.2, 0.0);
        let laplace =
            pressure_kpa(PressureModel::Laplace, &fabric(0.5, 0.5), &cylinder(60.0), &stretch);
        let paper =
            pressure_kpa(PressureModel::Paper, &fabric(0.5, 0.5), &cylinder(60.0), &stretch);
        assert!((paper / laplace - PI / 2.0).abs() < 1e-12);
    }

    #[test]
    fn the_papers_knee_needs_the_top_of_its_colour_bar() {
        // 3.18 at a radius of 0.06 m with k = 0.5: 3.18 / (π 8.333 0.5) = 0.2429.
        let strain =
            warp_strain(PressureModel::Paper, &fabric(0.5, 5.0), &[wish(3.18, cylinder(60.0))]);
        assert!((strain.unwrap() - 0.24294).abs() < 1e-5);
    }

    #[test]
    fn equation_3_by_hand_for_two_points_on_one_thread() {
        // Laplace, k = 0.5 N/mm: κ = 0.02 wants 2 kPa, κ = 0.01 wants 2 kPa.
        // ε = (0.02·0.002 + 0.01·0.002) / (0.5 (0.0004 + 0.0001)) = 6e-5 / 2.5e-4 = 0.24.
        let points = [wish(2.0, cylinder(50.0)), wish(2.0, cylinder(100.0))];
        let strain = warp_strain(PressureModel::Laplace, &fabric(0.5, 0.5), &points).unwrap();
        assert!((strain - 0.24).abs() < 1e-12);
        // Paper: κ_H is half of it and s π stands in front: 0.24 · 2 / π.
        let strain = warp_strain(PressureModel::Paper, &fabric(0.5, 0.5), &points).unwrap();
        assert!((strain - 0.48 / PI).abs() < 1e-12);
    }

    #[test]
    fn what_the_inverse_gives_the_formula_gives_back_with_weft_tension_too() {
        let curvature = LocalCurvature { warp: 0.02, weft: 0.008, mean: 0.014 };
        for model in [PressureModel::Laplace, PressureModel::Paper] {
            let fabric = fabric(0.6, 1.5);
            let wish = Wish { weft_strain: 0.04, ..wish(2.5, curvature) };
            let strain = warp_strain(model, &fabric, &[wish]).unwrap();
            let stretch = Stretch::without_shear(strain, 0.04);
            let kpa = pressure_kpa(model, &fabric, &curvature, &stretch);
            assert!((kpa - 2.5).abs() < 1e-9, "{model:?} {kpa}");
        }
    }

    #[test]
    fn flat_and_hollow_places_give_no_strain() {
        let hollow = LocalCurvature { warp: -0.01, weft: 0.02, mean: 0.005 };
        let flat = LocalCurvature { warp: 1e-9, weft: 0.02, mean: 0.01 };
        for curvature in [hollow, flat] {
            let points = [wish(1.0, curvature)];
            assert_eq!(warp_strain(PressureModel::Laplace, &fabric(0.5, 0.5), &points), None);
            assert!(
                warp_strain(PressureModel::Paper, &fabric(0.5, 0.5), &points).is_some(),
                "the paper's formula asks for mean curvature alone"
            );
        }
    }

    #[test]
    fn a_compressed_thread_never_pushes() {
        let stretch = Stretch::without_shear(-0.1, 0.0);
        let kpa =
            pressure_kpa(PressureModel::Laplace, &fabric(0.5, 0.5), &cylinder(45.0), &stretch);
        assert!(kpa == 0.0);
    }
}
