//! The woven model Γ (section 3 of the paper): a spring mesh on the surface.
//!
//! How the paper's assumptions and lemmas stand in this code:
//!
//! - Assumption 1, Lemma 1 (one material along each thread; anisotropy by stiffness): one stiffness
//!   per [`SpringKind`], from [`Fabric`](crate::design::Fabric).
//! - Assumption 2, Lemma 2 (weak in shear, k_diag ≪ k_warp, k_weft): diagonal springs take part in
//!   the energy, never in a pressure.
//! - Assumption 3 (no slippage at a crossing): a node belongs to one warp and one weft thread for
//!   good; its index (i, j) never changes.
//! - Assumption 4 (no friction): forces act along the surface alone and nothing resists them.
//! - Lemma 3 (one strain along a thread): targets are per warp thread, see
//!   [`pressure`](crate::pressure).
//! - Lemma 4 (weft strain near zero): one wanted weft strain for the whole fabric.

mod laying;
mod model;
mod nearest;
mod rest;

pub use laying::lay;
pub use model::{NodeIndex, Spring, SpringKind, WovenModel};
pub use nearest::NodeSearch;
pub use rest::RestLengths;
