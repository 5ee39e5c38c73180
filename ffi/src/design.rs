//! What the designer wants: made empty or from a design file's text, changed value by value.

use std::ffi::c_char;

use glam::DVec3;
use serde_json::Value;
use wovenfit_core::design::{Design as Wishes, parse, schema};
use wovenfit_core::export::json_text;
use wovenfit_core::surface::on_grid;

use crate::buffers::{fill_text, text};
use crate::failure::{Error, Failure};
use crate::guard::{Out, Outcome, borrow, borrow_mut, free, guard};
use crate::limits::{WOVENFIT_MOST_PLANES, WOVENFIT_MOST_PRESSURES, WOVENFIT_MOST_SEAM_POINTS};
use crate::mesh::{Given, named, scale};
use crate::status::Status;

/// What is wanted of one brace: fabric, pressures, orientation, seams, region. Everything in it is
/// checked when it is set. One thread at a time may change it; while nobody does, any may read.
#[derive(Clone)]
pub struct Design {
    pub(crate) wishes: Wishes,
    /// Of the coordinates given to it.
    pub(crate) mm_per_unit: f64,
    /// Number of triangles of the mesh on which the region's were selected.
    pub(crate) selected_of: Option<usize>,
}

impl Design {
    pub(crate) fn new(wishes: Wishes, mm_per_unit: f64) -> Self {
        Self { wishes, mm_per_unit, selected_of: None }
    }

    /// The wishes for a mesh, whose unit is now known.
    pub(crate) fn wishes_for(&self, mesh: &Given) -> Result<Wishes, Failure> {
        let triangles = mesh.raw.polygons.len();
        let selected_of = self.selected_of.filter(|_| self.wishes.region_faces.is_some());
        if let Some(other) = selected_of.filter(|&of| of != triangles) {
            return Err(Failure::invalid(format!(
                "the region was selected on a mesh of {other} triangles, and this one has \
                 {triangles}: select it anew"
            )));
        }
        Ok(Wishes { unit: Some(mesh.unit), ..self.wishes.clone() })
    }

    /// Points of the caller in mm.
    pub(crate) fn in_mm(&self, points: Vec<DVec3>) -> Vec<DVec3> {
        points.into_iter().map(|p| on_grid(p, self.mm_per_unit)).collect()
    }

    /// Changes the wishes, if the rules of the design file and our limits allow it.
    pub(crate) fn change(&mut self, change: impl FnOnce(&mut Wishes)) -> Outcome {
        let mut wishes = self.wishes.clone();
        change(&mut wishes);
        within_limits(&wishes)?;
        self.wishes = wishes.checked()?;
        Ok(())
    }
}

fn within_limits(wishes: &Wishes) -> Outcome {
    let seam_points: usize = wishes.seams.iter().map(Vec::len).sum();
    for (what, count, most) in [
        ("pressures", wishes.pressures.len(), WOVENFIT_MOST_PRESSURES),
        ("seam points", seam_points, WOVENFIT_MOST_SEAM_POINTS),
        ("region planes", wishes.region.len(), WOVENFIT_MOST_PLANES),
        ("bony places", wishes.limits.bony.len(), WOVENFIT_MOST_PLANES),
    ] {
        if count > most as usize {
            let text = format!("the design has {count} {what}; {most} are the most");
            return Err(Failure::too_large(text));
        }
    }
    Ok(())
}

/// Makes an empty design: the default fabric, no pressures, the whole surface. `mm_per_unit`:
/// millimetres in one unit of all coordinates that are given to it, as for a mesh.
///
/// Any thread. Free `design` with wovenfit_design_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_new(
    mm_per_unit: f64,
    design: *mut *mut Design,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let out = Out::new(design, "design")?;
            let mm_per_unit = scale(mm_per_unit)?;
            out.give(Design::new(Wishes::default(), mm_per_unit))
        })
    }
}

