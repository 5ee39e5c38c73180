//! The arrays of a result, on the cut surface and on the mesh that was given.

use glam::DVec2;
use wovenfit_core::surface::VertexId;
use wovenfit_core::transfer::{OnGiven, Transfer};

use super::{Computed, FitResult};
use crate::buffers::fill;
use crate::failure::{Error, Failure};
use crate::guard::{borrow, guard};
use crate::pool::in_pool;
use crate::status::Status;

/// No element: where an index could stand.
pub const WOVENFIT_NONE: u32 = u32::MAX;

/// An array of 64-bit numbers of a result. V and T are the numbers of vertices and triangles of the
/// cut surface, GV and GT those of the mesh given.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultDoubles {
    /// V x 2: pattern coordinates of the cut surface's vertices in mm, x along warp, y along weft, the
    /// pattern's lower left corner at the origin.
    Pattern = 1,
    /// T x 3 x 2: the same for every corner of every triangle.
    PatternPerCorner = 2,
    /// V x 3: places of the cut surface's vertices in mm.
    Positions = 3,
    /// V x 3: weights of the corners of the given triangle in which each vertex lies
    /// (WOVENFIT_RESULT_INDEX_ARRAY_VERTEX_TO_GIVEN_TRIANGLE); they sum to 1. Zeros without one.
    VertexWeights = 4,
    /// V: strain along warp.
    WarpStrain = 5,
    /// V: strain along weft.
    WeftStrain = 6,
    /// V: present area over rest area.
    AreaStretch = 7,
    /// V: pressure in kPa, negative where the fabric would lift off.
    PressureKpa = 8,
    /// V: coefficient of friction needed to hold the fabric; NaN near a free edge and where nearly
    /// nothing presses.
    Friction = 9,
    /// n x 2: pattern coordinates along all outline loops, one after the other, in mm. The first loop
    /// is the outer one.
    Outline = 10,
    /// n x 2: lengths in the pattern of the left and right side of each seam, in mm.
    SeamLengths = 11,
    /// n x 2: distance along the limb from the end near the body and girth there, in mm.
    Girths = 12,
    /// n x 2: pattern coordinates of the wanted pressures in the order of the table, in mm.
    PressurePoints = 13,
    /// 2 x 2: pattern coordinates of the orientation markers in mm, the first near the body.
    OrientationMarkers = 14,
    /// GT x 3 x 2: pattern coordinates for every corner of the given triangles, in their order, in mm;
    /// NaN where the brace does not cover a triangle's middle. A triangle through which the edge or a
    /// seam runs belongs to the side of its middle, and goes on linearly beyond.
    GivenPatternPerCorner = 20,
    /// GV: strain along warp at the given vertices; NaN where the brace does not cover them.
    GivenWarpStrain = 21,
    /// GV: strain along weft.
    GivenWeftStrain = 22,
    /// GV: pressure in kPa.
    GivenPressureKpa = 23,
}

/// An array of indices of a result; V, T, GV and GT as in wovenfit_result_array. Vertices of the cut
/// surface are counted from 0.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResultIndices {
    /// T x 3: corners of the cut surface's triangles, counter-clockwise seen from outside.
    Triangles = 1,
    /// V: the given vertex that each vertex is, the first of those that were welded; WOVENFIT_NONE if
    /// the cut made it.
    VertexToGivenVertex = 2,
    /// V: a given triangle in which each vertex lies; WOVENFIT_NONE on what closes a hole.
    VertexToGivenTriangle = 3,
    /// T: the given triangle in which the middle of each triangle lies; WOVENFIT_NONE on what closes a
    /// hole.
    TriangleToGivenTriangle = 4,
    /// The vertices along all outline loops, one after the other; as many as the outline has points.
    Outline = 5,
    /// n + 1: where each outline loop starts in the outline, and the end.
    OutlineStarts = 6,
    /// The vertices along the left sides of all seams, one seam after the other. Each side has as many
    /// as the other, start sewn to start.
    SeamLeft = 7,
    /// The same for the right sides.
    SeamRight = 8,
    /// n + 1: where each seam starts in the two, and the end.
    SeamStarts = 9,
}

/// The way back to the mesh given, made when it is first asked for.
pub(super) struct Ways {
    vertices: Vec<OnGiven>,
    triangles: Vec<Option<usize>>,
    corners: Vec<Option<[DVec2; 3]>>,
    warp: Vec<f64>,
    weft: Vec<f64>,
    pressure: Vec<f64>,
}

impl Computed {
    fn ways(&self) -> Result<&Ways, Failure> {
        if let Some(ways) = self.ways.get() {
            return Ok(ways);
        }
        let made = in_pool(|| {
            let field = &self.flattening.field;
            let transfer = Transfer::new(&self.flattening, &self.ready.mesh.raw);
            Ways {
                vertices: transfer.vertices(),
                triangles: transfer.triangles(),
                corners: transfer.corners(),
                warp: transfer.to_vertices(&field.warp_strain),
                weft: transfer.to_vertices(&field.weft_strain),
                pressure: transfer.to_vertices(&field.pressure_kpa),
            }
        })?;
        // Of two threads that made it at once one is first, with the same numbers.
        Ok(self.ways.get_or_init(|| made))
    }

