//! Procedural limbs of real size, for demonstrations and tests.
//!
//! Each limb is a smooth closed-form map from (station along the limb, angle round it) to space
//! with designs that suit it, a file a limb. They are plausible, not anatomical: no bone, no
//! tendon, no person was measured. For figures about people use scans.

mod ankle;
mod elbow;
mod forearm;
mod knee;
mod noise;
mod opening;
mod shape;
#[cfg(test)]
mod tests;
mod tube;
mod wishes;
mod wrist;

pub use wishes::Configuration;

use crate::design::Design;
use crate::parameters::nearest_name;
use crate::surface::RawMesh;
use wishes::Specimen;

static SPECIMENS: [Specimen; 5] =
    [elbow::SPECIMEN, knee::SPECIMEN, wrist::SPECIMEN, ankle::SPECIMEN, forearm::SPECIMEN];

/// The names of the limbs.
pub const NAMES: &[&str] = &{
    let mut names = [""; SPECIMENS.len()];
    let mut k = 0;
    while k < names.len() {
        names[k] = SPECIMENS[k].name;
        k += 1;
    }
    names
};

/// Fewest triangles of a sample: below, the elbow's features fall between the vertices.
pub const MIN_TRIANGLES: usize = 500;

/// Most triangles of a sample.
pub const MAX_TRIANGLES: usize = 2_000_000;

/// Most noise of a sample, in mm: more than any scanner that is fit for the purpose.
pub const MAX_NOISE_MM: f64 = 2.0;

/// A procedural limb and a design for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The limb in mm: triangles, counter-clockwise seen from outside, that share vertices.
    pub mesh: RawMesh,
    /// Wanted pressures on the limb's noiseless surface, a fabric and orientation markers.
    pub design: Design,
}

/// What sample is wanted of a limb.
#[derive(Debug, Clone, PartialEq)]
pub struct SampleOptions {
    /// About how many triangles (within 10 %).
    pub triangles: usize,
    /// Deviation of Gaussian noise along the normal, as a scanner would add, in mm.
    pub noise_mm: f64,
    /// Whether to cut the opening that some limbs can have: the wrist one for the thumb.
    pub opening: bool,
    /// The name of one of the paper's examples on this limb (see [`configurations`]); `None` for
    /// a design that is reachable by Laplace's law.
    pub configuration: Option<String>,
    /// The name of one of the configuration's fabrics; `None` for its first.
    pub fabric: Option<String>,
}

impl Default for SampleOptions {
    fn default() -> Self {
        Self { triangles: 20_000, noise_mm: 0.0, opening: false, configuration: None, fabric: None }
    }
}

/// Why there is no such sample.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SampleError {
    /// No limb has this name.
    #[error(
        "there is no sample `{name}`; the nearest name is `{nearest}` (there are: {})",
        NAMES.join(", ")
    )]
    UnknownName {
        /// The name given.
        name: String,
        /// The known name nearest to it.
        nearest: &'static str,
    },
    /// The number of triangles is out of range.
    #[error("a sample cannot have {given} triangles: ask for {MIN_TRIANGLES} to {MAX_TRIANGLES}")]
    Triangles {
        /// The number asked for.
        given: usize,
    },
    /// The noise is out of range or no number.
    #[error("a sample cannot have noise of {given} mm: ask for 0 to {MAX_NOISE_MM} mm")]
    Noise {
        /// The noise asked for, in mm.
        given: f64,
    },
    /// The limb has no place for an opening.
    #[error("the sample `{name}` has no opening; these can have one: {}", with_opening().join(", "))]
    Opening {
        /// The limb.
        name: &'static str,
    },
    /// The limb has no example of the paper.
    #[error(
        "the sample `{name}` has no configuration; these have: {}",
        with_configurations().join(", ")
    )]
    NoConfiguration {
        /// The limb.
        name: &'static str,
    },
    /// The limb has no example of this name.
    #[error(
        "the sample `{name}` has no configuration `{given}`; the nearest name is `{nearest}` \
         (there are: {})",
        configurations(name).iter().map(|c| c.name).collect::<Vec<_>>().join(", ")
    )]
    UnknownConfiguration {
        /// The limb.
        name: &'static str,
        /// The name given.
        given: String,
        /// The known name nearest to it.
        nearest: &'static str,
    },
    /// The example is not made in this fabric.
    #[error(
        "configuration `{configuration}` of the sample `{name}` is not made in the fabric `{given}`; \
         the nearest name is `{nearest}` (there are: {})",
        fabrics.join(", ")
    )]
    UnknownFabric {
        /// The limb.
        name: &'static str,
        /// The example.
        configuration: &'static str,
        /// The name given.
        given: String,
        /// The known name nearest to it.
        nearest: &'static str,
        /// All names.
        fabrics: Vec<&'static str>,
    },
    /// A fabric was named for a design that has its own.
    #[error("a fabric goes with a configuration: name that too, or leave the fabric out")]
    FabricAlone,
}

