//! How small triangles are to be.

use glam::DVec3;

/// Edges are as short as this at the places, in mm: some stitches of a knit. What is smaller is no sheet.
pub const FINEST_MM: f64 = 1.0;

/// Elsewhere they are as short as this share of the distance to the nearest.
const GROWTH: f64 = 0.25;

/// Lengths of edges: short at some places, longer with the distance from them.
#[derive(Debug, Clone, Default)]
pub struct Grading {
    places: Vec<DVec3>,
    /// The box of them all.
    low: DVec3,
    high: DVec3,
}

impl Grading {
    /// That of these places; without any it wants nothing.
    pub fn new(places: Vec<DVec3>) -> Self {
        let low = places.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = places.iter().copied().reduce(DVec3::max).unwrap_or_default();
        Self { places, low, high }
    }

    /// How long an edge is to be at a point, in mm, if it is not to be longer than `most`.
    pub fn length(&self, at: DVec3, most: f64) -> f64 {
        let length = |distance: f64| FINEST_MM.max(GROWTH * distance);
        // No place is nearer than the box of all.
        if self.places.is_empty() || length(at.distance(at.clamp(self.low, self.high))) >= most {
            return most;
        }
        let nearest =
            self.places.iter().map(|p| p.distance_squared(at)).fold(f64::INFINITY, f64::min);
        length(nearest.sqrt()).min(most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_short_at_places_and_grow_with_the_distance_to_the_nearest() {
        let grading = Grading::new(vec![DVec3::ZERO, DVec3::new(100.0, 0.0, 0.0)]);
        let at = |x: f64, most: f64| grading.length(DVec3::new(x, 0.0, 0.0), most);
        assert_eq!(at(2.0, 9.0), FINEST_MM);
        assert!((at(20.0, 9.0) - GROWTH * 20.0).abs() < 1e-12);
        assert!((at(90.0, 9.0) - GROWTH * 10.0).abs() < 1e-12);
        assert_eq!(at(20.0, 4.0), 4.0);
        assert_eq!(at(-1000.0, 9.0), 9.0);
        assert_eq!(Grading::default().length(DVec3::ZERO, 9.0), 9.0);
    }
}
