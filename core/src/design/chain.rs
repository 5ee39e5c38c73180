//! Seams drawn along the edges of a mesh, as hosts mark them: a set of edges in any order.
//!
//! Edges are chained into polylines from branch to branch or free end. A chain of mesh edges zigzags
//! by up to an edge's length and could not be sewn; of its points those stay from which the others
//! lie farther than its mean edge (Douglas & Peucker 1973), and between them the cut runs straight.
//! Limit: what the edges draw is followed to within that edge's length.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

/// The polylines, in mm, that edges between these points (mm) form: those with a free end first, so
/// that every later one can begin at an earlier one.
///
/// # Panics
/// If an edge names a point that does not exist.
#[must_use]
pub fn seams_along_edges(points: &[DVec3], edges: &[[usize; 2]]) -> Vec<Vec<DVec3>> {
    let mut next: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for &[a, b] in edges.iter().filter(|[a, b]| a != b) {
        next.entry(a).or_default().insert(b);
        next.entry(b).or_default().insert(a);
    }
    let degree: BTreeMap<usize, usize> = next.iter().map(|(&v, to)| (v, to.len())).collect();
    let mut chains = Vec::new();
    // From free ends, then from branches, and what is left are rings.
    for begins in [|d: usize| d == 1, |d: usize| d > 2, |_: usize| true] {
        for &start in degree.keys().filter(|v| begins(degree[v])) {
            while let Some(&first) = next[&start].first() {
                let mut chain = vec![start];
                let mut to = first;
                loop {
                    let from = chain[chain.len() - 1];
                    next.entry(from).or_default().remove(&to);
                    next.entry(to).or_default().remove(&from);
                    chain.push(to);
                    match next[&to].first() {
                        Some(&on) if degree[&to] == 2 => to = on,
                        _ => break,
                    }
                }
                chains.push(chain);
            }
        }
    }
    chains
        .into_iter()
        .map(|chain| simplified(&chain.into_iter().map(|v| points[v]).collect::<Vec<_>>()))
        .collect()
}

/// The points of a polyline that matter at its mean edge.
fn simplified(line: &[DVec3]) -> Vec<DVec3> {
    let length: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let tolerance = length / (line.len() - 1).max(1) as f64;
    let mut keep = vec![false; line.len()];
    let last = line.len() - 1;
    (keep[0], keep[last]) = (true, true);
    let mut spans = vec![(0, last)];
    while let Some((a, b)) = spans.pop() {
        let off = |i: usize| (i, to_segment(line[i], line[a], line[b]));
        let farthest = (a + 1..b).map(off).max_by(|p, q| p.1.total_cmp(&q.1));
        if let Some((i, _)) = farthest.filter(|&(_, distance)| distance > tolerance) {
            keep[i] = true;
            spans.extend([(a, i), (i, b)]);
        }
    }
    line.iter().zip(keep).filter_map(|(&p, keep)| keep.then_some(p)).collect()
}

fn to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let squared = (b - a).length_squared();
    let part = if squared > 0.0 { ((p - a).dot(b - a) / squared).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a.lerp(b, part))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64) -> DVec3 {
        DVec3::new(x, y, 0.0)
    }

    #[test]
    fn edges_in_any_order_and_twice_are_one_line_without_its_zigzag() {
        let points = [p(0.0, 0.0), p(1.0, 0.2), p(2.0, -0.2), p(3.0, 0.0), p(3.0, 5.0)];
        let edges = [[2, 1], [4, 3], [0, 1], [1, 0], [3, 2], [2, 2]];
        assert_eq!(seams_along_edges(&points, &edges), [[points[0], points[3], points[4]]]);
    }

    #[test]
    fn a_bridge_between_branches_comes_after_the_arms() {
        // An H: arms 0–2, 1–2, 4–3, 5–3 and the bridge 2–3.
        let points = [p(0.0, 0.0), p(0.0, 4.0), p(0.0, 2.0), p(5.0, 2.0), p(5.0, 0.0), p(5.0, 4.0)];
        let seams = seams_along_edges(&points, &[[3, 2], [2, 0], [1, 2], [3, 4], [5, 3]]);
        assert_eq!(seams.len(), 5);
        assert_eq!(seams[0], [points[0], points[2]]);
        assert_eq!(seams[4], [points[2], points[3]]);
    }

    #[test]
    fn a_ring_closes_on_its_first_point() {
        // A square of twelve edges: its corners stay.
        let side = |k: usize| match k {
            0..3 => p(3.0 * k as f64, 0.0),
            3..6 => p(9.0, 3.0 * (k - 3) as f64),
            6..9 => p(9.0 - 3.0 * (k - 6) as f64, 9.0),
            _ => p(0.0, 9.0 - 3.0 * (k - 9) as f64),
        };
        let points: Vec<DVec3> = (0..12).map(side).collect();
        let edges: Vec<[usize; 2]> = (0..12).map(|k| [k, (k + 1) % 12]).collect();
        let seams = seams_along_edges(&points, &edges);
        assert_eq!(seams, [[points[0], points[3], points[6], points[9], points[0]]]);
        assert!(seams_along_edges(&points, &[[1, 1]]).is_empty());
    }
}
