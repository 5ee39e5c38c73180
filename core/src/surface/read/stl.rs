//! STL by `stl_io`, as a soup: every triangle has three points of its own.
//!
//! `stl_io` takes every file that begins with `solid ` for text, and many binary files do; here
//! the number of triangles after the header, which is no text, decides. Its own merging
//! of points (equal bits, so that 0 and −0 differ) is not used: see
//! [`validate`](crate::surface::validate()).

use std::io::{Cursor, ErrorKind};

use glam::DVec3;

use super::{Format, RawMesh, ReadError, excerpt};

/// The words with which lines of text STL begin.
const KEYWORDS: [&str; 7] =
    ["solid", "facet", "outer", "vertex", "endloop", "endfacet", "endsolid"];

/// Bytes of the header of binary STL, and with the number of triangles after it.
const HEADER: usize = 80;
const PREAMBLE: usize = HEADER + 4;
/// Bytes of a triangle in binary STL.
const TRIANGLE: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, ReadError> {
    let declared = declared_triangles(bytes);
    let complete = declared.map(|n| PREAMBLE as u64 + n * TRIANGLE as u64);
    if looks_like_text(bytes) {
        return read_text(bytes);
    }
    if is_text(bytes) {
        return Err(ReadError::NotThisFormat {
            format: Format::Stl,
            reason: "it is text that does not begin with `solid`".to_owned(),
        });
    }
    let truncated = |detail| Err(ReadError::Truncated { format: Format::Stl, detail });
    let (Some(declared), Some(complete)) = (declared, complete) else {
        return truncated(format!(
            "a binary one begins with {PREAMBLE} bytes of header, and it has {} bytes",
            bytes.len()
        ));
    };
    if (bytes.len() as u64) < complete {
        return truncated(format!(
            "for the {declared} triangles that it declares it needs {complete} bytes and has {}, \
             enough for {}",
            bytes.len(),
            (bytes.len() - PREAMBLE) / TRIANGLE
        ));
    }
    let mut copy = bytes.to_vec();
    // The header is free text; without its `solid` the crate knows the file as binary.
    copy[..HEADER].fill(0);
    collect(&mut Cursor::new(copy)).map_err(|error| ReadError::Malformed {
        format: Format::Stl,
        place: "the body".to_owned(),
        detail: excerpt(&error.to_string()),
    })
}

fn declared_triangles(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER..PREAMBLE)?;
    Some(u64::from(u32::from_le_bytes(count.try_into().ok()?)))
}

/// Whether the bytes are text from end to end: of a binary file, cut short or not, the numbers
/// after its header are none.
fn is_text(bytes: &[u8]) -> bool {
    std::str::from_utf8(bytes)
        .is_ok_and(|text| text.chars().all(|c| !c.is_control() || c.is_ascii_whitespace()))
}

/// Whether the bytes are a text STL, broken or whole: `solid`, and no zero byte where a binary
/// file has the number of its triangles, which has one unless it exceeds 16 million.
fn looks_like_text(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        && !bytes[..bytes.len().min(PREAMBLE)].contains(&0)
}

fn collect(source: &mut Cursor<Vec<u8>>) -> std::io::Result<RawMesh> {
    let mut raw = RawMesh::default();
    for triangle in stl_io::create_stl_reader(source)? {
        let first = raw.points.len();
        raw.points.extend(triangle?.vertices.map(|v| DVec3::from_array(v.0.map(f64::from))));
        raw.polygons.push(vec![first, first + 1, first + 2]);
    }
    Ok(raw)
}

fn read_text(bytes: &[u8]) -> Result<RawMesh, ReadError> {
    // The name may be in any encoding, or missing, and keywords in any case.
    let text = String::from_utf8_lossy(bytes).to_ascii_lowercase();
    // The crate stops at the first `endsolid`; the solids of a file become one.
    let is_frame = |line: &str| line.starts_with("solid") || line.starts_with("endsolid");
    let mut normal = String::with_capacity(text.len());
    normal.push_str("solid \n");
    let mut ended = false;
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        ended = line.starts_with("endsolid");
        if !is_frame(line) {
            normal.push_str(line);
            normal.push('\n');
        }
    }
    if ended {
        normal.push_str("endsolid\n");
    }
    collect(&mut Cursor::new(normal.into_bytes())).map_err(|error| explain(&text, ended, &error))
}

