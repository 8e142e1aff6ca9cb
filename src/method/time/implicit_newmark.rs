//! Newmark's method with β = 1/4 and γ = 1/2 for particles, the trapezoidal rule: the forces of
//! k+1 balance, and the nodal displacements are solved for.
//!
//! Sources: Newmark (1959); Guilkey and Weiss (2003) took it to the material point method.

use super::equilibrium::balance;
use super::generalized_alpha;
use super::scheme::{MAPPED, MATERIAL, MOVED_WITH_A, Made, NONE, Scheme, TABLE, TripFactor};
use super::steps::*;
use crate::method::breakdown::Breakdown;
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::{Nodes, Particles};
use crate::method::continuum::sums;
use crate::method::model::{Model, State};
use crate::method::reading::Kinematics;

// ANCHOR: implicit_newmark
/// Takes step `n` of the scheme, 1 to 6, in the time step from k to k+1 that ends at `t` (s).
pub fn step<const D: usize>(
    n: usize,
    state: &mut State<D>,
    model: &Model<D>,
    dt: f64,
    t: f64,
) -> Result<(), Breakdown> {
    let per_u = 4.0 / (dt * dt);
    if n == 4 {
        predict_displacement(&mut state.node, dt);
        return balance(state, model, per_u, t); // u_I and a_I of k+1
    }
    let State { particle, node, shape, mass, scratch, .. } = state;
    match n {
        1 => {
            discard(node);
            tabulate(shape, scratch, particle, model)?; // N_Ip of k
        }
        2 => transfer(node, mass, particle, shape)?,
        3 => {
            map_acceleration(node, mass, particle, shape, &model.fixed); // a_I^k
            impose_essential(node, mass, &model.fixed);
        }
        5 => move_particles(particle, node, shape, dt),
        _ => {
            update_material(particle, model)?; // by the G_p of u_I
            particle.lengthen();
        }
    }
    Ok(())
}

/// Starts the search at u_I = Δt v_I + ½ Δt² a_I^k (m), where a_I^{k+1} is a_I^k: the
/// scheme's u_I is Δt v_I + ¼ Δt² (a_I^k + a_I^{k+1}), so a_I^{k+1} grows by 4/Δt² of what u_I
/// does.
pub fn predict_displacement<const D: usize>(node: &mut Nodes<D>, dt: f64) {
    for I in 0..node.len() {
        node.u[I] = node.v[I] * dt + node.a_last[I] * (0.5 * dt * dt);
        node.a[I] = node.a_last[I];
    }
}

/// Moves the particles: x_p += Σ N_Ip u_I, v_p += ½ Δt Σ N_Ip (a_I^k + a_I^{k+1}), and
/// a_p = Σ N_Ip a_I^{k+1}.
pub fn move_particles<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        let [u_p, last, next] =
            [&node.u, &node.a_last, &node.a].map(|q| sums::interpolate(q, shape, p));
        particle.advance(p, u_p);
        particle.v[p] += (last + next) * (0.5 * dt);
        particle.a[p] = next;
    }
}
// ANCHOR_END: implicit_newmark

/// This is the scheme.
pub struct ImplicitNewmark;

impl<const D: usize> Scheme<D> for ImplicitNewmark {
    fn makes(&self, _: Kinematics) -> &'static [Made] {
        &[&["a_p"], TABLE, MAPPED, &["a_I", "v_I"], NONE, MOVED_WITH_A, MATERIAL]
    }

    fn start(&self, state: &mut State<D>, model: &Model<D>) -> Result<(), Breakdown> {
        generalized_alpha::start(state, model)
    }

    fn step(
        &self,
        n: usize,
        state: &mut State<D>,
        model: &Model<D>,
        dt: f64,
        t: f64,
    ) -> Result<(), Breakdown> {
        step(n, state, model, dt, t)
    }

    fn factor(&self, _: Kinematics) -> TripFactor {
        TripFactor::Unlimited
    }
}
