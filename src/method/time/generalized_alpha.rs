//! This is the explicit generalized-α scheme of Hulbert and Chung (1996) for particles,
//! (24)-(26), with the balance and the parameters that the paper leaves out.

use super::scheme::{FORCES, MAPPED, MOVED_WITH_A, Made, STRAINED, Scheme, TABLE, TripFactor};
use super::steps::*;
use crate::method::breakdown::Breakdown;
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::{Nodes, Particles};
use crate::method::continuum::sums;
use crate::method::model::{Model, State};
use crate::method::reading::Kinematics;
use nalgebra::SVector;

// ANCHOR: alpha_parameters
/// The parameters follow from ρ_b, the spectral radius at the bifurcation, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// α_m = (2ρ_b − 1) / (1 + ρ_b).
    pub alpha_m: f64,
    /// β = (5 − 3ρ_b) / ((1 + ρ_b)² (2 − ρ_b)).
    pub beta: f64,
    /// γ = 3/2 − α_m.
    pub gamma: f64,
}

impl Parameters {
    /// Makes them from ρ_b (–).
    pub fn new(rho_b: f64) -> Self {
        let alpha_m = (2.0 * rho_b - 1.0) / (1.0 + rho_b);
        let beta = (5.0 - 3.0 * rho_b) / ((1.0 + rho_b) * (1.0 + rho_b) * (2.0 - rho_b));
        Parameters { alpha_m, beta, gamma: 1.5 - alpha_m }
    }
}
// ANCHOR_END: alpha_parameters

// ANCHOR: generalized_alpha_start
/// Gives a_p at k = 0 under loads: that of the forces at once. Without it the old
/// acceleration of the first step would be 0, and the momentum off by ½ F Δt for
/// ever.
pub fn start<const D: usize>(
    State { particle, node, shape, mass, scratch, .. }: &mut State<D>,
    model: &Model<D>,
) -> Result<(), Breakdown> {
    discard(node);
    tabulate(shape, scratch, particle, model)?;
    transfer(node, mass, particle, shape)?;
    balance_forces(node, particle, shape, model, 0.0);
    accelerate(node, mass);
    for p in 0..particle.len() {
        particle.a[p] = sums::interpolate(&node.a, shape, p);
    }
    Ok(())
}
// ANCHOR_END: generalized_alpha_start

// ANCHOR: generalized_alpha
/// Takes step `n` of the scheme, 1 to 7, in the time step from k to k+1; loads are those of k,
/// at `t` (s).
///
/// a_I^k is the particles' acceleration, mapped like the velocity, and the
/// strain is that of the nodal displacement inside (25).
pub fn step<const D: usize>(
    n: usize,
    State { particle, node, shape, mass, scratch, .. }: &mut State<D>,
    model: &Model<D>,
    rho_b: f64,
    dt: f64,
    t: f64,
) -> Result<(), Breakdown> {
    let parameters = Parameters::new(rho_b);
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
        4 => {
            balance_forces(node, particle, shape, model, t);
            accelerate(node, mass);
        }
        5 => balance_accelerations(node, &parameters), // a_I^{k+1}
        6 => move_particles(particle, node, shape, &parameters, dt), // (24) (25) (26)
        _ => {
            average_velocity(node, &parameters, dt);
            strain_material(particle, node, shape, model, dt)?;
        }
    }
    Ok(())
}

/// Solves (1 − α_m) a_I^{k+1} + α_m a_I^k = a_I for a_I^{k+1}, where a_I is that of the forces.
pub fn balance_accelerations<const D: usize>(node: &mut Nodes<D>, parameters: &Parameters) {
    let alpha_m = parameters.alpha_m;
    for I in 0..node.len() {
        node.a_next[I] = (node.a[I] - node.a_last[I] * alpha_m) / (1.0 - alpha_m);
    }
}

/// Moves the particles: (24) v_p += Δt Σ N_Ip ((1 − γ) a_I^k + γ a_I^{k+1}); (25)
/// x_p += Σ N_Ip (Δt v_I + Δt² ((½ − β) a_I^k + β a_I^{k+1})); (26)
/// a_p = Σ N_Ip a_I^{k+1}.
pub fn move_particles<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    Parameters { beta, gamma, .. }: &Parameters,
    dt: f64,
) {
    for p in 0..particle.len() {
        let (mut v_p, mut u_p, mut a_p) = (SVector::zeros(), SVector::zeros(), SVector::zeros());
        for (I, N_Ip, _) in shape.of(p) {
            let (old, new) = (node.a_last[I], node.a_next[I]);
            v_p += (old * (1.0 - gamma) + new * *gamma) * N_Ip;
            u_p += (node.v[I] * dt + (old * (0.5 - beta) + new * *beta) * (dt * dt)) * N_Ip;
            a_p += new * N_Ip;
        }
        particle.v[p] += v_p * dt;
        particle.advance(p, u_p);
        particle.a[p] = a_p;
    }
}

/// Puts the nodal displacement inside (25), divided by Δt, in place of v_I.
pub fn average_velocity<const D: usize>(node: &mut Nodes<D>, parameters: &Parameters, dt: f64) {
    let beta = parameters.beta;
    for I in 0..node.len() {
        node.v[I] += (node.a_last[I] * (0.5 - beta) + node.a_next[I] * beta) * dt;
    }
}
// ANCHOR_END: generalized_alpha

/// This is the scheme of one ρ_b.
pub struct GeneralizedAlpha {
    pub rho_b: f64,
}

impl<const D: usize> Scheme<D> for GeneralizedAlpha {
    fn makes(&self, _: Kinematics) -> &'static [Made] {
        &[&["a_p"], TABLE, MAPPED, &["a_I", "v_I"], FORCES, &["a_I_next"], MOVED_WITH_A, STRAINED]
    }

    fn start(&self, state: &mut State<D>, model: &Model<D>) -> Result<(), Breakdown> {
        match model.loads {
            Some(_) => start(state, model),
            None => Ok(()),
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
        step(n, state, model, self.rho_b, dt, t)
    }

    fn factor(&self, _: Kinematics) -> TripFactor {
        TripFactor::Alpha { rho_b: self.rho_b }
    }
}
