//! The limit of Δt: predicted before a run, measured by marching, and watched while the
//! particles move.
//!
//! Hold the particles where they are. With M the mass matrix that the scheme
//! divides by, M_C the consistent one and K the stiffness, every scheme here is
//! stable up to Δt = 2/√λ with λ the largest eigenvalue of
//!
//! M⁻¹ K g(A),  A = M⁻¹ M_C,
//!
//! and g a function of the scheme on [0, 1], where the eigenvalues of A lie:
//! g(s) = s for the leapfrogs, 2 − s for stress-last, and for generalized-α
//! g(s) = 2p/l with l = 1 − α_m − α_m s and
//! p = (1 + s)(β − γs/2) − s(1 − s)/2. OTM maps nothing: g = 1.

mod factor;
mod lanczos;
mod march;
mod noise;
mod operator;
mod predict;
mod watch;

pub use lanczos::Tridiagonal;
pub use march::{grows, measured};
pub use noise::noise;
pub use operator::Operator;
pub use predict::{Critical, at_offset, critical, limit, over_offsets, predicted, runnable};
pub use watch::{Balance, Watch};
