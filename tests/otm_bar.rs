//! OTM on bars: its order, its errors beside those of MPM, and its largest stable step.

use crate::support::*;
use lme_mpm::method::continuum::sums;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time::otm;
use lme_mpm::scene::{Scene, wave_speed};
use lme_mpm::setup;
use nalgebra::Vector1;
use std::fmt::Write;

/// On the vibrating bar with one particle per cell v, σ and u are of second order in h,
/// theory inside the 95% interval, on 10 to 80 cells, with the updated metric, too. A wide basis, γ = 1.8, keeps that
/// order for u only: as in MPM its functions change their form at the ends.
#[test]
fn otm_order_on_smooth_data() {
    let mut table = String::from("basis,velocity,stress,displacement,error of v at 80 cells\n");
    let cells = [10, 14, 20, 28, 40, 56, 80];
    let h = cells.map(|n| 1.0 / f64::from(n));
    let narrower =
        BasisCase { name: "lme γ = 6", sets: &["basis.kind=lme", "basis.gamma=6"], ..LME_NARROW };
    let updated = BasisCase {
        name: "lme γ = 4 updated metric",
        sets: &["basis.kind=lme", "basis.gamma=4", "basis.metric=updated"],
        ..LME_NARROW
    };
    for basis in [LINEAR, LME_MIDDLE, LME_NARROW, narrower, updated] {
        let name = basis.name;
        let errors = cells.map(|n| {
            let fixed = ["method=otm", "grid.particles_per_cell=1", "time.cfl=0.5", "time.end=0.8"];
            let cells = format!("grid.cells={n}");
            let scene = scene(VIBRATION, &[basis.sets, &fixed, &[&cells]].concat());
            field_errors(&scene, &finished(&scene))
        });
        let Each { v, sigma, u } = orders(&h, &errors);
        writeln!(table, "{name},{v},{sigma},{u},{:.2e}", errors[6].v).unwrap();
        assert!(agrees(&u, 2.0), "{name}: {u}");
        if basis.reaches_far {
            assert!(v.slope > 1.4 && sigma.slope > 1.4, "{name}: {v} {sigma}");
        } else {
            assert!(agrees(&v, 2.0) && agrees(&sigma, 2.0), "{name}: {v} {sigma}");
        }
    }
    approve("otm__orders", &table);
}

/// The bar's errors are within a tenth of the figures of an independent prototype, by γ,
/// Courant number and grid.
#[test]
fn otm_dyka_meets_the_prototype() {
    let off = |gamma: f64, courant: f64, cells: usize, there: Each<f64>| {
        let scene = scene(
            DYKA_OTM,
            &[
                &format!("basis.gamma={gamma}"),
                &format!("time.cfl={courant}"),
                &format!("grid.cells={cells}"),
            ],
        );
        let here = bar_errors(&scene, &finished(&scene));
        let off = |here: f64, there: f64| (here / there - 1.0).abs();
        let Each { v, sigma, u } = here;
        Each { v: off(v, there.v), sigma: off(sigma, there.sigma), u: off(u, there.u) }
    };
    // It gives no displacement for γ = 4.
    for (cells, v, sigma) in [(40, 0.070, 0.147), (160, 0.048, 0.102)] {
        let off = off(4.0, 0.9, cells, Each { v, sigma, u: f64::NAN });
        assert!(off.v < 0.1 && off.sigma < 0.1, "{cells} cells: {off:?}");
    }
    let off = off(6.0, 0.99, 160, Each { v: 0.027, sigma: 0.064, u: 5.4e-4 });
    assert!(off.v < 0.1 && off.sigma < 0.1 && off.u < 0.1, "{off:?}");
}

/// The bar's errors, energy drift and histories for γ from 0.8 to 6, one and two points
/// per cell and 40 to 160 cells are the approved ones, and below those of a run that is
/// merely stable.
#[test]
fn otm_dyka() {
    let mut table = String::from(
        "γ,points per cell,cells,velocity at L,stress at 3L/4,displacement field,\
         largest energy drift,pairs per particle,bits of v,bits of σ\n",
    );
    for gamma in ["0.8", "1.8", "4", "6"] {
        for per_cell in [1, 2] {
            for cells in [40, 80, 160] {
                let scene = scene(
                    DYKA_OTM,
                    &[
                        &format!("basis.gamma={gamma}"),
                        &format!("grid.particles_per_cell={per_cell}"),
                        &format!("grid.cells={cells}"),
                    ],
                );
                let outcome = finished(&scene);
                let Each { v, sigma, u } = bar_errors(&scene, &outcome);
                let drift = value(&scene, &outcome, "energy_drift_largest");
                let name = format!("{gamma},{per_cell},{cells}");
                let right = v < 0.25 && sigma < 0.4 && u < 0.1 && drift < 0.03;
                assert!(right, "{name}: {v} {sigma} {u} {drift}");
                let pairs = pairs_per_particle(&outcome.cost);
                let [bits_v, bits_sigma] = ["velocity_end", "stress_three_quarter"]
                    .map(|probe| digest(&column(&outcome.history, probe)));
                writeln!(
                    table,
                    "{name},{v:.4},{sigma:.4},{u:.5},{drift:.4},{pairs:.1},\
                     {bits_v:016x},{bits_sigma:016x}"
                )
                .unwrap();
            }
        }
    }
    approve("otm__dyka", &table);
}

