//! What must stay as it is: mass, momentum, angular momentum, and energy with the
//! work of the loads.

use crate::support::*;
use lme_mpm::method::measure;
use lme_mpm::run::Outcome;
use lme_mpm::scene::Scene;
use std::fmt::Write;

/// Momentum of a free body to n·ε with every scheme, basis and mass matrix, and
/// the mass of each particle to its last digit.
#[test]
fn conservation_of_mass_and_momentum() {
    for (scheme, sets) in SCHEMES {
        for (basis, more) in BASES {
            for mass in [&["mass=lumped"][..], &["mass=consistent", "time.cfl=0.35"]] {
                let free = ["boundary.left=free", "grid.beyond.left=2", "grid.beyond.right=2"];
                let scene = dyka(&[sets, more, mass, &free].concat());
                let outcome = finished(&scene);
                let momentum = outcome.history.column("momentum").unwrap();
                let n = 64.0 * outcome.cost.steps as f64;
                for p in &momentum {
                    let drift = (p / momentum[0] - 1.0).abs();
                    assert!(drift < n * f64::EPSILON, "{scheme}, {basis}, {mass:?}: {drift:e}");
                }
                let masses = outcome.particles.column("mass").unwrap();
                let share = 7833.0 * (0.1333 / 80.0);
                assert!(masses.iter().all(|m| (m / share - 1.0).abs() < 1e-15));
            }
        }
    }
}

/// Steps of the long runs.
const STEPS: f64 = 1e5;

/// Mean of the total energy, less the work of the loads, over the first and the
/// last tenth, relative to its largest value: (drift, largest deviation from the
/// first mean).
fn balance(outcome: &Outcome) -> (f64, f64) {
    let column = |name: &str| outcome.history.column(name);
    let (kinetic, strain) = (column("kinetic_energy").unwrap(), column("strain_energy").unwrap());
    let work = column("work").unwrap_or_else(|| vec![0.0; kinetic.len()]);
    let total: Vec<f64> = kinetic.iter().zip(&strain).map(|(a, b)| a + b).collect();
    let largest = total.iter().fold(0.0, |a: f64, b| a.max(*b));
    let own: Vec<f64> = total.iter().zip(&work).map(|(a, b)| (a - b) / largest).collect();
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    let tenth = own.len() / 10;
    let (first, last) = (mean(&own[..tenth]), mean(&own[own.len() - tenth..]));
    (last - first, own.iter().map(|e| (e - first).abs()).fold(0.0, f64::max))
}

/// A small bar for `STEPS` steps; recorded every 7, which is no part of a period.
fn long(text: &str, transit: f64, sets: &[&str]) -> Scene {
    let end = format!("time.end={:?}", STEPS * 0.5 * transit / 8.0);
    let fixed = ["grid.cells=8", "output.every=7", end.as_str()];
    scene(text, &[sets, &fixed].concat())
}

/// Energy over 100 000 steps, in free vibration and under sudden gravity with the
/// work counted, of one basis with some schemes; a table.
///
/// Newmark's method keeps it to 1e-4, the other leapfrogs to 1e-3; stress-last
/// and generalized-α lose it.
fn energy(basis: &str, more: &[&str], schemes: &[&str]) -> String {
    let mut table = String::new();
    for (scheme, sets) in SCHEMES.iter().filter(|(name, _)| schemes.contains(name)) {
        let all = [*sets, more].concat();
        let free = finished(&long(VIBRATION, 1.0, &all));
        assert_eq!(free.cost.steps as f64, STEPS);
        let gravity = finished(&long(GRAVITY, GRAVITY_TRANSIT, &[&all[..], &[WEAK]].concat()));
        let (drift, swing) = balance(&free);
        let (drift_loaded, swing_loaded) = balance(&gravity);
        writeln!(
            table,
            "{basis},{scheme},{drift:.1e},{swing:.1e},{drift_loaded:.1e},{swing_loaded:.1e}"
        )
        .unwrap();
        let name = format!("{basis}, {scheme}: {drift:e}, {drift_loaded:e}");
        if scheme.contains("(last)") || scheme.contains("generalized") {
            assert!(drift < -0.1 && drift_loaded < 0.0, "{name}");
        } else {
            let bound = if *scheme == "newmark" { 1e-4 } else { 1e-3 };
            assert!(drift.abs() < bound && drift_loaded.abs() < bound, "{name}");
        }
    }
    table
}

