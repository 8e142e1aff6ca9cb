//! Taylor least squares (reference 19) gives each cell polynomials of its own, D = 1, 2, 3.

use super::fit::{Sample, least_squares};
use super::{Cell, volume};
use nalgebra::{SMatrix, SVector};

// ANCHOR: taylor
/// Lists Taylor's polynomials about the middle of a cell, ξ = 2 (x − x_c)/h, up to `degree`:
/// 1, ξ_i, ξ_i²/2 − 1/6 and ξ_i ξ_j. All but the first have the mean 0 over the cell.
pub fn polynomials<const D: usize>(xi: &SVector<f64, D>, degree: usize) -> Vec<f64> {
    let mut values = vec![1.0];
    if degree > 0 {
        values.extend(xi.iter());
    }
    if degree > 1 {
        values.extend(xi.iter().map(|xi| 0.5 * xi * xi - 1.0 / 6.0));
        for i in 0..D {
            values.extend((0..i).map(|j| xi[i] * xi[j]));
        }
    }
    values
}
// ANCHOR_END: taylor

/// Lists what the particles of a cell have, `field` (any unit), with equal weights.
fn samples<const D: usize>(cell: &Cell<D>, field: &[SMatrix<f64, D, D>]) -> Vec<Sample<D>> {
    let one =
        |(p, at): &(usize, super::Located<D>)| (at.xi.map(|xi| 2.0 * xi - 1.0), 1.0, field[*p]);
    cell.own().iter().map(one).collect()
}

// ANCHOR: tls
/// Gives σ (Pa) at Gauss's points of a cell by unweighted least squares over its particles. It
/// passes polynomials of its degree on as they are, and does not keep Σ_p V_p σ_p. `fitted` counts
/// the stresses that it takes in.
///
/// Test: `reconstruction_passes_polynomials_on`.
pub fn stress<const D: usize>(
    cell: &Cell<D>,
    degree: usize,
    fitted: &mut u64,
) -> Vec<SMatrix<f64, D, D>> {
    let places: Vec<_> = cell.points.iter().map(|(xi, _)| *xi).collect();
    let samples = samples(cell, &cell.particle.sigma);
    *fitted += samples.len() as u64;
    least_squares(&samples, &places, &move |xi| polynomials(xi, degree))
}
// ANCHOR_END: tls

// ANCHOR: conservative
/// Gives a field at Gauss's points of a cell so that its integral is the particles' sum: the mean
/// is a_1 = Σ_p V_p f_p / |Ω_e|, and the other polynomials are fitted to f_p − a_1. For densities
/// of mass and momentum; a stress has no such sum to keep.
///
/// Tests: `reconstruction_keeps_mass_and_momentum`, `reconstruction_of_order_0_is_the_sum`.
pub fn conservative<const D: usize>(
    cell: &Cell<D>,
    field: &[SMatrix<f64, D, D>],
    degree: usize,
) -> Vec<SMatrix<f64, D, D>> {
    let mut mean = SMatrix::<f64, D, D>::zeros();
    for (p, _) in cell.own() {
        mean += field[*p] * (volume(cell.particle, *p) / cell.volume());
    }
    let places: Vec<_> = cell.points.iter().map(|(xi, _)| *xi).collect();
    let mut samples = samples(cell, field);
    samples.iter_mut().for_each(|(_, _, value)| *value -= mean);
    let rest = move |xi: &SVector<f64, D>| polynomials(xi, degree).split_off(1);
    least_squares(&samples, &places, &rest).into_iter().map(|value| value + mean).collect()
}
// ANCHOR_END: conservative
