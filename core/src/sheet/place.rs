//! Lays pieces on a sheet: side by side from the upper left, in rows, without overlap.

use glam::DVec2;

/// Between pieces, in mm: room for a knife and for words of neither.
pub(super) const GAP: f64 = 15.0;

/// Rows are no wider than this unless a piece is, in mm: the usable width of most elastic fabrics.
const ROW: f64 = 1400.0;

/// The lower left corner of each box of a size, y up, the lowest at zero, and the extent of all.
pub(super) fn rows(sizes: &[DVec2]) -> (Vec<DVec2>, DVec2) {
    let mut corners = Vec::with_capacity(sizes.len());
    let (mut x, mut top, mut depth, mut wide) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    for size in sizes {
        if x > 0.0 && x + size.x > ROW {
            top += depth + GAP;
            (x, depth) = (0.0, 0.0);
        }
        corners.push(DVec2::new(x, top + size.y));
        x += size.x + GAP;
        depth = depth.max(size.y);
        wide = wide.max(x - GAP);
    }
    let high = top + depth;
    for corner in &mut corners {
        corner.y = high - corner.y;
    }
    (corners, DVec2::new(wide, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_lie_side_by_side_and_then_below() {
        let sizes = [(800.0, 100.0), (500.0, 200.0), (300.0, 50.0)].map(DVec2::from);
        let (corners, all) = rows(&sizes);
        assert_eq!(corners[0], DVec2::new(0.0, 165.0));
        assert_eq!(corners[1], DVec2::new(815.0, 65.0));
        assert_eq!(corners[2], DVec2::ZERO);
        assert_eq!(all, DVec2::new(1315.0, 265.0));
        assert_eq!(rows(&[]), (Vec::new(), DVec2::ZERO));
        assert_eq!(rows(&[DVec2::new(2000.0, 5.0)]).1, DVec2::new(2000.0, 5.0));
    }
}
