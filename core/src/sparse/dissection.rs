//! The order of elimination: a nested dissection of the worn surface, as a tree.
//!
//! George, *Nested Dissection of a Regular Finite Element Mesh* (1973): the vertices on one side of a
//! cut, those on the other, then those on the cut. The cut is across the longest extent, in space, so
//! that a seam's two sides lie together. On limbs it makes a sixth less fill than minimum degree at
//! 250,000 triangles, and its two sides can be eliminated at the same time.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use glam::DVec3;

/// Pieces of no more vertices than this are not cut further: a dense matrix of this size costs less than
/// the many small ones.
const LEAF: usize = 20;

/// Pieces of fewer vertices than this are not worth a task of their own.
const PER_TASK: usize = 2000;

/// Two jobs; at the same time if there is much to do.
pub fn both<A: Send, B: Send>(
    much: bool,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if much { rayon::join(first, second) } else { (first(), second()) }
}

/// Which vertices are coupled with which.
pub struct Neighbours {
    start: Vec<usize>,
    list: Vec<u32>,
}

impl Neighbours {
    /// From pairs of different vertices, each pair once.
    pub fn new(vertices: usize, pairs: &[(u32, u32)]) -> Self {
        let mut start = vec![0usize; vertices + 1];
        for &(a, b) in pairs {
            start[a as usize + 1] += 1;
            start[b as usize + 1] += 1;
        }
        for v in 0..vertices {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut list = vec![0u32; start[vertices]];
        for &(a, b) in pairs {
            for (from, to) in [(a, b), (b, a)] {
                list[next[from as usize]] = to;
                next[from as usize] += 1;
            }
        }
        Self { start, list }
    }

    /// Those of a vertex.
    pub fn of(&self, vertex: u32) -> &[u32] {
        &self.list[self.start[vertex as usize]..self.start[vertex as usize + 1]]
    }
}

/// A piece of the surface: the vertices of its two parts, if it is cut, and then its own (those on the
/// cut, or all), as places in the order of elimination.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Piece {
    /// The first vertex of its parts, or of itself.
    pub first: u32,
    /// Its own first vertex.
    pub own: u32,
    /// The place after its last.
    pub end: u32,
    /// Its two parts, among the pieces.
    pub parts: Option<[u32; 2]>,
}

/// The order of elimination, and its pieces: each after its parts, the whole surface last.
pub struct Dissection {
    /// Vertices in this order.
    pub order: Vec<u32>,
    /// The pieces.
    pub pieces: Vec<Piece>,
}

struct Cutter<'a> {
    places: &'a [DVec3],
    neighbours: &'a Neighbours,
    /// The piece that a vertex belongs to: 1 is the whole, 2 n and 2 n + 1 the parts of n.
    piece: Vec<AtomicU32>,
}

impl Dissection {
    /// Of vertices at these places.
    pub fn new(places: &[DVec3], neighbours: &Neighbours) -> Self {
        let mut order: Vec<u32> = (0..places.len() as u32).collect();
        let piece = places.iter().map(|_| AtomicU32::new(1)).collect();
        let cutter = Cutter { places, neighbours, piece };
        let pieces = cutter.cut(1, 0, &mut order);
        Self { order, pieces }
    }
}

