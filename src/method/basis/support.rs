//! Says which nodes of a grid local max-ent sees.

use super::lme::{AxisFunctions, AxisPoint, Failure, Lme, max_ent_row, solve_axis};
use super::scratch::Scratch;
use crate::method::continuum::shape::{Factor, Shape};
use crate::method::continuum::state::Multiplier;
use crate::method::grid::{Grid, Located};
use nalgebra::{SVector, Vector1};

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

impl Width {
    /// Takes γ and the cut-off.
    pub fn of(gamma: f64, cutoff: f64) -> Self {
        Width { gamma, reach: radius(gamma, cutoff) }
    }
}

// ANCHOR: lme_ball
/// Writes one row of local max-ent cut off by a ball: all nodes within R, and always the corners of
/// the cell, so that x_p is in the hull of its nodes. Lengths are measured in cells along
/// each axis. `lambda` starts the search for λ h, and holds what was found.
///
/// Errors: [`Failure`].
pub fn row_in_ball<const D: usize>(
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
    *lambda = max_ent_row(shape, lme, gamma, &grid.h, starts(gamma, *lambda, at.xi))?;
    shape.end_list();
    Ok(())
}
// ANCHOR_END: lme_ball

// ANCHOR: lme_box
/// Writes one row of local max-ent cut off by a box: the functions of each axis by
/// themselves, of which it is the product. `known` starts the search for λ h along each axis,
/// and holds what was found; `x` (m) is the point.
///
/// With λ(x) goes ∂λ/∂x = (2γ − 1/J)/h² along an axis: r(λ, x) stays 0.
///
/// Errors: [`Failure`].
pub fn row_in_box<const D: usize>(
    shape: &mut Shape<D>,
    Scratch { axes, axis_lme, axis_row, .. }: &mut Scratch<D>,
    known: &mut Multiplier<D>,
    Width { gamma, reach }: Width,
    grid: &Grid<D>,
    (at, x): (&Located<D>, &SVector<f64, D>),
) -> Result<(), Failure> {
    let mut first = [0; D];
    for d in 0..D {
        let (cell, xi, h, axis) = (at.cell[d], at.xi[d], grid.h[d], &mut axes[d]);
        // The nodes within R on either side, and always both of the cell.
        let below = ((reach - xi) as usize).min(cell) + 1;
        let above = ((reach - (1.0 - xi)) as usize).min(grid.cells[d] - 1 - cell) + 1;
        let point = AxisPoint { xi, below, above };
        let start = known.lambda[d] + known.rate[d] * ((x[d] - known.x[d]) * grid.per_h[d]);
        let (lambda, J) = match solve_axis(axis, gamma, point, start, h) {
            Some(found) => found,
            None => search_axis(axis, axis_lme, axis_row, gamma, point, (known.lambda[d], h))?,
        };
        first[d] = cell + 1 - below;
        (known.lambda[d], known.rate[d], known.x[d]) = (lambda, 2.0 * gamma - 1.0 / J, x[d]);
    }
    shape.push_product(std::array::from_fn(|d| (first[d], &axes[d].factor[..])));
    Ok(())
}

/// Finds the functions of one axis by the general search; returns λ h and J.
#[cold]
fn search_axis(
    axis: &mut AxisFunctions,
    lme: &mut Lme<1>,
    row: &mut Shape<1>,
    gamma: f64,
    AxisPoint { xi, below, above }: AxisPoint,
    (last, h): (f64, f64),
) -> Result<(f64, f64), Failure> {
    lme.clear(true);
    for n in 0..below + above {
        let offset = below as f64 - 1.0 - n as f64;
        lme.push(n, Vector1::new(xi + offset), Vector1::new(offset));
    }
    row.clear([0]);
    let xi = Vector1::new(xi);
    let starts = starts(gamma, Vector1::new(last), xi);
    let lambda = max_ent_row(row, lme, gamma, &Vector1::new(h), starts)?;
    row.end_list();
    let mut J = 0.0;
    axis.factor.clear();
    for (n, N, slope) in row.of(0) {
        let xi_n = xi[0] + (below as f64 - 1.0 - n as f64);
        J += N * xi_n * xi_n;
        axis.factor.push(Factor { N, slope: slope[0] });
    }
    Ok((lambda[0], J))
}
// ANCHOR_END: lme_box

/// Lists where the search for λ h starts: the last λ, which is 0 before the first search, then
/// 0, then the two nodes.
fn starts<const D: usize>(
    gamma: f64,
    last: SVector<f64, D>,
    xi: SVector<f64, D>,
) -> impl Iterator<Item = SVector<f64, D>> {
    let zero = SVector::zeros();
    let last = Some(last).filter(|last| *last != zero);
    let two_nodes = std::iter::once_with(move || of_two_nodes(gamma, &xi));
    last.into_iter().chain([zero]).chain(two_nodes)
}

/// Gives the λ h that the two nodes of the cell along each axis alone would have: with it their
/// weights are 1 − s and s.
fn of_two_nodes<const D: usize>(gamma: f64, xi: &SVector<f64, D>) -> SVector<f64, D> {
    SVector::from_fn(|d, _| {
        let s = xi[d];
        let inside = 0.0 < s && s < 1.0;
        if inside { -gamma * (1.0 - 2.0 * s) - libm::log(s / (1.0 - s)) } else { 0.0 }
    })
}
