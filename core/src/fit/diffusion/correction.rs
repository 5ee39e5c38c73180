//! Correcting the wanted strain of a thread from the strain that it really takes.
//!
//! On a doubly curved limb the minimum of Eq. (4) leaves a thread, taken over its whole length, a
//! little off its wanted strain: the fabric shares the misfit out. The paper stops there. Asking for a
//! little less (or more) than wanted brings the thread's strain, and with it the pressure, to what
//! was wanted. The corrections belong to the annotations, not to rows, so that they survive a change
//! of level.
//!
//! A row of N nodes answers with a time constant of τ = (N / π)² / (λ k_warp) steps, the slowest
//! mode of diffusion along it. A proportional and integral controller whose integral time is τ makes
//! that a first-order approach without overshoot.

use std::f64::consts::PI;

use crate::design::Fabric;
use crate::pressure::Targets;
use crate::weave::{SpringKind, WovenModel};

/// Proportional gain: the corrected thread approaches its strain with the time constant τ / GAIN.
const GAIN: f64 = 1.0;

/// No correction is larger than this, or than half the wanted strain: a thread that needs more does
/// not answer, and pushing harder only distorts its neighbours.
const LARGEST: f64 = 0.05;

/// A thread has settled within this fraction of its strain, or this strain.
const SETTLED: (f64, f64) = (0.01, 0.001);

/// What is added to the wanted strain of each annotation's thread.
#[derive(Debug, Clone, PartialEq)]
pub struct Corrections {
    integrals: Vec<f64>,
    strains: Vec<f64>,
    settled: bool,
}

impl Corrections {
    /// No corrections, for so many annotations.
    #[must_use]
    pub fn none(annotations: usize) -> Self {
        let zero = vec![0.0; annotations];
        Self { integrals: zero.clone(), strains: zero, settled: true }
    }

    /// By annotation.
    #[must_use]
    pub fn strains(&self) -> &[f64] {
        &self.strains
    }

    /// Whether at the last update every thread that can be corrected further had its strain.
    #[must_use]
    pub fn settled(&self) -> bool {
        self.settled
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
        self.settled = true;
        for thread in &targets.threads {
            let (Some(wanted), Some(asked)) = (thread.wanted, thread.asked) else { continue };
            let wanted = wanted.clamp(0.0, fabric.max_strain);
            let row = (thread.y / model.spacing()).round() as i32;
            let Some((reached, springs)) = model.thread_strain(SpringKind::Warp, row) else {
                continue;
            };
            // Where threads lie too close to differ, what smoothing has left of the wish.
            let error = wanted + (thread.fitted - asked) - reached;
            let tau = (springs as f64 / PI).powi(2) / (lambda * fabric.warp);
            let part = (steps as f64 / tau).min(0.5);
            let largest = LARGEST.max(0.5 * wanted);
            let (low, high) = ((-wanted).max(-largest), (fabric.max_strain - wanted).min(largest));
            let mut at_limit = false;
            for &k in &thread.annotations {
                let integral = self.integrals[k] + part * GAIN * error;
                let total = integral + GAIN * error;
                at_limit |= total < low || total > high;
                // An integral that grew beyond what can be asked would take as long to come back.
                self.integrals[k] = integral.clamp(low.min(0.0), high.max(0.0));
                self.strains[k] = total.clamp(low, high);
            }
            self.settled &= at_limit || error.abs() <= (SETTLED.0 * wanted).max(SETTLED.1);
        }
    }
}
