//! The dual domain method: what its gradients owe, and what they are worth.

use crate::support::lines::{Dash, Frame, Line, lines};
use crate::support::*;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::measure;
use lme_mpm::run::stability;
use nalgebra::SVector;
use std::fmt::Write;

/// A grid of four cells along each axis with one empty cell beyond the upper sides, and points in
/// each of the four.
fn places<const D: usize>() -> (Grid<D>, Vec<SVector<f64, D>>) {
    let grid = Grid::over([4.0; D], [4; D], [[0, 1]; D]);
    let mut random = stability::noise();
    let mut x = Vec::new();
    for cell in lme_mpm::method::grid::odometer([4_usize; D]) {
        for _ in 0..2 {
            x.push(SVector::from_fn(|d, _| cell[d] as f64 + 0.5 + 0.49 * random()));
        }
    }
    (grid, x)
}

fn owes_nothing<const D: usize>() {
    let (grid, x) = places::<D>();
    let table = on_grid(&Basis::Ddmp, &grid, &x).unwrap();
    for p in 0..x.len() {
        let (mut sum, mut place) = (0.0_f64, SVector::<f64, D>::zeros());
        let mut slopes = SVector::<f64, D>::zeros();
        let mut map = nalgebra::SMatrix::<f64, D, D>::zeros();
        for (I, N, grad_N) in table.shape.of(p) {
            let x_I = grid.position(I);
            sum += N;
            place += x_I * N;
            slopes += grad_N;
            map += x_I * grad_N.transpose();
            assert!(N >= 0.0);
        }
        assert!((sum - 1.0).abs() < 1e-15 * 4.0 && (place - x[p]).amax() < 1e-14);
        assert!(slopes.amax() < 1e-14, "{p}: {slopes}");
        assert!((map - nalgebra::SMatrix::identity()).amax() < 1e-14, "{p}: {map}");
    }
}

/// ΣN = 1, Σ N x_I = x, Σ∇N = 0 and Σ x_I ⊗ ∇N_I = 1, to 1e-14 of sizes of 5, at random points in
/// one, two and three dimensions, beside empty cells, too.
#[test]
fn ddmp_owes_nothing() {
    owes_nothing::<1>();
    owes_nothing::<2>();
    owes_nothing::<3>();
}

/// Inside a row of cells G of a node to its neighbours is ±1/2h, and at the last cell that holds
/// particles one-sided: ±1/h. So the row at ξ has the gradients of the formula, to 1e-15.
#[test]
fn ddmp_is_the_dual_of_its_domain() {
    let (grid, _) = places::<1>();
    let points = |list: &[f64]| list.iter().map(|x| SVector::from([*x])).collect::<Vec<_>>();
    let x = points(&[0.5, 1.25, 2.5, 3.75]);
    let table = on_grid(&Basis::Ddmp, &grid, &x).unwrap();
    let row = |p: usize| table.shape.of(p).map(|(I, N, g)| (I, N, g[0])).collect::<Vec<_>>();
    // α = 3/4 at a quarter; S = 3/4 and 1/4.
    let (a, s0, s1) = (0.75, 0.75, 0.25);
    let expected = [
        (0, 0.0, -(1.0 - a) * s0 * 0.5),
        (1, s0, -a - (1.0 - a) * s1 * 0.5),
        (2, s1, a + (1.0 - a) * s0 * 0.5),
        (3, 0.0, (1.0 - a) * s1 * 0.5),
    ];
    for ((I, N, g), (J, M, f)) in row(1).into_iter().zip(expected) {
        assert!(I == J && (N - M).abs() < 1e-15 && (g - f).abs() < 1e-15, "{:?}", row(1));
    }
    // Node 4 ends the cells with particles: its dual gradient is one-sided, and node 5 has no part.
    let end = [
        (2, 0.0, -(1.0 - a) * s1 * 0.5),
        (3, s1, -a - (1.0 - a) * s0),
        (4, s0, a + (1.0 - a) * (s1 * 0.5 + s0)),
    ];
    assert_eq!(row(3).len(), 3);
    for ((I, N, g), (J, M, f)) in row(3).into_iter().zip(end) {
        assert!(I == J && (N - M).abs() < 1e-15 && (g - f).abs() < 1e-15, "{:?}", row(3));
    }
}

