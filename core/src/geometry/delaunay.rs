//! Triangles of better shape over the same vertices: the intrinsic Delaunay triangulation.
//!
//! Bobenko & Springborn, *A discrete Laplace-Beltrami operator for simplicial surfaces*, 2007. Edges are flipped in the
//! surface, not through space: two triangles are unfolded, and the other diagonal of their quadrilateral is drawn on
//! them. The surface keeps its shape and its lengths; linear functions over the triangles come nearer to smooth ones.

use std::collections::BTreeSet;

use glam::DVec2;

use crate::surface::{HalfEdgeId, Surface, VertexId};

/// The angles opposite an edge may sum to more than a straight one by so much, in radians: what is nearly as good stays.
const ALLOWED: f64 = 0.2;

/// A smaller share of bad edges does no harm: that beside a cut, or where a scan is patched.
const FEW: f64 = 0.02;

/// The triangulation.
pub struct Delaunay {
    /// The same vertices with other triangles, whose edges are chords where the surface bends.
    pub surface: Surface,
    /// Lengths of the triangles' edges in the surface as it was, in mm, edge k from corner k to corner k + 1.
    pub lengths: Vec<[f64; 3]>,
}

impl Delaunay {
    /// That of a surface whose triangles lie the right way round in the `plane`, as far as all of these do, too; `None`
    /// where its own triangles are nearly as good.
    #[must_use]
    pub fn new(surface: &Surface, plane: &[DVec2]) -> Option<Self> {
        let mut mesh = Mesh::new(surface, plane);
        let mut next: Vec<usize> = (0..mesh.twins.len()).filter(|&h| mesh.is_bad(h)).collect();
        if next.len() as f64 <= FEW * mesh.twins.len() as f64 {
            return None;
        }
        let mut edges: BTreeSet<[usize; 2]> = (0..mesh.twins.len()).map(|h| mesh.ends(h)).collect();
        let mut flipped = false;
        while let Some(h) = next.pop() {
            if mesh.is_bad(h)
                && let Some(round) = mesh.flip(h, &mut edges)
            {
                next.extend(round);
                flipped = true;
            }
        }
        if !flipped {
            return None;
        }
        let triangles = mesh.corners.iter().map(|t| t.map(VertexId::new)).collect();
        // Never none for a surface that was sound.
        let surface = Surface::new(surface.points().to_vec(), triangles).ok()?;
        Some(Self { surface, lengths: mesh.lengths })
    }
}

/// Triangles on their way. Half-edge 3 t + k runs from corner k of triangle t to the next.
struct Mesh<'a> {
    plane: &'a [DVec2],
    corners: Vec<[usize; 3]>,
    lengths: Vec<[f64; 3]>,
    twins: Vec<Option<usize>>,
}

/// The half-edge so many after another in its triangle.
fn after(h: usize, many: usize) -> usize {
    h - h % 3 + (h + many) % 3
}

impl<'a> Mesh<'a> {
    fn new(surface: &Surface, plane: &'a [DVec2]) -> Self {
        let of = |t| std::array::from_fn(|k| surface.length(HalfEdgeId::of(t, k)));
        Self {
            plane,
            corners: surface.triangles().iter().map(|t| t.map(VertexId::index)).collect(),
            lengths: surface.triangle_ids().map(of).collect(),
            twins: surface.half_edges().map(|h| surface.twin(h).map(HalfEdgeId::index)).collect(),
        }
    }

    fn start(&self, h: usize) -> usize {
        self.corners[h / 3][h % 3]
    }

    fn length(&self, h: usize) -> f64 {
        self.lengths[h / 3][h % 3]
    }

    fn ends(&self, h: usize) -> [usize; 2] {
        let (a, b) = (self.start(h), self.start(after(h, 1)));
        [a.min(b), a.max(b)]
    }

    /// The corner opposite a half-edge, which runs along x from the origin, its triangle above.
    fn apex(&self, h: usize) -> DVec2 {
        let [base, right, left] = [0, 1, 2].map(|k| self.length(after(h, k)));
        let x = (base * base + left * left - right * right) / (2.0 * base);
        DVec2::new(x, (left * left - x * x).max(0.0).sqrt())
    }

    /// The angle opposite a half-edge.
    fn opposite(&self, h: usize) -> f64 {
        let apex = self.apex(h);
        (DVec2::new(self.length(h), 0.0) - apex).angle_to(-apex).abs()
    }

    fn is_bad(&self, h: usize) -> bool {
        self.twins[h].is_some_and(|twin| {
            self.opposite(h) + self.opposite(twin) > std::f64::consts::PI + ALLOWED
        })
    }

