//! A piece of the brace, ready to be drawn: what a cutter cuts and what a sewer reads off it.

use glam::DVec2;

use super::allowance::{CutLine, area, closed, cut_line};
use super::crossing::{Narrowed, adjust};
use super::edges::{Edge, EdgeKind, edges, length};
use super::notch::{Notch, notches};
use super::smooth::smooth;
use crate::design;
use crate::seams::CutSurface;
use crate::warning::Warning;

/// A piece; lengths in mm, x along warp, y along weft and up.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// What it is called; never empty.
    pub name: String,
    /// How often it is cut.
    pub quantity: usize,
    /// What it is cut from.
    pub material: String,
    /// Its sew line as loops of edges, the outer loop first and counter-clockwise, then the cut-outs.
    pub edges: Vec<Vec<Edge>>,
    /// What is cut: closed loops, the closing point not repeated, in the same order.
    pub cut: Vec<Vec<DVec2>>,
    /// Sew lines that go on through the allowance of an edge.
    pub extensions: Vec<[DVec2; 2]>,
    /// The notches of its sewn edges.
    pub notches: Vec<Notch>,
    /// Pressure points and orientation markers.
    pub marks: Vec<Mark>,
    /// What is sewn to what.
    pub seams: Vec<SeamNote>,
}

/// A side of a seam on this piece.
#[derive(Debug, Clone, PartialEq)]
pub struct SeamNote {
    /// The edge, by loop and place in it.
    pub edge: [usize; 2],
    /// The side's name, for example `seam 1 left`.
    pub name: String,
    /// What it is sewn to, for example `seam 1 right`.
    pub sewn_to: String,
    /// Its length, in mm.
    pub length_mm: f64,
}

/// What a mark shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkKind {
    /// A point where pressure was asked for.
    Pressure,
    /// The orientation marker near the body.
    Upper,
    /// The other orientation marker.
    Lower,
}

/// A point that is drilled or drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// What it shows.
    pub kind: MarkKind,
    /// Where, in mm.
    pub at: DVec2,
    /// What stands beside it; empty for markers.
    pub words: String,
}

/// What pieces are made from.
pub(crate) struct Wanted<'a> {
    pub cut: &'a CutSurface,
    pub coordinates: &'a [DVec2],
    pub piece: &'a design::Piece,
    /// The fabric's name.
    pub fabric: &'a str,
    pub marks: Vec<Mark>,
    /// Whether the outline crosses itself: it then gets no allowance.
    pub overlaps: bool,
}

/// The pieces of a pattern, and what the designer should know of them.
pub(crate) fn pieces(wanted: &Wanted<'_>) -> (Vec<Piece>, Vec<Warning>) {
    let mut warnings = Vec::new();
    let (mut all, names) = edges(wanted.cut, wanted.coordinates);
    let asked = allow(&mut all, wanted.piece);
    if asked && wanted.overlaps {
        all.iter_mut().flatten().flatten().for_each(|edge| edge.allowance = 0.0);
        warnings.push(Warning::new(
            "allowance_left_out",
            "the pattern's outline crosses itself: no allowance is drawn round it",
        ));
    } else if asked {
        for loops in &mut all {
            let adjusted = adjust(loops);
            warnings.extend(adjusted.narrowed.iter().map(|narrow| narrowed(narrow, &names)));
            warnings.extend(adjusted.closed_darts.iter().map(|dart| closed_dart(dart, &names)));
        }
    }
    let marks = shared_out(&all, &wanted.marks);
    let count = all.len();
    let pieces = all.into_iter().zip(marks).enumerate();
    let pieces = pieces.map(|(i, (loops, marks))| piece(wanted, loops, marks, &names, [i, count]));
    (pieces.collect(), warnings)
}

/// Smooths edges and gives each its allowance; tells whether any is wanted.
fn allow(all: &mut [Vec<Vec<Edge>>], design: &design::Piece) -> bool {
    for edge in all.iter_mut().flatten().flatten() {
        edge.points = smooth(&edge.points);
        edge.allowance = match edge.kind {
            EdgeKind::Sewn(..) => design.seam_allowance_mm,
            EdgeKind::Top => design.top_allowance_mm,
            EdgeKind::Bottom => design.bottom_allowance_mm,
            EdgeKind::Free => design.edge_allowance_mm,
        };
    }
    all.iter().flatten().flatten().any(|edge| edge.allowance > 0.0)
}

