//! Springs stiffen where they are stretched far beyond their wanted length.
//!
//! J_E has an end where a triangle is pressed together in the pattern: with both gradients small n / d grows, and the
//! energy goes to ½ A Σ k. From a stretch of 3/2 λ on a spring's part of it is ever less steep. At the tip of a notch,
//! where the strain of any elastic sheet is singular, triangles gave way one after the other: an ankle of 200,000 had
//! stretches of 12 there, J_E grew less with every finer mesh, and the pattern was 3 mm from where it is if they
//! hold. No fabric gives way so; a knit stiffens. So each spring gets
//!
//! ⅙ A k [`STIFFER`] (n / d − 3/2 λ)³
//!
//! more where n / d, its stretch, is larger than that: two derivatives are continuous, and the sum gets ever steeper.
//! Where no thread is stretched by half it adds nothing, and it is never part of the J_E reported.

use super::{GRADIENTS, Gradients, LOCAL, Order, Spring, Springs, Stretches, springs};

/// A spring stiffens where it is stretched to more than so many times its wanted length: where its part of J_E has its
/// inflection.
const BEGINS: f64 = 1.5;

/// Of a spring's stiffness so much is added for each unit of stretch beyond: at twice the wanted length, as much again.
const STIFFER: f64 = 2.0;

/// Whether a stretch is so large, given the wanted one.
pub fn begins(stretch: f64, wanted: f64) -> bool {
    stretch > BEGINS * wanted
}

/// J_E with what it adds, per worn area, in N/mm; infinite where the triangle is turned over.
pub fn energy(g: &Gradients, k: &Springs, wanted: &Stretches) -> f64 {
    let d = g.determinant();
    if d.is_nan() || d <= 0.0 {
        return f64::INFINITY;
    }
    let by_d = 1.0 / d;
    springs(k, wanted)
        .iter()
        .map(|&(k, alpha, beta, [length, _])| {
            let n = (alpha * g.x + beta * g.y).length();
            let loose = 0.5 * k * (n - length * d).powi(2) * by_d;
            if !begins(n * by_d, length) {
                return loose;
            }
            loose + k * STIFFER / 6.0 * (n * by_d - BEGINS * length).powi(3)
        })
        .sum()
}

/// Adds the first derivatives of a spring that stiffens.
pub fn add_slope(slope: &mut [f64; LOCAL], g: &Gradients, spring: &Spring) {
    let Derivatives { over, stiffness, first, .. } = Derivatives::new(g, spring);
    if over <= 0.0 {
        return;
    }
    let pull = 0.5 * stiffness * over;
    slope.iter_mut().zip(first).for_each(|(slope, first)| *slope += pull * first);
}

/// Adds the second derivatives of one, to the given order.
pub fn add_bend(bend: &mut [[f64; LOCAL]; LOCAL], g: &Gradients, spring: &Spring, order: Order) {
    let Derivatives { over, stiffness, first, second } = Derivatives::new(g, spring);
    for i in 0..LOCAL {
        for j in 0..=i {
            bend[i][j] += stiffness * first[i] * first[j];
        }
    }
    if order != Order::First {
        let pull = 0.5 * stiffness * over;
        for i in 0..GRADIENTS {
            for j in 0..=i {
                bend[i][j] += pull * second[i][j];
            }
        }
    }
}

/// What a spring's stretch is beyond its limit, and its derivatives by ∇x, ∇y and c.
struct Derivatives {
    over: f64,
    /// The stiffness added, in N/mm.
    stiffness: f64,
    first: [f64; LOCAL],
    /// Lower triangle; without those that the strain function has.
    second: [[f64; GRADIENTS]; GRADIENTS],
}

impl Derivatives {
    fn new(g: &Gradients, &(k, alpha, beta, [length, length1]): &Spring) -> Self {
        let d = g.determinant();
        let v = alpha * g.x + beta * g.y;
        let n = v.length();
        let stretch = n / d;
        let over = stretch - BEGINS * length;
        let m = v / n;
        // ∂n, ∂d and the combination of the unit normal to v of which n'' consists.
        let dn = [alpha * m.x, alpha * m.y, beta * m.x, beta * m.y];
        let dd = [g.y.y, -g.y.x, -g.x.y, g.x.x];
        let across = m.perp();
        let w = [alpha * across.x, alpha * across.y, beta * across.x, beta * across.y];
        let part = |i: usize| (dn[i] - stretch * dd[i]) / d;
        let first = [part(0), part(1), part(2), part(3), -BEGINS * length1];
        let mut second = [[0.0; GRADIENTS]; GRADIENTS];
        for i in 0..GRADIENTS {
            for j in 0..=i {
                let by_d = 2.0 * stretch * dd[i] * dd[j] - dn[i] * dd[j] - dd[i] * dn[j];
                second[i][j] = (w[i] * w[j] / n + by_d / d) / d;
            }
        }
        // d'' couples ∇x.x with ∇y.y and ∇x.y with ∇y.x.
        second[3][0] -= stretch / d;
        second[2][1] += stretch / d;
        Self { over, stiffness: k * STIFFER * over, first, second }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::fit::newton::element;

    const K: Springs = Springs { warp: 0.7, weft: 1.9, diagonal: 0.11 };

    const WANTED: Stretches = Stretches { warp: [1.1, 0.0], weft: 1.03 };

    #[test]
    fn a_triangle_pressed_together_stiffens_from_a_stretch_of_half_as_much_again() {
        let shrunk = |s: f64| Gradients { x: DVec2::X / s, y: DVec2::Y / s };
        let at = |s: f64| energy(&shrunk(s), &K, &WANTED);
        let loose = |s: f64| element::energy(&shrunk(s), &K, &WANTED);
        // The weft is the first.
        assert!((at(1.54) - loose(1.54)).abs() < 1e-15);
        assert!(at(1.55) > loose(1.55));
        // J_E alone ends, as the area in the pattern does.
        assert!(loose(1e6) < 2.0 && at(1e6) > 1e11);
        // From there it would be ever less steep.
        let bent = |e: &dyn Fn(f64) -> f64, s: f64| e(s + 1e-3) - 2.0 * e(s) + e(s - 1e-3);
        assert!(bent(&loose, 1.8) < 0.0 && bent(&at, 1.8) > 0.0 && bent(&at, 8.0) > 0.0);
    }
}
