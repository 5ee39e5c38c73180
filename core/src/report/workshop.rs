//! The workshop sheet: what goes to the bench with the pattern, as titled tables of words.
//!
//! Said once and printed twice, on the report's page and as the last page of a PDF. Pressures, strains
//! and girths in it are computed, not measured.

use glam::DVec2;

use super::girth::GirthPair;
use super::json::Report;
use crate::cutting::{LENGTH_TOLERANCE, Piece, TOLERANCE};
use crate::field::Field;
use crate::sheet::{SheetUnit, allowances};
use crate::units::mmhg_from_kpa;

/// Bands along the limb in which stretch is told.
const BANDS: usize = 5;

/// Most rows of pressures and of girths; the report has all.
const MOST_ROWS: usize = 24;

/// The workshop sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Workshop {
    /// What it is of.
    pub title: String,
    /// Its tables.
    pub sections: Vec<Section>,
}

/// A table with its title.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// What it tells.
    pub title: &'static str,
    /// Heads of its columns; none where the first column names the second.
    pub head: Vec<&'static str>,
    /// Its rows, a text a column.
    pub rows: Vec<Vec<String>>,
    /// What is said below it.
    pub notes: Vec<String>,
}

/// What the sheet is made from.
pub struct WorkshopInput<'a> {
    /// Every figure.
    pub report: &'a Report,
    /// The pieces.
    pub pieces: &'a [Piece],
    /// Girths of limb and pattern.
    pub girths: &'a [GirthPair],
    /// Strains at the vertices.
    pub field: &'a Field,
    /// The vertices' places in the pattern, in mm.
    pub coordinates: &'a [DVec2],
    /// The SHA-256 of the design, and whether it is that of its file.
    pub design_sha256: (String, bool),
    /// The unit of lengths.
    pub unit: SheetUnit,
}

/// The workshop sheet of a result.
#[must_use]
pub fn workshop(input: &WorkshopInput<'_>) -> Workshop {
    let piece = &input.report.piece;
    let name = input.pieces.first().map_or("brace", |_| match piece.name.trim() {
        "" => "brace",
        name => name,
    });
    let mut sections = vec![about(input), warnings(input), pressures(input), seams(input)];
    sections.extend([stretch(input), donning(input), girths(input), origin(input)]);
    sections.retain(|section| !section.rows.is_empty() || !section.notes.is_empty());
    Workshop { title: format!("{name}: workshop sheet"), sections }
}

fn pair(name: &str, value: impl Into<String>) -> Vec<String> {
    vec![name.to_owned(), value.into()]
}

fn percent(part: f64) -> String {
    let text = format!("{:.1} %", 100.0 * part);
    if text == "-0.0 %" { "0.0 %".to_owned() } else { text }
}

fn about(input: &WorkshopInput<'_>) -> Section {
    let report = input.report;
    let fabric = &report.fabric;
    let unit = input.unit;
    let mut rows = Vec::new();
    for (name, text) in [("Reference", &report.piece.reference), ("Date", &report.piece.date)] {
        if !text.trim().is_empty() {
            rows.push(pair(name, text.trim()));
        }
    }
    for piece in input.pieces {
        let (low, high) = piece.bounds();
        let size = high - low;
        rows.push(pair(
            &piece.name,
            format!(
                "cut {} \u{d7} from {}; {} \u{d7} {}, {:.0} cm\u{b2} of fabric each",
                piece.quantity,
                piece.material,
                unit.words(size.x),
                unit.words(size.y),
                piece.cut_area() / 100.0
            ),
        ));
    }
    rows.push(pair("Allowances", allowances(input.pieces, unit)));
    rows.push(pair("Fabric", fabric.name.as_str()));
    rows.push(pair(
        "Stiffness (force per width at strain 1)",
        format!(
            "warp {} N/mm, weft {} N/mm, diagonal {} N/mm",
            fabric.warp, fabric.weft, fabric.diagonal
        ),
    ));
    rows.push(pair("Largest strain that it bears", percent(fabric.max_strain)));
    rows.push(pair(
        "Threads",
        "weft along the grain arrow, along the limb; warp across, round the limb: the way it is \
         stretched",
    ));
    Section { title: "Piece and fabric", rows, ..Section::default() }
}

