//! Time integration (§4): the nine steps, and the schemes that order them.

pub mod newmark;
pub mod steps;

use crate::cost::Cost;
use crate::continuum::state::State;
use crate::fault::{Breakdown, Moment};
use crate::model::Model;
use crate::reading::StepEight;

/// The scheme that carries a scene through time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// The paper's explicit predictor-corrector, (27)-(29).
    Newmark(StepEight),
}

/// Nodal values at k = 0, which the first predictor needs.
pub fn start<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    match model.integrator {
        Integrator::Newmark(reading) => newmark::start(state, model, reading, cost),
    }
}

/// One time step, from k to `moment`.
pub fn advance<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    match model.integrator {
        Integrator::Newmark(reading) => newmark::advance(state, model, reading, moment, cost),
    }?;
    cost.steps += 1;
    steps::finite(&state.particle, moment)
}
