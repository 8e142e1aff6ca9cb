//! What must stay as it is: mass, momentum, angular momentum, and energy with the
//! work of the loads.

use crate::support::lines::{Dash, Frame, Line, lines};
use crate::support::*;
use lme_mpm::method::measure;
use lme_mpm::method::time;
use lme_mpm::output::figure::{self, Axes};
use lme_mpm::run::table::Table;
use nalgebra::Vector2;
use std::fmt::Write;

/// With every scheme, basis and mass matrix the momentum of a free body stays to n·ε, n
/// steps times 64, and the mass of each particle to its last digit: the bar to its end.
#[test]
fn conservation_of_mass_and_momentum() {
    for scheme in SCHEMES {
        for basis in BASES {
            for mass in MASSES {
                let cfl = if mass == LUMPED { "time.cfl=0.5" } else { "time.cfl=0.35" };
                let free = ["boundary.left=free", "grid.beyond={ left = 2, right = 2 }", cfl];
                let scene = dyka(&[scheme.sets, basis.sets, mass.sets, &free].concat());
                let outcome = finished(&scene);
                let momentum = column(&outcome.history, "momentum");
                let drift = largest(momentum.iter().map(|p| p / momentum[0] - 1.0));
                let bound = 64.0 * outcome.cost.steps as f64 * f64::EPSILON;
                let name = format!("{}, {}, {}", scheme.name, basis.name, mass.name);
                assert!(drift < bound, "{name}: {drift:e}");
                let masses = column(&outcome.particles, "mass");
                let share = 7833.0 * (0.1333 / 80.0);
                let off = largest(masses.iter().map(|m| m / share - 1.0));
                assert!(off < 1e-15, "{name}: {off:e}");
            }
        }
    }
}

/// Steps of the long runs.
const STEPS: f64 = 1e5;

/// What becomes of the total energy less the work of the loads, relative to the largest
/// total energy.
struct Balance {
    /// The mean over the last tenth less that over the first.
    drift: f64,
    /// The largest deviation from the mean over the first tenth.
    swing: f64,
}

fn balance(history: &Table) -> Balance {
    let total = total_energy(history);
    let work = history.column("work").unwrap_or_else(|| vec![0.0; total.len()]);
    let scale = largest(total.iter().copied());
    let own: Vec<f64> = total.iter().zip(&work).map(|(a, b)| (a - b) / scale).collect();
    let (first, last) = means_of_tenths(&own);
    Balance { drift: last - first, swing: largest(own.iter().map(|e| e - first)) }
}

/// The balance of a bar of 8 cells after `STEPS` steps, whose wave takes `transit` (s)
/// from end to end; recorded every 7 steps, which is no part of a period.
fn long(text: &str, transit: f64, sets: &[&str]) -> Balance {
    let end = format!("time.end={:?}", STEPS * 0.5 * transit / 8.0);
    let outcome =
        finished(&scene(text, &[sets, &["grid.cells=8", "output.every=7", &end]].concat()));
    assert_eq!(outcome.cost.steps as f64, STEPS);
    balance(&outcome.history)
}

/// L/c of the bar of vibration.toml (s).
const VIBRATION_TRANSIT: f64 = 1.0;
/// L/c of the bar of gravity.toml (s).
const GRAVITY_TRANSIT: f64 = 6.324555320336759e-3;
/// A hundredth of its gravity: particles move by less than 1e-5 of a cell.
const WEAK: &str = "body_force.acceleration=0.0981";

