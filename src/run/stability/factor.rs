//! The factor g is what a scheme makes of the trip to the particles and back.

use crate::method::basis::Basis;
use crate::method::time::generalized_alpha::Parameters;
use crate::method::time::scheme::TripFactor;

/// The polynomial in place of a fraction may be off by this.
const ERROR: f64 = 1e-6;

/// A polynomial with more terms costs more than it tells.
const MOST_TERMS: usize = 500;

// ANCHOR: factor
impl TripFactor {
    /// Says whether a node with hardly any mass takes the limit to 0: where g(0) is not 0, and
    /// |∇N|²/N is not bounded.
    pub fn fears_light_nodes(&self, basis: &Basis) -> bool {
        match self {
            TripFactor::One | TripFactor::Filtered | TripFactor::Unlimited => false,
            TripFactor::Last | TripFactor::Alpha { .. } => basis.traits().pushes_light_nodes,
        }
    }

    /// Gives g(s), s from 0 to 1.
    pub fn at(&self, s: f64) -> f64 {
        match self {
            TripFactor::One => 1.0,
            TripFactor::Unlimited => 0.0,
            TripFactor::Filtered => s,
            TripFactor::Last => 2.0 - s,
            TripFactor::Alpha { rho_b } => {
                let Parameters { alpha_m, beta, gamma } = Parameters::new(*rho_b);
                let l = 1.0 - alpha_m - alpha_m * s;
                let p = (1.0 + s) * (beta - 0.5 * gamma * s) - 0.5 * s * (1.0 - s);
                2.0 * p / l
            }
        }
    }

    /// Gives the coefficients of Chebyshev's polynomials of 2s − 1 whose sum is g to 1e-6; of
    /// a fraction that is the more, the nearer ρ_b is to 1.
    ///
    /// From about ρ_b = 0.9999 on g falls from 2 to almost 1 so steeply before s = 1 that no
    /// five hundred terms follow; then it is the constant that g nowhere exceeds. With ρ_b = 1
    /// itself l and p have the factor 1 − s: g is 2 for every s < 1, and 1 for s = 1.
    pub fn chebyshev(&self) -> Vec<f64> {
        let off = |found: &[f64]| {
            let points = 4 * found.len(); // the error swings once between two that fit
            let angle = |n: usize| n as f64 * std::f64::consts::PI / points as f64;
            let at = |s: f64| (sum_at(found, s) - self.at(s)).abs();
            (0..=points).map(|n| at(0.5 + 0.5 * libm::cos(angle(n)))).fold(0.0, f64::max)
        };
        let mut terms = if self.at(1.0).is_finite() { 2 } else { MOST_TERMS };
        while terms < MOST_TERMS {
            let found = self.interpolant(terms);
            if off(&found) < ERROR {
                return found;
            }
            terms += terms / 2 + 1;
        }
        vec![(0..1000).map(|n| self.at(n as f64 / 1000.0)).fold(0.0, f64::max)]
    }

    /// Gives the coefficients of the polynomial that is g at Chebyshev's points.
    fn interpolant(&self, terms: usize) -> Vec<f64> {
        let angle = |j: usize| (j as f64 + 0.5) * std::f64::consts::PI / terms as f64;
        let coefficient = |k: usize| {
            let term = |j: usize| {
                self.at(0.5 + 0.5 * libm::cos(angle(j))) * libm::cos(k as f64 * angle(j))
            };
            let sum: f64 = (0..terms).map(term).sum();
            sum * if k == 0 { 1.0 } else { 2.0 } / terms as f64
        };
        (0..terms).map(coefficient).collect()
    }
}
// ANCHOR_END: factor

/// Gives Σ_k c_k T_k(2s − 1), by Clenshaw's recurrence.
pub fn sum_at(coefficients: &[f64], s: f64) -> f64 {
    let x = 2.0 * s - 1.0;
    let (mut above, mut now) = (0.0, 0.0);
    for (k, c) in coefficients.iter().enumerate().rev() {
        let twice = if k == 0 { 1.0 } else { 2.0 };
        (above, now) = (now, c + twice * x * now - above);
    }
    now
}
