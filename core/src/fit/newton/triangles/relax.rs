//! Vertex by vertex to rest, where a Hessian from elsewhere does not serve.
//!
//! Where an ankle's instep folds, a few triangles are stretched so far that their stiffness changes tenfold while
//! a step moves them by half their size. A Hessian kept from before overshoots there, and all of the fabric that
//! hangs on the fold follows by as little as the fold lets it. So where triangles have changed much since the
//! Hessian was taken, each vertex is moved to the rest of its own surroundings (Gauss–Seidel with Newton's steps
//! in two unknowns, by the Gauss–Newton matrix where the other is not positive), and the next step has only what is
//! smooth to do. It never raises the energy and changes nothing at the minimum.

use glam::{DMat2, DVec2};
use rayon::prelude::*;

use super::{PER_TASK, Triangles, Turning, Wanted, Worn};
use crate::fit::newton::element::{
    Gradients, Order, Springs, bend, force_at_corners, slope, stiffening_energy, turn,
};

/// Where a triangle's shape has changed by more than this share, its corners are relaxed. At 0.06 so many of a
/// wrist's are that they hinder the steps.
const CHANGED: f64 = 0.2;

/// Where more vertices than this share of all are to be relaxed the Hessian is of no use anywhere, and they are left
/// to the next one: sweeps over many take long, and cannot be cancelled.
const MOST: f64 = 0.02;

/// So many are always few.
const FEW: usize = 200;

/// Sweeps over them, there and back in turn.
const SWEEPS: usize = 6;

/// They end when one moves no vertex by more than this share of the tolerance.
const LEFT: f64 = 0.01;

/// A vertex's step halved this often is no step.
const HALVINGS: usize = 4;

/// What the vertices are at rest against.
#[derive(Clone, Copy)]
pub struct Forces<'a> {
    /// Stiffness of the springs.
    pub springs: &'a Springs,
    /// The strains wanted.
    pub wanted: &'a Wanted,
    /// The turning springs.
    pub turning: &'a [Turning],
}

impl Triangles {
    /// Relaxes the vertices of triangles that have changed much from `earlier` pattern coordinates, but for
    /// those `held`. How far the first sweep has moved one at most, in mm.
    pub fn relax(
        &self,
        coordinates: &mut [DVec2],
        earlier: &[DVec2],
        held: impl Iterator<Item = usize>,
        forces: &Forces<'_>,
        tolerance: f64,
    ) -> f64 {
        let vertices = self.changed(coordinates, earlier, held);
        if vertices.len() > FEW.max((MOST * coordinates.len() as f64) as usize) {
            return 0.0;
        }
        let mut first = 0.0;
        for sweep in 0..SWEEPS {
            let mut most = 0.0f64;
            let mut one = |&v: &usize| most = most.max(self.relax_vertex(coordinates, v, forces));
            if sweep % 2 == 0 {
                vertices.iter().for_each(&mut one);
            } else {
                vertices.iter().rev().for_each(&mut one);
            }
            if sweep == 0 {
                first = most;
            }
            if most <= LEFT * tolerance {
                break;
            }
        }
        first
    }

    /// The corners of triangles that have changed much, in order.
    fn changed(
        &self,
        coordinates: &[DVec2],
        earlier: &[DVec2],
        held: impl Iterator<Item = usize>,
    ) -> Vec<usize> {
        let parts: Vec<Vec<usize>> = self
            .worn
            .par_chunks(PER_TASK)
            .map(|part| {
                let changed = part.iter().filter(|worn| worn.has_changed(coordinates, earlier));
                changed.flat_map(|worn| worn.corners.map(|v| v as usize)).collect()
            })
            .collect();
        let mut vertices = parts.concat();
        vertices.sort_unstable();
        vertices.dedup();
        if !vertices.is_empty() {
            let mut held: Vec<usize> = held.collect();
            held.sort_unstable();
            vertices.retain(|v| held.binary_search(v).is_err());
        }
        vertices
    }

    /// The gradient by a vertex's coordinates, in N, and the second derivatives to an order, in N/mm.
    fn round_vertex(
        &self,
        coordinates: &[DVec2],
        v: usize,
        forces: &Forces<'_>,
        order: Order,
    ) -> (DVec2, DMat2) {
        let Forces { springs, wanted, turning } = *forces;
        let mut force = DVec2::ZERO;
        let mut stiffness = [0.0; 3];
        for &corner in self.corners_at(v) {
            let (t, k) = (corner as usize / 3, corner as usize % 3);
            let (worn, turning) = (&self.worn[t], &turning[t]);
            let (g, y) = Self::gradients(worn, coordinates);
            let wanted = wanted.at(y);
            let mut slope = slope(&g, springs, &wanted);
            let mut bend = bend(&g, springs, &wanted, order);
            for (of_y, along, s) in [
                (true, turning.warp, turning.stiffness[0]),
                (false, turning.weft, turning.stiffness[1]),
            ] {
                turn(&mut slope, &g, of_y, along, s);
                bend.turn(of_y, along, s);
            }
            let of_corners = force_at_corners(&slope, &worn.hats, worn.area);
            force += DVec2::new(of_corners[2 * k], of_corners[2 * k + 1]);
            let here = bend.at_corner(worn.hats[k], worn.area);
            stiffness.iter_mut().zip(here).for_each(|(sum, here)| *sum += here);
        }
        let [xx, xy, yy] = stiffness;
        (force, DMat2::from_cols_array(&[xx, xy, xy, yy]))
    }

    /// Moves a vertex towards rest as far as the energy falls; how far, in mm.
    fn relax_vertex(&self, coordinates: &mut [DVec2], v: usize, forces: &Forces<'_>) -> f64 {
        let Forces { springs, wanted, turning } = *forces;
        let (mut force, mut stiffness) = self.round_vertex(coordinates, v, forces, Order::Full);
        if stiffness.x_axis.x <= 0.0 || stiffness.determinant() <= 0.0 {
            (force, stiffness) = self.round_vertex(coordinates, v, forces, Order::First);
        }
        let step = -(stiffness.inverse() * force);
        if !step.is_finite() {
            return 0.0;
        }
        let corners = self.corners_at(v);
        let value = |coordinates: &[DVec2]| -> f64 {
            corners
                .iter()
                .map(|&corner| {
                    let t = corner as usize / 3;
                    let worn = &self.worn[t];
                    let (g, y) = Self::gradients(worn, coordinates);
                    worn.area
                        * (stiffening_energy(&g, springs, &wanted.at(y)) + turning[t].energy(&g))
                })
                .sum()
        };
        let (from, before) = (coordinates[v], value(coordinates));
        let mut length = 1.0;
        for _ in 0..HALVINGS {
            coordinates[v] = from + length * step;
            if value(coordinates) <= before {
                return length * step.length();
            }
            length *= 0.5;
        }
        coordinates[v] = from;
        0.0
    }
}

impl Worn {
    /// Whether the pattern's shape here is another than it was, in size or direction.
    fn has_changed(&self, coordinates: &[DVec2], earlier: &[DVec2]) -> bool {
        let shape = |coordinates: &[DVec2]| {
            let (Gradients { x, y }, _) = Triangles::gradients(self, coordinates);
            DMat2::from_cols(DVec2::new(x.x, y.x), DVec2::new(x.y, y.y))
        };
        let change = shape(coordinates) * shape(earlier).inverse() - DMat2::IDENTITY;
        change.x_axis.length_squared() + change.y_axis.length_squared() > CHANGED * CHANGED
    }
}
