//! Raw triangles become a validated surface once; later stages cannot be handed anything else.

mod index;
mod raw;
mod read;
mod topology;

pub use index::{HalfEdgeId, TriangleId, VertexId};
pub use raw::RawMesh;
pub use read::{Format, ReadError, read};
pub use topology::{BoundaryLoop, Surface, TopologyError};
