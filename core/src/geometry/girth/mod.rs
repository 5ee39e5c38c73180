//! Girths and length of a limb, and whether its size is that of a limb.
//!
//! A centre line runs through the middles of the level sets of a function along the limb:
//! harmonic between the two end loops of a tube; of a slit limb, the function whose gradient
//! follows the axes of its own slabs; a seam whose two sides coincide is sewn shut before. A girth is the section across the centre line that closes
//! round it. Bent limbs are measured across their own axis, not across a global one.
//!
//! Limits: near ends that are cut askew a section does not close; it is measured as near to the
//! end as it closes, or left out. Of an open limb (a gap along it) the length is that between its
//! farthest ends, and the outermost sections may be scraps of an end cut askew.

mod axis;
mod section;
mod unit;

pub use unit::{UnitError, guard_unit};

use std::f64::consts::TAU;

use glam::DVec3;

use self::axis::{CentreLine, along_normals, between_loops, range};
use self::section::{Piece, plane_section};
use crate::surface::{Surface, VertexId};

/// A second boundary loop at least this share of the longest is the other end of a tube; a
/// shorter one is a cut-out. A thumb hole in a slit wrist brace has 0.15 of the outline's length;
/// the ankle has 0.4 of the thigh's girth.
const END_SHARE: f64 = 0.25;

/// Share of a slit limb's length left out at both ends of its centre line.
const INSET: f64 = 0.03;

/// How far pieces and gaps of a section may be from one whole turn, in radians: less than the
/// smallest gap that would be counted twice or left out on a tube.
const ONCE_ROUND: f64 = 0.2;

/// No more girths are measured: one every millimetre of a limb of two metres. What is longer is no
/// limb, and gets them farther apart.
const MOST_GIRTHS: f64 = 2000.0;

/// Parts of a step by which the first and last section move inward until they close.
const SLIDES: usize = 8;

/// The girth of a limb at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Girth {
    /// Distance along the centre line from the end with the longer loop, in mm.
    pub at_mm: f64,
    /// Length of the section of the surface there, in mm; across a cut-out of a tube as a tape
    /// measure goes, straight from rim to rim.
    pub girth_mm: f64,
    /// The place on the centre line, in mm.
    pub centre: DVec3,
    /// Unit direction of the centre line there, away from that end.
    pub direction: DVec3,
    /// Whether the surface goes all the way round; of a slit limb an open girth is shorter than the
    /// limb's by its gap.
    pub closed: bool,
}

/// The measures of a limb.
#[derive(Debug, Clone, PartialEq)]
pub struct Measures {
    /// Length of the centre line, in mm; 0 when none was found.
    pub length_mm: f64,
    /// Girths along the centre line; empty when the surface is not like a limb.
    pub girths: Vec<Girth>,
    /// Size along x, y and z, in mm.
    pub size_mm: DVec3,
    /// Area of the surface, in mm².
    pub area_mm2: f64,
}

impl Measures {
    /// The median girth in mm: of the closed ones if there are any, else of all; without any,
    /// π times the middle size of the surface.
    #[must_use]
    pub fn median_girth_mm(&self) -> f64 {
        let closed = self.girths.iter().any(|g| g.closed);
        let mut lengths: Vec<f64> =
            self.girths.iter().filter(|g| g.closed || !closed).map(|g| g.girth_mm).collect();
        lengths.sort_by(f64::total_cmp);
        lengths.get(lengths.len() / 2).copied().unwrap_or_else(|| {
            let mut size = self.size_mm.to_array();
            size.sort_by(f64::total_cmp);
            std::f64::consts::PI * size[1]
        })
    }
}

/// Measures a limb: its girths every `step_mm` (positive) along its centre line, from the end
/// with the longer loop.
#[must_use]
pub fn measure(surface: &Surface, step_mm: f64) -> Measures {
    let (low, high) = surface
        .points()
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
    let size_mm = if surface.vertex_count() == 0 { DVec3::ZERO } else { high - low };
    let mut measures =
        Measures { length_mm: 0.0, girths: Vec::new(), size_mm, area_mm2: surface.total_area() };
    let sewn = sewn_shut(surface);
    let surface = sewn.as_ref().unwrap_or(surface);
    if let Some(limb) = Limb::new(surface, size_mm.length()) {
        measures.length_mm = limb.line.length();
        measures.girths = limb.girths(step_mm);
        if !limb.tube && runs_backwards(&measures.girths) {
            let turned = Limb { function: limb.function.iter().map(|f| -f).collect(), ..limb };
            if let Some(line) = CentreLine::new(surface, &turned.function, INSET) {
                measures.girths = Limb { line, ..turned }.girths(step_mm);
            }
        }
    }
    measures
}

