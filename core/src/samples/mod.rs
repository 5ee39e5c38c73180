//! Procedural limbs of real size, for demonstrations and tests.
