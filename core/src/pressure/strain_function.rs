//! The warp strain distribution function ε(t) (section 5.1 of the paper).
//!
//! A clamped cubic B-spline over t in [0, 1], the row's place between the first and the last row,
//! flat at both ends. With l data it has n = l + 2 control points (Eq. 10), the end slopes giving
//! the two equations more; with all control points at or above zero they are squares Q_i² and the
//! function is never negative (Eq. 11). If some would be negative, Eq. (11) cannot interpolate and
//! Eq. (10) is floored at zero, as the paper says.
//!
//! The paper leaves the knots open. They are the inner data sites t_2 … t_{l−1}, so that every
//! control point has a datum under its basis function and the equations can always be solved
//! (Schoenberg & Whitney 1953; Piegl & Tiller, *The NURBS Book*, 2nd ed., section 9.2).
//!
//! Data closer than a stated spacing cannot be interpolated in earnest: 0.01 and 0.24 at t = 0.48 and
//! 0.50 make an interpolating cubic swing from −1.15 to 1.35. They are fitted by least squares with
//! penalised differences of the control points (Eilers & Marx, *P-splines*, 1996), and the
//! residual is shown.

use faer::Mat;
use faer::linalg::solvers::Solve;

/// A strain that the function should take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// Where, in [0, 1].
    pub t: f64,
    /// Wanted strain.
    pub strain: f64,
}

/// Which form of the function was used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrainForm {
    /// No data: zero.
    Zero,
    /// One datum: constant.
    Constant,
    /// Eq. (11): squares, never negative.
    Squared,
    /// Eq. (10) floored at zero.
    Floored,
    /// Smoothed least squares; data are not met exactly.
    Smoothed,
}

impl StrainForm {
    /// A short name for reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Zero => "zero",
            Self::Constant => "constant",
            Self::Squared => "squared",
            Self::Floored => "floored",
            Self::Smoothed => "smoothed",
        }
    }
}

/// The warp strain distribution function ε(t).
#[derive(Debug, Clone, PartialEq)]
pub struct StrainFunction {
    form: StrainForm,
    /// Full knot vector, with the end knots four times.
    knots: Vec<f64>,
    control: Vec<f64>,
    max_strain: f64,
}

/// Weight of a squared first difference of the control points against a squared residual. A penalty
/// on first differences draws the curve taut between the data, so that it does not swing beyond
/// them (one on second differences does); small enough that single data are met within a few per
/// cent, see the test on 0.01 and 0.24.
const SMOOTHING: f64 = 0.1;

impl StrainFunction {
    /// The function through (or near) the data, which must be sorted by t without repetition and lie
    /// in [0, 1]; strains are taken into [0, `max_strain`] first.
    ///
    /// Data at a distance in t of `closest` or less are smoothed, not interpolated.
    #[must_use]
    pub fn new(data: &[Datum], max_strain: f64, closest: f64) -> Self {
        let data: Vec<Datum> = data
            .iter()
            .map(|d| Datum { t: d.t, strain: d.strain.clamp(0.0, max_strain) })
            .collect();
        // Rows are whole numbers of cells apart: equal is equal but for rounding.
        let crowded = data.windows(2).any(|pair| pair[1].t - pair[0].t < closest * (1.0 + 1e-9));
        match data.as_slice() {
            [] => Self::with_control(StrainForm::Zero, clamped(&[]), vec![0.0; 4], max_strain),
            [one] => Self::with_control(
                StrainForm::Constant,
                clamped(&[]),
                vec![one.strain; 4],
                max_strain,
            ),
            _ if crowded => Self::smoothed(&data, max_strain, closest),
            _ => Self::interpolating(&data, max_strain),
        }
    }

    fn with_control(form: StrainForm, knots: Vec<f64>, control: Vec<f64>, max_strain: f64) -> Self {
        Self { form, knots, control, max_strain }
    }

