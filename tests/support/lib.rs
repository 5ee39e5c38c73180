//! What the tests share: fixtures with analytic truth, broken meshes, writers of mesh files, a
//! runner of the built program, and checkers that recompute what the program claims.
//!
//! Nothing here calls the product's algorithms: fixtures, writers and checkers are written anew,
//! so that a fault in the product cannot hide itself. `README.md` says which test goes where.

pub mod broken;
pub mod check;
pub mod cli;
pub mod design;
pub mod fixtures;
pub mod mesh;
pub mod motion;
pub mod random;
pub mod write;
