//! Results on the mesh that was given: pattern coordinates per corner, values per vertex.

use glam::{DMat2, DVec2, DVec3};
use rayon::prelude::*;

use super::Transfer;
use crate::geometry::{Locator, SurfacePoint};
use crate::surface::{HalfEdgeId, Surface, TriangleId, VertexId};

/// A vertex is covered if the brace is nearer than this part of the mean edge there: the surface
/// gives way by less beside a cut.
const AT_VERTEX: f64 = 0.05;

/// A triangle is covered if the brace is nearer to its middle than this part of its least height; a
/// triangle beside the brace is a third of it away.
const AT_MIDDLE: f64 = 1.0 / 6.0;

impl Transfer<'_> {
    /// The pattern coordinates (mm) of the corners of every face given; `None` where the brace does
    /// not cover the face's middle, and for faces of more corners.
    ///
    /// A face through which the edge or a seam of the brace runs belongs to the side on which its
    /// middle lies; its corners beyond are where the map there, gone on linearly, would have them.
    #[must_use]
    pub fn corners(&self) -> Vec<Option<[DVec2; 3]>> {
        let triangle_of = self.scan().triangle_of_face();
        let disk = self.flattening.disk();
        let on = Laid {
            locator: Locator::new(disk),
            disk,
            coordinates: &self.flattening.coordinates,
            over: self.over(),
            transfer: self,
        };
        triangle_of
            .into_par_iter()
            .enumerate()
            .map(|(face, triangle)| {
                let triangle = triangle?;
                let corners = self.corners_in(face, triangle)?;
                let laid = on.lay(triangle)?;
                Some(corners.map(|k| laid[k]))
            })
            .collect()
    }

    /// Values of the cut surface's vertices carried to the vertices given; NaN where the brace does
    /// not cover them.
    ///
    /// # Panics
    /// If there are not as many values as the cut surface has vertices.
    #[must_use]
    pub fn to_vertices(&self, values: &[f64]) -> Vec<f64> {
        let (scan, disk) = (&self.scan().surface, self.flattening.disk());
        assert_eq!(values.len(), disk.vertex_count());
        let mut copy: Vec<Option<VertexId>> = vec![None; scan.vertex_count()];
        for v in disk.vertex_ids() {
            if let Some(same) = self.vertex[v.index()] {
                copy[same.index()].get_or_insert(v);
            }
        }
        let locator = Locator::new(disk);
        let at = |v: VertexId| -> f64 {
            if let Some(own) = copy[v.index()] {
                return values[own.index()];
            }
            let (mut length, mut count) = (0.0, 0.0);
            for w in scan.neighbours(v) {
                length += scan.point(v).distance(scan.point(w));
                count += 1.0;
            }
            match locator.closest(scan.point(v)) {
                Some((place, far)) if far <= AT_VERTEX * length / count => {
                    let corners = disk.triangle(place.triangle).map(|w| values[w.index()]);
                    DVec3::from_array(corners).dot(place.barycentric)
                }
                _ => f64::NAN,
            }
        };
        let on_scan: Vec<f64> =
            scan.vertex_ids().collect::<Vec<_>>().into_par_iter().map(at).collect();
        let origin = &self.scan().origin;
        origin
            .vertices
            .iter()
            .map(|vertex| vertex.map_or(f64::NAN, |vertex| on_scan[vertex.index()]))
            .collect()
    }

    /// The cut triangles over each triangle of the scan.
    fn over(&self) -> Over {
        let mut pairs: Vec<(TriangleId, TriangleId)> =
            self.under.iter().enumerate().map(|(d, &t)| (t, TriangleId::new(d))).collect();
        pairs.par_sort_unstable();
        Over(pairs)
    }
}

/// Cut triangles by the triangle of the scan under them.
struct Over(Vec<(TriangleId, TriangleId)>);

impl Over {
    fn of(&self, t: TriangleId) -> impl Iterator<Item = TriangleId> + '_ {
        let first = self.0.partition_point(|&(under, _)| under < t);
        self.0[first..].iter().take_while(move |&&(under, _)| under == t).map(|&(_, over)| over)
    }
}

/// The disk laid flat, asked by triangles of the scan.
struct Laid<'a> {
    locator: Locator,
    disk: &'a Surface,
    coordinates: &'a [DVec2],
    over: Over,
    transfer: &'a Transfer<'a>,
}

