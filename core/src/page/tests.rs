//! The whole page, read back as the XML that it is.

use std::f64::consts::TAU;

use glam::DVec3;
use roxmltree::{Document, Node, ParsingOptions};

use super::*;
use crate::design::{Fabric, Piece, PressureModel};
use crate::export::DrawingSeam;
use crate::geometry::measure;
use crate::geometry::shapes::grid;
use crate::parameters::Parameters;
use crate::report::{
    ENERGY_UNIT, FitReport, HistoryEntry, ParameterValues, PatternReport, PressureReport, Reason,
    SeamReport, StrainDatum, StrainFunctionReport, StrainRow, SurfaceReport,
};

const RADIUS: f64 = 40.0;
const LENGTH: f64 = 160.0;
const SIDES: usize = 48;
const ROWS: usize = 40;

/// A cylinder cut open whose pattern is narrower by 1/1.25: 25 % of warp strain.
struct Sleeve {
    disk: Surface,
    coordinates: Vec<DVec2>,
    drawing: Drawing,
    report: Report,
    girths: Vec<Girth>,
    pressure: Vec<f64>,
}

fn sleeve() -> Sleeve {
    let disk = grid(ROWS, SIDES, false, |s, t| {
        let (sin, cos) = (TAU * (s % 1.0)).sin_cos();
        DVec3::new(RADIUS * cos, RADIUS * sin, LENGTH * t)
    });
    let width = TAU * RADIUS / 1.25;
    let place = |i: usize, j: usize| {
        DVec2::new(width * j as f64 / SIDES as f64, LENGTH * i as f64 / ROWS as f64)
    };
    let coordinates: Vec<DVec2> =
        (0..=ROWS).flat_map(|i| (0..=SIDES).map(move |j| place(i, j))).collect();
    let side = |j: usize| (0..=ROWS).rev().map(|i| place(i, j)).collect::<Vec<_>>();
    let (left, right) = (side(0), side(SIDES));
    let mut outline = left.clone();
    outline.extend(right.iter().rev());
    let drawing = Drawing {
        outline: vec![outline],
        seams: vec![DrawingSeam { left, right, left_mm: LENGTH, right_mm: LENGTH }],
        markers: [DVec2::new(0.5 * width, 150.0), DVec2::new(0.5 * width, 10.0)],
        points: vec![
            (DVec2::new(0.4 * width, 80.0), "17.2 mmHg".to_owned()),
            (DVec2::new(0.6 * width, 40.0), "20.0 mmHg".to_owned()),
        ],
        name: String::new(),
    };
    let girths = measure(&disk, 20.0).girths;
    let pressure = disk.points().iter().map(|p| 1.0 + p.z / 100.0).collect();
    Sleeve { disk, coordinates, drawing, report: report(), girths, pressure }
}

fn report() -> Report {
    let reached = PressureReport {
        at: [-RADIUS, 1.0, 80.0],
        asked_kpa: 2.29,
        got_kpa: Some(2.28),
        got_local_kpa: Some(2.9),
        mean_curvature_per_m: 12.5,
        warp_curvature_per_m: 25.0,
        weft_curvature_per_m: 0.0,
        warp_strain: Some(0.25),
        weft_strain: Some(0.0),
        reachable_kpa: Some([0.0, 6.0]),
        thread: Some(3),
        reason: None,
    };
    let missed = PressureReport {
        at: [-RADIUS, -1.0, 40.0],
        asked_kpa: 20.0 * 0.133322,
        got_kpa: Some(1.0),
        got_local_kpa: Some(1.0),
        reason: Some(Reason { code: "shape", text: "the <limb> is & was \"hollow\"".to_owned() }),
        ..reached.clone()
    };
    let history = |iteration, spacing_mm, e_ssd| HistoryEntry {
        iteration,
        spacing_mm,
        nodes: 100,
        springs: 200,
        energy: 10.0,
        e_ssd,
    };
    let row = |t: f64| StrainRow { y_mm: LENGTH * t, t, strain: 0.25 };
    Report {
        wovenfit: "0.1.0",
        piece: Piece::default(),
        pressure_model: PressureModel::Laplace,
        fabric: Fabric::default(),
        parameters: ParameterValues::from(&Parameters::default()),
        curvature_radius_mm: 10.0,
        surface: SurfaceReport {
            vertices: 1,
            triangles: 1,
            boundary_loops: 1,
            area_mm2: 1.0,
            length_mm: Some(LENGTH),
            girths: Vec::new(),
        },
        fit: FitReport {
            method: "diffusion".to_owned(),
            iterations: 100,
            converged: true,
            stopped_by: "plateau",
            energy: 12.5,
            energy_of_free_seams: None,
            energy_unit: ENERGY_UNIT,
            e_ssd: 0.02,
            springs: 200,
            nodes: 100,
            spacing_mm: 5.0,
            history: vec![history(0, 10.0, 5.0), history(50, 10.0, 0.1), history(100, 5.0, 0.02)],
        },
        strain_function: StrainFunctionReport {
            form: "constant",
            rows: vec![row(0.0), row(0.5), row(1.0)],
            data: vec![StrainDatum {
                t: 0.5,
                wanted: 0.26,
                asked: 0.25,
                fitted: 0.25,
                residual: 0.0,
            }],
        },
        pressures: vec![reached, missed],
        field: crate::report::FieldReport::default(),
        pattern: PatternReport { width_mm: 201.0, height_mm: LENGTH, ..PatternReport::default() },
        seams: vec![SeamReport { left_mm: LENGTH, right_mm: LENGTH - 1.5 }],
        warnings: vec![Warning::new("over_limit", "pressure 2 asks <too> much")],
    }
}

