//! A model has one basis, of which the rest of the program asks some things.

use super::support::{Width, radius};

/// A basis is a family of shape functions; a scene has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Basis {
    /// Piecewise (multi)linear functions of the grid's cells.
    Linear,
    /// Linear functions averaged over particles of fixed size.
    Ugimp {
        /// l = l_p/h along each axis: half the particle's length in cells.
        half_length: [f64; 3],
    },
    /// Linear functions averaged over particles that stretch.
    Gimp {
        /// l = l_p/h along each axis before any stretch.
        half_length: [f64; 3],
    },
    /// Local maximum entropy, (30)-(37).
    Lme {
        /// γ = βh².
        gamma: f64,
        /// Nodes with exp(−γ|ξ|²) below this are left out.
        cutoff: f64,
        /// What |ξ| is in the cut-off.
        support: Support,
    },
    /// B-splines centred at the nodes.
    BSpline(Degree),
}

/// B-splines have one of two degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Degree {
    /// Parabolas, with one continuous derivative.
    Quadratic,
    /// Cubic functions, with two.
    Cubic,
}

/// The cut-off of local max-ent leaves a box of nodes, a ball, or what becomes of a ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// |ξ| is the largest distance along an axis: the functions are products of those of
    /// one axis.
    Box,
    /// |ξ| is the distance.
    Ball,
    /// |ξ| is the distance before the deformation: the metric goes with the material, and the
    /// functions with it. With OTM only, whose nodes go with it, too.
    Ellipsoid,
}

impl Basis {
    /// Gives the width of local max-ent; the functions of the other bases have none to choose.
    pub fn width(&self) -> Option<Width> {
        match self {
            Basis::Lme { gamma, cutoff, .. } => Some(Width::of(*gamma, *cutoff)),
            Basis::Linear | Basis::Ugimp { .. } | Basis::Gimp { .. } | Basis::BSpline(_) => None,
        }
    }

    /// Says whether each particle keeps a multiplier λ_p between tables.
    pub fn has_multiplier(&self) -> bool {
        match self {
            Basis::Lme { .. } => true,
            Basis::Linear | Basis::Ugimp { .. } | Basis::Gimp { .. } | Basis::BSpline(_) => false,
        }
    }

    /// Says whether each particle keeps A of its metric, B = γ AᵀA/h².
    pub fn has_metric(&self) -> bool {
        matches!(self, Basis::Lme { support: Support::Ellipsoid, .. })
    }

    /// Says whether each particle keeps its stretch along each axis.
    pub fn has_stretch(&self) -> bool {
        matches!(self, Basis::Gimp { .. })
    }

    /// Says whether a node that a particle has just touched counts at once, however small
    /// its mass, so that the limit of Δt is also taken with all particles moved by a touch.
    pub fn switches_nodes_on(&self) -> bool {
        match self {
            Basis::Ugimp { .. } | Basis::Gimp { .. } | Basis::BSpline(_) => true,
            Basis::Linear | Basis::Lme { .. } => false,
        }
    }

    /// Bounds the nodes that a particle sees along an axis that has `nodes` of them.
    pub fn most_along(&self, nodes: f64) -> f64 {
        match self {
            Basis::Linear => 2.0,
            Basis::Ugimp { .. } | Basis::BSpline(Degree::Quadratic) => 3.0,
            Basis::BSpline(Degree::Cubic) | Basis::Gimp { .. } => 4.0,
            Basis::Lme { gamma, cutoff, .. } => (2.0 * radius(*gamma, *cutoff) + 2.0).min(nodes),
        }
    }
}
