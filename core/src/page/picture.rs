//! Colours for what a raster shows, as a PNG inside the page.
//!
//! An indexed image: every band of values in `SHADES` steps of light, lines between bands,
//! hatching for what has no place on the scale. Limit: 8 bits index 256 colours, which bounds bands
//! times shades.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;

use super::raster::{Raster, Seen};
use super::scale::{Bands, Class, Rgb, luminance};
use crate::surface::Surface;

/// Steps of light: 2 % each over the range used, finer than an eye tells on a printed page.
const SHADES: usize = 16;
/// Share of light that a face turned away from it still has: little, so that bands keep their grey.
const LEAST_LIGHT: f64 = 0.7;
/// How hard a picture is compressed, of 9: a page is a tenth larger than by the usual 6, in half the time.
const EFFORT: u8 = 3;
/// Ground of what is negative.
pub(super) const NEGATIVE: Rgb = [238, 238, 238];
/// What has no value.
pub(super) const UNKNOWN: Rgb = [190, 190, 190];
/// The inside of the limb, seen through its ends.
pub(super) const INSIDE: Rgb = [222, 218, 212];
/// Lines on light ground.
const DARK: Rgb = [30, 30, 30];
/// Lines on dark ground, and the hatching above the limit.
const LIGHT: Rgb = [255, 255, 255];

/// Values by vertex, and how they are shown.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field<'a> {
    /// By vertex, in the unit of the bands.
    pub(super) values: &'a [f64],
    /// How values are shown.
    pub(super) bands: Bands,
    /// Value above which the picture is hatched.
    pub(super) limit: Option<f64>,
}

/// How bright each pixel of a raster is, in steps below [`SHADES`].
pub(super) struct Shades(Vec<u8>);

impl Shades {
    /// A body with these unit normals by vertex, lit from a unit direction.
    pub(super) fn new(surface: &Surface, raster: &Raster, normals: &[DVec3], from: DVec3) -> Self {
        let facing: Vec<f64> = normals.iter().map(|normal| normal.dot(from)).collect();
        let shade = |seen: Seen| {
            let facing = mean(surface, &seen, &facing);
            let lit = if seen.outside { facing } else { -facing };
            (lit.clamp(0.0, 1.0) * (SHADES - 1) as f64 + 0.5) as u8
        };
        Self((0..raster.width * raster.height).map(|at| raster.seen(at).map_or(0, shade)).collect())
    }
}

/// A field on what a raster shows, as the address of an image that is in the address itself.
/// `pixel` is the size of a pixel in mm. Without `shades` it is a flat picture without edges.
pub(super) fn data_address(
    surface: &Surface,
    raster: &Raster,
    field: &Field<'_>,
    shades: Option<&Shades>,
    pixel: f64,
) -> String {
    let indices = paint(surface, raster, field, shades, pixel);
    let bytes = png(raster.width, raster.height, &indices, &palette(&field.bands));
    format!("data:image/png;base64,{}", STANDARD.encode(bytes))
}

/// Where a kind of pixel begins in the palette.
#[derive(Debug, Clone, Copy)]
struct Palette {
    bands: usize,
}

impl Palette {
    fn index(self, class: usize, shade: usize) -> u8 {
        (class * SHADES + shade) as u8
    }

    fn negative(self) -> usize {
        self.bands
    }

    fn unknown(self) -> usize {
        self.bands + 1
    }

    fn inside(self) -> usize {
        self.bands + 2
    }

    fn dark(self) -> u8 {
        ((self.bands + 3) * SHADES) as u8
    }

    fn light(self) -> u8 {
        self.dark() + 1
    }

    fn nothing(self) -> u8 {
        self.dark() + 2
    }
}

