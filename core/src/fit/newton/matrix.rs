//! The sparse symmetric matrix of the fit: two unknowns a vertex, one analysis, many factorizations.
//!
//! The sparsity is that of the cut surface's edges, with a full block for the vertices of every
//! further term (an edge of a seam and the one sewn to it; the orientation markers). It never
//! changes, so ordering and symbolic analysis are done once (faer, supernodal Cholesky, one thread:
//! two threads were slower at 10k, 40k and 160k nodes, and their bits differed).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};

use super::element::Element;
use crate::parameterize::SparseError;
use crate::surface::Surface;

/// Where the 2 × 2 block of two vertices stands in the values: the first entry of its first and of its
/// second column.
#[derive(Debug, Clone, Copy)]
struct Block(u32, u32);

/// The analysed matrix; lower triangle, vertex by vertex x then y.
pub struct Matrix {
    vertices: usize,
    symbolic: SymbolicSparseColMat<usize>,
    cholesky: SymbolicCholesky<usize>,
    /// The blocks of a triangle's corners, in the order (0,0) (1,0) (1,1) (2,0) (2,1) (2,2).
    triangles: Vec<[Block; 6]>,
    /// The corners' pairs in that order are lower triangle as they stand, or transposed.
    turned: Vec<[bool; 6]>,
    /// Of every clique the blocks of its pairs, row by row, and whether they are transposed.
    cliques: Vec<Vec<(Block, bool)>>,
    diagonal: Vec<Block>,
}

/// Corner pairs of a triangle, lower triangle row by row.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];

fn triangular(row: usize, column: usize) -> usize {
    if row >= column { row * (row + 1) / 2 + column } else { column * (column + 1) / 2 + row }
}

