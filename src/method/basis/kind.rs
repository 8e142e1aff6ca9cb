//! The list of bases: what a scene calls each, what the rest of the program must know of it, and
//! how a row of its table is made.

use super::bspline::{self, Degree};
use super::scratch::Scratch;
use super::support::{Support, Width, radius, row_in_ball, row_in_box};
use super::{linear, ugimp};
use crate::method::breakdown::Breakdown;
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::Multiplier;
use crate::method::grid::{Grid, Located};
use nalgebra::SVector;
use std::array::from_fn;

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

/// Extents say where particles stand and, where their basis asks for it, how far they have
/// stretched.
#[derive(Clone, Copy)]
pub struct Extents<'a, const D: usize> {
    /// x_p (m).
    pub x: &'a [SVector<f64, D>],
    /// The stretch along each axis (–); empty where no particle has one.
    pub stretch: &'a [SVector<f64, D>],
}

impl<'a, const D: usize> Extents<'a, D> {
    /// Takes particles that are as long as they were, at `x` (m).
    pub fn unstretched(x: &'a [SVector<f64, D>]) -> Self {
        Extents { x, stretch: &[] }
    }
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
    /// A row in 2D and 3D is a list of nodes, and not a product over the axes.
    pub lists_rows: bool,
    /// From this Poisson's ratio on a body in 2D or 3D bends less than nine tenths as far as at 0.3,
    /// as it locks (`locking_of_a_cantilever`).
    pub locks_from: f64,
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
            lists_rows: false,
            locks_from: 0.45,
        };
        match self {
            Basis::Linear => {
                Traits { switches_nodes_on: false, pushes_light_nodes: true, along: 2.0, ..smooth }
            }
            Basis::Ugimp { .. } => smooth,
            Basis::Gimp { .. } => Traits { stretch: true, along: 4.0, ..smooth },
            Basis::BSpline(Degree::Quadratic) => Traits { locks_from: 0.499, ..smooth },
            Basis::BSpline(Degree::Cubic) => Traits { along: 4.0, locks_from: 0.499, ..smooth },
            Basis::Lme { gamma, cutoff, support } => Traits {
                multiplier: true,
                metric: *support == Support::Ellipsoid,
                switches_nodes_on: false,
                along: 2.0 * radius(*gamma, *cutoff) + 2.0,
                lists_rows: *support != Support::Box,
                locks_from: match *gamma {
                    gamma if gamma <= 1.0 => 0.499,
                    gamma if gamma <= 4.0 => 0.49,
                    _ => 0.45,
                },
                ..smooth
            },
            Basis::Ddmp => Traits {
                pushes_light_nodes: true,
                along: 4.0,
                lists_rows: true,
                locks_from: 0.49,
                ..smooth
            },
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

// ANCHOR: rows
/// This says how a row is made; what is the same for all particles is taken once.
#[derive(Clone, Copy)]
pub(super) enum Making {
    Linear,
    Gimp([f64; 3]),
    BSpline(Degree),
    Ddmp,
    Box(Width),
    Ball(Width),
}

impl Making {
    /// Prepares the rows of some particles. Along one axis a ball is a box. On a grid no metric
    /// deforms, so an ellipsoid is a ball.
    pub(super) fn of<const D: usize>(
        basis: &Basis,
        scratch: &mut Scratch<D>,
        grid: &Grid<D>,
        particles: Extents<D>,
    ) -> Self {
        match *basis {
            Basis::Linear => Making::Linear,
            Basis::Ugimp { half_length } | Basis::Gimp { half_length } => Making::Gimp(half_length),
            Basis::BSpline(degree) => Making::BSpline(degree),
            Basis::Ddmp => {
                scratch.duals.integrate(grid, particles.x);
                Making::Ddmp
            }
            Basis::Lme { gamma, cutoff, support } => match support {
                Support::Ball | Support::Ellipsoid if D > 1 => {
                    Making::Ball(Width::of(gamma, cutoff))
                }
                _ => Making::Box(Width::of(gamma, cutoff)),
            },
        }
    }

    /// Adds the row of particle `p`, which stands in a cell of `grid`, to the table.
    ///
    /// Errors: those of [`super::fill_from_grid`].
    pub(super) fn push_row<const D: usize>(
        self,
        (shape, scratch): (&mut Shape<D>, &mut Scratch<D>),
        lambda: &mut [Multiplier<D>],
        grid: &Grid<D>,
        particles: Extents<D>,
        (p, at): (usize, &Located<D>),
    ) -> Result<(), Breakdown> {
        let no_basis = |failure| Breakdown::NoBasis { particle: p, failure };
        let x_p = &particles.x[p];
        match self {
            Making::Linear => {
                let axes: [_; D] = from_fn(|d| linear::factors(at.xi[d], grid.per_h[d]));
                shape.push_product(from_fn(|d| (at.cell[d], &axes[d][..])));
            }
            Making::BSpline(degree) => {
                let axes = bspline::axes(degree, at, grid);
                shape.push_product(from_fn(|d| axes[d].factors()));
            }
            Making::Ddmp => scratch.duals.push_row(shape, grid, at),
            Making::Gimp(half_length) => {
                let l = ugimp::stretched(p, half_length, particles.stretch)?;
                let axes = ugimp::axes(at, grid, l).ok_or_else(|| beyond(p, x_p))?;
                shape.push_product(from_fn(|d| axes[d].factors()));
            }
            Making::Box(width) => {
                let known = &mut lambda[p];
                row_in_box(shape, scratch, known, width, grid, (at, x_p)).map_err(no_basis)?;
            }
            Making::Ball(width) => {
                let (lme, last) = (&mut scratch.lme, &mut lambda[p].lambda);
                row_in_ball(shape, lme, last, width, grid, at).map_err(no_basis)?;
            }
        }
        Ok(())
    }
}
// ANCHOR_END: rows

/// Names a particle p at `x_p` (m) that reaches beyond the grid.
fn beyond<const D: usize>(p: usize, x_p: &SVector<f64, D>) -> Breakdown {
    Breakdown::ReachesBeyond { particle: p, position: x_p.iter().copied().collect() }
}
