//! Loads: the exact solutions that go with them against references of 60
//! digits, runs against the exact solutions, and nothing computed undeclared.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::exact::forced::{Forced, Load};
use lme_mpm::method::exact::manufactured::Manufactured;
use lme_mpm::method::exact::mode::{Mode, Vibration};
use lme_mpm::method::exact::riemann::{Bar, End, Patch};
use lme_mpm::method::exact::{Exact, Fields};
use lme_mpm::method::measure::rms;
use lme_mpm::method::time::generalized_alpha::Parameters;
use lme_mpm::scene::Scene;

/// The rows of a reference file, by column name.
struct Row(csv::StringRecord, csv::StringRecord);

impl Row {
    fn text(&self, name: &str) -> &str {
        let at = self.0.iter().position(|column| column == name).unwrap();
        &self.1[at]
    }
    fn number(&self, name: &str) -> f64 {
        self.text(name).parse().unwrap()
    }
    fn ends(&self) -> [End; 2] {
        ["left", "right"].map(|side| match self.text(side) {
            "fixed" => End::Fixed,
            _ => End::Free,
        })
    }
}

fn rows(text: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    reader.records().map(|row| Row(header.clone(), row.unwrap())).collect()
}

/// Bars under gravity and tractions, at once and growing, with all pairs of
/// ends, up to 40 L/c, against static solution and images at 60 digits
/// (data/reference/loads.py).
#[test]
fn forced_against_images_at_60_digits() {
    let rows = rows(include_str!("../data/reference/loads.csv"));
    for row in &rows {
        let (length, density, modulus) =
            (row.number("length"), row.number("density"), row.number("modulus"));
        let ends = row.ends();
        let velocity = row.number("patch_velocity");
        let patch = Patch { from: row.number("patch_from"), to: row.number("patch_to"), velocity };
        let patches = if velocity == 0.0 { vec![] } else { vec![patch] };
        let thrown = Bar { length, density, modulus, ends, patches };
        let (c, Z) = (thrown.c(), thrown.Z());
        let ramp = row.number("traction_ramp");
        let body = Load { value: row.number("body_force"), ramp: row.number("body_ramp") };
        let traction =
            ["traction_left", "traction_right"].map(|name| Load { value: row.number(name), ramp });
        let forced = Forced { length, c, Z, ends, body, traction };
        let (x, t) = (row.number("x"), row.number("t"));
        let Fields { velocity: v, stress, displacement } = thrown.at(x, t) + forced.at(x, t);

        let pull = traction[0].value.abs() + traction[1].value.abs();
        let transits = 1.0 + t * c / length;
        let scale = velocity.abs() + (body.value.abs() * length / c + pull / Z) * transits;
        for (name, value, unit) in [
            ("velocity", v, scale),
            ("stress", stress, Z * scale),
            ("displacement", displacement, scale * length / c * transits),
        ] {
            let off = (value - row.number(name)).abs() / unit;
            assert!(off < 2e-14, "{}, x = {x}, t = {t}: {name} off by {off:e}", row.text("case"));
        }
    }
    assert!(rows.len() > 300);
}

/// u = A φ sin ωt with its stress and body force against differentiation at 60
/// digits (data/reference/manufactured.py).
#[test]
fn manufactured_against_60_digits() {
    let rows = rows(include_str!("../data/reference/manufactured.csv"));
    for row in &rows {
        let (length, modulus) = (row.number("length"), row.number("modulus"));
        let c = (modulus / row.number("density")).sqrt();
        let mode = Mode::new(row.ends(), row.number("mode") as usize, length);
        let amplitude = row.number("amplitude");
        let solution = Manufactured { mode, amplitude, c, modulus };
        let (x, t) = (row.number("x"), row.number("t"));
        let fields = solution.at(x, t);
        let omega = c * mode.k;
        for (name, value, unit) in [
            ("velocity", fields.velocity, amplitude * omega),
            ("stress", fields.stress, modulus),
            ("displacement", fields.displacement, amplitude),
            ("body_force", solution.body_force(x, t), amplitude * omega * omega),
        ] {
            let off = (value - row.number(name)).abs() / unit;
            assert!(off < 1e-13, "x = {x}, t = {t}: {name} off by {off:e}");
        }
    }
    assert!(rows.len() > 30);
}

