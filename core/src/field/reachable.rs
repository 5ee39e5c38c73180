//! What pressure a point can get at all.

use crate::design::{Fabric, PressureModel};
use crate::pressure::{LocalCurvature, Stretch, pressure_kpa};

/// Strains that are tried: between two of them the pressure hardly changes.
const STEPS: u32 = 100;

/// The least and the largest pressure in kPa that warp strains from zero to the fabric's limit give
/// where the limb curves so and weft is strained so; negative where the fabric would lift off.
#[must_use]
pub fn reachable_kpa(
    model: PressureModel,
    fabric: &Fabric,
    curvature: &LocalCurvature,
    weft_strain: f64,
) -> [f64; 2] {
    let at = |warp: f64| {
        pressure_kpa(model, fabric, curvature, &Stretch::without_shear(warp, weft_strain))
    };
    // Usually the ends; but a stretched weft loses width, and with it pressure, as the warp
    // stretches, so that the least may lie between.
    (0..=STEPS)
        .map(|k| at(fabric.max_strain * f64::from(k) / f64::from(STEPS)))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laplaces_law_at_both_ends_of_the_fabrics_range() {
        let fabric = Fabric { warp: 0.5, weft: 2.0, max_strain: 0.4, ..Fabric::default() };
        let curvature = LocalCurvature { warp: 0.02, weft: 0.01, mean: 0.015 };
        let [low, high] = reachable_kpa(PressureModel::Laplace, &fabric, &curvature, 0.1);
        // Slack warp: weft alone, 2.0 · 0.1 · 0.01 N/mm² (per present width, which is the rest's).
        assert!((low - 2.0).abs() < 1e-12, "{low}");
        // Full: 0.5 · 0.4 · 0.02 / 1.1 + 2.0 · 0.1 · 0.01 / 1.4.
        assert!((high - (4.0 / 1.1 + 2.0 / 1.4)).abs() < 1e-12, "{high}");
        // A hollow place is pulled off the harder the tighter.
        let hollow = LocalCurvature { warp: -0.02, weft: 0.0, mean: -0.01 };
        let [low, high] = reachable_kpa(PressureModel::Laplace, &fabric, &hollow, 0.0);
        assert!((low + 4.0).abs() < 1e-12 && high == 0.0);
    }
}
