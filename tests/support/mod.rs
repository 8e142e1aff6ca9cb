//! What several tests share: scenes with changes, runs, and orders.

pub mod kit;
pub mod program;

use lme_mpm::continuum::state::State;
use lme_mpm::cost::Cost;
use lme_mpm::fault::Moment;
use lme_mpm::measure::observed_order;
use lme_mpm::model::Model;
use lme_mpm::run::{Outcome, run};
use lme_mpm::scene::{DYKA, Scene};
use lme_mpm::time;
use proptest::test_runner::{Config as ProptestConfig, RngSeed};

pub const FREE_FLIGHT: &str = include_str!("../../data/scenes/free-flight.toml");
pub const VIBRATION: &str = include_str!("../../data/scenes/vibration.toml");
pub const GRAVITY: &str = include_str!("../../data/scenes/gravity.toml");
pub const TRACTION: &str = include_str!("../../data/scenes/traction.toml");
pub const MANUFACTURED: &str = include_str!("../../data/scenes/manufactured.toml");
pub const DYKA_OTM: &str = include_str!("../../data/scenes/dyka-otm.toml");
pub const DISCS: &str = include_str!("../../data/scenes/colliding-discs.toml");

/// L/c of the Dyka bar [s], from c = √(E/ρ).
pub fn transit() -> f64 {
    0.1333 / (200e9_f64 / 7833.0).sqrt()
}

/// A scene from `text` with the changes `KEY=VALUE`.
pub fn scene(text: &str, sets: &[&str]) -> Scene {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    Scene::parse("test", "test.toml", text, &sets).unwrap_or_else(|error| panic!("{error}"))
}

/// The Dyka bar with the changes `KEY=VALUE`.
pub fn dyka(sets: &[&str]) -> Scene {
    scene(DYKA, sets)
}

/// Runs a scene to its end.
pub fn finished(scene: &Scene) -> Outcome {
    run(scene, &mut |_| {}).unwrap_or_else(|stopped| panic!("{}", stopped.breakdown))
}

/// One line of a run's summary.
pub fn value(scene: &Scene, outcome: &Outcome, quantity: &str) -> f64 {
    let lines = lme_mpm::summary::lines(scene, outcome, 0.0);
    lines.iter().find(|line| line.quantity == quantity).unwrap().value
}

/// Takes `steps` steps of `model` from `state`, which has not been started.
pub fn march<const D: usize>(model: &Model<D>, state: &mut State<D>, steps: usize) -> Cost {
    let mut cost = Cost::default();
    time::start(state, model, &mut cost).unwrap();
    for step in 1..=steps {
        let moment = Moment { step, time: step as f64 * model.dt };
        time::advance(state, model, moment, &mut cost).unwrap();
    }
    cost
}

/// The exponent of error ∝ h^slope by least squares on logarithms.
pub fn slope(h: &[f64], error: &[f64]) -> f64 {
    observed_order(h, error).slope
}

/// Compares a text with `snapshots/NAME.snap`.
pub fn approve(name: &str, text: &str) {
    settings().bind(|| insta::assert_snapshot!(name, text));
}

/// Compares a picture with `snapshots/NAME.snap.svg`.
pub fn approve_picture(name: &str, svg: String) {
    let file = format!("{name}.svg");
    settings().bind(|| insta::assert_binary_snapshot!(&file, svg.into_bytes()));
}

/// Insta with the project's snapshot directory, and names that are claims.
fn settings() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
}

/// FNV-1a over the bits of every number: one changed bit changes it.
pub fn digest(column: &[f64]) -> u64 {
    let bytes = column.iter().flat_map(|x| x.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// u and v of all particles of the bar at t = L/c, from v = v0 sin(πx/2L), on 160
/// cells with `steps` time steps.
pub fn smooth_run(sets: &[&str], steps: usize) -> (Vec<f64>, Vec<f64>) {
    let scene = dyka(&[sets, &["grid.cells=160"]].concat());
    let mut model = Model::<1>::of(&scene);
    model.dt = transit() / steps as f64;
    let mut state = model.initial_state(&scene);
    let start: Vec<f64> = state.particle.x.iter().map(|x| x[0]).collect();
    for (v, x) in state.particle.v.iter_mut().zip(&start) {
        v[0] = 0.1 * (std::f64::consts::FRAC_PI_2 * x / 0.1333).sin();
    }
    march(&model, &mut state, steps);
    let u = state.particle.x.iter().zip(&start).map(|(x, start)| x[0] - start).collect();
    (u, state.particle.v.iter().map(|v| v[0]).collect())
}

/// Every basis of the bar, with its name in tables.
pub const BASES: [(&str, &[&str]); 6] = [
    ("linear", &[]),
    ("ugimp", &["basis.kind=ugimp"]),
    ("bspline", &["basis.kind=bspline"]),
    ("lme γ = 0.8", &["basis.kind=lme", "basis.gamma=0.8"]),
    ("lme γ = 1.8", &["basis.kind=lme", "basis.gamma=1.8"]),
    ("lme γ = 4", &["basis.kind=lme", "basis.gamma=4"]),
];

/// Every scheme with its variants, with its name in snapshots and tables.
pub const SCHEMES: [(&str, &[&str]); 7] = [
    ("newmark", &["time.integrator=newmark"]),
    ("newmark as printed", &["time.integrator=newmark", "time.reading=as-printed"]),
    ("euler (first)", &["time.integrator=forward-euler", "time.stress_update=first"]),
    ("euler (last)", &["time.integrator=forward-euler", "time.stress_update=last"]),
    (
        "euler (modified last)",
        &["time.integrator=forward-euler", "time.stress_update=modified-last"],
    ),
    ("corrected euler", &["time.integrator=corrected-euler"]),
    ("generalized-α (0.8)", &["time.integrator=generalized-alpha", "time.rho_b=0.8"]),
];

/// Random cases, the same ones in every run.
pub fn same_every_time(cases: u32) -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(31);
    ProptestConfig { cases, failure_persistence: None, rng_seed, ..ProptestConfig::default() }
}

/// A square or cubic block, free on all sides, with the changes of `sets`.
pub fn block(dimension: usize, sets: &[&str]) -> Scene {
    let list = |x: &str| format!("[{}]", vec![x; dimension].join(","));
    let text = format!(
        "title = 'block'\nmethod = 'otm'\nmass = 'lumped'\n\
         basis = {{ kind = 'lme', gamma = 1.8 }}\n\
         body = {{ length = {}, density = 1000, youngs_modulus = 1e6, poisson_ratio = 0.3 }}\n\
         grid = {{ cells = {}, particles_per_cell = {} }}\n\
         time = {{ integrator = 'newmark', cfl = 0.4, end = 0.05 }}\n",
        list("1"),
        list(if dimension == 3 { "3" } else { "5" }),
        list("1"),
    );
    scene(&text, sets)
}
