//! The cut line: the sew line with its allowances outside, an own one for every edge.
//!
//! Strips of cloth are laid outside the edges and united with the piece (crate `i_overlay`), so that
//! hollows and darts come out right without rules for them. Where a sewn side meets an edge, the
//! corner is cut as sewing wants it:
//!
//! - the allowance of an edge is turned over along it, so its side is the mirror image of the sewn
//!   side in that edge: turned over, it lies on the brace and is as edge as it;
//! - the sew line goes on along that mirror image, with its own allowance beside it;
//! - the end of the seam's allowance is the mirror image of the neighbouring cut edge in the sew line:
//!   pressed open, it ends where the brace ends.

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::edges::Edge;

/// A mitre reaches no farther from its corner than so many times the wider allowance.
const MITRE_LIMIT: f64 = 3.0;

/// Shapes smaller than this, in mm², are crumbs of rounding.
const CRUMB: f64 = 0.01;

/// How far strips reach into the piece, in mm: edges that are the same but for rounding would leave slits.
const LAP: f64 = 0.002;

/// How much larger than exact is what is cut off, in mm.
const HAIR: f64 = 0.05;

type Polygon = Vec<[f64; 2]>;

/// What the allowances make of a piece.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CutLine {
    /// Closed loops, outer ones first and counter-clockwise, then the cut-outs.
    pub(super) loops: Vec<Vec<DVec2>>,
    /// Sew lines that go on through the allowance of an edge.
    pub(super) extensions: Vec<[DVec2; 2]>,
}

/// The cut line of loops of edges.
pub(super) fn cut_line(loops: &[Vec<Edge>]) -> CutLine {
    let piece: Vec<Polygon> = loops.iter().map(|edges| polygon(&closed(edges))).collect();
    if loops.iter().flatten().all(|edge| edge.allowance == 0.0) {
        let loops = loops.iter().map(|edges| closed(edges)).collect();
        return CutLine { loops, extensions: Vec::new() };
    }
    let mut cloth = Cloth::default();
    for edges in loops {
        for (i, after) in edges.iter().enumerate() {
            let before = &edges[(i + edges.len() - 1) % edges.len()];
            cloth.along(after);
            if edges.len() > 1 {
                cloth.corner(before, after);
            } else {
                cloth.mitre(after, after);
            }
        }
    }
    // Edges first, for where their strips end at a sewn side the seam's allowance lies.
    let hems = cloth.hems.overlay(&cloth.beyond_hems, OverlayRule::Difference, FillRule::NonZero);
    let body = hems.overlay(&piece, OverlayRule::Union, FillRule::NonZero);
    let seams =
        cloth.seams.overlay(&cloth.beyond_seams, OverlayRule::Difference, FillRule::NonZero);
    let united = body.overlay(&seams, OverlayRule::Union, FillRule::NonZero);
    let mut all: Vec<Vec<DVec2>> = united
        .into_iter()
        .flatten()
        .map(|contour| contour.into_iter().map(DVec2::from).collect::<Vec<_>>())
        .filter(|contour| area(contour).abs() > CRUMB)
        .collect();
    all.sort_by(|a, b| area(b).total_cmp(&area(a)));
    CutLine { loops: all, extensions: cloth.extensions }
}

/// The closed polygon of the edges of a loop, the closing point not repeated.
pub(super) fn closed(edges: &[Edge]) -> Vec<DVec2> {
    edges
        .iter()
        .flat_map(|edge| edge.points.split_last().map_or(&[][..], |(_, rest)| rest))
        .copied()
        .collect()
}

/// Area inside a closed polygon in mm², positive if it turns counter-clockwise.
pub(super) fn area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

fn polygon(points: &[DVec2]) -> Polygon {
    points.iter().map(|p| p.to_array()).collect()
}

/// The same, counter-clockwise: cloth has no negative area.
fn cloth(points: &[DVec2]) -> Polygon {
    let mut polygon = polygon(points);
    if area(points) < 0.0 {
        polygon.reverse();
    }
    polygon
}

/// The unit normal to the right of a direction: outside, along a piece's edge.
pub(super) fn right(direction: DVec2) -> DVec2 {
    -direction.perp()
}

fn direction(from: DVec2, to: DVec2) -> DVec2 {
    (to - from).normalize_or_zero()
}

/// What is cut off a strip that ends square, from its corner and its square end to the line from the
/// corner to `end`; larger by a hair off that line, or rounding would leave threads. `on`: the way on
/// past the end of the strip.
fn beyond(corner: DVec2, end: DVec2, square: DVec2, on: DVec2) -> Polygon {
    let (along, out) = (HAIR * direction(corner, end), HAIR * direction(corner, square));
    cloth(&[corner, end + along, square + out + HAIR * on, corner + HAIR * on])
}

#[derive(Default)]
struct Cloth {
    hems: Vec<Polygon>,
    beyond_hems: Vec<Polygon>,
    seams: Vec<Polygon>,
    beyond_seams: Vec<Polygon>,
    extensions: Vec<[DVec2; 2]>,
}

