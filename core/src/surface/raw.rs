//! Triangles as a file or a host gives them, before anything is known about them.

use glam::DVec3;

/// Points and polygons as read, in the file's own unit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RawMesh {
    /// The points.
    pub points: Vec<DVec3>,
    /// The corners of each polygon as indices into `points`; three or more, not checked.
    pub polygons: Vec<Vec<usize>>,
}

impl RawMesh {
    /// A mesh of triangles.
    #[must_use]
    pub fn from_triangles(points: Vec<DVec3>, triangles: &[[usize; 3]]) -> Self {
        Self { points, polygons: triangles.iter().map(|t| t.to_vec()).collect() }
    }
}
