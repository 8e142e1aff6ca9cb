//! Solves the elastic bar under loads, from rest, by Riemann invariants once more.
//!
//! A body force adds to both invariants all along a characteristic, a traction
//! adds to the one that leaves the loaded end. The problem is linear, so this
//! is added to what [`super::riemann`] gives for an initial velocity.

use super::fields::Fields;
use super::riemann::{End, Family};

/// Says how much of a load acts at time `t`: min(t/T, 1), and 1 for T = 0.
pub fn ramp(t: f64, T: f64) -> f64 {
    if t < T { t / T } else { 1.0 }
}

/// A load grows linearly to its value over the time T, and stays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    pub value: f64,
    /// T (s); 0 for a load that is there at once.
    pub ramp: f64,
}

impl Load {
    // ANCHOR: ramp_integrals
    /// Integrates the load over the time from 0 to t.
    fn once(&self, t: f64) -> f64 {
        let T = self.ramp;
        self.value * if t < T { t * t / (2.0 * T) } else { t - 0.5 * T }
    }

    /// Integrates [`Load::once`] once more.
    fn twice(&self, t: f64) -> f64 {
        let T = self.ramp;
        let grown = T * T / 6.0 + 0.5 * (t * t - T * T) - 0.5 * T * (t - T);
        self.value * if t < T { t * t * t / (6.0 * T) } else { grown }
    }

    /// Gives the load at t ≥ 0.
    pub fn now(&self, t: f64) -> f64 {
        self.value * ramp(t, self.ramp)
    }
    // ANCHOR_END: ramp_integrals
}

/// A forced bar is linear elastic on 0 ≤ x ≤ L, at rest at t = 0, and under loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forced {
    /// L (m).
    pub length: f64,
    /// c (m/s).
    pub c: f64,
    /// Z = ρc (Pa s/m).
    pub Z: f64,
    /// At x = 0 and at x = L.
    pub ends: [End; 2],
    /// b (m/s²).
    pub body: Load,
    /// Traction on the free ends (Pa), both along +x.
    pub traction: [Load; 2],
}

impl Forced {
    // ANCHOR: forced
    /// Gives v, σ and u at 0 ≤ `x` ≤ L (m) and `t` ≥ 0 (s), with as many terms as
    /// there are reflections.
    pub fn at(&self, x: f64, t: f64) -> Fields {
        let (I, II) = (self.invariant(Family::I, x, t), self.invariant(Family::II, x, t));
        Fields { velocity: I.0 + II.0, stress: self.Z * (II.0 - I.0), displacement: I.1 + II.1 }
    }

    /// Gives R at (x, t), and ∫ R dt at x. Followed back from (x, t), the
    /// characteristic collects half of the body force on every piece, and t/Z
    /// at every loaded end.
    fn invariant(&self, family: Family, x: f64, t: f64) -> (f64, f64) {
        let mut end = if family == Family::I { 0 } else { 1 };
        let mut path = if end == 0 { x } else { self.length - x };
        let (mut R, mut integral, mut sign, mut since) = (0.0, 0.0, 1.0, t);
        loop {
            let before = t - path / self.c; // when the wave left the end
            let start = before.max(0.0);
            R += 0.5 * sign * (self.body.once(since) - self.body.once(start));
            integral += 0.5 * sign * (self.body.twice(since) - self.body.twice(start));
            if before < 0.0 {
                return (R, integral);
            }
            R += sign / self.Z * self.traction[end].now(before);
            integral += sign / self.Z * self.traction[end].once(before);
            sign *= self.ends[end].reflection();
            (end, path, since) = (1 - end, path + self.length, before);
        }
    }
    // ANCHOR_END: forced
}
