//! Wishes that have a place: pressures, orientation, seams, region, by points or on a mesh.

use wovenfit_core::design::{RegionPlane, WantedPressure, condense, seams_along_edges};

use crate::buffers::{copied, points};
use crate::design::Design;
use crate::failure::{Error, Failure};
use crate::guard::{Outcome, borrow, borrow_mut, guard};
use crate::limits::{
    WOVENFIT_MOST_PLANES, WOVENFIT_MOST_PRESSURES, WOVENFIT_MOST_SEAM_POINTS,
    WOVENFIT_MOST_TRIANGLES, WOVENFIT_MOST_VERTICES,
};
use crate::mesh::Mesh;
use crate::status::Status;

/// Adds wanted pressures at points.
///
/// `positions`: x, y, z of each of `count` points, in the design's unit, on the surface or within
/// 10 mm of it. `kpa`: the wanted pressure of each, in kPa, 0 to 13.3 unless "limits.max_kpa" allows
/// more.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_add_pressures(
    design: *mut Design,
    positions: *const f64,
    kpa: *const f64,
    count: usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let most = WOVENFIT_MOST_PRESSURES as usize;
            let places = design.in_mm(points(positions, count, most, "positions")?);
            let kpa = pressures(&copied(kpa, count, most, "kpa")?)?;
            add(design, places.into_iter().zip(kpa).map(|(at, kpa)| WantedPressure { at, kpa }))
        })
    }
}

/// Adds wanted pressures at vertices of a mesh: `vertices`, counted from 0, and `kpa` have `count`
/// numbers each; `kpa` is as in wovenfit_design_add_pressures.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_add_pressures_at_vertices(
    design: *mut Design,
    mesh: *const Mesh,
    vertices: *const u32,
    kpa: *const f64,
    count: usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let mesh = &borrow(mesh, "mesh")?.0;
            let most = WOVENFIT_MOST_PRESSURES as usize;
            let vertices = copied(vertices, count, most, "vertices")?;
            let kpa = pressures(&copied(kpa, count, most, "kpa")?)?;
            let wanted = vertices
                .iter()
                .zip(kpa)
                .map(|(&vertex, kpa)| Ok(WantedPressure { at: mesh.place(vertex)?, kpa }));
            let wanted: Vec<WantedPressure> = wanted.collect::<Result<_, Failure>>()?;
            add(design, wanted.into_iter())
        })
    }
}

/// Adds the pressures painted onto a mesh: `kpa` is a value for each of its vertices in kPa, 0 where
/// nothing is asked; `count` is their number and must be that of the vertices.
///
/// Painted vertices are condensed to at most 200 points at least 10 mm apart, each wanting the mean
/// of the values round it; a warning of the result says how many became how many, and the table of
/// pressures lists the points. Paint that was there before stays: clear "pressures" first.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_paint_pressures(
    design: *mut Design,
    mesh: *const Mesh,
    kpa: *const f64,
    count: usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let mesh = &borrow(mesh, "mesh")?.0;
            let vertices = mesh.raw.points.len();
            if count != vertices {
                return Err(Failure::invalid(format!(
                    "`kpa` has {count} values and the mesh {vertices} vertices: give one for each, 0 \
                     where nothing is asked"
                )));
            }
            let kpa = pressures(&copied(kpa, count, WOVENFIT_MOST_VERTICES as usize, "kpa")?)?;
            for (vertex, _) in kpa.iter().enumerate().filter(|(_, kpa)| **kpa > 0.0) {
                // The count was limited to 32 bits above.
                mesh.place(vertex as u32)?;
            }
            let painted = condense(&mesh.places(), &mesh.raw.polygons, &kpa);
            design.change(|wishes| {
                wishes.pressures.extend(painted.pressures);
                wishes.warnings.extend(painted.warning);
            })
        })
    }
}

/// Sets the two orientation markers at points: `positions` is x, y, z of both in the design's unit,
/// the first near the body. In the pattern they stand above each other: the weft direction.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_set_orientation(
    design: *mut Design,
    positions: *const f64,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let markers = design.in_mm(points(positions, 2, 2, "positions")?);
            design.change(|wishes| wishes.orientation = Some([markers[0], markers[1]]))
        })
    }
}

/// Sets the two orientation markers at vertices of a mesh, `first` near the body.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_set_orientation_at_vertices(
    design: *mut Design,
    mesh: *const Mesh,
    first: u32,
    second: u32,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let mesh = &borrow(mesh, "mesh")?.0;
            let markers = [mesh.place(first)?, mesh.place(second)?];
            design.change(|wishes| wishes.orientation = Some(markers))
        })
    }
}

