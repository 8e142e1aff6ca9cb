//! The weights p_I at one multiplier, and their moments: (31), (32), (34), (36)
//! and (37).

use super::{Faces, Lme, fill_faces};
use crate::method::continuum::law::outer;
use nalgebra::{SMatrix, SVector};

/// Up to this many cells the exponentials are factorised on a grid.
pub const FEW: usize = 6;

/// Z, r and J at one μ.
pub struct Moments<const D: usize> {
    /// The largest exponent, and Z with that taken off.
    pub largest: f64,
    pub Z: f64,
    /// μ·ξ_0.
    pub tilt: f64,
    /// Σ p_I a_I.
    pub mean: SVector<f64, D>,
    /// (37): r = Σ p_I ξ_I.
    pub r: SVector<f64, D>,
    /// (36): J = ∂r/∂λ = Σ p_I (ξ_I − r) ⊗ (ξ_I − r).
    pub J: SMatrix<f64, D, D>,
}

impl<const D: usize> Moments<D> {
    /// log Z + μ·ξ_0, what the right μ minimises.
    pub fn phi(&self) -> f64 {
        self.largest + libm::log(self.Z) + self.tilt
    }
}

impl<const D: usize> Lme<D> {
    // ANCHOR: lme_moments
    /// (31) (32) at μ, with the largest exponent taken off so that none
    /// overflows; then r and J centred at the mean, so that nothing cancels.
    pub fn moments(
        &mut self,
        gamma: f64,
        mu: &SVector<f64, D>,
        xi_0: &SVector<f64, D>,
        faces: &Faces<D>,
    ) -> Moments<D> {
        let largest = match self.factorised(gamma, mu) {
            true => 0.0,
            false => self.exponentiated(gamma, mu),
        };
        let (mut Z, mut mean) = (0.0, SVector::zeros());
        for (p, a) in self.weight.iter().zip(&self.a) {
            Z += *p;
            mean += a * *p;
        }
        mean /= Z;
        let mut J = SMatrix::zeros();
        for (p, a) in self.weight.iter_mut().zip(&self.a) {
            *p /= Z;
            let from_mean = a - mean;
            J += outer(&from_mean, &from_mean) * *p;
        }
        fill_faces(&mut J, faces);
        (self.largest, self.Z) = (largest, Z);
        Moments { largest, Z, tilt: mu.dot(xi_0), mean, r: xi_0 + mean, J }
    }
    // ANCHOR_END: lme_moments

    /// exp(f_I − the largest f) in `weight`; returns the largest f.
    fn exponentiated(&mut self, gamma: f64, mu: &SVector<f64, D>) -> f64 {
        let mut largest = f64::NEG_INFINITY;
        for (p, a) in self.weight.iter_mut().zip(&self.a) {
            *p = exponent(gamma, mu, a);
            largest = largest.max(*p);
        }
        for p in &mut self.weight {
            *p = libm::exp(*p - largest);
        }
        self.cost.exponentials += self.a.len() as u64;
        largest
    }

    // ANCHOR: lme_factorised
    /// exp f_I in `weight` with one exponential for each axis, where all a_I are
    /// small whole numbers: exp((μ − γa)a) = exp(−γa²) exp(μ)^a. Powers by
    /// multiplication lose less than a digit of 1e-15 there. `false`, and
    /// nothing done, elsewhere.
    fn factorised(&mut self, gamma: f64, mu: &SVector<f64, D>) -> bool {
        const MOST: f64 = 300.0;
        let reach = self.reach;
        let K = FEW as f64;
        if !(self.on_grid && reach <= K && gamma * reach * reach < MOST && mu.amax() * reach < MOST)
        {
            return false;
        }
        if self.gauss_gamma != gamma {
            self.gauss = std::array::from_fn(|k| libm::exp(-gamma * (k * k) as f64));
            self.gauss_gamma = gamma;
            self.cost.exponentials += self.gauss.len() as u64;
        }
        let mut factor = [[0.0; 2 * FEW + 1]; D];
        for d in 0..D {
            let (up, mut power) = (libm::exp(mu[d]), 1.0);
            let (down, mut inverse) = (1.0 / up, 1.0);
            for k in 0..=reach as usize {
                factor[d][FEW + k] = self.gauss[k] * power;
                factor[d][FEW - k] = self.gauss[k] * inverse;
                power *= up;
                inverse *= down;
            }
        }
        self.cost.exponentials += D as u64;
        for (p, a) in self.weight.iter_mut().zip(&self.a) {
            *p = (0..D).map(|d| factor[d][(a[d] + K) as usize]).product();
        }
        true
    }
    // ANCHOR_END: lme_factorised
}

/// f_I = −γ|a|² + μ·a, axis by axis: near the solution μ_d − γ a_d is the small
/// difference of large numbers that are exact.
fn exponent<const D: usize>(gamma: f64, mu: &SVector<f64, D>, a: &SVector<f64, D>) -> f64 {
    (0..D).map(|d| (mu[d] - gamma * a[d]) * a[d]).sum()
}
