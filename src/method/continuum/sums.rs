//! The sums of §3.3 carry quantities from particles to nodes and back; what they divide by is
//! the lumped mass of (18).

use super::law::{applied, outer};
use super::loads::Loads;
use super::shape::Shape;
use super::state::{Nodes, Particles};
use nalgebra::{SMatrix, SVector};

// ANCHOR: lumped_mass
/// (13), lumped by rows, adds m_I += Σ_p m_p N_Ip  (kg).
///
/// Since Σ_J N_Jp = 1, the row sum of m_IJ = Σ_p N_Ip m_p N_Jp is this.
pub fn lumped_mass<const D: usize>(node: &mut Nodes<D>, particle: &Particles<D>, shape: &Shape<D>) {
    for (I, p, N_Ip, _) in shape.pairs() {
        node.m[I] += particle.m[p] * N_Ip;
    }
}
// ANCHOR_END: lumped_mass

// ANCHOR: momentum
/// The particles bring their momentum to the nodes: p_I += Σ_p m_p v_p N_Ip  (kg m/s).
pub fn momentum<const D: usize>(node: &mut Nodes<D>, particle: &Particles<D>, shape: &Shape<D>) {
    for (I, p, N_Ip, _) in shape.pairs() {
        node.p[I] += particle.v[p] * (particle.m[p] * N_Ip);
    }
}
// ANCHOR_END: momentum

// ANCHOR: internal_force
/// (14) adds the internal forces: f_I −= Σ_p σ_p ∇N_Ip m_p / ρ_p  (N).
pub fn internal_force<const D: usize>(
    node: &mut Nodes<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
) {
    for (I, p, _, grad_N_Ip) in shape.pairs() {
        let volume = particle.m[p] / particle.rho[p];
        node.f[I] -= applied(&particle.sigma[p], grad_N_Ip) * volume;
    }
}
// ANCHOR_END: internal_force

// ANCHOR: external_force
/// (15) adds the loads of time `t` (s):
/// f_I += Σ_p N_Ip m_p b_p + Σ_p N_Ip m_p h⁻¹ t^s_p  (N).
pub fn external_force<const D: usize>(
    node: &mut Nodes<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
    loads: &Loads<D>,
    t: f64,
) {
    if let Some(body) = &loads.body {
        for p in 0..particle.len() {
            let force = body.at(p, t) * particle.m[p];
            for (I, N_Ip, _) in shape.of(p) {
                node.f[I] += force * N_Ip;
            }
        }
        node.cost.body_forces += particle.len() as u64;
    }
    if let Some(traction) = &loads.traction {
        for (p, force) in traction.at(t) {
            for (I, N_Ip, _) in shape.of(p) {
                node.f[I] += force * N_Ip;
            }
        }
        node.cost.tractions += traction.layer.len() as u64;
    }
}
// ANCHOR_END: external_force

// ANCHOR: velocity_gradient
/// Gives the gradient inside (16), ∇v at particle p: Σ_I (v_I − v_0) ⊗ ∇N_Ip  (1/s).
///
/// v_0 is the velocity of the first of the particle's nodes. It may be taken
/// off because Σ_I ∇N_Ip = 0; then nodes that move alike give exactly zero,
/// and a fast body loses no digits of its strain. A node without mass has no
/// velocity: it moves with v_0.
pub fn velocity_gradient<const D: usize>(
    node: &Nodes<D>,
    shape: &Shape<D>,
    p: usize,
) -> SMatrix<f64, D, D> {
    let with_mass = || shape.of(p).filter(|&(I, _, _)| node.m[I] > 0.0);
    let mut grad_v = SMatrix::zeros();
    if let Some((first, _, _)) = with_mass().next() {
        let v_0 = node.v[first];
        for (I, _, grad_N_Ip) in with_mass() {
            grad_v += outer(&(node.v[I] - v_0), grad_N_Ip);
        }
    }
    grad_v
}
// ANCHOR_END: velocity_gradient

// ANCHOR: interpolate
/// Interpolates a nodal field to particle p: Σ_I q_I N_Ip, in the unit of q.
pub fn interpolate<const D: usize>(
    q: &[SVector<f64, D>],
    shape: &Shape<D>,
    p: usize,
) -> SVector<f64, D> {
    let mut sum = SVector::zeros();
    for (I, N_Ip, _) in shape.of(p) {
        sum += q[I] * N_Ip;
    }
    sum
}
// ANCHOR_END: interpolate

// ANCHOR: to_particle_divided
/// (20) and (21) carry Σ_I (q_I / m_I) N_Ip to particle p. Here a tiny mass
/// divides a force that need not be tiny; see [`to_particle`].
pub fn to_particle_divided<const D: usize>(
    q: &[SVector<f64, D>],
    node: &Nodes<D>,
    shape: &Shape<D>,
    p: usize,
) -> SVector<f64, D> {
    let mut sum = SVector::zeros();
    for (I, N_Ip, _) in shape.of(p) {
        if node.m[I] > 0.0 {
            sum += q[I] / node.m[I] * N_Ip;
        }
    }
    sum
}
// ANCHOR_END: to_particle_divided

// ANCHOR: to_particle
/// (19) carries a nodal momentum or force to particle p: Σ_I q_I N_Ip / m_I.
///
/// `q` (kg m/s) gives m/s, `q` (N) gives m/s². The nodal sum q_I is never
/// divided by m_I alone: N_Ip / m_I stays at or below 1 / m_p however small
/// the mass of the node, while f_I / m_I does not. A node without mass carries
/// nothing.
pub fn to_particle<const D: usize>(
    q: &[SVector<f64, D>],
    node: &Nodes<D>,
    shape: &Shape<D>,
    p: usize,
) -> SVector<f64, D> {
    let mut sum = SVector::zeros();
    for (I, N_Ip, _) in shape.of(p) {
        if node.m[I] > 0.0 {
            sum += q[I] * (N_Ip / node.m[I]);
        }
    }
    sum
}
// ANCHOR_END: to_particle
