//! `paper.json`: every example's report, its threads, and the findings.

use serde::Serialize;

use super::measures::{Thread, Threads, course};
use super::{Claim, Extent, Outcome, Settings, claims};
use crate::export::json_text;
use crate::report::{ParameterValues, Report};

#[derive(Serialize)]
struct All<'a> {
    wovenfit: &'static str,
    triangles: usize,
    parameters: ParameterValues,
    claims: &'a [Claim],
    examples: Vec<One<'a>>,
}

#[derive(Serialize)]
struct One<'a> {
    name: &'static str,
    limb: &'static str,
    configuration: &'static str,
    fabric: Option<&'static str>,
    extent: Extent,
    /// First and last E_SSD of the finest level.
    e_ssd: [f64; 2],
    /// Steps until E_SSD has made 99 % of its fall.
    steps_to_99_percent: u64,
    threads: Vec<Thread>,
    report: &'a Report,
}

/// The outcomes and findings as indented JSON: the same input gives the same bytes.
#[must_use]
pub fn examples_json(settings: &Settings, outcomes: &[Outcome], claims: &[Claim]) -> String {
    let examples = outcomes
        .iter()
        .map(|outcome| {
            let (example, report) = (outcome.example, &outcome.flattening.report);
            One {
                name: example.name,
                limb: example.limb,
                configuration: example.configuration,
                fabric: example.fabric,
                extent: example.extent,
                e_ssd: course::ends(&report.fit),
                steps_to_99_percent: course::steps_to(&report.fit, claims::THERE),
                threads: Threads::of(&outcome.flattening).profile(),
                report,
            }
        })
        .collect();
    json_text(&All {
        wovenfit: env!("CARGO_PKG_VERSION"),
        triangles: settings.triangles,
        parameters: (&settings.parameters).into(),
        claims,
        examples,
    })
}