    fn interpolating(data: &[Datum], max_strain: f64) -> Self {
        let inner: Vec<f64> = data[1..data.len() - 1].iter().map(|d| d.t).collect();
        let knots = clamped(&inner);
        let free = data.len();
        let matrix =
            Mat::from_fn(free, free, |row, column| flat_ended(&knots, data[row].t, free)[column]);
        let right = Mat::from_fn(free, 1, |row, _| data[row].strain);
        let solution = matrix.partial_piv_lu().solve(&right);
        let control = with_flat_ends((0..free).map(|k| solution[(k, 0)]).collect());
        let form = if control.iter().all(|&c| c >= 0.0) {
            StrainForm::Squared
        } else {
            StrainForm::Floored
        };
        Self::with_control(form, knots, control, max_strain)
    }

    fn smoothed(data: &[Datum], max_strain: f64, closest: f64) -> Self {
        // One span for every `closest`, but no more than can be told apart and no fewer than make
        // a curve.
        let spans = (1.0 / closest).floor().clamp(2.0, 60.0) as usize;
        let inner: Vec<f64> = (1..spans).map(|k| k as f64 / spans as f64).collect();
        let knots = clamped(&inner);
        let free = spans + 1;
        let mut normal = Mat::<f64>::zeros(free, free);
        let mut right = Mat::<f64>::zeros(free, 1);
        for datum in data {
            let basis = flat_ended(&knots, datum.t, free);
            for a in 0..free {
                right[(a, 0)] += basis[a] * datum.strain;
                for b in 0..free {
                    normal[(a, b)] += basis[a] * basis[b];
                }
            }
        }
        for k in 1..free {
            for (a, da) in [(k - 1, -1.0), (k, 1.0)] {
                for (b, db) in [(k - 1, -1.0), (k, 1.0)] {
                    normal[(a, b)] += SMOOTHING * da * db;
                }
            }
        }
        let solution = normal.partial_piv_lu().solve(&right);
        // Basis functions are never negative and sum to one: control points in the range keep the
        // function in it.
        let control = (0..free).map(|k| solution[(k, 0)].clamp(0.0, max_strain)).collect();
        Self::with_control(StrainForm::Smoothed, knots, with_flat_ends(control), max_strain)
    }

    /// ε(t), always in [0, max_strain]; t outside [0, 1] takes the end's value.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let basis = basis(&self.knots, t.clamp(0.0, 1.0), self.control.len());
        let value: f64 = basis.iter().zip(&self.control).map(|(b, c)| b * c).sum();
        value.clamp(0.0, self.max_strain)
    }

    /// Which form was used.
    #[must_use]
    pub fn form(&self) -> StrainForm {
        self.form
    }

    /// The function as polynomials between its knots, for many evaluations with derivatives.
    #[must_use]
    pub fn course(&self) -> StrainCourse {
        let mut breaks = self.knots.clone();
        breaks.dedup();
        let control = self.control.len();
        let pieces = breaks
            .windows(2)
            .map(|span| {
                let (low, width) = (span[0], span[1] - span[0]);
                // A cubic is given by four values; at thirds of the span, by Newton's differences.
                let [a, b, c, d] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|s| {
                    let basis = basis(&self.knots, low + s * width, control);
                    basis.iter().zip(&self.control).map(|(b, c)| b * c).sum::<f64>()
                });
                let third = 4.5 * (d - 3.0 * c + 3.0 * b - a);
                let second = 4.5 * (c - 2.0 * b + a) - third;
                let first = d - a - second - third;
                [a, first / width, second / width.powi(2), third / width.powi(3)]
            })
            .collect();
        // Four cells to a piece of even length.
        let cells = 4 * (breaks.len() - 1);
        let first = (0..cells)
            .map(|cell| breaks[1..].partition_point(|&b| b <= cell as f64 / cells as f64))
            .collect();
        StrainCourse { breaks, pieces, first, max_strain: self.max_strain }
    }
}

/// A strain function as polynomials; see [`StrainFunction::course`].
#[derive(Debug, Clone, PartialEq)]
pub struct StrainCourse {
    breaks: Vec<f64>,
    /// Coefficients of 1, s, s², s³ with s from the piece's beginning.
    pieces: Vec<[f64; 4]>,
    /// The piece at the beginning of each of so many even cells.
    first: Vec<usize>,
    max_strain: f64,
}