/// The table of energy over 100 000 steps, in free vibration and under sudden gravity
/// with the work counted, of one basis with some schemes.
///
/// Newmark's method keeps it to 1e-4, the other leapfrogs to 1e-3; stress-last
/// and generalized-α lose it.
fn energy(basis: &BasisCase, schemes: &[Scheme]) -> String {
    let columns = "basis,scheme,free: drift,free: swing,gravity: drift,gravity: swing\n";
    let mut table = String::from(columns);
    for scheme in schemes {
        let sets = [scheme.sets, basis.sets].concat();
        let free = long(VIBRATION, VIBRATION_TRANSIT, &sets);
        let loaded = long(GRAVITY, GRAVITY_TRANSIT, &[&sets[..], &[WEAK]].concat());
        let name = format!("{},{}", basis.name, scheme.name);
        writeln!(
            table,
            "{name},{:.1e},{:.1e},{:.1e},{:.1e}",
            free.drift, free.swing, loaded.drift, loaded.swing
        )
        .unwrap();
        let said = format!("{name}: {:e}, {:e}", free.drift, loaded.drift);
        if scheme.leapfrog {
            let bound = if *scheme == NEWMARK { 1e-4 } else { 1e-3 };
            assert!(free.drift.abs() < bound && loaded.drift.abs() < bound, "{said}");
        } else {
            assert!(free.drift < -0.1 && loaded.drift < 0.0, "{said}");
        }
    }
    table
}

/// The leapfrogs keep the energy of the linear basis over 100 000 steps, the other schemes
/// lose it; bounds in `energy`.
#[test]
fn conservation_of_energy_linear() {
    approve("conservation__energy_linear", &energy(&LINEAR, &SCHEMES));
}

/// The same with local max-ent, γ = 0.8, for one leapfrog and both other schemes.
#[test]
fn conservation_of_energy_local_max_ent() {
    let table = energy(&LME_WIDE, &[NEWMARK, STRESS_LAST, GENERALIZED_ALPHA]);
    approve("conservation__energy_lme", &table);
}

/// The energy of the vibrating bar of 8 cells over a hundred periods, c Δt/h = 1/2, as its mean over
/// each 64 steps, a period of the exact wave: those of the leapfrogs keep within one percent of each other
/// and of where they began, generalized-α loses more than a twentieth, stress-last more than a third.
#[test]
fn conservation_in_a_picture() {
    let looks = [
        ("Newmark", 0, Dash::Solid),
        ("Newmark as printed", 4, Dash::Dashed),
        ("stress-first", 2, Dash::Dotted),
        ("stress-last", 1, Dash::Solid),
        ("modified-last", 5, Dash::Dashed),
        ("corrected Euler", 6, Dash::Dotted),
        ("generalized-α (0.8)", 3, Dash::Solid),
    ];
    let mut drawn = Vec::new();
    for (scheme, (name, colour, dash)) in SCHEMES.into_iter().zip(looks) {
        let sets = [scheme.sets, &["grid.cells=8", "time.cfl=0.5", "time.end=400"]].concat();
        let total = total_energy(&finished(&scene(VIBRATION, &sets)).history);
        let mean = |block: &[f64]| block.iter().sum::<f64>() / block.len() as f64;
        let means: Vec<f64> = total.chunks_exact(64).map(mean).collect();
        let shares: Vec<f64> = means.iter().map(|energy| energy / means[0]).collect();
        let (off, last) = (largest(shares.iter().map(|share| share - 1.0)), shares[99]);
        match scheme {
            STRESS_LAST => assert!(last < 0.67, "{name}: {last}"),
            GENERALIZED_ALPHA => assert!(last < 0.95, "{name}: {last}"),
            _ => assert!(off < 0.01, "{name}: {off}"),
        }
        let points = shares.into_iter().enumerate().map(|(n, share)| (n as f64, share)).collect();
        drawn.push(Line::new(name, points, colour).dashed(dash));
    }
    let frame = Frame {
        x: "time [periods]",
        y: "mean energy / that of the first period",
        x_range: Some((0.0, 100.0)),
        y_range: Some((0.6, 1.05)),
        ..Frame::default()
    };
    approve_picture("conservation__histories", lines(&drawn, &frame));
}

