//! The design file: JSON in, a checked [`Design`] in the core's units out, and back.
//!
//! A wish that is not understood is refused, never ignored: unknown keys, keys given twice and
//! values outside their range are errors with path, value and remedy. Lengths are in the file's
//! `units`, pressures in kPa or mmHg, as each says.

use glam::DVec3;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::error::DesignError;
use super::{
    Design, Fabric, Facing, FileHash, Limits, Piece, PressureModel, RegionPlane, WantedPressure,
    schema as check,
};
use crate::export::json_text;
use crate::surface::in_mm;
use crate::units::{KPA_PER_MMHG, LengthUnit, kpa_from_mmhg, mmhg_from_kpa};

/// Pressure above which wanting it is an error unless `limits.max_kpa` allows it, in kPa; the same
/// in mmHg. Above it blood hardly flows, and it is what 20 mmHg typed as kPa exceeds.
const MOST_KPA: f64 = 13.3;
const MOST_MMHG: f64 = 100.0;

/// The highest `limits.max_kpa`: an atmosphere, twice what a tourniquet presses.
const MOST_LIMIT_KPA: f64 = 100.0;

/// Largest magnitude of a coordinate, in mm: a kilometre. Beyond it squares lose the millimetre.
const FARTHEST: f64 = 1e6;

/// Least distance of the two orientation markers, in mm: closer ones give no direction on a scan.
const LEAST_MARKER_DISTANCE: f64 = 1.0;

/// Least length of a region plane's normal: shorter ones are zeros with rounding errors.
const LEAST_NORMAL: f64 = 1e-9;

/// The widest allowance, in mm: wider ones are no seam or hem of a brace.
const MOST_ALLOWANCE: f64 = 100.0;

/// The least distance of notches, in mm: closer ones weaken the edge.
const LEAST_NOTCH_SPACING: f64 = 10.0;

type Point = [f64; 3];

/// What is wanted of a brace: the fabric, the normal pressures, where it lies on the limb.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "wovenfit design")]
struct DesignFile {
    /// Unit of all coordinates of this file. Without it they are in the unit of the surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "LengthUnit")]
    units: Option<LengthUnit>,
    /// The fabric: a linear woven one. Stiffness is the secant at working strain.
    #[serde(default)]
    fabric: FabricFile,
    /// How tension presses: "laplace" agrees with sensors, "paper" is equation (2) of Wang & Tang.
    #[serde(default)]
    #[schemars(with = "PressureModel")]
    pressure_model: PressureModel,
    /// The wanted normal pressures, a list of {"at": [x, y, z], "kpa": …} or {"at": …, "mmhg": …}. It may be empty: [].
    pressures: Vec<PressureFile>,
    /// Two orientation markers, the first near the body. In the pattern they stand on a vertical (weft) line. Without them the limb itself is taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "[Point; 2]")]
    orientation: Option<[Point; 2]>,
    /// Lines along which the surface is cut open, each of two or more points. Without them a tube is cut along a short line between its ends.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(inner(length(min = 2)))]
    seams: Vec<Vec<Point>>,
    /// Planes that bound the brace: it covers what lies on the side of all their normals.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    region: Vec<PlaneFile>,
    /// The faces of the surface's file that the brace covers, counted from 0. With `region` too, what lies in both is covered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Vec<usize>", length(min = 1))]
    region_faces: Option<Vec<usize>>,
    /// Whether the triangles of the surface face away from the body or towards it. Needed only where the shape does not show it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Facing")]
    facing: Option<Facing>,
    /// Limits that are checked.
    #[serde(default, skip_serializing_if = "LimitsFile::is_empty")]
    limits: LimitsFile,
    /// How the piece is cut and what is written on it.
    #[serde(default, skip_serializing_if = "PieceFile::is_default")]
    piece: PieceFile,
}

