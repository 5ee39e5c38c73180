//! OBJ by `tobj`.
//!
//! `tobj` splits the mesh at every object and group (a point shared by two groups becomes two),
//! numbers points by first use, reads no file with a comment that is not UTF-8, and tells no line.
//! The first three would tear the surface apart or lose the file's numbers, so it is handed only
//! what makes the surface: the `v` and `f` lines, without texture, normal, colour and weight,
//! after one face that names every point in order. When it refuses, the line at fault is looked
//! for here.

use std::borrow::Cow;
use std::fmt::Write as _;

use glam::DVec3;

use super::{Format, RawMesh, ReadError, excerpt};

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, ReadError> {
    let text = as_text(bytes)?;
    if let Some(mesh) = plain(&text) {
        return Ok(mesh);
    }
    let (mut points, mut faces, mut statements) = (0usize, 0usize, 0usize);
    let mut lines = String::with_capacity(text.len());
    for (_, line) in logical_lines(&text) {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                points += 1;
                lines.push('v');
                words.take(3).for_each(|word| push_word(&mut lines, word));
                lines.push('\n');
            }
            Some("f" | "fo") => {
                faces += 1;
                lines.push('f');
                words.for_each(|word| push_word(&mut lines, position_part(word)));
                lines.push('\n');
            }
            Some(word) if is_statement(word) => statements += 1,
            _ => {}
        }
    }
    if points == 0 {
        return Err(if faces + statements > 0 {
            ReadError::NoVertices(Format::Obj)
        } else {
            not_obj("it has no line that begins with `v`")
        });
    }
    if faces == 0 {
        return Err(ReadError::NoFaces { format: Format::Obj, points });
    }
    let mut all = String::with_capacity(lines.len() + 8 * points);
    all.push('f');
    for i in 1..=points {
        // Writing to a string cannot fail.
        let _ = write!(all, " {i}");
    }
    all.push('\n');
    all.push_str(&lines);

    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let options = tobj::LoadOptions::default();
    let models = match tobj::load_obj_buf(&mut all.as_bytes(), &options, no_materials) {
        Ok((models, _)) => models,
        Err(error) => return Err(explain(&text, points, &error)),
    };
    let Some(mesh) = models.into_iter().next().map(|model| model.mesh) else {
        return Err(ReadError::NoFaces { format: Format::Obj, points });
    };
    let mut corners = mesh.indices.iter().map(|&i| i as usize);
    // No arities are given where every face is a triangle.
    let mut polygons: Vec<Vec<usize>> = if mesh.face_arities.is_empty() {
        (0..=faces).map(|_| corners.by_ref().take(3).collect()).collect()
    } else {
        mesh.face_arities.iter().map(|&n| corners.by_ref().take(n as usize).collect()).collect()
    };
    polygons.remove(0);
    let points = mesh.positions.chunks_exact(3).map(DVec3::from_slice).collect();
    Ok(RawMesh { points, polygons })
}

/// The mesh of a file in which nothing is unusual, the same as by the long way below: three numbers
/// a point, three corners or more a face, all in range, no line joined to the next. `None` if
/// anything is otherwise: then `tobj` reads it, or the reason is looked for.
fn plain(text: &str) -> Option<RawMesh> {
    if text.contains('\\') {
        return None;
    }
    let (mut points, mut polygons) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let mut number = || words.next()?.parse::<f64>().ok();
                points.push(DVec3::new(number()?, number()?, number()?));
            }
            Some("f") => {
                let mut polygon = Vec::with_capacity(3);
                for word in words {
                    let index: i64 = position_part(word).parse().ok()?;
                    // Negative indices count back from the points above the face.
                    let above = if index < 0 { i64::try_from(points.len()).ok()? } else { -1 };
                    polygon.push(usize::try_from(above + index).ok()?);
                }
                if polygon.len() < 3 {
                    return None;
                }
                polygons.push(polygon);
            }
            Some("fo") => return None,
            _ => {}
        }
    }
    let known = |polygon: &Vec<usize>| polygon.iter().all(|&v| v < points.len());
    let usual = !points.is_empty() && !polygons.is_empty() && polygons.iter().all(known);
    usual.then_some(RawMesh { points, polygons })
}

