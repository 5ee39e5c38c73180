//! The sparse symmetric matrix of a surface: two unknowns a vertex, one analysis, many factorizations.
//!
//! The sparsity is that of the cut surface's edges, with a full block for the vertices of every
//! further term (an edge of a seam and the one sewn to it). It never changes, so the order of
//! elimination (`dissection`) and the analysis (`multifrontal`) are made once.

use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::cholesky::SparseError;
use super::dissection::{Dissection, Neighbours};
use super::multifrontal::{AXES, BLOCK, Blocks, Multifrontal};
use crate::progress::Progress;
use crate::surface::Surface;

/// The block of two vertices, and whether it stands transposed.
#[derive(Debug, Clone, Copy)]
struct Block {
    at: u32,
    turned: bool,
}

/// The part of a block that comes from one triangle.
#[derive(Debug, Clone, Copy, Default)]
struct Part {
    triangle: u32,
    /// The corners, in the order of `PAIRS`.
    pair: u8,
    /// Whether it stands transposed.
    turned: bool,
}

/// A triangle's part of a matrix.
#[derive(Debug, Clone, Copy)]
pub struct Element {
    /// By x₀, y₀, x₁, y₁, x₂, y₂: lower triangle, row by row.
    pub stiffness: [f64; 21],
}

/// The analysed matrix.
pub struct Matrix {
    vertices: usize,
    factors: Multifrontal,
    blocks: usize,
    /// What each block gets from the triangles: those of block k are `parts[starts[k]..starts[k + 1]]`, in the
    /// triangles' order.
    starts: Vec<u32>,
    parts: Vec<Part>,
    /// Of every clique the blocks of its pairs, lower triangle row by row.
    cliques: Vec<Vec<Block>>,
    /// Of every vertex with itself.
    diagonal: Vec<u32>,
    /// Memory that is no longer needed: new memory costs as much as half a factorization.
    spare: Mutex<Spare>,
}

/// Room of a factor, and of what a factorization needs meanwhile.
#[derive(Default)]
struct Spare {
    factor: Vec<f64>,
    meanwhile: Vec<f64>,
}

/// Rooms are larger than they have to be by one part in so many.
const SPARE: usize = 8;

/// Corner pairs of a triangle, lower triangle row by row.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];

const fn triangular(row: usize, column: usize) -> usize {
    if row >= column { row * (row + 1) / 2 + column } else { column * (column + 1) / 2 + row }
}

/// Of each of `PAIRS` the four entries of its block in an element, column by column.
const ENTRIES: [[usize; BLOCK]; 6] = {
    let mut entries = [[0; BLOCK]; 6];
    let mut k = 0;
    while k < 6 {
        let (a, b) = PAIRS[k];
        let (row, column) = (AXES * a, AXES * b);
        entries[k] = [
            triangular(row, column),
            triangular(row + 1, column),
            triangular(row, column + 1),
            triangular(row + 1, column + 1),
        ];
        k += 1;
    }
    entries
};