/// A mode meets its ends, the wave equation and, with A k → 0, the manufactured
/// solution, into which it grows.
#[test]
fn vibration_is_a_natural_mode() {
    let (c, modulus, length) = (2.0, 8.0, 1.5);
    for ends in [[End::Fixed; 2], [End::Free; 2], [End::Fixed, End::Free], [End::Free, End::Fixed]]
    {
        for number in [1, 2, 5] {
            let mode = Mode::new(ends, number, length);
            let vibration = Vibration { mode, velocity: 0.3, c, modulus };
            for (end, x) in ends.iter().zip([0.0, length]) {
                let fields = vibration.at(x, 0.7);
                match end {
                    End::Fixed => assert!(fields.velocity.abs() < 1e-14),
                    End::Free => assert!(fields.stress.abs() < 1e-13),
                }
            }
            // As many nodes as the number says: the mode's slope at a fixed end,
            // or its value at a free one, alternates from mode to mode.
            let half_waves = mode.k * length / std::f64::consts::PI;
            let expected = number as f64 - if ends[0] == ends[1] { 0.0 } else { 0.5 };
            assert_relative_eq!(half_waves, expected, max_relative = 1e-15);
            // ρ ∂v/∂t = ∂σ/∂x and ∂σ/∂t = E ∂v/∂x by central differences.
            let (x, t, d) = (0.4, 0.9, 1e-4);
            let at = |dx: f64, dt: f64| vibration.at(x + dx, t + dt);
            let dv_dt = (at(0.0, d).velocity - at(0.0, -d).velocity) / (2.0 * d);
            let ds_dx = (at(d, 0.0).stress - at(-d, 0.0).stress) / (2.0 * d);
            let omega = c * mode.k;
            let near = modulus * mode.k * 0.3 * (omega * d) * (omega * d);
            assert_relative_eq!(modulus / (c * c) * dv_dt, ds_dx, epsilon = near);
            let ds_dt = (at(0.0, d).stress - at(0.0, -d).stress) / (2.0 * d);
            let dv_dx = (at(d, 0.0).velocity - at(-d, 0.0).velocity) / (2.0 * d);
            assert_relative_eq!(ds_dt, modulus * dv_dx, epsilon = near);
            let amplitude = 1e-9;
            let small = Manufactured { mode, amplitude, c, modulus };
            let linear = Vibration { velocity: amplitude * omega, ..vibration };
            let (one, other) = (small.at(x, t), linear.at(x, t));
            assert_relative_eq!(one.velocity, other.velocity, max_relative = 1e-12);
            assert_relative_eq!(one.stress, other.stress, max_relative = 1e-6);
            assert!(small.body_force(x, t).abs() < 1e-7 * amplitude * omega * omega);
        }
    }
}

/// Under sudden gravity v and σ have kinks that travel and u has none. A kink is
/// smeared over h^(2/3), where the error is as large: v and σ of order h, u of
/// order h^(5/3). The largest displacement is twice the static one.
#[test]
fn gravity_converges_to_the_exact_swing() {
    let cells = [20, 40, 80, 160, 320];
    let h = cells.map(|n| 1.0 / f64::from(n));
    let [mut u, mut v] = [Vec::new(), Vec::new()];
    for n in cells {
        let scene = scene(GRAVITY, &[&format!("grid.cells={n}")]);
        let outcome = finished(&scene);
        u.push(value(&scene, &outcome, "displacement_end_rms_relative"));
        v.push(value(&scene, &outcome, "velocity_field_rms_relative"));
    }
    assert!(u[4] < 5e-5 && v[4] < 5e-3, "{u:?} {v:?}");
    assert!((slope(&h, &u) - 5.0 / 3.0).abs() < 0.05, "{u:?}");
    assert!((slope(&h, &v) - 1.0).abs() < 0.05, "{v:?}");
    let scene = scene(GRAVITY, &[]);
    let exact = lme_mpm::setup::exact(&scene).unwrap();
    let (rho, b, L, E) = (2000.0, 9.81, 10.0, 5e9);
    let half_swing = exact.at(L, 0.5 * scene.time.end).displacement;
    assert_relative_eq!(half_swing, rho * b * L * L / E, max_relative = 1e-9);
}

