//! Allowances that are too wide for their place, and the widest that are not.
//!
//! The outer end of an allowance must be the piece's outer end. Where it lies inside the piece, or
//! inside the allowance of a part of the outline farther along, the cut line would cross itself.
//! The two sides of a dart meet at its tip whatever the allowance is: there the cloth is not cut open.

use glam::DVec2;

use super::allowance::right;
use super::edges::{Edge, EdgeKind};

/// Neighbouring parts of an outline may overlap over so many times their allowance: a hollow corner of
/// 90 degrees takes twice. What is farther apart along the outline is a bay that would be closed.
const NEIGHBOURHOOD: f64 = 2.5;

/// How far an allowance may reach into another before it counts, in mm.
const SLACK: f64 = 0.2;

/// Halvings when the widest allowance is looked for: a 4,000th of what was asked.
const HALVINGS: usize = 12;

/// What is done about allowances that are too wide.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Adjusted {
    /// Edges made narrower: what they are, asked and used in mm, and a place in the pattern.
    pub(super) narrowed: Vec<Narrowed>,
    /// Darts that are not cut open down to their tip, by their seam: over how many mm.
    pub(super) closed_darts: Vec<(usize, f64)>,
}

/// An allowance that was made narrower.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Narrowed {
    pub(super) kind: EdgeKind,
    pub(super) asked: f64,
    pub(super) used: f64,
    pub(super) at: DVec2,
}

/// A part of the outline between two points.
struct Segment {
    of: [usize; 2],
    ends: [DVec2; 2],
    /// Where its middle is along its loop, in mm, and how long the loop is.
    at: f64,
    around: f64,
}

/// An overlap: which edge reaches into which, and where.
struct Overlap {
    edge: [usize; 2],
    into: Option<[usize; 2]>,
    at: DVec2,
    length: f64,
}

/// Makes allowances narrower where the cut line would cross itself.
pub(super) fn adjust(loops: &mut [Vec<Edge>]) -> Adjusted {
    let segments = segments(loops);
    let kind = |loops: &[Vec<Edge>], [l, e]: [usize; 2]| loops[l][e].kind;
    let dart = |loops: &[Vec<Edge>], o: &Overlap| match (kind(loops, o.edge), o.into) {
        (EdgeKind::Sewn(k, _), Some(into)) => {
            matches!(kind(loops, into), EdgeKind::Sewn(other, _) if other == k)
        }
        _ => false,
    };
    let bad = |loops: &[Vec<Edge>]| -> Vec<Overlap> {
        overlaps(loops, &segments).into_iter().filter(|o| !dart(loops, o)).collect()
    };
    let mut adjusted = Adjusted::default();
    let found = bad(loops);
    if !found.is_empty() {
        let mut involved: Vec<[usize; 2]> =
            found.iter().flat_map(|o| [Some(o.edge), o.into]).flatten().collect();
        involved.sort_unstable();
        involved.dedup();
        let asked: Vec<f64> = involved.iter().map(|&[l, e]| loops[l][e].allowance).collect();
        let set = |loops: &mut [Vec<Edge>], share: f64| {
            for (&[l, e], asked) in involved.iter().zip(&asked) {
                // Whole millimetres: what a workshop can draw.
                loops[l][e].allowance = if share < 1.0 { (share * asked).floor() } else { *asked };
            }
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            set(loops, middle);
            if bad(loops).is_empty() { low = middle } else { high = middle }
        }
        set(loops, low);
        for (&[l, e], &asked) in involved.iter().zip(&asked) {
            let edge = &loops[l][e];
            let place = found.iter().find(|o| o.edge == [l, e] || o.into == Some([l, e]));
            let at = place.map_or(DVec2::ZERO, |o| o.at);
            if edge.allowance < asked {
                let (kind, used) = (edge.kind, edge.allowance);
                adjusted.narrowed.push(Narrowed { kind, asked, used, at });
            }
        }
    }
    let darts = overlaps(loops, &segments);
    for overlap in darts.iter().filter(|o| dart(loops, o)) {
        let EdgeKind::Sewn(seam, _) = kind(loops, overlap.edge) else { continue };
        match adjusted.closed_darts.iter_mut().find(|(k, _)| *k == seam) {
            // Both sides are counted.
            Some((_, length)) => *length += 0.5 * overlap.length,
            None => adjusted.closed_darts.push((seam, 0.5 * overlap.length)),
        }
    }
    adjusted
}

fn segments(loops: &[Vec<Edge>]) -> Vec<Segment> {
    let mut all = Vec::new();
    for (l, edges) in loops.iter().enumerate() {
        let start = all.len();
        let mut run = 0.0;
        for (e, edge) in edges.iter().enumerate() {
            for pair in edge.points.windows(2) {
                let step = pair[0].distance(pair[1]);
                let ends = [pair[0], pair[1]];
                all.push(Segment { of: [l, e], ends, at: run + 0.5 * step, around: 0.0 });
                run += step;
            }
        }
        all[start..].iter_mut().for_each(|segment| segment.around = run);
    }
    all
}

