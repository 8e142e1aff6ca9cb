//! Which shape functions a model has.

/// The basis of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Basis {
    /// Piecewise (multi)linear functions of the grid's cells.
    Linear,
    /// Linear functions averaged over particles of fixed size.
    Ugimp {
        /// l = l_p/h along each axis: half the particle's length in cells.
        half_length: [f64; 3],
    },
    /// Local maximum entropy, (30)-(37).
    Lme {
        /// γ = βh².
        gamma: f64,
        /// Nodes with exp(−γ|ξ|²) below this are left out.
        cutoff: f64,
    },
    /// Quadratic B-splines centred at the nodes.
    BSpline,
}