/// A step of traction is a front: errors like h^(1/3), as on the Dyka bar.
/// Until it comes back the loaded end moves at t/Z.
#[test]
fn traction_converges_like_a_front() {
    let cells = [40, 80, 160, 320, 640];
    let h = cells.map(|n| 1.0 / f64::from(n));
    let mut stress = Vec::new();
    for n in cells {
        let scene = scene(TRACTION, &[&format!("grid.cells={n}")]);
        let outcome = finished(&scene);
        stress.push(value(&scene, &outcome, "stress_wall_rms_relative"));
        if n == 640 {
            let v = outcome.history.column("velocity_end").unwrap();
            let plateau: Vec<f64> = v[v.len() / 8..v.len() * 3 / 8].to_vec();
            let Z = 7833.0 * 5053.019;
            let off = rms(plateau.iter().map(|v| (*v, 10e6 / Z))) / (10e6 / Z);
            assert!(off < 0.05, "{off}");
        }
    }
    let order = slope(&h, &stress);
    assert!((order - 1.0 / 3.0).abs() < 0.06, "{order}: {stress:?}");
}

/// The same bar with a load at the left does the mirrored thing; in 2D, with ν = 0,
/// a load on the whole side does the same.
#[test]
fn traction_mirrored_and_on_a_strip() {
    let here = finished(&scene(TRACTION, &[])).particles;
    let sets = [
        "boundary.left=free",
        "boundary.right=fixed",
        "grid.beyond.left=1",
        "grid.beyond.right=0",
        "traction.right=0",
        "traction.left=-10e6",
    ];
    let there = finished(&scene(TRACTION, &sets)).particles;
    let strip = TRACTION
        .replace("length = 0.1333", "length = [0.1333, 0.01]")
        .replace("cells = 40", "cells = [40, 2]")
        .replace("particles_per_cell = 2", "particles_per_cell = [2, 3]")
        .replace("right = 10e6", "right = [10e6, 0]")
        .split("[[probe]]")
        .next()
        .unwrap()
        .to_string();
    let strip = finished(&scene(&strip, &[])).particles;
    for (name, sign, scale) in [("velocity", -1.0, 0.25), ("stress", 1.0, 1e7)] {
        let one = here.column(name).unwrap();
        let mut mirrored = there.column(name).unwrap();
        mirrored.reverse();
        let wide = strip.column(&format!("{name}_x{}", if name == "stress" { "x" } else { "" }));
        for (n, a) in one.iter().enumerate() {
            let b = sign * mirrored[n];
            assert!((a - b).abs() < 1e-10 * scale, "{name}: {a} and {b}");
            let c = wide.as_ref().unwrap()[n];
            assert!((a - c).abs() < 1e-10 * scale, "{name}: {a} and {c} in 2D");
        }
    }
}

/// All six sides in 3D, along all three axes: a free block has the momentum
/// t A T after the time T.
#[test]
fn traction_of_all_six_sides() {
    let sides = ["left", "right", "bottom", "top", "back", "front"];
    let length = [0.3, 0.5, 0.7];
    for (side, name) in sides.into_iter().enumerate() {
        let text = format!(
            "title = 'block'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
             body = {{ length = [0.3, 0.5, 0.7], density = 10, youngs_modulus = 1e6, poisson_ratio = 0.2 }}\n\
             grid = {{ cells = [2, 3, 2], particles_per_cell = [2, 1, 3] }}\n\
             time = {{ integrator = 'newmark', cfl = 0.5, end = 1e-3 }}\n\
             traction.{name} = [7, 11, 13]\n"
        );
        let history = finished(&scene(&text, &[])).history;
        let area: f64 = (0..3).filter(|d| *d != side / 2).map(|d| length[d]).product();
        for (axis, t) in ["x", "y", "z"].into_iter().zip([7.0, 11.0, 13.0]) {
            let p = history.column(&format!("momentum_{axis}")).unwrap();
            assert_relative_eq!(*p.last().unwrap(), t * area * 1e-3, max_relative = 1e-12);
        }
    }
}

