//! What `check` says of a surface before any brace is designed on it.

use serde::Serialize;

use super::json::GirthReport;
use crate::export::json_text;
use crate::warning::Warning;

/// What a surface is and what is wrong with it.
///
/// What cannot be told of a surface with defects is `None`.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct CheckReport {
    /// The file, as it was named; `None` for a surface that came from no file.
    pub file: Option<String>,
    /// The unit that its coordinates were taken to be in.
    pub unit: Option<&'static str>,
    /// `disk`, `tube`, `tube with holes`, `closed` or whatever it is, in words.
    pub shape: Option<String>,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Size along x, y and z, in mm.
    pub size_mm: Option<[f64; 3]>,
    /// Area in mm².
    pub area_mm2: Option<f64>,
    /// Length along the limb's centre line in mm, where there is one.
    pub length_mm: Option<f64>,
    /// Girths along the limb, from the end near the body.
    pub girths: Vec<GirthReport>,
    /// Boundary loops, the longest first.
    pub loops: Vec<LoopReport>,
    /// Mean curvature over the surface.
    pub curvature_per_m: Option<CurvatureReport>,
    /// What was repaired or should be known.
    pub warnings: Vec<Warning>,
    /// What stops flattening.
    pub defects: Vec<Defect>,
}

/// A boundary loop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LoopReport {
    /// Its length in mm.
    pub length_mm: f64,
    /// Its middle, in mm.
    pub at: [f64; 3],
}

/// How mean curvature is distributed over the vertices, per metre, outward positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CurvatureReport {
    /// Radius over which it was estimated, in mm.
    pub radius_mm: f64,
    /// The least.
    pub min: f64,
    /// 5 % of the vertices have less.
    pub percent_5: f64,
    /// Half of the vertices have less.
    pub median: f64,
    /// 95 % of the vertices have less.
    pub percent_95: f64,
    /// The largest.
    pub max: f64,
}

/// Something that stops flattening.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Defect {
    /// A frozen short name that programs can test.
    pub code: String,
    /// What it is, which element, and what to do about it.
    pub message: String,
    /// The vertices concerned, as the file counts them, from 0.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<usize>,
    /// The faces concerned, as the file counts them, from 0.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<usize>,
    /// Where it is, in mm, if it is at one place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
}

impl CheckReport {
    /// The report as indented JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        json_text(self)
    }

    /// The report for people.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = self.file.as_ref().map_or_else(String::new, |file| format!("{file}\n"));
        let mut say = |name: &str, value: String| text.push_str(&format!("  {name:<12}{value}\n"));
        if let Some(shape) = &self.shape {
            say("shape", shape.clone());
        }
        if let Some(unit) = self.unit {
            say("unit", unit.to_owned());
        }
        if self.triangles > 0 {
            say("mesh", format!("{} vertices, {} triangles", self.vertices, self.triangles));
        }
        if let Some([x, y, z]) = self.size_mm {
            say("size", format!("{x:.1} × {y:.1} × {z:.1} mm"));
        }
        if let Some(area) = self.area_mm2 {
            say("area", format!("{:.1} cm²", area / 100.0));
        }
        if let Some(length) = self.length_mm {
            say("length", format!("{length:.1} mm along the limb"));
        }
        for (i, boundary) in self.loops.iter().enumerate() {
            let [x, y, z] = boundary.at;
            let name = if i == 0 { "openings" } else { "" };
            let place = format!("round ({x:.1}, {y:.1}, {z:.1})");
            say(name, format!("{:>7.1} mm {place}", boundary.length_mm));
        }
        for (i, girth) in self.girths.iter().enumerate() {
            let name = if i == 0 { "girths" } else { "" };
            say(name, format!("{:>7.1} mm at {:.1} mm", girth.girth_mm, girth.at_mm));
        }
        if let Some(c) = &self.curvature_per_m {
            say(
                "curvature",
                format!(
                    "mean curvature over {} mm, per metre: median {:.1}, 90 % in {:.1} … {:.1}, \
                     all in {:.1} … {:.1}",
                    c.radius_mm, c.median, c.percent_5, c.percent_95, c.min, c.max
                ),
            );
        }
        for warning in &self.warnings {
            text.push_str(&format!("warning: {}{}\n", warning.message, place(warning.at)));
        }
        for defect in &self.defects {
            text.push_str(&format!("defect: {}{}\n", defect.message, place(defect.at)));
        }
        text.push_str(&match self.defects.len() {
            0 => "This surface can be flattened.\n".to_owned(),
            1 => "This surface cannot be flattened: 1 defect.\n".to_owned(),
            count => format!("This surface cannot be flattened: {count} defects.\n"),
        });
        text
    }
}

