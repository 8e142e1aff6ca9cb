//! The null-space filter: a projection that no node feels, and what it is worth.

use crate::support::*;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::continuum::filter::null_space;
use lme_mpm::method::continuum::state::{Nodes, Particles};
use lme_mpm::method::continuum::sums;
use lme_mpm::method::grid::{Grid, odometer};
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time::steps;
use lme_mpm::run::parse;
use lme_mpm::scene::DYKA;
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use std::fmt::Write;

/// A bar of eight cells whose particles have random places in it, masses, densities and
/// stresses, with its table.
fn shaken(sets: &[&str]) -> (Model<1>, State<1>) {
    let sets = [&["grid.cells=8", "grid.particles_per_cell=3"], sets].concat();
    let (model, mut state) = at_start::<1>(&dyka(&sets));
    let mut random = unit_numbers();
    let h = model.grid.h[0];
    let State { particle, shape, scratch, .. } = &mut state;
    for p in 0..particle.len() {
        let cell = (particle.x[p][0] / h).floor();
        particle.x[p][0] = (cell + 0.05 + 0.9 * random()) * h;
        particle.m[p] *= 0.5 + random();
        particle.rho[p] *= 0.5 + random();
        particle.sigma[p] = SMatrix::from_element(random() - 0.5);
    }
    steps::tabulate(shape, scratch, particle, &model).unwrap();
    (model, state)
}

/// Numbers from 0 to 1, the same every time.
fn unit_numbers() -> impl FnMut() -> f64 {
    let mut n = 0.0;
    move || {
        n += 1.0;
        (n * 0.618_033_988_749_894_9_f64).fract() // the golden ratio fills the interval evenly
    }
}

/// The stresses, projected onto the range of the strain operator B_pI = ∇N_Ip in the inner
/// product of the volumes: B (BᵀVB)⁺ BᵀV σ.
fn projected(state: &State<1>, nodes: usize) -> Vec<f64> {
    let particle = &state.particle;
    let mut B = DMatrix::zeros(particle.len(), nodes);
    for (I, p, _, grad_N_Ip) in state.shape.pairs() {
        B[(p, I)] = grad_N_Ip[0];
    }
    let volume = |p: usize| particle.m[p] / particle.rho[p];
    let V = DMatrix::from_diagonal(&DVector::from_fn(particle.len(), |p, _| volume(p)));
    let sigma = DVector::from_fn(particle.len(), |p, _| particle.sigma[p][0]);
    let normal = B.transpose() * &V * &B;
    let eps = 1e-12 * normal.amax();
    let inverse = normal.pseudo_inverse(eps).unwrap();
    (&B * inverse * B.transpose() * V * sigma).iter().copied().collect()
}

fn stresses(state: &State<1>) -> Vec<f64> {
    state.particle.sigma.iter().map(|sigma| sigma[0]).collect()
}

/// With linear functions in 1D the projection is the filter, to 1e-13 of stresses of size 1; with
/// B-splines and local max-ent it is another thing, by more than a tenth.
#[test]
fn null_space_is_a_projection() {
    let apart_of = |sets: &[&str]| {
        let (model, mut state) = shaken(sets);
        let expected = projected(&state, model.grid.nodes());
        null_space(&mut state.particle, &model.grid);
        apart(&stresses(&state), &expected)
    };
    let linear = apart_of(&["basis.kind=linear"]);
    assert!(linear < 1e-13, "{linear:e}");
    for sets in [&["basis.kind=bspline"][..], &["basis.kind=lme", "basis.gamma=0.8"]] {
        let other = apart_of(sets);
        assert!(other > 0.1, "{sets:?}: {other:e}");
    }
}

/// No force (14) changes by more than 1e-14 with linear functions in 1D, where most stresses
/// change; the projection of any basis changes none, to 1e-11, and the filter of B-splines does.
#[test]
fn null_space_changes_no_force() {
    let forces = |state: &mut State<1>| -> Vec<f64> {
        let State { node, particle, shape, .. } = state;
        node.f.fill(SVector::zeros());
        sums::internal_force(node, particle, shape);
        node.f.iter().map(|f| f[0]).collect()
    };
    let (model, mut state) = shaken(&["basis.kind=linear"]);
    let (before, sigma) = (forces(&mut state), stresses(&state));
    null_space(&mut state.particle, &model.grid);
    assert!(apart(&forces(&mut state), &before) < 1e-14);
    assert!(apart(&stresses(&state), &sigma) > 0.3);
    for kind in ["basis.kind=linear", "basis.kind=ugimp", "basis.kind=bspline"] {
        let (model, mut state) = shaken(&[kind]);
        let before = forces(&mut state);
        let expected = projected(&state, model.grid.nodes());
        for (sigma, expected) in state.particle.sigma.iter_mut().zip(expected) {
            *sigma = SMatrix::from_element(expected);
        }
        let off = apart(&forces(&mut state), &before);
        assert!(off < 1e-11, "{kind}: {off:e}");
    }
    let (model, mut state) = shaken(&["basis.kind=bspline"]);
    let before = forces(&mut state);
    null_space(&mut state.particle, &model.grid);
    assert!(apart(&forces(&mut state), &before) > 1e-2);
}

/// On the bar, whose particles stay in their cells, the linear basis gives with the filter what it
/// gives without, to 1e-9 of v_0. Without the key no stress is counted, and with it two in each cell
/// and step.
#[test]
fn null_space_does_nothing_on_the_bar() {
    let sets = ["grid.cells=80", "time.cfl=0.5"];
    let plain = finished(&dyka(&sets));
    let filtered = finished(&dyka(&[&sets[..], &["filter=null-space"]].concat()));
    let velocity = |outcome: &lme_mpm::run::Outcome| column(&outcome.history, "velocity_end");
    let off = apart(&velocity(&plain), &velocity(&filtered));
    assert!(off < 5e-9, "{off:e}");
    assert_eq!(plain.cost.filtered_stresses, 0);
    assert_eq!(filtered.cost.filtered_stresses, 160 * (filtered.cost.steps + 1));
}

