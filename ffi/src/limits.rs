//! How much the library takes: beyond, it refuses with the limit instead of asking for memory
//! without bound.

/// Most vertices of a mesh: three for each of the most triangles, as a mesh without shared vertices
/// has.
pub const WOVENFIT_MOST_VERTICES: u32 = 6_000_000;

/// Most triangles of a mesh. A limb scanned to half a millimetre has fewer; decimate beyond.
pub const WOVENFIT_MOST_TRIANGLES: u32 = 2_000_000;

/// Most wanted pressures of a design. Paint more onto the vertices instead.
pub const WOVENFIT_MOST_PRESSURES: u32 = 1000;

/// Most points of all seams of a design together.
pub const WOVENFIT_MOST_SEAM_POINTS: u32 = 5000;

/// Most planes of a region, and most bony places.
pub const WOVENFIT_MOST_PLANES: u32 = 1000;

/// Most bytes of a text given to the library.
pub const WOVENFIT_MOST_TEXT: u32 = 64_000_000;
