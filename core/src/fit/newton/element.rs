//! The paper's energy of one triangle, with its first and second derivatives.
//!
//! One term of Eq. (4) per woven node means: weighted by area in the pattern. A cell of spacing L has
//! one warp spring, one weft spring and two diagonals; with F = d(worn)/d(pattern) they measure
//! L |F e_x|, L |F e_y| and L |F (e_x ± e_y)|, so that J_E per area of the pattern is
//!
//! W = ½ k_warp (|F e_x| − λ)² + ½ k_weft (|F e_y| − μ)² + ½ k_diag Σ± (|F (e_x ± e_y)| − ρ)²
//!
//! with λ = 1 + ε(t), μ = 1 + ε_weft and ρ = (λ² + μ²)^½ (Eqs. 5–7). The unknowns are the pattern
//! coordinates (x, y), so it is written in their gradients on the worn triangle: with
//! d = det(∇x, ∇y), the area in the pattern is d times the worn one and F e_x = rot ∇y / d,
//! F e_y = rot ∇x / d, F (e_x ± e_y) = rot (∇x ∓ ∇y) / d. Each spring is then a residual
//!
//! r = n / √d − λ √d,  n the length of a combination of ∇x and ∇y,
//!
//! and the triangle's energy ½ A Σ k r², A its worn area. It grows without bound as d goes to 0 and as d
//! goes to infinity, and so keeps triangles from turning over by itself. λ is a function of the
//! triangle's mean weft coordinate c.
//!
//! It has an end, though, where a triangle is pressed together in the pattern; there springs stiffen (`stiffening`).

mod stiffening;

use glam::DVec2;

pub use self::stiffening::energy as stiffening_energy;
use super::eigen::{Square, eigen, negative, positive};
use crate::sparse::Element;

/// Number of local variables: ∇x (2), ∇y (2), c.
pub const LOCAL: usize = 5;

/// Those of them that are gradients' components.
const GRADIENTS: usize = 4;

/// Share of a corner in the triangle's mean weft coordinate.
const THIRD: f64 = 1.0 / 3.0;

/// Stiffness of warp, weft and diagonal springs, in N/mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Springs {
    /// Along warp.
    pub warp: f64,
    /// Along weft.
    pub weft: f64,
    /// Along both diagonals.
    pub diagonal: f64,
}

/// Wanted stretches of a triangle's threads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretches {
    /// λ = 1 + ε, and its derivative along weft, in 1/mm.
    pub warp: [f64; 2],
    /// μ = 1 + ε_weft.
    pub weft: f64,
}

/// Pattern coordinates' gradients on a worn triangle, in its own orthonormal frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gradients {
    /// ∇x.
    pub x: DVec2,
    /// ∇y.
    pub y: DVec2,
}

impl Gradients {
    /// From the gradients of the corners' hat functions (1/mm) and the corners' pattern coordinates.
    pub fn new(hats: &[DVec2; 3], corners: [DVec2; 3]) -> Self {
        let mut g = Self { x: DVec2::ZERO, y: DVec2::ZERO };
        for (hat, p) in hats.iter().zip(corners) {
            g.x += p.x * *hat;
            g.y += p.y * *hat;
        }
        g
    }

    /// Area in the pattern over worn area.
    pub fn determinant(&self) -> f64 {
        self.x.perp_dot(self.y)
    }

    /// Stretches |F e_x| and |F e_y|.
    pub fn stretches(&self) -> [f64; 2] {
        let d = self.determinant();
        [self.y.length() / d, self.x.length() / d]
    }
}

/// A spring: stiffness, the combination α ∇x + β ∇y that it measures, and its wanted stretch with its
/// derivative along weft.
type Spring = (f64, f64, f64, [f64; 2]);

/// The four springs.
fn springs(k: &Springs, wanted: &Stretches) -> [Spring; 4] {
    let [l, l1] = wanted.warp;
    let mu = wanted.weft;
    let rho = (l * l + mu * mu).sqrt();
    let rho1 = l * l1 / rho;
    let diagonal = [rho, rho1];
    [
        (k.warp, 0.0, 1.0, wanted.warp),
        (k.weft, 1.0, 0.0, [mu, 0.0]),
        (k.diagonal, -1.0, 1.0, diagonal),
        (k.diagonal, 1.0, 1.0, diagonal),
    ]
}

