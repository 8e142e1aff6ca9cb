//! A bar in equilibrium at finite strain, under its weight and a traction that have grown slowly.

use super::fields::Fields;
use super::forced::Load;
use super::riemann::End;
use crate::method::choice::Law;
use crate::method::continuum::law::Elastic;
use crate::method::continuum::moduli::Past;
use nalgebra::SMatrix;

/// A column is a bar on 0 ≤ X ≤ L, fixed at one end and free at the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// L (m).
    pub length: f64,
    /// ρ at rest (kg/m³).
    pub density: f64,
    pub material: Elastic,
    /// X = 0 is fixed, else X = L.
    pub fixed_below: bool,
    /// b (m/s²).
    pub body: Load,
    /// The traction on the free end (Pa), along +x.
    pub traction: Load,
}

impl Column {
    /// Makes the column with these ends and tractions at them; `None` where not just one end is
    /// fixed, or where the material cannot bear the full loads.
    pub fn new(
        (length, density): (f64, f64),
        material: Elastic,
        ends: [End; 2],
        body: Load,
        traction: [Load; 2],
    ) -> Option<Self> {
        let fixed_below = ends[0] == End::Fixed;
        if ends[0] == ends[1] {
            return None;
        }
        let traction = traction[usize::from(fixed_below)];
        let column = Column { length, density, material, fixed_below, body, traction };
        [0.0, length]
            .iter()
            .all(|X| column.stretch(column.force(*X, f64::INFINITY)).is_some())
            .then_some(column)
    }

    // ANCHOR: column
    /// Gives P, the force per area at rest (Pa), at X and time `t`: the traction and the weight of
    /// what hangs on X. In a bar it is the Cauchy stress, whatever the strain.
    pub fn force(&self, X: f64, t: f64) -> f64 {
        let weight = self.density * self.body.now(t);
        match self.fixed_below {
            true => self.traction.now(t) + weight * (self.length - X),
            false => -self.traction.now(t) - weight * X,
        }
    }

    /// Gives the fields of the material point X: v = 0, σ = P, and u = ∫ (F − 1) dX from the fixed
    /// end. Since dX = −dP/(ρ b), u = (C(P_0) − C(P)) / (ρ b) with the complementary energy
    /// C = ∫ (F − 1) dP = (F − 1) P − W(F); without a body force F is the same everywhere.
    pub fn at(&self, X: f64, t: f64) -> Fields {
        let held = if self.fixed_below { 0.0 } else { self.length };
        let (stress, at_held) = (self.force(X, t), self.force(held, t));
        let weight = self.density * self.body.now(t);
        let displacement = match weight == 0.0 {
            true => (self.stretch(stress).unwrap_or(1.0) - 1.0) * (X - held),
            false => (self.complementary(at_held) - self.complementary(stress)) / weight,
        };
        Fields { velocity: 0.0, stress, displacement }
    }

    /// Gives C (J/m³) of P (Pa).
    fn complementary(&self, P: f64) -> f64 {
        let F = self.stretch(P).unwrap_or(1.0);
        let modulus = self.material.p_wave_modulus();
        let W = match self.material.law {
            Law::Rate => modulus * (F * libm::log(F) - (F - 1.0)),
            Law::NeoHookean | Law::Hencky => self.material.energy_of(&SMatrix::<f64, 1, 1>::new(F)),
        };
        (F - 1.0) * P - W
    }
    // ANCHOR_END: column

    /// Finds F at which the law has P (Pa): exp(P/(λ + 2μ)) for (3), else by Newton's method from
    /// F = 1 on; `None` where there is none.
    fn stretch(&self, P: f64) -> Option<f64> {
        if self.material.law == Law::Rate {
            return Some(libm::exp(P / self.material.p_wave_modulus())).filter(|F| F.is_finite());
        }
        let at_rest = Past { F: SMatrix::<f64, 1, 1>::identity(), sigma: SMatrix::zeros() };
        let (unit, mut H) = (SMatrix::<f64, 1, 1>::identity(), 0.0);
        for _ in 0..50 {
            let trial = self.material.trial(&at_rest, &SMatrix::<f64, 1, 1>::new(H))?;
            let slope = trial.change(&self.material, &unit)[0];
            let step = (P - trial.P[0]) / slope;
            if slope <= 0.0 {
                return None;
            }
            H += step.max(-0.5 * (1.0 + H)); // F stays above 0
            if step.abs() <= 1e-15 {
                return Some(1.0 + H);
            }
        }
        None
    }
}
