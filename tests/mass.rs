//! The consistent mass matrix (13): its sums, its solutions, and its limits.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::breakdown::{Breakdown, BrokenDown};
use lme_mpm::method::continuum::mass::{ConsistentMass, MassMatrix};
use lme_mpm::method::continuum::state::{Nodes, Particles};
use lme_mpm::method::continuum::sums;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::model::{Model, State};
use lme_mpm::run::run;
use lme_mpm::scene::Scene;
use nalgebra::{DMatrix, DVector, Vector1, Vector2};

/// A scene's particles, moved off their places, with masses that differ, and
/// tabulated; nodes with m_I and p_I.
fn loose<const D: usize>(scene: &Scene) -> (Model<D>, State<D>) {
    let (model, mut state) = at_start::<D>(scene);
    let h = model.grid.h;
    let particle = &mut state.particle;
    for p in 0..particle.len() {
        let s = p as f64;
        for d in 0..D {
            particle.x[p][d] += 0.2 * h[d] * (1.7 * s + d as f64).sin();
            particle.v[p][d] = (0.3 * s + d as f64).sin();
        }
        particle.m[p] *= 1.0 + 0.3 * (0.9 * s).cos();
    }
    state.shape = on_grid(&model.basis, &model.grid, &state.particle.x).unwrap().shape;
    sums::mass_and_momentum(&mut state.node, &state.particle, &state.shape);
    (model, state)
}

fn consistent<const D: usize>(nodes: usize, fixed: &[(usize, usize)]) -> MassMatrix<D> {
    MassMatrix::Consistent(Box::new(ConsistentMass::blank(nodes, fixed)))
}

/// The bar on 12 cells with three particles in each and the consistent mass.
fn bar(sets: &[&str]) -> Scene {
    dyka(&[sets, &["mass=consistent", "grid.cells=12", "grid.particles_per_cell=3"]].concat())
}

/// The solution meets Σ_J m_IJ v_J = p_I to 1e-12, with every basis: the sum of (13) as a
/// dense matrix, multiplied out. Its sum stays, so no momentum is lost. A free bar of 12
/// cells with three loose particles in each.
#[test]
fn mass_solves_what_13_says() {
    for BasisCase { name, sets, reaches_far, .. } in BASES {
        let scene = bar(&[sets, &["boundary.left=free", "grid.beyond.left=1"]].concat());
        let (model, mut state) = loose::<1>(&scene);
        let (node, particle, shape) = (&mut state.node, &state.particle, &state.shape);
        let n = node.len();
        let mut M = DMatrix::<f64>::zeros(n, n);
        for (I, p, N_Ip, _) in shape.pairs() {
            for (J, N_Jp, _) in shape.of(p) {
                M[(I, J)] += N_Ip * particle.m[p] * N_Jp;
            }
        }
        // Light nodes, seen from afar only, are lumped.
        let light: Vec<bool> = (0..n).map(|I| M[(I, I)] < 0.25 * node.m[I]).collect();
        let used = light.contains(&true);
        assert!(used || !reaches_far, "{name}: the rule for light nodes is not used");
        for I in 0..n {
            for J in 0..I {
                if light[I] || light[J] {
                    let both = M[(I, J)];
                    M[(I, I)] += both;
                    M[(J, J)] += both;
                    M[(I, J)] = 0.0;
                    M[(J, I)] = 0.0;
                }
            }
        }
        let mut mass = consistent(n, &model.fixed);
        mass.assemble(particle, shape, &node.m).unwrap();
        mass.solve(&mut node.v, &node.p, &node.m);
        let v = DVector::from_fn(n, |I, _| node.v[I][0]);
        let scale = largest(node.p.iter().map(|p| p[0]));
        for I in 0..n {
            let product: f64 = (0..n).map(|J| M[(I, J)] * v[J]).sum();
            assert!((product - node.p[I][0]).abs() < 1e-12 * scale, "{name}, node {I}");
        }
        let brought: f64 = node.p.iter().map(|p| p[0]).sum();
        let carried: f64 = (0..n).map(|I| node.m[I] * node.v[I][0]).sum();
        assert_relative_eq!(carried, brought, epsilon = 1e-12 * scale);
        assert_eq!((mass.cost().factorizations, mass.cost().solves), (1, 1));
    }
}

