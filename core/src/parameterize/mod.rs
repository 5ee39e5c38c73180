//! The initial planar parameterization Ω (step 1 of the paper's algorithm).
//!
//! The intrinsic parameterization (the paper's reference 5) where it can be used, a flip-free map
//! where it cannot, and that is said. Either is at true scale and upright: x
//! along warp, y along weft, the first marker vertically above the second.

mod flip_free;
mod intrinsic;
mod quality;
mod rest;
#[cfg(test)]
mod tests;

pub(crate) use flip_free::first_root;
pub use quality::{
    MapQuality, crossing_edges, flipped_triangles, map_quality, outline_crossings, signed_area,
};
pub(crate) use rest::{RestTriangle, rest_of_lengths, rest_triangles};

use glam::{DVec2, DVec3};

use crate::geometry::SurfacePoint;
use crate::progress::Progress;
use crate::sparse::{Matrix, SparseError};
use crate::surface::{Surface, TriangleId};
use crate::warning::Warning;

/// A map whose typical piece is drawn at less than half or more than double its length is no
/// start for a fit that moves nodes by fractions of a spacing.
const UNUSABLE_FACTOR: f64 = 1.0;

/// Markers nearer to each other than this share of the root of the surface's area do not give a
/// direction: 0.02 mm on a limb.
const LEAST_APART: f64 = 1e-4;

/// A planar parameterization of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameterization {
    /// Place in the plane by vertex, in mm; x along warp, y along weft.
    pub coordinates: Vec<DVec2>,
    /// What the map does to the surface.
    pub quality: MapQuality,
    /// What had to be done to get it.
    pub warnings: Vec<Warning>,
}