fn push_word(line: &mut String, word: &str) {
    line.push(' ');
    line.push_str(word);
}

/// The index of the position in a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`.
fn position_part(corner: &str) -> &str {
    corner.split('/').next().unwrap_or(corner)
}

/// Whether a line's first word is one of OBJ's own beside `v` and `f`.
fn is_statement(word: &str) -> bool {
    const STATEMENTS: [&str; 10] = ["vt", "vn", "vp", "o", "g", "s", "usemtl", "mtllib", "l", "p"];
    STATEMENTS.contains(&word)
}

fn not_obj(reason: &str) -> ReadError {
    ReadError::NotThisFormat { format: Format::Obj, reason: reason.to_owned() }
}

/// The text; a comment or name in another encoding than UTF-8 does no harm.
fn as_text(bytes: &[u8]) -> Result<Cow<'_, str>, ReadError> {
    if bytes.contains(&0) {
        return Err(not_obj("it is binary"));
    }
    let text = String::from_utf8_lossy(bytes);
    match text.split_whitespace().next() {
        Some("ply") => Err(not_obj("it begins like a PLY file")),
        Some("solid") => Err(not_obj("it begins like an STL file")),
        _ => Ok(text),
    }
}

/// Every line with its number from 1; a backslash at its end joins it to the next.
fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (i, line) = lines.next()?;
        let mut whole = Cow::Borrowed(line);
        while let Some(start) = whole.trim_end().strip_suffix('\\') {
            let mut joined = start.to_owned();
            let Some((_, more)) = lines.next() else { return Some((i + 1, Cow::Owned(joined))) };
            joined.push(' ');
            joined.push_str(more);
            whole = Cow::Owned(joined);
        }
        Some((i + 1, whole))
    })
}