/// The colours by index; the last is transparent.
fn palette(bands: &Bands) -> Vec<Rgb> {
    let grounds = (0..bands.count).map(|k| bands.colour(k)).chain([NEGATIVE, UNKNOWN, INSIDE]);
    let mut colours: Vec<Rgb> = grounds
        .flat_map(|ground| {
            (0..SHADES).map(move |shade| {
                let part = shade as f64 / (SHADES - 1) as f64;
                let share = LEAST_LIGHT + (1.0 - LEAST_LIGHT) * part;
                ground.map(|c| (f64::from(c) * share).round() as u8)
            })
        })
        .collect();
    colours.extend([DARK, LIGHT, LIGHT]);
    colours
}

/// The class of a pixel in which there is nothing.
const NO_CLASS: u8 = u8::MAX;

fn paint(
    surface: &Surface,
    raster: &Raster,
    field: &Field<'_>,
    shades: Option<&Shades>,
    pixel: f64,
) -> Vec<u8> {
    let palette = Palette { bands: field.bands.count };
    let (width, height) = (raster.width, raster.height);
    let count = width * height;
    // Class of each pixel, to find the lines between them.
    let mut classes = vec![NO_CLASS; count];
    let mut indices = vec![palette.nothing(); count];
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let at = y * width + x;
        let Some(seen) = raster.seen(at) else { continue };
        let value = mean(surface, &seen, field.values);
        let class = if !seen.outside {
            palette.inside()
        } else {
            match field.bands.class(value) {
                Class::Band(band) => band,
                Class::Negative => palette.negative(),
                Class::Unknown => palette.unknown(),
            }
        };
        // Classes times shades are less than 256.
        classes[at] = class as u8;
        let shade = shades.map_or(SHADES - 1, |shades| usize::from(shades.0[at]));
        let over = seen.outside && field.limit.is_some_and(|limit| value > limit);
        indices[at] = if over && (x + y) % 12 < 4 {
            palette.light()
        } else if class == palette.negative() && (x + height - y) % 12 < 2 {
            palette.dark()
        } else {
            palette.index(class, shade)
        };
    }
    let lines: Vec<u8> = (0..palette.bands + 3)
        .flat_map(|a| (0..palette.bands + 3).map(move |b| (a, b)))
        .map(|(a, b)| line_between(&field.bands, palette, a, b))
        .collect();
    // A line is two pixels wide: the last of one band and the first of the next.
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let at = y * width + x;
        let right = (x + 1 < width).then_some(at + 1);
        let below = (y + 1 < height).then_some(at + width);
        for next in [right, below].into_iter().flatten() {
            let (a, b) = (classes[at], classes[next]);
            let line = match (a == NO_CLASS, b == NO_CLASS) {
                (false, false) => {
                    // A farther part of the body behind a nearer one has an edge of its own.
                    let apart = || f64::abs(raster.depth(at) - raster.depth(next)) > 6.0 * pixel;
                    if shades.is_some() && apart() {
                        palette.dark()
                    } else if a != b {
                        lines[usize::from(a) * (palette.bands + 3) + usize::from(b)]
                    } else {
                        continue;
                    }
                }
                (true, true) => continue,
                _ if shades.is_some() => palette.dark(),
                _ => continue,
            };
            for pixel in [at, next] {
                if classes[pixel] != NO_CLASS {
                    indices[pixel] = line;
                }
            }
        }
    }
    indices
}

/// The line between two kinds of pixels: light where both are dark.
fn line_between(bands: &Bands, palette: Palette, a: usize, b: usize) -> u8 {
    let ground = |class: usize| {
        if class < bands.count { luminance(bands.colour(class)) } else { 1.0 }
    };
    if ground(a).max(ground(b)) < 0.18 { palette.light() } else { palette.dark() }
}

fn mean(surface: &Surface, seen: &Seen, values: &[f64]) -> f64 {
    let corners = surface.triangle(seen.triangle);
    (0..3).map(|k| seen.weights[k] * values[corners[k].index()]).sum()
}

