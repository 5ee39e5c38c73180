//! Surfaces to fit, with what is wished on them.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::Solver;
use crate::design::{Fabric, PressureModel};
use crate::fit::{Fit, FitInput};
use crate::geometry::{Grading, Locator, ShapeOperator, SurfacePoint};
use crate::parameters::Parameters;
use crate::pressure::Annotation;
use crate::progress::Silent;
use crate::seams::Seam;
use crate::surface::{Surface, VertexId};

/// A sheet of (rows + 1) × (columns + 1) vertices; diagonals alternate if wanted.
pub fn sheet(
    rows: usize,
    columns: usize,
    alternate: bool,
    place: impl Fn(f64, f64) -> DVec3,
) -> Surface {
    let mut points = Vec::new();
    for i in 0..=rows {
        for j in 0..=columns {
            points.push(place(j as f64 / columns as f64, i as f64 / rows as f64));
        }
    }
    let id = |i: usize, j: usize| VertexId::new(i * (columns + 1) + j);
    let mut triangles = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let [a, b, c, d] = [id(i, j), id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)];
            if alternate && (i + j) % 2 == 1 {
                triangles.extend([[a, b, d], [b, c, d]]);
            } else {
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    Surface::new(points, triangles).unwrap()
}

pub fn at(surface: &Surface, place: DVec3) -> SurfacePoint {
    Locator::new(surface).closest(place).unwrap().0
}

/// A wish for the strain `strain` in the default fabric, on a place that curves like a cylinder.
pub fn wish(surface: &Surface, place: DVec3, up: DVec3, strain: f64) -> Annotation {
    let point = at(surface, place);
    let normal = surface.normal(point.triangle);
    let v = up.reject_from(normal).normalize();
    let shape = ShapeOperator { normal, u: v.cross(normal), v, kuu: 0.02, kuv: 0.0, kvv: 0.0 };
    let kpa = 0.5 * strain * 0.02 * 1000.0;
    Annotation { at: place, point, kpa, shape }
}

pub struct Case {
    pub disk: Surface,
    pub seams: Vec<Seam>,
    pub omega: Vec<DVec2>,
    pub markers: [SurfacePoint; 2],
    pub annotations: Vec<Annotation>,
    pub fabric: Fabric,
    pub parameters: Parameters,
}

impl Case {
    pub fn new(disk: Surface, omega: Vec<DVec2>, markers: [DVec3; 2]) -> Self {
        let markers = markers.map(|place| at(&disk, place));
        Self {
            disk,
            seams: Vec::new(),
            omega,
            markers,
            annotations: Vec::new(),
            fabric: Fabric::default(),
            parameters: Parameters::default(),
        }
    }

    pub fn input(&self) -> FitInput<'_> {
        FitInput {
            disk: &self.disk,
            omega: &self.omega,
            markers: &self.markers,
            annotations: &self.annotations,
            fabric: &self.fabric,
            pressure_model: PressureModel::Laplace,
            parameters: &self.parameters,
        }
    }

    pub fn solver(&self) -> Solver {
        Solver::new(&self.disk, &self.seams, self.parameters.equal_seams).unwrap()
    }

    /// One that begins on fewer vertices.
    pub fn coarse_to_fine(&self) -> Solver {
        let mut solver = self.solver();
        let (equal, even) = (self.parameters.equal_seams, Grading::default());
        solver.coarsen(&self.disk, &self.seams, &self.omega, equal, &even).unwrap();
        assert!(solver.coarse.is_some(), "{} triangles", self.disk.triangle_count());
        solver
    }

    pub fn fit(&self) -> Fit {
        self.solver().fit(&self.input(), None, &Silent).unwrap().0
    }

    /// The pattern with its first marker upright over the second, the second at the origin.
    pub fn placed(&self, fit: &Fit) -> Vec<DVec2> {
        let [_, low] = self.markers.map(|m| m.interpolate(&self.disk, &fit.coordinates));
        fit.coordinates.iter().map(|&p| p - low).collect()
    }
}

pub fn gap(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// A slit barrel: doubly curved, with the slit's two sides sewn together.
pub fn barrel(rows: usize, columns: usize, alternate: bool) -> Case {
    let place = |s: f64, t: f64| {
        let belly = (std::f64::consts::PI * t).sin();
        let r = 42.0 + 9.0 * belly + (3.0 * t - 4.0 * belly) * (TAU * (s - 0.1)).sin();
        let a = TAU * s;
        DVec3::new(r * a.cos(), r * a.sin(), 140.0 * t)
    };
    let disk = sheet(rows, columns, alternate, place);
    let omega =
        disk.points().iter().enumerate().map(|(k, p)| {
            DVec2::new(300.0 * (k % (columns + 1)) as f64 / columns as f64, 1.05 * p.z)
        });
    let omega = omega.collect();
    let mut case = Case::new(disk, omega, [place(0.5, 1.0), place(0.5, 0.0)]);
    let id = |i: usize, j: usize| VertexId::new(i * (columns + 1) + j);
    case.seams = vec![Seam {
        left: (0..=rows).rev().map(|i| id(i, 0)).collect(),
        right: (0..=rows).rev().map(|i| id(i, columns)).collect(),
    }];
    case.annotations = [(0.52, 0.3, 0.12), (0.45, 0.7, 0.2)]
        .map(|(s, t, strain)| wish(&case.disk, place(s, t), DVec3::Z, strain))
        .to_vec();
    case
}

/// A flat sheet with wishes that are not the same along weft; its triangles can lean over so far that they have angles of
/// 135 degrees.
pub fn flat(rows: usize, columns: usize, leaning: bool) -> Case {
    let place = |s: f64, t: f64| DVec3::new(240.0 * s, 140.0 * t, 0.0);
    let upright = sheet(rows, columns, false, place);
    let id = |i: usize, j: usize| VertexId::new(i * (columns + 1) + j);
    let mut triangles = Vec::new();
    for i in 0..rows {
        triangles.push([id(i, 0), id(i + 1, 1), id(i + 1, 0)]);
        for j in 0..columns - 1 {
            let [a, b, c, d] = [id(i, j), id(i, j + 1), id(i + 1, j + 2), id(i + 1, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        triangles.push([id(i, columns - 1), id(i, columns), id(i + 1, columns)]);
    }
    let points = upright.points().to_vec();
    let omega = points.iter().map(|p| p.truncate()).collect();
    let disk = if leaning { Surface::new(points, triangles).unwrap() } else { upright };
    let mut case = Case::new(disk, omega, [place(0.5, 1.0), place(0.5, 0.0)]);
    case.annotations = [(0.5, 0.2, 0.02), (0.5, 0.5, 0.3), (0.5, 0.8, 0.05)]
        .map(|(s, t, strain)| wish(&case.disk, place(s, t), DVec3::Y, strain))
        .to_vec();
    case
}
