//! PLY by `ply-rs-bw`: ascii and binary of either byte order, any scalar type.
//!
//! The sizes in the header are checked against the bytes that follow before anything is read.

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
    ScalarType,
};

use super::{Format, RawMesh, ReadError, excerpt};

/// A point; NaN until its coordinates are set.
struct Vertex(DVec3);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self(DVec3::NAN)
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let coordinate = match name {
            "x" => &mut self.0.x,
            "y" => &mut self.0.y,
            "z" => &mut self.0.z,
            _ => return PropertyAccessResult::Ignored,
        };
        *coordinate = match property {
            Property::Char(v) => f64::from(v),
            Property::UChar(v) => f64::from(v),
            Property::Short(v) => f64::from(v),
            Property::UShort(v) => f64::from(v),
            Property::Int(v) => f64::from(v),
            Property::UInt(v) => f64::from(v),
            Property::Float(v) => f64::from(v),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// The corners of a face.
struct Face(Vec<i64>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !is_corner_list(name) {
            return PropertyAccessResult::Ignored;
        }
        fn widen<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
            list.into_iter().map(Into::into).collect()
        }
        self.0 = match property {
            Property::ListChar(list) => widen(list),
            Property::ListUChar(list) => widen(list),
            Property::ListShort(list) => widen(list),
            Property::ListUShort(list) => widen(list),
            Property::ListInt(list) => widen(list),
            Property::ListUInt(list) => widen(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// Some other element: read past.
struct Other;

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
    }
}

fn is_corner_list(name: &str) -> bool {
    matches!(name, "vertex_indices" | "vertex_index")
}

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, ReadError> {
    let format = Format::Ply;
    if !bytes.starts_with(b"ply") {
        let reason = "it does not begin with `ply`".to_owned();
        return Err(ReadError::NotThisFormat { format, reason });
    }
    let mut reader = Reader::new(bytes);
    let header = Parser::<Other>::new().read_header(&mut reader).map_err(|e| explain(&e))?;
    check_header(&header)?;
    check_sizes(&header, reader.get_ref().len())?;

    let body: &[u8] = reader.get_ref();
    let fault = |e: &ParseError| cut_short(&header, body).unwrap_or_else(|| explain(e));

    let mut raw = RawMesh::default();
    for element in header.elements.values() {
        match element.name.as_str() {
            "vertex" => {
                let vertices = Parser::<Vertex>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(|e| fault(&e))?;
                raw.points = vertices.into_iter().map(|v| v.0).collect();
            }
            "face" => {
                let faces = Parser::<Face>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(|e| fault(&e))?;
                let points = header.elements.get("vertex").map_or(0, |e| e.count);
                raw.polygons = faces
                    .into_iter()
                    .enumerate()
                    .map(|(face, corners)| {
                        let to_index = |index: i64| {
                            usize::try_from(index).map_err(|_| ReadError::IndexOutOfRange {
                                format,
                                face,
                                index,
                                points,
                            })
                        };
                        corners.0.into_iter().map(to_index).collect()
                    })
                    .collect::<Result<_, _>>()?;
            }
            _ => {
                Parser::<Other>::new()
                    .read_payload_for_element(&mut reader, element, &header)
                    .map_err(|e| fault(&e))?;
            }
        }
    }
    Ok(raw)
}

fn check_header(header: &Header) -> Result<(), ReadError> {
    let format = Format::Ply;
    let place = || "the header".to_owned();
    let Some(vertex) = header.elements.get("vertex").filter(|e| e.count > 0) else {
        return Err(ReadError::NoVertices(format));
    };
    for axis in ["x", "y", "z"] {
        if !vertex.properties.contains_key(axis) {
            let detail = format!("the points have no property `{axis}`");
            return Err(ReadError::Malformed { format, place: place(), detail });
        }
    }
    let Some(face) = header.elements.get("face").filter(|e| e.count > 0) else {
        return Err(ReadError::NoFaces { format, points: vertex.count });
    };
    if !face.properties.keys().any(|name| is_corner_list(name)) {
        let detail = "the faces have no list `vertex_indices` or `vertex_index`".to_owned();
        return Err(ReadError::Malformed { format, place: place(), detail });
    }
    Ok(())
}

/// Refuses a header that declares more than the bytes after it can hold.
fn check_sizes(header: &Header, available: usize) -> Result<(), ReadError> {
    let mut needed = 0u128;
    for element in header.elements.values() {
        let smallest = match header.encoding {
            // A line each; the last may lack its end.
            Encoding::Ascii => 1,
            Encoding::BinaryBigEndian | Encoding::BinaryLittleEndian => smallest_size(element),
        };
        if smallest == 0 && element.count > 0 {
            return Err(ReadError::Malformed {
                format: Format::Ply,
                place: "the header".to_owned(),
                detail: format!("the element `{}` has no properties", excerpt(&element.name)),
            });
        }
        needed += element.count as u128 * smallest as u128;
    }
    if needed > available as u128 + 1 {
        return Err(ReadError::Truncated {
            format: Format::Ply,
            detail: format!(
                "its header declares at least {needed} bytes of data but {available} follow"
            ),
        });
    }
    Ok(())
}

/// What is wrong with a text whose header declares more lines than follow: the last one that does
/// is probably half a line, and no fault of its own.
fn cut_short(header: &Header, body: &[u8]) -> Option<ReadError> {
    let declared: u128 = header.elements.values().map(|e| e.count as u128).sum();
    let lines = body.split(|&b| b == b'\n').filter(|line| !line.trim_ascii().is_empty()).count();
    (header.encoding == Encoding::Ascii && (lines as u128) < declared).then(|| {
        let detail = format!(
            "its header declares {declared} lines of data and it ends in line {lines} of them"
        );
        ReadError::Truncated { format: Format::Ply, detail }
    })
}

/// The fewest bytes that an element takes in a binary file: its lists may be empty.
fn smallest_size(element: &ElementDef) -> usize {
    let scalar = |t: &ScalarType| match t {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let size = |t: &PropertyType| match t {
        PropertyType::Scalar(t) | PropertyType::List(t, _) => scalar(t),
    };
    element.properties.values().map(|p| size(&p.data_type)).sum()
}

fn explain(error: &ParseError) -> ReadError {
    let format = Format::Ply;
    let text = error.to_string();
    // The crate's text goes on over several lines; the first says what it is about.
    let first = text.lines().next().unwrap_or_default();
    let first = first.split_once(": ").map_or(first, |(_, rest)| rest);
    if error.kind() == std::io::ErrorKind::UnexpectedEof {
        return ReadError::Truncated { format, detail: first.trim_end_matches('.').to_owned() };
    }
    let place = error.line().map_or("the data".to_owned(), |line| format!("line {line}"));
    let line = text.lines().find_map(|l| l.trim_start().strip_prefix("String: '"));
    let not_a_number = line.and_then(|line| {
        let line = line.trim_end_matches('\'');
        line.split_whitespace().find(|word| !word.parse::<f64>().is_ok_and(f64::is_finite))
    });
    match (error.line(), not_a_number) {
        (Some(_), Some(word)) if text.contains("element line") => {
            ReadError::NotANumber { format, place, text: excerpt(word) }
        }
        _ => {
            let detail = match line {
                Some(line) => format!("`{}` cannot be read", excerpt(line.trim_end_matches('\''))),
                None => first.to_owned(),
            };
            ReadError::Malformed { format, place, detail }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_bytes(bytes: &[u8]) -> Result<RawMesh, ReadError> {
        super::super::read(bytes, Format::Ply)
    }

    const TEXT: &str = "ply\nformat ascii 1.0\ncomment limb\nelement vertex 4\n\
                        property double x\nproperty double y\nproperty double z\n\
                        property uchar red\nelement face 2\nproperty uchar flag\n\
                        property list uchar int vertex_indices\nelement edge 1\n\
                        property int vertex1\nend_header\n0 0 0 255\n0.1 0 0 255\n\
                        0.1 0.1234567890123456 0 1\n0 -1E-1 0 1\n0 3 0 1 2\n1 4 0 1 2 3\n7\n";

    /// The same as `TEXT`, with these types, in binary.
    fn binary(big: bool, double: bool, index_bytes: usize) -> Vec<u8> {
        let order = if big { "big" } else { "little" };
        let coordinate = if double { "double" } else { "float" };
        let index = ["", "uchar", "short", "", "uint"][index_bytes];
        let mut bytes = format!(
            "ply\r\nformat binary_{order}_endian 1.0\r\nelement vertex 4\r\n\
             property {coordinate} x\r\nproperty {coordinate} y\r\n\
             property {coordinate} z\r\nelement face 2\r\n\
             property list uchar {index} vertex_index\r\nend_header\r\n"
        )
        .into_bytes();
        let mut push = |little: &[u8]| {
            let mut word = little.to_vec();
            if big {
                word.reverse();
            }
            bytes.extend(word);
        };
        for x in [0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.1, 0.123_456_789_012_345_6, 0.0, 0.0, -0.1, 0.0] {
            if double { push(&f64::to_le_bytes(x)) } else { push(&(x as f32).to_le_bytes()) }
        }
        for corners in [&[0u32, 1, 2][..], &[0, 1, 2, 3]] {
            push(&[u8::try_from(corners.len()).unwrap()]);
            corners.iter().for_each(|i| push(&i.to_le_bytes()[..index_bytes]));
        }
        bytes
    }

    #[test]
    fn text_keeps_double_precision_and_skips_what_is_not_the_surface() {
        let raw = read_bytes(TEXT.as_bytes()).unwrap();
        assert_eq!(raw.points[2], DVec3::new(0.1, 0.123_456_789_012_345_6, 0.0));
        assert_eq!(raw.points[3], DVec3::new(0.0, -0.1, 0.0));
        assert_eq!(raw.polygons, [vec![0, 1, 2], vec![0, 1, 2, 3]]);
    }

    #[test]
    fn binary_of_either_order_and_any_type_gives_the_same() {
        let want = read_bytes(TEXT.as_bytes()).unwrap();
        for big in [false, true] {
            for index_bytes in [1, 2, 4] {
                assert_eq!(read_bytes(&binary(big, true, index_bytes)).unwrap(), want);
                let single = read_bytes(&binary(big, false, index_bytes)).unwrap();
                assert_eq!(single.polygons, want.polygons);
                assert_eq!(single.points[1].x, f64::from(0.1f32));
            }
        }
    }

    #[test]
    fn faults_are_named() {
        let message = |text: &str| read_bytes(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(
            message(&TEXT.replace("0.1 0 0 255", "0.1 zero 0 255")),
            "line 16 of the PLY file: `zero` is not a number; export it again"
        );
        assert_eq!(
            message(&TEXT.replace("0.1 0 0 255", "0.1 nan 0 255")),
            "line 16 of the PLY file: `nan` is not a number; export it again"
        );
        assert_eq!(
            message(&TEXT.replace("0.1 0 0 255", "0.1 0 0")),
            "line 16 of the PLY file: `0.1 0 0` cannot be read; export it again"
        );
        assert_eq!(
            message(&TEXT.replace("1 4 0 1 2 3", "1 4 0 1 2 4")),
            "face 1 of the PLY file names point 4, but there are 4 points: export it again"
        );
        assert_eq!(
            message(&TEXT.replace("1 4 0 1 2 3", "1 4 0 -1 2 3")),
            "face 1 of the PLY file names point -1, but there are 4 points: export it again"
        );
        assert_eq!(
            message(&TEXT.replace("int vertex_indices", "float vertex_indices")),
            "line 19 of the PLY file: `0 3 0 1 2` cannot be read; export it again"
        );
        assert_eq!(
            message(&TEXT.replace("double z", "double height")),
            "the header of the PLY file: the points have no property `z`; export it again"
        );
        assert_eq!(
            message(
                &TEXT
                    .replace("element face 2", "element face 0")
                    .replace("0 3 0 1 2\n1 4 0 1 2 3\n", "")
            ),
            "the PLY file has 4 points but no faces, a point cloud: make a mesh of it first \
             (surface reconstruction)"
        );
        assert_eq!(
            message(&TEXT.replace("element vertex 4", "element vertex 0")),
            "the PLY file has no points: export the surface as a mesh"
        );
        assert_eq!(
            message(&TEXT.replace("ascii", "utf8")),
            "line 2 of the PLY file: `format utf8 1.0` cannot be read; export it again"
        );
    }

    #[test]
    fn sizes_that_the_file_cannot_hold_are_refused_at_once() {
        for count in ["5000000000", "18446744073709551615", "99999999999999999999999"] {
            let text = TEXT.replace("element vertex 4", &format!("element vertex {count}"));
            assert!(read_bytes(text.as_bytes()).is_err());
        }
        let empty = TEXT.replace("element edge 1", "element nothing 4000000000\nelement edge 1");
        let binary = empty.replace("ascii", "binary_little_endian");
        assert_eq!(
            read_bytes(binary.as_bytes()).unwrap_err().to_string(),
            "the header of the PLY file: the element `nothing` has no properties; export it again"
        );
        assert!(matches!(read_bytes(empty.as_bytes()), Err(ReadError::Truncated { .. })));
        let mut list = self::binary(false, true, 4);
        let at = list.len() - 17;
        list[at] = 255;
        assert!(matches!(read_bytes(&list), Err(ReadError::Truncated { .. })));
    }

    #[test]
    fn no_truncation_panics_or_passes_for_whole() {
        let end = TEXT.len() - "3\n7\n".len();
        for n in 0..end {
            assert!(read_bytes(&TEXT.as_bytes()[..n]).is_err(), "{n}");
        }
        for big in [false, true] {
            let bytes = binary(big, true, 4);
            for n in 0..bytes.len() {
                assert!(read_bytes(&bytes[..n]).is_err(), "{n}");
            }
        }
    }
}