/// The drift under gravity is proportional to the displacement: a hundred times the
/// gravity drifts a hundred times as far, within a factor of two. It comes from
/// particles that move through the grid, not from the steps in time.
#[test]
fn conservation_of_energy_needs_still_particles() {
    let drift = |sets: &[&str]| long(GRAVITY, GRAVITY_TRANSIT, sets).drift;
    let ratio = drift(&[]) / drift(&[WEAK]);
    assert!((50.0..200.0).contains(&ratio), "{ratio}");
}

/// What a body has lost when it stops.
struct Spun {
    /// The relative change of the angular momentum.
    angular: f64,
    /// The momentum, over that of the rim.
    momentum: f64,
    /// The angular momentum over that at the start, against the time (s), some forty times.
    history: Vec<(f64, f64)>,
}

/// A disc that spins about its own centre, no loads, 10 × 10 cells, 2 s.
fn spinning(scheme: &Scheme, basis: &BasisCase, mass: &MassCase) -> Spun {
    let block = DISCS
        .replace("centre = [0.2, 0.2]\nradius = 0.2", "centre = [0.5, 0.5]\nradius = 0.3")
        .replace("\n[[body.ball]]\ncentre = [0.8, 0.8]\nradius = 0.2\n", "");
    let block = block.split("[[initial_velocity]]").next().unwrap();
    let fixed = ["grid.cells=[10,10]", "time.cfl=0.1", "time.end=2"];
    let scene = scene(block, &[scheme.sets, basis.sets, mass.sets, &fixed].concat());
    let (model, mut state) = at_start::<2>(&scene);
    let particle = &mut state.particle;
    // ω is small enough for small strain; the body turns by 0.4 rad.
    let omega = 0.2;
    for p in 0..particle.len() {
        let r = particle.x[p] - Vector2::new(0.5, 0.5);
        particle.v[p] = Vector2::new(-omega * r[1], omega * r[0]);
    }
    let before = measure::angular_momentum(&particle.carriers())[0];
    let scale = measure::kinetic_energy(&particle.carriers()) / omega;
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    let mut history = vec![(0.0, 1.0)];
    for step in 1..=model.steps {
        advance(&model, &mut state, step).unwrap();
        if step % (model.steps / 40) == 0 || step == model.steps {
            let now = measure::angular_momentum(&state.carriers(model.method))[0];
            history.push((step as f64 * model.dt, now / before));
        }
    }
    let after = state.carriers(model.method);
    Spun {
        angular: measure::angular_momentum(&after)[0] / before - 1.0,
        momentum: measure::momentum(&after).norm() / scale,
        history,
    }
}

/// A block that fills its grid, thrown about for ten steps, has no light nodes. Then
/// Newmark's method with the consistent mass matrix keeps the angular momentum of the
/// particles to 1e-12, with every basis that needs no room beyond the body, and with the
/// lumped one it does not: there Σ_p m_p x_p × Σ_I N_Ip a_I is not Σ_I x_I × f_I.
#[test]
fn conservation_of_angular_momentum_with_consistent_mass() {
    let block =
        DISCS.replace("\n[[body.ball]]", "\n#").replace("centre =", "#").replace("radius =", "#");
    let block = block.split("[[initial_velocity]]").next().unwrap();
    let close = "grid.beyond={ left = 0, right = 0, bottom = 0, top = 0 }";
    let fixed = ["grid.cells=[6,5]", "time.cfl=0.2", close];
    for basis in BASES.into_iter().filter(|basis| *basis != UGIMP) {
        for mass in MASSES {
            let scene = scene(block, &[basis.sets, mass.sets, &fixed].concat());
            let (model, mut state) = at_start::<2>(&scene);
            let particle = &mut state.particle;
            for p in 0..particle.len() {
                let (s, r) = (p as f64, particle.x[p]);
                let noise = Vector2::new((1.3 * s).sin(), (2.9 * s).cos());
                particle.v[p] = (Vector2::new(-r[1], r[0]) + noise) * 0.02;
            }
            let before = measure::angular_momentum(&particle.carriers())[0];
            march(&model, &mut state, 10);
            let after = measure::angular_momentum(&state.carriers(model.method))[0];
            let loss = (after / before - 1.0).abs();
            assert_eq!(loss < 1e-12, mass == CONSISTENT, "{}, {}: {loss:e}", basis.name, mass.name);
        }
    }
}

