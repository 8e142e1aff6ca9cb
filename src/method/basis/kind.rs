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
    /// Linear functions with the gradients of the dual domain method.
    Ddmp,
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

/// What the rest of the program asks of a basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traits {
    /// Each particle keeps a multiplier λ_p between tables.
    pub multiplier: bool,
    /// Each particle keeps A of its metric, B = γ AᵀA/h².
    pub metric: bool,
    /// Each particle keeps its stretch along each axis.
    pub stretch: bool,
    /// A node that a particle has just touched counts at once, however small its mass, so that the
    /// limit of Δt is also taken with all particles moved by a touch.
    pub switches_nodes_on: bool,
    /// |∇N|²/N has no bound, so that a node with hardly any mass may be pushed at any rate.
    pub pushes_light_nodes: bool,
    /// A particle sees at most so many nodes along an axis.
    pub along: f64,
}

// ANCHOR: bases
impl Basis {
    /// The words of a scene, in the order of the book.
    pub const WORDS: [&str; 6] = ["linear", "ugimp", "gimp", "lme", "bspline", "ddmp"];

    /// Says in one line for each basis what the rest of the program must know of it.
    pub fn traits(&self) -> Traits {
        let smooth = Traits {
            multiplier: false,
            metric: false,
            stretch: false,
            switches_nodes_on: true,
            pushes_light_nodes: false,
            along: 3.0,
        };
        match self {
            Basis::Linear => {
                Traits { switches_nodes_on: false, pushes_light_nodes: true, along: 2.0, ..smooth }
            }
            Basis::Ugimp { .. } | Basis::BSpline(Degree::Quadratic) => smooth,
            Basis::Gimp { .. } => Traits { stretch: true, along: 4.0, ..smooth },
            Basis::BSpline(Degree::Cubic) => Traits { along: 4.0, ..smooth },
            Basis::Lme { gamma, cutoff, support } => Traits {
                multiplier: true,
                metric: *support == Support::Ellipsoid,
                switches_nodes_on: false,
                along: 2.0 * radius(*gamma, *cutoff) + 2.0,
                ..smooth
            },
            Basis::Ddmp => Traits { pushes_light_nodes: true, along: 4.0, ..smooth },
        }
    }

    /// Gives the width of local max-ent; the functions of the other bases have none to choose.
    pub fn width(&self) -> Option<Width> {
        match self {
            Basis::Lme { gamma, cutoff, .. } => Some(Width::of(*gamma, *cutoff)),
            _ => None,
        }
    }
}
// ANCHOR_END: bases
