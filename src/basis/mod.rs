//! Shape functions (§3.3 and §5), all behind one function that fills the table.
#![allow(non_snake_case)]

pub mod bspline;
pub mod linear;
pub mod lme;
pub mod scattered;
pub mod support;
pub mod tensor;
pub mod ugimp;

use crate::continuum::shape::Shape;
use crate::cost::Cost;
use crate::grid::{Grid, Located};
use lme::{Failure, Lme};
use nalgebra::SVector;
use scattered::Bins;
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
    /// The nodes that the point at hand sees.
    nodes: Vec<usize>,
    /// λ h of each particle, from where the next search starts.
    pub lambda: Vec<SVector<f64, D>>,
    /// Nodes that move, sorted for the search.
    bins: Bins<D>,
}

/// A particle that the basis cannot serve, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trouble {
    pub particle: usize,
    pub reason: Reason,
}

/// What a point sees: node, N (–) and ∇N (1/m).
pub type Values<const D: usize> = Vec<(usize, f64, SVector<f64, D>)>;

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
    let reach = match basis {
        Basis::Lme { gamma, cutoff } => support::radius(*gamma, *cutoff),
        _ => 0.0,
    };
    for (p, x_p) in x.iter().enumerate() {
        let trouble = |reason| Trouble { particle: p, reason };
        let at = grid.locate(x_p).ok_or(trouble(Reason::OutsideGrid))?;
        match basis {
            Basis::Lme { gamma, .. } => {
                support::row(shape, scratch, cost, *gamma, reach, grid, &at, p)
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