/// Across cells the filter takes 45% or more of the error in velocity and stress from uGIMP, with
/// two particles per cell and with four, and more than 5% of the energy with it; from linear functions
/// 45% of the energy or more. Quadratic B-splines gain as much, though the mean of
/// a cell is no projection for them.
#[test]
fn null_space_across_cells() {
    let mut table = String::from(
        "basis,particles per cell,filter,velocity,stress,displacement,energy at the end\n",
    );
    for kind in ["linear", "ugimp", "bspline"] {
        for per_cell in [2, 4] {
            let [plain, filtered] = ["none", "null-space"].map(|filter| {
                let sets = [
                    format!("basis.kind={kind}"),
                    format!("grid.particles_per_cell={per_cell}"),
                    format!("filter={filter}"),
                    "check.energy=1e3".to_string(),
                ];
                let scene = crossing(&strs(&sets));
                let Each { v, sigma, u } = over_time(&scene).unwrap();
                let energy = total_energy(&finished(&scene).history);
                let left = energy[energy.len() - 1] / energy[0];
                write!(table, "{kind},{per_cell},{filter},{v:.1e},{sigma:.1e},{u:.1e},").unwrap();
                writeln!(table, "{left:.2}").unwrap();
                [v, sigma, left]
            });
            if kind == "linear" {
                assert!(filtered[2] < 0.55, "{table}");
                continue;
            }
            assert!(filtered[0] < 0.55 * plain[0] && filtered[1] < 0.55 * plain[1], "{table}");
            assert!(filtered[2] < 0.95 && plain[2] > 0.95, "{table}");
        }
    }
    approve("null_space__crossing", &table);
}

/// The predicted limit holds with the filter, too: a projection makes no wave faster. At 0.99 of
/// the limit the energy of the bar stays within half of what it is at first, over eight periods, whether the
/// filter of the basis is a projection or not.
#[test]
fn null_space_keeps_the_limit() {
    for kind in ["linear", "ugimp", "bspline"] {
        let kind = format!("basis.kind={kind}");
        let end = format!("time.end={}", 32.0 * transit());
        let sets = ["grid.cells=20", "filter=null-space", "time.cfl=10", "check.energy=1e3", &kind];
        let scene = dyka(&[&sets[..], &["time.fraction_of_critical=0.99", &end]].concat());
        let (first, last) = means_of_tenths(&total_energy(&finished(&scene).history));
        assert!(last < 1.5 * first, "{kind}: {first} {last}");
    }
}

/// What makes no sense with the filter is refused, by key and allowed words.
#[test]
fn null_space_is_refused_where_it_means_nothing() {
    let refused = |text: &str, sets: &[&str]| {
        let sets: Vec<String> =
            ["filter=null-space"].iter().chain(sets).map(ToString::to_string).collect();
        let error = parse("test", "test.toml", text, &sets).unwrap_err().to_string();
        assert!(error.contains("filter") && error.contains("\"none\""), "{error}");
        error
    };
    assert!(refused(DYKA_OTM, &[]).contains("otm"));
    assert!(refused(DYKA, &["body.law=hencky"]).contains("deformation gradient"));
    assert!(refused(DYKA, &["time.integrator=implicit-newmark"]).contains("implicit"));
    assert!(refused(DYKA, &["filter=mean"]).contains("filter"));
}

/// How many of a cell's stresses its nodes feel, before the filter and after it: the rank of the map from
/// the stresses of 2^D particles in a cell to the forces on its nodes, and of the same map behind the filter.
fn felt<const D: usize>() -> [usize; 2] {
    let grid = Grid::<D>::over([1.0; D], [1; D], [[0, 0]; D]);
    let places = odometer([2; D]).map(|at| SVector::from_fn(|d, _| 0.25 + 0.5 * at[d] as f64));
    let x: Vec<SVector<f64, D>> = places.collect();
    let shape = on_grid(&Basis::Linear, &grid, &x).unwrap().shape;
    let mut particle = Particles::at_rest(x, 1.0);
    particle.m.fill(0.5_f64.powi(D as i32));
    let mut columns: [Vec<Vec<f64>>; 2] = [Vec::new(), Vec::new()];
    for p in 0..particle.len() {
        for (i, j) in (0..D).flat_map(|i| (i..D).map(move |j| (i, j))) {
            for (filtered, columns) in columns.iter_mut().enumerate() {
                particle.sigma.fill(SMatrix::zeros());
                particle.sigma[p][(i, j)] = 1.0;
                particle.sigma[p][(j, i)] = 1.0;
                if filtered == 1 {
                    null_space(&mut particle, &grid);
                }
                let mut node = Nodes::blank(grid.nodes());
                sums::internal_force(&mut node, &particle, &shape);
                columns.push(node.f.iter().flat_map(|f| f.iter().copied()).collect());
            }
        }
    }
    columns.map(|columns| {
        DMatrix::from_fn(columns[0].len(), columns.len(), |row, column| columns[column][row])
            .rank(1e-10)
    })
}

/// In 1D a cell's nodes feel one stress, and the filter leaves it. In 2D they feel five: three that are
/// uniform, and two that resist the hourglass modes, which the filter takes away. In 3D it leaves 6 of 18.
#[test]
fn null_space_takes_the_hourglass() {
    assert_eq!([felt::<1>(), felt::<2>(), felt::<3>()], [[1, 1], [5, 3], [18, 6]]);
}
