//! Vertices near to each other gathered to one, and which of these are joined.

use crate::surface::{Surface, VertexId};

/// Gathers vertices connected within `squared` (mm²) of a seed; vertices further apart stay
/// alone. The cluster of each vertex, and the clusters' seeds.
pub(super) fn clusters(surface: &Surface, squared: f64) -> (Vec<u32>, Vec<VertexId>) {
    let mut cluster = vec![u32::MAX; surface.vertex_count()];
    let mut seeds: Vec<VertexId> = Vec::new();
    for seed in surface.vertex_ids() {
        if cluster[seed.index()] != u32::MAX {
            continue;
        }
        // As many clusters as vertices, whose indices fit 32 bits.
        let number = seeds.len() as u32;
        cluster[seed.index()] = number;
        let mut stack = vec![seed];
        while let Some(v) = stack.pop() {
            for n in surface.neighbours(v) {
                let near = surface.point(n).distance_squared(surface.point(seed)) <= squared;
                if near && cluster[n.index()] == u32::MAX {
                    cluster[n.index()] = number;
                    stack.push(n);
                }
            }
        }
        seeds.push(seed);
    }
    (cluster, seeds)
}

/// The samples that are joined by an edge of the surface: where each one's begin, and all of them.
pub(super) fn joined(surface: &Surface, sample_of: &[u32], count: usize) -> (Vec<u32>, Vec<u32>) {
    let edges = || {
        surface.half_edges().filter_map(|h| {
            // An inner edge is seen from both sides: once is enough.
            let first = surface.twin(h).is_none_or(|twin| h < twin);
            let ends = [surface.from(h), surface.to(h)].map(|v| sample_of[v.index()]);
            (first && ends[0] != ends[1]).then_some(ends)
        })
    };
    let mut ends = vec![0u32; count + 1];
    for [a, b] in edges() {
        ends[a as usize + 1] += 1;
        ends[b as usize + 1] += 1;
    }
    for k in 0..count {
        ends[k + 1] += ends[k];
    }
    let mut filled = ends.clone();
    let mut all = vec![0; ends[count] as usize];
    for [a, b] in edges() {
        for (from, to) in [(a, b), (b, a)] {
            all[filled[from as usize] as usize] = to;
            filled[from as usize] += 1;
        }
    }
    // Each one's in order and once: clusters are joined by several edges.
    let (mut starts, mut kept) = (Vec::with_capacity(count + 1), 0);
    for k in 0..count {
        starts.push(kept as u32);
        let (start, end) = (ends[k] as usize, ends[k + 1] as usize);
        all[start..end].sort_unstable();
        let begin = kept;
        for i in start..end {
            if kept == begin || all[kept - 1] != all[i] {
                all[kept] = all[i];
                kept += 1;
            }
        }
    }
    starts.push(kept as u32);
    all.truncate(kept);
    (starts, all)
}