impl StrainCourse {
    /// ε(t) and ε'(t). Beyond the ends, and where the function is held at zero or at the
    /// fabric's limit, it is constant.
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 2] {
        let inside = t.clamp(0.0, 1.0);
        let last = self.pieces.len() - 1;
        let cell = (inside * self.first.len() as f64) as usize;
        let mut k = self.first.get(cell).map_or(last, |&k| k.min(last));
        while k < last && self.breaks[k + 1] <= inside {
            k += 1;
        }
        let s = inside - self.breaks[k];
        let [a, b, c, d] = self.pieces[k];
        let value = a + s * (b + s * (c + s * d));
        if value <= 0.0 || value >= self.max_strain || t != inside {
            return [value.clamp(0.0, self.max_strain), 0.0];
        }
        [value, b + s * (2.0 * c + s * 3.0 * d)]
    }
}

/// The clamped cubic knot vector with these inner knots.
fn clamped(inner: &[f64]) -> Vec<f64> {
    let mut knots = vec![0.0; 4];
    knots.extend_from_slice(inner);
    knots.extend([1.0; 4]);
    knots
}

/// Control points whose first two and last two agree: slope zero at both ends.
fn with_flat_ends(free: Vec<f64>) -> Vec<f64> {
    let (first, last) = (free[0], free[free.len() - 1]);
    std::iter::once(first).chain(free).chain(std::iter::once(last)).collect()
}

/// The basis after tying the first two and the last two control points together.
fn flat_ended(knots: &[f64], t: f64, free: usize) -> Vec<f64> {
    let full = basis(knots, t, free + 2);
    let mut tied = full[1..=free].to_vec();
    tied[0] += full[0];
    tied[free - 1] += full[free + 1];
    tied
}

