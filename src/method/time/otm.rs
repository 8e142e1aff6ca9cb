//! This is the optimal transportation meshfree method (§6.2; Li, Habbal and Ortiz 2010).
//!
//! The nodes are the body's own: they carry mass and velocity, and they move. The
//! particles are points of quadrature, with volume, deformation and stress. In
//! between stand local max-ent functions on the moving nodes, tabulated anew in
//! every step. Time goes by central differences, as in [`crate::method::time::newmark`].

use super::deformation::deform;
use super::scheme::{FORCES, MATERIAL, Made, Scheme, TABLE, TripFactor};
use super::steps::balance_forces;
use crate::method::basis::scattered;
use crate::method::breakdown::Breakdown;
use crate::method::continuum::law;
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::{Nodes, Particles};
use crate::method::continuum::sums;
use crate::method::model::{Model, State};
use crate::method::reading::{Kinematics, NodalMass};
use nalgebra::SVector;

// ANCHOR: otm_start
/// Fills the nodes at k = 0: m_a = Σ_p m_p N_ap and v_a = Σ_p m_p v_p N_ap / m_a.
///
/// Where the nodal mass stays what it is here, so does the momentum, to round-off.
pub fn start<const D: usize>(state: &mut State<D>, model: &Model<D>) -> Result<(), Breakdown> {
    tabulate_again(state, model)?;
    let State { particle, node, shape, .. } = state;
    sums::mass_and_momentum(node, particle, shape);
    for &(a, i) in &model.fixed {
        node.p[a][i] = 0.0;
    }
    for a in 0..node.len() {
        node.v[a] = node.p[a] / node.m[a];
    }
    balance_forces(node, particle, shape, model, 0.0);
    show_velocity(particle, node, shape);
    Ok(())
}
// ANCHOR_END: otm_start

// ANCHOR: otm
/// Takes step `n` of OTM, 1 to 7, in the time step from k to k+1 that ends at `t` (s).
pub fn step<const D: usize>(
    n: usize,
    state: &mut State<D>,
    model: &Model<D>,
    masses: NodalMass,
    dt: f64,
    t: f64,
) -> Result<(), Breakdown> {
    let State { particle, node, shape, .. } = state;
    match n {
        1 => kick(node, 0.5 * dt),
        2 => move_nodes(node, dt),
        3 => move_particles(particle, node, shape, dt), // N_ap of k
        4 => deform_particles(particle, node, shape, model, dt)?, // N_ap of k
        5 => {
            tabulate_again(state, model)?; // N_ap at k+1
            if masses != NodalMass::Kept {
                renew_masses(state, masses)?;
            }
        }
        6 => {
            node.f.fill(SVector::zeros());
            balance_forces(node, particle, shape, model, t);
        }
        _ => {
            kick(node, 0.5 * dt);
            show_velocity(particle, node, shape);
        }
    }
    Ok(())
}
// ANCHOR_END: otm

// ANCHOR: otm_steps
/// Steps 1 and 7 kick the nodes: v_a += ½ Δt f_a / m_a.
pub fn kick<const D: usize>(node: &mut Nodes<D>, dt: f64) {
    for a in 0..node.len() {
        node.v[a] += node.f[a] * (dt / node.m[a]);
    }
}

/// Step 2 moves the nodes: x_a += Δt v_a.
pub fn move_nodes<const D: usize>(node: &mut Nodes<D>, dt: f64) {
    for a in 0..node.len() {
        node.x[a] += node.v[a] * dt;
    }
}

/// Step 3 moves the particles: x_p += Δt Σ_a v_a N_ap.
pub fn move_particles<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        particle.advance(p, sums::interpolate(&node.v, shape, p) * dt);
    }
}

/// Step 4 deforms them by f = 1 + G with G = Σ_a Δt v_a ⊗ ∇N_ap, the gradient of that move:
/// [`deform`].
///
/// Errors: [`Breakdown::Inverted`] when det f ≤ 0; [`Breakdown::NotFinite`].
pub fn deform_particles<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    model: &Model<D>,
    dt: f64,
) -> Result<(), Breakdown> {
    for p in 0..particle.len() {
        particle.G[p] = sums::velocity_gradient(node, shape, p) * dt;
    }
    deform(particle, &model.law)?;
    update_metric(particle)
}