fn middle_is_linear<const D: usize>() {
    let grid = Grid::over([4.0; D], [4; D], [[0, 0]; D]);
    let x: Vec<_> = lme_mpm::method::grid::odometer([4_usize; D])
        .map(|c| SVector::from(c.map(|c| c as f64 + 0.5)))
        .collect();
    let [ddmp, linear] =
        [Basis::Ddmp, Basis::Linear].map(|basis| on_grid(&basis, &grid, &x).unwrap());
    for p in 0..x.len() {
        let one: Vec<_> = ddmp.shape.of(p).filter(|(_, N, _)| *N > 0.0).collect();
        let other: Vec<_> = linear.shape.of(p).collect();
        assert_eq!(one.len(), other.len());
        for ((I, N, g), (J, M, f)) in one.iter().zip(&other) {
            assert!(I == J && N == M && (g - f).amax() < 1e-15);
        }
    }
}

/// A particle in the middle of a cell has the gradient of the linear functions, in one to three
/// dimensions.
#[test]
fn ddmp_in_the_middle_is_linear() {
    middle_is_linear::<1>();
    middle_is_linear::<2>();
    middle_is_linear::<3>();
}

fn jump<const D: usize>(basis: &Basis) -> f64 {
    let (grid, mut x) = places::<D>();
    let side = |d: f64| SVector::<f64, D>::from_fn(|e, _| if e == 0 { 2.0 + d } else { 1.3 });
    let n = x.len();
    x.extend([side(-1e-9), side(1e-9)]);
    let table = on_grid(basis, &grid, &x).unwrap();
    let of = |p: usize| {
        let mut list = vec![SVector::<f64, D>::zeros(); grid.nodes()];
        table.shape.of(p).for_each(|(I, _, g)| list[I] = g);
        list
    };
    largest(of(n).iter().zip(of(n + 1)).map(|(a, b)| (a - b).amax()))
}

/// Across a face the gradient does not jump, to 1e-7; that of the linear functions does, by 1/h and
/// more in 1D.
#[test]
fn ddmp_is_continuous_across_faces() {
    let smooth = [jump::<1>(&Basis::Ddmp), jump::<2>(&Basis::Ddmp), jump::<3>(&Basis::Ddmp)];
    assert!(smooth.iter().all(|jump| *jump < 1e-7), "{smooth:?}");
    assert!(jump::<1>(&Basis::Linear) > 0.99);
}

