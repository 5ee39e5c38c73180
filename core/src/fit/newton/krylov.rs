//! Linear equations of which only the product is known.
//!
//! GMRES (Saad & Schultz, *GMRES: A Generalized Minimal Residual Algorithm for Solving Nonsymmetric Linear Systems*,
//! 1986): of the space of b, A b, A² b, … the vector is taken that leaves the least of b.

use glam::DVec2;

/// What GMRES has found.
pub struct Solution {
    /// The vector.
    pub x: Vec<DVec2>,
    /// The share of b that it leaves, |b − A x| over |b|.
    pub left: f64,
}

fn dot(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

/// x with A x = b, to a `share` of b or after `most` products; `None` for b without length, or if there was no
/// product. `product` is A of a vector of length 1, or `None` if no more are wanted.
pub fn gmres(
    b: &[DVec2],
    product: impl Fn(&[DVec2]) -> Option<Vec<DVec2>>,
    most: usize,
    share: f64,
) -> Option<Solution> {
    let length = dot(b, b).sqrt();
    if length == 0.0 || !length.is_finite() {
        return None;
    }
    let mut basis: Vec<Vec<DVec2>> = vec![b.iter().map(|&b| b / length).collect()];
    // The upper triangle by column, the rotations that made it (Givens), and b turned by them.
    let mut columns: Vec<Vec<f64>> = Vec::with_capacity(most);
    let mut rotations: Vec<(f64, f64)> = Vec::with_capacity(most);
    let mut turned = vec![length];
    while columns.len() < most && turned[columns.len()].abs() > share * length {
        let k = columns.len();
        let Some(mut next) = product(&basis[k]) else { break };
        let mut column: Vec<f64> = basis
            .iter()
            .map(|v| {
                let part = dot(v, &next);
                next.iter_mut().zip(v).for_each(|(next, &v)| *next -= part * v);
                part
            })
            .collect();
        let rest = dot(&next, &next).sqrt();
        for (i, &(c, s)) in rotations.iter().enumerate() {
            let below = if i + 1 < column.len() { column[i + 1] } else { rest };
            let above = column[i];
            column[i] = c * above + s * below;
            if i + 1 < column.len() {
                column[i + 1] = c * below - s * above;
            }
        }
        let whole = column[k].hypot(rest);
        if whole == 0.0 || !whole.is_finite() {
            break;
        }
        let (c, s) = (column[k] / whole, rest / whole);
        column[k] = whole;
        columns.push(column);
        rotations.push((c, s));
        turned.push(-s * turned[k]);
        turned[k] *= c;
        if rest > 0.0 {
            next.iter_mut().for_each(|next| *next /= rest);
        }
        basis.push(next);
    }
    if columns.is_empty() {
        return None;
    }
    let left = turned[columns.len()].abs() / length;
    let mut parts = turned;
    for i in (0..columns.len()).rev() {
        let above: f64 = (i + 1..columns.len()).map(|j| columns[j][i] * parts[j]).sum();
        parts[i] = (parts[i] - above) / columns[i][i];
    }
    let mut x = vec![DVec2::ZERO; b.len()];
    for (part, v) in parts.iter().zip(&basis).take(columns.len()) {
        x.iter_mut().zip(v).for_each(|(x, &v)| *x += *part * v);
    }
    Some(Solution { x, left })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lopsided matrix: diagonal 1, but for a few small and one negative, with a coupling to the next.
    fn product(v: &[DVec2]) -> Vec<DVec2> {
        let diagonal = |k: usize| match k {
            3 => 0.05,
            8 => 0.2,
            11 => -0.1,
            _ => 1.0,
        };
        let next = |k: usize| if k + 1 < v.len() { v[k + 1] } else { DVec2::ZERO };
        (0..v.len()).map(|k| diagonal(k) * v[k] + 0.01 * next(k).perp()).collect()
    }

    #[test]
    fn equations_with_few_odd_directions_are_solved_in_few_products() {
        let b: Vec<DVec2> = (0..30).map(|k| DVec2::new(f64::from(k % 5) - 1.7, 0.3)).collect();
        let Solution { x, left } = gmres(&b, |v| Some(product(v)), 12, 1e-6).unwrap();
        let rest: Vec<DVec2> = product(&x).iter().zip(&b).map(|(ax, b)| *b - *ax).collect();
        let measured = (dot(&rest, &rest) / dot(&b, &b)).sqrt();
        assert!((measured - left).abs() < 1e-9, "{measured} and said {left}");
        assert!(left < 1e-3, "{left}");
        // Much of what is small in b is large in x.
        assert!(x[3].length() > 15.0 * b[3].length());
    }

    #[test]
    fn it_ends_where_it_is_told_and_with_what_it_has() {
        let b = vec![DVec2::new(1.0, -2.0); 10];
        assert!(gmres(&[DVec2::ZERO; 4], |v| Some(v.to_vec()), 5, 0.1).is_none());
        assert!(gmres(&b, |_| None, 5, 0.1).is_none());
        let Solution { x, left } = gmres(&b, |v| Some(v.to_vec()), 5, 0.1).unwrap();
        assert!(left < 1e-12 && x.iter().zip(&b).all(|(x, b)| x.distance(*b) < 1e-12));
        let one = gmres(&b, |v| Some(product(v)), 1, 0.0).unwrap();
        let two = gmres(&b, |v| Some(product(v)), 2, 0.0).unwrap();
        assert!(two.left < one.left && one.left < 1.0);
    }
}
