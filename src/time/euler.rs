//! Forward Euler, (20)-(21), with its three orders of the stress update, and
//! the corrected form, (22)-(23).
//!
//! The nodal momentum is advanced first, and the particles move with the
//! advanced one. (With the old momentum, as (21) is printed, no step is
//! stable.) Then (20)-(21) and (22)-(23) are the same sums; they differ in what
//! is divided by m_I. The corrected form divides N_Ip, which no tiny mass can
//! blow up, and takes the strain from the momentum of the particles, mapped
//! anew.
#![allow(non_snake_case)]

use super::steps::*;
use crate::continuum::state::State;
use crate::cost::Cost;
use crate::fault::{Breakdown, Moment};
use crate::model::Model;
use crate::reading::StressUpdate;

// ANCHOR: forward_euler
/// One time step of forward Euler, k → k+1.
pub fn forward<const D: usize>(
    State { particle, node, shape, mass, scratch }: &mut State<D>,
    model: &Model<D>,
    order: StressUpdate,
    dt: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let fixed = &model.fixed;
    discard(node);
    tabulate(shape, scratch, particle, model, moment, cost)?; // N_Ip of k
    transfer(node, mass, particle, shape, moment, cost)?;
    impose_essential(node, mass, fixed, cost);
    if order == StressUpdate::First {
        update_material(particle, node, shape, model, dt, moment)?;
    }
    balance_forces(node, mass, particle, shape, model, moment.time - dt, cost);
    advance_momentum(node, dt);
    move_with_nodes(particle, node, shape, dt); // (20) (21)
    if order == StressUpdate::ModifiedLast {
        map_momentum_anew(node, particle, shape);
        impose_essential(node, mass, fixed, cost);
    }
    if order != StressUpdate::First {
        update_material(particle, node, shape, model, dt, moment)?;
    }
    Ok(())
}
// ANCHOR_END: forward_euler

// ANCHOR: corrected_euler
/// One time step of the corrected form, k → k+1.
pub fn corrected<const D: usize>(
    State { particle, node, shape, mass, scratch }: &mut State<D>,
    model: &Model<D>,
    dt: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let fixed = &model.fixed;
    discard(node);
    tabulate(shape, scratch, particle, model, moment, cost)?; // N_Ip of k
    transfer(node, mass, particle, shape, moment, cost)?;
    impose_essential(node, mass, fixed, cost);
    balance_forces(node, mass, particle, shape, model, moment.time - dt, cost);
    advance_momentum(node, dt);
    move_with_shares(particle, node, shape, dt); // (22) (23)
    map_momentum_anew(node, particle, shape);
    impose_essential(node, mass, fixed, cost);
    update_material(particle, node, shape, model, dt, moment)
}
// ANCHOR_END: corrected_euler
