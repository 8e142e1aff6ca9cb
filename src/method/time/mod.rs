//! Time integration (§4) is a sequence of steps; each scheme is a function of the number of its
//! step, in a file of its own, and one line of [`scheme()`].

pub mod deformation;
pub mod equilibrium;
pub mod euler;
pub mod generalized_alpha;
pub mod implicit_newmark;
pub mod newmark;
pub mod otm;
pub mod quasi_static;
pub mod scheme;
pub mod steps;

use super::breakdown::Breakdown;
use super::choice::{Integrator, Method};
use super::model::{Model, State};
use euler::{CorrectedEuler, ForwardEuler};
use generalized_alpha::GeneralizedAlpha;
use implicit_newmark::ImplicitNewmark;
use newmark::Newmark;
use otm::Otm;
use quasi_static::QuasiStatic;
use scheme::Scheme;

// ANCHOR: schemes
/// Gives the scheme of a method.
pub fn scheme<const D: usize>(method: Method) -> Box<dyn Scheme<D>> {
    match method {
        Method::Otm(masses) => Box::new(Otm(masses)),
        Method::Mpm(integrator) => match integrator {
            Integrator::Newmark(reading) => Box::new(Newmark(reading)),
            Integrator::ForwardEuler(order) => Box::new(ForwardEuler(order)),
            Integrator::CorrectedEuler => Box::new(CorrectedEuler),
            Integrator::GeneralizedAlpha { rho_b } => Box::new(GeneralizedAlpha { rho_b }),
            Integrator::ImplicitNewmark => Box::new(ImplicitNewmark),
            Integrator::QuasiStatic => Box::new(QuasiStatic),
        },
    }
}
// ANCHOR_END: schemes

// ANCHOR: advance
/// Prepares what a scheme needs at k = 0: with Newmark's method nodal values, by one time step
/// with Δt = 0, in which nothing moves; with generalized-α the acceleration of loads that act
/// at once, with the implicit Newmark method that of all forces; with OTM the nodes' masses, velocities and forces; with the others nothing.
///
/// `after` sees the state after each step of Newmark's, and after any other start as step 0.
pub fn start<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    after: &mut impl FnMut(usize, &State<D>),
) -> Result<(), Breakdown> {
    let scheme = scheme::<D>(model.method);
    if scheme.starts_with_all_steps() {
        all_steps(&*scheme, state, model, [0.0, 0.0], after)?;
    } else {
        scheme.start(state, model)?;
        after(0, state);
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
    all_steps(&*scheme::<D>(model.method), state, model, [model.dt, t], after)?;
    steps::finite(&state.particle)
}

/// Takes all steps of one time step, from the first to the last.
fn all_steps<const D: usize>(
    scheme: &dyn Scheme<D>,
    state: &mut State<D>,
    model: &Model<D>,
    [dt, t]: [f64; 2],
    after: &mut impl FnMut(usize, &State<D>),
) -> Result<(), Breakdown> {
    let loads_at = time_of_loads(model.method, dt, t);
    for n in 1..scheme.makes(model.kinematics).len() {
        scheme.step(n, state, model, dt, loads_at)?;
        after(n, state);
    }
    Ok(())
}
// ANCHOR_END: advance

/// Says when the loads of a time step are taken (s), which ends at `t`: with the forces that the
/// method balances, those of k+1 or of k.
pub fn time_of_loads(method: Method, dt: f64, t: f64) -> f64 {
    if method.needs().balance_at_end { t } else { t - dt }
}
