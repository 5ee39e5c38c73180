//! What was reached, judged against what was asked, at every annotated point.

use glam::{DVec2, DVec3};

use super::formula::{
    FLAT_CURVATURE, LocalCurvature, Stretch, Wish, pressing_curvature, pressure_kpa, warp_strain,
};
use super::reached::{Reached, Reader};
use super::{Annotation, Targets, Woven};
use crate::design::{Fabric, PressureModel};
use crate::geometry::closest_on_triangle;
use crate::parameters::Parameters;
use crate::surface::{HalfEdgeId, Surface};
use crate::weave::{NodeIndex, WovenModel};

/// Why a wanted pressure was missed.
#[derive(Debug, Clone, PartialEq)]
pub enum Reason {
    /// The surface is flat or hollow along the thread: no tension presses there.
    FlatOrHollow {
        /// Curvature through which warp tension would press, in 1/mm.
        curvature: f64,
    },
    /// The strain needed is more than the fabric bears.
    OverStrain {
        /// Strain that this point alone would need.
        needed: f64,
        /// The fabric's limit.
        limit: f64,
    },
    /// Other points on the same thread, or on threads too close to differ, want another strain.
    ThreadConflict {
        /// Those points, by number from 0.
        others: Vec<usize>,
    },
    /// The fit was stopped before it came to rest.
    NotConverged,
    /// The point lies near a free edge of the brace, where threads find no hold.
    FreeEdge {
        /// Distance to the edge, in mm.
        distance: f64,
    },
    /// Points on neighbouring threads want another strain, and one strain cannot go over into the
    /// other in so short a way.
    NeighbourConflict {
        /// Those points, by number from 0.
        others: Vec<usize>,
    },
    /// The thread has its strain; stretched weft threads press as well.
    WeftTension {
        /// Strain of the weft thread.
        strain: f64,
        /// Pressure from it, in kPa.
        kpa: f64,
    },
    /// The thread has its strain; the curvature at the point is not that of the thread of the model
    /// nearest to it.
    BetweenThreads {
        /// Distance of the threads, in mm.
        spacing: f64,
    },
    /// The shape of the limb does not let this thread take its strain.
    Shape {
        /// Wanted strain of the thread.
        wanted: f64,
        /// Reached strain of the thread.
        reached: f64,
    },
}

impl Reason {
    /// A frozen short name.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::FlatOrHollow { .. } => "flat_or_hollow",
            Self::OverStrain { .. } => "over_strain",
            Self::ThreadConflict { .. } => "thread_conflict",
            Self::NotConverged => "not_converged",
            Self::FreeEdge { .. } => "free_edge",
            Self::NeighbourConflict { .. } => "neighbour_conflict",
            Self::WeftTension { .. } => "weft_tension",
            Self::BetweenThreads { .. } => "between_threads",
            Self::Shape { .. } => "shape",
        }
    }

    /// What it means and what can be done, for people.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::FlatOrHollow { curvature } => format!(
                "the limb is flat or hollow along the thread here (curvature {:.1} per m), so no \
                 tension presses: use a pad under the brace, or ask elsewhere",
                1000.0 * curvature
            ),
            Self::OverStrain { needed, limit } => format!(
                "it needs a strain of {needed:.2}, and this fabric bears {limit:.2}: take a \
                 stiffer fabric or ask less"
            ),
            Self::ThreadConflict { others } => format!(
                "{} on the same thread: a thread has one strain all round the limb",
                wants_another(others)
            ),
            Self::NeighbourConflict { others } => format!(
                "{} too near to this thread: the fabric cannot change its strain in so short a \
                 way; ask for more where it presses too much and for less where too little, or \
                 move the points apart",
                wants_another(others)
            ),
            Self::WeftTension { strain, kpa } => format!(
                "the weft threads are stretched by {:.1} % here and press with {kpa:.2} kPa of \
                 their own: ask less, or take a fabric softer along the limb",
                100.0 * strain
            ),
            Self::BetweenThreads { spacing } => format!(
                "the thread has the strain asked of it, but the limb's curvature changes from one \
                 thread of the model to the next here: use a spacing below {spacing} mm"
            ),
            Self::NotConverged => "the fit was stopped before it came to rest: allow more \
                                   iterations"
                .to_owned(),
            Self::FreeEdge { distance } => format!(
                "it lies {distance:.0} mm from the brace's free edge: move it inward or let the \
                 brace reach further"
            ),
            Self::Shape { wanted, reached } => format!(
                "the limb's shape does not let this thread take its strain: {reached:.3} instead \
                 of {wanted:.3}; a seam or dart nearby would free it"
            ),
        }
    }
}

