//! Local max-ent cannot serve every point, and says why.

use thiserror::Error;

/// A failure says why there is no λ, or none that serves, and what to do.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Failure {
    /// x is not in the convex hull of the nodes, or the nodes span no volume.
    #[error(
        "the point is outside the convex hull of its nodes, or they span no volume; put nodes \
         around it, or let it see more of them with a smaller gamma or cutoff"
    )]
    OutsideHull,
    /// A coordinate of the point or of a node is NaN or infinite.
    #[error("a coordinate of the point or of a node is not a finite number")]
    NotFinite,
    /// |r| (–) after so many iterations.
    #[error(
        "|r| is still {residual:e} after {iterations} Newton iterations; take a smaller gamma, or \
         move the point off the hull, line or plane of nodes that it is near to"
    )]
    NotConverged { residual: f64, iterations: usize },
    /// Σ N_I = 1, Σ N_I x_I = x, Σ ∇N_I = 0 or Σ x_I ⊗ ∇N_I = 1 is missed by so much (–).
    #[error(
        "its functions and gradients miss their sums by {error:e}, since it is next to nodes that \
         are almost in one plane; move the point off them, or the nodes onto the plane"
    )]
    Inexact { error: f64 },
}
