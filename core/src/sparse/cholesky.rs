//! Sparse symmetric positive definite systems: a thin layer over faer's Cholesky factorization.
//!
//! The pattern is ordered and analysed once, then factorized for as many sets of values as there
//! are. Always on one thread, so that the same input gives the same bits. Limit: positive
//! definite matrices only; others are refused, not patched.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, Mat, Par, Side, Spec};
use rayon::prelude::*;

/// Why a system cannot be solved.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SparseError {
    /// The matrix is not positive definite; usually a part of the unknowns is not held.
    #[error("the matrix is not positive definite (at unknown {0} of the elimination)")]
    NotPositiveDefinite(usize),
    /// The system does not fit the memory or the index type.
    #[error("a system of {0} unknowns is too large for this machine's memory")]
    TooLarge(usize),
    /// An entry lies outside the lower triangle.
    #[error("entry ({row}, {column}) is not in the lower triangle of {size} unknowns")]
    Entry {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// Number of unknowns.
        size: usize,
    },
}

/// Most entries and unknowns: what a signed number of 32 bits counts.
const MOST_ENTRIES: usize = i32::MAX as usize;

/// The analysed pattern of a symmetric matrix, given by its lower triangle.
pub struct Pattern {
    size: usize,
    /// Unknowns and entries are numbered by 32 bits: half the memory to go through.
    lower: SymbolicSparseColMat<u32>,
    /// The entries given, in the order of the matrix's own, and where each of those begins in it.
    order: Vec<u32>,
    starts: Vec<u32>,
    symbolic: SymbolicCholesky<u32>,
}

impl std::fmt::Debug for Pattern {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Pattern").field("size", &self.size).finish_non_exhaustive()
    }
}

impl Pattern {
    /// Analyses a matrix of `size` unknowns whose lower triangle (row ≥ column) has these
    /// entries; an entry that occurs several times stands for the sum.
    ///
    /// # Errors
    /// If an entry is not in the lower triangle, or memory runs out.
    pub fn new(size: usize, entries: &[(usize, usize)]) -> Result<Self, SparseError> {
        if let Some(&(row, column)) = entries.iter().find(|(r, c)| r < c || *r >= size) {
            return Err(SparseError::Entry { row, column, size });
        }
        if entries.len() > MOST_ENTRIES || size > MOST_ENTRIES {
            return Err(SparseError::TooLarge(size));
        }
        let (lower, order, starts) = assembled(size, entries);
        let symbolic = factorize_symbolic_cholesky(
            lower.as_ref(),
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| SparseError::TooLarge(size))?;
        Ok(Self { size, lower, order, starts, symbolic })
    }

    /// Factorizes the matrix with these values, one for each entry given to [`Pattern::new`] and
    /// in the same order.
    ///
    /// # Errors
    /// If the matrix is not positive definite (or has a value that is not finite), or memory
    /// runs out.
    ///
    /// # Panics
    /// If the number of values differs from the number of entries.
    pub fn factorize(&self, values: &[f64]) -> Result<Factor<'_>, SparseError> {
        let too_large = || SparseError::TooLarge(self.size);
        assert_eq!(values.len(), self.order.len());
        let sums: Vec<f64> = self
            .starts
            .windows(2)
            .map(|ends| {
                let parts = &self.order[ends[0] as usize..ends[1] as usize];
                let first = values[parts[0] as usize];
                parts[1..].iter().fold(first, |sum, &k| sum + values[k as usize])
            })
            .collect();
        let matrix = SparseColMatRef::new(self.lower.as_ref(), &sums);
        let mut factor = vec![0.0; self.symbolic.len_val()];
        let scratch = self.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large())?;
        self.symbolic
            .factorize_numeric_llt(
                &mut factor,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Spec::default(),
            )
            .map_err(|LltError::NonPositivePivot { index }| {
                SparseError::NotPositiveDefinite(index)
            })?;
        Ok(Factor { pattern: self, factor })
    }
}

