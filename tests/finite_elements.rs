//! Two methods of this program are finite elements where their particles stand so: OTM with the
//! linear basis, and MPM with particles at Gauss points.

use crate::support::*;
use lme_mpm::method::time;
use nalgebra::{DMatrix, DVector};

/// Finite elements are OTM with the linear basis: nodes that start alike move as those of a chain
/// of springs E/h with masses ρh, half of it at the ends, by central differences, to 1e-8 of the
/// speed after a crossing of 20 cells.
#[test]
fn finite_elements_are_a_chain() {
    let sets = [
        "method=otm",
        "grid.cells=20",
        "grid.particles_per_cell=1",
        "initial_velocity.0.velocity=1e-7",
        "time.end=2.6e-5",
    ];
    let scene = dyka(&sets);
    let (model, mut state) = at_start::<1>(&scene);
    let n = 20;
    let h = 0.1333 / 20.0;
    let (stiffness, mass) = (200e9 / h, 7833.0 * h);
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    let start: Vec<f64> = state.node.v.iter().map(|v| v[0]).collect();
    let (mut u, mut v) = (vec![0.0; n + 1], start);
    let acceleration = |u: &[f64]| -> Vec<f64> {
        let pull = |I: usize| stiffness * (u[I + 1] - u[I]);
        let force = |I: usize| match I {
            0 => 0.0,
            I if I == n => -pull(n - 1) * 2.0,
            I => pull(I) - pull(I - 1),
        };
        (0..=n).map(|I| force(I) / mass).collect()
    };
    for step in 1..=model.steps {
        advance(&model, &mut state, step).unwrap();
        let before = acceleration(&u);
        for I in 0..=n {
            v[I] += 0.5 * model.dt * before[I];
            u[I] += model.dt * v[I];
        }
        let after = acceleration(&u);
        (0..=n).for_each(|I| v[I] += 0.5 * model.dt * after[I]);
    }
    let own: Vec<f64> = state.node.v.iter().map(|v| v[0]).collect();
    assert_eq!(own.len(), n + 1);
    assert!(apart(&own, &v) < 1e-8 * 1e-7, "{own:?} {v:?}");
}

/// Linear finite elements with the consistent matrix are MPM with the consistent matrix and
/// particles at Gauss points: the stress of every element after a crossing of 20 cells is that of
/// a dense computation with ρh/6 (2, 1; 1, 2), to 1e-7 of the plateau.
#[test]
fn finite_elements_by_gauss_points() {
    let sets = [
        CONSISTENT.sets,
        &["grid.cells=20", "initial_velocity.0.velocity=1e-7", "time.end=2.6e-5", "time.cfl=0.2"],
        &["grid.beyond={right=0}"],
    ];
    let mut scene = dyka(&sets.concat());
    // From a quarter of a cell to 1/2 − 1/(2√3), in units of the particles' distance.
    scene.grid.offset = (0.5 - 0.5 / 3.0_f64.sqrt() - 0.25) / 0.5;
    let (model, mut state) = at_start::<1>(&scene);
    let n = 20;
    let h = 0.1333 / 20.0;
    let mut mass = DMatrix::<f64>::zeros(n, n);
    let mut stiffness = DMatrix::<f64>::zeros(n, n);
    let mut momentum = DVector::<f64>::zeros(n);
    // Node 0 is fixed and left out.
    for cell in 0..n {
        for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            if cell + a > 0 && cell + b > 0 {
                let alike = a == b;
                mass[(cell + a - 1, cell + b - 1)] += 7833.0 * h / if alike { 3.0 } else { 6.0 };
                stiffness[(cell + a - 1, cell + b - 1)] +=
                    200e9 / h * if alike { 1.0 } else { -1.0 };
            }
        }
    }
    let table = on_grid(&model.basis, &model.grid, &state.particle.x).unwrap().shape;
    for p in 0..state.particle.len() {
        for (I, N, _) in table.of(p) {
            if I > 0 {
                momentum[I - 1] += N * state.particle.m[p] * state.particle.v[p][0];
            }
        }
    }
    let inverse = mass.try_inverse().unwrap();
    let (mut u, mut v) = (DVector::<f64>::zeros(n), &inverse * momentum);
    let turn = -(&inverse * stiffness);
    march(&model, &mut state, model.steps);
    for _ in 0..model.steps {
        v += 0.5 * model.dt * (&turn * &u);
        u += model.dt * &v;
        v += 0.5 * model.dt * (&turn * &u);
    }
    let stress = |cell: usize| {
        let left = if cell == 0 { 0.0 } else { u[cell - 1] };
        200e9 * (u[cell] - left) / h
    };
    let expected: Vec<f64> = (0..2 * n).map(|p| stress(p / 2)).collect();
    let own: Vec<f64> = state.particle.sigma.iter().map(|sigma| sigma[0]).collect();
    let plateau = 0.5 * 1e-7 * (200e9_f64 * 7833.0).sqrt();
    assert!(apart(&own, &expected) < 1e-7 * plateau, "{:e}", apart(&own, &expected) / plateau);
}
