//! Local max-ent with a metric that deforms with the material (Kumar, Danas and Kochmann 2019, anisotropic
//! functions for OTM): a point measures distances as they were before the body was stretched.
//!
//! The weights are p_a ∝ exp(−(x − x_a)·B(x − x_a) + λ·(x − x_a)) with B = γ/h² 1 at the start
//! and B ← f⁻ᵀ B f⁻¹ in every step, f the step's deformation gradient. With A ← A f⁻¹ from A = 1,
//! B is γ AᵀA/h² throughout. So ξ_a = A (x − x_a)/h brings back (31) as it stands, and whatever
//! solves that serves here: only places go in by A, and gradients come out by Aᵀ.

use crate::method::continuum::law::applied;
use nalgebra::{SMatrix, SVector};

// ANCHOR: metric
/// A metric measures offsets in units of h before the deformation.
#[derive(Clone, Copy)]
pub struct Metric<'a, const D: usize> {
    /// h of γ = βh² along each axis (m).
    pub h: &'a SVector<f64, D>,
    /// A (–); `None` where distances are those of the present body, as with A = 1.
    pub A: Option<&'a SMatrix<f64, D, D>>,
}

impl<const D: usize> Metric<'_, D> {
    /// Gives ξ = A Δx / h (–) of the offset Δx = x − x_a (m).
    pub fn xi(&self, offset: SVector<f64, D>) -> SVector<f64, D> {
        match self.A {
            Some(A) => applied(A, &offset).component_div(self.h),
            None => offset.component_div(self.h),
        }
    }

    /// Gives ∇N = Aᵀ (∇_ξ N / h) (1/m) from the gradient by ξ (–). The multiplier λ of the
    /// offset itself (1/m) follows in the same way from λ h.
    pub fn gradient(&self, by_xi: &SVector<f64, D>) -> SVector<f64, D> {
        let grad = by_xi.component_div(self.h);
        self.A.map_or(grad, |A| applied(&A.transpose(), &grad))
    }

    /// Gives the half width (h) of a cube that holds every offset with |ξ| ≤ `reach`: the
    /// longest row of A⁻¹, in units of h, times `reach`. `None` if A has no inverse.
    pub fn half_width(&self, reach: f64) -> Option<f64> {
        let Some(A) = self.A else {
            return Some(reach);
        };
        let inverse = A.try_inverse()?;
        let scaled = |d: usize, e: usize| inverse[(d, e)] * self.h[e] / self.h[d];
        let square = |d: usize| (0..D).map(|e| scaled(d, e) * scaled(d, e)).sum::<f64>();
        Some(reach * libm::sqrt((0..D).map(square).fold(0.0, f64::max)))
    }
}
// ANCHOR_END: metric
