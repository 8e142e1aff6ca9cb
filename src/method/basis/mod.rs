//! All shape functions (§3.3 and §5) stand behind one function that fills the table.

pub mod anisotropic;
pub mod bins;
pub mod bspline;
pub mod ddmp;
mod kind;
pub mod linear;
pub mod lme;
pub mod scattered;
mod scratch;
pub mod support;
pub mod tensor;
pub mod ugimp;

pub use kind::{Basis, Degree, Support, Traits};
pub use scratch::Scratch;

use super::breakdown::Breakdown;
use super::continuum::shape::Shape;
use super::continuum::state::Multiplier;
use super::grid::Grid;
use nalgebra::SVector;
use std::array::from_fn;
use support::{Width, row_in_ball, row_in_box};

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

// ANCHOR: tabulate
/// Fills the table with N_Ip (–) and ∇N_Ip (1/m) of `particles`. With local max-ent `lambda`
/// starts the search for each particle's λ h, and holds what was found.
///
/// Errors: the first particle that cannot be served, [`Breakdown::LeftGrid`],
/// [`Breakdown::NotFinite`], [`Breakdown::ReachesBeyond`], [`Breakdown::Domain`] or
/// [`Breakdown::NoBasis`]. Tests: `tests/basis.rs`, `tests/gimp.rs`.
pub fn fill_from_grid<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut [Multiplier<D>],
    basis: &Basis,
    grid: &Grid<D>,
    particles: Extents<D>,
) -> Result<(), Breakdown> {
    shape.clear(grid.stride());
    let making = Making::of::<D>(basis);
    if let Making::Ddmp = making {
        scratch.duals.integrate(grid, particles.x);
    }
    for (p, x_p) in particles.x.iter().enumerate() {
        let at = grid.locate(x_p).ok_or_else(|| outside(p, x_p))?;
        let no_basis = |failure| Breakdown::NoBasis { particle: p, failure };
        match making {
            Making::Linear => {
                let axes: [_; D] = from_fn(|d| linear::factors(at.xi[d], grid.per_h[d]));
                shape.push_product(from_fn(|d| (at.cell[d], &axes[d][..])));
            }
            Making::BSpline(degree) => {
                let axes = bspline::axes(degree, &at, grid);
                shape.push_product(from_fn(|d| axes[d].factors()));
            }
            Making::Ddmp => scratch.duals.push_row(shape, grid, &at),
            Making::Gimp(half_length) => {
                let l = ugimp::stretched(p, half_length, particles.stretch)?;
                let axes = ugimp::axes(&at, grid, l).ok_or_else(|| beyond(p, x_p))?;
                shape.push_product(from_fn(|d| axes[d].factors()));
            }
            Making::Box(width) => {
                let known = &mut lambda[p];
                row_in_box(shape, scratch, known, width, grid, (&at, x_p)).map_err(no_basis)?;
            }
            Making::Ball(width) => {
                let (lme, last) = (&mut scratch.lme, &mut lambda[p].lambda);
                row_in_ball(shape, lme, last, width, grid, &at).map_err(no_basis)?;
            }
        }
    }
    Ok(())
}

/// This says how a row is made; what is the same for all particles is taken once.
#[derive(Clone, Copy)]
enum Making {
    Linear,
    Gimp([f64; 3]),
    BSpline(Degree),
    Ddmp,
    Box(Width),
    Ball(Width),
}

impl Making {
    /// Along one axis a ball is a box. On a grid no metric deforms, so an ellipsoid is a ball.
    fn of<const D: usize>(basis: &Basis) -> Self {
        match *basis {
            Basis::Linear => Making::Linear,
            Basis::Ugimp { half_length } | Basis::Gimp { half_length } => Making::Gimp(half_length),
            Basis::BSpline(degree) => Making::BSpline(degree),
            Basis::Ddmp => Making::Ddmp,
            Basis::Lme { gamma, cutoff, support } => match support {
                Support::Ball | Support::Ellipsoid if D > 1 => {
                    Making::Ball(Width::of(gamma, cutoff))
                }
                _ => Making::Box(Width::of(gamma, cutoff)),
            },
        }
    }
}
// ANCHOR_END: tabulate

/// Names a particle p at `x_p` (m) that reaches beyond the grid.
fn beyond<const D: usize>(p: usize, x_p: &SVector<f64, D>) -> Breakdown {
    Breakdown::ReachesBeyond { particle: p, position: x_p.iter().copied().collect() }
}

/// Names a particle p that stands at `x_p` (m) outside the grid, or has a place that is no
/// number.
fn outside<const D: usize>(p: usize, x_p: &SVector<f64, D>) -> Breakdown {
    match x_p.iter().all(|x| x.is_finite()) {
        true => Breakdown::LeftGrid { particle: p, position: x_p.iter().copied().collect() },
        false => Breakdown::NotFinite { particle: p, symbol: "position" },
    }
}
