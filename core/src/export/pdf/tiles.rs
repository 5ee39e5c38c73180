//! Tiles for an office printer: an overview with the boxes to measure, then page by page.
//!
//! Neighbouring pages overlap. In every overlap stand crosses that are drawn at the same place of the
//! sheet on both pages: laid on each other, the pages fit. Pages on which nothing is drawn are left out.

use glam::DVec2;

use super::document::{Document, Page, drawing};
use crate::sheet::width::{width, wrapped};
use crate::sheet::{OUTER_BOX, Shape, Sheet, boxes};

/// What ordinary printers cannot reach, in mm.
const MARGIN: f64 = 10.0;
/// Below the drawing, for the page's name, in mm.
const FOOT: f64 = 8.0;
/// How far pages overlap, in mm.
const OVERLAP: f64 = 15.0;
/// Arms of a cross, in mm.
const CROSS: f64 = 5.0;
/// Size of small words, in mm.
const SMALL: f64 = 3.6;

const GREY: [u8; 3] = [150, 150, 150];

/// How a sheet is cut into pages.
pub(super) struct Grid {
    /// What a page shows of the sheet, in mm.
    pub(super) window: DVec2,
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Grid {
    pub(super) fn new(sheet: DVec2, paper: DVec2) -> Self {
        let window = paper - 2.0 * MARGIN - DVec2::new(0.0, FOOT);
        let count = |length: f64, window: f64| {
            ((length - OVERLAP) / (window - OVERLAP)).ceil().max(1.0) as usize
        };
        Self { window, columns: count(sheet.x, window.x), rows: count(sheet.y, window.y) }
    }

    /// The lower left corner of what a page shows; rows count from the top.
    fn corner(&self, row: usize, column: usize) -> DVec2 {
        let step = self.window - OVERLAP;
        DVec2::new(column as f64, (self.rows - 1 - row) as f64) * step
    }

    /// A letter for the row, a number for the column.
    fn name(row: usize, column: usize) -> String {
        let letter = char::from(b'A' + (row % 26) as u8);
        let again = if row < 26 { String::new() } else { (row / 26 + 1).to_string() };
        format!("{letter}{again}{}", column + 1)
    }

    fn pages(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)))
    }

    /// Where crosses stand: in every overlap of two pages, at a quarter and three quarters of it.
    fn crosses(&self) -> Vec<DVec2> {
        let step = self.window - OVERLAP;
        let mut crosses = Vec::new();
        for (row, column) in self.pages() {
            let corner = self.corner(row, column);
            for share in [0.25, 0.75] {
                if column + 1 < self.columns {
                    let x = step.x + 0.5 * OVERLAP;
                    crosses.push(corner + DVec2::new(x, share * self.window.y));
                }
                if row > 0 {
                    let y = step.y + 0.5 * OVERLAP;
                    crosses.push(corner + DVec2::new(share * self.window.x, y));
                }
            }
        }
        crosses
    }
}

/// The overview and the tiles.
pub(super) fn add(document: &mut Document, sheet: &Sheet<'_>, paper: DVec2) {
    let grid = Grid::new(sheet.size, paper);
    let drawn: Vec<(usize, usize)> =
        grid.pages().filter(|&(row, column)| shows(sheet, &grid, row, column)).collect();
    let page = overview(document, sheet, &grid, &drawn, paper);
    document.add(page);
    for (number, &(row, column)) in drawn.iter().enumerate() {
        let mut page = document.page(paper);
        let (corner, low) = (grid.corner(row, column), DVec2::new(MARGIN, MARGIN + FOOT));
        page.window(low, grid.window, 1.0, DVec2::ZERO);
        drawing(&mut page, sheet.all(), low - corner);
        page.colour(GREY);
        for cross in grid.crosses() {
            let at = cross - corner + low;
            let (x, y) = (DVec2::new(CROSS, 0.0), DVec2::new(0.0, CROSS));
            page.line(&[at - x, at + x], false);
            page.line(&[at - y, at + y], false);
            page.circle(at, 0.5 * CROSS);
        }
        // Where the neighbours' drawings begin.
        let step = grid.window - OVERLAP;
        page.dash(&[2.0, 2.0]);
        for (there, x) in [(column > 0, OVERLAP), (column + 1 < grid.columns, step.x)] {
            if there {
                let from = low + DVec2::new(x, 0.0);
                page.line(&[from, from + DVec2::new(0.0, grid.window.y)], false);
            }
        }
        for (there, y) in [(row + 1 < grid.rows, OVERLAP), (row > 0, step.y)] {
            if there {
                let from = low + DVec2::new(0.0, y);
                page.line(&[from, from + DVec2::new(grid.window.x, 0.0)], false);
            }
        }
        page.dash(&[]);
        frame(&mut page, low, grid.window);
        page.restore();
        page.colour(GREY);
        frame(&mut page, low, grid.window);
        page.colour([0; 3]);
        let foot = DVec2::new(MARGIN, MARGIN + 0.5 * FOOT - 1.0);
        page.words(foot, 6.0, 0.0, true, &Grid::name(row, column));
        let words = format!(
            "row {} of {}, column {} of {}; page {} of {}.  {}",
            row + 1,
            grid.rows,
            column + 1,
            grid.columns,
            number + 1,
            drawn.len(),
            sheet.heading.name
        );
        page.words(foot + DVec2::new(16.0, 0.0), SMALL, 0.0, false, &words);
        document.add(page);
    }
}

fn frame(page: &mut Page, low: DVec2, size: DVec2) {
    let (x, y) = (DVec2::new(size.x, 0.0), DVec2::new(0.0, size.y));
    page.line(&[low, low + x, low + size, low + y], true);
}

