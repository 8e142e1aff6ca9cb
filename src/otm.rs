//! The optimal transportation meshfree method (§6.2; Li, Habbal and Ortiz 2010).
//!
//! The nodes are the body's own: they carry mass and velocity, and they move. The
//! particles are points of quadrature, with volume, deformation and stress. In
//! between stand local max-ent functions on the moving nodes, tabulated anew in
//! every step. Time goes by central differences, as in [`crate::time::newmark`].
#![allow(non_snake_case)]

use crate::basis::scattered;
use crate::continuum::law;
use crate::continuum::shape::Shape;
use crate::continuum::state::{Nodes, Particles, State};
use crate::continuum::sums;
use crate::cost::Cost;
use crate::fault::{Breakdown, Moment};
use crate::model::Model;
use crate::time::steps::balance_forces;
use nalgebra::SVector;

// ANCHOR: otm_start
/// k = 0: m_a = Σ_p m_p N_ap, once and for all, and v_a = Σ_p m_p v_p N_ap / m_a.
///
/// Since the nodal mass stays, so does the momentum, to round-off.
pub fn start<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let nothing = vec![SVector::zeros(); state.node.x.len()];
    state.node.m = vec![0.0; nothing.len()];
    for list in [&mut state.node.p, &mut state.node.v, &mut state.node.f] {
        list.clone_from(&nothing);
    }
    tabulate(state, model, Moment::START, cost)?;
    let State { particle, node, shape, mass, .. } = state;
    sums::lumped_mass(node, particle, shape);
    sums::momentum(node, particle, shape);
    for &(a, i) in &model.fixed {
        node.p[a][i] = 0.0;
    }
    for a in 0..node.len() {
        node.v[a] = node.p[a] / node.m[a];
    }
    balance_forces(node, mass, particle, shape, model, 0.0, cost);
    show_velocity(particle, node, shape);
    Ok(())
}
// ANCHOR_END: otm_start

// ANCHOR: otm
/// One time step of OTM, k → k+1: its seven steps in order.
pub fn step<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    dt: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let State { particle, node, shape, .. } = state;
    kick(node, 0.5 * dt); // 1
    move_nodes(node, dt); // 2
    move_particles(particle, node, shape, dt); // 3: N_ap of k
    deform(particle, node, shape, model, dt, moment)?; // 4: N_ap of k
    tabulate(state, model, moment, cost)?; // 5: N_ap at k+1
    let State { particle, node, shape, mass, .. } = state;
    node.f.fill(SVector::zeros());
    balance_forces(node, mass, particle, shape, model, moment.time, cost); // 6
    kick(node, 0.5 * dt); // 7
    show_velocity(particle, node, shape);
    Ok(())
}
// ANCHOR_END: otm

// ANCHOR: otm_steps
/// Steps 1 and 7: v_a += ½ Δt f_a / m_a.
pub fn kick<const D: usize>(node: &mut Nodes<D>, dt: f64) {
    for a in 0..node.len() {
        node.v[a] += node.f[a] * (dt / node.m[a]);
    }
}

/// Step 2: x_a += Δt v_a.
pub fn move_nodes<const D: usize>(node: &mut Nodes<D>, dt: f64) {
    for a in 0..node.len() {
        node.x[a] += node.v[a] * dt;
    }
}

/// Step 3: x_p += Δt Σ_a v_a N_ap.
pub fn move_particles<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        particle.x[p] += sums::interpolate(&node.v, shape, p) * dt;
    }
}

/// Step 4: with G = Σ_a Δt v_a ⊗ ∇N_ap and f = 1 + G: F ← f F, ρ ← ρ / det f, and
/// σ += D : Δε with Δε = sym(G (1 + G/2)⁻¹).
///
/// Errors: [`Breakdown::Inverted`] when det f ≤ 0; [`Breakdown::NotFinite`].
pub fn deform<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    model: &Model<D>,
    dt: f64,
    moment: Moment,
) -> Result<(), Breakdown> {
    for p in 0..particle.len() {
        let G = sums::velocity_gradient(node, shape, p) * dt;
        let (f, J) = law::increment(&G);
        if !J.is_finite() {
            return Err(Breakdown::NotFinite { particle: p, moment, symbol: "strain" });
        }
        let d_eps = law::midpoint_strain(&G).filter(|_| J > 0.0);
        let inverted = Breakdown::Inverted { particle: p, moment, strain: J - 1.0 };
        particle.d_eps[p] = d_eps.ok_or(inverted)?;
        particle.F[p] = f * particle.F[p];
        particle.rho[p] /= J;
        particle.sigma[p] += model.law.stress_increment(&particle.d_eps[p]);
    }
    Ok(())
}

/// v_p = Σ_a v_a N_ap, for what is recorded; nothing is computed from it.
pub fn show_velocity<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
) {
    for p in 0..particle.len() {
        particle.v[p] = sums::interpolate(&node.v, shape, p);
    }
}
// ANCHOR_END: otm_steps

/// Step 5: N_ap and ∇N_ap on the nodes where they stand now.
pub fn tabulate<const D: usize>(
    State { particle, node, shape, scratch, .. }: &mut State<D>,
    model: &Model<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let (basis, h) = (&model.basis, &model.grid.h);
    scattered::tabulate(shape, scratch, cost, basis, h, &node.x, &particle.x).map_err(
        |(p, failure)| match particle.x[p].iter().all(|x| x.is_finite()) {
            true => Breakdown::NoBasis { particle: p, moment, failure },
            false => Breakdown::NotFinite { particle: p, moment, symbol: "position" },
        },
    )
}
