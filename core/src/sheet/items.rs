//! What is drawn of one piece, in its own coordinates.

use glam::DVec2;

use super::room::{Room, Turned, edges};
use super::width::width;
use super::{Item, Layer, Shape, SheetUnit};
use crate::cutting::{EdgeKind, MarkKind, Piece, Side, along, length};

/// Size of small and large words, in mm.
const SMALL: f64 = 3.5;
const LARGE: f64 = 5.0;
/// Words that find no place are tried so much smaller, and left out below it.
const SMALLER: f64 = 0.75;
/// Upright lines that are tried over the width for the grain arrow.
const TRIALS: u32 = 32;
/// How far the grain arrow keeps from marks, in mm.
const CLEARANCE: f64 = 10.0;
/// The longest arrow, in mm.
const LONGEST: f64 = 160.0;
/// Lengths that are tried for the stretch arrow, in mm.
const STRETCHES: [f64; 5] = [100.0, 70.0, 50.0, 35.0, 20.0];

/// The items of a piece, and words that found no place on it. `suffix` makes its names unique.
pub(super) fn items(piece: &Piece, unit: SheetUnit, suffix: &str) -> (Vec<Item>, Vec<String>) {
    let loops = piece.sew_loops();
    let mut drawn = Drawn { piece, unit, suffix, items: Vec::new(), left_over: Vec::new() };
    let mut room = Room::new(&loops);
    drawn.lines();
    drawn.notches(&mut room);
    drawn.marks(&mut room);
    drawn.grain(&loops, &mut room);
    drawn.stretch(&mut room);
    drawn.ends(&mut room);
    drawn.sides(&mut room);
    drawn.values(&mut room);
    drawn.about(&mut room);
    (drawn.items, drawn.left_over)
}

struct Drawn<'a> {
    piece: &'a Piece,
    unit: SheetUnit,
    suffix: &'a str,
    items: Vec<Item>,
    left_over: Vec<String>,
}

