//! What several tests share: runs, tables of shape functions, errors and orders, snapshots.

mod cases;
mod crossing;
pub mod figures;
pub mod kit;
pub mod lines;
pub mod program;
mod reference;
mod scenes;
pub mod sketch;

pub use cases::*;
pub use crossing::*;
pub use reference::*;
pub use scenes::*;

use lme_mpm::method::basis::scattered::{Places, fill_from_nodes};
use lme_mpm::method::basis::{Basis, Extents, Scratch, fill_from_grid};
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::Multiplier;
use lme_mpm::method::cost::Cost;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::measure::{Order, observed_order};
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time;
use lme_mpm::output::summary;
use lme_mpm::run::table::Table;
use lme_mpm::run::{Outcome, Stopped, run};
use lme_mpm::scene::Scene;
use lme_mpm::setup;
use nalgebra::SVector;
use proptest::test_runner::{Config as ProptestConfig, RngSeed};

/// Runs a scene to its end.
pub fn finished(scene: &Scene) -> Outcome {
    run(scene, &mut |_| {}).unwrap_or_else(|stopped| panic!("{}", stopped.broken))
}

/// Runs a scene; a result must be free of NaN, a breakdown must have a name and a
/// history without NaN.
pub fn outcome(scene: &Scene) -> Result<Outcome, Box<Stopped>> {
    let result = run(scene, &mut |_| {});
    let (history, particles) = match &result {
        Ok(outcome) => (&outcome.history, Some(&outcome.particles)),
        Err(stopped) => {
            assert!(stopped.broken.breakdown.to_string().len() > 30);
            (&stopped.history, None)
        }
    };
    let tables = std::iter::once(history).chain(particles);
    for table in tables {
        assert!(table.rows().all(|row| row.iter().all(|x| x.is_finite())), "NaN in a table");
    }
    result
}

/// One line of a run's summary.
pub fn value(scene: &Scene, outcome: &Outcome, quantity: &str) -> f64 {
    let lines = summary::lines(scene, outcome, 0.0);
    lines.iter().find(|line| line.quantity == quantity).unwrap().value
}

/// A column of a table, which has it.
pub fn column(table: &Table, name: &str) -> Vec<f64> {
    table.column(name).unwrap_or_else(|| panic!("no column `{name}`"))
}

/// One of a kind for each of v, σ and u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Each<T> {
    pub v: T,
    pub sigma: T,
    pub u: T,
}

/// The relative errors that the bar is judged by: v at L, σ at 3L/4 and the field of u.
pub fn bar_errors(scene: &Scene, outcome: &Outcome) -> Each<f64> {
    let of = |place: &str| value(scene, outcome, &format!("{place}_rms_relative"));
    Each { v: of("velocity_end"), sigma: of("stress_three_quarter"), u: of("displacement_field") }
}

/// The relative errors of the fields of v, σ and u at the end of a run.
pub fn field_errors(scene: &Scene, outcome: &Outcome) -> Each<f64> {
    let of = |field: &str| value(scene, outcome, &format!("{field}_field_rms_relative"));
    Each { v: of("velocity"), sigma: of("stress"), u: of("displacement") }
}

/// The observed order of each error in `h`, one entry of `errors` to one of `h`.
pub fn orders(h: &[f64], errors: &[Each<f64>]) -> Each<Order> {
    let of = |pick: fn(&Each<f64>) -> f64| {
        observed_order(h, &errors.iter().map(pick).collect::<Vec<_>>())
    };
    Each { v: of(|error| error.v), sigma: of(|error| error.sigma), u: of(|error| error.u) }
}

/// Whether theory's order lies in the 95% interval of the observed one.
pub fn agrees(observed: &Order, theory: f64) -> bool {
    (observed.slope - theory).abs() <= observed.half_width
}

/// The largest absolute value; not a number if one of them is none.
pub fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let larger = |a: f64, b: f64| if a.is_nan() || b.abs() <= a { a } else { b.abs() };
    numbers.into_iter().fold(0.0, larger)
}

/// The largest distance between the numbers of two lists, which are as long.
pub fn apart(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    largest(one.iter().zip(other).map(|(a, b)| a - b))
}

/// Kinetic and strain energy together, row by row of a history (J).
pub fn total_energy(history: &Table) -> Vec<f64> {
    let (kinetic, strain) = (column(history, "kinetic_energy"), column(history, "strain_energy"));
    kinetic.iter().zip(&strain).map(|(a, b)| a + b).collect()
}

/// The mean over the first tenth of a list and over the last.
pub fn means_of_tenths(list: &[f64]) -> (f64, f64) {
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let tenth = list.len() / 10;
    (mean(&list[..tenth]), mean(&list[list.len() - tenth..]))
}

/// Nodes that a particle sees in the mean.
pub fn pairs_per_particle(cost: &Cost) -> f64 {
    cost.particle_node_pairs as f64 / cost.basis_evaluations as f64
}

/// A scene's model and its state at t = 0, which has not been started.
pub fn at_start<const D: usize>(scene: &Scene) -> (Model<D>, State<D>) {
    let model = setup::model::<D>(scene);
    let state = setup::initial_state(&model, scene);
    (model, state)
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
        self.shape.of(0).collect()
    }
}

fn tabulated<const D: usize>(
    points: usize,
    fill: impl FnOnce(&mut Shape<D>, &mut Scratch<D>, &mut [Multiplier<D>]) -> Result<(), Breakdown>,
) -> (Tabulated<D>, Result<(), Breakdown>) {
    let (mut shape, mut scratch) = (Shape::blank(0), Scratch::default());
    let mut known = vec![Multiplier::default(); points];
    let done = fill(&mut shape, &mut scratch, &mut known);
    let lambda = known.iter().map(|known| known.lambda).collect();
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
        fill_from_grid(shape, scratch, lambda, basis, grid, Extents::unstretched(x))
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

/// Random cases, the same ones in every run.
pub fn same_every_time(cases: u32) -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(31);
    ProptestConfig { cases, failure_persistence: None, rng_seed, ..ProptestConfig::default() }
}
