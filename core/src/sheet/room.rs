//! Free room inside a piece: where words and arrows stand without touching its edge or one another.

use glam::DVec2;

/// How far words keep from edges and from one another, in mm.
const GAP: f64 = 1.5;

/// Farthest that words are moved from where they are best, in mm.
const FARTHEST: f64 = 90.0;

/// Step of the search, in mm.
const STEP: f64 = 4.0;

/// A box about a middle, turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turned {
    pub(super) middle: DVec2,
    /// Half its width and half its height.
    pub(super) half: DVec2,
    /// The unit direction of its width.
    pub(super) along: DVec2,
}

impl Turned {
    pub(super) fn new(middle: DVec2, width: f64, height: f64, angle: f64) -> Self {
        let half = 0.5 * DVec2::new(width, height);
        Self { middle, half, along: DVec2::from_angle(angle.to_radians()) }
    }

    fn axes(&self) -> [DVec2; 2] {
        [self.half.x * self.along, self.half.y * self.along.perp()]
    }

    fn corners(&self) -> [DVec2; 4] {
        let [a, b] = self.axes();
        [self.middle - a - b, self.middle + a - b, self.middle + a + b, self.middle - a + b]
    }

    /// Whether two boxes touch, by the axes of both (the separating axis theorem).
    fn touches(&self, other: &Self) -> bool {
        let gap = other.middle - self.middle;
        let [a, b] = self.axes();
        let [c, d] = other.axes();
        [self.along, self.along.perp(), other.along, other.along.perp()].into_iter().all(|axis| {
            let reach: f64 = [a, b, c, d].iter().map(|arm| arm.dot(axis).abs()).sum();
            gap.dot(axis).abs() < reach
        })
    }
}

/// The room inside loops of a piece.
pub(super) struct Room<'a> {
    loops: &'a [Vec<DVec2>],
    taken: Vec<Turned>,
}

impl<'a> Room<'a> {
    /// The room inside loops, even-odd.
    pub(super) fn new(loops: &'a [Vec<DVec2>]) -> Self {
        Self { loops, taken: Vec::new() }
    }

    /// Takes a box, whatever is there.
    pub(super) fn take(&mut self, what: Turned) {
        self.taken.push(what);
    }

    /// Takes a free place for a box near its own, moved as little as may be; where there is none,
    /// nothing is taken.
    pub(super) fn claim(&mut self, wanted: Turned) -> Option<Turned> {
        let rings = (FARTHEST / STEP) as i32;
        for ring in 0..=rings {
            let count = (8 * ring).max(1);
            for k in 0..count {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
                let middle = wanted.middle + STEP * f64::from(ring) * DVec2::from_angle(angle);
                let there = Turned { middle, ..wanted };
                if self.free(&there) {
                    self.taken.push(there);
                    return Some(there);
                }
            }
        }
        None
    }

    /// Whether a box lies inside, clear of the edge and of what was taken.
    pub(super) fn free(&self, what: &Turned) -> bool {
        let wide = Turned { half: what.half + GAP, ..*what };
        if !inside(self.loops, what.middle) || self.taken.iter().any(|taken| wide.touches(taken)) {
            return false;
        }
        let corners = wide.corners();
        let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
        !edges(self.loops).any(|(a, b)| sides().any(|(c, d)| crosses([a, b], [*c, *d])))
            && corners.iter().all(|p| inside(self.loops, *p))
    }
}

/// Whether a point is inside loops, even-odd.
pub(super) fn inside(loops: &[Vec<DVec2>], p: DVec2) -> bool {
    let crossings = edges(loops).filter(|(a, b)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossings.count() % 2 == 1
}

pub(super) fn edges(loops: &[Vec<DVec2>]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    loops.iter().flat_map(|points| {
        let next = points.iter().skip(1).chain(points.first());
        points.iter().copied().zip(next.copied())
    })
}

fn crosses([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p) > 0.0;
    side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 80 × 60 mm with a hole of 20 × 20 mm in its middle.
    fn plate() -> Vec<Vec<DVec2>> {
        let rectangle = |x0: f64, y0: f64, x1: f64, y1: f64| {
            vec![DVec2::new(x0, y0), DVec2::new(x1, y0), DVec2::new(x1, y1), DVec2::new(x0, y1)]
        };
        vec![rectangle(0.0, 0.0, 80.0, 60.0), rectangle(30.0, 20.0, 50.0, 40.0)]
    }

    #[test]
    fn inside_excludes_the_hole() {
        assert!(inside(&plate(), DVec2::new(10.0, 30.0)));
        assert!(!inside(&plate(), DVec2::new(40.0, 30.0)));
        assert!(!inside(&plate(), DVec2::new(-1.0, 30.0)));
    }

    #[test]
    fn a_box_moves_off_the_edge_the_hole_and_what_is_there() {
        let loops = plate();
        let mut room = Room::new(&loops);
        let wanted = Turned::new(DVec2::new(40.0, 30.0), 16.0, 4.0, 0.0);
        let first = room.claim(wanted).unwrap();
        let second = room.claim(wanted).unwrap();
        assert!(!first.touches(&second));
        for place in [first, second] {
            for corner in place.corners() {
                assert!(inside(&loops, corner));
            }
        }
        // Wider than the plate: nowhere.
        assert_eq!(room.claim(Turned::new(DVec2::new(40.0, 10.0), 90.0, 4.0, 0.0)), None);
        // Across the hole is not free, though all corners are inside.
        assert!(!room.free(&Turned::new(DVec2::new(40.0, 45.0), 4.0, 24.0, 0.0)));
    }

    #[test]
    fn turned_boxes_touch_where_they_do() {
        let flat = Turned::new(DVec2::ZERO, 10.0, 2.0, 0.0);
        assert!(flat.touches(&Turned::new(DVec2::new(4.0, 4.0), 10.0, 2.0, 90.0)));
        // Its box along the axes would touch, it does not.
        assert!(!flat.touches(&Turned::new(DVec2::new(8.0, 4.0), 10.0, 2.0, 45.0 + 90.0)));
    }
}
