//! The method at its limits. Each test says its GOAL, its SETUP and what is EXPECTED.

use crate::support::*;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::model::Model;
use lme_mpm::method::model::State;
use lme_mpm::method::time::steps;
use lme_mpm::run::{Stopped, run};
use lme_mpm::scene::{DYKA, Scene};
use nalgebra::SVector;
use proptest::prelude::*;

/// Runs a scene; a result must be free of NaN, a breakdown must have a name and a
/// history without NaN.
fn outcome(scene: &Scene) -> Result<lme_mpm::run::Outcome, Box<Stopped>> {
    let result = run(scene, &mut |_| {});
    let (history, particles) = match &result {
        Ok(outcome) => (&outcome.history, Some(&outcome.particles)),
        Err(stopped) => {
            assert!(stopped.broken.breakdown.to_string().len() > 30);
            (&stopped.history, None)
        }
    };
    let tables = std::iter::once(history).chain(particles);
    for table in tables {
        assert!(table.rows().all(|row| row.iter().all(|x| x.is_finite())), "NaN in a table");
    }
    result
}

/// GOAL: a node of tiny mass sends no particle off.
/// SETUP: the bar's last particle stands ε h beyond the end node, ε = 1e-2 … 1e-15, so
/// that the node behind it has the mass ε m_p; every integrator. (The consistent
/// matrix: `mass_of_a_light_node_does_no_harm`.)
/// EXPECTED: at a step within its own limit for that place every scheme stays bounded.
/// The leapfrogs keep their usual step for any ε. For stress-last and generalized-α
/// the limit itself goes to zero like √(2ε), which the prediction says.
#[test]
fn extremes_particle_just_beyond_a_node() {
    for (name, sets) in SCHEMES {
        for epsilon in [1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-15] {
            let scene = dyka(&[sets, &["grid.cells=8", "grid.particles_per_cell=1"]].concat());
            let model = lme_mpm::setup::model::<1>(&scene);
            let at_end = |state: &mut lme_mpm::method::model::State<1>| {
                state.particle.x[7][0] = 0.1333 + epsilon * model.grid.h[0];
            };
            let mut state = lme_mpm::setup::initial_state(&model, &scene);
            at_end(&mut state);
            let State { particle, node, shape, mass, scratch, .. } = &mut state;
            steps::tabulate(shape, scratch, particle, &model).unwrap();
            steps::transfer(node, mass, particle, shape).unwrap();
            let limit = lme_mpm::run::stability::limit(&mut state, &model);
            let c = lme_mpm::scene::wave_speed(&scene.body);
            let courant = c * limit / model.grid.h[0];
            let filtered = !(name.contains("(last)") || name.contains("generalized"));
            if filtered {
                assert!(courant > 0.99, "{name}, ε = {epsilon}: {courant}");
            } else {
                let beyond = (0.1333 + epsilon * model.grid.h[0]) - 0.1333; // as stored
                let expected = (2.0 * beyond / model.grid.h[0]).sqrt();
                assert!(
                    (0.8..1.2).contains(&(courant / expected)),
                    "{name}, ε = {epsilon}: {courant}"
                );
            }
            // Frozen to 1e-20 of a cell, so that ε stays what it is.
            let model = Model { dt: 0.9 * limit, ..model.clone() };
            let mut state = lme_mpm::setup::initial_state(&model, &scene);
            at_end(&mut state);
            for v in &mut state.particle.v {
                v[0] *= 1e-20;
            }
            march(&model, &mut state, 400);
            let fastest = state.particle.v.iter().fold(0.0, |a: f64, v| a.max(v[0].abs()));
            assert!(fastest < 10.0 * 5e-20, "{name}, ε = {epsilon}: {fastest:e}");
        }
    }
}