/// A linear woven fabric.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct FabricFile {
    /// Its name.
    name: String,
    /// Stiffness along warp, round the limb, in N/mm: force per rest width at strain 1. 500 N/m is 0.5 N/mm.
    #[schemars(range(max = 100.0), extend("exclusiveMinimum" = 0))]
    warp: f64,
    /// Stiffness along weft, along the limb, in N/mm. 500 N/m is 0.5 N/mm.
    #[schemars(range(max = 100.0), extend("exclusiveMinimum" = 0))]
    weft: f64,
    /// Stiffness of the diagonals, which stand for shear, in N/mm. A tenth of `warp` if it was not measured.
    #[schemars(range(max = 100.0), extend("exclusiveMinimum" = 0))]
    diagonal: f64,
    /// The coefficient s of the paper's Eq. (1), used by the pressure model "paper" alone.
    #[schemars(range(max = 100.0), extend("exclusiveMinimum" = 0))]
    s: f64,
    /// The largest strain that the fabric bears: 0.5 is half as long again.
    #[schemars(range(max = 3.0), extend("exclusiveMinimum" = 0))]
    max_strain: f64,
    /// The strain wanted along weft, near zero.
    #[schemars(range(min = -0.2, max = 3.0))]
    weft_strain: f64,
}

impl Default for FabricFile {
    fn default() -> Self {
        Fabric::default().into()
    }
}

impl From<Fabric> for FabricFile {
    fn from(fabric: Fabric) -> Self {
        let Fabric { name, warp, weft, diagonal, s, max_strain, weft_strain } = fabric;
        Self { name, warp, weft, diagonal, s, max_strain, weft_strain }
    }
}

impl From<FabricFile> for Fabric {
    fn from(fabric: FabricFile) -> Self {
        let FabricFile { name, warp, weft, diagonal, s, max_strain, weft_strain } = fabric;
        Self { name, warp, weft, diagonal, s, max_strain, weft_strain }
    }
}

/// A wanted normal pressure: a place and either `kpa` or `mmhg`.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{"required": ["kpa"]}, {"required": ["mmhg"]}]))]
struct PressureFile {
    /// Where: [x, y, z] on the surface or within 10 mm of it.
    at: Point,
    /// How much, in kPa. 20 mmHg are 2.67 kPa.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64", range(min = 0.0))]
    kpa: Option<f64>,
    /// How much, in mmHg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64", range(min = 0.0))]
    mmhg: Option<f64>,
}

/// A plane; the brace is on the side to which the normal points.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct PlaneFile {
    /// A point of the plane: [x, y, z].
    point: Point,
    /// Its normal, of any length but zero, towards the kept side: [x, y, z].
    normal: Point,
}

/// Limits that are checked.
#[derive(Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct LimitsFile {
    /// The highest pressure, in kPa: wanting more is an error, getting more is a warning. Without it wanting is limited to 13.3 kPa (100 mmHg).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "f64", range(max = MOST_LIMIT_KPA), extend("exclusiveMinimum" = 0))]
    max_kpa: Option<f64>,
    /// Places where bone lies under the skin, points [x, y, z].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    bony: Vec<Point>,
}

impl LimitsFile {
    fn is_empty(&self) -> bool {
        self.max_kpa.is_none() && self.bony.is_empty()
    }
}

/// How the piece is cut and what is written on it.
#[derive(Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct PieceFile {
    /// Name of the piece.
    #[serde(skip_serializing_if = "String::is_empty")]
    name: String,
    /// Patient or job reference.
    #[serde(skip_serializing_if = "String::is_empty")]
    reference: String,
    /// Date, as it is to be written.
    #[serde(skip_serializing_if = "String::is_empty")]
    date: String,
    /// How often it is cut.
    #[serde(skip_serializing_if = "is_one")]
    #[schemars(range(min = 1, max = 1000))]
    quantity: usize,
    /// What it is cut from. Without it the fabric's name.
    #[serde(skip_serializing_if = "String::is_empty")]
    material: String,
    /// Seam allowance of sewn sides, in mm, outside the sew line. With 0 they are joined edge to edge.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = MOST_ALLOWANCE))]
    seam_allowance_mm: f64,
    /// Allowance at the end near the body, in mm. It is turned down along the edge.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = MOST_ALLOWANCE))]
    top_allowance_mm: f64,
    /// Allowance at the far end, in mm. It is turned up along the edge.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = MOST_ALLOWANCE))]
    bottom_allowance_mm: f64,
    /// Allowance at every other edge, in mm: cut-outs, and the edge of a piece that goes not round the limb.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = MOST_ALLOWANCE))]
    edge_allowance_mm: f64,
    /// Distance of the notches along a seam, in mm, about: 10 or more, or 0 for none.
    #[serde(skip_serializing_if = "is_default_spacing")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    notch_spacing_mm: f64,
}

impl Default for PieceFile {
    fn default() -> Self {
        Piece::default().into()
    }
}

