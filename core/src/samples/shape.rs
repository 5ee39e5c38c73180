//! What limbs are shaped with: elliptic sections along the limb, and muscles, bones and hollows as
//! smooth bumps on them.

use glam::DVec2;

/// A muscle, bone, crease or hollow: a Gaussian along the limb, its periodic kin round it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bump {
    /// How far it stands out, in mm; negative for a hollow.
    pub(super) height: f64,
    /// Its middle along the limb, in mm.
    pub(super) station: f64,
    /// Its half width along the limb (one deviation), in mm.
    pub(super) long: f64,
    /// Its middle round the limb, in radians.
    pub(super) angle: f64,
    /// Its half width round the limb (one deviation), in radians.
    pub(super) wide: f64,
}

impl Bump {
    /// How far it stands out at a place, in mm.
    pub(super) fn at(&self, station: f64, angle: f64) -> f64 {
        let along = 0.5 * ((station - self.station) / self.long).powi(2);
        // The periodic Gaussian (von Mises): smooth all the way round.
        let round = (1.0 - (angle - self.angle).cos()) / self.wide.powi(2);
        self.height * (-along - round).exp()
    }
}

/// How far all bumps together stand out at a place, in mm.
pub(super) fn relief(bumps: &[Bump], station: f64, angle: f64) -> f64 {
    bumps.iter().map(|bump| bump.at(station, angle)).sum()
}

/// The share of a bend that lies behind a station, from 0 to 1, for one that is tightest at
/// `middle` and eases out over the length `ease` on both sides, in mm: a tanh. Its tightest
/// radius is 2 · `ease` / angle.
pub(super) fn bent(station: f64, middle: f64, ease: f64) -> f64 {
    0.5 * (1.0 + ((station - middle) / ease).tanh())
}

/// The share of a bend that lies behind a station, from 0 to 1, for one of even curvature over
/// `half` on both sides of the middle, with ends eased over `ease`, in mm: a box convolved with
/// the derivative of a tanh. Its tightest radius is close to 2 · `half` / angle.
pub(super) fn evenly_bent(station: f64, middle: f64, half: f64, ease: f64) -> f64 {
    // ln cosh x without overflow.
    let log_cosh = |x: f64| x.abs() + (-2.0 * x.abs()).exp().ln_1p() - std::f64::consts::LN_2;
    let from = station - middle;
    let share = ease * (log_cosh((from + half) / ease) - log_cosh((from - half) / ease));
    0.5 + share / (4.0 * half)
}

/// Elliptic sections along a limb.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sections {
    /// Distance between two rows, in mm; the first is at station 0.
    pub(super) step: f64,
    /// How far the skin is from the centre line in mm: front, outer side, back, inner side. They
    /// are the control points of uniform cubic B-splines: the limb's curvature is continuous and
    /// nothing overshoots.
    pub(super) rows: &'static [[f64; 4]],
}

impl Sections {
    /// The skin from the centre line (front, outer side) in mm, moved out by `relief` along the
    /// ellipse's normal. The angle is the ellipse's own: 0 front, π/2 outer side.
    pub(super) fn at(&self, station: f64, angle: f64, relief: f64) -> DVec2 {
        let [front, outer, back, inner] = self.distances(station);
        let middle = 0.5 * DVec2::new(front - back, outer - inner);
        let half = 0.5 * DVec2::new(front + back, outer + inner);
        let (sin, cos) = angle.sin_cos();
        let normal = DVec2::new(half.y * cos, half.x * sin).normalize();
        middle + half * DVec2::new(cos, sin) + relief * normal
    }

    fn distances(&self, station: f64) -> [f64; 4] {
        let last = self.rows.len() as f64 - 1.0;
        let place = station / self.step;
        let cell = place.floor();
        let t = place - cell;
        let weights = [
            (1.0 - t).powi(3),
            3.0 * t.powi(3) - 6.0 * t.powi(2) + 4.0,
            -3.0 * t.powi(3) + 3.0 * t.powi(2) + 3.0 * t + 1.0,
            t.powi(3),
        ];
        let mut sum = [0.0; 4];
        for (k, weight) in weights.into_iter().enumerate() {
            let row = (cell + k as f64 - 1.0).clamp(0.0, last) as usize;
            for (sum, distance) in sum.iter_mut().zip(self.rows[row]) {
                *sum += weight * distance / 6.0;
            }
        }
        sum
    }
}
