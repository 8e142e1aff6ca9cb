//! Laws that hold for any data: at a point, of the sums, of a whole run.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::continuum::law::{LinearElastic, density, symmetric_part};
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::Particles;
use lme_mpm::method::continuum::sums;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::measure;
use lme_mpm::method::model::State;
use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2};

// ---- the pointwise laws --------------------------------------------------------

/// Hooke's law in plane strain against its textbook form.
#[test]
fn law_plane_strain() {
    let (E, nu) = (210e9, 0.3);
    let law = LinearElastic::new(E, nu);
    let eps = Matrix2::new(1e-3, 2e-4, 2e-4, -4e-4);
    let sigma = law.stress_increment(&eps);
    let factor = E / ((1.0 + nu) * (1.0 - 2.0 * nu));
    assert_relative_eq!(
        sigma[(0, 0)],
        factor * ((1.0 - nu) * 1e-3 - nu * 4e-4),
        max_relative = 1e-14
    );
    assert_relative_eq!(
        sigma[(1, 1)],
        factor * (nu * 1e-3 - (1.0 - nu) * 4e-4),
        max_relative = 1e-14
    );
    assert_relative_eq!(sigma[(0, 1)], E / (1.0 + nu) * 2e-4, max_relative = 1e-14);
    assert_eq!(sigma[(0, 1)], sigma[(1, 0)]);
}

/// In 1D the modulus is E(1−ν)/((1+ν)(1−2ν)), and E for ν = 0.
#[test]
fn law_uniaxial_strain() {
    let modulus = |nu| LinearElastic::new(200e9, nu).p_wave_modulus();
    assert_eq!(modulus(0.0), 200e9);
    assert_relative_eq!(modulus(0.25), 200e9 * 0.75 / (1.25 * 0.5), max_relative = 1e-15);
    let eps = SMatrix::<f64, 1, 1>::new(1e-3);
    assert_eq!(LinearElastic::new(200e9, 0.0).stress_increment(&eps)[0], 200e6);
}

/// ½ σ : D⁻¹ : σ of σ = D : ε is ½ σ : ε, in every dimension.
#[test]
fn law_energy_is_half_stress_times_strain() {
    let law = LinearElastic::new(7.0, 0.3);
    let eps = Matrix3::new(0.3, 0.1, -0.2, 0.1, -0.4, 0.05, -0.2, 0.05, 0.2);
    let sigma = law.stress_increment(&eps);
    assert_relative_eq!(law.energy_density(&sigma), 0.5 * sigma.dot(&eps), max_relative = 1e-14);
    let eps = eps.fixed_view::<2, 2>(0, 0).into_owned();
    let sigma = law.stress_increment(&eps);
    assert_relative_eq!(law.energy_density(&sigma), 0.5 * sigma.dot(&eps), max_relative = 1e-14);
    let eps = SMatrix::<f64, 1, 1>::new(0.3);
    let sigma = law.stress_increment(&eps);
    assert_relative_eq!(law.energy_density(&sigma), 0.5 * sigma.dot(&eps), max_relative = 1e-14);
}

/// (2) of a rotation is zero, and (17) refuses to turn material inside out.
#[test]
fn law_rotation_and_inversion() {
    assert_eq!(symmetric_part(&Matrix2::new(0.0, -3.0, 3.0, 0.0)), Matrix2::zeros());
    assert_eq!(symmetric_part(&Matrix2::new(1.0, 4.0, 2.0, 5.0)), Matrix2::new(1.0, 3.0, 3.0, 5.0));
    assert_eq!(density(10.0, &Matrix2::new(0.2, 9.0, 9.0, 0.05)), Some(8.0));
    assert_eq!(density(1.0, &Matrix2::new(-0.5, 0.0, 0.0, -0.5)), None);
    assert_eq!(density(1.0, &Matrix2::new(f64::NAN, 0.0, 0.0, 0.0)), None);
}

// ---- the sums ------------------------------------------------------------------

/// A 2D block with scattered velocities and stresses, tabulated.
fn scattered() -> (Grid<2>, State<2>) {
    let scene = strip(2, &["initial_velocity=[]"]);
    let model = lme_mpm::setup::model::<2>(&scene);
    let mut state = lme_mpm::setup::initial_state(&model, &scene);
    for p in 0..state.particle.len() {
        let s = p as f64;
        state.particle.x[p] += Vector2::new((1.7 * s).sin(), (2.3 * s).cos()) * 1e-4;
        state.particle.v[p] = Vector2::new((0.3 * s).sin(), (0.7 * s).cos());
        state.particle.sigma[p] = Matrix2::new(s.sin(), s.cos(), s.cos(), (2.0 * s).sin()) * 1e6;
    }
    state.shape = on_grid(&Basis::Linear, &model.grid, &state.particle.x).unwrap().shape;
    (model.grid, state)
}

