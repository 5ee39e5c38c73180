//! The paper's examples as a page: our versions of its Figs. 2 and 7 to 14, what it says about them,
//! and what is computed here.
//!
//! In the manner of the report's page: one file, no script, nothing fetched. Every number in a
//! sentence comes from the outcomes; patterns and limbs of one figure share scale and colours.

mod curves;
mod sheet;

use self::sheet::Sheets;
use super::html::{Tag, shown, tag};
use super::limb::Limb;
use super::quantity::{Quantity, vertex_areas};
use super::{PageInput, note};
use crate::design::Limits;
use crate::examples::{Claim, Extent, Outcome, Settings, Verdict, course};

/// What stands before all figures.
const METHOD: &str = "Computed by the paper\u{2019}s own method: diffusion on one woven model from the \
    initial parameterization, no coarser models first, the strains of Eq. (3) asked for as they \
    are (wovenfit flatten corrects them, and meets pressures better), pressure by Eq. (2) with \
    s = 1. The paper\u{2019}s scans are not published: the limbs are wovenfit\u{2019}s samples, of real \
    size and of nobody, and the pressures are of the order that fills the paper\u{2019}s colour bar (0 \
    to 0.25), except the knee\u{2019}s, which are the paper\u{2019}s. So figures can be compared in \
    kind, not in size.";

/// Why there are two curves.
const TWO_CURVES: &str = "E_SSD (Eq. 14) is a sum over warp and weft springs, and so larger for more \
    springs: curves of one figure are at one spacing, on one level, but a tighter pattern has \
    fewer threads, and nodes come and go at the edge. Beside it stands what does not depend on \
    their number, the root mean square strain difference of a spring. A dot marks the end. Both are \
    measured against each example\u{2019}s own wanted strains.";

/// The examples as one self-contained HTML page. `outcomes` are those of
/// [`run`](crate::examples::run).
#[must_use]
pub fn paper_html(settings: &Settings, outcomes: &[Outcome], claims: &[Claim]) -> String {
    let page = Page { settings, outcomes, claims };
    let body = tag("body")
        .child(page.heading())
        .child(page.overview())
        .child(page.elbow(2, "isotropic"))
        .child(page.strain_functions())
        .child(page.courses(8, "The course of the four, isotropic fabric", &names("isotropic")))
        .child(page.elbow(9, "anisotropic"))
        .child(page.courses(
            10,
            "The course of the four, anisotropic fabric",
            &names("anisotropic"),
        ))
        .child(page.limb(11, "knee", "A knee brace"))
        .child(page.courses(
            12,
            "The course of the knee brace",
            &["knee-free", "knee-pressed"].map(str::to_owned),
        ))
        .child(page.limb(13, "wrist", "A wrist brace"))
        .child(page.courses(
            14,
            "The course of the wrist brace",
            &["wrist-free", "wrist-pressed"].map(str::to_owned),
        ))
        .child(page.runs())
        .child(page.limits());
    let html = tag("html").with("lang", "en").child(header()).child(body);
    format!("<!DOCTYPE html>\n{html}\n")
}

fn header() -> Tag {
    let meta = |name: &str, content: &str| tag("meta").with("name", name).with("content", content);
    let policy = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
    tag("head")
        .child(tag("meta").with("charset", "utf-8"))
        .child(meta("viewport", "width=device-width, initial-scale=1"))
        .child(tag("meta").with("http-equiv", "Content-Security-Policy").with("content", policy))
        .child(meta("generator", concat!("wovenfit ", env!("CARGO_PKG_VERSION"))))
        .child(tag("title").text("The paper\u{2019}s examples: wovenfit"))
        .child(
            tag("style").verbatim(include_str!("../style.css")).verbatim(include_str!("paper.css")),
        )
}

fn names(fabric: &str) -> [String; 4] {
    ["a", "b", "c", "d"].map(|c| format!("elbow-{fabric}-{c}"))
}

