//! Sewn edges have equal lengths in the pattern.
//!
//! For every edge of a seam and the one sewn to it, of lengths l and r in the pattern and w on the
//! worn surface, the energy gets ½ κ (l − r)² / w. κ is so large that what remains of a mismatch of
//! some per cent is some hundredths of a per cent. The force acts along the seam's course smoothed over
//! [`COURSE_MM`], not along the single edges: otherwise the shorter side would lengthen by a zigzag as
//! fine as its edges.

use glam::DVec2;

use crate::design::Fabric;
use crate::seams::Seam;
use crate::surface::Surface;

/// κ over the fabric's largest stiffness, in mm: holds against the pull of cloth some 50 mm wide that
/// wants a mismatch of 2 % to within 0.004 %.
const STIFFNESS_MM: f64 = 25_000.0;

/// Length over which a seam's direction is averaged, in mm.
const COURSE_MM: f64 = 10.0;

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

/// A sewn edge's part of the energy.
pub struct SewnTerm {
    /// Derivative of l − r by the coordinates of the clique's vertices.
    pub row: Vec<f64>,
    /// κ (l − r) / w: the force, in N.
    pub force: f64,
    /// κ / w, in N/mm.
    pub stiffness: f64,
}

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
        STIFFNESS_MM * fabric.warp.max(fabric.weft)
    }

    /// The energy of all mismatches, in N·mm.
    pub fn energy(&self, coordinates: &[DVec2], fabric: &Fabric) -> f64 {
        let kappa = Self::stiffness(fabric);
        let length = |[a, b]: [usize; 2]| coordinates[a].distance(coordinates[b]);
        let edges = self.edges.iter();
        edges.map(|e| 0.5 * kappa * (length(e.left) - length(e.right)).powi(2) / e.worn).sum()
    }

    /// The terms, one for each clique.
    pub fn terms(&self, coordinates: &[DVec2], fabric: &Fabric) -> Vec<SewnTerm> {
        let kappa = Self::stiffness(fabric);
        let (left, right) = (self.courses(coordinates, |e| e.left), self.courses(coordinates, |e| e.right));
        let edges = self.edges.iter().enumerate().zip(&self.cliques);
        edges
            .map(|((k, edge), clique)| {
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
                let length = |[a, b]: [usize; 2]| coordinates[a].distance(coordinates[b]);
                let stiffness = kappa / edge.worn;
                let force = stiffness * (length(edge.left) - length(edge.right));
                SewnTerm { row, force, stiffness }
            })
            .collect()
    }

    /// The direction of one side at every edge: that of the chord over [`COURSE_MM`] round it.
    fn courses(&self, coordinates: &[DVec2], side: impl Fn(&SewnEdge) -> [usize; 2]) -> Vec<DVec2> {
        let mut courses = vec![DVec2::ZERO; self.edges.len()];
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
                let to = along[k + 1..]
                    .partition_point(|&s| s <= middle + 0.5 * COURSE_MM)
                    .max(1)
                    + k;
                let chord = coordinates[side(&run[to - 1])[1]] - coordinates[side(&run[from])[0]];
                let own = side(&run[k]);
                courses[at + k] = chord
                    .try_normalize()
                    .unwrap_or_else(|| (coordinates[own[1]] - coordinates[own[0]]).normalize_or_zero());
            }
            at += run.len();
        }
        courses
    }
}
