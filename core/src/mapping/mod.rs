//! The surface-plane mapping: from woven nodes to every vertex of the surface.
