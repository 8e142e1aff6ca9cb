//! The paper's Algorithm: Newmark's explicit predictor-corrector with γ = ½,
//! β = 0, the central difference (27)-(29).

use super::steps::*;
use crate::continuum::state::State;
use crate::cost::Cost;
use crate::fault::{Breakdown, Moment};
use crate::model::Model;
use crate::reading::StepEight;

// ANCHOR: newmark
/// One time step of the Algorithm: k → k+1, its nine steps in order.
pub fn advance<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    reading: StepEight,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let State { particle, node, shape } = state;
    predict(particle, node, shape, model.dt); //               1, (27) (28)
    nodal_values(state, model, reading, model.dt, moment, cost)?; // 2 to 8
    let State { particle, node, shape } = state;
    correct(particle, node, shape, model.dt); //               9, (29)
    Ok(())
}

/// Steps 2 to 8: all that the nodes know at k+1, from the predicted particles.
fn nodal_values<const D: usize>(
    State { particle, node, shape }: &mut State<D>,
    model: &Model<D>,
    reading: StepEight,
    dt: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    discard(node); //                                          2
    tabulate(shape, particle, model, moment, cost)?; //        N_Ip at k+1
    transfer(node, particle, shape); //                        3, (13)
    impose_essential(node, &model.fixed); //                   4
    increment_strain(particle, node, shape, dt); //            5, (16)
    update_density(particle, moment)?; //                      6, (17)
    update_stress(particle, &model.law); //                    (3)
    balance_forces(node, particle, shape, &model.fixed); //    7, (14) (18)
    integrate_momentum(node, dt, reading); //                  8
    Ok(())
}

/// Nodal values at k = 0: steps 2 to 8 with Δt = 0, so that nothing moves.
pub fn start<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    reading: StepEight,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    nodal_values(state, model, reading, 0.0, Moment::START, cost)
}
// ANCHOR_END: newmark