/// J_E per worn area, in N/mm; infinite where the triangle is turned over.
pub fn energy(g: &Gradients, k: &Springs, wanted: &Stretches) -> f64 {
    let d = g.determinant();
    if d.is_nan() || d <= 0.0 {
        return f64::INFINITY;
    }
    springs(k, wanted)
        .iter()
        .map(|&(k, alpha, beta, [length, ..])| {
            let n = (alpha * g.x + beta * g.y).length();
            0.5 * k * (n - length * d).powi(2) / d
        })
        .sum()
}

/// Second derivatives of the energy per worn area by ∇x, ∇y and c: Σ k ∂r ∂r, and Σ k r ∂²r if asked for.
/// Lower triangle.
///
/// Of ∂²r what comes from the strain function's slope and curvature is left out: sliding the fabric along
/// the function would have a negative stiffness, where in truth the function slides along with it.
#[derive(Debug, Clone, Copy)]
pub struct Bend([[f64; LOCAL]; LOCAL]);

/// The first derivatives alone, at a triangle that is not turned over.
///
/// ½ k r² is ½ k (n² / d − 2 λ n + λ² d), which has a root less.
pub fn slope(g: &Gradients, k: &Springs, wanted: &Stretches) -> [f64; LOCAL] {
    let d = g.determinant();
    let by_d = 1.0 / d;
    let (mut of_x, mut of_y, mut of_d, mut of_c) = (DVec2::ZERO, DVec2::ZERO, 0.0, 0.0);
    let springs = springs(k, wanted);
    let mut stiffens = false;
    for &(k, alpha, beta, [length, length1]) in &springs {
        let v = alpha * g.x + beta * g.y;
        let n = v.length();
        let pull = k * (by_d - length / n) * v;
        of_x += alpha * pull;
        of_y += beta * pull;
        let stretch = n * by_d;
        of_d += 0.5 * k * (length + stretch) * (length - stretch);
        of_c += k * length1 * (length * d - n);
        stiffens |= stiffening::begins(stretch, length);
    }
    let mut slope = [
        of_x.x + of_d * g.y.y,
        of_x.y - of_d * g.y.x,
        of_y.x - of_d * g.x.y,
        of_y.y + of_d * g.x.x,
        of_c,
    ];
    if stiffens {
        springs.iter().for_each(|spring| stiffening::add_slope(&mut slope, g, spring));
    }
    slope
}

/// First derivatives by the corners' pattern coordinates (x₀, y₀, x₁, …), times the worn area.
pub fn force_at_corners(slope: &[f64; LOCAL], hats: &[DVec2; 3], area: f64) -> [f64; 6] {
    let mut force = [0.0; 6];
    for k in 0..3 {
        let [a, b] = hats[k].to_array();
        force[2 * k] = area * (slope[0] * a + slope[1] * b);
        force[2 * k + 1] = area * (slope[2] * a + slope[3] * b + slope[4] * THIRD);
    }
    force
}

/// How much of the second derivatives is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Gauss–Newton: Σ k ∂r ∂r, never negative. Far from the minimum the rest is of no use.
    First,
    /// With [`NEGATIVE`] as a part of what is negative by triangle: mostly still positive in sum, and nearer to the truth
    /// than without.
    Second,
    /// All: near rest that is mostly positive in sum, too.
    Full,
    /// Without what is negative by triangle.
    Convex,
}

/// What is left of a triangle's negative curvature where the neighbours are trusted to outweigh it. Without any the
/// fabric seems up to twenty times as stiff as it is where a lobe swings about a fold, and the steps are short by as
/// much; with all of it sums that are just positive change too much in a step.
pub const NEGATIVE: f64 = 0.75;