fn page(sleeve: &Sleeve, everywhere: bool) -> String {
    report_html(&PageInput {
        disk: &sleeve.disk,
        coordinates: &sleeve.coordinates,
        drawing: &sleeve.drawing,
        report: &sleeve.report,
        girths: &sleeve.girths,
        warp_strain: &vec![0.25; sleeve.disk.vertex_count()],
        pressure_kpa: everywhere.then_some(&sleeve.pressure),
        limit_kpa: 6.5,
        workshop: None,
    })
}

fn parse(page: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(page, options).unwrap()
}

/// All text of an element, in order, with single spaces.
fn words(node: Node<'_, '_>) -> String {
    let parts: Vec<&str> = node
        .descendants()
        .filter(|n| n.is_text() && n.parent().is_some_and(|p| p.tag_name().name() != "style"))
        .filter_map(|n| n.text())
        .flat_map(str::split_whitespace)
        .collect();
    parts.join(" ")
}

fn named<'a, 'i>(document: &'a Document<'i>, name: &str) -> Vec<Node<'a, 'i>> {
    document.descendants().filter(|n| n.tag_name().name() == name).collect()
}

#[test]
fn it_says_what_was_asked_for_in_order_of_use() {
    let text = page(&sleeve(), true);
    let document = parse(&text);
    let said = words(named(&document, "body")[0]);
    let wanted = [
        "Elastic brace",
        "1 warning",
        "pressure 2 asks <too> much",
        "1 of 2 wanted pressures is missed: point 2",
        "wanted",
        "computed (not measured)",
        "Missed: the <limb> is & was \"hollow\"",
        "From the front",
        "From the right",
        "From the back",
        "From the left",
        "Colour scale cividis",
        "Colour scale magma",
        "weft, up: near the body",
        "warp, round the limb",
        "seam 1: 160.0 mm",
        "warp strain, %",
        "E_SSD",
        "reduction, %",
        "Stiffness along warp",
        "0.5 N/mm",
        "What the model leaves out",
        "linear woven fabric on a rigid limb that does not bend",
        "friction",
        "relaxation",
        "soft tissue",
        "not a medical verification",
    ];
    let mut from = 0;
    for words in wanted {
        let found = said[from..].find(words);
        from += found.unwrap_or_else(|| panic!("`{words}` is missing or misplaced in:\n{said}"));
    }
}

#[test]
fn nothing_is_fetched_and_nothing_runs() {
    let text = page(&sleeve(), true);
    let document = parse(&text);
    for node in document.descendants() {
        assert!(!["script", "link", "iframe", "object"].contains(&node.tag_name().name()));
        for attribute in node.attributes() {
            let (name, value) = (attribute.name(), attribute.value());
            assert!(!name.starts_with("on"), "{name}");
            if ["src", "href", "action", "data"].contains(&name) {
                assert!(value.starts_with("data:image/png;base64,"), "{name}={value:.60}");
            }
        }
    }
    assert!(!text.contains("url(") && !text.contains("@import"));
    // An element that HTML does not know as void must not be self-closed.
    for node in document.descendants().filter(|n| n.is_element() && !n.has_children()) {
        let svg = node.ancestors().any(|n| n.tag_name().name() == "svg");
        assert!(svg || node.tag_name().name() == "meta", "{:?} is empty", node.tag_name());
    }
}

