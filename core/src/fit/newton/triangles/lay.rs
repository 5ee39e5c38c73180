//! The given triangles laid the right way round where the fit was made on others over the same vertices.
//!
//! The energy keeps its own triangles from turning over. Of those that made way for them the thinnest may end
//! turned over by some hundredths of a millimetre where a scan's vertices lie nearly in a line. Held back in every
//! step they stopped the whole fit (a scan from marching cubes, with heights of half a thousandth of a millimetre, and
//! noisy ankles), so they are put right when it has ended: one corner each moves across the opposite side.

use std::collections::BTreeSet;

use glam::DVec2;

use super::Triangles;
use crate::surface::Surface;

/// Height of a triangle that was put right, over the side that its corner has crossed.
const THIN: f64 = 1e-3;

/// What is left at least of the area of the fit's own triangles round a corner that moves.
const LEFT: f64 = 0.1;

/// Putting one right may turn over another: so often all are looked at again.
const SWEEPS: usize = 10;

fn twice_area(corners: [u32; 3], coordinates: &[DVec2]) -> f64 {
    let [a, b, c] = corners.map(|v| coordinates[v as usize]);
    (b - a).perp_dot(c - a)
}

impl Triangles {
    /// Takes over the triangles of a surface over the same vertices for [`lay_right`](Self::lay_right).
    pub fn made_way(&mut self, surface: &Surface) {
        let first_least = |corners: [u32; 3]| {
            let [a, b, c] = corners;
            if a < b && a < c {
                corners
            } else if b < c {
                [b, c, a]
            } else {
                [c, a, b]
            }
        };
        let own: BTreeSet<[u32; 3]> =
            self.worn.iter().map(|worn| first_least(worn.corners)).collect();
        let given = surface.triangles().iter().map(|t| t.map(|v| v.index() as u32));
        self.given = given.filter(|&t| !own.contains(&first_least(t))).collect();
    }

    /// Whether all triangles lie the right way round in the plane.
    pub fn lie_right(&self, coordinates: &[DVec2]) -> bool {
        self.worn.iter().all(|worn| twice_area(worn.corners, coordinates) > 0.0)
    }

    /// Lays those that made way the right way round, too, where that takes no corner that is `held` and leaves these
    /// triangles as they lie.
    pub fn lay_right(&self, coordinates: &mut [DVec2], held: impl Iterator<Item = usize>) {
        let is_over = |t: &[u32; 3], coordinates: &[DVec2]| twice_area(*t, coordinates) <= 0.0;
        let held: BTreeSet<usize> = held.collect();
        for _ in 0..SWEEPS {
            let over: Vec<[u32; 3]> =
                self.given.iter().copied().filter(|t| is_over(t, coordinates)).collect();
            if over.is_empty() {
                return;
            }
            over.into_iter().for_each(|t| self.put_right(t, coordinates, &held));
        }
    }

    /// Moves a corner of a triangle that is turned over across the opposite side, the longest that it can be.
    fn put_right(&self, corners: [u32; 3], coordinates: &mut [DVec2], held: &BTreeSet<usize>) {
        let mut sides = [0, 1, 2].map(|k| {
            let [v, from, to] = [k, (k + 1) % 3, (k + 2) % 3].map(|k| corners[k] as usize);
            (v, coordinates[to] - coordinates[from])
        });
        sides.sort_by(|(_, a), (_, b)| b.length_squared().total_cmp(&a.length_squared()));
        for (v, side) in sides.into_iter().filter(|(v, _)| !held.contains(v)) {
            let height = twice_area(corners, coordinates) / side.length();
            let way = (THIN * side.length() - height) * side.perp().normalize_or_zero();
            let before = coordinates[v];
            let round: Vec<f64> = self.areas_round(v, coordinates).collect();
            coordinates[v] += way;
            let stay = self.areas_round(v, coordinates).zip(round).all(|(a, b)| a > LEFT * b);
            if stay && twice_area(corners, coordinates) > 0.0 {
                return;
            }
            coordinates[v] = before;
        }
    }

    /// Twice the areas of the triangles round a vertex.
    fn areas_round<'a>(
        &'a self,
        v: usize,
        coordinates: &'a [DVec2],
    ) -> impl Iterator<Item = f64> + 'a {
        let corners = self.corners_at(v).iter();
        corners.map(|&k| twice_area(self.worn[k as usize / 3].corners, coordinates))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameterize::rest_triangles;
    use crate::surface::VertexId;

    /// A square with one vertex just above its lower side and one below it.
    fn triangles(own: bool) -> Surface {
        let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 0.001], [1.0, -1.0]];
        let round = [[1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let between = if own { [[0, 5, 4], [5, 1, 4]] } else { [[0, 1, 4], [0, 5, 1]] };
        let corners = round.into_iter().chain(between).map(|t| t.map(VertexId::new));
        let points = points.map(|p| DVec2::from_array(p).extend(0.0));
        Surface::new(points.to_vec(), corners.collect()).unwrap()
    }

    #[test]
    fn a_sliver_that_made_way_and_turned_over_is_put_right_by_the_least_motion() {
        let (own, given) = (triangles(true), triangles(false));
        let mut triangles = Triangles::new(&own, &rest_triangles(&own));
        triangles.made_way(&given);
        let flat: Vec<DVec2> = own.points().iter().map(|p| p.truncate()).collect();
        let put = |mut plane: Vec<DVec2>, held: &[usize]| {
            triangles.lay_right(&mut plane, held.iter().copied());
            plane
        };
        assert_eq!(put(flat.clone(), &[]), flat, "nothing lies wrong");
        let mut over = flat.clone();
        over[4].y = -0.02;
        assert!(triangles.lie_right(&over), "only a triangle that made way is turned over");
        let right = put(over.clone(), &[]);
        let lies_right = |t: &[u32; 3]| twice_area(*t, &right) > 0.0;
        assert!(triangles.given.iter().all(lies_right) && triangles.lie_right(&right));
        assert!(right[4].y > 0.0 && right[4].distance(over[4]) < 0.03, "{}", right[4]);
        assert_eq!((&right[..4], right[5]), (&over[..4], over[5]));
        // What is held stays; another corner goes, or none can.
        let right = put(over.clone(), &[4]);
        assert_eq!(right[4], over[4]);
        assert!(triangles.given.iter().all(|t| twice_area(*t, &right) > 0.0));
        assert_eq!(put(over.clone(), &[0, 1, 4]), over);
    }
}
