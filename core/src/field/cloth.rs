//! The fabric at every vertex of the disk: strains, thread directions and areas.
//!
//! A vertex has the means over its own triangles, weighted by their area in the pattern. The copies
//! of a seam's place are kept apart here: threads may meet a seam at different angles from its two
//! sides, and what they do to the limb is computed on each side before it is averaged.

use glam::{DVec2, DVec3};

use crate::pressure::{Stretch, triangle_stretch};
use crate::surface::Surface;

/// The fabric at the vertices of a disk, each from its own side of a seam.
pub(super) struct Cloth {
    /// Mean strains and area stretch.
    pub(super) stretch: Vec<Stretch>,
    /// Direction of the warp thread, of unit length; zero where the pattern has no area.
    pub(super) warp: Vec<DVec3>,
    /// Direction of the weft thread.
    pub(super) weft: Vec<DVec3>,
    /// A third of its triangles' area in the pattern, in mm².
    pub(super) rest_area: Vec<f64>,
    /// A third of its triangles' area on the limb, in mm².
    pub(super) worn_area: Vec<f64>,
}

impl Cloth {
    pub(super) fn new(disk: &Surface, coordinates: &[DVec2]) -> Self {
        let n = disk.vertex_count();
        let (mut warp, mut weft) = (vec![DVec3::ZERO; n], vec![DVec3::ZERO; n]);
        let (mut warp_length, mut weft_length) = (vec![0.0; n], vec![0.0; n]);
        let (mut rest_area, mut worn_area) = (vec![0.0; n], vec![0.0; n]);
        let mut covered = vec![0.0; n];
        for t in disk.triangle_ids() {
            let worn = disk.area(t) / 3.0;
            let stretch = triangle_stretch(disk, coordinates, t);
            for v in disk.triangle(t).map(|v| v.index()) {
                worn_area[v] += worn;
                let Some(stretch) = stretch else { continue };
                let rest = stretch.rest_area.abs() / 3.0;
                warp[v] += rest * stretch.warp;
                weft[v] += rest * stretch.weft;
                warp_length[v] += rest * stretch.warp.length();
                weft_length[v] += rest * stretch.weft.length();
                rest_area[v] += rest;
                covered[v] += worn;
            }
        }
        let stretch = (0..n)
            .map(|v| match rest_area[v] {
                rest if rest > 0.0 => Stretch {
                    warp: warp_length[v] / rest - 1.0,
                    weft: weft_length[v] / rest - 1.0,
                    area: covered[v] / rest,
                },
                _ => Stretch::without_shear(0.0, 0.0),
            })
            .collect();
        let unit = |sums: Vec<DVec3>| sums.into_iter().map(DVec3::normalize_or_zero).collect();
        Self { stretch, warp: unit(warp), weft: unit(weft), rest_area, worn_area }
    }
}
