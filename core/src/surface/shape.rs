//! What a surface is as a whole, from its Euler characteristic V − E + F = 2 − 2 g − b.

use super::topology::Surface;

/// What a connected surface is as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// One boundary loop: can be laid flat as it is.
    Disk,
    /// Two boundary loops: a cut from one to the other makes it a disk.
    Tube,
    /// Three or more boundary loops, say a tube with a thumb hole.
    WithOpenings {
        /// Number of boundary loops.
        loops: usize,
    },
    /// No boundary: a limb that must be opened first.
    Closed,
    /// One handle or more, like a ring's: no cut between boundary loops makes it a disk.
    Handles {
        /// Number of handles.
        genus: usize,
        /// Number of boundary loops; may be zero.
        loops: usize,
    },
}

/// What the connected surface `surface` is as a whole.
#[must_use]
pub fn shape_of(surface: &Surface) -> Shape {
    let loops = surface.boundary_loops().len();
    let signed = i64::try_from(loops).expect("counts fit 32 bits");
    // Orientable and connected: 2 g is even and not negative.
    let genus = usize::try_from((2 - signed - surface.euler_characteristic()) / 2).unwrap_or(0);
    match (genus, loops) {
        (0, 0) => Shape::Closed,
        (0, 1) => Shape::Disk,
        (0, 2) => Shape::Tube,
        (0, loops) => Shape::WithOpenings { loops },
        (genus, loops) => Shape::Handles { genus, loops },
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::surface::VertexId;

    /// A grid of `n × m` squares, closed round the first way and, if `torus`, the second,
    /// without the squares for which `hole` is true.
    fn wrapped(n: usize, m: usize, torus: bool, hole: impl Fn(usize, usize) -> bool) -> Surface {
        let rows = if torus { m } else { m + 1 };
        let points = (0..n * rows).map(|i| DVec3::new((i % n) as f64, (i / n) as f64, 0.0));
        let id = |i: usize, j: usize| VertexId::new(i % n + n * (j % rows));
        let mut triangles = Vec::new();
        for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))).filter(|&(i, j)| !hole(i, j))
        {
            triangles.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
            triangles.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
        }
        Surface::new(points.collect(), triangles).unwrap()
    }

    #[test]
    fn shapes_are_told_by_loops_and_genus() {
        let triangle = Surface::new(
            vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            vec![[VertexId::new(0), VertexId::new(1), VertexId::new(2)]],
        );
        assert_eq!(shape_of(&triangle.unwrap()), Shape::Disk);
        let whole = |_, _| false;
        assert_eq!(shape_of(&wrapped(5, 6, false, whole)), Shape::Tube);
        let thumb = |i, j| i == 2 && j == 3;
        assert_eq!(shape_of(&wrapped(5, 6, false, thumb)), Shape::WithOpenings { loops: 3 });
        assert_eq!(shape_of(&wrapped(5, 6, true, whole)), Shape::Handles { genus: 1, loops: 0 });
        assert_eq!(shape_of(&wrapped(5, 6, true, thumb)), Shape::Handles { genus: 1, loops: 1 });
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let sides = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let sides = sides.iter().map(|t| t.map(VertexId::new)).collect();
        assert_eq!(shape_of(&Surface::new(points, sides).unwrap()), Shape::Closed);
    }
}
