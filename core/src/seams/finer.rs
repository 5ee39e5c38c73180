//! A cut surface with triangles split where they are too large.
//!
//! They are split in four of their own shape, and what that leaves of their neighbours by longest edges (Rivara,
//! *Algorithms for refining triangular grids suitable for adaptive and multigrid techniques*, 1984), so that no angle
//! becomes smaller than half the smallest, however often. Both sides of a seam are split alike. The facets stay what
//! they are.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use super::cut::{CutSurface, Ends};
use super::sewing::Seam;
use crate::geometry::{FINEST_MM, Grading};
use crate::surface::{Surface, VertexId};

/// Triangles are split that have the area of an equilateral one with edges longer than wanted by more than this. Their
/// longest edges would count where their shape is bad, and the fit gives these another.
const TOO_LONG: f64 = 1.4;

/// Times that triangles are split: from edges of 16 mm to such of 1 mm.
const SPLITS: usize = 4;

/// A cut surface with smaller triangles. Its vertices come first, then those in the middle of edges.
#[derive(Debug)]
pub struct Finer {
    /// The surface.
    pub cut: CutSurface,
    /// The ends of the edge in whose middle each further vertex lies.
    middles: Vec<[usize; 2]>,
}

impl Finer {
    /// A cut surface with triangles as small as wanted; `None` where they all are.
    #[must_use]
    pub fn new(cut: &CutSurface, grading: &Grading) -> Option<Self> {
        let indices = |side: &[VertexId]| side.iter().map(|v| v.index()).collect();
        let sides = |seam: &Seam| [indices(&seam.left), indices(&seam.right)];
        let mut mesh = Mesh {
            points: cut.disk.points().to_vec(),
            triangles: cut.disk.triangles().iter().map(|t| t.map(VertexId::index)).collect(),
            seams: cut.seams.iter().map(sides).collect(),
            middles: BTreeMap::new(),
        };
        for _ in 0..SPLITS {
            let chosen = mesh.too_large(grading);
            if chosen.is_empty() {
                break;
            }
            mesh.split(&chosen);
        }
        if mesh.middles.is_empty() {
            return None;
        }
        let chain = |chain: &[VertexId]| -> Vec<VertexId> {
            mesh.chain(&indices(chain)).into_iter().map(VertexId::new).collect()
        };
        let triangles = mesh.triangles.iter().map(|t| t.map(VertexId::new)).collect();
        let cut = CutSurface {
            seams: cut
                .seams
                .iter()
                .map(|seam| Seam { left: chain(&seam.left), right: chain(&seam.right) })
                .collect(),
            splits: cut.splits.iter().map(|split| chain(split)).collect(),
            ends: cut.ends.as_ref().map(|ends| Ends {
                proximal: chain(&ends.proximal),
                distal: chain(&ends.distal),
                girths: ends.girths,
            }),
            warnings: cut.warnings.clone(),
            // Never none for a surface that was sound.
            disk: Surface::new(mesh.points.clone(), triangles).ok()?,
        };
        let mut middles = vec![[0; 2]; mesh.middles.len()];
        let first = mesh.points.len() - middles.len();
        mesh.middles.iter().for_each(|(&ends, &v)| middles[v - first] = ends);
        Some(Self { cut, middles })
    }

    /// Whether a surface has triangles that any place would have smaller.
    #[must_use]
    pub fn is_of_use(disk: &Surface) -> bool {
        disk.half_edges().any(|h| disk.length(h) > TOO_LONG * FINEST_MM)
    }

    /// The further vertices, and the ends of the edges in whose middle they lie.
    pub fn middles(&self) -> impl Iterator<Item = (usize, [usize; 2])> + '_ {
        let first = self.cut.disk.vertex_count() - self.middles.len();
        self.middles.iter().enumerate().map(move |(k, &ends)| (first + k, ends))
    }

    /// Values at the vertices of the surface as it was, with those at the further ones.
    #[must_use]
    pub fn extended(&self, values: &[DVec2]) -> Vec<DVec2> {
        let mut values = values.to_vec();
        for (_, [a, b]) in self.middles() {
            values.push(0.5 * (values[a] + values[b]));
        }
        values
    }
}

