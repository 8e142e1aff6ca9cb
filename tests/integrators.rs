//! The schemes against each other, against theory, and against another program.

use crate::support::*;
use lme_mpm::method::measure;
use lme_mpm::method::model::State;
use lme_mpm::method::time::generalized_alpha::Parameters;
use lme_mpm::method::time::steps;
use lme_mpm::output::summary::cost_lines;

/// v and σ of all particles after one step.
struct Instant {
    v: Vec<f64>,
    sigma: Vec<f64>,
}

/// The bar on 20 cells after each of 60 steps, thrown with `SLOW` so gently that the
/// particles stay in place to 1e-12 of a cell.
fn frozen(scheme: &Scheme) -> Vec<Instant> {
    let slow = format!("initial_velocity.0.velocity={SLOW:e}");
    let scene = dyka(&[scheme.sets, &["grid.cells=20", &slow]].concat());
    let (model, mut state) = at_start::<1>(&scene);
    march(&model, &mut state, 0);
    let mut history = Vec::new();
    for step in 1..=60 {
        advance(&model, &mut state, step).unwrap();
        let particle = &state.particle;
        history.push(Instant {
            v: particle.v.iter().map(|v| v[0]).collect(),
            sigma: particle.sigma.iter().map(|sigma| sigma[0]).collect(),
        });
    }
    history
}

const SLOW: f64 = 1e-9;

/// From σ = 0 and one velocity, Newmark, stress-first and modified-last are one
/// leapfrog, to 1e-10 over 60 steps. The stress is the same in every step. The velocity
/// of stress-first stands half a step later than Newmark's, which is the mean of two of
/// them; that of modified-last is stress-first's of the step before. Stress-last is
/// another scheme.
#[test]
fn integrators_are_one_leapfrog() {
    let [newmark, first, modified, last] =
        [NEWMARK, STRESS_FIRST, MODIFIED_LAST, STRESS_LAST].map(|scheme| frozen(&scheme));
    let plateau = SLOW * 4e7;
    let near = |a: &[f64], b: &[f64], scale: f64, what: &str| {
        let off = apart(a, b);
        assert!(off < 1e-10 * scale, "{what}: {off:e} of {scale:e}");
    };
    for k in 1..60 {
        near(&newmark[k].sigma, &first[k].sigma, plateau, "σ, stress first");
        near(&newmark[k].sigma, &modified[k].sigma, plateau, "σ, modified last");
        let both = first[k - 1].v.iter().zip(&first[k].v);
        let mean: Vec<f64> = both.map(|(a, b)| 0.5 * (a + b)).collect();
        near(&newmark[k].v, &mean, SLOW, "v, stress first");
        near(&modified[k].v, &first[k - 1].v, SLOW, "v, modified last");
    }
    assert!(apart(&last[59].sigma, &newmark[59].sigma) > 0.01 * plateau);
}

/// (22)-(23) with the momentum mapped anew is (20)-(21) with `modified-last`, on moving
/// particles too: the bar to its end, bit for bit.
#[test]
fn corrected_euler_is_modified_last() {
    let [modified, corrected] =
        [MODIFIED_LAST, CORRECTED_EULER].map(|scheme| finished(&dyka(scheme.sets)).particles);
    for name in ["velocity", "stress", "displacement"] {
        assert_eq!(column(&modified, name), column(&corrected, name), "{name}");
    }
}

/// When the strain is taken, where (21) is read as printed: the particles move with the nodes' old
/// velocity.
#[derive(Clone, Copy, PartialEq)]
enum Literal {
    /// Before the forces, from the old velocity.
    StrainFirst,
    /// At the end of the step, still from the old velocity; the forces have the old stress.
    AllOld,
}

/// The largest energy of the bar by a literal (21) in so many steps, over that of its start. The
/// bar is thrown so gently that its particles stay where they are.
fn energy_of_literal_21(reading: Literal, courant: f64, step_count: usize) -> f64 {
    let slow = format!("initial_velocity.0.velocity={SLOW:e}");
    let cfl = format!("time.cfl={courant}");
    let (model, mut state) = at_start::<1>(&dyka(&[STRESS_FIRST.sets, &[&slow, &cfl]].concat()));
    let energy = |state: &State<1>| {
        measure::kinetic_energy(&state.particle.carriers())
            + measure::strain_energy(&state.particle, &model.law)
    };
    let (start, dt) = (energy(&state), model.dt);
    let mut most: f64 = 1.0;
    for _ in 0..step_count {
        let State { particle, node, shape, mass, scratch, .. } = &mut state;
        steps::discard(node);
        steps::tabulate(shape, scratch, particle, &model).unwrap();
        steps::transfer(node, mass, particle, shape).unwrap();
        steps::impose_essential(node, mass, &model.fixed);
        if reading == Literal::StrainFirst {
            steps::strain_material(particle, node, shape, &model, dt).unwrap();
        }
        steps::balance_forces(node, particle, shape, &model, 0.0);
        steps::accelerate(node, mass);
        steps::move_with_nodes(particle, node, shape, dt); // the momentum is not advanced
        if reading == Literal::AllOld {
            steps::strain_material(particle, node, shape, &model, dt).unwrap();
        }
        most = most.max(energy(&state) / start);
    }
    most
}

