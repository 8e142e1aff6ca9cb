//! Local max-ent cut off by a box: a product of axes, each solved by itself.

use crate::support::*;
use lme_mpm::method::basis::scattered::values_at as lme_at;
use lme_mpm::method::basis::{Basis, Extents, Scratch, Support, fill_from_grid};
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::Multiplier;
use lme_mpm::method::grid::Grid;
use nalgebra::{SVector, Vector1};
use std::collections::BTreeMap;

/// Places of a grid of D axes with 8 cells of size 1: inside, near and on edges, sides,
/// corners and nodes.
fn places<const D: usize>() -> Vec<SVector<f64, D>> {
    let along: [f64; 9] = [0.0, 1e-9, 0.37, 1.0, 2.5, 3.999, 4.0, 6.81, 8.0];
    // In 3D a ninth of all triples, each pair of them once.
    let place = |n: usize| [n % 9, n / 9, (n % 9 + n / 9) % 9];
    (0..81).map(|n| SVector::from_fn(|d, _| along[place(n)[d]])).collect()
}

/// On the nodes of a box local max-ent is the product of the functions of one axis: what a
/// solver per axis and one product give is what the general solver finds on the same nodes,
/// N to 1e-14 and h∇N to 1e-13, in 2D and 3D, γ from 0.3 to 20, cut off at 1e-6 and 1e-2,
/// on sides, edges, corners and nodes too.
#[test]
fn lme_box_is_a_product() {
    fn check<const D: usize>() -> usize {
        let grid = Grid::over([8.0; D], [8; D], [[0, 0]; D]);
        let mut compared = 0;
        for (gamma, cutoff) in [(0.3, 1e-2), (0.8, 1e-6), (1.8, 1e-6), (1.8, 1e-2), (20.0, 1e-6)] {
            let basis = Basis::Lme { gamma, cutoff, support: Support::Box };
            for x in places::<D>() {
                let product = on_grid(&basis, &grid, &[x]).unwrap().row();
                let nodes: Vec<SVector<f64, D>> =
                    product.iter().map(|(I, ..)| grid.position(*I)).collect();
                let (general, _) = lme_at(&nodes, 1.0, gamma, 0.0, &x).unwrap();
                for ((n, N, grad_N), (_, expected, slope)) in general.iter().zip(&product) {
                    let place = format!("{D}D, γ = {gamma}, {cutoff:e}, {x:?}, {:?}", nodes[*n]);
                    assert!((N - expected).abs() < 1e-14, "{place}: {N:e}, {expected:e}");
                    let apart = (grad_N - slope).amax();
                    assert!(apart < 1e-13 * (1.0 + slope.amax()), "{place}: {apart:e}");
                    compared += 1;
                }
            }
        }
        compared
    }
    assert!(check::<2>() > 5_000 && check::<3>() > 20_000);
}

/// At the same tolerance the box is nearer to the functions that are not cut off than the
/// ball, and has more nodes: Σ_I |N_I − N_I without cut-off| and the same of h∇N, the mean
/// over 81 places of a grid of 8 cells along each axis, in 2D and 3D.
#[test]
fn lme_box_is_nearer_than_the_ball() {
    fn errors<const D: usize>(gamma: f64, cutoff: f64, support: Support) -> (usize, f64, f64) {
        let grid = Grid::over([8.0; D], [8; D], [[0, 0]; D]);
        let (mut nodes, mut N_error, mut grad_error) = (0, 0.0, 0.0);
        for x in places::<D>() {
            let row = |cutoff| {
                let basis = Basis::Lme { gamma, cutoff, support };
                on_grid(&basis, &grid, &[x]).unwrap().row()
            };
            let cut: BTreeMap<usize, (f64, SVector<f64, D>)> =
                row(cutoff).into_iter().map(|(I, N, grad)| (I, (N, grad))).collect();
            nodes = nodes.max(cut.len());
            for (I, N, grad) in row(0.0) {
                let (N_cut, grad_cut) = cut.get(&I).copied().unwrap_or((0.0, SVector::zeros()));
                N_error += (N - N_cut).abs() / 81.0;
                grad_error += (grad - grad_cut).amax() / 81.0;
            }
        }
        (nodes, N_error, grad_error)
    }
    let mut text =
        String::from("dimensions,γ,tolerance,nodes in the box,N,h∇N,nodes in the ball,N,h∇N\n");
    let mut compare = |D: usize, gamma: f64, cutoff: f64| {
        let of = |support| match D {
            2 => errors::<2>(gamma, cutoff, support),
            _ => errors::<3>(gamma, cutoff, support),
        };
        let (in_box, in_ball) = (of(Support::Box), of(Support::Ball));
        let place = format!("{D}D, γ = {gamma}, {cutoff:e}");
        assert!(in_box.0 >= in_ball.0, "{place}");
        assert!(in_box.1 < in_ball.1 && in_box.2 < in_ball.2, "{place}: {in_box:?}, {in_ball:?}");
        text += &format!("{D},{gamma},{cutoff:e}");
        for (nodes, N, grad) in [in_box, in_ball] {
            text += &format!(",{nodes},{N:.1e},{grad:.1e}");
        }
        text += "\n";
    };
    for gamma in [0.8, 1.8] {
        for cutoff in [1e-2, 1e-4, 1e-6] {
            compare(2, gamma, cutoff);
        }
        compare(3, gamma, 1e-2);
        compare(3, gamma, 1e-4);
    }
    approve("lme__box_and_ball", &text);
}

/// What one axis finds from where it was before is what the general search finds from λ = 0 on
/// the same nodes: N to 1e-15 and h∇N to 1e-14, for γ from 0.3 to 20, while a point marches over
/// 12 cells, from one end to the other, in steps of 1e-6 to 0.3 cells.
#[test]
fn lme_axis_is_the_general_solution() {
    let grid = Grid::over([12.0], [12], [[0, 0]]);
    let nodes: Vec<_> = (0..grid.nodes()).map(|I| grid.position(I)).collect();
    for gamma in [0.3, 0.8, 1.8, 4.0, 20.0] {
        let basis = Basis::Lme { gamma, cutoff: 1e-6, support: Support::Box };
        for (start, step, steps) in
            [(0.0, 0.1, 121), (1e-9, 0.3, 40), (3.2, 1e-3, 2000), (5.49999, 1e-6, 50)]
        {
            let (mut shape, mut scratch) = (Shape::default(), Scratch::default());
            let mut known = [Multiplier::default()];
            for n in 0..steps {
                let x = Vector1::new((start + n as f64 * step).min(12.0));
                let place = [x];
                let at = Extents::unstretched(&place);
                fill_from_grid(&mut shape, &mut scratch, &mut known, &basis, &grid, at).unwrap();
                let seen: Vec<_> = shape.of(0).map(|(I, ..)| nodes[I]).collect();
                let (general, lambda) = lme_at(&seen, 1.0, gamma, 0.0, &x).unwrap();
                for ((_, N, slope), (_, expected, expected_slope)) in shape.of(0).zip(&general) {
                    let place = format!("γ = {gamma}, {x:?} after steps of {step}");
                    assert!((N - expected).abs() < 1e-15, "{place}: {N:e}, {expected:e}");
                    let apart = (slope - expected_slope).amax();
                    assert!(apart < 1e-14 * (1.0 + expected_slope.amax()), "{place}: {apart:e}");
                }
                let apart = (known[0].lambda - lambda).amax();
                assert!(apart < 1e-12 * (1.0 + lambda.amax()), "γ = {gamma}, {x:?}: {apart:e}");
            }
        }
    }
}