/// The pattern of a matrix with these entries, the entries in its order, and where each place of
/// the pattern begins in that order.
fn assembled(
    size: usize,
    entries: &[(usize, usize)],
) -> (SymbolicSparseColMat<u32>, Vec<u32>, Vec<u32>) {
    let mut ends = vec![0usize; size + 1];
    for &(_, column) in entries {
        ends[column + 1] += 1;
    }
    for k in 0..size {
        ends[k + 1] += ends[k];
    }
    // Row and number of every entry, column by column.
    let mut sorted = vec![(0u32, 0u32); entries.len()];
    let mut filled = ends.clone();
    for (k, &(row, column)) in entries.iter().enumerate() {
        sorted[filled[column]] = (row as u32, k as u32);
        filled[column] += 1;
    }
    let mut columns = Vec::with_capacity(size);
    let mut rest = sorted.as_mut_slice();
    for k in 0..size {
        let (column, others) = rest.split_at_mut(ends[k + 1] - ends[k]);
        columns.push(column);
        rest = others;
    }
    columns.par_iter_mut().with_min_len(1024).for_each(|column| {
        column.sort_unstable_by_key(|&(row, _)| row);
    });
    let (mut column_starts, mut rows) = (Vec::with_capacity(size + 1), Vec::new());
    let (mut order, mut starts) = (Vec::with_capacity(entries.len()), Vec::new());
    for column in columns {
        column_starts.push(rows.len() as u32);
        let mut last = None;
        for &mut (row, k) in column {
            if last != Some(row) {
                last = Some(row);
                rows.push(row);
                starts.push(order.len() as u32);
            }
            order.push(k);
        }
    }
    column_starts.push(rows.len() as u32);
    starts.push(order.len() as u32);
    (SymbolicSparseColMat::new_checked(size, size, column_starts, None, rows), order, starts)
}

/// A factorized matrix.
#[derive(Debug)]
pub struct Factor<'a> {
    pattern: &'a Pattern,
    factor: Vec<f64>,
}

impl Factor<'_> {
    /// Solves for several right-hand sides at once.
    ///
    /// # Panics
    /// If a right-hand side has another length than the number of unknowns.
    #[must_use]
    pub fn solve(&self, right: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let (n, symbolic) = (self.pattern.size, &self.pattern.symbolic);
        assert!(right.iter().all(|column| column.len() == n));
        let mut x = Mat::from_fn(n, right.len(), |i, j| right[j][i]);
        let mut memory =
            MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(right.len(), Par::Seq));
        LltRef::new(symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            x.as_mut(),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        (0..right.len()).map(|j| (0..n).map(|i| x[(i, j)]).collect()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_of_springs_is_solved_for_two_right_hand_sides() {
        // [[2,-1,0],[-1,2,-1],[0,-1,2]], the diagonal given in two parts.
        let entries = [(0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (0, 0), (1, 1), (2, 2)];
        let pattern = Pattern::new(3, &entries).unwrap();
        let factor = pattern.factorize(&[1.0, -1.0, 1.0, -1.0, 1.0, 1.0, 1.0, 1.0]).unwrap();
        let x = factor.solve(&[vec![1.0, 0.0, 0.0], vec![0.0, 4.0, 0.0]]);
        for (got, want) in x.iter().flatten().zip([0.75, 0.5, 0.25, 2.0, 4.0, 2.0]) {
            assert!((got - want).abs() < 1e-15, "{got} {want}");
        }
        // The same pattern, other values.
        let twice = pattern.factorize(&[2.0, -2.0, 2.0, -2.0, 2.0, 2.0, 2.0, 2.0]).unwrap();
        assert!((twice.solve(&[vec![1.0, 0.0, 0.0]])[0][0] - 0.375).abs() < 1e-15);
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let pattern = Pattern::new(2, &[(0, 0), (1, 0), (1, 1)]).unwrap();
        let error = |v: &[f64]| pattern.factorize(v).map(|_| ()).unwrap_err();
        assert!(matches!(error(&[1.0, 2.0, 1.0]), SparseError::NotPositiveDefinite(_)));
        assert!(matches!(error(&[1.0, f64::NAN, 1.0]), SparseError::NotPositiveDefinite(_)));
        assert!(matches!(Pattern::new(2, &[(0, 1)]), Err(SparseError::Entry { .. })));
    }
}