/// The histories of the bar by γ are the approved ones, thinned out to 33 rows.
#[test]
fn otm_histories() {
    let gammas = ["0.8", "1.8", "4", "6"];
    let histories =
        gammas.map(|gamma| finished(&scene(DYKA_OTM, &[&format!("basis.gamma={gamma}")])).history);
    for probe in ["velocity_end", "stress_three_quarter"] {
        let exact = format!("{probe}_exact");
        let mut columns: Vec<Vec<f64>> =
            ["step", "t", &exact].map(|name| column(&histories[0], name)).into();
        columns.extend(histories.iter().map(|history| column(history, probe)));
        let mut text = format!("step,t,{exact},{}", gammas.map(|g| format!("γ = {g}")).join(","));
        let last = columns[0].len() - 1;
        for row in 0..=32 {
            let cells = columns.iter().map(|list| format!("{:.7e}", list[row * last / 32]));
            write!(text, "\n{}", cells.collect::<Vec<_>>().join(",")).unwrap();
        }
        approve(&format!("otm__{probe}"), &(text + "\n"));
    }
}

/// A method beside others: with its particles per cell and Courant number.
#[derive(Clone, Copy, PartialEq)]
struct Rival {
    name: &'static str,
    sets: Sets,
    mass: MassCase,
    courant: f64,
}

const OTM: Rival = Rival {
    name: "otm",
    sets: &["method=otm", "grid.particles_per_cell=1"],
    mass: LUMPED,
    courant: 0.5,
};
const OTM_FAST: Rival = Rival { courant: 0.99, ..OTM };
const MPM: Rival = Rival { name: "mpm", sets: &["method=mpm", "grid.particles_per_cell=1"], ..OTM };
const MPM_FAST: Rival = Rival { courant: 0.99, ..MPM };
const MPM_OF_TWO: Rival =
    Rival { name: "mpm 2 per cell", sets: &["method=mpm", "grid.particles_per_cell=2"], ..OTM };
const MPM_CONSISTENT: Rival = Rival { mass: CONSISTENT, courant: 0.2, ..MPM_OF_TWO };

/// MPM and OTM side by side on 80 cells, with the same basis and one particle in each
/// cell, each at a common time step and at a large one of its own: lumped beside lumped,
/// OTM has the smaller error of σ for every γ. How much smaller grows with γ and with the
/// time step: less than half at γ = 4 and c Δt/h = 0.99.
#[test]
fn otm_beside_mpm() {
    let mut table = String::from(
        "γ,method,mass,cfl,velocity at L,stress at 3L/4,displacement field,overshoot of σ,\
         largest energy drift,pairs per particle and step,steps\n",
    );
    let gammas = ["0.8", "1.8", "4"];
    let mut errors = Vec::new();
    for gamma in gammas {
        for rival in [OTM, OTM_FAST, MPM, MPM_FAST, MPM_OF_TWO, MPM_CONSISTENT] {
            let Rival { name, sets, mass, courant } = rival;
            let common =
                ["grid.cells=80", &format!("basis.gamma={gamma}"), &format!("time.cfl={courant}")];
            let scene = scene(DYKA_OTM, &[sets, mass.sets, &common].concat());
            let outcome = finished(&scene);
            let of = |name: &str| value(&scene, &outcome, name);
            let Each { v, sigma, u } = bar_errors(&scene, &outcome);
            errors.push(((gamma, rival), sigma));
            let peak = of("stress_three_quarter_peak");
            let overshoot = peak / of("stress_three_quarter_peak_exact") - 1.0;
            let drift = of("energy_drift_largest");
            let (pairs, steps) = (pairs_per_particle(&outcome.cost), outcome.cost.steps);
            writeln!(
                table,
                "{gamma},{name},{},{courant},{v:.4},{sigma:.4},{u:.5},{overshoot:.2},{drift:.4},\
                 {pairs:.1},{steps}",
                mass.name
            )
            .unwrap();
        }
    }
    let error = |gamma: &str, rival: Rival| {
        errors.iter().find(|(case, _)| *case == (gamma, rival)).unwrap().1
    };
    for gamma in gammas {
        assert!(error(gamma, OTM) < error(gamma, MPM), "{gamma}");
    }
    assert!(error("4", OTM_FAST) < 0.5 * error("4", MPM_FAST));
    approve("otm__beside_mpm", &table);
}