fn overlaps(loops: &[Vec<Edge>], segments: &[Segment]) -> Vec<Overlap> {
    let allowance = |s: &Segment| loops[s.of[0]][s.of[1]].allowance;
    let mut found = Vec::new();
    for s in segments {
        let a = allowance(s);
        let [from, to] = s.ends;
        let Some(direction) = (to - from).try_normalize().filter(|_| a > 0.0) else { continue };
        let outer = from.midpoint(to) + a * right(direction);
        let far = |t: &&Segment| {
            let gap = (s.at - t.at).abs();
            let gap = gap.min(s.around - gap);
            let least = (NEIGHBOURHOOD * a.max(allowance(t))).min(s.around / 3.0);
            s.of[0] != t.of[0] || gap > least
        };
        let into = segments.iter().filter(far).find(|t| {
            // An allowance lies on the outer side of its edge. Where there is none the edge itself is not
            // to be crossed.
            outside(outer, t.ends) && distance(outer, t.ends) < allowance(t) - SLACK
                || crosses([from.midpoint(to), outer], t.ends)
        });
        if let Some(t) = into {
            let (edge, into, length) = (s.of, Some(t.of), from.distance(to));
            found.push(Overlap { edge, into, at: from.midpoint(to), length });
        }
    }
    found
}

/// Whether a point is on the outer side of a segment of an outline.
fn outside(p: DVec2, [a, b]: [DVec2; 2]) -> bool {
    (p - a).dot(right(b - a)) > 0.0
}

/// Distance of a point from a segment.
fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let part = ((p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + part * along)
}

/// Whether two segments cross.
fn crosses([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p) > 0.0;
    side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cutting::edges::Side;

    fn edge(kind: EdgeKind, allowance: f64, points: &[(f64, f64)]) -> Edge {
        Edge { kind, points: points.iter().map(|p| DVec2::from(*p)).collect(), allowance }
    }

    /// The walls of a slot 30 mm wide and 90 mm deep, in points 5 mm apart.
    fn slot(allowance: f64) -> Vec<Vec<Edge>> {
        let line = |from: DVec2, to: DVec2| -> Vec<(f64, f64)> {
            let parts = (from.distance(to) / 5.0).round() as u32;
            (0..=parts).map(|i| from.lerp(to, f64::from(i) / f64::from(parts)).into()).collect()
        };
        let p = [
            (0.0, 0.0),
            (130.0, 0.0),
            (130.0, 100.0),
            (80.0, 100.0),
            (80.0, 10.0),
            (50.0, 10.0),
            (50.0, 100.0),
            (0.0, 100.0),
            (0.0, 0.0),
        ]
        .map(DVec2::from);
        let points: Vec<(f64, f64)> = p.windows(2).flat_map(|w| line(w[0], w[1])).collect();
        vec![vec![edge(EdgeKind::Free, allowance, &points)]]
    }

    #[test]
    fn what_fits_is_left_and_what_does_not_is_made_as_wide_as_fits() {
        let mut narrow = slot(10.0);
        assert_eq!(adjust(&mut narrow), Adjusted::default());
        assert_eq!(narrow[0][0].allowance, 10.0);
        // The walls are 30 mm apart: 15 mm each.
        let mut wide = slot(22.0);
        let said = adjust(&mut wide);
        assert_eq!(said.narrowed.len(), 1);
        assert_eq!((said.narrowed[0].asked, said.narrowed[0].used), (22.0, 15.0));
        assert_eq!(wide[0][0].allowance, 15.0);
        assert!((45.0..85.0).contains(&said.narrowed[0].at.x));
    }

    #[test]
    fn a_hole_that_its_allowance_would_close_gets_less() {
        let ring: Vec<(f64, f64)> = (0..=60)
            .map(|i| {
                (12.0 * DVec2::from_angle(-f64::from(i) * std::f64::consts::TAU / 60.0)).into()
            })
            .collect();
        let mut hole = vec![vec![edge(EdgeKind::Free, 15.0, &ring)]];
        let said = adjust(&mut hole);
        assert_eq!(said.narrowed.len(), 1);
        assert!((11.0..=12.0).contains(&said.narrowed[0].used), "{said:?}");
    }

    #[test]
    fn a_dart_is_told_and_keeps_its_allowance() {
        // 20 mm wide at the mouth, 100 mm deep: narrower than 16 mm below 80 mm.
        let side = |from: (f64, f64), to: (f64, f64)| -> Vec<(f64, f64)> {
            let (from, to) = (DVec2::from(from), DVec2::from(to));
            (0..=50).map(|i| from.lerp(to, f64::from(i) / 50.0).into()).collect()
        };
        let mut dart = vec![vec![
            edge(EdgeKind::Sewn(2, Side::Left), 8.0, &side((60.0, 100.0), (50.0, 0.0))),
            edge(EdgeKind::Sewn(2, Side::Right), 8.0, &side((50.0, 0.0), (40.0, 100.0))),
            edge(
                EdgeKind::Top,
                0.0,
                &[
                    (40.0, 100.0),
                    (-20.0, 100.0),
                    (-20.0, -50.0),
                    (120.0, -50.0),
                    (120.0, 100.0),
                    (60.0, 100.0),
                ],
            ),
        ]];
        let said = adjust(&mut dart);
        assert!(said.narrowed.is_empty(), "{said:?}");
        assert_eq!(said.closed_darts.len(), 1);
        let (seam, length) = said.closed_darts[0];
        // The parts nearest to the tip are each other's neighbours.
        assert!(seam == 2 && (50.0..82.0).contains(&length), "{length}");
        assert_eq!(dart[0][0].allowance, 8.0);
    }
}
