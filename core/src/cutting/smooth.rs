//! Smooths an edge within a stated tolerance: what a knife follows without a tremble.
//!
//! The edge's points are moved to the cubic smoothing spline through them (Reinsch, *Smoothing by
//! spline functions*, 1967), parameterized by chord length, ends held fast: of all curves with the
//! same sum of squared distances the least bent. Its one number is the largest for which no point
//! moves more than [`TOLERANCE`] and the length stays what it was. Limit: roughness beyond the
//! tolerance, as of the torn rim of a scan, stays.

use glam::DVec2;

use super::edges::length;

/// Farthest that a point of the outline is moved, in mm.
pub const TOLERANCE: f64 = 0.1;

/// Most by which the length of an edge may change, in mm.
pub const LENGTH_TOLERANCE: f64 = 0.02;

/// An edge turns a corner where it turns by more than this, in degrees: corners are not smoothed.
const CORNER: f64 = 30.0;

/// Powers of ten of the spline's number: below nothing moves, above all is straight.
const POWERS: [f64; 2] = [-6.0, 9.0];

/// Halvings of that range.
const HALVINGS: usize = 24;

/// The edge, smoothed between its corners. It has as many points as before.
#[must_use]
pub fn smooth(points: &[DVec2]) -> Vec<DVec2> {
    let mut smoothed = points.to_vec();
    let mut start = 0;
    for end in corners(points) {
        let part = spline_within(&points[start..=end]);
        smoothed[start..=end].copy_from_slice(&part);
        start = end;
    }
    smoothed
}

/// The corners of a line after its start, its end included.
fn corners(points: &[DVec2]) -> Vec<usize> {
    let sharp = CORNER.to_radians().cos();
    let turns = points.windows(3).enumerate().filter(|(_, p)| {
        let directions = (p[1] - p[0]).try_normalize().zip((p[2] - p[1]).try_normalize());
        directions.is_some_and(|(before, after)| before.dot(after) < sharp)
    });
    let mut corners: Vec<usize> = turns.map(|(i, _)| i + 1).collect();
    corners.extend(points.len().checked_sub(1).filter(|&last| last > 0));
    corners
}

fn spline_within(points: &[DVec2]) -> Vec<DVec2> {
    let before = length(points);
    let fits = |moved: &[DVec2]| {
        points.iter().zip(moved).all(|(p, q)| p.distance(*q) <= TOLERANCE)
            && (length(moved) - before).abs() <= LENGTH_TOLERANCE
    };
    let [mut low, mut high] = POWERS;
    let mut best = points.to_vec();
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match spline(points, 10f64.powf(middle)).filter(|moved| fits(moved)) {
            Some(moved) => {
                best = moved;
                low = middle;
            }
            None => high = middle,
        }
    }
    best
}

/// The values at the knots of the smoothing spline with this number; `None` where two points are one.
fn spline(points: &[DVec2], number: f64) -> Option<Vec<DVec2>> {
    let n = points.len();
    if n < 3 {
        return Some(points.to_vec());
    }
    let step: Vec<f64> = points.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    if step.iter().any(|h| *h < 1e-9) {
        return None;
    }
    // Reinsch: (R + λ Qᵀ W Q) γ = Qᵀ y, f = y − λ W Q γ; W is 0 at both ends, so they stay.
    let inner = n - 2;
    let column = |j: usize| {
        let (before, after) = (1.0 / step[j], 1.0 / step[j + 1]);
        [before, -before - after, after]
    };
    let weight = |i: usize| if i == 0 || i == n - 1 { 0.0 } else { 1.0 };
    // The symmetric matrix by its diagonal and the two above.
    let mut band = vec![[0.0; 3]; inner];
    for j in 0..inner {
        let q = column(j);
        for (offset, entry) in band[j].iter_mut().enumerate().take((inner - j).min(3)) {
            let p = column(j + offset);
            let product: f64 = (offset..3).map(|k| weight(j + k) * q[k] * p[k - offset]).sum();
            *entry = number * product;
        }
        band[j][0] += (step[j] + step[j + 1]) / 3.0;
        if j + 1 < inner {
            band[j][1] += step[j + 1] / 6.0;
        }
    }
    let mut gamma: Vec<DVec2> = (0..inner)
        .map(|j| (0..3).map(|k| column(j)[k] * points[j + k]).fold(DVec2::ZERO, |a, b| a + b))
        .collect();
    solve(&mut band, &mut gamma);
    let mut moved = points.to_vec();
    for (j, gamma) in gamma.iter().enumerate() {
        for (k, q) in column(j).into_iter().enumerate() {
            moved[j + k] -= number * weight(j + k) * q * *gamma;
        }
    }
    moved.iter().all(|p| p.is_finite()).then_some(moved)
}