/// Adds a seam along which the surface is cut: `positions` is x, y, z of each of its `count` points,
/// two or more, in the design's unit, within 10 mm of the surface. It begins at an edge of the brace
/// or at an earlier seam.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_add_seam(
    design: *mut Design,
    positions: *const f64,
    count: usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let most = WOVENFIT_MOST_SEAM_POINTS as usize;
            let seam = design.in_mm(points(positions, count, most, "positions")?);
            design.change(|wishes| wishes.seams.push(seam))
        })
    }
}

/// Adds seams along edges of a mesh: `vertices` is two vertices, counted from 0, for each of
/// `edge_count` edges, in any order.
///
/// Edges are chained from branch to branch or free end, and their zigzag is drawn straight to within
/// an edge's mean length: a seam of zigzags cannot be sewn.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_add_seams_along_edges(
    design: *mut Design,
    mesh: *const Mesh,
    vertices: *const u32,
    edge_count: usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let mesh = &borrow(mesh, "mesh")?.0;
            let most = WOVENFIT_MOST_TRIANGLES as usize;
            if edge_count > most {
                let text = format!("{edge_count} edges are given; {most} are the most");
                return Err(Failure::too_large(text));
            }
            let ends = copied(vertices, 2 * edge_count, 2 * most, "vertices")?;
            for &vertex in &ends {
                mesh.place(vertex)?;
            }
            let edges: Vec<[usize; 2]> =
                ends.chunks_exact(2).map(|pair| [pair[0] as usize, pair[1] as usize]).collect();
            let seams = seams_along_edges(&mesh.places(), &edges);
            design.change(|wishes| wishes.seams.extend(seams))
        })
    }
}

/// Adds a plane that bounds the brace: it covers what lies on the side to which all normals point.
/// `point`: x, y, z of a point of the plane in the design's unit. `normal`: its direction, of any
/// length but zero.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_add_region_plane(
    design: *mut Design,
    point: *const f64,
    normal: *const f64,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let point = design.in_mm(points(point, 1, 1, "point")?)[0];
            let normal = points(normal, 1, 1, "normal")?[0];
            design.change(|wishes| wishes.region.push(RegionPlane { point, normal }))
        })
    }
}

/// Sets the triangles of a mesh that the brace covers, `count` of them, counted from 0; it then
/// covers what lies in them and within all planes. Its edge follows the triangles' edges. Pressure
/// is still read off the whole scan. The design then fits jobs on a mesh of as many triangles only.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_set_region_triangles(
    design: *mut Design,
    mesh: *const Mesh,
    triangles: *const u32,
    count: usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let all = borrow(mesh, "mesh")?.0.raw.polygons.len();
            let most = WOVENFIT_MOST_TRIANGLES as usize;
            let mut selected = copied(triangles, count, most, "triangles")?;
            if selected.is_empty() {
                return Err(Failure::invalid(
                    "no triangle is selected: select those that the brace covers, or clear \
                     \"region_faces\" to cover all",
                ));
            }
            if let Some(beyond) = selected.iter().find(|&&t| t as usize >= all) {
                let text = format!("triangle {beyond} does not exist: the mesh has {all}, from 0");
                return Err(Failure::new(Status::OutOfRange, text));
            }
            selected.sort_unstable();
            selected.dedup();
            let selected = selected.into_iter().map(|t| t as usize).collect();
            design.wishes.region_faces = Some(selected);
            design.selected_of = Some(all);
            Ok(())
        })
    }
}

/// Adds places where bone lies under the skin, at which the report warns of pressure: x, y, z of each
/// of `count` points in the design's unit.
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_add_bony(
    design: *mut Design,
    positions: *const f64,
    count: usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let most = WOVENFIT_MOST_PLANES as usize;
            let places = design.in_mm(points(positions, count, most, "positions")?);
            design.change(|wishes| wishes.limits.bony.extend(places))
        })
    }
}

/// Refuses what is no pressure; how high one may be is for the design to say.
fn pressures(kpa: &[f64]) -> Result<Vec<f64>, Failure> {
    match kpa.iter().position(|kpa| !(kpa.is_finite() && *kpa >= 0.0)) {
        Some(i) => Err(Failure::invalid(format!(
            "number {i} of `kpa` is {}: give pressures of 0 or more, in kPa",
            kpa[i]
        ))),
        None => Ok(kpa.to_vec()),
    }
}

fn add(design: &mut Design, wanted: impl Iterator<Item = WantedPressure>) -> Outcome {
    design.change(|wishes| wishes.pressures.extend(wanted))
}
