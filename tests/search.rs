//! OTM's search: which nodes a material point sees, and what looking for them costs.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::bins::Bins;
use lme_mpm::method::basis::{Basis, Support};
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::cost::Cost;
use lme_mpm::method::time::otm;
use nalgebra::{Vector1, Vector2};

/// The search finds what looking at all nodes finds, wherever they stand, and the
/// table is the one of `scattered::values_at`.
#[test]
fn otm_neighbours_are_complete() {
    let h = Vector2::new(0.1, 0.07);
    let place = |n: usize| {
        let s = n as f64;
        let grid = Vector2::new((n % 20) as f64 * h[0], (n / 20) as f64 * h[1]);
        grid + Vector2::new((7.3 * s).sin() * h[0], (3.1 * s).cos() * h[1]) * 0.3
    };
    let mut nodes: Vec<Vector2<f64>> = (0..400).map(place).collect();
    nodes.push(Vector2::new(1e6, -1e6)); // far off, and no reason for a million boxes
    let mut bins = Bins::default();
    for reach in [0.4, 1.3, 2.6, 1e9, f64::INFINITY] {
        bins.sort(&nodes, &h, f64::min(reach, 10.0));
        for p in 0..60 {
            let x = place(5 * p) + h * 0.21;
            let near = |a: &usize| {
                let xi = (x - nodes[*a]).component_div(&h);
                xi.dot(&xi) <= reach * reach
            };
            let mut found: Vec<usize> =
                bins.near(&x.component_div(&h), reach).filter(near).collect();
            found.sort_unstable();
            let all: Vec<usize> = (0..nodes.len()).filter(near).collect();
            assert_eq!(found, all);
        }
    }
}

/// The work of the search grows like the number of particles: the candidates per
/// particle and step stay what they are on 16 times as many.
#[test]
fn otm_search_is_linear() {
    let candidates = |cells: usize| {
        let cells = format!("grid.cells=[{cells},{cells}]");
        let cost = finished(&block(2, &[&cells, "time.end=0.005"])).cost;
        (cost.candidates as f64 / cost.basis_evaluations as f64, cost.particle_node_pairs)
    };
    let (few, pairs) = candidates(12);
    let (many, more_pairs) = candidates(48);
    assert!(more_pairs > 15 * pairs);
    assert!(many < 1.25 * few, "{few} and {many}");
}

/// Stretched to three times its length the body keeps its neighbours, because the
/// radius widens; a particle outside the hull of all nodes is a typed error.
#[test]
fn otm_keeps_enough_neighbours() {
    let scene = scene(DYKA_OTM, &["basis.gamma=6"]);
    let model = lme_mpm::setup::model::<1>(&scene);
    let mut state = lme_mpm::setup::initial_state(&model, &scene);
    for x in state.node.x.iter_mut().chain(&mut state.particle.x) {
        *x *= 3.0;
    }
    let (nodes, x) = (&state.node.x, &state.particle.x);
    let (Tabulated { shape, .. }, done) = on_nodes(&model.basis, &model.grid.h, nodes, x);
    done.unwrap();
    for p in 0..x.len() {
        let mean: f64 = shape.of(p).map(|(a, N_ap, _)| N_ap * nodes[a][0]).sum();
        assert_relative_eq!(mean, x[p][0], max_relative = 1e-13);
    }
    state.particle.x[7][0] = -1e-3;
    let stopped = otm::start(&mut state, &model).unwrap_err();
    assert!(matches!(stopped, Breakdown::NoBasis { particle: 7, .. }), "{stopped}");
    let mut state = lme_mpm::setup::initial_state(&model, &scene);
    state.particle.x[3][0] = f64::NAN;
    let stopped = otm::start(&mut state, &model).unwrap_err();
    assert!(matches!(stopped, Breakdown::NotFinite { particle: 3, .. }), "{stopped}");
}

/// Boxes hold every node within reach and few others, wherever the nodes stand.
#[test]
fn otm_boxes_hold_all_within_reach() {
    for shift in [[3.0, -7.0], [-40.0, 5.5], [0.0, 0.0]] {
        let nodes: Vec<Vector2<f64>> = (0..144)
            .map(|n| Vector2::new((n % 12) as f64 + shift[0], (n / 12) as f64 + shift[1]))
            .collect();
        let mut bins = Bins::<2>::default();
        bins.sort(&nodes, &Vector2::new(1.0, 1.0), 1.5);
        for at in [[0.2, 0.3], [5.7, 6.1], [10.9, 0.4], [3.5, 10.99]] {
            let x = Vector2::new(at[0] + shift[0], at[1] + shift[1]);
            let near: Vec<usize> = bins.near(&x, 1.5).collect();
            assert!(near.len() <= 36, "{shift:?}, {at:?}: {}", near.len());
            for (n, node) in nodes.iter().enumerate() {
                assert!((node - x).norm() > 1.5 || near.contains(&n), "{shift:?}, {at:?}: {n}");
            }
        }
    }
}

/// A table of nodes in 1D with the spacing 1, or its refusal, with its cost.
fn row(basis: &Basis, nodes: &[f64], x: &[f64]) -> (Option<Vec<f64>>, Cost) {
    let [nodes, x] =
        [nodes, x].map(|list| list.iter().map(|x| Vector1::new(*x)).collect::<Vec<_>>());
    let (Tabulated { shape, cost, .. }, done) = on_nodes(basis, &Vector1::new(1.0), &nodes, &x);
    (done.ok().map(|()| shape.pairs().map(|(_, _, N, _)| N).collect()), cost)
}

/// The search widens by half until the point is enclosed, and stops when there are no
/// more nodes to be seen.
#[test]
fn otm_search_widens_step_by_step() {
    let basis = Basis::Lme { gamma: 4.0, cutoff: 1e-6, support: Support::Ball };
    // R = 1.86, then 2.79, which sees 0 and 5 but not −0.6.
    let (found, _) = row(&basis, &[-0.6, 0.0, 5.0], &[2.4]);
    let found = found.unwrap();
    assert_eq!(found.len(), 2);
    assert_relative_eq!(found[1], 0.48, max_relative = 1e-13);
    // Outside: seen one of two, then both, and then refused.
    let (refused, cost) = row(&basis, &[0.0, 1.0], &[-1.0]);
    assert_eq!((refused, cost.candidates), (None, 4));
}

/// What two points cost is what each of them costs.
#[test]
fn otm_costs_add_up() {
    let basis = Basis::Lme { gamma: 1.8, cutoff: 1e-6, support: Support::Ball };
    let nodes = [0.0, 0.9, 2.1, 3.0, 4.2];
    let of = |x: &[f64]| row(&basis, &nodes, x).1;
    let (one, other, both) = (of(&[1.3]), of(&[2.6]), of(&[1.3, 2.6]));
    assert!(one.exponentials > 4 && one.newton_iterations > 1);
    assert_eq!(both.exponentials, one.exponentials + other.exponentials);
    assert_eq!(both.newton_iterations, one.newton_iterations + other.newton_iterations);
}

/// The linear functions of OTM at its first and last node, and beyond.
#[test]
fn otm_linear_at_the_ends() {
    let at = |x: f64| row(&Basis::Linear, &[0.0, 1.0, 2.5], &[x]).0;
    assert_eq!(at(0.0), Some(vec![1.0, 0.0]));
    assert_eq!(at(2.5), Some(vec![0.0, 1.0]));
    assert_eq!((at(-1e-9), at(2.5 + 1e-9)), (None, None));
}
