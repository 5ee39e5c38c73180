//! How much smaller the pattern is than the limb, girth by girth.
//!
//! The pattern's girth is the length, in the flat pattern, of the very line on which the limb's
//! girth was measured: where the plane across the limb's centre line meets a triangle, the same
//! piece of line is measured in the triangle's place in the pattern, and the pieces are summed. It
//! is what a tape along that line of the cut fabric shows, and needs no guess of which place of the
//! pattern belongs to which of the limb. Limit: it is not a thread; where the line runs askew to
//! the warp, the reduction is not the thread's strain.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::geometry::Girth;
use crate::surface::Surface;

/// A girth of the limb and of the pattern.
#[derive(Debug, Clone, PartialEq)]
pub struct GirthPair {
    /// The limb's.
    pub limb: Girth,
    /// The pattern's on the same line, in mm; unknown where that line was not found again.
    pub pattern_mm: Option<f64>,
    /// The line in the pattern, in pieces.
    pub line: Vec<[DVec2; 2]>,
}

impl GirthPair {
    /// By what part the pattern's is shorter than the limb's.
    #[must_use]
    pub fn reduction(&self) -> Option<f64> {
        self.pattern_mm.map(|pattern| 1.0 - pattern / self.limb.girth_mm)
    }
}

/// Largest part by which the line found may differ in length from the girth measured.
const SAME_LINE: f64 = 1e-3;

/// The girths of limb and pattern.
#[must_use]
pub fn girth_pairs(disk: &Surface, coordinates: &[DVec2], girths: &[Girth]) -> Vec<GirthPair> {
    girths.iter().map(|girth| pair(disk, coordinates, girth)).collect()
}

/// A connected part of a plane section, on the limb and in the pattern.
#[derive(Debug, Clone, Default)]
struct Part {
    worn: f64,
    rest: f64,
    line: Vec<[DVec2; 2]>,
}

fn pair(disk: &Surface, coordinates: &[DVec2], girth: &Girth) -> GirthPair {
    let parts = section(disk, coordinates, girth.centre, girth.direction);
    let fits = |worn: f64| (worn / girth.girth_mm - 1.0).abs() < SAME_LINE;
    // The plane may meet other parts of a bent limb: the line is the part of the same length. An
    // open girth may be of several parts.
    let whole: f64 = parts.iter().map(|part| part.worn).sum();
    let gap = |part: &Part| (part.worn - girth.girth_mm).abs();
    let nearest = parts.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
    let found = match nearest {
        Some(part) if fits(part.worn) => Some(part.clone()),
        Some(_) if fits(whole) => Some(Part {
            worn: whole,
            rest: parts.iter().map(|part| part.rest).sum(),
            line: parts.iter().flat_map(|part| part.line.iter().copied()).collect(),
        }),
        _ => None,
    };
    GirthPair {
        limb: *girth,
        pattern_mm: found.as_ref().map(|part| part.rest),
        line: found.map(|part| part.line).unwrap_or_default(),
    }
}

/// A place in space by its bits.
type Key = [u64; 3];

/// The section of the surface with a plane, in parts that hang together in space: across seams too.
fn section(disk: &Surface, coordinates: &[DVec2], point: DVec3, normal: DVec3) -> Vec<Part> {
    let height = |p: DVec3| (p - point).dot(normal);
    let mut number: BTreeMap<Key, usize> = BTreeMap::new();
    // Pieces: their two ends by number, length on the limb, and place in the pattern.
    let mut pieces: Vec<([usize; 2], f64, [DVec2; 2])> = Vec::new();
    for t in disk.triangle_ids() {
        let corners = disk.triangle(t);
        let mut ends: Vec<(DVec3, DVec2)> = Vec::with_capacity(2);
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let (p, q) = (disk.point(a), disk.point(b));
            // In one order for both triangles of an edge and both sides of a seam, so that the
            // place comes out the same to the last bit.
            let in_order = p.to_array().partial_cmp(&q.to_array()).is_some_and(|o| o.is_lt());
            let (a, b, p, q) = if in_order { (a, b, p, q) } else { (b, a, q, p) };
            let (h, l) = (height(p), height(q));
            if (h < 0.0) != (l < 0.0) {
                let f = h / (h - l);
                let flat = coordinates[a.index()].lerp(coordinates[b.index()], f);
                ends.push((p.lerp(q, f), flat));
            }
        }
        if let [(p, a), (q, b)] = ends[..] {
            let fresh = number.len();
            let i = *number.entry(key(p)).or_insert(fresh);
            let fresh = number.len();
            let j = *number.entry(key(q)).or_insert(fresh);
            pieces.push(([i, j], p.distance(q), [a, b]));
        }
    }
    let mut root: Vec<usize> = (0..number.len()).collect();
    for ([i, j], ..) in &pieces {
        let (i, j) = (find(&mut root, *i), find(&mut root, *j));
        root[i.max(j)] = i.min(j);
    }
    let mut parts: BTreeMap<usize, Part> = BTreeMap::new();
    for ([i, _], worn, line) in pieces {
        let part = parts.entry(find(&mut root, i)).or_default();
        part.worn += worn;
        part.rest += line[0].distance(line[1]);
        part.line.push(line);
    }
    parts.into_values().collect()
}

