//! What a pattern reaches at an annotated point: strains along its threads and round it.
//!
//! Everything here is read from the pattern alone (pattern coordinates against places in space), so
//! that it holds for every way of fitting and can be recomputed from the written files.

use std::collections::{BTreeSet, VecDeque};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{Annotation, LocalCurvature, Stretch};
use crate::geometry::SurfacePoint;
use crate::surface::{HalfEdgeId, Surface, TriangleId};

/// How a triangle of the pattern is stretched when worn: the columns of F = d(space)/d(pattern).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleStretch {
    /// F e_x: where a unit of warp thread goes.
    pub warp: DVec3,
    /// F e_y: where a unit of weft thread goes.
    pub weft: DVec3,
    /// Area in the pattern, in mm²; negative for a flipped triangle.
    pub rest_area: f64,
}

/// The stretch of a triangle; `None` where it has no area in the pattern.
#[must_use]
pub fn triangle_stretch(
    disk: &Surface,
    coordinates: &[DVec2],
    t: TriangleId,
) -> Option<TriangleStretch> {
    let [p, q, r] = disk.corners(t);
    let [a, b, c] = disk.triangle(t).map(|v| coordinates[v.index()]);
    let (u, v) = (b - a, c - a);
    let area = u.perp_dot(v);
    (area != 0.0).then(|| TriangleStretch {
        warp: ((q - p) * v.y - (r - p) * u.y) / area,
        weft: ((r - p) * u.x - (q - p) * v.x) / area,
        rest_area: 0.5 * area,
    })
}

/// The fabric round a point: its threads' directions and its mean stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Patch {
    /// Direction of the warp thread in space (not of unit length).
    warp: DVec3,
    /// Direction of the weft thread.
    weft: DVec3,
    /// Mean strains and area stretch.
    stretch: Stretch,
}

/// Means over some triangles, weighted by their area in the pattern.
fn patch(disk: &Surface, coordinates: &[DVec2], triangles: &[TriangleId]) -> Option<Patch> {
    let (mut warp, mut weft) = (DVec3::ZERO, DVec3::ZERO);
    let (mut warp_length, mut weft_length, mut area, mut worn) = (0.0, 0.0, 0.0, 0.0);
    for &t in triangles {
        let Some(stretch) = triangle_stretch(disk, coordinates, t) else { continue };
        let w = stretch.rest_area.abs();
        warp += w * stretch.warp;
        weft += w * stretch.weft;
        warp_length += w * stretch.warp.length();
        weft_length += w * stretch.weft.length();
        area += w;
        worn += disk.area(t);
    }
    (area > 0.0).then(|| Patch {
        warp,
        weft,
        stretch: Stretch {
            warp: warp_length / area - 1.0,
            weft: weft_length / area - 1.0,
            area: worn / area,
        },
    })
}

/// The triangles within `radius` mm of a point and connected to it; at least the point's own.
fn triangles_within(disk: &Surface, point: &SurfacePoint, radius: f64) -> Vec<TriangleId> {
    let (start, centre) = (point.triangle, point.position(disk));
    let mut seen = BTreeSet::from([start]);
    let mut queue = VecDeque::from([start]);
    let mut found = Vec::new();
    while let Some(t) = queue.pop_front() {
        found.push(t);
        for k in 0..3 {
            let Some(twin) = disk.twin(HalfEdgeId::of(t, k)) else { continue };
            let next = twin.triangle();
            let [a, b, c] = disk.corners(next);
            if ((a + b + c) / 3.0).distance(centre) <= radius && seen.insert(next) {
                queue.push_back(next);
            }
        }
    }
    found.sort_unstable();
    found
}

/// Which way a thread runs in the pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Along {
    /// A row: constant y.
    Warp,
    /// A column: constant x.
    Weft,
}

impl Along {
    /// A place of the pattern as (along the thread, across it).
    fn turn(self, p: DVec2) -> DVec2 {
        match self {
            Self::Warp => p,
            Self::Weft => DVec2::new(p.y, p.x),
        }
    }
}

/// What a pattern gives at an annotated point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// Place in the pattern, in mm.
    pub place: DVec2,
    /// Curvature along the threads as they run.
    pub curvature: LocalCurvature,
    /// Strains of the whole threads through the point.
    pub threads: Stretch,
    /// Strains round the point.
    pub local: Stretch,
}

/// Reads at annotated points what patterns of one surface give there.
#[derive(Debug)]
pub struct Reader<'a> {
    disk: &'a Surface,
    annotations: &'a [Annotation],
    /// The triangles round each of them.
    round: Vec<Vec<TriangleId>>,
    gap: f64,
}

impl<'a> Reader<'a> {
    /// Strains round a point are means over `radius` mm.
    #[must_use]
    pub fn new(disk: &'a Surface, annotations: &'a [Annotation], radius: f64) -> Self {
        let round =
            annotations.par_iter().map(|a| triangles_within(disk, &a.point, radius)).collect();
        Self { disk, annotations, round, gap: gap(disk) }
    }

