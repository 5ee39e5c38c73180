//! A raw mesh becomes a [`Surface`], or every defect it has is named.
//!
//! What can be mended without guessing is mended and said as a warning; the rest is an error with
//! its place. The warnings' codes: `unused_vertices`, `welded`, `collapsed_dropped`,
//! `components_dropped`, `orientation_repaired`, `reversed`, `facing_unlikely`, `cut_kept`,
//! `hole_closed`, `hole_kept`, `opening_kept`.
//!
//! Limit: triangles that pass through one another are not looked for.

use std::collections::HashMap;

use glam::DVec3;

use super::connectivity::{Edges, Sets, components, end, start};
use super::defect::{Component, Defect, SurfaceError};
use super::index::VertexId;
use super::polygon::{Unsplittable, triangulate};
use super::raw::RawMesh;
use super::topology::Surface;
use super::{holes, orientation, weld};
use crate::design::Facing;
use crate::units::LengthUnit;
use crate::warning::Warning;

/// Coordinates are rounded to multiples of this many mm, so that a limb given in millimetres,
/// metres and inches is the same to the last bit: conversion leaves differences of about 1e-13 mm
/// on a limb, and coordinates written with up to nine decimals of a millimetre lie at least
/// 2e-13 mm from where rounding changes, a few in a million of longer ones do not. A nanometre
/// is nothing to a limb, and moves the curvature of a mesh with 2 mm edges by 0.001 1/m.
const GRID: f64 = 1.0 / (1u64 << 20) as f64;

/// A coordinate beyond this many mm (a thousand kilometres) is a fault of the file: squares and
/// cubes of limb coordinates must stay exact enough.
const FARTHEST: f64 = 1e9;

/// A triangle is degenerate when its height is below this fraction of the bounding box's
/// diagonal: that is how exactly 32-bit coordinates place points that should lie on a line.
const THIN: f64 = 1e-7;

/// The half-edges must be numbered by 32 bits.
const MOST: usize = (u32::MAX / 3) as usize;

/// How a raw mesh is to be understood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceOptions {
    /// The unit of its coordinates.
    pub unit: LengthUnit,
    /// Whether all components but the one of the largest area are dropped.
    pub keep_largest: bool,
    /// Boundary loops of at most this length, in mm, are closed unless they are the surface's
    /// outline or ends; 0 closes none.
    pub close_holes: f64,
    /// Whether its triangles face outward; `None` lets the shape tell.
    pub facing: Option<Facing>,
}

/// A surface and what was done to get it.
#[derive(Debug, Clone, PartialEq)]
pub struct Validated {
    /// The surface.
    pub surface: Surface,
    /// What was mended or may not be as meant.
    pub warnings: Vec<Warning>,
    /// For each vertex of the surface the point of the raw mesh that it came from, the first of
    /// those that were welded. No vertex is new.
    pub source: Vec<usize>,
}

/// The surface that `raw` means.
///
/// # Errors
/// With every defect that is found: the checks of single points and faces come first, those of
/// how faces hang together only when these pass.
pub fn validate(raw: &RawMesh, options: &SurfaceOptions) -> Result<Validated, SurfaceError> {
    let mut warnings = Vec::new();
    let points = converted_points(raw, options.unit);
    check_elements(raw, &points)?;
    let mut mesh = Mesh::split(raw, points)?;
    mesh.report_unused(raw, &mut warnings);
    let diagonal = mesh.diagonal();
    let tolerance = (weld::WELD * diagonal).max(2.0 * GRID);
    let thinnest = (THIN * diagonal).max(2.0 * GRID);
    mesh.weld(tolerance, &mut warnings);
    if options.keep_largest {
        mesh.keep_largest(&mut warnings);
    }

    let mut defects = mesh.take_broken_triangles(thinnest);
    let edges = Edges::of(&mesh.triangles);
    let agreement = orientation::agree(&mesh.triangles, &edges);
    defects.extend(mesh.non_manifold_edges(&edges));
    defects.extend(mesh.non_manifold_vertices(&edges));
    defects.extend(agreement.conflicts.iter().map(|&[a, b]| {
        let ends = [start(&mesh.triangles, a), end(&mesh.triangles, a)];
        let faces = [mesh.faces[a / 3], mesh.faces[b / 3]];
        Defect::not_orientable(ends, faces, mesh.middle(ends))
    }));
    let pieces = mesh.components(&edges);
    if pieces.len() > 1 {
        defects.push(Defect::several_components(&pieces));
    }
    if !defects.is_empty() {
        return Err(SurfaceError::new(defects));
    }

    mesh.turn(&agreement.turned, &mut warnings);
    mesh.drop_unused();
    mesh.face_outward(options.facing, &mut warnings)?;
    let cut = weld::cut_length(&mesh.points, &mesh.triangles, tolerance);
    if cut > 0.0 {
        warnings.push(Warning::new(
            "cut_kept",
            format!(
                "the boundary lies on itself along {cut:.1} mm: taken as a cut and left open; \
                 merge the vertices there in the file if it is none"
            ),
        ));
    }
    warnings.extend(holes::close(&mesh.points, &mut mesh.triangles, options.close_holes, thinnest));
    let triangles = mesh.triangles.iter().map(|t| t.map(VertexId::new)).collect();
    let surface = Surface::new(mesh.points, triangles).map_err(|e| Defect::fault(&e))?;
    Ok(Validated { surface, warnings, source: mesh.source })
}