/// Takes the metric along: A_p ← A_p f⁻¹, and so B_p ← f⁻ᵀ B_p f⁻¹, where it is to go with the
/// material. Elsewhere there is nothing to take.
///
/// Errors: [`Breakdown::Inverted`] if f has no inverse.
pub fn update_metric<const D: usize>(particle: &mut Particles<D>) -> Result<(), Breakdown> {
    for (p, (A_p, G_p)) in particle.pull.iter_mut().zip(&particle.G).enumerate() {
        let (f, J) = law::increment(G_p);
        let inverse = f.try_inverse();
        *A_p *= inverse.ok_or(Breakdown::Inverted { particle: p, strain: J - 1.0 })?;
    }
    Ok(())
}

/// Shows v_p = Σ_a v_a N_ap for what is recorded; nothing is computed from it.
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

/// Step 5 tabulates N_ap and ∇N_ap on the nodes where they stand now.
pub fn tabulate_again<const D: usize>(
    State { particle, node, shape, scratch, .. }: &mut State<D>,
    model: &Model<D>,
) -> Result<(), Breakdown> {
    let Particles { x, lambda, pull, .. } = particle;
    let nodes = scattered::Places { x: &node.x, h: &model.grid.h };
    let carried = scattered::Carried { x, pull };
    scattered::fill_in_metric(shape, scratch, lambda, &model.basis, nodes, carried)
}

// ANCHOR: renew_masses
/// Step 5 may also renew the masses, m_a = Σ_p m_p N_ap (kg) with the new functions: then either
/// v_a or m_a v_a stays.
///
/// Errors: [`Breakdown::NoMass`] where no particle sees a node any more.
pub fn renew_masses<const D: usize>(
    State { particle, node, shape, .. }: &mut State<D>,
    masses: NodalMass,
) -> Result<(), Breakdown> {
    for a in 0..node.len() {
        node.p[a] = node.v[a] * node.m[a];
    }
    node.m.fill(0.0);
    for p in 0..particle.len() {
        for (a, N_ap, _) in shape.of(p) {
            node.m[a] += particle.m[p] * N_ap;
        }
    }
    if let Some(node) = node.m.iter().position(|m_a| *m_a == 0.0) {
        return Err(Breakdown::NoMass { node });
    }
    if masses == NodalMass::RenewedKeepingMomentum {
        for a in 0..node.len() {
            node.v[a] = node.p[a] / node.m[a];
        }
    }
    Ok(())
}
// ANCHOR_END: renew_masses

const AT_START: Made = &["N_Ip", "grad_N_Ip", "lambda", "m_I", "v_I", "f_int_I", "f_ext_I", "f_I"];
const RENEWED: Made = &["N_Ip", "grad_N_Ip", "lambda", "m_I", "v_I"];
const KICKED: Made = &["v_I", "v_p"];
const MADE_KEPT: &[Made] =
    &[AT_START, &["v_I"], &["x_I"], &["x_p"], MATERIAL, TABLE, FORCES, KICKED];
const MADE_RENEWED: &[Made] =
    &[AT_START, &["v_I"], &["x_I"], &["x_p"], MATERIAL, RENEWED, FORCES, KICKED];

/// This is OTM, with one of three readings of its nodes' masses.
pub struct Otm(pub NodalMass);

impl<const D: usize> Scheme<D> for Otm {
    fn makes(&self, _: Kinematics) -> &'static [Made] {
        match self.0 {
            NodalMass::Kept => MADE_KEPT,
            NodalMass::RenewedKeepingVelocity | NodalMass::RenewedKeepingMomentum => MADE_RENEWED,
        }
    }

    fn start(&self, state: &mut State<D>, model: &Model<D>) -> Result<(), Breakdown> {
        start(state, model)
    }

    fn step(
        &self,
        n: usize,
        state: &mut State<D>,
        model: &Model<D>,
        dt: f64,
        t: f64,
    ) -> Result<(), Breakdown> {
        step(n, state, model, self.0, dt, t)
    }

    fn factor(&self, _: Kinematics) -> TripFactor {
        TripFactor::One
    }
}
