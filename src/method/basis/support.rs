//! Says which nodes of a grid local max-ent sees.

use super::lme::{Failure, Lme, max_ent_row};
use super::scratch::Scratch;
use super::tensor::product_row;
use crate::method::continuum::shape::Shape;
use crate::method::grid::{Grid, Located};
use nalgebra::{SVector, Vector1};

// ANCHOR: lme_support
/// Gives the cut-off radius R/h = √(−ln tol/γ): beyond it exp(−γ|ξ|²) < tol. A tolerance of 0
/// cuts nothing.
pub fn radius(gamma: f64, cutoff: f64) -> f64 {
    libm::sqrt(-libm::log(cutoff) / gamma)
}
// ANCHOR_END: lme_support

/// A width says how far local max-ent reaches.
#[derive(Clone, Copy)]
pub struct Width {
    /// γ = βh².
    pub gamma: f64,
    /// R/h.
    pub reach: f64,
}

// ANCHOR: lme_grid
/// Writes one row of local max-ent on a grid: all nodes within R, and always the corners of
/// the cell, so that x_p is in the hull of its nodes. Lengths are measured in cells along
/// each axis. `lambda` starts the search for λ h, and holds what was found.
///
/// Errors: [`Failure`].
pub fn row_on_grid<const D: usize>(
    shape: &mut Shape<D>,
    lme: &mut Lme<D>,
    lambda: &mut SVector<f64, D>,
    Width { gamma, reach }: Width,
    grid: &Grid<D>,
    at: &Located<D>,
) -> Result<(), Failure> {
    lme.clear(true);
    for node in grid.around(at, reach) {
        // The cell's lower corner is the base: offsets are whole numbers.
        let offset = SVector::from_fn(|d, _| at.cell[d] as f64 - node[d] as f64);
        let xi = at.xi + offset;
        let is_corner = (0..D).all(|d| node[d] == at.cell[d] || node[d] == at.cell[d] + 1);
        if is_corner || xi.dot(&xi) <= reach * reach {
            lme.push(grid.node(node), xi, offset);
        }
    }
    // The last λ, which is 0 before the first search, then 0, then the two nodes.
    let zero = SVector::zeros();
    let last = Some(*lambda).filter(|last| *last != zero);
    let starts = last.into_iter().chain([zero]);
    let starts = starts.chain(std::iter::once_with(|| of_two_nodes(gamma, &at.xi)));
    *lambda = max_ent_row(shape, lme, gamma, &grid.h, starts)?;
    Ok(())
}
// ANCHOR_END: lme_grid

// ANCHOR: lme_box
/// Writes one row of local max-ent cut off by a box: the functions of each axis by
/// themselves, and their product. `lambda` starts the search for λ h along each axis, and
/// holds what was found.
///
/// Errors: [`Failure`].
pub fn row_in_box<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut SVector<f64, D>,
    width: Width,
    grid: &Grid<D>,
    at: &Located<D>,
) -> Result<(), Failure> {
    let Scratch { axis_lme, axes, .. } = scratch;
    axes.clear();
    for d in 0..D {
        let mut lambda_d = Vector1::new(lambda[d]);
        row_on_grid(axes, axis_lme, &mut lambda_d, width, &grid.axis(d), &at.axis(d))?;
        axes.end_row();
        lambda[d] = lambda_d[0];
    }
    let count = std::array::from_fn(|d| axes.of(d).count());
    product_row(shape, grid, count, |d, n| axes.pair(d, n));
    Ok(())
}
// ANCHOR_END: lme_box

/// Gives the λ h that the two nodes of the cell along each axis alone would have: with it their
/// weights are 1 − s and s.
fn of_two_nodes<const D: usize>(gamma: f64, xi: &SVector<f64, D>) -> SVector<f64, D> {
    SVector::from_fn(|d, _| {
        let s = xi[d];
        let inside = 0.0 < s && s < 1.0;
        if inside { -gamma * (1.0 - 2.0 * s) - libm::log(s / (1.0 - s)) } else { 0.0 }
    })
}
