//! A limb that is cut open and ready to be solved again.

use std::sync::Arc;

use wovenfit_core::Prepared as Limb;
use wovenfit_core::parameters::Parameters as Values;

use crate::failure::Failure;
use crate::guard::free;
use crate::mesh::Given;

/// A limb that is cut open: what does not change with pressures, fabric and orientation. It never
/// changes: any number of threads may use it at once.
pub struct Prepared(pub(crate) Arc<Ready>);

/// What a prepared limb holds.
pub(crate) struct Ready {
    pub(crate) limb: Limb,
    pub(crate) mesh: Arc<Given>,
}

/// Refuses parameters that say another unit than the mesh does.
pub(crate) fn agree(values: &Values, mesh: &Given) -> Result<(), Failure> {
    match values.units {
        Some(unit) if unit.millimetres() != mesh.mm_per_unit => Err(Failure::invalid(format!(
            "the parameter `units` is `{}`, {} mm, but the mesh was given with {} mm per unit: give \
             the mesh anew in its unit, or set `units` to `auto`",
            unit.symbol(),
            unit.millimetres(),
            mesh.mm_per_unit
        ))),
        _ => Ok(()),
    }
}

/// Frees a prepared limb; NULL is fine. Jobs and results made from it stay.
///
/// No other thread may be using the handle.
///
/// # Safety
/// `prepared` is NULL or an object that was not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wovenfit_prepared_free(prepared: *mut Prepared) {
    // SAFETY: the caller gives NULL or a living object and never uses it again.
    unsafe { free(prepared) }
}