/// The first line at fault, which `tobj` does not tell.
fn explain(text: &str, points: usize, error: &tobj::LoadError) -> ReadError {
    let format = Format::Obj;
    let (mut above, mut face) = (0usize, 0usize);
    let mut last_line = 0;
    for (number, line) in logical_lines(text) {
        last_line = number;
        let place = || format!("line {number}");
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                above += 1;
                let coordinates: Vec<&str> = words.take(3).collect();
                if let Some(word) = coordinates.iter().find(|word| word.parse::<f64>().is_err()) {
                    return ReadError::NotANumber { format, place: place(), text: excerpt(word) };
                }
                if coordinates.len() < 3 {
                    let detail = format!("the point has {} of 3 coordinates", coordinates.len());
                    return ReadError::Malformed { format, place: place(), detail };
                }
            }
            Some("f" | "fo") => {
                for word in words {
                    let Ok(index) = position_part(word).parse::<i64>() else {
                        let text = excerpt(word);
                        return ReadError::NotANumber { format, place: place(), text };
                    };
                    // Negative indices count back from the points above the face.
                    let count = i64::try_from(points).unwrap_or(i64::MAX);
                    let back = i64::try_from(above).unwrap_or(i64::MAX);
                    if index == 0 || index > count || index < -back {
                        return ReadError::IndexOutOfRange { format, face, index, points };
                    }
                }
                face += 1;
            }
            _ => {}
        }
    }
    ReadError::Malformed { format, place: format!("line {last_line}"), detail: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<RawMesh, ReadError> {
        super::super::read(text.as_bytes(), Format::Obj)
    }

    const SQUARE: &str = "# square\nmtllib a.mtl\no one\nv 0 0 0\nv 0.1 0 0 1 0 0\nv 0.1 0.1 0\n\
                          v 0 0.1 0\nvt 0 0\nvn 0 0 1\nusemtl red\n";

    #[test]
    fn polygons_keep_their_corners_and_the_files_numbers_and_precision() {
        let text =
            format!("v 9 9 9\n{SQUARE}f 4/1/1 5//1 2/1\nv 1 2 0.1234567890123456\nf 2 3 4 5 6");
        let raw = read_text(&text).unwrap();
        assert_eq!(raw.points.len(), 6, "an unused point keeps its place");
        assert_eq!(raw.points[0], DVec3::splat(9.0));
        assert_eq!(raw.points[5].z, 0.123_456_789_012_345_6);
        assert_eq!(raw.polygons, [vec![3, 4, 1], vec![1, 2, 3, 4, 5]]);
    }

    #[test]
    fn triangles_alone_are_read() {
        let raw = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 3 1 2\n").unwrap();
        assert_eq!(raw.polygons, [vec![2, 0, 1]]);
    }

    #[test]
    fn a_point_shared_by_two_groups_stays_one() {
        let text = format!("{SQUARE}g a\nf 1 2 3\ng b\no other\nf -4 -2 -1\n");
        let raw = read_text(&text).unwrap();
        assert_eq!(raw.points.len(), 4);
        assert_eq!(raw.polygons, [vec![0, 1, 2], vec![0, 2, 3]]);
    }

    #[test]
    fn joined_lines_and_foreign_encodings_are_read() {
        let mut bytes = b"# Gr\xf6\xdfe\n".to_vec();
        bytes.extend_from_slice(b"v 0 0 0\r\nv 1 0 0\r\nv 0 1 \\\r\n 0\r\nf 1 2 \\\r\n3\r\n");
        let raw = super::super::read(&bytes, Format::Obj).unwrap();
        assert_eq!(raw.polygons, [vec![0, 1, 2]]);
        assert_eq!(raw.points[2], DVec3::Y);
    }

    #[test]
    fn faults_name_their_line() {
        let message = |text: &str| read_text(text).unwrap_err().to_string();
        assert_eq!(
            message("v 0 0 0\nv 1,5 0 0\nv 0 1 0\nf 1 2 3\n"),
            "line 2 of the OBJ file: `1,5` is not a number; export it again"
        );
        assert_eq!(
            message("v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n"),
            "line 2 of the OBJ file: the point has 2 of 3 coordinates; export it again"
        );
        assert_eq!(
            message("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 three\n"),
            "line 4 of the OBJ file: `three` is not a number; export it again"
        );
        assert_eq!(
            message("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 7\n"),
            "face 1 of the OBJ file names point 7, but there are 3 points: export it again"
        );
        for index in ["0", "-4", "-9223372036854775808"] {
            assert_eq!(
                message(&format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {index}\n")),
                format!(
                    "face 0 of the OBJ file names point {index}, but there are 3 points: \
                     export it again"
                )
            );
        }
        assert_eq!(
            message("v 0 0 0\nv 1 0 0\n"),
            "the OBJ file has 2 points but no faces, a point cloud: make a mesh of it first \
             (surface reconstruction)"
        );
        assert_eq!(message("o empty\n"), ReadError::NoVertices(Format::Obj).to_string());
    }

    #[test]
    fn no_truncation_panics() {
        let text = format!("{SQUARE}f 1/1/1 2/1/1 3/1/1\nf -4 -2 -1 -3\n");
        for n in 0..text.len() {
            let _ = super::super::read(&text.as_bytes()[..n], Format::Obj);
        }
    }

    #[test]
    fn the_short_way_and_the_long_way_read_the_same() {
        let long = |text: &str| read_text(&format!("# \\ no plain file\n{text}"));
        for text in [
            "v 0 0 0\nv 1 0 0\nv 0 1e-3 0\nf 1//1 2//1 3//1\n",
            "f 1 2 3\nv 0 0 0\nv 1 0 0 0.5\nv 0 1 0\nf -1 -2 -3\n",
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n",
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nf +1 2/ 3/1/\n",
        ] {
            assert!(plain(text).is_some(), "{text}");
            assert_eq!(read_text(text), long(text), "{text}");
        }
        for text in [
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n",
            "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n",
            "v 0 0 0\nv 1 0 0\nv 0 1 x\nf 1 2 3\n",
            "v 0 0 0\nv 1 0 0\nf 1 2\n",
        ] {
            assert!(plain(text).is_none(), "{text}");
        }
    }
}