/// For the report's drawings.
fn input(outcome: &Outcome) -> PageInput<'_> {
    let flattening = &outcome.flattening;
    PageInput {
        disk: flattening.disk(),
        coordinates: &flattening.coordinates,
        drawing: &flattening.drawing,
        report: &flattening.report,
        girths: &flattening.girths,
        warp_strain: &flattening.field.warp_strain,
        pressure_kpa: None,
        limit_kpa: Limits::WARN_KPA,
        workshop: None,
    }
}

/// Warp strain of several outcomes in the same bands; first that of all together, for the legend.
fn on_one_scale(outcomes: &[&Outcome]) -> (Quantity, Vec<Quantity>) {
    let areas: Vec<Vec<f64>> =
        outcomes.iter().map(|outcome| vertex_areas(outcome.flattening.disk())).collect();
    let strain = |outcome: &Outcome| outcome.flattening.field.warp_strain.clone();
    let all: Vec<f64> = outcomes.iter().flat_map(|outcome| strain(outcome)).collect();
    let together = Quantity::strain(&all, &areas.concat());
    let each = outcomes
        .iter()
        .zip(&areas)
        .map(|(outcome, areas)| Quantity {
            bands: together.bands,
            ..Quantity::strain(&strain(outcome), areas)
        })
        .collect();
    (together, each)
}

/// The heading over a figure's first drawings.
const START: &str = "The initial woven fitting, by the intrinsic parameterization at true scale";

/// Numbers of two of the limb's views.
const FRONT: usize = 0;
const BACK: usize = 2;

fn heading_of(figure: u8, title: &str) -> Tag {
    tag("h2").text(format!("Fig. {figure}: {title}"))
}

fn figure(drawing: svg::Document, words: &str) -> Tag {
    tag("figure").child(drawing).child(tag("figcaption").text(words))
}

/// What is not to be torn apart by the end of a sheet.
fn panel(drawings: Vec<Tag>) -> Tag {
    tag("div").class("panel").children(drawings)
}

struct Page<'a> {
    settings: &'a Settings,
    outcomes: &'a [Outcome],
    claims: &'a [Claim],
}

