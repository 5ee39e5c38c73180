//! Curves of several examples in one chart, and strain functions with their bars.

use glam::DVec2;
use svg::Document;

use crate::examples::{Outcome, Threads, course};
use crate::page::chart::{Axis, FIELD, Field, LETTER, SIZE};
use crate::page::draw::{
    Anchor, INK, circle, drawing, line, path, path_data, rectangle, text, text_width,
};

/// Colour and dashes by number: told apart by either.
const LINES: [(&str, &str); 4] =
    [("#1d1d1b", "none"), ("#00599c", "9 4"), ("#b3400e", "2 4"), ("#4d6b00", "12 4 2 4")];

/// Values over the steps of a fit.
pub(super) struct Course {
    /// What it is called in the legend.
    pub(super) name: String,
    /// Steps and positive values.
    pub(super) points: Vec<(f64, f64)>,
}

/// The part of an example's title that tells it from its neighbours: "A" of "A: no pressure".
fn short(outcome: &Outcome) -> String {
    let title = outcome.example.title;
    match title.split_once(": ") {
        Some((letter, _)) => letter.to_owned(),
        None => title.split_once(' ').map_or(title, |(_, rest)| rest).to_owned(),
    }
}

/// E_SSD over the steps.
pub(super) fn sums(outcomes: &[&Outcome]) -> Vec<Course> {
    courses(outcomes, |entry| entry.e_ssd)
}

/// The root mean square strain difference of a spring, in per cent, over the steps.
pub(super) fn means(outcomes: &[&Outcome]) -> Vec<Course> {
    courses(outcomes, |entry| 100.0 * course::rms(entry))
}

fn courses(
    outcomes: &[&Outcome],
    value: impl Fn(&crate::report::HistoryEntry) -> f64,
) -> Vec<Course> {
    let one = |outcome: &&Outcome| {
        let entries = course::finest(&outcome.flattening.report.fit);
        let begin = entries.clone().next().map_or(0, |entry| entry.iteration);
        let points = entries
            .map(|entry| ((entry.iteration - begin) as f64, value(entry)))
            .filter(|(_, value)| *value > 0.0)
            .collect();
        Course { name: short(outcome), points }
    };
    outcomes.iter().map(one).collect()
}

/// A chart of curves, values logarithmic.
pub(super) fn chart(courses: &[Course], title: &str, words: &str) -> Document {
    let points = || courses.iter().flat_map(|course| course.points.iter());
    let most = points().map(|p| p.0).fold(1.0, f64::max);
    let field = Field {
        x: Axis::linear(0.0, most, "steps of the diffusion"),
        y: Axis::logarithmic(points().map(|p| p.1), title),
    };
    let mut all = field.axes(drawing(SIZE.x, SIZE.y, words));
    let (mut x, y) = (FIELD[0].x, 38.0);
    for (course, (colour, dashes)) in courses.iter().zip(LINES) {
        let places = course.points.iter().map(|&(step, value)| field.place(step, value.log10()));
        let curve = path(path_data(places), colour, 2.4).set("stroke-dasharray", dashes);
        all = all.add(curve);
        if let Some(&(step, value)) = course.points.last() {
            all = all.add(circle(field.place(step, value.log10()), 3.6, colour, colour));
        }
        let at = DVec2::new(x, y);
        let sample = line(at, at + DVec2::new(34.0, 0.0), colour, 2.4);
        all = all.add(sample.set("stroke-dasharray", dashes)).add(text(
            at + DVec2::new(40.0, 5.0),
            Anchor::Start,
            LETTER,
            &course.name,
        ));
        x += 40.0 + text_width(&course.name, LETTER) + 22.0;
    }
    all
}

/// The largest strain of these examples' functions, bars and threads, and the least below zero.
pub(super) fn strain_range(outcomes: &[&Outcome]) -> [f64; 2] {
    let all = outcomes.iter().flat_map(|outcome| {
        let function = &outcome.flattening.report.strain_function;
        let rows = function.rows.iter().map(|row| row.strain);
        let data = function.data.iter().map(|datum| datum.wanted);
        let threads = Threads::of(&outcome.flattening).profile();
        rows.chain(data).chain(threads.into_iter().map(|t| t.strain)).collect::<Vec<_>>()
    });
    let (low, high) = all.fold((0.0, 0.01), |(l, h), s| (f64::min(l, s), f64::max(h, s)));
    [100.0 * low, 100.0 * high]
}

/// A strain function with the bars that it goes through, and the strain that the threads take.
pub(super) fn strain_function(outcome: &Outcome, [low, high]: [f64; 2]) -> Document {
    let flattening = &outcome.flattening;
    let function = &flattening.report.strain_function;
    let field = Field {
        x: Axis::linear(0.0, 1.0, "t, along the brace (1: near the body)"),
        y: Axis::linear(1.08 * low, 1.08 * high, "warp strain, %"),
    };
    let words = format!("Strain function of {}", outcome.example.title);
    let mut all = field.axes(drawing(SIZE.x, SIZE.y, &words));
    let zero = [field.place(0.0, 0.0), field.place(1.0, 0.0)];
    all = all.add(line(zero[0], zero[1], INK, 0.8));
    for datum in &function.data {
        let (foot, head) = (field.place(datum.t, 0.0), field.place(datum.t, 100.0 * datum.wanted));
        let corner = DVec2::new(foot.x - 9.0, foot.y.min(head.y));
        let size = DVec2::new(18.0, (foot.y - head.y).abs().max(1.0));
        all = all.add(rectangle(corner, size, "#cfccc5").set("stroke", INK));
    }
    let [wanted, reached] = [LINES[0], LINES[1]];
    let curve = function.rows.iter().map(|row| field.place(row.t, 100.0 * row.strain));
    all = all.add(path(path_data(curve), wanted.0, 2.4));
    if let [first, .., last] = function.rows.as_slice() {
        let top = flattening.report.pattern.height_mm;
        let t = |part: f64| (part * top - first.y_mm) / (last.y_mm - first.y_mm);
        let threads = Threads::of(flattening).profile();
        let curve = threads
            .iter()
            .map(|thread| field.place(t(thread.t).clamp(0.0, 1.0), 100.0 * thread.strain));
        all = all.add(path(path_data(curve), reached.0, 2.4).set("stroke-dasharray", reached.1));
    }
    let y = 38.0;
    let mut x = FIELD[0].x;
    all = all.add(
        rectangle(DVec2::new(x, y - 7.0), DVec2::new(18.0, 13.0), "#cfccc5").set("stroke", INK),
    );
    x += 24.0;
    all = all.add(text(DVec2::new(x, y + 5.0), Anchor::Start, LETTER, "wanted (Eq. 3)"));
    x += text_width("wanted (Eq. 3)", LETTER) + 16.0;
    for ((colour, dashes), words) in [(wanted, "function"), (reached, "threads, reached")] {
        let at = DVec2::new(x, y);
        let sample = line(at, at + DVec2::new(34.0, 0.0), colour, 2.4);
        all = all.add(sample.set("stroke-dasharray", dashes));
        x += 40.0;
        all = all.add(text(DVec2::new(x, y + 5.0), Anchor::Start, LETTER, words));
        x += text_width(words, LETTER) + 16.0;
    }
    all
}
