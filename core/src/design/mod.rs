//! What the designer wants of one brace, in the core's units (mm, N/mm, kPa).

mod chain;
mod edit;
mod error;
mod file;
mod painted;
mod schema;

use glam::DVec3;
use serde::Serialize;

pub use chain::seams_along_edges;
pub use error::DesignError;
pub use file::{parse, schema};
pub use painted::{APART_MM, MOST_POINTS, Painted, condense};

use crate::units::LengthUnit;
use crate::warning::Warning;

/// What the designer wants.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Design {
    /// The unit that the design file's coordinates were in, if it said; coordinates here are mm.
    pub unit: Option<LengthUnit>,
    /// The fabric.
    pub fabric: Fabric,
    /// How tension presses.
    pub pressure_model: PressureModel,
    /// The wanted normal pressures; may be empty.
    pub pressures: Vec<WantedPressure>,
    /// Two orientation markers; in the pattern they stand on a vertical (weft) line, the first,
    /// near the body, on top.
    pub orientation: Option<[DVec3; 2]>,
    /// Polylines along which the surface is cut.
    pub seams: Vec<Vec<DVec3>>,
    /// Half-spaces: the brace covers what lies in all of them.
    pub region: Vec<RegionPlane>,
    /// The faces of the raw mesh that the brace covers, counted from 0; all where there are none. What
    /// also lies in all half-spaces is kept.
    pub region_faces: Option<Vec<usize>>,
    /// Whether the triangles face outward as given; `None` where the shape itself shows it.
    pub facing: Option<Facing>,
    /// Limits that are checked.
    pub limits: Limits,
    /// What is written on the piece.
    pub piece: Piece,
    /// What was done to the wishes before they stood here, for the report; no part of a design file.
    pub warnings: Vec<Warning>,
    /// Of the file that it was read from; no part of it.
    pub file: FileHash,
}

/// A linear woven fabric.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fabric {
    /// Its name.
    pub name: String,
    /// Stiffness along warp (round the limb), force per rest width at strain 1, in N/mm.
    pub warp: f64,
    /// Stiffness along weft (along the limb), in N/mm.
    pub weft: f64,
    /// Stiffness of the diagonal springs that stand for shear, in N/mm.
    pub diagonal: f64,
    /// The paper's coefficient s of Eq. (1); used by [`PressureModel::Paper`] alone.
    pub s: f64,
    /// The largest strain that the fabric bears.
    pub max_strain: f64,
    /// The strain wanted along weft (Lemma 4: near zero).
    pub weft_strain: f64,
}

impl Default for Fabric {
    /// The paper's isotropic test fabric.
    fn default() -> Self {
        Self {
            name: "unnamed".to_owned(),
            warp: 0.5,
            weft: 0.5,
            diagonal: 0.05,
            s: 1.0,
            max_strain: 0.5,
            weft_strain: 0.0,
        }
    }
}

/// The formula between tension and normal pressure.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "lowercase")]
pub enum PressureModel {
    /// Laplace's law along both threads; agrees with sensors on rigid cylinders.
    #[default]
    Laplace,
    /// The paper's Eq. (2): mean curvature times the sum of tensions times s π.
    Paper,
}

/// A wanted normal pressure at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WantedPressure {
    /// Where, in mm.
    pub at: DVec3,
    /// How much, in kPa.
    pub kpa: f64,
}

/// A half-space of the region: what lies on the side to which the normal points is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegionPlane {
    /// A point of the plane, in mm.
    pub point: DVec3,
    /// Its normal, of any length but zero, pointing to the kept side.
    pub normal: DVec3,
}

/// Whether triangles face outward.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Facing {
    /// Counter-clockwise triangles face away from the body.
    Outward,
    /// Counter-clockwise triangles face the body: they are reversed.
    Inward,
}

/// Limits that are checked.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Limits {
    /// Pressure above which the report warns and above which wanting is an error; `None` means
    /// 6.5 kPa for warnings and 13.3 kPa for wanting.
    pub max_kpa: Option<f64>,
    /// Places where bone lies under the skin, in mm.
    pub bony: Vec<DVec3>,
}

impl Limits {
    /// Pressure above which the report warns where the design gives no limit, in kPa: the lower end
    /// of the highest compression class, IV of RAL-GZ 387.
    pub const WARN_KPA: f64 = 6.5;
}

/// How the piece is cut and what is written on it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Piece {
    /// Name of the piece.
    pub name: String,
    /// Patient or job reference.
    pub reference: String,
    /// Date, as the designer writes it.
    pub date: String,
    /// How often it is cut.
    pub quantity: usize,
    /// What it is cut from; where it is empty, the fabric's name.
    pub material: String,
    /// Allowance outside the sew line of sewn sides, in mm.
    pub seam_allowance_mm: f64,
    /// Allowance at the end near the body, in mm.
    pub top_allowance_mm: f64,
    /// Allowance at the far end, in mm.
    pub bottom_allowance_mm: f64,
    /// Allowance at every other edge (cut-outs, the edge of a patch), in mm.
    pub edge_allowance_mm: f64,
    /// Distance of notches along a seam, in mm; 0 for none.
    pub notch_spacing_mm: f64,
}

impl Default for Piece {
    /// One piece without allowance: elastic fabric is mostly joined edge to edge (flat seams), and an
    /// allowance that nobody asked for, sewn in, would make the brace wider than computed.
    fn default() -> Self {
        Self {
            name: String::new(),
            reference: String::new(),
            date: String::new(),
            quantity: 1,
            material: String::new(),
            seam_allowance_mm: 0.0,
            top_allowance_mm: 0.0,
            bottom_allowance_mm: 0.0,
            edge_allowance_mm: 0.0,
            // Two hands hold the fabric at both ends of some 5 cm while it is sewn.
            notch_spacing_mm: 50.0,
        }
    }
}

/// The SHA-256 of the file that a design was read from, if it is still as it was read.
///
/// No wish: designs from different files are equal if their wishes are.
#[derive(Debug, Clone, Default)]
pub struct FileHash(pub Option<String>);

impl PartialEq for FileHash {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