/// What each of so many blocks gets from the triangles, given the blocks of each triangle.
fn parts(blocks: usize, of_triangles: &[[Block; 6]]) -> (Vec<u32>, Vec<Part>) {
    let mut starts = vec![0u32; blocks + 1];
    for block in of_triangles.iter().flatten() {
        starts[block.at as usize + 1] += 1;
    }
    for k in 0..blocks {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut parts = vec![Part::default(); starts[blocks] as usize];
    for (triangle, blocks) in of_triangles.iter().enumerate() {
        for (pair, block) in blocks.iter().enumerate() {
            let at = &mut next[block.at as usize];
            // There are fewer triangles than 2^32, the matrix has refused more.
            let (triangle, pair) = (triangle as u32, pair as u8);
            parts[*at as usize] = Part { triangle, pair, turned: block.turned };
            *at += 1;
        }
    }
    (starts, parts)
}

impl Matrix {
    /// The matrix of a surface's edges, and of `cliques` of vertices that are coupled all with all.
    ///
    /// # Errors
    /// If there are more vertices than can be counted.
    pub fn new(surface: &Surface, cliques: &[Vec<usize>]) -> Result<Self, SparseError> {
        let n = surface.vertex_count();
        let too_large = || SparseError::TooLarge(AXES * n);
        // Of numbers of 32 bits: blocks are counted by them, some seven a vertex, and their parts, some twelve.
        if n > u32::MAX as usize / 32 {
            return Err(too_large());
        }
        let triangles: Vec<[usize; 3]> =
            surface.triangles().iter().map(|t| t.map(|v| v.index())).collect();
        // Of every vertex itself and its greater neighbours, in order.
        let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(4 * triangles.len() + n);
        let mut couple = |a: usize, b: usize| pairs.push((a.min(b) as u32, a.max(b) as u32));
        for v in 0..n {
            couple(v, v);
        }
        for t in &triangles {
            couple(t[0], t[1]);
            couple(t[1], t[2]);
            couple(t[2], t[0]);
        }
        for clique in cliques {
            for (k, &a) in clique.iter().enumerate() {
                clique[..k].iter().for_each(|&b| couple(a, b));
            }
        }
        pairs.par_sort_unstable();
        pairs.dedup();
        if u32::try_from(pairs.len()).is_err() {
            return Err(too_large());
        }
        let mut start = vec![0usize; n + 1];
        for &(first, _) in &pairs {
            start[first as usize + 1] += 1;
        }
        for v in 0..n {
            start[v + 1] += start[v];
        }
        let apart: Vec<(u32, u32)> = pairs.iter().copied().filter(|(a, b)| a != b).collect();
        let neighbours = Neighbours::new(n, &apart);
        let dissection = Dissection::new(surface.points(), &neighbours);
        let (factors, Blocks { of_pair, place }) =
            Multifrontal::new(dissection, &neighbours, &pairs);
        let block = |row: usize, column: usize| {
            let (a, b) = (row.min(column), row.max(column));
            let list = &pairs[start[a]..start[a + 1]];
            let k = start[a] + list.partition_point(|&(_, other)| (other as usize) < b);
            Block { at: of_pair[k], turned: place[row] < place[column] }
        };
        let of_triangles: Vec<[Block; 6]> =
            triangles.par_iter().map(|t| PAIRS.map(|(a, b)| block(t[a], t[b]))).collect();
        let (starts, parts) = parts(pairs.len(), &of_triangles);
        let of_cliques = cliques
            .iter()
            .map(|clique| {
                (0..clique.len())
                    .flat_map(|a| (0..=a).map(move |b| (a, b)))
                    .map(|(a, b)| block(clique[a], clique[b]))
                    .collect()
            })
            .collect();
        let diagonal = (0..n).map(|v| block(v, v).at).collect();
        let blocks = pairs.len();
        Ok(Self {
            vertices: n,
            factors,
            blocks,
            starts,
            parts,
            cliques: of_cliques,
            diagonal,
            spare: Mutex::default(),
        })
    }

    /// Number of values.
    pub fn entries(&self) -> usize {
        BLOCK * self.blocks
    }

    /// Number of values of the factor: what a factorization costs in memory, times eight bytes.
    pub fn factor_len(&self) -> usize {
        self.factors.len()
    }

    /// Adds a block given by its entries; a vertex's block with itself is given by its lower triangle.
    fn add(values: &mut [f64], block: Block, entry: impl Fn(usize, usize) -> f64) {
        let at = BLOCK * block.at as usize;
        let Some([a, b, c, d]) = values.get_mut(at..at + BLOCK) else { return };
        let (low, high) =
            if block.turned { (entry(0, 1), entry(1, 0)) } else { (entry(1, 0), entry(0, 1)) };
        *a += entry(0, 0);
        *b += low;
        *c += high;
        *d += entry(1, 1);
    }

    /// Sets the values to the sums of the triangles' parts, each in the triangles' order.
    pub fn set_triangles(&self, values: &mut Vec<f64>, elements: &[Element]) {
        /// Fewer blocks than this a task cost more than they save.
        const PER_TASK: usize = 2048;
        values.resize(self.entries(), 0.0);
        values.par_chunks_mut(BLOCK * PER_TASK).enumerate().for_each(|(chunk, values)| {
            let starts = self.starts[chunk * PER_TASK..].windows(2);
            for (values, range) in values.chunks_exact_mut(BLOCK).zip(starts) {
                let mut sum = [0.0; BLOCK];
                for part in &self.parts[range[0] as usize..range[1] as usize] {
                    let entries = &elements[part.triangle as usize].stiffness;
                    let [a, b, c, d] = ENTRIES[usize::from(part.pair)].map(|at| entries[at]);
                    let (low, high) = if part.turned { (c, b) } else { (b, c) };
                    for (sum, entry) in sum.iter_mut().zip([a, low, high, d]) {
                        *sum += entry;
                    }
                }
                values.copy_from_slice(&sum);
            }
        });
    }

    /// Adds s · c cᵀ for a row c over the coordinates (x₀, y₀, x₁, …) of a clique's vertices.
    pub fn add_square(&self, values: &mut [f64], clique: usize, row: &[f64], s: f64) {
        let pairs = (0..row.len() / AXES).flat_map(|a| (0..=a).map(move |b| (a, b)));
        for (&block, (a, b)) in self.cliques[clique].iter().zip(pairs) {
            Self::add(values, block, |i, j| s * row[AXES * a + i] * row[AXES * b + j]);
        }
    }

    /// Adds `s` to both diagonal entries of a vertex.
    pub fn add_diagonal(&self, values: &mut [f64], vertex: usize, s: f64) {
        let at = BLOCK * self.diagonal[vertex] as usize;
        values[at] += s;
        values[at + BLOCK - 1] += s;
    }

    /// The mean of the diagonal's entries.
    pub fn mean_diagonal(&self, values: &[f64]) -> f64 {
        let both = |at: u32| values[BLOCK * at as usize] + values[BLOCK * at as usize + BLOCK - 1];
        let sum: f64 = self.diagonal.iter().map(|&at| both(at)).sum();
        sum / (AXES * self.vertices) as f64
    }

    /// The factorization of these values; `None` if they are not positive definite, or the job is cancelled.
    ///
    /// # Errors
    /// If memory runs out.
    pub fn factorize(
        &self,
        values: &[f64],
        progress: &dyn Progress,
    ) -> Result<Option<SurfaceFactor>, SparseError> {
        let Spare { mut factor, mut meanwhile } = std::mem::take(&mut *self.spared());
        for (room, len) in
            [(&mut factor, self.factors.len()), (&mut meanwhile, self.factors.room())]
        {
            if room.len() < len {
                *room = Vec::new();
                // With some to spare for a surface with more vertices: what is not written is no memory.
                let len = len + len / SPARE;
                // Asked for first, for what follows ends the program where there is not enough. Cleared pages cost nothing
                // until they are written, and that is done by all threads.
                let mut asked = Vec::<f64>::new();
                asked
                    .try_reserve_exact(len)
                    .map_err(|_| SparseError::TooLarge(AXES * self.vertices))?;
                // Or the compiler would take the two for nothing.
                drop(std::hint::black_box(asked));
                *room = vec![0.0; len];
            }
        }
        let (own, free) = (self.factors.len(), self.factors.room());
        let positive =
            self.factors.factorize(values, &mut factor[..own], &mut meanwhile[..free], progress);
        self.spared().meanwhile = meanwhile;
        if positive {
            return Ok(Some(SurfaceFactor(factor)));
        }
        self.spared().factor = factor;
        Ok(None)
    }

    /// Takes back a factor that is no longer needed; its room serves for the next.
    pub fn take_back(&self, factor: SurfaceFactor) {
        self.spared().factor = factor.0;
    }

    /// Takes over the room of a matrix that is no longer needed.
    pub fn take_over(&self, other: &Self) {
        *self.spared() = std::mem::take(&mut *other.spared());
    }

    /// Keeps no room for another factorization.
    pub fn let_go(&self) {
        *self.spared() = Spare::default();
    }

    fn spared(&self) -> MutexGuard<'_, Spare> {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Solutions for right-hand sides, together: reading the factor is what a solve costs.
    pub fn solve(&self, factor: &SurfaceFactor, right: &[&[f64]]) -> Vec<Vec<f64>> {
        self.factors.solve(&factor.0[..self.factors.len()], right)
    }
}

/// A factorized matrix.
pub struct SurfaceFactor(Vec<f64>);

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::shapes::grid;
    use crate::progress::Silent;

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
        let mut values = Vec::new();
        matrix.set_triangles(&mut values, &elements);
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
        let factor = matrix.factorize(&values, &Silent).unwrap().unwrap();
        let x = matrix.solve(&factor, &[&right]);
        for (got, want) in x[0].iter().zip(&wanted) {
            assert!((got - want).abs() < 1e-10, "{got} {want}");
        }
        // The room of a smaller matrix is taken over and, where it is too small, made anew.
        for rows in [6, 1] {
            let surface = grid(rows, 5, false, |x, y| DVec3::new(70.0 * x, 50.0 * y, 0.0));
            let other = Matrix::new(&surface, &[]).unwrap();
            let mut diagonal = vec![0.0; other.entries()];
            (0..surface.vertex_count()).for_each(|v| other.add_diagonal(&mut diagonal, v, 2.0));
            let unused = other.factorize(&diagonal, &Silent).unwrap().unwrap();
            other.take_back(unused);
            matrix.take_over(&other);
            let again = matrix.factorize(&values, &Silent).unwrap().unwrap();
            assert_eq!(matrix.solve(&again, &[&right]), x);
        }
        // Taking more away than there is leaves no positive matrix.
        for v in 0..n {
            matrix.add_diagonal(&mut values, v, -5.0);
        }
        matrix.take_back(factor);
        assert!(matrix.factorize(&values, &Silent).unwrap().is_none());
    }

    #[test]
    fn many_fronts_solve_together_and_give_the_same_bits_on_any_number_of_threads() {
        // Enough vertices for tasks of their own.
        let surface =
            grid(90, 60, true, |x, y| DVec3::new(90.0 * x, 60.0 * y, (7.0 * x * y).sin()));
        let n = surface.vertex_count();
        let sewn: Vec<Vec<usize>> = (0..60).map(|k| vec![91 * k, 91 * k + 90]).collect();
        let matrix = Matrix::new(&surface, &sewn).unwrap();
        let mut random = 3u64;
        let mut value = || {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (random >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        let mut entries = Vec::new();
        let mut elements = Vec::new();
        for t in surface.triangles() {
            let b: [f64; 6] = std::array::from_fn(|_| value());
            let mut stiffness = [0.0; 21];
            let dof = |i: usize| 2 * t[i / 2].index() + i % 2;
            for i in 0..6 {
                for j in 0..6 {
                    entries.push((dof(i), dof(j), b[i] * b[j]));
                    stiffness[triangular(i, j)] = b[i] * b[j];
                }
            }
            elements.push(Element { stiffness });
        }
        let mut values = Vec::new();
        matrix.set_triangles(&mut values, &elements);
        let row = [0.4, -0.9, -0.3, 0.8];
        for (k, pair) in sewn.iter().enumerate() {
            matrix.add_square(&mut values, k, &row, 50.0);
            let dof = |i: usize| 2 * pair[i / 2] + i % 2;
            for i in 0..4 {
                entries.extend((0..4).map(|j| (dof(i), dof(j), 50.0 * row[i] * row[j])));
            }
        }
        for v in 0..n {
            matrix.add_diagonal(&mut values, v, 0.1);
            entries.extend([2 * v, 2 * v + 1].map(|i| (i, i, 0.1)));
        }
        let right: Vec<Vec<f64>> = (0..3).map(|_| (0..2 * n).map(|_| value()).collect()).collect();
        let right: Vec<&[f64]> = right.iter().map(Vec::as_slice).collect();
        let solve = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let factor = matrix.factorize(&values, &Silent).unwrap().unwrap();
                matrix.solve(&factor, &right)
            })
        };
        let solutions = solve(1);
        for (x, right) in solutions.iter().zip(&right) {
            let mut left = vec![0.0; 2 * n];
            entries.iter().for_each(|&(i, j, a)| left[i] += a * x[j]);
            let off = left.iter().zip(*right).map(|(l, r)| (l - r).abs()).fold(0.0, f64::max);
            assert!(off < 1e-9, "{off}");
        }
        assert_eq!(solutions, solve(3));
        assert_eq!(solutions, solve(3));
    }
}