    /// Draws the other diagonal; the four half-edges round both triangles, or `None` where there is that edge, or in the
    /// plane no room for it.
    fn flip(&mut self, h: usize, edges: &mut BTreeSet<[usize; 2]>) -> Option<[usize; 4]> {
        let g = self.twins[h]?;
        let (a, b) = (self.start(h), self.start(g));
        let (c, d) = (self.start(after(h, 2)), self.start(after(g, 2)));
        let lies_right = |corners: [usize; 3]| {
            let [p, q, r] = corners.map(|v| self.plane[v]);
            (q - p).perp_dot(r - p) > 0.0
        };
        let fits = lies_right([a, d, c]) && lies_right([d, b, c]);
        if c == d || !fits || !edges.insert([c.min(d), c.max(d)]) {
            return None;
        }
        edges.remove(&[a.min(b), a.max(b)]);
        let (above, below) = (self.apex(h), self.apex(g));
        // Below it the other half-edge runs from b to a.
        let below = DVec2::new(self.length(h) - below.x, -below.y);
        let diagonal = above.distance(below);
        let old = [after(g, 1), after(h, 2), after(g, 2), after(h, 1)];
        let [ad, ca, db, bc] = old.map(|h| (self.length(h), self.twins[h]));
        let (t, s) = (h / 3, g / 3);
        (self.corners[t], self.corners[s]) = ([a, d, c], [d, b, c]);
        self.lengths[t] = [ad.0, diagonal, ca.0];
        self.lengths[s] = [db.0, bc.0, diagonal];
        let round = [3 * t, 3 * t + 2, 3 * s, 3 * s + 1];
        for (new, (_, twin)) in round.into_iter().zip([ad, ca, db, bc]) {
            self.twins[new] = twin;
            if let Some(twin) = twin {
                self.twins[twin] = Some(new);
            }
        }
        self.twins[3 * t + 1] = Some(3 * s + 2);
        self.twins[3 * s + 2] = Some(3 * t + 1);
        Some(round)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec3;

    use super::*;

    /// Rows of triangles that lean over by half an edge, drawn by the longer diagonals: angles of 30 and 120 degrees.
    fn rhombs(place: impl Fn(DVec2) -> DVec3) -> (Surface, Vec<DVec2>) {
        let n = 12;
        let plane: Vec<DVec2> = (0..n * n)
            .map(|k| {
                let (i, j) = ((k / n) as f64, (k % n) as f64);
                DVec2::new(j + 0.5 * i, 0.75f64.sqrt() * i)
            })
            .collect();
        let id = |i: usize, j: usize| VertexId::new(i * n + j);
        let mut triangles = Vec::new();
        for i in 0..n - 1 {
            for j in 0..n - 1 {
                let [a, b, c, d] = [id(i, j), id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        let points = plane.iter().map(|&p| place(p)).collect();
        (Surface::new(points, triangles).unwrap(), plane)
    }

    /// Heron's formula.
    fn area([a, b, c]: [f64; 3]) -> f64 {
        let s = 0.5 * (a + b + c);
        (s * (s - a) * (s - b) * (s - c)).sqrt()
    }

    #[test]
    fn a_sheet_of_rhombs_gets_equilateral_triangles() {
        let (surface, plane) = rhombs(|p| p.extend(0.0));
        let Delaunay { surface: other, lengths } = Delaunay::new(&surface, &plane).unwrap();
        assert_eq!(other.triangle_count(), surface.triangle_count());
        for length in lengths.iter().flatten() {
            assert!((length - 1.0).abs() < 1e-12, "{length}");
        }
        assert!(Delaunay::new(&other, &plane).is_none());
    }

    #[test]
    fn a_bent_surface_keeps_its_area_and_lengths_agree_on_both_sides_of_an_edge() {
        let bent = |p: DVec2| {
            let angle = p.x / 4.0;
            DVec3::new(4.0 * angle.sin(), p.y, 4.0 * angle.cos() + 0.05 * p.y * p.y)
        };
        let (surface, plane) = rhombs(bent);
        let other = Delaunay::new(&surface, &plane).unwrap();
        let whole: f64 = other.lengths.iter().map(|&lengths| area(lengths)).sum();
        assert!((whole / surface.total_area() - 1.0).abs() < 1e-12);
        let length = |h: HalfEdgeId| other.lengths[h.triangle().index()][h.corner()];
        let mut longer = 0;
        for h in other.surface.half_edges() {
            if let Some(twin) = other.surface.twin(h) {
                assert!((length(h) - length(twin)).abs() < 1e-12);
                let mesh =
                    Mesh { lengths: other.lengths.clone(), ..Mesh::new(&other.surface, &plane) };
                let sum = mesh.opposite(h.index()) + mesh.opposite(twin.index());
                assert!(sum <= PI + ALLOWED + 1e-9, "{sum}");
            }
            // In the surface the way is longer than through space.
            assert!(length(h) > other.surface.length(h) - 1e-12);
            longer += usize::from(length(h) > other.surface.length(h) + 1e-4);
        }
        assert!(longer > 100, "{longer}");
    }

    #[test]
    fn what_has_no_room_in_the_plane_stays() {
        let (surface, mut plane) = rhombs(|p| p.extend(0.0));
        let [a, c] = [12 * 5 + 5, 12 * 6 + 6];
        let has_diagonal = |plane: &[DVec2]| {
            let other = Delaunay::new(&surface, plane).unwrap().surface;
            other.neighbours(VertexId::new(a)).any(|v| v == VertexId::new(c))
        };
        assert!(!has_diagonal(&plane));
        // Beyond the line through the other two corners, where the quadrilateral is not convex.
        plane[a] = plane[a].lerp(plane[c], 0.7);
        assert!(has_diagonal(&plane));
    }
}
