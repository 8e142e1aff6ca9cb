//! The discretised continuum, §2-3 of the paper, stands here: what particles and nodes carry,
//! the pointwise laws, the table of shape functions, and the sums that move quantities between
//! the two.

pub mod equilibrium;
pub mod filter;
pub mod hyperelastic;
pub mod law;
pub mod light;
pub mod loads;
pub mod mass;
pub mod moduli;
pub mod shape;
pub mod sparse;
pub mod state;
pub mod sums;