impl Drawn<'_> {
    fn add(&mut self, layer: Layer, id: &str, shape: Shape) {
        let id = if id.is_empty() { String::new() } else { format!("{id}{}", self.suffix) };
        self.items.push(Item { layer, id, shape });
    }

    fn line(&mut self, layer: Layer, id: &str, points: &[DVec2], closed: bool) {
        self.add(layer, id, Shape::Line { points: points.to_vec(), closed });
    }

    /// Writes words near a place, turned by an angle; tells whether there was room.
    fn words(&mut self, room: &mut Room<'_>, text: &str, at: DVec2, size: f64, angle: f64) -> bool {
        for size in [size, SMALLER * size] {
            let wanted = Turned::new(at, width(text, size), size, angle);
            if let Some(place) = room.claim(wanted) {
                let text = text.to_owned();
                let at = place.middle;
                let words = Shape::Words { at, size, angle, from_start: false, text };
                self.add(Layer::Text, "", words);
                return true;
            }
        }
        false
    }

    fn lines(&mut self) {
        let piece = self.piece;
        for (i, points) in piece.cut.iter().enumerate() {
            if i == 0 {
                self.line(Layer::Cut, "outline", points, true);
            } else {
                self.line(Layer::CutOut, &format!("cut_out_{i}"), points, true);
            }
        }
        for (l, edges) in piece.edges.iter().enumerate() {
            for (e, edge) in edges.iter().enumerate() {
                match edge.kind {
                    EdgeKind::Sewn(_, side) => {
                        let note = piece.seams.iter().find(|note| note.edge == [l, e]);
                        let id = note.map_or_else(String::new, |note| note.name.replace(' ', "_"));
                        // From the seam's start, both sides alike.
                        let mut points = edge.points.clone();
                        if side == Side::Right {
                            points.reverse();
                        }
                        self.line(Layer::Sew, &id, &points, false);
                    }
                    _ if edge.allowance > 0.0 => self.line(Layer::Sew, "", &edge.points, false),
                    _ => {}
                }
            }
        }
        for extension in &piece.extensions {
            self.line(Layer::Sew, "", extension, false);
        }
    }

    fn notches(&mut self, room: &mut Room<'_>) {
        for notch in &self.piece.notches {
            self.line(Layer::Notch, "", &[notch.at, notch.end], false);
            room.take(Turned::new(notch.end, 2.0, 2.0, 0.0));
        }
    }

    fn marks(&mut self, room: &mut Room<'_>) {
        for mark in &self.piece.marks {
            let at = mark.at;
            room.take(Turned::new(at, 5.0, 5.0, 0.0));
            match mark.kind {
                MarkKind::Pressure => {
                    self.add(Layer::Mark, "", Shape::Circle { centre: at, radius: 1.2 });
                    let (x, y) = (DVec2::new(2.0, 0.0), DVec2::new(0.0, 2.0));
                    self.line(Layer::Mark, "", &[at - x, at + x], false);
                    self.line(Layer::Mark, "", &[at - y, at + y], false);
                }
                MarkKind::Upper | MarkKind::Lower => {
                    let id =
                        if mark.kind == MarkKind::Upper { "marker_top" } else { "marker_bottom" };
                    let corners =
                        [DVec2::Y, DVec2::X, DVec2::NEG_Y, DVec2::NEG_X].map(|d| at + 1.8 * d);
                    self.line(Layer::Mark, id, &corners, true);
                }
            }
        }
    }

    /// The values beside pressure points.
    fn values(&mut self, room: &mut Room<'_>) {
        for mark in &self.piece.marks {
            if mark.words.is_empty() {
                continue;
            }
            let aside = DVec2::new(4.0 + 0.5 * width(&mark.words, SMALL), 0.0);
            let best = Turned::new(mark.at + aside, width(&mark.words, SMALL), SMALL, 0.0);
            let at = if room.free(&best) { mark.at + aside } else { mark.at - aside };
            if !self.words(room, &mark.words, at, SMALL, 0.0) {
                self.left_over.push(format!(
                    "{} at ({:.0}, {:.0}) mm of the piece",
                    mark.words, mark.at.x, mark.at.y
                ));
            }
        }
    }

    /// An upright arrow with both heads where there is most room, and what it says.
    fn grain(&mut self, loops: &[Vec<DVec2>], room: &mut Room<'_>) {
        let Some([bottom, top]) = upright(loops, self.piece) else { return };
        let middle = bottom.midpoint(top);
        let reach = (0.25 * (top.y - bottom.y)).min(0.5 * LONGEST);
        let (from, to) = (middle - reach * DVec2::Y, middle + reach * DVec2::Y);
        self.arrow(Layer::Grain, from, to);
        room.take(Turned::new(middle, 4.0, 2.0 * reach, 0.0));
        let words = "grain: weft, along the limb";
        let beside = middle - DVec2::new(SMALL + 1.0, 0.0);
        let _ = self.words(room, words, beside, SMALL, 90.0);
    }

    /// A level arrow with both heads: the way the brace is stretched.
    fn stretch(&mut self, room: &mut Room<'_>) {
        let (low, high) = self.piece.bounds();
        let wanted = DVec2::new(0.5 * (low.x + high.x), low.y + 0.35 * (high.y - low.y));
        for reach in STRETCHES {
            let place = room.claim(Turned::new(wanted, reach, 2.0 * SMALL + 4.0, 0.0));
            let Some(place) = place else { continue };
            let at = place.middle - DVec2::new(0.0, 0.5 * SMALL);
            let half = DVec2::new(0.5 * reach, 0.0);
            self.arrow(Layer::Stretch, at - half, at + half);
            let text = ["stretch: warp, round the limb", "stretch: warp", "stretch"]
                .into_iter()
                .find(|text| width(text, SMALL) < reach);
            if let Some(text) = text {
                let at = at + DVec2::new(0.0, SMALL);
                let text = text.to_owned();
                let words = Shape::Words { at, size: SMALL, angle: 0.0, from_start: false, text };
                self.add(Layer::Text, "", words);
            }
            return;
        }
        self.left_over.push("Stretch: across, round the limb.".to_owned());
    }

    fn arrow(&mut self, layer: Layer, from: DVec2, to: DVec2) {
        self.line(layer, layer.name(), &[from, to], false);
        let way = (to - from).normalize_or_zero();
        for (tip, way) in [(to, way), (from, -way)] {
            let arm = |side: f64| tip - 4.0 * way + 1.5 * side * way.perp();
            self.line(layer, "", &[arm(1.0), tip, arm(-1.0)], false);
        }
    }

    /// "top" and "bottom" inside the ends.
    fn ends(&mut self, room: &mut Room<'_>) {
        for (kind, text) in [(EdgeKind::Top, "top: near the body"), (EdgeKind::Bottom, "bottom")] {
            let runs = self.piece.edges.iter().flatten().filter(|edge| edge.kind == kind);
            let Some(longest) = runs.max_by(|a, b| length(&a.points).total_cmp(&length(&b.points)))
            else {
                continue;
            };
            let points = longest.points.clone();
            self.beside(room, &points, text, LARGE, 0.5);
        }
    }

    /// What each sewn side is called and what it is sewn to.
    fn sides(&mut self, room: &mut Room<'_>) {
        for note in &self.piece.seams {
            let [l, e] = note.edge;
            let points = &self.piece.edges[l][e].points;
            let long = format!(
                "{}: {}, sewn to {}",
                note.name,
                self.unit.words(note.length_mm),
                note.sewn_to
            );
            let short = format!("{}: {}", note.name, self.unit.words(note.length_mm));
            let fits = |text: &str| width(text, SMALL) < 0.8 * length(points);
            let text = [long, short.clone(), note.name.clone()].into_iter().find(|t| fits(t));
            match text {
                Some(text) => self.beside(room, points, &text, SMALL, 0.5),
                None => self.left_over.push(short),
            }
        }
    }

    /// Words inside an edge, along it.
    fn beside(&mut self, room: &mut Room<'_>, points: &[DVec2], text: &str, size: f64, share: f64) {
        let total = length(points);
        let at = |part: f64| along(points, part * total).map(|(p, _)| p);
        let (Some(p), Some(a), Some(b)) = (at(share), at(share - 0.1), at(share + 0.1)) else {
            return;
        };
        // The direction over a fifth of the line; the piece lies left of it.
        let way = (b - a).normalize_or_zero();
        let degrees = way.y.atan2(way.x).to_degrees();
        let angle = if degrees > 90.0 {
            degrees - 180.0
        } else if degrees <= -90.0 {
            degrees + 180.0
        } else {
            degrees
        };
        let place = p + (0.5 * size + 5.0) * way.perp();
        if !self.words(room, text, place, size, angle) {
            self.left_over.push(text.to_owned());
        }
    }

    /// The name, and how often it is cut from what.
    fn about(&mut self, room: &mut Room<'_>) {
        let (low, high) = self.piece.bounds();
        let middle = DVec2::new(0.5 * (low.x + high.x), low.y + 0.65 * (high.y - low.y));
        let cut = format!("cut {} \u{d7} from {}", self.piece.quantity, self.piece.material);
        let widest = 0.6 * (high.x - low.x);
        let name = super::width::wrapped(&self.piece.name, LARGE, widest.max(20.0)).join(" ");
        let lines = [(name, LARGE), (cut, SMALL)];
        for (i, (text, size)) in lines.into_iter().enumerate() {
            let at = middle - DVec2::new(0.0, 8.0 * i as f64);
            if !self.words(room, &text, at, size, 0.0) && !self.words(room, &text, at, size, 90.0) {
                self.left_over.push(text);
            }
        }
    }
}

