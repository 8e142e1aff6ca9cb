//! Forward Euler, (20)-(21), has three orders of the stress update, and a corrected form,
//! (22)-(23).
//!
//! The nodal momentum is advanced first, and the particles move with the
//! advanced one; as (21) is printed they would move with the old. Then (20)-(21) and (22)-(23) are the same sums. The corrected form
//! takes the strain from the momentum of the particles, mapped anew.

use super::scheme::{
    ADVANCED, FORCES, MAPPED, MATERIAL, MOVED, Made, NONE, STRAINED, Scheme, TABLE, TripFactor,
};
use super::steps::*;
use crate::method::breakdown::Breakdown;
use crate::method::model::{Model, State};
use crate::method::reading::{Kinematics, StressUpdate};

// ANCHOR: forward_euler
/// Takes step `n` of forward Euler, 1 to 7, in the time step from k to k+1; loads are those of
/// k, at `t` (s).
pub fn forward_step<const D: usize>(
    n: usize,
    State { particle, node, shape, mass, scratch, .. }: &mut State<D>,
    model: &Model<D>,
    order: StressUpdate,
    dt: f64,
    t: f64,
) -> Result<(), Breakdown> {
    let order = match model.kinematics {
        Kinematics::AsPrinted => order,
        Kinematics::Consistent => StressUpdate::Last, // the velocity that moves the particles
    };
    match n {
        1 => {
            discard(node);
            tabulate(shape, scratch, particle, model)?; // N_Ip of k
        }
        2 => transfer(node, mass, particle, shape)?,
        3 => {
            impose_essential(node, mass, &model.fixed);
            if order == StressUpdate::First {
                strain_material(particle, node, shape, model, dt)?;
            }
        }
        4 => {
            balance_forces(node, particle, shape, model, t);
            accelerate(node, mass);
        }
        5 => advance_momentum(node, dt),
        6 => move_with_nodes(particle, node, shape, dt), // (20) (21)
        _ => {
            if order == StressUpdate::ModifiedLast {
                map_momentum_anew(node, particle, shape);
                impose_essential(node, mass, &model.fixed);
            }
            if order != StressUpdate::First {
                strain_material(particle, node, shape, model, dt)?;
            }
        }
    }
    Ok(())
}
// ANCHOR_END: forward_euler

// ANCHOR: corrected_euler
/// Takes step `n` of the corrected form, 1 to 7, in the time step from k to k+1; loads are those
/// of k, at `t` (s).
pub fn corrected_step<const D: usize>(
    n: usize,
    State { particle, node, shape, mass, scratch, .. }: &mut State<D>,
    model: &Model<D>,
    dt: f64,
    t: f64,
) -> Result<(), Breakdown> {
    match n {
        1 => {
            discard(node);
            tabulate(shape, scratch, particle, model)?; // N_Ip of k
        }
        2 => transfer(node, mass, particle, shape)?,
        3 => impose_essential(node, mass, &model.fixed),
        4 => {
            balance_forces(node, particle, shape, model, t);
            accelerate(node, mass);
        }
        5 => advance_momentum(node, dt),
        6 => move_with_nodes(particle, node, shape, dt), // (22) (23)
        _ => {
            if model.kinematics == Kinematics::AsPrinted {
                map_momentum_anew(node, particle, shape);
                impose_essential(node, mass, &model.fixed);
            }
            strain_material(particle, node, shape, model, dt)?;
        }
    }
    Ok(())
}
// ANCHOR_END: corrected_euler

const STRAINED_LAST: &[Made] = &[NONE, TABLE, MAPPED, &["v_I"], FORCES, ADVANCED, MOVED, MATERIAL];
const STRAINED_BY_MAP: &[Made] =
    &[NONE, TABLE, MAPPED, &["v_I"], FORCES, ADVANCED, MOVED, STRAINED];

/// This is forward Euler, with one of three orders.
pub struct ForwardEuler(pub StressUpdate);

impl<const D: usize> Scheme<D> for ForwardEuler {
    fn makes(&self, kinematics: Kinematics) -> &'static [Made] {
        match (kinematics, self.0) {
            (Kinematics::Consistent, _) | (_, StressUpdate::Last) => STRAINED_LAST,
            (_, StressUpdate::First) => {
                &[NONE, TABLE, MAPPED, STRAINED, FORCES, ADVANCED, MOVED, NONE]
            }
            (_, StressUpdate::ModifiedLast) => STRAINED_BY_MAP,
        }
    }

    fn step(
        &self,
        n: usize,
        state: &mut State<D>,
        model: &Model<D>,
        dt: f64,
        t: f64,
    ) -> Result<(), Breakdown> {
        forward_step(n, state, model, self.0, dt, t)
    }

    fn factor(&self, kinematics: Kinematics) -> TripFactor {
        match self.0 {
            StressUpdate::Last => TripFactor::Last,
            StressUpdate::First | StressUpdate::ModifiedLast => TripFactor::of_strain(kinematics),
        }
    }
}

/// This is its corrected form.
pub struct CorrectedEuler;

impl<const D: usize> Scheme<D> for CorrectedEuler {
    fn makes(&self, kinematics: Kinematics) -> &'static [Made] {
        match kinematics {
            Kinematics::AsPrinted => STRAINED_BY_MAP,
            Kinematics::Consistent => STRAINED_LAST,
        }
    }

    fn step(
        &self,
        n: usize,
        state: &mut State<D>,
        model: &Model<D>,
        dt: f64,
        t: f64,
    ) -> Result<(), Breakdown> {
        corrected_step(n, state, model, dt, t)
    }

    fn factor(&self, kinematics: Kinematics) -> TripFactor {
        TripFactor::of_strain(kinematics)
    }
}