#[test]
fn what_a_user_wrote_stays_text() {
    let hostile = "<script>alert(1)</script>\"'&\u{1}</td><!--";
    let mut sleeve = sleeve();
    let report = &mut sleeve.report;
    report.piece = Piece {
        name: hostile.to_owned(),
        reference: hostile.to_owned(),
        date: hostile.to_owned(),
        ..Piece::default()
    };
    report.fabric.name = hostile.to_owned();
    report.warnings = vec![Warning::new("x", hostile)];
    report.pressures[1].reason = Some(Reason { code: "x", text: hostile.to_owned() });
    sleeve.drawing.points[0].1 = hostile.to_owned();
    sleeve.drawing.name = hostile.to_owned();
    let text = page(&sleeve, true);
    assert!(!text.contains("<script"));
    let document = parse(&text);
    assert!(named(&document, "script").is_empty());
    let said = words(document.root_element());
    assert!(said.matches("<script>alert(1)</script>\"'& </td><!--").count() >= 7, "{said}");
}

#[test]
fn figures_stand_in_both_units_with_what_is_off() {
    let text = page(&sleeve(), false);
    let document = parse(&text);
    let rows: Vec<String> = named(&document, "tr").into_iter().map(words).collect();
    let has = |row: &str| assert!(rows.iter().any(|r| r == row), "`{row}` in {rows:#?}");
    has("1 \u{2212}40.0, 1.0, 80.0 17.2 2.29 17.1 2.28 0 25.0");
    has("2 \u{2212}40.0, \u{2212}1.0, 40.0 20.0 2.67 7.5 1.00 \u{2212}62 25.0");
    // 48 sides of a circle of 40 mm are 251.15 mm round; 1/1.25 of the circle is 201.06 mm.
    has("60 251.1 201.1 19.9");
    let creep = rows.iter().find(|r| r.contains("near this point alone")).unwrap();
    assert!(creep.contains("21.8 mmHg (2.90 kPa)"), "{creep}");
}

#[test]
fn without_pressure_everywhere_there_is_strain_alone_and_a_word_about_it() {
    let (with, without) = (page(&sleeve(), true), page(&sleeve(), false));
    let count = |page: &str, name: &str| named(&parse(page), name).len();
    // Four views and a pattern for each.
    assert_eq!([count(&with, "image"), count(&without, "image")], [10, 5]);
    assert!(!without.contains("magma"));
    assert!(without.contains("at the points of the table alone"));
}

#[test]
fn a_run_that_did_not_converge_says_so_before_any_figure() {
    let mut sleeve = sleeve();
    sleeve.report.fit.converged = false;
    sleeve.report.warnings.clear();
    let text = page(&sleeve, false);
    let said = words(named(&parse(&text), "body")[0]);
    assert!(said.find("Not converged after 100 steps").unwrap() < said.find("mm").unwrap());
    assert!(!said.contains("reached, by the model"));
}

#[test]
fn a_pattern_that_cannot_be_cut_is_no_success() {
    let mut sleeve = sleeve();
    sleeve.report.pressures.truncate(1);
    let verdict = |sleeve: &Sleeve| words(named(&parse(&page(sleeve, false)), "body")[0]);
    assert!(verdict(&sleeve).contains("1 of 1 wanted pressures are reached, by the model"));
    sleeve.report.pattern.overlaps = 1;
    let said = verdict(&sleeve);
    assert!(said.contains("it cannot be cut") && !said.contains("reached, by the model"));
}

#[test]
fn empty_wishes_and_unknown_values_make_a_page_too() {
    let mut sleeve = sleeve();
    sleeve.report.pressures.clear();
    sleeve.report.strain_function = StrainFunctionReport::default();
    sleeve.report.fit.history.clear();
    sleeve.report.seams.clear();
    sleeve.report.warnings.clear();
    sleeve.drawing.points.clear();
    sleeve.drawing.seams.clear();
    sleeve.girths.clear();
    sleeve.pressure.fill(f64::NAN);
    let text = page(&sleeve, true);
    let said = words(named(&parse(&text), "body")[0]);
    assert!(said.contains("The design wants no pressures."));
    assert!(said.contains("No girths were found"));
    assert!(!text.contains("NaN") && !text.contains("inf "));
}

#[test]
fn the_same_result_gives_the_same_bytes() {
    assert_eq!(page(&sleeve(), true), page(&sleeve(), true));
}
