//! What a page may ask about a scene.

use crate::answer::Answer;
use lme_mpm::method::basis::scattered::{Places, fill_from_nodes};
use lme_mpm::method::basis::{Extents, Scratch, fill_from_grid};
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::Multiplier;
use lme_mpm::output::summary;
use lme_mpm::run::stability::{Critical, critical, runnable};
use lme_mpm::run::table::Table;
use lme_mpm::run::{Frame, Stopped, parse, run_knowing};
use lme_mpm::scene::Scene;
use lme_mpm::setup;
use nalgebra::SVector;
use std::fmt::Display;
use std::ops::ControlFlow;

/// The exact fields are answered at so many places of the bar.
const SAMPLES: usize = 241;

/// A request names a scene and a number.
pub struct Request {
    number: usize,
    scene: String,
    sets: Vec<String>,
}

impl Request {
    /// Reads a request; the error says what it should have been.
    pub fn read(bytes: &[u8]) -> Result<Self, &'static str> {
        let text = std::str::from_utf8(bytes).map_err(|_| "the request is not UTF-8")?;
        let mut fields = text.split('\0');
        let number = fields.next().and_then(|number| number.parse().ok());
        match (number, fields.next()) {
            (Some(number), Some(scene)) => Ok(Request {
                number,
                scene: scene.to_string(),
                sets: fields.map(String::from).collect(),
            }),
            _ => Err("the request is not a number, a scene, and values for --set"),
        }
    }

    /// Makes the scene ready to run.
    fn parsed(&self) -> Result<Scene, impl Display + use<>> {
        parse("lab", "scene", &self.scene, &self.sets)
    }
}

/// Answers Δt (s), the Courant number, steps and particles, and the limits of the Courant number:
/// at the start, and over all offsets; infinite where there is none.
pub fn limit(request: &Request) -> Answer {
    let scene = match request.parsed() {
        Ok(scene) => scene,
        Err(error) => return Answer::error(error),
    };
    let mut answer = Answer::default();
    let (particles, nodes, steps) = scene.sizes();
    answer.numbers("sizes", [particles, nodes, steps]);
    answer.numbers("courant", [scene.courant_number()]);
    match critical(&scene) {
        Ok(limit) => answer.numbers("limit", limits(&scene, &limit)),
        Err(breakdown) => answer.text("error", breakdown),
    }
    answer
}

/// The limits of the Courant number, at the start and over all offsets.
fn limits(scene: &Scene, limit: &Critical) -> [f64; 2] {
    [limit.start, limit.used()].map(|dt| scene.courant_number_of(dt))
}

/// Runs a scene; the number of the request is the largest number of frames.
pub fn run(request: &Request) -> Answer {
    let mut scene = match request.parsed() {
        Ok(scene) => scene,
        Err(error) => return Answer::error(error),
    };
    let limit = match runnable(&scene) {
        Ok(limit) => limit,
        Err(fault) => return Answer::error(fault),
    };
    let most = request.number.max(1);
    scene.every = scene.every.max((scene.step_count() as usize).div_ceil(most));
    scene.vtk = true;
    let mut answer = Answer::default();
    let dt = scene.time.end / scene.step_count();
    if let Some(limit) = &limit {
        answer.numbers("limit", limits(&scene, limit));
    }
    match run_knowing(&scene, limit, &mut |_| ControlFlow::Continue(())) {
        Ok(outcome) => {
            answer.table("history", &outcome.history);
            frames(&mut answer, &scene, &outcome.frames);
            let mut lines = summary::lines(&scene, &outcome, 0.0);
            lines.retain(|line| line.quantity != "wall_time");
            lines.extend(limit.iter().flat_map(|limit| summary::limit_lines(limit, dt)));
            lines.extend(summary::cost_lines(&outcome.cost));
            let names: Vec<&str> = lines.iter().map(|line| line.quantity.as_str()).collect();
            answer.text("summary.names", names.join("\n"));
            answer.numbers("summary", lines.iter().map(|line| line.value));
            let warnings: Vec<String> = outcome.warnings.iter().map(ToString::to_string).collect();
            answer.text("warnings", warnings.join("\n"));
        }
        Err(stopped) => {
            let Stopped { broken, history, frames: seen } = *stopped;
            answer.table("history", &history);
            frames(&mut answer, &scene, &seen);
            answer.text("broken", broken);
        }
    }
    answer
}

