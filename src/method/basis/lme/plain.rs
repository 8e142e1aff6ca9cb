//! Local max-ent as the paper has it: (31)-(37), solved by Newton's method from λ = 0.

use super::failure::Failure;
use nalgebra::{SMatrix, SVector};

/// The steps after which plain Newton is given up.
pub const MOST_STEPS: usize = 40;

/// p_I (–), h∇p_I (–) and λ h (–) of one point.
pub type Solution<const D: usize> = (Vec<f64>, Vec<SVector<f64, D>>, SVector<f64, D>);

// ANCHOR: lme_plain
/// p_I, h∇p_I and λ of a point with ξ_I = (x − x_I)/h, for γ = βh²; `residuals` gets
/// |r| before each step.
///
/// From γ of about 6 up λ = 0 is too far from the solution at more and more places, and
/// on the hull λ is infinite. No run calls this: it is the measure of what they call.
///
/// Errors: [`Failure::OutsideHull`] where J has no inverse, [`Failure::NotConverged`].
pub fn newton<const D: usize>(
    residuals: &mut Vec<f64>,
    xi: &[SVector<f64, D>],
    gamma: f64,
) -> Result<Solution<D>, Failure> {
    let mut lambda = SVector::<f64, D>::zeros();
    for _ in 0..MOST_STEPS {
        let f = xi.iter().map(|xi| lambda.dot(xi) - (xi * gamma).dot(xi)); // (34)
        let largest = f.clone().fold(f64::NEG_INFINITY, f64::max); // taken off, so that none overflows
        let mut p: Vec<f64> = f.map(|f| libm::exp(f - largest)).collect();
        let Z: f64 = p.iter().sum(); // (32)
        p.iter_mut().for_each(|p| *p /= Z); // (31)
        let r: SVector<f64, D> = xi.iter().zip(&p).map(|(xi, p)| xi * *p).sum(); // (37)
        let from_mean = xi.iter().map(|xi| xi - r).zip(&p);
        let J: SMatrix<f64, D, D> = from_mean.map(|(d, p)| d * *p * d.transpose()).sum(); // (36)
        residuals.push(libm::sqrt(r.dot(&r)));
        let inverse = J.try_inverse().ok_or(Failure::OutsideHull)?;
        if r.dot(&r) < 1e-30 {
            let grad = xi.iter().zip(&p).map(|(xi, p)| -(inverse * xi) * *p).collect(); // (35)
            return Ok((p, grad, lambda));
        }
        lambda -= inverse * r;
    }
    let residual = residuals.last().copied().unwrap_or(f64::NAN);
    Err(Failure::NotConverged { residual, iterations: MOST_STEPS })
}
// ANCHOR_END: lme_plain
