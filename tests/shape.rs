//! The functions that `lme-mpm shape` prints are those that a run uses.

use crate::support::*;
use lme_mpm::method::basis::{Basis, Degree, Support};
use lme_mpm::method::grid::Grid;
use lme_mpm::port::points::{COORDINATES, Points, ShapeQuery, shape_at};
use lme_mpm::run::table::shortest;
use nalgebra::SVector;

/// Points as CSV.
fn csv<const D: usize>(points: &[SVector<f64, D>]) -> Points {
    let line = |x: &SVector<f64, D>| x.iter().map(|x| shortest(*x)).collect::<Vec<_>>().join(",");
    let lines: Vec<String> = points.iter().map(line).collect();
    let text = format!("{}\n{}\n", COORDINATES[D - 1].join(","), lines.join("\n"));
    Points::read("points", text.as_bytes(), &COORDINATES).unwrap()
}

/// The functions and gradients that `shape` prints, point by point and node by node.
fn printed<const D: usize>(
    basis: &Basis,
    h: f64,
    nodes: &[SVector<f64, D>],
    x: &[SVector<f64, D>],
) -> Vec<Vec<[f64; 4]>> {
    let asked = ShapeQuery { basis: *basis, needs_grid: false, spacing: h, stretch: None };
    answered(&asked, nodes, x)
}

/// The same of all that can be asked.
fn answered<const D: usize>(
    asked: &ShapeQuery,
    nodes: &[SVector<f64, D>],
    x: &[SVector<f64, D>],
) -> Vec<Vec<[f64; 4]>> {
    let text = String::from_utf8(shape_at(asked, &csv(nodes), &csv(x)).unwrap()).unwrap();
    let mut table = vec![vec![[0.0; 4]; nodes.len()]; x.len()];
    for line in text.lines().skip(1) {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        table[cells[0] as usize][cells[1] as usize][..=D].copy_from_slice(&cells[2..]);
    }
    table
}

/// Points of the box of a grid, at least `margin` cells from its ends: some anywhere, some on
/// nodes, faces and corners, and next to them.
fn anywhere<const D: usize>(grid: &Grid<D>, margin: f64) -> Vec<SVector<f64, D>> {
    let near = [0.0, 1e-9, 1.0 - 1e-9, 0.5, 0.3, 0.71, 1.0];
    let place = |n: usize| {
        SVector::from_fn(|d, _| {
            let random = (1.0 + (12.9898 * (3 * n + d) as f64).sin() * 0.999) * 0.5;
            let cell = (random * grid.cells[d] as f64).floor();
            let within =
                if n.is_multiple_of(3) { random } else { near[(n / 3 + 2 * d) % near.len()] };
            let last = grid.cells[d] as f64 - margin;
            (cell + within).clamp(margin, last) * grid.h[d]
        })
    };
    (0..90).map(place).collect()
}

/// Nodes of a grid in another order than its own, as a file may have them, give to 1e-14 (of N, and
/// of h∇N) the table of a run, for every basis, width and cut-off.
fn shape_is_what_a_run_uses<const D: usize>() {
    let h = 0.25;
    let cells: [usize; D] = std::array::from_fn(|d| [6, 5, 4][d]);
    let grid = Grid::over(cells.map(|n| n as f64 * h), cells, [[0, 0]; D]);
    let own = |n: usize| (n * 11 + 3) % grid.nodes();
    let order: Vec<usize> = (0..grid.nodes()).map(own).collect();
    let nodes: Vec<SVector<f64, D>> = order.iter().map(|I| grid.position(*I)).collect();
    let mut bases = vec![
        Basis::Linear,
        Basis::Ugimp { half_length: [0.25; 3] },
        Basis::BSpline(Degree::Quadratic),
        Basis::BSpline(Degree::Cubic),
    ];
    for gamma in [0.3, 0.8, 1.8, 4.0, 8.0, 20.0] {
        for support in [Support::Box, Support::Ball] {
            bases.push(Basis::Lme { gamma, cutoff: 1e-6, support });
        }
    }
    for basis in bases {
        let margin = if let Basis::Ugimp { half_length } = basis { half_length[0] } else { 0.0 };
        let x = anywhere(&grid, margin);
        let printed = printed(&basis, h, &nodes, &x);
        let shape = on_grid(&basis, &grid, &x).unwrap().shape;
        for (p, row) in printed.iter().enumerate() {
            let mut of_run = vec![[0.0; 4]; grid.nodes()];
            for (I, N, grad) in shape.of(p) {
                of_run[I][0] = N;
                of_run[I][1..=D].copy_from_slice(grad.as_slice());
            }
            for (n, own) in row.iter().enumerate() {
                let place = format!("{basis:?}, point {p} at {:?}, node {n}", x[p]);
                for (i, (one, other)) in own.iter().zip(&of_run[order[n]]).enumerate() {
                    let unit = if i == 0 { 1.0 } else { h };
                    assert!((one - other).abs() * unit <= 1e-14, "{place}: {one} {other}");
                }
            }
        }
    }
}