impl Laid<'_> {
    /// Pattern coordinates of the corners of a triangle of the scan, if it is covered.
    fn lay(&self, t: TriangleId) -> Option<[DVec2; 3]> {
        let scan = &self.transfer.scan().surface;
        let corners = scan.triangle(t);
        // Nearly all triangles are as they were.
        let mut over = self.over.of(t);
        if let (Some(d), None) = (over.next(), over.next())
            && let [Some(a), Some(b), Some(c)] = corners.map(|v| self.corner(&[d], v))
        {
            return Some([a, b, c]);
        }
        let p = scan.corners(t);
        let longest = (0..3).map(|k| p[k].distance(p[(k + 1) % 3])).fold(0.0, f64::max);
        let height = scan.area_vector(t).length() / longest;
        let (at, far) = self.locator.closest(p.iter().sum::<DVec3>() / 3.0)?;
        if far > AT_MIDDLE * height {
            return None;
        }
        let pieces = self.pieces(at.triangle, t);
        let map = Affine::fit(self, &pieces, p).or_else(|| {
            // A sliver alone gives no map.
            let wider: Vec<TriangleId> = pieces.iter().flat_map(|&d| self.beside(d)).collect();
            Affine::fit(self, &wider, p)
        })?;
        let mut result = [DVec2::ZERO; 3];
        for k in 0..3 {
            result[k] = self.corner(&pieces, corners[k]).unwrap_or_else(|| {
                let beyond = map.at(p[k]);
                // What the brace covers there is one place for all triangles that meet in it; the
                // other side of a seam lies elsewhere in the pattern.
                match self.locator.closest(p[k]) {
                    Some((at, far)) if far <= AT_VERTEX * longest => {
                        let own = self.flat(&at);
                        if own.distance(beyond) <= 0.5 * longest { own } else { beyond }
                    }
                    _ => beyond,
                }
            });
        }
        Some(result)
    }

    fn flat(&self, at: &SurfacePoint) -> DVec2 {
        at.interpolate(self.disk, self.coordinates)
    }

    /// The coordinates of a vertex of the scan as a corner of one of these cut triangles.
    fn corner(&self, pieces: &[TriangleId], v: VertexId) -> Option<DVec2> {
        let mut corners = pieces.iter().flat_map(|&d| self.disk.triangle(d));
        corners
            .find(|w| self.transfer.vertex[w.index()] == Some(v))
            .map(|w| self.coordinates[w.index()])
    }

    /// The cut triangles over `t` that hang together with `first`.
    fn pieces(&self, first: TriangleId, t: TriangleId) -> Vec<TriangleId> {
        let all: Vec<TriangleId> = self.over.of(t).collect();
        let mut pieces = vec![first];
        let mut next = 0;
        while next < pieces.len() {
            for d in self.beside(pieces[next]) {
                if all.contains(&d) && !pieces.contains(&d) {
                    pieces.push(d);
                }
            }
            next += 1;
        }
        pieces
    }

    /// A cut triangle and those that share an edge with it.
    fn beside(&self, d: TriangleId) -> Vec<TriangleId> {
        let twin = |k| self.disk.twin(HalfEdgeId::of(d, k)).map(HalfEdgeId::triangle);
        std::iter::once(d).chain((0..3).filter_map(twin)).collect()
    }
}

/// The linear map from a triangle's plane into the pattern that fits some cut triangles best.
struct Affine {
    origin: DVec3,
    axes: [DVec3; 2],
    from: DVec2,
    to: DVec2,
    slope: DMat2,
}

impl Affine {
    /// Least squares over the corners of `pieces`, by area; `None` if they lie on a line.
    fn fit(laid: &Laid<'_>, pieces: &[TriangleId], [a, b, c]: [DVec3; 3]) -> Option<Self> {
        let u = (b - a).try_normalize()?;
        let v = (b - a).cross(c - a).cross(u).try_normalize()?;
        let axes = [u, v];
        let down = |p: DVec3| DVec2::new((p - a).dot(u), (p - a).dot(v));
        let mut samples: Vec<(f64, DVec2, DVec2)> = Vec::new();
        for &d in pieces {
            let area = laid.disk.area(d);
            for w in laid.disk.triangle(d) {
                samples.push((area, down(laid.disk.point(w)), laid.coordinates[w.index()]));
            }
        }
        let weight: f64 = samples.iter().map(|s| s.0).sum();
        let from = samples.iter().map(|s| s.0 * s.1).sum::<DVec2>() / weight;
        let to = samples.iter().map(|s| s.0 * s.2).sum::<DVec2>() / weight;
        let (mut spread, mut cross) = (DMat2::ZERO, DMat2::ZERO);
        for (w, p, q) in samples {
            let (p, q) = (p - from, q - to);
            spread += w * DMat2::from_cols(p.x * p, p.y * p);
            cross += w * DMat2::from_cols(p.x * q, p.y * q);
        }
        let trace = spread.x_axis.x + spread.y_axis.y;
        // Flatter than 1 to 100: what lies across is rounding, not shape.
        let known = spread.determinant() > 1e-4 * trace * trace;
        known.then(|| Self { origin: a, axes, from, to, slope: cross * spread.inverse() })
    }

    fn at(&self, p: DVec3) -> DVec2 {
        let [u, v] = self.axes;
        let flat = DVec2::new((p - self.origin).dot(u), (p - self.origin).dot(v));
        self.to + self.slope * (flat - self.from)
    }
}
