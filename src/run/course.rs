//! The course of a run can be taken on step by step.

use super::guards::Guards;
use super::outcome::{Outcome, Stopped};
use super::recorder::Recorder;
use super::stability::Critical;
use super::table::Table;
use crate::method::breakdown::{BrokenDown, Moment};
use crate::method::cost::Cost;
use crate::method::model::{Model, State};
use crate::method::time;
use crate::scene::Scene;
use crate::setup;

/// The course of a run has a state, what it has recorded so far, and what guards it.
pub struct Course<'a, const D: usize> {
    /// The state after the last finished step.
    pub state: State<D>,
    scene: &'a Scene,
    model: &'a Model<D>,
    recorder: Recorder<'a, D>,
    guards: Option<Guards<'a, D>>,
    /// Time steps finished.
    step: usize,
}

impl<'a, const D: usize> Course<'a, D> {
    /// Makes a run of `scene`, whose model is `model`, before its first step.
    pub fn new(scene: &'a Scene, model: &'a Model<D>) -> Self {
        let state = setup::initial_state(model, scene);
        let recorder = Recorder::new(scene, model, &state);
        Course { state, scene, model, recorder, guards: None, step: 0 }
    }

    /// Prepares the scheme and records the start; the limit of Δt may be known, so that the watch
    /// need not predict it again.
    ///
    /// Errors: [`BrokenDown`] in step 0.
    pub fn start(&mut self, limit: Option<Critical>) -> Result<(), BrokenDown> {
        let (state, model) = (&mut self.state, self.model);
        time::start(state, model, &mut |_, _| {}).map_err(|what| what.at(Moment::START))?;
        let guards = self.guards.insert(Guards::new(self.scene, model, state, limit));
        let work = guards.add_work(state, Moment::START);
        let recorded = self.recorder.record(state, Moment::START, work);
        recorded.map_err(|what| what.at(Moment::START))
    }

    /// Takes the next time step, records and guards it, and gives the moment at which it ends;
    /// nothing after the last.
    ///
    /// Errors: [`BrokenDown`] in this step.
    pub fn advance(&mut self) -> Result<Option<Moment>, BrokenDown> {
        if self.is_at_end() {
            return Ok(None);
        }
        let moment = Moment::of(self.step + 1, self.model.dt);
        let (state, recorder) = (&mut self.state, &mut self.recorder);
        time::advance(state, self.model, moment.time, &mut |_, _| {})
            .map(|()| self.guards.as_mut().and_then(|guards| guards.add_work(state, moment)))
            .and_then(|work| recorder.follow(state, moment, work))
            .and_then(|()| {
                self.guards.as_mut().map_or(Ok(()), |guards| guards.judge(state, moment))
            })
            .map_err(|what| what.at(moment))?;
        self.step += 1;
        Ok(Some(moment))
    }

    /// Tells whether the last time step is finished.
    pub fn is_at_end(&self) -> bool {
        self.step == self.model.steps
    }

    /// Gives the history so far.
    pub fn history(&self) -> &Table {
        &self.recorder.history
    }

    /// Gives what has come out of it.
    pub fn outcome(self) -> Outcome {
        let Course { state, model, recorder, guards, .. } = self;
        let bytes_per_particle = model.bytes_per_particle() as u64;
        let limit_applications = guards.as_ref().map_or(0, Guards::limit_applications);
        Outcome {
            particles: recorder.particles(&state, Moment::of(model.steps, model.dt).time),
            frames: recorder.frames,
            history: recorder.history,
            growth: guards.as_ref().map_or(0.0, Guards::growth),
            warnings: guards.map_or(Vec::new(), |guards| guards.warnings()),
            cost: Cost { bytes_per_particle, limit_applications, ..state.cost() },
            dt: model.dt,
        }
    }

    /// Gives what it has recorded until it broke down.
    pub fn stopped(self, broken: BrokenDown) -> Stopped {
        let Recorder { history, frames, .. } = self.recorder;
        Stopped { broken, history, frames }
    }
}
