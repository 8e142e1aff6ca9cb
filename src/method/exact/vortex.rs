//! The generalized vortex turns a ring of material to and fro: large rotation and shear without
//! any change of volume, about material that stays at rest.
//!
//! Source: Kamojjala, Brannon, Sadeghirad and Guilkey, *Verification tests in solid mechanics*
//! (2015); the body force is derived anew.

use super::fields::{Fields, FieldsIn};
use crate::method::continuum::law::Elastic;
use nalgebra::{Matrix2, Vector2};

/// A point at the distance R of the centre turns by α = A sin(ωt) q(R/R_0), where
/// q(s) = 1 − 32 (s − 1)² + 256 (s − 1)⁴ for ¾ < s < 5/4 and 0 elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vortex {
    /// From the body's lower corner (m).
    pub centre: [f64; 2],
    /// R_0, where the ring turns most (m).
    pub radius: f64,
    /// A (rad).
    pub angle: f64,
    /// ω (rad/s).
    pub omega: f64,
    /// ρ (kg/m³).
    pub density: f64,
    /// Neo-Hookean.
    pub material: Elastic,
}

/// These are R (m), α, R α' = dα/d ln R and R² α'' at a point, α, its rate and its second rate
/// without their factors of time.
struct Turn {
    R: f64,
    /// sin and cos of the polar angle Θ.
    place: [f64; 2],
    q: f64,
    slope: f64,
    curvature: f64,
}

impl Turn {
    /// Gives the directions of the polar axes after a turn by `alpha` (rad), as columns.
    fn axes(&self, alpha: f64) -> Matrix2<f64> {
        let (sin, cos) = libm::sincos(alpha);
        let [sin_0, cos_0] = self.place;
        let (sin, cos) = (sin_0 * cos + cos_0 * sin, cos_0 * cos - sin_0 * sin);
        Matrix2::new(cos, -sin, sin, cos)
    }
}

impl Vortex {
    // ANCHOR: vortex
    fn turn(&self, X: [f64; 2]) -> Turn {
        let (x, y) = (X[0] - self.centre[0], X[1] - self.centre[1]);
        let R = libm::hypot(x, y);
        let s = R / self.radius;
        let e = s - 1.0;
        if !(-0.25 < e && e < 0.25) {
            return Turn { R, place: [0.0, 1.0], q: 0.0, slope: 0.0, curvature: 0.0 };
        }
        let square = e * e;
        Turn {
            R,
            place: [y / R, x / R],
            q: 1.0 - 32.0 * square + 256.0 * square * square,
            slope: s * (-64.0 * e + 1024.0 * e * square),
            curvature: s * s * (-64.0 + 3072.0 * square),
        }
    }

    /// Gives F = Q(α) (1 + γ e_Θ ⊗ e_R) with the shear γ = R dα/dR, and the directions of the
    /// polar axes after the turn, as columns.
    fn polar(&self, turn: &Turn, t: f64) -> (f64, Matrix2<f64>) {
        let swing = self.angle * libm::sin(self.omega * t);
        (swing * turn.slope, turn.axes(swing * turn.q))
    }

    /// Gives F of the material point X (m).
    pub fn deformation(&self, X: [f64; 2], t: f64) -> Matrix2<f64> {
        let turn = self.turn(X);
        let (gamma, axes) = self.polar(&turn, t);
        let [sin, cos] = turn.place;
        axes * Matrix2::new(1.0, 0.0, gamma, 1.0) * Matrix2::new(cos, sin, -sin, cos)
    }

    /// Gives v, σ and u of the material point X (m). In polar axes σ = μ (b − 1) is
    /// μ (0, γ; γ, γ²), for J = 1; the chord of the turn is 2 R sin(α/2) long.
    pub fn at(&self, X: [f64; 2], t: f64) -> FieldsIn<2> {
        let turn = self.turn(X);
        let (gamma, axes) = self.polar(&turn, t);
        let rate = self.angle * self.omega * libm::cos(self.omega * t) * turn.q;
        let half = 0.5 * self.angle * libm::sin(self.omega * t) * turn.q;
        let chord = turn.axes(half).column(1) * (2.0 * libm::sin(half));
        let stress = Matrix2::new(0.0, gamma, gamma, gamma * gamma) * self.material.mu;
        Fields {
            velocity: axes.column(1) * (turn.R * rate),
            stress: axes * stress * axes.transpose(),
            displacement: chord * turn.R,
        }
    }

    /// Gives the force that keeps it going (m/s²): with balance in polar axes
    /// b_r = −R α̇² + μ γ² / (ρ R) and b_θ = R α̈ − (μ/ρ) (3 α' + R α'').
    pub fn body_force(&self, X: [f64; 2], t: f64) -> Vector2<f64> {
        let turn = self.turn(X);
        if turn.q == 0.0 && turn.slope == 0.0 {
            return Vector2::zeros();
        }
        let (gamma, axes) = self.polar(&turn, t);
        let (sin, cos) = libm::sincos(self.omega * t);
        let rate = self.angle * self.omega * cos * turn.q;
        let second = -self.angle * self.omega * self.omega * sin * turn.q;
        let stiffness = self.material.mu / (self.density * turn.R);
        let bent = self.angle * sin * (3.0 * turn.slope + turn.curvature);
        let b = Vector2::new(
            stiffness * gamma * gamma - turn.R * rate * rate,
            turn.R * second - stiffness * bent,
        );
        axes * b
    }
    // ANCHOR_END: vortex
}
