//! These laws give the stress and the energy from the deformation gradient F alone, and so are
//! objective: a rotation turns the stress, and costs nothing.
//!
//! Both are written in H = F − 1, which keeps the digits of small strains, and both become (3)
//! there. With J = det F and b = F Fᵀ:
//!
//! | law | W, energy per volume at t = 0 | J σ |
//! |---|---|---|
//! | neo-Hookean | ½ λ ln²J − μ ln J + ½ μ (tr b − D) | λ ln J 1 + μ (b − 1) |
//! | Hencky | ½ λ ln²J + μ ε : ε | λ ln J 1 + 2 μ ε, ε = ½ ln b |
//!
//! In 2D this is plane strain, in 1D uniaxial strain: the missing stretches are 1.
//!
//! Sources: Bonet and Wood, *Nonlinear Continuum Mechanics for Finite Element Analysis*, 2nd
//! ed. (2008), §6.4; Hencky (1928).

use super::law::{Elastic, volume_change};
use crate::method::choice::Law;
use nalgebra::{SMatrix, SVector};

// ANCHOR: hyperelastic
impl Elastic {
    /// Gives σ (Pa) of the deformation gradient `F` (–) with det F > 0; 0 with the rate law,
    /// which has none.
    pub fn stress_of<const D: usize>(&self, F: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
        let H = F - SMatrix::identity();
        let dJ = volume_change(&H);
        let of_shape = match self.law {
            Law::Rate => return SMatrix::zeros(),
            Law::NeoHookean => left_cauchy_green(&H) * self.mu,
            Law::Hencky => logarithmic_strain(&H) * (2.0 * self.mu),
        };
        let of_volume = SMatrix::identity() * (self.lambda * libm::log1p(dJ));
        (of_volume + of_shape) / (1.0 + dJ)
    }

    /// Gives W (J/m³), the energy per volume at t = 0, of the deformation gradient `F` (–)
    /// with det F > 0; 0 with the rate law.
    ///
    /// ½ (tr b − D) − ln J is taken as ½ H : H − (J − 1 − tr H) + (J − 1 − ln J), whose terms
    /// are all as small as H².
    pub fn energy_of<const D: usize>(&self, F: &SMatrix<f64, D, D>) -> f64 {
        let H = F - SMatrix::identity();
        let dJ = volume_change(&H);
        let ln_J = libm::log1p(dJ);
        let of_shape = match self.law {
            Law::Rate => return 0.0,
            Law::NeoHookean => 0.5 * H.dot(&H) - (dJ - H.trace()) + (dJ - ln_J),
            Law::Hencky => {
                let eps = logarithmic_strain(&H);
                eps.dot(&eps)
            }
        };
        0.5 * self.lambda * ln_J * ln_J + self.mu * of_shape
    }
}

/// Gives b − 1 = H + Hᵀ + H Hᵀ of H = F − 1 (–).
pub(super) fn left_cauchy_green<const D: usize>(H: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    H + H.transpose() + H * H.transpose()
}

/// Gives ε = ½ ln b of H = F − 1 (–): b − 1 has the principal values e_n along the unit vectors
/// q_n, so ε = Σ_n ½ ln(1 + e_n) q_n ⊗ q_n.
fn logarithmic_strain<const D: usize>(H: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    let (e, Q) = principal(left_cauchy_green(H));
    let ln: SVector<f64, D> = e.map(|e_n| 0.5 * libm::log1p(e_n));
    SMatrix::from_fn(|i, j| (0..D).map(|n| ln[n] * Q[(i, n)] * Q[(j, n)]).sum())
}

/// Finds the principal values of a symmetric matrix, and their directions as columns, by
/// Jacobi's rotations: each makes one entry beside the diagonal zero.
pub(super) fn principal<const D: usize>(
    mut A: SMatrix<f64, D, D>,
) -> (SVector<f64, D>, SMatrix<f64, D, D>) {
    /// Entries shrink quadratically; 3 × 3 needs four or five sweeps.
    const SWEEPS: usize = 12;
    let mut Q = SMatrix::<f64, D, D>::identity();
    for _ in 0..SWEEPS {
        for i in 0..D {
            for j in i + 1..D {
                if A[(i, j)] == 0.0 {
                    continue;
                }
                // The smaller root t = tan of t² + 2 θ t − 1 = 0.
                let theta = (A[(j, j)] - A[(i, i)]) / (2.0 * A[(i, j)]);
                let size = 1.0 / (theta.abs() + libm::sqrt(theta * theta + 1.0));
                let t = if theta < 0.0 { -size } else { size };
                let c = 1.0 / libm::sqrt(t * t + 1.0);
                let mut R = SMatrix::<f64, D, D>::identity();
                (R[(i, i)], R[(j, j)]) = (c, c);
                (R[(i, j)], R[(j, i)]) = (t * c, -t * c);
                A = R.transpose() * A * R;
                (A[(i, j)], A[(j, i)]) = (0.0, 0.0);
                Q *= R;
            }
        }
    }
    (A.diagonal(), Q)
}
// ANCHOR_END: hyperelastic
