//! Makes the weights p_I at one multiplier, and their moments: (31), (32), (34), (36) and (37),
//! where a plain exponential would lose digits or leave the range of numbers.

use super::seen::{Seen, fill_faces};
use crate::method::continuum::law::outer;
use crate::method::cost::Cost;
use nalgebra::{SMatrix, SVector};

/// On a grid the exponentials are factorised up to a distance of so many cells.
pub const FEW: usize = 6;

/// Exponents up to this size are safe to multiply.
pub const MOST: f64 = 300.0;

/// These are the weights of the nodes that share, and what the next ones are made from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weights {
    /// p_I, which add up to 1.
    pub p: Vec<f64>,
    /// Σ exp f_I is Z exp(largest).
    pub largest: f64,
    pub Z: f64,
    gauss: Gauss,
    /// Exponential functions and Newton iterations so far.
    pub cost: Cost,
}

/// Keeps exp(−γk²) for k = 0, 1, … and the γ it is for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gauss {
    of: [f64; FEW + 1],
    gamma: f64,
}

impl Gauss {
    /// Gives exp(−γk²), made anew when γ is another.
    #[inline]
    pub fn at(&mut self, gamma: f64, cost: &mut Cost) -> &[f64; FEW + 1] {
        if self.gamma != gamma {
            self.of = std::array::from_fn(|k| libm::exp(-gamma * (k * k) as f64));
            self.gamma = gamma;
            cost.exponentials += self.of.len() as u64;
        }
        &self.of
    }
}

/// Moments are Z, r and J at one μ.
pub struct Moments<const D: usize> {
    /// μ = λ − 2γ ξ_0.
    pub mu: SVector<f64, D>,
    /// The largest exponent, and Z with that taken off.
    largest: f64,
    Z: f64,
    /// μ·ξ_0.
    tilt: f64,
    /// Σ p_I a_I.
    pub mean: SVector<f64, D>,
    /// (37): r = Σ p_I ξ_I.
    pub r: SVector<f64, D>,
    /// (36): J = ∂r/∂λ = Σ p_I (ξ_I − r) ⊗ (ξ_I − r).
    pub J: SMatrix<f64, D, D>,
}

impl<const D: usize> Moments<D> {
    /// Gives log Z + μ·ξ_0, which the right μ minimises.
    pub fn phi(&self) -> f64 {
        self.largest + libm::log(self.Z) + self.tilt
    }
}

// ANCHOR: lme_moments
/// Takes (31) and (32) at μ, with the largest exponent taken off so that none
/// overflows; then r and J centred at the mean, so that nothing cancels.
pub fn moments<const D: usize>(
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
    mu: &SVector<f64, D>,
) -> Moments<D> {
    let largest = match factorised(weights, seen, gamma, mu) {
        true => 0.0,
        false => exponentiated(weights, seen, gamma, mu),
    };
    let (mut Z, mut mean) = (0.0, SVector::zeros());
    for (p, a) in weights.p.iter().zip(&seen.a) {
        Z += *p;
        mean += a * *p;
    }
    mean /= Z;
    let mut J = SMatrix::zeros();
    for (p, a) in weights.p.iter_mut().zip(&seen.a) {
        *p /= Z;
        let from_mean = a - mean;
        J += outer(&from_mean, &from_mean) * *p;
    }
    fill_faces(&mut J, &seen.faces);
    (weights.largest, weights.Z) = (largest, Z);
    Moments { mu: *mu, largest, Z, tilt: mu.dot(&seen.xi_0), mean, r: seen.xi_0 + mean, J }
}
// ANCHOR_END: lme_moments

/// Makes p_I = exp(f_I − the largest f); returns the largest f.
fn exponentiated<const D: usize>(
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
    mu: &SVector<f64, D>,
) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    for (p, a) in weights.p.iter_mut().zip(&seen.a) {
        *p = exponent(gamma, mu, a);
        largest = largest.max(*p);
    }
    for p in &mut weights.p {
        *p = libm::exp(*p - largest);
    }
    weights.cost.exponentials += seen.a.len() as u64;
    largest
}

/// Gives f_I = −γ|a|² + μ·a, axis by axis: near the solution μ_d − γ a_d is the small
/// difference of large numbers that are exact.
fn exponent<const D: usize>(gamma: f64, mu: &SVector<f64, D>, a: &SVector<f64, D>) -> f64 {
    (0..D).map(|d| (mu[d] - gamma * a[d]) * a[d]).sum()
}

// ANCHOR: lme_factorised
/// Makes p_I = exp f_I with one exponential for each axis, where all a_I are small
/// whole numbers: exp((μ − γa)a) = exp(−γa²) exp(μ)^a. Powers by multiplication lose
/// less than a digit of 1e-15 there. Elsewhere nothing is done, and the answer is `false`.
fn factorised<const D: usize>(
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
    mu: &SVector<f64, D>,
) -> bool {
    let reach = seen.reach;
    let K = FEW as f64;
    if !(seen.on_grid && reach <= K && gamma * reach * reach < MOST && mu.amax() * reach < MOST) {
        return false;
    }
    let gauss = weights.gauss.at(gamma, &mut weights.cost);
    let mut factor = [[0.0; 2 * FEW + 1]; D];
    for d in 0..D {
        let (up, mut power) = (libm::exp(mu[d]), 1.0);
        let (down, mut inverse) = (1.0 / up, 1.0);
        for k in 0..=reach as usize {
            factor[d][FEW + k] = gauss[k] * power;
            factor[d][FEW - k] = gauss[k] * inverse;
            power *= up;
            inverse *= down;
        }
    }
    weights.cost.exponentials += D as u64;
    for (p, a) in weights.p.iter_mut().zip(&seen.a) {
        *p = (0..D).map(|d| factor[d][(a[d] + K) as usize]).product();
    }
    true
}
// ANCHOR_END: lme_factorised
