//! OTM: what its nodes keep, what its particles see, and the bar.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::continuum::law;
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::{Nodes, Particles};
use lme_mpm::method::measure::{self, observed_order};
use lme_mpm::method::model::Model;
use lme_mpm::method::model::State;
use lme_mpm::method::time::otm;
use lme_mpm::run::run;
use lme_mpm::scene::Scene;
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector1, Vector2};
use std::fmt::Write;

/// A smooth push to and fro, so that nodes no longer stand on a grid.
fn scatter<const D: usize>(x: &SVector<f64, D>, size: f64) -> SVector<f64, D> {
    SVector::from_fn(|d, _| {
        let phase: f64 = (0..D).map(|e| (5.0 + e as f64) * x[e]).sum();
        x[d] + size * (phase + 1.3 * d as f64).sin()
    })
}

// ---- kinematics ------------------------------------------------------------------

/// Affine patch: nodes anywhere, an affine displacement. Each particle finds its
/// gradient to round-off, step by step; the product of the incremental J is the
/// determinant of the whole map, and so is the ratio of the densities.
#[test]
fn otm_affine_patch_on_scattered_nodes() {
    fn check<const D: usize>(gradient: SMatrix<f64, D, D>) {
        let scene = block(D, &[]);
        let model = lme_mpm::setup::model::<D>(&scene);
        let mut state = lme_mpm::setup::initial_state(&model, &scene);
        for x in state.node.x.iter_mut().chain(&mut state.particle.x) {
            *x = scatter(x, 0.04);
        }
        let start = state.particle.x.clone();
        otm::start(&mut state, &model).unwrap();
        // Another gradient in every step, so that the order of the product counts.
        let turned = |step: usize| match step % 2 {
            0 => gradient,
            _ => gradient.transpose() * 0.5,
        };
        let (mut whole, mut J) = (SMatrix::<f64, D, D>::identity(), 1.0);
        let steps = 25;
        for step in 1..=steps {
            let State { particle, node, shape, .. } = &mut state;
            // Δt = 1: v_a is the displacement of the step, affine in the present place.
            for a in 0..node.len() {
                node.v[a] = turned(step) * node.x[a] + SVector::repeat(0.01);
            }
            otm::move_nodes(node, 1.0);
            otm::move_particles(particle, node, shape, 1.0);
            otm::deform(particle, node, shape, &model, 1.0).unwrap();
            otm::tabulate_again(&mut state, &model).unwrap();
            whole = (SMatrix::identity() + turned(step)) * whole;
            J *= law::increment(&turned(step)).1;
        }
        for p in 0..state.particle.len() {
            assert_relative_eq!(state.particle.F[p], whole, epsilon = 1e-11);
            assert_relative_eq!(1000.0 / state.particle.rho[p], J, max_relative = 1e-11);
            let det = law::increment(&(state.particle.F[p] - SMatrix::identity())).1;
            assert_relative_eq!(det, J, max_relative = 1e-11);
            // The particle went with the nodes: x = whole · X + what was added up.
            let moved = state.particle.x[p] - whole * start[p];
            let other = state.particle.x[0] - whole * start[0];
            assert_relative_eq!(moved, other, epsilon = 1e-11);
        }
    }
    check::<1>(SMatrix::<f64, 1, 1>::new(0.015));
    check::<2>(Matrix2::new(0.01, -0.02, 0.03, 0.005));
    check::<3>(Matrix3::new(0.01, -0.01, 0.0, 0.02, -0.005, 0.01, 0.0, 0.02, 0.008));
}

/// det f in closed form, and a strain that a rotation does not see and that adds
/// up to the logarithm.
#[test]
fn otm_increments_of_finite_size() {
    let G = Matrix3::new(0.2, -0.1, 0.3, 0.4, -0.5, 0.1, 0.2, 0.7, -0.1);
    assert_relative_eq!(law::increment(&G).1, (Matrix3::identity() + G).determinant());
    let (s, c) = 0.7_f64.sin_cos();
    let rotation = Matrix2::new(c - 1.0, -s, s, c - 1.0);
    assert!(law::midpoint_strain(&rotation).unwrap().norm() < 1e-15);
    let sum: f64 = (0..1000)
        .map(|_| law::midpoint_strain(&Vector1::new(2.0_f64.powf(1e-3) - 1.0)).unwrap()[0])
        .sum();
    assert_relative_eq!(sum, 2.0_f64.ln(), max_relative = 1e-6);
    assert_eq!(law::midpoint_strain(&Vector1::new(-2.0)), None);
}

