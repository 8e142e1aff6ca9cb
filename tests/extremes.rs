//! The method at its limits. Each test says its GOAL, its SETUP and what is EXPECTED.
//! (`extremes_of_scenes.rs` has the limits of what a scene may ask for.)

use crate::support::*;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time::steps;
use lme_mpm::run::stability;
use lme_mpm::scene::{Scene, wave_speed};

/// GOAL: a node of tiny mass sends no particle off.
/// SETUP: the bar's last particle stands ε h beyond the end node, ε = 1e-2 … 1e-15, so
/// that the node behind it has the mass ε m_p; every integrator, 400 steps at 0.9 of the
/// predicted limit. (The consistent matrix: `mass_of_a_light_node_does_no_harm`.)
/// EXPECTED: at a step within its own limit for that place every scheme stays bounded.
/// The leapfrogs keep their usual step for any ε. For stress-last and generalized-α
/// the limit itself goes to zero like √(2ε), which the prediction says.
#[test]
fn extremes_particle_just_beyond_a_node() {
    for scheme in SCHEMES {
        for epsilon in [1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15] {
            let name = format!("{}, ε = {epsilon}", scheme.name);
            let small = ["grid.cells=8", "grid.particles_per_cell=1"];
            let scene = dyka(&[scheme.sets, &small].concat());
            let (model, mut state) = at_start::<1>(&scene);
            let h = model.grid.h[0];
            let end = 0.1333 + epsilon * h;
            state.particle.x[7][0] = end;
            let mut marched = state.clone();
            let State { particle, node, shape, mass, scratch, .. } = &mut state;
            steps::tabulate(shape, scratch, particle, &model).unwrap();
            steps::transfer(node, mass, particle, shape).unwrap();
            let limit = stability::limit(&mut state, &model);
            let courant = wave_speed(&scene.body) * limit / h;
            if scheme.leapfrog {
                assert!(courant > 0.99, "{name}: {courant}");
            } else {
                let beyond = end - 0.1333; // as stored
                let expected = (2.0 * beyond / h).sqrt();
                assert!((0.8..1.2).contains(&(courant / expected)), "{name}: {courant}");
            }
            // Frozen to 1e-20 of a cell, so that ε stays what it is.
            for v in &mut marched.particle.v {
                v[0] *= 1e-20;
            }
            march(&Model { dt: 0.9 * limit, ..model }, &mut marched, 400);
            let fastest = largest(marched.particle.v.iter().map(|v| v[0]));
            assert!(fastest < 10.0 * 5e-20, "{name}: {fastest:e}");
        }
    }
}

/// GOAL: particles on nodes, edges and ends, and one bit beside them, are ordinary.
/// SETUP: a block in uniform motion at a power of two whose particles start exactly on
/// nodes, on the grid's own ends, and ±1 ulp beside, one cell per step with the linear
/// basis; half of its flight.
/// EXPECTED: not one bit of stress with the linear basis, and 1e-11 of the modulus with
/// any other.
#[test]
fn extremes_particles_on_nodes_and_one_bit_beside() {
    for ulps in [-1.0, 0.0, 1.0] {
        let scene = scene(FREE_FLIGHT, &["grid.particles_per_cell=1", "time.cfl=1.2"]);
        let (model, mut state) = at_start::<1>(&scene);
        for (p, x) in state.particle.x.iter_mut().enumerate() {
            let node = (p as f64) * model.grid.h[0];
            x[0] = node + ulps * f64::EPSILON * node.max(1e-300);
        }
        // The grid's lower end, which has room before it.
        state.particle.x[0][0] = -model.grid.h[0];
        march(&model, &mut state, model.steps / 2);
        assert!(state.particle.sigma.iter().all(|sigma| sigma[0] == 0.0), "{ulps}");
        assert!(state.particle.v.iter().all(|v| v[0] == 8.0), "{ulps}");
    }
    for ulps in [-1.0, 0.0, 1.0] {
        for basis in BASES.into_iter().filter(|basis| *basis != LINEAR) {
            let scene = scene(FREE_FLIGHT, &[basis.sets, &["grid.beyond.left=3"]].concat());
            let (model, mut state) = at_start::<1>(&scene);
            for (p, x) in state.particle.x.iter_mut().enumerate() {
                let node = (p / 2) as f64 * model.grid.h[0];
                x[0] = node * (1.0 + ulps * f64::EPSILON);
            }
            march(&model, &mut state, model.steps / 2);
            let stress = largest(state.particle.sigma.iter().map(|sigma| sigma[0]));
            assert!(stress < 1e-5, "{}, {ulps}: {stress:e} Pa of 1e6 Pa", basis.name);
        }
    }
}

