//! What is measured: the same body for every basis in 1D to 3D, and the steps of the Algorithm
//! by themselves.

use lme_mpm::method::model::{Model, State};
use lme_mpm::method::reading::StepEight;
use lme_mpm::method::time::{self, newmark};
use lme_mpm::scene::Scene;
use lme_mpm::{run, setup};

/// A case is a basis, as a scene sets it.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub name: &'static str,
    pub sets: &'static [&'static str],
}

/// Every basis; local max-ent wide and narrow.
pub const CASES: [Case; 5] = [
    Case { name: "linear", sets: &["basis.kind=linear"] },
    Case { name: "ugimp", sets: &["basis.kind=ugimp"] },
    Case { name: "bspline", sets: &["basis.kind=bspline"] },
    Case { name: "lme 0.8", sets: &["basis.kind=lme", "basis.gamma=0.8"] },
    Case { name: "lme 3", sets: &["basis.kind=lme", "basis.gamma=3"] },
];

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// A block of cells of size 1, free on all sides, with two particles along each axis of a cell;
/// half of it is thrown against the other.
pub fn scene<const D: usize>(case: Case) -> Scene {
    let list = |entries: [&str; D]| format!("[{}]", entries.join(","));
    let cells = list(std::array::from_fn(|_| ["400", "20", "8"][D - 1]));
    let first = |x: &'static str| list(std::array::from_fn(|d| if d == 0 { x } else { "0" }));
    let half = ["200", "10", "4"][D - 1];
    let text = format!(
        "title = 'block'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
         body = {{ length = {cells}, density = 1, youngs_modulus = 1, poisson_ratio = 0.3 }}\n\
         grid = {{ cells = {cells}, particles_per_cell = {} }}\n\
         time = {{ integrator = 'newmark', cfl = 0.2, end = 1000 }}\n\
         [[initial_velocity]]\nfrom = {}\nto = {cells}\nvelocity = {}\n",
        list(["2"; D]),
        first(half),
        first("-1e-3"),
    );
    let sets: Vec<String> = case.sets.iter().map(|set| set.to_string()).collect();
    run::parse("block", "block.toml", &text, &sets).unwrap_or_else(|fault| panic!("{fault}"))
}

/// The block after ten steps: every array has its size, and every particle has moved.
pub fn warm<const D: usize>(scene: &Scene) -> (Model<D>, State<D>) {
    let model = setup::model::<D>(scene);
    let mut state = setup::initial_state(&model, scene);
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    for step in 1..=10 {
        advance(&model, &mut state, step);
    }
    (model, state)
}

/// Takes a whole time step.
pub fn advance<const D: usize>(model: &Model<D>, state: &mut State<D>, step: usize) {
    time::advance(state, model, step as f64 * model.dt, &mut |_, _| {}).unwrap();
}

/// Takes step `n` of the Algorithm with Δt = 0: all of its work, and nothing changes but for the
/// sums at the nodes, which grow.
pub fn one_step<const D: usize>(n: usize, model: &Model<D>, state: &mut State<D>) {
    newmark::step(n, state, model, StepEight::SecondOrder, 0.0, 0.0).unwrap();
}

/// What a table holds for each particle: nodes that it sees, and bytes.
pub fn pairs_and_bytes<const D: usize>(state: &State<D>) -> (f64, f64) {
    let particles = state.particle.len() as f64;
    (state.shape.len() as f64 / particles, state.shape.bytes() as f64 / particles)
}

// ANCHOR: bytes_moved
/// The bytes that a time step must at least read or write for each particle, if the nodes stay
/// in the cache: the row of the table, which is written once and read five times, and what each
/// step takes of the particle and leaves there, step by step.
pub fn bytes_moved<const D: usize>(model: &Model<D>, bytes_of_row: f64) -> f64 {
    let (vector, matrix) = ((8 * D) as f64, (8 * D * D) as f64);
    let multiplier = if model.basis.has_multiplier() { 3.0 * vector } else { 0.0 };
    let steps = [
        bytes_of_row + 5.0 * vector, // 1: a_p; x_p and v_p before and after
        bytes_of_row + vector + 2.0 * multiplier, // 2: x_p; λ_p before and after
        bytes_of_row + 8.0 + vector, // 3: m_p, v_p
        bytes_of_row + matrix,       // 5: Δε_p
        16.0 + 4.0 * matrix,         // 6: ρ_p and σ_p before and after, Δε_p twice
        bytes_of_row + 16.0 + matrix, // 7: m_p, ρ_p, σ_p
        bytes_of_row + 3.0 * vector, // 9: v_p before and after, a_p
        2.0 * vector + matrix + 8.0, // the watch for numbers that are none
    ];
    steps.iter().sum()
}
// ANCHOR_END: bytes_moved

/// The columns of the table of a whole time step.
pub const HEADER: &str = "basis,dimensions,nodes that a particle sees,bytes of its row,\
                          bytes moved,instructions\n";

/// A row of that table, but for the instructions: the same on every machine.
pub fn row<const D: usize>(n: usize) -> String {
    let (model, state) = warm::<D>(&scene::<D>(CASES[n]));
    let (pairs, bytes) = pairs_and_bytes(&state);
    format!("{},{D},{pairs:.1},{bytes:.0},{:.0}", CASES[n].name, bytes_moved(&model, bytes))
}
