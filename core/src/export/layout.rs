//! Where lettering goes on a pattern: free places inside the outline.
//!
//! Only the look depends on this, never a cut line.

use glam::DVec2;

use super::drawing::Drawing;

/// A vertical stretch inside the outline: `top.x == bottom.x`, `top.y > bottom.y`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    pub(super) top: DVec2,
    pub(super) bottom: DVec2,
}

/// How far lettering keeps from marks, in mm: two letters' height.
const CLEARANCE: f64 = 10.0;

/// Upright lines that are tried over the width.
const TRIALS: u32 = 32;

/// Smallest box round all that is drawn; zero where nothing is.
pub(super) fn bounds(drawing: &Drawing) -> (DVec2, DVec2) {
    let points = || {
        let sides = drawing.seams.iter().flat_map(|s| s.left.iter().chain(&s.right));
        drawing.outline.iter().flatten().chain(sides)
    };
    let Some(first) = points().next() else { return (DVec2::ZERO, DVec2::ZERO) };
    let marks = drawing.points.iter().map(|(p, _)| p).chain(&drawing.markers);
    points().chain(marks).fold((*first, *first), |(low, high), p| (low.min(*p), high.max(*p)))
}

/// Whether `p` is inside the outer loop and in no cut-out (even-odd rule).
pub(super) fn inside(drawing: &Drawing, p: DVec2) -> bool {
    let crossings = edges(drawing).filter(|(a, b)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossings.count() % 2 == 1
}

/// A long upright stretch inside the outline, away from marks if there is one.
pub(super) fn upright(drawing: &Drawing) -> Option<Stretch> {
    let (low, high) = bounds(drawing);
    let middle = f64::from(TRIALS) / 2.0;
    let mut best: Option<(f64, Stretch)> = None;
    for trial in 1..TRIALS {
        let fraction = f64::from(trial) / f64::from(TRIALS);
        // A hair off the grid, so that no line runs through a vertex at a round coordinate.
        let x = low.x + (high.x - low.x) * (fraction + 1e-7);
        let Some(stretch) = longest_at(drawing, x) else { continue };
        let marks = drawing.points.iter().map(|(p, _)| *p).chain(drawing.markers);
        let crowded = marks.into_iter().any(|p| (p.x - x).abs() < CLEARANCE);
        let length = stretch.top.y - stretch.bottom.y;
        let central = 1.0 - 0.2 * (f64::from(trial) - middle).abs() / middle;
        let score = length * central * if crowded { 0.5 } else { 1.0 };
        if best.is_none_or(|(most, _)| score > most) {
            best = Some((score, stretch));
        }
    }
    best.map(|(_, stretch)| stretch)
}

fn longest_at(drawing: &Drawing, x: f64) -> Option<Stretch> {
    let mut heights: Vec<f64> = edges(drawing)
        .filter(|(a, b)| (a.x > x) != (b.x > x))
        .map(|(a, b)| a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y))
        .collect();
    heights.sort_by(f64::total_cmp);
    let pairs = heights.chunks_exact(2).map(|pair| (pair[0], pair[1]));
    pairs
        .max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0)))
        .map(|(bottom, top)| Stretch { top: DVec2::new(x, top), bottom: DVec2::new(x, bottom) })
}

fn edges(drawing: &Drawing) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    drawing.outline.iter().flat_map(|points| {
        let next = points.iter().skip(1).chain(points.first());
        points.iter().copied().zip(next.copied())
    })
}

/// The place for a label beside a line: its middle, moved inside, and the angle of the line there
/// in degrees, counter-clockwise with y up, such that the text is not upside down.
pub(super) fn beside(drawing: &Drawing, line: &[DVec2], distance: f64) -> Option<(DVec2, f64)> {
    let (middle, direction) = middle(line)?;
    let normal = direction.perp() * distance;
    let place = if inside(drawing, middle + normal) || !inside(drawing, middle - normal) {
        middle + normal
    } else {
        middle - normal
    };
    let angle = direction.y.atan2(direction.x).to_degrees();
    let upright = if angle > 90.0 {
        angle - 180.0
    } else if angle <= -90.0 {
        angle + 180.0
    } else {
        angle
    };
    Some((place, upright))
}

/// The point half-way along a polyline, and the direction of the line about it.
fn middle(line: &[DVec2]) -> Option<(DVec2, DVec2)> {
    let length: f64 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
    let at = |wanted: f64| {
        let mut run = 0.0;
        for w in line.windows(2) {
            let step = w[0].distance(w[1]);
            if run + step >= wanted && step > 0.0 {
                return Some(w[0].lerp(w[1], (wanted - run) / step));
            }
            run += step;
        }
        line.last().copied()
    };
    // The direction over a fifth of the line: single edges zigzag.
    let direction = (at(0.6 * length)? - at(0.4 * length)?).try_normalize()?;
    Some((at(0.5 * length)?, direction))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 80 × 60 mm with a hole of 20 × 20 mm in its middle.
    fn plate() -> Drawing {
        let rectangle = |x0: f64, y0: f64, x1: f64, y1: f64| {
            vec![DVec2::new(x0, y0), DVec2::new(x1, y0), DVec2::new(x1, y1), DVec2::new(x0, y1)]
        };
        let mut hole = rectangle(30.0, 20.0, 50.0, 40.0);
        hole.reverse();
        Drawing {
            outline: vec![rectangle(0.0, 0.0, 80.0, 60.0), hole],
            markers: [DVec2::new(10.0, 55.0), DVec2::new(10.0, 5.0)],
            ..Drawing::default()
        }
    }

    #[test]
    fn inside_excludes_the_hole() {
        assert!(inside(&plate(), DVec2::new(10.0, 30.0)));
        assert!(!inside(&plate(), DVec2::new(40.0, 30.0)));
        assert!(!inside(&plate(), DVec2::new(-1.0, 30.0)));
    }

    #[test]
    fn the_upright_runs_over_the_full_height_beside_hole_and_markers() {
        let stretch = upright(&plate()).unwrap();
        assert!((stretch.top.y - stretch.bottom.y - 60.0).abs() < 1e-9);
        assert!(stretch.top.x > 50.0 && stretch.top.x < 80.0, "{stretch:?}");
    }

    #[test]
    fn a_label_stands_inside_and_is_not_upside_down() {
        let side = [DVec2::new(80.0, 60.0), DVec2::new(80.0, 0.0)];
        let (place, angle) = beside(&plate(), &side, 4.0).unwrap();
        assert!(place.distance(DVec2::new(76.0, 30.0)) < 1e-9, "{place}");
        assert!((angle - 90.0).abs() < 1e-9, "{angle}");
        let level = [DVec2::new(80.0, 0.0), DVec2::new(0.0, 0.0)];
        let (place, angle) = beside(&plate(), &level, 4.0).unwrap();
        assert!(place.distance(DVec2::new(40.0, 4.0)) < 1e-9, "{place}");
        assert!(angle.abs() < 1e-9, "{angle}");
    }

    #[test]
    fn nothing_to_draw_has_no_bounds_and_no_upright() {
        assert_eq!(bounds(&Drawing::default()), (DVec2::ZERO, DVec2::ZERO));
        assert_eq!(upright(&Drawing::default()), None);
        assert_eq!(beside(&Drawing::default(), &[DVec2::ONE, DVec2::ONE], 1.0), None);
    }
}