/// Σ_I m_I = Σ_p m_p and Σ_I p_I = Σ_p m_p v_p.
#[test]
fn sums_keep_mass_and_momentum() {
    let (_, State { particle, mut node, shape, .. }) = scattered();
    sums::lumped_mass(&mut node, &particle, &shape);
    sums::momentum(&mut node, &particle, &shape);
    let mass: f64 = node.m.iter().sum();
    let round_off = particle.len() as f64 * f64::EPSILON;
    assert_relative_eq!(mass, particle.m.iter().sum::<f64>(), max_relative = round_off);
    let momentum: Vector2<f64> = node.p.iter().sum();
    assert_relative_eq!(
        momentum,
        measure::momentum(&particle.carriers()),
        epsilon = round_off * mass
    );
}

/// Internal forces do no net work on a rigid motion: Σ_I f_I = 0 and, since
/// σ is symmetric, Σ_I x_I × f_I = 0.
#[test]
fn sums_internal_force_is_in_balance() {
    let (grid, State { particle, mut node, shape, .. }) = scattered();
    sums::internal_force(&mut node, &particle, &shape);
    let scale: f64 = node.f.iter().map(|f| f.norm()).sum();
    let force: Vector2<f64> = node.f.iter().sum();
    let torque: f64 = (0..node.len()).map(|I| grid.position(I).perp(&node.f[I])).sum();
    assert!(scale > 1e3);
    assert!(force.norm() < 1e-14 * scale, "{force:?}");
    assert!(torque.abs() < 1e-14 * scale, "{torque:e}");
}

/// An affine velocity of the nodes gives its gradient at every particle.
#[test]
fn sums_velocity_gradient_of_affine_motion() {
    let (grid, State { particle, mut node, shape, .. }) = scattered();
    let L = Matrix2::new(0.3, -0.7, 0.2, 0.9);
    sums::lumped_mass(&mut node, &particle, &shape);
    for I in 0..node.len() {
        node.v[I] = Vector2::new(100.0, -50.0) + L * grid.position(I);
    }
    for p in 0..particle.len() {
        let grad_v = sums::velocity_gradient(&node, &shape, p);
        assert_relative_eq!(grad_v, L, epsilon = 1e-9);
    }
}

/// A node with a mass 1e-300 times that of its neighbour sends no particle off.
#[test]
fn sums_to_particle_survives_tiny_mass() {
    let mut shape = Shape::<1>::blank(0);
    let tiny = 1e-300;
    shape.push(0, 1.0, SVector::<f64, 1>::new(-1.0));
    shape.push(1, tiny, SVector::<f64, 1>::new(1.0));
    shape.end_row();
    let particle =
        Particles { m: vec![2.0], ..Particles::at_rest(vec![SVector::<f64, 1>::new(0.0)], 1.0) };
    let mut node = lme_mpm::method::continuum::state::Nodes::<1>::blank(2);
    sums::lumped_mass(&mut node, &particle, &shape);
    let force = [SVector::<f64, 1>::new(2e10), SVector::<f64, 1>::new(-1e10)];
    // f_I / m_I alone would be 5e309; mapped, both parts are f / m_p.
    let a = sums::to_particle(&force, &node, &shape, 0);
    assert_eq!(a[0], 0.5 * (2e10 - 1e10));
}

/// Nodes on a fixed side, and those beyond it, are fixed, component by
/// component; no others.
#[test]
fn model_fixes_the_nodes_of_a_side() {
    let sets = ["boundary={ left = { x = 'fixed' }, top = 'fixed' }", "grid.beyond={ left = 1 }"];
    let model = lme_mpm::setup::model::<2>(&strip(2, &sets));
    assert_eq!(model.grid.cells, [42, 4]); // 1 + 40 + 1 and 1 + 3 + 0
    let mut expected = Vec::new();
    for I in 0..model.grid.nodes() {
        let [i, j] = model.grid.index(I);
        let (left, top) = (i <= 1, j >= 4);
        expected.extend((left || top).then_some((I, 0)));
        expected.extend(top.then_some((I, 1)));
    }
    assert_eq!(model.fixed, expected);
}

// ---- whole runs ------------------------------------------------------------------