fn warnings(input: &WorkshopInput<'_>) -> Section {
    let all = input.report.warnings.iter().enumerate();
    let notes = all.map(|(i, warning)| format!("{}. {}", i + 1, warning.message));
    Section { title: "Warnings", notes: notes.collect(), ..Section::default() }
}

fn pressures(input: &WorkshopInput<'_>) -> Section {
    let all = &input.report.pressures;
    let rows = all.iter().take(MOST_ROWS).enumerate().map(|(i, p)| {
        let both = |kpa: f64| format!("{:.1} mmHg ({kpa:.2} kPa)", mmhg_from_kpa(kpa));
        vec![
            (i + 1).to_string(),
            both(p.asked_kpa),
            p.got_kpa.map_or_else(|| "\u{2013}".to_owned(), both),
            p.warp_strain.map_or_else(|| "\u{2013}".to_owned(), percent),
            if p.reason.is_some() { "missed" } else { "reached" }.to_owned(),
        ]
    });
    let mut notes = Vec::new();
    if all.len() > MOST_ROWS {
        notes.push(format!("And {} more: see report.json.", all.len() - MOST_ROWS));
    }
    if !all.is_empty() {
        notes.push("Computed by a model, not measured.".to_owned());
    }
    Section {
        title: "Pressures",
        head: vec!["point", "wanted", "computed, not measured", "warp strain", ""],
        rows: rows.collect(),
        notes,
    }
}

fn seams(input: &WorkshopInput<'_>) -> Section {
    let sides: Vec<_> = input.pieces.iter().flat_map(|piece| &piece.seams).collect();
    let rows = sides.iter().filter(|side| side.name.ends_with("left")).map(|left| {
        let right = sides.iter().find(|side| side.name == left.sewn_to);
        let other = right.map_or(left.length_mm, |right| right.length_mm);
        vec![
            left.name.trim_end_matches(" left").to_owned(),
            input.unit.words(left.length_mm),
            input.unit.words(other),
            format!("{:.2} mm", (left.length_mm - other).abs()),
        ]
    });
    Section {
        title: "Seams",
        head: vec!["seam", "left side", "right side", "differ by"],
        rows: rows.collect(),
        notes: vec![format!(
            "Sew start to start, notch on notch; the first notch from the start is double. Edges are \
             smoothed within {TOLERANCE} mm; each side keeps its length within {LENGTH_TOLERANCE} mm."
        )],
    }
}

fn stretch(input: &WorkshopInput<'_>) -> Section {
    let heights = || input.coordinates.iter().map(|p| p.y);
    let low = heights().fold(f64::INFINITY, f64::min);
    let high = heights().fold(f64::NEG_INFINITY, f64::max);
    let field = input.field;
    let rows = (0..BANDS).filter_map(|band| {
        // From the top, near the body.
        let [from, to] = [band, band + 1].map(|k| high - (high - low) * k as f64 / BANDS as f64);
        let inside = |i: &usize| (to..=from).contains(&input.coordinates[*i].y);
        let there: Vec<usize> = (0..input.coordinates.len()).filter(inside).collect();
        let area: f64 = there.iter().map(|&i| field.area_mm2[i]).sum();
        if area <= 0.0 {
            return None;
        }
        let mean =
            |of: &[f64]| there.iter().map(|&i| field.area_mm2[i] * of[i]).sum::<f64>() / area;
        let extreme = |of: &[f64], pick: fn(f64, f64) -> f64, from: f64| {
            there.iter().map(|&i| of[i]).fold(from, pick)
        };
        let least = extreme(&field.warp_strain, f64::min, f64::INFINITY);
        let most = extreme(&field.warp_strain, f64::max, f64::NEG_INFINITY);
        Some(vec![
            format!("{} to {}", input.unit.words(high - from), input.unit.words(high - to)),
            percent(mean(&field.warp_strain)),
            format!("{} to {}", percent(least), percent(most)),
            percent(mean(&field.weft_strain)),
        ])
    });
    Section {
        title: "Stretch when worn, by region",
        head: vec!["from the top", "warp, mean", "warp, least to most", "weft, mean"],
        rows: rows.collect(),
        notes: Vec::new(),
    }
}