/// GOAL: any number of particles per cell.
/// SETUP: 1 to 64 on the bar of 20 cells, linear and local max-ent with γ = 0.8.
/// EXPECTED: an error of v below a half, as with two, and the energy kept to 2%.
#[test]
fn extremes_particles_per_cell() {
    for per_cell in [1, 2, 3, 5, 8, 16, 33, 64] {
        for basis in [LINEAR, LME_WIDE] {
            let n = format!("grid.particles_per_cell={per_cell}");
            let scene = dyka(&[basis.sets, &["grid.cells=20", &n]].concat());
            let result = outcome(&scene).unwrap();
            let v = bar_errors(&scene, &result).v;
            let drift = value(&scene, &result, "energy_drift_largest");
            assert!(v < 0.5 && drift < 0.02, "{per_cell}, {}: {v}, {drift}", basis.name);
        }
    }
}

/// GOAL: speeds from 1e-12 to 5000 m/s, which is the wave speed.
/// SETUP: the bar, its quarter thrown at them; then the free flight at a speed of many
/// cells per step.
/// EXPECTED: slow ones are one solution, scaled; fast ones end by name or without NaN;
/// a flight that leaves its grid is named, whatever the number of cells per step.
#[test]
fn extremes_of_speed() {
    let at = |v: f64| {
        let speed = format!("initial_velocity.0.velocity={v:e}");
        dyka(&["grid.cells=20", &speed, "grid.beyond.right=30"])
    };
    let slow = outcome(&at(1e-12)).unwrap();
    let usual = outcome(&at(1e-3)).unwrap();
    for name in ["velocity_end", "stress_three_quarter"] {
        let scaled: Vec<f64> = column(&slow.history, name).iter().map(|x| x * 1e9).collect();
        let usual = column(&usual.history, name);
        let off = apart(&scaled, &usual);
        assert!(off < 1e-5 * largest(usual), "{name}: {off:e}");
    }
    let mut broken = 0;
    for v in [1.0, 50.0, 500.0, 5000.0, -500.0, -5000.0, 1e8] {
        broken += usize::from(outcome(&at(v)).is_err());
    }
    assert!((1..7).contains(&broken), "{broken}");
    for cells_per_step in [0.5, 3.0, 1e3, 1e9, 1e300] {
        let dt = 0.05 / 31.6; // 0.5 h / c of that scene
        let speed = cells_per_step * 0.1 / dt;
        let text = format!("initial_velocity.0.velocity={speed:e}");
        let stopped = outcome(&scene(FREE_FLIGHT, &[&text, "time.end=0.5"])).unwrap_err();
        let named = matches!(
            stopped.broken.breakdown,
            Breakdown::LeftGrid { .. } | Breakdown::NotFinite { .. }
        );
        assert!(named, "{cells_per_step}: {}", stopped.broken.breakdown);
    }
}

/// GOAL: units do not matter.
/// SETUP: the bar on 12 cells with E and ρ times 1e±30, L times 1e±12; every basis.
/// EXPECTED: the error of the usual bar, to 1e-6.
#[test]
fn extremes_of_units() {
    for basis in BASES {
        let error = |scene: Scene| bar_errors(&scene, &outcome(&scene).unwrap()).v;
        let small = [basis.sets, &["grid.cells=12"]].concat();
        let usual = error(dyka(&small));
        for (length, modulus, density) in [
            (1.0, 1e30, 1.0),
            (1.0, 1e-30, 1.0),
            (1.0, 1.0, 1e30),
            (1.0, 1.0, 1e-30),
            (1.0, 1e30, 1e-30),
            (1e12, 1.0, 1.0),
            (1e-12, 1.0, 1.0),
        ] {
            let time = length * f64::sqrt(density / modulus);
            let units = bar_in_units(length, time, density, modulus);
            let here = error(dyka(&[&small[..], &strs(&units)].concat()));
            let name = format!("{}, {length}, {modulus}, {density}", basis.name);
            assert!((here / usual - 1.0).abs() < 1e-6, "{name}: {here} and {usual}");
        }
    }
}