impl<'a> Page<'a> {
    fn of(&self, name: &str) -> &'a Outcome {
        let found = self.outcomes.iter().find(|outcome| outcome.example.name == name);
        found.expect("every name in this file stands in the list of examples")
    }

    fn heading(&self) -> Tag {
        let parameters = &self.settings.parameters;
        let words = format!(
            "About {} triangles, threads every {} mm \u{b7} wovenfit {}",
            self.settings.triangles,
            parameters.spacing,
            env!("CARGO_PKG_VERSION")
        );
        tag("header")
            .class("head")
            .child(tag("h1").text("The paper\u{2019}s examples, by its own method"))
            .child(tag("p").text(words))
    }

    fn overview(&self) -> Tag {
        let count = |verdict: Verdict| self.claims.iter().filter(|c| c.verdict == verdict).count();
        let [holds, in_part, differs] =
            [Verdict::Holds, Verdict::InPart, Verdict::Differs].map(count);
        let words = format!(
            "Of {} sentences of the paper, {holds} hold here, {in_part} in part, {differs} not.",
            self.claims.len()
        );
        let head =
            |words: &str, class: &str| tag("th").with("scope", "col").class(class).text(words);
        let row = |claim: &Claim| {
            tag("tr")
                .child(tag("td").class("words number").text(format!("Fig. {}", claim.figure)))
                .child(tag("td").class("words").text(claim.paper))
                .child(tag("td").class("words verdict-cell").text(claim.verdict.words()))
        };
        tag("section")
            .child(tag("p").class("verdict").text(words).child(tag("span").text(
                "Wang & Tang, Woven Model Based Geometric Design of Elastic Medical Braces, section 6. \
                 Computed by a model, not measured.",
            )))
            .child(tag("p").text(METHOD))
            .child(
                tag("table")
                    .class("sentences")
                    .child(tag("thead").child(tag("tr").children([
                        head("figure", "words"),
                        head("what the paper says", "words"),
                        head("and here", "words"),
                    ])))
                    .child(tag("tbody").children(self.claims.iter().map(row))),
            )
    }

    /// What the paper says about a figure, and what is computed.
    fn sentences(&self, figure: u8) -> Vec<Tag> {
        let said = self.claims.iter().filter(|claim| claim.figure == figure);
        said.map(|claim| {
            let class = match claim.verdict {
                Verdict::Holds => "claim",
                Verdict::InPart => "claim in_part",
                Verdict::Differs => "claim differs",
            };
            let part = |name: &str, words: &str| {
                tag("p").child(tag("b").text(name)).child(tag("span").text(format!(" {words}")))
            };
            tag("div")
                .class(class)
                .child(part("The paper:", claim.paper))
                .child(part("Here:", &claim.here))
                .child(part("So it", &format!("{}.", claim.verdict.words())))
        })
        .collect()
    }

    fn section(figure: u8, title: &str) -> Tag {
        tag("section").child(heading_of(figure, title))
    }

    /// A section whose heading stays with its first drawings when it is printed.
    fn figures(figure: u8, title: &str, words: Tag, under: &str, drawings: Vec<Tag>) -> Tag {
        let mut first = tag("div").class("panel").child(heading_of(figure, title)).child(words);
        if !under.is_empty() {
            first = first.child(tag("h3").text(under));
        }
        tag("section").child(first.children(drawings))
    }

    /// Limbs from the front over patterns, a column an example, with the legend under them.
    fn columns(outcomes: &[&Outcome]) -> Vec<Tag> {
        let (together, each) = on_one_scale(outcomes);
        let inputs: Vec<PageInput<'_>> = outcomes.iter().map(|outcome| input(outcome)).collect();
        let sheets = Sheets::of(outcomes);
        let columns = || outcomes.iter().zip(&each);
        let limbs = columns().zip(&inputs).map(|((outcome, quantity), input)| {
            let words = format!("{}, from the front", outcome.example.title);
            figure(Limb::new(input).view(FRONT, quantity), &words)
        });
        let patterns = columns().map(|(outcome, quantity)| {
            let words = format!("{}, the pattern", outcome.example.title);
            figure(sheets.drawing(outcome, quantity), &words)
        });
        vec![
            tag("div").class("four").children(limbs),
            tag("div").class("four").children(patterns),
            together.legend(),
        ]
    }

    /// An example a row: the limb from the front and the back, and the pattern; with the legend.
    fn rows(outcomes: &[&Outcome]) -> Vec<Tag> {
        let (together, each) = on_one_scale(outcomes);
        let sheets = Sheets::of(outcomes);
        let rows = outcomes.iter().zip(&each).map(|(outcome, quantity)| {
            let input = input(outcome);
            let limb = Limb::new(&input);
            tag("div").class("three").children([
                figure(limb.view(FRONT, quantity), outcome.example.title),
                figure(limb.view(BACK, quantity), "from the back"),
                figure(sheets.drawing(outcome, quantity), "the pattern"),
            ])
        });
        rows.chain([together.legend()]).collect()
    }

    fn elbow(&self, figure: u8, fabric: &str) -> Tag {
        let outcomes: Vec<&Outcome> = names(fabric).iter().map(|name| self.of(name)).collect();
        let stiffness = &outcomes[0].flattening.report.fabric;
        let title = format!(
            "An elbow brace for four configurations, {fabric} fabric {} / {} / {}",
            stiffness.warp, stiffness.weft, stiffness.diagonal
        );
        let words = note(
            "Circles: wanted pressures in kPa, large ones where the paper has arrows. Up is near \
             the body, warp runs across, and a millimetre is as long in every pattern.",
        );
        let mut all = if figure == 2 {
            let start = Self::rows(&[self.of("elbow-start")]);
            Self::figures(figure, &title, words, START, start)
                .child(panel(Self::columns(&outcomes)))
        } else {
            Self::figures(figure, &title, words, "", Self::columns(&outcomes))
        };
        all = all.children(self.sentences(figure));
        if figure == 9 {
            all = all.child(note(
                "The paper says only that the amplitudes differ from those of Fig. 2. Stiff weft \
                 threads keep the pattern\u{2019}s length along the limb: its height varies less \
                 between the four than in Fig. 2."
                    .to_owned()
                    + &self.heights(),
            ));
        }
        all.child(Self::pressures(&outcomes))
    }

    /// How much the heights of the four patterns vary in both fabrics.
    fn heights(&self) -> String {
        let range = |fabric: &str| {
            let heights =
                names(fabric).map(|name| self.of(&name).flattening.report.pattern.height_mm);
            let (low, high) = heights
                .iter()
                .fold((f64::INFINITY, 0.0), |(l, h), &x| (f64::min(l, x), f64::max(h, x)));
            format!("{} to {} mm", shown(low, 1), shown(high, 1))
        };
        format!(" ({} there, {} here.)", range("isotropic"), range("anisotropic"))
    }

    fn strain_functions(&self) -> Tag {
        let outcomes: Vec<&Outcome> = names("isotropic").iter().map(|name| self.of(name)).collect();
        let range = curves::strain_range(&outcomes);
        let figures = outcomes.iter().map(|outcome| {
            tag("figure")
                .child(curves::strain_function(outcome, range))
                .child(tag("figcaption").text(outcome.example.title))
        });
        Self::section(7, "The strain functions of the four, isotropic fabric")
            .class("keep")
            .child(note(
                "Bars: the strains that the wanted pressures need. The function goes through them, \
                 level at both ends, never negative (Eqs. 10, 11); A\u{2019}s is zero, as the paper \
                 says. The paper does not show what the threads reach: dashes, each whole thread\u{2019}s \
                 strain in the finished pattern.",
            ))
            .child(tag("div").class("pair").children(figures))
    }

    fn courses(&self, figure: u8, title: &str, names: &[String]) -> Tag {
        let outcomes: Vec<&Outcome> = names.iter().map(|name| self.of(name)).collect();
        let charts = [
            (curves::sums(&outcomes), "E_SSD, logarithmic", "E_SSD over the steps"),
            (
                curves::means(&outcomes),
                "strain difference of a spring, %, RMS, log.",
                "Root mean square strain difference over the steps",
            ),
        ];
        let figures = charts.map(|(courses, title, words)| {
            tag("figure").child(curves::chart(&courses, title, words))
        });
        let ends = outcomes.iter().map(|outcome| {
            let fit = &outcome.flattening.report.fit;
            let [first, last] = course::ends(fit);
            format!(
                "{}: {} \u{2192} {} in {} steps, {}",
                outcome.example.title,
                shown(first, 1),
                shown(last, 2),
                fit.iterations,
                if fit.converged { "converged" } else { "not converged" }
            )
        });
        let ends = ends.collect::<Vec<_>>().join("; ") + ".";
        let mut all = Self::section(figure, title)
            .class("keep")
            .child(tag("div").class("pair").children(figures))
            .child(note(format!("E_SSD from start to end: {ends}")));
        if figure == 8 {
            all = all.child(note(TWO_CURVES));
        }
        all.children(self.sentences(figure))
    }

    fn limb(&self, figure: u8, limb: &str, title: &str) -> Tag {
        let [start, free, pressed] =
            ["start", "free", "pressed"].map(|end| self.of(&format!("{limb}-{end}")));
        let fabric = &start.flattening.report.fabric;
        let title =
            format!("{title}, fabric {} / {} / {}", fabric.warp, fabric.weft, fabric.diagonal);
        let words = note("Circles: wanted pressures in kPa. (b) and (c) share colours and scale.");
        Self::figures(figure, &title, words, START, Self::rows(&[start]))
            .child(panel(Self::rows(&[free, pressed])))
            .children(self.sentences(figure))
            .child(Self::pressures(&[pressed]))
    }

    /// Wanted and computed at every point of these examples.
    fn pressures(outcomes: &[&Outcome]) -> Tag {
        let head = |words: &str| tag("th").with("scope", "col").text(words);
        let cell = |words: String| tag("td").text(words);
        let rows = outcomes.iter().flat_map(|outcome| {
            let report = &outcome.flattening.report;
            report.pressures.iter().enumerate().flat_map(move |(k, p)| {
                let name = outcome.example.title.split(['(', ':', ')']).find(|s| !s.is_empty());
                let place = format!("{}, point {}", name.unwrap_or_default(), k + 1);
                let more = if p.reason.is_some() { "more" } else { "" };
                let row = tag("tr")
                    .class(more)
                    .child(tag("th").with("scope", "row").text(place))
                    .child(cell(shown(p.asked_kpa, 2)))
                    .child(
                        cell(p.got_kpa.map_or("\u{2013}".to_owned(), |kpa| shown(kpa, 2)))
                            .class("computed"),
                    )
                    .child(cell(
                        p.warp_strain.map_or("\u{2013}".to_owned(), |s| shown(100.0 * s, 1)),
                    ))
                    .child(cell(shown(p.mean_curvature_per_m, 1)).class("wide"));
                let why = p.reason.as_ref().map(|reason| {
                    let words = format!("Missed: {}.", reason.text);
                    tag("tr").class("why").child(tag("td").with("colspan", "5").text(words))
                });
                [Some(row), why].into_iter().flatten()
            })
        });
        let top =
            ["where", "wanted, kPa", "computed (not measured), kPa", "strain of the thread, %"];
        let curvature = head("mean curvature, per m").class("wide");
        tag("table")
            .class("points")
            .child(tag("thead").child(tag("tr").children(top.map(head)).child(curvature)))
            .child(tag("tbody").children(rows))
    }

    /// Every run in a line.
    fn runs(&self) -> Tag {
        let head = |words: &str| tag("th").with("scope", "col").text(words);
        let cell = |words: String| tag("td").text(words);
        let wide = |words: String| cell(words).class("wide");
        let rows =
            self.outcomes.iter().filter(|o| o.example.extent != Extent::Start).map(|outcome| {
                let (fit, pattern) =
                    (&outcome.flattening.report.fit, &outcome.flattening.report.pattern);
                let rms = |entry: Option<&crate::report::HistoryEntry>| {
                    entry.map_or(0.0, |entry| 100.0 * course::rms(entry))
                };
                let fine = course::finest(fit);
                tag("tr")
                    .child(tag("td").class("words").text(outcome.example.name))
                    .child(wide(fit.nodes.to_string()))
                    .child(cell(fit.iterations.to_string()))
                    .child(cell(if fit.converged { "yes" } else { "no" }.to_owned()))
                    .child(wide(shown(rms(fine.clone().next()), 1)))
                    .child(cell(shown(rms(fine.last()), 1)))
                    .child(cell(format!(
                        "{} \u{d7} {}",
                        shown(pattern.width_mm, 0),
                        shown(pattern.height_mm, 0)
                    )))
            });
        let top = [head("example").class("words"), head("nodes").class("wide")]
            .into_iter()
            .chain(["steps", "converged"].map(head))
            .chain([head("first, %").class("wide"), head("last, %")])
            .chain([head("pattern, mm").class("wide")]);
        tag("section")
            .class("keep")
            .child(tag("h2").text("Every run"))
            .child(note(
                "First and last: the root mean square strain difference of a spring from its \
                 wanted strain. All figures: paper.json. The worn brace of each with its pattern: \
                 NAME.worn.obj.",
            ))
            .child(
                tag("table")
                    .class("runs plain")
                    .child(tag("thead").child(tag("tr").children(top)))
                    .child(tag("tbody").children(rows)),
            )
    }

    fn limits(&self) -> Tag {
        tag("section")
            .class("limits")
            .child(tag("h2").text("What the model leaves out"))
            .child(tag("p").text(super::LEFT_OUT))
    }
}
