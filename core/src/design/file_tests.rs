use glam::DVec3;
use serde_json::json;

use super::*;
use crate::units::LengthUnit;

fn error(json: &str) -> String {
    parse(json, None)
        .map(|design| format!("accepted: {design:?}"))
        .unwrap_or_else(|e| e.to_string())
}

/// The message for a design with one wanted pressure and `rest` after it.
fn pressure_error(pressure: &str, rest: &str) -> String {
    error(&format!(r#"{{"pressures":[{pressure}]{rest}}}"#))
}

/// The message for a design without pressures and with `rest`.
fn rest_error(rest: &str) -> String {
    error(&format!(r#"{{"pressures":[],{rest}}}"#))
}

const WHOLE: &str = r#"{"units":"cm",
  "fabric":{"name":"tricot","warp":0.6,"weft":0.4,"diagonal":0.06,"s":0.64,"max_strain":0.4,"weft_strain":0.02},
  "pressure_model":"paper",
  "pressures":[{"at":[1,2,3],"kpa":2.29},{"at":[4,5,6],"mmhg":20}],
  "orientation":[[0,0,20],[0,0,0]],
  "seams":[[[1,0,0],[1,0,10],[1,0,20]]],
  "region":[{"point":[0,0,2],"normal":[0,0,1]}],
  "region_faces":[4,0,7],
  "facing":"inward",
  "limits":{"max_kpa":6.5,"bony":[[7,8,9]]},
  "piece":{"name":"Elbow","reference":"J 17","date":"2024-05-06"}}"#;

#[test]
fn every_key_arrives_in_the_cores_units() {
    let design = parse(WHOLE, Some(LengthUnit::Metre)).unwrap();
    assert_eq!(design.unit, Some(LengthUnit::Centimetre));
    let fabric = &design.fabric;
    assert_eq!(fabric.name, "tricot");
    assert_eq!([fabric.warp, fabric.weft, fabric.diagonal], [0.6, 0.4, 0.06]);
    assert_eq!([fabric.s, fabric.max_strain, fabric.weft_strain], [0.64, 0.4, 0.02]);
    assert_eq!(design.pressure_model, PressureModel::Paper);
    assert_eq!(design.pressures[0].at, DVec3::new(10.0, 20.0, 30.0));
    assert_eq!(design.pressures[0].kpa, 2.29);
    assert!((design.pressures[1].kpa - 2.66644).abs() < 1e-12);
    assert_eq!(design.orientation, Some([DVec3::new(0.0, 0.0, 200.0), DVec3::ZERO]));
    assert_eq!(design.seams.len(), 1);
    assert_eq!(design.seams[0][2], DVec3::new(10.0, 0.0, 200.0));
    // A plane's point is a place and is converted; its normal is a direction and is not.
    assert_eq!(design.region[0].point, DVec3::new(0.0, 0.0, 20.0));
    assert_eq!(design.region[0].normal, DVec3::Z);
    assert_eq!(design.region_faces.as_deref(), Some(&[4, 0, 7][..]));
    assert_eq!(design.facing, Some(Facing::Inward));
    assert_eq!(design.limits.max_kpa, Some(6.5));
    assert_eq!(design.limits.bony, [DVec3::new(70.0, 80.0, 90.0)]);
    assert_eq!(
        [&design.piece.name, &design.piece.reference, &design.piece.date],
        ["Elbow", "J 17", "2024-05-06"]
    );
}

#[test]
fn all_but_pressures_is_optional_and_pressures_may_be_empty() {
    assert_eq!(parse(r#"{"pressures":[]}"#, None).unwrap(), Design::default());
    // As editors on Windows save it.
    assert_eq!(parse("\u{feff}{\"pressures\":[]}\r\n", None).unwrap(), Design::default());
    let one = parse(r#"{"pressures":[],"fabric":{"warp":0.7}}"#, None).unwrap();
    assert_eq!(one.fabric, Fabric { warp: 0.7, ..Fabric::default() });
}

#[test]
fn coordinates_are_in_the_files_unit_else_the_surfaces_else_mm() {
    let at = |text: &str, surface| parse(text, surface).unwrap().pressures[0].at.x;
    let plain = r#"{"pressures":[{"at":[2,0,0],"kpa":1}]}"#;
    let inches = r#"{"units":"in","pressures":[{"at":[2,0,0],"kpa":1}]}"#;
    assert_eq!(at(plain, None), 2.0);
    assert_eq!(at(plain, Some(LengthUnit::Metre)), 2000.0);
    assert_eq!(at(inches, Some(LengthUnit::Metre)), 50.8);
    assert_eq!(parse(plain, Some(LengthUnit::Metre)).unwrap().unit, None);
}

#[test]
fn what_is_no_json_is_shown_by_line_and_column() {
    assert_eq!(
        error("{\n  \"pressures\": [\n}"),
        "line 3, column 1: the design cannot be read: expected value"
    );
    assert_eq!(
        error(" \n"),
        "line 1, column 1: the design cannot be read: the file is empty; the least is \
         {\"pressures\": []}"
    );
    assert_eq!(
        error(r#"{"pressures":[{"at":[0,0,0],"kpa":1e999}]}"#),
        "line 1, column 39: the design cannot be read: number out of range"
    );
    assert_eq!(
        error(r#"{"pressures":[{"at":[0,0,0],"kpa":NaN}]}"#),
        "line 1, column 35: the design cannot be read: expected value"
    );
}

#[test]
fn unknown_keys_name_their_path_and_the_nearest_known_key() {
    assert_eq!(
        rest_error(r#""presure_model":"paper""#),
        "`presure_model` is not a known key; the nearest known key is `pressure_model`"
    );
    assert_eq!(
        rest_error(r#""fabric":{"wrap":1}"#),
        "`fabric.wrap` is not a known key; the nearest known key is `warp`"
    );
    assert_eq!(
        pressure_error(r#"{"at":[0,0,0],"kpa":1},{"at":[0,0,0],"mmHg":1}"#, ""),
        "`pressures[1].mmHg` is not a known key; the nearest known key is `mmhg`"
    );
}

#[test]
fn a_key_given_twice_is_refused() {
    assert_eq!(
        rest_error(r#""fabric":{"warp":1,"warp":2}"#),
        "line 1, column 41: the design cannot be read: duplicate field `warp`"
    );
}

#[test]
fn values_of_the_wrong_kind_name_path_value_and_remedy() {
    assert_eq!(
        error("{}"),
        "`pressures` is missing: The wanted normal pressures, a list of \
         {\"at\": [x, y, z], \"kpa\": …} or {\"at\": …, \"mmhg\": …}. It may be empty: []."
    );
    assert!(error("[]").starts_with("`the design` is []: give an object, { … } ("));
    assert_eq!(
        rest_error(r#""units":"ft""#),
        "`units` is \"ft\": give one of \"mm\", \"cm\", \"m\", \"in\" \
         (Unit of all coordinates of this file)"
    );
    assert!(
        rest_error(r#""pressure_model":"Laplace""#)
            .starts_with("`pressure_model` is \"Laplace\": give one of \"laplace\", \"paper\" (")
    );
    assert!(
        rest_error(r#""facing":"out""#)
            .starts_with("`facing` is \"out\": give one of \"outward\", \"inward\" (")
    );
    assert_eq!(
        rest_error(r#""piece":{"name":3}"#),
        "`piece.name` is 3: give a text in quotes (Name of the piece)"
    );
    assert_eq!(
        pressure_error(r#"{"at":[0,0,"0"],"kpa":1}"#, ""),
        "`pressures[0].at[2]` is \"0\": give a number"
    );
    assert_eq!(
        pressure_error(r#"{"at":[0,0],"kpa":1}"#, ""),
        "`pressures[0].at` is [0,0]: give a list of 3 numbers \
         (Where: [x, y, z] on the surface or within 10 mm of it)"
    );
    assert_eq!(
        rest_error(r#""seams":3"#),
        "`seams` is 3: give a list of polylines, each [[x, y, z], …] \
         (Lines along which the surface is cut open, each of two or more points)"
    );
    // What would otherwise silently stand for an absent wish.
    assert!(error(r#"{"pressures":null}"#).starts_with("`pressures` is null: give a list"));
}

#[test]
fn fabrics_outside_their_range_are_refused() {
    assert_eq!(
        rest_error(r#""fabric":{"warp":0}"#),
        "`fabric.warp` is 0: give a number, more than 0 and at most 100 (Stiffness along warp, \
         round the limb, in N/mm: force per rest width at strain 1)"
    );
    for (key, bad, good) in [
        ("warp", "500", "100"),
        ("weft", "-0.5", "0.1"),
        ("diagonal", "0", "0.001"),
        ("s", "0", "0.6366"),
        ("max_strain", "0", "0.01"),
        ("max_strain", "3.01", "3"),
        ("weft_strain", "-0.21", "-0.2"),
    ] {
        let message = rest_error(&format!(r#""fabric":{{"{key}":{bad}}}"#));
        let begin = format!("`fabric.{key}` is {bad}: give a number, ");
        assert!(message.starts_with(&begin), "{message}");
        let accepted = parse(&format!(r#"{{"pressures":[],"fabric":{{"{key}":{good}}}}}"#), None);
        assert!(accepted.is_ok(), "{key} {good}: {accepted:?}");
    }
    assert_eq!(
        rest_error(r#""fabric":{"weft_strain":0.6}"#),
        "`fabric.weft_strain` is 0.6: the fabric bears no more than max_strain, 0.5"
    );
}

#[test]
fn millimetres_of_mercury_typed_as_kilopascal_are_recognised() {
    assert_eq!(
        pressure_error(r#"{"at":[0,0,0],"kpa":20}"#, ""),
        "`pressures[0].kpa` is 20: 20 kPa is 150 mmHg, above 13.3 kPa (100 mmHg); did you mean \
         20 mmHg? Then write \"mmhg\": 20; if it is meant, set limits.max_kpa to 20 or more"
    );
    assert_eq!(
        pressure_error(r#"{"at":[0,0,0],"mmhg":120}"#, ""),
        "`pressures[0].mmhg` is 120: 120 mmHg is 15.999 kPa, above 13.3 kPa (100 mmHg); if it is \
         meant, set limits.max_kpa to 16 or more"
    );
    assert_eq!(
        pressure_error(r#"{"at":[0,0,0],"kpa":200}"#, ""),
        "`pressures[0].kpa` is 200: 200 kPa is 1500.1 mmHg, above 13.3 kPa (100 mmHg)"
    );
    assert_eq!(
        pressure_error(r#"{"at":[0,0,0],"kpa":7}"#, r#","limits":{"max_kpa":6.5}"#),
        "`pressures[0].kpa` is 7: 7 kPa is 52.5 mmHg, above limits.max_kpa, 6.5 kPa (48.8 mmHg); \
         did you mean 7 mmHg? Then write \"mmhg\": 7; if it is meant, set limits.max_kpa to 7 or \
         more"
    );
}

#[test]
fn pressures_up_to_the_limit_are_accepted() {
    let kpa = |pressure: &str, rest: &str| {
        let text = format!(r#"{{"pressures":[{{"at":[0,0,0],{pressure}}}]{rest}}}"#);
        parse(&text, None).unwrap().pressures[0].kpa
    };
    assert_eq!(kpa(r#""kpa":13.3"#, ""), 13.3);
    assert!((kpa(r#""mmhg":100"#, "") - 13.3322).abs() < 1e-9);
    assert_eq!(kpa(r#""kpa":0"#, ""), 0.0);
    assert_eq!(kpa(r#""kpa":20"#, r#","limits":{"max_kpa":20}"#), 20.0);
}

#[test]
fn a_wanted_pressure_is_given_once_and_is_not_negative() {
    assert_eq!(
        pressure_error(r#"{"at":[0,0,0]}"#, ""),
        "`pressures[0].kpa` is missing: give the wanted pressure as \"kpa\" or as \"mmhg\""
    );
    assert_eq!(
        pressure_error(r#"{"at":[0,0,0],"kpa":1,"mmhg":7}"#, ""),
        "`pressures[0]` is both 1 kPa and 7 mmHg: give one of `kpa` and `mmhg`"
    );
    assert_eq!(
        pressure_error(r#"{"at":[0,0,0],"kpa":-1}"#, ""),
        "`pressures[0].kpa` is -1: give a number, at least 0 (How much, in kPa)"
    );
}

#[test]
fn places_that_mean_nothing_are_refused() {
    assert_eq!(
        pressure_error(r#"{"at":[0,0,1e7],"kpa":1}"#, r#","units":"m""#),
        "`pressures[0].at` is [0.0,0.0,10000000.0]: this is more than a kilometre from the \
         origin in m; check the coordinates and `units`"
    );
    assert_eq!(
        rest_error(r#""orientation":[[1,2,3],[1,2,3.5]]"#),
        "`orientation` is [[1.0,2.0,3.0],[1.0,2.0,3.5]]: give two different points, one above \
         the other along the limb, the first near the body"
    );
    assert_eq!(
        rest_error(r#""seams":[[[1,2,3]]]"#),
        "`seams[0]` is [[1,2,3]]: give a list of 2 or more points, each [x, y, z]"
    );
    assert_eq!(
        rest_error(r#""seams":[[[1,2,3],[1,2,3]]]"#),
        "`seams[0]` is 2 times the point [1.0,2.0,3.0]: give two or more different points along \
         the cut"
    );
    assert_eq!(
        rest_error(r#""region_faces":[1,-2]"#),
        "`region_faces[1]` is -2: give a whole number, 0 or more"
    );
    assert_eq!(
        rest_error(r#""region_faces":[]"#),
        "`region_faces` is []: give a list of 1 or more whole numbers (The faces of the surface's \
         file that the brace covers, counted from 0)"
    );
    assert_eq!(
        rest_error(r#""region":[{"point":[0,0,0],"normal":[0,0,0]}]"#),
        "`region[0].normal` is [0.0,0.0,0.0]: a normal of length zero has no direction; give the \
         direction towards the kept side, for example [0, 0, 1]"
    );
}

#[test]
fn writing_and_reading_gives_the_same_design() {
    let design = parse(WHOLE, None).unwrap();
    let again = parse(&design.to_json(), None).unwrap();
    assert_eq!(again, Design { unit: Some(LengthUnit::Millimetre), ..design });
}

#[test]
fn a_written_design_has_only_what_is_set() {
    let expected = concat!(
        "{\n",
        "  \"units\": \"mm\",\n",
        "  \"fabric\": {\n",
        "    \"name\": \"unnamed\",\n",
        "    \"warp\": 0.5,\n",
        "    \"weft\": 0.5,\n",
        "    \"diagonal\": 0.05,\n",
        "    \"s\": 1.0,\n",
        "    \"max_strain\": 0.5,\n",
        "    \"weft_strain\": 0.0\n",
        "  },\n",
        "  \"pressure_model\": \"laplace\",\n",
        "  \"pressures\": [\n",
        "    {\n",
        "      \"at\": [1.0, 2.5, -3.0],\n",
        "      \"kpa\": 2.29\n",
        "    }\n",
        "  ]\n",
        "}\n"
    );
    let wanted = WantedPressure { at: DVec3::new(1.0, 2.5, -3.0), kpa: 2.29 };
    let design = Design { pressures: vec![wanted], ..Design::default() };
    assert_eq!(design.to_json(), expected);
}

#[test]
fn the_schema_describes_every_key_and_forbids_others() {
    fn walk(schema: &Value, path: &str, count: &mut usize) {
        let object = schema.get("properties").and_then(|p| p.as_object());
        if let Some(properties) = object {
            assert_eq!(schema["additionalProperties"], json!(false), "{path}");
            for (key, value) in properties {
                *count += 1;
                assert!(
                    value["description"].as_str().is_some_and(|d| d.ends_with(['.', ']'])),
                    "{path}.{key}"
                );
                walk(value, &format!("{path}.{key}"), count);
            }
        }
        if let Some(items) = schema.get("items") {
            walk(items, &format!("{path}[]"), count);
        }
    }
    let schema = schema();
    assert_eq!(schema["$schema"], json!("https://json-schema.org/draft/2020-12/schema"));
    assert_eq!(schema["required"], json!(["pressures"]));
    let mut count = 0;
    walk(&schema, "", &mut count);
    // 11 at the top and 7 + 3 + 2 + 2 + 10 below.
    assert_eq!(count, 35);
    assert!(!schema.to_string().contains("$ref"));
}
