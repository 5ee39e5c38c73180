//! Whole runs of the program, judged by what it prints and writes.

mod cli;
mod cutter;
mod demo;
mod field;
mod files;
mod fit;
mod invariance;
mod page;
mod paper;
mod parameters;
mod reasons;
mod samples;

use glam::DVec3;
use serde_json::Value;
use support::design::{upright, wanting};
use support::fixtures::bumpy;
use support::mesh::{Mesh, Triangulation};

/// A limb-sized tube without symmetry and a design for it, small enough to be fast.
fn limb() -> (Mesh, Value) {
    let mesh = bumpy(42.0, 110.0, 2.0, 40, Triangulation::Alternating);
    let on_axis = |angle: f64, z: f64| DVec3::new(42.0 * angle.cos(), 42.0 * angle.sin(), z);
    let design = wanting(&[(on_axis(0.6, 35.0), 1.6), (on_axis(0.7, 75.0), 2.0)]);
    (mesh, upright(design, on_axis(0.6, 105.0), on_axis(0.6, 5.0)))
}

/// Options that make a run on [`limb`] short.
const FAST: [&str; 3] = ["--quiet", "--spacing", "9"];