/// "point 2 wants another strain", "points 2 and 5 want another strain".
fn wants_another(others: &[usize]) -> String {
    let names: Vec<String> = others.iter().map(|k| (k + 1).to_string()).collect();
    match names.as_slice() {
        [one] => format!("point {one} wants another strain"),
        many => format!("points {} want another strain", many.join(" and ")),
    }
}

/// What was reached at an annotated point.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// Computed pressure with one tension along each thread (Lemma 3), in kPa; with the paper's
    /// formula Eq. (2) from the closest node's own springs.
    pub got_kpa: f64,
    /// Computed pressure from the fit's own strains, averaged over the curvature radius, in kPa.
    pub got_local_kpa: f64,
    /// Curvature along the threads as they run now.
    pub curvature: LocalCurvature,
    /// Strain of the warp thread through the point.
    pub warp_strain: f64,
    /// Strain of the weft thread through the point.
    pub weft_strain: f64,
    /// Place in the pattern, in mm.
    pub place: DVec2,
    /// Why it was missed; `None` where it was met.
    pub reason: Option<Reason>,
}

/// A thread has its strain within this fraction.
const SAME_STRAIN: f64 = 0.03;

/// Over this distance along the limb, in mm, the fabric's shear makes neighbouring threads alike.
const NEIGHBOURHOOD: f64 = 60.0;

/// A neighbour that misses by more than this fraction in the other direction is drawn by this one: as much as
/// corrected pressures may be off.
const OPPOSITE_MISS: f64 = 0.02;

/// A pressure is never called missed by less than this, in kPa: below what a sensor under a brace
/// resolves (0.5 mmHg is 0.07 kPa).
const LEAST_MISS_KPA: f64 = 0.05;

/// The fitted brace that is judged.
#[derive(Clone, Copy)]
pub struct Brace<'a> {
    /// The cut surface.
    pub disk: &'a Surface,
    /// Pattern coordinates by vertex, in mm.
    pub coordinates: &'a [DVec2],
    /// The boundary half-edges that are not sewn.
    pub free_edges: &'a [HalfEdgeId],
    /// The woven nodes, where the fit has them.
    pub woven: Option<&'a Woven>,
    /// Distance of neighbouring threads at rest, in mm.
    pub spacing: f64,
    /// The wanted strains.
    pub targets: &'a Targets,
    /// Whether the fit came to rest.
    pub converged: bool,
}

/// Judges every annotation.
#[must_use]
pub fn judge(
    brace: &Brace<'_>,
    annotations: &[Annotation],
    fabric: &Fabric,
    pressure_model: PressureModel,
    parameters: &Parameters,
) -> Vec<Judgement> {
    let radius = parameters.curvature_radius;
    let reached = Reader::new(brace.disk, annotations, radius).read(brace.coordinates);
    let got: Vec<f64> = reached
        .iter()
        .enumerate()
        .map(|(k, reached)| {
            let stretch = match (pressure_model, brace.woven) {
                (PressureModel::Paper, Some(woven)) => {
                    springs_at(&woven.model, woven.nodes[k]).unwrap_or(reached.threads)
                }
                _ => reached.threads,
            };
            pressure_kpa(pressure_model, fabric, &reached.curvature, &stretch)
        })
        .collect();
    (0..annotations.len())
        .map(|k| {
            judge_one(brace, annotations, &reached, &got, k, fabric, pressure_model, parameters)
        })
        .collect()
}

#[expect(clippy::too_many_arguments, reason = "one private caller, and every one is evidence")]
fn judge_one(
    brace: &Brace<'_>,
    annotations: &[Annotation],
    reached: &[Reached],
    got: &[f64],
    k: usize,
    fabric: &Fabric,
    pressure_model: PressureModel,
    parameters: &Parameters,
) -> Judgement {
    let annotation = &annotations[k];
    let Reached { place, curvature, threads, local } = reached[k];
    let got_local_kpa = pressure_kpa(pressure_model, fabric, &curvature, &local);
    let most = (parameters.miss_tolerance * annotation.kpa).max(LEAST_MISS_KPA);
    let reason = ((got[k] - annotation.kpa).abs() > most)
        .then(|| why(brace, annotations, reached, got, k, fabric, pressure_model, parameters));
    Judgement {
        got_kpa: got[k],
        got_local_kpa,
        curvature,
        warp_strain: threads.warp,
        weft_strain: threads.weft,
        place,
        reason,
    }
}

/// Mean strains of the (at most four) warp and weft springs at a node, as in Eq. (2).
fn springs_at(model: &WovenModel, node: NodeIndex) -> Option<Stretch> {
    let here = model.place(node)?;
    let mean = |di: i32, dj: i32| {
        let strains: Vec<f64> = [1, -1]
            .into_iter()
            .filter_map(|sign| model.place(node.offset(sign * di, sign * dj)))
            .map(|other| here.distance(other) / model.spacing() - 1.0)
            .collect();
        (!strains.is_empty()).then(|| strains.iter().sum::<f64>() / strains.len() as f64)
    };
    Some(Stretch::without_shear(mean(0, 1)?, mean(1, 0)?))
}

