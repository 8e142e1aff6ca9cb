//! Shape functions (§3.3 and §5), all behind one function that fills the table.
#![allow(non_snake_case)]

pub mod bspline;
pub mod linear;
pub mod lme;
pub mod tensor;
pub mod ugimp;

use crate::continuum::shape::Shape;
use crate::cost::Cost;
use crate::grid::{Grid, Located};
use lme::{Failure, Lme};
use nalgebra::SVector;
use tensor::Line;

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

impl Basis {
    /// Bytes that the basis keeps for each particle: λ of local max-ent.
    pub fn bytes_per_particle<const D: usize>(&self) -> usize {
        match self {
            Basis::Lme { .. } => size_of::<SVector<f64, D>>(),
            Basis::Linear | Basis::Ugimp { .. } | Basis::BSpline => 0,
        }
    }
}

/// What a basis keeps from table to table: nothing, but for local max-ent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scratch<const D: usize> {
    lme: Lme<D>,
    /// λ h of each particle, from where the next search starts.
    pub lambda: Vec<SVector<f64, D>>,
}

/// A particle that the basis cannot serve, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trouble {
    pub particle: usize,
    pub reason: Reason,
}

/// Why a basis cannot serve a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// It stands outside the grid, or with uGIMP reaches beyond it.
    OutsideGrid,
    /// Local max-ent has no solution there, or did not find it.
    Lme(Failure),
}

// ANCHOR: tabulate
/// Fills the table with N_Ip (–) and ∇N_Ip (1/m) at the positions `x` (m).
///
/// Errors: [`Trouble`] with the first particle that cannot be served.
/// Tests: `tests/basis.rs`.
pub fn tabulate<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    cost: &mut Cost,
    basis: &Basis,
    grid: &Grid<D>,
    x: &[SVector<f64, D>],
) -> Result<(), Trouble> {
    shape.clear();
    for (p, x_p) in x.iter().enumerate() {
        let trouble = |reason| Trouble { particle: p, reason };
        let at = grid.locate(x_p).ok_or(trouble(Reason::OutsideGrid))?;
        match basis {
            Basis::Lme { gamma, cutoff } => {
                lme_row(shape, scratch, cost, *gamma, *cutoff, grid, &at, p)
                    .map_err(|failure| trouble(Reason::Lme(failure)))?;
            }
            _ => {
                let lines = lines(basis, grid, &at).ok_or(trouble(Reason::OutsideGrid))?;
                tensor::row(shape, grid, &lines);
            }
        }
        shape.end_row();
    }
    cost.basis_evaluations += x.len() as u64;
    cost.particle_node_pairs += shape.len() as u64;
    Ok(())
}
// ANCHOR_END: tabulate

/// The one-dimensional functions of a tensor-product basis along each axis.
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

// ANCHOR: lme_row
/// One row of local max-ent on a grid: all nodes within R, and always the
/// corners of the cell, so that x_p is in the hull of its nodes. Lengths are
/// measured in cells along each axis.
#[allow(clippy::too_many_arguments)]
fn lme_row<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    cost: &mut Cost,
    gamma: f64,
    cutoff: f64,
    grid: &Grid<D>,
    at: &Located<D>,
    p: usize,
) -> Result<(), Failure> {
    let radius = lme::radius(gamma, cutoff);
    let Scratch { lme, lambda } = scratch;
    lme.clear();
    let first_entry = shape.len();
    for node in grid.around(at, radius) {
        let I = grid.node(node);
        // The cell's lower corner is the base: offsets are whole numbers.
        let offset = SVector::from_fn(|d, _| at.cell[d] as f64 - node[d] as f64);
        let xi = at.xi + offset;
        let is_corner = (0..D).all(|d| node[d] == at.cell[d] || node[d] == at.cell[d] + 1);
        if is_corner || xi.dot(&xi) <= radius * radius {
            lme.push(xi, offset);
            shape.push(I, 0.0, SVector::zeros());
        }
    }
    // The two nodes of the cell along each axis alone would give s/(1 − s).
    let two_nodes = SVector::from_fn(|d, _| {
        let s = at.xi[d];
        let inside = 0.0 < s && s < 1.0;
        if inside { -gamma * (1.0 - 2.0 * s) - libm::log(s / (1.0 - s)) } else { 0.0 }
    });
    let (exponentials, iterations) = (lme.exponentials, lme.iterations);
    let found = match lambda.get(p) {
        Some(last) => lme.evaluate(gamma, &[*last, SVector::zeros(), two_nodes]),
        None => lme.evaluate(gamma, &[SVector::zeros(), two_nodes]),
    }?;
    cost.exponentials += lme.exponentials - exponentials;
    cost.newton_iterations += lme.iterations - iterations;
    match lambda.get_mut(p) {
        Some(last) => *last = found,
        None => lambda.push(found),
    }
    for (n, (N, grad)) in lme.p.iter().zip(&lme.grad).enumerate() {
        shape.set(first_entry + n, *N, grad.component_div(&grid.h));
    }
    Ok(())
}
// ANCHOR_END: lme_row

/// N and ∇N of one point for the command line and for scattered nodes: all
/// nodes within R of x, as (node, N, ∇N), and λ (1/m).
///
/// `spacing` is the h (m) of γ = βh². Errors: [`Failure`].
pub fn lme_at<const D: usize>(
    nodes: &[SVector<f64, D>],
    spacing: f64,
    gamma: f64,
    cutoff: f64,
    x: &SVector<f64, D>,
) -> Result<(Vec<(usize, f64, SVector<f64, D>)>, SVector<f64, D>), Failure> {
    if nodes.iter().chain([x]).any(|place| place.iter().any(|x| !x.is_finite())) {
        return Err(Failure::NotFinite);
    }
    let radius = lme::radius(gamma, cutoff);
    let scaled = |from: &SVector<f64, D>, to: &SVector<f64, D>| (from - to) / spacing;
    let square = |I: &usize| {
        let xi = scaled(x, &nodes[*I]);
        xi.dot(&xi)
    };
    let near: Vec<usize> = (0..nodes.len()).filter(|I| square(I) <= radius * radius).collect();
    let base = near.iter().min_by(|a, b| square(a).total_cmp(&square(b)));
    let base = *base.ok_or(Failure::OutsideHull)?;
    let mut lme = Lme::default();
    for I in &near {
        lme.push(scaled(x, &nodes[*I]), scaled(&nodes[base], &nodes[*I]));
    }
    let lambda = lme.evaluate(gamma, &[SVector::zeros()])?;
    let values = near.iter().zip(&lme.p).zip(&lme.grad);
    Ok((values.map(|((I, N), grad)| (*I, *N, grad / spacing)).collect(), lambda / spacing))
}
