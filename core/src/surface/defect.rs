//! What can be wrong with a raw mesh, by name, index and place.

use std::fmt;

use glam::DVec3;
use serde::Serialize;

use super::topology::TopologyError;

/// A kind of defect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DefectKind {
    /// There are no points or no faces.
    Empty,
    /// There are more points or faces than can be numbered.
    TooLarge,
    /// A coordinate is NaN, infinite, or beyond any length of a limb.
    NotFinite,
    /// A face names a vertex that does not exist.
    IndexOutOfRange,
    /// A face has no area.
    DegenerateTriangle,
    /// Two faces have the same corners.
    DuplicateTriangle,
    /// A face with more than three corners crosses itself.
    CrossedPolygon,
    /// More than two faces meet at an edge.
    NonManifoldEdge,
    /// The surface touches itself at a vertex.
    NonManifoldVertex,
    /// The surface has only one side.
    NotOrientable,
    /// The surface is in several pieces.
    SeveralComponents,
    /// The shape does not show which side is outside.
    AmbiguousFacing,
    /// A fault of the program: no mesh should lead here.
    Fault,
}

/// A defect of a raw mesh. Faces and vertices are those of the file, counted from 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Defect {
    /// What it is.
    pub kind: DefectKind,
    /// The vertices concerned.
    pub vertices: Vec<usize>,
    /// The faces concerned.
    pub faces: Vec<usize>,
    /// Where it is, in mm, if it is at one place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// What it is, where, and what to do about it, for people.
    pub message: String,
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// Why a raw mesh is no [`Surface`](super::Surface): all its defects.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SurfaceError {
    defects: Vec<Defect>,
}

impl SurfaceError {
    /// Every defect, in the order of the checks and within a check of the file.
    #[must_use]
    pub fn defects(&self) -> &[Defect] {
        &self.defects
    }

    /// Whether it is a fault of the program and not of the mesh.
    #[must_use]
    pub fn is_fault(&self) -> bool {
        self.defects.iter().any(|defect| defect.kind == DefectKind::Fault)
    }

    pub(super) fn new(defects: Vec<Defect>) -> Self {
        Self { defects }
    }
}

impl From<Defect> for SurfaceError {
    fn from(defect: Defect) -> Self {
        Self { defects: vec![defect] }
    }
}

impl fmt::Display for SurfaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// Enough to see what is wrong; a mesh that is broken everywhere has thousands.
        const SHOWN: usize = 5;
        if let [defect] = self.defects.as_slice() {
            return write!(f, "{defect} (faces and vertices are counted from 0)");
        }
        let count = self.defects.len();
        write!(f, "the surface has {count} defects (faces and vertices are counted from 0):")?;
        for defect in self.defects.iter().take(SHOWN) {
            write!(f, "\n  {defect}")?;
        }
        if count > SHOWN {
            write!(f, "\n  and {} more", count - SHOWN)?;
        }
        Ok(())
    }
}

impl std::error::Error for SurfaceError {}

/// A place for people: hundredths of a millimetre are below what a scanner resolves.
pub(super) fn place(p: DVec3) -> String {
    // Adding 0 turns a rounded −0 into 0.
    let round = |x: f64| (x * 100.0).round() / 100.0 + 0.0;
    format!("({:.2}, {:.2}, {:.2}) mm", round(p.x), round(p.y), round(p.z))
}

