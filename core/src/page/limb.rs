//! The limb from four sides, coloured by a quantity, with seams and asked points.
//!
//! A scan does not know which side of the body it is. Up is towards the end near the body (upward
//! in the pattern); front is the side on which the orientation markers lie, which the designer
//! chooses and which stands on the middle line of a pattern; right and left are those of one who
//! looks at the front.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::PageInput;
use super::draw::{
    Anchor, INK, Labels, circle, drawing, image, line, path, path_data, rimmed, text,
};
use super::html::{Tag, shown, tag};
use super::picture::{Shades, data_address};
use super::quantity::Quantity;
use super::raster::{Camera, Raster};
use crate::geometry::Locator;
use crate::surface::VertexId;

/// Width of a view, in units of the drawing.
const WIDTH: f64 = 260.0;
/// White round the limb.
const MARGIN: f64 = 8.0;
/// Room for the scale bar under it.
const FOOTER: f64 = 26.0;
/// Largest height of the limb.
const HEIGHT: f64 = 400.0;
/// Pixels in a unit: 290 per inch where four views share an A4 sheet.
const DENSITY: f64 = 2.2;
/// Size of lettering.
const SIZE: f64 = 17.0;
/// How far before a point on the surface something may be seen and the point be still visible, in
/// mm: the scan's own roughness and a pixel's slope.
const SLACK: f64 = 2.0;
/// More points than this are drawn without numbers.
const MOST_NUMBERS: usize = 40;

struct View {
    name: &'static str,
    camera: Camera,
    raster: Raster,
    shades: Shades,
    corner: DVec2,
    size: DVec2,
}

impl View {
    /// Where a point is in the drawing.
    fn place(&self, p: DVec3) -> DVec2 {
        self.corner + self.camera.pixel(p) / DENSITY
    }

    fn shows(&self, p: DVec3) -> bool {
        self.raster.shows(&self.camera, p, SLACK)
    }
}

/// The four views of a limb, ready to be coloured.
pub(super) struct Limb<'a> {
    input: &'a PageInput<'a>,
    views: Vec<View>,
    /// Asked points on the surface.
    points: Vec<DVec3>,
    /// The seams on the surface.
    seams: Vec<Vec<DVec3>>,
    scale: f64,
    height: f64,
}

impl<'a> Limb<'a> {
    pub(super) fn new(input: &'a PageInput<'a>) -> Self {
        let disk = input.disk;
        let normals = disk.vertex_normals();
        let up = up(input);
        let front = front(input, &normals, up);
        let right = up.cross(front);
        let ways = [
            ("From the front", front),
            ("From the right", right),
            ("From the back", -front),
            ("From the left", -right),
        ];
        let extent = |way: DVec3| {
            let along = disk.points().iter().map(|p| p.dot(way));
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)))
        };
        let centre: DVec3 = [right, up, front]
            .into_iter()
            .map(|way| {
                let (low, high) = extent(way);
                0.5 * (low + high) * way
            })
            .sum();
        let span = |way: DVec3| {
            let (low, high) = extent(way);
            (high - low).max(1.0)
        };
        let (wide, high) = (span(right).max(span(front)), span(up));
        let scale = ((WIDTH - 2.0 * MARGIN) / wide).min(HEIGHT / high);
        let views = ways
            .into_par_iter()
            .map(|(name, viewer)| {
                let across = up.cross(viewer);
                // A pixel more on every side for the edge.
                let pixels = |mm: f64| (mm * scale * DENSITY).ceil() as usize + 2;
                let camera = Camera {
                    right: across,
                    up,
                    viewer,
                    centre,
                    scale: scale * DENSITY,
                    size: [pixels(span(across)), pixels(high)],
                };
                let size = DVec2::new(camera.size[0] as f64, camera.size[1] as f64) / DENSITY;
                let raster = Raster::new(disk, disk.points(), &camera);
                let light = (viewer + 0.25 * up - 0.25 * across).normalize_or_zero();
                View {
                    name,
                    camera,
                    shades: Shades::new(disk, &raster, &normals, light),
                    raster,
                    corner: DVec2::new(0.5 * (WIDTH - size.x), MARGIN),
                    size,
                }
            })
            .collect();
        let locator = Locator::new(disk);
        let on_surface = |at: [f64; 3]| {
            locator.closest(DVec3::from_array(at)).map(|(point, _)| point.position(disk))
        };
        let points = input.report.pressures.iter().filter_map(|p| on_surface(p.at)).collect();
        let height = high * scale + 2.0 * MARGIN + FOOTER;
        Self { input, views, points, seams: seams(input), scale, height }
    }

    /// The four views coloured by a quantity.
    pub(super) fn figure(&self, quantity: &Quantity) -> Tag {
        let pictures: Vec<String> =
            self.views.par_iter().map(|view| self.picture(view, quantity)).collect();
        let views = self.views.iter().zip(pictures).enumerate().map(|(k, (view, picture))| {
            let caption = tag("figcaption").text(view.name);
            tag("figure").child(self.drawing(view, quantity, picture, k == 0)).child(caption)
        });
        tag("div").class("views").children(views)
    }

    /// One of the four views (0: from the front, then its right, back and left) by itself.
    pub(super) fn view(&self, number: usize, quantity: &Quantity) -> svg::Document {
        let view = &self.views[number];
        self.drawing(view, quantity, self.picture(view, quantity), true)
    }

    fn picture(&self, view: &View, quantity: &Quantity) -> String {
        let (shades, pixel) = (Some(&view.shades), 1.0 / view.camera.scale);
        data_address(self.input.disk, &view.raster, &quantity.field(), shades, pixel)
    }

    fn drawing(
        &self,
        view: &View,
        quantity: &Quantity,
        picture: String,
        with_scale: bool,
    ) -> svg::Document {
        let words = format!("The limb {}, coloured by {}", view.name, quantity.name);
        let mut all =
            drawing(WIDTH, self.height, &words).add(image(view.corner, view.size, picture));
        for run in self.seams.iter().flat_map(|seam| visible_runs(view, seam)) {
            let data = path_data(run.iter().map(|&p| view.place(p)));
            all = all
                .add(path(data.clone(), "#ffffff", 4.0))
                .add(path(data, INK, 1.6).set("stroke-dasharray", "6 4"));
        }
        let mut labels = Labels::new(DVec2::new(WIDTH, self.height));
        let seen: Vec<(usize, DVec2)> = self
            .points
            .iter()
            .enumerate()
            .filter(|(_, p)| view.shows(**p))
            .map(|(k, &p)| (k, view.place(p)))
            .collect();
        let numbered = self.points.len() <= MOST_NUMBERS;
        for &(_, at) in &seen {
            let (radius, width) = if numbered { (5.0, 2.0) } else { (2.0, 0.8) };
            all = all.add(circle(at, radius, "#ffffff", INK).set("stroke-width", width));
            labels.keep_free(at, radius);
        }
        if let Some(v) = quantity.largest {
            let p = self.input.disk.point(v);
            if view.shows(p) {
                let at = view.place(p);
                let corners = [(0.0, -7.0), (6.5, 4.5), (-6.5, 4.5)];
                let data = path_data(corners.map(|c| at + DVec2::from(c)));
                all = all.add(path(data + "Z", INK, 1.8).set("fill", "#ffffff"));
                labels.keep_free(at, 7.0);
                let words = format!("most {}", shown(quantity.values[v.index()], 0));
                let (place, anchor) = labels.place(at, 10.0, SIZE, &words);
                all = all.add(rimmed(place, anchor, SIZE, &words));
            }
        }
        for (k, at) in seen.into_iter().filter(|_| numbered) {
            let words = (k + 1).to_string();
            let (place, anchor) = labels.place(at, 7.0, SIZE, &words);
            let label = rimmed(place, anchor, SIZE, &words);
            all = all.add(label.set("font-weight", "700"));
        }
        if with_scale { self.scale_bar(all) } else { all }
    }

    fn scale_bar(&self, all: svg::Document) -> svg::Document {
        let left = DVec2::new(MARGIN, self.height - 12.0);
        let right = left + DVec2::new(50.0 * self.scale, 0.0);
        let tick = DVec2::new(0.0, 4.0);
        let words = right + DVec2::new(7.0, 5.0);
        all.add(line(left, right, INK, 1.4))
            .add(line(left - tick, left + tick, INK, 1.4))
            .add(line(right - tick, right + tick, INK, 1.4))
            .add(text(words, Anchor::Start, 15.0, "50 mm"))
    }
}

