//! A surface as the caller's buffers give it.

use std::ffi::c_char;
use std::sync::Arc;

use glam::DVec3;
use wovenfit_core::surface::{RawMesh, on_grid};
use wovenfit_core::units::LengthUnit;

use crate::buffers::{Plain, copied, text};
use crate::failure::{Error, Failure};
use crate::guard::{Out, Outcome, borrow, free, guard};
use crate::limits::{WOVENFIT_MOST_TRIANGLES, WOVENFIT_MOST_VERTICES};
use crate::status::Status;

/// A mesh of triangles, as it was given, with its unit. It never changes: any number of threads may
/// use it at once.
pub struct Mesh(pub(crate) Arc<Given>);

/// What a mesh holds.
pub(crate) struct Given {
    pub(crate) raw: RawMesh,
    /// The unit of `raw`.
    pub(crate) unit: LengthUnit,
    /// Millimetres in one unit of what was given.
    pub(crate) mm_per_unit: f64,
}

impl Given {
    fn new(points: Vec<DVec3>, triangles: &[u32], mm_per_unit: f64) -> Self {
        let polygons = triangles.chunks_exact(3).map(|t| t.iter().map(|&v| v as usize).collect());
        let polygons = polygons.collect();
        // A unit that has a name stays, so that messages can say it.
        let (points, unit) = match named(mm_per_unit) {
            Some(unit) => (points, unit),
            None => {
                let in_mm = points.into_iter().map(|p| on_grid(p, mm_per_unit)).collect();
                (in_mm, LengthUnit::Millimetre)
            }
        };
        Self { raw: RawMesh { points, polygons }, unit, mm_per_unit }
    }

    /// The place of a vertex in mm.
    pub(crate) fn place(&self, vertex: u32) -> Result<DVec3, Failure> {
        let count = self.raw.points.len();
        let point = self.raw.points.get(vertex as usize).ok_or_else(|| {
            let text = format!("vertex {vertex} does not exist: the mesh has {count}, from 0");
            Failure::new(Status::OutOfRange, text)
        })?;
        if point.is_finite() {
            return Ok(on_grid(*point, self.unit.millimetres()));
        }
        Err(Failure::invalid(format!("vertex {vertex} has no finite place")))
    }

    /// Every place in mm, finite or not.
    pub(crate) fn places(&self) -> Vec<DVec3> {
        let mm = self.unit.millimetres();
        self.raw.points.iter().map(|&p| on_grid(p, mm)).collect()
    }
}

/// The unit of so many mm, if it has a name.
pub(crate) fn named(mm_per_unit: f64) -> Option<LengthUnit> {
    LengthUnit::ALL.into_iter().find(|unit| unit.millimetres() == mm_per_unit)
}

/// Refuses a scale that is none.
pub(crate) fn scale(mm_per_unit: f64) -> Result<f64, Failure> {
    /// From atoms to continents: beyond, numbers lose what a limb needs.
    const SCALES: std::ops::RangeInclusive<f64> = 1e-9..=1e9;
    if SCALES.contains(&mm_per_unit) {
        return Ok(mm_per_unit);
    }
    Err(Failure::invalid(format!(
        "`mm_per_unit` is {mm_per_unit}: give the millimetres in one unit of the coordinates, from \
         1e-9 to 1e9 (1 for millimetres, 1000 for metres)"
    )))
}

/// Makes a mesh of 64-bit coordinates.
///
/// `positions`: x, y, z of each of `vertex_count` vertices, the next vertex `stride` bytes further
/// (0 for 24). `triangles`: three vertices, counted from 0, for each of `triangle_count`,
/// counter-clockwise seen from outside the limb; polygons are the caller's to split. `mm_per_unit`:
/// millimetres in one unit of the coordinates. The buffers are copied. Whether the mesh is sound is
/// for wovenfit_check_run and the job to say, so that every defect is named; here only NULL, counts,
/// stride and unit are refused.
///
/// Any thread. Free `mesh` with wovenfit_mesh_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_mesh_new_f64(
    positions: *const f64,
    vertex_count: usize,
    stride: usize,
    triangles: *const u32,
    triangle_count: usize,
    mm_per_unit: f64,
    mesh: *mut *mut Mesh,
    error: *mut *mut Error,
) -> Status {
    let buffers = Buffers { positions, vertex_count, stride, triangles, triangle_count };
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe { guard(error, || make(&buffers, mm_per_unit, mesh)) }
}

