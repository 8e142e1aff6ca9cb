//! For a manufactured solution at finite strain the motion is chosen, and the body force that
//! keeps it going is derived.

use super::fields::Fields;
use super::mode::Mode;

/// The motion is u(X, t) = A φ(X) sin ωt with ω = ck, for the law σ = E ln F, into which (3)
/// integrates in one dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manufactured {
    pub mode: Mode,
    /// A (m); A k < 1 keeps F above 0.
    pub amplitude: f64,
    /// c of the bar at rest (m/s).
    pub c: f64,
    /// E, or λ + 2μ for uniaxial strain (Pa).
    pub modulus: f64,
}

impl Manufactured {
    // ANCHOR: manufactured
    /// Gives F = 1 + ∂u/∂X.
    fn stretch(&self, X: f64, t: f64) -> f64 {
        1.0 + self.amplitude * self.mode.slope(X) * libm::sin(self.c * self.mode.k * t)
    }

    /// Gives v, σ = E ln F, and u of the material point X (m).
    pub fn at(&self, X: f64, t: f64) -> Fields {
        let omega = self.c * self.mode.k;
        let shape = self.amplitude * self.mode.shape(X);
        Fields {
            velocity: omega * shape * libm::cos(omega * t),
            stress: self.modulus * libm::log(self.stretch(X, t)),
            displacement: shape * libm::sin(omega * t),
        }
    }

    /// Gives the force that keeps it going, b = ∂²u/∂t² − (∂σ/∂X)/ρ_0 = ω² u (1/F − 1) (m/s²),
    /// since φ'' = −k² φ.
    pub fn body_force(&self, X: f64, t: f64) -> f64 {
        let omega = self.c * self.mode.k;
        let u = self.amplitude * self.mode.shape(X) * libm::sin(omega * t);
        omega * omega * u * (1.0 / self.stretch(X, t) - 1.0)
    }
    // ANCHOR_END: manufactured
}