impl PieceFile {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn is_default_spacing(value: &f64) -> bool {
    *value == Piece::default().notch_spacing_mm
}

fn is_one(value: &usize) -> bool {
    *value == 1
}

impl From<Piece> for PieceFile {
    fn from(piece: Piece) -> Self {
        let Piece { name, reference, date, quantity, material, notch_spacing_mm, .. } = piece;
        Self {
            name,
            reference,
            date,
            quantity,
            material,
            seam_allowance_mm: piece.seam_allowance_mm,
            top_allowance_mm: piece.top_allowance_mm,
            bottom_allowance_mm: piece.bottom_allowance_mm,
            edge_allowance_mm: piece.edge_allowance_mm,
            notch_spacing_mm,
        }
    }
}

impl From<PieceFile> for Piece {
    fn from(piece: PieceFile) -> Self {
        let PieceFile { name, reference, date, quantity, material, notch_spacing_mm, .. } = piece;
        Self {
            name,
            reference,
            date,
            quantity,
            material,
            seam_allowance_mm: piece.seam_allowance_mm,
            top_allowance_mm: piece.top_allowance_mm,
            bottom_allowance_mm: piece.bottom_allowance_mm,
            edge_allowance_mm: piece.edge_allowance_mm,
            notch_spacing_mm,
        }
    }
}

/// The JSON schema (draft 2020-12) of the design file, with descriptions.
#[must_use]
pub fn schema() -> Value {
    let settings = SchemaSettings::draft2020_12().with(|s| s.inline_subschemas = true);
    settings.into_generator().into_root_schema_for::<DesignFile>().to_value()
}

/// Reads a design file.
///
/// Its coordinates are in its own `units`, else in `surface_unit` (what the designer said of the
/// surface), else in mm.
///
/// # Errors
/// If the text is no JSON, has a key that is not known or is given twice, or a value that cannot
/// be used; with the place in the file and the remedy.
pub fn parse(given: &str, surface_unit: Option<LengthUnit>) -> Result<Design, DesignError> {
    // Editors on Windows put a byte order mark first.
    let json = given.strip_prefix('\u{feff}').unwrap_or(given);
    if json.trim().is_empty() {
        let reason = "the file is empty; the least is {\"pressures\": []}".to_owned();
        return Err(DesignError::Syntax { line: 1, column: 1, reason });
    }
    let value: Value = serde_json::from_str(json).map_err(|e| DesignError::from(&e))?;
    check::check(&value, &schema(), "")?;
    // From the text, not the value: of a key given twice the value keeps but the last.
    let file: DesignFile = serde_json::from_str(json).map_err(|e| DesignError::from(&e))?;
    let hash = FileHash(Some(sha256(given.as_bytes())));
    Ok(Design { file: hash, ..from_file(file, surface_unit)? })
}

/// The SHA-256 of bytes, in hexadecimal digits as `sha256sum` prints it.
fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The design of a file whose keys, types and ranges are those of the schema.
fn from_file(file: DesignFile, surface_unit: Option<LengthUnit>) -> Result<Design, DesignError> {
    let unit = file.units.or(surface_unit).unwrap_or(LengthUnit::Millimetre);
    let place = |p: Point, path: String| position(p, unit, path);

    let fabric = Fabric::from(file.fabric);
    if fabric.weft_strain > fabric.max_strain {
        return Err(DesignError::value(
            "fabric.weft_strain",
            fabric.weft_strain,
            format!("the fabric bears no more than max_strain, {}", fabric.max_strain),
        ));
    }
    let pressures = file
        .pressures
        .iter()
        .enumerate()
        .map(|(i, p)| wanted_pressure(p, unit, file.limits.max_kpa, i))
        .collect::<Result<_, _>>()?;
    let orientation = file.orientation.map(|pair| orientation(pair, unit)).transpose()?;
    let seams = file
        .seams
        .iter()
        .enumerate()
        .map(|(i, line)| seam(line, unit, &format!("seams[{i}]")))
        .collect::<Result<_, _>>()?;
    let region = file
        .region
        .iter()
        .enumerate()
        .map(|(i, plane)| region_plane(plane, unit, &format!("region[{i}]")))
        .collect::<Result<_, _>>()?;
    let bony = numbered(&file.limits.bony, "limits.bony").map(|(p, path)| place(p, path));
    Ok(Design {
        unit: file.units,
        fabric,
        pressure_model: file.pressure_model,
        pressures,
        orientation,
        seams,
        region,
        region_faces: file.region_faces,
        facing: file.facing,
        limits: Limits { max_kpa: file.limits.max_kpa, bony: bony.collect::<Result<_, _>>()? },
        piece: piece(file.piece)?,
        warnings: Vec::new(),
        file: FileHash(None),
    })
}

fn numbered<'a>(points: &'a [Point], path: &'a str) -> impl Iterator<Item = (Point, String)> + 'a {
    points.iter().enumerate().map(move |(i, p)| (*p, format!("{path}[{i}]")))
}

fn shown(point: Point) -> String {
    check::shown(&Value::from(point.to_vec()))
}

/// A point in mm.
fn position(point: Point, unit: LengthUnit, path: String) -> Result<DVec3, DesignError> {
    let mm = in_mm(DVec3::from_array(point), unit);
    if mm.abs().max_element() <= FARTHEST {
        return Ok(mm);
    }
    Err(DesignError::value(
        path,
        shown(point),
        format!(
            "this is more than a kilometre from the origin in {}; check the coordinates and `units`",
            unit.symbol()
        ),
    ))
}

fn wanted_pressure(
    pressure: &PressureFile,
    unit: LengthUnit,
    max_kpa: Option<f64>,
    index: usize,
) -> Result<WantedPressure, DesignError> {
    let path = format!("pressures[{index}]");
    let at = position(pressure.at, unit, format!("{path}.at"))?;
    let kpa = match (pressure.kpa, pressure.mmhg) {
        (Some(kpa), None) => {
            if kpa > max_kpa.unwrap_or(MOST_KPA) {
                return Err(too_high(&path, "kpa", kpa, kpa, max_kpa));
            }
            kpa
        }
        (None, Some(mmhg)) => {
            let kpa = kpa_from_mmhg(mmhg);
            if max_kpa.map_or(mmhg > MOST_MMHG, |most| kpa > most) {
                return Err(too_high(&path, "mmhg", mmhg, kpa, max_kpa));
            }
            kpa
        }
        (Some(kpa), Some(mmhg)) => {
            return Err(DesignError::value(
                path,
                format!("both {kpa} kPa and {mmhg} mmHg"),
                "give one of `kpa` and `mmhg`",
            ));
        }
        (None, None) => {
            return Err(DesignError::Missing {
                path: format!("{path}.kpa"),
                remedy: "give the wanted pressure as \"kpa\" or as \"mmhg\"".to_owned(),
            });
        }
    };
    Ok(WantedPressure { at, kpa })
}

/// The error for too high a pressure, `value` in the unit of `key`.
fn too_high(path: &str, key: &str, value: f64, kpa: f64, max_kpa: Option<f64>) -> DesignError {
    let limit = match max_kpa {
        Some(most) => {
            format!("limits.max_kpa, {most} kPa ({} mmHg)", rounded(mmhg_from_kpa(most), 1))
        }
        None => format!("{MOST_KPA} kPa ({MOST_MMHG} mmHg)"),
    };
    // A host's unit may have made any number of digits of it.
    let said = rounded(value, 3);
    let (other, question) = if key == "kpa" {
        let meant = kpa_from_mmhg(value) <= max_kpa.unwrap_or(MOST_MMHG * KPA_PER_MMHG);
        let question = if meant {
            format!("; did you mean {said} mmHg? Then write \"mmhg\": {said}")
        } else {
            String::new()
        };
        (format!("{said} kPa is {} mmHg", rounded(mmhg_from_kpa(kpa), 1)), question)
    } else {
        (format!("{said} mmHg is {} kPa", rounded(kpa, 3)), String::new())
    };
    let allow = (kpa * 10.0).ceil() / 10.0;
    let allowed = if allow <= MOST_LIMIT_KPA {
        format!("; if it is meant, set limits.max_kpa to {allow} or more")
    } else {
        String::new()
    };
    let remedy = format!("{other}, above {limit}{question}{allowed}");
    DesignError::value(format!("{path}.{key}"), said, remedy)
}

/// `value` to so many decimals at most, without trailing zeros.
fn rounded(value: f64, decimals: i32) -> f64 {
    let factor = 10_f64.powi(decimals);
    (value * factor).round() / factor
}

fn piece(piece: PieceFile) -> Result<Piece, DesignError> {
    let spacing = piece.notch_spacing_mm;
    if spacing > 0.0 && spacing < LEAST_NOTCH_SPACING {
        let remedy = format!("give {LEAST_NOTCH_SPACING} mm or more, or 0 for no notches");
        return Err(DesignError::value("piece.notch_spacing_mm", spacing, remedy));
    }
    Ok(piece.into())
}

fn orientation(pair: [Point; 2], unit: LengthUnit) -> Result<[DVec3; 2], DesignError> {
    let first = position(pair[0], unit, "orientation[0]".to_owned())?;
    let second = position(pair[1], unit, "orientation[1]".to_owned())?;
    if first.distance(second) < LEAST_MARKER_DISTANCE {
        return Err(DesignError::value(
            "orientation",
            check::shown(&Value::from(pair.map(|p| Value::from(p.to_vec())).to_vec())),
            "give two different points, one above the other along the limb, the first near the body",
        ));
    }
    Ok([first, second])
}

fn seam(line: &[Point], unit: LengthUnit, path: &str) -> Result<Vec<DVec3>, DesignError> {
    let points: Vec<DVec3> =
        numbered(line, path).map(|(p, path)| position(p, unit, path)).collect::<Result<_, _>>()?;
    if points.iter().all(|p| *p == points[0]) {
        return Err(DesignError::value(
            path,
            format!("{} times the point {}", points.len(), shown(line[0])),
            "give two or more different points along the cut",
        ));
    }
    Ok(points)
}

fn region_plane(
    plane: &PlaneFile,
    unit: LengthUnit,
    path: &str,
) -> Result<RegionPlane, DesignError> {
    let point = position(plane.point, unit, format!("{path}.point"))?;
    let normal = DVec3::from_array(plane.normal);
    let length = normal.abs().max_element();
    if (LEAST_NORMAL..=FARTHEST).contains(&length) {
        return Ok(RegionPlane { point, normal });
    }
    let remedy = if length < LEAST_NORMAL {
        "a normal of length zero has no direction; give the direction towards the kept side, \
         for example [0, 0, 1]"
    } else {
        "give the direction towards the kept side by numbers near 1, for example [0, 0, 1]"
    };
    Err(DesignError::value(format!("{path}.normal"), shown(plane.normal), remedy))
}

/// A design file as JSON whose coordinates say their unit, read again after a change.
pub(super) fn from_value(value: Value) -> Result<Design, DesignError> {
    check::check(&value, &schema(), "")?;
    from_file(serde_json::from_value(value).map_err(|e| DesignError::from(&e))?, None)
}

/// The design file of a design as JSON; numbers keep every bit.
pub(super) fn to_value(design: &Design) -> Result<Value, DesignError> {
    serde_json::to_value(design.to_file()).map_err(|e| DesignError::from(&e))
}

impl Design {
    /// The design as a design file in mm and kPa, with only what is set beside the fabric and the
    /// pressure model; reading it back gives the same design.
    #[must_use]
    pub fn to_json(&self) -> String {
        json_text(&self.to_file())
    }