/// The unit direction along the limb to where the pattern is highest: from the middle of its lowest
/// fifth to that of its highest.
fn up(input: &PageInput<'_>) -> DVec3 {
    let heights = || input.coordinates.iter().map(|p| p.y);
    let (low, high) =
        heights().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
    let fifth = 0.2 * (high - low);
    let middle = |keep: &dyn Fn(f64) -> bool| {
        let points: Vec<DVec3> =
            heights().zip(input.disk.points()).filter(|(y, _)| keep(*y)).map(|(_, &p)| p).collect();
        points.iter().sum::<DVec3>() / points.len().max(1) as f64
    };
    let along = middle(&|y| y >= high - fifth) - middle(&|y| y <= low + fifth);
    along.try_normalize().unwrap_or(DVec3::Z)
}

/// The unit direction out of the limb where the orientation markers are, across `up`.
fn front(input: &PageInput<'_>, normals: &[DVec3], up: DVec3) -> DVec3 {
    let nearest = |place: DVec2| {
        let order = |a: &usize, b: &usize| {
            let gap = |v: usize| input.coordinates[v].distance_squared(place);
            gap(*a).total_cmp(&gap(*b))
        };
        (0..input.coordinates.len()).min_by(order)
    };
    let [first, second] = input.drawing.markers;
    let out: DVec3 = [first, first.midpoint(second), second]
        .into_iter()
        .filter_map(|place| nearest(place).map(|v| normals[v]))
        .sum();
    out.reject_from(up).try_normalize().unwrap_or_else(|| up.any_orthonormal_vector())
}

/// The seams in space: their places in the pattern are those of boundary vertices.
fn seams(input: &PageInput<'_>) -> Vec<Vec<DVec3>> {
    let key = |p: DVec2| p.to_array().map(f64::to_bits);
    let disk = input.disk;
    let boundary = disk.boundary_loops().iter().flat_map(|l| disk.loop_vertices(l));
    let vertex: BTreeMap<[u64; 2], VertexId> =
        boundary.map(|v| (key(input.coordinates[v.index()]), v)).collect();
    let sides = input.drawing.seams.iter().flat_map(|seam| [&seam.left, &seam.right]);
    sides
        .map(|side| {
            side.iter().filter_map(|&p| vertex.get(&key(p))).map(|&v| disk.point(v)).collect()
        })
        .collect()
}

/// The parts of a line on the surface that a view shows.
fn visible_runs(view: &View, points: &[DVec3]) -> Vec<Vec<DVec3>> {
    let mut runs: Vec<Vec<DVec3>> = Vec::new();
    let mut going = false;
    for &p in points {
        if view.shows(p) {
            match runs.last_mut().filter(|_| going) {
                Some(run) => run.push(p),
                None => runs.push(vec![p]),
            }
            going = true;
        } else {
            going = false;
        }
    }
    runs
}
