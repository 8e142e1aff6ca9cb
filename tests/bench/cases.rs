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

/// A block of many cells.
pub fn scene<const D: usize>(case: Case) -> Scene {
    let text = block::<D>([400, 20, 8][D - 1]);
    let sets: Vec<String> = case.sets.iter().map(|set| set.to_string()).collect();
    run::parse("block", "block.toml", &text, &sets).unwrap_or_else(|fault| panic!("{fault}"))
}

/// The scene of a block of `n` cells of size 1 along each axis, free on all sides, with two particles along each axis of a cell;
/// half of it is thrown against the other.
pub fn block<const D: usize>(n: usize) -> String {
    let list = |entries: [usize; D]| format!("{entries:?}");
    let cells = list([n; D]);
    let first = |x: String| {
        let entries: Vec<String> =
            (0..D).map(|d| if d == 0 { x.clone() } else { "0".to_string() }).collect();
        format!("[{}]", entries.join(","))
    };
    format!(
        "title = 'block'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
         body = {{ length = {cells}, density = 1, youngs_modulus = 1, poisson_ratio = 0.3 }}\n\
         grid = {{ cells = {cells}, particles_per_cell = {} }}\n\
         time = {{ integrator = 'newmark', cfl = 0.2, end = 1000 }}\n\
         [[initial_velocity]]\nfrom = {}\nto = {cells}\nvelocity = {}\n",
        list([2; D]),
        first((n / 2).to_string()),
        first("-1e-3".to_string()),
    )
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