/// Answers the particles at the recorded moments, and the exact fields of a bar there.
fn frames(answer: &mut Answer, scene: &Scene, frames: &[Frame]) {
    answer.numbers("t", frames.iter().map(|frame| frame.time));
    if let Some(first) = frames.first() {
        answer.text("particles.columns", first.particles.columns.join("\n"));
    }
    let rows = |frame: &Frame| frame.particles.rows().flatten().copied().collect::<Vec<f64>>();
    answer.numbers("particles", frames.iter().flat_map(rows));
    if scene.dimension() > 1 {
        return;
    }
    let Ok(exact) = setup::exact::<1>(scene) else { return };
    let length = scene.body.length[0];
    let mut fields = Vec::with_capacity(3 * SAMPLES * frames.len());
    for frame in frames {
        for n in 0..SAMPLES {
            let X = length * n as f64 / (SAMPLES - 1) as f64;
            let at = exact.along(X, frame.time);
            fields.extend([scene.body.origin[0] + X + at.displacement, at.velocity, at.stress]);
        }
    }
    answer.numbers("exact", fields);
}

/// Runs a scene for its history alone.
pub fn history(request: &Request) -> Answer {
    let scene = match request.parsed() {
        Ok(scene) => scene,
        Err(error) => return Answer::error(error),
    };
    // Without a watch nobody needs the limit of a scene that may be above it.
    let limit = match scene.time.allow_unstable {
        true => Ok(None),
        false => runnable(&scene),
    };
    let limit = match limit {
        Ok(limit) => limit,
        Err(fault) => return Answer::error(fault),
    };
    let mut answer = Answer::default();
    let history = match run_knowing(&scene, limit, &mut |_| ControlFlow::Continue(())) {
        Ok(outcome) => outcome.history,
        Err(stopped) => {
            answer.text("broken", stopped.broken);
            stopped.history
        }
    };
    answer.table("history", &history);
    csv(&mut answer, &history);
    answer
}

fn csv(answer: &mut Answer, history: &Table) {
    match history.csv() {
        Ok(csv) => answer.part("csv", &csv),
        Err(fault) => answer.text("csv.error", fault),
    }
}

/// Answers the places of the nodes (m), those asked for (m), and for each of these N_I (–) and
/// dN_I/dx (1/m) of all nodes.
pub fn shape(request: &Request) -> Answer {
    let scene = match request.parsed() {
        Ok(scene) if scene.dimension() == 1 => scene,
        Ok(_) => return Answer::error("shape functions are drawn along one axis"),
        Err(error) => return Answer::error(error),
    };
    let model = setup::model::<1>(&scene);
    let state = setup::initial_state(&model, &scene);
    let (length, places) = (scene.body.length[0], request.number.max(2));
    let at =
        |n: usize| if n + 1 == places { length } else { length * n as f64 / (places - 1) as f64 };
    let x: Vec<SVector<f64, 1>> = (0..places).map(|n| SVector::repeat(at(n))).collect();
    let (mut table, mut scratch) = (Shape::default(), Scratch::default());
    let mut lambda = vec![Multiplier::default(); places];
    let on_grid = !scene.method.moves_nodes();
    let nodes: Vec<SVector<f64, 1>> = match on_grid {
        true => (0..model.grid.nodes()).map(|I| model.grid.position(I)).collect(),
        false => state.node.x.clone(),
    };
    let extents = Extents::unstretched(&x);
    let done = if on_grid {
        fill_from_grid(&mut table, &mut scratch, &mut lambda, &model.basis, &model.grid, extents)
    } else {
        let among = Places { x: &nodes, h: &model.grid.h };
        fill_from_nodes(&mut table, &mut scratch, &mut lambda, &model.basis, among, &x)
    };
    if let Err(breakdown) = done {
        return Answer::error(breakdown);
    }
    let mut values = vec![[0.0; 2]; places * nodes.len()];
    for (I, n, N, grad) in table.pairs() {
        values[n * nodes.len() + I] = [N, grad[0]];
    }
    let mut answer = Answer::default();
    let origin = scene.body.origin[0];
    answer.numbers("nodes", nodes.iter().map(|x| origin + x[0]));
    answer.numbers("x", x.iter().map(|x| origin + x[0]));
    answer.numbers("N", values.iter().map(|value| value[0]));
    answer.numbers("slope", values.iter().map(|value| value[1]));
    answer
}
