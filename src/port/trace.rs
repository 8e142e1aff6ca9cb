//! Writes down every intermediate of the first steps of a run, in the paper's order: what a
//! port is held against.
//!
//! A trace observes the run's own steps: after each of them it writes down what that step
//! has made.

use crate::method::breakdown::{BrokenDown, Moment};
use crate::method::model::{Model, State};
use crate::method::time;
use crate::scene::Scene;
use crate::scene::fault::Fault;
use crate::setup;

pub use super::entry::{COLUMNS, Entry, PAIRS, SYMBOLS, TraceRecorder, csv, hex, number};

/// Checks that a trace of `steps` steps has an end in sight.
///
/// Errors: [`Fault::Argument`] for more steps than the scene has, or more numbers than
/// a trace may hold.
pub fn affordable(scene: &Scene, steps: usize) -> Result<(), Fault> {
    let (particles, nodes, all_steps) = scene.sizes();
    let refuse =
        |problem: String, allowed| Err(Fault::Argument { argument: "--steps", problem, allowed });
    if steps as f64 > all_steps {
        let problem = format!("{steps} steps, and the scene has {all_steps}");
        return refuse(problem, "a whole number up to the number of steps of the scene");
    }
    let d = scene.dimension() as f64;
    let of_particle = scene.pairs_per_particle() * (1.0 + d) + 4.0 * d + 3.0 * d * d + 1.0;
    let numbers = (steps as f64 + 1.0) * (particles * of_particle + nodes * (1.0 + 5.0 * d));
    if numbers > MOST_NUMBERS {
        let problem = format!("{steps} steps of this scene make {numbers:.0e} numbers");
        return refuse(problem, "so many steps that a trace has 30 million numbers at most");
    }
    Ok(())
}

/// So many numbers take some gigabytes.
const MOST_NUMBERS: f64 = 3e7;

/// Runs the first `steps` steps of a scene and returns everything that they made.
///
/// Errors: [`BrokenDown`].
pub fn trace(scene: &Scene, steps: usize) -> Result<Vec<Entry>, BrokenDown> {
    match scene.dimension() {
        1 => trace_in::<1>(scene, steps).map(|(entries, _)| entries),
        2 => trace_in::<2>(scene, steps).map(|(entries, _)| entries),
        _ => trace_in::<3>(scene, steps).map(|(entries, _)| entries),
    }
}

/// Does the same and returns the state at the end, too.
pub fn trace_in<const D: usize>(
    scene: &Scene,
    steps: usize,
) -> Result<(Vec<Entry>, State<D>), BrokenDown> {
    let model = setup::model::<D>(scene);
    let mut state = setup::initial_state(&model, scene);
    let mut recorder = TraceRecorder::default();
    recorder.given(scene, &state, &model);
    for k in 0..=steps {
        let moment = Moment::of(k, model.dt);
        let mut after = |n: usize, state: &State<D>| recorder.step(k, n, state, &model);
        let done = match k {
            0 => time::start(&mut state, &model, &mut after),
            _ => time::advance(&mut state, &model, moment.time, &mut after),
        };
        // A number that is none stands in the trace before the step that stumbles over it.
        recorder.finite().and(done).map_err(|what| what.at(moment))?;
    }
    Ok((recorder.entries, state))
}

impl TraceRecorder {
    /// Writes what step `n` of time step `k` has made of a state.
    pub fn step<const D: usize>(&mut self, k: usize, n: usize, state: &State<D>, model: &Model<D>) {
        let loads_at = match k {
            0 => 0.0,
            _ => time::time_of_loads(model.method, model.dt, Moment::of(k, model.dt).time),
        };
        self.at(k, n);
        let made = time::scheme::<D>(model.method).makes(model.kinematics);
        for symbol in made[n] {
            self.symbol(symbol, state, model, loads_at);
        }
    }
}
