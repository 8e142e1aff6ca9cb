//! Equilibrium without inertia: the loads grow in steps, and in each the nodal displacements are
//! solved for.
//!
//! Sources: Charlton, Coombs and Augarde, *iGIMP* (2017); Coombs and Augarde, *AMPLE: A Material
//! Point Learning Environment* (2020), from whose column the shipped scene is taken.

use super::equilibrium::balance;
use super::scheme::{MATERIAL, Made, NONE, Scheme, TABLE, TripFactor};
use super::steps::*;
use crate::method::breakdown::Breakdown;
use crate::method::continuum::sums;
use crate::method::model::{Model, State};
use crate::method::reading::Kinematics;
use nalgebra::SVector;

// ANCHOR: quasi_static
/// Takes step `n`, 1 to 5, of the load step that ends at `t` (s), which says how much of the loads
/// acts.
pub fn step<const D: usize>(
    n: usize,
    state: &mut State<D>,
    model: &Model<D>,
    t: f64,
) -> Result<(), Breakdown> {
    if n == 3 {
        state.node.u.fill(SVector::zeros());
        return balance(state, model, 0.0, t);
    }
    let State { particle, node, shape, mass, scratch, .. } = state;
    match n {
        1 => {
            discard(node);
            tabulate(shape, scratch, particle, model)?; // N_Ip of k
        }
        2 => transfer(node, mass, particle, shape)?, // m_I says which nodes take part
        4 => {
            for p in 0..particle.len() {
                particle.advance(p, sums::interpolate(&node.u, shape, p));
            }
        }
        _ => {
            update_material(particle, model)?; // by the G_p of u_I
            particle.lengthen();
        }
    }
    Ok(())
}
// ANCHOR_END: quasi_static

/// This is the march from load to load.
pub struct QuasiStatic;

impl<const D: usize> Scheme<D> for QuasiStatic {
    fn makes(&self, _: Kinematics) -> &'static [Made] {
        &[NONE, TABLE, &["m_I"], NONE, &["x_p"], MATERIAL]
    }

    fn step(
        &self,
        n: usize,
        state: &mut State<D>,
        model: &Model<D>,
        _: f64,
        t: f64,
    ) -> Result<(), Breakdown> {
        step(n, state, model, t)
    }

    fn factor(&self, _: Kinematics) -> TripFactor {
        TripFactor::Unlimited
    }
}