/// A free bar under growing loads: its momentum is what the scheme makes of the sum
/// of forces, to round-off. Newmark and OTM take the mean of both ends of a step, the
/// Euler forms the beginning, generalized-α its own recurrence, which starts from
/// the acceleration of k = 0.
#[test]
fn loads_move_a_free_bar_by_their_impulse() {
    let (b, t, T) = (3.0, 5e6, 8e-6);
    let mass = 7833.0 * 0.1333;
    for ramp in [T, 0.0] {
        let loads = [
            format!("body_force={{ acceleration = {b}, ramp = {ramp:e} }}"),
            format!("traction={{ right = {t:e}, ramp = {ramp:e} }}"),
        ];
        let free =
            ["boundary.left=free", "grid.beyond.left=2", "time.end=2e-5", "initial_velocity=[]"];
        for (name, sets) in SCHEMES {
            let loads: Vec<&str> = loads.iter().map(String::as_str).collect();
            let scene = dyka(&[sets, &free, &loads].concat());
            let outcome = finished(&scene);
            let dt = outcome.dt;
            let force = |k: usize| {
                let now = k as f64 * dt;
                let share = if now < ramp { now / ramp } else { 1.0 };
                (b * mass + t) * share
            };
            let momentum = outcome.history.column("momentum").unwrap();
            let (mut expected, mut a) = (0.0, force(0));
            for k in 0..momentum.len() {
                let off = (momentum[k] - expected).abs();
                assert!(off < 1e-12 * (b * mass + t) * 2e-5, "{name}, {ramp}, {k}: {off:e}");
                expected += dt
                    * match name {
                        _ if name.starts_with("newmark") => 0.5 * (force(k) + force(k + 1)),
                        "generalized-α (0.8)" => {
                            let Parameters { alpha_m, gamma, .. } = Parameters::new(0.8);
                            let next = (force(k) - alpha_m * a) / (1.0 - alpha_m);
                            let mean = (1.0 - gamma) * a + gamma * next;
                            a = next;
                            mean
                        }
                        _ => force(k),
                    };
            }
        }
    }
}

/// The work of growing loads is what the energy gains: one stiff cell that moves as
/// a whole, in 20 steps over the ramp.
#[test]
fn loads_do_the_work_that_the_energy_gains() {
    for load in
        ["body_force={ acceleration = 3, ramp = 1e-3 }", "traction={ right = 3e3, ramp = 1e-3 }"]
    {
        let text = "title = 'one'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
             body = { length = 1, density = 1000, youngs_modulus = 1e9, poisson_ratio = 0 }\n\
             grid = { cells = 1, particles_per_cell = 1 }\n\
             time = { integrator = 'newmark', cfl = 0.05, end = 1e-3 }\n";
        let history = finished(&scene(text, &[load])).history;
        let last = |name: &str| *history.column(name).unwrap().last().unwrap();
        assert_eq!(history.column("t").unwrap().len(), 21);
        assert_relative_eq!(last("work"), last("kinetic_energy"), max_relative = 5e-3);
        // ½ m v² with v = b T/2.
        assert_relative_eq!(
            last("kinetic_energy"),
            0.5 * 1000.0 * 1.5e-3 * 1.5e-3,
            max_relative = 1e-6
        );
    }
}

/// Runs with growing loads against their exact solutions, and vibrations of all
/// pairs of ends.
#[test]
fn runs_meet_their_exact_solutions() {
    let error = |scene: &Scene, name: &str| value(scene, &finished(scene), name);
    let hung = scene(GRAVITY, &["body_force.ramp=0.01"]);
    assert!(error(&hung, "displacement_end_rms_relative") < 1e-3);
    let pulled = scene(TRACTION, &["traction.ramp=2e-5"]);
    assert!(error(&pulled, "displacement_field_rms_relative") < 2e-3);
    assert!(error(&pulled, "stress_wall_rms_relative") < 0.02);
    for left in ["fixed", "free"] {
        for right in ["fixed", "free"] {
            for mode in [1, 2] {
                let sets = [
                    format!("boundary={{ left = '{left}', right = '{right}' }}"),
                    format!("vibration.mode={mode}"),
                    "grid.cells=80".to_string(),
                ];
                let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
                let scene = scene(VIBRATION, &sets);
                // The phase is late by (kh)² ωt/24 or so.
                let bound = if mode == 1 { 3e-3 } else { 2e-2 };
                let (v, u) = ("velocity_field_rms_relative", "displacement_field_rms_relative");
                assert!(error(&scene, v) < bound && error(&scene, u) < bound, "{sets:?}");
            }
        }
    }
}

