//! A mesh on its way to be a [`Surface`](super::Surface), and the steps of the way.

use glam::DVec3;

use super::connectivity::{Edges, Sets, components, start};
use super::defect::{Component, Defect, SurfaceError};
use super::polygon::{Unsplittable, triangulate};
use super::raw::RawMesh;
use super::{orientation, weld};
use crate::design::Facing;
use crate::warning::Warning;

/// The mean of points, if there are any.
pub(super) fn mean(points: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    let (sum, count) = points.fold((DVec3::ZERO, 0usize), |(sum, n), p| (sum + p, n + 1));
    (count > 0).then(|| sum / count as f64)
}

/// A mesh on its way to be a surface. Until [`Mesh::drop_unused`] its points are numbered as the raw
/// mesh's.
pub(super) struct Mesh {
    /// In mm.
    pub(super) points: Vec<DVec3>,
    /// The raw point of each point.
    pub(super) source: Vec<usize>,
    pub(super) triangles: Vec<[usize; 3]>,
    /// The raw polygon of each triangle.
    pub(super) faces: Vec<usize>,
    /// The point that each raw point became; `usize::MAX` if none.
    pub(super) became: Vec<usize>,
}

impl Mesh {
    /// The mesh with its polygons split into triangles.
    pub(super) fn split(raw: &RawMesh, points: Vec<DVec3>) -> Result<Self, SurfaceError> {
        let (mut triangles, mut faces) = (Vec::new(), Vec::new());
        let mut defects = Vec::new();
        for (face, polygon) in raw.polygons.iter().enumerate() {
            // Some exporters write a triangle as a quadrangle with a repeated corner.
            let mut corners = polygon.clone();
            corners.dedup();
            while corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            let places: Vec<DVec3> = corners.iter().map(|&v| points[v]).collect();
            let middle = || mean(places.iter().copied()).unwrap_or(DVec3::NAN);
            match triangulate(&places) {
                Ok(parts) => {
                    triangles.extend(parts.into_iter().map(|t| t.map(|i| corners[i])));
                    faces.resize(triangles.len(), face);
                }
                Err(Unsplittable::NoArea) => {
                    defects.push(Defect::degenerate(face, &corners, middle()));
                }
                Err(Unsplittable::Crossed) => {
                    defects.push(Defect::crossed_polygon(face, &corners, middle()));
                }
            }
        }
        if !defects.is_empty() {
            return Err(SurfaceError::new(defects));
        }
        let source: Vec<usize> = (0..points.len()).collect();
        Ok(Self { became: source.clone(), points, source, triangles, faces })
    }

    pub(super) fn report_unused(&self, raw: &RawMesh, warnings: &mut Vec<Warning>) {
        let mut used = vec![false; self.points.len()];
        raw.polygons.iter().flatten().for_each(|&v| used[v] = true);
        let unused = used.iter().filter(|used| !**used).count();
        if unused > 0 {
            warnings.push(Warning::new(
                "unused_vertices",
                format!(
                    "{} no face and {} dropped",
                    counted(unused, "point belongs to", "points belong to"),
                    was(unused)
                ),
            ));
        }
    }

    fn bounds(&self, triangles: impl Iterator<Item = usize>) -> [DVec3; 2] {
        let start = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        triangles
            .flat_map(|t| self.triangles[t])
            .fold(start, |[min, max], v| [min.min(self.points[v]), max.max(self.points[v])])
    }

    pub(super) fn diagonal(&self) -> f64 {
        let [min, max] = self.bounds(0..self.triangles.len());
        min.distance(max)
    }

    pub(super) fn middle(&self, ends: [usize; 2]) -> DVec3 {
        0.5 * (self.points[ends[0]] + self.points[ends[1]])
    }

    fn corners(&self, t: usize) -> [DVec3; 3] {
        self.triangles[t].map(|v| self.points[v])
    }

