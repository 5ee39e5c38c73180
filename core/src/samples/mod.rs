//! Procedural limbs of real size, for demonstrations and tests.
//!
//! Each limb is a smooth closed-form map from (station along the limb, angle round it) to space
//! with a design that suits it, a file a limb. They are plausible, not anatomical: no bone, no
//! tendon, no person was measured. For figures about people use scans.

mod elbow;
mod noise;
mod tube;

use crate::design::Design;
use crate::parameters::nearest_name;
use crate::surface::RawMesh;

/// The names of the limbs.
pub const NAMES: &[&str] = &["elbow"];

/// Fewest triangles of a sample: below, the elbow's features fall between the vertices.
pub const MIN_TRIANGLES: usize = 500;

/// Most triangles of a sample.
pub const MAX_TRIANGLES: usize = 2_000_000;

/// Most noise of a sample, in mm: more than any scanner that is fit for the purpose.
pub const MAX_NOISE_MM: f64 = 2.0;

/// A procedural limb and a design for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The limb in mm: triangles, counter-clockwise seen from outside, that share vertices.
    pub mesh: RawMesh,
    /// Wanted pressures on the limb's noiseless surface, a fabric and orientation markers.
    pub design: Design,
}

/// Why there is no such sample.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SampleError {
    /// No limb has this name.
    #[error(
        "there is no sample `{name}`; the nearest name is `{nearest}` (there are: {})",
        NAMES.join(", ")
    )]
    UnknownName {
        /// The name given.
        name: String,
        /// The known name nearest to it.
        nearest: &'static str,
    },
    /// The number of triangles is out of range.
    #[error("a sample cannot have {given} triangles: ask for {MIN_TRIANGLES} to {MAX_TRIANGLES}")]
    Triangles {
        /// The number asked for.
        given: usize,
    },
    /// The noise is out of range or no number.
    #[error("a sample cannot have noise of {given} mm: ask for 0 to {MAX_NOISE_MM} mm")]
    Noise {
        /// The noise asked for, in mm.
        given: f64,
    },
}

/// Makes the limb `name` with near `triangles` triangles (within 10 %) and Gaussian noise of
/// deviation `noise_mm` along the normal, as a scanner would add. The same arguments give the
/// same limb.
///
/// # Errors
/// If there is no such limb, or a number is out of range.
pub fn sample(name: &str, triangles: usize, noise_mm: f64) -> Result<Sample, SampleError> {
    if !(MIN_TRIANGLES..=MAX_TRIANGLES).contains(&triangles) {
        return Err(SampleError::Triangles { given: triangles });
    }
    if !(0.0..=MAX_NOISE_MM).contains(&noise_mm) {
        return Err(SampleError::Noise { given: noise_mm });
    }
    match name {
        "elbow" => Ok(Sample {
            mesh: tube::triangulate(&elbow::Elbow, triangles, noise_mm),
            design: elbow::design(),
        }),
        _ => Err(SampleError::UnknownName {
            name: name.to_owned(),
            nearest: nearest_name(name, NAMES.iter().copied()).unwrap_or_default(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::surface::{Surface, VertexId};

    fn surface(mesh: &RawMesh) -> Surface {
        let triangles =
            mesh.polygons.iter().map(|p| [p[0], p[1], p[2]].map(VertexId::new)).collect();
        Surface::new(mesh.points.clone(), triangles).unwrap()
    }

    #[test]
    fn every_limb_is_an_outward_tube_of_well_shaped_triangles() {
        for name in NAMES {
            for triangles in [500, 2_000, 20_000] {
                let mesh = sample(name, triangles, 0.0).unwrap().mesh;
                let surface = surface(&mesh);
                assert_eq!(surface.euler_characteristic(), 0);
                assert_eq!(surface.boundary_loops().len(), 2);
                assert_eq!(surface.components().1, 1);
                let count = surface.triangle_count() as f64;
                assert!((count / triangles as f64 - 1.0).abs() < 0.1, "{count} of {triangles}");
                let smallest = surface
                    .triangle_ids()
                    .flat_map(|t| {
                        let p = surface.corners(t);
                        (0..3).map(move |k| {
                            (p[(k + 1) % 3] - p[k]).angle_between(p[(k + 2) % 3] - p[k])
                        })
                    })
                    .fold(PI, f64::min);
                assert!(smallest > 15f64.to_radians(), "{}°", smallest.to_degrees());
                // Divergence theorem: the volume of all rays from the origin, inside the limb,
                // to its skin; negative if the triangles faced inward.
                let volume: f64 = surface
                    .triangle_ids()
                    .map(|t| {
                        let [a, b, c] = surface.corners(t);
                        a.dot(b.cross(c)) / 6.0
                    })
                    .sum();
                assert!(volume > 1e5, "{volume} mm³");
            }
        }
    }

    #[test]
    fn the_same_arguments_give_the_same_limb() {
        for noise in [0.0, 0.3] {
            let [a, b] = [(); 2].map(|()| sample("elbow", 3_000, noise).unwrap());
            let bits = |s: &Sample| -> Vec<[u64; 3]> {
                s.mesh.points.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
            };
            assert_eq!(bits(&a), bits(&b));
            assert_eq!(a, b);
        }
    }

    #[test]
    fn noise_is_along_the_normal_and_as_large_as_asked() {
        let clean = sample("elbow", 20_000, 0.0).unwrap().mesh;
        let noisy = sample("elbow", 20_000, 0.4).unwrap().mesh;
        assert_eq!(clean.polygons, noisy.polygons);
        let normals = surface(&clean).vertex_normals();
        let count = clean.points.len() as f64;
        let (mut square, mut sideways) = (0.0, 0.0);
        for ((a, b), n) in clean.points.iter().zip(&noisy.points).zip(normals) {
            let moved = *b - *a;
            square += moved.length_squared();
            sideways += (moved - moved.dot(n) * n).length_squared();
        }
        let deviation = (square / count).sqrt();
        // The standard error of a deviation over 10,000 draws is 0.7 %.
        assert!((deviation / 0.4 - 1.0).abs() < 0.03, "{deviation} mm");
        assert!((sideways / square).sqrt() < 0.1);
    }

    #[test]
    fn a_wrong_argument_is_named_with_the_remedy() {
        let message = |name, triangles, noise| sample(name, triangles, noise).unwrap_err();
        assert_eq!(
            message("elbwo", 1_000, 0.0).to_string(),
            "there is no sample `elbwo`; the nearest name is `elbow` (there are: elbow)"
        );
        assert_eq!(
            message("elbow", 499, 0.0).to_string(),
            "a sample cannot have 499 triangles: ask for 500 to 2000000"
        );
        assert!(matches!(message("elbow", 2_000_001, 0.0), SampleError::Triangles { .. }));
        for noise in [-0.1, 2.1, f64::NAN, f64::INFINITY] {
            assert!(matches!(message("elbow", 1_000, noise), SampleError::Noise { .. }));
        }
    }
}
