//! Sparse Cholesky factorization along a dissection, two unknowns a vertex.
//!
//! Duff & Reid, *The Multifrontal Solution of Indefinite Sparse Symmetric Linear Systems* (1983). Every piece
//! of the dissection is a front: the dense matrix of its own vertices and of those of later
//! pieces that they are coupled with, its border. What its parts have left over is added to it, its own
//! vertices are eliminated (faer's dense kernels, one thread), and what that leaves on the border
//! goes on to the piece above. The two parts of a piece touch no common number and run at the same
//! time; what is computed, and so every bit, is the same on any number of threads.

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, MatMut, MatRef, Par, Spec};

use super::dissection::{Dissection, Neighbours, Piece, both};
use crate::progress::Progress;

/// Subtrees of fewer vertices than this are not worth a task of their own.
const PER_TASK: u32 = 1000;

/// A factorization has some more tasks than this at most: each needs room of its own.
const TASKS: u32 = 16;

/// Rows and columns of a vertex.
pub const AXES: usize = 2;

/// Entries of the block of two vertices, column by column.
pub const BLOCK: usize = AXES * AXES;

/// A piece of the dissection as a dense matrix: its own vertices, then its border.
struct Front {
    piece: Piece,
    /// Later vertices that it is coupled with, as places in the order of elimination, ascending.
    border: Vec<u32>,
    /// Where the borders of its parts stand among its own vertices and its border.
    into: [Vec<u32>; 2],
    /// Its blocks of the matrix.
    blocks: Range<usize>,
    /// Where its columns of the factor begin, and those of the first of its parts.
    columns: usize,
    first_columns: usize,
    /// Room, in numbers, for what this piece leaves over and what its parts need meanwhile; and where in it
    /// that of its second part begins.
    room: usize,
    second_room: usize,
    /// Whether its two parts have rooms of their own, so that they can be eliminated at the same time.
    apart: bool,
}

impl Front {
    /// Own columns.
    fn own(&self) -> usize {
        AXES * (self.piece.end - self.piece.own) as usize
    }

    /// Rows: its own and the border's.
    fn rows(&self) -> usize {
        self.own() + AXES * self.border.len()
    }

    /// Numbers that it leaves over: those of its border's rows and columns.
    fn left_over(&self) -> usize {
        (AXES * self.border.len()).pow(2)
    }

    fn many(&self) -> bool {
        self.piece.end - self.piece.first > PER_TASK
    }
}

/// The analysed matrix.
pub struct Multifrontal {
    fronts: Vec<Front>,
    /// Vertices in the order of elimination.
    order: Vec<u32>,
    /// Row and column of every block in its front, as vertices.
    at: Vec<[u32; 2]>,
    len: usize,
}

/// Where the blocks of the coupled pairs stand.
pub struct Blocks {
    /// Of every pair its block.
    pub of_pair: Vec<u32>,
    /// Of every vertex its place in the order of elimination: of a pair, the later one is the block's row.
    pub place: Vec<u32>,
}

