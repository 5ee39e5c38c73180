//! The woven model Γ: a spring mesh on the surface.
