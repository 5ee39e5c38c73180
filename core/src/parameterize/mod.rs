//! The initial planar parameterization Ω.
