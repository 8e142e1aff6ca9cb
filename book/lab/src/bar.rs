//! What a page may ask about a scene.

use crate::answer::Answer;
use lme_mpm::method::basis::scattered::{Places, fill_from_nodes};
use lme_mpm::method::basis::{Extents, Scratch, fill_from_grid};
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::Multiplier;
use lme_mpm::method::exact::Exact;
use lme_mpm::run::parse;
use lme_mpm::run::stability::{Critical, critical};
use lme_mpm::scene::Scene;
use lme_mpm::setup;
use nalgebra::SVector;
use std::fmt::Display;

/// The exact fields are answered at so many places of the bar.
const SAMPLES: usize = 241;

/// A request names a scene and a number.
pub struct Request {
    pub number: f64,
    scene: String,
    sets: Vec<String>,
}

impl Request {
    /// Gives the number as a count.
    pub fn whole(&self) -> usize {
        self.number as usize
    }

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
    pub fn parsed(&self) -> Result<Scene, impl Display + use<>> {
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
pub fn limits(scene: &Scene, limit: &Critical) -> [f64; 2] {
    [limit.start, limit.used()].map(|dt| scene.courant_number_of(dt))
}

/// Answers the exact fields of a bar at as many moments as the request's number says, equally
/// spaced from the start to the end: x (m), v (m/s) and σ (Pa) of the places of [`SAMPLES`].
pub fn exact(request: &Request) -> Answer {
    fields(request, |scene| {
        let last = request.whole().max(2) - 1;
        (0..=last).map(|row| scene.time.end * row as f64 / last as f64).collect()
    })
}

/// Answers the exact fields of a bar at the moment (s) that is the request's number.
pub fn moment(request: &Request) -> Answer {
    fields(request, |_| vec![request.number])
}

/// Gives the scene of a bar and its exact solution, or the answer that says why there is none.
fn solved(request: &Request) -> Result<(Scene, Exact<1>), Answer> {
    let scene = request.parsed().map_err(Answer::error)?;
    if scene.dimension() != 1 {
        return Err(Answer::error("exact fields are drawn along one axis"));
    }
    let exact = setup::exact::<1>(&scene).map_err(Answer::error)?;
    Ok((scene, exact))
}

/// Answers the exact fields of a bar at these moments.
fn fields(request: &Request, moments: impl Fn(&Scene) -> Vec<f64>) -> Answer {
    let (scene, exact) = match solved(request) {
        Ok(both) => both,
        Err(answer) => return answer,
    };
    let (length, origin) = (scene.body.length[0], scene.body.origin[0]);
    let mut fields = Vec::new();
    for t in moments(&scene) {
        for n in 0..SAMPLES {
            let X = length * n as f64 / (SAMPLES - 1) as f64;
            let at = exact.along(X, t);
            fields.extend([origin + X + at.displacement, at.velocity, at.stress]);
        }
    }
    let mut answer = Answer::default();
    answer.numbers("exact", fields);
    answer
}

/// Answers what the exact solution is at one material point (m), the request's number, at
/// [`SAMPLES`] moments from the start to the end: t (s), v (m/s), σ (Pa) and u (m).
pub fn point(request: &Request) -> Answer {
    let (scene, exact) = match solved(request) {
        Ok(both) => both,
        Err(answer) => return answer,
    };
    let mut answer = Answer::default();
    let moments = 0..4 * SAMPLES;
    answer.numbers(
        "exact",
        moments.flat_map(|n| {
            let t = scene.time.end * n as f64 / (4 * SAMPLES - 1) as f64;
            let at = exact.along(request.number - scene.body.origin[0], t);
            [t, at.velocity, at.stress, at.displacement]
        }),
    );
    answer
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
    let (length, places) = (scene.body.length[0], request.whole().max(2));
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
