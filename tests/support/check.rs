//! Recomputes from `worn.obj` alone what the program claims about a pattern.
//!
//! The file holds the cut surface (`v`, mm) and the pattern (`vt`, mm, x along warp, y along
//! weft); two boundary edges that coincide in space are sewn together.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};
use rstar::{AABB, RTree, primitives::GeomWithData, primitives::Rectangle};

use crate::mesh::{boundary_edges, boundary_loops};

/// A worn surface with its pattern.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WornObj {
    /// Points of the worn surface, in mm.
    pub v: Vec<DVec3>,
    /// Points of the pattern, in mm.
    pub vt: Vec<DVec2>,
    /// Triangles: index into `v` and into `vt` of each corner.
    pub faces: Vec<[(usize, usize); 3]>,
}

/// A pair of lines that are sewn together.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    /// Pairs of boundary edges (indices into `vt`), the second one running back.
    pub pairs: Vec<[[usize; 2]; 2]>,
    /// Length of the one side in the pattern, in mm.
    pub left_mm: f64,
    /// Length of the other side in the pattern, in mm.
    pub right_mm: f64,
    /// Length in space, in mm.
    pub worn_mm: f64,
    /// Largest difference between an edge and the edge that it is sewn to, in mm.
    pub worst_edge_mm: f64,
}

/// How a triangle of fabric is stretched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Worn length over rest length along warp, |F eₓ|.
    pub warp: f64,
    /// Worn length over rest length along weft, |F e_y|.
    pub weft: f64,
    /// Cosine of the angle between the worn threads: 0 without shear.
    pub shear: f64,
    /// Area in the pattern, in mm².
    pub area: f64,
    /// Middle of the triangle in the pattern.
    pub middle: DVec2,
    /// Middle of the triangle in space.
    pub worn: DVec3,
}

impl WornObj {
    /// Reads the file.
    ///
    /// # Panics
    /// On anything but `v`, `vt`, triangles `f v/vt …`, comments, names and groups, on numbers
    /// that are not finite, and on indices that do not exist.
    #[must_use]
    pub fn parse(text: &str) -> Self {
        let mut worn = Self::default();
        for (i, line) in text.lines().enumerate() {
            let numbers = |rest: &str| -> Vec<f64> {
                rest.split_whitespace()
                    .map(|x| x.parse().unwrap_or_else(|_| panic!("line {}: {line}", i + 1)))
                    .inspect(|x: &f64| assert!(x.is_finite(), "line {}: {line}", i + 1))
                    .collect()
            };
            match line.split_once(' ').unwrap_or((line, "")) {
                ("v", rest) => worn.v.push(DVec3::from_slice(&numbers(rest))),
                ("vt", rest) => worn.vt.push(DVec2::from_slice(&numbers(rest))),
                ("f", rest) => {
                    let corners: Vec<(usize, usize)> = rest
                        .split_whitespace()
                        .map(|corner| {
                            let mut parts = corner.split('/').map(|x| {
                                x.parse::<usize>()
                                    .unwrap_or_else(|_| panic!("line {}: {line}", i + 1))
                            });
                            let mut next = || parts.next().expect("v/vt") - 1;
                            (next(), next())
                        })
                        .collect();
                    worn.faces.push(corners.try_into().expect("triangles"));
                }
                ("" | "#" | "o" | "g" | "s" | "mtllib" | "usemtl", _) => {}
                (other, _) if other.starts_with('#') => {}
                _ => panic!("line {}: {line}", i + 1),
            }
        }
        let known = |&(v, vt): &(usize, usize)| v < worn.v.len() && vt < worn.vt.len();
        assert!(worn.faces.iter().flatten().all(known), "an index does not exist");
        assert!(!worn.faces.is_empty(), "no triangle");
        worn
    }

    /// The triangles of the pattern, as indices into `vt`.
    #[must_use]
    pub fn pattern(&self) -> Vec<[usize; 3]> {
        self.faces.iter().map(|f| f.map(|(_, vt)| vt)).collect()
    }

