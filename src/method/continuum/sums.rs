//! The sums of §3.3 carry quantities from particles to nodes and back.

use super::law::outer;
use super::loads::Loads;
use super::shape::Shape;
use super::state::{Nodes, Particles};
use nalgebra::{SMatrix, SVector};

// ANCHOR: mass_and_momentum
/// The particles bring their mass and momentum to the nodes. (13), lumped by rows, adds
/// m_I += Σ_p m_p N_Ip  (kg): since Σ_J N_Jp = 1, the row sum of m_IJ = Σ_p N_Ip m_p N_Jp is
/// this. And p_I += Σ_p m_p v_p N_Ip  (kg m/s).
pub fn mass_and_momentum<const D: usize>(
    node: &mut Nodes<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
) {
    for p in 0..particle.len() {
        let (m_p, v_p) = (particle.m[p], particle.v[p]);
        shape.lines(p, |line| {
            let m_line = m_p * line.share;
            let (m, p) = (&mut node.m[line.nodes()], &mut node.p[line.nodes()]);
            for ((m_I, p_I), factor) in m.iter_mut().zip(p).zip(line.factors) {
                *m_I += m_line * factor.N;
                *p_I += v_p * (m_line * factor.N);
            }
        });
    }
}
// ANCHOR_END: mass_and_momentum

// ANCHOR: momentum
/// The particles bring their momentum alone: p_I += Σ_p m_p v_p N_Ip  (kg m/s).
pub fn momentum<const D: usize>(node: &mut Nodes<D>, particle: &Particles<D>, shape: &Shape<D>) {
    for p in 0..particle.len() {
        let (m_p, v_p) = (particle.m[p], particle.v[p]);
        shape.lines(p, |line| {
            let p_line = v_p * (m_p * line.share);
            for (p_I, factor) in node.p[line.nodes()].iter_mut().zip(line.factors) {
                *p_I += p_line * factor.N;
            }
        });
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
    for p in 0..particle.len() {
        let pull = particle.sigma[p] * (particle.m[p] / particle.rho[p]);
        shape.lines(p, |line| {
            let (along, across) = line.split(&pull);
            for (f_I, factor) in node.f[line.nodes()].iter_mut().zip(line.factors) {
                *f_I -= along * factor.slope;
                if D > 1 {
                    *f_I -= across * factor.N;
                }
            }
        });
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
/// Gives the gradient inside (16), ∇v at particle p: Σ_I v_I ⊗ ∇N_Ip  (1/s).
#[inline(always)]
pub fn velocity_gradient<const D: usize>(
    node: &Nodes<D>,
    shape: &Shape<D>,
    p: usize,
) -> SMatrix<f64, D, D> {
    gradient(&node.v, &node.m, shape, p)
}

/// Gives ∇q at particle p of a nodal field q: Σ_I (q_I − q_0) ⊗ ∇N_Ip, in the unit of q per m.
///
/// q_0 is that of the first of the particle's nodes. It may be taken
/// off because Σ_I ∇N_Ip = 0; then nodes that move alike give exactly zero,
/// and a fast body loses no digits of its strain. A node without mass (`m` is m_I) has no
/// velocity: it moves with q_0.
#[inline(always)]
pub fn gradient<const D: usize>(
    q: &[SVector<f64, D>],
    m: &[f64],
    shape: &Shape<D>,
    p: usize,
) -> SMatrix<f64, D, D> {
    let mut grad_q = SMatrix::<f64, D, D>::zeros();
    let watch = shape.has_tiny(p); // else every node has mass
    let Some(first) = shape.find(p, |I| !watch || m[I] > 0.0) else {
        return grad_q;
    };
    let q_0 = q[first];
    shape.lines(p, |line| {
        for (I, _, grad_N_Ip) in line.entries() {
            if watch && m[I] == 0.0 {
                continue;
            }
            grad_q += outer(&(q[I] - q_0), &grad_N_Ip);
        }
    });
    grad_q
}
// ANCHOR_END: velocity_gradient

// ANCHOR: interpolate
/// Interpolates a nodal field to particle p: Σ_I q_I N_Ip, in the unit of q.
#[inline(always)]
pub fn interpolate<const D: usize>(
    q: &[SVector<f64, D>],
    shape: &Shape<D>,
    p: usize,
) -> SVector<f64, D> {
    let mut sum = SVector::zeros();
    shape.lines(p, |line| {
        let mut of_line = SVector::zeros();
        for (q_I, factor) in q[line.nodes()].iter().zip(line.factors) {
            of_line += q_I * factor.N;
        }
        sum += of_line * line.share;
    });
    sum
}
// ANCHOR_END: interpolate
