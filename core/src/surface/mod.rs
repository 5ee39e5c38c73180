//! Raw triangles become a validated surface once; later stages cannot be handed anything else.

mod connectivity;
mod defect;
mod holes;
mod index;
mod mesh;
mod orientation;
mod origin;
mod polygon;
mod raw;
mod read;
mod rounding;
mod shape;
mod topology;
mod validate;
mod weld;

pub use defect::{Defect, DefectKind, SurfaceError};
pub use index::{HalfEdgeId, TriangleId, VertexId};
pub use origin::{Origin, Scan};
pub use raw::RawMesh;
pub use read::{Format, ReadError, read};
pub(crate) use rounding::in_mm;
pub use rounding::on_grid;
pub use shape::{Shape, shape_of};
pub use topology::{BoundaryLoop, Surface, TopologyError};
pub use validate::{SurfaceOptions, Validated, validate};
