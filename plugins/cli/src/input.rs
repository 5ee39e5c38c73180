//! Reading what the designer names: a surface, a design.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use wovenfit_core::design::{self, Design};
use wovenfit_core::surface::{self, Format, RawMesh};
use wovenfit_core::units::LengthUnit;

use crate::exit::Failure;

/// Why a surface could not be had.
#[derive(Debug)]
pub enum SurfaceFailure {
    /// The file could not be opened, or is of no format we know.
    File(Failure),
    /// The file was read and its contents are no mesh.
    Contents(Failure),
}

impl From<SurfaceFailure> for Failure {
    fn from(failure: SurfaceFailure) -> Self {
        match failure {
            SurfaceFailure::File(failure) | SurfaceFailure::Contents(failure) => failure,
        }
    }
}

/// The points and polygons of a surface file; its format is told by its extension.
pub fn surface(path: &Path) -> Result<RawMesh, SurfaceFailure> {
    let format = format_of(path).map_err(SurfaceFailure::File)?;
    let bytes = bytes_of(path).map_err(SurfaceFailure::File)?;
    surface::read(&bytes, format)
        .map_err(|error| SurfaceFailure::Contents(Failure::of(&error).at(path)))
}

fn format_of(path: &Path) -> Result<Format, Failure> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.and_then(Format::from_extension).ok_or_else(|| {
        let what = match extension {
            Some(extension) => format!("files ending in .{extension} are not known"),
            None => "the name has no ending that shows the format".to_owned(),
        };
        Failure::new(format!("{what}: give a surface as .obj, .stl or .ply")).at(path)
    })
}

/// The design in a file; `surface_unit` is the unit of the surface where it was given.
pub fn design(path: &Path, surface_unit: Option<LengthUnit>) -> Result<Design, Failure> {
    let text = String::from_utf8(bytes_of(path)?).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        Failure::new(format!("byte {place} is not UTF-8 text: save the design as UTF-8")).at(path)
    })?;
    design::parse(&text, surface_unit).map_err(|error| Failure::of(&error).at(path))
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, Failure> {
    if path.is_dir() {
        return Err(Failure::new("this is a folder: give a file").at(path));
    }
    fs::read(path).map_err(|error| {
        let reason = match error.kind() {
            ErrorKind::NotFound => "there is no such file".to_owned(),
            ErrorKind::PermissionDenied => "reading this file is not permitted".to_owned(),
            _ => format!("cannot be read: {error}"),
        };
        Failure::new(reason).at(path)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(result: Result<impl Sized, impl Into<Failure>>) -> String {
        result.map_or_else(|failure| failure.into().to_string(), |_| "accepted".to_owned())
    }

    #[test]
    fn every_unreadable_input_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let shown = |name: &str| path(name).display().to_string();
        fs::create_dir(path("folder.obj")).unwrap();
        fs::write(path("latin1.json"), b"{\"piece\": {\"name\": \"\xe9\"}}").unwrap();
        fs::write(path("bad.json"), "{").unwrap();

        assert_eq!(
            message(surface(&path("limb.fbx"))),
            format!(
                "{}: files ending in .fbx are not known: give a surface as .obj, .stl or .ply",
                shown("limb.fbx")
            )
        );
        assert_eq!(
            message(surface(&path("limb"))),
            format!(
                "{}: the name has no ending that shows the format: give a surface as .obj, .stl \
                 or .ply",
                shown("limb")
            )
        );
        assert_eq!(
            message(surface(&path("limb.obj"))),
            format!("{}: there is no such file", shown("limb.obj"))
        );
        assert_eq!(
            message(surface(&path("folder.obj"))),
            format!("{}: this is a folder: give a file", shown("folder.obj"))
        );
        assert_eq!(
            message(design(&path("latin1.json"), None)),
            format!(
                "{}: byte 20 is not UTF-8 text: save the design as UTF-8",
                shown("latin1.json")
            )
        );
        let bad = message(design(&path("bad.json"), None));
        assert!(
            bad.starts_with(&format!(
                "{}: line 1, column 1: the design cannot be read: ",
                shown("bad.json")
            )),
            "{bad}"
        );
    }
}
