//! The wanted strains of a woven model: of every row and, with Eqs. (5)–(7), of every spring.
//!
//! Every annotated point is given to its closest node; all points of one row make one equation (3)
//! for that warp thread.

use std::collections::BTreeMap;

use glam::DVec3;

use super::formula::{LocalCurvature, Wish, warp_strain};
use super::targets::{Annotation, Targets, ThreadTarget};
use crate::design::{Fabric, PressureModel};
use crate::surface::Surface;
use crate::weave::{NodeIndex, NodeSearch, RestLengths, SpringKind, WovenModel};

/// The wanted strains of a woven model.
#[derive(Debug, Clone, PartialEq)]
pub struct WovenTargets {
    /// By thread.
    pub targets: Targets,
    /// Wanted length of every spring.
    pub rest: RestLengths,
    /// The closest node of every annotation.
    pub nodes: Vec<NodeIndex>,
}

/// A woven model at rest, with the node that stands for each annotation.
#[derive(Debug, Clone, PartialEq)]
pub struct Woven {
    /// The nodes.
    pub model: WovenModel,
    /// The closest node of every annotation.
    pub nodes: Vec<NodeIndex>,
}

/// An annotation that no thread passes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TargetError {
    /// The woven model has no node.
    #[error("the surface is too small for a single cell of the fabric: use a smaller `spacing`")]
    NoFabric,
    /// No node near an annotated point.
    #[error(
        "pressure {number} at ({:.1}, {:.1}, {:.1}) mm has no thread within {limit:.0} mm: use a \
         smaller `spacing`",
        at.x, at.y, at.z
    )]
    NoThread {
        /// Number of the annotation, from 1 as people count.
        number: usize,
        /// Where it is, in mm.
        at: DVec3,
        /// How far was searched, in mm.
        limit: f64,
    },
}

/// The wanted strains for these annotations; `row_spacing` in mm is the distance of threads below
/// which strains are smoothed. With `corrections`, by annotation, these are added to the wanted
/// strain, and Eq. (3) takes the strain that the weft threads really have; without, the paper's
/// Lemma 4 stands and they have the fabric's.
///
/// # Errors
/// If there is no fabric, or none near an annotation.
pub fn target_strains(
    surface: &Surface,
    model: &WovenModel,
    annotations: &[Annotation],
    fabric: &Fabric,
    pressure_model: PressureModel,
    row_spacing: f64,
    corrections: Option<&[f64]>,
) -> Result<WovenTargets, TargetError> {
    let (first, last) = model.row_range().ok_or(TargetError::NoFabric)?;
    let search = NodeSearch::new(surface, model);
    let limit = 8.0 * model.spacing();
    let mut nodes = Vec::with_capacity(annotations.len());
    let mut curvatures = Vec::with_capacity(annotations.len());
    let mut by_row: BTreeMap<i32, Vec<usize>> = BTreeMap::new();
    for (k, annotation) in annotations.iter().enumerate() {
        let (slot, _) = search.closest(&annotation.point, limit).ok_or(TargetError::NoThread {
            number: k + 1,
            at: annotation.at,
            limit,
        })?;
        let node = model.index(slot);
        let warp = thread_direction(model, node, 0, 1);
        let weft = thread_direction(model, node, 1, 0);
        nodes.push(node);
        curvatures.push(LocalCurvature {
            warp: annotation.shape.normal_curvature(warp),
            weft: annotation.shape.normal_curvature(weft),
            mean: annotation.shape.mean(),
        });
        by_row.entry(node.i).or_default().push(k);
    }
    let wishes: Vec<Wish> = (0..annotations.len())
        .map(|k| Wish {
            kpa: annotations[k].kpa,
            curvature: curvatures[k],
            weft_strain: match corrections {
                Some(_) => model
                    .thread_strain(SpringKind::Weft, nodes[k].j)
                    .map_or(fabric.weft_strain, |(strain, _)| strain),
                None => fabric.weft_strain,
            },
        })
        .collect();
    let spacing = model.spacing();
    let threads: Vec<ThreadTarget> = by_row
        .into_iter()
        .map(|(row, on_it)| {
            let points: Vec<Wish> = on_it.iter().map(|&k| wishes[k]).collect();
            let wanted = warp_strain(pressure_model, fabric, &points);
            let correction = corrections.map_or(0.0, |strains| {
                on_it.iter().map(|&k| strains[k]).sum::<f64>() / on_it.len() as f64
            });
            let within = |strain: f64| strain.clamp(0.0, fabric.max_strain);
            ThreadTarget {
                y: f64::from(row) * spacing,
                t: 0.0,
                wanted,
                asked: wanted.map(|strain| within(within(strain) + correction)),
                annotations: on_it,
                fitted: 0.0,
            }
        })
        .collect();
    let extent = [first, last.max(first + 1)].map(|row| f64::from(row) * spacing);
    let targets = Targets::new(threads, wishes, extent, fabric.max_strain, row_spacing, false);
    let rows = f64::from((last - first).max(1));
    let strains =
        (first..=last).map(|row| targets.function.at(f64::from(row - first) / rows)).collect();
    let rest = RestLengths::new(spacing, first, strains, fabric.weft_strain);
    Ok(WovenTargets { targets, rest, nodes })
}

/// Direction of the thread through a node, from the neighbours on both sides where there are two.
fn thread_direction(model: &WovenModel, node: NodeIndex, di: i32, dj: i32) -> DVec3 {
    let here = model.place(node);
    let ahead = model.place(node.offset(di, dj)).or(here);
    let behind = model.place(node.offset(-di, -dj)).or(here);
    ahead.zip(behind).map_or(DVec3::ZERO, |(a, b)| a - b)
}
