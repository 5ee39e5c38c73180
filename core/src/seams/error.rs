//! Why a surface cannot be clipped, cut open or oriented.

use glam::DVec3;

use crate::surface::TopologyError;

/// Farthest that a designer's point may lie from the surface, in mm. A marker or a seam is drawn
/// on the limb itself; a centimetre is more than a scan's error and less than a limb's detail.
pub const REACH_MM: f64 = 10.0;

/// Why the region, the cut or the orientation markers cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SeamError {
    /// A region plane without a direction.
    #[error(
        "region plane {plane} (through {}) has the normal 0, 0, 0: give the direction to the side that the brace covers",
        place(*.point)
    )]
    PlaneWithoutNormal {
        /// Which plane, from 1.
        plane: usize,
        /// Its point, in mm.
        point: DVec3,
    },
    /// A region plane behind which nothing is left.
    #[error(
        "region plane {plane} (through {}, normal {}) leaves nothing of the surface, which spans {} to {}: move the plane's point or reverse its normal, which points to the kept side",
        place(*.point), place(*.normal), place(*.low), place(*.high)
    )]
    NothingLeft {
        /// Which plane, from 1.
        plane: usize,
        /// Its point, in mm.
        point: DVec3,
        /// Its normal.
        normal: DVec3,
        /// Lowest corner of what was there before this plane, in mm.
        low: DVec3,
        /// Highest corner of what was there before this plane, in mm.
        high: DVec3,
    },
    /// A selected face that the mesh does not have.
    #[error(
        "region face {face} does not exist: the surface has {count} faces, counted from 0; select the faces of this very mesh"
    )]
    NoSuchFace {
        /// The face.
        face: usize,
        /// How many there are.
        count: usize,
    },
    /// A selection that leaves nothing.
    #[error(
        "none of the {selected} selected faces belongs to the surface: select the faces that the brace covers"
    )]
    NothingSelected {
        /// How many were selected.
        selected: usize,
    },
    /// A surface without a boundary.
    #[error(
        "the surface is closed: it has no opening through which the limb enters; give two region planes, one across the limb at each end of the brace"
    )]
    Closed,
    /// A surface with handles.
    #[error(
        "the surface has {genus} handle{}: it is not a tube; repair the scan where it touches itself (between fingers, between limb and trunk, near {}), or keep a part without the handle by region planes",
        if *.genus == 1 { "" } else { "s" }, place(*.centre)
    )]
    Handles {
        /// How many handles.
        genus: i64,
        /// The middle of the surface, in mm.
        centre: DVec3,
    },
    /// A seam of fewer than two points.
    #[error("seam {seam} has {count} point{}: a seam needs at least two", if *.count == 1 { "" } else { "s" })]
    SeamTooShort {
        /// Which seam, from 1.
        seam: usize,
        /// How many points it has.
        count: usize,
    },
    /// A seam's point far from the surface.
    #[error(
        "point {point} of seam {seam}, ({}), lies {distance:.1} mm from the surface; a seam's points must lie within {REACH_MM} mm of it: move the point, or check the units",
        place(*.at)
    )]
    SeamPointFar {
        /// Which seam, from 1.
        seam: usize,
        /// Which of its points, from 1.
        point: usize,
        /// The point, in mm.
        at: DVec3,
        /// Its distance, in mm.
        distance: f64,
    },
    /// A seam of which no end is at an edge of the surface or at another seam.
    #[error(
        "seam {seam} begins ({}) and ends ({}) inside the surface: begin it within {REACH_MM} mm of an edge of the surface or of an earlier seam",
        place(*.start), place(*.end)
    )]
    SeamInside {
        /// Which seam, from 1.
        seam: usize,
        /// Its first point, in mm.
        start: DVec3,
        /// Its last point, in mm.
        end: DVec3,
    },
    /// No way from one point of a seam to the next.
    #[error(
        "seam {seam} cannot go on from its point {point}, ({}), to the next, ({}), without running along an edge of the surface: move the points farther from the edge",
        place(*.from), place(*.to)
    )]
    NoWay {
        /// Which seam, from 1.
        seam: usize,
        /// From which of its points, from 1.
        point: usize,
        /// That point, in mm.
        from: DVec3,
        /// The next point, in mm.
        to: DVec3,
    },
    /// No way between the two ends past the cut-outs.
    #[error(
        "no seam fits between the two ends of the tube (near {} and {}) without touching a cut-out: close the holes of the scan or draw the seam",
        place(*.proximal), place(*.distal)
    )]
    NoAutomaticSeam {
        /// Middle of one end, in mm.
        proximal: DVec3,
        /// Middle of the other end, in mm.
        distal: DVec3,
    },
    /// The seams leave the tube uncut.
    #[error(
        "the seams do not open the tube: no seam reaches the {girth:.0} mm long end near ({}) within {REACH_MM} mm: draw a seam from one end of the tube to the other, or give no seams to have it placed automatically",
        place(*.near)
    )]
    EndNotReached {
        /// Length of the end that is not reached, in mm.
        girth: f64,
        /// Its middle, in mm.
        near: DVec3,
    },
    /// The seams begin at both ends of the tube and do not meet.
    #[error(
        "the seams do not open the tube: seams begin at both ends, near ({}) and ({}), but do not meet; join them into one from end to end",
        place(*.proximal), place(*.distal)
    )]
    EndsNotJoined {
        /// Middle of one end, in mm.
        proximal: DVec3,
        /// Middle of the other end, in mm.
        distal: DVec3,
    },
    /// The seams cut the surface apart.
    #[error(
        "the seams split the surface into {pieces} pieces; the smallest, {area:.0} mm², lies near ({}): shorten a seam there so that the pattern is one piece",
        place(*.near)
    )]
    Split {
        /// How many pieces.
        pieces: usize,
        /// Area of the smallest, in mm².
        area: f64,
        /// Its middle, in mm.
        near: DVec3,
    },
    /// An orientation marker far from the surface.
    #[error(
        "orientation marker {marker}, ({}), lies {distance:.1} mm from the surface; it must lie within {REACH_MM} mm of it: move the marker, or check the units",
        place(*.at)
    )]
    MarkerFar {
        /// Which marker, from 1.
        marker: usize,
        /// The marker, in mm.
        at: DVec3,
        /// Its distance, in mm.
        distance: f64,
    },
    /// Both orientation markers at one place.
    #[error(
        "the two orientation markers lie {distance:.2} mm apart near ({}): they give the direction along the limb and must be apart; put the first near the body, the second near the far end",
        place(*.at)
    )]
    MarkersCoincide {
        /// The first marker, in mm.
        at: DVec3,
        /// Distance of the two on the surface, in mm.
        distance: f64,
    },
    /// A fault of the program.
    #[error("internal fault in the cut: {0}; please report it with the surface and the design")]
    Internal(String),
}

impl From<TopologyError> for SeamError {
    fn from(error: TopologyError) -> Self {
        Self::Internal(error.to_string())
    }
}

/// A place for people: millimetres with one decimal.
pub(super) fn place(p: DVec3) -> String {
    // Adding zero turns −0 into 0.
    let [x, y, z] = p.to_array().map(|x| (10.0 * x).round() / 10.0 + 0.0);
    format!("{x:.1}, {y:.1}, {z:.1}")
}