impl Cutter<'_> {
    /// Orders the vertices of piece `name`, the first of which stands at `first`. A task changes the marks
    /// of its own vertices alone, and others' marks are never those that it looks for: the result does
    /// not depend on their order.
    fn cut(&self, name: u32, first: u32, list: &mut [u32]) -> Vec<Piece> {
        let end = first + list.len() as u32;
        let whole = || vec![Piece { first, own: first, end, parts: None }];
        // A name doubles with each cut.
        if list.len() <= LEAF || name >= 1 << 30 {
            list.sort_unstable();
            return whole();
        }
        let place = |v: u32| self.places[v as usize];
        let (low, high) =
            list.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &v| {
                (low.min(place(v)), high.max(place(v)))
            });
        let extent = high - low;
        let axis = (1..3).fold(0, |best, a| if extent[a] > extent[best] { a } else { best });
        let middle = list.len() / 2;
        list.select_nth_unstable_by(middle, |&a, &b| {
            place(a)[axis].total_cmp(&place(b)[axis]).then(a.cmp(&b))
        });
        // What lies beyond the middle and touches what lies before it is the cut.
        let mark = |v: u32, name: u32| self.piece[v as usize].store(name, Relaxed);
        let before = 2 * name;
        list[..middle].iter().for_each(|&v| mark(v, before));
        let touches = |v: u32| {
            self.neighbours.of(v).iter().any(|&w| self.piece[w as usize].load(Relaxed) == before)
        };
        let (mut cut, beyond): (Vec<u32>, Vec<u32>) =
            list[middle..].iter().partition(|&&v| touches(v));
        if beyond.is_empty() {
            // Nothing was gained: a dense piece.
            list.sort_unstable();
            return whole();
        }
        cut.sort_unstable();
        beyond.iter().for_each(|&v| mark(v, before + 1));
        let split = middle + beyond.len();
        list[middle..split].copy_from_slice(&beyond);
        list[split..].copy_from_slice(&cut);
        let (left, rest) = list.split_at_mut(middle);
        let right = &mut rest[..split - middle];
        let many = left.len() > PER_TASK;
        let at = first + middle as u32;
        let (mut pieces, others) =
            both(many, || self.cut(before, first, left), || self.cut(before + 1, at, right));
        let count = pieces.len() as u32;
        pieces.extend(others.into_iter().map(|piece| Piece {
            parts: piece.parts.map(|parts| parts.map(|part| part + count)),
            ..piece
        }));
        let parts = Some([count - 1, pieces.len() as u32 - 1]);
        pieces.push(Piece { first, own: first + split as u32, end, parts });
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of vertices, coupled with those at its sides.
    fn grid(columns: u32, rows: u32) -> (Vec<DVec3>, Vec<(u32, u32)>) {
        let at = |i: u32, j: u32| j * columns + i;
        let mut places = Vec::new();
        let mut pairs = Vec::new();
        for j in 0..rows {
            for i in 0..columns {
                places.push(DVec3::new(f64::from(i), f64::from(j), 0.3 * f64::from(i * j % 5)));
                if i > 0 {
                    pairs.push((at(i - 1, j), at(i, j)));
                }
                if j > 0 {
                    pairs.push((at(i, j - 1), at(i, j)));
                }
            }
        }
        (places, pairs)
    }

    #[test]
    fn the_order_is_a_permutation_and_parts_touch_only_through_the_cut() {
        let (places, pairs) = grid(40, 30);
        let neighbours = Neighbours::new(places.len(), &pairs);
        let Dissection { order, pieces } = Dissection::new(&places, &neighbours);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &v)| i == v as usize));
        let mut place = vec![0u32; order.len()];
        for (at, &v) in order.iter().enumerate() {
            place[v as usize] = at as u32;
        }
        let mut cuts = 0;
        for piece in &pieces {
            let Some([a, b]) = piece.parts.map(|parts| parts.map(|p| pieces[p as usize])) else {
                continue;
            };
            assert_eq!([piece.first, a.end, b.end], [a.first, b.first, piece.own]);
            for &v in &order[a.first as usize..a.end as usize] {
                for &w in neighbours.of(v) {
                    assert!(!(b.first..b.end).contains(&place[w as usize]));
                }
            }
            cuts += 1;
        }
        assert!(cuts > 20);
        assert_eq!(pieces.last().map(|p| [p.first, p.end]), Some([0, 1200]));
    }

    #[test]
    fn vertices_that_are_all_coupled_are_one_piece() {
        let places: Vec<DVec3> = (0..60).map(|i| DVec3::X * f64::from(i)).collect();
        let pairs: Vec<(u32, u32)> = (0..60).flat_map(|a| (0..a).map(move |b| (b, a))).collect();
        let dissection = Dissection::new(&places, &Neighbours::new(60, &pairs));
        assert_eq!(dissection.pieces, [Piece { first: 0, own: 0, end: 60, parts: None }]);
    }
}