/// The Dyka bar as a strip in D = 2 or 3, ν = 0, free at its long sides.
fn strip(dimension: usize, sets: &[&str]) -> lme_mpm::scene::Scene {
    let list = |first: &str, other: &str| {
        let mut entries = vec![first];
        entries.resize(dimension, other);
        format!("[{}]", entries.join(","))
    };
    let (x, xx) = if dimension == 1 { ("", "") } else { ("component='x'\n", "component='xx'\n") };
    let text = format!(
        "title = 'strip'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
         body = {{ length = {length}, density = 7833, youngs_modulus = 200e9, poisson_ratio = 0 }}\n\
         grid = {{ cells = {cells}, particles_per_cell = {per_cell} }}\n\
         time = {{ integrator = 'newmark', cfl = 0.5, end = {end} }}\n\
         boundary.left = 'fixed'\n\
         [[initial_velocity]]\nfrom = {from}\nto = {length}\nvelocity = {velocity}\n\
         [[probe]]\nname = 'velocity_end'\nquantity = 'velocity'\n{x}position = {length}\n\
         [[probe]]\nname = 'stress_three_quarter'\nquantity = 'stress'\n{xx}position = {quarter}\n",
        length = list("0.1333", "0.01"),
        cells = list("40", "3"),
        per_cell = list("2", "2"),
        from = list("0.099975", "0"),
        velocity = list("5", "0"),
        quarter = list("0.099975", "0"),
        end = 4.0 * transit(),
    );
    scene(&text, sets)
}

/// A strip with ν = 0 is the bar, in 2D and in 3D.
#[test]
fn run_strip_equals_bar() {
    let bar = finished(&strip(1, &[])).history;
    for dimension in [2, 3] {
        let strip = finished(&strip(dimension, &[])).history;
        for (name, scale) in [("velocity_end", 5.0), ("stress_three_quarter", 2e8)] {
            let (one, many) = (bar.column(name).unwrap(), strip.column(name).unwrap());
            assert_eq!(one.len(), many.len());
            for (a, b) in one.iter().zip(&many) {
                assert!((a - b).abs() < 1e-12 * scale, "{name} in {dimension}D: {a} and {b}");
            }
        }
    }
}

