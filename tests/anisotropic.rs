//! Local max-ent with a metric that goes with the material: its exact law, how far it reaches, and
//! where a stretched state is stable.

use crate::support::*;
use lme_mpm::method::basis::anisotropic::Metric;
use lme_mpm::method::basis::scattered::{NodeValues, values_in};
use lme_mpm::method::continuum::law;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time::{otm, steps};
use nalgebra::{DMatrix, Matrix2, Matrix3, SMatrix, SVector, Vector1, Vector2};
use std::fmt::Write;

/// The wave speed over the cell (1/s) of the bars here.
const RATE: f64 = 1.0;

/// A bar of unit cells, E = ρ = 1, both ends held, stretched by F in one step.
fn stretched_bar(gamma: f64, metric: &str, cells: usize, F: f64) -> (Model<1>, State<1>) {
    let sets = [
        format!("body.length={cells}"),
        format!("grid.cells={cells}"),
        format!("basis.gamma={gamma}"),
        format!("basis.metric={metric}"),
    ];
    let fixed = [
        "body.law=neo-hookean",
        "body.density=1",
        "body.youngs_modulus=1",
        "body.poisson_ratio=0",
        "boundary.left=fixed",
        "boundary.right=fixed",
    ];
    let (model, mut state) = at_start::<1>(&block(1, &[&strs(&sets), &fixed[..]].concat()));
    otm::start(&mut state, &model).unwrap();
    for a in 0..state.node.len() {
        state.node.v[a] = state.node.x[a] * (F - 1.0);
    }
    displace(&mut state, &model, Functions::Renewed);
    (model, state)
}

/// Which functions the force is taken with after a displacement.
#[derive(Clone, Copy, PartialEq)]
enum Functions {
    /// Those of the places where nodes and particles now stand, as OTM has them.
    Renewed,
    /// Those of before, carried along by the material: a Lagrangian kernel.
    Frozen,
}

/// Moves the nodes by v, of which Δt = 1 makes a displacement, and all else with them.
fn displace(state: &mut State<1>, model: &Model<1>, functions: Functions) {
    let State { particle, node, shape, .. } = state;
    otm::move_nodes(node, 1.0);
    otm::move_particles(particle, node, shape, 1.0);
    otm::deform_particles(particle, node, shape, model, 1.0).unwrap();
    node.f.fill(SVector::zeros());
    if functions == Functions::Renewed {
        otm::tabulate_again(state, model).unwrap();
        let State { particle, node, shape, .. } = state;
        steps::balance_forces(node, particle, shape, model, 0.0);
        return;
    }
    for (a, p, _, grad) in shape.pairs() {
        let f = law::increment(&particle.G[p]).1;
        node.f[a] -= particle.sigma[p] * grad * (particle.m[p] / particle.rho[p] / f);
    }
}

/// The fastest growth (c/h) that M⁻¹K has, K = −∂f/∂x by central differences.
fn growth(model: &Model<1>, state: &State<1>, functions: Functions) -> f64 {
    let free = 1..state.node.len() - 1;
    let n = free.len();
    let mut K = DMatrix::<f64>::zeros(n, n);
    let small = 1e-5;
    let force = |b: usize, by: f64| {
        let mut state = state.clone();
        state.node.v.fill(Vector1::zeros());
        state.node.v[b][0] = by;
        displace(&mut state, model, functions);
        state.node.f
    };
    for b in free.clone() {
        let (up, down) = (force(b, small), force(b, -small));
        for a in free.clone() {
            let slope = (up[a][0] - down[a][0]) / (2.0 * small);
            K[(a - 1, b - 1)] = -slope / state.node.m[a];
        }
    }
    let squares = K.complex_eigenvalues();
    squares.iter().map(|square| (-square).sqrt().re.abs()).fold(0.0, f64::max) / RATE
}

/// The growth (c/h) that OTM shows: the first residual is held as a static load, the nodes are
/// pushed a little, and the logarithm of the largest velocity is followed.
fn simulated(model: &Model<1>, state: &State<1>, rate: f64) -> f64 {
    let mut state = state.clone();
    let dt = 0.05;
    let held: Vec<_> = state.node.f.iter().map(|f| -f).collect();
    for a in 0..state.node.len() {
        let push = 1e-9 * (1.3 * a as f64 * a as f64).sin();
        state.node.v[a] = Vector1::new(push);
    }
    let mut logs = Vec::new();
    let end = (9.0 / rate / dt) as usize;
    for _ in 0..end {
        step(&mut state, model, &held, dt);
        let largest = state.node.v.iter().map(|v| v[0].abs()).fold(0.0, f64::max);
        logs.push(largest.ln());
    }
    (logs[end - 1] - logs[end / 2 - 1]) / (dt * (end - end / 2) as f64)
}

/// One step of OTM with loads held, between ends that stand.
fn step(state: &mut State<1>, model: &Model<1>, held: &[Vector1<f64>], dt: f64) {
    let State { particle, node, shape, .. } = state;
    let last = node.len() - 1;
    let load = |f: &mut [Vector1<f64>], held: &[Vector1<f64>]| {
        f.iter_mut().zip(held).for_each(|(f, held)| *f += held);
        (f[0], f[last]) = (Vector1::zeros(), Vector1::zeros());
    };
    (node.v[0], node.v[last]) = (Vector1::zeros(), Vector1::zeros());
    if node.a[0] == Vector1::zeros() {
        load(&mut node.f, held);
        node.a[0][0] = 1.0; // the load is on from now on
    }
    otm::kick(node, 0.5 * dt);
    otm::move_nodes(node, dt);
    otm::move_particles(particle, node, shape, dt);
    otm::deform_particles(particle, node, shape, model, dt).unwrap();
    otm::tabulate_again(state, model).unwrap();
    let State { particle, node, shape, .. } = state;
    node.f.fill(Vector1::zeros());
    steps::balance_forces(node, particle, shape, model, 0.0);
    load(&mut node.f, held);
    otm::kick(node, 0.5 * dt);
}

#[test]
fn aniso_explore() {
    for (metric, gammas, Fs) in [
        (
            "fixed",
            vec![0.8, 1.8, 4.0],
            vec![0.3, 0.35, 0.4, 0.5, 0.52, 0.6, 0.73, 0.75, 0.8, 1.0, 1.5, 2.0, 3.0],
        ),
        (
            "updated",
            vec![0.8, 1.2, 1.8, 2.5, 3.0],
            vec![0.3, 0.5, 0.8, 1.05, 1.1, 1.15, 1.2, 1.3, 1.4, 1.45, 1.8, 2.5, 2.6, 4.0],
        ),
    ] {
        for gamma in gammas {
            let mut s = format!("{metric} {gamma}:");
            for F in &Fs {
                let (model, state) = stretched_bar(gamma, metric, 20, *F);
                let g = growth(&model, &state, Functions::Renewed);
                let z = growth(&model, &state, Functions::Frozen);
                let _ = write!(s, " {F}={g:.3}/{z:.3}");
                if g > 0.1 {
                    let _ = write!(s, "[{:.3}]", simulated(&model, &state, g));
                }
            }
            println!("{s}");
        }
    }
}
