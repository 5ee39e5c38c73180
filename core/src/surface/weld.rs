//! Points at one place become one vertex, where that is what the file means.
//!
//! - In a **soup** (no point is shared by two faces: STL always, and exports without indices) the
//!   places are all the connectivity there is, and all points are welded.
//! - Where points are shared by index, two vertices at one place are two on purpose: the sides of
//!   a cut. They are left alone, unless they lie on the borders of two *different* components,
//!   edge on edge, with the surface going on: exporters part a surface so at the borders of
//!   texture patches. A second layer, its triangles on those of the first, is not joined to it.
//!
//! Limit: the cut of a surface that is stored as a soup cannot be told from the rest and closes.

use std::collections::HashMap;

use glam::DVec3;

use super::connectivity::{Edges, Sets, components, end, start};

/// Two points of a soup are one when closer than this, as a fraction of the diagonal of the
/// bounding box. STL stores 32-bit coordinates, 6e-8 of the size; a transformation on export
/// computed triangle by triangle leaves a few such steps between copies of one point. On a limb
/// it is below a thousandth of a millimetre, far under any scanner's resolution.
pub(super) const WELD: f64 = 1e-6;

/// Whether no point is shared by two of several triangles.
pub(super) fn is_soup(triangles: &[[usize; 3]], faces: &[usize], vertices: usize) -> bool {
    let mut user = vec![usize::MAX; vertices];
    let mut shared = false;
    for (corners, &face) in triangles.iter().zip(faces) {
        for &v in corners {
            shared |= user[v] != usize::MAX && user[v] != face;
            user[v] = face;
        }
    }
    !shared && faces.first() != faces.last()
}

/// For every one of `vertices` the first of them that lies within `tolerance` (mm) of it.
pub(super) fn first_at_place(points: &[DVec3], vertices: &[usize], tolerance: f64) -> Vec<usize> {
    // Much wider than the tolerance, so that a point is rarely near more than one cell.
    let cell = 32.0 * tolerance;
    let index = |x: f64| (x / cell).floor() as i64;
    let mut firsts: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    vertices
        .iter()
        .map(|&v| {
            let p = points[v];
            let low = (p - tolerance).to_array().map(index);
            let high = (p + tolerance).to_array().map(index);
            let mut found = usize::MAX;
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        for &first in firsts.get(&[x, y, z]).into_iter().flatten() {
                            if points[first].distance(p) <= tolerance {
                                found = found.min(first);
                            }
                        }
                    }
                }
            }
            if found == usize::MAX {
                firsts.entry(p.to_array().map(index)).or_default().push(v);
                found = v;
            }
            found
        })
        .collect()
}

/// For every vertex the one it becomes when all points at a place are one.
pub(super) fn by_place(points: &[DVec3], tolerance: f64) -> Vec<usize> {
    let all: Vec<usize> = (0..points.len()).collect();
    first_at_place(points, &all, tolerance)
}

/// For every vertex the one it becomes when components are joined where border lies on border,
/// edge on edge; `None` if they nowhere do.
pub(super) fn join_components(
    points: &[DVec3],
    triangles: &[[usize; 3]],
    tolerance: f64,
) -> Option<Vec<usize>> {
    let edges = Edges::of(triangles);
    let (component, count) = components(triangles, &edges);
    if count < 2 {
        return None;
    }
    let borders = Borders::of(points, triangles, &edges, tolerance);
    let mut sets = Sets::new(points.len());
    let mut joined = false;
    for group in borders.groups() {
        for (i, a) in group.iter().enumerate() {
            for b in &group[i + 1..] {
                let goes_on = points[a.apex].distance(points[b.apex]) > tolerance
                    && component[a.triangle] != component[b.triangle];
                if goes_on {
                    joined = true;
                    sets.join(a.vertices[0], b.vertices[0]);
                    sets.join(a.vertices[1], b.vertices[1]);
                }
            }
        }
    }
    joined.then(|| (0..points.len()).map(|v| sets.find(v)).collect())
}

