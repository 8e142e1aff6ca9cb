//! The schemes against each other, against theory, and against another program.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::time::generalized_alpha::Parameters;
use lme_mpm::output::summary::{cost_lines, lines};

/// v and σ of all particles after each of `steps` steps of the bar, thrown so
/// gently that the particles stay in place to 1e-12 of a cell.
fn frozen(sets: &[&str], steps: usize) -> Vec<(Vec<f64>, Vec<f64>)> {
    let scene = dyka(&[sets, &["initial_velocity.0.velocity=1e-9", "grid.cells=20"]].concat());
    let model = lme_mpm::setup::model::<1>(&scene);
    let mut state = lme_mpm::setup::initial_state(&model, &scene);
    march(&model, &mut state, 0);
    let mut history = Vec::new();
    for step in 1..=steps {
        advance(&model, &mut state, step).unwrap();
        let particle = &state.particle;
        history.push((
            particle.v.iter().map(|v| v[0]).collect(),
            particle.sigma.iter().map(|s| s[0]).collect(),
        ));
    }
    history
}

fn assert_close(a: &[f64], b: &[f64], scale: f64, what: &str) {
    let worst = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-10 * scale, "{what}: {worst:e} of {scale:e}");
}

/// From σ = 0 and one velocity, Newmark, stress-first and modified-last are one
/// leapfrog. The stress is the same in every step. The velocity of stress-first
/// stands half a step later than Newmark's, which is the mean of two of them;
/// that of modified-last is stress-first's of the step before.
#[test]
fn integrators_are_one_leapfrog() {
    let newmark = frozen(SCHEMES[0].1, 60);
    let first = frozen(SCHEMES[2].1, 60);
    let modified = frozen(SCHEMES[4].1, 60);
    let (v, stress) = (1e-9, 1e-9 * 4e7);
    for k in 1..60 {
        assert_close(&newmark[k].1, &first[k].1, stress, "σ, stress first");
        assert_close(&newmark[k].1, &modified[k].1, stress, "σ, modified last");
        let mean: Vec<f64> =
            first[k - 1].0.iter().zip(&first[k].0).map(|(a, b)| 0.5 * (a + b)).collect();
        assert_close(&newmark[k].0, &mean, v, "v, stress first");
        assert_close(&modified[k].0, &first[k - 1].0, v, "v, modified last");
    }
    // Stress-last is another scheme.
    let last = frozen(SCHEMES[3].1, 60);
    let apart = last[59].1.iter().zip(&newmark[59].1).map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f64::max) > 0.01 * stress);
}

/// (22)-(23) with the momentum mapped anew is (20)-(21) with `modified-last`,
/// to round-off, on moving particles too.
#[test]
fn corrected_euler_is_modified_last() {
    let run = |sets: &[&str]| finished(&dyka(sets)).particles;
    let (a, b) = (run(SCHEMES[4].1), run(SCHEMES[5].1));
    for (name, scale) in [("velocity", 5.0), ("stress", 2e8), ("displacement", 1e-4)] {
        let (a, b) = (a.column(name).unwrap(), b.column(name).unwrap());
        let worst = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-11 * scale, "{name}: {worst:e}");
    }
}

/// The parameters of Hulbert and Chung at the ends of their range, and the
/// condition of second order, γ = 3/2 − α_m.
#[test]
fn generalized_alpha_parameters() {
    let Parameters { alpha_m, beta, gamma } = Parameters::new(1.0);
    assert_eq!((alpha_m, beta, gamma), (0.5, 0.5, 1.0));
    let Parameters { alpha_m, beta, gamma } = Parameters::new(0.0);
    assert_eq!((alpha_m, beta, gamma), (-1.0, 2.5, 2.5));
}

/// The bar computed once more by a program that shares nothing with this one,
/// data/reference/bar.py: the errors of three schemes agree to ten digits.
#[test]
fn integrators_against_another_program() {
    let text = include_str!("../data/reference/bar.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut count = 0;
    for row in reader.records().map(Result::unwrap) {
        let (name, sets) = SCHEMES.iter().find(|(name, _)| *name == &row[0]).unwrap();
        let cells = format!("grid.cells={}", &row[1]);
        let scene = dyka(&[*sets, &[cells.as_str()]].concat());
        let lines = lines(&scene, &finished(&scene), 0.0);
        let value = |name: &str| lines.iter().find(|line| line.quantity == name).unwrap().value;
        for (quantity, at) in [("velocity_end", 2), ("stress_three_quarter", 3)] {
            let here = value(&format!("{quantity}_rms_relative"));
            let there: f64 = row[at].parse().unwrap();
            assert!((here / there - 1.0).abs() < 1e-10, "{name}, {quantity}: {here} {there}");
        }
        count += 1;
    }
    assert_eq!(count, 6);
}

/// Generalized-α carries an acceleration, the others do not.
#[test]
fn integrators_carry_what_they_need() {
    for (name, sets) in SCHEMES {
        let outcome = finished(&dyka(sets));
        let lines = cost_lines(&outcome.cost);
        let bytes = lines.iter().find(|l| l.quantity == "bytes_per_particle").unwrap().value;
        assert_relative_eq!(bytes, if name.starts_with("generalized") { 56.0 } else { 48.0 });
    }
}