impl Multifrontal {
    /// The matrix of these couplings: pairs of vertices (each once, and every vertex with itself).
    pub fn new(
        dissection: Dissection,
        neighbours: &Neighbours,
        pairs: &[(u32, u32)],
    ) -> (Self, Blocks) {
        let Dissection { order, pieces } = dissection;
        let mut place = vec![0u32; order.len()];
        for (at, &v) in order.iter().enumerate() {
            place[v as usize] = at as u32;
        }
        let mut fronts: Vec<Front> = Vec::with_capacity(pieces.len());
        let mut front_of = vec![0u32; order.len()];
        let mut seen = vec![u32::MAX; order.len()];
        let mut columns = 0;
        for (k, &piece) in pieces.iter().enumerate() {
            let k = k as u32;
            front_of[piece.own as usize..piece.end as usize].fill(k);
            let mut border = Vec::new();
            let mut meet = |at: u32| {
                if at >= piece.end && seen[at as usize] != k {
                    seen[at as usize] = k;
                    border.push(at);
                }
            };
            for &v in &order[piece.own as usize..piece.end as usize] {
                neighbours.of(v).iter().for_each(|&w| meet(place[w as usize]));
            }
            let parts = piece.parts.map(|parts| parts.map(|p| p as usize));
            for part in parts.iter().flatten() {
                fronts[*part].border.iter().for_each(|&at| meet(at));
            }
            border.sort_unstable();
            let into = parts.map_or_else(Default::default, |parts| {
                parts.map(|p| {
                    fronts[p].border.iter().map(|&at| local(&piece, &border, at)).collect()
                })
            });
            let first_columns = parts.map_or(columns, |[left, _]| fronts[left].first_columns);
            let mut front = Front {
                piece,
                border,
                into,
                blocks: 0..0,
                columns,
                first_columns,
                room: 0,
                second_room: 0,
                apart: piece.end - piece.first > PER_TASK.max(order.len() as u32 / TASKS),
            };
            front.second_room = front.left_over();
            front.room = front.second_room;
            if let Some([a, b]) = parts.map(|parts| parts.map(|p| &fronts[p])) {
                // At the same time, or in what the first no longer needs.
                front.second_room += if front.apart { a.room } else { a.left_over() };
                front.room = (front.left_over() + a.room).max(front.second_room + b.room);
            }
            columns += front.own() * front.rows();
            fronts.push(front);
        }
        // A pair belongs to the front that eliminates the first of its two.
        let column = |&(a, b): &(u32, u32)| place[a as usize].min(place[b as usize]);
        let mut counts = vec![0usize; fronts.len() + 1];
        for pair in pairs {
            counts[front_of[column(pair) as usize] as usize + 1] += 1;
        }
        for k in 0..fronts.len() {
            counts[k + 1] += counts[k];
            fronts[k].blocks = counts[k]..counts[k + 1];
        }
        let mut at = vec![[0; 2]; pairs.len()];
        let of_pair = pairs
            .iter()
            .map(|pair| {
                let column = column(pair);
                let k = front_of[column as usize] as usize;
                let block = counts[k];
                counts[k] += 1;
                let row = place[pair.0 as usize].max(place[pair.1 as usize]);
                let Front { piece, border, .. } = &fronts[k];
                at[block] = [row, column].map(|at| local(piece, border, at));
                block as u32
            })
            .collect();
        (Self { fronts, order, at, len: columns }, Blocks { of_pair, place })
    }

    /// Number of values of the factor.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Numbers that a factorization needs room for meanwhile.
    pub fn room(&self) -> usize {
        self.fronts.last().map_or(0, |root| root.room)
    }

    /// Factorizes the matrix of these blocks into `factor`, of [`len`](Self::len) numbers, with
    /// [`room`](Self::room) for as many; false if it is not positive definite, or the job is cancelled.
    pub fn factorize(
        &self,
        blocks: &[f64],
        factor: &mut [f64],
        room: &mut [f64],
        progress: &dyn Progress,
    ) -> bool {
        let Some(root) = self.fronts.len().checked_sub(1) else { return true };
        self.eliminate(root, blocks, factor, room, progress).is_some()
    }

    /// Eliminates the vertices of a piece and its parts; what that leaves on the border is at the beginning of
    /// `room` then, the lower triangle of a matrix by columns.
    fn eliminate(
        &self,
        k: usize,
        blocks: &[f64],
        factor: &mut [f64],
        room: &mut [f64],
        progress: &dyn Progress,
    ) -> Option<()> {
        let front = &self.fronts[k];
        if front.many() && progress.cancelled() {
            return None;
        }
        let (own, rows) = (front.own(), front.rows());
        let left_over = rows - own;
        let (below, columns) = factor.split_at_mut(front.columns - front.first_columns);
        let (rest, room) = room.split_at_mut(front.left_over());
        let second_room = front.second_room - rest.len();
        let parts = front.piece.parts.map(|parts| parts.map(|p| p as usize));
        if let Some([a, b]) = parts {
            let split = self.fronts[b].first_columns - front.first_columns;
            let (first, second) = below.split_at_mut(split);
            if front.apart {
                let (room, other) = room.split_at_mut(second_room);
                let (left, right) = rayon::join(
                    || self.eliminate(a, blocks, first, room, progress),
                    || self.eliminate(b, blocks, second, other, progress),
                );
                left?;
                right?;
            } else {
                self.eliminate(a, blocks, first, room, progress)?;
                self.eliminate(b, blocks, second, &mut room[second_room..], progress)?;
            }
        }
        columns.fill(0.0);
        for (block, &[row, column]) in blocks[BLOCK * front.blocks.start..BLOCK * front.blocks.end]
            .chunks_exact(BLOCK)
            .zip(&self.at[front.blocks.clone()])
        {
            for (axis, entries) in block.chunks_exact(AXES).enumerate() {
                let to = rows * (AXES * column as usize + axis) + AXES * row as usize;
                columns[to..to + AXES].copy_from_slice(entries);
            }
        }
        let left = [(0, 0), (second_room, 1)].map(|(at, part)| Left {
            numbers: &room[at.min(room.len())..],
            into: &front.into[part],
        });
        for left in &left {
            left.add_to(columns, rows, 0..own);
        }
        let matrix = MatMut::from_column_major_slice_mut(columns, rows, own);
        let (mut top, mut bottom) = matrix.split_at_row_mut(own);
        let mut memory =
            MemBuffer::new(cholesky_in_place_scratch::<f64>(own, Par::Seq, Spec::default()));
        cholesky_in_place(
            top.as_mut(),
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        )
        .ok()?;
        if left_over > 0 {
            solve_lower_triangular_in_place(
                top.as_ref(),
                bottom.as_mut().transpose_mut(),
                Par::Seq,
            );
            triangular::matmul(
                MatMut::from_column_major_slice_mut(rest, left_over, left_over),
                BlockStructure::TriangularLower,
                Accum::Replace,
                bottom.as_ref(),
                BlockStructure::Rectangular,
                bottom.as_ref().transpose(),
                BlockStructure::Rectangular,
                -1.0,
                Par::Seq,
            );
            for left in &left {
                left.add_to(rest, left_over, own..rows);
            }
        }
        Some(())
    }

