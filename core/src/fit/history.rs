//! The course of a fit, and when it has come to rest.

use super::Misfit;

/// The state after one pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryEntry {
    /// Diffusion steps so far, all levels together.
    pub iteration: u64,
    /// Spacing of the level, in mm.
    pub spacing: f64,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of whole cells.
    pub cells: usize,
    /// J_E and E_SSD.
    pub misfit: Misfit,
}

impl HistoryEntry {
    /// J_E over the fabric's rest area, in N/mm: comparable while nodes come and go.
    #[must_use]
    pub fn energy_density(&self) -> f64 {
        self.misfit.energy / (self.cells.max(1) as f64 * self.spacing * self.spacing)
    }
}

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// E_SSD fell below its threshold.
    Tolerance,
    /// The energy no longer falls.
    Plateau,
    /// The gradient, scaled by the Hessian, fell below its threshold.
    Gradient,
    /// The fabric is at rest, but no target strains were found at which the pressures settle: those are kept
    /// that came nearest.
    Unsettled,
    /// The largest number of steps was reached: not converged.
    MaxIterations,
}

impl Stopped {
    /// A short name for reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Tolerance => "strain_tolerance",
            Self::Plateau => "plateau",
            Self::Gradient => "gradient",
            Self::Unsettled => "unsettled",
            Self::MaxIterations => "max_iterations",
        }
    }

    /// Whether the fit came to rest by itself.
    #[must_use]
    pub fn converged(self) -> bool {
        self != Self::MaxIterations
    }
}

/// Whether, over the last `window` steps of one level, the energy density has changed by no more
/// than the fraction `plateau`.
#[must_use]
pub fn at_plateau(level: &[HistoryEntry], window: u64, plateau: f64) -> bool {
    let Some(last) = level.last() else { return false };
    let Some(before) = level.iter().rev().find(|entry| entry.iteration + window <= last.iteration)
    else {
        return false;
    };
    let change = before.energy_density() - last.energy_density();
    change.abs() <= plateau * before.energy_density()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(iteration: u64, energy: f64) -> HistoryEntry {
        let misfit = Misfit { energy, e_ssd: 0.0, springs: 1 };
        HistoryEntry { iteration, spacing: 1.0, nodes: 4, cells: 1, misfit }
    }

    #[test]
    fn a_plateau_needs_a_whole_window_and_a_small_change() {
        let falling = [entry(0, 2.0), entry(500, 1.5), entry(1000, 1.0), entry(1500, 0.995)];
        assert!(!at_plateau(&falling[..2], 1000, 0.01), "too short");
        assert!(!at_plateau(&falling[..3], 1000, 0.01), "still falling");
        assert!(!at_plateau(&falling, 1000, 0.01), "fell by a third over the window");
        assert!(at_plateau(&falling, 500, 0.01));
        let rising = [entry(0, 1.0), entry(1000, 1.2)];
        assert!(!at_plateau(&rising, 1000, 0.01), "a rise is no rest");
    }
}
