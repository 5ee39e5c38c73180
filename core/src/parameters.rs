//! The one table of parameters: name, unit, range, default, one line, one paragraph.
//!
//! The command line's flags, the hosts' dialogs and the documentation are made from
//! [`PARAMETERS`]; a parameter exists once. What the designer wants of one brace (fabric,
//! pressures, seams) is no parameter: see [`Design`](crate::design::Design).

use std::ops::RangeInclusive;

use crate::units::LengthUnit;

/// How the woven model is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Pattern coordinates of the surface's vertices, moved by Newton steps: for every use.
    Newton,
    /// The paper's reference: woven nodes on the surface, moved along geodesics by diffusion.
    Diffusion,
}

/// How curvature is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurvatureEstimate {
    /// A quadric over `curvature_radius`: for scans.
    Scale,
    /// Meyer et al. (2002) on the triangles round a vertex: for clean, smooth meshes only.
    Meyer,
}

/// Whether a noisy scan is smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Denoise {
    /// If its noise is large enough to matter.
    Auto,
    /// Never.
    Off,
}

/// What a parameter may be.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A number in a closed range.
    Number(RangeInclusive<f64>),
    /// A whole number in a closed range.
    Integer(RangeInclusive<u64>),
    /// On or off.
    Switch,
    /// One of these names.
    Choice(Vec<&'static str>),
}

/// A row of the table.
#[derive(Debug)]
pub struct Parameter {
    /// Its name in snake case; on the command line with dashes.
    pub name: &'static str,
    /// Its unit, empty where it has none.
    pub unit: &'static str,
    /// What it may be.
    pub kind: Kind,
    /// What it does, in one line.
    pub summary: &'static str,
    /// When and why to change it, in a paragraph.
    pub text: &'static str,
    get: fn(&Parameters) -> String,
    set: fn(&mut Parameters, &str) -> Result<(), String>,
}

/// A value that a parameter cannot take.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ParameterError {
    /// No parameter has this name.
    #[error("there is no parameter `{name}`; the nearest name is `{nearest}`")]
    Unknown {
        /// The name given.
        name: String,
        /// The known name nearest to it.
        nearest: &'static str,
    },
    /// The value is not one that the parameter can take.
    #[error("parameter `{name}` cannot be `{value}`: {remedy}")]
    Value {
        /// The parameter.
        name: &'static str,
        /// The value given.
        value: String,
        /// What it may be.
        remedy: String,
    },
}

trait ParameterValue: Sized {
    fn parse(text: &str, kind: &Kind) -> Result<Self, String>;
    fn show(&self) -> String;
}

impl ParameterValue for f64 {
    fn parse(text: &str, kind: &Kind) -> Result<Self, String> {
        let Kind::Number(range) = kind else { unreachable!("the table pairs f64 with Number") };
        let remedy = || format!("give a number from {} to {}", range.start(), range.end());
        let value: Self = text.trim().parse().map_err(|_| remedy())?;
        if range.contains(&value) { Ok(value) } else { Err(remedy()) }
    }

    fn show(&self) -> String {
        self.to_string()
    }
}

impl ParameterValue for u64 {
    fn parse(text: &str, kind: &Kind) -> Result<Self, String> {
        let Kind::Integer(range) = kind else { unreachable!("the table pairs u64 with Integer") };
        let remedy = || format!("give a whole number from {} to {}", range.start(), range.end());
        let value: Self = text.trim().parse().map_err(|_| remedy())?;
        if range.contains(&value) { Ok(value) } else { Err(remedy()) }
    }

    fn show(&self) -> String {
        self.to_string()
    }
}

impl ParameterValue for bool {
    fn parse(text: &str, _kind: &Kind) -> Result<Self, String> {
        text.trim().parse().map_err(|_| "give `true` or `false`".to_owned())
    }

    fn show(&self) -> String {
        self.to_string()
    }
}

