//! The steps of the paper's Algorithm and of the other schemes have one function each: outputs
//! first, inputs after, so that a signature reads like its equation.

use super::deformation::deform;
use crate::method::basis::{self, Extents, Scratch};
use crate::method::breakdown::Breakdown;
use crate::method::choice::Filter;
use crate::method::continuum::filter::null_space;
use crate::method::continuum::law::{self, Elastic};
use crate::method::continuum::mass::MassMatrix;
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::{Nodes, Particles};
use crate::method::continuum::sums;
use crate::method::model::{Fixed, Model};
use crate::method::reading::StepEight;
use crate::method::reconstruction::internal_force;
use nalgebra::SVector;

/// This is γ of Newmark's method, which with β = 0 is the explicit central difference.
pub const NEWMARK_GAMMA: f64 = 0.5;

// ANCHOR: predict
/// Step 1, the predictor, moves the particles with the nodal values of k:
/// (27) x_p += Δt Σ_I p_I N_Ip / m_I + ½ Δt² Σ_I f_I N_Ip / m_I
/// and (28) ṽ_p = v_p + (1 − γ) Δt Σ_I f_I N_Ip / m_I, the predicted velocity, which stands in
/// `particle.v` until step 9.
///
/// p_I / m_I stands as v_I at the nodes. The sum with f_I / m_I is a_p: the last corrector has
/// taken it, at the same nodes with the same N_Ip.
pub fn predict<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        let (v_p, a_p) = (sums::interpolate(&node.v, shape, p), particle.a[p]);
        particle.advance(p, v_p * dt + a_p * (0.5 * dt * dt));
        particle.v[p] += a_p * ((1.0 - NEWMARK_GAMMA) * dt);
    }
}
// ANCHOR_END: predict

// ANCHOR: discard
/// Step 2 discards the previous nodal values.
pub fn discard<const D: usize>(node: &mut Nodes<D>) {
    node.m.fill(0.0);
    node.p.fill(SVector::zeros());
    node.v.fill(SVector::zeros());
    node.f.fill(SVector::zeros());
    node.a.fill(SVector::zeros());
    node.a_last.fill(SVector::zeros());
    node.a_next.fill(SVector::zeros());
}
// ANCHOR_END: discard

// ANCHOR: tabulate_step
/// Step 2 also tabulates N_Ip and ∇N_Ip at the particles' new positions.
///
/// Errors: [`Breakdown::LeftGrid`]; [`Breakdown::NotFinite`] for a position that
/// is not a number; [`Breakdown::NoBasis`] where local max-ent has no solution;
/// [`Breakdown::Domain`] where that of GIMP has outgrown its grid.
pub fn tabulate<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    particle: &mut Particles<D>,
    model: &Model<D>,
) -> Result<(), Breakdown> {
    let Particles { x, lambda, stretch, .. } = particle;
    basis::fill_from_grid(shape, scratch, lambda, &model.basis, &model.grid, Extents { x, stretch })
}
// ANCHOR_END: tabulate_step

// ANCHOR: transfer
/// Step 3 carries mass and momentum to the nodes: m_I = Σ_p m_p N_Ip  (kg) and
/// p_I = Σ_p m_p v_p N_Ip  (kg m/s); with the consistent mass matrix m_IJ, too. In the Algorithm
/// v_p is the predicted ṽ_p, and p_I and v_I are p̃_I and ṽ_I up to step 8.
///
/// Errors: [`Breakdown::SingularMass`].
pub fn transfer<const D: usize>(
    node: &mut Nodes<D>,
    mass: &mut MassMatrix<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
) -> Result<(), Breakdown> {
    sums::mass_and_momentum(node, particle, shape);
    mass.assemble(particle, shape, &node.m)
}
// ANCHOR_END: transfer

// ANCHOR: impose_essential
/// Step 4 sets p_I = 0 where the boundary is fixed, then v_I = p_I / m_I  (m/s), or the
/// solution of (12) with the consistent mass matrix.
pub fn impose_essential<const D: usize>(
    node: &mut Nodes<D>,
    mass: &mut MassMatrix<D>,
    fixed: &Fixed,
) {
    for &(I, i) in fixed {
        node.p[I][i] = 0.0;
    }
    mass.solve(&mut node.v, &node.p, &node.m);
}
// ANCHOR_END: impose_essential

