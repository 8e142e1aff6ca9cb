//! Local max-ent cannot serve every point, and says why.

use thiserror::Error;

/// A failure says why there is no λ.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Failure {
    /// x is not in the convex hull of the nodes, or the nodes span no volume.
    #[error("the point is outside the convex hull of its nodes, or they span no volume")]
    OutsideHull,
    /// A coordinate of the point or of a node is NaN or infinite.
    #[error("a coordinate of the point or of a node is not a finite number")]
    NotFinite,
    /// |r| (–) after so many iterations.
    #[error("|r| is still {residual:e} after {iterations} Newton iterations")]
    NotConverged { residual: f64, iterations: usize },
}