/// Cubic B-spline basis functions at t by the Cox–de Boor recursion.
fn basis(knots: &[f64], t: f64, count: usize) -> Vec<f64> {
    const DEGREE: usize = 3;
    // The span of t; the last one is closed.
    let span = (DEGREE..count).rev().find(|&k| t >= knots[k]).unwrap_or(DEGREE);
    let mut values = vec![0.0; count + DEGREE];
    values[span] = 1.0;
    for degree in 1..=DEGREE {
        for k in span.saturating_sub(degree)..=span {
            let part = |k: usize, rising: bool| {
                let width = knots[k + degree] - knots[k];
                if width <= 0.0 {
                    0.0
                } else if rising {
                    (t - knots[k]) / width
                } else {
                    (knots[k + degree] - t) / width
                }
            };
            values[k] = part(k, true) * values[k]
                + if k < span { part(k + 1, false) * values[k + 1] } else { 0.0 };
        }
    }
    values.truncate(count);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data(pairs: &[(f64, f64)]) -> Vec<Datum> {
        pairs.iter().map(|&(t, strain)| Datum { t, strain }).collect()
    }

    fn slope(f: &StrainFunction, t: f64) -> f64 {
        (f.at(t + 1e-6) - f.at(t - 1e-6)) / 2e-6
    }

    #[test]
    fn no_datum_is_zero_and_one_is_constant() {
        let zero = StrainFunction::new(&[], 0.5, 0.05);
        assert_eq!((zero.form(), zero.at(0.3)), (StrainForm::Zero, 0.0));
        let one = StrainFunction::new(&data(&[(0.4, 0.17)]), 0.5, 0.05);
        assert_eq!(one.form(), StrainForm::Constant);
        for t in [0.0, 0.4, 1.0] {
            assert!((one.at(t) - 0.17).abs() < 1e-15);
        }
    }

    #[test]
    fn two_data_at_the_ends_make_the_cubic_smoothstep() {
        // Four control points a, a, b, b over one span: a + (b − a)(3 t² − 2 t³).
        let f = StrainFunction::new(&data(&[(0.0, 0.1), (1.0, 0.3)]), 0.5, 0.05);
        assert_eq!(f.form(), StrainForm::Squared);
        for t in [0.0f64, 0.2, 0.5, 0.9, 1.0] {
            let by_hand = 0.1 + 0.2 * (3.0 * t * t - 2.0 * t.powi(3));
            assert!((f.at(t) - by_hand).abs() < 1e-12, "{t}");
        }
    }

    #[test]
    fn data_are_met_and_the_ends_are_flat() {
        let wanted = [(0.1, 0.05), (0.3, 0.2), (0.55, 0.12), (0.9, 0.3)];
        let f = StrainFunction::new(&data(&wanted), 0.5, 0.05);
        for (t, strain) in wanted {
            assert!((f.at(t) - strain).abs() < 1e-12);
        }
        assert!(slope(&f, 1e-6).abs() < 1e-3 && slope(&f, 1.0 - 1e-6).abs() < 1e-3);
    }

    #[test]
    fn high_near_zero_high_is_floored_at_zero() {
        let wanted = [(0.1, 0.3), (0.45, 0.0), (0.55, 0.0), (0.9, 0.3)];
        let f = StrainFunction::new(&data(&wanted), 0.5, 0.05);
        assert_eq!(f.form(), StrainForm::Floored);
        for k in 0..=100 {
            let value = f.at(f64::from(k) / 100.0);
            assert!((0.0..=0.5).contains(&value));
        }
        assert!(f.at(0.5) < 1e-12);
    }

    #[test]
    fn strains_close_together_do_not_swing() {
        let wanted = [(0.1, 0.1), (0.48, 0.01), (0.50, 0.24), (0.9, 0.1)];
        let f = StrainFunction::new(&data(&wanted), 0.5, 10.0 / 220.0);
        assert_eq!(f.form(), StrainForm::Smoothed);
        for k in 0..=1000 {
            let value = f.at(f64::from(k) / 1000.0);
            assert!((0.0..0.30).contains(&value), "{value} at {k}");
        }
        // The two cannot both be met; single data are.
        assert!((f.at(0.48) - 0.01) > 0.02 && (0.24 - f.at(0.50)) > 0.02);
        assert!((f.at(0.1) - 0.1).abs() < 0.01 && (f.at(0.9) - 0.1).abs() < 0.01);
    }

    #[test]
    fn a_painted_field_is_followed() {
        let wanted: Vec<Datum> = (0..=44)
            .map(|k| f64::from(k) / 44.0)
            .map(|t| Datum { t, strain: 0.15 + 0.05 * (6.0 * t).sin() })
            .collect();
        let f = StrainFunction::new(&wanted, 0.5, 10.0 / 220.0);
        assert_eq!(f.form(), StrainForm::Smoothed);
        for d in &wanted[2..43] {
            assert!((f.at(d.t) - d.strain).abs() < 0.005, "{} {}", f.at(d.t), d.strain);
        }
    }

    #[test]
    fn the_course_is_the_function_with_its_slope() {
        let many: Vec<(f64, f64)> =
            (0..=30).map(|k| (f64::from(k) / 30.0, 0.2 + 0.1 * f64::from(k).sin())).collect();
        for data in [
            data(&[(0.1, 0.05), (0.3, 0.2), (0.55, 0.12), (0.9, 0.3)]),
            data(&[(0.0, 0.1), (1.0, 0.3)]),
            data(&[(0.4, 0.2)]),
            data(&[(0.1, 0.3), (0.45, 0.0), (0.55, 0.0), (0.9, 0.3)]),
            data(&many),
        ] {
            let f = StrainFunction::new(&data, 0.5, 0.05);
            let course = f.course();
            for k in 0..=200 {
                let t = f64::from(k) / 200.0;
                assert!((course.at(t)[0] - f.at(t)).abs() < 1e-12, "{t}");
                let inside = (t + 0.0013).min(0.999);
                let [_, first] = course.at(inside);
                let h = 1e-5;
                let [low, high] = [-h, h].map(|h| course.at(inside + h)[0]);
                if low > 0.0 && high > 0.0 {
                    assert!((first - (high - low) / (2.0 * h)).abs() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn nothing_leaves_the_fabrics_range() {
        let f = StrainFunction::new(&data(&[(0.2, 0.9), (0.5, 0.45), (0.8, 0.9)]), 0.5, 0.05);
        for k in 0..=100 {
            assert!((0.0..=0.5).contains(&f.at(f64::from(k) / 100.0)));
        }
        assert!((f.at(0.2) - 0.5).abs() < 1e-12, "0.9 is taken to the limit");
    }
}