/// Why a surface has no initial parameterization.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParameterizeError {
    /// The surface is not one piece that can be laid flat.
    #[error(
        "only one piece that is cut open can be laid flat: this surface has {components} pieces, \
         {loops} boundary loops and Euler characteristic {euler}; cut it along a seam first"
    )]
    NotADisk {
        /// Its connected components.
        components: usize,
        /// Its boundary loops.
        loops: usize,
        /// Its Euler characteristic.
        euler: i64,
    },
    /// The markers do not give a direction.
    #[error(
        "the two orientation markers, at ({:.1}, {:.1}, {:.1}) and ({:.1}, {:.1}, {:.1}) mm, lie \
         {apart:.3} mm apart in the pattern and give no direction: place them further apart, the \
         first at the end near the body",
        at[0].x, at[0].y, at[0].z, at[1].x, at[1].y, at[1].z
    )]
    MarkersCoincide {
        /// Where they are on the surface, in mm.
        at: [DVec3; 2],
        /// Their distance in the plane, in mm.
        apart: f64,
    },
    /// No map without flipped triangles was found.
    #[error(
        "the surface cannot be laid flat without turning triangles over: {count} triangles, the \
         first {triangle} at ({:.1}, {:.1}, {:.1}) mm; remesh the surface there",
        at.x, at.y, at.z
    )]
    Flipped {
        /// How many triangles are flipped.
        count: usize,
        /// The first of them.
        triangle: TriangleId,
        /// Where it is on the surface, in mm.
        at: DVec3,
    },
    /// The linear system of the flip-free start failed.
    #[error("the surface cannot be laid flat: {0}")]
    System(#[from] SparseError),
    /// The job was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// The initial parameterization of a disk, possibly with holes that stay cut-outs, upright by
/// its markers (the first at the end near the body). `matrix` is the disk's. The scale r of the paper is not
/// applied.
///
/// A tube passes for a disk with a hole: cut it first.
///
/// # Errors
/// If the surface is not one disk, the markers fall together, or no map without flipped
/// triangles exists in floating point, or the job is cancelled.
pub fn initial(
    disk: &Surface,
    matrix: &Matrix,
    markers: &[SurfacePoint; 2],
    progress: &dyn Progress,
) -> Result<Parameterization, ParameterizeError> {
    let (_, components) = disk.components();
    let (loops, euler) = (disk.boundary_loops().len(), disk.euler_characteristic());
    if components != 1 || loops == 0 || euler + i64::try_from(loops).unwrap_or(i64::MAX) != 2 {
        return Err(ParameterizeError::NotADisk { components, loops, euler });
    }
    let mut warnings = Vec::new();
    let natural =
        intrinsic::intrinsic(disk, matrix, progress).ok().map(|map| (map_quality(disk, &map), map));
    if progress.cancelled() {
        return Err(ParameterizeError::Cancelled);
    }
    let (quality, map) = match (unusable(disk, natural.as_ref()), natural) {
        (None, Some(usable)) => usable,
        (reason, _) => {
            let (reason, at) = reason.unwrap_or_default();
            let message = format!(
                "the intrinsic parameterization {reason}; the fit starts from a flip-free map \
                 instead"
            );
            warnings.push(match at {
                Some(place) => Warning::at("start_replaced", message, place),
                None => Warning::new("start_replaced", message),
            });
            let map = flip_free::flip_free(disk)?;
            let quality = map_quality(disk, &map);
            if let Some(triangle) = flipped_triangles(disk, &map).next() {
                let at = middle(disk, triangle);
                return Err(ParameterizeError::Flipped { count: quality.flipped, triangle, at });
            }
            (quality, map)
        }
    };
    let coordinates = upright(&map, disk, markers)?;
    Ok(Parameterization { coordinates, quality, warnings })
}

/// Why a map cannot be the start, and where; `None` if it can.
fn unusable(
    disk: &Surface,
    natural: Option<&(MapQuality, Vec<DVec2>)>,
) -> Option<(String, Option<DVec3>)> {
    let Some((quality, map)) = natural else {
        return Some(("cannot be solved on this mesh".to_owned(), None));
    };
    if let Some(first) = flipped_triangles(disk, map).next() {
        let at = middle(disk, first);
        let text = format!(
            "turns {} of {} triangles over (the first: {first} at ({:.1}, {:.1}, {:.1}) mm)",
            quality.flipped,
            disk.triangle_count(),
            at.x,
            at.y,
            at.z
        );
        return Some((text, Some(at)));
    }
    if quality.crossings > 0 {
        let text = format!("crosses its own outline {} times", quality.crossings);
        return Some((text, None));
    }
    if quality.factor_rms.is_nan() || quality.factor_rms > UNUSABLE_FACTOR {
        let text = format!(
            "stretches the surface too unevenly ({:.2} to {:.2})",
            quality.least_stretch, quality.greatest_stretch
        );
        return Some((text, None));
    }
    None
}

fn middle(surface: &Surface, t: TriangleId) -> DVec3 {
    surface.corners(t).iter().sum::<DVec3>() / 3.0
}

/// The map turned about the middle between the markers, which becomes the origin, so that the
/// first marker stands vertically above the second. Nothing is scaled or mirrored.
///
/// # Errors
/// If the markers fall together in the plane.
pub fn upright(
    coordinates: &[DVec2],
    surface: &Surface,
    markers: &[SurfacePoint; 2],
) -> Result<Vec<DVec2>, ParameterizeError> {
    let [first, second] = markers.map(|m| m.interpolate(surface, coordinates));
    let up = first - second;
    let apart = up.length();
    if apart.is_nan() || apart <= LEAST_APART * surface.total_area().sqrt() {
        let at = markers.map(|m| m.position(surface));
        return Err(ParameterizeError::MarkersCoincide { at, apart });
    }
    let origin = second + 0.5 * up;
    // The complex number that turns `up` to +i: i · conj(up) / |up|.
    let turn = DVec2::new(up.y, up.x) / apart;
    Ok(coordinates.iter().map(|&p| turn.rotate(p - origin)).collect())
}