    /// Makes one vertex of the points at a place, where that is meant.
    pub(super) fn weld(&mut self, tolerance: f64, warnings: &mut Vec<Warning>) {
        let soup = weld::is_soup(&self.triangles, &self.faces, self.points.len());
        let map = if soup {
            weld::by_place(&self.points, tolerance)
        } else {
            match weld::join_components(&self.points, &self.triangles, tolerance) {
                Some(map) => map,
                None => return,
            }
        };
        let mut used = vec![false; self.points.len()];
        let mut kept = vec![false; self.points.len()];
        for &v in self.triangles.iter().flatten() {
            used[v] = true;
            kept[map[v]] = true;
        }
        let before = used.iter().filter(|used| **used).count();
        let after = kept.iter().filter(|kept| **kept).count();
        self.triangles.iter_mut().for_each(|t| *t = t.map(|v| map[v]));
        self.became = map;
        if after < before {
            let message = if soup {
                format!(
                    "the faces of the file share no points: its {before} points were welded into \
                     {after} vertices by their places"
                )
            } else {
                format!(
                    "{} on the borders between pieces of the surface {} welded: borders lay \
                     exactly on each other",
                    counted(before - after, "point", "points"),
                    was(before - after)
                )
            };
            warnings.push(Warning::new("welded", message));
        }
        if soup {
            // What is shorter than the tolerance collapses, and its neighbours close up.
            let whole = |t: &[usize; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
            let keep: Vec<bool> = self.triangles.iter().map(whole).collect();
            let dropped = keep.iter().filter(|keep| !**keep).count();
            if dropped > 0 {
                self.retain(&keep);
                warnings.push(Warning::new(
                    "collapsed_dropped",
                    format!(
                        "{} shorter than {tolerance:.1e} mm collapsed when points were welded \
                         and {} dropped",
                        counted(dropped, "triangle with a side", "triangles with a side"),
                        was(dropped)
                    ),
                ));
            }
        }
    }

    fn retain(&mut self, keep: &[bool]) {
        let mut flags = keep.iter();
        self.triangles.retain(|_| *flags.next().unwrap_or(&true));
        let mut flags = keep.iter();
        self.faces.retain(|_| *flags.next().unwrap_or(&true));
    }

    /// The components, by area from the largest.
    pub(super) fn components(&self, edges: &Edges) -> Vec<Component> {
        let (component, count) = components(&self.triangles, edges);
        self.measure(&component, count).into_iter().map(|(_, c)| c).collect()
    }

    fn measure(&self, component: &[usize], count: usize) -> Vec<(usize, Component)> {
        let empty = |i| {
            let (min, max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            (i, Component { face: usize::MAX, triangles: 0, area: 0.0, min, max })
        };
        let mut all: Vec<(usize, Component)> = (0..count).map(empty).collect();
        for (t, &i) in component.iter().enumerate() {
            let [a, b, c] = self.corners(t);
            let one = &mut all[i].1;
            one.face = one.face.min(self.faces[t]);
            one.triangles += 1;
            one.area += 0.5 * (b - a).cross(c - a).length();
            one.min = one.min.min(a).min(b).min(c);
            one.max = one.max.max(a).max(b).max(c);
        }
        all.sort_by(|(_, a), (_, b)| b.area.total_cmp(&a.area).then(a.face.cmp(&b.face)));
        all
    }

    pub(super) fn keep_largest(&mut self, warnings: &mut Vec<Warning>) {
        let edges = Edges::of(&self.triangles);
        let (component, count) = components(&self.triangles, &edges);
        if count < 2 {
            return;
        }
        let pieces = self.measure(&component, count);
        let largest = pieces[0].0;
        let keep: Vec<bool> = component.iter().map(|&i| i == largest).collect();
        self.retain(&keep);
        /// The rest is only counted.
        const SHOWN: usize = 10;
        let mut texts: Vec<String> =
            pieces[1..].iter().take(SHOWN).map(|(_, c)| c.to_string()).collect();
        if pieces.len() - 1 > SHOWN {
            texts.push(format!("{} smaller ones", pieces.len() - 1 - SHOWN));
        }
        warnings.push(Warning::new(
            "components_dropped",
            format!(
                "{} beside the largest {} dropped: {}",
                counted(count - 1, "piece", "pieces"),
                was(count - 1),
                texts.join("; ")
            ),
        ));
    }

    /// Takes out triangles without area and second copies, as defects, so that they do not show
    /// up again as defects of edges.
    pub(super) fn take_broken_triangles(&mut self, thinnest: f64) -> Vec<Defect> {
        let mut defects = Vec::new();
        let mut keep = vec![true; self.triangles.len()];
        let first_with = self.first_with_same_corners();
        for t in 0..self.triangles.len() {
            let corners = self.triangles[t];
            let [a, b, c] = self.corners(t);
            let middle = (a + b + c) / 3.0;
            let doubled = (b - a).cross(c - a).length();
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let first = first_with[t];
            if doubled <= thinnest * longest {
                defects.push(Defect::degenerate(self.faces[t], &corners, middle));
                keep[t] = false;
            } else if first < t {
                let faces = [self.faces[first], self.faces[t]];
                let mut sorted = corners;
                sorted.sort_unstable();
                defects.push(Defect::duplicate(faces, &sorted, middle));
                keep[t] = false;
            }
        }
        if !defects.is_empty() {
            self.retain(&keep);
        }
        defects
    }

    /// For every triangle the first with the same corners in any order.
    fn first_with_same_corners(&self) -> Vec<usize> {
        let sorted = |(t, corners): (usize, &[usize; 3])| {
            let mut corners = *corners;
            corners.sort_unstable();
            (corners, t)
        };
        let mut by_corners: Vec<_> = self.triangles.iter().enumerate().map(sorted).collect();
        by_corners.sort_unstable();
        let mut first = vec![0; self.triangles.len()];
        for same in by_corners.chunk_by(|a, b| a.0 == b.0) {
            same.iter().for_each(|&(_, t)| first[t] = same[0].1);
        }
        first
    }

    pub(super) fn non_manifold_edges(&self, edges: &Edges) -> Vec<Defect> {
        edges
            .iter()
            .filter(|(_, uses)| uses.len() > 2)
            .map(|(ends, uses)| {
                let faces: Vec<usize> = uses.half_edges().map(|h| self.faces[h / 3]).collect();
                Defect::non_manifold_edge(ends, &faces, self.middle(ends))
            })
            .collect()
    }

    /// Vertices whose triangles do not hang together over edges.
    pub(super) fn non_manifold_vertices(&self, edges: &Edges) -> Vec<Defect> {
        // Corner k of triangle t is 3 t + k.
        let mut fans = Sets::new(3 * self.triangles.len());
        for (ends, uses) in edges.iter() {
            let corner_at = |h: usize, v: usize| {
                if start(&self.triangles, h) == v { h } else { h - h % 3 + (h % 3 + 1) % 3 }
            };
            let first = uses.half_edge(0);
            for h in uses.half_edges() {
                ends.iter().for_each(|&v| fans.join(corner_at(first, v), corner_at(h, v)));
            }
        }
        let mut firsts: Vec<(usize, usize)> = (0..3 * self.triangles.len())
            .filter(|&corner| fans.find(corner) == corner)
            .map(|corner| (start(&self.triangles, corner), corner / 3))
            .collect();
        firsts.sort_unstable();
        firsts
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|fans| fans.len() > 1)
            .map(|fans| {
                let faces: Vec<usize> = fans.iter().map(|&(_, t)| self.faces[t]).collect();
                let v = fans[0].0;
                Defect::non_manifold_vertex(v, &faces, self.points[v])
            })
            .collect()
    }

    pub(super) fn turn(&mut self, turned: &[bool], warnings: &mut Vec<Warning>) {
        for (corners, _) in self.triangles.iter_mut().zip(turned).filter(|(_, turned)| **turned) {
            corners.swap(1, 2);
        }
        let count = turned.iter().filter(|turned| **turned).count();
        if count > 0 {
            warnings.push(Warning::new(
                "orientation_repaired",
                format!(
                    "{count} of {} triangles faced the other way than the rest and {} turned",
                    turned.len(),
                    was(count)
                ),
            ));
        }
    }

    pub(super) fn drop_unused(&mut self) {
        let mut used = vec![false; self.points.len()];
        self.triangles.iter().flatten().for_each(|&v| used[v] = true);
        let mut new = vec![usize::MAX; self.points.len()];
        let (mut points, mut source) = (Vec::new(), Vec::new());
        for v in (0..used.len()).filter(|&v| used[v]) {
            new[v] = points.len();
            points.push(self.points[v]);
            source.push(self.source[v]);
        }
        self.triangles.iter_mut().for_each(|t| *t = t.map(|v| new[v]));
        self.became.iter_mut().for_each(|v| *v = new[*v]);
        (self.points, self.source) = (points, source);
    }

    /// Turns the surface inside out where that makes it face outward.
    pub(super) fn face_outward(
        &mut self,
        facing: Option<Facing>,
        warnings: &mut Vec<Warning>,
    ) -> Result<(), SurfaceError> {
        let edges = Edges::of(&self.triangles);
        let told = orientation::faces_outward(&self.points, &self.triangles, &edges);
        let outward = match facing {
            Some(facing) => facing == Facing::Outward,
            None => told.ok_or_else(Defect::ambiguous_facing)?,
        };
        if told.is_some_and(|told| told != outward) {
            warnings.push(Warning::new(
                "facing_unlikely",
                "the design's \"facing\" makes the surface face inward by its shape: check that \
                 pressures are meant on its hollow side",
            ));
        }
        if !outward {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
            let why = match facing {
                Some(_) => "as the design's \"facing\" says",
                None => "by its shape",
            };
            warnings.push(Warning::new(
                "reversed",
                format!("the surface faced inward, {why}, and all triangles were turned"),
            ));
        }
        Ok(())
    }
}

fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn was(count: usize) -> &'static str {
    if count == 1 { "was" } else { "were" }
}