/// With light nodes, on a disc and on a free block, particles moved off their places, with
/// every basis: the matrix is symmetric, has the row sums m_I and m_II ≥ m_I/16, and vᵀmv is
/// at least that of (13) as it stands and at most 1 + D times that of the lumped one, all to
/// 1e-10. The matrix is taken from what it solves.
#[test]
fn mass_with_light_nodes_keeps_its_promises() {
    let disc = ["body.ball=[{ centre = [0.5, 0.5], radius = 0.45 }]", "grid.cells=[5,5]"];
    let block = ["body.ball=[]", "grid.cells=[4,3]"];
    for (BasisCase { name, sets, .. }, body) in
        BASES.iter().flat_map(|basis| [(basis, disc), (basis, block)])
    {
        let whole = "initial_velocity=[{ from = [0,0], to = [1,1], velocity = [1,0] }]";
        let scene = scene(DISCS, &[CONSISTENT.sets, sets, &body, &[whole]].concat());
        let (model, state) = loose::<2>(&scene);
        let State { particle, node, shape, .. } = &state;
        let heavy: Vec<usize> = (0..node.len()).filter(|I| node.m[*I] > 0.0).collect();
        let n = heavy.len();
        let root = DVector::from_fn(n, |i, _| node.m[heavy[i]].sqrt());
        // (13) as it stands, and what stands in its place, each over √(m_I m_J).
        let mut plain = DMatrix::<f64>::zeros(node.len(), node.len());
        for (I, p, N_Ip, _) in shape.pairs() {
            for (J, N_Jp, _) in shape.of(p) {
                plain[(I, J)] += N_Ip * particle.m[p] * N_Jp;
            }
        }
        let plain =
            DMatrix::from_fn(n, n, |i, j| plain[(heavy[i], heavy[j])] / (root[i] * root[j]));
        let mut mass = consistent(model.grid.nodes(), &[]);
        mass.assemble(particle, shape, &node.m).unwrap();
        let mut inverse = DMatrix::<f64>::zeros(n, n);
        let mut v = node.v.clone();
        for (j, J) in heavy.iter().enumerate() {
            let mut unit = vec![Vector2::zeros(); node.len()];
            unit[*J][0] = root[j];
            mass.solve(&mut v, &unit, &node.m);
            for (i, I) in heavy.iter().enumerate() {
                inverse[(i, j)] = v[*I][0] * root[i];
            }
        }
        let M = inverse.try_inverse().unwrap();
        let sums = &M * &root - &root;
        assert!(sums.amax() < 1e-10, "{name}: row sums off by {:e}", sums.amax());
        let asymmetry = (&M - M.transpose()).amax();
        assert!(asymmetry < 1e-10, "{name}: {asymmetry:e}");
        let own = M.diagonal().min();
        assert!(own > 1.0 / 16.0 - 1e-10, "{name}: {own}");
        assert!(body == block || plain.diagonal().min() < 1.0 / 16.0, "{name}: none is light");
        let more = (&M - plain).symmetric_eigenvalues().min();
        assert!(more > -1e-10, "{name}: {more:e}");
        let most = M.symmetric_eigenvalues().max();
        assert!(most < 3.0 + 1e-10, "{name}: {most}");
    }
}

/// An affine velocity of the particles is found again at the nodes, to 1e-12, which the
/// lumped matrix cannot do; in 2D, 5 × 4 cells.
#[test]
fn mass_finds_an_affine_velocity() {
    let scene = scene(DISCS, &[CONSISTENT.sets, &["body.ball=[]", "grid.cells=[5,4]"]].concat());
    let (model, mut state) = loose::<2>(&scene);
    let (node, particle, shape) = (&mut state.node, &mut state.particle, &mut state.shape);
    let affine = |x: &Vector2<f64>| Vector2::new(1.0 + 2.0 * x[0] - x[1], 0.5 * x[0] + 3.0 * x[1]);
    for p in 0..particle.len() {
        particle.v[p] = affine(&particle.x[p]);
    }
    let mut furthest_off = |mut mass: MassMatrix<2>| {
        node.p.fill(Vector2::zeros());
        sums::momentum(node, particle, shape);
        mass.assemble(particle, shape, &node.m).unwrap();
        mass.solve(&mut node.v, &node.p, &node.m);
        // Light nodes beyond the body, one cell beyond each free side, are lumped.
        let inside = |I: usize| {
            let [i, j] = model.grid.index(I);
            (1..=6).contains(&i) && (1..=5).contains(&j) && node.m[I] > 0.0
        };
        let off = |I: usize| (node.v[I] - affine(&model.grid.position(I))).norm();
        largest((0..node.len()).filter(|I| inside(*I)).map(off))
    };
    let lumped = furthest_off(MassMatrix::Lumped);
    let solved = furthest_off(consistent(model.grid.nodes(), &[]));
    assert!(lumped > 0.05 && solved < 1e-12, "{lumped} {solved:e}");
}