/// "1, 2 and 3".
pub(super) fn list(numbers: &[usize]) -> String {
    let texts: Vec<String> = numbers.iter().map(ToString::to_string).collect();
    match texts.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

impl Defect {
    fn new(kind: DefectKind, message: String) -> Self {
        Self { kind, vertices: Vec::new(), faces: Vec::new(), at: None, message }
    }

    fn vertices(self, vertices: &[usize]) -> Self {
        Self { vertices: vertices.to_vec(), ..self }
    }

    fn faces(self, faces: &[usize]) -> Self {
        Self { faces: faces.to_vec(), ..self }
    }

    fn at(self, p: DVec3) -> Self {
        Self { at: p.is_finite().then(|| p.to_array()), ..self }
    }

    pub(super) fn empty() -> Self {
        Self::new(
            DefectKind::Empty,
            "the mesh has no faces: export the surface as a mesh of triangles".to_owned(),
        )
    }

    pub(super) fn too_large(points: usize, faces: usize, most: usize) -> Self {
        Self::new(
            DefectKind::TooLarge,
            format!(
                "the mesh has {points} points and {faces} faces, but {most} of each are the most \
                 that can be numbered: decimate it"
            ),
        )
    }

    pub(super) fn not_finite(vertex: usize, p: DVec3) -> Self {
        let what = if p.is_nan() {
            "a coordinate that is not a number"
        } else if p.is_finite() {
            "a coordinate of more than a thousand kilometres"
        } else {
            "an infinite coordinate"
        };
        Self::new(
            DefectKind::NotFinite,
            format!(
                "vertex {vertex} has {what}, ({}, {}, {}) mm: delete the vertex or export again",
                p.x, p.y, p.z
            ),
        )
        .vertices(&[vertex])
        .at(p)
    }

    pub(super) fn index_out_of_range(
        face: usize,
        vertex: usize,
        count: usize,
        known: Option<DVec3>,
    ) -> Self {
        let near = known.map_or(String::new(), |p| format!(" at {}", place(p)));
        Self::new(
            DefectKind::IndexOutOfRange,
            format!(
                "face {face}{near} names vertex {vertex}, but there are {count} vertices: export \
                 the mesh again"
            ),
        )
        .vertices(&[vertex])
        .faces(&[face])
        .at(known.unwrap_or(DVec3::NAN))
    }

    pub(super) fn degenerate(face: usize, corners: &[usize], p: DVec3) -> Self {
        let why = match corners.len() {
            0..=2 => format!("{} corners", corners.len()),
            _ => format!("its corners {} lie on one line or point", list(corners)),
        };
        Self::new(
            DefectKind::DegenerateTriangle,
            format!(
                "face {face} at {} has no area ({why}): delete it or merge its close vertices",
                place(p)
            ),
        )
        .vertices(corners)
        .faces(&[face])
        .at(p)
    }

    pub(super) fn duplicate(faces: [usize; 2], corners: &[usize; 3], p: DVec3) -> Self {
        Self::new(
            DefectKind::DuplicateTriangle,
            format!(
                "faces {} at {} have the same corners {}: delete one of them",
                list(&faces),
                place(p),
                list(corners)
            ),
        )
        .vertices(corners)
        .faces(&faces)
        .at(p)
    }

    pub(super) fn crossed_polygon(face: usize, corners: &[usize], p: DVec3) -> Self {
        Self::new(
            DefectKind::CrossedPolygon,
            format!(
                "face {face} at {} with {} corners crosses itself and cannot be split into \
                 triangles: triangulate it",
                place(p),
                corners.len()
            ),
        )
        .vertices(corners)
        .faces(&[face])
        .at(p)
    }

    pub(super) fn non_manifold_edge(ends: [usize; 2], faces: &[usize], p: DVec3) -> Self {
        Self::new(
            DefectKind::NonManifoldEdge,
            format!(
                "the edge between vertices {} at {} belongs to {} faces ({}) instead of one or \
                 two: delete the faces that stick out or lie inside",
                list(&ends),
                place(p),
                faces.len(),
                list(faces)
            ),
        )
        .vertices(&ends)
        .faces(faces)
        .at(p)
    }

    pub(super) fn non_manifold_vertex(vertex: usize, faces: &[usize], p: DVec3) -> Self {
        Self::new(
            DefectKind::NonManifoldVertex,
            format!(
                "the surface touches itself at vertex {vertex} at {}: its faces form {} separate \
                 fans (faces {} are one of each): split the vertex or delete all fans but one",
                place(p),
                faces.len(),
                list(faces)
            ),
        )
        .vertices(&[vertex])
        .faces(faces)
        .at(p)
    }

    pub(super) fn not_orientable(ends: [usize; 2], faces: [usize; 2], p: DVec3) -> Self {
        Self::new(
            DefectKind::NotOrientable,
            format!(
                "the surface has only one side: followed all round, front meets back at the edge \
                 between vertices {} at {} (faces {}): cut out the twisted strip",
                list(&ends),
                place(p),
                list(&faces)
            ),
        )
        .vertices(&ends)
        .faces(&faces)
        .at(p)
    }

    pub(super) fn several_components(components: &[Component]) -> Self {
        /// Beyond these only their number is said: crumbs come by the hundred.
        const SHOWN: usize = 10;
        let mut pieces: Vec<String> =
            components.iter().take(SHOWN).map(ToString::to_string).collect();
        if components.len() > SHOWN {
            pieces.push(format!("{} smaller ones", components.len() - SHOWN));
        }
        Self::new(
            DefectKind::SeveralComponents,
            format!(
                "the surface is in {} separate pieces: {}: delete what does not belong to the \
                 limb, or keep only the largest with keep_largest",
                components.len(),
                pieces.join("; ")
            ),
        )
        .faces(&components.iter().map(|c| c.face).collect::<Vec<_>>())
    }

    pub(super) fn ambiguous_facing() -> Self {
        Self::new(
            DefectKind::AmbiguousFacing,
            "the surface is so flat, or bulges and hollows so alike, that its shape does not show \
             which side is outside: set \"facing\" in the design to \"outward\" if its faces are \
             counter-clockwise seen from outside the body, otherwise to \"inward\""
                .to_owned(),
        )
    }

    pub(super) fn fault(error: &TopologyError) -> Self {
        Self::new(
            DefectKind::Fault,
            format!("a fault of the program, please report it with the file: {error}"),
        )
    }
}

/// A connected piece of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Component {
    /// Its first face in the file.
    pub(super) face: usize,
    /// Number of its triangles.
    pub(super) triangles: usize,
    /// Its area, in mm².
    pub(super) area: f64,
    /// Its bounding box, in mm.
    pub(super) min: DVec3,
    pub(super) max: DVec3,
}

impl fmt::Display for Component {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.max - self.min;
        write!(
            f,
            "{} triangle{} of {:.0} × {:.0} × {:.0} mm round {}",
            self.triangles,
            if self.triangles == 1 { "" } else { "s" },
            size.x,
            size.y,
            size.z,
            place(0.5 * (self.min + self.max))
        )
    }
}
