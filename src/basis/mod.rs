//! Shape functions (§3.3 and §5), all behind one function that fills the table.
#![allow(non_snake_case)]

pub mod linear;

use crate::continuum::shape::Shape;
use crate::cost::Cost;
use crate::grid::Grid;
use nalgebra::SVector;

/// The basis of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Basis {
    /// Piecewise (multi)linear functions of the grid's cells.
    Linear,
}

/// A particle that the basis cannot serve: it stands outside the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outside {
    /// p, counted from 0.
    pub particle: usize,
}

// ANCHOR: tabulate
/// Fills the table with N_Ip (–) and ∇N_Ip (1/m) at the positions `x` (m).
///
/// Errors: [`Outside`] with the first particle that has left the grid.
/// Tests: `tests/laws.rs`, `basis_*`.
pub fn tabulate<const D: usize>(
    shape: &mut Shape<D>,
    cost: &mut Cost,
    basis: &Basis,
    grid: &Grid<D>,
    x: &[SVector<f64, D>],
) -> Result<(), Outside> {
    shape.clear();
    for (p, x_p) in x.iter().enumerate() {
        match basis {
            Basis::Linear => linear::row(shape, grid, x_p),
        }
        .ok_or(Outside { particle: p })?;
        shape.end_row();
    }
    cost.basis_evaluations += x.len() as u64;
    cost.particle_node_pairs += shape.len() as u64;
    Ok(())
}
// ANCHOR_END: tabulate