/// The bar on 80 cells and the motion across 160, lumped and consistent, by particles per cell: what is
/// found beside what was expected of an independent program. All agree to
/// 5%. On the bar the energy at the end is that of the start to 0.1%.
#[test]
fn ddmp_side_by_side() {
    let mut table = String::from(
        "motion,mass,particles per cell,velocity,stress,displacement,expected velocity,expected stress,expected displacement\n",
    );
    let bar = [
        ("lumped", 2, "0.5", [Some(0.137), Some(0.252), Some(0.0125)]),
        ("consistent", 2, "0.2", [Some(0.049), Some(0.090), Some(0.0015)]),
        ("consistent", 3, "0.2", [Some(0.094), None, None]),
        ("consistent", 4, "0.2", [Some(0.097), None, None]),
    ];
    let cells = [
        ("lumped", 2, "0.2", [0.094, 0.11, 0.031]),
        ("lumped", 4, "0.2", [0.065, 0.049, 0.023]),
        ("consistent", 2, "0.1", [0.054, 0.055, 5.6e-3]),
        ("consistent", 4, "0.1", [0.016, 0.015, 8e-4]),
    ];
    let sets = |mass: &str, per_cell: usize, cfl: &str| {
        [
            "basis.kind=ddmp".to_string(),
            format!("mass={mass}"),
            format!("grid.particles_per_cell={per_cell}"),
            format!("time.cfl={cfl}"),
        ]
    };
    let mut row =
        |motion: &str, mass: &str, n: usize, found: Each<f64>, expected: [Option<f64>; 3]| {
            let Each { v, sigma, u } = found;
            let shown = expected.map(|x| x.map_or(String::new(), |x| format!("{x:.1e}"))).join(",");
            writeln!(table, "{motion},{mass},{n},{v:.1e},{sigma:.1e},{u:.1e},{shown}").unwrap();
            let ratios = [v, sigma, u].into_iter().zip(expected).filter_map(|(a, b)| Some(a / b?));
            ratios.collect::<Vec<f64>>()
        };
    let mut histories = String::from("mass,particles per cell,digest of the history\n");
    for (mass, n, cfl, expected) in bar {
        let sets = [&sets(mass, n, cfl)[..], &["grid.cells=80".to_string()]].concat();
        let scene = dyka(&strs(&sets));
        let u = over_time(&scene).unwrap().u;
        let outcome = finished(&scene);
        let found = Each { u, ..bar_errors(&scene, &outcome) };
        let all: Vec<f64> = outcome.history.rows().flatten().copied().collect();
        writeln!(histories, "{mass},{n},{:016x}", digest(&all)).unwrap();
        let ratios = row("bar", mass, n, found, expected);
        assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() < 0.05), "{mass} {n}: {ratios:?}");
        let drift = value(&scene, &outcome, "energy_drift");
        assert!(drift.abs() < 1e-3, "{mass} {n}: {drift:e}");
    }
    for (mass, n, cfl, expected) in cells {
        let scene = crossing(&strs(&sets(mass, n, cfl)));
        let found = over_time(&scene).unwrap();
        let ratios = row("across cells", mass, n, found, expected.map(Some));
        assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() < 0.05), "{mass} {n}: {ratios:?}");
    }
    approve("ddmp__side_by_side", &table);
    approve("ddmp__histories", &histories);
}

/// Across cells, in a motion whose amplitude is a sixteenth of the bar, the error in the velocity grows from 40 to
/// 160 cells, with two particles per cell and with four, and with either mass matrix.
#[test]
fn ddmp_does_not_converge_across_cells() {
    let mut table = String::from("mass,particles per cell,20,40,80,160\n");
    for (mass, cfl) in [("lumped", 0.2), ("consistent", 0.1)] {
        for n in [2, 4] {
            let errors = [20, 40, 80, 160].map(|cells| {
                let sets = [
                    "basis.kind=ddmp".to_string(),
                    format!("mass={mass}"),
                    format!("grid.particles_per_cell={n}"),
                    format!("grid.cells={cells}"),
                    format!("time.cfl={cfl}"),
                ];
                over_time(&crossing(&strs(&sets))).unwrap().v
            });
            assert!(errors[3] > 1.5 * errors[1], "{mass} {n}: {errors:?}");
            writeln!(table, "{mass},{n},{}", errors.map(|e| format!("{e:.1e}")).join(",")).unwrap();
        }
    }
    approve("ddmp__grids", &table);
}

/// On the swinging bar, in which nothing crosses, 10 to 80 cells: the orders in h of velocity, stress and
/// displacement are 2.0, 1.0 and 2.1 with the lumped matrix, and 1.7, 1.0 and 2.3 with the consistent one, all
/// to 0.05.
#[test]
fn ddmp_has_its_orders() {
    let cells = [10, 20, 40, 80];
    let h = cells.map(|n| 1.0 / f64::from(n));
    let mut table = String::from("mass,field,10 cells,20,40,80,order\n");
    for (mass, cfl) in [("lumped", 0.5), ("consistent", 0.2)] {
        let errors = cells.map(|n| {
            let sets = [
                "basis.kind=ddmp".to_string(),
                format!("mass={mass}"),
                format!("grid.cells={n}"),
                format!("time.cfl={cfl}"),
            ];
            let scene = scene(VIBRATION, &strs(&sets));
            let each = field_errors(&scene, &finished(&scene));
            [each.v, each.sigma, each.u]
        });
        let expected = match mass {
            "lumped" => [2.0, 1.0, 2.1],
            _ => [1.7, 1.0, 2.3],
        };
        for (n, field) in ["velocity", "stress", "displacement"].into_iter().enumerate() {
            let of = errors.map(|errors| errors[n]);
            let order = measure::observed_order(&h, &of).slope;
            assert!((order - expected[n]).abs() < 0.05, "{mass}, {field}: {order}");
            let shown = of.map(|error| format!("{error:.1e}")).join(",");
            writeln!(table, "{mass},{field},{shown},{order:.2}").unwrap();
        }
    }
    approve("ddmp__orders", &table);
}