/// An indexed PNG whose last colour is transparent.
fn png(width: usize, height: usize, indices: &[u8], palette: &[Rgb]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.concat());
    let mut opacity = vec![255; palette.len() - 1];
    opacity.push(0);
    encoder.set_trns(opacity);
    encoder.set_deflate_compression(png::DeflateCompression::Level(EFFORT));
    // Indices are no amounts: neighbours that differ by one are as different as any.
    encoder.set_filter(png::Filter::NoFilter);
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(indices))
        .expect("a vector takes all bytes, and size and palette fit the indices");
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::raster::Camera;
    use crate::page::scale::Scale;
    use crate::surface::VertexId;

    /// A square of 20 mm whose value rises from −10 on the left to 30 on the right.
    fn ramp() -> (Surface, Vec<f64>) {
        let points = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)]
            .map(|(x, y)| DVec3::new(x, y, 0.0))
            .to_vec();
        let id = VertexId::new;
        let triangles = vec![[id(0), id(1), id(2)], [id(0), id(2), id(3)]];
        (Surface::new(points, triangles).unwrap(), vec![-10.0, 30.0, 30.0, -10.0])
    }

    fn camera() -> Camera {
        Camera {
            right: DVec3::X,
            up: DVec3::Y,
            viewer: DVec3::Z,
            centre: DVec3::new(10.0, 10.0, 0.0),
            scale: 10.0,
            size: [220, 220],
        }
    }

    fn picture(limit: Option<f64>) -> (Vec<u8>, Bands) {
        let (surface, values) = ramp();
        let bands = Bands { scale: Scale::Cividis, low: 0.0, step: 10.0, count: 3, floor: 0.0 };
        let raster = Raster::new(&surface, surface.points(), &camera());
        let field = Field { values: &values, bands, limit };
        (paint(&surface, &raster, &field, None, 0.1), bands)
    }

    #[test]
    fn bands_stand_where_their_values_are_with_lines_between() {
        let (indices, bands) = picture(None);
        let palette = Palette { bands: bands.count };
        let row = |x: usize| indices[110 * 220 + x];
        assert_eq!(row(3), palette.nothing());
        // The value is 2 per mm from −10, and the square begins at pixel 10: zero at pixel 60.
        assert_eq!(row(59), palette.dark());
        assert_eq!(row(60), palette.dark());
        assert_eq!(row(80), palette.index(0, SHADES - 1));
        assert_eq!(row(130), palette.index(1, SHADES - 1));
        assert_eq!(row(190), palette.index(2, SHADES - 1));
        // Below zero: ground and hatching.
        let negative: Vec<u8> = (12..58).map(row).collect();
        assert!(negative.contains(&palette.dark()));
        assert!(negative.contains(&palette.index(palette.negative(), SHADES - 1)));
    }

    #[test]
    fn above_the_limit_it_is_hatched() {
        let (indices, bands) = picture(Some(25.0));
        let palette = Palette { bands: bands.count };
        let hatched: Vec<usize> =
            (0..220).filter(|x| indices[110 * 220 + x] == palette.light()).collect();
        // 25 is at 17.5 mm, which is pixel 185.
        assert!(!hatched.is_empty() && hatched.iter().all(|&x| x >= 185), "{hatched:?}");
    }

    #[test]
    fn the_png_reads_back_with_its_colours() {
        let (indices, bands) = picture(None);
        let bytes = png(220, 220, &indices, &palette(&bands));
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let pixel = |x: usize, y: usize| &pixels[4 * (220 * y + x)..4 * (220 * y + x) + 4];
        assert_eq!(pixel(2, 2)[3], 0);
        let wanted = bands.colour(2);
        assert_eq!(pixel(190, 110), [wanted[0], wanted[1], wanted[2], 255]);
    }

    #[test]
    fn the_most_bands_fit_one_byte() {
        let bands = Bands { scale: Scale::Magma, low: 0.0, step: 1.0, count: 11, floor: 0.0 };
        assert!(palette(&bands).len() <= 256);
        assert_eq!(usize::from(Palette { bands: 11 }.nothing()) + 1, palette(&bands).len());
    }
}