fn converted_points(raw: &RawMesh, unit: LengthUnit) -> Vec<DVec3> {
    let scale = unit.millimetres();
    // Adding 0 makes −0 the 0 that it equals.
    let snap = |x: f64| (x * scale / GRID).round() * GRID + 0.0;
    raw.points.iter().map(|p| DVec3::from_array(p.to_array().map(snap))).collect()
}

fn check_elements(raw: &RawMesh, points: &[DVec3]) -> Result<(), SurfaceError> {
    if raw.points.is_empty() || raw.polygons.is_empty() {
        return Err(Defect::empty().into());
    }
    let corners: usize = raw.polygons.iter().map(Vec::len).sum();
    if points.len() > MOST || corners > MOST {
        return Err(Defect::too_large(points.len(), raw.polygons.len(), MOST).into());
    }
    let mut used = vec![false; points.len()];
    let mut defects = Vec::new();
    for (face, polygon) in raw.polygons.iter().enumerate() {
        let known = polygon.iter().filter_map(|&v| points.get(v)).copied();
        for &v in polygon {
            if v < points.len() {
                used[v] = true;
            } else {
                let place = mean(known.clone());
                defects.push(Defect::index_out_of_range(face, v, points.len(), place));
            }
        }
    }
    for (v, &p) in points.iter().enumerate() {
        // An unused point does no harm: it is dropped.
        if used[v] && !(p.abs().max_element() <= FARTHEST && p.is_finite()) {
            defects.push(Defect::not_finite(v, p));
        }
    }
    if defects.is_empty() { Ok(()) } else { Err(SurfaceError::new(defects)) }
}

fn mean(points: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    let (sum, count) = points.fold((DVec3::ZERO, 0usize), |(sum, n), p| (sum + p, n + 1));
    (count > 0).then(|| sum / count as f64)
}

/// A mesh on its way to be a surface.
struct Mesh {
    /// In mm.
    points: Vec<DVec3>,
    /// The raw point of each point.
    source: Vec<usize>,
    triangles: Vec<[usize; 3]>,
    /// The raw polygon of each triangle.
    faces: Vec<usize>,
}

impl Mesh {
    /// The mesh with its polygons split into triangles.
    fn split(raw: &RawMesh, points: Vec<DVec3>) -> Result<Self, SurfaceError> {
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
        let source = (0..points.len()).collect();
        Ok(Self { points, source, triangles, faces })
    }

    fn report_unused(&self, raw: &RawMesh, warnings: &mut Vec<Warning>) {
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

    fn diagonal(&self) -> f64 {
        let [min, max] = self.bounds(0..self.triangles.len());
        min.distance(max)
    }

    fn middle(&self, ends: [usize; 2]) -> DVec3 {
        0.5 * (self.points[ends[0]] + self.points[ends[1]])
    }

    fn corners(&self, t: usize) -> [DVec3; 3] {
        self.triangles[t].map(|v| self.points[v])
    }

    /// The raw points of vertices.
    fn raw<const N: usize>(&self, vertices: [usize; N]) -> [usize; N] {
        vertices.map(|v| self.source[v])
    }

    /// Makes one vertex of the points at a place, where that is meant.
    fn weld(&mut self, tolerance: f64, warnings: &mut Vec<Warning>) {
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
    fn components(&self, edges: &Edges) -> Vec<Component> {
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

    fn keep_largest(&mut self, warnings: &mut Vec<Warning>) {
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
    fn take_broken_triangles(&mut self, thinnest: f64) -> Vec<Defect> {
        let mut defects = Vec::new();
        let mut keep = vec![true; self.triangles.len()];
        let mut first_with: HashMap<[usize; 3], usize> =
            HashMap::with_capacity(self.triangles.len());
        for t in 0..self.triangles.len() {
            let corners = self.triangles[t];
            let [a, b, c] = self.corners(t);
            let middle = (a + b + c) / 3.0;
            let doubled = (b - a).cross(c - a).length();
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let mut sorted = corners;
            sorted.sort_unstable();
            if doubled <= thinnest * longest {
                defects.push(Defect::degenerate(self.faces[t], &self.raw(corners), middle));
                keep[t] = false;
            } else if let Some(&first) = first_with.get(&sorted) {
                let faces = [self.faces[first], self.faces[t]];
                defects.push(Defect::duplicate(faces, &self.raw(sorted), middle));
                keep[t] = false;
            } else {
                first_with.insert(sorted, t);
            }
        }
        if !defects.is_empty() {
            self.retain(&keep);
        }
        defects
    }

    fn non_manifold_edges(&self, edges: &Edges) -> Vec<Defect> {
        edges
            .iter()
            .filter(|(_, uses)| uses.len() > 2)
            .map(|(ends, uses)| {
                let faces: Vec<usize> = uses.half_edges().map(|h| self.faces[h / 3]).collect();
                Defect::non_manifold_edge(self.raw(ends), &faces, self.middle(ends))
            })
            .collect()
    }

    /// Vertices whose triangles do not hang together over edges.
    fn non_manifold_vertices(&self, edges: &Edges) -> Vec<Defect> {
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
                Defect::non_manifold_vertex(self.source[v], &faces, self.points[v])
            })
            .collect()
    }

    fn turn(&mut self, turned: &[bool], warnings: &mut Vec<Warning>) {
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

    fn drop_unused(&mut self) {
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
        (self.points, self.source) = (points, source);
    }

    /// Turns the surface inside out where that makes it face outward.
    fn face_outward(
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