/// GOAL: particles on nodes, edges and ends, and one bit beside them, are ordinary.
/// SETUP: a block in uniform motion at a power of two whose particles start exactly on
/// nodes, on the grid's own ends, and ±1 ulp beside, 1D and 2D, one cell per step.
/// EXPECTED: not one bit of stress with the linear basis, no NaN with any.
#[test]
fn extremes_particles_on_nodes_and_one_bit_beside() {
    for ulps in [-1.0, 0.0, 1.0] {
        let scene = scene(FREE_FLIGHT, &["grid.particles_per_cell=1", "time.cfl=1.2"]);
        let model = lme_mpm::setup::model::<1>(&scene);
        let mut state = lme_mpm::setup::initial_state(&model, &scene);
        for (p, x) in state.particle.x.iter_mut().enumerate() {
            let node = (p as f64) * model.grid.h[0];
            x[0] = node + ulps * f64::EPSILON * node.max(1e-300);
        }
        // The grid's lower end, which has room before it.
        state.particle.x[0][0] = -model.grid.h[0];
        march(&model, &mut state, model.steps / 2);
        assert!(state.particle.sigma.iter().all(|sigma| sigma[0] == 0.0), "{ulps}");
        assert!(state.particle.v.iter().all(|v| v[0] == 8.0), "{ulps}");
        for sets in BASES.iter().skip(1).map(|(_, sets)| *sets) {
            let scene =
                crate::support::scene(FREE_FLIGHT, &[sets, &["grid.beyond.left=3"]].concat());
            let model = lme_mpm::setup::model::<1>(&scene);
            let mut state = lme_mpm::setup::initial_state(&model, &scene);
            for (p, x) in state.particle.x.iter_mut().enumerate() {
                let node = (p / 2) as f64 * model.grid.h[0];
                x[0] = node * (1.0 + ulps * f64::EPSILON);
            }
            march(&model, &mut state, model.steps / 2);
            let stress = state.particle.sigma.iter().fold(0.0, |a: f64, s| a.max(s[0].abs()));
            assert!(stress < 1e-5, "{sets:?}, {ulps}: {stress:e} Pa of 1e6 Pa");
        }
    }
}

