//! A raw mesh becomes a [`Surface`], or every defect it has is named.
//!
//! What can be mended without guessing is mended and said as a warning; the rest is an error with
//! its place. The warnings' codes: `unused_vertices`, `welded`, `collapsed_dropped`,
//! `components_dropped`, `orientation_repaired`, `reversed`, `facing_unlikely`, `cut_kept`,
//! `hole_closed`, `hole_kept`, `opening_kept`.
//!
//! Limit: triangles that pass through one another are not looked for.

use glam::DVec3;

use super::connectivity::{Edges, end, start};
use super::defect::{Defect, SurfaceError};
use super::index::VertexId;
use super::mesh::{Mesh, mean};
use super::origin::Origin;
use super::raw::RawMesh;
use super::rounding::{GRID, in_mm};
use super::topology::Surface;
use super::{holes, orientation, weld};
use crate::design::Facing;
use crate::units::LengthUnit;
use crate::warning::Warning;

/// A coordinate beyond this many mm (a thousand kilometres) is a fault of the file: squares and
/// cubes of limb coordinates must stay exact enough.
const FARTHEST: f64 = 1e9;

/// A triangle is degenerate when its height is below this fraction of the bounding box's
/// diagonal: that is how exactly 32-bit coordinates place points that should lie on a line.
const THIN: f64 = 1e-7;

/// No limb is larger, in mm: a stray crumb far away must not make tolerances coarse.
const LARGEST_LIMB: f64 = 2000.0;

/// The half-edges must be numbered by 32 bits.
const MOST: usize = (u32::MAX / 3) as usize;

/// How a raw mesh is to be understood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceOptions {
    /// The unit of its coordinates.
    pub unit: LengthUnit,
    /// Whether all components but the one of the largest area are dropped.
    pub keep_largest: bool,
    /// Boundary loops of at most this length, in mm, are closed unless they are the surface's
    /// outline or ends; 0 closes none.
    pub close_holes: f64,
    /// Whether its triangles face outward; `None` lets the shape tell.
    pub facing: Option<Facing>,
}

/// A surface and what was done to get it.
#[derive(Debug, Clone, PartialEq)]
pub struct Validated {
    /// The surface.
    pub surface: Surface,
    /// What was mended or may not be as meant.
    pub warnings: Vec<Warning>,
    /// What in the raw mesh it came from.
    pub origin: Origin,
}

/// The surface that `raw` means.
///
/// # Errors
/// With every defect that is found: the checks of single points and faces come first, those of
/// how faces hang together only when these pass.
pub fn validate(raw: &RawMesh, options: &SurfaceOptions) -> Result<Validated, SurfaceError> {
    let mut warnings = Vec::new();
    let points: Vec<DVec3> = raw.points.iter().map(|&p| in_mm(p, options.unit)).collect();
    check_elements(raw, &points)?;
    let mut mesh = Mesh::split(raw, points)?;
    mesh.report_unused(raw, &mut warnings);
    let diagonal = mesh.diagonal().min(LARGEST_LIMB);
    let tolerance = (weld::WELD * diagonal).max(2.0 * GRID);
    let thinnest = (THIN * diagonal).max(2.0 * GRID);
    mesh.weld(tolerance, &mut warnings);
    if options.keep_largest {
        mesh.keep_largest(&mut warnings);
    }

    let mut defects = mesh.take_broken_triangles(thinnest);
    let edges = Edges::of(&mesh.triangles);
    let agreement = orientation::agree(&mesh.triangles, &edges);
    defects.extend(mesh.non_manifold_edges(&edges));
    defects.extend(mesh.non_manifold_vertices(&edges));
    defects.extend(agreement.conflicts.iter().map(|&[a, b]| {
        let ends = [start(&mesh.triangles, a), end(&mesh.triangles, a)];
        let faces = [mesh.faces[a / 3], mesh.faces[b / 3]];
        Defect::not_orientable(ends, faces, mesh.middle(ends))
    }));
    let pieces = mesh.components(&edges);
    if pieces.len() > 1 {
        defects.push(Defect::several_components(&pieces));
    }
    if !defects.is_empty() {
        return Err(SurfaceError::new(defects));
    }

    mesh.turn(&agreement.turned, &mut warnings);
    mesh.drop_unused();
    mesh.face_outward(options.facing, &mut warnings)?;
    let cut = weld::cut_length(&mesh.points, &mesh.triangles, tolerance);
    if cut > 0.0 {
        warnings.push(Warning::new(
            "cut_kept",
            format!(
                "the boundary lies on itself along {cut:.1} mm: taken as a cut and left open; \
                 merge the vertices there in the file if it is none"
            ),
        ));
    }
    warnings.extend(holes::close(&mesh.points, &mut mesh.triangles, options.close_holes, thinnest));
    let triangles = mesh.triangles.iter().map(|t| t.map(VertexId::new)).collect();
    let surface = Surface::new(mesh.points, triangles).map_err(|e| Defect::fault(&e))?;
    let mut faces: Vec<Option<usize>> = mesh.faces.into_iter().map(Some).collect();
    // What closes a hole comes last.
    faces.resize(surface.triangle_count(), None);
    let became = |v: usize| (v != usize::MAX).then(|| VertexId::new(v));
    let vertices = mesh.became.into_iter().map(became).collect();
    let origin = Origin { source: mesh.source, vertices, faces, face_count: raw.polygons.len() };
    Ok(Validated { surface, warnings, origin })
}

fn check_elements(raw: &RawMesh, points: &[DVec3]) -> Result<(), SurfaceError> {
    if raw.points.is_empty() || raw.polygons.is_empty() {
        return Err(Defect::empty().into());
    }
    let corners: usize = raw.polygons.iter().map(Vec::len).sum();
    if points.len() > MOST || corners > MOST {
        return Err(Defect::too_large(points.len(), raw.polygons.len(), MOST).into());
    }
    let mut used = vec![false; points.len()];
    let mut defects = Vec::new();
    for (face, polygon) in raw.polygons.iter().enumerate() {
        let known = polygon.iter().filter_map(|&v| points.get(v)).copied();
        for &v in polygon {
            if v < points.len() {
                used[v] = true;
            } else {
                let place = mean(known.clone());
                defects.push(Defect::index_out_of_range(face, v, points.len(), place));
            }
        }
    }
    for (v, &p) in points.iter().enumerate() {
        // An unused point does no harm: it is dropped.
        if used[v] && !(p.abs().max_element() <= FARTHEST && p.is_finite()) {
            defects.push(Defect::not_finite(v, p));
        }
    }
    if defects.is_empty() { Ok(()) } else { Err(SurfaceError::new(defects)) }
}

#[cfg(test)]
mod tests;
