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
//!
//! A cubic may rise far above all that is wanted: through 0.25, 0.29 and 0.08 at t = 0.32, 0.54 and 0.58 to 0.50. Two
//! contrary threads near each other need that, for only beside a steep rise is the fabric as steep. Where contrary
//! wishes do not come to rest by it, it can be drawn taut: the more it rises, the more is taken of the piecewise cubic that
//! goes through the data, too, rises above none of its neighbours and stays as it is beyond the first and the last
//! (Fritsch & Butland, *A Method for Constructing Local Monotone Piecewise Cubic Interpolants*, 1984). Between the two
//! it changes smoothly, for the data move with the fabric while that is fitted.

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
    /// Eq. (10) drawn taut where it rises far above all data.
    Taut,
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
            Self::Taut => "taut",
        }
    }
}

/// The warp strain distribution function ε(t).
#[derive(Debug, Clone, PartialEq)]
pub struct StrainFunction {
    form: StrainForm,
    spline: Spline,
    /// Another through the same data, and how much of it is taken.
    taut: Option<(f64, Monotone)>,
    max_strain: f64,
}

/// A clamped cubic B-spline.
#[derive(Debug, Clone, PartialEq)]
struct Spline {
    /// Full knot vector, with the end knots four times.
    knots: Vec<f64>,
    control: Vec<f64>,
}

impl Spline {
    fn at(&self, t: f64) -> f64 {
        let basis = basis(&self.knots, t, self.control.len());
        basis.iter().zip(&self.control).map(|(b, c)| b * c).sum()
    }

    /// By what share it rises above the greatest datum.
    fn rise(&self, data: &[Datum]) -> f64 {
        /// Places to a span at which it is looked at.
        const PLACES: usize = 16;
        let wanted = data.iter().map(|d| d.strain).fold(0.0, f64::max);
        if wanted == 0.0 {
            return 0.0;
        }
        let spans = self.knots.windows(2).filter(|span| span[1] > span[0]);
        let places = spans.flat_map(|span| {
            (0..=PLACES).map(|k| span[0] + (span[1] - span[0]) * k as f64 / PLACES as f64)
        });
        places.map(|t| self.at(t)).fold(wanted, f64::max) / wanted - 1.0
    }
}

/// A piecewise cubic through data that is monotone between any two.
#[derive(Debug, Clone, PartialEq)]
struct Monotone {
    data: Vec<Datum>,
    /// Its derivatives there.
    slopes: Vec<f64>,
}

impl Monotone {
    fn new(data: &[Datum]) -> Self {
        let secant = |pair: &[Datum]| (pair[1].strain - pair[0].strain) / (pair[1].t - pair[0].t);
        let inner = data.windows(3).map(|three| {
            let (before, after) = (secant(&three[..2]), secant(&three[1..]));
            if before * after <= 0.0 {
                return 0.0;
            }
            let [h, k] = [three[1].t - three[0].t, three[2].t - three[1].t];
            3.0 * (h + k) / ((2.0 * k + h) / before + (k + 2.0 * h) / after)
        });
        let slopes = std::iter::once(0.0).chain(inner).chain(std::iter::once(0.0)).collect();
        Self { data: data.to_vec(), slopes }
    }

    fn at(&self, t: f64) -> f64 {
        let k = self.data.partition_point(|d| d.t <= t);
        let (Some(before), Some(after)) = (k.checked_sub(1), self.data.get(k)) else {
            return self.data[k.saturating_sub(1)].strain;
        };
        let (before, slopes) = (&self.data[before], [self.slopes[k - 1], self.slopes[k]]);
        let width = after.t - before.t;
        let s = (t - before.t) / width;
        // Hermite's.
        let rise = s * s * (3.0 - 2.0 * s);
        let bends = [s * (1.0 - s).powi(2), s * s * (s - 1.0)];
        before.strain
            + rise * (after.strain - before.strain)
            + width * (bends[0] * slopes[0] + bends[1] * slopes[1])
    }
}