fn choose<T: Copy>(text: &str, choices: &[(&'static str, T)]) -> Result<T, String> {
    choices.iter().find(|(name, _)| *name == text.trim()).map(|(_, value)| *value).ok_or_else(
        || {
            let names: Vec<String> = choices.iter().map(|(name, _)| format!("`{name}`")).collect();
            format!("give one of {}", names.join(", "))
        },
    )
}

fn chosen<T: Copy + PartialEq>(value: T, choices: &[(&'static str, T)]) -> String {
    choices
        .iter()
        .find(|(_, v)| *v == value)
        .map_or_else(String::new, |(name, _)| (*name).to_owned())
}

const METHODS: [(&str, Method); 2] = [("newton", Method::Newton), ("diffusion", Method::Diffusion)];

const ESTIMATES: [(&str, CurvatureEstimate); 2] =
    [("scale", CurvatureEstimate::Scale), ("meyer", CurvatureEstimate::Meyer)];

const DENOISE: [(&str, Denoise); 2] = [("auto", Denoise::Auto), ("off", Denoise::Off)];

const UNITS: [(&str, Option<LengthUnit>); 5] = [
    ("auto", None),
    ("mm", Some(LengthUnit::Millimetre)),
    ("cm", Some(LengthUnit::Centimetre)),
    ("m", Some(LengthUnit::Metre)),
    ("in", Some(LengthUnit::Inch)),
];

macro_rules! choice_value {
    ($type:ty, $choices:expr) => {
        impl ParameterValue for $type {
            fn parse(text: &str, _kind: &Kind) -> Result<Self, String> {
                choose(text, &$choices)
            }

            fn show(&self) -> String {
                chosen(*self, &$choices)
            }
        }
    };
}

choice_value!(Method, METHODS);
choice_value!(Denoise, DENOISE);
choice_value!(CurvatureEstimate, ESTIMATES);
choice_value!(Option<LengthUnit>, UNITS);

fn names<T>(choices: &[(&'static str, T)]) -> Kind {
    Kind::Choice(choices.iter().map(|(name, _)| *name).collect())
}

macro_rules! parameters {
    ($( $name:ident: $type:ty = $default:expr, $unit:literal, $kind:expr,
        $summary:literal, $text:literal; )+) => {
        /// A value for every parameter of [`PARAMETERS`]; `Default` gives the table's defaults.
        #[derive(Debug, Clone, PartialEq)]
        pub struct Parameters {
            $(
                #[doc = $summary]
                #[doc = ""]
                #[doc = $text]
                pub $name: $type,
            )+
        }

        impl Default for Parameters {
            fn default() -> Self {
                Self { $( $name: $default, )+ }
            }
        }

        /// The table, in the order in which dialogs show it.
        pub static PARAMETERS: std::sync::LazyLock<Vec<Parameter>> =
            std::sync::LazyLock::new(|| vec![
                $( Parameter {
                    name: stringify!($name),
                    unit: $unit,
                    kind: $kind,
                    summary: $summary,
                    text: $text,
                    get: |p| p.$name.show(),
                    set: |p, text| {
                        p.$name = ParameterValue::parse(text, &$kind)?;
                        Ok(())
                    },
                }, )+
            ]);
    };
}

parameters! {
    units: Option<LengthUnit> = None, "", names(&UNITS),
        "Unit of the surface's coordinates.",
        "A mesh file does not say its unit. `auto` takes the design's unit, or millimetres, and \
         refuses a limb whose girth is outside 60 to 1500 mm with the likely unit named; a unit \
         given here is believed.";
    keep_largest: bool = false, "", Kind::Switch,
        "Drop all components but the largest.",
        "Scans carry crumbs: bits of table, hair or noise. Without this they are an error that \
         lists them.";
    close_holes: f64 = 30.0, "mm", Kind::Number(0.0..=200.0),
        "Close holes of the scan whose rim is at most this long.",
        "Small holes are gaps of the scanner and are closed; longer rims are openings of the \
         brace (its two ends, a thumb hole) and stay. 0 closes none.";
    denoise: Denoise = Denoise::Auto, "", names(&DENOISE),
        "Whether a noisy scan is smoothed.",
        "`auto` measures the scan's noise; above 0.05 mm the surface is smoothed over \
         `curvature_radius`, and curvature is read over a larger radius if the noise would \
         otherwise blur it; both are said. Noise makes a limb's lengths too long and its curvature, \
         and with it the pattern, a matter of chance. `off` takes the scan as it is.";
    curvature: CurvatureEstimate = CurvatureEstimate::Scale, "", names(&ESTIMATES),
        "How the curvature of the surface is estimated.",
        "`scale` fits a quadric over `curvature_radius`, exact on cylinders and spheres and calm \
         on scans. `meyer` uses only the triangles round a vertex (Meyer et al. 2002): exact in \
         the limit on clean meshes, noise on scans.";
    curvature_radius: f64 = 10.0, "mm", Kind::Number(2.0..=50.0),
        "Radius over which curvature is estimated.",
        "Pressure is tension times curvature, so this is the scale at which pressure is stated. A \
         smaller radius follows bony crests and the scanner's noise alike; a larger one smooths \
         both away.";
    method: Method = Method::Newton, "", names(&METHODS),
        "How the fabric is fitted.",
        "`newton` moves the pattern coordinates of the surface's vertices to the minimum of the \
         paper's energy, with seams that can be sewn. `diffusion` is the paper's method, the \
         reference: woven nodes on the surface, moved along geodesics; far slower, and its seams \
         do not match.";
    newton_tolerance: f64 = 0.01, "mm", Kind::Number(1e-9..=1.0),
        "Converged when a whole Newton step moves no point of the pattern farther than this.",
        "The step is the gradient of the energy scaled by its Hessian: what is still missing to \
         the minimum. A pattern is cut to some tenths of a millimetre.";
    newton_steps: u64 = 100, "", Kind::Integer(1..=10_000),
        "Most Newton steps of all vertices.",
        "The sample limbs need three to thirty; those on fewer vertices with which a fit begins are not counted. \
         A run that hits it says `not converged` in the table, the report and the warnings.";
    equal_seams: bool = true, "", Kind::Switch,
        "Hold sewn edges at equal lengths in the pattern.",
        "Without it the two sides of a seam come out up to a fifth apart, and the pattern cannot \
         be sewn without easing. It costs some per cent more energy; the report says how much. \
         The diffusion cannot do it.";
    spacing: f64 = 5.0, "mm", Kind::Number(0.5..=30.0),
        "Distance between neighbouring threads of the woven model at rest.",
        "The model's threads stand for many real ones. With `diffusion` halving it follows the \
         shape more closely and takes about sixteen times as long. With `newton` it is only the \
         length over which a shortened thread is kept from buckling, and points closer than half \
         of it along weft share a thread.";
    start_warp: f64 = 0.75, "", Kind::Number(0.4..=1.0),
        "Scale of the initial parameterization along warp.",
        "The paper's r: the fabric starts stretched along warp, because springs settle more \
         easily from tension than from compression.";
    start_weft: f64 = 1.0, "", Kind::Number(0.4..=1.0),
        "Scale of the initial parameterization along weft.",
        "The paper leaves the weft direction as it is.";
    damping: f64 = 0.125, "", Kind::Number(0.01..=0.2),
        "Step of the diffusion, λ times the largest stiffness.",
        "λ = damping / max(k_warp, k_weft), Eq. (13). Larger is faster until the threads begin to \
         swing.";
    steps_per_pass: u64 = 50, "", Kind::Integer(1..=1000),
        "Diffusion steps between two determinations of the strains.",
        "After every pass the annotated points are assigned to their closest nodes anew, the \
         strain function is rebuilt, the fabric's edge is repaired and the markers are brought \
         back to a vertical line.";
    coarse_levels: u64 = 2, "", Kind::Integer(0..=4),
        "Coarser woven models fitted first.",
        "Each level doubles the spacing. Diffusion moves a disturbance one node a step, so a \
         coarse model finds the overall shape in far fewer steps.";
    strain_tolerance: f64 = 0.001, "", Kind::Number(1e-6..=0.1),
        "Converged when the root mean square strain difference falls below this.",
        "The threshold on E_SSD (Eq. 14) stated per spring: E_SSD⁰ = tolerance² × number of warp \
         and weft springs. On a doubly curved limb it is never reached and the plateau decides.";
    plateau: f64 = 0.01, "per 1000 steps", Kind::Number(1e-5..=1.0),
        "Converged when the energy falls more slowly than this fraction.",
        "Measured over a thousand steps at a spacing of 5 mm, and as many more or fewer as other \
         spacings and stiffer wefts need for the same change. 0.001 is a strict plateau, \
         some ten times longer for a difference of the order of 1 % of the energy.";
    max_iterations: u64 = 100_000, "", Kind::Integer(1..=10_000_000),
        "Most diffusion steps, all levels together.",
        "A run that hits it says `not converged` in the table, the report and the warnings.";
    row_spacing: f64 = 10.0, "mm", Kind::Number(0.0..=100.0),
        "Threads with wanted pressures closer than this are smoothed, not interpolated.",
        "A curve through two different strains a few millimetres apart swings far beyond both. \
         Closer threads are fitted by smoothed least squares and the residual is shown.";
    correct_pressures: bool = true, "", Kind::Switch,
        "Correct the wanted strain of a thread from the strain that it takes.",
        "On a doubly curved limb the fit leaves each thread a little off its wanted strain. With \
         this the fit asks for less or more until the thread as a whole has it; without, it is \
         the paper's method unchanged.";
    miss_tolerance: f64 = 0.05, "", Kind::Number(0.001..=0.5),
        "A pressure counts as missed when it is off by more than this fraction.",
        "Below it the table gives no reason. A difference under 0.05 kPa never counts.";
    girth_step: f64 = 20.0, "mm", Kind::Number(1.0..=200.0),
        "Distance between two measured girths.",
        "Along the limb's centre line, from the end near the body.";
}

impl Parameter {
    /// The default, as text.
    #[must_use]
    pub fn default_text(&self) -> String {
        (self.get)(&Parameters::default())
    }
}

impl Parameters {
    /// Sets the parameter `name` from text.
    ///
    /// # Errors
    /// If there is no such parameter or it cannot take the value.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), ParameterError> {
        let parameter = find(name)?;
        (parameter.set)(self, value).map_err(|remedy| ParameterError::Value {
            name: parameter.name,
            value: value.to_owned(),
            remedy,
        })
    }

    /// The value of the parameter `name` as text.
    ///
    /// # Errors
    /// If there is no such parameter.
    pub fn get(&self, name: &str) -> Result<String, ParameterError> {
        Ok((find(name)?.get)(self))
    }
}

fn find(name: &str) -> Result<&'static Parameter, ParameterError> {
    PARAMETERS.iter().find(|p| p.name == name).ok_or_else(|| ParameterError::Unknown {
        name: name.to_owned(),
        nearest: nearest_name(name, PARAMETERS.iter().map(|p| p.name)).unwrap_or_default(),
    })
}

/// The candidate most like `name`, for messages about a misspelt one.
pub(crate) fn nearest_name<'a>(
    name: &str,
    candidates: impl Iterator<Item = &'a str>,
) -> Option<&'a str> {
    candidates.min_by_key(|candidate| strsim::damerau_levenshtein(name, candidate))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_default_is_in_its_range_and_survives_text() {
        for parameter in PARAMETERS.iter() {
            let mut p = Parameters::default();
            p.set(parameter.name, &parameter.default_text()).unwrap();
            assert_eq!(p, Parameters::default(), "{}", parameter.name);
            assert!(parameter.summary.ends_with('.') && parameter.text.ends_with('.'));
        }
    }

    #[test]
    fn a_wrong_value_names_the_parameter_and_the_remedy() {
        let mut p = Parameters::default();
        let message = |e: ParameterError| e.to_string();
        assert_eq!(
            message(p.set("spacing", "0").unwrap_err()),
            "parameter `spacing` cannot be `0`: give a number from 0.5 to 30"
        );
        assert_eq!(
            message(p.set("units", "ft").unwrap_err()),
            "parameter `units` cannot be `ft`: give one of `auto`, `mm`, `cm`, `m`, `in`"
        );
        assert_eq!(
            message(p.set("spaceing", "4").unwrap_err()),
            "there is no parameter `spaceing`; the nearest name is `spacing`"
        );
        assert!(p.set("spacing", "NaN").is_err());
    }
}