/// There is one system for components that are fixed alike, one for each where they
/// differ; a fixed component stays 0, and the other is what it would be alone, bit by bit.
/// A block of 3 × 2 cells, fixed on the left.
#[test]
fn mass_of_components_fixed_differently() {
    let strip = "title = 'strip'\nmethod = 'mpm'\nmass = 'consistent'\nbasis.kind = 'linear'\n\
         body = { length = [1, 1], density = 1, youngs_modulus = 1, poisson_ratio = 0 }\n\
         grid = { cells = [3, 2], particles_per_cell = [2, 2] }\n\
         time = { integrator = 'newmark', cfl = 0.3, end = 1 }\n";
    for (boundary, systems) in [("left = 'fixed'", 1), ("left = { x = 'fixed' }", 2)] {
        let scene = scene(&format!("{strip}boundary.{boundary}\n"), &[]);
        let (model, mut state) = loose::<2>(&scene);
        let node = &mut state.node;
        for (I, i) in &model.fixed {
            node.p[*I][*i] = 0.0;
        }
        let mut mass = consistent(node.len(), &model.fixed);
        mass.assemble(&state.particle, &state.shape, &node.m).unwrap();
        mass.solve(&mut node.v, &node.p, &node.m);
        assert_eq!((mass.cost().factorizations, mass.cost().solves), (systems, 2));
        for (I, i) in &model.fixed {
            assert_eq!(node.v[*I][*i], 0.0);
        }
        // The second component by itself: fixed as the first is, or free.
        let others = if systems == 1 { model.fixed.clone() } else { Vec::new() };
        let (_, mut alone) = loose::<2>(&scene);
        for (I, i) in &others {
            alone.node.p[*I][*i] = 0.0;
        }
        let mut mass = consistent(alone.node.len(), &others);
        let Nodes { m, p, v, .. } = &mut alone.node;
        mass.assemble(&alone.particle, &alone.shape, m).unwrap();
        mass.solve(v, p, m);
        for (together, alone) in state.node.v.iter().zip(v) {
            assert_eq!(together[1], alone[1]);
        }
    }
}

/// Fewer particles than free nodes cannot determine their velocities: named,
/// with the step, before any step is taken.
#[test]
fn mass_singular_is_named() {
    let one_each = ["mass=consistent", "grid.particles_per_cell=1", "boundary.left=free"];
    let stopped = run(&dyka(&one_each), &mut |_| {}).unwrap_err();
    let BrokenDown { breakdown, moment } = &stopped.broken;
    assert_eq!(*breakdown, Breakdown::SingularMass { particles: 40, nodes: 41 });
    assert_eq!(moment.step, 0);
    let text = stopped.broken.to_string();
    assert!(text.contains("singular") && text.contains("mass = \"lumped\""), "{text}");
    // Two particles in each cell determine them.
    run(&dyka(&["mass=consistent", "boundary.left=free", "time.cfl=0.3"]), &mut |_| {}).unwrap();
}

/// One particle between two nodes has a singular matrix, of rank one, unless one of the
/// two is light: with N = 1/4 it is not yet, one bit further it is.
#[test]
fn mass_is_light_below_a_quarter() {
    let assembled = |x: f64| {
        let grid = Grid::over([1.0], [1], [[0, 0]]);
        let mut particle = Particles::at_rest(vec![Vector1::new(x)], 1.0);
        particle.m = vec![1.0];
        let mut node = Nodes::<1>::blank(2);
        let Tabulated { shape, .. } = on_grid(&Basis::Linear, &grid, &particle.x).unwrap();
        sums::mass_and_momentum(&mut node, &particle, &shape);
        consistent(2, &[]).assemble(&particle, &shape, &node.m)
    };
    assert!(assembled(0.25).is_err());
    assert!(assembled(0.25 - f64::EPSILON / 4.0).is_ok());
}

/// A particle that has passed a node by ε gives it the mass ε m_p. It is light,
/// and lumped: no ε from 0.2 to 1e-15 sends the particle off or takes a smaller time step.
/// The bar to its end, no particle half as fast again as its end is otherwise.
#[test]
fn mass_of_a_light_node_does_no_harm() {
    let scene = dyka(&["mass=consistent", "time.cfl=0.35"]);
    let calm = largest(column(&finished(&scene).history, "velocity_end"));
    for epsilon in [0.2, 1e-2, 1e-4, 1e-8, 1e-15] {
        let (model, mut state) = at_start::<1>(&scene);
        let last = state.particle.len() - 1;
        state.particle.x[last][0] = 0.1333 + epsilon * model.grid.h[0];
        march(&model, &mut state, model.steps);
        let fastest = largest(state.particle.v.iter().map(|v| v[0]));
        assert!(fastest < 1.5 * calm, "ε = {epsilon}: {fastest}");
    }
}

/// The errors of v and σ are within a tenth of the figures of an independent prototype:
/// local max-ent γ = 0.8, three particles per cell, cΔt/h = 0.35, 40 and 160 cells.
#[test]
fn mass_consistent_meets_the_prototype() {
    let own = ["grid.particles_per_cell=3", "time.cfl=0.35"];
    for (cells, v, sigma) in [(40, 0.071, 0.153), (160, 0.063, 0.118)] {
        let cells = format!("grid.cells={cells}");
        let scene = dyka(&[CONSISTENT.sets, LME_WIDE.sets, &own, &[&cells]].concat());
        let here = bar_errors(&scene, &finished(&scene));
        assert!((here.v / v - 1.0).abs() < 0.1, "{cells}: {here:?}");
        assert!((here.sigma / sigma - 1.0).abs() < 0.1, "{cells}: {here:?}");
    }
}