#[expect(clippy::too_many_arguments, reason = "one private caller, and every one is evidence")]
fn why(
    brace: &Brace<'_>,
    annotations: &[Annotation],
    places: &[Reached],
    got: &[f64],
    k: usize,
    fabric: &Fabric,
    pressure_model: PressureModel,
    parameters: &Parameters,
) -> Reason {
    let curvature = &places[k].curvature;
    let (reached, weft) = (places[k].threads.warp, places[k].threads.weft);
    let pressing = pressing_curvature(pressure_model, curvature);
    if pressing <= FLAT_CURVATURE {
        return Reason::FlatOrHollow { curvature: pressing };
    }
    let targets = brace.targets;
    let needs = |wish: Wish| warp_strain(pressure_model, fabric, &[wish]);
    let needed = needs(Wish { curvature: *curvature, ..targets.wishes[k] }).unwrap_or(0.0);
    if needed > fabric.max_strain {
        return Reason::OverStrain { needed, limit: fabric.max_strain };
    }
    // Below a hundredth of strain two wishes are one.
    let differs = |a: f64, b: f64| (a - b).abs() > (parameters.miss_tolerance * a).max(0.01);
    // Woven threads lie a whole number of cells apart.
    let apart = |other: usize| match brace.woven {
        Some(woven) => f64::from((woven.nodes[other].i - woven.nodes[k].i).abs()) * brace.spacing,
        None => (places[other].place.y - places[k].place.y).abs(),
    };
    let wanting_else = |farthest: f64, pulls: &dyn Fn(f64) -> bool| -> Vec<usize> {
        (0..annotations.len())
            .filter(|&other| other != k && apart(other) <= farthest)
            .filter(|&other| {
                needs(targets.wishes[other])
                    .is_some_and(|strain| differs(needed, strain) && pulls(strain - needed))
            })
            .collect()
    };
    let given = targets.given(k).unwrap_or(0.0);
    let others = wanting_else(parameters.row_spacing, &|_| true);
    if !others.is_empty() && differs(needed, given) {
        return Reason::ThreadConflict { others };
    }
    if !brace.converged {
        return Reason::NotConverged;
    }
    let distance = distance_to_edges(brace, annotations[k].point.position(brace.disk));
    if distance < parameters.curvature_radius {
        return Reason::FreeEdge { distance };
    }
    let off = reached - given;
    let over = got[k] - annotations[k].kpa;
    let as_given = off.abs() <= SAME_STRAIN * given;
    if as_given {
        let stretch = Stretch::without_shear(reached, weft);
        let slack = Stretch { weft: 0.0, ..stretch };
        let from_weft = pressure_kpa(pressure_model, fabric, curvature, &stretch)
            - pressure_kpa(pressure_model, fabric, curvature, &slack);
        if over > 0.0 && from_weft > 0.5 * over {
            return Reason::WeftTension { strain: weft, kpa: from_weft };
        }
        if brace.woven.is_some() {
            return Reason::BetweenThreads { spacing: brace.spacing };
        }
    } else {
        let others = wanting_else(NEIGHBOURHOOD, &|toward| toward * off > 0.0);
        if !others.is_empty() {
            return Reason::NeighbourConflict { others };
        }
    }
    // Where the targets were left for each other's sake, one has too much and the other too little.
    let others: Vec<usize> = (0..annotations.len())
        .filter(|&other| other != k && apart(other) <= NEIGHBOURHOOD)
        .filter(|&other| {
            let Annotation { kpa, .. } = annotations[other];
            let opposite = (kpa - got[other]) * over.signum();
            opposite > OPPOSITE_MISS * kpa
                && needs(targets.wishes[other]).is_some_and(|strain| (strain - needed) * over > 0.0)
        })
        .collect();
    if !others.is_empty() {
        return Reason::NeighbourConflict { others };
    }
    // A corrected target that was taken as it is says nothing: what the wish needs does.
    Reason::Shape { wanted: if as_given { needed } else { given }, reached }
}

/// Distance in space from a place to the nearest free edge, in mm.
fn distance_to_edges(brace: &Brace<'_>, place: DVec3) -> f64 {
    brace
        .free_edges
        .iter()
        .map(|&h| {
            let (a, b) = (brace.disk.point(brace.disk.from(h)), brace.disk.point(brace.disk.to(h)));
            // A triangle that has shrunk to the edge.
            let w = closest_on_triangle(place, [a, b, b]);
            place.distance(w.x * a + (w.y + w.z) * b)
        })
        .fold(f64::INFINITY, f64::min)
}