/// Solves a symmetric positive definite system of bandwidth two, L D Lᵀ.
fn solve(band: &mut [[f64; 3]], right: &mut [DVec2]) {
    let n = band.len();
    for j in 0..n {
        let [pivot, one, two] = band[j];
        let (l1, l2) = (one / pivot, two / pivot);
        if j + 1 < n {
            band[j + 1][0] -= l1 * one;
            band[j + 1][1] -= l1 * two;
            let r = right[j];
            right[j + 1] -= l1 * r;
        }
        if j + 2 < n {
            band[j + 2][0] -= l2 * two;
            let r = right[j];
            right[j + 2] -= l2 * r;
        }
        band[j][1] = l1;
        band[j][2] = l2;
    }
    for j in (0..n).rev() {
        let mut value = right[j] / band[j][0];
        if j + 1 < n {
            value -= band[j][1] * right[j + 1];
        }
        if j + 2 < n {
            value -= band[j][2] * right[j + 2];
        }
        right[j] = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sum of squared turning angles.
    fn tremble(points: &[DVec2]) -> f64 {
        let turn = |p: &[DVec2]| (p[1] - p[0]).angle_to(p[2] - p[1]);
        points.windows(3).map(|p| turn(p).powi(2)).sum()
    }

    #[test]
    fn a_trembling_arc_becomes_calm_within_the_tolerance_and_keeps_its_length() {
        // Radius 200 mm, points every 3 mm, 0.015 mm to and fro.
        let arc: Vec<DVec2> = (0..80)
            .map(|i| {
                let radius = 200.0 + 0.015 * [1.0, -1.0][i % 2];
                radius * DVec2::from_angle(0.015 * i as f64)
            })
            .collect();
        let calm = smooth(&arc);
        assert_eq!((calm[0], calm[79]), (arc[0], arc[79]));
        let moved = arc.iter().zip(&calm).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        assert!(moved > 0.01 && moved <= TOLERANCE, "{moved}");
        assert!((length(&calm) - length(&arc)).abs() <= LENGTH_TOLERANCE);
        // A true arc of 80 points turns by 0.015 at each: 0.0176.
        assert!(tremble(&arc) > 0.04 && tremble(&calm) < 0.0185, "{}", tremble(&calm));
    }

    #[test]
    fn a_corner_stays_sharp_and_a_straight_line_stays() {
        let mut line: Vec<DVec2> = (0..=20).map(|i| DVec2::new(f64::from(i), 0.0)).collect();
        line.extend((1..=20).map(|i| DVec2::new(20.0, f64::from(i))));
        for (p, q) in line.iter().zip(smooth(&line)) {
            assert!(p.distance(q) < 1e-9, "{p} {q}");
        }
    }

    #[test]
    fn doubled_points_and_short_lines_are_left_as_they_are() {
        let doubled = [(0.0, 0.0), (1.0, 0.1), (1.0, 0.1), (2.0, 0.0)].map(DVec2::from);
        assert_eq!(smooth(&doubled), doubled);
        assert_eq!(smooth(&doubled[..2]), doubled[..2]);
        assert_eq!(smooth(&doubled[..1]), doubled[..1]);
    }

    #[test]
    fn the_band_is_solved_as_by_hand() {
        // [2 1 0; 1 3 1; 0 1 2] x = [4, 10, 8] has x = (1, 2, 3).
        let mut band = [[2.0, 1.0, 0.0], [3.0, 1.0, 0.0], [2.0, 0.0, 0.0]];
        let mut right = [4.0, 10.0, 8.0].map(DVec2::splat);
        solve(&mut band, &mut right);
        for (got, wanted) in right.iter().zip([1.0, 2.0, 3.0]) {
            assert!((got.x - wanted).abs() < 1e-12 && got.x == got.y, "{got}");
        }
    }
}
