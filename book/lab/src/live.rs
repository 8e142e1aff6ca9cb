//! A run that the page takes on in pieces, so that it never waits for long.

use crate::answer::Answer;
use crate::bar::Request;
use lme_mpm::method::breakdown::BrokenDown;
use lme_mpm::method::model::Model;
use lme_mpm::output::summary;
use lme_mpm::run::Course;
use lme_mpm::run::stability::{Critical, runnable};
use lme_mpm::run::table::Table;
use lme_mpm::scene::Scene;
use lme_mpm::setup;
use std::mem::ManuallyDrop;

/// A run under way, whatever its dimension.
pub trait Live {
    /// Takes `steps` time steps more, or as many as there are, and answers what is new: moments
    /// `t` (s), particles and rows of the history; at the end also the summary, or why it broke.
    fn go_on(&mut self, steps: usize) -> Answer;
}

/// Begins a run and answers its particles, nodes, steps and end (s), and its limits; the number
/// of the request is the largest number of moments.
pub fn begin(request: &Request) -> (Answer, Option<Box<dyn Live>>) {
    let mut scene = match request.parsed() {
        Ok(scene) => scene,
        Err(error) => return (Answer::error(error), None),
    };
    // Moments are kept here, with fewer columns than the program's own.
    scene.vtk = false;
    let mut answer = Answer::default();
    let (particles, nodes, steps) = scene.sizes();
    answer.numbers("sizes", [particles, nodes, steps, scene.time.end]);
    let limit = match runnable(&scene) {
        Ok(limit) => limit,
        Err(fault) => {
            answer.text("error", fault);
            return (answer, None);
        }
    };
    if let Some(limit) = &limit {
        answer.numbers("limit", crate::bar::limits(&scene, limit));
    }
    let every = (scene.step_count() as usize).div_ceil(request.whole().max(1));
    (answer, Some(live(scene, limit, every)))
}

/// Runs a scene for its history alone, and answers it also as the program's own file.
pub fn history(request: &Request) -> Answer {
    let mut scene = match request.parsed() {
        Ok(scene) => scene,
        Err(error) => return Answer::error(error),
    };
    scene.vtk = false;
    // Without a watch nobody needs the limit of a scene that may be above it.
    let limit = match scene.time.allow_unstable {
        true => Ok(None),
        false => runnable(&scene),
    };
    match limit {
        Ok(limit) => live(scene, limit, usize::MAX).go_on(usize::MAX),
        Err(fault) => Answer::error(fault),
    }
}

/// Makes a run that keeps a moment after `every` so many steps.
fn live(scene: Scene, limit: Option<Critical>, every: usize) -> Box<dyn Live> {
    match scene.dimension() {
        1 => Box::new(Run::<1>::new(scene, limit, every)),
        2 => Box::new(Run::<2>::new(scene, limit, every)),
        _ => Box::new(Run::<3>::new(scene, limit, every)),
    }
}

/// A run with the scene and the model that it borrows, which are given back after it.
struct Run<const D: usize> {
    course: ManuallyDrop<Course<'static, D>>,
    scene: *mut Scene,
    model: *mut Model<D>,
    limit: Option<Critical>,
    /// A moment is kept after so many steps.
    every: usize,
    /// Steps taken; none before the start.
    step: Option<usize>,
    /// Rows of the history that the page has.
    told: usize,
    finished: bool,
}

impl<const D: usize> Run<D> {
    fn new(scene: Scene, limit: Option<Critical>, every: usize) -> Self {
        let model = Box::into_raw(Box::new(setup::model::<D>(&scene)));
        let scene = Box::into_raw(Box::new(scene));
        // SAFETY: both live until `drop`, which lets the run go first.
        let course = ManuallyDrop::new(Course::new(unsafe { &*scene }, unsafe { &*model }));
        Run { course, scene, model, limit, every, step: None, told: 0, finished: false }
    }

