//! Sewn edges have equal lengths in the pattern.
//!
//! For every edge of a seam and the one sewn to it, of lengths l and r in the pattern and w on the
//! worn surface, the energy gets ½ κ (l − r)² / w. κ is so large that what remains of a mismatch of
//! some per cent is some hundredths of a per cent. The force acts along the seam's course smoothed over
//! [`COURSE_MM`], not along the single edges: otherwise the shorter side would lengthen by a zigzag as
//! fine as its edges.
//!
//! While a Hessian is kept its courses are, too: a force across them, where a mismatch is still on its way, would
//! move the fabric as if nothing held it. What turns with the fabric is the tension that the Hessian's last step has
//! left ([`Pull`]): so the seams pull along their own courses at rest, wherever the Hessian is from.

use glam::DVec2;

use crate::design::Fabric;
use crate::seams::Seam;
use crate::surface::Surface;

/// κ over the fabric's largest stiffness, in mm: holds against the pull of cloth some 50 mm wide that
/// wants a mismatch of 2 % to within 0.004 %.
const STIFFNESS_MM: f64 = 25_000.0;

/// Length over which a seam's direction is averaged, in mm. A side that is pushed together by P, in N, folds where P is
/// more than half of this times the fabric's shear stiffness, in N/mm: over 10 mm an ankle's did, on the way from
/// one pressure to another.
const COURSE_MM: f64 = 20.0;

/// An edge whose direction has less than this of its course's has folded: along the course it would be closed where it
/// gapes, so it pulls along itself.
const FOLDED: f64 = 0.5;

/// An edge of a seam and the one sewn to it.
#[derive(Debug, Clone, Copy)]
pub struct SewnEdge {
    left: [usize; 2],
    right: [usize; 2],
    /// On the worn surface, in mm.
    worn: f64,
    /// Its seam, and where it begins along it, in mm.
    seam: usize,
}

/// The sewn edges of a surface, and for each the vertices that it couples.
pub struct Sewn {
    edges: Vec<SewnEdge>,
    cliques: Vec<Vec<usize>>,
}

/// The courses of the seams at some place: derivatives of every l − r by the coordinates of its
/// clique's vertices.
#[derive(Default)]
pub struct Courses(Vec<Vec<f64>>);

impl Sewn {
    /// The sewn edges of these seams.
    pub fn new(surface: &Surface, seams: &[Seam]) -> Self {
        let mut edges = Vec::new();
        let mut cliques = Vec::new();
        for (number, seam) in seams.iter().enumerate() {
            for (l, r) in seam.left.windows(2).zip(seam.right.windows(2)) {
                let worn = surface.point(l[0]).distance(surface.point(l[1]));
                let index = |pair: &[crate::surface::VertexId]| [pair[0].index(), pair[1].index()];
                let (left, right) = (index(l), index(r));
                let mut clique = vec![left[0], left[1], right[0], right[1]];
                clique.sort_unstable();
                clique.dedup();
                edges.push(SewnEdge { left, right, worn, seam: number });
                cliques.push(clique);
            }
        }
        Self { edges, cliques }
    }

    /// The vertices that each edge couples.
    pub fn cliques(&self) -> &[Vec<usize>] {
        &self.cliques
    }

    /// κ in N.
    fn stiffness(fabric: &Fabric) -> f64 {
        STIFFNESS_MM * fabric.warp.max(fabric.weft).max(fabric.diagonal)
    }

    /// l − r, in mm.
    fn mismatch(edge: &SewnEdge, coordinates: &[DVec2]) -> f64 {
        let length = |[a, b]: [usize; 2]| coordinates[a].distance(coordinates[b]);
        length(edge.left) - length(edge.right)
    }

    /// The energy of all mismatches, in N·mm.
    pub fn energy(&self, coordinates: &[DVec2], fabric: &Fabric) -> f64 {
        let kappa = Self::stiffness(fabric);
        let edges = self.edges.iter();
        edges.map(|e| 0.5 * kappa * Self::mismatch(e, coordinates).powi(2) / e.worn).sum()
    }

    /// κ / w of every edge, in N/mm.
    pub fn stiffnesses(&self, fabric: &Fabric) -> impl Iterator<Item = f64> {
        let kappa = Self::stiffness(fabric);
        self.edges.iter().map(move |edge| kappa / edge.worn)
    }