#[test]
fn shape_is_what_a_run_uses_1d() {
    shape_is_what_a_run_uses::<1>();
}

#[test]
fn shape_is_what_a_run_uses_2d() {
    shape_is_what_a_run_uses::<2>();
}

#[test]
fn shape_is_what_a_run_uses_3d() {
    shape_is_what_a_run_uses::<3>();
}

/// Nodes that form no full grid have the table of OTM: nodes within R, which is at least h, and
/// widened where they do not enclose the point.
#[test]
fn shape_is_what_otm_uses() {
    let h = 0.25;
    let grid = Grid::over([1.5, 1.25], [6, 5], [[0, 0]; 2]);
    let stretched = |I: usize| {
        let x: SVector<f64, 2> = grid.position(I);
        SVector::from([1.6 * x[0] + 0.1 * x[1] * x[1], x[1] + 0.02 * (5.0 * x[0]).sin()])
    };
    let nodes: Vec<SVector<f64, 2>> = (0..grid.nodes()).map(stretched).collect();
    let x: Vec<SVector<f64, 2>> = [[0.7, 0.6], [1.1, 0.31], [0.41, 1.0]].map(SVector::from).into();
    for gamma in [0.8, 4.0, 20.0] {
        let basis = Basis::Lme { gamma, cutoff: 1e-6, support: Support::Box };
        let printed = printed(&basis, h, &nodes, &x);
        let (table, done) = on_nodes(&basis, &SVector::repeat(h), &nodes, &x);
        done.unwrap();
        for (I, p, N, grad) in table.shape.pairs() {
            assert_eq!(printed[p][I][..3], [N, grad[0], grad[1]], "γ = {gamma}");
        }
    }
}

/// GIMP's functions of a particle that has stretched are those of a particle that is so long from the start,
/// to the last bit, as long as uGIMP takes one; beyond that ΣN = 1 and Σ N x = x hold to 1e-15, up to a
/// domain of two cells, and a longer one is refused by name.
#[test]
fn shape_of_stretched_particles() {
    let h = 0.25;
    let nodes: Vec<SVector<f64, 1>> = (0..9).map(|n| SVector::from([n as f64 * h])).collect();
    let x: Vec<SVector<f64, 1>> = (0..20).map(|n| SVector::from([0.5 + 0.05 * n as f64])).collect();
    let basis = Basis::Gimp { half_length: [0.25; 3] };
    let asked =
        |stretch: f64| ShapeQuery { basis, needs_grid: false, spacing: h, stretch: Some(stretch) };
    for stretch in [0.5, 1.0, 1.5, 2.0] {
        let longer = Basis::Ugimp { half_length: [0.25 * stretch; 3] };
        assert_eq!(answered(&asked(stretch), &nodes, &x), printed(&longer, h, &nodes, &x));
    }
    for (row, x) in answered(&asked(3.9), &nodes, &x).iter().zip(&x) {
        let sum = |of: &dyn Fn(usize) -> f64| (0..9).map(|I| row[I][0] * of(I)).sum::<f64>();
        assert!((sum(&|_| 1.0) - 1.0).abs() < 1e-15);
        assert!((sum(&|I| nodes[I][0]) - x[0]).abs() < 1e-15);
        assert!((3..=4).contains(&row.iter().filter(|entry| entry[0] > 0.0).count()));
    }
    let fault = shape_at(&asked(4.1), &csv(&nodes), &csv(&x)).unwrap_err().to_string();
    assert!(fault.contains("--stretch"), "{fault}");
}