    /// Number of triangles that lie face down or flat in the pattern. Seen from outside worn
    /// triangles turn counter-clockwise, and so do the pattern's with the right side up: a wholly
    /// mirrored pattern is all flipped.
    #[must_use]
    pub fn flipped(&self) -> usize {
        self.pattern()
            .iter()
            .filter(|t| {
                let [a, b, c] = t.map(|i| coord(self.vt[i]));
                orient2d(a, b, c) <= 0.0
            })
            .count()
    }

    /// Number of inner pattern vertices round which the triangles turn more than once: fabric
    /// laid twice without any triangle being flipped.
    #[must_use]
    pub fn wound_twice(&self) -> usize {
        let pattern = self.pattern();
        let mut turn = vec![0.0; self.vt.len()];
        for t in &pattern {
            for k in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|d| self.vt[t[(k + d) % 3]]);
                turn[t[k]] += (b - a).angle_to(c - a).abs();
            }
        }
        for [a, b] in boundary_edges(&pattern) {
            turn[a] = 0.0;
            turn[b] = 0.0;
        }
        turn.iter().filter(|&&angle| angle > 3.0 * std::f64::consts::PI).count()
    }

    /// The pattern's outline: closed loops of indices into `vt`.
    #[must_use]
    pub fn outline(&self) -> Vec<Vec<usize>> {
        boundary_loops(&self.pattern())
    }

    /// Number of pairs of outline edges without a common end that meet.
    #[must_use]
    pub fn overlaps(&self) -> usize {
        let edges = boundary_edges(&self.pattern());
        let corner = |i: usize| self.vt[i].to_array();
        let tree = RTree::bulk_load(
            edges
                .iter()
                .enumerate()
                .map(|(i, &[a, b])| {
                    GeomWithData::new(Rectangle::from_corners(corner(a), corner(b)), i)
                })
                .collect(),
        );
        let mut count = 0;
        for (i, &[a, b]) in edges.iter().enumerate() {
            let near = AABB::from_corners(corner(a), corner(b));
            for other in tree.locate_in_envelope_intersecting(near) {
                let [c, d] = edges[other.data];
                if other.data > i
                    && ![c, d].contains(&a)
                    && ![c, d].contains(&b)
                    && meet([a, b].map(|k| self.vt[k]), [c, d].map(|k| self.vt[k]))
                {
                    count += 1;
                }
            }
        }
        count
    }

    /// What is sewn together: runs of outline edges that coincide in space, to within a
    /// millionth of the surface's size, with edges that run the other way.
    #[must_use]
    pub fn seams(&self) -> Vec<Seam> {
        let pattern = self.pattern();
        let mut place = vec![DVec3::NAN; self.vt.len()];
        for &(v, vt) in self.faces.iter().flatten() {
            place[vt] = self.v[v];
        }
        let low = self.v.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = self.v.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let near = 1e-6 * (high - low).length();
        let edges = boundary_edges(&pattern);
        let middle = |[a, b]: [usize; 2]| (0.5 * (place[a] + place[b])).to_array();
        let tree = RTree::bulk_load(
            edges.iter().map(|&edge| GeomWithData::new(middle(edge), edge)).collect(),
        );
        let same = |a: usize, b: usize| place[a].distance(place[b]) <= near;
        let mut partner: BTreeMap<[usize; 2], [usize; 2]> = BTreeMap::new();
        for &edge in &edges {
            for other in tree.locate_within_distance(middle(edge), near * near) {
                let [c, d] = other.data;
                if other.data != edge && same(edge[0], d) && same(edge[1], c) {
                    partner.insert(edge, other.data);
                }
            }
        }
        let mut seams = Vec::new();
        let mut used: BTreeMap<[usize; 2], ()> = BTreeMap::new();
        for around in boundary_loops(&pattern) {
            let n = around.len();
            let edge = |k: usize| [around[k % n], around[(k + 1) % n]];
            // The run goes on where both sides go on.
            let goes_on = |k: usize| match (partner.get(&edge(k + n - 1)), partner.get(&edge(k))) {
                (Some(before), Some(now)) => now[1] == before[0],
                _ => false,
            };
            let start = (0..n).find(|&k| !goes_on(k)).unwrap_or(0);
            let mut run: Vec<[[usize; 2]; 2]> = Vec::new();
            for k in start..start + n {
                if !goes_on(k) && !run.is_empty() {
                    seams.push(self.seam(std::mem::take(&mut run), &place));
                }
                if let Some(&other) = partner.get(&edge(k)) {
                    // The other side meets the same pairs later.
                    if !used.contains_key(&edge(k)) {
                        used.insert(other, ());
                        run.push([edge(k), other]);
                    }
                }
            }
            if !run.is_empty() {
                seams.push(self.seam(run, &place));
            }
        }
        seams
    }

    fn seam(&self, pairs: Vec<[[usize; 2]; 2]>, place: &[DVec3]) -> Seam {
        let rest = |[a, b]: [usize; 2]| self.vt[a].distance(self.vt[b]);
        let sum = |side: usize| pairs.iter().map(|pair| rest(pair[side])).sum();
        Seam {
            left_mm: sum(0),
            right_mm: sum(1),
            worn_mm: pairs.iter().map(|[[a, b], _]| place[*a].distance(place[*b])).sum(),
            worst_edge_mm: pairs
                .iter()
                .map(|[left, right]| (rest(*left) - rest(*right)).abs())
                .fold(0.0, f64::max),
            pairs,
        }
    }

    /// The stretch of every triangle, from F = d(worn)/d(pattern).
    #[must_use]
    pub fn stretches(&self) -> Vec<Stretch> {
        self.faces
            .iter()
            .map(|face| {
                let p = face.map(|(v, _)| self.v[v]);
                let q = face.map(|(_, vt)| self.vt[vt]);
                let (a, b) = (q[1] - q[0], q[2] - q[0]);
                let twice = a.perp_dot(b);
                let (along, across) = (p[1] - p[0], p[2] - p[0]);
                // The columns of [along across] [a b]⁻¹.
                let warp = (along * b.y - across * a.y) / twice;
                let weft = (across * a.x - along * b.x) / twice;
                Stretch {
                    warp: warp.length(),
                    weft: weft.length(),
                    shear: warp.dot(weft) / (warp.length() * weft.length()),
                    area: 0.5 * twice,
                    middle: (q[0] + q[1] + q[2]) / 3.0,
                    worn: (p[0] + p[1] + p[2]) / 3.0,
                }
            })
            .collect()
    }

    /// Width and height of the pattern's bounding box, in mm.
    #[must_use]
    pub fn size(&self) -> DVec2 {
        let used = || self.faces.iter().flatten().map(|&(_, vt)| self.vt[vt]);
        used().fold(DVec2::NEG_INFINITY, DVec2::max) - used().fold(DVec2::INFINITY, DVec2::min)
    }

    /// Area of the pattern, in mm²; what is face down counts as negative.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.stretches().iter().map(|s| s.area).sum()
    }

    /// How much fabric lies along the warp line at height `y`, in mm.
    #[must_use]
    pub fn width_at(&self, y: f64) -> f64 {
        self.chords(|p| DVec2::new(p.x, p.y - y))
    }

    /// How much fabric lies along the weft line at `x`, in mm.
    #[must_use]
    pub fn height_at(&self, x: f64) -> f64 {
        self.chords(|p| DVec2::new(p.y, p.x - x))
    }

    /// Total length of the line y = 0 inside triangles, seen through `turn`.
    fn chords(&self, turn: impl Fn(DVec2) -> DVec2) -> f64 {
        let mut total = 0.0;
        for face in &self.faces {
            let q = face.map(|(_, vt)| turn(self.vt[vt]));
            let crossings: Vec<f64> = (0..3)
                .filter_map(|k| {
                    let (a, b) = (q[k], q[(k + 1) % 3]);
                    // Half-open, so that a line through a corner counts once.
                    ((a.y < 0.0) != (b.y < 0.0)).then(|| a.x + (b.x - a.x) * a.y / (a.y - b.y))
                })
                .collect();
            if let [first, second] = crossings[..] {
                total += (first - second).abs();
            }
        }
        total
    }
}

