//! What ends a run, and what it is warned of: energy, rotation, angular momentum.

use crate::support::program::{assert_fails, directory, program, text};
use crate::support::*;
use lme_mpm::method::breakdown::{Breakdown, BrokenDown};
use lme_mpm::run::Warning;
use lme_mpm::scene::Scene;
use std::fmt::Write;

/// How a run that must not come to its end breaks down.
fn broken(scene: &Scene) -> BrokenDown {
    match outcome(scene) {
        Ok(outcome) => panic!("it ran, with a growth of {:e}", outcome.growth),
        Err(stopped) => stopped.broken,
    }
}

/// The default of `check.energy` stands between what the schemes honestly do and what is lost.
/// The bar thrown, swinging, under gravity and under a sudden traction, with three bases, both
/// mass matrices and all schemes: the energy grows by less than a fifth where the run comes to
/// its end, most with the consistent matrix near its limit, where an Euler form has velocity and
/// stress half a step apart at a front.
#[test]
fn guards_default_of_energy() {
    let scenes = [
        ("thrown", lme_mpm::scene::DYKA),
        ("swinging", VIBRATION),
        ("gravity", GRAVITY),
        ("traction", TRACTION),
    ];
    let names = scenes.map(|(name, _)| name).join(",");
    let mut table = format!("scheme,mass,{names}\n");
    for scheme in SCHEMES {
        for mass in MASSES {
            let growths = scenes.map(|(name, text)| {
                let of = |basis: BasisCase| {
                    let sets = [&["check.energy=1e300"], basis.sets, mass.sets, scheme.sets];
                    match outcome(&scene(text, &sets.concat())) {
                        Ok(outcome) => outcome.growth,
                        Err(stopped) => {
                            let why = stopped.broken.breakdown;
                            let of_step = matches!(
                                why,
                                Breakdown::BeyondLimit { .. } | Breakdown::Gained { .. }
                            );
                            assert!(of_step, "{name}, {}: {why}", scheme.name);
                            0.0
                        }
                    }
                };
                largest([LINEAR, BSPLINE, LME_WIDE].map(of))
            });
            assert!(growths.iter().all(|growth| *growth < 0.2), "{}: {growths:?}", scheme.name);
            let shown = growths.map(|growth| format!("{growth:.3}")).join(",");
            writeln!(table, "{},{},{shown}", scheme.name, mass.name).unwrap();
        }
    }
    approve("guards__default_of_energy", &table);
}

/// A bar thrown at a sixth of its wave speed, with room for it, at 29% of the predicted limit,
/// ended with 7.66 times its energy and said nothing. It ends by name.
#[test]
fn guards_energy_ends_a_run_by_name() {
    let thrown = dyka(&["grid.beyond.right=60", "initial_velocity.0.velocity=800"]);
    let broken = broken(&thrown);
    let Breakdown::Diverged { share, bound, .. } = broken.breakdown else {
        panic!("{broken}");
    };
    assert!(share > bound && share < 1.0 && bound == 0.25, "{share} {bound}");
    assert!(broken.to_string().contains("check.energy"), "{broken}");
}

/// An energy that underflows at the start is judged once it does not: with v = 1e-200 m/s and a
/// Courant number of 5 it grew by 87 orders of magnitude.
#[test]
fn guards_energy_that_starts_at_nothing_is_judged() {
    let slow = ["initial_velocity.0.velocity=1e-200", "time.cfl=5", "time.allow_unstable=true"];
    let broken = broken(&dyka(&slow));
    assert!(matches!(broken.breakdown, Breakdown::Diverged { .. }), "{broken}");
    // With a step that holds it grows by what the bar does at any speed.
    let faint = finished(&dyka(&["initial_velocity.0.velocity=1e-200"])).growth;
    let plain = finished(&dyka(&["initial_velocity.0.velocity=1e-3"])).growth;
    assert!((faint / plain - 1.0).abs() < 1e-3, "{faint:e} {plain:e}");
}

/// A run ends at the same step whatever it records.
#[test]
fn guards_do_not_depend_on_what_is_recorded() {
    let at = |every: &str| {
        let sets = ["grid.beyond.right=60", "initial_velocity.0.velocity=800", every];
        broken(&dyka(&sets))
    };
    assert_eq!(at("output.every=1"), at("output.every=100000"));
    let grown = |every: &str| finished(&scene(TRACTION, &[every])).growth;
    assert_eq!(grown("output.every=1"), grown("output.every=7"));
}