/// (21) as printed does no harm by itself: with the strain taken before the forces the bar keeps
/// its energy to a tenth over 20 000 steps at c Δt/h = 0.5. What no time step survives is the old
/// velocity in the strain together with the old stress in the forces: an oscillator then gains
/// ω²Δt² of its energy in every step. In 4/CFL² steps that is one factor whatever the step, above
/// e at 0.02, with the same exponent to a quarter at 0.1 and to a half at 0.5.
#[test]
fn euler_with_the_old_velocity() {
    let kept = energy_of_literal_21(Literal::StrainFirst, 0.5, 20_000);
    assert!(kept < 1.1, "{kept}");
    let exponents = [0.5_f64, 0.1, 0.02].map(|courant| {
        let steps = (4.0 / (courant * courant)) as usize;
        energy_of_literal_21(Literal::AllOld, courant, steps).ln()
    });
    let [coarse, middle, fine] = exponents;
    assert!(fine > 1.0, "{exponents:?}");
    assert!(
        (middle / fine - 1.0).abs() < 0.25 && (coarse / fine - 1.0).abs() < 0.5,
        "{exponents:?}"
    );
}

/// The parameters of Hulbert and Chung at the ends of their range, ρ_b = 1 and 0, meet
/// the condition of second order, γ = 3/2 − α_m.
#[test]
fn generalized_alpha_parameters() {
    let Parameters { alpha_m, beta, gamma } = Parameters::new(1.0);
    assert_eq!((alpha_m, beta, gamma), (0.5, 0.5, 1.0));
    let Parameters { alpha_m, beta, gamma } = Parameters::new(0.0);
    assert_eq!((alpha_m, beta, gamma), (-1.0, 2.5, 2.5));
}

/// At Ω² = (1 + ρ_b)² (2 − ρ_b) the cubic of one oscillator,
/// (z − 1)² [(1 − α_m) z + α_m] + Ω² [1 − γ + γ z + (z − 1)(½ − β + β z)], is (1 − α_m)(z + ρ_b)³:
/// its three roots are one.
#[test]
fn generalized_alpha_roots_meet_at_minus_rho_b() {
    for rho_b in [0.0, 0.2, 0.5, 0.8, 1.0] {
        let Parameters { alpha_m, beta, gamma } = Parameters::new(rho_b);
        let omega_2 = (1.0 + rho_b) * (1.0 + rho_b) * (2.0 - rho_b);
        let of_z = [
            alpha_m + (0.5 - gamma + beta) * omega_2,
            1.0 - 3.0 * alpha_m + (0.5 + gamma - 2.0 * beta) * omega_2,
            3.0 * alpha_m - 2.0 + beta * omega_2,
        ];
        let wanted = [rho_b * rho_b * rho_b, 3.0 * rho_b * rho_b, 3.0 * rho_b];
        for (coefficient, wanted) in of_z.iter().zip(wanted) {
            let off = coefficient / (1.0 - alpha_m) - wanted;
            assert!(off.abs() < 1e-14, "{rho_b}: {off:e}");
        }
    }
}

/// The bar computed once more by a program that shares nothing with this one,
/// data/reference/bar.py: the errors of three schemes on two grids agree to ten digits.
#[test]
fn integrators_against_another_program() {
    let text = include_str!("../data/reference/bar.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut count = 0;
    for row in reader.records().map(Result::unwrap) {
        let scheme = SCHEMES.into_iter().find(|scheme| scheme.name == &row[0]).unwrap();
        let cells = format!("grid.cells={}", &row[1]);
        let scene = dyka(&[scheme.sets, &[&cells]].concat());
        let Each { v, sigma, .. } = bar_errors(&scene, &finished(&scene));
        for (here, there) in [(v, &row[2]), (sigma, &row[3])] {
            let there: f64 = there.parse().unwrap();
            assert!((here / there - 1.0).abs() < 1e-10, "{row:?}: {here}");
        }
        count += 1;
    }
    assert_eq!(count, 6);
}

/// Newmark's method and generalized-α carry an acceleration, eight bytes of a particle in 1D;
/// the others do not.
#[test]
fn integrators_carry_what_they_need() {
    for scheme in SCHEMES {
        let lines = cost_lines(&finished(&dyka(scheme.sets)).cost);
        let bytes = lines.iter().find(|line| line.quantity == "bytes_per_particle").unwrap().value;
        let expected = if scheme.carries_acceleration { 56.0 + 8.0 } else { 56.0 };
        assert_eq!(bytes, expected, "{}", scheme.name);
    }
}
