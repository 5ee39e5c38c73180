//! Units: the only place that knows a conversion.
//!
//! Inside the core lengths are millimetres, stiffness is N/mm (= kN/m, force per rest width at
//! strain 1), pressure is kPa and curvature is 1/mm. 1 kPa = 1e-3 N/mm².

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// N/mm² in one kPa.
pub const N_PER_MM2_PER_KPA: f64 = 1e-3;

/// kPa in one mmHg (conventional millimetre of mercury, 133.322 Pa).
pub const KPA_PER_MMHG: f64 = 0.133322;

/// 1/m in one 1/mm: curvatures are shown per metre.
pub const PER_M_PER_PER_MM: f64 = 1000.0;

/// A unit of length that a file's coordinates may be in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum LengthUnit {
    /// Millimetre.
    #[serde(rename = "mm")]
    Millimetre,
    /// Centimetre.
    #[serde(rename = "cm")]
    Centimetre,
    /// Metre.
    #[serde(rename = "m")]
    Metre,
    /// Inch of 25.4 mm.
    #[serde(rename = "in")]
    Inch,
}

impl LengthUnit {
    /// Every unit, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::Millimetre, Self::Centimetre, Self::Metre, Self::Inch];

    /// Millimetres in one of this unit.
    #[must_use]
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
        }
    }

    /// The short name used in files and on the command line.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Inch => "in",
        }
    }

    /// The unit with this symbol.
    #[must_use]
    pub fn from_symbol(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }
}

/// A pressure in kPa from one in mmHg.
#[must_use]
pub fn kpa_from_mmhg(mmhg: f64) -> f64 {
    mmhg * KPA_PER_MMHG
}

/// A pressure in mmHg from one in kPa.
#[must_use]
pub fn mmhg_from_kpa(kpa: f64) -> f64 {
    kpa / KPA_PER_MMHG
}