/// The surface with boundary vertices at the very same place made one: a limb cut along a seam is
/// whole again. `None` if there are none or they do not fit together.
fn sewn_shut(surface: &Surface) -> Option<Surface> {
    let mut boundary: Vec<VertexId> =
        surface.vertex_ids().filter(|&v| surface.is_boundary_vertex(v)).collect();
    let key = |v: VertexId| surface.point(v).to_array();
    let order = |a: VertexId, b: VertexId| {
        let (p, q) = (key(a), key(b));
        (0..3).fold(std::cmp::Ordering::Equal, |o, i| o.then(p[i].total_cmp(&q[i])))
    };
    boundary.sort_by(|&a, &b| order(a, b).then(a.cmp(&b)));
    let mut same: Vec<VertexId> = surface.vertex_ids().collect();
    for w in boundary.windows(2) {
        if order(w[0], w[1]).is_eq() {
            same[w[1].index()] = same[w[0].index()];
        }
    }
    let mut number = vec![None; same.len()];
    let mut points = Vec::new();
    for v in surface.vertex_ids().filter(|v| same[v.index()] == *v) {
        number[v.index()] = Some(VertexId::new(points.len()));
        points.push(surface.point(v));
    }
    if points.len() == same.len() {
        return None;
    }
    let mut triangles = Vec::with_capacity(surface.triangle_count());
    for t in surface.triangles() {
        let [a, b, c] = t.map(|v| number[same[v.index()].index()]);
        triangles.push([a?, b?, c?]);
    }
    Surface::new(points, triangles).ok()
}

/// Whether the last girth is longer than the first: a slit limb is then measured from its other
/// end. Equal ones, to a thousandth, stay.
fn runs_backwards(girths: &[Girth]) -> bool {
    match (girths.first(), girths.last()) {
        (Some(a), Some(b)) => b.girth_mm > a.girth_mm * 1.001,
        _ => false,
    }
}

struct Limb<'a> {
    surface: &'a Surface,
    function: Vec<f64>,
    line: CentreLine,
    tube: bool,
    /// Whether a vertex lies on an end loop of a tube.
    at_end: Vec<bool>,
}

impl<'a> Limb<'a> {
    /// The limb with its centre line; `None` if the surface has no direction along which it is
    /// one (a system that cannot be solved, a line longer than the surface's size allows).
    fn new(surface: &'a Surface, size: f64) -> Option<Self> {
        let loops = surface.boundary_loops();
        let lengths: Vec<f64> = loops.iter().map(|l| surface.loop_length(l)).collect();
        let mut order: Vec<usize> = (0..loops.len()).collect();
        order.sort_by(|&a, &b| lengths[b].total_cmp(&lengths[a]));
        let mut at_end = vec![false; surface.vertex_count()];
        let tube = order.len() >= 2 && lengths[order[1]] >= END_SHARE * lengths[order[0]];
        let function = if tube {
            for &end in &order[..2] {
                for v in surface.loop_vertices(&loops[end]) {
                    at_end[v.index()] = true;
                }
            }
            between_loops(surface, [order[0], order[1]]).ok()?
        } else {
            along_normals(surface).ok()?
        };
        let line = CentreLine::new(surface, &function, if tube { 0.0 } else { INSET })?;
        // A centre line within a box is rarely longer than its diagonals; one that is ten times
        // as long wanders and says nothing.
        let sane = line.length() > 0.0 && line.length() < 10.0 * size;
        sane.then_some(Self { surface, function, line, tube, at_end })
    }

    fn girths(&self, step: f64) -> Vec<Girth> {
        let length = self.line.length();
        let step = step.max(length / MOST_GIRTHS);
        // A plane through the very end only grazes it.
        let margin = self.surface.mean_edge_length().min(0.25 * length);
        // A length just short of a whole number of steps, by rounding or discretisation, is one.
        let count = (length / step + 1e-3).floor() as usize;
        (0..=count)
            .filter_map(|k| {
                let wanted = (k as f64 * step).clamp(margin, length - margin);
                let inward = match k {
                    0 => 1.0,
                    _ if length - wanted < 0.5 * step => -1.0,
                    _ => 0.0,
                };
                let slides = if inward == 0.0 { 0 } else { SLIDES / 2 };
                (0..=slides).find_map(|slide| {
                    let at = wanted + inward * slide as f64 * step / SLIDES as f64;
                    self.girth(at.clamp(margin, length - margin))
                })
            })
            .collect()
    }