// ANCHOR: increment_strain
/// Step 5 takes the strain increment from the nodes: Δε_p = Δt ε̇_p with (16) ε̇_p = ½ Σ_I
/// (∇N_Ip v_I + (∇N_Ip v_I)ᵀ)  (–). Where the particles keep it, all of G_p = Δt ∇v instead.
pub fn increment_strain<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        let grad_v = sums::velocity_gradient(node, shape, p);
        match particle.G.get_mut(p) {
            None => {
                particle.d_eps[p] = law::symmetric_part(&grad_v) * dt;
                particle.turn(p, &(grad_v * dt));
            }
            Some(G_p) => *G_p = grad_v * dt,
        }
    }
}
// ANCHOR_END: increment_strain

// ANCHOR: update_density
/// Step 6 updates the density, (17): ρ_p ← ρ_p / (1 + tr Δε_p)  (kg/m³).
///
/// Errors: [`Breakdown::Inverted`] when 1 + tr Δε_p ≤ 0;
/// [`Breakdown::NotFinite`] when it is not a number.
pub fn update_density<const D: usize>(particle: &mut Particles<D>) -> Result<(), Breakdown> {
    for p in 0..particle.len() {
        let strain = particle.d_eps[p].trace();
        if !strain.is_finite() {
            return Err(Breakdown::NotFinite { particle: p, symbol: "strain" });
        }
        let rho_p = law::density(particle.rho[p], &particle.d_eps[p]);
        particle.rho[p] = rho_p.ok_or(Breakdown::Inverted { particle: p, strain })?;
    }
    Ok(())
}
// ANCHOR_END: update_density

// ANCHOR: update_stress
/// Step 6 also updates the stress, by (3): σ_p += D : Δε_p  (Pa).
pub fn update_stress<const D: usize>(particle: &mut Particles<D>, law: &Elastic) {
    for p in 0..particle.len() {
        particle.sigma[p] += law.stress_increment(&particle.d_eps[p]);
    }
}
// ANCHOR_END: update_stress

/// Step 6 as a whole: density and stress by (17) and (3) as printed, or at finite strain; then
/// the filter, where there is one.
///
/// Errors: [`Breakdown::Inverted`], [`Breakdown::NotFinite`].
pub fn update_material<const D: usize>(
    particle: &mut Particles<D>,
    model: &Model<D>,
) -> Result<(), Breakdown> {
    if model.keeps_gradient() {
        deform(particle, &model.law)?;
    } else {
        update_density(particle)?; // (17)
        update_stress(particle, &model.law); // (3)
    }
    if let Some(Filter::NullSpace) = model.filter {
        null_space(particle, &model.grid);
    }
    Ok(())
}

// ANCHOR: balance_forces
/// Step 7 balances the forces: f_I = f_I^int + f_I^ext, (14) (15), with the loads of time
/// `t` (s), and f_I = 0 where the boundary is fixed  (N).
pub fn balance_forces<const D: usize>(
    node: &mut Nodes<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
    model: &Model<D>,
    t: f64,
) {
    internal_force(node, particle, shape, &model.grid, model.reconstruction);
    if let Some(loads) = &model.loads {
        sums::external_force(node, particle, shape, loads, t);
    }
    for &(I, i) in &model.fixed {
        node.f[I][i] = 0.0;
    }
}

/// Step 7 takes the acceleration from them, (18): a_I = f_I / m_I  (m/s²), or the solution of
/// (12) with the consistent mass matrix.
pub fn accelerate<const D: usize>(node: &mut Nodes<D>, mass: &mut MassMatrix<D>) {
    mass.solve(&mut node.a, &node.f, &node.m);
}
// ANCHOR_END: balance_forces

// ANCHOR: integrate_momentum
/// Step 8 integrates the momentum: p_I = p̃_I + γ f_I Δt, or p̃_I + f_I Δt as printed  (kg m/s);
/// v_I likewise with a_I.
pub fn integrate_momentum<const D: usize>(node: &mut Nodes<D>, dt: f64, reading: StepEight) {
    let share = match reading {
        StepEight::SecondOrder => NEWMARK_GAMMA,
        StepEight::AsPrinted => 1.0,
    };
    for I in 0..node.len() {
        node.p[I] += node.f[I] * (share * dt);
        node.v[I] += node.a[I] * (share * dt);
    }
}
// ANCHOR_END: integrate_momentum

