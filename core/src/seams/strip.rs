//! A strip of triangles unfolded into the plane, and the shortest path within it.
//!
//! The triangles are laid side by side, true in length; the taut string through the portals
//! between them is found by the funnel (Lee & Preparata, *Euclidean shortest paths in the presence
//! of rectilinear barriers*, 1984).

use std::cell::RefCell;

use glam::DVec2;

use super::error::SeamError;
use super::path::{Bend, End, Path, Taut};
use super::triangulation::Triangulation;
use crate::surface::{HalfEdgeId, TriangleId};

/// Shortens the strip where that needs no geometry: turns round its ends, and steps back.
pub(super) fn reduce(mesh: &Triangulation, path: &mut Path) {
    let touches = |h: HalfEdgeId, end: End| match end {
        End::Vertex(v) => mesh.from(h) == v || mesh.to(h) == v,
        End::Boundary(..) => false,
    };
    let mut kept: Vec<HalfEdgeId> = Vec::with_capacity(path.crossings.len());
    for &h in &path.crossings {
        if touches(h, path.start) {
            kept.clear();
        } else if kept.last().is_some_and(|&last| mesh.twin(last) == Some(h)) {
            kept.pop();
        } else {
            kept.push(h);
        }
    }
    if let Some(first) = kept.iter().position(|&h| touches(h, path.end)) {
        kept.truncate(first);
    }
    path.crossings = kept;
}

/// The shapes of triangles that strips run through, each computed once: a path is pulled taut again
/// and again, with another end.
pub(super) struct Shapes<'a> {
    mesh: &'a Triangulation,
    /// Of each half-edge's triangle: where its apex is along the half-edge and beside it, in mm.
    /// Nothing lies beside before it was computed.
    apexes: RefCell<Vec<[f64; 2]>>,
}

impl<'a> Shapes<'a> {
    pub(super) fn new(mesh: &'a Triangulation) -> Self {
        Self { mesh, apexes: RefCell::new(vec![[0.0; 2]; mesh.half_edge_count()]) }
    }

    /// Where the apex of `h`'s triangle comes when `h` lies from `a` to `b`: on its left.
    fn apex(&self, h: HalfEdgeId, a: DVec2, b: DVec2) -> DVec2 {
        let mut apexes = self.apexes.borrow_mut();
        let known = &mut apexes[h.index()];
        if known[1] == 0.0 {
            *known = beside(self.mesh, h);
        }
        let [x, y] = *known;
        let along = (b - a).normalize_or_zero();
        a + x * along + y * along.perp()
    }

    /// Lays a triangle flat, counter-clockwise as seen from outside.
    fn lay(&self, t: TriangleId) -> [DVec2; 3] {
        let h = HalfEdgeId::of(t, 0);
        let b = DVec2::new(self.mesh.length(h), 0.0);
        [DVec2::ZERO, b, self.apex(h, DVec2::ZERO, b)]
    }
}

/// Where the apex of a half-edge's triangle is along the half-edge and to its left, in mm.
fn beside(mesh: &Triangulation, h: HalfEdgeId) -> [f64; 2] {
    let (p, q, o) = (mesh.point(mesh.from(h)), mesh.point(mesh.to(h)), mesh.point(mesh.apex(h)));
    let (edge, side) = (q - p, o - p);
    let length = edge.length();
    [side.dot(edge) / length, edge.cross(side).length() / length]
}

struct Unfolded {
    start: DVec2,
    end: DVec2,
    /// Start and end of each crossed half-edge.
    portals: Vec<(DVec2, DVec2)>,
    shore: Option<DVec2>,
}

fn unfold(shapes: &Shapes<'_>, path: &Path) -> Option<Unfolded> {
    let mesh = shapes.mesh;
    let first = match path.crossings.first() {
        Some(h) => h.triangle(),
        None => shared_triangle(mesh, path.start, path.end)?,
    };
    let mut triangle = first;
    let mut flat = shapes.lay(triangle);
    let start = locate(mesh, path.start, triangle, &flat)?;
    let mut portals = Vec::with_capacity(path.crossings.len());
    for &h in &path.crossings {
        if h.triangle() != triangle {
            return None;
        }
        let (a, b) = (flat[h.corner()], flat[(h.corner() + 1) % 3]);
        portals.push((a, b));
        let g = mesh.twin(h)?;
        let k = g.corner();
        triangle = g.triangle();
        flat[k] = b;
        flat[(k + 1) % 3] = a;
        flat[(k + 2) % 3] = shapes.apex(g, b, a);
    }
    let end = locate(mesh, path.end, triangle, &flat)?;
    let shore = match path.end {
        End::Boundary(h, _) => {
            Some((flat[(h.corner() + 1) % 3] - flat[h.corner()]).normalize_or_zero())
        }
        End::Vertex(_) => None,
    };
    Some(Unfolded { start, end, portals, shore })
}

fn shared_triangle(mesh: &Triangulation, start: End, end: End) -> Option<TriangleId> {
    let around = |end: End| match end {
        End::Vertex(v) => mesh.outgoing(v).into_iter().map(HalfEdgeId::triangle).collect(),
        End::Boundary(h, _) => vec![h.triangle()],
    };
    let near_end: Vec<TriangleId> = around(end);
    around(start).into_iter().find(|t| near_end.contains(t))
}