/// The coordinates, where they are known.
fn place(at: Option<[f64; 3]>) -> String {
    at.map_or_else(String::new, |[x, y, z]| format!(" [at ({x:.2}, {y:.2}, {z:.2}) mm]"))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use serde_json::{Value, json};

    use super::*;

    fn tube() -> CheckReport {
        CheckReport {
            file: Some("elbow.obj".to_owned()),
            unit: Some("mm"),
            shape: Some("tube".to_owned()),
            vertices: 1000,
            triangles: 1960,
            size_mm: Some([90.0, 120.25, 240.0]),
            area_mm2: Some(61_234.0),
            length_mm: Some(251.5),
            girths: vec![
                GirthReport { at_mm: 20.0, girth_mm: 268.0 },
                GirthReport { at_mm: 40.0, girth_mm: 261.25 },
            ],
            loops: vec![LoopReport { length_mm: 270.5, at: [0.0, 0.0, 240.0] }],
            curvature_per_m: Some(CurvatureReport {
                radius_mm: 10.0,
                min: -4.0,
                percent_5: 2.0,
                median: 12.5,
                percent_95: 25.0,
                max: 48.0,
            }),
            ..CheckReport::default()
        }
    }

    #[test]
    fn a_good_surface_is_told_in_lines() {
        let expected = "\
elbow.obj
  shape       tube
  unit        mm
  mesh        1000 vertices, 1960 triangles
  size        90.0 × 120.2 × 240.0 mm
  area        612.3 cm²
  length      251.5 mm along the limb
  openings      270.5 mm round (0.0, 0.0, 240.0)
  girths        268.0 mm at 20.0 mm
                261.2 mm at 40.0 mm
  curvature   mean curvature over 10 mm, per metre: median 12.5, 90 % in 2.0 … 25.0, all in -4.0 … 48.0
This surface can be flattened.
";
        assert_eq!(tube().to_text(), expected);
    }

    #[test]
    fn defects_and_warnings_are_told_with_their_place_and_stay_in_the_json() {
        let mut report = tube();
        report.warnings =
            vec![Warning::at("welded", "two points were one", DVec3::new(1.0, 2.0, 3.0))];
        report.defects = vec![Defect {
            code: "non_manifold_edge".to_owned(),
            message: "three triangles share an edge".to_owned(),
            faces: vec![7, 8, 9],
            at: Some([4.0, 5.0, 6.5]),
            ..Defect::default()
        }];
        let text = report.to_text();
        assert!(
            text.contains("warning: two points were one [at (1.00, 2.00, 3.00) mm]\n"),
            "{text}"
        );
        assert!(
            text.ends_with(
                "defect: three triangles share an edge [at (4.00, 5.00, 6.50) mm]\n\
                 This surface cannot be flattened: 1 defect.\n"
            ),
            "{text}"
        );
        let json: Value = serde_json::from_str(&report.to_json()).unwrap();
        assert_eq!(
            json["defects"],
            json!([{"code": "non_manifold_edge", "message": "three triangles share an edge", "faces": [7, 8, 9],
                    "at": [4.0, 5.0, 6.5]}])
        );
        assert_eq!(json["curvature_per_m"]["percent_95"], json!(25.0));
        assert_eq!(json["loops"][0]["length_mm"], json!(270.5));
    }

    #[test]
    fn a_surface_that_could_not_be_read_has_nulls_not_zeros() {
        let defect = Defect {
            code: "unreadable".to_owned(),
            message: "the file is empty".to_owned(),
            ..Defect::default()
        };
        let report = CheckReport { defects: vec![defect], ..CheckReport::default() };
        assert_eq!(
            report.to_text(),
            "defect: the file is empty\nThis surface cannot be flattened: 1 defect.\n"
        );
        let json: Value = serde_json::from_str(&report.to_json()).unwrap();
        assert_eq!([&json["area_mm2"], &json["size_mm"], &json["shape"]], [&Value::Null; 3]);
        assert!(json["defects"][0].get("at").is_none());
    }
}