/// Implicit steps take it as any basis of the grid: on the bar with 40 cells, with either matrix, Newton's
/// residuals end below 1e-10. The velocity errs by as much as with explicit steps to 3% with the lumped matrix, and by a
/// seventh more with the consistent one. With that the energy stays to 1e-3; with the lumped one 5.6% of it are lost.
#[test]
fn ddmp_with_implicit_steps() {
    for (mass, cfl) in [("lumped", 0.5), ("consistent", 0.2)] {
        let run = |scheme: &str| {
            let sets = [
                "basis.kind=ddmp".to_string(),
                format!("mass={mass}"),
                format!("time.integrator={scheme}"),
                format!("time.cfl={cfl}"),
            ];
            let scene = dyka(&strs(&sets));
            let outcome = finished(&scene);
            let drift = value(&scene, &outcome, "energy_drift");
            (bar_errors(&scene, &outcome).v, drift, outcome)
        };
        let (explicit, _, _) = run("newmark");
        let (implicit, drift, outcome) = run("implicit-newmark");
        let residuals = column(&outcome.history, "equilibrium_residual");
        assert!(residuals.iter().all(|size| *size <= 1e-10));
        let (least, most, lost) = match mass {
            "lumped" => (1.0, 1.03, -0.0565),
            _ => (1.1, 1.15, 0.0),
        };
        assert!((least..most).contains(&(implicit / explicit)), "{mass}: {implicit} {explicit}");
        assert!((drift - lost).abs() < 1e-3, "{mass}: {drift:e}");
    }
}

/// Draws N of a node and its two gradients in a row of cells that all hold particles. Of the linear
/// gradient both sides of a face differ by 1/h and more; of the dual one they agree, to 1e-7.
#[test]
fn figure_of_the_dual_gradient() {
    let grid = Grid::<1>::over([6.0], [6], [[0, 0]]);
    let near = |n: usize| [n as f64 - 1e-9, n as f64 + 1e-9];
    let mut places: Vec<f64> =
        (0..6).flat_map(|e| (1..20).map(move |n| e as f64 + 0.05 * n as f64)).collect();
    places.extend((1..6).flat_map(near));
    places.sort_by(f64::total_cmp);
    let x: Vec<SVector<f64, 1>> = places.iter().map(|x| SVector::from([*x])).collect();
    let curve = |basis: &Basis, of: &dyn Fn(f64, f64) -> f64| -> Vec<(f64, f64)> {
        let table = on_grid(basis, &grid, &x).unwrap().shape;
        let own = |p: usize| {
            table.of(p).find(|(I, _, _)| *I == 3).map_or(0.0, |(_, N, slope)| of(N, slope[0]))
        };
        places.iter().enumerate().map(|(p, x)| (*x, own(p))).collect()
    };
    let slope = |_: f64, slope: f64| slope;
    let (linear, dual) = (curve(&Basis::Linear, &slope), curve(&Basis::Ddmp, &slope));
    let jump = |curve: &[(f64, f64)]| {
        let faces = curve.windows(2).filter(|pair| pair[1].0 - pair[0].0 < 1e-8);
        largest(faces.map(|pair| pair[1].1 - pair[0].1))
    };
    assert!(jump(&linear) > 1.99 && jump(&dual) < 1e-7, "{:e}", jump(&dual));
    let drawn = [
        Line::new("the function of the node at 3", curve(&Basis::Ddmp, &|N, _| N), 6)
            .dashed(Dash::Dashed),
        Line::new("its linear gradient", linear, 0),
        Line::new("its dual gradient", dual, 1),
    ];
    let frame = Frame { x: "x [h]", y: "function, and gradient times h", ..Frame::default() };
    approve_picture("ddmp__gradient", lines(&drawn, &frame));
}

