//! What an implicit step asks of a law: the stress after a trial displacement, and how it changes
//! with that displacement, in closed form.
//!
//! The step begins with the volume V and has the displacement gradient G, f = 1 + G. Its internal
//! forces are those of the first Piola-Kirchhoff stress with the beginning of the step as
//! reference, P = det f σ f⁻ᵀ: for V det f is the volume at the end, and f⁻ᵀ ∇N the gradient
//! there. In 1D P is σ.

use super::hyperelastic::{left_cauchy_green, principal};
use super::law::{Elastic, increment, midpoint_strain, symmetric_part, volume_change};
use crate::method::choice::Law;
use nalgebra::{SMatrix, SVector};

/// A material point remembers one of these from before the step: F with a hyperelastic law, σ with
/// the rate law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Past<const D: usize> {
    /// F (–).
    pub F: SMatrix<f64, D, D>,
    /// σ (Pa).
    pub sigma: SMatrix<f64, D, D>,
}

/// A trial is what a displacement gradient G would make of a material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial<const D: usize> {
    /// P (Pa).
    pub P: SMatrix<f64, D, D>,
    sigma: SMatrix<f64, D, D>,
    /// det f.
    J: f64,
    /// f⁻¹.
    back: SMatrix<f64, D, D>,
    of_law: OfLaw<D>,
}

/// This is what the derivative of the stress needs besides.
#[derive(Clone, Copy, Debug, PartialEq)]
enum OfLaw<const D: usize> {
    /// (1 + G/2)⁻¹.
    Rate { middle: SMatrix<f64, D, D> },
    /// det F after the step, and b = F Fᵀ.
    NeoHookean { J: f64, b: SMatrix<f64, D, D> },
    /// det F, b, the principal values of b − 1 and their directions.
    Hencky { J: f64, b: SMatrix<f64, D, D>, e: SVector<f64, D>, Q: SMatrix<f64, D, D> },
}

impl Elastic {
    // ANCHOR: trial
    /// Tries the displacement gradient `G` (–) on a point with this past: σ is that of (3) with
    /// Δε = sym(G (1 + G/2)⁻¹), or that of F ← f F, and P = det f σ f⁻ᵀ.
    ///
    /// `None` where det f ≤ 0, or is no number.
    pub fn trial<const D: usize>(
        &self,
        past: &Past<D>,
        G: &SMatrix<f64, D, D>,
    ) -> Option<Trial<D>> {
        let (f, J) = increment(G);
        if !(J > 0.0 && J.is_finite()) {
            return None;
        }
        let back = f.try_inverse()?;
        let F = f * past.F;
        let H = F - SMatrix::identity();
        let whole = 1.0 + volume_change(&H);
        let b = SMatrix::identity() + left_cauchy_green(&H);
        let of_law = match self.law {
            Law::Rate => {
                let middle = (SMatrix::<f64, D, D>::identity() + G * 0.5).try_inverse()?;
                OfLaw::Rate { middle }
            }
            Law::NeoHookean => OfLaw::NeoHookean { J: whole, b },
            Law::Hencky => {
                let (e, Q) = principal(left_cauchy_green(&H));
                OfLaw::Hencky { J: whole, b, e, Q }
            }
        };
        let sigma = match self.law {
            Law::Rate => past.sigma + self.stress_increment(&midpoint_strain(G)?),
            Law::NeoHookean | Law::Hencky => self.stress_of(&F),
        };
        Some(Trial { P: sigma * back.transpose() * J, sigma, J, back, of_law })
    }
    // ANCHOR_END: trial
}

impl<const D: usize> Trial<D> {
    // ANCHOR: tangent
    /// Gives dP (Pa) of a change `dG` (–): with l = dG f⁻¹ it is
    /// det f (tr(l) σ − σ lᵀ + dσ) f⁻ᵀ. The first two terms are those of the geometry.
    ///
    /// For the rate law dσ = D : sym(m dG m) with m = (1 + G/2)⁻¹; for the others
    /// J dσ = λ tr(l) 1 + μ (l b + b lᵀ) − tr(l) J σ, where Hencky's law has
    /// 2μ dε in place of the second term, and dε = ½ d ln b has in the principal
    /// directions of b the entries of ½ (l b + b lᵀ) times the slope of ln between b_m and b_n.
    ///
    /// Test: `moduli_are_the_derivative` in `tests/implicit.rs`.
    pub fn change(&self, material: &Elastic, dG: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
        let Elastic { lambda, mu, .. } = *material;
        let l = dG * self.back;
        let volume = l.trace();
        let from_tau = |J: f64, of_shape: SMatrix<f64, D, D>| {
            (SMatrix::identity() * (lambda * volume) + of_shape) / J - self.sigma * volume
        };
        let d_sigma = match &self.of_law {
            OfLaw::Rate { middle } => {
                material.stress_increment(&symmetric_part(&(middle * dG * middle)))
            }
            OfLaw::NeoHookean { J, b } => from_tau(*J, symmetric_part(&(l * b)) * (2.0 * mu)),
            OfLaw::Hencky { J, b, e, Q } => {
                let along = Q.transpose() * symmetric_part(&(l * b)) * Q;
                let d_eps = SMatrix::from_fn(|m, n| along[(m, n)] * slope_of_ln(e[m], e[n]));
                from_tau(*J, Q * d_eps * Q.transpose() * (2.0 * mu))
            }
        };
        let all = self.sigma * volume - self.sigma * l.transpose() + d_sigma;
        all * self.back.transpose() * self.J
    }
    // ANCHOR_END: tangent
}

/// Gives (ln(1 + c) − ln(1 + d)) / (c − d), and 1/(1 + d) where both are the same.
fn slope_of_ln(c: f64, d: f64) -> f64 {
    let x = (c - d) / (1.0 + d);
    let ratio = if x == 0.0 { 1.0 } else { libm::log1p(x) / x };
    ratio / (1.0 + d)
}