/// Makes a mesh of 32-bit coordinates; all else is as in wovenfit_mesh_new_f64, a `stride` of 0
/// means 12.
///
/// Any thread. Free `mesh` with wovenfit_mesh_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_mesh_new_f32(
    positions: *const f32,
    vertex_count: usize,
    stride: usize,
    triangles: *const u32,
    triangle_count: usize,
    mm_per_unit: f64,
    mesh: *mut *mut Mesh,
    error: *mut *mut Error,
) -> Status {
    let buffers = Buffers { positions, vertex_count, stride, triangles, triangle_count };
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe { guard(error, || make(&buffers, mm_per_unit, mesh)) }
}

/// What a mesh is made from.
struct Buffers<T> {
    positions: *const T,
    vertex_count: usize,
    stride: usize,
    triangles: *const u32,
    triangle_count: usize,
}

/// # Safety
/// The buffers can be read as far as they say, and `mesh` can be written.
unsafe fn make<T: Plain + Into<f64>>(
    buffers: &Buffers<T>,
    mm_per_unit: f64,
    mesh: *mut *mut Mesh,
) -> Outcome {
    let mesh = Out::new(mesh, "mesh")?;
    let mm_per_unit = scale(mm_per_unit)?;
    // SAFETY: by the caller.
    unsafe {
        let points = positions(buffers)?;
        let most = 3 * WOVENFIT_MOST_TRIANGLES as usize;
        let corners = buffers.triangle_count.checked_mul(3).filter(|&corners| corners <= most);
        let corners = corners.ok_or_else(|| {
            Failure::too_large(format!(
                "{} triangles are given; {WOVENFIT_MOST_TRIANGLES} are the most: decimate the mesh",
                buffers.triangle_count
            ))
        })?;
        let triangles = copied(buffers.triangles, corners, most, "triangles")?;
        mesh.give(Mesh(Arc::new(Given::new(points, &triangles, mm_per_unit))))
    }
}

/// # Safety
/// `positions` can be read for `vertex_count` vertices `stride` bytes apart.
unsafe fn positions<T: Plain + Into<f64>>(buffers: &Buffers<T>) -> Result<Vec<DVec3>, Failure> {
    let (count, one) = (buffers.vertex_count, 3 * size_of::<T>());
    if count > WOVENFIT_MOST_VERTICES as usize {
        return Err(Failure::too_large(format!(
            "{count} vertices are given; {WOVENFIT_MOST_VERTICES} are the most: decimate the mesh"
        )));
    }
    let stride = if buffers.stride == 0 { one } else { buffers.stride };
    let fits = count.checked_mul(stride).is_some_and(|all| all <= isize::MAX as usize);
    if stride < one || !fits {
        return Err(Failure::invalid(format!(
            "`stride` is {stride} bytes: give 0, or the bytes from one vertex to the next, at least \
             {one}"
        )));
    }
    if count == 0 {
        return Ok(Vec::new());
    }
    if buffers.positions.is_null() {
        return Err(Failure::new(Status::NullArgument, "`positions` is NULL"));
    }
    let mut points = Vec::with_capacity(count);
    for i in 0..count {
        // SAFETY: within what the caller says can be read; checked not to overflow.
        let [x, y, z] = unsafe {
            buffers.positions.cast::<u8>().add(i * stride).cast::<[T; 3]>().read_unaligned()
        };
        points.push(DVec3::new(x.into(), y.into(), z.into()));
    }
    Ok(points)
}

/// The millimetres in a unit by its name: "mm", "cm", "m" or "in".
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_unit_millimetres(
    name: *const c_char,
    mm_per_unit: *mut f64,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let out = Out::new(mm_per_unit, "mm_per_unit")?;
            let name = text(name, "name")?;
            let unit = LengthUnit::from_symbol(name).ok_or_else(|| {
                let known = LengthUnit::ALL.map(LengthUnit::symbol).join("`, `");
                Failure::invalid(format!("there is no unit `{name}`: give one of `{known}`"))
            })?;
            out.put(unit.millimetres())
        })
    }
}

/// Numbers of vertices and triangles of a mesh, as given.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_mesh_size(
    mesh: *const Mesh,
    vertex_count: *mut usize,
    triangle_count: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let raw = &borrow(mesh, "mesh")?.0.raw;
            let vertices = Out::new(vertex_count, "vertex_count")?;
            let triangles = Out::new(triangle_count, "triangle_count")?;
            vertices.put(raw.points.len())?;
            triangles.put(raw.polygons.len())
        })
    }
}

/// Frees a mesh; NULL is fine. Designs, jobs and results made from it stay.
///
/// No other thread may be using the handle.
///
/// # Safety
/// `mesh` is NULL or a mesh that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_mesh_free(mesh: *mut Mesh) {
    // SAFETY: the caller gives NULL or a living object and never uses it again.
    unsafe { free(mesh) }
}
