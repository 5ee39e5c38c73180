//! Step 2 of the paper: the wanted strain of every thread of the woven model.
//!
//! Every annotated point is given to its closest node; all points of one row make one equation (3)
//! for that warp thread; the strain function interpolates for the rows without points.

use std::collections::BTreeMap;

use glam::DVec3;

use super::formula::{LocalCurvature, Wish, warp_strain};
use super::strain_function::{Datum, StrainFunction};
use crate::design::{Fabric, PressureModel};
use crate::geometry::{ShapeOperator, SurfacePoint};
use crate::surface::Surface;
use crate::weave::{NodeIndex, NodeSearch, RestLengths, SpringKind, WovenModel};

/// A wanted pressure, found on the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Annotation {
    /// Where the designer put it, in mm.
    pub at: DVec3,
    /// The nearest point of the cut surface.
    pub point: SurfacePoint,
    /// Wanted normal pressure, in kPa.
    pub kpa: f64,
    /// Shape of the surface there.
    pub shape: ShapeOperator,
}

/// The wanted strain of a warp thread with annotated points.
#[derive(Debug, Clone, PartialEq)]
pub struct ThreadTarget {
    /// Its row.
    pub row: i32,
    /// Its place in [0, 1].
    pub t: f64,
    /// The annotations on it, by number.
    pub annotations: Vec<usize>,
    /// What Eq. (3) gives, before the fabric's limits; `None` where nothing on it can be pressed.
    pub wanted: Option<f64>,
    /// What is asked of the fit: `wanted` corrected by what the thread has reached so far, within
    /// the fabric's limits.
    pub asked: Option<f64>,
    /// What the strain function gives.
    pub fitted: f64,
}

/// The wanted strains of a woven model.
#[derive(Debug, Clone, PartialEq)]
pub struct Targets {
    /// Wanted length of every spring.
    pub rest: RestLengths,
    /// The strain function ε(t).
    pub function: StrainFunction,
    /// The threads with annotated points, from the lowest row.
    pub threads: Vec<ThreadTarget>,
    /// The closest node of every annotation.
    pub nodes: Vec<NodeIndex>,
    /// Every annotation as a wish on its thread.
    pub wishes: Vec<Wish>,
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
) -> Result<Targets, TargetError> {
    let (first, last) = model.row_range().ok_or(TargetError::NoFabric)?;
    let rows = f64::from((last - first).max(1));
    let parameter = |row: i32| f64::from(row - first) / rows;
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
    let mut threads: Vec<ThreadTarget> = by_row
        .into_iter()
        .map(|(row, on_it)| {
            let points: Vec<Wish> = on_it.iter().map(|&k| wishes[k]).collect();
            let wanted = warp_strain(pressure_model, fabric, &points);
            let correction = corrections.map_or(0.0, |strains| {
                on_it.iter().map(|&k| strains[k]).sum::<f64>() / on_it.len() as f64
            });
            let within = |strain: f64| strain.clamp(0.0, fabric.max_strain);
            ThreadTarget {
                row,
                t: parameter(row),
                wanted,
                asked: wanted.map(|strain| within(within(strain) + correction)),
                annotations: on_it,
                fitted: 0.0,
            }
        })
        .collect();
    let data: Vec<Datum> = threads
        .iter()
        .filter_map(|thread| thread.asked.map(|strain| Datum { t: thread.t, strain }))
        .collect();
    let closest = (row_spacing / (rows * model.spacing())).min(0.5);
    let function = StrainFunction::new(&data, fabric.max_strain, closest);
    for thread in &mut threads {
        thread.fitted = function.at(thread.t);
    }
    let strains = (first..=last).map(|row| function.at(parameter(row))).collect();
    let rest = RestLengths::new(model.spacing(), first, strains, fabric.weft_strain);
    Ok(Targets { rest, function, threads, nodes, wishes })
}

/// Direction of the thread through a node, from the neighbours on both sides where there are two.
fn thread_direction(model: &WovenModel, node: NodeIndex, di: i32, dj: i32) -> DVec3 {
    let here = model.place(node);
    let ahead = model.place(node.offset(di, dj)).or(here);
    let behind = model.place(node.offset(-di, -dj)).or(here);
    ahead.zip(behind).map_or(DVec3::ZERO, |(a, b)| a - b)
}