/// Body force is computed where it is declared, once per particle and force
/// balance; traction once per loaded particle; and none anywhere else.
#[test]
fn loads_undeclared_are_uncomputed() {
    let counts = |scene: &Scene| {
        let cost = finished(scene).cost;
        (cost.body_forces, cost.tractions, cost.factorizations, cost.solves, cost.steps)
    };
    for text in [lme_mpm::scene::DYKA, FREE_FLIGHT, VIBRATION] {
        let (bodies, tractions, factorizations, solves, _) = counts(&scene(text, &[]));
        assert_eq!((bodies, tractions, factorizations, solves), (0, 0, 0, 0));
    }
    let (bodies, tractions, _, _, steps) = counts(&scene(GRAVITY, &[]));
    assert_eq!((bodies, tractions), (80 * (steps + 1), 0));
    let (bodies, tractions, _, _, steps) = counts(&scene(TRACTION, &[]));
    assert_eq!((bodies, tractions), (0, steps + 1));
    let (_, _, factorizations, solves, steps) = counts(&dyka(&["mass=consistent"]));
    assert_eq!((factorizations, solves), (steps + 1, 2 * (steps + 1)));
    // Generalized-α looks for accelerations at the start only under loads.
    let alpha = "time.integrator=generalized-alpha";
    for (sets, extra) in [
        (&[alpha, "time.rho_b=0.8"][..], 0),
        (&[alpha, "time.rho_b=0.8", "body_force.acceleration=1"], 80),
    ] {
        let cost = finished(&dyka(sets)).cost;
        assert_eq!(cost.basis_evaluations, 80 * cost.steps + extra);
    }
}

/// A sudden traction on a free end acts there at once, σ = t and v = t/Z, and the front
/// that it sends belongs to the loaded side.
#[test]
fn forced_front_belongs_to_the_loaded_side() {
    let scene = dyka(&["initial_velocity=[]", "probe=[]", "traction.right=1e6"]);
    let Exact::Linear { forced: Some(forced), .. } = lme_mpm::setup::exact(&scene).unwrap() else {
        panic!()
    };
    let at_once = forced.at(forced.length, 0.0);
    assert_relative_eq!(at_once.stress, 1e6, max_relative = 1e-15);
    assert_relative_eq!(at_once.velocity, 1e6 / forced.Z, max_relative = 1e-15);
    assert_eq!((forced.at(0.5 * forced.length, 0.0).stress, at_once.displacement), (0.0, 0.0));
}

/// The manufactured motion across ten cells to each side: what the linear basis
/// makes of it, and what local max-ent does. The bound is that of an independent
/// prototype.
#[test]
fn manufactured_motion_across_cells() {
    let mut table = String::from(
        "basis,mass,displacement of the middle,displacement field,velocity field,stress field\n",
    );
    let mut errors = Vec::new();
    for (name, sets) in BASES {
        for mass in ["lumped", "consistent"] {
            let linear = MANUFACTURED.replace("kind = \"lme\"\ngamma = 0.8", "kind = \"linear\"");
            let mass_set = format!("mass={mass}");
            let scene = scene(&linear, &[sets, &[mass_set.as_str()]].concat());
            let Ok(outcome) = lme_mpm::run::run(&scene, &mut |_| {}) else {
                table += &format!("{name},{mass},blew up,,,\n");
                continue;
            };
            let of = |quantity: &str| value(&scene, &outcome, quantity);
            let row = [
                "displacement_middle_rms_relative",
                "displacement_field_rms_relative",
                "velocity_field_rms_relative",
                "stress_field_rms_relative",
            ]
            .map(of);
            let text: Vec<String> = row.iter().map(|x| format!("{x:.1e}")).collect();
            table += &format!("{name},{mass},{}\n", text.join(","));
            errors.push((name, mass, row[0]));
        }
    }
    let of = |name: &str, mass: &str| errors.iter().find(|e| e.0 == name && e.1 == mass).unwrap().2;
    assert!(of("linear", "lumped") > 0.5);
    assert!(of("lme γ = 0.8", "lumped") < 1.5e-3);
    assert!(of("lme γ = 0.8", "consistent") < of("lme γ = 0.8", "lumped"));
    assert!(of("ugimp", "lumped") < 0.3 * of("linear", "lumped"));
    assert!(of("bspline", "lumped") < of("ugimp", "lumped"));
    approve("manufactured__errors", &table);
}