/// Rigid translation: no stress but round-off, and every particle where it should
/// be, in 1D, 2D and 3D.
#[test]
fn otm_rigid_translation() {
    fn check<const D: usize>(basis: &[&str]) {
        let velocity = format!("[{}]", vec!["3.7"; D].join(","));
        let region = |corner: &str| format!("[{}]", vec![corner; D].join(","));
        let throw = format!(
            "initial_velocity=[{{ from = {}, to = {}, velocity = {velocity} }}]",
            region("0"),
            region("1")
        );
        let scene = block(D, &[basis, &[throw.as_str(), "time.end=2"]].concat());
        let model = lme_mpm::setup::model::<D>(&scene);
        let mut state = lme_mpm::setup::initial_state(&model, &scene);
        let start = state.particle.x.clone();
        march(&model, &mut state, model.steps);
        let end = model.steps as f64 * model.dt;
        let c = (1e6_f64 * 1.35 / 1000.0).sqrt();
        for p in 0..start.len() {
            let stress = state.particle.sigma[p].norm();
            assert!(stress < 1e-11 * 1000.0 * c * 3.7, "{basis:?}: {stress:e}");
            let moved = state.particle.x[p] - start[p];
            assert_relative_eq!(moved, SVector::repeat(3.7 * end), epsilon = 1e-11);
        }
    }
    check::<1>(&[]);
    check::<2>(&[]);
    check::<3>(&["basis.gamma=4"]);
}

// ---- conservation ------------------------------------------------------------------

/// A free block thrown about: mass, momentum and angular momentum of the nodes to
/// n·ε; energy to the swing of a leapfrog.
#[test]
fn otm_conserves_what_it_should() {
    for gamma in ["0.8", "1.8", "4"] {
        let gamma = format!("basis.gamma={gamma}");
        let scene = block(2, &[&gamma, "grid.particles_per_cell=[2,2]", "time.end=0.2"]);
        let model = lme_mpm::setup::model::<2>(&scene);
        let mut state = lme_mpm::setup::initial_state(&model, &scene);
        for p in 0..state.particle.len() {
            let x = state.particle.x[p];
            let wave = Vector2::new((3.0 * x[1]).sin(), (2.0 * x[0]).cos()) * 0.3;
            state.particle.v[p] = Vector2::new(2.0 - x[1], x[0]) + wave;
        }
        otm::start(&mut state, &model).unwrap();
        let mass: f64 = state.node.m.iter().sum();
        assert_relative_eq!(mass, 1000.0, max_relative = 1e-14);
        let energy = |state: &State<2>| {
            measure::kinetic_energy(&state.carriers(model.method))
                + measure::strain_energy(&state.particle, &model.law)
        };
        let momentum = measure::momentum(&state.carriers(model.method));
        let angular = measure::angular_momentum(&state.carriers(model.method))[0];
        let before = energy(&state);
        let (mut swing, mut masses) = (0.0_f64, true);
        let m = state.node.m.clone();
        for step in 1..=model.steps {
            advance(&model, &mut state, step).unwrap();
            swing = swing.max((energy(&state) / before - 1.0).abs());
            masses &= state.node.m == m;
        }
        let n = 10.0 * model.steps as f64 * f64::EPSILON;
        assert!(masses);
        let drift =
            (measure::momentum(&state.carriers(model.method)) - momentum).norm() / momentum.norm();
        assert!(drift < n, "{gamma}: {drift:e}");
        let spun = measure::angular_momentum(&state.carriers(model.method))[0] / angular - 1.0;
        assert!(spun.abs() < n, "{gamma}: {spun:e}");
        assert!(swing < 0.01, "{gamma}: {swing}");
    }
}

