//! Notches: where the two sides of a seam are laid on each other.
//!
//! Both sides have them at the same share of their length from the seam's start; sides of equal
//! length so have them at equal lengths. The first from the start is double, so that a side cannot be
//! sewn on upside down. They are slits of half the allowance, from the cut line inward; an edge
//! without allowance is marked there and not cut, for a slit would go through the seam.

use glam::DVec2;

use super::allowance::right;
use super::edges::{Edge, EdgeKind, Side, along, length};

/// The deepest slit, in mm.
const DEEPEST: f64 = 4.0;

/// Length of a mark on an edge without allowance, in mm.
const MARK: f64 = 3.0;

/// Distance of the two slits of a double notch, in mm.
const DOUBLE: f64 = 6.0;

/// A notch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Notch {
    /// The seam, by its index.
    pub seam: usize,
    /// The side of the seam.
    pub side: Side,
    /// Which it is, from 1 at the seam's start; the two slits of a double one have the same number.
    pub number: usize,
    /// Length along the side from the seam's start, in mm.
    pub along_mm: f64,
    /// On the sew line, in mm.
    pub sewn_at: DVec2,
    /// On the cut line, in mm.
    pub at: DVec2,
    /// The inner end of the slit or mark, in mm.
    pub end: DVec2,
    /// Whether it is cut, else it is drawn.
    pub slit: bool,
}

/// The notches of an edge, `spacing` mm apart, about; none on an edge that is not sewn.
pub(super) fn notches(edge: &Edge, spacing: f64) -> Vec<Notch> {
    let EdgeKind::Sewn(seam, side) = edge.kind else { return Vec::new() };
    if spacing <= 0.0 {
        return Vec::new();
    }
    // From the seam's start: the right side's edge runs towards it.
    let total = length(&edge.points);
    // By the nearest whole number both sides get as many, though their lengths differ by rounding.
    let parts = (total / spacing + 1e-6).round().max(2.0);
    let mut notches = Vec::new();
    for number in 1..parts as usize {
        let at = total * number as f64 / parts;
        let offsets: &[f64] = if number == 1 { &[-0.5 * DOUBLE, 0.5 * DOUBLE] } else { &[0.0] };
        for offset in offsets.iter().filter(|offset| at + **offset > 0.0) {
            let run = at + offset;
            let along_edge = if side == Side::Left { run } else { total - run };
            let Some((sewn_at, direction)) = along(&edge.points, along_edge) else { continue };
            let out = right(direction);
            let slit = edge.allowance > 0.0;
            let depth = if slit { (0.5 * edge.allowance).min(DEEPEST) } else { MARK };
            let on_cut = sewn_at + edge.allowance * out;
            let end = on_cut - depth * out;
            notches.push(Notch {
                seam,
                side,
                number,
                along_mm: run,
                sewn_at,
                at: on_cut,
                end,
                slit,
            });
        }
    }
    notches
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(side: Side, allowance: f64, points: &[(f64, f64)]) -> Edge {
        let points = points.iter().map(|p| DVec2::from(*p)).collect();
        Edge { kind: EdgeKind::Sewn(0, side), points, allowance }
    }

    #[test]
    fn both_sides_have_them_at_equal_lengths_and_the_first_is_double() {
        // 200 mm: four parts of 50 mm. The right side is bent and runs upward.
        let left = side(Side::Left, 10.0, &[(0.0, 200.0), (0.0, 0.0)]);
        let right = side(Side::Right, 10.0, &[(160.0, 0.0), (160.0, 120.0), (208.0, 184.0)]);
        let [left, right] = [&left, &right].map(|edge| notches(edge, 50.0));
        let lengths = |all: &[Notch]| all.iter().map(|n| n.along_mm).collect::<Vec<_>>();
        assert_eq!(lengths(&left), [47.0, 53.0, 100.0, 150.0]);
        assert_eq!(lengths(&right), lengths(&left));
        assert_eq!(left[2].sewn_at, DVec2::new(0.0, 100.0));
        // 100 mm from the upper end: 80 down the slope, 20 more straight down.
        assert!(right[2].sewn_at.distance(DVec2::new(160.0, 100.0)) < 1e-9);
        // Slits from the cut line, 10 mm outside, 4 mm inward.
        assert!(left[2].at.distance(DVec2::new(-10.0, 100.0)) < 1e-9 && left[2].slit);
        assert!(left[2].end.distance(DVec2::new(-6.0, 100.0)) < 1e-9);
        assert!(right[3].at.distance(DVec2::new(170.0, 50.0)) < 1e-9);
    }

    #[test]
    fn without_allowance_they_are_drawn_and_where_none_are_wanted_there_are_none() {
        let left = side(Side::Left, 0.0, &[(0.0, 100.0), (0.0, 0.0)]);
        let drawn = notches(&left, 50.0);
        assert_eq!(drawn.len(), 2);
        assert!(!drawn[0].slit && drawn[0].at == drawn[0].sewn_at);
        assert!(drawn[0].end.distance(drawn[0].at + DVec2::new(3.0, 0.0)) < 1e-9);
        assert!(notches(&left, 0.0).is_empty());
        let edge = Edge { kind: EdgeKind::Top, ..left };
        assert!(notches(&edge, 50.0).is_empty());
    }
}
