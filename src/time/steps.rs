//! The steps of the paper's Algorithm, one function each: outputs first,
//! inputs after, so that a signature reads like its equation.
#![allow(non_snake_case)]

use crate::basis::{self, Reason, Scratch, Trouble};
use crate::continuum::law::{self, LinearElastic};
use crate::continuum::mass::{ConsistentMass, Singular};
use crate::continuum::shape::Shape;
use crate::continuum::state::{Nodes, Particles};
use crate::continuum::sums;
use crate::cost::Cost;
use crate::fault::{Breakdown, Moment};
use crate::model::{Fixed, Model};
use crate::reading::StepEight;
use nalgebra::SVector;

/// γ of Newmark's method: with β = 0 the explicit central difference.
pub const NEWMARK_GAMMA: f64 = 0.5;

// ANCHOR: predict
/// Step 1, predictor: (27) x_p += Δt Σ_I p_I N_Ip / m_I + ½ Δt² Σ_I f_I N_Ip / m_I
/// and (28) v_p += (1 − γ) Δt Σ_I f_I N_Ip / m_I, with nodal values of k.
pub fn predict<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        let v_p = sums::to_particle(&node.p, node, shape, p);
        let a_p = sums::to_particle(&node.f, node, shape, p);
        particle.x[p] += v_p * dt + a_p * (0.5 * dt * dt);
        particle.v[p] += a_p * ((1.0 - NEWMARK_GAMMA) * dt);
    }
}
// ANCHOR_END: predict

// ANCHOR: discard
/// Step 2: discard the previous nodal values.
pub fn discard<const D: usize>(node: &mut Nodes<D>) {
    node.m.fill(0.0);
    node.p.fill(SVector::zeros());
    node.v.fill(SVector::zeros());
    node.f.fill(SVector::zeros());
    node.a.fill(SVector::zeros());
    node.a_next.fill(SVector::zeros());
}
// ANCHOR_END: discard

// ANCHOR: tabulate_step
/// Between steps 2 and 3: N_Ip and ∇N_Ip at the particles' new positions.
///
/// Errors: [`Breakdown::LeftGrid`]; [`Breakdown::NotFinite`] for a position that
/// is not a number; [`Breakdown::NoBasis`] where local max-ent has no solution.
pub fn tabulate<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    particle: &Particles<D>,
    model: &Model<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let outcome = basis::tabulate(shape, scratch, cost, &model.basis, &model.grid, &particle.x);
    outcome.map_err(|Trouble { particle: p, reason }| {
        let position: Vec<f64> = particle.x[p].iter().copied().collect();
        match reason {
            _ if position.iter().any(|x| !x.is_finite()) => {
                Breakdown::NotFinite { particle: p, moment, symbol: "position" }
            }
            Reason::OutsideGrid => Breakdown::LeftGrid { particle: p, moment, position },
            Reason::Lme(failure) => Breakdown::NoBasis { particle: p, moment, failure },
        }
    })
}
// ANCHOR_END: tabulate_step

// ANCHOR: transfer
/// Step 3: m_I = Σ_p m_p N_Ip  (kg) and p_I = Σ_p m_p v_p N_Ip  (kg m/s); with
/// the consistent mass matrix m_IJ, too.
///
/// Errors: [`Breakdown::SingularMass`].
pub fn transfer<const D: usize>(
    node: &mut Nodes<D>,
    mass: &mut Option<ConsistentMass<D>>,
    particle: &Particles<D>,
    shape: &Shape<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    sums::lumped_mass(node, particle, shape);
    sums::momentum(node, particle, shape);
    if let Some(mass) = mass {
        let nodes = node.m.iter().filter(|m_I| **m_I > 0.0).count();
        mass.assemble(particle, shape, &node.m, cost).map_err(|Singular| {
            Breakdown::SingularMass { particles: particle.len(), nodes, moment }
        })?;
    }
    Ok(())
}
// ANCHOR_END: transfer

