//! The watch on the limit of Δt while particles move: it changes nothing, costs little, and
//! stops by name what would blow up.

use crate::support::*;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::time::generalized_alpha::Parameters;
use lme_mpm::method::time::scheme::TripFactor;
use lme_mpm::run::Stopped;
use lme_mpm::run::table::Table;
use lme_mpm::scene::{DYKA, Scene};
use std::fmt::Write;

const SHIPPED: [&str; 8] =
    [DYKA, DYKA_OTM, VIBRATION, GRAVITY, TRACTION, FREE_FLIGHT, MANUFACTURED, DISCS];

/// A run has the same bits with and without the watch: every shipped scene, every cost but
/// the watch's own. Still scenes pay nothing; the others are the approved table.
#[test]
fn watch_changes_no_bit() {
    let mut table = String::from("scene,particles,steps,limit applications\n");
    for text in SHIPPED {
        let watched = finished(&scene(text, &[]));
        let alone = finished(&scene(text, &["time.watch=0"]));
        assert_eq!(watched.history, alone.history);
        assert_eq!(watched.particles, alone.particles);
        assert_eq!(alone.cost.limit_applications, 0);
        let moves = [FREE_FLIGHT, MANUFACTURED, DISCS].contains(&text);
        assert_eq!(watched.cost.limit_applications > 0, moves, "{}", scene(text, &[]).title);
        let mut cost = watched.cost;
        cost.limit_applications = 0;
        assert_eq!(cost, alone.cost);
        let (title, particles) = (scene(text, &[]).title, watched.particles.rows().len());
        let (steps, applications) = (cost.steps, watched.cost.limit_applications);
        writeln!(table, "{title},{particles},{steps},{applications}").unwrap();
    }
    approve("watch__cost", &table);
}

/// The largest growth of the energy in a history, of what the start and loads gave: E less
/// that of the start and the work, over that of the start and the work to and fro.
fn growth(history: &Table) -> f64 {
    let energy = total_energy(history);
    let work = history.column("work").unwrap_or_else(|| vec![0.0; energy.len()]);
    let mut given = energy[0];
    let mut growth = f64::NEG_INFINITY;
    for k in 0..energy.len() {
        given += if k > 0 { (work[k] - work[k - 1]).abs() } else { 0.0 };
        growth = growth.max((energy[k] - energy[0] - work[k]) / given);
    }
    growth
}

/// How a run ended, in a word.
fn word(stopped: &Stopped) -> &'static str {
    match stopped.broken.breakdown {
        Breakdown::BeyondLimit { .. } => "beyond the limit",
        Breakdown::Gained { .. } => "gained energy",
        _ => "broke down",
    }
}