/// The largest stable time step by marching 2000 steps is 2/ω of M⁻¹K with the functions
/// of the start, to 2%, for γ from 0.8 to 6 on 40 cells with one particle in each; with the updated metric it is the same.
#[test]
fn otm_stability_limit() {
    let mut table = String::from("γ,metric,measured cΔt/h,predicted\n");
    let updated = ["1.8", "4"].map(|gamma| (gamma, "updated"));
    for (gamma, metric) in
        ["0.8", "1.8", "4", "6"].map(|gamma| (gamma, "fixed")).into_iter().chain(updated)
    {
        let slow = "initial_velocity.0.velocity=1e-7";
        let sets = [format!("basis.gamma={gamma}"), format!("basis.metric={metric}")];
        let scene = scene(DYKA_OTM, &[&strs(&sets)[..], &[slow]].concat());
        let model = setup::model::<1>(&scene);
        let (c, h) = (wave_speed(&scene.body), model.grid.h[0]);
        let (mut low, mut high) = (0.5, 4.0);
        while high - low > 2e-3 {
            let middle = 0.5 * (low + high);
            let dt = middle * h / c;
            if grows(&Model { dt, ..model.clone() }, &scene) { high = middle } else { low = middle }
        }
        let measured = 0.5 * (low + high);
        let predicted = 2.0 * c / (h * largest_frequency(&scene));
        assert!((measured / predicted - 1.0).abs() < 0.02, "{gamma}: {measured}, {predicted}");
        writeln!(table, "{gamma},{metric},{measured:.3},{predicted:.4}").unwrap();
    }
    approve("otm__stability", &table);
}

/// True where noise of 1e-7 m/s becomes a thousand times as fast within 2000 steps.
fn grows(model: &Model<1>, scene: &Scene) -> bool {
    let mut state = setup::initial_state(model, scene);
    for (p, v) in state.particle.v.iter_mut().enumerate() {
        v[0] = 1e-7 * (12.9898 * p as f64).sin();
    }
    otm::start(&mut state, model).unwrap();
    (1..=2000).any(|step| {
        advance(model, &mut state, step).is_err() || state.node.v.iter().any(|v| v[0].abs() > 1e-4)
    })
}

/// ω of M⁻¹K by power iteration with the start's functions: K u is the force of the
/// stress E Σ ∇N u.
fn largest_frequency(scene: &Scene) -> f64 {
    let (model, mut state) = at_start::<1>(scene);
    otm::start(&mut state, &model).unwrap();
    let State { particle, node, shape, .. } = &mut state;
    for (a, v) in node.v.iter_mut().enumerate() {
        v[0] = if a == 0 { 0.0 } else { (1.7 * a as f64).sin() };
    }
    let mut square = 0.0;
    for _ in 0..20000 {
        for p in 0..particle.len() {
            let strain: f64 = shape.of(p).map(|(a, _, grad)| node.v[a][0] * grad[0]).sum();
            particle.sigma[p][0] = 200e9 * strain;
        }
        node.f.fill(Vector1::new(0.0));
        sums::internal_force(node, particle, shape);
        node.f[0][0] = 0.0;
        let norm = |list: &[f64]| list.iter().map(|x| x * x).sum::<f64>().sqrt();
        let a: Vec<f64> = (0..node.len()).map(|a| -node.f[a][0] / node.m[a]).collect();
        let v: Vec<f64> = node.v.iter().map(|v| v[0]).collect();
        square = norm(&a) / norm(&v);
        for (v, a) in node.v.iter_mut().zip(&a) {
            v[0] = a / square;
        }
    }
    square.sqrt()
}

/// OTM in 1D with the linear functions is the finite-element method. At cΔt/h = 1
/// its displacement is exact, to 1e-4 on 40 cells, and its stress to 2%.
#[test]
fn otm_with_linear_functions_is_exact_at_courant_one() {
    let scene = dyka(&["method=otm", "grid.particles_per_cell=1", "time.cfl=1"]);
    let Each { sigma, u, .. } = bar_errors(&scene, &finished(&scene));
    assert!(u < 1e-4 && sigma < 0.02, "{u} {sigma}");
}