/// Whether anything is drawn on a page: a part of a line, a circle or the box of words.
fn shows(sheet: &Sheet<'_>, grid: &Grid, row: usize, column: usize) -> bool {
    let low = grid.corner(row, column);
    let high = low + grid.window;
    sheet.all().any(|item| match &item.shape {
        Shape::Line { points, closed } => {
            let next = points.iter().skip(1).chain(points.first().filter(|_| *closed));
            points.iter().zip(next).any(|(a, b)| reaches(*a, *b, low, high))
        }
        Shape::Circle { centre, radius } => {
            (*centre + *radius).cmpge(low).all() && (*centre - *radius).cmple(high).all()
        }
        Shape::Words { at, size, angle, from_start, text } => {
            let way = DVec2::from_angle(angle.to_radians()) * width(text, *size);
            let start = if *from_start { *at } else { *at - 0.5 * way };
            reaches(start, start + way, low - *size, high + *size)
        }
    })
}

/// Whether a segment has a point in a box (Liang and Barsky 1984).
fn reaches(a: DVec2, b: DVec2, low: DVec2, high: DVec2) -> bool {
    let way = b - a;
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for k in 0..2 {
        if way[k] == 0.0 {
            if a[k] < low[k] || a[k] > high[k] {
                return false;
            }
            continue;
        }
        let (s, t) = ((low[k] - a[k]) / way[k], (high[k] - a[k]) / way[k]);
        enter = enter.max(s.min(t));
        leave = leave.min(s.max(t));
    }
    enter <= leave
}

/// The first page: the boxes to measure, and how the pages lie.
fn overview(
    document: &Document,
    sheet: &Sheet<'_>,
    grid: &Grid,
    drawn: &[(usize, usize)],
    paper: DVec2,
) -> Page {
    let mut page = document.page(paper);
    let left = MARGIN + 5.0;
    let mut y = paper.y - MARGIN - 8.0;
    page.words(DVec2::new(left, y), 7.0, 0.0, true, &sheet.heading.name);
    y -= 9.0;
    let text = format!(
        "Print this page first, at 100 % (\"actual size\", not \"fit to page\"), and measure the boxes. \
         Then print the {} pages, cut or fold each along its frame on two sides, lay the crosses of \
         neighbouring pages on each other and glue. Rows are letters from the top, columns numbers \
         from the left; pages without a frame below are empty and left out.",
        drawn.len()
    );
    for line in wrapped(&text, SMALL, paper.x - 2.0 * left) {
        page.words(DVec2::new(left, y), SMALL, 0.0, false, &line);
        y -= 5.2;
    }
    y -= 2.0;
    let corner = DVec2::new(left, y - OUTER_BOX.y);
    let items = boxes(corner);
    drawing(&mut page, items.iter(), DVec2::ZERO);
    y = corner.y - 10.0;
    // The pages, as large as the rest of the paper allows.
    let all = grid.corner(0, grid.columns - 1) + grid.window;
    let room = DVec2::new(paper.x - 2.0 * left, y - MARGIN - 5.0);
    let scale = (room / all).min_element().min(0.5);
    let origin = DVec2::new(left, y - scale * all.y);
    page.window(origin - 1.0, scale * all + 2.0, scale, origin);
    drawing(&mut page, sheet.all(), DVec2::ZERO);
    page.restore();
    for &(row, column) in drawn {
        let low = origin + scale * grid.corner(row, column);
        page.colour([0, 0x50, 0xa0]);
        frame(&mut page, low, scale * grid.window);
        let size = (0.12 * scale * grid.window.x).clamp(2.5, 8.0);
        let at = low + DVec2::new(1.0, size);
        page.words(at, size, 0.0, true, &Grid::name(row, column));
    }
    page.colour([0; 3]);
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_cover_the_sheet_with_their_overlaps() {
        // A4 shows 190 × 269 mm, 175 × 254 further.
        let paper = DVec2::new(210.0, 297.0);
        let grid = Grid::new(DVec2::new(365.0, 269.0), paper);
        assert_eq!((grid.window, grid.columns, grid.rows), (DVec2::new(190.0, 269.0), 2, 1));
        let grid = Grid::new(DVec2::new(365.1, 270.0), paper);
        assert_eq!((grid.columns, grid.rows), (3, 2));
        assert_eq!(grid.corner(1, 0), DVec2::ZERO);
        assert_eq!(grid.corner(0, 2), DVec2::new(350.0, 254.0));
        assert_eq!((Grid::name(0, 0), Grid::name(27, 11)), ("A1".to_owned(), "B212".to_owned()));
        // Every cross lies on two pages or, where four overlap, on more.
        for cross in grid.crosses() {
            let on = |&(row, column): &(usize, usize)| {
                let low = grid.corner(row, column);
                cross.cmpgt(low).all() && cross.cmplt(low + grid.window).all()
            };
            assert!(grid.pages().filter(on).count() >= 2, "{cross}");
        }
    }

    #[test]
    fn a_segment_is_seen_where_it_passes() {
        let (low, high) = (DVec2::ZERO, DVec2::ONE);
        assert!(reaches(DVec2::new(-1.0, 0.5), DVec2::new(2.0, 0.5), low, high));
        assert!(!reaches(DVec2::new(-1.0, 1.5), DVec2::new(2.0, 1.5), low, high));
        assert!(!reaches(DVec2::new(-1.0, 0.0), DVec2::new(0.0, 2.5), low, high));
        assert!(reaches(DVec2::splat(0.5), DVec2::splat(0.5), low, high));
    }
}