/// Length (mm) along which the boundary lies on itself: a cut.
pub(super) fn cut_length(points: &[DVec3], triangles: &[[usize; 3]], tolerance: f64) -> f64 {
    let edges = Edges::of(triangles);
    let borders = Borders::of(points, triangles, &edges, tolerance);
    let length = |b: &Border| points[b.vertices[0]].distance(points[b.vertices[1]]);
    borders.groups().filter(|group| group.len() > 1).map(|group| length(&group[0])).sum()
}

/// A boundary edge, by its ends' places.
#[derive(Clone, Copy)]
struct Border {
    places: [usize; 2],
    /// The vertices at these places.
    vertices: [usize; 2],
    triangle: usize,
    /// The triangle's third vertex.
    apex: usize,
}

/// The boundary edges, sorted by their places.
struct Borders(Vec<Border>);

impl Borders {
    fn of(points: &[DVec3], triangles: &[[usize; 3]], edges: &Edges, tolerance: f64) -> Self {
        let half_edges: Vec<usize> = edges
            .iter()
            .filter(|(_, uses)| uses.len() == 1)
            .map(|(_, uses)| uses.half_edge(0))
            .collect();
        let mut vertices: Vec<usize> =
            half_edges.iter().flat_map(|&h| [start(triangles, h), end(triangles, h)]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut place = vec![usize::MAX; points.len()];
        for (&v, first) in vertices.iter().zip(first_at_place(points, &vertices, tolerance)) {
            place[v] = first;
        }
        let mut borders: Vec<Border> = half_edges
            .into_iter()
            .filter_map(|h| {
                let (a, b) = (start(triangles, h), end(triangles, h));
                let (a, b) = if place[a] <= place[b] { (a, b) } else { (b, a) };
                (place[a] != place[b]).then(|| Border {
                    places: [place[a], place[b]],
                    vertices: [a, b],
                    triangle: h / 3,
                    apex: triangles[h / 3][(h % 3 + 2) % 3],
                })
            })
            .collect();
        borders.sort_by_key(|b| (b.places, b.triangle, b.vertices));
        Self(borders)
    }

    /// The edges that lie on one another.
    fn groups(&self) -> impl Iterator<Item = &[Border]> {
        self.0.chunk_by(|a, b| a.places == b.places)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_within_the_tolerance_are_one_across_cells() {
        let x = |x: f64| DVec3::new(x, 5.0, -7.0);
        // 0.032 is a cell's border for a tolerance of 0.001.
        let points = [x(0.0315), x(0.0324), x(0.0336), x(0.0), x(-0.0005), x(0.0315)];
        assert_eq!(by_place(&points, 0.001), [0, 0, 2, 3, 3, 0]);
    }

    #[test]
    fn a_soup_shares_no_point() {
        assert!(is_soup(&[[0, 1, 2], [3, 4, 5]], &[0, 1], 6));
        assert!(!is_soup(&[[0, 1, 2], [0, 2, 3]], &[0, 1], 4));
        // One quadrangle shares points between its own triangles only.
        assert!(!is_soup(&[[0, 1, 2], [0, 2, 3]], &[0, 0], 4));
        assert!(is_soup(&[[0, 1, 2], [0, 2, 3], [4, 5, 6]], &[0, 0, 1], 7));
    }

    #[test]
    fn components_are_joined_edge_on_edge_and_not_at_a_point() {
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        // Two triangles that meet along x = 1 and one that touches the corner (2, 0).
        let points = [
            p(0.0, 0.0),
            p(1.0, 0.0),
            p(1.0, 1.0),
            p(1.0, 0.0),
            p(2.0, 0.0),
            p(1.0, 1.0),
            p(2.0, 0.0),
            p(3.0, 0.0),
            p(3.0, 1.0),
        ];
        let triangles = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        let map = join_components(&points, &triangles, 1e-6).unwrap();
        assert_eq!(map, [0, 1, 2, 1, 4, 2, 6, 7, 8]);
        assert!(join_components(&points, &triangles[1..], 1e-6).is_none());
        // Nor are two layers, whichever way they face.
        for layers in [[[0, 1, 2], [3, 4, 5]], [[0, 1, 2], [3, 5, 4]]] {
            let points = [points[0], points[1], points[2], points[0], points[1], points[2]];
            assert!(join_components(&points, &layers, 1e-6).is_none());
        }
    }
}
