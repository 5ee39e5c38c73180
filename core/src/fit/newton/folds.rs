//! Where strains are singular.
//!
//! Where a free edge runs through a sharp fold the fabric is stretched without bound, as at the tip of a crack; what
//! triangles as large as a scan's make of it is too stiff by their size, and all that hangs on the fold turns with
//! it: the lobe of an ankle of 20,000 triangles by 1.3 mm. So triangles are to be small there.

use glam::DVec3;

use super::triangles::Wanted;
use super::{FitError, FitInput, Solver};
use crate::progress::Progress;
use crate::surface::HalfEdgeId;

/// A fold has a thread stretched to more than so many times what is wanted: an ankle's has, of 5,000 triangles as of
/// 80,000, on the same 150 mm². Where few triangles draw a wrist they stretch it as far, but not up to a free edge.
const STRETCHED: f64 = 1.3;

/// Places in the folds at free edges, if a fit on fewer vertices finds any: the middles of triangles that are stretched
/// far and hang together at corners up to a free edge.
///
/// # Errors
/// If the job is cancelled.
pub fn folds(
    solver: &Solver,
    input: &FitInput<'_>,
    free_edges: &[HalfEdgeId],
    progress: &dyn Progress,
) -> Result<Vec<DVec3>, FitError> {
    let Some(fit) = solver.draft(input, progress)? else { return Ok(Vec::new()) };
    let FitInput { disk, fabric, .. } = *input;
    let wanted = Wanted::new(&fit.targets, fabric.weft_strain);
    let mut stretched = solver.triangles.overstretched(&fit.coordinates, &wanted, STRETCHED);
    let corners = |t: usize| solver.triangles.corners_of(t);
    let mut reached = vec![false; disk.vertex_count()];
    for &h in free_edges {
        reached[disk.from(h).index()] = true;
        reached[disk.to(h).index()] = true;
    }
    let mut folds = Vec::new();
    loop {
        let (joined, others): (Vec<usize>, Vec<usize>) =
            stretched.into_iter().partition(|&t| corners(t).iter().any(|&v| reached[v]));
        if joined.is_empty() {
            break;
        }
        joined.iter().flat_map(|&t| corners(t)).for_each(|v| reached[v] = true);
        folds.extend(joined);
        stretched = others;
    }
    let middle = |t: usize| corners(t).map(|v| disk.points()[v]).iter().sum::<DVec3>() / 3.0;
    Ok(folds.into_iter().map(middle).collect())
}
