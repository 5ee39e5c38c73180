//! Wavefront OBJ: the worn surface with its pattern coordinates, the flat pattern, raw meshes.
//!
//! Numbers have nine decimals of a millimetre: far below any tolerance of the method, and fixed so
//! that the same result gives the same bytes. Texture coordinates are millimetres of the pattern,
//! not fractions of a picture: a program that shows them as a texture has to scale them.

use glam::{DVec2, DVec3};

use super::number::{push_fixed, push_whole};
use crate::surface::{RawMesh, Surface};

const DECIMALS: usize = 9;

/// The worn surface: `v` in mm as it sits on the limb, `vt` the pattern coordinates in mm, x along
/// warp and y along weft.
///
/// `coordinates` has one entry a vertex of `disk`.
///
/// # Panics
/// If `coordinates` and the vertices of `disk` are not equally many, a fault of the program.
#[must_use]
pub fn worn_obj(disk: &Surface, coordinates: &[DVec2]) -> String {
    assert_eq!(disk.vertex_count(), coordinates.len(), "one pattern coordinate a vertex");
    let mut text = header(&[
        "the cut surface as worn: v in mm in the coordinates of the scan",
        "vt: pattern coordinates in mm, not normalised: x along warp (round the limb),",
        "y along weft (along the limb, up to the end near the body)",
    ]);
    text.push_str("o worn\n");
    disk.points().iter().for_each(|p| push_point(&mut text, "v", &p.to_array()));
    coordinates.iter().for_each(|c| push_point(&mut text, "vt", &c.to_array()));
    for triangle in disk.triangles() {
        text.push('f');
        for number in triangle.map(|v| v.index() as u64 + 1) {
            text.push(' ');
            push_whole(&mut text, number, 1);
            text.push('/');
            push_whole(&mut text, number, 1);
        }
        text.push('\n');
    }
    text
}

/// The flat pattern: the triangles of [`worn_obj`] at their pattern coordinates, z = 0.
///
/// # Panics
/// If `coordinates` and the vertices of `disk` are not equally many, a fault of the program.
#[must_use]
pub fn flat_obj(disk: &Surface, coordinates: &[DVec2]) -> String {
    assert_eq!(disk.vertex_count(), coordinates.len(), "one pattern coordinate a vertex");
    let mut text = header(&[
        "the flat pattern: v in mm, x along warp (round the limb),",
        "y along weft (along the limb, up to the end near the body), z = 0;",
        "the triangles are those of worn.obj, in the same order",
    ]);
    text.push_str("o flat\n");
    for c in coordinates {
        push_point(&mut text, "v", &c.extend(0.0).to_array());
    }
    for triangle in disk.triangles() {
        push_face(&mut text, triangle.iter().map(|v| v.index()));
    }
    text
}

/// A mesh as it is, in mm; `title` goes into the comments.
#[must_use]
pub fn raw_obj(mesh: &RawMesh, title: &str) -> String {
    let title = title.replace(['\r', '\n'], " ");
    let mut text = header(&[&title, "v in mm"]);
    mesh.points.iter().for_each(|p: &DVec3| push_point(&mut text, "v", &p.to_array()));
    for polygon in &mesh.polygons {
        push_face(&mut text, polygon.iter().copied());
    }
    text
}

fn header(lines: &[&str]) -> String {
    let mut text = format!("# wovenfit {}\n", env!("CARGO_PKG_VERSION"));
    lines.iter().for_each(|line| text.push_str(&format!("# {line}\n")));
    text
}

fn push_point(text: &mut String, key: &str, coordinates: &[f64]) {
    text.push_str(key);
    for coordinate in coordinates {
        text.push(' ');
        push_fixed(text, *coordinate, DECIMALS);
    }
    text.push('\n');
}

fn push_face(text: &mut String, corners: impl Iterator<Item = usize>) {
    text.push('f');
    for corner in corners {
        text.push(' ');
        push_whole(text, corner as u64 + 1, 1);
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::surface::VertexId;

    /// Two triangles of a 20 × 10 mm rectangle that stands upright in space.
    fn disk() -> (Surface, Vec<DVec2>) {
        let points = vec![
            DVec3::new(0.0, 1.0 / 3.0, -0.0),
            DVec3::new(20.0, 1.0 / 3.0, 0.0),
            DVec3::new(20.0, 1.0 / 3.0, 10.0),
            DVec3::new(0.0, 1.0 / 3.0, 10.0),
        ];
        let triangles = [[0, 1, 2], [0, 2, 3]].map(|t| t.map(VertexId::new)).to_vec();
        let coordinates = vec![
            DVec2::new(-8.0, -1e-12),
            DVec2::new(8.5, 0.0),
            DVec2::new(8.5, 10.0),
            DVec2::new(-8.0, 10.0),
        ];
        (Surface::new(points, triangles).unwrap(), coordinates)
    }

    fn read(text: &str) -> tobj::Mesh {
        let options = tobj::LoadOptions::default();
        let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| {
            Err(tobj::LoadError::OpenFileFailed)
        })
        .unwrap();
        assert_eq!(models.len(), 1);
        models.into_iter().next().unwrap().mesh
    }

    #[test]
    fn another_program_reads_the_worn_surface_and_its_pattern() {
        let (disk, coordinates) = disk();
        let mesh = read(&worn_obj(&disk, &coordinates));
        assert_eq!(mesh.positions.len(), 12);
        assert_eq!(mesh.positions[9..12], [0.0, 0.333333333, 10.0]);
        assert_eq!(mesh.texcoords, [-8.0, 0.0, 8.5, 0.0, 8.5, 10.0, -8.0, 10.0]);
        assert_eq!(mesh.indices, [0, 1, 2, 0, 2, 3]);
        assert_eq!(mesh.texcoord_indices, mesh.indices);
    }

    #[test]
    fn the_flat_pattern_has_the_same_triangles_at_z_zero() {
        let (disk, coordinates) = disk();
        let mesh = read(&flat_obj(&disk, &coordinates));
        assert_eq!(
            mesh.positions,
            [-8.0, 0.0, 0.0, 8.5, 0.0, 0.0, 8.5, 10.0, 0.0, -8.0, 10.0, 0.0]
        );
        assert_eq!(mesh.indices, [0, 1, 2, 0, 2, 3]);
    }

    #[test]
    fn numbers_have_nine_decimals_and_no_negative_zero() {
        let (disk, coordinates) = disk();
        let text = worn_obj(&disk, &coordinates);
        assert!(text.contains("\nv 0.000000000 0.333333333 0.000000000\n"), "{text}");
        assert!(text.contains("\nvt -8.000000000 0.000000000\n"), "{text}");
        assert!(text.contains("\nf 1/1 3/3 4/4\n"), "{text}");
        assert!(!text.contains("-0.000000000"));
    }

    #[test]
    fn a_raw_mesh_keeps_its_polygons_and_its_title_stays_a_comment() {
        let mesh = RawMesh {
            points: vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y],
            polygons: vec![vec![0, 1, 2, 3]],
        };
        let text = raw_obj(&mesh, "a\nv 9 9 9");
        assert!(text.contains("# a v 9 9 9\n"));
        assert!(text.ends_with("f 1 2 3 4\n"));
        assert_eq!(text.lines().filter(|l| l.starts_with("v ")).count(), 4);
    }
}
