//! Moving least squares (reference 18) fit polynomials anew about each of Gauss's points, D = 1,
//! 2, 3.

use super::Cell;
use super::fit::least_squares;
use super::tls::polynomials;
use crate::method::basis::bspline::quadratic;
use crate::method::grid::odometer;
use nalgebra::{SMatrix, SVector};

// ANCHOR: mls
/// Gives σ (Pa) at Gauss's points of a cell: about each one the particles within 3/2 h along
/// every axis weigh as much as a quadratic B-spline there, w_p = Π_d B((x_p − x_g)_d / h_d), and
/// the polynomials stand in (x − x_g)/h. `fitted` counts the stresses that it takes in.
///
/// Test: `reconstruction_passes_polynomials_on`.
pub fn stress<const D: usize>(
    cell: &Cell<D>,
    degree: usize,
    fitted: &mut u64,
) -> Vec<SMatrix<f64, D, D>> {
    let low = cell.index.map(|n| n.saturating_sub(2));
    let high: [usize; D] = std::array::from_fn(|d| (cell.index[d] + 2).min(cell.grid.cells[d] - 1));
    let around = || {
        let count = std::array::from_fn(|d| high[d] - low[d] + 1);
        odometer(count).map(move |n: [usize; D]| std::array::from_fn(|d| low[d] + n[d]))
    };
    let one = |(xi, _): &(SVector<f64, D>, f64)| {
        let mut samples = Vec::new();
        for other in around() {
            for (p, at) in &cell.inside[cell.grid.node(other)] {
                let from = SVector::<f64, D>::from_fn(|d, _| {
                    let cells = other[d] as f64 - cell.index[d] as f64;
                    cells + at.xi[d] - (0.5 + 0.5 * xi[d])
                });
                let weight: f64 = from.iter().map(|from| quadratic(*from).0).product();
                if weight > 0.0 {
                    samples.push((from, weight, cell.particle.sigma[*p]));
                }
            }
        }
        *fitted += samples.len() as u64;
        let place = [SVector::zeros()];
        least_squares(&samples, &place, &move |xi| polynomials(xi, degree)).into_iter().sum()
    };
    cell.points.iter().map(one).collect()
}
// ANCHOR_END: mls
