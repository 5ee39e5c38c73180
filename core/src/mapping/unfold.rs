//! Repairing folds of the surface-plane mapping.
//!
//! Eqs. (8) and (9) place each vertex by itself. Where the fabric is extrapolated (at the rim of a
//! cut-out, beyond the last cells of a coarse grid) two neighbouring vertices can be placed by
//! different nodes and change sides: a triangle flips. There the places are recomputed together:
//! every vertex of the fold goes to the mean of what its neighbours' places and the threads of one
//! common node say (a discrete Poisson equation, solved by Gauss–Seidel sweeps), with the
//! surroundings held. The fold's surroundings are widened until nothing is flipped.
//!
//! Limit: where the fabric itself is folded this does not help, and the flipped triangles are counted
//! in the report.

use glam::DVec2;

use super::Mapping;
use crate::parameterize::flipped_triangles;
use crate::surface::{Surface, TriangleId, VertexId};

/// How often a fold's surroundings are widened by a ring of triangles.
const MOST_RINGS: usize = 8;

/// Sweeps over a fold: its diameter is some ten edges, and a sweep smooths over one.
const SWEEPS: usize = 200;

/// The coordinates without the folds that can be repaired.
pub(super) fn unfolded(mapping: &Mapping<'_>, closest: &[usize], plane: Vec<DVec2>) -> Vec<DVec2> {
    let surface = mapping.surface;
    let count = |plane: &[DVec2]| flipped_triangles(surface, plane).count();
    let mut fewest = count(&plane);
    let mut best = plane;
    for rings in 1..=MOST_RINGS {
        if fewest == 0 {
            break;
        }
        let fold = surroundings(surface, &best, rings);
        let repaired = settle(mapping, closest, &best, &fold);
        let flipped = count(&repaired);
        if flipped < fewest {
            (fewest, best) = (flipped, repaired);
        }
    }
    let flipped: Vec<TriangleId> = flipped_triangles(surface, &best).collect();
    for t in flipped {
        let mut repaired = best.clone();
        let (apex, place) = righted(surface, &best, t);
        repaired[apex.index()] = place;
        let flipped = count(&repaired);
        if flipped < fewest {
            (fewest, best) = (flipped, repaired);
        }
    }
    best
}

/// Where the apex of a needle (the corner opposite its longest side) belongs: on its own side of the
/// longest side, as far along and away as on the surface. A needle flips when its apex is off by its
/// height, hundredths of a millimetre.
fn righted(surface: &Surface, plane: &[DVec2], t: TriangleId) -> (VertexId, DVec2) {
    let corners = surface.triangle(t);
    let side = |k: usize| {
        let [a, b] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
        surface.point(b) - surface.point(a)
    };
    let longest = |a: usize, b: usize| if side(b).length() > side(a).length() { b } else { a };
    let apex = (0..3).reduce(longest).unwrap_or(0);
    let (from, to) = (corners[(apex + 1) % 3], corners[(apex + 2) % 3]);
    let offset = surface.point(corners[apex]) - surface.point(from);
    let along = offset.dot(side(apex)) / side(apex).length_squared();
    let away = (offset - along * side(apex)).length() / side(apex).length();
    let base = plane[to.index()] - plane[from.index()];
    (corners[apex], plane[from.index()] + along * base + away * base.perp())
}

/// The vertices within so many rings of a flipped triangle, in order.
fn surroundings(surface: &Surface, plane: &[DVec2], rings: usize) -> Vec<VertexId> {
    let mut fold: Vec<VertexId> =
        flipped_triangles(surface, plane).flat_map(|t| surface.triangle(t)).collect();
    for _ in 0..rings {
        let next: Vec<VertexId> = fold.iter().flat_map(|&v| surface.neighbours(v)).collect();
        fold.extend(next);
        fold.sort_unstable();
        fold.dedup();
    }
    fold
}

fn settle(
    mapping: &Mapping<'_>,
    closest: &[usize],
    plane: &[DVec2],
    fold: &[VertexId],
) -> Vec<DVec2> {
    let surface = mapping.surface;
    // What the threads say of the way from a neighbour to a vertex, as seen from one node.
    let ways: Vec<Vec<(VertexId, DVec2)>> = fold
        .iter()
        .map(|&v| {
            surface
                .neighbours(v)
                .filter_map(|n| {
                    let node = closest[v.index().min(n.index())];
                    let seen = |u: VertexId| mapping.seen_alone(node, surface.point(u));
                    Some((n, seen(v)? - seen(n)?))
                })
                .collect()
        })
        .collect();
    let mut places = plane.to_vec();
    for _ in 0..SWEEPS {
        for (v, ways) in fold.iter().zip(&ways) {
            if !ways.is_empty() {
                let sum: DVec2 = ways.iter().map(|(n, way)| places[n.index()] + *way).sum();
                places[v.index()] = sum / ways.len() as f64;
            }
        }
    }
    places
}