fn key(p: DVec3) -> Key {
    // One zero.
    (p + 0.0).to_array().map(f64::to_bits)
}

fn find(root: &mut [usize], mut i: usize) -> usize {
    while root[i] != i {
        root[i] = root[root[i]];
        i = root[i];
    }
    i
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::shapes::{grid, torus_point};

    /// A cylinder of radius 40 mm cut open, of 60 sides, and its pattern, 20 % too narrow.
    fn cylinder() -> (Surface, Vec<DVec2>) {
        let sides = 60;
        let side = 2.0 * 40.0 * (TAU / 120.0).sin();
        let surface = grid(50, sides, false, |s, t| {
            let (sin, cos) = (TAU * (s % 1.0)).sin_cos();
            DVec3::new(40.0 * cos, 40.0 * sin, 200.0 * t)
        });
        let plane = (0..=50)
            .flat_map(|i| (0..=sides).map(move |j| (i, j)))
            .map(|(i, j)| DVec2::new(0.8 * side * j as f64, 4.0 * f64::from(i)))
            .collect();
        (surface, plane)
    }

    fn at(centre: DVec3, direction: DVec3, girth_mm: f64) -> Girth {
        Girth { at_mm: 0.0, girth_mm, centre, direction, closed: true }
    }

    #[test]
    fn a_pattern_a_fifth_narrower_is_reduced_by_a_fifth() {
        let (disk, plane) = cylinder();
        let round = 60.0 * 80.0 * (TAU / 120.0).sin();
        let pair = pair(&disk, &plane, &at(DVec3::new(0.0, 0.0, 90.5), DVec3::Z, round));
        assert!((pair.reduction().unwrap() - 0.2).abs() < 1e-9, "{:?}", pair.pattern_mm);
        assert!(pair.line.iter().flatten().all(|p| (p.y - 90.5).abs() < 1e-9));
        let pair = super::pair(&disk, &plane, &at(DVec3::new(0.0, 0.0, 90.5), DVec3::Z, 200.0));
        assert_eq!((pair.pattern_mm, pair.line.len()), (None, 0));
    }

    #[test]
    fn of_two_parts_of_a_bent_limb_the_one_measured_is_taken() {
        // More than half a ring that widens: a plane through its axis meets it twice.
        let ring =
            grid(120, 48, false, |s, t| torus_point(100.0, 30.0 + 12.0 * t, s % 1.0, 2.4 * t));
        let flat: Vec<DVec2> = (0..=120)
            .flat_map(|i| (0..=48).map(move |j| DVec2::new(3.0 * f64::from(j), 3.0 * f64::from(i))))
            .collect();
        let middle = |t: f64| torus_point(100.0, 0.0, 0.0, t);
        let axis = (middle(0.2001) - middle(0.1999)).normalize();
        for (t, radius) in [(0.2, 31.0), (2.2, 41.0)] {
            let girth = TAU * radius;
            let parts = section(&ring, &flat, middle(0.2), axis);
            assert_eq!(parts.len(), 2);
            let near = |part: &&Part| (part.worn / girth - 1.0).abs() < 0.02;
            let part = parts.iter().find(near).unwrap_or_else(|| panic!("{t}"));
            let found = pair(&ring, &flat, &at(middle(0.2), axis, part.worn));
            // 48 cells of 3 mm, some of them crossed askew by the flat section.
            assert_eq!(found.pattern_mm, Some(part.rest));
            assert!((part.rest / 144.0 - 1.0).abs() < 0.05, "{}", part.rest);
            let row = 120.0 * t / 2.4;
            assert!(found.line.iter().flatten().all(|p| (p.y / 3.0 - row).abs() < 5.0));
        }
    }
}