    /// Adds the forces of the mismatches along courses, by every coordinate (x₀, y₀, x₁, …), in N.
    pub fn add_forces(
        &self,
        forces: &mut [f64],
        coordinates: &[DVec2],
        courses: &Courses,
        fabric: &Fabric,
    ) {
        let edges = self.edges.iter().zip(self.stiffnesses(fabric));
        for ((edge, stiffness), (row, clique)) in edges.zip(courses.0.iter().zip(&self.cliques)) {
            let force = stiffness * Self::mismatch(edge, coordinates);
            for (k, v) in clique.iter().enumerate() {
                forces[2 * v] += force * row[2 * k];
                forces[2 * v + 1] += force * row[2 * k + 1];
            }
        }
    }

    /// Adds what a motion along courses changes of the forces, by every coordinate, in N.
    pub fn add_change(
        &self,
        forces: &mut [f64],
        motion: &[DVec2],
        courses: &Courses,
        fabric: &Fabric,
    ) {
        let rows = courses.0.iter().zip(&self.cliques);
        for ((row, clique), stiffness) in rows.zip(self.stiffnesses(fabric)) {
            let force = stiffness * closed(row, clique, motion);
            for (k, v) in clique.iter().enumerate() {
                forces[2 * v] += force * row[2 * k];
                forces[2 * v + 1] += force * row[2 * k + 1];
            }
        }
    }

    /// The tensions of the edges after a motion along courses, in N.
    pub fn tensions(
        &self,
        coordinates: &[DVec2],
        courses: &Courses,
        motion: &[DVec2],
        fabric: &Fabric,
    ) -> Vec<f64> {
        let edges = self.edges.iter().zip(self.stiffnesses(fabric));
        edges
            .zip(courses.0.iter().zip(&self.cliques))
            .map(|((edge, stiffness), (row, clique))| {
                stiffness * (Self::mismatch(edge, coordinates) + closed(row, clique, motion))
            })
            .collect()
    }

    /// What tensions pull along courses beyond what they pull along others, by every coordinate, in N.
    fn turned(
        &self,
        courses: &Courses,
        others: &Courses,
        tensions: &[f64],
        vertices: usize,
    ) -> Vec<f64> {
        let mut forces = vec![0.0; 2 * vertices];
        for (((row, other), clique), tension) in
            courses.0.iter().zip(&others.0).zip(&self.cliques).zip(tensions)
        {
            for (k, v) in clique.iter().enumerate() {
                forces[2 * v] += tension * (row[2 * k] - other[2 * k]);
                forces[2 * v + 1] += tension * (row[2 * k + 1] - other[2 * k + 1]);
            }
        }
        forces
    }

    /// The courses at these pattern coordinates.
    pub fn courses(&self, coordinates: &[DVec2]) -> Courses {
        let left = self.directions(coordinates, |e| e.left);
        let right = self.directions(coordinates, |e| e.right);
        let edges = self.edges.iter().enumerate().zip(&self.cliques);
        let rows = edges.map(|((k, edge), clique)| {
            let mut row = vec![0.0; 2 * clique.len()];
            let mut add = |vertex: usize, by: DVec2| {
                if let Ok(at) = clique.binary_search(&vertex) {
                    row[2 * at] += by.x;
                    row[2 * at + 1] += by.y;
                }
            };
            add(edge.left[1], left[k]);
            add(edge.left[0], -left[k]);
            add(edge.right[1], -right[k]);
            add(edge.right[0], right[k]);
            row
        });
        Courses(rows.collect())
    }

    /// The direction of one side at every edge: that of the chord over [`COURSE_MM`] round it, or of the edge itself where
    /// it has folded.
    fn directions(
        &self,
        coordinates: &[DVec2],
        side: impl Fn(&SewnEdge) -> [usize; 2],
    ) -> Vec<DVec2> {
        let mut directions = vec![DVec2::ZERO; self.edges.len()];
        let mut at = 0;
        for run in self.edges.chunk_by(|a, b| a.seam == b.seam) {
            // Where every edge begins along the worn seam.
            let mut along = vec![0.0];
            for edge in run {
                along.push(along[along.len() - 1] + edge.worn);
            }
            for k in 0..run.len() {
                let middle = 0.5 * (along[k] + along[k + 1]);
                let from = along[..=k].partition_point(|&s| s < middle - 0.5 * COURSE_MM).min(k);
                let to =
                    along[k + 1..].partition_point(|&s| s <= middle + 0.5 * COURSE_MM).max(1) + k;
                let chord = coordinates[side(&run[to - 1])[1]] - coordinates[side(&run[from])[0]];
                let [a, b] = side(&run[k]);
                let own = (coordinates[b] - coordinates[a]).normalize_or_zero();
                let course = chord.normalize_or_zero();
                directions[at + k] = if course.dot(own) < FOLDED { own } else { course };
            }
            at += run.len();
        }
        directions
    }
}

