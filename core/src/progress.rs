//! Progress of a long job, and its cancelling.

/// The stages of [`flatten`](crate::flatten), in the order in which they run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Checking and repairing the surface.
    Surface,
    /// Keeping the region that the brace covers.
    Region,
    /// Cutting the region open into a disk.
    Cut,
    /// The initial planar parameterization Ω.
    Parameterization,
    /// Curvature at the annotated points.
    Curvature,
    /// Moving the fabric to its place.
    Fit,
    /// Interpolating the surface-plane mapping.
    Mapping,
    /// Outline, seams and the judgement of what was reached.
    Report,
}

impl Stage {
    /// A short name for people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Surface => "surface",
            Self::Region => "region",
            Self::Cut => "cut",
            Self::Curvature => "curvature",
            Self::Parameterization => "parameterization",
            Self::Fit => "fit",
            Self::Mapping => "mapping",
            Self::Report => "report",
        }
    }
}

/// Where a running job says how far it is and asks whether to go on.
///
/// Called from the thread that runs the job, several times a second.
pub trait Progress: Sync {
    /// `fraction` of the stage is done, in `[0, 1]`; `energy` is the fit's energy in N·mm.
    fn report(&self, stage: Stage, fraction: f64, energy: Option<f64>);

    /// Whether the job should stop with [`Error::Cancelled`](crate::Error::Cancelled).
    fn cancelled(&self) -> bool {
        false
    }
}

/// Nobody watches and nobody cancels.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _stage: Stage, _fraction: f64, _energy: Option<f64>) {}
}

/// `f` over all items, some thousand at a time, with the number of the first of them, and a question before
/// each; none if the job is cancelled.
pub(crate) fn in_parts<T, R>(
    items: &[T],
    progress: &dyn Progress,
    f: impl Fn(usize, &[T]) -> Vec<R>,
) -> Option<Vec<R>> {
    /// Few enough for several questions a second, enough for all threads.
    const PART: usize = 1024;
    let mut all = Vec::with_capacity(items.len());
    for (k, part) in items.chunks(PART).enumerate() {
        if progress.cancelled() {
            return None;
        }
        all.extend(f(k * PART, part));
    }
    Some(all)
}
