//! Pages in millimetres with lines, words and layers.

use glam::DVec2;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str, TextStr};

use crate::export::charset::latin;
use crate::sheet::width::width;
use crate::sheet::{Item, Layer, Shape};

/// Points in a millimetre.
const POINTS: f32 = 72.0 / 25.4;

/// Width of lines, in mm.
pub(super) const LINE: f64 = 0.3;

/// A circle's arm to its control points over its radius.
const ARM: f64 = 0.552_284_75;

const CATALOG: i32 = 1;
const PAGES: i32 = 2;
const INFO: i32 = 3;
const REGULAR: i32 = 4;
const BOLD: i32 = 5;
/// The layers' objects follow one another.
const LAYERS: i32 = 6;
const FIRST_FREE: i32 = LAYERS + Layer::ALL.len() as i32;

/// A document of pages.
pub(super) struct Document {
    title: String,
    pages: Vec<Page>,
    changed: Vec<[String; 2]>,
}

/// A page being drawn, in mm, y up.
pub(super) struct Page {
    pub(super) size: DVec2,
    content: Content,
    changed: Vec<[String; 2]>,
}

impl Document {
    pub(super) fn new(title: &str) -> Self {
        Self { title: title.to_owned(), pages: Vec::new(), changed: Vec::new() }
    }

    /// A page of a size in mm; it is added when it is drawn.
    pub(super) fn page(&self, size: DVec2) -> Page {
        let mut content = Content::new();
        content.transform([POINTS, 0.0, 0.0, POINTS, 0.0, 0.0]);
        content.set_line_width(LINE as f32);
        content.set_line_join(LineJoinStyle::RoundJoin);
        content.set_line_cap(LineCapStyle::RoundCap);
        Page { size, content, changed: Vec::new() }
    }

    pub(super) fn add(&mut self, page: Page) {
        self.pages.push(page);
    }

    /// The bytes, and the texts that were changed.
    pub(super) fn finish(mut self) -> (Vec<u8>, Vec<[String; 2]>) {
        let mut pdf = Pdf::new();
        pdf.set_version(1, 5);
        let layer_ids: Vec<Ref> =
            (0..Layer::ALL.len() as i32).map(|i| Ref::new(LAYERS + i)).collect();
        let mut catalog = pdf.catalog(Ref::new(CATALOG));
        catalog.pages(Ref::new(PAGES));
        // Readers that scale to fit by themselves are asked not to.
        catalog.viewer_preferences().pair(Name(b"PrintScaling"), Name(b"None"));
        let mut optional = catalog.insert(Name(b"OCProperties")).dict();
        optional.insert(Name(b"OCGs")).array().items(layer_ids.iter().copied());
        let mut usual = optional.insert(Name(b"D")).dict();
        usual.insert(Name(b"Order")).array().items(layer_ids.iter().copied());
        usual.finish();
        optional.finish();
        catalog.finish();
        pdf.document_info(Ref::new(INFO))
            .title(TextStr(&self.title))
            .producer(TextStr(concat!("wovenfit ", env!("CARGO_PKG_VERSION"))));
        for (id, font) in [(REGULAR, "Helvetica"), (BOLD, "Helvetica-Bold")] {
            pdf.type1_font(Ref::new(id))
                .base_font(Name(font.as_bytes()))
                .encoding_predefined(Name(b"WinAnsiEncoding"));
        }
        for (id, layer) in layer_ids.iter().zip(Layer::ALL) {
            let mut group = pdf.indirect(*id).dict();
            group.pair(Name(b"Type"), Name(b"OCG"));
            group.pair(Name(b"Name"), TextStr(layer.name()));
        }
        let count = self.pages.len() as i32;
        let page_id = |i: i32| Ref::new(FIRST_FREE + 2 * i);
        pdf.pages(Ref::new(PAGES)).kids((0..count).map(page_id)).count(count);
        for (i, drawn) in (0..).zip(self.pages) {
            let stream = Ref::new(FIRST_FREE + 2 * i + 1);
            let size = drawn.size;
            let mut page = pdf.page(page_id(i));
            let [w, h] = [size.x, size.y].map(|mm| mm as f32 * POINTS);
            page.media_box(Rect::new(0.0, 0.0, w, h));
            page.parent(Ref::new(PAGES));
            page.contents(stream);
            let mut resources = page.resources();
            resources
                .fonts()
                .pair(Name(b"F0"), Ref::new(REGULAR))
                .pair(Name(b"F1"), Ref::new(BOLD));
            let mut properties = resources.insert(Name(b"Properties")).dict();
            for (k, id) in layer_ids.iter().enumerate() {
                properties.pair(Name(format!("L{k}").as_bytes()), *id);
            }
            properties.finish();
            resources.finish();
            page.finish();
            pdf.stream(stream, &drawn.content.finish());
            self.changed.extend(drawn.changed);
        }
        self.changed.sort();
        self.changed.dedup();
        (pdf.finish(), self.changed)
    }
}