impl Cloth {
    fn add(&mut self, sewn: bool, points: &[DVec2]) {
        let list = if sewn { &mut self.seams } else { &mut self.hems };
        if area(points) != 0.0 {
            list.push(cloth(points));
        }
    }

    /// A strip outside a segment, with a lap inside it that is gone at its ends.
    fn strip(&mut self, sewn: bool, [from, to]: [DVec2; 2], width: f64, out: DVec2) {
        let (lap, out) = (from.midpoint(to) - LAP * out, width * out);
        self.add(sewn, &[from, lap, to, to + out, from + out]);
    }

    /// The strips outside the segments of an edge, with mitres between them.
    fn along(&mut self, edge: &Edge) {
        if edge.allowance == 0.0 {
            return;
        }
        for pair in edge.points.windows(2) {
            let normal = right(direction(pair[0], pair[1]));
            self.strip(edge.sewn(), [pair[0], pair[1]], edge.allowance, normal);
        }
        for bend in edge.points.windows(3) {
            let [into, from] = [direction(bend[0], bend[1]), direction(bend[1], bend[2])];
            self.mitred(edge.sewn(), bend[1], [into, from], [edge.allowance; 2]);
        }
    }

    /// The corner between two edges of a loop.
    fn corner(&mut self, before: &Edge, after: &Edge) {
        match (before.sewn(), after.sewn()) {
            (true, false) => self.hemmed(before, after, true),
            (false, true) => self.hemmed(after, before, false),
            _ => self.mitre(before, after),
        }
    }

    fn mitre(&mut self, before: &Edge, after: &Edge) {
        let (Some([.., a, b]), [_, d, ..]) = (before.points.get(..), after.points.as_slice())
        else {
            return;
        };
        let turns = [direction(*a, *b), direction(*b, *d)];
        self.mitred(before.sewn(), *b, turns, [before.allowance, after.allowance]);
    }

    /// What fills the gap between two strips at an outward corner.
    fn mitred(&mut self, sewn: bool, at: DVec2, turns: [DVec2; 2], allowances: [f64; 2]) {
        let [into, from] = turns;
        let sine = into.perp_dot(from);
        if sine <= 1e-12 {
            return;
        }
        let [a, b] = allowances;
        let (one, other) = (at + a * right(into), at + b * right(from));
        // Where the two outer lines meet.
        let along = (other - one).perp_dot(from) / sine;
        let tip = one + along * into;
        let most = MITRE_LIMIT * a.max(b);
        if tip.distance(at) <= most {
            self.add(sewn, &[at, one, tip, other]);
        } else {
            self.add(sewn, &[at, one, other]);
        }
    }

    /// The corner between a sewn side and an edge; `ends`: the sewn side ends there, else it begins.
    fn hemmed(&mut self, sewn: &Edge, hem: &Edge, ends: bool) {
        let (side, edge) = (&sewn.points, &hem.points);
        let (corner, before, next) = if ends {
            (side[side.len() - 1], side[side.len() - 2], edge[1])
        } else {
            (side[0], side[1], edge[edge.len() - 2])
        };
        let (arriving, along) = (direction(before, corner), direction(corner, next));
        // Outside lies right of one who walks with the piece on the left.
        let outside = |walking: DVec2| if ends { right(walking) } else { -right(walking) };
        let mut tip = corner;
        let mut way = arriving;
        if hem.allowance > 0.0 {
            let h = hem.allowance;
            let out = outside(along);
            let back = -arriving;
            let mirrored = 2.0 * along.dot(back) * along - back;
            let rise = mirrored.dot(out);
            if rise > 1.0 / MITRE_LIMIT {
                tip = corner + mirrored * (h / rise);
                way = mirrored;
                let square = corner + h * out;
                let wedge = [corner, square, tip];
                if (tip - square).dot(along) < 0.0 {
                    self.add(false, &wedge);
                } else {
                    self.beyond_hems.push(beyond(corner, tip, square, -along));
                }
                self.extensions.push([corner, tip]);
            }
        }
        let a = sewn.allowance;
        if a == 0.0 {
            return;
        }
        if tip != corner {
            self.strip(true, [corner, tip], a, outside(way));
            let turns = if ends { [arriving, way] } else { [-way, -arriving] };
            self.mitred(true, corner, turns, [a; 2]);
        }
        // The end of the seam's allowance: the edge, mirrored in the sew line.
        let out = outside(way);
        let mirrored = 2.0 * along.dot(way) * way - along;
        let rise = mirrored.dot(out);
        if rise > 1.0 / MITRE_LIMIT {
            let end = tip + mirrored * (a / rise);
            let wedge = [tip, tip + a * out, end];
            if (end - (tip + a * out)).dot(way) > 0.0 {
                self.add(true, &wedge);
            } else {
                self.beyond_seams.push(beyond(tip, end, tip + a * out, way));
            }
        }
    }
}

#[cfg(test)]
#[path = "allowance_tests.rs"]
mod tests;
