//! Which triangles of an unvalidated mesh meet at which edge, and what hangs together.

/// The edges of triangles with their half-edges (`3 t + k`, as in [`HalfEdgeId`]), ordered by
/// the numbers of their ends.
///
/// [`HalfEdgeId`]: super::HalfEdgeId
pub(super) struct Edges {
    /// Lower end, higher end, half-edge; sorted.
    uses: Vec<(u32, u32, u32)>,
}

impl Edges {
    /// The edges of `triangles`. Edges from a vertex to itself are left out.
    pub(super) fn of(triangles: &[[usize; 3]]) -> Self {
        // Validation refuses meshes with more half-edges than 32 bits can number.
        let narrow = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
        let mut uses = Vec::with_capacity(3 * triangles.len());
        for (t, corners) in triangles.iter().enumerate() {
            for k in 0..3 {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                if from != to {
                    uses.push((narrow(from.min(to)), narrow(from.max(to)), narrow(3 * t + k)));
                }
            }
        }
        uses.sort_unstable();
        Self { uses }
    }

    /// Every edge: its ends, the lower first, and the half-edges along it.
    pub(super) fn iter(&self) -> impl Iterator<Item = ([usize; 2], EdgeUses<'_>)> {
        self.uses
            .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
            .map(|uses| ([uses[0].0 as usize, uses[0].1 as usize], EdgeUses(uses)))
    }
}

/// The half-edges along one edge.
#[derive(Clone, Copy)]
pub(super) struct EdgeUses<'a>(&'a [(u32, u32, u32)]);

impl EdgeUses<'_> {
    pub(super) fn len(self) -> usize {
        self.0.len()
    }

    pub(super) fn half_edge(self, i: usize) -> usize {
        self.0[i].2 as usize
    }

    pub(super) fn half_edges(&self) -> impl Iterator<Item = usize> + '_ {
        self.0.iter().map(|u| u.2 as usize)
    }
}

/// The half-edge's start.
pub(super) fn start(triangles: &[[usize; 3]], half_edge: usize) -> usize {
    triangles[half_edge / 3][half_edge % 3]
}

/// The half-edge's end.
pub(super) fn end(triangles: &[[usize; 3]], half_edge: usize) -> usize {
    triangles[half_edge / 3][(half_edge % 3 + 1) % 3]
}

/// Disjoint sets of numbers; the lowest number of a set stands for it.
pub(super) struct Sets {
    parent: Vec<usize>,
}

impl Sets {
    pub(super) fn new(count: usize) -> Self {
        Self { parent: (0..count).collect() }
    }

    pub(super) fn find(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    pub(super) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b)] = a.min(b);
    }
}

/// The component of every triangle, numbered from 0 by lowest triangle, and their number.
/// Triangles that share an edge are in one component.
pub(super) fn components(triangles: &[[usize; 3]], edges: &Edges) -> (Vec<usize>, usize) {
    let mut sets = Sets::new(triangles.len());
    for (_, uses) in edges.iter() {
        let first = uses.half_edge(0) / 3;
        uses.half_edges().for_each(|h| sets.join(first, h / 3));
    }
    let mut number = vec![usize::MAX; triangles.len()];
    let mut count = 0;
    for t in 0..triangles.len() {
        let root = sets.find(t);
        if root == t {
            number[t] = count;
            count += 1;
        } else {
            number[t] = number[root];
        }
    }
    (number, count)
}

/// The boundary loops as half-edges in order, by their lowest half-edge. `triangles` must be an
/// oriented manifold.
pub(super) fn boundary_loops(
    triangles: &[[usize; 3]],
    edges: &Edges,
    vertices: usize,
) -> Vec<Vec<usize>> {
    let mut boundary: Vec<usize> = edges
        .iter()
        .filter(|(_, uses)| uses.len() == 1)
        .map(|(_, uses)| uses.half_edge(0))
        .collect();
    boundary.sort_unstable();
    let mut leaving = vec![usize::MAX; vertices];
    boundary.iter().for_each(|&h| leaving[start(triangles, h)] = h);
    let mut loops = Vec::new();
    for &first in &boundary {
        let mut half_edges = Vec::new();
        let mut h = first;
        // Each half-edge is taken out as it is passed.
        while leaving[start(triangles, h)] == h {
            leaving[start(triangles, h)] = usize::MAX;
            half_edges.push(h);
            h = leaving[end(triangles, h)];
            if h == usize::MAX {
                break;
            }
        }
        if !half_edges.is_empty() {
            loops.push(half_edges);
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_components_and_loops_of_two_pieces() {
        let triangles = [[0, 1, 2], [5, 6, 4], [2, 1, 3]];
        let edges = Edges::of(&triangles);
        let shared: Vec<_> = edges.iter().filter(|(_, uses)| uses.len() == 2).collect();
        assert_eq!(shared.len(), 1);
        assert_eq!(shared[0].0, [1, 2]);
        assert_eq!(shared[0].1.half_edges().collect::<Vec<_>>(), [1, 6]);
        assert_eq!(components(&triangles, &edges), (vec![0, 1, 0], 2));
        let loops = boundary_loops(&triangles, &edges, 7);
        let starts: Vec<Vec<usize>> =
            loops.iter().map(|l| l.iter().map(|&h| start(&triangles, h)).collect()).collect();
        assert_eq!(starts, [vec![0, 1, 3, 2], vec![5, 6, 4]]);
    }
}
