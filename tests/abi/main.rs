//! The shared library as a host loads it: by its path, function by function, with the signatures of
//! `include/wovenfit.h` written by hand.

mod given;
mod host;
mod loading;
mod pattern;

use glam::DVec3;
use serde_json::Value;
use support::design::{upright, wanting};
use support::fixtures::bumpy;
use support::mesh::{Mesh, Triangulation};

/// A limb-sized tube without symmetry and a design for it, small enough to be fast.
fn limb() -> (Mesh, Value) {
    let mesh = bumpy(42.0, 110.0, 2.0, 40, Triangulation::Jittered(3));
    let on_axis = |angle: f64, z: f64| DVec3::new(42.0 * angle.cos(), 42.0 * angle.sin(), z);
    let design = wanting(&[(on_axis(0.6, 35.0), 1.6), (on_axis(0.7, 75.0), 2.0)]);
    (mesh, upright(design, on_axis(0.6, 105.0), on_axis(0.6, 5.0)))
}