/// One drawn taut may rise above the greatest datum by this share; of one that rises by the second nothing is taken.
const RISES: [f64; 2] = [0.25, 0.5];

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
        Self::through(data, max_strain, closest, false)
    }

    /// The same, drawn taut where it would rise far above all data.
    #[must_use]
    pub fn taut(data: &[Datum], max_strain: f64, closest: f64) -> Self {
        Self::through(data, max_strain, closest, true)
    }

    fn through(data: &[Datum], max_strain: f64, closest: f64, taut: bool) -> Self {
        let data: Vec<Datum> = data
            .iter()
            .map(|d| Datum { t: d.t, strain: d.strain.clamp(0.0, max_strain) })
            .collect();
        // Rows are whole numbers of cells apart: equal is equal but for rounding.
        let crowded = data.windows(2).any(|pair| pair[1].t - pair[0].t < closest * (1.0 + 1e-9));
        let constant = |strain| Spline { knots: clamped(&[]), control: vec![strain; 4] };
        let (form, spline, taut) = match data.as_slice() {
            [] => (StrainForm::Zero, constant(0.0), None),
            [one] => (StrainForm::Constant, constant(one.strain), None),
            _ if crowded => {
                (StrainForm::Smoothed, Self::smoothed(&data, max_strain, closest), None)
            }
            _ => {
                let spline = Self::interpolating(&data);
                let [some, all] = RISES;
                let rise = if taut { spline.rise(&data) } else { 0.0 };
                let share = ((rise - some) / (all - some)).clamp(0.0, 1.0);
                if share > 0.0 {
                    let share = share * share * (3.0 - 2.0 * share);
                    (StrainForm::Taut, spline, Some((share, Monotone::new(&data))))
                } else if spline.control.iter().all(|&c| c >= 0.0) {
                    (StrainForm::Squared, spline, None)
                } else {
                    (StrainForm::Floored, spline, None)
                }
            }
        };
        Self { form, spline, taut, max_strain }
    }

    fn interpolating(data: &[Datum]) -> Spline {
        let inner: Vec<f64> = data[1..data.len() - 1].iter().map(|d| d.t).collect();
        let knots = clamped(&inner);
        let free = data.len();
        let matrix =
            Mat::from_fn(free, free, |row, column| flat_ended(&knots, data[row].t, free)[column]);
        let right = Mat::from_fn(free, 1, |row, _| data[row].strain);
        let solution = matrix.partial_piv_lu().solve(&right);
        let control = with_flat_ends((0..free).map(|k| solution[(k, 0)]).collect());
        Spline { knots, control }
    }

    fn smoothed(data: &[Datum], max_strain: f64, closest: f64) -> Spline {
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
        Spline { knots, control: with_flat_ends(control) }
    }

    /// ε(t), always in [0, max_strain]; t outside [0, 1] takes the end's value.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        self.unbounded(t.clamp(0.0, 1.0)).clamp(0.0, self.max_strain)
    }

    /// The function before it is held in its range.
    fn unbounded(&self, t: f64) -> f64 {
        let value = self.spline.at(t);
        self.taut.as_ref().map_or(value, |(share, taut)| value + share * (taut.at(t) - value))
    }

    /// Which form was used.
    #[must_use]
    pub fn form(&self) -> StrainForm {
        self.form
    }

    /// The function as polynomials between its knots, for many evaluations with derivatives.
    #[must_use]
    pub fn course(&self) -> StrainCourse {
        let further = self.taut.iter().flat_map(|(_, taut)| taut.data.iter().map(|d| d.t));
        let mut breaks: Vec<f64> = self.spline.knots.iter().copied().chain(further).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let pieces = breaks
            .windows(2)
            .map(|span| {
                let (low, width) = (span[0], span[1] - span[0]);
                // A cubic is given by four values; at thirds of the span, by Newton's differences.
                let [a, b, c, d] =
                    [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|s| self.unbounded(low + s * width));
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
    fn a_function_that_would_rise_far_above_all_data_is_drawn_taut_through_them() {
        // The cubic alone rises to 0.50 between the first two, and to the fabric's limit beyond the first.
        for wanted in [
            vec![(0.324, 0.248), (0.545, 0.286), (0.581, 0.084)],
            vec![(0.6, 0.114), (0.69, 0.055), (0.75, 0.103), (0.83, 0.142)],
        ] {
            let f = StrainFunction::taut(&data(&wanted), 0.5, 0.03);
            assert_eq!(f.form(), StrainForm::Taut);
            for (t, strain) in &wanted {
                assert!((f.at(*t) - strain).abs() < 1e-12);
            }
            let greatest = wanted.iter().map(|(_, strain)| *strain).fold(0.0, f64::max);
            let most = (0..=1000).map(|k| f.at(f64::from(k) / 1000.0)).fold(0.0, f64::max);
            assert!(most < 1.2 * greatest, "{most} of {greatest}");
        }
        // Monotone between neighbours, and as it is beyond the first and the last.
        let wanted = data(&[(0.2, 0.3), (0.3, 0.1), (0.5, 0.08), (0.8, 0.2)]);
        let taut = Monotone::new(&wanted);
        assert_eq!([taut.at(0.0), taut.at(0.2), taut.at(0.8), taut.at(1.0)], [0.3, 0.3, 0.2, 0.2]);
        for (before, after) in wanted.iter().zip(&wanted[1..]) {
            let course =
                (0..=100).map(|k| taut.at(before.t + (after.t - before.t) * f64::from(k) / 100.0));
            let course: Vec<f64> = course.collect();
            let rises = after.strain > before.strain;
            assert!(course.windows(2).all(|p| if rises { p[1] >= p[0] } else { p[1] <= p[0] }));
        }
    }

    #[test]
    fn from_the_cubic_to_the_taut_function_it_changes_smoothly() {
        let at = |strain: f64| {
            let wanted = data(&[(0.324, 0.248), (0.545, 0.286), (0.581, strain)]);
            let f = StrainFunction::taut(&wanted, 0.5, 0.03);
            (f.form(), (0..=100).map(|k| f.at(f64::from(k) / 100.0)).collect::<Vec<f64>>())
        };
        let mut forms = Vec::new();
        let mut before = at(0.286).1;
        for k in 1..=220 {
            let (form, values) = at(0.286 - 0.001 * f64::from(k));
            let pairs = values.iter().zip(&before);
            let most = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(most < 0.03, "{most} at {k}");
            forms.push(form);
            before = values;
        }
        assert_eq!([forms[0], forms[219]], [StrainForm::Squared, StrainForm::Taut], "{forms:?}");
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
            // Drawn taut, partly and wholly.
            data(&[(0.3, 0.2), (0.5, 0.22), (0.6, 0.13)]),
            data(&[(0.324, 0.248), (0.545, 0.286), (0.581, 0.084)]),
        ] {
            let f = StrainFunction::taut(&data, 0.5, 0.05);
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