/// The limit of c Δt/h is predicted as 1.92 with the lumped matrix and as 0.64 with the consistent one, to
/// 0.5%. Marched over eight periods, the bar keeps its energy at 0.99 of it, and at 1.02 of it the energy
/// grows beyond ten times what it was.
#[test]
fn ddmp_has_a_predicted_limit() {
    for (mass, expected) in [("mass=lumped", 1.92), ("mass=consistent", 0.637)] {
        let with = |part: f64| {
            let sets = [
                "basis.kind=ddmp".to_string(),
                mass.to_string(),
                "grid.cells=20".to_string(),
                format!("time.cfl={}", part * expected),
                format!("time.end={}", 32.0 * transit()),
                "time.allow_unstable=true".to_string(),
                "check.energy=1e3".to_string(),
            ];
            dyka(&strs(&sets))
        };
        let scene = with(0.99);
        let limit = scene.courant_number_of(stability::critical(&scene).unwrap().start);
        assert!((limit / expected - 1.0).abs() < 0.005, "{mass}: {limit}");
        let (first, last) = means_of_tenths(&total_energy(&finished(&scene).history));
        assert!(last < 1.5 * first, "{mass}: {first} {last}");
        let grown = match outcome(&with(1.02)) {
            Ok(outcome) => {
                let (first, last) = means_of_tenths(&total_energy(&outcome.history));
                last > 10.0 * first
            }
            Err(_) => true,
        };
        assert!(grown, "{mass}");
    }
}

/// α is a product over the axes, so in a strip, whose particles stand at a quarter of a cell across, too, it is
/// another than in the bar: 9/16 in place of 3/4. The two differ by more than a tenth of the velocity, though
/// their errors are the same to a fifth. Two discs that meet keep their momentum to round-off.
#[test]
fn ddmp_in_the_plane() {
    let sets = ["basis.kind=ddmp", "time.cfl=0.5"];
    let [bar, strip] = [1, 2].map(|D| finished(&strip(D, &sets)).history);
    let exact = column(&bar, "velocity_end_exact");
    let of = |history| column(history, "velocity_end");
    let error = |list: &[f64]| measure::rms(list.iter().copied().zip(exact.iter().copied()));
    assert!(apart(&of(&bar), &of(&strip)) > 0.5);
    let ratio = error(&of(&strip)) / error(&of(&bar));
    assert!((ratio - 1.0).abs() < 0.2, "{ratio}");
    let discs = finished(&scene(DISCS, &["basis.kind=ddmp", "grid.cells=[10,10]", "time.cfl=0.2"]));
    for name in ["momentum_x", "momentum_y"] {
        let momentum = column(&discs.history, name);
        let off = largest(momentum.iter().map(|p| p - momentum[0]));
        assert!(off < 1e-12, "{name}: {off:e}");
    }
}

/// Nobody else pays for it: with another basis a run counts what it counted, and with this one four
/// nodes for each particle of the bar's inside, no exponential.
#[test]
fn ddmp_costs_only_who_asks() {
    let cost = finished(&dyka(&["basis.kind=ddmp"])).cost;
    assert_eq!(cost.exponentials, 0);
    let pairs = pairs_per_particle(&cost);
    assert!(pairs > 3.9 && pairs < 4.0, "{pairs}");
    let linear = finished(&dyka(&[])).cost;
    assert_eq!(linear.particle_node_pairs, 2 * linear.basis_evaluations);
}
