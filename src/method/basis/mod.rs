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

pub use bspline::Degree;
pub use kind::{Basis, Extents, Traits};
pub use scratch::Scratch;
pub use support::Support;

use super::breakdown::Breakdown;
use super::continuum::shape::Shape;
use super::continuum::state::Multiplier;
use super::grid::Grid;
use kind::Making;
use nalgebra::SVector;

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
    let making = Making::of(basis, scratch, grid, particles);
    for (p, x_p) in particles.x.iter().enumerate() {
        let at = grid.locate(x_p).ok_or_else(|| outside(p, x_p))?;
        making.push_row((shape, scratch), lambda, grid, particles, (p, &at))?;
    }
    Ok(())
}
// ANCHOR_END: tabulate

/// Names a particle p that stands at `x_p` (m) outside the grid, or has a place that is no
/// number.
fn outside<const D: usize>(p: usize, x_p: &SVector<f64, D>) -> Breakdown {
    match x_p.iter().all(|x| x.is_finite()) {
        true => Breakdown::LeftGrid { particle: p, position: x_p.iter().copied().collect() },
        false => Breakdown::NotFinite { particle: p, symbol: "position" },
    }
}
