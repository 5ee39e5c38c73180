//! Correcting the wanted strain of a thread from the strain that it really takes.
//!
//! On a doubly curved limb the minimum of Eq. (4) leaves a thread, taken over its whole length, a
//! little off its wanted strain: the fabric shares the misfit out. The paper stops there. Asking for a
//! little less (or more) than wanted brings the thread's strain, and with it the pressure, to what
//! was wanted. The corrections belong to the annotations, not to rows, so that they survive a change
//! of level.
//!
//! They are integrated slowly: a row of N nodes answers with a time constant of
//! τ = (N / π)² / (λ k_warp) steps (the slowest mode of diffusion along it), and a correction
//! gathered over 4 τ does not swing.

use std::f64::consts::PI;

use crate::design::Fabric;
use crate::pressure::Targets;
use crate::weave::{SpringKind, WovenModel};

/// What is added to the wanted strain of each annotation's thread.
#[derive(Debug, Clone, PartialEq)]
pub struct Corrections {
    strains: Vec<f64>,
    last_change: f64,
}

impl Corrections {
    /// No corrections, for so many annotations.
    #[must_use]
    pub fn none(annotations: usize) -> Self {
        Self { strains: vec![0.0; annotations], last_change: 0.0 }
    }

    /// By annotation.
    #[must_use]
    pub fn strains(&self) -> &[f64] {
        &self.strains
    }

    /// The largest change of the last update, per thousand diffusion steps.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.last_change
    }

    /// Corrects from what the threads have reached after so many steps of λ.
    pub fn update(
        &mut self,
        model: &WovenModel,
        targets: &Targets,
        fabric: &Fabric,
        lambda: f64,
        steps: u64,
    ) {
        self.last_change = 0.0;
        for thread in &targets.threads {
            let Some(wanted) = thread.wanted else { continue };
            // A fabric at its limit is asked for its limit and no more.
            let wanted = wanted.clamp(0.0, fabric.max_strain);
            let Some((reached, springs)) = row_strain(model, thread.row) else { continue };
            let tau = (springs as f64 / PI).powi(2) / (lambda * fabric.warp);
            let gain = (steps as f64 / (4.0 * tau)).min(0.5);
            for &k in &thread.annotations {
                let before = self.strains[k];
                let after = before + gain * (wanted - reached);
                self.strains[k] = after.clamp(-wanted, fabric.max_strain - wanted);
                let rate = (self.strains[k] - before).abs() * 1000.0 / steps.max(1) as f64;
                self.last_change = self.last_change.max(rate);
            }
        }
    }
}

/// Strain of a row of warp springs taken together, and their number.
fn row_strain(model: &WovenModel, row: i32) -> Option<(f64, usize)> {
    let (mut length, mut springs) = (0.0, 0);
    for spring in model.springs().filter(|s| s.kind == SpringKind::Warp && s.a.i == row) {
        length += spring.length;
        springs += 1;
    }
    (springs > 0).then(|| (length / (springs as f64 * model.spacing()) - 1.0, springs))
}