    /// Takes up to `steps` steps and keeps the moments among them; true at the end.
    fn march(&mut self, steps: usize, seen: &mut Seen) -> Result<bool, BrokenDown> {
        if self.step.is_none() {
            self.course.start(self.limit.take())?;
            self.step = Some(0);
            seen.keep(0.0, self);
        }
        for _ in 0..steps {
            let Some(moment) = self.course.advance()? else { break };
            self.step = Some(moment.step);
            if moment.step.is_multiple_of(self.every) || self.course.is_at_end() {
                seen.keep(moment.time, self);
            }
        }
        Ok(self.course.is_at_end())
    }

    /// Adds the rows of the history that the page does not have yet.
    fn tell(&mut self, answer: &mut Answer, history: &Table) {
        answer.text("history.columns", history.columns.join("\n"));
        answer.numbers("history", history.rows().skip(self.told).flatten().copied());
        self.told = history.rows().count();
        // A history that is wanted alone is wanted as a file, too.
        if self.every == usize::MAX {
            match history.csv() {
                Ok(csv) => answer.part("csv", &csv),
                Err(fault) => answer.text("csv.error", fault),
            }
        }
    }

    /// Takes the run out, to be made into what has come of it.
    fn taken(&mut self) -> Course<'static, D> {
        self.finished = true;
        // SAFETY: it is taken once, for `finished` is set and asked for.
        unsafe { ManuallyDrop::take(&mut self.course) }
    }
}

/// The moments of one piece of a run.
#[derive(Default)]
struct Seen {
    t: Vec<f64>,
    particles: Vec<f64>,
}

impl Seen {
    /// Keeps the particles at `t`: for each its place (m), its displacement (m) with the axes of a
    /// plane, v (m/s), and the first component of σ (Pa).
    fn keep<const D: usize>(&mut self, t: f64, run: &Run<D>) {
        self.t.push(t);
        // SAFETY: the scene lives as long as the run.
        let origin = unsafe { &(*run.scene).body.origin };
        let particle = &run.course.state.particle;
        for p in 0..particle.len() {
            self.particles.extend((0..D).map(|i| origin[i] + particle.x[p][i]));
            self.particles.extend(particle.u[p].iter());
            self.particles.extend(particle.v[p].iter());
            self.particles.push(particle.sigma[p][(0, 0)]);
        }
    }
}

impl<const D: usize> Live for Run<D> {
    fn go_on(&mut self, steps: usize) -> Answer {
        let mut answer = Answer::default();
        if self.finished {
            return Answer::error("the run is over");
        }
        let mut seen = Seen::default();
        let done = self.march(steps, &mut seen);
        answer.numbers("step", [self.step.unwrap_or(0) as f64]);
        answer.numbers("t", seen.t);
        answer.numbers("particles", seen.particles);
        match done {
            Ok(false) => {
                let history = self.course.history().clone();
                self.tell(&mut answer, &history);
            }
            Ok(true) => {
                let outcome = self.taken().outcome();
                self.tell(&mut answer, &outcome.history);
                // SAFETY: as in `keep`.
                summarize(&mut answer, unsafe { &*self.scene }, &outcome);
                answer.text("done", "");
            }
            Err(broken) => {
                let stopped = self.taken().stopped(broken);
                self.tell(&mut answer, &stopped.history);
                answer.text("broken", stopped.broken);
                answer.text("done", "");
            }
        }
        answer
    }
}

/// Adds the summary of a run and its warnings.
fn summarize(answer: &mut Answer, scene: &Scene, outcome: &lme_mpm::run::Outcome) {
    let mut lines = summary::lines(scene, outcome, 0.0);
    lines.retain(|line| line.quantity != "wall_time");
    lines.extend(summary::cost_lines(&outcome.cost));
    let names: Vec<&str> = lines.iter().map(|line| line.quantity.as_str()).collect();
    answer.text("summary.names", names.join("\n"));
    answer.numbers("summary", lines.iter().map(|line| line.value));
    let warnings: Vec<String> = outcome.warnings.iter().map(ToString::to_string).collect();
    answer.text("warnings", warnings.join("\n"));
}

impl<const D: usize> Drop for Run<D> {
    fn drop(&mut self) {
        // SAFETY: what borrows goes first, and all three are given back once.
        unsafe {
            if !self.finished {
                ManuallyDrop::drop(&mut self.course);
            }
            drop(Box::from_raw(self.model));
            drop(Box::from_raw(self.scene));
        }
    }
}