/// The first line at fault, which `stl_io` does not tell. What stands last in a file that has not
/// `ended` may be half a line.
fn explain(text: &str, ended: bool, error: &std::io::Error) -> ReadError {
    let format = Format::Stl;
    let mut facets = 0usize;
    let whole = text.trim_end().lines().count() - usize::from(!ended);
    for (i, line) in text.lines().enumerate().take(whole).skip(1) {
        let mut words = line.split_whitespace();
        let numbers = match (words.next(), words.next()) {
            (Some("facet"), _) => {
                facets += 1;
                line.split_whitespace().skip(2)
            }
            (Some("vertex"), _) => line.split_whitespace().skip(1),
            _ => continue,
        };
        let place = format!("line {} (face {})", i + 1, facets.saturating_sub(1));
        for word in numbers {
            match word.parse::<f32>() {
                Ok(number) if number.is_finite() => {}
                _ => return ReadError::NotANumber { format, place, text: excerpt(word) },
            }
        }
    }
    // Of keywords out of order the crate says so by another kind, but for those of half a line.
    let odd = |line: &str| {
        let word = line.split_whitespace().next();
        word.is_some_and(|word| !KEYWORDS.contains(&word))
    };
    let sound = !text.lines().take(whole).any(odd);
    if !ended && (error.kind() == ErrorKind::UnexpectedEof || sound) {
        let detail =
            format!("it ends in line {} without `endsolid`", text.trim_end().lines().count());
        return ReadError::Truncated { format, detail };
    }
    ReadError::Malformed {
        format,
        place: format!("one of the {facets} faces"),
        detail: excerpt(&error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_bytes(bytes: &[u8]) -> Result<RawMesh, ReadError> {
        super::super::read(bytes, Format::Stl)
    }

    const TEXT: &str = "solid wrist\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   \
                        vertex 1.5 0 0\n   vertex 0 2e-1 0\n  endloop\n endfacet\nendsolid wrist\n";

    fn binary(header: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
        for triangle in triangles {
            bytes.extend([0u8; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0u8; 2]);
        }
        bytes
    }

    const TWO: [[[f32; 3]; 3]; 2] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.1]],
        [[0.0, 0.0, 0.0], [1.0, 1.0, 0.1], [0.0, 1.0, -0.0]],
    ];

    #[test]
    fn text_is_read_with_every_triangles_own_points() {
        let raw = read_bytes(TEXT.as_bytes()).unwrap();
        assert_eq!(raw.polygons, [vec![0, 1, 2]]);
        assert_eq!(raw.points[1], DVec3::new(1.5, 0.0, 0.0));
        assert_eq!(raw.points[2].y, f64::from(0.2f32));
        let shouting = TEXT.to_uppercase().replace("SOLID WRIST", "SOLID");
        assert_eq!(read_bytes(shouting.as_bytes()).unwrap(), raw);
    }

    #[test]
    fn all_solids_of_a_text_file_are_read() {
        let two = format!("{TEXT}\n{}", TEXT.replace("1.5", "2.5"));
        let raw = read_bytes(two.as_bytes()).unwrap();
        assert_eq!(raw.polygons.len(), 2);
        assert_eq!(raw.points[4].x, 2.5);
    }

    #[test]
    fn binary_is_read_even_when_it_begins_with_solid() {
        for header in [&b"wovenfit"[..], b"solid made by a CAD program\nfacet"] {
            let raw = read_bytes(&binary(header, &TWO)).unwrap();
            assert_eq!(raw.points.len(), 6);
            assert_eq!(raw.polygons, [vec![0, 1, 2], vec![3, 4, 5]]);
            assert_eq!(raw.points[4], DVec3::new(1.0, 1.0, f64::from(0.1f32)));
        }
    }

    #[test]
    fn faults_are_named() {
        let message = |bytes: &[u8]| read_bytes(bytes).unwrap_err().to_string();
        let mut short = binary(b"\x01bin", &TWO);
        short.truncate(150);
        assert_eq!(
            message(&short),
            "the STL file is truncated: for the 2 triangles that it declares it needs 184 bytes \
             and has 150, enough for 1; copy or export it again"
        );
        // A header of plain text does not make a text of it.
        let mut short = binary(b"made by a scanner", &TWO);
        short.truncate(150);
        assert!(message(&short).contains("needs 184 bytes and has 150"), "{}", message(&short));
        // A huge declared number neither allocates nor loops.
        short[HEADER..PREAMBLE].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(message(&short).contains("the 4294967295 triangles that it declares"));
        assert_eq!(
            message(TEXT.replace("1.5", "1,5").as_bytes()),
            "line 5 (face 0) of the STL file: `1,5` is not a number; export it again"
        );
        assert_eq!(
            message(TEXT.replace("1.5", "nan").as_bytes()),
            "line 5 (face 0) of the STL file: `nan` is not a number; export it again"
        );
        assert_eq!(
            message(TEXT.replace("endsolid wrist\n", "").as_bytes()),
            "the STL file is truncated: it ends in line 8 without `endsolid`; copy or export it again"
        );
        assert_eq!(
            read_bytes(b"solid nothing\nendsolid\n"),
            Err(ReadError::NoVertices(Format::Stl))
        );
        assert_eq!(read_bytes(&binary(b"", &[])), Err(ReadError::NoVertices(Format::Stl)));
    }

    #[test]
    fn no_truncation_panics_or_passes_for_whole() {
        let bytes = binary(b"solid", &TWO);
        for n in 0..bytes.len() {
            assert!(read_bytes(&bytes[..n]).is_err(), "{n}");
        }
        for n in 0..TEXT.len() - "endsolid wrist\n".len() {
            let error = read_bytes(&TEXT.as_bytes()[..n]).unwrap_err();
            let named = matches!(error, ReadError::Truncated { .. });
            assert!(n < "solid wrist\n".len() || named, "{n}: {error}");
        }
    }
}
