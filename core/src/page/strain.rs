//! Warp strain at every vertex of the pattern.

use glam::DVec2;

use crate::pressure::triangle_stretch;
use crate::surface::Surface;

/// Warp strain by vertex: |F e_x| − 1 of the triangles at the vertex, the mean weighted by their
/// area in the pattern (the weight that the woven model's springs have). `NaN` at a vertex whose
/// triangles have no area in the pattern.
#[must_use]
pub fn warp_strain(disk: &Surface, coordinates: &[DVec2]) -> Vec<f64> {
    let mut sums = vec![0.0; disk.vertex_count()];
    let mut areas = vec![0.0; disk.vertex_count()];
    for t in disk.triangle_ids() {
        let Some(stretch) = triangle_stretch(disk, coordinates, t) else { continue };
        let area = stretch.rest_area.abs();
        for v in disk.triangle(t) {
            sums[v.index()] += area * (stretch.warp.length() - 1.0);
            areas[v.index()] += area;
        }
    }
    sums.into_iter().zip(areas).map(|(sum, area)| sum / area).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::surface::VertexId;

    #[test]
    fn strains_are_means_over_the_pattern() {
        // Two strips of rest widths 10 and 30 mm side by side, stretched by 10 % and 50 %.
        let (rest, worn) = ([0.0, 10.0, 40.0], [0.0, 11.0, 56.0]);
        let mut points = Vec::new();
        let mut plane = Vec::new();
        for y in [0.0, 20.0] {
            for k in 0..3 {
                points.push(DVec3::new(worn[k], y, 0.0));
                plane.push(DVec2::new(rest[k], y));
            }
        }
        let id = VertexId::new;
        let triangles = (0..2)
            .flat_map(|k| [[id(k), id(k + 1), id(k + 4)], [id(k), id(k + 4), id(k + 3)]])
            .collect();
        let disk = Surface::new(points, triangles).unwrap();
        let strain = warp_strain(&disk, &plane);
        // At the lower middle meet one triangle of 100 mm² at 0.1 and two of 300 mm² at 0.5.
        let expected = [0.1, (100.0 * 0.1 + 600.0 * 0.5) / 700.0, 0.5];
        for k in 0..3 {
            assert!((strain[k] - expected[k]).abs() < 1e-12, "{k}: {}", strain[k]);
        }
    }
}