    fn doubles(&self, what: i32) -> Result<Vec<f64>, Failure> {
        let (flattening, is) = (&self.flattening, |w: ResultDoubles| w as i32 == what);
        let (disk, field) = (flattening.disk(), &flattening.field);
        let pairs = |points: &[DVec2]| points.iter().flat_map(DVec2::to_array).collect();
        Ok(if is(ResultDoubles::Pattern) {
            pairs(&flattening.coordinates)
        } else if is(ResultDoubles::PatternPerCorner) {
            let corners = disk.triangles().iter().flatten();
            corners.flat_map(|v| flattening.coordinates[v.index()].to_array()).collect()
        } else if is(ResultDoubles::Positions) {
            disk.points().iter().flat_map(|p| p.to_array()).collect()
        } else if is(ResultDoubles::VertexWeights) {
            self.ways()?.vertices.iter().flat_map(|on| on.weights).collect()
        } else if is(ResultDoubles::WarpStrain) {
            field.warp_strain.clone()
        } else if is(ResultDoubles::WeftStrain) {
            field.weft_strain.clone()
        } else if is(ResultDoubles::AreaStretch) {
            field.area_stretch.clone()
        } else if is(ResultDoubles::PressureKpa) {
            field.pressure_kpa.clone()
        } else if is(ResultDoubles::Friction) {
            field.friction.iter().map(|friction| friction.unwrap_or(f64::NAN)).collect()
        } else if is(ResultDoubles::Outline) {
            flattening.drawing.outline.iter().flat_map(|l| pairs(l) as Vec<f64>).collect()
        } else if is(ResultDoubles::SeamLengths) {
            let seams = flattening.drawing.seams.iter();
            seams.flat_map(|seam| [seam.left_mm, seam.right_mm]).collect()
        } else if is(ResultDoubles::Girths) {
            flattening.girths.iter().flat_map(|girth| [girth.at_mm, girth.girth_mm]).collect()
        } else if is(ResultDoubles::PressurePoints) {
            flattening.drawing.points.iter().flat_map(|(p, _)| p.to_array()).collect()
        } else if is(ResultDoubles::OrientationMarkers) {
            pairs(&flattening.drawing.markers)
        } else if is(ResultDoubles::GivenPatternPerCorner) {
            let corner = |c: &Option<[DVec2; 3]>| c.unwrap_or([DVec2::NAN; 3]);
            self.ways()?.corners.iter().flat_map(corner).flat_map(|p| p.to_array()).collect()
        } else if is(ResultDoubles::GivenWarpStrain) {
            self.ways()?.warp.clone()
        } else if is(ResultDoubles::GivenWeftStrain) {
            self.ways()?.weft.clone()
        } else if is(ResultDoubles::GivenPressureKpa) {
            self.ways()?.pressure.clone()
        } else {
            return Err(Failure::invalid(format!("`what` is {what}: there is no such array")));
        })
    }

    fn indices(&self, what: i32) -> Result<Vec<u32>, Failure> {
        let (cut, is) = (&self.flattening.cut, |w: ResultIndices| w as i32 == what);
        let some = |index: Option<usize>| index.map_or(WOVENFIT_NONE, narrow);
        let ids = |ids: &[VertexId]| ids.iter().map(|v| narrow(v.index())).collect::<Vec<_>>();
        let seams = || cut.seams.iter();
        Ok(if is(ResultIndices::Triangles) {
            cut.disk.triangles().iter().flatten().map(|v| narrow(v.index())).collect()
        } else if is(ResultIndices::VertexToGivenVertex) {
            self.ways()?.vertices.iter().map(|on| some(on.vertex)).collect()
        } else if is(ResultIndices::VertexToGivenTriangle) {
            self.ways()?.vertices.iter().map(|on| some(on.face)).collect()
        } else if is(ResultIndices::TriangleToGivenTriangle) {
            self.ways()?.triangles.iter().map(|&face| some(face)).collect()
        } else if is(ResultIndices::Outline) {
            self.outline().iter().flat_map(|around| ids(around)).collect()
        } else if is(ResultIndices::OutlineStarts) {
            starts(self.outline().iter().map(Vec::len))
        } else if is(ResultIndices::SeamLeft) {
            seams().flat_map(|seam| ids(&seam.left)).collect()
        } else if is(ResultIndices::SeamRight) {
            seams().flat_map(|seam| ids(&seam.right)).collect()
        } else if is(ResultIndices::SeamStarts) {
            starts(seams().map(|seam| seam.left.len()))
        } else {
            return Err(Failure::invalid(format!("`what` is {what}: there is no such array")));
        })
    }

    /// The outline loops as vertices, in the order of the drawing.
    fn outline(&self) -> Vec<Vec<VertexId>> {
        wovenfit_core::pattern::outline(&self.flattening.cut.disk)
    }
}

/// Meshes are limited to fewer than 2^32 elements.
fn narrow(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(WOVENFIT_NONE)
}

/// Where lists of these lengths start when they stand one after the other, and the end.
fn starts(lengths: impl Iterator<Item = usize>) -> Vec<u32> {
    let mut sum = 0;
    let ends = lengths.map(|length| {
        sum += length;
        narrow(sum)
    });
    std::iter::once(0).chain(ends).collect()
}

/// An array of numbers of a result; `what` is a wovenfit_result_array, `capacity` and `count` are in
/// numbers. The first call for one about the given mesh finds the way back to it, in a fraction of
/// the job's time.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_doubles(
    result: *const FitResult,
    what: i32,
    buffer: *mut f64,
    capacity: usize,
    count: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let values = borrow(result, "result")?.0.doubles(what)?;
            fill(buffer, capacity, count, &values)
        })
    }
}

/// An array of indices of a result; `what` is a wovenfit_result_index_array, all else as in
/// wovenfit_result_doubles.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_result_indices(
    result: *const FitResult,
    what: i32,
    buffer: *mut u32,
    capacity: usize,
    count: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let values = borrow(result, "result")?.0.indices(what)?;
            fill(buffer, capacity, count, &values)
        })
    }
}