/// Runs that went wrong with exit code 0 or by a breakdown far from its cause: what moves at
/// a part of the limit that holds at its start only. Each of them now runs right, with less
/// than 1% of energy made and errors like those of a small step, or stops by name before its
/// energy has grown by 1%.
#[test]
fn watch_stops_in_time() {
    let mut table =
        String::from("case,c dt/h,end,steps,cells moved,growth of energy,applications per step\n");
    let mut add = |name: &str, scene: &Scene, speed: f64| {
        let result = outcome(scene);
        let (end, history) = match &result {
            Ok(outcome) => ("ran", &outcome.history),
            Err(stopped) => (word(stopped), &stopped.history),
        };
        let made = growth(history);
        assert!(made < 0.01 && end != "broke down", "{name}: {end}, {made:e}");
        let steps = history.rows().len() - 1;
        let h = scene.body.length[0] / scene.grid.cells[0] as f64;
        let cells = speed * steps as f64 * scene.time.end / scene.sizes().2 / h;
        let cells = if speed > 0.0 { format!("{cells:.2}") } else { String::new() };
        let cost = result.as_ref().map_or(String::new(), |outcome| {
            format!("{:.2}", outcome.cost.limit_applications as f64 / steps as f64)
        });
        let courant = scene.courant_number();
        writeln!(table, "{name},{courant:.3},{end},{steps},{cells},{made:.1e},{cost}").unwrap();
        result.is_ok()
    };
    let slow = ["initial_velocity.0.velocity=0.3", "time.end=3"];
    let flight = |sets: &[&str]| scene(FREE_FLIGHT, &[&slow, sets].concat());
    let one = "grid.particles_per_cell=1";
    for cfl in ["time.cfl=1.6", "time.cfl=1.2"] {
        assert!(!add("flight; 1 per cell", &flight(&[one, cfl]), 0.3));
    }
    assert!(add("flight; 1 per cell", &flight(&[one, "time.cfl=0.999"]), 0.3));
    assert!(!add("flight; 2 per cell", &flight(&["time.cfl=1.56"]), 0.3));
    assert!(add("flight; 2 per cell", &flight(&["time.cfl=1.38"]), 0.3));
    for scheme in [STRESS_LAST, GENERALIZED_ALPHA] {
        for cfl in ["time.cfl=0.5", "time.cfl=0.2", "time.cfl=0.1"] {
            let name = format!("flight; {}", scheme.name);
            add(&name, &flight(&[scheme.sets, &[cfl]].concat()), 0.3);
        }
    }
    for cfl in ["time.cfl=0.5", "time.cfl=0.2"] {
        let sets = ["time.kinematics=consistent", cfl];
        add("flight; newmark; consistent kinematics", &flight(&sets), 0.3);
    }
    let discs = [BSPLINE.sets, CONSISTENT.sets, &["time.end=1.5"]].concat();
    for cfl in ["time.cfl=0.4538", "time.cfl=0.3241", "time.cfl=0.2303"] {
        let scene = scene(DISCS, &[&discs[..], &[cfl]].concat());
        add("discs; B-splines; consistent", &scene, 0.1 * 2.0_f64.sqrt());
    }
    let linear = MANUFACTURED.replace("kind = \"lme\"\ngamma = 0.8", "kind = \"linear\"");
    let large = ["time.fraction_of_critical=0.7", "time.cfl=10", "time.end=0.1"];
    for basis in [LINEAR, UGIMP, BSPLINE, LME_WIDE] {
        for mass in MASSES {
            let name = format!("manufactured; {}; {}", basis.name, mass.name);
            add(&name, &scene(&linear, &[basis.sets, mass.sets, &large].concat()), 0.0);
        }
    }
    approve("watch__cases", &table);
}

/// Without the watch the same flights end in an energy that has grown by more than a tenth, or
/// a breakdown: it is the watch that stops them.
#[test]
fn watch_is_what_stops_them() {
    let slow = ["initial_velocity.0.velocity=0.3", "time.end=3", "time.watch=0"];
    let one = "grid.particles_per_cell=1";
    for sets in [[one, "time.cfl=1.6"], [one, "time.cfl=1.2"], ["mass=lumped", "time.cfl=1.56"]] {
        let flight = scene(FREE_FLIGHT, &[&slow[..], &sets].concat());
        let history = match outcome(&flight) {
            Ok(outcome) => outcome.history,
            Err(stopped) => {
                assert_eq!(word(&stopped), "broke down");
                stopped.history
            }
        };
        assert!(growth(&history) > 0.1, "{sets:?}");
    }
}

/// At 0.99 of the limit over all offsets nothing grows in a flight of nine cells: less than
/// 1e-9 of energy is made and the velocity is right to 1e-4, every basis, 1, 2 and 4 particles
/// per cell, lumped mass.
#[test]
fn watch_lets_fly_below_the_limit_over_offsets() {
    for basis in BASES {
        for per_cell in [1, 2, 4] {
            let count = format!("grid.particles_per_cell={per_cell}");
            let sets = ["initial_velocity.0.velocity=0.3", "time.end=3", "time.cfl=9", &count];
            let part = ["time.fraction_of_critical=0.99", "grid.beyond.left=2"];
            let flight = scene(FREE_FLIGHT, &[basis.sets, &sets, &part].concat());
            let result = finished(&flight);
            let name = format!("{}, {per_cell}", basis.name);
            assert!(growth(&result.history) < 1e-9, "{name}: {:e}", growth(&result.history));
            let error = value(&flight, &result, "velocity_field_rms_relative");
            assert!(error < 1e-4, "{name}: {error:e}");
        }
    }
}

