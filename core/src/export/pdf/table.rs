//! The workshop sheet as pages of tables.

use glam::DVec2;

use super::document::{Document, Page};
use crate::report::{Section, Workshop};
use crate::sheet::width::{width, wrapped};

/// White border, in mm.
const MARGIN: f64 = 15.0;
/// Size of words, and from line to line, in mm.
const SIZE: f64 = 3.3;
const STEP: f64 = 4.5;
const TITLE: f64 = 6.5;
const HEADING: f64 = 4.2;
/// Between columns, in mm.
const GAP: f64 = 3.0;
/// The widest that a column is wanted, in mm.
const WIDEST: f64 = 112.0;
/// The bold face is so much wider than the widths that are known.
const BOLD: f64 = 1.08;

struct Pages<'a> {
    document: &'a mut Document,
    paper: DVec2,
    page: Page,
    y: f64,
}

/// Adds the workshop sheet.
pub(super) fn add(document: &mut Document, workshop: &Workshop, paper: DVec2) {
    let page = document.page(paper);
    let mut pages = Pages { document, paper, page, y: paper.y - MARGIN - 3.0 };
    pages.line(TITLE, true, &workshop.title);
    pages.y -= 2.0;
    for section in &workshop.sections {
        pages.section(section);
    }
    let Pages { document, page, .. } = pages;
    document.add(page);
}

impl Pages<'_> {
    fn width(&self) -> f64 {
        self.paper.x - 2.0 * MARGIN
    }

    /// Goes to a new page unless so much room is left.
    fn need(&mut self, room: f64) {
        if self.y - room < MARGIN {
            let next = self.document.page(self.paper);
            let full = std::mem::replace(&mut self.page, next);
            self.document.add(full);
            self.y = self.paper.y - MARGIN - 3.0;
        }
    }

    fn line(&mut self, size: f64, bold: bool, text: &str) {
        for line in wrapped(text, size, self.width()) {
            self.need(1.4 * size);
            let at = DVec2::new(MARGIN, self.y);
            self.page.words(at, size, 0.0, bold, &line);
            self.y -= 1.4 * size;
        }
    }

    fn section(&mut self, section: &Section) {
        // A heading stays with its first rows.
        self.need(HEADING + 4.0 * STEP);
        self.y -= 2.5;
        self.line(HEADING, true, section.title);
        let columns = self.columns(section);
        if !section.head.is_empty() {
            let head: Vec<String> = section.head.iter().map(|&text| text.to_owned()).collect();
            self.row(&head, &columns, true);
        }
        for row in &section.rows {
            self.row(row, &columns, false);
        }
        for note in &section.notes {
            self.line(SIZE, false, note);
        }
    }

    /// Widths of columns, as their words want it.
    fn columns(&self, section: &Section) -> Vec<f64> {
        let count = section.rows.first().map_or(section.head.len(), Vec::len);
        let wanted = |i: usize| {
            let head = section.head.get(i).map_or(0.0, |text| BOLD * width(text, SIZE));
            let cells = section.rows.iter().filter_map(|row| row.get(i));
            let widest = cells.map(|text| width(text, SIZE)).fold(head, f64::max);
            (widest + GAP).min(WIDEST)
        };
        let wanted: Vec<f64> = (0..count).map(wanted).collect();
        let scale = self.width() / wanted.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        wanted.iter().map(|width| scale * width).collect()
    }

    /// A row in columns.
    fn row(&mut self, cells: &[String], widths: &[f64], bold: bool) {
        let size = if bold { BOLD * SIZE } else { SIZE };
        let columns: Vec<Vec<String>> = cells
            .iter()
            .zip(widths)
            .map(|(text, column)| wrapped(text, size, column - GAP))
            .collect();
        let high = columns.iter().map(Vec::len).max().unwrap_or(1).max(1) as f64;
        self.need(high * STEP);
        let mut x = MARGIN;
        for (lines, width) in columns.iter().zip(widths) {
            for (k, line) in lines.iter().enumerate() {
                let at = DVec2::new(x, self.y - STEP * k as f64);
                self.page.words(at, SIZE, 0.0, bold, line);
            }
            x += width;
        }
        self.y -= high * STEP;
        let rule = self.y + 0.45 * STEP;
        self.page.colour([200; 3]);
        let end = self.paper.x - MARGIN;
        self.page.line(&[DVec2::new(MARGIN, rule), DVec2::new(end, rule)], false);
        self.page.colour([0; 3]);
        self.y -= 0.25 * STEP;
    }
}
