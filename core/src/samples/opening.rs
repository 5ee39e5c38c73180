//! A round opening in a limb, such as the one for the thumb.
//!
//! The mesh is not cut: the vertices next to the rim slide along one of their edges onto it, and
//! the triangles inside are dropped, so that the rim is smooth and no triangle gets small.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::shape::Bump;

/// The top of a bump, taken off.
#[derive(Debug, Clone, Copy)]
pub(super) struct Opening {
    /// The bump, such as the base of the thumb.
    pub(super) bump: Bump,
    /// The height on the bump at which the rim runs, in mm.
    pub(super) height: f64,
}

impl Opening {
    /// Whether a place (station, angle) lies in the opening.
    fn holds(&self, place: DVec2) -> bool {
        self.bump.at(place.x, place.y) > self.height
    }

    /// Takes the opening out of a mesh whose vertices are given by (station, angle).
    pub(super) fn cut(&self, places: &mut Vec<DVec2>, faces: &mut Vec<[usize; 3]>) {
        let inside: Vec<bool> = places.iter().map(|&place| self.holds(place)).collect();
        // For every vertex the nearest place where one of its edges meets the rim, if that is in
        // its own half of the edge.
        let mut nearest: Vec<Option<(f64, DVec2)>> = vec![None; places.len()];
        for face in faces.iter() {
            for k in 0..3 {
                let [a, b] = [face[k], face[(k + 1) % 3]];
                if inside[a] == inside[b] {
                    continue;
                }
                let step = shortest(places[b] - places[a]);
                let share = self.meets(places[a], step);
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
        faces.retain(|face| face.iter().any(|&v| nearest[v].is_none() && !inside[v]));
        drop_unused(places, faces);
    }

    /// The share of an edge at which it meets the rim, by bisection.
    fn meets(&self, from: DVec2, step: DVec2) -> f64 {
        let starts_inside = self.holds(from);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = f64::midpoint(low, high);
            if self.holds(from + middle * step) == starts_inside {
                low = middle;
            } else {
                high = middle;
            }
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
