//! The report as a page: what a designer reads in a minute and an orthotist files.
//!
//! One HTML file that holds its pictures and fetches nothing: no script, no font, no network. The
//! order is that of use: warnings, then whether the wishes were met, the limb, the pattern, how it
//! came about, and what the model leaves out. Limb and pattern are PNGs in bands of colour, with
//! vector drawings over them; charts are SVG.

mod chart;
mod draw;
mod girth;
mod html;
mod limb;
mod paper;
mod picture;
mod plan;
mod quantity;
mod raster;
mod scale;
mod tables;

use glam::DVec2;
use rayon::prelude::*;

use self::html::{Tag, shown, tag};
use self::limb::Limb;
pub use self::paper::paper_html;
use self::plan::Plan;
use self::quantity::{Quantity, vertex_areas};
use crate::export::Drawing;
use crate::geometry::Girth;
use crate::report::{GirthPair, Report, Workshop, girth_pairs};
use crate::surface::Surface;
use crate::units::mmhg_from_kpa;
use crate::warning::Warning;

/// What the page shows.
#[derive(Debug, Clone, Copy)]
pub struct PageInput<'a> {
    /// The cut surface, in mm.
    pub disk: &'a Surface,
    /// Pattern coordinates of its vertices, in mm, x along warp, y along weft.
    pub coordinates: &'a [DVec2],
    /// The pattern as a drawing, in the same coordinates.
    pub drawing: &'a Drawing,
    /// Every figure and warning.
    pub report: &'a Report,
    /// The girths of the limb, from the end near the body.
    pub girths: &'a [Girth],
    /// Warp strain by vertex; `NaN` where it is unknown.
    pub warp_strain: &'a [f64],
    /// Computed pressure by vertex in kPa, `NaN` where it is unknown; `None` if it was computed at
    /// the asked points alone.
    pub pressure_kpa: Option<&'a [f64]>,
    /// Pressure above which pictures are hatched, in kPa.
    pub limit_kpa: f64,
    /// What the workshop gets, if the page has it.
    pub workshop: Option<&'a Workshop>,
}

/// What the model leaves out.
const LEFT_OUT: &str = "The pressures on this page are computed by a model, not measured. The \
    model is a linear woven fabric on a rigid limb that does not bend. It leaves out friction \
    between fabric and skin, the relaxation of the fabric in wear, and the give of soft tissue. \
    This page is not a medical verification: measure the pressures of a sewn brace before anyone \
    wears it, above all over bone.";

/// Warnings about which nothing need be done.
const CALM: [&str; 6] = [
    "seam_automatic",
    "orientation_automatic",
    "reversed",
    "orientation_repaired",
    "welded",
    "unused_vertices",
];

/// The report as one self-contained HTML page.
#[must_use]
pub fn report_html(input: &PageInput<'_>) -> String {
    let areas = vertex_areas(input.disk);
    let mut quantities = vec![Quantity::strain(input.warp_strain, &areas)];
    if let Some(kpa) = input.pressure_kpa {
        quantities.push(Quantity::pressure(kpa, &areas, input.limit_kpa));
    }
    // The pictures are what takes long.
    let (pairs, (on_limb, flat)) = rayon::join(
        || girth_pairs(input.disk, input.coordinates, input.girths),
        || rayon::join(|| limb(input, &quantities), || pattern(input, &quantities)),
    );
    let body = tag("body")
        .child(heading(input))
        .children(warnings(&input.report.warnings))
        .child(verdict(input))
        .child(facts(input, &quantities, &pairs))
        .child(pressures(input))
        .child(on_limb)
        .child(flat)
        .child(curves(input))
        .child(girths(input, &pairs))
        .child(fabric(input))
        .children(input.workshop.map(tables::workshop))
        .child(
            tag("section")
                .class("limits")
                .child(tag("h2").text("What the model leaves out"))
                .child(tag("p").text(LEFT_OUT)),
        );
    let page = tag("html").with("lang", "en").child(header(input)).child(body);
    format!("<!DOCTYPE html>\n{page}\n")
}

fn header(input: &PageInput<'_>) -> Tag {
    let meta = |name: &str, content: &str| tag("meta").with("name", name).with("content", content);
    let policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
    tag("head")
        .child(tag("meta").with("charset", "utf-8"))
        .child(meta("viewport", "width=device-width, initial-scale=1"))
        .child(
            // Nothing is fetched, whatever may stand in a name.
            tag("meta").with("http-equiv", "Content-Security-Policy").with("content", policy),
        )
        .child(meta("generator", &format!("wovenfit {}", input.report.wovenfit)))
        .child(tag("title").text(format!("{}: report", name(input))))
        .child(tag("style").verbatim(include_str!("style.css")))
}

fn name(input: &PageInput<'_>) -> String {
    let name = html::printable(&input.report.piece.name);
    if name.trim().is_empty() { "Elastic brace".to_owned() } else { name }
}

