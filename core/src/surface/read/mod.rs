//! Mesh files become points and polygons.
//!
//! The formats are read by their crates; what is added here is what those leave to the caller:
//! sizes declared in a header are checked against the bytes that are there, so that a broken file
//! can neither exhaust the memory nor loop, and every refusal names its place. No input panics.
//!
//! Limit: coordinates keep the precision of the format, which for STL is that of 32 bits (about
//! 2e-5 mm on a limb).

mod obj;
mod ply;
mod stl;

use std::fmt;

use super::raw::RawMesh;

/// A mesh file's format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ, text.
    Obj,
    /// Stereolithography STL, text or binary.
    Stl,
    /// Stanford PLY, text or binary of either byte order.
    Ply,
}

impl Format {
    /// The format that files with this extension (without its dot, in any case) are in.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            _ => None,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Ply => "PLY",
        })
    }
}

/// Why bytes are no mesh. Faces are counted from 0, lines from 1.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ReadError {
    /// There are no bytes.
    #[error("the {0} file is empty: export it again")]
    Empty(Format),
    /// The bytes are not in the format.
    #[error("this is no {format} file: {reason}; give the file the extension of its format")]
    NotThisFormat {
        /// The format it should be in.
        format: Format,
        /// What shows that it is not.
        reason: String,
    },
    /// The file ends before its contents do.
    #[error("the {format} file is truncated: {detail}; copy or export it again")]
    Truncated {
        /// The format.
        format: Format,
        /// What is missing.
        detail: String,
    },
    /// Something in the file cannot be read as what it should be.
    #[error("{place} of the {format} file: {detail}; export it again")]
    Malformed {
        /// The format.
        format: Format,
        /// Where: a line or a face.
        place: String,
        /// What is wrong.
        detail: String,
    },
    /// A text stands where a number should.
    #[error("{place} of the {format} file: `{text}` is not a number; export it again")]
    NotANumber {
        /// The format.
        format: Format,
        /// Where: a line or a face.
        place: String,
        /// What stands there.
        text: String,
    },
    /// There are no points.
    #[error("the {0} file has no points: export the surface as a mesh")]
    NoVertices(Format),
    /// There are points but no faces.
    #[error(
        "the {format} file has {points} points but no faces, a point cloud: make a mesh of it \
         first (surface reconstruction)"
    )]
    NoFaces {
        /// The format.
        format: Format,
        /// How many points there are.
        points: usize,
    },
    /// A face names a point that does not exist.
    #[error(
        "face {face} of the {format} file names point {index}, but there are {points} points: \
         export it again"
    )]
    IndexOutOfRange {
        /// The format.
        format: Format,
        /// The face, counted from 0.
        face: usize,
        /// The index as the file gives it.
        index: i64,
        /// How many points there are.
        points: usize,
    },
}

/// The points and polygons of a file's bytes, in the file's own unit and order.
///
/// # Errors
/// If the bytes are empty, truncated, not in the format, or hold no faces.
pub fn read(bytes: &[u8], format: Format) -> Result<RawMesh, ReadError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ReadError::Empty(format));
    }
    let raw = match format {
        Format::Obj => obj::read(bytes)?,
        Format::Stl => stl::read(bytes)?,
        Format::Ply => ply::read(bytes)?,
    };
    if raw.points.is_empty() {
        return Err(ReadError::NoVertices(format));
    }
    if raw.polygons.is_empty() {
        return Err(ReadError::NoFaces { format, points: raw.points.len() });
    }
    for (face, polygon) in raw.polygons.iter().enumerate() {
        if let Some(&index) = polygon.iter().find(|&&index| index >= raw.points.len()) {
            let index = i64::try_from(index).unwrap_or(i64::MAX);
            return Err(ReadError::IndexOutOfRange {
                format,
                face,
                index,
                points: raw.points.len(),
            });
        }
    }
    Ok(raw)
}

/// Text from a file, shortened for a message.
fn excerpt(text: &str) -> String {
    const LONGEST: usize = 40;
    let clean: String = text.trim().chars().filter(|c| !c.is_control()).collect();
    if clean.chars().count() <= LONGEST {
        clean
    } else {
        clean.chars().take(LONGEST).chain(['…']).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extensions_name_formats_in_any_case() {
        assert_eq!(Format::from_extension("OBJ"), Some(Format::Obj));
        assert_eq!(Format::from_extension("stl"), Some(Format::Stl));
        assert_eq!(Format::from_extension("Ply"), Some(Format::Ply));
        assert_eq!(Format::from_extension(".ply"), None);
        assert_eq!(Format::from_extension("step"), None);
    }

    #[test]
    fn an_empty_file_is_named() {
        for format in [Format::Obj, Format::Stl, Format::Ply] {
            assert_eq!(read(b"", format), Err(ReadError::Empty(format)));
            assert_eq!(read(b" \r\n", format), Err(ReadError::Empty(format)));
        }
        assert_eq!(
            read(b"", Format::Stl).unwrap_err().to_string(),
            "the STL file is empty: export it again"
        );
    }

    #[test]
    fn one_format_under_anothers_extension_is_refused() {
        let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let ply = b"ply\nformat ascii 1.0\nend_header\n";
        let stl = b"solid a\nendsolid a\n";
        for (bytes, formats) in [
            (&obj[..], [Format::Stl, Format::Ply]),
            (&ply[..], [Format::Obj, Format::Stl]),
            (&stl[..], [Format::Obj, Format::Ply]),
        ] {
            for format in formats {
                let error = read(bytes, format).unwrap_err();
                assert!(matches!(error, ReadError::NotThisFormat { .. }), "{format} {error}");
            }
        }
    }
}