/// What a motion of a clique's vertices along its course adds to l − r, in mm.
fn closed(row: &[f64], clique: &[usize], motion: &[DVec2]) -> f64 {
    let moved = clique.iter().zip(row.chunks_exact(2));
    moved.map(|(&v, by)| by[0] * motion[v].x + by[1] * motion[v].y).sum()
}

/// What the seams pull while a Hessian is kept.
#[derive(Default)]
pub struct Pull {
    /// Of every edge after the last step that a Hessian made, in N.
    tensions: Vec<f64>,
    /// What they pull along the courses as these have turned, beyond what they pull along those of the Hessian, in N;
    /// none before.
    turned: Vec<f64>,
}

impl Pull {
    /// That of an earlier fit, whose Hessian is kept.
    pub fn resumed(tensions: Vec<f64>) -> Self {
        Self { tensions, turned: Vec::new() }
    }

    /// The tensions, for the next fit.
    pub fn into_tensions(self) -> Vec<f64> {
        self.tensions
    }

    /// What is pulled beyond the Hessian's courses, by every coordinate, in N; none if nothing is.
    pub fn turned(&self) -> &[f64] {
        &self.turned
    }

    /// Lets the seams pull along their courses at these pattern coordinates, and not along the Hessian's.
    pub fn follow(&mut self, sewn: &Sewn, coordinates: &[DVec2], courses: &Courses) {
        if !self.tensions.is_empty() {
            let now = sewn.courses(coordinates);
            self.turned = sewn.turned(&now, courses, &self.tensions, coordinates.len());
        }
    }

    /// These are the tensions that the step of the Hessian at hand leaves.
    pub fn left(&mut self, tensions: Vec<f64>) {
        self.tensions = tensions;
    }
}

impl Courses {
    /// One row for each clique.
    pub fn rows(&self) -> &[Vec<f64>] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::VertexId;

    #[test]
    fn an_edge_that_has_folded_is_closed_along_itself() {
        // Two rows of four squares 2 mm wide; the outer rows are sewn together.
        let id = |i: usize, j: usize| VertexId::new(5 * i + j);
        let at = |v: usize| DVec2::new(2.0 * (v / 5) as f64, 2.0 * (v % 5) as f64);
        let points = (0..15).map(|v| at(v).extend(0.0)).collect();
        let cells = (0..2).flat_map(|i| (0..4).map(move |j| (i, j)));
        let triangles = cells.flat_map(|(i, j)| {
            let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            [[a, b, c], [a, c, d]]
        });
        let disk = Surface::new(points, triangles.collect()).unwrap();
        let side = |i: usize| (0..5).map(|j| id(i, j)).collect();
        let sewn = Sewn::new(&disk, &[Seam { left: side(0), right: side(2) }]);
        let straight: Vec<DVec2> = (0..15).map(at).collect();
        let mut folded = straight.clone();
        // The left side's third vertex lies below its second.
        folded[2] = DVec2::new(0.5, 1.0);
        for coordinates in [straight, folded] {
            let courses = sewn.courses(&coordinates);
            // Its second edge, by what the vertex alone moves.
            let (edge, row, clique) = (&sewn.edges[1], &courses.0[1], &sewn.cliques[1]);
            let own = coordinates[edge.left[1]] - coordinates[edge.left[0]];
            let mut motion = vec![DVec2::ZERO; 15];
            motion[2] = 1e-4 * own.normalize();
            let there: Vec<DVec2> = coordinates.iter().zip(&motion).map(|(&p, &d)| p + d).collect();
            let longer = Sewn::mismatch(edge, &there) - Sewn::mismatch(edge, &coordinates);
            assert!((closed(row, clique, &motion) / longer - 1.0).abs() < 1e-3, "{own}");
        }
    }
}
