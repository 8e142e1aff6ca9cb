//! The exact solutions that go with loads, vibrations and manufactured motions: against
//! references of 60 digits, the equations they solve, and each other.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::choice::Law;
use lme_mpm::method::continuum::law::Elastic;
use lme_mpm::method::exact::forced::{Forced, Load};
use lme_mpm::method::exact::manufactured::Manufactured;
use lme_mpm::method::exact::mode::{Mode, Vibration};
use lme_mpm::method::exact::riemann::{Bar, End, Patch};
use lme_mpm::method::exact::vortex::Vortex;
use lme_mpm::method::exact::{Exact, Fields, FieldsIn, Moved};
use lme_mpm::scene::Scene;
use lme_mpm::scene::fault::Fault;
use lme_mpm::setup;
use nalgebra::{SMatrix, SVector, Vector1};
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
        let material = Elastic::new(Law::Rate, modulus, 0.0);
        let solution = swinging(mode, amplitude, c, row.number("density"), material);
        let (x, t) = (Vector1::new(row.number("x")), row.number("t"));
        let fields: Fields = solution.at(&x, t).into();
        let omega = c * mode.k;
        for (name, value, unit) in [
            ("velocity", fields.velocity, amplitude * omega),
            ("stress", fields.stress, modulus),
            ("displacement", fields.displacement, amplitude),
            ("body_force", solution.body_force(&x, t)[0], amplitude * omega * omega),
        ] {
            let off = (value - row.number(name)).abs() / unit;
            assert!(off < 1e-13, "x = {x}, t = {t}: {name} off by {off:e}");
        }
    }
    assert!(rows.len() > 30);
}

/// The motion u = A φ sin ckt of a bar.
fn swinging(
    mode: Mode,
    amplitude: f64,
    c: f64,
    density: f64,
    material: Elastic,
) -> Manufactured<1> {
    let omega = c * mode.k;
    Manufactured { modes: [mode], amplitude, omega, phase: [0.0], density, material }
}

/// Motions along one to three axes with every law, and the vortex, meet differentiation at 40
/// digits of nothing but the motion, to 2e-14 of the largest of their kind, and stresses to 2e-15 of
/// that or E
/// (data/reference/moved.py).
#[test]
fn moved_against_40_digits() {
    let rows = rows(include_str!("../data/reference/moved.csv"));
    for row in &rows {
        match row.text("dimension") {
            "1" => moved_meets::<1>(row),
            "2" => moved_meets::<2>(row),
            _ => moved_meets::<3>(row),
        }
    }
    assert_eq!(rows.len(), 26);
}

fn moved_meets<const D: usize>(row: &Row) {
    let numbers = |name: &str| -> [f64; D] {
        std::array::from_fn(|i| row.number(&format!("{name}_{}", ["x", "y", "z"][i])))
    };
    let laws = [("rate", Law::Rate), ("neo-hookean", Law::NeoHookean), ("hencky", Law::Hencky)];
    let law = laws.iter().find(|(name, _)| *name == row.text("law")).unwrap().1;
    let material = Elastic::new(law, row.number("E"), row.number("nu"));
    let density = row.number("density");
    let (length, amplitude, omega) =
        (numbers("length"), row.number("amplitude"), row.number("frequency"));
    let solution = match row.text("case") {
        "vortex" => Moved::Vortex(Vortex {
            centre: std::array::from_fn(|i| 0.5 * length[i]),
            radius: row.number("radius"),
            angle: amplitude,
            omega,
            density,
            material,
        }),
        _ => Moved::Manufactured(Manufactured {
            modes: length
                .map(|length| Mode::new([End::Fixed; 2], row.number("mode") as usize, length)),
            amplitude,
            omega,
            phase: numbers("phase"),
            density,
            material,
        }),
    };
    let (X, t) = (SVector::from(numbers("X")), row.number("t"));
    let fields: FieldsIn<D> = solution.at(&X, t);
    for (name, found) in
        [("u", fields.displacement), ("v", fields.velocity), ("b", solution.body_force(&X, t))]
    {
        let expected = SVector::from(numbers(name));
        let off = (found - expected).amax() / expected.amax();
        assert!(off < 2e-14, "{}: {name} off by {off:e}", row.text("case"));
    }
    let axes = ["x", "y", "z"];
    let expected = SMatrix::<f64, D, D>::from_fn(|i, j| {
        row.number(&format!("sigma_{}{}", axes[i.min(j)], axes[i.max(j)]))
    });
    // The hyperelastic laws have it from F, too.
    let from_F = match law {
        Law::Rate => fields.stress,
        _ => material.stress_of(&solution.deformation(&X, t)),
    };
    for found in [fields.stress, from_F] {
        let off = (found - expected).amax() / row.number("E").max(expected.amax());
        assert!(off < 2e-15, "{}: σ off by {off:e}", row.text("case"));
    }
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
            let material = Elastic::new(Law::Rate, modulus, 0.0);
            let small = swinging(mode, amplitude, c, modulus / (c * c), material);
            let X = Vector1::new(x);
            let linear = Vibration { velocity: amplitude * omega, ..vibration };
            let (one, other): (Fields, Fields) = (small.at(&X, t).into(), linear.at(x, t));
            assert_relative_eq!(one.velocity, other.velocity, max_relative = 1e-12);
            assert_relative_eq!(one.stress, other.stress, max_relative = 1e-6);
            assert!(small.body_force(&X, t)[0].abs() < 1e-7 * amplitude * omega * omega);
        }
    }
}

/// A sudden traction on a free end acts there at once, σ = t and v = t/Z, and the front
/// that it sends belongs to the loaded side.
#[test]
fn forced_front_belongs_to_the_loaded_side() {
    let scene = dyka(&["initial_velocity=[]", "probe=[]", "traction.right=1e6"]);
    let Ok(Exact::Linear { forced: Some(forced), .. }) = setup::exact::<1>(&scene) else {
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
    let latest = |scene: &Scene| setup::exact::<1>(scene).unwrap().latest();
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
    let Ok(Exact::Moved(Moved::Manufactured(solution))) = setup::exact::<1>(&moving) else {
        panic!("{moving:?}")
    };
    let expected = 1e4 / solution.omega;
    assert_relative_eq!(latest(&moving), expected, max_relative = 1e-14);
    let error = setup::exact::<2>(&scene(DISCS, &[])).unwrap_err();
    assert!(matches!(error, Fault::NoExact { .. }), "{error}");
}