/// GOAL: the origin does not matter.
/// SETUP: the bar on 12 cells, 1e12 cells away from it, where a place is known to some
/// 1e-4 of a cell; every basis.
/// EXPECTED: the error of the usual bar, to 1e-6, for only differences of places count.
#[test]
fn extremes_of_place() {
    let far = 1e12 * 0.1333 / 12.0;
    let moved = [
        "grid.cells=12",
        &format!("body.origin={far:e}"),
        &format!("initial_velocity.0.from={:e}", far + 0.099975),
        &format!("initial_velocity.0.to={:e}", far + 0.1333),
        &format!("probe.0.position={:e}", far + 0.13),
        &format!("probe.1.position={:e}", far + 0.09),
    ];
    for BasisCase { name, sets, .. } in BASES {
        let error = |scene: Scene| bar_errors(&scene, &outcome(&scene).unwrap()).v;
        let usual = error(dyka(&[sets, &["grid.cells=12"]].concat()));
        let here = error(dyka(&[sets, &moved].concat()));
        assert!((here / usual - 1.0).abs() < 1e-6, "{name}: {here} and {usual}");
    }
}

/// GOAL: γ at its extremes.
/// SETUP: the bar on 12 cells with γ from 1e-6 to 1e6, default cut-off, MPM with both
/// masses, OTM.
/// EXPECTED: a result or a named breakdown; from γ = 30 on the linear basis, to 1e-6.
#[test]
fn extremes_of_gamma() {
    let error = |sets: &[&str]| {
        let scene = dyka(&[sets, &["grid.cells=12"]].concat());
        outcome(&scene).ok().map(|outcome| bar_errors(&scene, &outcome).v)
    };
    let linear = error(&[]).unwrap();
    let finite_elements = error(&["method=otm"]).unwrap();
    for gamma in [1e-6, 1e-3, 0.05, 30.0, 700.0, 1e4, 1e6] {
        let own = format!("basis.gamma={gamma:e}");
        let lumped = error(&["basis.kind=lme", &own]);
        let otm = error(&["method=otm", "basis.kind=lme", &own]);
        error(&["basis.kind=lme", &own, "mass=consistent", "time.cfl=0.05"]);
        if gamma >= 30.0 {
            assert!((lumped.unwrap() / linear - 1.0).abs() < 1e-6, "{gamma}");
            assert!((otm.unwrap() / finite_elements - 1.0).abs() < 1e-6, "{gamma}");
        }
    }
}

/// GOAL: Δt from 1e-6 of the limit to 1.5 times it.
/// SETUP: some steps of the bar on 8 cells at each, with every scheme.
/// EXPECTED: the smallest step moves like the exact solution, to 1e-3; above the limit the
/// energy grows until the run is stopped by name.
#[test]
fn extremes_of_the_time_step() {
    for Scheme { name, sets, .. } in SCHEMES {
        let tiny = ["grid.cells=8", "time.fraction_of_critical=1e-6", "time.end=1e-10"];
        let result = outcome(&dyka(&[sets, &tiny].concat())).unwrap();
        let taken = result.cost.steps;
        assert!((5..100).contains(&taken), "{name}: {taken}");
        let [u, exact] = ["displacement", "displacement_exact"]
            .map(|name| *column(&result.particles, name).last().unwrap());
        assert!((u / exact - 1.0).abs() < 1e-3, "{name}: {u:e} and {exact:e}");
        let wild = ["grid.cells=8", "time.cfl=9", "time.fraction_of_critical=1.5", "time.end=1e-3"];
        let stopped = outcome(&dyka(&[sets, &wild].concat())).unwrap_err();
        let grown = matches!(
            stopped.broken.breakdown,
            Breakdown::Diverged { .. }
                | Breakdown::BeyondLimit { .. }
                | Breakdown::Inverted { .. }
                | Breakdown::LeftGrid { .. }
        );
        assert!(grown && stopped.broken.moment.step > 0, "{name}: {}", stopped.broken);
    }
}

