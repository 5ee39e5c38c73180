//! The tables of the page: pressures, girths, fabric, settings.

use super::PageInput;
use super::html::{Tag, shown, shown_or_dash, tag};
use crate::design::PressureModel;
use crate::report::{GirthPair, PressureReport, Workshop};
use crate::units::mmhg_from_kpa;

/// Most points in the table; a painted field has thousands.
const MOST_ROWS: usize = 200;

/// Part by which the pressure from the fabric near a point alone may differ before it is told.
const CREEP: f64 = 0.15;

fn cell(words: impl AsRef<str>) -> Tag {
    tag("td").text(words)
}

fn head(words: &str) -> Tag {
    tag("th").with("scope", "col").text(words)
}

fn group(words: &str, columns: &str) -> Tag {
    let head = tag("th").class("group").with("scope", "colgroup").with("colspan", columns);
    head.text(words)
}

/// Pressures wanted and computed, with reasons.
pub(super) fn pressures(input: &PageInput<'_>) -> Tag {
    let all = &input.report.pressures;
    if all.is_empty() {
        return tag("p").text("The design wants no pressures.");
    }
    let top = tag("tr")
        .child(head("point").class("words").with("rowspan", "2"))
        .child(head("place, mm").class("wide").with("rowspan", "2"))
        .child(group("wanted", "2"))
        .child(group("computed (not measured)", "3"))
        .child(head("warp strain, %").with("rowspan", "2"));
    let units = ["mmHg", "kPa", "mmHg", "kPa", "off by, %"].map(head);
    let rows = all.iter().take(MOST_ROWS).enumerate().flat_map(|(k, p)| pressure(k + 1, p));
    let table = tag("table")
        .child(tag("thead").child(top).child(tag("tr").children(units)))
        .child(tag("tbody").children(rows));
    let block = tag("div").child(table);
    if all.len() > MOST_ROWS {
        let rest = all.len() - MOST_ROWS;
        return block.child(tag("p").text(format!("And {rest} more points: see report.json.")));
    }
    block
}

fn pressure(number: usize, p: &PressureReport) -> Vec<Tag> {
    let mut notes = Vec::new();
    if let Some(reason) = &p.reason {
        notes.push(("Missed: ", reason.text.clone()));
    }
    if let (Some(got), Some(local)) = (p.got_kpa, p.got_local_kpa)
        && (local - got).abs() > CREEP * got.abs()
    {
        notes.push((
            "",
            format!(
                "From the fabric's strain near this point alone: {} mmHg ({} kPa); the brace would \
                 creep here until its threads have evened out.",
                shown(mmhg_from_kpa(local), 1),
                shown(local, 2)
            ),
        ));
    }
    let [x, y, z] = p.at;
    let off = p.got_kpa.filter(|_| p.asked_kpa > 0.0).map(|got| got / p.asked_kpa - 1.0);
    let off = off.map_or_else(
        || "\u{2013}".to_owned(),
        |off| {
            let words = shown(100.0 * off, 0);
            let sign = if words.starts_with(|c: char| c.is_ascii_digit()) && words != "0" {
                "+"
            } else {
                ""
            };
            format!("{sign}{words}")
        },
    );
    let computed = |words: String| cell(words).class("computed");
    let row = tag("tr")
        .child(tag("th").with("scope", "row").text(number.to_string()))
        .child(
            cell(format!("{}, {}, {}", shown(x, 1), shown(y, 1), shown(z, 1))).class("wide place"),
        )
        .child(cell(shown(mmhg_from_kpa(p.asked_kpa), 1)))
        .child(cell(shown(p.asked_kpa, 2)))
        .child(computed(shown_or_dash(p.got_kpa.map(mmhg_from_kpa), 1)))
        .child(computed(shown_or_dash(p.got_kpa, 2)))
        .child(computed(off))
        .child(cell(shown_or_dash(p.warp_strain.map(|s| 100.0 * s), 1)));
    if notes.is_empty() {
        return vec![row];
    }
    let words = tag("td").with("colspan", "8");
    let words = notes.into_iter().fold(words, |all, (lead, note)| {
        let line = tag("p");
        let line =
            if lead.is_empty() { line } else { line.child(tag("b").class("missed").text(lead)) };
        all.child(line.child(tag("span").text(note)))
    });
    vec![row.class("more"), tag("tr").class("why").child(words)]
}