    /// The SHA-256 of the design in hexadecimal digits, and whether it is that of a file: of the file
    /// that it was read from and not changed since, else of the file that [`Design::to_json`] gives.
    #[must_use]
    pub fn sha256(&self) -> (String, bool) {
        match &self.file.0 {
            Some(hash) => (hash.clone(), true),
            None => (sha256(self.to_json().as_bytes()), false),
        }
    }

    fn to_file(&self) -> DesignFile {
        let points = |list: &[DVec3]| list.iter().map(DVec3::to_array).collect();
        DesignFile {
            units: Some(LengthUnit::Millimetre),
            fabric: self.fabric.clone().into(),
            pressure_model: self.pressure_model,
            pressures: self
                .pressures
                .iter()
                .map(|p| PressureFile { at: p.at.to_array(), kpa: Some(p.kpa), mmhg: None })
                .collect(),
            orientation: self.orientation.map(|pair| pair.map(|p| p.to_array())),
            seams: self.seams.iter().map(|line| points(line)).collect(),
            region: self
                .region
                .iter()
                .map(|p| PlaneFile { point: p.point.to_array(), normal: p.normal.to_array() })
                .collect(),
            region_faces: self.region_faces.clone(),
            facing: self.facing,
            limits: LimitsFile { max_kpa: self.limits.max_kpa, bony: points(&self.limits.bony) },
            piece: self.piece.clone().into(),
        }
    }
}

#[cfg(test)]
#[path = "file_tests.rs"]
mod tests;