/// Whether it can be put on: each part of the brace passes over what is beyond it on the limb.
fn donning(input: &WorkshopInput<'_>) -> Section {
    let limit = input.report.fabric.max_strain;
    let worst = donning_strain(input.girths);
    let mut notes = vec![
        "Put on from the far end: each part passes over the widest girth between there and its place. \
         Of the limb only what the brace covers is known here: a heel or a hand beyond it is not."
            .to_owned(),
    ];
    let Some((narrow, wide, strain)) = worst else {
        notes.insert(0, "Not computed: the brace does not close round the limb.".to_owned());
        return Section { title: "Putting it on", notes, ..Section::default() };
    };
    let verdict = if strain <= limit {
        format!("possible: {} are needed, the fabric bears {}", percent(strain), percent(limit))
    } else {
        format!(
            "NOT POSSIBLE as it is: {} are needed, the fabric bears {}; plan an opening, or another \
             fabric",
            percent(strain),
            percent(limit)
        )
    };
    let rows = vec![
        pair("Widest girth to pass", input.unit.words(wide)),
        pair("Relaxed girth that passes it", input.unit.words(narrow)),
        pair("Strain for it", verdict),
    ];
    Section { title: "Putting it on", head: Vec::new(), rows, notes }
}

/// The relaxed girth, the limb's girth and the strain where most is needed to put a brace on.
fn donning_strain(girths: &[GirthPair]) -> Option<(f64, f64, f64)> {
    let mut worst: Option<(f64, f64, f64)> = None;
    let mut widest = 0.0f64;
    for pair in girths.iter().rev().filter(|pair| pair.limb.closed) {
        widest = widest.max(pair.limb.girth_mm);
        let Some(relaxed) = pair.pattern_mm.filter(|girth| *girth > 0.0) else { continue };
        let strain = widest / relaxed - 1.0;
        if worst.is_none_or(|(_, _, most)| strain > most) {
            worst = Some((relaxed, widest, strain));
        }
    }
    worst
}

fn girths(input: &WorkshopInput<'_>) -> Section {
    let every = input.girths.len().div_ceil(MOST_ROWS).max(1);
    let rows = input.girths.iter().step_by(every).map(|pair| {
        vec![
            input.unit.words(pair.limb.at_mm),
            input.unit.words(pair.limb.girth_mm),
            pair.pattern_mm.map_or_else(|| "\u{2013}".to_owned(), |mm| input.unit.words(mm)),
            pair.reduction().map_or_else(|| "\u{2013}".to_owned(), percent),
        ]
    });
    Section {
        title: "Girths",
        head: vec!["along the limb", "limb", "brace, relaxed", "reduced by"],
        rows: rows.collect(),
        notes: Vec::new(),
    }
}

fn origin(input: &WorkshopInput<'_>) -> Section {
    let (hash, of_file) = &input.design_sha256;
    let name = if *of_file { "SHA-256 of the design file" } else { "SHA-256 of the design" };
    let rows = vec![
        pair("Curvature read over a radius of", format!("{} mm", input.report.curvature_radius_mm)),
        pair(name, hash.as_str()),
        pair("Computed by", format!("wovenfit {}", input.report.wovenfit)),
    ];
    Section { title: "Origin", rows, ..Section::default() }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::Girth;

    fn girth(at_mm: f64, limb: f64, relaxed: f64) -> GirthPair {
        GirthPair {
            limb: Girth {
                at_mm,
                girth_mm: limb,
                centre: DVec3::ZERO,
                direction: DVec3::Z,
                closed: true,
            },
            pattern_mm: Some(relaxed),
            line: Vec::new(),
        }
    }

    #[test]
    fn each_part_of_a_brace_passes_over_what_is_beyond_it() {
        // A narrow middle and a wide far end: the middle must pass 300 mm.
        let all = [girth(0.0, 320.0, 290.0), girth(50.0, 240.0, 200.0), girth(100.0, 300.0, 260.0)];
        let (relaxed, wide, strain) = donning_strain(&all).unwrap();
        assert_eq!((relaxed, wide), (200.0, 300.0));
        assert!((strain - 0.5).abs() < 1e-12);
        // The wide upper end passes nothing wider than itself.
        let tapering = [girth(0.0, 320.0, 250.0), girth(50.0, 240.0, 200.0)];
        let (relaxed, wide, strain) = donning_strain(&tapering).unwrap();
        assert_eq!((relaxed, wide), (250.0, 320.0));
        assert!((strain - 0.28).abs() < 1e-12);
        assert_eq!(donning_strain(&[]), None);
    }
}