/// A long upright stretch inside loops, away from marks if there is one: its lower and upper end.
fn upright(loops: &[Vec<DVec2>], piece: &Piece) -> Option<[DVec2; 2]> {
    let points = || loops.iter().flatten();
    let low = points().map(|p| p.x).fold(f64::INFINITY, f64::min);
    let high = points().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
    let middle = f64::from(TRIALS) / 2.0;
    let mut best: Option<(f64, [DVec2; 2])> = None;
    for trial in 1..TRIALS {
        // A hair off the grid, so that no line runs through a vertex at a round coordinate.
        let x = low + (high - low) * (f64::from(trial) / f64::from(TRIALS) + 1e-7);
        let Some(stretch) = longest_at(loops, x) else { continue };
        let crowded = piece.marks.iter().any(|mark| (mark.at.x - x).abs() < CLEARANCE);
        // Beside the middle, which is for the name.
        let aside = (f64::from(trial) - 0.5 * middle).abs() / middle;
        let score =
            (stretch[1].y - stretch[0].y) * (1.0 - 0.2 * aside) * if crowded { 0.5 } else { 1.0 };
        if best.is_none_or(|(most, _)| score > most) {
            best = Some((score, stretch));
        }
    }
    best.map(|(_, stretch)| stretch)
}

fn longest_at(loops: &[Vec<DVec2>], x: f64) -> Option<[DVec2; 2]> {
    let mut heights: Vec<f64> = edges(loops)
        .filter(|(a, b)| (a.x > x) != (b.x > x))
        .map(|(a, b)| a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y))
        .collect();
    heights.sort_by(f64::total_cmp);
    let pairs = heights.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
    pairs
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))
        .map(|pair| pair.map(|y| DVec2::new(x, y)))
}