/// Energy with the work of gravity over twenty swings; and one swing against the exact
/// one, for which the load must act from the start.
#[test]
fn otm_energy_under_gravity() {
    let sets = ["method=otm", "basis.kind=lme", "basis.gamma=1.8", "time.end=0.5"];
    let scene = scene(GRAVITY, &sets);
    let outcome = finished(&scene);
    let balance = value(&scene, &outcome, "energy_balance_largest");
    assert!(balance < 1e-4, "{balance}");
    let scene = crate::support::scene(GRAVITY, &sets[..3]);
    let outcome = finished(&scene);
    assert!(value(&scene, &outcome, "displacement_end_rms_relative") < 1e-3);
    let v = value(&scene, &outcome, "velocity_field_rms_relative");
    assert!(v < 0.0105, "{v}");
}

/// A free bar under loads that act at once or grow: its momentum is the trapezoidal sum
/// of the forces, from the first step on.
#[test]
fn otm_momentum_is_the_impulse() {
    for ramp in [0.0, 8e-6] {
        let sets = [
            "boundary.left=free".to_string(),
            "initial_velocity=[]".to_string(),
            "time.end=2e-5".to_string(),
            format!("body_force={{ acceleration = 3, ramp = {ramp:e} }}"),
            format!("traction={{ right = 5e6, ramp = {ramp:e} }}"),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let outcome = finished(&scene(DYKA_OTM, &sets));
        let full = 3.0 * 7833.0 * 0.1333 + 5e6;
        let force = |k: usize| {
            let now = k as f64 * outcome.dt;
            full * if now < ramp { now / ramp } else { 1.0 }
        };
        let mut expected = 0.0;
        for (k, p) in outcome.history.column("momentum").unwrap().into_iter().enumerate() {
            assert!((p - expected).abs() < 1e-12 * full * 2e-5, "{ramp}, {k}: {p} {expected}");
            expected += 0.5 * outcome.dt * (force(k) + force(k + 1));
        }
    }
}

/// A load that varies in time acts at the time of its step: the manufactured motion
/// across cells, which OTM follows on nodes that move along.
#[test]
fn otm_follows_a_manufactured_motion() {
    let scene =
        scene(MANUFACTURED, &["method=otm", "basis.gamma=1.8", "grid.particles_per_cell=1"]);
    let outcome = finished(&scene);
    let error = value(&scene, &outcome, "displacement_middle_rms_relative");
    assert!(error < 2e-4, "{error}");
}

/// A particle that a step would turn inside out is named.
#[test]
fn otm_inversion_is_named() {
    let scene = scene(DYKA_OTM, &["initial_velocity.0.velocity=-5e4"]);
    let stopped = run(&scene, &mut |_| {}).unwrap_err();
    let named =
        matches!(stopped.broken.breakdown, Breakdown::Inverted { .. } | Breakdown::NoBasis { .. });
    assert!(named, "{}", stopped.broken.breakdown);
    let mut particle = Particles::at_rest(vec![Vector1::new(0.5)], 1.0);
    particle.F = vec![SMatrix::identity()];
    let mut node = Nodes::<1>::blank(2);
    node.m = vec![1.0; 2];
    node.v = [1.0, 0.0].map(Vector1::new).to_vec();
    let mut shape = Shape::blank(0);
    for (a, slope) in [(0, -1.0), (1, 1.0)] {
        shape.push(a, 0.5, Vector1::new(slope));
    }
    shape.end_row();
    let model = lme_mpm::setup::model::<1>(&scene);
    let stopped = otm::deform(&mut particle, &node, &shape, &model, 1.0).unwrap_err();
    assert_eq!(stopped, Breakdown::Inverted { particle: 0, strain: -1.0 });
}

// ---- accuracy ------------------------------------------------------------------------

/// On the vibrating bar with one particle per cell v, σ and u are of second order
/// in h, theory inside the 95% interval. A wide basis, γ = 1.8, keeps that order
/// for u only: as in MPM its functions change their form at the ends.
#[test]
fn otm_order_on_smooth_data() {
    let mut table = String::from("basis,velocity,stress,displacement,error of v at 80 cells\n");
    let cells = [10, 14, 20, 28, 40, 56, 80];
    let h = cells.map(|n| 1.0 / f64::from(n));
    for (name, sets) in [
        ("linear", &["basis.kind=linear"][..]),
        ("lme γ = 1.8", &["basis.kind=lme", "basis.gamma=1.8"]),
        ("lme γ = 4", &["basis.kind=lme", "basis.gamma=4"]),
        ("lme γ = 6", &["basis.kind=lme", "basis.gamma=6"]),
    ] {
        let mut errors = [Vec::new(), Vec::new(), Vec::new()];
        for n in cells {
            let cells = format!("grid.cells={n}");
            let fixed = ["method=otm", "grid.particles_per_cell=1", "time.cfl=0.5", "time.end=0.8"];
            let scene = scene(VIBRATION, &[sets, &fixed, &[cells.as_str()]].concat());
            let outcome = finished(&scene);
            for (list, field) in errors.iter_mut().zip(["velocity", "stress", "displacement"]) {
                list.push(value(&scene, &outcome, &format!("{field}_field_rms_relative")));
            }
        }
        let [v, stress, u] = errors.each_ref().map(|list| observed_order(&h, list));
        writeln!(table, "{name},{v},{stress},{u},{:.2e}", errors[0][6]).unwrap();
        let all = [&v, &stress, &u];
        let known = name != "lme γ = 1.8";
        assert!(!known || all.iter().all(|order| order.contains(2.0)), "{name}: {v} {stress} {u}");
        assert!(v.slope > 1.4 && stress.slope > 1.4 && u.contains(2.0), "{name}: {v} {stress} {u}");
    }
    approve("otm__orders", &table);
}

/// A strip with ν = 0 is the bar. (Without cut-off: a round support is no product
/// of two.)
#[test]
fn otm_strip_equals_bar() {
    let bar = scene(DYKA_OTM, &["basis.cutoff=0", "grid.cells=12", "basis.gamma=2"]);
    let one = finished(&bar).particles;
    let strip = DYKA_OTM
        .replace("length = 0.1333", "length = [0.1333, 0.033325]")
        .replace("particles_per_cell = 1", "particles_per_cell = [1, 1]")
        .replace("cells = 40", "cells = [12, 3]")
        .replace("from = 0.099975", "from = [0.099975, 0]")
        .replace("to = 0.1333", "to = [0.1333, 0.033325]")
        .replace("velocity = 5", "velocity = [5, 0]")
        .split("[[probe]]")
        .next()
        .unwrap()
        .to_string();
    let many = finished(&scene(&strip, &["basis.cutoff=0", "basis.gamma=2"])).particles;
    for (name, wide, scale) in
        [("velocity", "velocity_x", 5.0), ("stress", "stress_xx", 2e8), ("density", "density", 8e3)]
    {
        let (one, many) = (one.column(name).unwrap(), many.column(wide).unwrap());
        for (n, b) in many.iter().enumerate() {
            let a = one[n % 12];
            assert!((a - b).abs() < 1e-10 * scale, "{name}: {a} and {b}");
        }
    }
}

/// The bar: errors by γ, Courant number and grid against the figures of an
/// independent prototype, and the histories pinned.
#[test]
fn otm_dyka() {
    // (γ, cΔt/h, cells, v, σ, u): figures of the prototype.
    for (gamma, cfl, cells, v, stress, u) in [
        (4.0, 0.9, 40, 0.070, 0.147, None),
        (4.0, 0.9, 160, 0.048, 0.102, None),
        (6.0, 0.99, 160, 0.027, 0.064, Some(5.4e-4)),
    ] {
        let sets = [
            format!("basis.gamma={gamma}"),
            format!("time.cfl={cfl}"),
            format!("grid.cells={cells}"),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let scene = scene(DYKA_OTM, &sets);
        let outcome = finished(&scene);
        let near = |name: &str, there: f64| {
            let here = value(&scene, &outcome, name);
            assert!((here / there - 1.0).abs() < 0.1, "{sets:?}, {name}: {here} and {there}");
        };
        near("velocity_end_rms_relative", v);
        near("stress_three_quarter_rms_relative", stress);
        if let Some(u) = u {
            near("displacement_field_rms_relative", u);
        }
    }
    let mut table = String::from(
        "γ,points per cell,cells,velocity at L,stress at 3L/4,displacement field,largest energy drift,pairs per particle,bits of v,bits of σ\n",
    );
    for gamma in ["0.8", "1.8", "4", "6"] {
        for per_cell in [1, 2] {
            for cells in [40, 80, 160] {
                let sets = [
                    format!("basis.gamma={gamma}"),
                    format!("grid.particles_per_cell={per_cell}"),
                    format!("grid.cells={cells}"),
                ];
                let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
                let scene = scene(DYKA_OTM, &sets);
                let outcome = finished(&scene);
                let of = |name: &str| value(&scene, &outcome, name);
                let (v, s) =
                    (of("velocity_end_rms_relative"), of("stress_three_quarter_rms_relative"));
                let (u, drift) =
                    (of("displacement_field_rms_relative"), of("energy_drift_largest"));
                assert!(v < 0.25 && s < 0.4 && u < 0.1 && drift < 0.03, "{sets:?}: {v} {s} {u}");
                let bits = |probe: &str| digest(&outcome.history.column(probe).unwrap());
                let cost = outcome.cost;
                let pairs = cost.particle_node_pairs as f64 / cost.basis_evaluations as f64;
                writeln!(
                    table,
                    "{gamma},{per_cell},{cells},{v:.4},{s:.4},{u:.5},{drift:.4},{pairs:.1},{:016x},{:016x}",
                    bits("velocity_end"),
                    bits("stress_three_quarter")
                )
                .unwrap();
            }
        }
    }
    approve("otm__dyka", &table);
}

/// The histories of the bar by γ, thinned out.
#[test]
fn otm_histories() {
    for probe in ["velocity_end", "stress_three_quarter"] {
        let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
        for gamma in ["0.8", "1.8", "4", "6"] {
            let history = finished(&scene(DYKA_OTM, &[&format!("basis.gamma={gamma}")])).history;
            if columns.is_empty() {
                for name in ["step", "t", &format!("{probe}_exact")] {
                    columns.push((name.to_string(), history.column(name).unwrap()));
                }
            }
            columns.push((format!("γ = {gamma}"), history.column(probe).unwrap()));
        }
        let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = names.join(",");
        let last = columns[0].1.len() - 1;
        for row in 0..=32 {
            text.push('\n');
            let cells = columns.iter().map(|(_, list)| format!("{:.7e}", list[row * last / 32]));
            text += &cells.collect::<Vec<_>>().join(",");
        }
        approve(&format!("otm__{probe}"), &(text + "\n"));
    }
}

/// MPM and OTM side by side: the same cells, one particle in each, the same basis,
/// each at a common time step and at a large one of its own.
#[test]
fn otm_beside_mpm() {
    let mut table = String::from(
        "γ,method,mass,cfl,velocity at L,stress at 3L/4,displacement field,overshoot of σ,largest energy drift,pairs per particle and step,steps\n",
    );
    let mut rows = Vec::new();
    for gamma in ["0.8", "1.8", "4"] {
        for (method, mass, cfl) in [
            ("otm", "lumped", "0.5"),
            ("otm", "lumped", "0.99"),
            ("mpm", "lumped", "0.5"),
            ("mpm", "lumped", "0.99"),
            ("mpm 2 per cell", "lumped", "0.5"),
            ("mpm 2 per cell", "consistent", "0.2"),
        ] {
            let per_cell = if method.contains('2') { 2 } else { 1 };
            let sets = [
                format!("method={}", &method[..3]),
                format!("mass={mass}"),
                format!("basis.gamma={gamma}"),
                format!("time.cfl={cfl}"),
                format!("grid.particles_per_cell={per_cell}"),
                "grid.cells=80".to_string(),
            ];
            let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
            let scene = scene(DYKA_OTM, &sets);
            let outcome = finished(&scene);
            let of = |name: &str| value(&scene, &outcome, name);
            let over =
                of("stress_three_quarter_peak") / of("stress_three_quarter_peak_exact") - 1.0;
            let cost = outcome.cost;
            let pairs = cost.particle_node_pairs as f64 / cost.basis_evaluations as f64;
            rows.push((gamma, method, cfl, of("stress_three_quarter_rms_relative")));
            writeln!(
                table,
                "{gamma},{method},{mass},{cfl},{:.4},{:.4},{:.5},{over:.2},{:.4},{pairs:.1},{}",
                of("velocity_end_rms_relative"),
                of("stress_three_quarter_rms_relative"),
                of("displacement_field_rms_relative"),
                of("energy_drift_largest"),
                cost.steps
            )
            .unwrap();
        }
    }
    // Lumped beside lumped, OTM has the smaller error for every γ; how much smaller
    // grows with γ and with the time step.
    let error = |gamma, method, cfl| {
        let own = |row: &&(&str, &str, &str, f64)| (row.0, row.1, row.2) == (gamma, method, cfl);
        rows.iter().find(own).unwrap().3
    };
    for gamma in ["0.8", "1.8", "4"] {
        assert!(error(gamma, "otm", "0.5") < error(gamma, "mpm", "0.5"), "{gamma}");
    }
    assert!(error("4", "otm", "0.99") < 0.5 * error("4", "mpm", "0.99"));
    approve("otm__beside_mpm", &table);
}

/// The largest stable time step by marching, against 2/ω of M⁻¹K with frozen
/// functions, both on 40 cells with one particle in each.
#[test]
fn otm_stability_limit() {
    let mut table = String::from("γ,measured cΔt/h,predicted\n");
    for gamma in ["0.8", "1.8", "4", "6"] {
        let scene =
            scene(DYKA_OTM, &[&format!("basis.gamma={gamma}"), "initial_velocity.0.velocity=1e-7"]);
        let model = lme_mpm::setup::model::<1>(&scene);
        let c = (200e9_f64 / 7833.0).sqrt();
        let grows = |courant: f64| {
            let model = Model { dt: courant * model.grid.h[0] / c, ..model.clone() };
            let mut state = lme_mpm::setup::initial_state(&model, &scene);
            for (p, v) in state.particle.v.iter_mut().enumerate() {
                v[0] = 1e-7 * (12.9898 * p as f64).sin();
            }
            otm::start(&mut state, &model).unwrap();
            for step in 1..=2000 {
                if advance(&model, &mut state, step).is_err()
                    || state.node.v.iter().any(|v| v[0].abs() > 1e-4)
                {
                    return true;
                }
            }
            false
        };
        let (mut low, mut high) = (0.5, 4.0);
        while high - low > 2e-3 {
            let middle = 0.5 * (low + high);
            if grows(middle) { high = middle } else { low = middle }
        }
        let measured = 0.5 * (low + high);
        let predicted = 2.0 * c / (model.grid.h[0] * largest_frequency(&model, &scene));
        assert!((measured / predicted - 1.0).abs() < 0.02, "{gamma}: {measured}, {predicted}");
        writeln!(table, "{gamma},{measured:.3},{predicted:.4}").unwrap();
    }
    approve("otm__stability", &table);
}

/// ω of M⁻¹K by power iteration with the start's functions: K u is the force of the
/// stress E Σ ∇N u.
fn largest_frequency(model: &Model<1>, scene: &Scene) -> f64 {
    let mut state = lme_mpm::setup::initial_state(model, scene);
    otm::start(&mut state, model).unwrap();
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
        lme_mpm::method::continuum::sums::internal_force(node, particle, shape);
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
/// its displacement is exact.
#[test]
fn otm_with_linear_functions_is_exact_at_courant_one() {
    let scene = dyka(&["method=otm", "grid.particles_per_cell=1", "time.cfl=1"]);
    let outcome = finished(&scene);
    assert!(value(&scene, &outcome, "displacement_field_rms_relative") < 1e-4);
    assert!(matches!(scene.basis, Basis::Linear));
    let error = value(&scene, &outcome, "stress_three_quarter_rms_relative");
    assert!(error < 0.02, "{error}");
}
