//! The two curves: warp strain along the limb, and the course of the fit.

use glam::DVec2;
use svg::Document;

use super::PageInput;
use super::draw::{
    Anchor, FAINT, INK, QUIET, circle, drawing, line, path, path_data, rectangle, rimmed, text,
    text_width,
};
use super::html::shown;
use super::scale::round_up;

/// Size of a chart, in units of its drawing.
pub(super) const SIZE: DVec2 = DVec2::new(560.0, 340.0);
/// Upper left and lower right corner of its field.
pub(super) const FIELD: [DVec2; 2] = [DVec2::new(60.0, 52.0), DVec2::new(544.0, 288.0)];
/// Size of lettering.
pub(super) const LETTER: f64 = 15.0;

/// A range along an axis and what it is called.
pub(super) struct Axis<'a> {
    pub(super) low: f64,
    high: f64,
    title: &'a str,
    /// Where there are ticks, with their lettering.
    ticks: Vec<(f64, String)>,
}

impl<'a> Axis<'a> {
    /// From `low` to `high` with ticks at round values.
    pub(super) fn linear(low: f64, high: f64, title: &'a str) -> Self {
        let high = if high > low { high } else { low + 1.0 };
        let step = round_up((high - low) / 6.0);
        let first = (low / step - 1e-9).ceil() as i64;
        let last = (high / step + 1e-9).floor() as i64;
        // As many as the step has: 2.5 is not 2.
        let whole = |decimals: &i32| {
            let shifted = step * 10f64.powi(*decimals);
            (shifted - shifted.round()).abs() < 1e-6
        };
        let decimals = (0..6).find(whole).unwrap_or(6) as usize;
        let ticks = (first..=last)
            .map(|k| k as f64 * step)
            .map(|value| (value, shown(value, decimals)))
            .collect();
        Self { low, high, title, ticks }
    }

    /// Over these positive values, in powers of ten; places are logarithms.
    pub(super) fn logarithmic(values: impl Iterator<Item = f64>, title: &'a str) -> Self {
        let (low, high) = values
            .map(f64::log10)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let (low, high) = if low <= high { (low - 0.05, high + 0.05) } else { (0.0, 1.0) };
        let factors: &[f64] = if high - low > 3.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let mut ticks = Vec::new();
        for power in low.floor() as i32..=high.ceil() as i32 {
            for factor in factors {
                let value = factor * 10f64.powi(power);
                let at = value.log10();
                if (low..=high).contains(&at) {
                    let decimals = usize::try_from(-power).unwrap_or(0);
                    ticks.push((at, shown(value, decimals)));
                }
            }
        }
        Self { low, high, title, ticks }
    }

    fn part(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}

/// A chart's field with its axes.
pub(super) struct Field<'a> {
    pub(super) x: Axis<'a>,
    pub(super) y: Axis<'a>,
}

impl Field<'_> {
    /// Where a value is in the drawing.
    pub(super) fn place(&self, x: f64, y: f64) -> DVec2 {
        let [low, high] = FIELD;
        DVec2::new(
            low.x + self.x.part(x) * (high.x - low.x),
            high.y - self.y.part(y) * (high.y - low.y),
        )
    }

    /// Both axes with their ticks and titles.
    pub(super) fn axes(&self, mut all: Document) -> Document {
        let [low, high] = FIELD;
        for (value, words) in &self.y.ticks {
            let y = self.place(self.x.low, *value).y;
            all = all.add(line(DVec2::new(low.x, y), DVec2::new(high.x, y), FAINT, 0.8)).add(text(
                DVec2::new(low.x - 7.0, y + 5.0),
                Anchor::End,
                LETTER,
                words,
            ));
        }
        for (value, words) in &self.x.ticks {
            let x = self.place(*value, self.y.low).x;
            let foot = DVec2::new(x, high.y);
            all = all.add(line(foot, foot + DVec2::new(0.0, 5.0), INK, 1.0)).add(text(
                DVec2::new(x, high.y + 20.0),
                Anchor::Middle,
                LETTER,
                words,
            ));
        }
        let corner = DVec2::new(low.x, high.y);
        let middle = DVec2::new(0.5 * (low.x + high.x), SIZE.y - 8.0);
        all.add(line(low, corner, INK, 1.2))
            .add(line(corner, high, INK, 1.2))
            .add(text(middle, Anchor::Middle, LETTER, self.x.title))
            .add(text(DVec2::new(4.0, 16.0), Anchor::Start, LETTER, self.y.title))
    }
}

