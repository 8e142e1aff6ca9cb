//! The paper's Algorithm: Newmark's explicit predictor-corrector with γ = ½,
//! β = 0, the central difference (27)-(29).

use super::steps::*;
use crate::continuum::state::State;
use crate::cost::Cost;
use crate::fault::{Breakdown, Moment};
use crate::model::Model;
use crate::reading::StepEight;

// ANCHOR: newmark
/// One time step of the Algorithm, k → k+1: its nine steps in order.
///
/// With Δt = 0 and blank nodes it moves nothing and gives the nodal values of
/// k = 0, which the first predictor needs.
pub fn step<const D: usize>(
    State { particle, node, shape, mass, scratch }: &mut State<D>,
    model: &Model<D>,
    reading: StepEight,
    dt: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let (law, fixed, t) = (&model.law, &model.fixed, moment.time);
    predict(particle, node, shape, dt); // 1: (27) (28)
    discard(node); // 2
    tabulate(shape, scratch, particle, model, moment, cost)?;
    transfer(node, mass, particle, shape, moment, cost)?; // 3: (13)
    impose_essential(node, mass, fixed, cost); // 4
    increment_strain(particle, node, shape, dt); // 5: (16)
    update_density(particle, moment)?; // 6: (17)
    update_stress(particle, law); // (3)
    balance_forces(node, mass, particle, shape, model, t, cost); // 7: (14) (15) (18)
    integrate_momentum(node, dt, reading); // 8
    correct(particle, node, shape, dt); // 9: (29)
    Ok(())
}
// ANCHOR_END: newmark
