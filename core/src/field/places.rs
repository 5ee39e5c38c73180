//! The places of a worn brace: the disk's vertices with the two sides of every seam as one.
//!
//! On the limb a sewn seam is a line like any other: forces pass through it and what is measured
//! round a place of it counts the fabric of both sides. Vertices are joined where the seams say so,
//! not where they happen to coincide.

use glam::DVec3;

use crate::seams::{Finer, Seam};
use crate::surface::{Surface, VertexId};

/// The places of a cut surface and which lie next to each other.
pub(super) struct Places {
    /// The place of every vertex.
    of: Vec<usize>,
    points: Vec<DVec3>,
    /// Where each place's neighbours begin in `neighbours`; one more at the end.
    starts: Vec<usize>,
    neighbours: Vec<u32>,
}

/// What a search over the places remembers, to be used again for the next one.
pub(super) struct Visits {
    round: u32,
    seen: Vec<u32>,
    queue: Vec<usize>,
}

impl Places {
    pub(super) fn new(disk: &Surface, seams: &[Seam]) -> Self {
        let mut root: Vec<usize> = (0..disk.vertex_count()).collect();
        for (&a, &b) in seams.iter().flat_map(|seam| seam.left.iter().zip(&seam.right)) {
            let (a, b) = (find(&mut root, a), find(&mut root, b));
            root[a.max(b)] = a.min(b);
        }
        let mut of = vec![0; disk.vertex_count()];
        let mut points = Vec::new();
        for v in disk.vertex_ids() {
            let first = find(&mut root, v);
            of[v.index()] = if first == v.index() {
                points.push(disk.point(v));
                points.len() - 1
            } else {
                // The first of a place comes before its copies.
                of[first]
            };
        }
        let mut pairs: Vec<(u32, u32)> = disk
            .half_edges()
            .flat_map(|h| {
                let [a, b] = [disk.from(h), disk.to(h)].map(|v| of[v.index()] as u32);
                [(a, b), (b, a)]
            })
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0; points.len() + 1];
        for &(a, _) in &pairs {
            starts[a as usize + 1] += 1;
        }
        for k in 0..points.len() {
            starts[k + 1] += starts[k];
        }
        let neighbours = pairs.into_iter().map(|(_, b)| b).collect();
        Self { of, points, starts, neighbours }
    }

    /// Of every place after the first so many, which are those of the surface as it was, the two between which it lies.
    pub(super) fn between(&self, before: usize, finer: &Finer) -> Vec<[usize; 2]> {
        let mut between = vec![[0; 2]; self.count() - before];
        for (v, ends) in finer.middles() {
            between[self.of[v] - before] = ends.map(|end| self.of[end]);
        }
        between
    }

    pub(super) fn count(&self) -> usize {
        self.points.len()
    }

    /// The place of a vertex.
    pub(super) fn of(&self, v: VertexId) -> usize {
        self.of[v.index()]
    }

    pub(super) fn point(&self, place: usize) -> DVec3 {
        self.points[place]
    }

    fn neighbours(&self, place: usize) -> impl Iterator<Item = usize> + '_ {
        self.neighbours[self.starts[place]..self.starts[place + 1]].iter().map(|&n| n as usize)
    }

    pub(super) fn visits(&self) -> Visits {
        Visits { round: 0, seen: vec![0; self.count()], queue: Vec::new() }
    }

    /// The places within `radius` mm of one, reached through such places, with their distances;
    /// itself first.
    pub(super) fn within(
        &self,
        visits: &mut Visits,
        from: usize,
        radius: f64,
    ) -> Vec<(usize, f64)> {
        visits.round += 1;
        visits.queue.clear();
        visits.queue.push(from);
        visits.seen[from] = visits.round;
        let mut found = Vec::new();
        let mut next = 0;
        while next < visits.queue.len() {
            let place = visits.queue[next];
            next += 1;
            found.push((place, self.points[place].distance(self.points[from])));
            for n in self.neighbours(place) {
                let near = self.points[n].distance_squared(self.points[from]) <= radius * radius;
                if near && visits.seen[n] != visits.round {
                    visits.seen[n] = visits.round;
                    visits.queue.push(n);
                }
            }
        }
        found
    }

    /// Sums of what the vertices of each place have.
    pub(super) fn sums<T>(&self, by_vertex: &[T], zero: T) -> Vec<T>
    where
        T: Copy + std::ops::AddAssign,
    {
        let mut sums = vec![zero; self.count()];
        for (&place, &value) in self.of.iter().zip(by_vertex) {
            sums[place] += value;
        }
        sums
    }

    /// What each vertex has of its place.
    pub(super) fn to_vertices<T: Copy>(&self, by_place: &[T]) -> Vec<T> {
        self.of.iter().map(|&place| by_place[place]).collect()
    }

    /// Weighted means over the sides of a seam, by vertex; a place without weight keeps its values.
    pub(super) fn means(&self, by_vertex: &[f64], weights: &[f64]) -> Vec<f64> {
        let weighted: Vec<f64> = by_vertex.iter().zip(weights).map(|(x, w)| x * w).collect();
        let (sums, total) = (self.sums(&weighted, 0.0), self.sums(weights, 0.0));
        self.of
            .iter()
            .zip(by_vertex)
            .map(|(&p, &own)| if total[p] > 0.0 { sums[p] / total[p] } else { own })
            .collect()
    }
}

/// The first vertex of what `v` has been joined to.
fn find(root: &mut [usize], v: VertexId) -> usize {
    let mut v = v.index();
    while root[v] != v {
        root[v] = root[root[v]];
        v = root[v];
    }
    v
}