    /// What a pattern gives at every annotated point.
    #[must_use]
    pub fn read(&self, coordinates: &[DVec2]) -> Vec<Reached> {
        let Self { disk, annotations, .. } = *self;
        let places: Vec<DVec2> =
            annotations.iter().map(|a| a.point.interpolate(disk, coordinates)).collect();
        let [warp, weft] = thread_strains(disk, coordinates, &places, self.gap);
        annotations
            .iter()
            .zip(&self.round)
            .enumerate()
            .map(|(k, (annotation, triangles))| {
                let round = patch(disk, coordinates, triangles);
                let shape = &annotation.shape;
                let mean = shape.mean();
                let curvature =
                    round.map_or(LocalCurvature { warp: mean, weft: mean, mean }, |patch| {
                        LocalCurvature {
                            warp: shape.normal_curvature(patch.warp),
                            weft: shape.normal_curvature(patch.weft),
                            mean,
                        }
                    });
                let local = round.map_or(Stretch::without_shear(0.0, 0.0), |patch| patch.stretch);
                let threads = Stretch::without_shear(
                    warp[k].unwrap_or(local.warp),
                    weft[k].unwrap_or(local.weft),
                );
                Reached { place: places[k], curvature, threads, local }
            })
            .collect()
    }
}

/// A gap in a thread is an opening of the pattern; a hundredth of a typical edge is rounding.
fn gap(disk: &Surface) -> f64 {
    0.01 * disk.mean_edge_length()
}

/// A piece of a thread in one triangle: where along the thread it begins and ends, and its worn length.
type Part = (f64, f64, f64);

/// Strains of the warp and the weft threads through places of the pattern: of each its worn length over its
/// rest length, less one. By Lemma 3 a thread's tension, and so its strain, evens out to this along its
/// whole length.
///
/// A thread is the straight line of the pattern through its place, as far as the pattern goes on
/// both sides without a gap. `None` outside the pattern.
fn thread_strains(
    disk: &Surface,
    coordinates: &[DVec2],
    places: &[DVec2],
    gap: f64,
) -> [Vec<Option<f64>>; 2] {
    /// Below this many triangles a task costs more than it saves.
    const TRIANGLES_PER_TASK: usize = 2048;
    let lines = [Along::Warp, Along::Weft].map(|along| {
        let mut lines: Vec<(f64, usize)> =
            places.iter().enumerate().map(|(k, &p)| (along.turn(p).y, k)).collect();
        lines.sort_by(|a, b| a.0.total_cmp(&b.0));
        lines
    });
    let found: Vec<[Vec<(usize, Part)>; 2]> = disk
        .triangles()
        .par_chunks(TRIANGLES_PER_TASK)
        .map(|triangles| {
            let mut found = [Vec::new(), Vec::new()];
            for corners in triangles {
                let plane = corners.map(|v| coordinates[v.index()]);
                for (along, (lines, found)) in
                    [Along::Warp, Along::Weft].into_iter().zip(lines.iter().zip(&mut found))
                {
                    let plane = plane.map(|p| along.turn(p));
                    let low = plane[0].y.min(plane[1].y).min(plane[2].y);
                    let high = plane[0].y.max(plane[1].y).max(plane[2].y);
                    let first = lines.partition_point(|&(h, _)| h < low);
                    for &(h, k) in lines[first..].iter().take_while(|&&(h, _)| h <= high) {
                        let worn = corners.map(|v| disk.point(v));
                        found.extend(crossing(plane, worn, h).map(|part| (k, part)));
                    }
                }
            }
            found
        })
        .collect();
    let mut parts = [vec![Vec::new(); places.len()], vec![Vec::new(); places.len()]];
    for found in found {
        for (parts, found) in parts.iter_mut().zip(found) {
            found.into_iter().for_each(|(k, part)| parts[k].push(part));
        }
    }
    let mut parts = parts.into_iter();
    [Along::Warp, Along::Weft].map(|along| {
        let parts = parts.next().unwrap_or_default();
        let threads = parts.into_iter().zip(places);
        threads.map(|(parts, &place)| one_thread(parts, along.turn(place).x, gap)).collect()
    })
}

/// Where the line at height `h` crosses a triangle.
fn crossing(plane: [DVec2; 3], worn: [DVec3; 3], h: f64) -> Option<Part> {
    let mut ends = [(0.0, DVec3::ZERO); 2];
    let mut count = 0;
    for i in 0..3 {
        let (a, b) = (plane[i], plane[(i + 1) % 3]);
        // Half-open, so that a line through a vertex crosses each triangle twice or not at all.
        if (a.y < h) != (b.y < h) && count < 2 {
            let f = (a.y - h) / (a.y - b.y);
            ends[count] = (a.x + f * (b.x - a.x), worn[i].lerp(worn[(i + 1) % 3], f));
            count += 1;
        }
    }
    let [(s0, p0), (s1, p1)] = ends;
    (count == 2).then(|| (s0.min(s1), s0.max(s1), p0.distance(p1)))
}

