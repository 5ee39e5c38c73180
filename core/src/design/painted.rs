//! Pressures painted onto a mesh, a value for every vertex, as the points that the method takes.
//!
//! The method meets a pressure at a point; a brush leaves thousands of them, millimetres apart, which
//! would ask every thread for ever so slightly different strains and fill the report with pages. So
//! painted vertices are sampled at least [`APART_MM`] apart (curvature, and with it pressure, is
//! known over 10 mm and no finer), in the order of the vertices; more than [`MOST_POINTS`] are never
//! made, the distance grows instead. Each point wants the mean of the painted values nearest to it,
//! weighted by the area round each vertex, so that a fine mesh counts no more than a coarse one.
//! Limit: where two colours meet, the points beside the border blend them.

use glam::DVec3;

use super::WantedPressure;
use crate::warning::Warning;

/// Least distance between two points, in mm.
pub const APART_MM: f64 = 10.0;

/// No more points are made.
pub const MOST_POINTS: usize = 200;

/// No vertex beyond this, in mm, is sampled: no surface reaches there.
const FARTHEST: f64 = 1e9;

/// What the distance grows by where there would be too many points.
const GROWTH: f64 = 1.25;

/// Painted pressures as points.
#[derive(Debug, Clone, PartialEq)]
pub struct Painted {
    /// The points, each at a painted vertex.
    pub pressures: Vec<WantedPressure>,
    /// How many vertices became how many points, where these are fewer.
    pub warning: Option<Warning>,
}

/// The points for a field of pressures (kPa) over the vertices of a mesh (mm); zero is not asked.
///
/// Faces that name no vertex are passed over: whether the mesh is sound is for others to say.
#[must_use]
pub fn condense(points: &[DVec3], faces: &[Vec<usize>], kpa: &[f64]) -> Painted {
    let painted: Vec<usize> = (0..points.len().min(kpa.len()))
        .filter(|&v| kpa[v] > 0.0 && points[v].abs().max_element() <= FARTHEST)
        .collect();
    let mut apart = APART_MM;
    let samples = loop {
        match sample(points, &painted, apart) {
            Some(samples) => break samples,
            None => apart *= GROWTH,
        }
    };
    let area = areas(points, faces);
    let mut sums = vec![[0.0; 4]; samples.len()];
    for &v in &painted {
        let gap = |&s: &usize| points[s].distance_squared(points[v]);
        let nearest =
            (0..samples.len()).min_by(|&a, &b| gap(&samples[a]).total_cmp(&gap(&samples[b])));
        if let Some(nearest) = nearest {
            let [weighted, weight, plain, count] = &mut sums[nearest];
            *weighted += area[v] * kpa[v];
            *weight += area[v];
            *plain += kpa[v];
            *count += 1.0;
        }
    }
    let mean = |[weighted, weight, plain, count]: [f64; 4]| {
        if weight > 0.0 { weighted / weight } else { plain / count }
    };
    let pressures: Vec<WantedPressure> = samples
        .iter()
        .zip(sums)
        .map(|(&s, sums)| WantedPressure { at: points[s], kpa: mean(sums) })
        .collect();
    let warning = (pressures.len() < painted.len()).then(|| {
        Warning::new(
            "painted_condensed",
            format!(
                "the pressure painted on {} vertices is asked for at {} points, at least {apart:.0} \
                 mm apart, each the mean of the painted values round it",
                painted.len(),
                pressures.len()
            ),
        )
    });
    Painted { pressures, warning }
}

/// Vertices at least `apart` from each other that leave none farther than that; `None` if they are
/// too many.
fn sample(points: &[DVec3], painted: &[usize], apart: f64) -> Option<Vec<usize>> {
    let mut samples: Vec<usize> = Vec::new();
    for &v in painted {
        let near = |&s: &usize| points[s].distance_squared(points[v]) < apart * apart;
        if !samples.iter().any(near) {
            if samples.len() == MOST_POINTS {
                return None;
            }
            samples.push(v);
        }
    }
    Some(samples)
}

/// The area round each vertex, in mm²: a third of that of its triangles.
fn areas(points: &[DVec3], faces: &[Vec<usize>]) -> Vec<f64> {
    let mut area = vec![0.0; points.len()];
    for face in faces {
        for k in 1..face.len().saturating_sub(1) {
            let corners = [face[0], face[k], face[k + 1]];
            let [Some(&a), Some(&b), Some(&c)] = corners.map(|v| points.get(v)) else { continue };
            let share = (b - a).cross(c - a).length() / 6.0;
            if share.is_finite() {
                corners.iter().for_each(|&v| area[v] += share);
            }
        }
    }
    area
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of squares, 1 mm wide, from x = 0 to `length` mm.
    fn strip(length: usize) -> (Vec<DVec3>, Vec<Vec<usize>>) {
        let points =
            (0..=length).flat_map(|x| [0.0, 1.0].map(|y| DVec3::new(x as f64, y, 0.0))).collect();
        let faces = (0..length).map(|i| vec![2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]).collect();
        (points, faces)
    }

    #[test]
    fn a_painted_strip_becomes_points_ten_millimetres_apart_with_local_means() {
        let (points, faces) = strip(100);
        let kpa: Vec<f64> = points.iter().map(|p| if p.x < 50.0 { 1.0 } else { 3.0 }).collect();
        let Painted { pressures, warning } = condense(&points, &faces, &kpa);
        assert_eq!(pressures.len(), 11);
        assert_eq!(pressures[0], WantedPressure { at: points[0], kpa: 1.0 });
        assert_eq!(pressures[10].kpa, 3.0);
        // Round x = 50 from 45 to 55: five columns and a half want 1.
        assert!((1.5..2.5).contains(&pressures[5].kpa), "{}", pressures[5].kpa);
        let warning = warning.unwrap();
        assert_eq!(warning.code, "painted_condensed");
        assert!(warning.message.contains("202 vertices") && warning.message.contains("11 points"));
    }

    #[test]
    fn means_are_weighted_by_area_and_without_area_plain() {
        // Two triangles at the origin, the second of ninefold area.
        let points = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (3.0, 0.0), (0.0, 3.0)]
            .map(|(x, y)| DVec3::new(x, y, 0.0));
        let kpa = [0.0, 1.0, 0.0, 2.0, 0.0];
        let faces = [vec![0, 1, 2], vec![0, 3, 4]];
        let of = |faces: &[Vec<usize>]| condense(&points, faces, &kpa).pressures[0].kpa;
        assert!((of(&faces) - 1.9).abs() < 1e-12);
        assert!((of(&[vec![0, 1, 99]]) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn never_more_points_than_the_most_and_single_vertices_stay_themselves() {
        let (points, faces) = strip(5000);
        let many = condense(&points, &faces, &vec![1.0; points.len()]);
        assert!((100..=MOST_POINTS).contains(&many.pressures.len()), "{}", many.pressures.len());
        let mut kpa = vec![0.0; points.len()];
        (kpa[40], kpa[100]) = (1.5, 2.5);
        let two = condense(&points, &faces, &kpa);
        assert_eq!(two.pressures.iter().map(|p| p.kpa).collect::<Vec<_>>(), [1.5, 2.5]);
        assert_eq!(two.warning, None);
        assert!(condense(&points, &faces, &[]).pressures.is_empty());
    }
}
