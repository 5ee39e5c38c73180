//! A round opening in a limb, such as the one for the thumb.
//!
//! The mesh is not cut: the vertices next to the rim slide along one of their edges onto it, and
//! the triangles inside are dropped, so that the rim is smooth and no triangle gets small.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::tube::Limb;

/// What lies within a cylinder round an axis that leaves the limb.
#[derive(Debug, Clone, Copy)]
pub(super) struct Opening {
    /// A point of the axis inside the limb, in mm.
    pub(super) from: DVec3,
    /// Unit direction of the axis, outward.
    pub(super) axis: DVec3,
    /// Radius of the cylinder, in mm.
    pub(super) radius: f64,
}

impl Opening {
    /// How far a point lies outside of the cylinder, in mm; negative inside.
    pub(super) fn outside(&self, point: DVec3) -> f64 {
        let from = point - self.from;
        let ahead = from.dot(self.axis);
        if ahead < 0.0 {
            // The far side of the limb.
            return from.length();
        }
        (from - ahead * self.axis).length() - self.radius
    }

    /// Takes the opening out of a mesh whose vertices are given by (station, angle).
    pub(super) fn cut(
        &self,
        limb: &dyn Limb,
        places: &mut Vec<DVec2>,
        faces: &mut Vec<[usize; 3]>,
    ) {
        let outside: Vec<f64> =
            places.iter().map(|place| self.outside(limb.point(place.x, place.y))).collect();
        // For every vertex the nearest place where one of its edges meets the rim, if that is in
        // its own half of the edge.
        let mut nearest: Vec<Option<(f64, DVec2)>> = vec![None; places.len()];
        for face in faces.iter() {
            for k in 0..3 {
                let [a, b] = [face[k], face[(k + 1) % 3]];
                if (outside[a] < 0.0) == (outside[b] < 0.0) {
                    continue;
                }
                let step = shortest(places[b] - places[a]);
                let share = self.meets(limb, places[a], step, outside[a] < 0.0);
                let (vertex, share, place) = if share < 0.5 {
                    (a, share, places[a] + share * step)
                } else {
                    (b, 1.0 - share, places[a] + share * step)
                };
                if nearest[vertex].is_none_or(|(least, _)| share < least) {
                    nearest[vertex] = Some((share, place));
                }
            }
        }
        for (place, nearest) in places.iter_mut().zip(&nearest) {
            if let Some((_, onto)) = nearest {
                *place = *onto;
            }
        }
        faces.retain(|face| {
            face.iter().any(|&v| nearest[v].is_none() && outside[v] >= 0.0)
        });
        drop_unused(places, faces);
    }

    /// The share of an edge at which it meets the rim, by bisection.
    fn meets(&self, limb: &dyn Limb, from: DVec2, step: DVec2, starts_inside: bool) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = f64::midpoint(low, high);
            let place = from + middle * step;
            let inside = self.outside(limb.point(place.x, place.y)) < 0.0;
            if inside == starts_inside { low = middle } else { high = middle }
        }
        f64::midpoint(low, high)
    }
}

/// A step in (station, angle) taken the short way round the limb.
fn shortest(step: DVec2) -> DVec2 {
    DVec2::new(step.x, (step.y + PI).rem_euclid(TAU) - PI)
}

/// Drops the vertices that no face uses and numbers the others anew.
fn drop_unused(places: &mut Vec<DVec2>, faces: &mut [[usize; 3]]) {
    let mut used = vec![false; places.len()];
    for &v in faces.iter().flatten() {
        used[v] = true;
    }
    let mut next = 0;
    let number: Vec<usize> = used
        .iter()
        .map(|&used| {
            let number = next;
            next += usize::from(used);
            number
        })
        .collect();
    for v in faces.iter_mut().flatten() {
        *v = number[*v];
    }
    let mut used = used.into_iter();
    places.retain(|_| used.next().unwrap_or(false));
}