fn heading(input: &PageInput<'_>) -> Tag {
    let piece = &input.report.piece;
    let mut words = Vec::new();
    if !piece.reference.trim().is_empty() {
        words.push(format!("Reference: {}", piece.reference));
    }
    if !piece.date.trim().is_empty() {
        words.push(format!("Date: {}", piece.date));
    }
    words.push(format!("wovenfit {}", input.report.wovenfit));
    tag("header")
        .class("head")
        .child(tag("h1").text(name(input)))
        .child(tag("p").text(words.join(" \u{b7} ")))
}

/// What the designer should know; what asks for nothing comes last and calmly.
fn warnings(all: &[Warning]) -> Vec<Tag> {
    let calm = |warning: &&Warning| CALM.contains(&warning.code);
    let list = |title: &str, class: &str, chosen: Vec<&Warning>| {
        let items = chosen.into_iter().map(|warning| {
            let item = tag("li").child(tag("span").text(&warning.message));
            match warning.at {
                Some([x, y, z]) => item.child(tag("span").class("place").text(format!(
                    "at ({}, {}, {}) mm",
                    shown(x, 1),
                    shown(y, 1),
                    shown(z, 1)
                ))),
                None => item,
            }
        });
        tag("section").class(class).child(tag("h2").text(title)).child(tag("ul").children(items))
    };
    let (quiet, loud): (Vec<&Warning>, Vec<&Warning>) = all.iter().partition(calm);
    let mut lists = Vec::new();
    if !loud.is_empty() {
        let title = match loud.len() {
            1 => "1 warning".to_owned(),
            n => format!("{n} warnings"),
        };
        lists.push(list(&title, "warnings", loud));
    }
    if !quiet.is_empty() {
        lists.push(list("Done for you", "warnings calm", quiet));
    }
    lists
}

fn verdict(input: &PageInput<'_>) -> Tag {
    let report = input.report;
    let all = report.pressures.len();
    let missed: Vec<String> = (report.pressures.iter().enumerate())
        .filter(|(_, p)| p.reason.is_some())
        .map(|(k, _)| (k + 1).to_string())
        .collect();
    let words = if report.pattern.flipped > 0 || report.pattern.overlaps > 0 {
        "\u{2717} This pattern folds or overlaps itself: it cannot be cut.".to_owned()
    } else if !report.fit.converged {
        format!("Not converged after {} steps: no figure here is final.", report.fit.iterations)
    } else if all == 0 {
        "The design wants no pressures.".to_owned()
    } else if missed.is_empty() {
        format!("\u{2713} {all} of {all} wanted pressures are reached, by the model.")
    } else if missed.len() > 12 {
        format!("\u{2717} {} of {all} wanted pressures are missed.", missed.len())
    } else {
        format!(
            "\u{2717} {} of {all} wanted pressures {} {}.",
            missed.len(),
            if missed.len() == 1 { "is missed: point" } else { "are missed: points" },
            missed.join(", ")
        )
    };
    let aside = "Computed by a model, not measured. What it leaves out stands at the end.";
    tag("p").class("verdict").text(words).child(tag("span").text(aside))
}

/// The figures that are asked for first.
fn facts(input: &PageInput<'_>, quantities: &[Quantity], pairs: &[GirthPair]) -> Tag {
    let report = input.report;
    let range = |[low, high]: [f64; 2], unit: &str| {
        format!("{} to {} {unit}", shown(low, 0), shown(high, 0))
    };
    let mut facts = vec![(
        "Pattern, wide \u{d7} high",
        format!(
            "{} \u{d7} {} mm",
            shown(report.pattern.width_mm, 0),
            shown(report.pattern.height_mm, 0)
        ),
    )];
    facts.extend(quantities.iter().map(|q| (q.name, range(q.range, q.unit))));
    let reductions = || pairs.iter().filter_map(GirthPair::reduction).map(|part| 100.0 * part);
    if reductions().next().is_some() {
        let (low, high) =
            reductions().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        facts.push(("Girths reduced by", range([low, high], "%")));
    }
    let seams = report.seams.iter().map(|seam| (seam.left_mm - seam.right_mm).abs());
    if let Some(gap) = seams.reduce(f64::max) {
        facts.push(("Seam sides differ by", format!("{} mm", shown(gap, 1))));
    }
    tag("dl").class("facts").children(
        facts.into_iter().map(|(name, value)| {
            tag("div").child(tag("dt").text(name)).child(tag("dd").text(value))
        }),
    )
}

fn section(title: &str) -> Tag {
    tag("section").child(tag("h2").text(title))
}

fn note(words: impl AsRef<str>) -> Tag {
    tag("p").class("note").text(words)
}

