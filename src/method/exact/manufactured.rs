//! For a manufactured solution at finite strain the motion is chosen, and the body force that
//! keeps it going is derived.
//!
//! One family holds three cases: the bar of the shipped scene; the periodic bar of Uintah's
//! adaptive grids (mode 2 of a bar that is held at both ends, φ = sin 2πX/L, a quarter of a
//! period ahead); and the axis-aligned motion in 2D and 3D of Wallstedt and Guilkey (2008), by
//! phases of its own along every axis.

use super::fields::{Fields, FieldsIn};
use super::mode::Mode;
use crate::method::choice::Law;
use crate::method::continuum::law::Elastic;
use nalgebra::{SMatrix, SVector};

/// The motion is u_i(X, t) = A φ(X_i) sin(ωt + θ_i) along every axis: F is diagonal, so all
/// laws have the stress in closed form, into which (3) integrates, too.
#[derive(Clone, Debug, PartialEq)]
pub struct Manufactured<const D: usize> {
    /// φ and k along each axis.
    pub modes: [Mode; D],
    /// A (m); |A| k < 1 keeps F above 0.
    pub amplitude: f64,
    /// ω (rad/s).
    pub omega: f64,
    /// θ_i (rad).
    pub phase: [f64; D],
    /// ρ at rest (kg/m³).
    pub density: f64,
    pub material: Elastic,
}

impl<const D: usize> Manufactured<D> {
    // ANCHOR: manufactured
    /// Gives the principal stretches F_i = 1 + ∂u_i/∂X_i.
    pub fn stretches(&self, X: &SVector<f64, D>, t: f64) -> SVector<f64, D> {
        SVector::from_fn(|i, _| 1.0 + self.amplitude * self.modes[i].slope(X[i]) * self.swing(i, t))
    }

    /// Gives sin(ωt + θ_i).
    fn swing(&self, i: usize, t: f64) -> f64 {
        libm::sin(self.omega * t + self.phase[i])
    }

    /// Gives v, σ and u of the material point X (m).
    pub fn at(&self, X: &SVector<f64, D>, t: f64) -> FieldsIn<D> {
        let shape = |i: usize| self.amplitude * self.modes[i].shape(X[i]);
        let turn = |i: usize| libm::cos(self.omega * t + self.phase[i]);
        Fields {
            velocity: SVector::from_fn(|i, _| self.omega * shape(i) * turn(i)),
            stress: SMatrix::from_diagonal(&self.stress(&self.stretches(X, t))),
            displacement: SVector::from_fn(|i, _| shape(i) * self.swing(i, t)),
        }
    }

    /// Gives σ_i (Pa) of the principal stretches. With the rate law (3) is integrated while
    /// the axes stay: σ_i = λ ln J + 2μ ln F_i.
    fn stress(&self, F: &SVector<f64, D>) -> SVector<f64, D> {
        let Elastic { law, lambda, mu } = self.material;
        let (J, ln_J) = (F.product(), F.map(libm::log).sum());
        F.map(|F_i| match law {
            Law::Rate => lambda * ln_J + 2.0 * mu * libm::log(F_i),
            Law::NeoHookean => (lambda * ln_J + mu * (F_i * F_i - 1.0)) / J,
            Law::Hencky => (lambda * ln_J + 2.0 * mu * libm::log(F_i)) / J,
        })
    }

    /// Gives the force that keeps it going, b_i = ∂²u_i/∂t² − (∂P_i/∂X_i)/ρ_0  (m/s²), with
    /// P_i = J σ_i / F_i.
    ///
    /// Only F_i depends on X_i, and ∂F_i/∂X_i = −k² u_i since φ'' = −k² φ. So ∂P_i/∂X_i is
    /// −k² u_i / F_i² times (λ + 2μ) J for the rate law, λ (1 − ln J) + μ (F_i² + 1) for the
    /// neo-Hookean one, and λ + 2μ − J σ_i for Hencky's.
    pub fn body_force(&self, X: &SVector<f64, D>, t: f64) -> SVector<f64, D> {
        let Elastic { law, lambda, mu } = self.material;
        let F = self.stretches(X, t);
        let (sigma, J) = (self.stress(&F), F.product());
        SVector::from_fn(|i, _| {
            let u = self.amplitude * self.modes[i].shape(X[i]) * self.swing(i, t);
            let square = F[i] * F[i];
            let stiffness = match law {
                Law::Rate => (lambda + 2.0 * mu) * J,
                Law::NeoHookean => lambda * (1.0 - F.map(libm::log).sum()) + mu * (square + 1.0),
                Law::Hencky => lambda + 2.0 * mu - J * sigma[i],
            };
            let k = self.modes[i].k;
            u * (k * k * stiffness / (self.density * square) - self.omega * self.omega)
        })
    }
    // ANCHOR_END: manufactured
}
