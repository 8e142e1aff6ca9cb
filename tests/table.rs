//! The table of shape functions: rows that are products, and rows that are lists.

use crate::cases::{CASES, advance, one_step, scene, warm};
use crate::rows::{HEADER, row};
use crate::support::*;
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::Nodes;
use lme_mpm::method::continuum::sums;
use lme_mpm::method::model::State;
use nalgebra::{SMatrix, SVector};

/// The strip with its particles moved off their places, tabulated; velocities and stresses
/// differ from particle to particle.
fn tabulated_strip<const D: usize>(basis: &BasisCase) -> State<D> {
    let (model, mut state) = at_start::<D>(&strip(D, basis.sets));
    let h = model.grid.h;
    let particle = &mut state.particle;
    for p in 0..particle.len() {
        let s = p as f64;
        let wave = |d: usize, rate: f64| (rate * s + d as f64).sin();
        particle.x[p] += SVector::from_fn(|d, _| 0.2 * h[d] * wave(d, 1.7));
        particle.v[p] = SVector::from_fn(|d, _| wave(d, 0.3));
        particle.sigma[p] = SMatrix::from_fn(|i, j| wave(i + j, 0.9) * 1e6);
    }
    state.shape = on_grid(&model.basis, &model.grid, &particle.x).unwrap().shape;
    state
}

/// The same rows, each a list of its nodes.
fn listed<const D: usize>(shape: &Shape<D>, particles: usize) -> Shape<D> {
    let mut list = Shape::default();
    for p in 0..particles {
        shape.of(p).for_each(|(I, N, grad_N)| list.push(I, N, grad_N));
        list.end_list();
    }
    list
}

/// A row is the same whether it is kept as a product or as a list: the same nodes in the same
/// order, and every sum over it the same to 1e-14 of its largest number; the linear basis,
/// B-splines and local max-ent with γ = 0.8 and 4, in 1D to 3D.
#[test]
fn table_of_products_is_a_table_of_lists() {
    fn check<const D: usize>(basis: &BasisCase) {
        let State { particle, mut node, shape, .. } = tabulated_strip::<D>(basis);
        let list = listed(&shape, particle.len());
        assert_eq!(shape.len(), list.len());
        let mut other = Nodes::blank(node.len());
        for (node, shape) in [(&mut node, &shape), (&mut other, &list)] {
            sums::mass_and_momentum(node, &particle, shape);
            sums::internal_force(node, &particle, shape);
            node.v.copy_from_slice(&node.p);
        }
        let apart = |a: &[SVector<f64, D>], b: &[SVector<f64, D>]| {
            let size = a.iter().map(|a| a.amax()).fold(0.0, f64::max);
            a.iter().zip(b).map(|(a, b)| (a - b).amax() / size).fold(0.0, f64::max)
        };
        let place = format!("{}, {D}D", basis.name);
        assert!(apart(&node.p, &other.p) < 1e-14 && apart(&node.f, &other.f) < 1e-14, "{place}");
        let mass = |node: &Nodes<D>| node.m.iter().map(|m| SVector::repeat(*m)).collect::<Vec<_>>();
        assert!(apart(&mass(&node), &mass(&other)) < 1e-14, "{place}");
        for p in 0..particle.len() {
            let v = [&shape, &list].map(|shape| sums::interpolate(&node.v, shape, p));
            assert!((v[0] - v[1]).amax() < 1e-14 * (1.0 + v[0].amax()), "{place}");
            let grad_v = [&shape, &list].map(|shape| sums::velocity_gradient(&node, shape, p));
            let largest = grad_v[0].amax().max(1.0 / 0.025);
            assert!((grad_v[0] - grad_v[1]).amax() < 1e-13 * largest, "{place}");
        }
    }
    for basis in [LINEAR, BSPLINE, LME_WIDE, LME_NARROW] {
        check::<1>(&basis);
        check::<2>(&basis);
        check::<3>(&basis);
    }
}

/// A table of products is small: of local max-ent with γ = 0.8 in 3D, which sees some 280
/// nodes here, below 1 kB for each particle; as a list it would take more than 20 times as much.
#[test]
fn table_is_small() {
    let State { particle, shape, .. } = tabulated_strip::<3>(&LME_WIDE);
    let list = listed(&shape, particle.len());
    let [product, list] = [&shape, &list].map(|shape| shape.bytes() / particle.len());
    let pairs = shape.len() / particle.len();
    assert!(product < 1000 && list > 20 * product, "{pairs} nodes: {product} and {list} bytes");
}

/// What the book's table of instructions says of nodes and bytes is so: every row of
/// `data/instructions/time-step.csv`, whose last column alone is counted elsewhere.
#[test]
fn table_of_instructions_is_current() {
    let path = format!("{}/data/instructions/time-step.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), HEADER.lines().next());
    for n in 0..CASES.len() {
        for expected in [row::<1>(n), row::<2>(n), row::<3>(n)] {
            let (counted, instructions) = lines.next().unwrap().rsplit_once(',').unwrap();
            assert_eq!(
                counted, expected,
                "`cargo bench --bench instructions -- --write` writes it"
            );
            assert!(instructions.parse::<f64>().unwrap() > 100.0);
        }
    }
    assert_eq!(lines.next(), None);
}

/// What is measured as one step does a step's work and moves nothing: Δt is 0. What is measured
/// as a time step moves the block.
#[test]
fn benches_measure_what_they_say() {
    let (model, mut state) = warm::<2>(&scene::<2>(CASES[3]));
    let before = state.particle.clone();
    for n in 1..=9 {
        one_step(n, &model, &mut state);
    }
    assert_eq!((&state.particle.x, &state.particle.v), (&before.x, &before.v));
    assert_eq!(state.particle.sigma, before.sigma);
    advance(&model, &mut state, 11);
    assert!(state.particle.x != before.x && state.particle.v != before.v);
}
