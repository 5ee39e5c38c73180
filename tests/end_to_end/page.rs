//! `report.html`, judged as a file: what it says, that it needs nothing else, and its cost.

use roxmltree::{Document, ParsingOptions};
use serde_json::json;
use support::cli::{Bench, run};
use support::design::wanting;
use support::fixtures::tube;
use support::mesh::Triangulation;

use crate::{FAST, limb};

/// Largest size of the page, in bytes: it is sent by mail.
const MOST_BYTES: usize = 1_500_000;

pub(crate) fn parse(page: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(page, options).expect("the page is well-formed")
}

/// All text with single spaces.
pub(crate) fn words(document: &Document<'_>) -> String {
    let body = document.descendants().find(|n| n.tag_name().name() == "body").expect("a body");
    let texts = body.descendants().filter(|n| n.is_text()).filter_map(|n| n.text());
    texts.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
}

#[test]
fn the_page_says_what_the_report_says() {
    let bench = Bench::new();
    let (mesh, mut design) = limb();
    design["piece"] =
        json!({"name": "sleeve <b> & co", "reference": "job \"17\"", "date": "today"});
    // Above the limit, and more than the fabric bears.
    design["pressures"][1]["kpa"] = json!(6.7);
    let _ = bench.flatten(&mesh, &design, &FAST).succeeded();
    let page = String::from_utf8(bench.out("report.html")).unwrap();
    assert!(page.len() < MOST_BYTES, "{} bytes", page.len());
    let document = parse(&page);
    let said = words(&document);
    let report = bench.report();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();

    let mut expected =
        vec!["sleeve <b> & co".to_owned(), "job \"17\"".to_owned(), "today".to_owned()];
    for p in report["pressures"].as_array().unwrap() {
        expected.push(format!("{:.1} {:.2}", number(&p["asked_mmhg"]), number(&p["asked_kpa"])));
        expected.push(format!("{:.1} {:.2}", number(&p["got_mmhg"]), number(&p["got_kpa"])));
        expected.extend(p["reason"]["text"].as_str().map(str::to_owned));
    }
    let missed = report["pressures"][1]["reason"]["text"].as_str().expect("it cannot be met");
    assert!(said.contains(&format!("Missed: {missed}")), "{said}");
    let girths = report["surface"]["girths"].as_array().unwrap();
    assert!(girths.len() >= 5);
    // Measured on the cut limb, where the vertices on the seam are others.
    let shown: Vec<f64> = said.split(' ').filter_map(|word| word.parse().ok()).collect();
    for girth in girths.iter().map(|girth| number(&girth["girth_mm"])) {
        assert!(shown.iter().any(|s| (s - girth).abs() < 0.1), "{girth} is not in:\n{said}");
    }
    let warnings = report["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|w| w["code"] == "over_limit"), "{warnings:?}");
    let messages = warnings.iter().map(|w| w["message"].as_str().unwrap());
    expected.extend(messages.map(|m| m.split_whitespace().collect::<Vec<_>>().join(" ")));
    for words in &expected {
        assert!(said.contains(words), "`{words}` is not in:\n{said}");
    }
    let place = |words: &str| said.find(words).unwrap_or_else(|| panic!("{words}"));
    assert!(place("above the limit of 6.50 kPa") < place("computed (not measured)"));
}

#[test]
fn the_page_fetches_nothing() {
    let bench = Bench::new();
    let (mesh, design) = limb();
    let _ = bench.flatten(&mesh, &design, &FAST).succeeded();
    let page = String::from_utf8(bench.out("report.html")).unwrap();
    let document = parse(&page);
    let mut pictures = 0;
    for node in document.descendants() {
        assert_ne!(node.tag_name().name(), "script");
        for attribute in node.attributes() {
            if ["src", "href", "srcset", "data", "poster"].contains(&attribute.name()) {
                assert!(attribute.value().starts_with("data:image/png;base64,"), "{attribute:?}");
                pictures += 1;
            }
        }
    }
    // Four views of the limb and the pattern at least.
    assert!(pictures >= 5, "{pictures}");
    assert!(!page.contains("url(") && !page.contains("@import"));
}

#[test]
fn the_pattern_is_a_fifth_shorter_round_a_tube_that_wants_a_quarter_of_strain() {
    // On a cylinder all threads are planar girths: the reduction is 1 − 1/(1 + ε) exactly, with
    // Laplace's p = k ε / r for the strain.
    let bench = Bench::new();
    let radius = 40.0;
    let limb = tube(radius, 120.0, 48, Triangulation::Alternating);
    let kpa = 0.5 * 0.25 / radius * 1000.0;
    let design = wanting(&[(limb.at(1.0, 60.0), kpa)]);
    let _ = bench
        .flatten(&limb.mesh, &design, &["--quiet", "--units", "mm", "--spacing", "7"])
        .succeeded();
    let page = String::from_utf8(bench.out("report.html")).unwrap();
    let document = parse(&page);
    let table = document
        .descendants()
        .filter(|n| n.tag_name().name() == "table")
        .find(|n| n.descendants().any(|n| n.text() == Some("reduction, %")))
        .expect("a table of girths");
    let cells = |row: roxmltree::Node<'_, '_>| -> Vec<f64> {
        row.children().filter_map(|n| n.text()?.trim().parse().ok()).collect()
    };
    let rows: Vec<Vec<f64>> = table
        .descendants()
        .filter(|n| n.tag_name().name() == "tr")
        .map(cells)
        .filter(|cells| cells.len() == 4)
        .collect();
    assert!(rows.len() >= 5, "{rows:?}");
    // Away from the free ends, where the fabric keeps its strain.
    for row in rows.iter().filter(|row| (30.0..90.0).contains(&row[0])) {
        assert!((row[3] - 20.0).abs() < 1.0, "{row:?}");
        assert!((row[2] / row[1] - 1.0 + row[3] / 100.0).abs() < 2e-3, "{row:?}");
    }
}

#[test]
fn the_page_stays_small_on_twenty_thousand_triangles() {
    let bench = Bench::new();
    let arm = bench.path("arm.obj");
    let made = ["sample", "elbow", "--triangles", "20000", "--out"].map(Into::into);
    let _ = run(made.into_iter().chain([arm.clone().into_os_string()])).succeeded();
    let [design, out] = ["arm.design.json", "out"].map(|name| bench.path(name));
    let _ = run([
        "flatten".as_ref(),
        arm.as_os_str(),
        "--design".as_ref(),
        design.as_os_str(),
        "--out".as_ref(),
        out.as_os_str(),
        "--quiet".as_ref(),
    ])
    .succeeded();
    let size = bench.out("report.html").len();
    assert!(size < MOST_BYTES, "{size} bytes");
}