    fn girth(&self, along: f64) -> Option<Girth> {
        let (centre, direction) = (self.line.at(along), self.line.direction(along));
        let pieces = plane_section(self.surface, centre, direction);
        let result = |girth_mm, closed| Girth { at_mm: along, girth_mm, centre, direction, closed };
        let touching = 1e-6 * self.surface.mean_edge_length();
        let round = pieces.iter().filter(|p| {
            let ends = p.points[0].distance(p.points[p.points.len() - 1]);
            (p.closed || ends <= touching) && p.turning(centre, direction).abs() > 6.0
        });
        // The innermost closed curve round the centre line: an elbow's other half may be met too.
        if let Some(closed) = round.map(Piece::length).min_by(f64::total_cmp) {
            return Some(result(closed, true));
        }
        let open: Vec<&Piece> =
            pieces.iter().filter(|p| !p.closed && self.belongs(p, along)).collect();
        if open.is_empty() || self.tube && open.iter().any(|p| self.meets_end(p)) {
            return None;
        }
        let length: f64 = open.iter().map(|p| p.length()).sum();
        let gaps = if self.tube { gaps(&open, centre, direction) } else { None };
        Some(result(length + gaps.unwrap_or(0.0), false))
    }

    /// Whether a piece lies at this place along the limb, rather than on another part of a bent
    /// limb that the same plane meets.
    fn belongs(&self, piece: &Piece, along: f64) -> bool {
        let (low, high) = range(&self.function);
        let places: Vec<f64> = piece
            .edges
            .iter()
            .map(|&h| {
                let value = self.function[self.surface.from(h).index()];
                self.line.along(value.clamp(low, high))
            })
            .collect();
        let mean = places.iter().sum::<f64>() / places.len() as f64;
        // A section of length g round the limb is some g / π wide, and as askew at most.
        (mean - along).abs() <= piece.length() / std::f64::consts::PI
    }

    fn meets_end(&self, piece: &Piece) -> bool {
        [piece.edges[0], piece.edges[piece.edges.len() - 1]].iter().any(|&h| {
            self.at_end[self.surface.from(h).index()] && self.at_end[self.surface.to(h).index()]
        })
    }
}

