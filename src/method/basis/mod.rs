//! All shape functions (§3.3 and §5) stand behind one function that fills the table.

pub mod bins;
pub mod bspline;
mod kind;
pub mod linear;
pub mod lme;
pub mod scattered;
mod scratch;
pub mod support;
pub mod tensor;
pub mod ugimp;

pub use kind::{Basis, Support};
pub use scratch::Scratch;

use super::breakdown::Breakdown;
use super::continuum::shape::Shape;
use super::grid::{Grid, Located};
use nalgebra::SVector;
use support::{row_in_box, row_on_grid};
use tensor::{Line, product_row};

// ANCHOR: tabulate
/// Fills the table with N_Ip (–) and ∇N_Ip (1/m) at the positions `x` (m). With local
/// max-ent `lambda` starts the search for each particle's λ h, and holds what was found.
///
/// Errors: the first particle that cannot be served, [`Breakdown::LeftGrid`],
/// [`Breakdown::NotFinite`] or [`Breakdown::NoBasis`].
/// Tests: `tests/basis.rs`.
pub fn fill_from_grid<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut [SVector<f64, D>],
    basis: &Basis,
    grid: &Grid<D>,
    x: &[SVector<f64, D>],
) -> Result<(), Breakdown> {
    shape.clear();
    let width = basis.width();
    for (p, x_p) in x.iter().enumerate() {
        let at = grid.locate(x_p).ok_or_else(|| outside(p, x_p))?;
        match (basis, width) {
            (Basis::Lme { support, .. }, Some(width)) => match support {
                Support::Box => row_in_box(shape, scratch, &mut lambda[p], width, grid, &at),
                Support::Ball => {
                    row_on_grid(shape, &mut scratch.lme, &mut lambda[p], width, grid, &at)
                }
            }
            .map_err(|failure| Breakdown::NoBasis { particle: p, failure })?,
            _ => {
                let lines = lines(basis, grid, &at).ok_or_else(|| Breakdown::ReachesBeyond {
                    particle: p,
                    position: x_p.iter().copied().collect(),
                })?;
                let count = std::array::from_fn(|d| lines[d].len());
                product_row(shape, grid, count, |d, n| lines[d].entry(n));
            }
        }
        shape.end_row();
    }
    shape.count();
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

/// Makes the functions of one coordinate of a tensor-product basis along each axis; `None`
/// where the particle reaches beyond the grid.
fn lines<const D: usize>(basis: &Basis, grid: &Grid<D>, at: &Located<D>) -> Option<[Line; D]> {
    let mut lines = [Line::default(); D];
    for d in 0..D {
        let (cell, cells, xi, h) = (at.cell[d], grid.cells[d], at.xi[d], grid.h[d]);
        lines[d] = match basis {
            Basis::Ugimp { half_length } => ugimp::line(cell, cells, xi, half_length[d], h)?,
            Basis::BSpline => bspline::line(cell, cells, xi, h),
            Basis::Linear | Basis::Lme { .. } => linear::line(cell, xi, h),
        };
    }
    Some(lines)
}
