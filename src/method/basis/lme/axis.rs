//! Solves local max-ent along one axis of a grid, (31)-(37) with D = 1, where the search starts
//! near: mostly one evaluation of the weights finds λ.
//!
//! A product of axes needs nothing else, so this is what a run spends its time on. All points
//! that it does not take are for the general search.

use super::weights::{FEW, Gauss, MOST};
use crate::method::continuum::shape::Factor;
use crate::method::cost::Cost;

/// A step is the last when no p_I changes by more, relative to itself: what third order
/// leaves out is then its fourth power.
const CLOSE: f64 = 1e-5;

/// A larger change than this of any p_I, relative to itself, is for the general search.
const FAR: f64 = 0.5;

/// After so many steps the general search takes over.
const MOST_STEPS: usize = 5;

/// These are the functions of one axis at one place, for the nodes from the lowest on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisFunctions {
    /// N (–) and dN/dx (1/m).
    pub factor: Vec<Factor>,
    gauss: Gauss,
    /// Exponential functions and Newton steps so far.
    pub cost: Cost,
}

/// The point stands at ξ in [0, 1] of its cell, and sees so many nodes from the cell's lower
/// one on down, and from its upper one on up.
#[derive(Clone, Copy)]
pub struct AxisPoint {
    pub xi: f64,
    pub below: usize,
    pub above: usize,
}

// ANCHOR: lme_axis
/// Solves for λ h (–) of one axis from `start`, fills N and dN/dx, and returns λ h and J (–).
/// `None` leaves the point to the general search: where it is on the end of its nodes, sees
/// too far, or starts too far off. `h` is the spacing (m).
///
/// Node 0 is the nearest, and p_a ∝ exp(−γa²) exp(μ)^a with whole a and μ = λ − 2γ ξ_0. The
/// step Δλ solves r + J Δλ + ½ K Δλ² = 0 to its second order (Halley), with K the third
/// moment. Tests: `lme_axis_is_the_general_solution`.
pub fn solve_axis(
    functions: &mut AxisFunctions,
    gamma: f64,
    AxisPoint { xi, below, above }: AxisPoint,
    start: f64,
    h: f64,
) -> Option<(f64, f64)> {
    let AxisFunctions { factor, gauss, cost } = functions;
    // ξ_0, and the nodes beyond node 0 on either side.
    let (xi_0, left, right) = match xi < 0.5 {
        true => (xi, below - 1, above),
        false => (xi - 1.0, below, above - 1),
    };
    let at_end = xi_0 == 0.0 && (left == 0 || right == 0);
    let reach = left.max(right) as f64;
    if at_end || reach > FEW as f64 || gamma * reach * reach >= MOST {
        return None;
    }
    let gauss = gauss.at(gamma, cost);
    let shift = 2.0 * gamma * xi_0;
    let mut mu = start - shift;
    factor.resize(left + 1 + right, Factor::default());
    for _ in 0..MOST_STEPS {
        if mu.is_nan() || mu.abs() * reach >= MOST {
            return None;
        }
        let now = weigh(factor, gauss, left, mu);
        cost.newton_iterations += 1;
        cost.exponentials += 1;
        let r = xi_0 + now.mean;
        let step = -r * now.J / (now.J * now.J - 0.5 * r * now.K);
        let change = step.abs() * (1.0 + reach);
        mu += step;
        if change <= CLOSE {
            let J = tilt(factor, &now, step, r, xi_0 + left as f64, h);
            return Some((mu + shift, J));
        }
        if change.is_nan() || change > FAR {
            return None;
        }
    }
    None
}

/// Moments of the weights: their sum Z, mean, variance J, and third and fourth cumulant.
struct AxisMoments {
    Z: f64,
    mean: f64,
    J: f64,
    K: f64,
    fourth: f64,
}

/// Makes the weights exp(−γa²) exp(μ)^a of the nodes a = left, …, 1, 0, −1, …, and their
/// moments. Node 0 is the nearest, so the mean is a half or so, and nothing cancels.
fn weigh(weight: &mut [Factor], gauss: &[f64], left: usize, mu: f64) -> AxisMoments {
    let (up, mut sums) = (libm::exp(mu), [1.0, 0.0, 0.0, 0.0, 0.0]); // Σ weight aⁿ
    let down = 1.0 / up;
    let (lower, others) = weight.split_at_mut(left);
    let (nearest, upper) = others.split_at_mut(1);
    nearest[0].N = 1.0;
    let (mut up_a, mut down_a, mut a) = (1.0, 1.0, 0.0);
    for ((low, high), gauss) in lower.iter_mut().rev().zip(upper.iter_mut()).zip(&gauss[1..]) {
        (up_a, down_a, a) = (up_a * up, down_a * down, a + 1.0);
        (low.N, high.N) = (gauss * up_a, gauss * down_a);
        add(&mut sums, a, low.N + high.N, low.N - high.N);
    }
    // One side may have more nodes than the other.
    for k in upper.len() + 1..=left {
        (up_a, a) = (up_a * up, a + 1.0);
        let low = gauss[k] * up_a;
        lower[left - k].N = low;
        add(&mut sums, a, low, low);
    }
    for k in left + 1..=upper.len() {
        (down_a, a) = (down_a * down, a + 1.0);
        let high = gauss[k] * down_a;
        upper[k - 1].N = high;
        add(&mut sums, a, high, -high);
    }
    let per_Z = 1.0 / sums[0];
    let [mean, second, third, fourth] = [1, 2, 3, 4].map(|n| sums[n] * per_Z);
    let square = mean * mean;
    let J = second - square;
    let K = third - 3.0 * second * mean + 2.0 * square * mean;
    let central = fourth - 4.0 * third * mean + 6.0 * second * square - 3.0 * square * square;
    AxisMoments { Z: sums[0], mean, J, K, fourth: central - 3.0 * J * J }
}

/// Adds to Σ weight aⁿ what the nodes a and −a have together, and by how much a has more.
#[inline(always)]
fn add(sums: &mut [f64; 5], a: f64, both: f64, more: f64) {
    sums[0] += both;
    sums[1] += more * a;
    sums[2] += both * (a * a);
    sums[3] += more * (a * a * a);
    sums[4] += both * (a * a * a * a);
}

/// Applies the last step Δλ to the weights themselves, as exp(Δλ (a − mean)) to its third
/// order, with Z and J that go with it. Leaves N and (35), dN/dx = −N ξ/(J h); returns J.
/// `xi` is ξ of the first node; that of each next one is less by 1.
fn tilt(factor: &mut [Factor], now: &AxisMoments, step: f64, r: f64, mut xi: f64, h: f64) -> f64 {
    let Z = now.Z * (1.0 + step * step * (0.5 * now.J + step * now.K * (1.0 / 6.0)));
    let J = now.J + step * (now.K + step * 0.5 * now.fourth);
    let (per_Z, per_J) = (1.0 / Z, -1.0 / (J * h));
    for Factor { N, slope } in factor {
        let t = step * (xi - r); // ξ − r = a − mean
        *N *= (1.0 + t * (1.0 + t * (0.5 + t * (1.0 / 6.0)))) * per_Z;
        *slope = *N * xi * per_J;
        xi -= 1.0;
    }
    J
}
// ANCHOR_END: lme_axis
