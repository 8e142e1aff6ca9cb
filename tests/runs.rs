//! Laws of whole runs: motions and changes of a scene that change nothing, and what a run
//! costs.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::continuum::state::Particles;
use lme_mpm::scene::Scene;
use nalgebra::SMatrix;

/// A strip with ν = 0 is the bar, in 2D and in 3D: both probes to 1e-12 in every step.
#[test]
fn run_strip_equals_bar() {
    let bar = finished(&strip(1, &[])).history;
    for dimension in [2, 3] {
        let strip = finished(&strip(dimension, &[])).history;
        for (name, scale) in [("velocity_end", 5.0), ("stress_three_quarter", 2e8)] {
            let off = apart(&column(&bar, name), &column(&strip, name));
            assert!(off < 1e-12 * scale, "{name} in {dimension}D: {off:e}");
        }
    }
}

/// Uniform motion across more than three cells leaves not one bit of strain or stress with
/// the linear basis, in 1D, 2D and 3D, when the speed is a power of two, so that p_I is
/// just that multiple of m_I.
#[test]
fn run_rigid_motion_is_exactly_free_of_stress() {
    fn check<const D: usize>(scene: &Scene) {
        let (model, mut state) = at_start::<D>(scene);
        let start = state.particle.x[0];
        let rho = state.particle.rho.clone();
        let v = state.particle.v.clone();
        march(&model, &mut state, model.steps);
        let crossed = (state.particle.x[0] - start).component_div(&model.grid.h);
        assert!(crossed.min() > 3.0, "cells crossed: {crossed:?}");
        assert!(state.particle.sigma.iter().all(|sigma| *sigma == SMatrix::<f64, D, D>::zeros()));
        assert_eq!(state.particle.rho, rho);
        assert_eq!(state.particle.v, v);
    }
    check::<1>(&scene(FREE_FLIGHT, &[]));
    for dimension in [2, 3] {
        let list = |x: &str| each_axis(dimension, x);
        let text = format!(
            "title = 'flight'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
             body = {{ length = {}, density = 1000, youngs_modulus = 1e6, poisson_ratio = 0.3 }}\n\
             [grid]\ncells = {}\nparticles_per_cell = {}\n\
             beyond = {{ right = 6, top = 6{} }}\n[time]\n\
             integrator = 'newmark'\ncfl = 0.5\nend = 0.5\n\
             [[initial_velocity]]\nfrom = {}\nto = {}\nvelocity = {}\n",
            list("0.7"),
            list("3"),
            list("2"),
            if dimension == 3 { ", front = 6" } else { "" },
            list("0"),
            list("0.7"),
            list("2"),
        );
        let scene = scene(&text, &[]);
        if dimension == 2 { check::<2>(&scene) } else { check::<3>(&scene) }
    }
}

/// The other bases sum rounded functions, so their rigid motion leaves a stress of
/// round-off: N differs from an exact partition of unity by some ε, and a strain increment
/// by some ε (v Δt/h), 20 at most. The velocity stays to 1e-13; γ up to 50.
#[test]
fn run_rigid_motion_of_every_basis() {
    let almost_linear: Sets = &["basis.kind=lme", "basis.gamma=50"];
    for sets in [UGIMP.sets, BSPLINE.sets, LME_WIDE.sets, LME_NARROW.sets, almost_linear] {
        let scene = scene(FREE_FLIGHT, sets);
        let (model, mut state) = at_start::<1>(&scene);
        march(&model, &mut state, model.steps);
        let strain = 8.0 * model.dt / model.grid.h[0] * f64::EPSILON;
        let bound = 20.0 * 1e6 * strain * model.steps as f64;
        let worst = largest(state.particle.sigma.iter().map(|sigma| sigma[0]));
        assert!(worst <= bound, "{sets:?}: stress {worst:e} above {bound:e}");
        for v in &state.particle.v {
            assert_relative_eq!(v[0], 8.0, max_relative = 1e-13);
        }
    }
}

/// At any other speed, here 7.3, −0.1 and 123.456 m/s, the stress of rigid motion is
/// round-off: p_I and m_I are sums of at most four rounded terms each, so a strain
/// increment is below 4 ε (v Δt/h).
#[test]
fn run_rigid_motion_at_any_speed_is_round_off() {
    for velocity in [7.3, -0.1, 123.456] {
        let end = 0.9 / f64::abs(velocity);
        let scene = scene(
            FREE_FLIGHT,
            &[
                &format!("initial_velocity.0.velocity={velocity}"),
                &format!("time.end={end}"),
                "grid.beyond.left=12",
            ],
        );
        let (model, mut state) = at_start::<1>(&scene);
        march(&model, &mut state, model.steps);
        let per_step = 1e6 * f64::EPSILON * f64::abs(velocity) * model.dt / model.grid.h[0];
        let bound = 4.0 * per_step * model.steps as f64;
        let worst = largest(state.particle.sigma.iter().map(|sigma| sigma[0]));
        assert!(worst < bound, "v = {velocity}: stress {worst:e} above {bound:e}");
    }
}