// ANCHOR: impose_essential
/// Step 4: p_I = 0 where the boundary is fixed, then v_I = p_I / m_I  (m/s).
pub fn impose_essential<const D: usize>(
    node: &mut Nodes<D>,
    mass: &mut Option<ConsistentMass<D>>,
    fixed: &Fixed,
    cost: &mut Cost,
) {
    for &(I, i) in fixed {
        node.p[I][i] = 0.0;
    }
    if let Some(mass) = mass {
        mass.spread(&mut node.p, &node.m, cost);
    }
    update_velocity(node);
}

/// v_I = p_I / m_I  (m/s); a node without mass keeps the velocity 0.
pub fn update_velocity<const D: usize>(node: &mut Nodes<D>) {
    for I in 0..node.len() {
        if node.m[I] > 0.0 {
            node.v[I] = node.p[I] / node.m[I];
        }
    }
}
// ANCHOR_END: impose_essential

// ANCHOR: increment_strain
/// Step 5: Δε_p = Δt ε̇_p, with (16) ε̇_p = ½ Σ_I (∇N_Ip v_I + (∇N_Ip v_I)ᵀ)  (–).
pub fn increment_strain<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        let grad_v = sums::velocity_gradient(node, shape, p);
        particle.d_eps[p] = law::symmetric_part(&grad_v) * dt;
    }
}
// ANCHOR_END: increment_strain

// ANCHOR: update_density
/// Step 6: ρ_p ← ρ_p / (1 + tr Δε_p)  (kg/m³).
///
/// Errors: [`Breakdown::Inverted`] when 1 + tr Δε_p ≤ 0;
/// [`Breakdown::NotFinite`] when it is not a number.
pub fn update_density<const D: usize>(
    particle: &mut Particles<D>,
    moment: Moment,
) -> Result<(), Breakdown> {
    for p in 0..particle.len() {
        if !particle.d_eps[p].trace().is_finite() {
            return Err(Breakdown::NotFinite { particle: p, moment, symbol: "strain" });
        }
        particle.rho[p] =
            law::density(particle.rho[p], &particle.d_eps[p]).ok_or(Breakdown::Inverted {
                particle: p,
                moment,
                strain: particle.d_eps[p].trace(),
            })?;
    }
    Ok(())
}
// ANCHOR_END: update_density

// ANCHOR: update_stress
/// (3), between steps 6 and 7: σ_p += D : Δε_p  (Pa).
pub fn update_stress<const D: usize>(particle: &mut Particles<D>, law: &LinearElastic) {
    for p in 0..particle.len() {
        particle.sigma[p] += law.stress_increment(&particle.d_eps[p]);
    }
}
// ANCHOR_END: update_stress

// ANCHOR: balance_forces
/// Step 7: f_I = f_I^int + f_I^ext, (14) (15), with the loads of time `t` (s),
/// and f_I = 0 where the boundary is fixed  (N).
pub fn balance_forces<const D: usize>(
    node: &mut Nodes<D>,
    mass: &mut Option<ConsistentMass<D>>,
    particle: &Particles<D>,
    shape: &Shape<D>,
    model: &Model<D>,
    t: f64,
    cost: &mut Cost,
) {
    sums::internal_force(node, particle, shape);
    if let Some(loads) = &model.loads {
        sums::external_force(node, particle, shape, loads, t, cost);
    }
    for &(I, i) in &model.fixed {
        node.f[I][i] = 0.0;
    }
    if let Some(mass) = mass {
        mass.spread(&mut node.f, &node.m, cost);
    }
}
// ANCHOR_END: balance_forces

// ANCHOR: integrate_momentum
/// Step 8: p_I += γ f_I Δt, or f_I Δt as printed  (kg m/s).
pub fn integrate_momentum<const D: usize>(node: &mut Nodes<D>, dt: f64, reading: StepEight) {
    let share = match reading {
        StepEight::SecondOrder => NEWMARK_GAMMA,
        StepEight::AsPrinted => 1.0,
    };
    for I in 0..node.len() {
        node.p[I] += node.f[I] * (share * dt);
    }
}
// ANCHOR_END: integrate_momentum

