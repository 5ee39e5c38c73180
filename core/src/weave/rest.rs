//! The wanted lengths of the springs, Eqs. (5)–(7).

use super::{NodeIndex, SpringKind};

/// The wanted length of every spring of a woven model, by row.
#[derive(Debug, Clone, PartialEq)]
pub struct RestLengths {
    spacing: f64,
    first_row: i32,
    warp_strains: Vec<f64>,
    weft_strain: f64,
}

impl RestLengths {
    /// From the wanted warp strain of every row, beginning with `first_row`, and the one wanted
    /// weft strain (Lemma 4). A row outside the given ones takes the strain of the nearest.
    #[must_use]
    pub fn new(spacing: f64, first_row: i32, warp_strains: Vec<f64>, weft_strain: f64) -> Self {
        Self { spacing, first_row, warp_strains, weft_strain }
    }

    /// Wanted warp strain of a row.
    #[must_use]
    pub fn warp_strain(&self, row: i32) -> f64 {
        let last = self.warp_strains.len().saturating_sub(1);
        let k = usize::try_from(row - self.first_row).unwrap_or(0).min(last);
        self.warp_strains.get(k).copied().unwrap_or(0.0)
    }

    /// Wanted weft strain.
    #[must_use]
    pub fn weft_strain(&self) -> f64 {
        self.weft_strain
    }

    /// Wanted length of a warp spring in a row, Eq. (5), in mm.
    #[must_use]
    pub fn warp(&self, row: i32) -> f64 {
        (1.0 + self.warp_strain(row)) * self.spacing
    }

    /// Wanted length of a weft spring, Eq. (6), in mm.
    #[must_use]
    pub fn weft(&self) -> f64 {
        (1.0 + self.weft_strain) * self.spacing
    }

    /// Wanted length of a diagonal spring between `row` and `row + 1`, Eq. (7), in mm.
    #[must_use]
    pub fn diagonal(&self, row: i32) -> f64 {
        let mean = 0.5 * (self.warp_strain(row) + self.warp_strain(row + 1));
        ((1.0 + mean) * self.spacing).hypot(self.weft())
    }

    /// Wanted length of a spring of this kind whose lower node is `a`, in mm.
    #[must_use]
    pub fn of(&self, kind: SpringKind, a: NodeIndex) -> f64 {
        match kind {
            SpringKind::Warp => self.warp(a.i),
            SpringKind::Weft => self.weft(),
            SpringKind::Diagonal => self.diagonal(a.i),
        }
    }

    /// Wanted strain of a warp or weft spring; diagonal springs have none of their own.
    #[must_use]
    pub fn strain(&self, kind: SpringKind, a: NodeIndex) -> Option<f64> {
        match kind {
            SpringKind::Warp => Some(self.warp_strain(a.i)),
            SpringKind::Weft => Some(self.weft_strain),
            SpringKind::Diagonal => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_follow_equations_5_to_7() {
        let rest = RestLengths::new(4.0, -1, vec![0.1, 0.3], 0.05);
        assert!((rest.warp(-1) - 4.4).abs() < 1e-12);
        assert!((rest.warp(7) - 5.2).abs() < 1e-12, "beyond the last row");
        assert!((rest.weft() - 4.2).abs() < 1e-12);
        // Mean warp strain of the two rows is 0.2: 4.8 and 4.2 mm at a right angle.
        assert!((rest.diagonal(-1) - 4.8f64.hypot(4.2)).abs() < 1e-12);
        assert_eq!(rest.strain(SpringKind::Diagonal, NodeIndex { i: 0, j: 0 }), None);
    }
}