impl Page {
    pub(super) fn colour(&mut self, [r, g, b]: [u8; 3]) {
        let [r, g, b] = [r, g, b].map(|c| f32::from(c) / 255.0);
        self.content.set_stroke_rgb(r, g, b);
        self.content.set_fill_rgb(r, g, b);
    }

    pub(super) fn dash(&mut self, lengths: &[f32]) {
        self.content.set_dash_pattern(lengths.iter().copied(), 0.0);
    }

    pub(super) fn line(&mut self, points: &[DVec2], closed: bool) {
        let Some((first, rest)) = points.split_first() else { return };
        self.content.move_to(first.x as f32, first.y as f32);
        for p in rest {
            self.content.line_to(p.x as f32, p.y as f32);
        }
        if closed {
            self.content.close_and_stroke();
        } else {
            self.content.stroke();
        }
    }

    pub(super) fn circle(&mut self, centre: DVec2, radius: f64) {
        let at = |x: f64, y: f64| {
            let p = centre + radius * DVec2::new(x, y);
            [p.x as f32, p.y as f32]
        };
        let [x, y] = at(1.0, 0.0);
        self.content.move_to(x, y);
        for [a, b, c] in [
            [(1.0, ARM), (ARM, 1.0), (0.0, 1.0)],
            [(-ARM, 1.0), (-1.0, ARM), (-1.0, 0.0)],
            [(-1.0, -ARM), (-ARM, -1.0), (0.0, -1.0)],
            [(ARM, -1.0), (1.0, -ARM), (1.0, 0.0)],
        ] {
            let [a, b, c] = [a, b, c].map(|(x, y)| at(x, y));
            self.content.cubic_to(a[0], a[1], b[0], b[1], c[0], c[1]);
        }
        self.content.close_and_stroke();
    }

    /// Words from a point at half the height of small letters, turned by degrees.
    pub(super) fn words(&mut self, at: DVec2, size: f64, angle: f64, bold: bool, text: &str) {
        let (bytes, whole) = latin(text);
        if !whole {
            let shown = bytes.iter().map(|b| char::from(*b)).collect();
            self.changed.push([text.to_owned(), shown]);
        }
        let turn = DVec2::from_angle(angle.to_radians());
        let base = at - 0.35 * size * turn.perp();
        let [c, s, x, y] = [turn.x, turn.y, base.x, base.y].map(|v| v as f32);
        self.content.begin_text();
        self.content.set_font(Name(if bold { b"F1" } else { b"F0" }), size as f32);
        self.content.set_text_matrix([c, s, -s, c, x, y]);
        self.content.show(Str(&bytes));
        self.content.end_text();
    }

    /// What is drawn until [`Page::restore`] is seen inside a rectangle alone, and moved.
    pub(super) fn window(&mut self, low: DVec2, size: DVec2, scale: f64, by: DVec2) {
        self.content.save_state();
        let [x, y, w, h] = [low.x, low.y, size.x, size.y].map(|v| v as f32);
        self.content.rect(x, y, w, h);
        self.content.clip_nonzero();
        self.content.end_path();
        let [scale, x, y] = [scale, by.x, by.y].map(|v| v as f32);
        self.content.transform([scale, 0.0, 0.0, scale, x, y]);
    }

    pub(super) fn restore(&mut self) {
        self.content.restore_state();
    }

    fn begin_layer(&mut self, layer: usize) {
        self.content
            .begin_marked_content_with_properties(Name(b"OC"))
            .properties_named(Name(format!("L{layer}").as_bytes()));
    }
}

/// Draws items, moved, layer by layer.
pub(super) fn drawing<'a>(
    page: &mut Page,
    items: impl Iterator<Item = &'a Item> + Clone,
    by: DVec2,
) {
    for (k, layer) in Layer::ALL.into_iter().enumerate() {
        page.begin_layer(k);
        page.colour(layer.colour());
        page.dash(if layer == Layer::Sew { &[4.0, 4.0] } else { &[] });
        for item in items.clone().filter(|item| item.layer == layer) {
            match &item.shape {
                Shape::Line { points, closed } => {
                    let points: Vec<DVec2> = points.iter().map(|p| *p + by).collect();
                    page.line(&points, *closed);
                }
                Shape::Circle { centre, radius } => page.circle(*centre + by, *radius),
                Shape::Words { at, size, angle, from_start, text } => {
                    let back = if *from_start { 0.0 } else { 0.5 * width(text, *size) };
                    let start = *at + by - back * DVec2::from_angle(angle.to_radians());
                    page.words(start, *size, *angle, false, text);
                }
            }
        }
        page.content.end_marked_content();
    }
    page.dash(&[]);
    page.colour([0; 3]);
}