/// Makes a design from the JSON text of a design file; refusals are the command line's own
/// (WOVENFIT_STATUS_DESIGN). Its coordinates are in its `units`; where it says none they are in
/// `mm_per_unit`, which must then be one of 1, 10, 1000 and 25.4. Coordinates given later are in
/// `mm_per_unit`.
///
/// Any thread. Free `design` with wovenfit_design_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_from_json(
    json: *const c_char,
    mm_per_unit: f64,
    design: *mut *mut Design,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let out = Out::new(design, "design")?;
            let mm_per_unit = scale(mm_per_unit)?;
            let unit = named(mm_per_unit);
            let wishes = parse(text(json, "json")?, unit)?;
            if unit.is_none() && wishes.unit.is_none() {
                return Err(Failure::invalid(format!(
                    "the design does not say its `units`, and {mm_per_unit} mm is none that has a \
                     name: add \"units\" to it"
                )));
            }
            within_limits(&wishes)?;
            out.give(Design::new(wishes, mm_per_unit))
        })
    }
}

/// Makes a copy of a design.
///
/// Any thread, while nobody changes `design`. Free `copy` with wovenfit_design_free.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_copy(
    design: *const Design,
    copy: *mut *mut Design,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow(design, "design")?.clone();
            Out::new(copy, "copy")?.give(design)
        })
    }
}

/// The design as the JSON text of a design file in mm and kPa; read again it gives the same design.
///
/// Any thread, while nobody changes `design`.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_json(
    design: *const Design,
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let json = borrow(design, "design")?.wishes.to_json();
            fill_text(buffer, capacity, needed, &json)
        })
    }
}

/// The JSON schema (draft 2020-12) of the design file, with descriptions.
///
/// Any thread.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_schema(
    buffer: *mut c_char,
    capacity: usize,
    needed: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe { guard(error, || fill_text(buffer, capacity, needed, &json_text(&schema()))) }
}

/// Sets a number by its name in the design file: "fabric.warp", "fabric.weft", "fabric.diagonal" (all
/// N/mm), "fabric.s", "fabric.max_strain", "fabric.weft_strain" (strains, no unit),
/// "limits.max_kpa" (kPa), "piece.quantity", "piece.seam_allowance_mm", "piece.top_allowance_mm",
/// "piece.bottom_allowance_mm", "piece.edge_allowance_mm", "piece.notch_spacing_mm" (mm).
/// Ranges are the design file's (WOVENFIT_STATUS_DESIGN).
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_set_number(
    design: *mut Design,
    name: *const c_char,
    value: f64,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let name = text(name, "name")?;
            let number = serde_json::Number::from_f64(value).ok_or_else(|| {
                Failure::invalid(format!("`{name}` is {value}: give a finite number"))
            })?;
            Ok(design.wishes.set(name, Value::Number(number))?)
        })
    }
}

/// Sets a text by its name in the design file: "fabric.name", "pressure_model" ("laplace" or
/// "paper"), "facing" ("outward" or "inward"), "piece.name", "piece.reference", "piece.date",
/// "piece.material".
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_set_text(
    design: *mut Design,
    name: *const c_char,
    value: *const c_char,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            let (name, value) = (text(name, "name")?, text(value, "value")?);
            Ok(design.wishes.set(name, Value::String(value.to_owned()))?)
        })
    }
}

/// Takes a wish out so that its default holds: any name above, or "pressures", "orientation",
/// "seams", "region" (its planes), "region_faces" (its triangles), "limits.bony", "fabric", "limits",
/// "piece".
///
/// One thread at a time.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_clear(
    design: *mut Design,
    name: *const c_char,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow_mut(design, "design")?;
            Ok(design.wishes.clear(text(name, "name")?)?)
        })
    }
}

/// Number of wanted pressures.
///
/// Any thread, while nobody changes `design`.
///
/// # Safety
/// As the header's preamble says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_pressure_count(
    design: *const Design,
    count: *mut usize,
    error: *mut *mut Error,
) -> Status {
    // SAFETY: the arguments are as the header's preamble asks.
    unsafe {
        guard(error, || {
            let design = borrow(design, "design")?;
            Out::new(count, "count")?.put(design.wishes.pressures.len())
        })
    }
}

/// Frees a design; NULL is fine. Jobs started with it stay.
///
/// No other thread may be using the handle.
///
/// # Safety
/// `design` is NULL or a design that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_design_free(design: *mut Design) {
    // SAFETY: the caller gives NULL or a living object and never uses it again.
    unsafe { free(design) }
}