// ANCHOR: correct
/// Step 9, corrector (29): v_p += γ Δt Σ_I f_I N_Ip / m_I, all at k+1  (m/s).
pub fn correct<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        let a_p = sums::to_particle(&node.f, node, shape, p);
        particle.v[p] += a_p * (NEWMARK_GAMMA * dt);
    }
}
// ANCHOR_END: correct

// ANCHOR: euler_steps
/// Strain, density and stress of all particles from the nodal velocity: (16),
/// (17), (3).
///
/// Errors: [`Breakdown::Inverted`], [`Breakdown::NotFinite`].
pub fn update_material<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    model: &Model<D>,
    dt: f64,
    moment: Moment,
) -> Result<(), Breakdown> {
    increment_strain(particle, node, shape, dt);
    update_density(particle, moment)?;
    update_stress(particle, &model.law);
    Ok(())
}

/// (18) over one step: p_I += f_I Δt  (kg m/s), and v_I = p_I / m_I  (m/s).
pub fn advance_momentum<const D: usize>(node: &mut Nodes<D>, dt: f64) {
    for I in 0..node.len() {
        node.p[I] += node.f[I] * dt;
    }
    update_velocity(node);
}

/// (20) v_p += Δt Σ_I N_Ip a_I and (21) x_p += Δt Σ_I N_Ip v_I, with
/// a_I = f_I/m_I and v_I = p_I/m_I of the advanced momentum.
pub fn move_with_nodes<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        particle.v[p] += sums::to_particle_divided(&node.f, node, shape, p) * dt;
        particle.x[p] += sums::to_particle_divided(&node.p, node, shape, p) * dt;
    }
}

/// (23) v_p += Δt Σ_I N_Ip f_I / m_I and (22) x_p += Δt Σ_I N_Ip p_I / m_I.
pub fn move_with_shares<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        particle.v[p] += sums::to_particle(&node.f, node, shape, p) * dt;
        particle.x[p] += sums::to_particle(&node.p, node, shape, p) * dt;
    }
}

/// p_I = Σ_p m_p v_p N_Ip with the particles' new velocity and the old N_Ip.
pub fn map_momentum_anew<const D: usize>(
    node: &mut Nodes<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
) {
    node.p.fill(SVector::zeros());
    sums::momentum(node, particle, shape);
}
// ANCHOR_END: euler_steps

/// a_I = Σ_p m_p a_p N_Ip / m_I (m/s²), 0 where the boundary is fixed.
pub fn map_acceleration<const D: usize>(
    node: &mut Nodes<D>,
    mass: &mut Option<ConsistentMass<D>>,
    particle: &mut Particles<D>,
    shape: &Shape<D>,
    fixed: &Fixed,
    cost: &mut Cost,
) {
    particle.a.resize(particle.m.len(), SVector::zeros());
    node.a.resize(node.m.len(), SVector::zeros());
    node.a_next.resize(node.m.len(), SVector::zeros());
    for (I, p, N_Ip, _) in shape.pairs() {
        node.a[I] += particle.a[p] * (particle.m[p] * N_Ip);
    }
    for &(I, i) in fixed {
        node.a[I][i] = 0.0;
    }
    if let Some(mass) = mass {
        mass.spread(&mut node.a, &node.m, cost);
    }
    for I in 0..node.len() {
        if node.m[I] > 0.0 {
            node.a[I] /= node.m[I];
        }
    }
}

/// Stops a run in the step in which a particle stops being finite; a density must
/// also stay above 0.
///
/// Errors: [`Breakdown::NotFinite`] with the first such particle.
pub fn finite<const D: usize>(particle: &Particles<D>, moment: Moment) -> Result<(), Breakdown> {
    for p in 0..particle.len() {
        let symbol = if !particle.x[p].iter().all(|x| x.is_finite()) {
            "position"
        } else if !particle.v[p].iter().all(|v| v.is_finite()) {
            "velocity"
        } else if !particle.sigma[p].iter().all(|s| s.is_finite()) {
            "stress"
        } else if !(particle.rho[p].is_finite() && particle.rho[p] > 0.0) {
            "density"
        } else {
            continue;
        };
        return Err(Breakdown::NotFinite { particle: p, moment, symbol });
    }
    Ok(())
}