/// GOAL: any number of particles per cell.
/// SETUP: 1 to 64 on the bar, linear and local max-ent.
/// EXPECTED: errors like those of two, energy kept.
#[test]
fn extremes_particles_per_cell() {
    for per_cell in [1, 2, 3, 5, 8, 16, 33, 64] {
        for sets in [BASES[0].1, BASES[3].1] {
            let n = format!("grid.particles_per_cell={per_cell}");
            let scene = dyka(&[sets, &[n.as_str(), "grid.cells=20"]].concat());
            let result = outcome(&scene).unwrap();
            let v = value(&scene, &result, "velocity_end_rms_relative");
            let drift = value(&scene, &result, "energy_drift_largest");
            assert!(v < 0.5 && drift < 0.02, "{per_cell}, {sets:?}: {v}, {drift}");
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
        let (a, b) = (slow.history.column(name).unwrap(), usual.history.column(name).unwrap());
        let scale = b.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (a, b) in a.iter().zip(&b) {
            assert!((a * 1e9 - b).abs() < 1e-5 * scale, "{name}");
        }
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
/// SETUP: E and ρ times 1e±30, L times 1e±12, a body 1e12 h from the origin; every
/// basis.
/// EXPECTED: the errors of the usual bar.
#[test]
fn extremes_of_units_and_place() {
    for (basis, sets) in BASES {
        let error =
            |scene: &Scene| value(scene, &outcome(scene).unwrap(), "velocity_end_rms_relative");
        let usual = error(&dyka(&[sets, &["grid.cells=12"]].concat()));
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
            let texts = [
                format!("body.length={:e}", 0.1333 * length),
                format!("body.youngs_modulus={:e}", 200e9 * modulus),
                format!("body.density={:e}", 7833.0 * density),
                format!("time.end={:e}", 1.0552107481257e-4 * time),
                format!("initial_velocity.0.from={:e}", 0.099975 * length),
                format!("initial_velocity.0.to={:e}", 0.1333 * length),
                format!("initial_velocity.0.velocity={:e}", 5.0 * length / time),
                format!("probe.0.position={:e}", 0.1333 * length),
                format!("probe.1.position={:e}", 0.099975 * length),
                "grid.cells=12".to_string(),
            ];
            let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
            let here = error(&dyka(&[sets, &texts[..]].concat()));
            assert!((here / usual - 1.0).abs() < 1e-6, "{basis}, {length}, {modulus}, {density}");
        }
        // 1e12 h away a place is known to some 1e-4 h: the scene says where it stands.
        let far = 1e12 * 0.1333 / 12.0;
        let texts = [
            format!("body.origin={far:e}"),
            format!("initial_velocity.0.from={:e}", far + 0.099975),
            format!("initial_velocity.0.to={:e}", far + 0.1333),
            format!("probe.0.position={:e}", far + 0.13),
            format!("probe.1.position={:e}", far + 0.09),
            "grid.cells=12".to_string(),
        ];
        let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
        if let Ok(scene) = lme_mpm::run::parse(
            "far",
            "far",
            DYKA,
            &[sets, &texts[..]].concat().iter().map(|s| s.to_string()).collect::<Vec<_>>(),
        ) {
            let here = error(&scene);
            assert!((here / usual - 1.0).abs() < 0.2, "{basis}: {here} and {usual}");
        }
    }
}

/// GOAL: γ at its extremes.
/// SETUP: the bar with γ from 1e-6 to 1e6, default cut-off, MPM with both masses, OTM.
/// EXPECTED: a result or a named breakdown; large γ is the linear basis.
#[test]
fn extremes_of_gamma() {
    let error = |sets: &[&str]| {
        let scene = dyka(&[sets, &["grid.cells=12"]].concat());
        outcome(&scene).ok().map(|outcome| value(&scene, &outcome, "velocity_end_rms_relative"))
    };
    let linear = error(&[]).unwrap();
    let fe = error(&["method=otm"]).unwrap();
    for gamma in ["1e-6", "1e-3", "0.05", "30", "700", "1e4", "1e6"] {
        let own = format!("basis.gamma={gamma}");
        let large = gamma.parse::<f64>().unwrap() > 20.0;
        let lumped = error(&["basis.kind=lme", &own]);
        let otm = error(&["method=otm", "basis.kind=lme", &own]);
        error(&["basis.kind=lme", &own, "mass=consistent", "time.cfl=0.05"]);
        if large {
            assert!((lumped.unwrap() / linear - 1.0).abs() < 1e-6, "{gamma}");
            assert!((otm.unwrap() / fe - 1.0).abs() < 1e-6, "{gamma}");
        }
    }
}

/// GOAL: Δt from 1e-6 of the limit to 1.5 times it.
/// SETUP: some steps of the bar at each.
/// EXPECTED: the smallest step moves like the exact solution; above the limit the
/// energy grows until the run is stopped by name.
#[test]
fn extremes_of_the_time_step() {
    for (name, sets) in SCHEMES {
        let scene = dyka(
            &[sets, &["grid.cells=8", "time.fraction_of_critical=1e-6", "time.end=1e-10"]].concat(),
        );
        let result = outcome(&scene).unwrap();
        let taken = result.cost.steps;
        assert!((5..100).contains(&taken), "{name}: {taken}");
        let u = result.particles.column("displacement").unwrap();
        let exact = result.particles.column("displacement_exact").unwrap();
        let (last, exact) = (u.last().unwrap(), exact.last().unwrap());
        assert!((last / exact - 1.0).abs() < 1e-3, "{name}: {last:e} and {exact:e}");
        let wild = ["grid.cells=8", "time.cfl=9", "time.fraction_of_critical=1.5", "time.end=1e-3"];
        let stopped = outcome(&dyka(&[sets, &wild].concat())).unwrap_err();
        let grown = matches!(
            stopped.broken.breakdown,
            Breakdown::Diverged { .. } | Breakdown::Inverted { .. } | Breakdown::LeftGrid { .. }
        );
        assert!(grown && stopped.broken.moment.step > 0, "{name}: {}", stopped.broken);
    }
}

/// GOAL: the energy stays over 100 000 steps, and the run ends as it should.
/// SETUP: the bar on 8 cells, far more periods than any study; Newmark's method, and
/// OTM.
/// EXPECTED: no drift of the mean above five percent, although the bar is thrown hard.
#[test]
fn extremes_of_length() {
    for method in ["method=mpm", "method=otm"] {
        let end = format!("time.end={:e}", 1e5 * 0.5 * transit() / 8.0);
        let scene = dyka(&[method, "grid.cells=8", "output.every=97", &end]);
        let result = outcome(&scene).unwrap();
        let total: Vec<f64> = result
            .history
            .column("kinetic_energy")
            .unwrap()
            .iter()
            .zip(result.history.column("strain_energy").unwrap())
            .map(|(a, b)| a + b)
            .collect();
        let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
        let tenth = total.len() / 10;
        let drift = mean(&total[total.len() - tenth..]) / mean(&total[..tenth]) - 1.0;
        assert!(drift.abs() < 0.05, "{method}: {drift}");
    }
}

/// GOAL: strain to near inversion ends by name.
/// SETUP: a bar thrown at its wall faster and faster.
/// EXPECTED: densities stay positive, and from some speed on the run ends by naming the
/// particle whose volume is used up or which left the grid.
#[test]
fn extremes_of_compression() {
    let mut named = 0;
    for v in [1e2, 1e3, 3e3, 1e4, 1e5] {
        for method in ["mpm", "otm"] {
            let sets = [
                format!("method={method}"),
                format!("initial_velocity=[{{ from = 0, to = 0.1333, velocity = -{v:e} }}]"),
            ];
            let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
            match outcome(&dyka(&sets)) {
                Ok(result) => {
                    let rho = result.particles.column("density").unwrap();
                    assert!(rho.iter().all(|rho| *rho > 0.0));
                }
                Err(_) => named += 1,
            }
        }
    }
    assert!(named >= 2, "{named}");
}

/// GOAL: a NaN is caught within the step, in the particle that has it.
/// SETUP: NaN or infinity put into place, velocity or stress of one particle of a
/// running bar; every integrator, OTM.
/// EXPECTED: the next step ends by name. What a NaN reaches first, through the nodes,
/// is the lowest-numbered particle beside it.
#[test]
fn extremes_nan_is_caught() {
    let mut all: Vec<(&str, Vec<&str>)> =
        SCHEMES.iter().map(|(name, sets)| (*name, sets.to_vec())).collect();
    all.push(("otm", vec!["method=otm"]));
    for (name, sets) in all {
        for what in ["x", "v", "sigma"] {
            for bad in [f64::NAN, f64::INFINITY] {
                let scene = dyka(&[&sets[..], &["grid.cells=10"]].concat());
                let model = lme_mpm::setup::model::<1>(&scene);
                let mut state = lme_mpm::setup::initial_state(&model, &scene);
                march(&model, &mut state, 5);
                let nodes = !state.node.x.is_empty();
                let hurt = 9;
                match what {
                    "x" => state.particle.x[hurt][0] = bad,
                    "v" if nodes => state.node.v[hurt][0] = bad,
                    "v" => state.particle.v[hurt][0] = bad,
                    _ => state.particle.sigma[hurt][0] = bad,
                }
                let stopped = advance(&model, &mut state, 6).unwrap_err();
                let particle = match stopped {
                    Breakdown::NotFinite { particle, .. }
                    | Breakdown::LeftGrid { particle, .. } => particle,
                    Breakdown::NoBasis { particle, .. } => particle,
                    other => panic!("{name}, {what}: {other}"),
                };
                // Nodes and points of OTM are numbered apart, two points to a node.
                let beside = if nodes && what == "v" { 2 * hurt } else { hurt };
                assert!(particle.abs_diff(beside) <= 6, "{name}, {what}: {particle}");
            }
        }
    }
}

/// GOAL: a grid that does not fit is refused with the memory it would need.
/// SETUP: 1e9 cells and more in 1D and 2D, and a long series of large frames.
/// EXPECTED: an error at once, before anything is allocated.
#[test]
fn extremes_of_memory() {
    let ask = |text: &str, sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
        lme_mpm::run::parse("big", "big", text, &sets).unwrap_err().problem
    };
    assert!(ask(DYKA, &["grid.cells=1000000000"]).contains("GB"));
    assert!(ask(DYKA, &["grid.cells=9000000000000000000"]).contains("GB"));
    let huge = ["grid.cells=[100000,100000]", "body.ball=[]"];
    assert!(ask(DISCS, &huge).contains("GB"));
    let frames = ["output.vtk=true", "grid.cells=[1000,1000]", "time.end=1e4"];
    assert!(ask(DISCS, &frames).contains("GB"));
}

proptest! {
    #![proptest_config(same_every_time(400))]

    /// GOAL: no scene file makes the program panic.
    /// SETUP: shipped scenes with bytes replaced, cut off, or doubled at random.
    /// EXPECTED: a scene or an error with a place in the text.
    #[test]
    fn extremes_of_scene_files(
        which in 0..5usize,
        cut in 0.0..1.0f64,
        at in prop::collection::vec((0.0..1.0f64, prop::sample::select(vec![
            '0', '9', '-', 'e', '.', '"', '[', ']', '{', '}', '=', '\n', '#', 'µ', '\u{0}', ' ', 'n',
        ])), 0..4),
        keep in any::<bool>(),
    ) {
        let text = [DYKA, VIBRATION, GRAVITY, MANUFACTURED, DISCS][which];
        let mut letters: Vec<char> = text.chars().collect();
        for (place, letter) in at {
            let n = (place * letters.len() as f64) as usize;
            letters[n] = letter;
        }
        if !keep {
            letters.truncate((cut * letters.len() as f64) as usize);
        }
        let text: String = letters.into_iter().collect();
        if let Err(error) = lme_mpm::run::parse("fuzz", "fuzz.toml", &text, &[]) {
            prop_assert!(error.span.end <= error.text.len());
            prop_assert!(!error.to_string().is_empty());
        }
    }

    /// GOAL: no `--set` makes it panic either.
    #[test]
    fn extremes_of_sets(set in "[a-z_.0-9]{0,24}=?[-+0-9a-z\\[\\]{}\"., ]{0,16}") {
        if let Err(error) = lme_mpm::run::parse("fuzz", "fuzz.toml", DYKA, &[set]) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}

/// GOAL: only what a scene requires is computed and carried.
/// SETUP: every shipped scene and some variants.
/// EXPECTED: the table of counters, in which what is undeclared is 0.
#[test]
fn extremes_of_frugality() {
    let mut table = String::from(
        "scene,dimension,bytes per particle,pairs per particle and step,exponentials,newton iterations,body forces,tractions,factorizations,candidates\n",
    );
    let frozen = lme_mpm::scene::DYKA;
    let otm = include_str!("../data/scenes/dyka-otm.toml");
    let short = ["time.end=1e-6"];
    for (name, text, sets) in [
        ("dyka", frozen, &[][..]),
        ("dyka (uGIMP)", frozen, &["basis.kind=ugimp"]),
        ("dyka (B-splines)", frozen, &["basis.kind=bspline"]),
        ("dyka (local max-ent)", frozen, &["basis.kind=lme", "basis.gamma=0.8"]),
        ("dyka (generalized-α)", frozen, &["time.integrator=generalized-alpha", "time.rho_b=0.8"]),
        ("dyka (consistent mass)", frozen, &["mass=consistent"]),
        ("dyka-otm", otm, &[]),
        ("gravity", GRAVITY, &[]),
        ("traction", TRACTION, &[]),
        ("vibration", VIBRATION, &[]),
        ("manufactured", MANUFACTURED, &[]),
        ("colliding-discs", DISCS, &[]),
    ] {
        let short = if text == DISCS || text == VIBRATION { &["time.end=0.1"][..] } else { &short };
        let scene = scene(text, &[sets, short].concat());
        let result = outcome(&scene).unwrap();
        let cost = result.cost;
        let each = cost.particle_node_pairs as f64 / cost.basis_evaluations as f64;
        table += &format!(
            "{name},{},{},{each:.1},{},{},{},{},{},{}\n",
            scene.dimension(),
            cost.bytes_per_particle,
            cost.exponentials,
            cost.newton_iterations,
            cost.body_forces,
            cost.tractions,
            cost.factorizations,
            cost.candidates
        );
        let lme = matches!(scene.basis, lme_mpm::method::basis::Basis::Lme { .. });
        assert_eq!(cost.exponentials > 0, lme, "{name}");
        assert_eq!(cost.body_forces > 0, text == GRAVITY || text == MANUFACTURED, "{name}");
        assert_eq!(cost.tractions > 0, text == TRACTION, "{name}");
        assert_eq!(cost.factorizations > 0, name.contains("consistent"), "{name}");
        assert_eq!(cost.candidates > 0, text == otm, "{name}");
        assert!(result.frames.is_empty(), "{name}: frames nobody asked for");
        let plain = !lme && !name.contains("generalized");
        assert!(!plain || cost.bytes_per_particle == [48, 112][scene.dimension() - 1], "{name}");
    }
    assert_eq!(size_of::<SVector<f64, 1>>(), 8, "a 1D vector is a number");
    approve("extremes__frugality", &table);
}
