//! What several tests share: scenes with changes, runs, tables, and orders.

pub mod kit;
pub mod program;

use lme_mpm::method::basis::scattered::{Places, fill_from_nodes};
use lme_mpm::method::basis::{Basis, Scratch, fill_from_grid};
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::cost::Cost;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::measure::observed_order;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time;
use lme_mpm::run::{Outcome, run};
use lme_mpm::scene::{DYKA, Scene};
use nalgebra::SVector;
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
    lme_mpm::run::parse("test", "test.toml", text, &sets).unwrap_or_else(|error| panic!("{error}"))
}

/// The Dyka bar with the changes `KEY=VALUE`.
pub fn dyka(sets: &[&str]) -> Scene {
    scene(DYKA, sets)
}

/// Runs a scene to its end.
pub fn finished(scene: &Scene) -> Outcome {
    run(scene, &mut |_| {}).unwrap_or_else(|stopped| panic!("{}", stopped.broken))
}

/// One line of a run's summary.
pub fn value(scene: &Scene, outcome: &Outcome, quantity: &str) -> f64 {
    let lines = lme_mpm::output::summary::lines(scene, outcome, 0.0);
    lines.iter().find(|line| line.quantity == quantity).unwrap().value
}

/// Takes `steps` steps of `model` from `state`, which has not been started.
pub fn march<const D: usize>(model: &Model<D>, state: &mut State<D>, steps: usize) {
    time::start(state, model, &mut |_, _| {}).unwrap();
    for step in 1..=steps {
        advance(model, state, step).unwrap();
    }
}

/// Takes time step number `step`.
pub fn advance<const D: usize>(
    model: &Model<D>,
    state: &mut State<D>,
    step: usize,
) -> Result<(), Breakdown> {
    time::advance(state, model, step as f64 * model.dt, &mut |_, _| {})
}

/// The table of points by themselves, their λ h, and what it has cost.
pub struct Tabulated<const D: usize> {
    pub shape: Shape<D>,
    pub lambda: Vec<SVector<f64, D>>,
    pub cost: Cost,
}

impl<const D: usize> Tabulated<D> {
    /// What the first point sees: node, N, ∇N.
    pub fn row(&self) -> Vec<(usize, f64, SVector<f64, D>)> {
        self.shape.of(0).map(|(I, N, grad)| (I, N, *grad)).collect()
    }
}

fn tabulated<const D: usize>(
    points: usize,
    fill: impl FnOnce(&mut Shape<D>, &mut Scratch<D>, &mut [SVector<f64, D>]) -> Result<(), Breakdown>,
) -> (Tabulated<D>, Result<(), Breakdown>) {
    let (mut shape, mut scratch) = (Shape::blank(0), Scratch::default());
    let mut lambda = vec![SVector::zeros(); points];
    let done = fill(&mut shape, &mut scratch, &mut lambda);
    let cost = shape.cost + scratch.cost();
    (Tabulated { shape, lambda, cost }, done)
}

/// The table of a basis on a grid at `x`.
pub fn on_grid<const D: usize>(
    basis: &Basis,
    grid: &Grid<D>,
    x: &[SVector<f64, D>],
) -> Result<Tabulated<D>, Breakdown> {
    let (table, done) = tabulated(x.len(), |shape, scratch, lambda| {
        fill_from_grid(shape, scratch, lambda, basis, grid, x)
    });
    done.map(|()| table)
}

/// The table of a basis on scattered nodes at `x`, as far as it got, and whether it did.
pub fn on_nodes<const D: usize>(
    basis: &Basis,
    h: &SVector<f64, D>,
    nodes: &[SVector<f64, D>],
    x: &[SVector<f64, D>],
) -> (Tabulated<D>, Result<(), Breakdown>) {
    tabulated(x.len(), |shape, scratch, lambda| {
        fill_from_nodes(shape, scratch, lambda, basis, Places { x: nodes, h }, x)
    })
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
    let mut model = lme_mpm::setup::model::<1>(&scene);
    model.dt = transit() / steps as f64;
    let mut state = lme_mpm::setup::initial_state(&model, &scene);
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