/// The paper's examples on the limb `name`; none for a limb without or an unknown name.
#[must_use]
pub fn configurations(name: &str) -> &'static [Configuration] {
    SPECIMENS.iter().find(|specimen| specimen.name == name).map_or(&[], |s| s.configurations)
}

/// The limbs that can have an opening.
fn with_opening() -> Vec<&'static str> {
    let with = SPECIMENS.iter().filter(|specimen| specimen.limb.opening().is_some());
    with.map(|specimen| specimen.name).collect()
}

/// The limbs with examples of the paper.
fn with_configurations() -> Vec<&'static str> {
    let with = SPECIMENS.iter().filter(|specimen| !specimen.configurations.is_empty());
    with.map(|specimen| specimen.name).collect()
}

/// Makes the limb `name` with its reachable design. The same arguments give the same limb.
///
/// # Errors
/// If there is no such limb, or a number is out of range.
pub fn sample(name: &str, triangles: usize, noise_mm: f64) -> Result<Sample, SampleError> {
    sample_with(name, &SampleOptions { triangles, noise_mm, ..SampleOptions::default() })
}

/// Makes the limb `name` as the options say. The same arguments give the same limb.
///
/// # Errors
/// If there is no such limb, it does not have what is asked for, or a number is out of range.
pub fn sample_with(name: &str, options: &SampleOptions) -> Result<Sample, SampleError> {
    let specimen = SPECIMENS.iter().find(|specimen| specimen.name == name).ok_or_else(|| {
        let nearest = nearest_name(name, NAMES.iter().copied()).unwrap_or_default();
        SampleError::UnknownName { name: name.to_owned(), nearest }
    })?;
    let name = specimen.name;
    let SampleOptions { triangles, noise_mm, .. } = *options;
    if !(MIN_TRIANGLES..=MAX_TRIANGLES).contains(&triangles) {
        return Err(SampleError::Triangles { given: triangles });
    }
    if !(0.0..=MAX_NOISE_MM).contains(&noise_mm) {
        return Err(SampleError::Noise { given: noise_mm });
    }
    let opening = if options.opening {
        Some(specimen.limb.opening().ok_or(SampleError::Opening { name })?)
    } else {
        None
    };
    let design = design(specimen, options.configuration.as_deref(), options.fabric.as_deref())?;
    Ok(Sample { mesh: tube::triangulate(specimen.limb, triangles, noise_mm, opening), design })
}

fn design(
    specimen: &'static Specimen,
    configuration: Option<&str>,
    fabric: Option<&str>,
) -> Result<Design, SampleError> {
    let name = specimen.name;
    let Some(wanted) = configuration else {
        return match fabric {
            None => Ok(specimen.demonstration()),
            Some(_) => Err(SampleError::FabricAlone),
        };
    };
    let known = specimen.configurations;
    let configuration = known.iter().find(|known| known.name == wanted).ok_or_else(|| {
        match nearest_name(wanted, known.iter().map(|known| known.name)) {
            None => SampleError::NoConfiguration { name },
            Some(nearest) => {
                SampleError::UnknownConfiguration { name, given: wanted.to_owned(), nearest }
            }
        }
    })?;
    let weaves = configuration.weaves;
    let weave = weaves.iter().find(|weave| fabric.is_none_or(|name| name == weave.name));
    let weave = weave.ok_or_else(|| {
        let given = fabric.unwrap_or_default();
        SampleError::UnknownFabric {
            name,
            configuration: configuration.name,
            given: given.to_owned(),
            nearest: nearest_name(given, configuration.fabrics()).unwrap_or_default(),
            fabrics: configuration.fabrics().collect(),
        }
    })?;
    Ok(specimen.example(configuration, weave))
}