/// Loads of any size are carried: from a thousandth of gravity down to 1e-30 m/s² the bar
/// hangs by the same error relative to its load, to 1e-6. A body whose steps are smaller than
/// the last digit of its places hangs, too.
#[test]
fn guards_small_loads_are_carried() {
    let error = |b: f64| {
        let load = format!("body_force.acceleration={b:e}");
        let scene = scene(GRAVITY, &[&load]);
        value(&scene, &finished(&scene), "displacement_field_rms_relative")
    };
    let plain = error(9.81e-3);
    for b in [9.81e-9, 1e-10, 1e-30] {
        let small = error(b);
        assert!((small / plain - 1.0).abs() < 1e-6, "{b:e}: {small:e}, {plain:e}");
    }
    let short = ["grid.cells=10", "time.cfl=1e-6", "time.end=2.53e-7", "output.every=100000"];
    let short = scene(GRAVITY, &short);
    let off = value(&short, &finished(&short), "displacement_field_rms_relative");
    assert!(off < 1e-6, "{off:e}");
}

/// A block whose halves are thrown past each other, so that it turns: free, for so long that it
/// turns by about so many radians.
fn turning(angle: f64, sets: &[&str]) -> Scene {
    let end = format!("time.end={}", angle / 0.75);
    let thrown = "initial_velocity=[{ from = [0, 0], to = [0.5, 1], velocity = [0, -0.5] }, \
                  { from = [0.5, 0], to = [1, 1], velocity = [0, 0.5] }]";
    block(2, &[&[thrown, &end, "grid.particles_per_cell=[2,2]"], sets].concat())
}

/// The rate law does not turn stresses: material that has turned by a tenth of a radian is warned
/// of, by half a radian ends the run, and by more runs where `check.rotation` says so. A
/// hyperelastic law turns as far as it likes.
#[test]
fn guards_rotation() {
    let warned = finished(&turning(0.3, &[])).warnings;
    let [Warning::Turned(seen)] = warned[..] else { panic!("{warned:?}") };
    assert!(seen.value > 0.1 && seen.value < 0.5 && seen.moment.step > 0, "{seen:?}");
    let broken = broken(&turning(1.0, &[]));
    assert!(matches!(broken.breakdown, Breakdown::Turned { bound: 0.5, .. }), "{broken}");
    finished(&turning(1.0, &["check.rotation=10"]));
    for law in ["body.law=neo-hookean", "body.law=hencky"] {
        assert_eq!(finished(&turning(1.0, &[law])).warnings, []);
    }
}

/// A free body keeps its angular momentum with OTM. MPM with the linear basis and the lumped
/// matrix loses of it, and is warned of; a body that is held is not.
#[test]
fn guards_angular_momentum() {
    let mpm = ["method=mpm", "basis.kind=linear", "basis.gamma=", "body.law=neo-hookean"];
    let room = "grid.beyond={ left = 3, right = 3, bottom = 3, top = 3 }";
    let lost = |warnings: &[Warning]| {
        warnings.iter().any(|warning| matches!(warning, Warning::AngularMomentum(_)))
    };
    assert!(lost(&finished(&turning(0.6, &[&mpm[..], &[room]].concat())).warnings));
    assert!(!lost(&finished(&turning(0.6, &["body.law=neo-hookean"])).warnings));
    let held = [&mpm[..], &[room, "boundary.left.x=fixed"]].concat();
    assert!(!lost(&finished(&turning(0.6, &held)).warnings));
}

/// A warning stands on stderr and in the summary, with particle, step and time; with `--strict`
/// the results are written, and the exit code is 1.
#[test]
fn guards_warnings_are_told() {
    let dir = directory("guards_warnings");
    let scene = "discs.toml";
    std::fs::write(dir.join(scene), DISCS).unwrap();
    let sets = ["run", scene, "--quiet", "--out", "out", "--set", "body.poisson_ratio=0.4999"];
    let warned = program(&dir, &sets);
    assert!(warned.status.success(), "{}", text(&warned.stderr));
    let summary = std::fs::read_to_string(dir.join("out/summary.csv")).unwrap();
    assert!(text(&warned.stderr).contains("warning: "), "{}", text(&warned.stderr));
    for name in ["warning_locking", "energy_growth_largest"] {
        assert!(summary.contains(&format!("\n{name},")), "{summary}");
    }
    let strict = program(&dir, &[&sets[..], &["--strict"]].concat());
    assert_fails(&strict, 1, &["Poisson's ratio"]);
    assert!(dir.join("out/summary.csv").exists());
}