// ANCHOR: correct
/// Step 9, the corrector (29), adds the second half: v_p = ṽ_p + γ Δt Σ_I f_I N_Ip / m_I, all at
/// k+1  (m/s).
pub fn correct<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        let a_p = sums::interpolate(&node.a, shape, p);
        particle.v[p] += a_p * (NEWMARK_GAMMA * dt);
        particle.a[p] = a_p; // for the next predictor
    }
}
// ANCHOR_END: correct

// ANCHOR: euler_steps
/// Strains all particles by the nodal velocity, and updates density and stress: (16), (17),
/// (3).
///
/// Errors: [`Breakdown::Inverted`], [`Breakdown::NotFinite`].
pub fn strain_material<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    model: &Model<D>,
    dt: f64,
) -> Result<(), Breakdown> {
    increment_strain(particle, node, shape, dt);
    particle.lengthen();
    update_material(particle, model)
}

/// (18) advances the momentum: p_I += f_I Δt  (kg m/s), and v_I += a_I Δt  (m/s).
pub fn advance_momentum<const D: usize>(node: &mut Nodes<D>, dt: f64) {
    for I in 0..node.len() {
        node.p[I] += node.f[I] * dt;
        node.v[I] += node.a[I] * dt;
    }
}

/// Moves the particles by (20) v_p += Δt Σ_I N_Ip a_I and (21) x_p += Δt Σ_I N_Ip v_I, with
/// a_I = f_I / m_I and v_I = p_I / m_I of the advanced momentum. (23) and (22) are the same
/// sums.
pub fn move_with_nodes<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        particle.v[p] += sums::interpolate(&node.a, shape, p) * dt;
        particle.advance(p, sums::interpolate(&node.v, shape, p) * dt);
    }
}

/// Maps the momentum again, p_I = Σ_p m_p v_p N_Ip, with the particles' new velocity and
/// the old N_Ip.
pub fn map_momentum_anew<const D: usize>(
    node: &mut Nodes<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
) {
    node.p.fill(SVector::zeros());
    sums::momentum(node, particle, shape);
}
// ANCHOR_END: euler_steps

/// Maps the acceleration, a_I = Σ_p m_p a_p N_Ip / m_I (m/s²), or the solution of (12) with
/// the consistent mass matrix; 0 where the boundary is fixed.
pub fn map_acceleration<const D: usize>(
    node: &mut Nodes<D>,
    mass: &mut MassMatrix<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
    fixed: &Fixed,
) {
    node.a.fill(SVector::zeros()); // for once m_I a_I
    for p in 0..particle.len() {
        for (I, N_Ip, _) in shape.of(p) {
            node.a[I] += particle.a[p] * (particle.m[p] * N_Ip);
        }
    }
    for &(I, i) in fixed {
        node.a[I][i] = 0.0;
    }
    mass.solve(&mut node.a_last, &node.a, &node.m);
}

/// Stops a run in the step in which a particle stops being finite; a density must
/// also stay above 0.
///
/// Errors: [`Breakdown::NotFinite`] with the first such particle.
pub fn finite<const D: usize>(particle: &Particles<D>) -> Result<(), Breakdown> {
    for p in 0..particle.len() {
        // What is no number makes the sum none.
        let sum = (particle.x[p] + particle.v[p]).sum() + particle.sigma[p].sum();
        if (sum + particle.rho[p]).is_finite() && particle.rho[p] > 0.0 {
            continue;
        }
        let finite = |list: &[f64]| list.iter().all(|number| number.is_finite());
        let symbol = if !finite(particle.x[p].as_slice()) {
            "position"
        } else if !finite(particle.v[p].as_slice()) {
            "velocity"
        } else if !finite(particle.sigma[p].as_slice()) {
            "stress"
        } else if !(particle.rho[p].is_finite() && particle.rho[p] > 0.0) {
            "density"
        } else {
            continue; // only the sum was too large
        };
        return Err(Breakdown::NotFinite { particle: p, symbol });
    }
    Ok(())
}