fn coord(p: DVec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

/// Whether two segments have a point in common; exact.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p, q, r| {
        let value = orient2d(coord(p), coord(q), coord(r));
        if value > 0.0 {
            1
        } else if value < 0.0 {
            -1
        } else {
            0
        }
    };
    let (abc, abd) = (side(a, b, c), side(a, b, d));
    let (cda, cdb) = (side(c, d, a), side(c, d, b));
    if abc == 0 && abd == 0 {
        let over = |p: f64, q: f64, r: f64, s: f64| p.max(q) >= r.min(s) && r.max(s) >= p.min(q);
        return over(a.x, b.x, c.x, d.x) && over(a.y, b.y, c.y, d.y);
    }
    abc * abd <= 0 && cda * cdb <= 0
}

/// Largest distance of either outline from the other (closed polygons, in mm), after the rigid motion
/// that brings the first onto the second best (iterated closest points).
#[must_use]
pub fn outline_gap(a: &[DVec2], b: &[DVec2]) -> f64 {
    let edges = |p: &[DVec2]| -> Vec<[DVec2; 2]> {
        (0..p.len()).map(|k| [p[k], p[(k + 1) % p.len()]]).collect()
    };
    let dense = |p: &[DVec2]| -> Vec<DVec2> {
        let step = |[a, b]: &[DVec2; 2]| (a.distance(*b).ceil() as usize).max(1);
        edges(p)
            .iter()
            .flat_map(|e| (0..step(e)).map(|k| e[0].lerp(e[1], k as f64 / step(e) as f64)))
            .collect()
    };
    let closest = |p: DVec2, edges: &[[DVec2; 2]]| -> DVec2 {
        let on = |[a, b]: &[DVec2; 2]| {
            let along = *b - *a;
            let t = (p - *a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
            *a + t.clamp(0.0, 1.0) * along
        };
        let places = edges.iter().map(on);
        places.min_by(|x, y| x.distance(p).total_cmp(&y.distance(p))).expect("an outline has edges")
    };
    let mean = |p: &[DVec2]| p.iter().sum::<DVec2>() / p.len() as f64;
    let target = edges(b);
    let mut moved = dense(a);
    let first = mean(&dense(b)) - mean(&moved);
    moved.iter_mut().for_each(|p| *p += first);
    for _ in 0..15 {
        let onto: Vec<DVec2> = moved.iter().map(|&p| closest(p, &target)).collect();
        let (from, to) = (mean(&moved), mean(&onto));
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (p, q) in moved.iter().zip(&onto) {
            cosine += (*p - from).dot(*q - to);
            sine += (*p - from).perp_dot(*q - to);
        }
        let turn = DVec2::new(cosine, sine).normalize();
        moved.iter_mut().for_each(|p| *p = to + turn.rotate(*p - from));
    }
    let far = |points: &[DVec2], edges: &[[DVec2; 2]]| {
        points.iter().map(|&p| p.distance(closest(p, edges))).fold(0.0, f64::max)
    };
    far(&moved, &target).max(far(&dense(b), &edges(&moved)))
}

/// Largest distance, in mm, that is left between two lists of points after the one is turned and
/// moved (never mirrored) onto the other as well as it can be in the mean square.
///
/// # Panics
/// If the lists differ in length.
#[must_use]
pub fn congruence_gap(a: &[DVec2], b: &[DVec2]) -> f64 {
    assert_eq!(a.len(), b.len(), "as many points");
    let mean = |points: &[DVec2]| points.iter().sum::<DVec2>() / points.len() as f64;
    let (middle_a, middle_b) = (mean(a), mean(b));
    // As complex numbers the best rotation is the phase of Σ conj(a) b.
    let (mut dot, mut cross) = (0.0, 0.0);
    for (p, q) in a.iter().zip(b) {
        let (p, q) = (*p - middle_a, *q - middle_b);
        dot += p.dot(q);
        cross += p.perp_dot(q);
    }
    let turn = DVec2::from_angle(cross.atan2(dot));
    a.iter()
        .zip(b)
        .map(|(p, q)| turn.rotate(*p - middle_a).distance(*q - middle_b))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat strip of `n` squares of side 10, worn as `worn` says, pattern = the strip.
    fn strip(n: usize, worn: impl Fn(DVec2) -> DVec3) -> WornObj {
        let vt: Vec<DVec2> =
            (0..=n).flat_map(|i| [0.0, 1.0].map(|j| 10.0 * DVec2::new(i as f64, j))).collect();
        let both = |t: [usize; 3]| t.map(|i| (i, i));
        let faces = (0..n)
            .flat_map(|i| {
                let k = 2 * i;
                [both([k, k + 2, k + 3]), both([k, k + 3, k + 1])]
            })
            .collect();
        WornObj { v: vt.iter().map(|&p| worn(p)).collect(), vt, faces }
    }

    fn flat(p: DVec2) -> DVec3 {
        p.extend(0.0)
    }

    #[test]
    fn a_good_strip_has_no_fault() {
        let s = strip(4, flat);
        assert_eq!((s.flipped(), s.overlaps(), s.wound_twice()), (0, 0, 0));
        assert_eq!(s.outline().len(), 1);
        assert_eq!(s.outline()[0].len(), 10);
        assert!(s.seams().is_empty());
        assert_eq!(s.size(), DVec2::new(40.0, 10.0));
        assert!((s.area() - 400.0).abs() < 1e-12);
        assert!((s.width_at(3.3) - 40.0).abs() < 1e-12);
        assert!((s.height_at(12.0) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn a_flip_is_seen() {
        let mut s = strip(4, flat);
        // The lower corner between the second and third square goes up through the upper one:
        // the triangles with that side as an edge are turned over.
        s.vt[4].y = 15.0;
        assert_eq!(s.flipped(), 2);
        s.vt[4].y = 10.0;
        assert_eq!(s.flipped(), 2, "without area counts");
        for p in &mut s.vt {
            p.x = -p.x;
        }
        assert_eq!(s.flipped(), 8, "a mirrored pattern is face down");
    }

    #[test]
    fn a_crossing_of_the_outline_is_seen() {
        // A strip that bends back through its own beginning.
        let mut s = strip(4, flat);
        let places: [[f64; 2]; 10] = [
            [0.0, 0.0],
            [0.0, 10.0],
            [30.0, 0.0],
            [20.0, 10.0],
            [30.0, 30.0],
            [20.0, 20.0],
            [8.0, 30.0],
            [12.0, 20.0],
            [8.0, -5.0],
            [12.0, -5.0],
        ];
        for (p, place) in s.vt.iter_mut().zip(places) {
            *p = place.into();
        }
        // Both long sides of the last square cross both long sides of the first.
        assert_eq!(s.overlaps(), 4);
        s.vt[8].y = 12.0;
        s.vt[9].y = 12.0;
        assert_eq!(s.overlaps(), 0);
        s.vt[9].y = 10.0;
        assert_eq!(s.overlaps(), 2, "touching counts: both edges that end there");
    }

    #[test]
    fn fabric_laid_twice_round_a_vertex_is_seen() {
        // Six triangles round a vertex, 120° each: none flipped, two turns in all.
        let mut s = WornObj::default();
        for k in 0..6 {
            let angle = f64::from(k) * std::f64::consts::TAU / 3.0;
            s.vt.push(DVec2::from_angle(angle) * (10.0 + f64::from(k)));
            s.v.push(DVec2::from_angle(0.5 * angle).extend(0.0));
        }
        s.vt.push(DVec2::ZERO);
        s.v.push(DVec3::Z);
        s.faces = (0..6).map(|k| [(6, 6), (k, k), ((k + 1) % 6, (k + 1) % 6)]).collect();
        assert_eq!((s.flipped(), s.wound_twice()), (0, 1));
    }

    /// A strip of eight squares worn as a ring: its short sides coincide in space.
    fn ring() -> WornObj {
        strip(8, |p| {
            let angle = std::f64::consts::TAU * p.x / 80.0;
            DVec3::new(13.0 * angle.cos(), 13.0 * angle.sin(), p.y)
        })
    }

    #[test]
    fn a_seam_is_found_and_both_sides_measured() {
        let seams = ring().seams();
        assert_eq!(seams.len(), 1);
        assert_eq!(seams[0].pairs.len(), 1);
        assert!((seams[0].left_mm - 10.0).abs() < 1e-12);
        assert!((seams[0].worn_mm - 10.0).abs() < 1e-12);
        assert!(seams[0].worst_edge_mm < 1e-12);
    }

    #[test]
    fn a_seam_that_cannot_be_sewn_is_seen() {
        let mut s = ring();
        s.vt[1].y = 10.5;
        let seam = &s.seams()[0];
        assert!(((seam.left_mm - seam.right_mm).abs() - 0.5).abs() < 1e-12);
        assert!((seam.worst_edge_mm - 0.5).abs() < 1e-12);
        // Edges that differ while the whole agrees: a ring of three columns, two squares high.
        let mut s = WornObj::default();
        for (left, right) in [(0.0, 0.0), (11.0, 10.0), (20.0, 20.0)] {
            for (k, y) in [left, right, right, right].into_iter().enumerate() {
                s.vt.push(DVec2::new(10.0 * k as f64, y));
                let round = DVec2::from_angle(std::f64::consts::TAU * (k % 3) as f64 / 3.0);
                s.v.push((6.0 * round).extend(right));
            }
        }
        for k in [0, 1, 2, 4, 5, 6] {
            s.faces.extend([[k, k + 1, k + 5], [k, k + 5, k + 4]].map(|t| t.map(|i| (i, i))));
        }
        let seams = s.seams();
        assert_eq!((seams.len(), seams[0].pairs.len()), (1, 2));
        assert!((seams[0].left_mm - seams[0].right_mm).abs() < 1e-12);
        assert!((seams[0].worst_edge_mm - 1.0).abs() < 1e-12);
    }

    #[test]
    fn stretch_is_read_off_the_threads() {
        // Warp 1.25, weft 0.8, sheared by a tenth: F = [1.25 0.08; 0 0.8].
        let s = strip(3, |p| DVec3::new(1.25 * p.x + 0.08 * p.y, 0.8 * p.y, 7.0));
        for stretch in s.stretches() {
            assert!((stretch.warp - 1.25).abs() < 1e-12);
            assert!((stretch.weft - 0.8f64.hypot(0.08)).abs() < 1e-12);
            assert!((stretch.shear - 0.08 / 0.8f64.hypot(0.08)).abs() < 1e-12);
            assert!((stretch.area - 50.0).abs() < 1e-12);
        }
    }

    #[test]
    fn congruence_forgives_a_motion_and_nothing_else() {
        let a: Vec<DVec2> = strip(3, flat).vt;
        let turn = DVec2::from_angle(2.1);
        let b: Vec<DVec2> = a.iter().map(|&p| turn.rotate(p) + DVec2::new(-3.0, 8.0)).collect();
        assert!(congruence_gap(&a, &b) < 1e-12);
        let mirrored: Vec<DVec2> = a.iter().map(|p| DVec2::new(-p.x, p.y + 0.3 * p.x)).collect();
        assert!(congruence_gap(&a, &mirrored) > 1.0);
        let larger: Vec<DVec2> = a.iter().map(|&p| 1.01 * p).collect();
        assert!(congruence_gap(&a, &larger) > 0.1);
    }

    #[test]
    fn a_file_is_read_as_written() {
        let text = "# wovenfit\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 0 1\nf 1/1 2/2 3/3\n";
        let worn = WornObj::parse(text);
        assert_eq!(worn.faces, [[(0, 0), (1, 1), (2, 2)]]);
        assert!((worn.stretches()[0].warp - 0.5).abs() < 1e-15);
        let broken =
            std::panic::catch_unwind(|| WornObj::parse(&text.replace("vt 2 0", "vt NaN 0")));
        assert!(broken.is_err());
    }
}