fn locate(mesh: &Triangulation, end: End, t: TriangleId, flat: &[DVec2; 3]) -> Option<DVec2> {
    match end {
        End::Vertex(v) => {
            let k = mesh.triangles()[t.index()].iter().position(|&w| w == v)?;
            Some(flat[k])
        }
        End::Boundary(h, part) => {
            (h.triangle() == t).then(|| flat[h.corner()].lerp(flat[(h.corner() + 1) % 3], part))
        }
    }
}

/// The taut string through a strip: the strip laid flat, the string's corners (the portal, whether on
/// its left, and the place) and its knots from end to end.
type Strung = (Unfolded, Vec<(usize, bool, DVec2)>, Vec<DVec2>);

fn string(shapes: &Shapes<'_>, path: &Path) -> Result<Strung, SeamError> {
    let flat = unfold(shapes, path)
        .ok_or_else(|| SeamError::Internal("the strip of a path is broken".to_owned()))?;
    let corners = funnel(&flat);
    let mut knots = vec![flat.start];
    knots.extend(corners.iter().map(|&(.., place)| place));
    knots.push(flat.end);
    Ok((flat, corners, knots))
}

/// Where the shortest path within the strip crosses each half-edge, as the part of the way from its
/// start.
pub(super) fn parts(shapes: &Shapes<'_>, path: &Path) -> Result<Vec<f64>, SeamError> {
    let (flat, corners, knots) = string(shapes, path)?;
    let mut parts = Vec::with_capacity(flat.portals.len());
    let mut piece = 0;
    for (i, &(p, q)) in flat.portals.iter().enumerate() {
        while corners.get(piece).is_some_and(|&(portal, ..)| portal < i) {
            piece += 1;
        }
        parts.push(crossing(knots[piece], knots[piece + 1], p, q));
    }
    Ok(parts)
}

/// The shortest path within the strip.
pub(super) fn pull(shapes: &Shapes<'_>, path: &Path) -> Result<Taut, SeamError> {
    let (flat, corners, knots) = string(shapes, path)?;
    let mesh = shapes.mesh;
    let length = knots.windows(2).map(|k| k[0].distance(k[1])).sum();
    let mut bends = Vec::with_capacity(corners.len());
    for (k, &(portal, left, place)) in corners.iter().enumerate() {
        let at =
            |i: usize| if left { mesh.to(path.crossings[i]) } else { mesh.from(path.crossings[i]) };
        let vertex = at(portal);
        let touches = |i: &usize| {
            mesh.from(path.crossings[*i]) == vertex || mesh.to(path.crossings[*i]) == vertex
        };
        let first = (0..=portal).rev().take_while(touches).last().unwrap_or(portal);
        let last = (portal..path.crossings.len()).take_while(touches).last().unwrap_or(portal);
        let turn = (place - knots[k]).angle_to(knots[k + 2] - place).abs();
        bends.push(Bend { vertex, left, first, last, turn });
    }
    let arrival = knots[knots.len() - 1] - knots[knots.len() - 2];
    Ok(Taut { length, parts: Vec::new(), bends, arrival, shore: flat.shore })
}

/// Where the segment `a b` crosses the portal `p q`, as the part of the way from `p`.
fn crossing(a: DVec2, b: DVec2, p: DVec2, q: DVec2) -> f64 {
    let part = (b - a).perp_dot(a - p) / (b - a).perp_dot(q - p);
    if part.is_finite() {
        part.clamp(0.0, 1.0)
    } else if a.distance_squared(q) < a.distance_squared(p) {
        1.0
    } else {
        0.0
    }
}

fn funnel(flat: &Unfolded) -> Vec<(usize, bool, DVec2)> {
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    let count = flat.portals.len();
    let mut corners: Vec<(usize, bool, DVec2)> = Vec::new();
    let mut apex = flat.start;
    let (mut left, mut right) = (apex, apex);
    let (mut left_at, mut right_at) = (0, 0);
    let mut i = 0;
    while i <= count {
        let (r, l) = if i < count { flat.portals[i] } else { (flat.end, flat.end) };
        let mut corner = None;
        if turn(apex, right, r) >= 0.0 {
            if apex == right || turn(apex, left, r) < 0.0 {
                (right, right_at) = (r, i);
            } else {
                corner = Some((left_at, true, left));
            }
        }
        if corner.is_none() && turn(apex, left, l) <= 0.0 {
            if apex == left || turn(apex, right, l) > 0.0 {
                (left, left_at) = (l, i);
            } else {
                corner = Some((right_at, false, right));
            }
        }
        if let Some((portal, is_left, place)) = corner {
            if portal >= count {
                break;
            }
            if corners.last().is_none_or(|&(.., last)| last != place) {
                corners.push((portal, is_left, place));
            }
            apex = place;
            (left, right) = (apex, apex);
            (left_at, right_at) = (portal, portal);
            i = portal;
        }
        i += 1;
    }
    corners
}
