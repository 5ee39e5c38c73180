//! Small holes of a scan are closed by the triangulation of their rim with the least area
//! (Barequet & Sharir, *Filling gaps in the boundary of a polyhedron*, 1995), without new
//! vertices.
//!
//! Which loops are holes: those with a rim of at most a stated length, but never the longest
//! loop, which is the surface's outline or an end, and not the second longest if it is at least a
//! quarter as long: then it is the other end of a tube (thigh to ankle is about 0.4), whatever
//! length was stated.
//!
//! Limit: a flat patch over a strongly curved place stays flat.

use std::collections::HashSet;

use glam::DVec3;

use super::connectivity::{Edges, boundary_loops, start};
use super::defect::place;
use crate::warning::Warning;

/// The second loop of a tube is at least this fraction of the first.
const OTHER_END: f64 = 0.25;

/// Rims of more vertices are not closed: the work grows with their number's cube.
const MOST_VERTICES: usize = 1000;

/// Closes small holes by adding triangles, and says so. `triangles` must be an oriented manifold;
/// `close_holes` is the longest rim, in mm; triangles lower than `thinnest` mm are not made.
pub(super) fn close(
    points: &[DVec3],
    triangles: &mut Vec<[usize; 3]>,
    close_holes: f64,
    thinnest: f64,
) -> Vec<Warning> {
    let edges = Edges::of(triangles);
    let loops: Vec<Rim> = boundary_loops(triangles, &edges, points.len())
        .into_iter()
        .map(|half_edges| {
            let vertices = half_edges.iter().map(|&h| start(triangles, h)).collect();
            Rim::new(vertices, points)
        })
        .collect();
    let mut by_length: Vec<usize> = (0..loops.len()).collect();
    by_length.sort_by(|&a, &b| loops[b].length.total_cmp(&loops[a].length).then(a.cmp(&b)));
    let mut kept = vec![false; loops.len()];
    if let Some(&longest) = by_length.first() {
        kept[longest] = true;
        if let Some(&second) = by_length.get(1) {
            kept[second] = loops[second].length >= OTHER_END * loops[longest].length;
        }
    }
    let mut warnings = Vec::new();
    for (rim, kept) in loops.iter().zip(kept) {
        if rim.length > close_holes {
            continue;
        }
        let what = format!(
            "with a rim of {:.1} mm ({} vertices) at {}",
            rim.length,
            rim.vertices.len(),
            place(rim.centre)
        );
        if kept {
            warnings.push(Warning::at(
                "opening_kept",
                format!(
                    "the opening {what} is within close_holes ({close_holes} mm) but was kept: \
                     it is an end or the outline of the surface; close it in the file if it is \
                     neither"
                ),
                rim.centre,
            ));
            continue;
        }
        match rim.fill(points, &edges, thinnest) {
            Some(patch) => {
                warnings.push(Warning::at(
                    "hole_closed",
                    format!("a hole {what} was closed with {} triangles", patch.len()),
                    rim.centre,
                ));
                triangles.extend(patch);
            }
            None => warnings.push(Warning::at(
                "hole_kept",
                format!(
                    "a hole {what} could not be closed without new vertices and stays as a \
                     cut-out: close it in the file"
                ),
                rim.centre,
            )),
        }
    }
    warnings
}

struct Rim {
    /// In the order of the boundary, the surface on the left.
    vertices: Vec<usize>,
    length: f64,
    centre: DVec3,
}

impl Rim {
    fn new(vertices: Vec<usize>, points: &[DVec3]) -> Self {
        let n = vertices.len();
        let length =
            (0..n).map(|i| points[vertices[i]].distance(points[vertices[(i + 1) % n]])).sum();
        let centre = vertices.iter().map(|&v| points[v]).sum::<DVec3>() / n as f64;
        Self { vertices, length, centre }
    }

    /// The triangles of least area that close the rim, if there are any that double no edge and
    /// are not too thin.
    fn fill(&self, points: &[DVec3], edges: &Edges, thinnest: f64) -> Option<Vec<[usize; 3]>> {
        let n = self.vertices.len();
        if n > MOST_VERTICES {
            return None;
        }
        let taken = self.edges_across(edges, points.len());
        let p = |i: usize| points[self.vertices[i]];
        let cost = |i: usize, k: usize, j: usize| {
            let (a, b, c) = (p(i), p(k), p(j));
            let doubled = (b - a).cross(c - a).length();
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            if doubled > thinnest * longest { 0.5 * doubled } else { f64::INFINITY }
        };
        // area[i][j]: least area that closes the rim from vertex i to vertex j; via: its apex.
        let mut area = vec![0.0; n * n];
        let mut via = vec![0usize; n * n];
        for span in 2..n {
            for i in 0..n - span {
                let j = i + span;
                let closing = i == 0 && j == n - 1;
                let mut best = (f64::INFINITY, 0);
                if closing || !taken.contains(&(i, j)) {
                    for k in i + 1..j {
                        let known = area[i * n + k] + area[k * n + j];
                        if known < best.0 {
                            let total = known + cost(i, k, j);
                            if total < best.0 {
                                best = (total, k);
                            }
                        }
                    }
                }
                (area[i * n + j], via[i * n + j]) = best;
            }
        }
        if !area[n - 1].is_finite() {
            return None;
        }
        let mut patch = Vec::with_capacity(n - 2);
        let mut spans = vec![(0, n - 1)];
        while let Some((i, j)) = spans.pop() {
            if j - i < 2 {
                continue;
            }
            let k = via[i * n + j];
            // Against the boundary's direction, so that the patch faces as the surface does.
            patch.push([j, k, i].map(|m| self.vertices[m]));
            spans.push((i, k));
            spans.push((k, j));
        }
        Some(patch)
    }

    /// Pairs of rim vertices, as positions on the rim, between which there is an edge already.
    fn edges_across(&self, edges: &Edges, vertices: usize) -> HashSet<(usize, usize)> {
        let mut position = vec![usize::MAX; vertices];
        self.vertices.iter().enumerate().for_each(|(i, &v)| position[v] = i);
        edges
            .iter()
            .map(|(ends, _)| (position[ends[0]], position[ends[1]]))
            .filter(|&(a, b)| a != usize::MAX && b != usize::MAX)
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect()
    }
}
