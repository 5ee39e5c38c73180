//! Which way the triangles face.
//!
//! Neighbours are made to agree by walking over the edges that two triangles share; a surface on
//! which that is impossible has one side. Which of the two agreeing ways is outward is told by
//! the volume: every boundary loop is closed by a fan to its centroid, and a surface that faces
//! outward then encloses a positive volume.
//!
//! Limit: a patch is taken to bulge outward, as limbs do. One so flat that its volume says
//! nothing is ambiguous and must be told by the designer.

use glam::DVec3;

use super::connectivity::{Edges, boundary_loops, end, start};

/// Below this |volume| / area^1.5 the shape does not tell. A sphere has 0.094, a tube of radius r
/// and length l has 0.2 √(r/l) (0.09 for a forearm, cut along a seam two thirds of that), a patch
/// of an eighth of a tube 0.015.
const FLAT: f64 = 0.01;

/// What walking over the edges found.
pub(super) struct Agreement {
    /// Triangles to turn round so that all agree; in each component the fewer.
    pub(super) turned: Vec<bool>,
    /// An edge of each one-sided component, as its two half-edges.
    pub(super) conflicts: Vec<[usize; 2]>,
}

/// Finds which triangles must be turned so that neighbours agree.
pub(super) fn agree(triangles: &[[usize; 3]], edges: &Edges) -> Agreement {
    let mut mate = vec![usize::MAX; 3 * triangles.len()];
    for (_, uses) in edges.iter().filter(|(_, uses)| uses.len() == 2) {
        mate[uses.half_edge(0)] = uses.half_edge(1);
        mate[uses.half_edge(1)] = uses.half_edge(0);
    }
    let mut turned = vec![false; triangles.len()];
    let mut seen = vec![false; triangles.len()];
    let mut conflicts = Vec::new();
    for first in 0..triangles.len() {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut component = vec![first];
        let mut conflict = None;
        let mut next = 0;
        while next < component.len() {
            let t = component[next];
            next += 1;
            for h in 3 * t..3 * t + 3 {
                let other = mate[h];
                if other == usize::MAX {
                    continue;
                }
                // Agreeing neighbours run along their common edge in opposite directions.
                let against = start(triangles, h) == start(triangles, other);
                let wanted = turned[t] != against;
                let neighbour = other / 3;
                if !seen[neighbour] {
                    seen[neighbour] = true;
                    turned[neighbour] = wanted;
                    component.push(neighbour);
                } else if turned[neighbour] != wanted && conflict.is_none() {
                    conflict = Some([h.min(other), h.max(other)]);
                }
            }
        }
        conflicts.extend(conflict);
        if 2 * component.iter().filter(|&&t| turned[t]).count() > component.len() {
            component.iter().for_each(|&t| turned[t] = !turned[t]);
        }
    }
    Agreement { turned, conflicts }
}

/// Whether an oriented manifold faces outward as it is; `None` where its shape does not tell.
pub(super) fn faces_outward(
    points: &[DVec3],
    triangles: &[[usize; 3]],
    edges: &Edges,
) -> Option<bool> {
    let origin = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let at = |v: usize| points[v] - origin;
    let (mut volume, mut area) = (0.0, 0.0);
    for &[a, b, c] in triangles {
        let [a, b, c] = [at(a), at(b), at(c)];
        volume += a.dot(b.cross(c)) / 6.0;
        area += 0.5 * (b - a).cross(c - a).length();
    }
    for boundary in boundary_loops(triangles, edges, points.len()) {
        let ends = |&h: &usize| (at(start(triangles, h)), at(end(triangles, h)));
        let length: f64 = boundary.iter().map(ends).map(|(a, b)| a.distance(b)).sum();
        let moment: DVec3 =
            boundary.iter().map(ends).map(|(a, b)| a.distance(b) * 0.5 * (a + b)).sum();
        let centroid = moment / length;
        // The cap runs along the boundary the other way.
        volume +=
            boundary.iter().map(ends).map(|(a, b)| b.dot(a.cross(centroid)) / 6.0).sum::<f64>();
    }
    (volume.abs() >= FLAT * area.powf(1.5)).then_some(volume > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fewer_are_turned() {
        // A fan of four round vertex 0; the third runs the other way.
        let triangles = [[0, 1, 2], [0, 2, 3], [0, 4, 3], [0, 4, 5]];
        let agreement = agree(&triangles, &Edges::of(&triangles));
        assert_eq!(agreement.turned, [false, false, true, false]);
        assert!(agreement.conflicts.is_empty());
        let triangles = [[0, 2, 1], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
        let agreement = agree(&triangles, &Edges::of(&triangles));
        assert_eq!(agreement.turned, [true, false, false, false]);
        // Two of five, the first among them.
        let triangles = [[0, 2, 1], [0, 2, 3], [0, 4, 3], [0, 4, 5], [0, 5, 6]];
        let agreement = agree(&triangles, &Edges::of(&triangles));
        assert_eq!(agreement.turned, [true, false, true, false, false]);
    }

    #[test]
    fn a_moebius_strip_has_one_conflict() {
        // Five triangles on five vertices, each sharing two edges with its neighbours.
        let triangles = [[0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 0], [4, 0, 1]];
        assert_eq!(agree(&triangles, &Edges::of(&triangles)).conflicts.len(), 1);
    }

    #[test]
    fn volume_tells_outward_and_flatness_does_not() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let outward = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let inward = outward.map(|[a, b, c]| [a, c, b]);
        let told = |t: &[[usize; 3]]| faces_outward(&points, t, &Edges::of(t));
        assert_eq!(told(&outward), Some(true));
        assert_eq!(told(&inward), Some(false));
        // Without its base it is a tent that bulges to the other side of the base.
        assert_eq!(told(&outward[1..]), Some(true));
        assert_eq!(told(&outward[..1]), None);
    }
}