    /// Solutions for right-hand sides, together: reading the factor is what a solve costs.
    pub fn solve(&self, factor: &[f64], right: &[&[f64]]) -> Vec<Vec<f64>> {
        let count = right.len();
        if self.fronts.is_empty() || count == 0 {
            return vec![Vec::new(); count];
        }
        // In the order of elimination, the right-hand sides side by side.
        let mut x = Vec::with_capacity(AXES * self.order.len() * count);
        for &v in &self.order {
            for axis in 0..AXES {
                x.extend(right.iter().map(|right| right[AXES * v as usize + axis]));
            }
        }
        let root = self.fronts.len() - 1;
        self.forward(root, factor, &mut x, count);
        self.backward(root, factor, &mut x, count, &[]);
        let mut solutions = vec![vec![0.0; AXES * self.order.len()]; count];
        for (&v, numbers) in self.order.iter().zip(x.chunks_exact(AXES * count)) {
            for (axis, numbers) in numbers.chunks_exact(count).enumerate() {
                for (solution, &number) in solutions.iter_mut().zip(numbers) {
                    solution[AXES * v as usize + axis] = number;
                }
            }
        }
        solutions
    }

    /// The columns of a front in the whole factor.
    fn columns<'a>(&self, front: &Front, factor: &'a [f64]) -> MatRef<'a, f64> {
        let (rows, own) = (front.rows(), front.own());
        let columns = &factor[front.columns..front.columns + own * rows];
        MatRef::from_column_major_slice(columns, rows, own)
    }

    /// `x` divided among the vertices of a piece's first part, of its second, and its own.
    fn divide<'a>(&self, front: &Front, x: &'a mut [f64], count: usize) -> [&'a mut [f64]; 3] {
        let (below, own) =
            x.split_at_mut(AXES * count * (front.piece.own - front.piece.first) as usize);
        let split = front.piece.parts.map_or(0, |[left, _]| {
            (self.fronts[left as usize].piece.end - front.piece.first) as usize
        });
        let (first, second) = below.split_at_mut(AXES * count * split);
        [first, second, own]
    }

    /// Solves L y = x for the vertices of a piece and its parts; what that takes from each number on the
    /// border, a right-hand side after the other.
    fn forward(&self, k: usize, factor: &[f64], x: &mut [f64], count: usize) -> Vec<f64> {
        let front = &self.fronts[k];
        let (own, rows) = (front.own(), front.rows());
        let [first, second, x] = self.divide(front, x, count);
        let parts = front.piece.parts.map(|[a, b]| {
            let left = || self.forward(a as usize, factor, first, count);
            let right = || self.forward(b as usize, factor, second, count);
            let (left, right) = both(front.many(), left, right);
            [left, right]
        });
        let mut local = vec![0.0; rows * count];
        for (r, local) in local.chunks_exact_mut(rows).enumerate() {
            for (i, number) in local[..own].iter_mut().enumerate() {
                *number = x[i * count + r];
            }
            for (part, into) in parts.iter().flatten().zip(&front.into) {
                let size = AXES * into.len();
                for (&to, pair) in into.iter().zip(part[size * r..].chunks_exact(AXES)) {
                    local[AXES * to as usize] += pair[0];
                    local[AXES * to as usize + 1] += pair[1];
                }
            }
        }
        let (top, bottom) = self.columns(front, factor).split_at_row(own);
        let (mut y, z) =
            MatMut::from_column_major_slice_mut(&mut local, rows, count).split_at_row_mut(own);
        solve_lower_triangular_in_place(top, y.as_mut(), Par::Seq);
        matmul(z, Accum::Add, bottom, y, -1.0, Par::Seq);
        let mut border = Vec::with_capacity((rows - own) * count);
        for (r, local) in local.chunks_exact(rows).enumerate() {
            for (i, &number) in local[..own].iter().enumerate() {
                x[i * count + r] = number;
            }
            border.extend_from_slice(&local[own..]);
        }
        border
    }

    /// Solves Lᵀ x = y for the vertices of a piece and its parts, from the solution on the border.
    fn backward(&self, k: usize, factor: &[f64], x: &mut [f64], count: usize, border: &[f64]) {
        let front = &self.fronts[k];
        let (own, rows) = (front.own(), front.rows());
        let [first, second, x] = self.divide(front, x, count);
        let mut local = vec![0.0; rows * count];
        for (r, local) in local.chunks_exact_mut(rows).enumerate() {
            for (i, number) in local[..own].iter_mut().enumerate() {
                *number = x[i * count + r];
            }
            local[own..].copy_from_slice(&border[(rows - own) * r..(rows - own) * (r + 1)]);
        }
        let (top, bottom) = self.columns(front, factor).split_at_row(own);
        let (mut y, z) =
            MatMut::from_column_major_slice_mut(&mut local, rows, count).split_at_row_mut(own);
        matmul(y.as_mut(), Accum::Add, bottom.transpose(), z, -1.0, Par::Seq);
        solve_upper_triangular_in_place(top.transpose(), y, Par::Seq);
        for (r, local) in local.chunks_exact(rows).enumerate() {
            for (i, &number) in local[..own].iter().enumerate() {
                x[i * count + r] = number;
            }
        }
        let Some([a, b]) = front.piece.parts else { return };
        let of = |into: &[u32]| -> Vec<f64> {
            let mut border = Vec::with_capacity(AXES * into.len() * count);
            for local in local.chunks_exact(rows) {
                for &at in into {
                    let at = AXES * at as usize;
                    border.extend_from_slice(&local[at..at + AXES]);
                }
            }
            border
        };
        let [of_first, of_second] = [of(&front.into[0]), of(&front.into[1])];
        let left = || self.backward(a as usize, factor, first, count, &of_first);
        let right = || self.backward(b as usize, factor, second, count, &of_second);
        both(front.many(), left, right);
    }
}