/// Uniform motion across cells: not one bit of strain or stress, in 1D, 2D and
/// 3D, when the speed is a power of two, so that p_I is just that multiple of m_I.
#[test]
fn run_rigid_motion_is_exactly_free_of_stress() {
    fn check<const D: usize>(scene: &lme_mpm::scene::Scene) {
        let model = lme_mpm::setup::model::<D>(scene);
        let mut state = lme_mpm::setup::initial_state(&model, scene);
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
        let list = |x: &str| format!("[{}]", vec![x; dimension].join(","));
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

/// The other bases sum rounded functions, so their rigid motion leaves a stress
/// of round-off: N differs from an exact partition of unity by some ε, and a
/// strain increment by some ε (v Δt/h).
#[test]
fn run_rigid_motion_of_every_basis() {
    for sets in [
        &["basis.kind=ugimp"][..],
        &["basis.kind=bspline"],
        &["basis.kind=lme", "basis.gamma=0.8"],
        &["basis.kind=lme", "basis.gamma=4"],
        &["basis.kind=lme", "basis.gamma=50"],
    ] {
        let scene = scene(FREE_FLIGHT, sets);
        let model = lme_mpm::setup::model::<1>(&scene);
        let mut state = lme_mpm::setup::initial_state(&model, &scene);
        march(&model, &mut state, model.steps);
        let strain = 8.0 * model.dt / model.grid.h[0] * f64::EPSILON;
        let bound = 20.0 * 1e6 * strain * model.steps as f64;
        let worst = state.particle.sigma.iter().fold(0.0, |worst: f64, s| worst.max(s[0].abs()));
        assert!(worst <= bound, "{sets:?}: stress {worst:e} above {bound:e}");
        for v in &state.particle.v {
            assert_relative_eq!(v[0], 8.0, max_relative = 1e-13);
        }
    }
}

/// At any other speed the stress of rigid motion is round-off: p_I and m_I are
/// sums of at most four rounded terms each, so a strain increment is below
/// 4 ε (v Δt/h).
#[test]
fn run_rigid_motion_at_any_speed_is_round_off() {
    for velocity in [7.3, -0.1, 123.456] {
        let end = 0.9 / f64::abs(velocity);
        let sets = [
            format!("initial_velocity.0.velocity={velocity}"),
            format!("time.end={end}"),
            "grid.beyond.left=12".to_string(),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let scene = scene(FREE_FLIGHT, &sets);
        let model = lme_mpm::setup::model::<1>(&scene);
        let mut state = lme_mpm::setup::initial_state(&model, &scene);
        march(&model, &mut state, model.steps);
        let per_step = 1e6 * f64::EPSILON * f64::abs(velocity) * model.dt / model.grid.h[0];
        let bound = 4.0 * per_step * model.steps as f64;
        let worst = state.particle.sigma.iter().fold(0.0, |worst: f64, s| worst.max(s[0].abs()));
        assert!(worst < bound, "v = {velocity}: stress {worst:e} above {bound:e}");
    }
}

/// The momentum of a free body stays to round-off.
#[test]
fn run_free_body_keeps_momentum() {
    let scene = dyka(&["boundary.left=free", "grid.beyond.left=2", "time.end=4e-4"]);
    let outcome = finished(&scene);
    let momentum = outcome.history.column("momentum").unwrap();
    let steps = outcome.cost.steps as f64;
    for p in &momentum {
        assert_relative_eq!(*p, momentum[0], max_relative = steps * f64::EPSILON);
    }
}

/// The mirrored bar does the mirrored thing.
#[test]
fn run_mirror_symmetry() {
    let here = finished(&dyka(&[]));
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
    ]));
    let of = |outcome: &lme_mpm::run::Outcome, name: &str| outcome.particles.column(name).unwrap();
    for (name, sign, scale) in
        [("velocity", -1.0, 5.0), ("stress", 1.0, 2e8), ("displacement", -1.0, 1e-4)]
    {
        let (right, mut left) = (of(&here, name), of(&there, name));
        left.reverse();
        for (a, b) in right.iter().zip(&left) {
            assert!((a - sign * b).abs() < 1e-11 * scale, "{name}: {a} and {b}");
        }
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
        let sets = [
            format!("body.length={:?}", 0.1333 * length),
            format!("body.density={:?}", 7833.0 * density),
            format!("body.youngs_modulus={:?}", 200e9 * stress),
            format!("time.end={:?}", 1.05521074812570e-4 * time),
            format!("initial_velocity.0.from={:?}", 0.099975 * length),
            format!("initial_velocity.0.to={:?}", 0.1333 * length),
            format!("initial_velocity.0.velocity={:?}", 5.0 * velocity),
            format!("probe.0.position={:?}", 0.1333 * length),
            format!("probe.1.position={:?}", 0.099975 * length),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let there = finished(&dyka(&sets));
        for (name, unit) in [
            ("velocity_end", velocity),
            ("stress_three_quarter", stress),
            ("t", time),
            ("momentum", mass * velocity),
            ("kinetic_energy", mass * velocity * velocity),
        ] {
            let (one, other) =
                (here.history.column(name).unwrap(), there.history.column(name).unwrap());
            let scaled: Vec<f64> = one.iter().map(|x| x * unit).collect();
            assert_eq!(scaled, other, "{name} with units 2^({a}, {b}, {c})");
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
    let sets = [
        format!("body.origin={shift:?}"),
        format!("initial_velocity.0.from={:?}", shift + 0.099975),
        format!("initial_velocity.0.to={:?}", shift + 0.1333),
        format!("probe.0.position={:?}", shift + 0.1333),
        format!("probe.1.position={:?}", shift + 0.09),
    ];
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let there = finished(&dyka(&sets));
    for name in ["velocity_end", "kinetic_energy", "strain_energy", "momentum"] {
        assert_eq!(here.history.column(name), there.history.column(name), "{name}");
    }
    for name in ["velocity", "stress", "displacement"] {
        assert_eq!(here.particles.column(name), there.particles.column(name), "{name}");
    }
}

/// Exponentials and Newton iterations are counted where there are some, and λ
/// is carried only by the basis that needs it.
#[test]
fn run_cost_of_local_max_ent() {
    for gamma in ["0.8", "1.8", "4"] {
        let gamma = format!("basis.gamma={gamma}");
        let cost = finished(&dyka(&["basis.kind=lme", &gamma])).cost;
        let warm = cost.newton_iterations as f64 / cost.basis_evaluations as f64;
        assert!(warm < 3.0, "{gamma}: {warm} iterations per particle and step");
    }
    let cost = finished(&dyka(&["basis.kind=lme", "basis.gamma=0.8"])).cost;
    assert!(cost.newton_iterations >= cost.basis_evaluations);
    // One for each axis and iteration, and the table of exp(−γk²).
    assert!(cost.exponentials >= cost.basis_evaluations);
    assert!(cost.exponentials < cost.particle_node_pairs);
    assert_eq!(cost.bytes_per_particle, 48 + 8);
    for kind in ["linear", "ugimp", "bspline"] {
        let cost = finished(&dyka(&[&format!("basis.kind={kind}")])).cost;
        assert_eq!((cost.exponentials, cost.newton_iterations), (0, 0), "{kind}");
        assert_eq!(cost.bytes_per_particle, 48, "{kind}");
    }
}

/// What a scene does not declare is not computed, and what is computed is
/// counted: one table per step and one at the start, 2^D pairs per particle.
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
        assert_eq!(cost.exponentials, 0);
        assert_eq!(cost.newton_iterations, 0);
        let d = dimension as u64;
        assert_eq!(cost.bytes_per_particle, 8 * (2 + 2 * d + 2 * d * d));
    }
    assert_eq!(Particles::<1>::BYTES, 48);
}
