//! A polygon becomes triangles without new vertices: ear clipping in the plane of its area vector
//! (Meisters 1975), with exact orientation tests (Shewchuk 1997), so that concave polygons and
//! corners on a straight side come out right. A convex quadrangle, planar or not, is split along
//! its shorter diagonal.
//!
//! Limit: a polygon so bent that its projection crosses itself is refused.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

/// Why a polygon cannot be split.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unsplittable {
    /// It has fewer than three different corners or no area.
    NoArea,
    /// It crosses itself, or is too large to be split in a useful time.
    Crossed,
}

/// The triangles of the polygon with these corners, as indices into `corners`, turning the same
/// way.
pub(super) fn triangulate(corners: &[DVec3]) -> Result<Vec<[usize; 3]>, Unsplittable> {
    /// Ear clipping takes the square of this many steps.
    const MOST_CORNERS: usize = 10_000;
    if corners.len() < 3 {
        return Err(Unsplittable::NoArea);
    }
    if corners.len() == 3 {
        return Ok(vec![[0, 1, 2]]);
    }
    if corners.len() > MOST_CORNERS {
        return Err(Unsplittable::Crossed);
    }
    let flat = project(corners).ok_or(Unsplittable::NoArea)?;
    if corners.len() == 4 {
        let convex = |i: usize| turn(flat[(i + 3) % 4], flat[i], flat[(i + 1) % 4]) > 0.0;
        if (0..4).all(convex) {
            let even = corners[0].distance_squared(corners[2]);
            let odd = corners[1].distance_squared(corners[3]);
            return Ok(if even <= odd {
                vec![[0, 1, 2], [0, 2, 3]]
            } else {
                vec![[0, 1, 3], [1, 2, 3]]
            });
        }
    }
    clip_ears(&flat).ok_or(Unsplittable::Crossed)
}

/// The corners in the plane of the polygon's area vector (Newell), counter-clockwise.
fn project(corners: &[DVec3]) -> Option<Vec<DVec2>> {
    let origin = corners[0];
    let area: DVec3 =
        (1..corners.len() - 1).map(|i| (corners[i] - origin).cross(corners[i + 1] - origin)).sum();
    let normal = area.try_normalize()?;
    let (u, v) = normal.any_orthonormal_pair();
    // The pair may be left-handed with the normal.
    let v = if u.cross(v).dot(normal) < 0.0 { -v } else { v };
    Some(corners.iter().map(|&p| DVec2::new((p - origin).dot(u), (p - origin).dot(v))).collect())
}

fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// Cuts off corners whose triangle turns left and holds no other corner, its border included.
fn clip_ears(flat: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    let mut at = 0;
    while left.len() > 3 {
        let n = left.len();
        // Going on from the last ear spreads the triangles instead of making one large fan.
        let ear = (0..n).map(|step| (at + step) % n).find(|&i| is_ear(flat, &left, i))?;
        triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
        at = ear + 1;
    }
    let last = [left[0], left[1], left[2]];
    (turn(flat[last[0]], flat[last[1]], flat[last[2]]) > 0.0).then(|| {
        triangles.push(last);
        triangles
    })
}

fn is_ear(flat: &[DVec2], left: &[usize], i: usize) -> bool {
    let n = left.len();
    let (before, after) = ((i + n - 1) % n, (i + 1) % n);
    let [a, b, c] = [before, i, after].map(|k| flat[left[k]]);
    turn(a, b, c) > 0.0
        && (0..n).filter(|&k| k != before && k != i && k != after).all(|k| {
            let p = flat[left[k]];
            turn(a, b, p) < 0.0 || turn(b, c, p) < 0.0 || turn(c, a, p) < 0.0
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area_of(corners: &[DVec3], triangles: &[[usize; 3]]) -> Vec<f64> {
        let area = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| corners[i]);
            (b - a).cross(c - a).z / 2.0
        };
        triangles.iter().map(area).collect()
    }

    fn flat(corners: &[(f64, f64)]) -> Vec<DVec3> {
        corners.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect()
    }

    #[test]
    fn a_convex_quadrangle_is_split_along_its_shorter_diagonal() {
        let kite = flat(&[(0.0, 0.0), (2.0, -1.0), (4.0, 0.0), (2.0, 1.0)]);
        assert_eq!(triangulate(&kite).unwrap(), [[0, 1, 3], [1, 2, 3]]);
        let square = flat(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert_eq!(triangulate(&square).unwrap(), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_polygons_keep_their_area_and_turn() {
        let arrow = flat(&[(0.0, 0.0), (4.0, -2.0), (1.0, 0.0), (4.0, 2.0)]);
        let l = flat(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)]);
        // A comb with three teeth and corners on its straight back.
        let comb = flat(&[
            (0.0, 0.0),
            (1.0, 0.0),
            (2.0, 0.0),
            (5.0, 0.0),
            (5.0, 3.0),
            (4.0, 3.0),
            (4.0, 1.0),
            (3.0, 1.0),
            (3.0, 3.0),
            (2.0, 3.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ]);
        for (corners, area) in [(arrow, 2.0), (l, 5.0), (comb, 11.0)] {
            for mirrored in [false, true] {
                let mut corners = corners.clone();
                if mirrored {
                    corners.reverse();
                }
                let triangles = triangulate(&corners).unwrap();
                assert_eq!(triangles.len(), corners.len() - 2);
                let areas = area_of(&corners, &triangles);
                let sign = if mirrored { -1.0 } else { 1.0 };
                assert!(areas.iter().all(|a| a * sign > 0.0), "{areas:?}");
                assert!((areas.iter().sum::<f64>() - sign * area).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn what_is_no_polygon_is_refused() {
        let two = flat(&[(0.0, 0.0), (1.0, 0.0)]);
        assert_eq!(triangulate(&two), Err(Unsplittable::NoArea));
        let line = flat(&[(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (2.0, 0.0)]);
        assert_eq!(triangulate(&line), Err(Unsplittable::NoArea));
        let bow = flat(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 3.0)]);
        assert_eq!(triangulate(&bow), Err(Unsplittable::Crossed));
    }
}