/// An edge, whichever way it is run along.
type Edge = [usize; 2];

fn edge(a: usize, b: usize) -> Edge {
    [a.min(b), a.max(b)]
}

fn edges([a, b, c]: [usize; 3]) -> [Edge; 3] {
    [edge(a, b), edge(b, c), edge(c, a)]
}

/// Triangles on their way to be smaller.
struct Mesh {
    points: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
    /// Both sides of every seam.
    seams: Vec<[Vec<usize>; 2]>,
    /// The vertices in the middle of edges that have been split.
    middles: BTreeMap<Edge, usize>,
}

impl Mesh {
    /// The triangles that are too large.
    fn too_large(&self, grading: &Grading) -> Vec<usize> {
        let is_too_large = |&t: &usize| {
            let [a, b, c] = self.triangles[t].map(|v| self.points[v]);
            let size = ((b - a).cross(c - a).length() * 2.0 / 3f64.sqrt()).sqrt() / TOO_LONG;
            grading.length((a + b + c) / 3.0, size) < size
        };
        (0..self.triangles.len()).filter(is_too_large).collect()
    }

    /// A triangle's corners, beginning with the ends of its longest edge; of two as long the same in both triangles.
    fn longest_first(&self, [a, b, c]: [usize; 3]) -> [usize; 3] {
        let of = |a: usize, b: usize| {
            let edge = edge(a, b);
            (self.points[edge[0]].distance_squared(self.points[edge[1]]), edge)
        };
        let (ab, bc, ca) = (of(a, b), of(b, c), of(c, a));
        if ab >= bc && ab >= ca {
            [a, b, c]
        } else if bc >= ca {
            [b, c, a]
        } else {
            [c, a, b]
        }
    }

    /// The longest edges of these triangles, and of every triangle that has one of the edges.
    fn marked(&self, chosen: &[usize]) -> BTreeSet<Edge> {
        let longest = |corners: [usize; 3]| {
            let [a, b, _] = self.longest_first(corners);
            edge(a, b)
        };
        let mut marked: BTreeSet<Edge> =
            chosen.iter().flat_map(|&t| edges(self.triangles[t])).collect();
        let mut is_end = vec![false; self.points.len()];
        loop {
            let before = marked.len();
            marked.iter().flatten().for_each(|&v| is_end[v] = true);
            for &corners in &self.triangles {
                let near = corners.iter().filter(|&&v| is_end[v]).count() > 1;
                if near && edges(corners).iter().any(|edge| marked.contains(edge)) {
                    marked.insert(longest(corners));
                }
            }
            for [left, right] in &self.seams {
                for (l, r) in left.windows(2).zip(right.windows(2)) {
                    let (l, r) = (edge(l[0], l[1]), edge(r[0], r[1]));
                    if marked.contains(&l) || marked.contains(&r) {
                        marked.extend([l, r]);
                    }
                }
            }
            if marked.len() == before {
                return marked;
            }
        }
    }

    /// Splits these triangles, and others so that edges meet edges.
    fn split(&mut self, chosen: &[usize]) {
        for [a, b] in self.marked(chosen) {
            self.middles.insert([a, b], self.points.len());
            self.points.push(0.5 * (self.points[a] + self.points[b]));
        }
        let middle = |a: usize, b: usize| self.middles.get(&edge(a, b)).copied();
        let mut triangles = Vec::with_capacity(self.triangles.len() + 2 * self.middles.len());
        for &corners in &self.triangles {
            let [a, b, c] = self.longest_first(corners);
            let Some(p) = middle(a, b) else {
                triangles.push(corners);
                continue;
            };
            if let (Some(q), Some(r)) = (middle(b, c), middle(c, a)) {
                triangles.extend([[a, p, r], [p, b, q], [r, q, c], [p, q, r]]);
                continue;
            }
            match middle(c, a) {
                None => triangles.push([a, p, c]),
                Some(q) => triangles.extend([[a, p, q], [p, c, q]]),
            }
            match middle(b, c) {
                None => triangles.push([p, b, c]),
                Some(q) => triangles.extend([[p, b, q], [p, q, c]]),
            }
        }
        self.triangles = triangles;
        let halved = |side: &Vec<usize>| self.halved(side);
        self.seams = self.seams.iter().map(|sides| sides.each_ref().map(halved)).collect();
    }

