//! These laws hold at a point, without any loop over particles or nodes: compatibility (2),
//! linear elasticity in rate form (3), and conservation of mass (17). What gives the stress from
//! the deformation gradient instead stands in [`super::hyperelastic`].

use crate::method::choice::Law;
use nalgebra::{SMatrix, SVector};

/// Makes the matrix a ⊗ b of the entries a_i b_j.
pub fn outer<const D: usize>(a: &SVector<f64, D>, b: &SVector<f64, D>) -> SMatrix<f64, D, D> {
    SMatrix::from_fn(|i, j| a[i] * b[j])
}

/// Applies a matrix to a vector, row by row: A·b.
pub fn applied<const D: usize>(a: &SMatrix<f64, D, D>, b: &SVector<f64, D>) -> SVector<f64, D> {
    SVector::from_fn(|i, _| (0..D).map(|j| a[(i, j)] * b[j]).sum())
}

// ANCHOR: strain_rate
/// (2) takes the strain rate from a velocity gradient: ε̇ = ∇ˢv = ½ (∇v + ∇ᵀv).
///
/// `grad_v` D×D (1/s); returns D×D (1/s).
pub fn symmetric_part<const D: usize>(grad_v: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    (grad_v + grad_v.transpose()) * 0.5
}
// ANCHOR_END: strain_rate

// ANCHOR: elastic
/// An elastic material has the isotropic elasticity tensor D of (3), by its Lamé moduli, and one
/// of the laws that are (3) while strains and rotations are small.
///
/// With D = 2 this is plane strain. With D = 1 it is uniaxial *strain*: the
/// modulus is λ + 2μ, which for ν = 0 is Young's modulus E, the modulus of a
/// slender bar. A bar with ν ≠ 0 would need uniaxial stress instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    pub law: Law,
    /// λ = E ν / ((1 + ν)(1 − 2ν)) (Pa).
    pub lambda: f64,
    /// μ = E / (2 (1 + ν)) (Pa).
    pub mu: f64,
}

impl Elastic {
    /// Makes the material from Young's modulus E > 0 (Pa) and Poisson's ratio −1 < ν < ½ (–).
    pub fn new(law: Law, youngs_modulus: f64, poisson_ratio: f64) -> Self {
        let (e, nu) = (youngs_modulus, poisson_ratio);
        Elastic {
            law,
            lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            mu: e / (2.0 * (1.0 + nu)),
        }
    }

    /// Gives λ + 2μ (Pa), the modulus of a plane wave, which travels at c = √((λ + 2μ) / ρ).
    pub fn p_wave_modulus(&self) -> f64 {
        self.lambda + 2.0 * self.mu
    }

    /// (3) gives the stress increment of a step: Δσ = D : Δε = λ tr(Δε) 1 + 2μ Δε  (Pa).
    pub fn stress_increment<const D: usize>(
        &self,
        d_eps: &SMatrix<f64, D, D>,
    ) -> SMatrix<f64, D, D> {
        SMatrix::identity() * (self.lambda * d_eps.trace()) + d_eps * (2.0 * self.mu)
    }

    /// Gives ½ σ : D⁻¹ : σ, the elastic energy per volume (J/m³): with s = σ − tr(σ)/d 1 in d
    /// dimensions it is s : s / 4μ + tr(σ)² / (2d (dλ + 2μ)).
    #[inline]
    pub fn energy_density<const D: usize>(&self, sigma: &SMatrix<f64, D, D>) -> f64 {
        let d = D as f64;
        let trace = sigma.trace();
        let of_volume = trace * trace * (0.5 / (d * (d * self.lambda + 2.0 * self.mu)));
        if D == 1 {
            return of_volume;
        }
        let s = sigma - SMatrix::identity() * (trace / d);
        of_volume + s.dot(&s) * (0.25 / self.mu)
    }
}
// ANCHOR_END: elastic

// ANCHOR: increment
/// Gives f = 1 + G and det f of a displacement gradient G of one step (–).
pub fn increment<const D: usize>(G: &SMatrix<f64, D, D>) -> (SMatrix<f64, D, D>, f64) {
    let f = SMatrix::<f64, D, D>::identity() + G;
    let J = determinant(&f);
    (f, J)
}

/// Gives det A, by its first row.
fn determinant<const D: usize>(A: &SMatrix<f64, D, D>) -> f64 {
    let minor =
        |i: usize, j: usize, k: usize, l: usize| A[(i, k)] * A[(j, l)] - A[(i, l)] * A[(j, k)];
    match D {
        1 => A[(0, 0)],
        2 => minor(0, 1, 0, 1),
        _ => {
            A[(0, 0)] * minor(1, 2, 1, 2) - A[(0, 1)] * minor(1, 2, 0, 2)
                + A[(0, 2)] * minor(1, 2, 0, 1)
        }
    }
}

/// Gives det(1 + H) − 1 of a displacement gradient H (–), with all the digits of a small one:
/// tr H and the minors of H.
pub fn volume_change<const D: usize>(H: &SMatrix<f64, D, D>) -> f64 {
    let minor = |i: usize, j: usize| H[(i, i)] * H[(j, j)] - H[(i, j)] * H[(j, i)];
    match D {
        1 => H[(0, 0)],
        2 => H.trace() + minor(0, 1),
        _ => H.trace() + (minor(0, 1) + minor(1, 2) + minor(0, 2)) + determinant(H),
    }
}

/// Gives Δε = sym(G (1 + G/2)⁻¹), the strain increment at the middle of a step of
/// finite size (–); `None` where 1 + G/2 has no inverse.
///
/// In 1D it is G/(1 + G/2), the logarithm ln(1 + G) but for G³/12. Of a rotation by
/// less than half a turn it is zero.
pub fn midpoint_strain<const D: usize>(G: &SMatrix<f64, D, D>) -> Option<SMatrix<f64, D, D>> {
    let middle = (SMatrix::<f64, D, D>::identity() + G * 0.5).try_inverse()?;
    Some(symmetric_part(&(G * middle)))
}
// ANCHOR_END: increment

// ANCHOR: density
/// (17) gives the density after a step: ρ ← ρ / (1 + tr Δε)  (kg/m³).
///
/// `None` when 1 + tr Δε ≤ 0: nothing would be left of the volume.
pub fn density<const D: usize>(rho: f64, d_eps: &SMatrix<f64, D, D>) -> Option<f64> {
    let stretch = 1.0 + d_eps.trace();
    (stretch > 0.0).then(|| rho / stretch)
}
// ANCHOR_END: density