/// Girths of limb and pattern.
pub(super) fn girths(pairs: &[GirthPair]) -> Tag {
    let heads = ["limb, mm", "pattern, mm", "reduction, %"].map(head);
    let first = head("along the limb, mm").class("words");
    let rows = pairs.iter().map(|pair| {
        let open = if pair.limb.closed { "" } else { " (open)" };
        tag("tr")
            .child(tag("th").with("scope", "row").text(shown(pair.limb.at_mm, 0)))
            .child(cell(format!("{}{open}", shown(pair.limb.girth_mm, 1))))
            .child(cell(shown_or_dash(pair.pattern_mm, 1)))
            .child(cell(shown_or_dash(pair.reduction().map(|part| 100.0 * part), 1)))
    });
    tag("table")
        .child(tag("thead").child(tag("tr").child(first).children(heads)))
        .child(tag("tbody").children(rows))
}

/// The fabric and the formula that turns its tension into pressure.
pub(super) fn fabric(input: &PageInput<'_>) -> Tag {
    let fabric = &input.report.fabric;
    let stiffness = |value: f64| format!("{value} N/mm ({value} kN/m)");
    let formula = match input.report.pressure_model {
        PressureModel::Laplace => {
            "Laplace\u{2019}s law along both threads: tension times curvature".to_owned()
        }
        PressureModel::Paper => {
            format!("Wang & Tang, Eq. (2): mean curvature times tensions, s = {}", fabric.s)
        }
    };
    let radius = format!("over a radius of {} mm", input.report.curvature_radius_mm);
    let rows = [
        ("Fabric", fabric.name.clone()),
        ("Stiffness along warp, round the limb", stiffness(fabric.warp)),
        ("Stiffness along weft, along the limb", stiffness(fabric.weft)),
        ("Stiffness of the diagonals (shear)", stiffness(fabric.diagonal)),
        ("Largest strain that it bears", format!("{} %", shown(100.0 * fabric.max_strain, 0))),
        ("Strain wanted along weft", format!("{} %", shown(100.0 * fabric.weft_strain, 1))),
        ("Pressure from tension", formula),
        ("Curvature of the limb", radius),
    ];
    let rows = rows.into_iter().map(|(name, value)| {
        let name = tag("th").with("scope", "row").text(name);
        tag("tr").child(name).child(cell(value).class("words"))
    });
    tag("table").class("plain").child(tag("tbody").children(rows))
}

/// Every parameter with its value.
pub(super) fn settings(input: &PageInput<'_>) -> Tag {
    let entries = input.report.parameters.entries().iter();
    tag("ul").class("settings").children(entries.map(|(name, value)| {
        tag("li").child(tag("b").text(name.replace('_', "-"))).child(tag("span").text(value))
    }))
}

/// The workshop sheet.
pub(super) fn workshop(sheet: &Workshop) -> Tag {
    let sections = sheet.sections.iter().map(|section| {
        let head = section.head.iter().map(|words| head(words).class("words"));
        let rows = section
            .rows
            .iter()
            .map(|cells| tag("tr").children(cells.iter().map(|words| cell(words).class("words"))));
        let mut block = tag("div").class("keep").child(tag("h3").text(section.title));
        if !section.rows.is_empty() {
            let mut table = tag("table").class("sheet");
            if !section.head.is_empty() {
                table = table.child(tag("thead").child(tag("tr").children(head)));
            }
            block = block.child(table.child(tag("tbody").children(rows)));
        }
        block.children(section.notes.iter().map(|note| tag("p").class("note").text(note)))
    });
    tag("section").class("workshop").child(tag("h2").text("For the workshop")).children(sections)
}
