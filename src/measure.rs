//! What is measured on a run (§6): the error (39), energy and momentum.

use crate::continuum::law::LinearElastic;
use crate::continuum::state::Particles;
use nalgebra::SVector;

// ANCHOR: rms
/// (39) with the square that the paper's print lacks:
/// RMS = √(1/N Σ (φ − φ̂)²), in the unit of φ; 0 for no pairs.
///
/// Test: `rms_has_its_square` in `tests/analytical.rs`.
pub fn rms(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0);
    for (phi, phi_hat) in pairs {
        sum += (phi - phi_hat) * (phi - phi_hat);
        n += 1.0;
    }
    if n == 0.0 { 0.0 } else { libm::sqrt(sum / n) }
}
// ANCHOR_END: rms

// ANCHOR: energy
/// ½ m_p |v_p|² (J).
pub fn kinetic_energy_of<const D: usize>(particle: &Particles<D>, p: usize) -> f64 {
    0.5 * particle.m[p] * particle.v[p].dot(&particle.v[p])
}

/// ½ σ_p : D⁻¹ : σ_p m_p / ρ_p (J).
pub fn strain_energy_of<const D: usize>(
    particle: &Particles<D>,
    law: &LinearElastic,
    p: usize,
) -> f64 {
    law.energy_density(&particle.sigma[p]) * (particle.m[p] / particle.rho[p])
}

/// Σ_p of the kinetic energy (J).
pub fn kinetic_energy<const D: usize>(particle: &Particles<D>) -> f64 {
    (0..particle.len()).map(|p| kinetic_energy_of(particle, p)).sum()
}

/// Σ_p of the strain energy (J).
pub fn strain_energy<const D: usize>(particle: &Particles<D>, law: &LinearElastic) -> f64 {
    (0..particle.len()).map(|p| strain_energy_of(particle, law, p)).sum()
}
// ANCHOR_END: energy

/// Σ_p m_p (x_i v_j − x_j v_i) about the body's lower corner (kg m²/s): one
/// number in 2D, three in 3D (for x, y, z), none in 1D.
pub fn angular_momentum<const D: usize>(particle: &Particles<D>) -> Vec<f64> {
    let planes: &[(usize, usize)] = match D {
        1 => &[],
        2 => &[(0, 1)],
        _ => &[(1, 2), (2, 0), (0, 1)],
    };
    let about = |&(i, j): &(usize, usize)| {
        let arm = |p: usize| {
            let (x, v) = (&particle.x[p], &particle.v[p]);
            particle.m[p] * (x[i] * v[j] - x[j] * v[i])
        };
        (0..particle.len()).map(arm).sum()
    };
    planes.iter().map(about).collect()
}

/// Σ_p m_p v_p (kg m/s).
pub fn momentum<const D: usize>(particle: &Particles<D>) -> SVector<f64, D> {
    let mut sum = SVector::zeros();
    for p in 0..particle.len() {
        sum += particle.v[p] * particle.m[p];
    }
    sum
}
