//! From the cut surface back to the mesh that was given: hosts want results on their own mesh.
//!
//! Smoothing moves vertices; region and cut move, split and flip what lies beside their curves. So
//! the way back is found by place: the middle of every cut triangle lies inside one triangle of the
//! scan, and a cut vertex at the very place of a scan vertex is that vertex. Where several are at
//! one place (a limb that came slit) its triangles tell which. The mesh given must be of triangles.
//!
//! Limit: beside a cut the flipped diagonals of nearly flat triangles make the way back true to the
//! bend of these triangles, hundredths of a millimetre, not exact.

mod given;

use glam::DVec3;
use rayon::prelude::*;

use crate::geometry::{Locator, closest_on_triangle};
use crate::pipeline::Flattening;
use crate::surface::{HalfEdgeId, RawMesh, Scan, Surface, TriangleId, VertexId};

/// A vertex of the cut surface on the mesh that was given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnGiven {
    /// The vertex that it is, the first of those that were welded; `None` if the cut made it.
    pub vertex: Option<usize>,
    /// A face in which it lies; `None` on what closes a hole.
    pub face: Option<usize>,
    /// Weights of that face's corners, in its own order; they sum to 1. Zero without a face.
    pub weights: [f64; 3],
}

/// The way between the cut surface of a result and the mesh from which it was made.
pub struct Transfer<'a> {
    flattening: &'a Flattening,
    raw: &'a RawMesh,
    /// The scan's triangle under each cut triangle.
    under: Vec<TriangleId>,
    /// The scan's vertex that each cut vertex is.
    vertex: Vec<Option<VertexId>>,
}

impl<'a> Transfer<'a> {
    /// Finds the way; `raw` is the mesh that the result was made from.
    #[must_use]
    pub fn new(flattening: &'a Flattening, raw: &'a RawMesh) -> Self {
        let (scan, disk) = (&flattening.scan.surface, flattening.disk());
        let locator = Locator::new(scan);
        let under: Vec<TriangleId> = disk
            .triangles()
            .par_iter()
            .enumerate()
            .map(|(t, _)| {
                let middle = disk.corners(TriangleId::new(t)).iter().sum::<DVec3>() / 3.0;
                locator.closest(middle).map_or(TriangleId::new(0), |(at, _)| at.triangle)
            })
            .collect();
        let vertex = same_vertices(scan, disk, &under);
        Self { flattening, raw, under, vertex }
    }

    fn scan(&self) -> &'a Scan {
        &self.flattening.scan
    }

    /// Every vertex of the cut surface.
    #[must_use]
    pub fn vertices(&self) -> Vec<OnGiven> {
        let locator = Locator::new(&self.scan().surface);
        self.flattening
            .disk()
            .vertex_ids()
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|v| self.on_given(v, &locator))
            .collect()
    }

    /// The face under every triangle of the cut surface; `None` on what closes a hole.
    #[must_use]
    pub fn triangles(&self) -> Vec<Option<usize>> {
        self.under.iter().map(|t| self.scan().origin.faces[t.index()]).collect()
    }

    fn on_given(&self, v: VertexId, locator: &Locator) -> OnGiven {
        let (scan, disk) = (&self.scan().surface, self.flattening.disk());
        let origin = &self.scan().origin;
        let around = || disk.outgoing(v).map(|h| self.under[h.triangle().index()]);
        let (triangle, weights) = if let Some(same) = self.vertex[v.index()] {
            let own = |t: &TriangleId| {
                scan.triangle(*t).contains(&same) && origin.faces[t.index()].is_some()
            };
            let all = || scan.outgoing(same).map(HalfEdgeId::triangle);
            let triangle = around().find(own).or_else(|| all().find(own)).or_else(|| all().next());
            let triangle = triangle.unwrap_or(TriangleId::new(0));
            let corner = scan.triangle(triangle).map(|w| f64::from(u8::from(w == same)));
            (triangle, DVec3::from_array(corner))
        } else {
            self.beside(v, around(), locator)
        };
        let face = origin.faces[triangle.index()];
        let weights = face.and_then(|face| self.in_face(face, triangle, weights));
        OnGiven {
            vertex: self.vertex[v.index()].map(|same| origin.source[same.index()]),
            face: face.filter(|_| weights.is_some()),
            weights: weights.unwrap_or_default(),
        }
    }

    /// A new vertex in the triangle of the scan that is nearest to it, of several equally near in one
    /// that lies under its own triangles.
    fn beside(
        &self,
        v: VertexId,
        around: impl Iterator<Item = TriangleId>,
        locator: &Locator,
    ) -> (TriangleId, DVec3) {
        /// Rounding of coordinates in mm.
        const EQUALLY_NEAR: f64 = 1e-9;
        let (scan, place) = (&self.scan().surface, self.flattening.disk().point(v));
        let gap = |t: TriangleId| {
            let [a, b, c] = scan.corners(t);
            let w = closest_on_triangle(place, [a, b, c]);
            (place.distance(w.x * a + w.y * b + w.z * c), t, w)
        };
        let near = around.map(gap).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let nearest = locator.closest(place);
        match (near, nearest) {
            (Some((far, t, w)), Some((_, least))) if far <= least + EQUALLY_NEAR => (t, w),
            (_, Some((at, _))) => (at.triangle, at.barycentric),
            _ => (TriangleId::new(0), DVec3::X),
        }
    }

    /// Weights of a triangle's corners as those of the face that it came from.
    fn in_face(&self, face: usize, triangle: TriangleId, weights: DVec3) -> Option<[f64; 3]> {
        let corners = self.corners_in(face, triangle)?;
        // Rounding leaves −1e−17 on an edge.
        Some(corners.map(|k| weights[k].max(0.0)))
    }

    /// For each corner of a face the corner of the triangle that it became.
    fn corners_in(&self, face: usize, triangle: TriangleId) -> Option<[usize; 3]> {
        let Scan { surface, origin } = self.scan();
        let &[a, b, c] = self.raw.polygons.get(face)?.as_slice() else { return None };
        let own = surface.triangle(triangle);
        let corner = |p: usize| {
            let vertex = (*origin.vertices.get(p)?)?;
            own.iter().position(|&w| w == vertex)
        };
        Some([corner(a)?, corner(b)?, corner(c)?])
    }
}

/// The scan's vertex at the very place of each cut vertex.
fn same_vertices(scan: &Surface, disk: &Surface, under: &[TriangleId]) -> Vec<Option<VertexId>> {
    let key = |p: DVec3| p.to_array().map(|x| (x + 0.0).to_bits());
    let mut places: Vec<([u64; 3], VertexId)> =
        scan.vertex_ids().map(|v| (key(scan.point(v)), v)).collect();
    places.par_sort_unstable();
    disk.vertex_ids()
        .map(|v| {
            let wanted = key(disk.point(v));
            let first = places.partition_point(|(place, _)| *place < wanted);
            let at = places[first..].iter().take_while(|(place, _)| *place == wanted);
            let all: Vec<VertexId> = at.map(|&(_, v)| v).collect();
            let touched = |w: &&VertexId| {
                disk.outgoing(v).any(|h| scan.triangle(under[h.triangle().index()]).contains(w))
            };
            match all.as_slice() {
                [] => None,
                [one] => Some(*one),
                several => several.iter().find(touched).or(several.first()).copied(),
            }
        })
        .collect()
}
