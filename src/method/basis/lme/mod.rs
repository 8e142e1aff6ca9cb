//! Local maximum-entropy shape functions, (30)-(37), take any set of nodes.
//!
//! [`plain`] solves the equations as the paper has them, and is read first. The other
//! files find the same numbers at any γ and place: `seen` holds the nodes of a point, and how
//! it lies in their hull; `weights` makes p_I at one λ, and their moments; `search` finds λ;
//! `functions` evaluates all p_I and their gradients, and checks their sums; `turned` does the
//! same again along better axes near a slanted side of the hull.
//!
//! Nothing here has a unit: with ξ_I = (x − x_I)/h and λ scaled by h, (31) is
//! p_I ∝ exp(−γ|ξ_I|² + λ·ξ_I), γ = βh². Relative to one node 0 near x, with
//! a_I = (x_0 − x_I)/h, so that ξ_I = ξ_0 + a_I, the exponent is
//!
//! f_I = −γ|a_I|² + μ·a_I + const,   μ = λ − 2γ ξ_0.
//!
//! The place ξ_0 has left the exponent: its rounding cannot be blown up by a
//! large γ, and on a grid all a_I are whole numbers.
//!
//! This does not cover a point on a line of nodes, but on none of them, inside the set,
//! with γ above 700 and no cut-off. The weights beside that line are then too
//! small for a number; the answer is [`Failure::NotConverged`]. With the default
//! cut-off such a point is on the side of its cell, and is served.

mod axis;
mod failure;
mod functions;
pub mod plain;
mod search;
mod seen;
mod turned;
mod weights;

pub use axis::{AxisFunctions, AxisPoint, solve_axis};
pub use failure::Failure;

use super::anisotropic::Metric;
use crate::method::continuum::shape::Shape;
use crate::method::cost::Cost;
use functions::Functions;
use nalgebra::SVector;
use seen::Seen;
use turned::{Turned, solve, solve_turned};
use weights::Weights;

/// Local max-ent at one point works with the nodes that it sees and with buffers, which are
/// kept, so that nothing is allocated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lme<const D: usize> {
    seen: Seen<D>,
    turned: Turned<D>,
    weights: Weights,
    functions: Functions<D>,
}

impl<const D: usize> Lme<D> {
    /// Forgets the nodes of the last point. `on_grid` promises that all offsets
    /// to come are whole numbers.
    pub fn clear(&mut self, on_grid: bool) {
        self.seen.clear(on_grid);
    }

    /// Adds node I to those that the point sees: (x − x_I)/h and, for one node b near x,
    /// (x_b − x_I)/h.
    pub fn push(&mut self, I: usize, xi: SVector<f64, D>, offset: SVector<f64, D>) {
        self.seen.push(I, xi, offset);
    }

    /// Sets the offset of every node I, where b is known only when all of them are.
    pub fn set_offsets(&mut self, offset: impl Fn(usize) -> SVector<f64, D>) {
        for (I, of_I) in self.seen.I.iter().zip(&mut self.seen.offset) {
            *of_I = offset(*I);
        }
    }

    /// Counts the nodes that the point sees.
    pub fn nodes(&self) -> usize {
        self.seen.I.len()
    }

    /// Counts the exponentials and Newton iterations so far.
    pub fn cost(&self) -> Cost {
        self.weights.cost + self.functions.cost
    }
}

// ANCHOR: lme_row
/// Solves local max-ent at the point whose nodes `lme` holds, for γ = βh², and writes N_I
/// (–) and ∇N_I (1/m) of them to the row; returns λ h (–). `h` is the spacing (m).
///
/// `starts` are values of λ h to begin from. The first one near enough is taken, else
/// the best. A point on the hull, or outside by no more than rounding, gets the limit from
/// inside. Where that does not come out right along the given axes, near a slanted side of the
/// hull, axes that follow the weights are tried.
///
/// Errors: [`Failure`], and nothing written: a row is right, or refused. Tests: `tests/hull.rs`.
pub fn max_ent_row<const D: usize>(
    shape: &mut Shape<D>,
    lme: &mut Lme<D>,
    gamma: f64,
    h: &SVector<f64, D>,
    starts: impl IntoIterator<Item = SVector<f64, D>>,
) -> Result<SVector<f64, D>, Failure> {
    let metric = Metric { h, A: None };
    max_ent_row_in(shape, lme, gamma, metric, starts)
}

/// Does the same where the nodes were shown as ξ of this metric.
///
/// Errors: [`Failure`], and nothing written.
pub fn max_ent_row_in<const D: usize>(
    shape: &mut Shape<D>,
    lme: &mut Lme<D>,
    gamma: f64,
    metric: Metric<D>,
    starts: impl IntoIterator<Item = SVector<f64, D>>,
) -> Result<SVector<f64, D>, Failure> {
    let Lme { seen, turned, weights, functions } = lme;
    let lambda = solve(functions, weights, seen, gamma, starts)
        .or_else(|_| solve_turned(turned, functions, weights, seen, gamma))?;
    for ((I, N_I), grad) in seen.I.iter().zip(&functions.p).zip(&functions.grad) {
        shape.push(*I, *N_I, metric.gradient(grad));
    }
    Ok(lambda)
}
// ANCHOR_END: lme_row