/// The mirrored bar does the mirrored thing: v, σ and u of all particles to 1e-11.
#[test]
fn run_mirror_symmetry() {
    let here = finished(&dyka(&[])).particles;
    let there = finished(&dyka(&[
        "boundary.left=free",
        "boundary.right=fixed",
        "grid.beyond.left=1",
        "grid.beyond.right=0",
        "initial_velocity.0.from=0",
        "initial_velocity.0.to=0.033325",
        "initial_velocity.0.velocity=-5",
        "probe.0.position=0",
        "probe.1.position=0.033325",
    ]))
    .particles;
    for (name, sign, scale) in
        [("velocity", -1.0, 5.0), ("stress", 1.0, 2e8), ("displacement", -1.0, 1e-4)]
    {
        let mirrored: Vec<f64> = column(&there, name).iter().rev().map(|x| sign * x).collect();
        let off = apart(&column(&here, name), &mirrored);
        assert!(off < 1e-11 * scale, "{name}: {off:e}");
    }
}

/// Other units of length, time and mass, all powers of two: not one bit
/// differs but the exponent.
#[test]
fn run_units_scale_bit_by_bit() {
    let here = finished(&dyka(&[]));
    // 1 m = 2^a new units, 1 s = 2^b, 1 kg = 2^c.
    for (a, b, c) in [(10, -6, 3), (-40, 30, -20)] {
        let two = |n: i32| libm::exp2(n as f64);
        let (length, time, mass) = (two(a), two(b), two(c));
        let (stress, velocity) = (mass / (length * time * time), length / time);
        // In 1D the cross-section is one and has no unit: density is mass per
        // length, and what is called stress is a force.
        let (density, stress) = (mass / length, stress * length * length);
        let there = finished(&dyka(&strs(&bar_in_units(length, time, density, stress))));
        for (name, unit) in [
            ("velocity_end", velocity),
            ("stress_three_quarter", stress),
            ("t", time),
            ("momentum", mass * velocity),
            ("kinetic_energy", mass * velocity * velocity),
        ] {
            let scaled: Vec<f64> = column(&here.history, name).iter().map(|x| x * unit).collect();
            let there = column(&there.history, name);
            assert_eq!(scaled, there, "{name} with units 2^({a}, {b}, {c})");
        }
    }
}

/// The origin is a matter of taste: a scene moved by 2^20 m gives the same bits.
/// (The stress probe is moved off the midpoint between two particles, which the
/// shift cannot represent, and is not compared.)
#[test]
fn run_translation_changes_nothing() {
    let here = finished(&dyka(&[]));
    let shift = libm::exp2(20.0);
    let there = finished(&dyka(&[
        &format!("body.origin={shift:?}"),
        &format!("initial_velocity.0.from={:?}", shift + 0.099975),
        &format!("initial_velocity.0.to={:?}", shift + 0.1333),
        &format!("probe.0.position={:?}", shift + 0.1333),
        &format!("probe.1.position={:?}", shift + 0.09),
    ]));
    for name in ["velocity_end", "kinetic_energy", "strain_energy", "momentum"] {
        assert_eq!(column(&here.history, name), column(&there.history, name), "{name}");
    }
    for name in ["velocity", "stress", "displacement"] {
        assert_eq!(column(&here.particles, name), column(&there.particles, name), "{name}");
    }
}

/// Exponentials and Newton iterations are counted where there are some, and λ, its rate and
/// place are carried only by the basis that needs them. One iteration finds λ in 1D: 1.05 per
/// particle and step at most.
#[test]
fn run_cost_of_local_max_ent() {
    for basis in BASES {
        let (name, cost) = (basis.name, finished(&dyka(basis.sets)).cost);
        if ![LME_WIDE, LME_MIDDLE, LME_NARROW].contains(&basis) {
            assert_eq!((cost.exponentials, cost.newton_iterations), (0, 0), "{name}");
            assert_eq!(cost.bytes_per_particle, 56 + 8, "{name}");
            continue;
        }
        let warm = cost.newton_iterations as f64 / cost.basis_evaluations as f64;
        assert!((1.0..1.05).contains(&warm), "{name}: {warm} iterations per particle and step");
        // One for each axis and iteration, and the table of exp(−γk²).
        assert!(cost.exponentials >= cost.basis_evaluations, "{name}");
        assert!(cost.exponentials < cost.particle_node_pairs, "{name}");
        assert_eq!(cost.bytes_per_particle, 56 + 8 + 24, "{name}");
    }
}

/// What a scene does not declare is not computed, and what is computed is
/// counted: one table per step and one at the start, 2^D pairs per particle, the strip in
/// 1D, 2D and 3D.
#[test]
fn run_cost_is_what_the_scene_needs() {
    for dimension in [1, 2, 3] {
        let scene = strip(dimension, &[]);
        let outcome = finished(&scene);
        let (particles, _, steps) = scene.sizes();
        let cost = outcome.cost;
        assert_eq!(cost.steps, steps as u64);
        assert_eq!(cost.basis_evaluations, (particles * (steps + 1.0)) as u64);
        assert_eq!(cost.particle_node_pairs, cost.basis_evaluations << dimension);
        assert_eq!((cost.exponentials, cost.newton_iterations), (0, 0));
        let d = dimension as u64;
        assert_eq!(cost.bytes_per_particle, 8 * (2 + 4 * d + 2 * d * d + d * (d - 1) / 2));
    }
    assert_eq!(Particles::<1>::BYTES, 56);
}