/// L/c of the bar of gravity.toml (s).
const GRAVITY_TRANSIT: f64 = 6.324555320336759e-3;
/// A hundredth of its gravity: particles move by less than 1e-5 of a cell.
const WEAK: &str = "body_force.acceleration=0.0981";

const ENERGY_COLUMNS: &str = "basis,scheme,free: drift,free: swing,gravity: drift,gravity: swing\n";

#[test]
fn conservation_of_energy_linear() {
    let all: Vec<&str> = SCHEMES.iter().map(|(name, _)| *name).collect();
    let table = energy(BASES[0].0, BASES[0].1, &all);
    approve("conservation__energy_linear", &format!("{ENERGY_COLUMNS}{table}"));
}

#[test]
fn conservation_of_energy_local_max_ent() {
    let some = ["newmark", "euler (last)", "generalized-α (0.8)"];
    let table = energy(BASES[3].0, BASES[3].1, &some);
    approve("conservation__energy_lme", &format!("{ENERGY_COLUMNS}{table}"));
}

/// The drift under gravity is proportional to the displacement: it comes from
/// particles that move through the grid, not from the steps in time.
#[test]
fn conservation_of_energy_needs_still_particles() {
    let drift = |sets: &[&str]| balance(&finished(&long(GRAVITY, GRAVITY_TRANSIT, sets))).0;
    let ratio = drift(&[]) / drift(&[WEAK]);
    assert!((50.0..200.0).contains(&ratio), "{ratio}");
}

/// A disc that spins about its own centre, no loads.
fn spinning(sets: &[&str]) -> (f64, f64) {
    let block = DISCS
        .replace("centre = [0.2, 0.2]\nradius = 0.2", "centre = [0.5, 0.5]\nradius = 0.3")
        .replace("\n[[body.ball]]\ncentre = [0.8, 0.8]\nradius = 0.2\n", "")
        .split("[[initial_velocity]]")
        .next()
        .unwrap()
        .to_string();
    let scene =
        scene(&block, &[sets, &["grid.cells=[10,10]", "time.cfl=0.1", "time.end=2"]].concat());
    let model = lme_mpm::setup::model::<2>(&scene);
    let mut state = lme_mpm::setup::initial_state(&model, &scene);
    let particle = &mut state.particle;
    // ω is small enough for small strain; the body turns by 0.4 rad.
    let omega = 0.2;
    for p in 0..particle.len() {
        let r = particle.x[p] - nalgebra::Vector2::new(0.5, 0.5);
        particle.v[p] = nalgebra::Vector2::new(-omega * r[1], omega * r[0]);
    }
    let before = measure::angular_momentum(&particle.carriers())[0];
    let momentum_scale = measure::kinetic_energy(&particle.carriers()) / omega;
    march(&model, &mut state, model.steps);
    let after = measure::angular_momentum(&state.carriers(model.method))[0];
    let momentum = measure::momentum(&state.carriers(model.method));
    (after / before - 1.0, momentum.norm() / momentum_scale)
}

/// A block that fills its grid, thrown about, has no light nodes. Then Newmark's
/// method with the consistent mass matrix keeps the angular momentum of the
/// particles to round-off, whatever the basis, and with the lumped one it does
/// not: there Σ_p m_p x_p × Σ_I N_Ip a_I is not Σ_I x_I × f_I.
#[test]
fn conservation_of_angular_momentum_with_consistent_mass() {
    let block =
        DISCS.replace("\n[[body.ball]]", "\n#").replace("centre =", "#").replace("radius =", "#");
    let block = block.split("[[initial_velocity]]").next().unwrap();
    let close = "grid.beyond={ left = 0, right = 0, bottom = 0, top = 0 }";
    for (basis, more) in BASES.iter().filter(|(basis, _)| *basis != "ugimp") {
        for mass in ["consistent", "lumped"] {
            let mass_set = format!("mass={mass}");
            let sets = [mass_set.as_str(), "grid.cells=[6,5]", "time.cfl=0.2", close];
            let scene = scene(block, &[more, &sets[..]].concat());
            let model = lme_mpm::setup::model::<2>(&scene);
            let mut state = lme_mpm::setup::initial_state(&model, &scene);
            let particle = &mut state.particle;
            for p in 0..particle.len() {
                let (s, r) = (p as f64, particle.x[p]);
                let noise = nalgebra::Vector2::new((1.3 * s).sin(), (2.9 * s).cos());
                particle.v[p] = (nalgebra::Vector2::new(-r[1], r[0]) + noise) * 0.02;
            }
            let before = measure::angular_momentum(&particle.carriers())[0];
            march(&model, &mut state, 10);
            let after = measure::angular_momentum(&state.carriers(model.method))[0];
            let loss = (after / before - 1.0).abs();
            let kept = loss < 1e-12;
            assert_eq!(kept, mass == "consistent", "{basis}, {mass}: {loss:e}");
        }
    }
}