impl Matrix {
    /// The matrix of a surface's edges, and of `cliques` of vertices that are coupled all with all.
    ///
    /// # Errors
    /// If memory runs out.
    pub fn new(surface: &Surface, cliques: &[Vec<usize>]) -> Result<Self, SparseError> {
        let n = surface.vertex_count();
        let size = 2 * n;
        let triangles: Vec<[usize; 3]> =
            surface.triangles().iter().map(|t| t.map(|v| v.index())).collect();
        // Of every vertex itself and its greater neighbours, in order.
        let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(4 * triangles.len() + n);
        let narrow = |v: usize| u32::try_from(v).map_err(|_| SparseError::TooLarge(size));
        for v in 0..n {
            pairs.push((narrow(v)?, narrow(v)?));
        }
        let mut couple = |a: usize, b: usize| -> Result<(), SparseError> {
            pairs.push((narrow(a.min(b))?, narrow(a.max(b))?));
            Ok(())
        };
        for t in &triangles {
            couple(t[0], t[1])?;
            couple(t[1], t[2])?;
            couple(t[2], t[0])?;
        }
        for clique in cliques {
            for (k, &a) in clique.iter().enumerate() {
                for &b in &clique[..k] {
                    couple(a, b)?;
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut start = vec![0usize; n + 1];
        for &(column, _) in &pairs {
            start[column as usize + 1] += 1;
        }
        for v in 0..n {
            start[v + 1] += start[v];
        }
        let mut columns = Vec::with_capacity(size + 1);
        let mut rows = Vec::with_capacity(4 * pairs.len());
        columns.push(0);
        for v in 0..n {
            let list = &pairs[start[v]..start[v + 1]];
            for own in 0..2 {
                rows.extend((own..2).map(|axis| 2 * v + axis));
                for &(_, other) in &list[1..] {
                    rows.extend([2 * other as usize, 2 * other as usize + 1]);
                }
                columns.push(rows.len());
            }
        }
        if u32::try_from(rows.len()).is_err() {
            return Err(SparseError::TooLarge(size));
        }
        let block = |a: usize, b: usize| -> (Block, bool) {
            let (column, row) = (a.min(b), a.max(b));
            let list = &pairs[start[column]..start[column + 1]];
            let k = list.partition_point(|&(_, r)| (r as usize) < row);
            let first = columns[2 * column] + 2 * k;
            let second = columns[2 * column + 1] + if k == 0 { 0 } else { 2 * k - 1 };
            (Block(first as u32, second as u32), a < b)
        };
        let mut of_triangles = Vec::with_capacity(triangles.len());
        let mut turned = Vec::with_capacity(triangles.len());
        for t in &triangles {
            let both = PAIRS.map(|(a, b)| block(t[a], t[b]));
            of_triangles.push(both.map(|(block, _)| block));
            turned.push(both.map(|(_, turned)| turned));
        }
        let of_cliques = cliques
            .iter()
            .map(|clique| {
                (0..clique.len())
                    .flat_map(|a| (0..=a).map(move |b| (a, b)))
                    .map(|(a, b)| block(clique[a], clique[b]))
                    .collect()
            })
            .collect();
        let diagonal = (0..n).map(|v| block(v, v).0).collect();

        let order = dissection(surface, &pairs, &start);
        let too_large = |_| SparseError::TooLarge(size);
        let symbolic = SymbolicSparseColMat::new_checked(size, size, columns, None, rows);
        let mut forward = Vec::with_capacity(size);
        for &v in &order {
            forward.extend([2 * v as usize, 2 * v as usize + 1]);
        }
        let mut inverse = vec![0; size];
        for (place, &unknown) in forward.iter().enumerate() {
            inverse[unknown] = place;
        }
        let cholesky = factorize_symbolic_cholesky(
            symbolic.as_ref(),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, size)),
            CholeskySymbolicParams::default(),
        )
        .map_err(too_large)?;
        Ok(Self {
            vertices: n,
            symbolic,
            cholesky,
            triangles: of_triangles,
            turned,
            cliques: of_cliques,
            diagonal,
        })
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.symbolic.compute_nnz()
    }

    /// Number of values of the factor: what a factorization costs in memory, times eight bytes.
    pub fn factor_len(&self) -> usize {
        self.cholesky.len_val()
    }

    /// Adds the triangles' parts, in order.
    pub fn add_triangles(&self, values: &mut [f64], elements: &[Element]) {
        for ((element, blocks), turned) in elements.iter().zip(&self.triangles).zip(&self.turned) {
            for (k, &(a, b)) in PAIRS.iter().enumerate() {
                let Block(first, second) = blocks[k];
                let (first, second) = (first as usize, second as usize);
                let at = |i: usize, j: usize| element.stiffness[triangular(2 * a + i, 2 * b + j)];
                values[first] += at(0, 0);
                if a == b {
                    values[first + 1] += at(1, 0);
                    values[second] += at(1, 1);
                } else {
                    let (low, high) =
                        if turned[k] { (at(0, 1), at(1, 0)) } else { (at(1, 0), at(0, 1)) };
                    values[first + 1] += low;
                    values[second] += high;
                    values[second + 1] += at(1, 1);
                }
            }
        }
    }

    /// Adds s · c cᵀ for a row c over the coordinates (x₀, y₀, x₁, …) of a clique's vertices.
    pub fn add_square(&self, values: &mut [f64], clique: usize, row: &[f64], s: f64) {
        let mut blocks = self.cliques[clique].iter();
        for a in 0..row.len() / 2 {
            for b in 0..=a {
                let Some(&(Block(first, second), turned)) = blocks.next() else { return };
                let (first, second) = (first as usize, second as usize);
                let at = |i: usize, j: usize| s * row[2 * a + i] * row[2 * b + j];
                if a == b {
                    values[first] += at(0, 0);
                    values[first + 1] += at(1, 0);
                    values[second] += at(1, 1);
                } else {
                    let (low, high) =
                        if turned { (at(0, 1), at(1, 0)) } else { (at(1, 0), at(0, 1)) };
                    values[first] += at(0, 0);
                    values[first + 1] += low;
                    values[second] += high;
                    values[second + 1] += at(1, 1);
                }
            }
        }
    }

    /// Adds `s` to both diagonal entries of a vertex.
    pub fn add_diagonal(&self, values: &mut [f64], vertex: usize, s: f64) {
        let Block(first, second) = self.diagonal[vertex];
        values[first as usize] += s;
        values[second as usize] += s;
    }

    /// The mean of the diagonal's entries.
    pub fn mean_diagonal(&self, values: &[f64]) -> f64 {
        let sum: f64 = self
            .diagonal
            .iter()
            .map(|&Block(first, second)| values[first as usize] + values[second as usize])
            .sum();
        sum / (2 * self.vertices) as f64
    }

    /// The factorization of these values into the room of an earlier one; `None` if the matrix is
    /// not positive definite.
    ///
    /// # Errors
    /// If memory runs out.
    pub fn factorize<'a>(
        &'a self,
        values: &[f64],
        mut factor: Vec<f64>,
    ) -> Result<Result<Factored<'a>, Vec<f64>>, SparseError> {
        let too_large = SparseError::TooLarge(2 * self.vertices);
        factor.clear();
        factor.resize(self.cholesky.len_val(), 0.0);
        let scratch = self.cholesky.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large)?;
        let done = self.cholesky.factorize_numeric_llt(
            &mut factor,
            SparseColMatRef::new(self.symbolic.as_ref(), values),
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        Ok(if done.is_ok() { Ok(Factored { matrix: self, factor }) } else { Err(factor) })
    }
}