    /// A chain of vertices with those that are in the middle of its edges.
    fn halved(&self, chain: &[usize]) -> Vec<usize> {
        let middle = |ends: &[usize]| self.middles.get(&edge(ends[0], ends[1])).copied();
        let halves = chain.windows(2).flat_map(|ends| std::iter::once(ends[0]).chain(middle(ends)));
        halves.chain(chain.last().copied()).collect()
    }

    /// A chain of vertices with all that have come to lie on it.
    fn chain(&self, chain: &[usize]) -> Vec<usize> {
        let mut chain = chain.to_vec();
        loop {
            let halved = self.halved(&chain);
            if halved.len() == chain.len() {
                return chain;
            }
            chain = halved;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shapes::grid;

    /// An uneven sheet of 80 by 60 mm, cut from its left edge to its middle along y = 30 mm, and sewn there. It is to be
    /// cut apart along x = 60 mm.
    fn slit_sheet() -> CutSurface {
        rough_sheet(0.0)
    }

    /// The same with vertices that lie off it by so many mm.
    fn rough_sheet(rough: f64) -> CutSurface {
        let sheet = grid(12, 16, false, |x, y| {
            let (x, y) = (80.0 * x, 60.0 * y);
            let off = rough * (1e3 * (12.9898 * x + 78.233 * y).sin()).sin();
            DVec3::new(x + (0.3 * y).sin(), y, 4.0 * (0.1 * x + 0.07 * y).sin() + off)
        });
        let chain = |on: &dyn Fn(DVec3) -> bool| -> Vec<VertexId> {
            sheet.vertex_ids().filter(|&v| on(sheet.point(v))).collect()
        };
        let along = 30.0;
        let left = chain(&|p| (p.y - along).abs() < 1e-9 && p.x < 42.0);
        let across = chain(&|p| (p.x - (0.3 * p.y).sin() - 60.0).abs() < 1e-9);
        let mut points = sheet.points().to_vec();
        let mut right = BTreeMap::new();
        for &v in &left[..left.len() - 1] {
            right.insert(v, VertexId::new(points.len()));
            points.push(sheet.point(v));
        }
        let triangles = sheet.triangles().iter().map(|t| {
            let beyond = t.iter().map(|&v| sheet.point(v).y).sum::<f64>() > 3.0 * along;
            t.map(|v| right.get(&v).copied().filter(|_| beyond).unwrap_or(v))
        });
        let disk = Surface::new(points, triangles.collect()).unwrap();
        let right = left.iter().map(|v| right.get(v).copied().unwrap_or(*v)).collect();
        let ends = Ends { proximal: left[..3].to_vec(), distal: Vec::new(), girths: [60.0, 60.0] };
        CutSurface {
            disk,
            seams: vec![Seam { left, right }],
            splits: vec![across],
            ends: Some(ends),
            warnings: Vec::new(),
        }
    }

    fn smallest_angle(surface: &Surface) -> f64 {
        let angles = surface.triangle_ids().flat_map(|t| {
            let p = surface.corners(t);
            (0..3).map(move |k| (p[(k + 1) % 3] - p[k]).angle_between(p[(k + 2) % 3] - p[k]))
        });
        angles.fold(f64::INFINITY, f64::min)
    }

    /// Whether the vertices of a chain are joined one by one.
    fn is_chain(surface: &Surface, chain: &[VertexId]) -> bool {
        chain.windows(2).all(|ends| surface.neighbours(ends[0]).any(|v| v == ends[1]))
    }

    #[test]
    fn triangles_are_as_small_as_wanted_and_still_the_same_surface() {
        let cut = slit_sheet();
        let grading = Grading::new(vec![DVec3::new(10.0, 31.0, 3.0)]);
        let finer = Finer::new(&cut, &grading).unwrap();
        let (before, after) = (&cut.disk, &finer.cut.disk);
        assert_eq!(after.points()[..before.vertex_count()], *before.points());
        assert_eq!(after.euler_characteristic(), before.euler_characteristic());
        assert_eq!(after.boundary_loops().len(), 1);
        assert!((after.total_area() / before.total_area() - 1.0).abs() < 1e-12);
        assert!(Finer::new(&finer.cut, &grading).is_none(), "they are all small enough");
        let (few, many) = (before.triangle_count(), after.triangle_count());
        assert!((2 * few..8 * few).contains(&many), "{many} of {few}");
    }

    #[test]
    fn no_angle_becomes_smaller_than_half_the_smallest() {
        for rough in [0.0, 1.0, 3.0, 10.0] {
            let cut = rough_sheet(rough);
            for k in 0..9 {
                let place = cut.disk.points()[20 * k + 7];
                let finer = Finer::new(&cut, &Grading::new(vec![place])).unwrap();
                let (before, after) = (smallest_angle(&cut.disk), smallest_angle(&finer.cut.disk));
                assert!(after > 0.5 * before - 1e-9, "{rough}, {k}: {after} of {before}");
            }
        }
    }

    #[test]
    fn both_sides_of_a_seam_are_split_alike_and_chains_stay_chains() {
        let cut = slit_sheet();
        // On one side of the seam, near the end of the split.
        for place in [DVec3::new(15.0, 26.0, 3.0), DVec3::new(60.0, 2.0, 0.0)] {
            let finer = Finer::new(&cut, &Grading::new(vec![place])).unwrap().cut;
            let Seam { left, right } = &finer.seams[0];
            assert_eq!((left.len(), left.last()), (right.len(), right.last()));
            for (l, r) in left.iter().zip(right) {
                assert!(finer.disk.point(*l).distance(finer.disk.point(*r)) < 1e-12);
            }
            let ends = finer.ends.as_ref().unwrap();
            for (chain, was) in [
                (left, &cut.seams[0].left),
                (right, &cut.seams[0].right),
                (&finer.splits[0], &cut.splits[0]),
                (&ends.proximal, &cut.ends.as_ref().unwrap().proximal),
            ] {
                assert!(is_chain(&finer.disk, chain), "{chain:?}");
                assert_eq!((chain.first(), chain.last()), (was.first(), was.last()));
            }
            let longer = |chain: &Vec<VertexId>, was: &Vec<VertexId>| chain.len() > was.len() + 8;
            assert!(
                longer(left, &cut.seams[0].left) || longer(&finer.splits[0], &cut.splits[0]),
                "{place}"
            );
        }
    }

    #[test]
    fn values_at_further_vertices_are_those_between() {
        let cut = slit_sheet();
        let finer = Finer::new(&cut, &Grading::new(vec![DVec3::new(10.0, 31.0, 3.0)])).unwrap();
        let of = |disk: &Surface| -> Vec<DVec2> {
            disk.points().iter().map(|p| DVec2::new(p.x - 2.0 * p.z, p.y)).collect()
        };
        let (got, wanted) = (finer.extended(&of(&cut.disk)), of(&finer.cut.disk));
        assert_eq!(got.len(), wanted.len());
        for (got, wanted) in got.iter().zip(&wanted) {
            assert!(got.distance(*wanted) < 1e-12);
        }
    }

    #[test]
    fn triangles_that_are_small_enough_stay() {
        let cut = slit_sheet();
        assert!(Finer::new(&cut, &Grading::default()).is_none());
        let far = Grading::new(vec![DVec3::new(0.0, 0.0, 900.0)]);
        assert!(Finer::new(&cut, &far).is_none() && Finer::is_of_use(&cut.disk));
        let small = cut.disk.points().iter().map(|p| 0.15 * *p).collect();
        let small = CutSurface { disk: cut.disk.with_points(small), ..cut };
        let everywhere = Grading::new(small.disk.points().to_vec());
        assert!(Finer::new(&small, &everywhere).is_none() && !Finer::is_of_use(&small.disk));
    }
}
