//! Time integration (§4): the nine steps, and the schemes that order them.

pub mod euler;
pub mod generalized_alpha;
pub mod newmark;
pub mod steps;

use crate::continuum::state::State;
use crate::cost::Cost;
use crate::fault::{Breakdown, Moment};
use crate::model::Model;
use crate::otm;
use crate::reading::{StepEight, StressUpdate};
use crate::scene::Method;

/// The scheme that carries a scene through time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// The paper's explicit predictor-corrector, (27)-(29).
    Newmark(StepEight),
    /// Forward Euler, (20)-(21).
    ForwardEuler(StressUpdate),
    /// Its corrected form, (22)-(23).
    CorrectedEuler,
    /// Explicit generalized-α, (24)-(26).
    GeneralizedAlpha {
        /// ρ_b, the spectral radius at the bifurcation, 0 to 1.
        rho_b: f64,
    },
}

/// What a scheme needs at k = 0: with Newmark nodal values, by one time step with
/// Δt = 0, in which nothing moves; with generalized-α the acceleration of loads
/// that act at once; with the others nothing.
pub fn start<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    match model.method {
        Method::Otm => otm::start(state, model, cost),
        Method::Mpm(Integrator::Newmark(_)) => step(state, model, 0.0, Moment::START, cost),
        Method::Mpm(Integrator::GeneralizedAlpha { .. }) if model.loads.is_some() => {
            generalized_alpha::start(state, model, cost)
        }
        Method::Mpm(_) => steps::finite(&state.particle, Moment::START),
    }
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
    match model.method {
        Method::Otm => otm::step(state, model, dt, moment, cost),
        Method::Mpm(integrator) => match integrator {
            Integrator::Newmark(reading) => newmark::step(state, model, reading, dt, moment, cost),
            Integrator::ForwardEuler(order) => {
                euler::forward(state, model, order, dt, moment, cost)
            }
            Integrator::CorrectedEuler => euler::corrected(state, model, dt, moment, cost),
            Integrator::GeneralizedAlpha { rho_b } => {
                generalized_alpha::step(state, model, rho_b, dt, moment, cost)
            }
        },
    }?;
    steps::finite(&state.particle, moment)
}
