//! What the MeshLab plugin's C++ calls: the core's public API behind a [cxx](https://cxx.rs) bridge.
//!
//! The bridge is the one place outside `ffi` where memory crosses a language, and cxx writes that code:
//! nothing here is `unsafe` by hand. Like the C ABI it computes nothing. Every call that does work goes
//! through `guard.rs`: a refusal and a panic both become a C++ exception with a text; without
//! that a panic would end the host.
//!
//! Coordinates given are in the mesh's unit; all that comes back is in mm, kPa and strains without
//! unit. Indices count from 0.

#![deny(unsafe_code)]

mod check;
mod guard;
mod input;
mod job;
mod pattern;
mod table;

use check::{Check, check_surface};
use input::{Input, new_input};
use job::{Job, start};
use pattern::Pattern;
use table::{check_parameters, fabric_wishes, parameters, pattern_formats};

// What cxx writes: its unsafe code, and paths in full.
#[allow(unsafe_code, unused_qualifications)]
#[cxx::bridge(namespace = "wovenfit")]
mod ffi {
    /// What a parameter may be.
    #[derive(Debug)]
    enum Kind {
        /// A number in a closed range.
        Number,
        /// A whole number in a closed range.
        Integer,
        /// On or off.
        Switch,
        /// One of some names.
        Choice,
    }

    /// A row of the table of parameters.
    #[derive(Debug)]
    struct Parameter {
        /// Its name in snake case.
        name: String,
        /// Its unit, empty where it has none.
        unit: String,
        /// What it does, in one line.
        summary: String,
        /// When and why to change it, in a paragraph.
        text: String,
        /// What it may be.
        kind: Kind,
        /// The least number.
        least: f64,
        /// The largest number.
        most: f64,
        /// The names that it may be.
        choices: Vec<String>,
        /// Its default, as text.
        default_value: String,
    }

    /// A single value of the design file.
    #[derive(Debug)]
    struct Wish {
        /// Its place in the design file, such as `fabric.warp`.
        place: String,
        /// What it is.
        text: String,
        /// Its default, as text.
        default_value: String,
    }

    /// How far a job is.
    #[derive(Debug)]
    struct Progress {
        /// Of the whole job, from 0 to 100.
        percent: i32,
        /// What is being done.
        stage: String,
        /// Whether it has ended.
        ended: bool,
    }

    /// A value at every vertex of the pattern.
    #[derive(Debug)]
    enum Field {
        /// Strain along warp.
        WarpStrain,
        /// Strain along weft.
        WeftStrain,
        /// Pressure in kPa.
        Pressure,
    }

    /// A file of a result.
    #[derive(Debug)]
    struct NamedFile {
        /// What the file is called.
        name: String,
        /// What stands in it.
        bytes: Vec<u8>,
        /// What its format could not hold.
        notes: Vec<String>,
    }

    /// A format of the pattern.
    #[derive(Debug)]
    struct Format {
        /// Its short name.
        name: String,
        /// What it is for, in one line.
        summary: String,
    }

    /// The figures of a result.
    #[derive(Debug)]
    struct Figures {
        /// Extent of the pattern along warp, in mm.
        width_mm: f64,
        /// Extent along weft, in mm.
        height_mm: f64,
        /// Area in mm².
        area_mm2: f64,
        /// Energy of the fit in N·mm.
        energy: f64,
        /// Radius over which curvature was read, in mm.
        curvature_radius_mm: f64,
        /// Steps of the fit.
        steps: u64,
        /// Whether it converged.
        converged: bool,
        /// Triangles that lie upside down.
        flipped: usize,
        /// Places where the pattern's edge crosses itself.
        overlaps: usize,
        /// Largest difference in length of the two sides of a seam, in mm.
        seam_mismatch_mm: f64,
        /// Wanted and computed pressures in kPa, in the order of the table; NaN where unknown.
        asked_kpa: Vec<f64>,
        /// What was computed.
        got_kpa: Vec<f64>,
        /// Wanted pressures that are missed.
        missed: usize,
    }

    /// A defect of a surface.
    #[derive(Debug)]
    struct Defect {
        /// The vertices of the mesh given that it is about.
        vertices: Vec<u32>,
        /// The triangles of the mesh given that it is about.
        triangles: Vec<u32>,
    }

    extern "Rust" {
        fn parameters() -> Vec<Parameter>;
        fn check_parameters() -> Vec<Parameter>;
        fn fabric_wishes() -> Vec<Wish>;
        fn pattern_formats() -> Vec<Format>;

        type Input;
        fn new_input() -> Box<Input>;
        fn set_parameter(self: &mut Input, name: &str, value: &str) -> Result<()>;
        fn read_design(self: &mut Input, bytes: &[u8]) -> Result<()>;
        fn set_wish(self: &mut Input, place: &str, value: &str) -> Result<()>;
        fn set_formats(self: &mut Input, names: &str, unit: &str) -> Result<()>;
        fn set_mesh(self: &mut Input, points: &[f64], triangles: &[u32]) -> Result<()>;
        fn add_pressure(self: &mut Input, at: [f64; 3], value: f64, unit: &str) -> Result<()>;
        fn paint(self: &mut Input, values: &[f64], scale: f64, unit: &str) -> Result<()>;
        fn select(self: &mut Input, triangles: &[u32]) -> Result<()>;
        fn unit(self: &Input) -> String;
        fn mm_per_unit(self: &Input) -> f64;

        type Job;
        fn start(input: Box<Input>) -> Result<Box<Job>>;
        fn wait(self: &Job, milliseconds: u64) -> bool;
        fn progress(self: &Job) -> Progress;
        fn cancel(self: &Job);
        fn result(self: &mut Job) -> Result<Box<Pattern>>;

        type Pattern;
        fn coordinates(self: &Pattern) -> Vec<f64>;
        fn triangles(self: &Pattern) -> Vec<u32>;
        fn field(self: &Pattern, which: Field) -> Vec<f64>;
        fn given_corners(self: &Pattern) -> Result<Vec<f64>>;
        fn figures(self: &Pattern) -> Figures;
        fn table(self: &Pattern) -> String;
        fn warnings(self: &Pattern) -> Vec<String>;
        fn files(self: &Pattern) -> Result<Vec<NamedFile>>;

        type Check;
        fn check_surface(input: &Input) -> Result<Box<Check>>;
        fn text(self: &Check) -> String;
        fn defects(self: &Check) -> Vec<Defect>;
        fn warning_count(self: &Check) -> usize;
    }
}