/// A factorized matrix.
pub struct Factored<'a> {
    matrix: &'a Matrix,
    factor: Vec<f64>,
}

impl Factored<'_> {
    /// Solutions for right-hand sides, together: reading the factor is what a solve costs.
    pub fn solve(&self, right: &[&[f64]]) -> Vec<Vec<f64>> {
        let cholesky = &self.matrix.cholesky;
        let rows = 2 * self.matrix.vertices;
        let count = right.len();
        let mut x = right.concat();
        let mut memory = MemBuffer::new(cholesky.solve_in_place_scratch::<f64>(count, Par::Seq));
        LltRef::new(cholesky, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x, rows, count),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        x.chunks_exact(rows).map(<[f64]>::to_vec).collect()
    }

    /// The room of the factor, for the next one.
    pub fn into_room(self) -> Vec<f64> {
        self.factor
    }
}

/// Vertices in the order of a nested dissection of the worn surface.
///
/// George (1973): the vertices on one side of a cut, those on the other, then those on the cut. The
/// cut is across the longest extent, in space, so that a seam's two sides lie together. On limbs it
/// makes less fill than minimum degree (a sixth less at 250,000 triangles).
fn dissection(surface: &Surface, pairs: &[(u32, u32)], start: &[usize]) -> Vec<u32> {
    let n = surface.vertex_count();
    // All neighbours of every vertex.
    let mut degree = vec![0usize; n + 1];
    for &(a, b) in pairs.iter().filter(|(a, b)| a != b) {
        degree[a as usize + 1] += 1;
        degree[b as usize + 1] += 1;
    }
    for v in 0..n {
        degree[v + 1] += degree[v];
    }
    let mut next = degree.clone();
    let mut neighbours = vec![0u32; degree[n]];
    for column in 0..n {
        for &(a, b) in &pairs[start[column] + 1..start[column + 1]] {
            for (from, to) in [(a, b), (b, a)] {
                neighbours[next[from as usize]] = to;
                next[from as usize] += 1;
            }
        }
    }
    let place: Vec<[f32; 3]> =
        surface.points().iter().map(|p| p.to_array().map(|x| x as f32)).collect();
    let mut part = vec![0u32; n];
    let mut parts = 0;
    let mut order: Vec<u32> = (0..n as u32).collect();
    /// Fewer vertices than this are eliminated as they come.
    const LEAF: usize = 12;
    let mut stack = vec![(0usize, n)];
    while let Some((low, high)) = stack.pop() {
        let list = &mut order[low..high];
        if list.len() <= LEAF {
            continue;
        }
        let mut least = [f32::INFINITY; 3];
        let mut most = [f32::NEG_INFINITY; 3];
        for &v in list.iter() {
            for axis in 0..3 {
                least[axis] = least[axis].min(place[v as usize][axis]);
                most[axis] = most[axis].max(place[v as usize][axis]);
            }
        }
        let extent = |axis: usize| most[axis] - least[axis];
        let axis = (1..3).fold(0, |best, a| if extent(a) > extent(best) { a } else { best });
        let middle = list.len() / 2;
        let key = |v: &u32| place[*v as usize][axis];
        list.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        // What lies beyond the middle and touches what lies before it is the cut.
        parts += 1;
        for &v in &list[..middle] {
            part[v as usize] = parts;
        }
        let touches = |v: u32| {
            let around = &neighbours[degree[v as usize]..degree[v as usize + 1]];
            around.iter().any(|&w| part[w as usize] == parts)
        };
        let mut beyond = Vec::with_capacity(list.len() - middle);
        let mut cut = Vec::new();
        for &v in &list[middle..] {
            if touches(v) { cut.push(v) } else { beyond.push(v) }
        }
        beyond.sort_unstable();
        cut.sort_unstable();
        list[..middle].sort_unstable();
        let split = low + middle;
        let end = split + beyond.len();
        order[split..end].copy_from_slice(&beyond);
        order[end..high].copy_from_slice(&cut);
        if beyond.is_empty() {
            // Nothing was gained: a dense piece.
            continue;
        }
        stack.push((low, split));
        stack.push((split, end));
    }
    order
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::shapes::grid;

    #[test]
    fn a_system_with_triangles_cliques_and_holds_is_solved() {
        let surface = grid(7, 5, false, |x, y| DVec3::new(70.0 * x, 50.0 * y, 0.0));
        let n = surface.vertex_count();
        let far = vec![0, n - 1];
        let matrix = Matrix::new(&surface, std::slice::from_ref(&far)).unwrap();
        // Elements B Bᵀ of arbitrary B, so that nothing cancels by symmetry.
        let mut random = 7u64;
        let mut value = || {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (random >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let mut dense = vec![vec![0.0; 2 * n]; 2 * n];
        let mut elements = Vec::new();
        for t in surface.triangles() {
            let b: [f64; 6] = std::array::from_fn(|_| value());
            let mut stiffness = [0.0; 21];
            let dof = |i: usize| 2 * t[i / 2].index() + i % 2;
            for i in 0..6 {
                for j in 0..6 {
                    dense[dof(i)][dof(j)] += b[i] * b[j];
                    stiffness[triangular(i, j)] = b[i] * b[j];
                }
            }
            elements.push(Element { stiffness });
        }
        let mut values = vec![0.0; matrix.len()];
        matrix.add_triangles(&mut values, &elements);
        let row = [0.3, -0.7, 1.1, 0.2];
        matrix.add_square(&mut values, 0, &row, 2.0);
        let dof = |i: usize| 2 * far[i / 2] + i % 2;
        for i in 0..4 {
            for j in 0..4 {
                dense[dof(i)][dof(j)] += 2.0 * row[i] * row[j];
            }
        }
        for v in 0..n {
            matrix.add_diagonal(&mut values, v, 0.5);
            dense[2 * v][2 * v] += 0.5;
            dense[2 * v + 1][2 * v + 1] += 0.5;
        }
        let mean = (0..2 * n).map(|i| dense[i][i]).sum::<f64>() / (2 * n) as f64;
        assert!((matrix.mean_diagonal(&values) - mean).abs() < 1e-12);
        let wanted: Vec<f64> = (0..2 * n).map(|i| (i as f64).sin()).collect();
        let right: Vec<f64> =
            dense.iter().map(|row| row.iter().zip(&wanted).map(|(a, b)| a * b).sum()).collect();
        let factor = matrix.factorize(&values, Vec::new()).unwrap().ok().unwrap();
        let x = factor.solve(&[&right]);
        for (got, want) in x[0].iter().zip(&wanted) {
            assert!((got - want).abs() < 1e-10, "{got} {want}");
        }
        // Taking more away than there is leaves no positive matrix.
        for v in 0..n {
            matrix.add_diagonal(&mut values, v, -5.0);
        }
        assert!(matrix.factorize(&values, factor.into_room()).unwrap().is_err());
    }

    #[test]
    fn the_dissection_is_a_permutation() {
        let surface = grid(40, 30, true, |x, y| DVec3::new(70.0 * x, 50.0 * y, x * y));
        let matrix = Matrix::new(&surface, &[]).unwrap();
        assert!(matrix.factor_len() > 0);
        let pairs: Vec<(u32, u32)> = (0..surface.vertex_count() as u32).map(|v| (v, v)).collect();
        let start: Vec<usize> = (0..=surface.vertex_count()).collect();
        let mut order = dissection(&surface, &pairs, &start);
        order.sort_unstable();
        assert!(order.iter().enumerate().all(|(i, &v)| i == v as usize));
    }
}
