//! Newton's method finds the nodal displacements at which the forces of the end of the step balance.

use crate::method::breakdown::Breakdown;
use crate::method::continuum::sums;
use crate::method::model::{Model, State};
use nalgebra::SVector;

/// The residual may be this share of the forces and inertia that it is made of.
pub const BALANCED: f64 = 1e-10;

/// A correction of this share of the displacements is round-off.
const ROUND_OFF: f64 = 1e-13;

/// So many iterations must do; from a start that is not far off they are three or four.
pub const MOST_ITERATIONS: usize = 25;

/// A correction that would turn a particle inside out is halved so often at most.
const HALVINGS: usize = 20;

// ANCHOR: balance
/// Finds u_I such that f_I^ext + f_I^int(u) − Σ_J m_IJ a_J = 0 at the end of a step (N), where a_I
/// grows by `per_u` u_I (1/s²): 4/Δt², or 0 without inertia. It starts with the u_I and a_I that
/// the nodes have; the loads are those of `t` (s).
///
/// Errors: [`Breakdown::NoEquilibrium`] after too many iterations, or where the tangent is not
/// positive definite; [`Breakdown::Inverted`]; [`Breakdown::NodeNotFinite`].
pub fn balance<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    per_u: f64,
    t: f64,
) -> Result<(), Breakdown> {
    load(state, model, t);
    let mut residuals = vec![residual(state, model, per_u)?];
    let failed = |residuals: &[f64], what| Breakdown::NoEquilibrium {
        iterations: residuals.len() - 1,
        residual: residuals.last().copied().unwrap_or(f64::NAN),
        what,
    };
    let mut round_off = false;
    while !(round_off || residuals.last().is_some_and(|size| *size <= BALANCED)) {
        if residuals.len() > MOST_ITERATIONS {
            return Err(failed(&residuals, "these are too many"));
        }
        let solved = correct(state, model, per_u);
        solved.ok_or_else(|| failed(&residuals, "the tangent is not positive definite"))?;
        round_off = is_round_off(state);
        residuals.push(advance(state, model, per_u)?);
    }
    if let Some(system) = &mut state.equilibrium {
        system.cost.equilibrium_iterations += residuals.len() as u64 - 1;
        system.residuals = residuals;
    }
    Ok(())
}
// ANCHOR_END: balance

/// Takes the loads of time `t` (s) (N), and makes room for the tangent.
fn load<const D: usize>(state: &mut State<D>, model: &Model<D>, t: f64) {
    let State { particle, node, shape, equilibrium, .. } = state;
    node.f.fill(SVector::zeros());
    if let Some(loads) = &model.loads {
        sums::external_force(node, particle, shape, loads, t);
    }
    if let Some(system) = equilibrium {
        system.loads.copy_from_slice(&node.f);
        system.fit(shape, node.len());
    }
}

/// Takes the residual of the nodes' u_I and a_I, and gives its size over that of its parts (–).
///
/// Errors: [`Breakdown::Inverted`], [`Breakdown::NodeNotFinite`].
fn residual<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    per_u: f64,
) -> Result<f64, Breakdown> {
    let State { particle, node, shape, mass, equilibrium, .. } = state;
    let Some(system) = equilibrium else { return Ok(0.0) };
    let strained = system.strain(particle, &node.u, (shape, &node.m), &model.law);
    strained.map_err(|(particle, J)| Breakdown::Inverted { particle, strain: J - 1.0 })?;
    system.inertia.fill(SVector::zeros());
    if per_u > 0.0 {
        mass.entries(&node.m, |I, J, m_IJ| system.inertia[I] += node.a[J] * m_IJ);
    }
    for I in 0..node.len() {
        system.residual[I] = system.loads[I] + system.internal[I] - system.inertia[I];
    }
    let known = |I: usize| node.m[I] == 0.0;
    for I in (0..node.len()).filter(|I| known(*I)) {
        system.residual[I] = SVector::zeros();
    }
    for &(I, i) in &model.fixed {
        system.residual[I][i] = 0.0;
        system.internal[I][i] = 0.0; // what holds the node is no part of it
        system.loads[I][i] = 0.0;
        system.inertia[I][i] = 0.0;
    }
    if let Some(node) = system.residual.iter().position(|r| !r.sum().is_finite()) {
        return Err(Breakdown::NodeNotFinite { node, symbol: "force" });
    }
    let square = |list: &[SVector<f64, D>]| list.iter().map(|x| x.dot(x)).sum::<f64>();
    let whole = square(&system.loads) + square(&system.internal) + square(&system.inertia);
    let own = square(&system.residual);
    Ok(if own > 0.0 { libm::sqrt(own / whole) } else { 0.0 })
}

/// Solves the tangent's equations for the next correction; `None` where that fails.
fn correct<const D: usize>(state: &mut State<D>, model: &Model<D>, per_u: f64) -> Option<()> {
    let State { particle, node, shape, mass, equilibrium, .. } = state;
    let system = equilibrium.as_mut()?;
    system.assemble(particle, (shape, &node.m), &model.law, (mass, per_u));
    let fixed = &model.fixed; // in ascending order
    let known = |I: usize, i: usize| node.m[I] == 0.0 || fixed.binary_search(&(I, i)).is_ok();
    system.solve(known)
}

/// Says whether the correction is lost beside the displacements.
fn is_round_off<const D: usize>(state: &State<D>) -> bool {
    let size = |list: &[SVector<f64, D>]| list.iter().map(|x| x.amax()).fold(0.0, f64::max);
    let correction = state.equilibrium.as_ref().map_or(0.0, |system| size(&system.correction));
    correction <= ROUND_OFF * size(&state.node.u)
}

/// Adds the correction to u_I and a_I, or a half, a quarter, ... of it, where all of it would turn
/// a particle inside out; gives the size of the new residual.
fn advance<const D: usize>(
    state: &mut State<D>,
    model: &Model<D>,
    per_u: f64,
) -> Result<f64, Breakdown> {
    let mut share = 1.0;
    add(state, share, per_u);
    for _ in 0..HALVINGS {
        match residual(state, model, per_u) {
            Err(Breakdown::Inverted { .. }) => {
                share *= 0.5;
                add(state, -share, per_u);
            }
            other => return other,
        }
    }
    residual(state, model, per_u)
}

/// Adds a share of the correction to u_I (m), and `per_u` times that to a_I (m/s²).
fn add<const D: usize>(state: &mut State<D>, share: f64, per_u: f64) {
    let State { node, equilibrium: Some(system), .. } = state else { return };
    for I in 0..node.len() {
        let du = system.correction[I] * share;
        node.u[I] += du;
        node.a[I] += du * per_u;
    }
}