/// A spinning disc loses less than a fifth of its angular momentum, with Newmark's method
/// and the two lossy schemes, three bases and both masses. Its rim is full of nodes that
/// see it from afar. With the consistent mass matrix they are light, and their ties take
/// more of a rotation than the lumped matrix does.
#[test]
fn conservation_of_angular_momentum() {
    let mut table = String::from("basis,scheme,lumped,consistent\n");
    let mut histories = Vec::new();
    for basis in [LINEAR, BSPLINE, LME_WIDE] {
        for scheme in [NEWMARK, STRESS_LAST, GENERALIZED_ALPHA] {
            let name = format!("{},{}", basis.name, scheme.name);
            let [lumped, consistent] = MASSES.map(|mass| spinning(&scheme, &basis, &mass));
            for Spun { angular, momentum, .. } in [&lumped, &consistent] {
                assert!(*angular < 0.0 && *angular > -0.2, "{name}: {angular:e}");
                assert!(*momentum < 1e-10, "{name}: {momentum:e}");
            }
            if scheme == NEWMARK {
                for (mass, spun) in MASSES.iter().zip([&lumped, &consistent]) {
                    let name = format!("{}, {}", basis.name, mass.name);
                    histories.push((name, spun.history.clone()));
                }
            }
            let (lumped, consistent) = (lumped.angular, consistent.angular);
            assert!(consistent.abs() > lumped.abs(), "{name}");
            writeln!(table, "{name},{lumped:.1e},{consistent:.1e}").unwrap();
        }
    }
    approve("conservation__angular_momentum", &table);
    let title = "Angular momentum of a spinning disc";
    let axes = Axes::new(title, "time t [s]", "share that is left [–]", false);
    approve_picture("conservation__spin", figure::curves(&histories, &axes));
}

/// Two discs collide and part, with every basis: momentum and angular momentum stay 0 by
/// symmetry, to 1e-11 of one disc's; more than half of the kinetic energy turns into
/// strain energy, four fifths of it are there in the end, and the total stays within 15%,
/// the swing of a coarse grid. Each disc flies back the way it came.
#[test]
fn conservation_of_colliding_discs() {
    let mut table = String::from(
        "basis,least kinetic share,kinetic share at the end,energy drift,largest drift,momentum\n",
    );
    for basis in BASES {
        let name = basis.name;
        let history = finished(&scene(DISCS, basis.sets)).history;
        let (kinetic, total) = (column(&history, "kinetic_energy"), total_energy(&history));
        let shares = kinetic.iter().map(|energy| energy / total[0]);
        let least = shares.fold(f64::INFINITY, f64::min);
        let end = kinetic.last().unwrap() / total[0];
        let drift = total.last().unwrap() / total[0] - 1.0;
        let swing = largest(total.iter().map(|energy| energy / total[0] - 1.0));
        let of_one_disc = 1000.0 * 0.1257 * 0.1;
        let momenta = ["momentum_x", "momentum_y", "angular_momentum"];
        let momentum =
            largest(momenta.into_iter().flat_map(|name| column(&history, name))) / of_one_disc;
        assert!(momentum < 1e-11, "{name}: {momentum:e}");
        assert!(least < 0.5 && end > 0.8 && swing < 0.15, "{name}: {least} {end} {swing}");
        let back = *column(&history, "velocity_first").last().unwrap();
        assert!(back < 0.0, "{name}: {back}");
        let momentum = momentum.max(1e-16);
        writeln!(table, "{name},{least:.3},{end:.3},{drift:.4},{swing:.4},{momentum:.0e}").unwrap();
    }
    approve("discs__energy", &table);
}
