//! The exact solutions that go with loads, vibrations and manufactured motions: against
//! references of 60 digits, the equations they solve, and each other.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::exact::forced::{Forced, Load};
use lme_mpm::method::exact::manufactured::Manufactured;
use lme_mpm::method::exact::mode::{Mode, Vibration};
use lme_mpm::method::exact::riemann::{Bar, End, Patch};
use lme_mpm::method::exact::{Exact, Fields};
use lme_mpm::scene::Scene;
use lme_mpm::scene::fault::Fault;
use lme_mpm::setup;
use std::f64::consts::PI;

/// Bars under gravity and tractions, at once and growing, with all pairs of ends, up to
/// 40 L/c, meet static solution and images at 60 digits to 2e-14
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

/// u = A φ sin ωt with its stress and body force meets differentiation at 60 digits to
/// 1e-13 (data/reference/manufactured.py).
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

/// The modes 1, 2 and 5 of every pair of ends meet their ends, the wave equation and, with
/// A k → 0, the manufactured solution, into which they grow.
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
            let half_waves = mode.k * length / PI;
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

/// A sudden traction on a free end acts there at once, σ = t and v = t/Z, and the front
/// that it sends belongs to the loaded side.
#[test]
fn forced_front_belongs_to_the_loaded_side() {
    let scene = dyka(&["initial_velocity=[]", "probe=[]", "traction.right=1e6"]);
    let Ok(Exact::Linear { forced: Some(forced), .. }) = setup::exact(&scene) else {
        panic!("the bar with a traction has an exact solution");
    };
    let at_once = forced.at(forced.length, 0.0);
    assert_relative_eq!(at_once.stress, 1e6, max_relative = 1e-15);
    assert_relative_eq!(at_once.velocity, 1e6 / forced.Z, max_relative = 1e-15);
    assert_eq!((forced.at(0.5 * forced.length, 0.0).stress, at_once.displacement), (0.0, 0.0));
}

/// A solution says until when it can be trusted, 2^50 L/c for the thrown bar and 1e4 of
/// its own times for the others, and the discs have none.
#[test]
fn exact_says_until_when() {
    let latest = |scene: &Scene| setup::exact(scene).unwrap().latest();
    let transit = transit();
    for (scene, expected) in [
        (dyka(&[]), 2.0_f64.powi(50) * transit),
        (dyka(&["traction.right=1"]), 1e4 * transit),
        (dyka(&["body_force.acceleration=1"]), 1e4 * transit),
        (dyka(&["initial_velocity=[]", "vibration={ mode = 1, velocity = 1 }"]), 1e4 * transit),
    ] {
        assert_relative_eq!(latest(&scene), expected, max_relative = 1e-14);
    }
    // The first mode between a fixed and a free end: k = π / 2L.
    let moving = scene(MANUFACTURED, &[]);
    let Ok(Exact::Manufactured(solution)) = setup::exact(&moving) else { panic!("{moving:?}") };
    let expected = 1e4 / (solution.c * solution.mode.k);
    assert_relative_eq!(latest(&moving), expected, max_relative = 1e-14);
    let error = setup::exact(&scene(DISCS, &[])).unwrap_err();
    assert!(matches!(error, Fault::NoExact { .. }), "{error}");
}
