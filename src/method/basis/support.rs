//! Which nodes local max-ent sees: on a grid, and in a list.

use super::lme::{Failure, Lme};
use super::scratch::Scratch;
use crate::method::continuum::shape::Shape;
use crate::method::grid::{Grid, Located};
use nalgebra::SVector;

// ANCHOR: lme_support
/// The cut-off radius R/h = √(−ln tol/γ): beyond it exp(−γ|ξ|²) < tol. A
/// tolerance of 0 cuts nothing.
pub fn radius(gamma: f64, cutoff: f64) -> f64 {
    libm::sqrt(-libm::log(cutoff) / gamma)
}
// ANCHOR_END: lme_support

// ANCHOR: lme_row
/// One row of local max-ent on a grid: all nodes within `reach` = R/h, and always the
/// corners of the cell, so that x_p is in the hull of its nodes. Lengths are
/// measured in cells along each axis.
pub fn row<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut SVector<f64, D>,
    gamma: f64,
    reach: f64,
    grid: &Grid<D>,
    at: &Located<D>,
) -> Result<(), Failure> {
    let Scratch { lme, nodes, .. } = scratch;
    lme.clear(true);
    nodes.clear();
    for node in grid.around(at, reach) {
        // The cell's lower corner is the base: offsets are whole numbers.
        let offset = SVector::from_fn(|d, _| at.cell[d] as f64 - node[d] as f64);
        let xi = at.xi + offset;
        let is_corner = (0..D).all(|d| node[d] == at.cell[d] || node[d] == at.cell[d] + 1);
        if is_corner || xi.dot(&xi) <= reach * reach {
            lme.push(xi, offset);
            nodes.push(grid.node(node));
        }
    }
    // The two nodes of the cell along each axis alone would give s/(1 − s).
    let two_nodes = || {
        SVector::from_fn(|d, _| {
            let s = at.xi[d];
            let inside = 0.0 < s && s < 1.0;
            if inside { -gamma * (1.0 - 2.0 * s) - libm::log(s / (1.0 - s)) } else { 0.0 }
        })
    };
    // The last λ, which is 0 before the first search, then 0, then the two nodes.
    let zero = SVector::<f64, D>::zeros();
    let last = Some(*lambda).filter(|last| *last != zero);
    let starts = last.into_iter().chain([zero]);
    *lambda = lme.evaluate(gamma, starts.chain(std::iter::once_with(two_nodes)))?;
    for ((I, N), grad) in nodes.iter().zip(&lme.p).zip(&lme.grad) {
        shape.push(*I, *N, grad.component_div(&grid.h));
    }
    Ok(())
}
// ANCHOR_END: lme_row

/// What a point sees: node, N (–) and ∇N (1/m).
pub type Values<const D: usize> = Vec<(usize, f64, SVector<f64, D>)>;

/// N and ∇N of one point for the command line and for scattered nodes: all
/// nodes within R of x, as (node, N, ∇N), and λ (1/m).
///
/// `spacing` is the h (m) of γ = βh². Errors: [`Failure`].
pub fn at<const D: usize>(
    nodes: &[SVector<f64, D>],
    spacing: f64,
    gamma: f64,
    cutoff: f64,
    x: &SVector<f64, D>,
) -> Result<(Values<D>, SVector<f64, D>), Failure> {
    if nodes.iter().chain([x]).any(|place| place.iter().any(|x| !x.is_finite())) {
        return Err(Failure::NotFinite);
    }
    let reach = radius(gamma, cutoff);
    let scaled = |from: &SVector<f64, D>, to: &SVector<f64, D>| (from - to) / spacing;
    let square = |I: &usize| {
        let xi = scaled(x, &nodes[*I]);
        xi.dot(&xi)
    };
    let near: Vec<usize> = (0..nodes.len()).filter(|I| square(I) <= reach * reach).collect();
    let base = near.iter().min_by(|a, b| square(a).total_cmp(&square(b)));
    let base = *base.ok_or(Failure::OutsideHull)?;
    let mut lme = Lme::default();
    lme.clear(false);
    for I in &near {
        lme.push(scaled(x, &nodes[*I]), scaled(&nodes[base], &nodes[*I]));
    }
    let lambda = lme.evaluate(gamma, [SVector::zeros()])?;
    let values = near.iter().zip(&lme.p).zip(&lme.grad);
    Ok((values.map(|((I, N), grad)| (*I, *N, grad / spacing)).collect(), lambda / spacing))
}