/// Second derivatives at a triangle that is not turned over.
pub fn bend(g: &Gradients, k: &Springs, wanted: &Stretches, order: Order) -> Bend {
    let d = g.determinant();
    let root = d.sqrt();
    let inverse = 1.0 / root;
    let by_d = 1.0 / d;
    // ∂d by (∇x, ∇y).
    let dd = [g.y.y, -g.y.x, -g.x.y, g.x.x];
    let mut bend = [[0.0; LOCAL]; LOCAL];
    for (k, alpha, beta, [length, length1]) in springs(k, wanted) {
        let v = alpha * g.x + beta * g.y;
        let n = v.length();
        let m = v / n;
        let dn = [alpha * m.x, alpha * m.y, beta * m.x, beta * m.y];
        let r = n * inverse - length * root;
        // ∂r = ∂n / √d − ½ (n d^-3/2 + λ d^-½) ∂d − λ' √d ∂c.
        let half = 0.5 * (n * by_d + length) * inverse;
        let dr: [f64; LOCAL] = [
            dn[0] * inverse - half * dd[0],
            dn[1] * inverse - half * dd[1],
            dn[2] * inverse - half * dd[2],
            dn[3] * inverse - half * dd[3],
            -length1 * root,
        ];
        for i in 0..LOCAL {
            for j in 0..=i {
                bend[i][j] += k * dr[i] * dr[j];
            }
        }
        if stiffening::begins(n * by_d, length) {
            stiffening::add_bend(&mut bend, g, &(k, alpha, beta, [length, length1]), order);
        }
        if order == Order::First {
            continue;
        }
        let kr = k * r;
        // n'' = w wᵀ / n with w the combination of the unit normal to v.
        let across = m.perp();
        let w = [alpha * across.x, alpha * across.y, beta * across.x, beta * across.y];
        let ww = inverse / n;
        let cross = 0.5 * inverse * by_d;
        let square = (0.75 * n * by_d + 0.25 * length) * inverse * by_d;
        for i in 0..4 {
            for j in 0..=i {
                bend[i][j] += kr
                    * (ww * w[i] * w[j] - cross * (dn[i] * dd[j] + dd[i] * dn[j])
                        + square * dd[i] * dd[j]);
            }
        }
        // d'' couples ∇x.x with ∇y.y and ∇x.y with ∇y.x.
        bend[3][0] -= kr * half;
        bend[2][1] += kr * half;
    }
    Bend(bend)
}

/// Adds the first derivatives of ½ s (∇y · along)² or ½ s (∇x · along)²: see [`Bend::turn`].
pub fn turn(slope: &mut [f64; LOCAL], g: &Gradients, of_y: bool, along: DVec2, s: f64) {
    let (v, at) = if of_y { (g.y, 2) } else { (g.x, 0) };
    let off = v.dot(along);
    slope[at] += s * off * along.x;
    slope[at + 1] += s * off * along.y;
}

impl Bend {
    /// Adds ½ s (∇y · along)² or ½ s (∇x · along)²: a spring that turns a thread into a direction.
    pub fn turn(&mut self, of_y: bool, along: DVec2, s: f64) {
        let at = if of_y { 2 } else { 0 };
        let [a, b] = along.to_array();
        self.0[at][at] += s * a * a;
        self.0[at + 1][at] += s * a * b;
        self.0[at + 1][at + 1] += s * b * b;
    }

    /// Leaves so much of the negative curvature by ∇x and ∇y: none makes the triangle convex (Teran, Sifakis, Irving
    /// & Fedkiw, *Robust Quasistatic Finite Elements and Flesh Simulation*, 2005). What couples them with c,
    /// some thousandths of them, stays as it is.
    pub fn leave_negative(&mut self, share: f64) {
        let taken = 1.0 - share;
        let whole: Square =
            std::array::from_fn(|i| std::array::from_fn(|j| self.0[i.max(j)][i.min(j)]));
        let Err(direction) = positive(whole) else { return };
        // Mostly one direction is negative, and soon found.
        if let Some((value, vector)) = negative(&whole, direction) {
            for i in 0..GRADIENTS {
                for j in 0..=i {
                    self.0[i][j] -= taken * value * vector[i] * vector[j];
                }
            }
            return;
        }
        let (values, vectors) = eigen(whole);
        for i in 0..GRADIENTS {
            for j in 0..=i {
                let negative = |k: usize| vectors[i][k] * values[k].min(0.0) * vectors[j][k];
                self.0[i][j] -= taken * (0..GRADIENTS).map(negative).sum::<f64>();
            }
        }
    }

    /// Second derivatives by one corner's pattern coordinates (xx, xy, yy), given its hat function's gradient, times the
    /// worn area.
    pub fn at_corner(&self, hat: DVec2, area: f64) -> [f64; 3] {
        let [a, b] = hat.to_array();
        let h = &self.0;
        let x = [h[0][0] * a + h[1][0] * b, h[1][0] * a + h[1][1] * b];
        // ∇y and c by x, and by y.
        let yx = [h[2][0] * a + h[2][1] * b, h[3][0] * a + h[3][1] * b, h[4][0] * a + h[4][1] * b];
        let yy = [
            h[2][2] * a + h[3][2] * b + h[4][2] * THIRD,
            h[3][2] * a + h[3][3] * b + h[4][3] * THIRD,
            h[4][2] * a + h[4][3] * b + h[4][4] * THIRD,
        ];
        let along = |[p, q, r]: [f64; 3]| p * a + q * b + r * THIRD;
        [x[0] * a + x[1] * b, along(yx), along(yy)].map(|h| area * h)
    }

