//! Where a validated surface came from, element by element.

use super::index::{TriangleId, VertexId};
use super::topology::Surface;

/// The elements of a raw mesh from which those of a [`Surface`] came.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// For each vertex of the surface the raw point that it came from, the first of those that were
    /// welded. No vertex is new.
    pub source: Vec<usize>,
    /// For each raw point the vertex that it became; `None` if no kept face has it.
    pub vertices: Vec<Option<VertexId>>,
    /// For each triangle of the surface its raw face; `None` if it closes a hole.
    pub faces: Vec<Option<usize>>,
    /// Number of raw faces.
    pub face_count: usize,
}

/// The whole scan, smoothed if it was noisy, with what it came from.
///
/// Smoothing moves vertices and changes nothing else, so the origin stays true.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// The surface, in mm.
    pub surface: Surface,
    /// What in the raw mesh it came from.
    pub origin: Origin,
}

impl Scan {
    /// For each raw face the first triangle of the surface that it became, if any.
    #[must_use]
    pub fn triangle_of_face(&self) -> Vec<Option<TriangleId>> {
        let mut triangles = vec![None; self.origin.face_count];
        for (t, face) in self.origin.faces.iter().enumerate() {
            if let Some(face) = *face {
                triangles[face].get_or_insert(TriangleId::new(t));
            }
        }
        triangles
    }
}
