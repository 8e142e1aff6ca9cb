//! One time step of a bar, seen after each of its steps.

use crate::answer::Answer;
use crate::bar::Request;
use lme_mpm::method::breakdown::{BrokenDown, Moment};
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time;
use lme_mpm::setup;

/// The particles and the nodes, by the names of the paper, and the table between them.
const PARTICLES: [&str; 6] = ["x_p", "v_p", "a_p", "rho_p", "sigma_p", "d_eps_p"];
const NODES: [&str; 5] = ["m_I", "p_I", "v_I", "f_I", "a_I"];

/// What has been seen, symbol by symbol and step after step.
#[derive(Default)]
struct Seen {
    particles: [Vec<f64>; 6],
    nodes: [Vec<f64>; 5],
    /// For each step the table: I, p, N_Ip, ∇N_Ip, pair after pair.
    tables: Vec<Vec<f64>>,
}

/// Answers time step k, the request's number: `dt` (s), the places of the nodes `x_I` (m), and for
/// each symbol its values before the time step and after each of its steps, all in one list;
/// `table` and the step's number are the pairs of particles and nodes after that step.
pub fn steps(request: &Request) -> Answer {
    let scene = match request.parsed() {
        Ok(scene) if scene.dimension() == 1 => scene,
        Ok(_) => return Answer::error("steps are shown of a bar"),
        Err(error) => return Answer::error(error),
    };
    let model = setup::model::<1>(&scene);
    let mut state = setup::initial_state(&model, &scene);
    let (mut answer, mut seen) = (Answer::default(), Seen::default());
    let k = request.whole().clamp(1, model.steps);
    if let Err(broken) = march(&model, &mut state, k, &mut seen) {
        answer.text("broken", broken);
    }
    answer.numbers("k", [k as f64, model.steps as f64]);
    answer.numbers("dt", [model.dt]);
    answer.numbers("x_I", (0..model.grid.nodes()).map(|I| model.grid.position(I)[0]));
    for (name, values) in PARTICLES.iter().zip(seen.particles) {
        answer.numbers(name, values);
    }
    for (name, values) in NODES.iter().zip(seen.nodes) {
        answer.numbers(name, values);
    }
    for (n, table) in seen.tables.into_iter().enumerate() {
        answer.numbers(&format!("table{n}"), table);
    }
    answer
}

/// Takes the time steps up to `k` and looks at the last of them.
fn march(
    model: &Model<1>,
    state: &mut State<1>,
    k: usize,
    seen: &mut Seen,
) -> Result<(), BrokenDown> {
    time::start(state, model, &mut |_, _| {}).map_err(|what| what.at(Moment::START))?;
    for step in 1..k {
        let moment = Moment::of(step, model.dt);
        let done = time::advance(state, model, moment.time, &mut |_, _| {});
        done.map_err(|what| what.at(moment))?;
    }
    seen.look(state);
    let moment = Moment::of(k, model.dt);
    time::advance(state, model, moment.time, &mut |_, state| seen.look(state))
        .map_err(|what| what.at(moment))
}

impl Seen {
    fn look(&mut self, state: &State<1>) {
        let State { particle, node, shape, .. } = state;
        for p in 0..particle.len() {
            let a_p = particle.a.get(p).map_or(0.0, |a| a[0]);
            let (sigma, d_eps) = (particle.sigma[p][(0, 0)], particle.d_eps[p][(0, 0)]);
            let values = [particle.x[p][0], particle.v[p][0], a_p, particle.rho[p], sigma, d_eps];
            for (list, value) in self.particles.iter_mut().zip(values) {
                list.push(value);
            }
        }
        for I in 0..node.m.len() {
            let values = [node.m[I], node.p[I][0], node.v[I][0], node.f[I][0], node.a[I][0]];
            for (list, value) in self.nodes.iter_mut().zip(values) {
                list.push(value);
            }
        }
        let pairs = shape.pairs();
        self.tables
            .push(pairs.flat_map(|(I, p, N, grad)| [I as f64, p as f64, N, grad[0]]).collect());
    }
}