/// Shapes that stand for data.
#[derive(Clone, Copy)]
enum Mark {
    Wanted,
    Asked,
    Reached,
}

fn mark(all: Document, at: DVec2, mark: Mark) -> Document {
    match mark {
        Mark::Wanted => all.add(circle(at, 5.5, "#ffffff", INK).set("stroke-width", "1.8")),
        Mark::Asked => all.add(
            rectangle(at - DVec2::splat(3.6), DVec2::splat(7.2), INK)
                .set("transform", format!("rotate(45 {:.2} {:.2})", at.x, at.y)),
        ),
        Mark::Reached => {
            let (a, b) = (DVec2::splat(5.0), DVec2::new(5.0, -5.0));
            all.add(line(at - a, at + a, INK, 2.0)).add(line(at - b, at + b, INK, 2.0))
        }
    }
}

/// Warp strain wanted of the threads along the limb, and what was asked and reached at the points;
/// `None` where the fit knows no threads.
pub(super) fn strain_function(input: &PageInput<'_>) -> Option<Document> {
    let function = &input.report.strain_function;
    let (first, last) = (function.rows.first()?, function.rows.last()?);
    let top = input.report.pattern.height_mm;
    let below = |y_mm: f64| top - y_mm;
    let at = |t: f64| below(first.y_mm + t * (last.y_mm - first.y_mm));
    let points = &input.drawing.points;
    let reached: Vec<(f64, f64)> = points
        .iter()
        .zip(&input.report.pressures)
        .filter_map(|((place, _), p)| Some((below(place.y), 100.0 * p.warp_strain?)))
        .collect();
    let rows = || function.rows.iter().map(|row| 100.0 * row.strain);
    let data = || function.data.iter().flat_map(|d| [d.wanted, d.asked]).map(|s| 100.0 * s);
    let most = rows().chain(data()).chain(reached.iter().map(|r| r.1)).fold(0.0, f64::max);
    let least = data().chain(reached.iter().map(|r| r.1)).fold(0.0, f64::min);
    let field = Field {
        x: Axis::linear(0.0, top, "mm below the pattern's upper edge (left: near the body)"),
        y: Axis::linear(1.08 * least, (1.08 * most).max(1.0), "warp strain, %"),
    };
    let mut all = field.axes(drawing(SIZE.x, SIZE.y, "Warp strain along the limb"));
    for datum in &function.data {
        let (foot, head) = (field.place(at(datum.t), 0.0), 100.0 * datum.wanted);
        let head = field.place(at(datum.t), head);
        let corner = DVec2::new(foot.x - 7.0, foot.y.min(head.y));
        let bar = rectangle(corner, DVec2::new(14.0, (foot.y - head.y).abs()), "#dcdad5");
        all = all.add(bar);
    }
    let curve =
        path_data(function.rows.iter().map(|r| field.place(below(r.y_mm), 100.0 * r.strain)));
    all = all.add(path(curve, "#00599c", 2.6));
    for datum in &function.data {
        all = mark(all, field.place(at(datum.t), 100.0 * datum.wanted), Mark::Wanted);
        all = mark(all, field.place(at(datum.t), 100.0 * datum.asked), Mark::Asked);
    }
    for (x, strain) in reached {
        all = mark(all, field.place(x, strain), Mark::Reached);
    }
    // The legend, over the field.
    let (mut x, y) = (FIELD[0].x, 38.0);
    let base = |x: f64| DVec2::new(x, y);
    all = all.add(line(base(x), base(x + 22.0), "#00599c", 2.6));
    x += 28.0;
    let lettering = |all: Document, x: &mut f64, words: &str| {
        let label = text(DVec2::new(*x, y + 5.0), Anchor::Start, LETTER, words);
        *x += text_width(words, LETTER) + 22.0;
        all.add(label)
    };
    all = lettering(all, &mut x, "fitted");
    for (kind, words) in
        [(Mark::Wanted, "wanted"), (Mark::Asked, "asked"), (Mark::Reached, "reached")]
    {
        all = mark(all, base(x), kind);
        x += 11.0;
        all = lettering(all, &mut x, words);
    }
    Some(all)
}

