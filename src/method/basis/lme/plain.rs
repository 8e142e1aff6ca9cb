//! Solves local max-ent as the paper has it: (31)-(37), by Newton's method from λ = 0.

use super::failure::Failure;
use nalgebra::{SMatrix, SVector};

/// After so many steps Newton's method is given up.
const MOST_STEPS: usize = 40;

/// λ is found when |r| is below this: some ten times what rounding leaves of it.
const SMALL: f64 = 1e-15;

/// A solution is λ at one point, with the shape functions that follow from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution<const D: usize> {
    /// λ (–, scaled by h).
    pub lambda: SVector<f64, D>,
    /// p_I, that is N_I.
    pub p: Vec<f64>,
    /// h ∇p_I.
    pub grad: Vec<SVector<f64, D>>,
}

// ANCHOR: lme_plain
/// Solves local max-ent at the point with `xi`, ξ_I = (x − x_I)/h, for γ = βh²;
/// `residuals` gets |r| (–) before each step.
///
/// From γ of about 6 up, λ = 0 is too far from the solution at more and more places; on
/// the hull λ is infinite. So no run calls this: what it calls is held to this.
///
/// Errors: [`Failure::OutsideHull`] where J has no inverse, [`Failure::NotConverged`].
/// Tests: `tests/lme.rs`.
pub fn solve<const D: usize>(
    residuals: &mut Vec<f64>,
    xi: &[SVector<f64, D>],
    gamma: f64,
) -> Result<Solution<D>, Failure> {
    let (mut lambda, mut residual) = (SVector::<f64, D>::zeros(), f64::NAN);
    for _ in 0..MOST_STEPS {
        let f = xi.iter().map(|xi_I| lambda.dot(xi_I) - (xi_I * gamma).dot(xi_I)); // (34)
        let largest = f.clone().fold(f64::NEG_INFINITY, f64::max); // so that none overflows
        let mut p: Vec<f64> = f.map(|f_I| libm::exp(f_I - largest)).collect();
        let Z: f64 = p.iter().sum(); // (32)
        p.iter_mut().for_each(|p_I| *p_I /= Z); // (31)
        let (mut r, mut J) = (SVector::<f64, D>::zeros(), SMatrix::<f64, D, D>::zeros());
        for (p_I, xi_I) in p.iter().zip(xi) {
            r += xi_I * *p_I; // (37)
        }
        for (p_I, xi_I) in p.iter().zip(xi) {
            J += (xi_I - r) * *p_I * (xi_I - r).transpose(); // (36)
        }
        residual = libm::sqrt(r.dot(&r));
        residuals.push(residual);
        let inverse = J.try_inverse().ok_or(Failure::OutsideHull)?;
        if residual < SMALL {
            let grad = p.iter().zip(xi).map(|(p_I, xi_I)| -(inverse * xi_I) * *p_I).collect(); // (35)
            return Ok(Solution { lambda, p, grad });
        }
        lambda -= inverse * r;
    }
    Err(Failure::NotConverged { residual, iterations: MOST_STEPS })
}
// ANCHOR_END: lme_plain