/// Angular momentum of a spinning disc, by scheme and mass. Its rim is full of
/// nodes that see it from afar. With the consistent mass matrix they are light
/// and lumped: the linear basis still loses less with it, the wide ones lose more.
#[test]
fn conservation_of_angular_momentum() {
    let mut table = String::from("basis,scheme,lumped,consistent\n");
    for (basis, more) in [BASES[0], BASES[2], BASES[3]] {
        for (scheme, sets) in [SCHEMES[0], SCHEMES[3], SCHEMES[6]] {
            let lumped = spinning(&[sets, more].concat());
            let consistent = spinning(&[sets, more, &["mass=consistent"]].concat());
            for (loss, momentum) in [lumped, consistent] {
                assert!(loss < 0.0 && loss > -0.2, "{basis}, {scheme}: {loss:e}");
                assert!(momentum < 1e-10, "{basis}, {scheme}: {momentum:e}");
            }
            let better = consistent.0.abs() < lumped.0.abs();
            assert_eq!(better, basis == "linear", "{basis}, {scheme}");
            writeln!(table, "{basis},{scheme},{:.1e},{:.1e}", lumped.0, consistent.0).unwrap();
        }
    }
    approve("conservation__angular_momentum", &table);
}

/// Two discs collide and part: momentum and angular momentum stay 0 by symmetry,
/// kinetic energy turns into strain energy and back, and the total stays within
/// the swing of a coarse grid.
#[test]
fn conservation_of_colliding_discs() {
    let mut table = String::from(
        "basis,least kinetic share,kinetic share at the end,energy drift,largest drift,momentum\n",
    );
    for (basis, sets) in BASES {
        let scene = scene(DISCS, sets);
        let outcome = finished(&scene);
        let column = |name: &str| outcome.history.column(name).unwrap();
        let (kinetic, strain) = (column("kinetic_energy"), column("strain_energy"));
        let total: Vec<f64> = kinetic.iter().zip(&strain).map(|(a, b)| a + b).collect();
        let least = kinetic.iter().fold(f64::INFINITY, |a: f64, b| a.min(*b)) / total[0];
        let end = kinetic.last().unwrap() / total[0];
        let drift = total.last().unwrap() / total[0] - 1.0;
        let largest = total.iter().map(|e| (e / total[0] - 1.0).abs()).fold(0.0, f64::max);
        // Momentum of one disc.
        let scale = 1000.0 * 0.1257 * 0.1;
        let momentum = ["momentum_x", "momentum_y", "angular_momentum"]
            .into_iter()
            .flat_map(column)
            .fold(0.0, |a: f64, p| a.max(p.abs()))
            / scale;
        assert!(momentum < 1e-11, "{basis}: {momentum:e}");
        assert!(least < 0.5 && end > 0.8 && largest < 0.15, "{basis}: {least} {end} {largest}");
        // They part: each flies back the way it came.
        let back = *column("velocity_first").last().unwrap();
        assert!(back < 0.0, "{basis}: {back} {least} {end} {largest}");
        writeln!(
            table,
            "{basis},{least:.3},{end:.3},{drift:.4},{largest:.4},{:.0e}",
            momentum.max(1e-16)
        )
        .unwrap();
    }
    approve("discs__energy", &table);
}