/// E_SSD, Eq. (14), over the steps of the fit; `None` where there is no course to show.
pub(super) fn energy(input: &PageInput<'_>) -> Option<Document> {
    let fit = &input.report.fit;
    // A level has its own spacing of threads, or its own vertices.
    let by_vertices = fit.method == "newton";
    let history: Vec<(f64, f64, f64)> = fit
        .history
        .iter()
        .filter(|entry| entry.e_ssd > 0.0)
        .map(|entry| {
            let level = if by_vertices { entry.nodes as f64 } else { entry.spacing_mm };
            (entry.iteration as f64, entry.e_ssd, level)
        })
        .collect();
    let last = history.last()?;
    let field = Field {
        x: Axis::linear(0.0, last.0, "steps"),
        y: Axis::logarithmic(history.iter().map(|h| h.1), "E_SSD, logarithmic"),
    };
    let mut all = field.axes(drawing(SIZE.x, SIZE.y, "E_SSD over the steps of the fit"));
    for (k, level) in history.chunk_by(|a, b| a.2 == b.2).enumerate() {
        let places = level.iter().map(|h| field.place(h.0, h.1.log10()));
        let start = field.place(level[0].0, field.y.low);
        // Alternating heights: the first levels are short.
        let head = DVec2::new(start.x, FIELD[0].y - if k % 2 == 0 { 26.0 } else { 8.0 });
        all = all.add(line(start, head, QUIET, 1.0).set("stroke-dasharray", "2 4")).add(path(
            path_data(places),
            "#00599c",
            2.6,
        ));
        let unit = if by_vertices { "vertices" } else { "mm" };
        let words = format!("{} {unit}", shown(level[0].2, usize::from(level[0].2.fract() != 0.0)));
        all = all.add(rimmed(head + DVec2::new(5.0, 10.0), Anchor::Start, LETTER, &words));
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = Axis::linear(-3.0, 265.0, "");
        let ticks: Vec<f64> = axis.ticks.iter().map(|t| t.0).collect();
        assert_eq!(ticks, [0.0, 50.0, 100.0, 150.0, 200.0, 250.0]);
        let axis = Axis::linear(0.0, 0.0, "");
        assert!(axis.ticks.len() > 2 && axis.high > axis.low);
        let axis = Axis::linear(0.0, 13.0, "");
        let words: Vec<&str> = axis.ticks.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(words, ["0.0", "2.5", "5.0", "7.5", "10.0", "12.5"]);
    }

    #[test]
    fn powers_of_ten_are_a_tick_each_when_there_are_many() {
        let axis = Axis::logarithmic([0.3, 6.0].into_iter(), "");
        let words: Vec<&str> = axis.ticks.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(words, ["0.5", "1", "2", "5"]);
        let axis = Axis::logarithmic([0.002, 6000.0].into_iter(), "");
        let words: Vec<&str> = axis.ticks.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(words, ["0.01", "0.1", "1", "10", "100", "1000"]);
    }

    #[test]
    fn a_field_has_its_origin_at_the_lower_left() {
        let field = Field { x: Axis::linear(0.0, 10.0, ""), y: Axis::linear(0.0, 5.0, "") };
        assert_eq!(field.place(0.0, 0.0), DVec2::new(FIELD[0].x, FIELD[1].y));
        assert_eq!(field.place(10.0, 5.0), DVec2::new(FIELD[1].x, FIELD[0].y));
    }
}