/// Strain of the run of pieces (from, to, worn length) that holds `at`.
fn one_thread(mut pieces: Vec<Part>, at: f64, tolerance: f64) -> Option<f64> {
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let (mut rest, mut worn) = (0.0, 0.0);
    let mut reach = f64::NEG_INFINITY;
    let mut holds_place = false;
    for (low, high, length) in pieces {
        if low > reach + tolerance {
            if holds_place {
                break;
            }
            (rest, worn) = (0.0, 0.0);
        }
        holds_place |= low <= at + tolerance && high >= at - tolerance;
        rest += high - low;
        worn += length;
        reach = reach.max(high);
    }
    // A line that only touches the pattern's edge has no strain but rounding's.
    (holds_place && rest > tolerance).then(|| worn / rest - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::VertexId;

    /// Three strips side by side along x, stretched 10 %, 20 % and 60 % along warp, 5 % along weft,
    /// of rest widths 10, 20 and 30 mm.
    fn strips() -> (Surface, Vec<DVec2>) {
        let rest = [0.0, 10.0, 30.0, 60.0];
        let worn = [0.0, 11.0, 35.0, 83.0];
        let mut points = Vec::new();
        let mut plane = Vec::new();
        for y in [0.0, 20.0, 40.0] {
            for k in 0..4 {
                points.push(DVec3::new(worn[k], 1.05 * y, 0.0));
                plane.push(DVec2::new(rest[k], y));
            }
        }
        let id = |i: usize, j: usize| VertexId::new(4 * i + j);
        let mut triangles = Vec::new();
        for i in 0..2 {
            for j in 0..3 {
                triangles.push([id(i, j), id(i, j + 1), id(i + 1, j + 1)]);
                triangles.push([id(i, j), id(i + 1, j + 1), id(i + 1, j)]);
            }
        }
        (Surface::new(points, triangles).unwrap(), plane)
    }

    #[test]
    fn a_threads_strain_is_its_whole_lengthening() {
        let (disk, plane) = strips();
        let strains = |places: &[DVec2]| thread_strains(&disk, &plane, places, gap(&disk));
        let strain = |place, along| strains(&[place])[along as usize][0];
        for y in [7.0, 20.0, 33.0] {
            let strain = strain(DVec2::new(5.0, y), Along::Warp).unwrap();
            assert!((strain - 23.0 / 60.0).abs() < 1e-12, "{y}: {strain}");
        }
        assert!((strain(DVec2::new(5.0, 7.0), Along::Weft).unwrap() - 0.05).abs() < 1e-12);
        assert_eq!(strain(DVec2::new(70.0, 7.0), Along::Warp), None);
        // Several at once, in any order.
        let places = [20.0, 70.0, 3.0].map(|x| DVec2::new(x, 0.5 * x));
        let [together, _] = strains(&places);
        assert_eq!(together, places.map(|p| strain(p, Along::Warp)));
    }

    #[test]
    fn a_line_that_touches_the_edge_in_a_corner_is_no_thread() {
        let (disk, mut plane) = strips();
        // The corner in the middle of the left edge stands out by less than any scan is exact.
        for out in [1e-3, 1e-9, 1e-15] {
            plane[4].x = -out;
            let [warp, weft] = thread_strains(&disk, &plane, &[plane[4]], gap(&disk));
            assert_eq!(weft, [None], "{out} mm");
            assert!((warp[0].unwrap() - 23.0 / 60.0).abs() < 1e-4, "{out} mm: {warp:?}");
        }
        plane[4].x = -1.0;
        let [_, weft] = thread_strains(&disk, &plane, &[DVec2::new(-0.5, 20.0)], gap(&disk));
        assert!(weft[0].is_some());
    }

    #[test]
    fn a_patch_takes_the_means_of_its_triangles() {
        let (disk, plane) = strips();
        let point =
            SurfacePoint { triangle: TriangleId::new(0), barycentric: DVec3::splat(1.0 / 3.0) };
        let near = patch(&disk, &plane, &triangles_within(&disk, &point, 0.0)).unwrap();
        assert!((near.stretch.warp - 0.1).abs() < 1e-12);
        assert!((near.stretch.weft - 0.05).abs() < 1e-12);
        assert!((near.stretch.area - 1.1 * 1.05).abs() < 1e-12);
        let far = patch(&disk, &plane, &triangles_within(&disk, &point, 1000.0)).unwrap();
        assert!((far.stretch.warp - 23.0 / 60.0).abs() < 1e-12);
        assert!(far.warp.normalize().distance(DVec3::X) < 1e-12);
    }
}
