//! The time loop carries a scene to its end: scene → state → step, step, … → history.

pub mod columns;
mod guards;
mod open;
mod outcome;
mod particles;
mod recorder;
pub mod stability;
pub mod table;
mod warning;

pub use open::{parse, parse_within};
pub use outcome::{Frame, Outcome, Stopped};
pub use warning::{Warning, Worst};

use crate::method::breakdown::{Breakdown, BrokenDown, Moment};
use crate::method::cost::Cost;
use crate::method::time;
use crate::scene::Scene;
use crate::setup;
use guards::Guards;
use recorder::Recorder;
use stability::Critical;
use std::ops::ControlFlow;

/// Runs a scene to its end; `progress` hears the number of every finished step.
///
/// A time step beyond the limit is run as well; the limit is known beforehand from
/// [`stability::critical`]. What grows is stopped by the watch, or blows up.
///
/// Errors: [`Stopped`] when the run breaks down.
pub fn run(scene: &Scene, progress: &mut dyn FnMut(usize)) -> Result<Outcome, Box<Stopped>> {
    let mut on = |step| {
        progress(step);
        ControlFlow::Continue(())
    };
    run_knowing(scene, None, &mut on)
}

/// Runs a scene of which the limit of Δt may be known, so that the watch need not predict it
/// again; `progress` hears the number of every finished step, and may break with the reason to
/// end the run there.
///
/// Errors: [`Stopped`] when the run breaks down, or `progress` ends it.
pub fn run_knowing(
    scene: &Scene,
    limit: Option<Critical>,
    progress: &mut dyn FnMut(usize) -> ControlFlow<Breakdown>,
) -> Result<Outcome, Box<Stopped>> {
    match scene.dimension() {
        1 => run_in::<1>(scene, limit, progress),
        2 => run_in::<2>(scene, limit, progress),
        _ => run_in::<3>(scene, limit, progress),
    }
}

fn run_in<const D: usize>(
    scene: &Scene,
    limit: Option<Critical>,
    progress: &mut dyn FnMut(usize) -> ControlFlow<Breakdown>,
) -> Result<Outcome, Box<Stopped>> {
    let model = setup::model::<D>(scene);
    let mut state = setup::initial_state(&model, scene);
    let (mut recorder, mut guards) = (Recorder::new(scene, &model, &state), None);
    let mut march = || -> Result<(), BrokenDown> {
        let start = Moment::START;
        time::start(&mut state, &model, &mut |_, _| {}).map_err(|what| what.at(start))?;
        let guards = guards.insert(Guards::new(scene, &model, &state, limit));
        let first = recorder.record(&state, start, guards.add_work(&state, start));
        first.map_err(|what| what.at(start))?;
        for step in 1..=model.steps {
            let moment = Moment::of(step, model.dt);
            time::advance(&mut state, &model, moment.time, &mut |_, _| {})
                .map(|()| guards.add_work(&state, moment))
                .and_then(|work| recorder.follow(&state, moment, work))
                .and_then(|()| guards.judge(&state, moment))
                .map_err(|what| what.at(moment))?;
            match progress(step) {
                ControlFlow::Break(why) if step < model.steps => return Err(why.at(moment)),
                _ => {}
            }
        }
        Ok(())
    };
    if let Err(broken) = march() {
        let Recorder { history, frames, .. } = recorder;
        return Err(Box::new(Stopped { broken, history, frames }));
    }
    let bytes_per_particle = model.bytes_per_particle() as u64;
    let limit_applications = guards.as_ref().map_or(0, Guards::limit_applications);
    Ok(Outcome {
        particles: recorder.particles(&state, Moment::of(model.steps, model.dt).time),
        frames: recorder.frames,
        history: recorder.history,
        growth: guards.as_ref().map_or(0.0, Guards::growth),
        warnings: guards.map_or(Vec::new(), |guards| guards.warnings()),
        cost: Cost { bytes_per_particle, limit_applications, ..state.cost() },
        dt: model.dt,
    })
}
