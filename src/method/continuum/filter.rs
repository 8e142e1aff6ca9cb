//! The null-space filter (reference 17) takes out of the stresses what no node feels.

use super::state::Particles;
use crate::method::grid::Grid;
use nalgebra::SMatrix;

// ANCHOR: null_space
/// Gives the particles of each cell that has two or more the mean of its stresses, weighted by
/// volumes: σ_p ← Σ_q V_q σ_q / Σ_q V_q (Pa), with V_q = m_q / ρ_q.
///
/// With the linear functions of one dimension this is the projection of the stresses onto what
/// a strain can be, and every force (14) stays as it was. A particle outside the grid keeps its
/// stress; the next table names it. Tests: `null_space_is_a_projection`,
/// `null_space_changes_no_force`.
pub fn null_space<const D: usize>(particle: &mut Particles<D>, grid: &Grid<D>) {
    for cell in particle.by_cell(grid).iter().filter(|cell| cell.len() > 1) {
        let (mut V, mut V_sigma) = (0.0, SMatrix::<f64, D, D>::zeros());
        for (q, _) in cell {
            let V_q = particle.m[*q] / particle.rho[*q];
            V += V_q;
            V_sigma += particle.sigma[*q] * V_q;
        }
        for (p, _) in cell {
            particle.sigma[*p] = V_sigma / V;
            particle.cost.filtered_stresses += 1;
        }
    }
}
// ANCHOR_END: null_space
