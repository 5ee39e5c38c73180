//! Elastic energy J_E (Eq. 4) and the squared strain difference E_SSD (Eq. 14).

use crate::design::Fabric;
use crate::weave::{RestLengths, SpringKind, WovenModel};

/// Stiffness of a kind of spring, in N/mm.
#[must_use]
pub fn stiffness(fabric: &Fabric, kind: SpringKind) -> f64 {
    match kind {
        SpringKind::Warp => fabric.warp,
        SpringKind::Weft => fabric.weft,
        SpringKind::Diagonal => fabric.diagonal,
    }
}

/// How far a woven model is from its wanted strains.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Misfit {
    /// J_E, Eq. (4), in N·mm.
    pub energy: f64,
    /// E_SSD, Eq. (14), over warp and weft springs.
    pub e_ssd: f64,
    /// Number of warp and weft springs.
    pub springs: usize,
}

impl Misfit {
    /// Sums over every spring, in order.
    #[must_use]
    pub fn of(model: &WovenModel, rest: &RestLengths, fabric: &Fabric) -> Self {
        let mut misfit = Self::default();
        for spring in model.springs() {
            let wanted = rest.of(spring.kind, spring.a);
            let k = stiffness(fabric, spring.kind);
            misfit.energy += 0.5 * k * (spring.length - wanted).powi(2);
            if let Some(strain) = rest.strain(spring.kind, spring.a) {
                let reached = spring.length / model.spacing() - 1.0;
                misfit.e_ssd += (reached - strain).powi(2);
                misfit.springs += 1;
            }
        }
        misfit
    }

    /// Root mean square strain difference of warp and weft springs.
    #[must_use]
    pub fn rms_strain(&self) -> f64 {
        (self.e_ssd / self.springs.max(1) as f64).sqrt()
    }
}
