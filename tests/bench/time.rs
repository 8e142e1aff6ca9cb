//! How long things take on this machine: a time step for every basis in 1D to 3D, each step of
//! the Algorithm, the prediction of the largest stable time step, and the exact solution.
//!
//! `cargo bench --bench time` runs it; with a word, what has that word in its name. Items are
//! particles, of the exact solution points.

mod cases;

use cases::{CASES, Case, advance, one_step, scene, warm};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use lme_mpm::run::{self, stability};
use lme_mpm::scene::DYKA;
use lme_mpm::setup;

fn main() {
    divan::main();
}

/// A time step.
#[divan::bench(args = CASES, consts = [1, 2, 3])]
fn time_step<const D: usize>(bencher: Bencher, case: Case) {
    let (model, mut state) = warm::<D>(&scene::<D>(case));
    let mut step = 10;
    bencher.counter(ItemsCount::new(state.particle.len())).bench_local(|| {
        step += 1;
        advance(&model, &mut state, step);
    });
}

/// Each step of the Algorithm, in 2D, with the linear basis.
#[divan::bench(args = 1..=9)]
fn step_linear(bencher: Bencher, n: usize) {
    step(bencher, CASES[0], n);
}

/// Each step of the Algorithm, in 2D, with local max-ent, γ = 0.8.
#[divan::bench(args = 1..=9)]
fn step_lme(bencher: Bencher, n: usize) {
    step(bencher, CASES[3], n);
}

fn step(bencher: Bencher, case: Case, n: usize) {
    let (model, mut state) = warm::<2>(&scene::<2>(case));
    bencher
        .counter(ItemsCount::new(state.particle.len()))
        .bench_local(|| one_step(n, &model, &mut state));
}

/// The prediction of the largest stable time step.
#[divan::bench(args = CASES, consts = [1, 2])]
fn prediction<const D: usize>(bencher: Bencher, case: Case) {
    let scene = scene::<D>(case);
    bencher
        .counter(ItemsCount::new(scene.sizes().0 as usize))
        .bench(|| stability::predicted(black_box(&scene), 0.0));
}

/// The exact solution of the bar at a hundred places and ten times.
#[divan::bench]
fn exact_solution(bencher: Bencher) {
    let bar = run::parse("dyka", "dyka.toml", DYKA, &[]).unwrap_or_else(|fault| panic!("{fault}"));
    let exact = setup::exact::<1>(&bar).unwrap_or_else(|fault| panic!("{fault}"));
    let (length, end) = (bar.body.length[0], bar.time.end);
    bencher.counter(ItemsCount::new(1000_usize)).bench(|| {
        for n in 0..1000 {
            let (i, k) = ((n % 100) as f64, (n / 100) as f64);
            black_box(exact.along(i / 100.0 * length, k / 10.0 * end));
        }
    });
}