/// GOAL: the energy stays over 100 000 steps, and the run ends as it should.
/// SETUP: the bar on 8 cells, more than 1500 of its periods; Newmark's method, and OTM.
/// EXPECTED: no drift of the mean above five percent, although the bar is thrown hard.
#[test]
fn extremes_of_length() {
    for method in ["method=mpm", "method=otm"] {
        let end = format!("time.end={:e}", 1e5 * 0.5 * transit() / 8.0);
        let scene = dyka(&[method, "grid.cells=8", "output.every=97", &end]);
        let result = outcome(&scene).unwrap();
        let (first, last) = means_of_tenths(&total_energy(&result.history));
        let drift = last / first - 1.0;
        assert!(drift.abs() < 0.05, "{method}: {drift}");
    }
}

/// GOAL: strain to near inversion ends by name.
/// SETUP: a bar thrown at its wall faster and faster, 1e2 to 1e5 m/s, MPM and OTM.
/// EXPECTED: densities stay positive, and from some speed on the run ends by naming the
/// particle whose volume is used up or which left the grid.
#[test]
fn extremes_of_compression() {
    for method in ["mpm", "otm"] {
        let ended = [1e2, 1e3, 3e3, 1e4, 1e5].map(|v: f64| {
            let throw =
                format!("initial_velocity=[{{ from = 0, to = 0.1333, velocity = -{v:e} }}]");
            let Ok(result) = outcome(&dyka(&[&format!("method={method}"), &throw])) else {
                return true;
            };
            let rho = column(&result.particles, "density");
            assert!(rho.iter().all(|rho| *rho > 0.0), "{method}, {v}");
            false
        });
        assert!(!ended[0] && ended[4] && ended.is_sorted(), "{method}: {ended:?}");
    }
}

/// Where a number of a running bar is spoiled.
#[derive(Clone, Copy, Debug)]
enum Spoiled {
    Position,
    Velocity,
    Stress,
}

/// GOAL: a NaN is caught within the step, in the particle that has it.
/// SETUP: NaN or infinity put into place, velocity or stress of one particle of a
/// running bar of 10 cells; every integrator, OTM.
/// EXPECTED: the next step ends by name. What a NaN reaches first, through the nodes,
/// is the lowest-numbered particle beside it, six away at most.
#[test]
fn extremes_nan_is_caught() {
    let otm = ("otm", &["method=otm"][..]);
    for (name, sets) in SCHEMES.map(|scheme| (scheme.name, scheme.sets)).into_iter().chain([otm]) {
        for what in [Spoiled::Position, Spoiled::Velocity, Spoiled::Stress] {
            for bad in [f64::NAN, f64::INFINITY] {
                let scene = dyka(&[sets, &["grid.cells=10"]].concat());
                let (model, mut state) = at_start::<1>(&scene);
                march(&model, &mut state, 5);
                let moving_nodes = model.method.moves_nodes();
                let hurt = 9;
                // Nodes and points of OTM are numbered apart, two points to a node.
                let mut beside = hurt;
                match what {
                    Spoiled::Position => state.particle.x[hurt][0] = bad,
                    Spoiled::Velocity if moving_nodes => {
                        state.node.v[hurt][0] = bad;
                        beside = 2 * hurt;
                    }
                    Spoiled::Velocity => state.particle.v[hurt][0] = bad,
                    Spoiled::Stress => state.particle.sigma[hurt][0] = bad,
                }
                let particle = match advance(&model, &mut state, 6).unwrap_err() {
                    Breakdown::NotFinite { particle, .. }
                    | Breakdown::LeftGrid { particle, .. }
                    | Breakdown::NoBasis { particle, .. } => particle,
                    other => panic!("{name}, {what:?}: {other}"),
                };
                assert!(particle.abs_diff(beside) <= 6, "{name}, {what:?}: {particle}");
            }
        }
    }
}