    /// Second derivatives by the corners' pattern coordinates, times the worn area.
    pub fn at_corners(&self, hats: &[DVec2; 3], area: f64) -> Element {
        let h = |i: usize, j: usize| if i >= j { self.0[i][j] } else { self.0[j][i] };
        let mut columns = [[0.0; LOCAL]; 6];
        for k in 0..3 {
            let [a, b] = hats[k].to_array();
            for i in 0..LOCAL {
                columns[2 * k][i] = area * (h(i, 0) * a + h(i, 1) * b);
                columns[2 * k + 1][i] = area * (h(i, 2) * a + h(i, 3) * b + h(i, 4) * THIRD);
            }
        }
        let mut stiffness = [0.0; 21];
        let mut at = 0;
        for row in 0..6 {
            let [a, b] = hats[row / 2].to_array();
            for column in &columns[..=row] {
                stiffness[at] = if row % 2 == 0 {
                    column[0] * a + column[1] * b
                } else {
                    column[2] * a + column[3] * b + column[4] * THIRD
                };
                at += 1;
            }
        }
        Element { stiffness }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const K: Springs = Springs { warp: 0.7, weft: 1.9, diagonal: 0.11 };
    const HATS: [DVec2; 3] =
        [DVec2::new(-0.5, -0.21), DVec2::new(0.5, -0.12), DVec2::new(0.0, 0.33)];

    /// ε(c) = 0.1 + 0.02 c − 0.003 c².
    fn wanted(c: f64) -> Stretches {
        let warp = [1.1 + 0.02 * c - 0.003 * c * c, 0.02 - 0.006 * c];
        Stretches { warp, weft: 1.03 }
    }

    /// The same everywhere.
    const CONSTANT: Stretches = Stretches { warp: [1.1, 0.0], weft: 1.03 };

    fn corners(p: &[f64; 6]) -> [DVec2; 3] {
        [0, 1, 2].map(|k| DVec2::new(p[2 * k], p[2 * k + 1]))
    }

    fn value(p: &[f64; 6]) -> f64 {
        let c = (p[1] + p[3] + p[5]) / 3.0;
        2.5 * stiffening_energy(&Gradients::new(&HATS, corners(p)), &K, &wanted(c))
    }

    fn element(p: &[f64; 6], order: Order, convex: bool) -> Element {
        let c = (p[1] + p[3] + p[5]) / 3.0;
        let g = Gradients::new(&HATS, corners(p));
        let mut bend = bend(&g, &K, &wanted(c), order);
        if convex {
            bend.leave_negative(0.0);
        }
        bend.at_corners(&HATS, 2.5)
    }

    fn force(p: &[f64; 6]) -> [f64; 6] {
        let c = (p[1] + p[3] + p[5]) / 3.0;
        let g = Gradients::new(&HATS, corners(p));
        force_at_corners(&slope(&g, &K, &wanted(c)), &HATS, 2.5)
    }

    const AT: [f64; 6] = [0.1, 0.2, 1.9, 0.5, 0.8, 2.7];

    /// Much smaller: both threads and a diagonal stiffen.
    const STIFFENED: [f64; 6] = [0.1, 0.2, 0.9, 0.35, 0.4, 1.1];

    #[test]
    fn the_gradient_is_that_of_the_energy() {
        for at in [AT, STIFFENED] {
            let force = force(&at);
            for i in 0..6 {
                let step = |h: f64| {
                    let mut p = at;
                    p[i] += h;
                    value(&p)
                };
                let difference = (step(1e-5) - step(-1e-5)) / 2e-5;
                let off = (force[i] - difference).abs();
                assert!(off < 1e-8 * (1.0 + difference.abs()), "{i}: {} {difference}", force[i]);
            }
        }
    }

    #[test]
    fn the_hessian_is_that_of_the_energy() {
        let gradients = |p: &[f64; 6]| Gradients::new(&HATS, corners(p));
        let force =
            |p: &[f64; 6]| force_at_corners(&slope(&gradients(p), &K, &CONSTANT), &HATS, 2.5);
        for place in [AT, STIFFENED] {
            let bend = bend(&gradients(&place), &K, &CONSTANT, Order::Second);
            let stiffness = bend.at_corners(&HATS, 2.5).stiffness;
            for (k, hat) in HATS.into_iter().enumerate() {
                let entry = |row: usize, column: usize| stiffness[row * (row + 1) / 2 + column];
                let (x, y) = (2 * k, 2 * k + 1);
                let at_corner = [entry(x, x), entry(y, x), entry(y, y)];
                for (one, all) in bend.at_corner(hat, 2.5).into_iter().zip(at_corner) {
                    assert!((one - all).abs() < 1e-12, "{one} {all}");
                }
            }
            let mut at = 0;
            for row in 0..6 {
                for column in 0..=row {
                    let step = |h: f64| {
                        let mut p = place;
                        p[column] += h;
                        force(&p)[row]
                    };
                    let difference = (step(1e-5) - step(-1e-5)) / 2e-5;
                    let off = (stiffness[at] - difference).abs();
                    assert!(off < 1e-7 * (1.0 + difference.abs()), "{row} {column}");
                    at += 1;
                }
            }
        }
    }

    /// The least of v·Hv/v·v over many v, and the largest.
    fn range(element: &Element) -> [f64; 2] {
        let at = |i: usize, j: usize| element.stiffness[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
        let mut random = 1u64;
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for _ in 0..2000 {
            let mut v = [0.0; 6];
            for x in &mut v {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                *x = (random >> 40) as f64 / f64::from(1 << 24) - 0.5;
            }
            let square: f64 = (0..6)
                .flat_map(|i| (0..6).map(move |j| (i, j)))
                .map(|(i, j)| v[i] * at(i, j) * v[j])
                .sum();
            let whole: f64 = v.iter().map(|x| x * x).sum();
            range = [range[0].min(square / whole), range[1].max(square / whole)];
        }
        range
    }

    #[test]
    fn only_all_of_the_second_order_part_makes_the_hessian_negative() {
        let [least, _] = range(&element(&AT, Order::Second, false));
        assert!(least < -0.01, "the case shows nothing: {least}");
        for (order, convex) in [(Order::First, false), (Order::Second, true)] {
            let [least, most] = range(&element(&AT, order, convex));
            assert!(least > -1e-6 && most > 1.0, "{order:?}: {least} {most}");
        }
    }

    #[test]
    fn only_what_is_negative_is_left_out() {
        let with = |off: f64| {
            let mut bend = Bend([[0.0; LOCAL]; LOCAL]);
            (0..LOCAL).for_each(|i| bend.0[i][i] = 1.0);
            (bend.0[2][1], bend.0[4][0]) = (off, 0.2);
            bend
        };
        let mut positive = with(0.5);
        positive.leave_negative(0.0);
        assert_eq!(positive.0, with(0.5).0);
        // Eigenvalues 3 along (1, 1) and −1 along (1, −1): the latter goes.
        let mut other = with(2.0);
        other.leave_negative(0.0);
        assert_eq!([other.0[4][0], other.0[4][4]], [0.2, 1.0]);
        for (entry, wanted) in [
            (other.0[0][0], 1.0),
            (other.0[3][3], 1.0),
            (other.0[1][1], 1.5),
            (other.0[2][2], 1.5),
            (other.0[2][1], 1.5),
        ] {
            assert!((entry - wanted).abs() < 1e-7, "{entry} {wanted}");
        }
    }

    #[test]
    fn a_triangle_with_its_wanted_strain_has_no_energy_and_one_turned_over_has_no_end_of_it() {
        // Worn 1.2 times as wide and 1.03 times as high as at rest.
        let g = Gradients { x: DVec2::new(1.0 / 1.2, 0.0), y: DVec2::new(0.0, 1.0 / 1.03) };
        let wanted = Stretches { warp: [1.2, 0.0], weft: 1.03 };
        assert!(energy(&g, &K, &wanted) < 1e-30);
        let over = Gradients { x: -g.x, ..g };
        assert_eq!(energy(&over, &K, &wanted), f64::INFINITY);
    }

    #[test]
    fn the_turning_springs_derivatives_are_those_of_its_energy() {
        let g = Gradients { x: DVec2::new(0.9, 0.1), y: DVec2::new(-0.2, 0.8) };
        let along = DVec2::from_angle(0.3);
        let mut first = [0.0; LOCAL];
        turn(&mut first, &g, true, along, 0.7);
        let mut second = Bend([[0.0; LOCAL]; LOCAL]);
        second.turn(true, along, 0.7);
        let energy = |y: DVec2| 0.35 * y.dot(along).powi(2);
        let h = 1e-4;
        for (i, axis) in [DVec2::X, DVec2::Y].into_iter().enumerate() {
            let [low, high] = [-h, h].map(|h| energy(g.y + h * axis));
            assert!((first[2 + i] - (high - low) / (2.0 * h)).abs() < 1e-9);
            let bent = (high - 2.0 * energy(g.y) + low) / (h * h);
            assert!((second.0[2 + i][2 + i] - bent).abs() < 1e-6);
        }
    }
}
