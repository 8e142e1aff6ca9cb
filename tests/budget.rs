//! What a run may take, memory and work, is known before its first step. Each test says its
//! GOAL, its SETUP and what is EXPECTED.

use crate::support::program::*;
use crate::support::*;
use lme_mpm::run::{parse, parse_within, run_knowing};
use lme_mpm::scene::{Budget, Scene};
use nalgebra_sparse::factorization::CscSymbolicCholesky;
use nalgebra_sparse::pattern::SparsityPattern;
use std::fs;
use std::ops::ControlFlow;
use std::process::Command;

/// The entries of the consistent mass matrix of a scene with its body moved by a fifth of a cell
/// along every axis, and of its factor L.
fn counted(scene: &Scene) -> [f64; 2] {
    match scene.dimension() {
        1 => counted_in::<1>(scene),
        2 => counted_in::<2>(scene),
        _ => counted_in::<3>(scene),
    }
}

fn counted_in<const D: usize>(scene: &Scene) -> [f64; 2] {
    let (model, state) = at_start::<D>(scene);
    let x: Vec<_> = state.particle.x.iter().map(|x| x + 0.2 * model.grid.h).collect();
    let shape = on_grid(&model.basis, &model.grid, &x).unwrap().shape;
    let nodes = model.grid.nodes();
    let mut coupled = vec![false; nodes * nodes];
    for (I, p, _, _) in shape.pairs() {
        for (J, _, _) in shape.of(p) {
            coupled[I * nodes + J] = true;
        }
    }
    let (mut offsets, mut indices) = (vec![0], Vec::new());
    for row in coupled.chunks(nodes) {
        indices.extend((0..nodes).filter(|J| row[*J]));
        offsets.push(indices.len());
    }
    let entries = indices.len();
    let pattern =
        SparsityPattern::try_from_offsets_and_indices(nodes, nodes, offsets, indices).unwrap();
    let symbolic = CscSymbolicCholesky::factor(pattern);
    [entries as f64, symbolic.l_pattern().nnz() as f64]
}

/// GOAL: what is predicted for the factors of the consistent mass matrix is enough, and no more
/// than twice what they take.
/// SETUP: the strip of the bar, in 1D to 3D, with as many cells along every axis, and every basis;
/// the pattern of the matrix is factorised, with the body moved by a fifth of a cell.
/// EXPECTED: predicted entries of L from one to two times those counted, and of the matrix as many
/// as counted or more.
#[test]
fn budget_of_the_factor() {
    for (dimension, cells) in [(1, 40), (2, 24), (3, 8)] {
        for BasisCase { name, sets, .. } in BASES {
            let cells = format!("grid.cells={}", each_axis(dimension, &cells.to_string()));
            let scene = strip(dimension, &[sets, &["mass=consistent", &cells]].concat());
            let [entries, factor] = counted(&scene);
            let (predicted, most) = (scene.factor_entries(), scene.mass_entries());
            let place = format!("{name} in {dimension}D: {predicted} for {factor} entries");
            println!("{place}: {:.2} ({most} for {entries})", predicted / factor);
            assert!(factor <= predicted && predicted <= 2.0 * factor, "{place}");
            assert!(entries <= most, "{place}");
        }
    }
}
