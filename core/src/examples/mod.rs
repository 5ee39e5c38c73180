//! The numerical examples of Wang & Tang (section 6), run by their own method.
//!
//! In: how fine. Out: every example's flattening, in the order of [`EXAMPLES`], and what
//! [`findings`] reads from them: whether the paper's sentences hold here, with the figures. The
//! paper's method is the diffusion on one woven model, from the initial parameterization scaled by
//! r, with the wanted strains as Eq. (3) gives them: no coarser levels first and no corrected
//! targets. Its scans and most of its pressures are not published: limbs and pressures are those
//! of [`samples`](crate::samples), so that figures can be compared in kind, not in size.

mod claims;
mod json;
mod measures;

use rayon::prelude::*;

pub use claims::{Claim, Verdict, findings};
pub use json::examples_json;
pub use measures::{Thread, Threads, course};

use crate::error::Error;
use crate::parameters::{Method, Parameters};
use crate::pipeline::{Flattening, flatten};
use crate::progress::{Progress, Stage};
use crate::samples::{SampleError, SampleOptions, sample_with};

/// How far an example goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Extent {
    /// The initial woven fitting alone: Ω at true scale, no step of the diffusion, no pressures.
    Start,
    /// To its end without wanted pressures.
    Free,
    /// To its end with the configuration's pressures.
    Pressed,
}

/// One of the paper's examples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Example {
    /// Its name in files: letters and dashes.
    pub name: &'static str,
    /// Its name on the page.
    pub title: &'static str,
    /// The sample limb.
    pub limb: &'static str,
    /// The limb's configuration.
    pub configuration: &'static str,
    /// The fabric, where the configuration is made in more than one.
    pub fabric: Option<&'static str>,
    /// How far it goes.
    pub extent: Extent,
}

const fn elbow(
    name: &'static str,
    title: &'static str,
    configuration: &'static str,
    fabric: &'static str,
    extent: Extent,
) -> Example {
    Example { name, title, limb: "elbow", configuration, fabric: Some(fabric), extent }
}

const fn other(
    name: &'static str,
    title: &'static str,
    limb: &'static str,
    extent: Extent,
) -> Example {
    Example { name, title, limb, configuration: "paper", fabric: None, extent }
}

const A: &str = "A: no pressure";
const B: &str = "B: high in the middle";
const C: &str = "C: high at one end";
const D: &str = "D: high at both ends";
const START: &str = "(a) the initial fitting";
const FREE: &str = "(b) no pressures wanted";
const PRESSED: &str = "(c) pressures wanted";

/// All of them.
pub static EXAMPLES: [Example; 15] = [
    elbow("elbow-start", START, "a", "isotropic", Extent::Start),
    elbow("elbow-isotropic-a", A, "a", "isotropic", Extent::Free),
    elbow("elbow-isotropic-b", B, "b", "isotropic", Extent::Pressed),
    elbow("elbow-isotropic-c", C, "c", "isotropic", Extent::Pressed),
    elbow("elbow-isotropic-d", D, "d", "isotropic", Extent::Pressed),
    elbow("elbow-anisotropic-a", A, "a", "anisotropic", Extent::Free),
    elbow("elbow-anisotropic-b", B, "b", "anisotropic", Extent::Pressed),
    elbow("elbow-anisotropic-c", C, "c", "anisotropic", Extent::Pressed),
    elbow("elbow-anisotropic-d", D, "d", "anisotropic", Extent::Pressed),
    other("knee-start", START, "knee", Extent::Start),
    other("knee-free", FREE, "knee", Extent::Free),
    other("knee-pressed", PRESSED, "knee", Extent::Pressed),
    other("wrist-start", START, "wrist", Extent::Start),
    other("wrist-free", FREE, "wrist", Extent::Free),
    other("wrist-pressed", PRESSED, "wrist", Extent::Pressed),
];

/// How fine the examples are computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// About how many triangles a limb has.
    pub triangles: usize,
    /// The parameters of the method.
    pub parameters: Parameters,
}

impl Default for Settings {
    /// The paper's method, at a spacing that keeps the whole a matter of minutes: steps go with the
    /// inverse square of the spacing, and so does the cost of a step.
    fn default() -> Self {
        let parameters = Parameters {
            method: Method::Diffusion,
            correct_pressures: false,
            coarse_levels: 0,
            spacing: 7.0,
            ..Parameters::default()
        };
        Self { triangles: 8_000, parameters }
    }
}

/// What became of an example.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Which.
    pub example: &'static Example,
    /// The pattern and every figure.
    pub flattening: Flattening,
}

/// Why the examples could not be computed.
#[derive(Debug, thiserror::Error)]
pub enum ExampleError {
    /// There is no such limb.
    #[error(transparent)]
    Sample(#[from] SampleError),
    /// It could not be flattened.
    #[error("the example {name} cannot be computed: {source}")]
    Flatten {
        /// Which.
        name: &'static str,
        /// Why.
        source: Box<Error>,
    },
}

/// Where the examples say how far they are; several run at a time.
pub trait Watch: Sync {
    /// An example is at work on this stage; `energy` is its fit's, in N·mm.
    fn report(&self, example: &'static Example, stage: Stage, energy: Option<f64>);

    /// An example has ended.
    fn done(&self, outcome: &Outcome);

    /// Whether all should stop with [`Error::Cancelled`].
    fn cancelled(&self) -> bool {
        false
    }
}

/// One example's progress.
struct Watched<'a> {
    watch: &'a dyn Watch,
    example: &'static Example,
}

impl Progress for Watched<'_> {
    fn report(&self, stage: Stage, _fraction: f64, energy: Option<f64>) {
        self.watch.report(self.example, stage, energy);
    }

    fn cancelled(&self) -> bool {
        self.watch.cancelled()
    }
}

/// Runs all examples, as many at a time as there are processors.
///
/// # Errors
/// If a limb cannot be made or flattened, or the job is cancelled.
pub fn run(settings: &Settings, watch: &dyn Watch) -> Result<Vec<Outcome>, ExampleError> {
    // All, so that the first error in the order of the list is the one that is told.
    let outcomes: Vec<_> = EXAMPLES
        .par_iter()
        .with_max_len(1)
        .map(|example| {
            let outcome = one(example, settings, &Watched { watch, example })?;
            watch.done(&outcome);
            Ok(outcome)
        })
        .collect();
    outcomes.into_iter().collect()
}

/// Runs one example.
fn one(
    example: &'static Example,
    settings: &Settings,
    progress: &dyn Progress,
) -> Result<Outcome, ExampleError> {
    let options = SampleOptions {
        triangles: settings.triangles,
        configuration: Some(example.configuration.to_owned()),
        fabric: example.fabric.map(str::to_owned),
        ..SampleOptions::default()
    };
    let sample = sample_with(example.limb, &options)?;
    let (mut design, mut parameters) = (sample.design, settings.parameters.clone());
    if example.extent != Extent::Pressed {
        design.pressures.clear();
    }
    if example.extent == Extent::Start {
        // Nothing is moved, and nothing scaled: the strains are those of Ω itself.
        parameters =
            Parameters { max_iterations: 0, start_warp: 1.0, start_weft: 1.0, ..parameters };
    }
    let flattening = flatten(&sample.mesh, &design, &parameters, progress)
        .map_err(|error| ExampleError::Flatten { name: example.name, source: Box::new(error) })?;
    Ok(Outcome { example, flattening })
}
