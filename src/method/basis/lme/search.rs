//! Searches for λ at any γ and place, by Newton's method with good starts, damped.

use super::failure::Failure;
use super::seen::{Seen, separates};
use super::weights::{Moments, Weights, moments};
use nalgebra::SVector;

/// After so many iterations the search for λ is given up.
const MOST_ITERATIONS: usize = 200;

/// A step of Newton's method is the last when no p_I changes by more, relative to itself. The
/// step is then applied to the p_I themselves; what is left is its square.
const CLOSE: f64 = 1e-8;

/// A step is taken without a question when no p_I changes by more, relative to itself.
const NEAR: f64 = 0.5;

/// Finds λ h (–) and the weights there, with Newton's method from `starts`.
///
/// If that does not lead to the solution, γ is raised from 1 (or less) in factors of 4. λ
/// grows in proportion, up to logarithms, so each solution starts the next well.
///
/// Errors: [`Failure::OutsideHull`], [`Failure::NotConverged`].
pub fn find_lambda<const D: usize>(
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
    starts: impl IntoIterator<Item = SVector<f64, D>>,
) -> Result<SVector<f64, D>, Failure> {
    weights.p.clear();
    weights.p.resize(seen.a.len(), 0.0);
    if seen.a.is_empty() {
        return Ok(SVector::zeros()); // a corner of the box: all weight is on its node
    }
    match newton(weights, seen, gamma, starts) {
        Err(Failure::NotConverged { .. }) => raise_gamma(weights, seen, gamma),
        done => done,
    }
}

// ANCHOR: lme_newton
/// Solves r(λ) = 0 by Newton's method.
///
/// The last step is applied to the p_I themselves, to first order: λ as a
/// number is no finer than its last bit, which at a large γ is too coarse.
fn newton<const D: usize>(
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
    starts: impl IntoIterator<Item = SVector<f64, D>>,
) -> Result<SVector<f64, D>, Failure> {
    let shift = seen.xi_0 * (2.0 * gamma);
    let starts = starts.into_iter().map(|lambda| lambda - shift);
    let mut now = begin(weights, seen, gamma, starts);
    for iteration in 1..=MOST_ITERATIONS {
        weights.cost.newton_iterations += 1;
        let Some((step, change)) = step(&now, seen) else {
            return Err(not_converged(&now, iteration));
        };
        if change <= CLOSE {
            for (p, a) in weights.p.iter_mut().zip(&seen.a) {
                *p *= 1.0 + step.dot(&(a - now.mean));
            }
            return Ok(now.mu + step + shift);
        }
        now = damped(weights, seen, gamma, &now, step, change);
        if separates(&(now.mu + shift), seen) {
            return Err(Failure::OutsideHull);
        }
    }
    Err(not_converged(&now, MOST_ITERATIONS))
}
// ANCHOR_END: lme_newton

/// Takes the first start that is near enough to the solution, else the best.
fn begin<const D: usize>(
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
    starts: impl Iterator<Item = SVector<f64, D>>,
) -> Moments<D> {
    let (mut best, mut least) = (SVector::zeros(), f64::INFINITY);
    for mu in starts {
        let here = moments(weights, seen, gamma, &mu);
        if step(&here, seen).is_some_and(|(_, change)| change <= NEAR) {
            return here;
        }
        let phi = here.phi();
        if phi < least {
            (best, least) = (mu, phi);
        }
    }
    moments(weights, seen, gamma, &best)
}

/// Takes Newton's step −J⁻¹ r and the largest relative change of a p_I by it,
/// |Δλ·(ξ_I − r)|; `None` when J is singular, or when a moment is no number.
fn step<const D: usize>(now: &Moments<D>, seen: &Seen<D>) -> Option<(SVector<f64, D>, f64)> {
    let step = -(now.J.try_inverse()? * now.r);
    let changes = seen.a.iter().map(|a| libm::fabs(step.dot(&(a - now.mean))));
    let change = changes.fold(0.0, f64::max); // which passes over what is no number
    let finite = change.is_finite() && step.iter().all(|step| step.is_finite());
    finite.then_some((step, change))
}

// ANCHOR: lme_damped
/// Goes along `step`, which is halved while it would change some p_I by more than a half
/// and does not lower log Z, which is convex, as it should (Armijo).
fn damped<const D: usize>(
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
    now: &Moments<D>,
    step: SVector<f64, D>,
    change: f64,
) -> Moments<D> {
    let mut damping = 1.0;
    loop {
        let next = moments(weights, seen, gamma, &(now.mu + step * damping));
        let enough = || now.phi() + 1e-4 * damping * now.r.dot(&step);
        if change * damping <= NEAR || next.phi() <= enough() {
            return next;
        }
        damping *= 0.5;
    }
}
// ANCHOR_END: lme_damped

/// Solves for a small γ first, and from there for larger ones up to `gamma`.
fn raise_gamma<const D: usize>(
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
) -> Result<SVector<f64, D>, Failure> {
    let mut reached = gamma.min(1.0);
    let mut lambda = newton(weights, seen, reached, [SVector::zeros()])?;
    while reached < gamma {
        let next = (4.0 * reached).min(gamma);
        lambda = newton(weights, seen, next, [lambda * (next / reached)])?;
        reached = next;
    }
    Ok(lambda)
}

/// Says how large |r| still is after so many `iterations`.
fn not_converged<const D: usize>(now: &Moments<D>, iterations: usize) -> Failure {
    Failure::NotConverged { residual: libm::sqrt(now.r.dot(&now.r)), iterations }
}
