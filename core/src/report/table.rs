//! The table of pressures for a terminal: plain text, aligned columns.
//!
//! What stands in it is computed from a model of the fabric. It says so, and it says where the fit
//! did not converge: a table travels without its report.

use super::json::{PressureReport, Report};
use crate::units::mmhg_from_kpa;

/// Longest line of running text.
const WIDTH: usize = 78;
/// Indent of a reason under its row.
const INDENT: &str = "      ";
/// The tallest number of rows shown; a painted field has thousands.
const MOST_ROWS: usize = 200;

/// The pressures wanted and computed, in mmHg and kPa, with the warp strain and, under a row, why
/// it misses.
#[must_use]
pub fn pressure_table(report: &Report) -> String {
    let mut text = String::from("Normal pressures: computed, not measured\n");
    if !report.fit.converged {
        text.push_str(&format!(
            "NOT CONVERGED after {} steps: the figures below are not final\n",
            report.fit.iterations
        ));
    }
    text.push('\n');
    if report.pressures.is_empty() {
        text.push_str("The design wants no pressures.\n");
        return text;
    }
    text.push_str("              wanted           computed\n");
    text.push_str("   #      mmHg     kPa       mmHg     kPa   warp strain\n");
    for (i, pressure) in report.pressures.iter().enumerate().take(MOST_ROWS) {
        text.push_str(&row(i + 1, pressure));
        if let Some(reason) = &pressure.reason {
            text.push_str(&wrapped(&reason.text));
        }
    }
    if report.pressures.len() > MOST_ROWS {
        let rest = report.pressures.len() - MOST_ROWS;
        text.push_str(&format!("… and {rest} more: see report.json\n"));
    }
    let missed = report.pressures.iter().filter(|p| p.reason.is_some()).count();
    let all = report.pressures.len();
    text.push_str(&match missed {
        0 => format!("\n{all} of {all} reached.\n"),
        _ => format!("\n{} of {all} reached, {missed} missed.\n", all - missed),
    });
    if let Some(farthest) = farthest(report) {
        text.push_str(&farthest);
    }
    text
}

/// What "reached" may hide: by how much that one of the reached pressures is off that is off by most.
fn farthest(report: &Report) -> Option<String> {
    let reached = report.pressures.iter().filter(|p| p.reason.is_none() && p.asked_kpa > 0.0);
    let off = reached.filter_map(|p| Some((p.got_kpa? / p.asked_kpa - 1.0).abs()));
    let most = off.reduce(f64::max)?;
    Some(format!("Those reached are off by {:.1} % at most.\n", 100.0 * most))
}

fn row(number: usize, pressure: &PressureReport) -> String {
    let asked = pressure.asked_kpa;
    let strain = pressure.warp_strain.map(|strain| 100.0 * strain);
    let line = format!(
        "{number:>4}  {:>8}{:>8}   {:>8}{:>8}   {:>9}{}",
        shown(Some(mmhg_from_kpa(asked)), 1),
        shown(Some(asked), 2),
        shown(pressure.got_kpa.map(mmhg_from_kpa), 1),
        shown(pressure.got_kpa, 2),
        shown(strain, 1),
        if strain.is_some() { " %" } else { "" },
    );
    format!("{}\n", line.trim_end())
}

/// A number, without the sign of what rounds to zero; a dash where it is unknown.
fn shown(value: Option<f64>, decimals: usize) -> String {
    let Some(value) = value else { return "-".to_owned() };
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}

/// Running text in indented lines that fit a terminal.
fn wrapped(text: &str) -> String {
    let mut lines = String::new();
    let mut line = INDENT.to_owned();
    for word in text.split_whitespace() {
        let used = line.chars().count();
        if used > INDENT.len() && used + 1 + word.chars().count() > WIDTH {
            lines.push_str(&line);
            lines.push('\n');
            line = INDENT.to_owned();
        }
        if line.chars().count() > INDENT.len() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines + &line + "\n"
}

#[cfg(test)]
mod tests {
    use super::super::example::report;
    use super::*;

    #[test]
    fn columns_are_aligned_and_reasons_stand_under_their_row() {
        let expected = "\
Normal pressures: computed, not measured

              wanted           computed
   #      mmHg     kPa       mmHg     kPa   warp strain
   1      17.2    2.29       17.1    2.28        14.9 %
   2      20.0    2.67          -       -           -
      the limb is concave here along warp: no tension presses on it; put a pad
      here or move the point to a convex place

1 of 2 reached, 1 missed.
Those reached are off by 0.4 % at most.
";
        assert_eq!(pressure_table(&report()), expected);
    }

    #[test]
    fn a_run_that_did_not_converge_says_so_first() {
        let mut report = report();
        report.fit.converged = false;
        let table = pressure_table(&report);
        assert_eq!(
            table.lines().nth(1),
            Some("NOT CONVERGED after 4000 steps: the figures below are not final")
        );
    }

    #[test]
    fn a_design_without_pressures_has_a_table_that_says_so() {
        let mut report = report();
        report.pressures.clear();
        assert_eq!(
            pressure_table(&report),
            "Normal pressures: computed, not measured\n\nThe design wants no pressures.\n"
        );
    }

    #[test]
    fn what_rounds_to_zero_has_no_sign() {
        assert_eq!(shown(Some(-0.004), 2), "0.00");
        assert_eq!(shown(Some(-0.04), 1), "0.0");
        assert_eq!(shown(Some(-0.06), 1), "-0.1");
    }

    #[test]
    fn a_painted_field_is_cut_short() {
        let mut report = report();
        report.pressures = vec![report.pressures[0].clone(); 203];
        let table = pressure_table(&report);
        assert!(table.contains("… and 3 more: see report.json\n"), "{table}");
        let end = "\n203 of 203 reached.\nThose reached are off by 0.4 % at most.\n";
        assert!(table.ends_with(end), "{table}");
    }
}
