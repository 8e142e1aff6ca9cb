//! Time integration (§4): the nine steps, and the schemes that order them.

pub mod newmark;
pub mod steps;

use crate::continuum::state::State;
use crate::cost::Cost;
use crate::fault::{Breakdown, Moment};
use crate::model::Model;
use crate::reading::StepEight;

/// The scheme that carries a scene through time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// The paper's explicit predictor-corrector, (27)-(29).
    Newmark(StepEight),
}

/// Nodal values at k = 0: one time step with Δt = 0, in which nothing moves.
pub fn start<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    step(state, model, 0.0, Moment::START, cost)
}

/// One time step, from k to `moment`.
///
/// Errors: [`Breakdown`] with particle, step and time.
pub fn advance<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    cost.steps += 1;
    step(state, model, model.dt, moment, cost)
}

fn step<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    dt: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    match model.integrator {
        Integrator::Newmark(reading) => newmark::step(state, model, reading, dt, moment, cost),
    }?;
    steps::finite(&state.particle, moment)
}
