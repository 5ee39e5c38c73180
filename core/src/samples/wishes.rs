//! What comes with a limb: a reachable design for demonstrations, and the paper's examples.

use glam::DVec3;

use super::tube::Limb;
use crate::design::{Design, Fabric, Piece, PressureModel, WantedPressure};
use crate::units::kpa_from_mmhg;

/// A limb with its designs.
pub(super) struct Specimen {
    /// Its name.
    pub(super) name: &'static str,
    /// Its shape.
    pub(super) limb: &'static dyn Limb,
    /// Where the orientation markers stand round the limb, in radians.
    pub(super) markers: f64,
    /// Where the limb is to be cut open, as the angle of a seam from end to end, in radians;
    /// `None` leaves it to be found.
    pub(super) seam: Option<f64>,
    /// A design that the default fabric reaches by Laplace's law, in mmHg.
    pub(super) mmhg: &'static [Wish],
    /// The paper's examples on this limb.
    pub(super) configurations: &'static [Configuration],
}

/// A wanted pressure at a place of a limb.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wish {
    /// Along the limb, in mm.
    pub(super) station: f64,
    /// Round the limb, in radians.
    pub(super) angle: f64,
    /// How much, in the unit that its list states.
    pub(super) pressure: f64,
}

impl Wish {
    /// Another pressure at the same place.
    pub(super) const fn of(self, pressure: f64) -> Self {
        Self { pressure, ..self }
    }
}

/// A row of a list: the station in mm, the angle in radians, the pressure.
pub(super) const fn wish(station: f64, angle: f64, pressure: f64) -> Wish {
    Wish { station, angle, pressure }
}

/// An example of Wang & Tang's section 6: their formula, Eq. (2), with s = 1.
#[derive(Debug)]
pub struct Configuration {
    /// Its name: the paper's letter in lower case, or `paper` where there is only one.
    pub name: &'static str,
    /// What it wants, in one line.
    pub summary: &'static str,
    /// The fabrics that it is made in; the first unless another is asked for.
    pub(super) weaves: &'static [Weave],
}

impl Configuration {
    /// The names of the fabrics that it is made in; the first unless another is asked for.
    pub fn fabrics(&self) -> impl Iterator<Item = &'static str> {
        self.weaves.iter().map(|weave| weave.name)
    }
}

/// A configuration in one fabric.
#[derive(Debug)]
pub(super) struct Weave {
    /// The fabric's name.
    pub(super) name: &'static str,
    /// Its stiffness along warp, weft and the diagonals, in N/mm.
    pub(super) stiffness: [f64; 3],
    /// What is wanted, in kPa.
    pub(super) kpa: &'static [Wish],
}

/// Name and stiffness of the fabric of the demonstrations and of the paper's first example.
pub(super) const ISOTROPIC: (&str, [f64; 3]) = ("isotropic", [0.5, 0.5, 0.05]);

/// Name and stiffness of the fabric of the paper's second and third example: hard to stretch
/// along the limb.
pub(super) const ANISOTROPIC: (&str, [f64; 3]) = ("anisotropic", [0.5, 5.0, 0.05]);

impl Specimen {
    /// The design for demonstrations.
    pub(super) fn demonstration(&self) -> Design {
        let pressures = self.mmhg.iter().map(|wish| self.wanted(wish, kpa_from_mmhg)).collect();
        Design { pressures, ..self.design(ISOTROPIC.1) }
    }

    /// The design of one of the paper's examples.
    pub(super) fn example(&self, configuration: &Configuration, weave: &Weave) -> Design {
        let mut design = self.design(weave.stiffness);
        design.pressure_model = PressureModel::Paper;
        design.pressures = weave.kpa.iter().map(|wish| self.wanted(wish, |kpa| kpa)).collect();
        design.piece.reference =
            format!("Wang & Tang, configuration {}, {}", configuration.name, weave.name);
        design
    }

    fn design(&self, [warp, weft, diagonal]: [f64; 3]) -> Design {
        let name = format!("weave {warp} / {weft} / {diagonal} N/mm");
        let markers = [MARKER, self.limb.length() - MARKER];
        Design {
            fabric: Fabric { name, warp, weft, diagonal, ..Fabric::default() },
            orientation: Some(markers.map(|station| self.limb.point(station, self.markers))),
            seams: self.seam.iter().map(|&angle| self.seam_at(angle)).collect(),
            piece: Piece { name: format!("{} brace", self.name), ..Piece::default() },
            ..Design::default()
        }
    }

    /// The polyline from end to end at an angle.
    fn seam_at(&self, angle: f64) -> Vec<DVec3> {
        let pieces = (self.limb.length() / SEAM_STEP).ceil();
        (0..=pieces as usize)
            .map(|k| self.limb.point(self.limb.length() * k as f64 / pieces, angle))
            .collect()
    }

    fn wanted(&self, wish: &Wish, kpa: impl Fn(f64) -> f64) -> WantedPressure {
        WantedPressure { at: self.limb.point(wish.station, wish.angle), kpa: kpa(wish.pressure) }
    }
}

/// Distance of the orientation markers from the ends along the centre line, in mm.
const MARKER: f64 = 12.0;

/// Distance between the points of a seam along the centre line, in mm: as one would click them.
const SEAM_STEP: f64 = 15.0;