/// The straight lengths from each open piece to the next round the line through `centre` along
/// `axis`; `None` if pieces and gaps together do not go round it just once.
fn gaps(pieces: &[&Piece], centre: DVec3, axis: DVec3) -> Option<f64> {
    let turn: f64 = pieces.iter().map(|p| p.turning(centre, axis)).sum();
    let u = axis.any_orthonormal_vector();
    let v = axis.cross(u) * turn.signum();
    let ends = |p: &Piece| (p.points[0], p.points[p.points.len() - 1]);
    let angle = |p: DVec3| (p - centre).dot(v).atan2((p - centre).dot(u));
    let mut order: Vec<(DVec3, DVec3)> = pieces.iter().map(|p| ends(p)).collect();
    order.sort_by(|a, b| angle(a.0).total_cmp(&angle(b.0)));
    let next = |i: usize| order[(i + 1) % order.len()].0;
    let across = |i: usize| (angle(next(i)) - angle(order[i].1)).rem_euclid(TAU);
    let round = turn.abs() + (0..order.len()).map(across).sum::<f64>();
    ((round - TAU).abs() < ONCE_ROUND)
        .then(|| (0..order.len()).map(|i| order[i].1.distance(next(i))).sum())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::super::shapes::{cone, cylinder, grid, noisy, torus_point, torus_quarter};
    use super::*;

    fn near(got: f64, want: f64, share: f64) {
        assert!((got / want - 1.0).abs() < share, "{got} instead of {want}");
    }

    #[test]
    fn a_cylinder_has_one_girth_and_its_length() {
        let m = measure(&cylinder(40.0, 210.0, 4.0), 20.0);
        near(m.length_mm, 210.0, 1e-3);
        assert_eq!(m.girths.len(), 11);
        for (k, g) in m.girths.iter().enumerate().skip(1) {
            near(g.at_mm, 20.0 * k as f64, 1e-9);
        }
        for g in &m.girths {
            near(g.girth_mm, TAU * 40.0, 0.002);
            assert!(g.closed && g.direction.z.abs() > 0.9999, "{g:?}");
        }
        near(m.size_mm.z, 210.0, 1e-9);
    }

    #[test]
    fn a_cone_is_measured_from_its_wide_end() {
        let m = measure(&cone(60.0, 30.0, 200.0, 3.0), 25.0);
        near(m.length_mm, 200.0, 5e-3);
        assert_eq!(m.girths.len(), 9);
        for g in &m.girths {
            near(g.girth_mm, TAU * (60.0 - 30.0 * g.at_mm / 200.0), 0.003);
        }
        // The same limb the other way up is still measured from the wide end.
        let m = measure(&cone(30.0, 60.0, 200.0, 3.0), 25.0);
        assert!(m.girths[0].girth_mm > 1.8 * m.girths[8].girth_mm);
    }

    #[test]
    fn a_tube_bent_by_90_degrees_keeps_its_girth_with_noise_too() {
        let s = torus_quarter(100.0, 40.0, 2.5);
        for (s, share) in [(s.clone(), 0.003), (noisy(&s, 0.2, 5), 0.01)] {
            let m = measure(&s, 20.0);
            near(m.length_mm, FRAC_PI_2 * 100.0, 0.01);
            assert_eq!(m.girths.len(), 8);
            for g in &m.girths {
                assert!(g.closed);
                near(g.girth_mm, TAU * 40.0, share);
                near(g.centre.length(), 100.0, 0.005);
            }
        }
    }

    #[test]
    fn a_slit_or_half_open_limb_is_measured_along_its_axis() {
        let shut = grid(40, 60, false, |s, t| {
            let (sin, cos) = (TAU * (s % 1.0)).sin_cos();
            DVec3::new((50.0 - 10.0 * t) * cos, (50.0 - 10.0 * t) * sin, 150.0 * t)
        });
        let m = measure(&shut, 25.0);
        near(m.length_mm, 150.0, 0.01);
        for g in &m.girths {
            assert!(g.closed);
            near(g.girth_mm, TAU * (50.0 - 10.0 * g.at_mm / 150.0), 0.005);
        }
        // Three quarters of a ring, bent by 90°: open.
        let bent = grid(64, 60, false, |s, t| torus_point(100.0, 40.0, 0.6 + 0.75 * s, t));
        let m = measure(&bent, 20.0);
        assert!(m.girths.len() >= 8);
        for g in &m.girths {
            assert!(!g.closed);
            near(g.girth_mm, 0.75 * TAU * 40.0, 0.003);
        }
    }

    #[test]
    fn a_section_through_a_hole_is_measured_across_it_and_an_end_cut_askew_is_skipped() {
        let whole = cylinder(40.0, 200.0, 4.0);
        let inside = |p: DVec3| p.x > 35.0 && (p.z - 100.0).abs() < 15.0;
        let triangles = |keep: &dyn Fn(DVec3) -> bool| {
            let mut number = vec![None; whole.vertex_count()];
            let mut points = Vec::new();
            let mut kept = Vec::new();
            for t in whole.triangle_ids() {
                if whole.corners(t).iter().all(|&p| keep(p)) {
                    kept.push(whole.triangle(t).map(|v| {
                        *number[v.index()].get_or_insert_with(|| {
                            points.push(whole.point(v));
                            VertexId::new(points.len() - 1)
                        })
                    }));
                }
            }
            Surface::new(points, kept).unwrap()
        };
        let m = measure(&triangles(&|p| !inside(p)), 50.0);
        let open: Vec<bool> = m.girths.iter().map(|g| !g.closed).collect();
        assert_eq!(open, [false, false, true, false, false]);
        // The hole spans some 60° of the circle; its chord is a little shorter than its arc.
        let share = m.girths[2].girth_mm / (TAU * 40.0);
        assert!((0.98..0.995).contains(&share), "{share}");
        // Two holes on one height.
        let both = |p: DVec3| p.x.abs() > 35.0 && (p.z - 100.0).abs() < 15.0;
        let m = measure(&triangles(&|p| !both(p)), 50.0);
        let share = m.girths[2].girth_mm / (TAU * 40.0);
        assert!(!m.girths[2].closed && (0.96..0.99).contains(&share), "{share}");
        // 45° at the top: no section closes within 40 mm of the middle of the end.
        let m = measure(&triangles(&|p| p.z < 150.0 + p.x), 20.0);
        assert!(m.girths.iter().all(|g| g.closed), "{m:?}");
        near(m.median_girth_mm(), TAU * 40.0, 0.02);
    }
}