/// A run that stops names particle, step, time, the limit at the start and now, and the part
/// of the predicted limit that would have held: with that part it ends well.
#[test]
fn watch_says_what_would_have_held() {
    let slow = ["initial_velocity.0.velocity=0.3", "time.end=3", "grid.particles_per_cell=1"];
    let stopped =
        outcome(&scene(FREE_FLIGHT, &[&slow[..], &["time.cfl=1.6"]].concat())).unwrap_err();
    let Breakdown::BeyondLimit { particle, dt, start, now, fraction } = stopped.broken.breakdown
    else {
        panic!("{stopped}");
    };
    assert!(particle < 10 && now < dt && dt < start && stopped.broken.moment.step > 10);
    let words = ["at step ", "beyond its limit", "at the start", "time.fraction_of_critical"];
    assert!(words.iter().all(|word| stopped.to_string().contains(word)), "{stopped}");
    assert!(fraction > 0.9 && fraction <= 1.0, "{fraction}");
    let part = format!("time.fraction_of_critical={}", 0.99 * fraction);
    finished(&scene(FREE_FLIGHT, &[&slow[..], &["time.cfl=9", &part]].concat()));
}

/// Beyond its limit no scheme multiplies a mode by more than a leapfrog does, e^μ with
/// cosh(μ/2) = Δt/limit: the recurrences of stress-last and generalized-α for a mode with the
/// eigenvalues s of A and κ of B, ρ_b from 0 to 0.999, 21 values of s, Δt up to fifty
/// times the limit; and with Δt at 0.999 of it nothing grows.
#[test]
fn watch_rate_is_an_upper_one() {
    let rate = |factor: TripFactor, s: f64, part: f64| {
        // Δt = 1: q is the acceleration by the stress, w the nodal velocity, a that of k.
        let kappa = 4.0 * part * part / factor.at(s);
        let (mut x, mut growth) = ([0.3, 0.7, 0.2], 0.0);
        for k in 0..2000 {
            let [w, q, a] = x;
            x = match factor {
                TripFactor::Alpha { rho_b } => {
                    let Parameters { alpha_m, beta, gamma } = Parameters::new(rho_b);
                    let next = (q - alpha_m * a) / (1.0 - alpha_m);
                    let d = w + (0.5 - beta) * a + beta * next;
                    [w + s * ((1.0 - gamma) * a + gamma * next), q - kappa * d, s * next]
                }
                _ => [w + s * q, q - kappa * (w + q), 0.0],
            };
            let size = largest(x);
            x = x.map(|x| x / size);
            growth += if k < 1000 { 0.0 } else { size.ln() / 1000.0 };
        }
        growth
    };
    let alphas = [0.0, 0.2, 0.5, 0.8, 0.95, 0.999];
    let alphas = alphas.map(|rho_b| TripFactor::Alpha { rho_b });
    for factor in [&[TripFactor::Last], &alphas[..]].concat() {
        for s in (0..=20).map(|n| f64::from(n) / 20.0) {
            for part in [1.01, 1.1, 1.5, 2.0, 5.0, 50.0] {
                let (found, upper) = (rate(factor, s, part), 2.0 * f64::acosh(part));
                assert!(found > 0.0 && found < upper + 2e-3, "{factor:?}, {s}, {part}: {found}");
            }
            let below = rate(factor, s, 0.999);
            assert!(below < 2e-2, "{factor:?}, {s}: {below}");
        }
    }
}

/// The shipped discs end with about 1% more energy than they began with, by their basis and
/// small step, and are left alone.
#[test]
fn watch_leaves_alone() {
    let made = growth(&finished(&scene(DISCS, &[])).history);
    assert!((0.008..0.013).contains(&made), "{made}");
}

/// Of the discs with generalized-α one run is stopped that would have come through without
/// more energy than at the start; and the manufactured motion with a large step, far below
/// its limit, ends without more energy and with a velocity that is off by 40%.
#[test]
fn watch_stops_too_much_and_too_little() {
    let discs = [GENERALIZED_ALPHA.sets, &["time.cfl=0.1"]].concat();
    let stopped = outcome(&scene(DISCS, &discs)).unwrap_err();
    assert_eq!(word(&stopped), "beyond the limit");
    let alone = finished(&scene(DISCS, &[&discs[..], &["time.watch=0"]].concat()));
    assert!(growth(&alone.history) < 1e-6);
    let swing = scene(MANUFACTURED, &["time.cfl=1.2", "time.end=0.1"]);
    let result = finished(&swing);
    assert!(growth(&result.history) < 1e-3);
    let error = value(&swing, &result, "velocity_field_rms_relative");
    assert!((0.35..0.5).contains(&error), "{error}");
}
