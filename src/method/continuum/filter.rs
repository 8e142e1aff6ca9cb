//! The null-space filter (reference 17) takes out of the stresses what no node feels.

use super::state::Particles;
use crate::method::grid::Grid;
use nalgebra::SMatrix;

/// A cell sums up what its particles have.
#[derive(Clone, Copy)]
struct CellSum<const D: usize> {
    particles: usize,
    /// Σ_q V_q (m³).
    V: f64,
    /// Σ_q V_q σ_q (N m).
    V_sigma: SMatrix<f64, D, D>,
}

// ANCHOR: null_space
/// Gives the particles of each cell that has two or more the mean of its stresses, weighted by
/// volumes: σ_p ← Σ_q V_q σ_q / Σ_q V_q (Pa), with V_q = m_q / ρ_q.
///
/// With the linear functions of one dimension this is the projection of the stresses onto what
/// a strain can be, and every force (14) stays as it was. A particle outside the grid keeps its
/// stress; the next table names it. Tests: `null_space_is_a_projection`,
/// `null_space_changes_no_force`.
pub fn null_space<const D: usize>(particle: &mut Particles<D>, grid: &Grid<D>) {
    let nothing = CellSum { particles: 0, V: 0.0, V_sigma: SMatrix::zeros() };
    let mut cells = vec![nothing; grid.nodes()];
    let cell_of = |particle: &Particles<D>, p: usize| {
        grid.locate(&particle.x[p]).map(|at| grid.node(at.cell)) // a cell has its lowest node's number
    };
    for p in 0..particle.len() {
        if let Some(n) = cell_of(particle, p) {
            let V_p = particle.m[p] / particle.rho[p];
            cells[n].particles += 1;
            cells[n].V += V_p;
            cells[n].V_sigma += particle.sigma[p] * V_p;
        }
    }
    for p in 0..particle.len() {
        if let Some(n) = cell_of(particle, p)
            && cells[n].particles > 1
        {
            particle.sigma[p] = cells[n].V_sigma / cells[n].V;
            particle.cost.filtered_stresses += 1;
        }
    }
}
// ANCHOR_END: null_space
