//! A flattened brace, for the host: layers, figures, files.

use rayon::prelude::*;
use wovenfit_core::design::Design;
use wovenfit_core::report::pressure_table;
use wovenfit_core::sheet::SheetUnit;
use wovenfit_core::surface::RawMesh;
use wovenfit_core::transfer::Transfer;
use wovenfit_core::{Flattening, PatternFormat, ResultFile};

use crate::ffi::{Field, Figures, NamedFile};
use crate::guard::{Failure, guarded_in_pool};

/// A flattened brace with what it was made from.
pub struct Pattern {
    pub(crate) flattening: Flattening,
    pub(crate) design: Design,
    pub(crate) raw: RawMesh,
    pub(crate) formats: Vec<PatternFormat>,
    pub(crate) sheet_unit: SheetUnit,
}

impl Pattern {
    /// x along warp and y along weft of every vertex of the pattern, in mm.
    pub(crate) fn coordinates(&self) -> Vec<f64> {
        self.flattening.coordinates.iter().flat_map(|p| p.to_array()).collect()
    }

    /// Three vertices for every triangle of the pattern.
    pub(crate) fn triangles(&self) -> Vec<u32> {
        // A mesh of 2^32 vertices does not fit into a host.
        self.flattening.disk().triangles().iter().flatten().map(|v| v.index() as u32).collect()
    }

    /// A value for every vertex of the pattern.
    pub(crate) fn field(&self, which: Field) -> Vec<f64> {
        let field = &self.flattening.field;
        match which {
            Field::WeftStrain => field.weft_strain.clone(),
            Field::Pressure => field.pressure_kpa.clone(),
            _ => field.warp_strain.clone(),
        }
    }

    /// Pattern coordinates of the three corners of every triangle given, in mm; NaN where the brace does
    /// not cover it.
    pub(crate) fn given_corners(&self) -> Result<Vec<f64>, Failure> {
        guarded_in_pool(|| {
            let corners = Transfer::new(&self.flattening, &self.raw).corners();
            let numbers = corners.iter().flat_map(|corners| match corners {
                Some([a, b, c]) => [a.x, a.y, b.x, b.y, c.x, c.y],
                None => [f64::NAN; 6],
            });
            Ok(numbers.collect())
        })
    }

    /// The figures.
    pub(crate) fn figures(&self) -> Figures {
        let report = &self.flattening.report;
        let seams = report.seams.iter().map(|seam| (seam.left_mm - seam.right_mm).abs());
        Figures {
            width_mm: report.pattern.width_mm,
            height_mm: report.pattern.height_mm,
            area_mm2: report.pattern.area_mm2,
            energy: report.fit.energy,
            curvature_radius_mm: report.curvature_radius_mm,
            steps: report.fit.iterations,
            converged: report.fit.converged,
            flipped: report.pattern.flipped,
            overlaps: report.pattern.overlaps,
            seam_mismatch_mm: seams.fold(0.0, f64::max),
            asked_kpa: report.pressures.iter().map(|p| p.asked_kpa).collect(),
            got_kpa: report.pressures.iter().map(|p| p.got_kpa.unwrap_or(f64::NAN)).collect(),
            missed: report.pressures.iter().filter(|p| p.reason.is_some()).count(),
        }
    }

    /// The table of pressures.
    pub(crate) fn table(&self) -> String {
        pressure_table(&self.flattening.report)
    }

    /// What the designer should know, each with its place.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let place = |at: Option<[f64; 3]>| {
            at.map_or_else(String::new, |[x, y, z]| format!(" [at ({x:.2}, {y:.2}, {z:.2}) mm]"))
        };
        let warnings = self.flattening.report.warnings.iter();
        warnings.map(|warning| format!("{}{}", warning.message, place(warning.at))).collect()
    }

    /// The files that the command line writes, with the pattern in the formats that were chosen.
    pub(crate) fn files(&self) -> Result<Vec<NamedFile>, Failure> {
        guarded_in_pool(|| {
            let text = |file: ResultFile| NamedFile {
                name: file.name().to_owned(),
                bytes: self.flattening.file(file, &self.design).into_bytes(),
                notes: Vec::new(),
            };
            let pattern = |format: PatternFormat| {
                let file = self.flattening.pattern(format, self.sheet_unit, &self.design);
                let (bytes, notes) = (file.bytes, file.notes);
                NamedFile { name: format.file_name().to_owned(), bytes, notes }
            };
            let texts = ResultFile::ALL.into_par_iter().filter(|&f| f != ResultFile::PatternSvg);
            let patterns = self.formats.par_iter().copied();
            Ok(texts.map(text).chain(patterns.map(pattern)).collect())
        })
    }
}