/// The marks of each piece: those inside it; what is on an edge between two goes to the nearer middle.
fn shared_out(all: &[Vec<Vec<Edge>>], marks: &[Mark]) -> Vec<Vec<Mark>> {
    let outlines: Vec<Vec<DVec2>> = all
        .iter()
        .map(|loops| loops.first().map_or_else(Vec::new, |edges| closed(edges)))
        .collect();
    let middle = |points: &[DVec2]| points.iter().sum::<DVec2>() / points.len().max(1) as f64;
    let mut shared = vec![Vec::new(); all.len()];
    for mark in marks {
        let inside = outlines.iter().position(|outline| winds_round(outline, mark.at));
        let gap = |points: &[DVec2]| middle(points).distance(mark.at);
        let nearest =
            || (0..outlines.len()).min_by(|&a, &b| gap(&outlines[a]).total_cmp(&gap(&outlines[b])));
        if let Some(piece) = inside.or_else(nearest) {
            shared[piece].push(mark.clone());
        }
    }
    shared
}

/// Whether a closed polygon goes round a point, even-odd.
fn winds_round(points: &[DVec2], p: DVec2) -> bool {
    let next = points.iter().cycle().skip(1);
    let crossings = points.iter().zip(next).filter(|(a, b)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossings.count() % 2 == 1
}

fn closed_dart((seam, length): &(usize, f64), names: &[String]) -> Warning {
    Warning::new(
        "dart_closed",
        format!(
            "the allowances of both sides of {} meet over {length:.0} mm towards the dart's tip: \
             it is not cut open there; sew along the sew lines and trim",
            names[*seam]
        ),
    )
}

fn narrowed(narrowed: &Narrowed, names: &[String]) -> Warning {
    let Narrowed { kind, asked, used, at } = *narrowed;
    let (what, key) = match kind {
        EdgeKind::Sewn(seam, _) => (names[seam].clone(), "seam_allowance_mm"),
        EdgeKind::Top => ("the top".to_owned(), "top_allowance_mm"),
        EdgeKind::Bottom => ("the bottom".to_owned(), "bottom_allowance_mm"),
        EdgeKind::Free => ("an edge".to_owned(), "edge_allowance_mm"),
    };
    Warning::new(
        "allowance_narrowed",
        format!(
            "with {asked} mm of allowance at {what} the cut line would cross itself near \
             ({:.0}, {:.0}) mm of the pattern: {used:.0} mm are used there; set piece.{key} to \
             {used:.0} or less",
            at.x, at.y
        ),
    )
}

/// A piece from its edges; `number` of `count`, from 0.
fn piece(
    wanted: &Wanted<'_>,
    edges: Vec<Vec<Edge>>,
    marks: Vec<Mark>,
    names: &[String],
    [number, count]: [usize; 2],
) -> Piece {
    let design = wanted.piece;
    let CutLine { loops, extensions } = cut_line(&edges);
    let text = |text: &str, otherwise: &str| {
        let text = text.trim();
        if text.is_empty() { otherwise.to_owned() } else { text.to_owned() }
    };
    let places = || edges.iter().enumerate().flat_map(|(l, e)| (0..e.len()).map(move |k| [l, k]));
    let seams = places()
        .filter_map(|place @ [l, e]| {
            let EdgeKind::Sewn(seam, side) = edges[l][e].kind else { return None };
            let sides = match side {
                super::Side::Left => ["left", "right"],
                super::Side::Right => ["right", "left"],
            };
            let [name, sewn_to] = sides.map(|side| format!("{} {side}", names[seam]));
            Some(SeamNote { edge: place, name, sewn_to, length_mm: length(&edges[l][e].points) })
        })
        .collect();
    let name = text(&design.name, "brace");
    Piece {
        name: if count == 1 { name } else { format!("{name} {}", number + 1) },
        quantity: design.quantity,
        material: text(&design.material, wanted.fabric),
        notches: edges
            .iter()
            .flatten()
            .flat_map(|edge| notches(edge, design.notch_spacing_mm))
            .collect(),
        cut: loops,
        extensions,
        marks,
        seams,
        edges,
    }
}

impl Piece {
    /// The smallest box round what is cut: its lower left and its upper right corner, in mm.
    #[must_use]
    pub fn bounds(&self) -> (DVec2, DVec2) {
        let points = self.cut.iter().flatten();
        points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
            (low.min(*p), high.max(*p))
        })
    }

    /// The sew line as closed loops, the outer one first.
    #[must_use]
    pub fn sew_loops(&self) -> Vec<Vec<DVec2>> {
        self.edges.iter().map(|edges| closed(edges)).collect()
    }

    /// Area inside the cut line, in mm²: what it takes of the fabric.
    #[must_use]
    pub fn cut_area(&self) -> f64 {
        self.cut.iter().map(|points| area(points)).sum()
    }
}

#[cfg(test)]
#[path = "piece_tests.rs"]
mod tests;
