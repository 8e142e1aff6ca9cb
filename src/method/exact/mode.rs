//! A linear elastic bar has natural vibrations.

use super::fields::Fields;
use super::riemann::End;

/// The n-th natural mode of a bar is φ = sin kx where x = 0 is fixed, else cos kx,
/// with k = nπ/L for two like ends and k = (2n − 1)π/2L for a fixed and a free one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// k (1/m).
    pub k: f64,
    /// x = 0 is fixed.
    fixed: bool,
}

impl Mode {
    /// Makes mode `number` ≥ 1 of a bar of `length` (m).
    pub fn new(ends: [End; 2], number: usize, length: f64) -> Self {
        let half_waves = if ends[0] == ends[1] { number as f64 } else { number as f64 - 0.5 };
        Mode { k: half_waves * std::f64::consts::PI / length, fixed: ends[0] == End::Fixed }
    }

    /// Gives φ(x).
    pub fn shape(&self, x: f64) -> f64 {
        if self.fixed { libm::sin(self.k * x) } else { libm::cos(self.k * x) }
    }

    /// Gives φ'(x) (1/m).
    pub fn slope(&self, x: f64) -> f64 {
        self.k * if self.fixed { libm::cos(self.k * x) } else { -libm::sin(self.k * x) }
    }
}

/// A bar vibrates in one mode when it is thrown from rest with V φ(x).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vibration {
    pub mode: Mode,
    /// V, the largest speed (m/s).
    pub velocity: f64,
    /// c (m/s).
    pub c: f64,
    /// E, or λ + 2μ for uniaxial strain (Pa).
    pub modulus: f64,
}

impl Vibration {
    // ANCHOR: vibration
    /// Gives the fields u = V/ω φ sin ωt, v = V φ cos ωt, σ = E V/ω φ' sin ωt, with ω = ck.
    pub fn at(&self, x: f64, t: f64) -> Fields {
        let omega = self.c * self.mode.k;
        let amplitude = self.velocity / omega * libm::sin(omega * t);
        Fields {
            velocity: self.velocity * self.mode.shape(x) * libm::cos(omega * t),
            stress: self.modulus * amplitude * self.mode.slope(x),
            displacement: amplitude * self.mode.shape(x),
        }
    }
    // ANCHOR_END: vibration
}