fn pressures(input: &PageInput<'_>) -> Tag {
    section("Pressures").child(tables::pressures(input)).child(note(format!(
        "Computed with the tension that the whole thread takes, equal all along it, and the \
         curvature of the limb over a radius of {} mm. 1 mmHg = 0.133322 kPa.",
        input.report.curvature_radius_mm
    )))
}

fn limb(input: &PageInput<'_>, quantities: &[Quantity]) -> Tag {
    let limb = Limb::new(input);
    let explanation = note(
        "Up is near the body. The front is the side of the pattern\u{2019}s orientation markers; \
         right and left are those of one who looks at it. Circles: the points of the table. \
         Dashes: seams.",
    );
    let mut blocks = quantities
        .iter()
        .map(|quantity| [tag("h3").text(quantity.name), limb.figure(quantity), quantity.legend()]);
    // A heading stays with what it is the heading of when the page is printed.
    let first = tag("div").class("keep").child(tag("h2").text("On the limb")).child(explanation);
    let mut all = tag("section").child(first.children(blocks.next().into_iter().flatten()));
    all = all.children(blocks.map(|block| tag("div").class("keep").children(block)));
    if input.pressure_kpa.is_none() {
        all = all
            .child(note("Pressure was computed at the points of the table alone, not everywhere."));
    }
    all
}

fn pattern(input: &PageInput<'_>, quantities: &[Quantity]) -> Tag {
    let plan = Plan::new(input);
    let drawings: Vec<_> = quantities.par_iter().map(|q| plan.drawing(q)).collect();
    let figures = quantities.iter().zip(drawings).map(|(quantity, drawing)| {
        let words = format!("{}, {}", quantity.name, quantity.unit);
        tag("figure").child(drawing).child(tag("figcaption").text(words))
    });
    let class = if quantities.len() > 1 { "pair" } else { "single" };
    tag("section")
        .class("keep")
        .child(tag("h2").text("The pattern"))
        .child(note(
            "Seen from the outside of the brace, not to scale: cut from pattern.svg, printed at \
             100 %. Colours as above; the small figures are values. Circles: wanted pressures. \
             \u{25c7}: orientation markers. Dashes: seams, sewn together, without allowance.",
        ))
        .child(tag("div").class(class).children(figures))
}

fn curves(input: &PageInput<'_>) -> Tag {
    let fit = &input.report.fit;
    let per_spring = (fit.e_ssd / fit.springs.max(1) as f64).sqrt();
    let figure = |drawing: Option<svg::Document>, words: String| {
        drawing.map(|drawing| tag("figure").child(drawing).child(tag("figcaption").text(words)))
    };
    let strain = figure(
        chart::strain_function(input),
        "Bars: the strain that a wanted pressure needs (Eq. 3). Asked: the same within the \
         fabric\u{2019}s limits, corrected by what threads take. The line is the strain function \
         fitted to it (Eqs. 10, 11). Reached: the thread in the finished pattern."
            .to_owned(),
    );
    let course = figure(
        chart::energy(input),
        format!(
            "E_SSD (Eq. 14): the sum of squared strain differences, each level of the fit with \
             its own number of springs. At the end {} over {} springs, {} of strain \
             for each; energy {} {}; {} steps, {}.",
            shown(fit.e_ssd, 2),
            fit.springs,
            shown(per_spring, 3),
            shown(fit.energy, 1),
            fit.energy_unit,
            fit.iterations,
            if fit.converged { "converged" } else { "not converged" }
        ),
    );
    tag("section")
        .class("keep")
        .child(tag("h2").text("Warp strain along the limb, and the course of the fit"))
        .child(tag("div").class("pair").children([strain, course].into_iter().flatten()))
}

fn girths(input: &PageInput<'_>, pairs: &[GirthPair]) -> Tag {
    let all = tag("section").class("keep").child(tag("h2").text("Girths"));
    if pairs.is_empty() {
        return all.child(tag("p").text("No girths were found: the surface is not like a limb."));
    }
    let caption = "Where the girths were measured, in mm along the limb.";
    all.child(note(
        "The pattern\u{2019}s girth is the length in the flat pattern of the very line on which \
         the limb\u{2019}s girth was measured, across its centre line. The reduction is what the \
         pattern is shorter by, in per cent of the limb; where that line runs askew to the warp, it \
         is not the strain of the threads.",
    ))
    .child(tag("div").class("pair").child(tag("div").child(tables::girths(pairs))).child(
        tag("figure").child(girth::lines(input, pairs)).child(tag("figcaption").text(caption)),
    ))
}

fn fabric(input: &PageInput<'_>) -> Tag {
    let limit = format!(
        "Warned above {} mmHg ({} kPa).",
        shown(mmhg_from_kpa(input.limit_kpa), 0),
        shown(input.limit_kpa, 1)
    );
    tag("section")
        .class("keep")
        .child(tag("h2").text("Fabric and settings"))
        .child(tables::fabric(input))
        .child(note(limit))
        .child(tables::settings(input))
}

#[cfg(test)]
mod tests;
