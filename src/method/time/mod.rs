//! Time integration (§4) is a sequence of steps; each scheme is a function of the number of its
//! step.

pub mod deformation;
pub mod equilibrium;
pub mod euler;
pub mod generalized_alpha;
pub mod implicit_newmark;
pub mod newmark;
pub mod otm;
pub mod quasi_static;
pub mod steps;

use super::breakdown::Breakdown;
use super::choice::{Integrator, Method};
use super::model::{Model, State};

// ANCHOR: advance
/// Prepares what a scheme needs at k = 0: with Newmark's method nodal values, by one time step
/// with Δt = 0, in which nothing moves; with generalized-α the acceleration of loads that act
/// at once, with the implicit Newmark method that of all forces; with OTM the nodes' masses, velocities and forces; with the others nothing.
///
/// `after` sees the state after each step of Newmark's, and after OTM's start as step 0.
pub fn start<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    after: &mut impl FnMut(usize, &State<D>),
) -> Result<(), Breakdown> {
    match model.method {
        Method::Otm(_) => {
            otm::start(state, model)?;
            after(0, state);
        }
        Method::Mpm(integrator) => match integrator {
            Integrator::Newmark(_) => all_steps(state, model, 0.0, 0.0, after)?,
            Integrator::GeneralizedAlpha { .. } if model.loads.is_some() => {
                generalized_alpha::start(state, model)?;
            }
            Integrator::GeneralizedAlpha { .. } => {}
            Integrator::ImplicitNewmark => implicit_newmark::start(state, model)?,
            Integrator::ForwardEuler(_) | Integrator::CorrectedEuler | Integrator::QuasiStatic => {}
        },
    }
    steps::finite(&state.particle)
}

/// Takes one time step, which ends at `t` (s); `after` sees the state after each step of the
/// scheme, with its number.
pub fn advance<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    t: f64,
    after: &mut impl FnMut(usize, &State<D>),
) -> Result<(), Breakdown> {
    state.steps += 1;
    all_steps(state, model, model.dt, t, after)?;
    steps::finite(&state.particle)
}

/// Takes all steps of one time step, from the first to the last.
fn all_steps<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    dt: f64,
    t: f64,
    after: &mut impl FnMut(usize, &State<D>),
) -> Result<(), Breakdown> {
    for n in 1..=step_count(model.method) {
        one_step(n, state, model, dt, t)?;
        after(n, state);
    }
    Ok(())
}

/// Takes step `n` of the model's scheme.
fn one_step<const D: usize>(
    n: usize,
    state: &mut State<D>,
    model: &Model<D>,
    dt: f64,
    t: f64,
) -> Result<(), Breakdown> {
    let loads_at = time_of_loads(model.method, dt, t);
    match model.method {
        Method::Otm(masses) => otm::step(n, state, model, masses, dt, loads_at),
        Method::Mpm(integrator) => match integrator {
            Integrator::Newmark(reading) => newmark::step(n, state, model, reading, dt, loads_at),
            Integrator::ForwardEuler(order) => {
                euler::forward_step(n, state, model, order, dt, loads_at)
            }
            Integrator::CorrectedEuler => euler::corrected_step(n, state, model, dt, loads_at),
            Integrator::GeneralizedAlpha { rho_b } => {
                generalized_alpha::step(n, state, model, rho_b, dt, loads_at)
            }
            Integrator::ImplicitNewmark => implicit_newmark::step(n, state, model, dt, loads_at),
            Integrator::QuasiStatic => quasi_static::step(n, state, model, loads_at),
        },
    }
}
// ANCHOR_END: advance

/// Counts the steps that a time step of a method has.
fn step_count(method: Method) -> usize {
    match method {
        Method::Otm(_) => otm::STEPS,
        Method::Mpm(integrator) => match integrator {
            Integrator::Newmark(_) => newmark::STEPS,
            Integrator::ForwardEuler(_) | Integrator::CorrectedEuler => euler::STEPS,
            Integrator::GeneralizedAlpha { .. } => generalized_alpha::STEPS,
            Integrator::ImplicitNewmark => implicit_newmark::STEPS,
            Integrator::QuasiStatic => quasi_static::STEPS,
        },
    }
}

/// Says when the loads of a time step are taken (s), which ends at `t`: with the forces that the
/// method balances, those of k+1 or of k.
pub fn time_of_loads(method: Method, dt: f64, t: f64) -> f64 {
    if method.needs().balance_at_end { t } else { t - dt }
}