/// What a part has left over, the lower triangle of a matrix by columns, and where it goes in the front.
struct Left<'a> {
    numbers: &'a [f64],
    into: &'a [u32],
}

impl Left<'_> {
    /// Adds those of its columns that are among `range` of the front's to `columns`, which are of `rows` and
    /// are the front's from there on.
    fn add_to(&self, columns: &mut [f64], rows: usize, range: Range<usize>) {
        let size = AXES * self.into.len();
        let at = |k: u32| AXES * k as usize;
        let first = AXES * self.into.partition_point(|&k| at(k) < range.start);
        let end = AXES * self.into.partition_point(|&k| at(k) < range.end);
        for c in first..end {
            let to = at(self.into[c / AXES]) + c % AXES - range.start;
            let column = &mut columns[rows * to..rows * (to + 1)];
            let source = self.numbers[size * c..size * (c + 1)].chunks_exact(AXES);
            for (&row, pair) in self.into.iter().zip(source).skip(c / AXES) {
                let row = at(row) - range.start;
                for (sum, number) in column[row..row + AXES].iter_mut().zip(pair) {
                    *sum += number;
                }
            }
        }
    }
}

/// Where a vertex stands in a front: among its own, or after them on the border.
fn local(piece: &Piece, border: &[u32], at: u32) -> u32 {
    if at < piece.end {
        at - piece.own
    } else {
        piece.end - piece.own + border.partition_point(|&b| b < at) as u32
    }
}
