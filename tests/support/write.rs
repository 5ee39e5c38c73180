//! Mesh files as bytes, written from the formats' descriptions, not with the product's crates.
//!
//! Numbers in text are Rust's shortest that read back to the same f64.

use std::fmt::Write;

use glam::DVec3;

use crate::mesh::Mesh;

/// The numbers in a PLY file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlyScalar {
    /// 32 bits.
    Float,
    /// 64 bits.
    Double,
}

/// The encoding of a PLY file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlyEncoding {
    /// Text.
    Ascii,
    /// Binary, least byte first.
    LittleEndian,
    /// Binary, greatest byte first.
    BigEndian,
}

/// Wavefront OBJ.
#[must_use]
pub fn obj(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::from("# test\n");
    for p in &mesh.points {
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).expect("writing to memory");
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("writing to memory");
    }
    text.into_bytes()
}

fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// ASCII STL.
#[must_use]
pub fn stl_ascii(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::from("solid test\n");
    for corners in mesh.corners() {
        let n = normal(corners);
        writeln!(text, " facet normal {} {} {}\n  outer loop", n.x, n.y, n.z)
            .expect("writing to memory");
        for p in corners {
            writeln!(text, "   vertex {} {} {}", p.x, p.y, p.z).expect("writing to memory");
        }
        text.push_str("  endloop\n endfacet\n");
    }
    text.push_str("endsolid test\n");
    text.into_bytes()
}

/// Binary STL; its numbers have 32 bits.
#[must_use]
pub fn stl_binary(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for corners in mesh.corners() {
        for p in std::iter::once(normal(corners)).chain(corners) {
            bytes.extend(p.as_vec3().to_array().iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}

/// PLY in any of its encodings.
#[must_use]
pub fn ply(mesh: &Mesh, encoding: PlyEncoding, scalar: PlyScalar) -> Vec<u8> {
    let (format, scalar_name) = (
        match encoding {
            PlyEncoding::Ascii => "ascii",
            PlyEncoding::LittleEndian => "binary_little_endian",
            PlyEncoding::BigEndian => "binary_big_endian",
        },
        match scalar {
            PlyScalar::Float => "float",
            PlyScalar::Double => "double",
        },
    );
    let mut bytes = format!(
        "ply\nformat {format} 1.0\ncomment test\nelement vertex {}\nproperty {scalar_name} x\n\
         property {scalar_name} y\nproperty {scalar_name} z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        mesh.points.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for p in &mesh.points {
        match encoding {
            PlyEncoding::Ascii if scalar == PlyScalar::Float => {
                let p = p.as_vec3();
                bytes.extend(format!("{} {} {}\n", p.x, p.y, p.z).into_bytes());
            }
            PlyEncoding::Ascii => bytes.extend(format!("{} {} {}\n", p.x, p.y, p.z).into_bytes()),
            _ => {
                for x in p.to_array() {
                    let (float, double) = (x as f32, x);
                    bytes.extend(match (encoding, scalar) {
                        (PlyEncoding::LittleEndian, PlyScalar::Float) => {
                            float.to_le_bytes().to_vec()
                        }
                        (_, PlyScalar::Float) => float.to_be_bytes().to_vec(),
                        (PlyEncoding::LittleEndian, _) => double.to_le_bytes().to_vec(),
                        _ => double.to_be_bytes().to_vec(),
                    });
                }
            }
        }
    }
    for t in &mesh.triangles {
        if encoding == PlyEncoding::Ascii {
            bytes.extend(format!("3 {} {} {}\n", t[0], t[1], t[2]).into_bytes());
            continue;
        }
        bytes.push(3);
        for &v in t {
            let v = v as i32;
            bytes.extend(match encoding {
                PlyEncoding::LittleEndian => v.to_le_bytes(),
                _ => v.to_be_bytes(),
            });
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Mesh {
        Mesh {
            points: vec![DVec3::ZERO, DVec3::new(1.5, 0.0, 0.0), DVec3::new(0.0, 0.1, 0.0)],
            triangles: vec![[0, 1, 2]],
        }
    }

    #[test]
    fn binary_files_have_the_formats_sizes_and_places() {
        let stl = stl_binary(&triangle());
        assert_eq!(stl.len(), 80 + 4 + 50);
        assert_eq!(stl[80..84], 1u32.to_le_bytes());
        // Normal, then three corners: the second one's x.
        assert_eq!(stl[84 + 12 + 12..84 + 12 + 16], 1.5f32.to_le_bytes());
        let ply = ply(&triangle(), PlyEncoding::BigEndian, PlyScalar::Double);
        assert!(ply.ends_with(&[3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]));
        let body = ply.len() - 13 - 9 * 8;
        assert!(ply[..body].ends_with(b"end_header\n"));
        assert_eq!(ply[body + 24..body + 32], 1.5f64.to_be_bytes());
    }

    #[test]
    fn text_reads_back_to_the_same_numbers() {
        let text = String::from_utf8(obj(&triangle())).unwrap();
        assert_eq!(text, "# test\nv 0 0 0\nv 1.5 0 0\nv 0 0.1 0\nf 1 2 3\n");
        let stl = String::from_utf8(stl_ascii(&triangle())).unwrap();
        assert!(stl.contains("facet normal 0 0 1") && stl.contains("vertex 0 0.1 0"));
    }
}
