//! Lanczos's method finds the largest eigenvalue of the operator, and how much of a given
//! stress belongs to eigenvalues beyond a bound.

use super::operator::{Operator, Stress};
use nalgebra::SMatrix;

/// After so many iterations the method stops in any case.
const MOST_ITERATIONS: usize = 300;

/// A tridiagonal matrix is what the operator becomes on the vectors of Lanczos's method.
pub struct Tridiagonal {
    diagonal: Vec<f64>,
    beside: Vec<f64>,
    /// Its largest eigenvalue (1/s²).
    pub largest: f64,
}

// ANCHOR: lanczos
impl Tridiagonal {
    /// Applies the operator to `start` and to what comes out, until the largest eigenvalue
    /// has grown three times by less than `tolerance` of itself.
    ///
    /// Round-off makes copies of the eigenvalues, but adds none above the largest, so
    /// three vectors are enough.
    pub fn of<const D: usize>(
        operator: &mut Operator<D>,
        start: Stress<D>,
        tolerance: f64,
    ) -> Tridiagonal {
        let count = start.len();
        let mut y = start;
        let mut before: Stress<D> = vec![SMatrix::zeros(); count];
        let mut found = Tridiagonal { diagonal: Vec::new(), beside: Vec::new(), largest: 0.0 };
        let mut settled = 0;
        for iteration in 0..MOST_ITERATIONS {
            let size = libm::sqrt(dot(&y, &y));
            if iteration > 0 {
                if size <= 1e-10 * found.largest {
                    break; // the space that the start spans is used up
                }
                found.beside.push(size);
            }
            for y in &mut y {
                *y /= size;
            }
            let mut next = operator.apply(&y);
            let alpha = dot(&next, &y);
            let beta = found.beside.last().copied().unwrap_or(0.0);
            for p in 0..count {
                next[p] -= y[p] * alpha + before[p] * beta;
            }
            found.diagonal.push(alpha);
            before = std::mem::replace(&mut y, next);
            let largest = found.eigenvalue(0);
            settled = if largest - found.largest <= tolerance * largest { settled + 1 } else { 0 };
            found.largest = largest;
            if settled >= 3 {
                break;
            }
        }
        found
    }

    /// Gives the share of the start's square that belongs to eigenvalues above `bound`, by
    /// the weights of Gauss's quadrature: an eigenvalue θ has 1 / Σ_k p_k(θ)² with the
    /// polynomials p_0 = 1, β_k+1 p_k+1 = (θ − α_k) p_k − β_k p_k−1.
    pub fn share_above(&self, bound: f64) -> f64 {
        (0..self.count_above(bound)).map(|k| 1.0 / self.square_sum(self.eigenvalue(k))).sum()
    }

    /// Gives Σ_k p_k(θ)².
    fn square_sum(&self, theta: f64) -> f64 {
        let (mut before, mut now, mut sum) = (0.0, 1.0, 1.0);
        for (k, beta) in self.beside.iter().enumerate() {
            let last = if k > 0 { self.beside[k - 1] } else { 0.0 };
            let next = ((theta - self.diagonal[k]) * now - last * before) / beta;
            (before, now) = (now, next);
            sum += now * now;
        }
        sum
    }

    /// Counts the eigenvalues that are not below x: the pivots that are not negative (Sturm).
    fn count_above(&self, x: f64) -> usize {
        let (mut count, mut pivot) = (0, self.diagonal[0] - x);
        for k in 1..=self.diagonal.len() {
            if pivot >= 0.0 {
                count += 1;
            }
            if k < self.diagonal.len() {
                pivot = self.diagonal[k] - x - self.beside[k - 1] * self.beside[k - 1] / pivot;
            }
        }
        count
    }

    /// Finds eigenvalue k, 0 for the largest, by bisection on their number.
    fn eigenvalue(&self, k: usize) -> f64 {
        let reach = |n: usize| {
            let left = if n > 0 { self.beside[n - 1] } else { 0.0 };
            let right = self.beside.get(n).copied().unwrap_or(0.0);
            self.diagonal[n] + left.abs() + right.abs()
        };
        let mut high = (0..self.diagonal.len()).map(reach).fold(f64::NEG_INFINITY, f64::max);
        let mut low = match k {
            0 => self.diagonal.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            _ => -high.abs(), // no eigenvalue of the operator is negative but by round-off
        };
        while high - low > 1e-13 * high.abs() {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.count_above(middle) <= k { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }
}
// ANCHOR_END: lanczos

/// Gives the product of two stresses (J).
pub fn dot<const D: usize>(a: &Stress<D>, b: &Stress<D>) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
