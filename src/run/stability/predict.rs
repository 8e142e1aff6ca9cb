//! The limit of Δt is predicted from where the particles stand, and from all places that they
//! may come to.

use super::lanczos::Tridiagonal;
use super::noise::noise;
use super::operator::Operator;
use crate::method::breakdown::Breakdown;
use crate::method::choice::{Mass, Method};
use crate::method::continuum::law::symmetric_part;
use crate::method::continuum::state::Particles;
use crate::method::grid::odometer;
use crate::method::model::{Model, State};
use crate::method::time::scheme::TripFactor;
use crate::method::time::{self, otm, steps};
use crate::scene::fault::Fault;
use crate::scene::{Motion, Scene};
use crate::setup;
use nalgebra::{SMatrix, SVector};

/// A particle that has just touched a new node switches it on. For GIMP and
/// B-splines that node then counts at once, however small its mass, so the limit
/// is also taken with all particles moved by this share of a cell.
const TOUCH: f64 = 1e-7;

/// Touches are drawn at random for so many particles together, and so often at most.
const DRAWN: usize = 1024;
const MOST_DRAWS: usize = 32;

/// The limit is found to this share of its square, and over many places to the next one.
const FINE: f64 = 1e-7;
const COARSE: f64 = 1e-5;

/// A scene moves if its particles may come so many cells away from where they start.
const MOVES: f64 = 0.25;

/// The body that is moved through a cell has so many cells along each of its axes: one to
/// three.
const CELLS: [usize; 3] = [12, 5, 3];

/// A particle on a node is put so far beside it, in these steps: further than round-off, and
/// less than a touch.
const BESIDE: f64 = 1e-9;

/// Along each direction the body is moved by this part of the distance between its particles,
/// in one to three dimensions, and so often at most.
const STEPS: [usize; 3] = [16, 16, 4];
const PLACES: usize = 32;

/// A Δt above this multiple of the predicted limit blows up for certain: the margin
/// is the prediction's own, and that of particles on their first way.
const CERTAIN: f64 = 1.002;

/// This is what is known of the limit of Δt before a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Critical {
    /// With the particles where they start (s).
    pub start: f64,
    /// The least one while they move through a cell (s); `None` for a scene that moves less
    /// than a quarter of a cell, and for OTM, whose nodes move along.
    pub over_offsets: Option<f64>,
}

impl Critical {
    /// Gives the limit (s) that `time.fraction_of_critical` is a part of.
    pub fn used(&self) -> f64 {
        self.over_offsets.unwrap_or(self.start)
    }
}

/// Predicts the limit of Δt of a scene; where its particles move, over all offsets. Infinite for
/// implicit schemes, and for reconstructed forces, whose limit is not predicted.
///
/// Errors: [`Breakdown`] of the first table, or of a singular mass matrix.
pub fn critical(scene: &Scene) -> Result<Critical, Breakdown> {
    if scene.method.needs().equilibrium || scene.reconstruction.is_some() {
        return Ok(Critical { start: f64::INFINITY, over_offsets: None });
    }
    let start = predicted(scene, 0.0)?;
    let moves = !scene.method.moves_nodes() && scene.travel() > MOVES;
    let over_offsets = if moves { Some(over_offsets(scene)?.min(start)) } else { None };
    Ok(Critical { start, over_offsets })
}

/// Gives the predicted limit of Δt; `None` where it cannot be predicted, and the scene
/// breaks down by its own name.
///
/// Errors: [`Fault::Unstable`] for a scene whose Δt is above that of its start, unless it
/// allows that.
pub fn runnable(scene: &Scene) -> Result<Option<Critical>, Fault> {
    let Ok(limit) = critical(scene) else {
        return Ok(None);
    };
    if scene.time.end / scene.sizes().2 <= limit.start * CERTAIN || scene.time.allow_unstable {
        return Ok(Some(limit));
    }
    Err(Fault::Unstable {
        courant: scene.courant_number(),
        largest: scene.courant_number_of(limit.used()),
        singular: scene.mass == Mass::Consistent && scene.grid.particles_per_cell.contains(&1),
    })
}

/// Finds the largest stable Δt (s) of a tabulated state with masses, by Lanczos's method.
/// Infinite for a body that nothing can strain, for implicit schemes, and for reconstructed forces,
/// whose limit is not predicted.
pub fn limit<const D: usize>(state: &mut State<D>, model: &Model<D>) -> f64 {
    limit_to(FINE, state, model)
}

fn limit_to<const D: usize>(tolerance: f64, state: &mut State<D>, model: &Model<D>) -> f64 {
    if model.reconstruction.is_some() {
        return f64::INFINITY;
    }
    let mut random = noise();
    let count = state.particle.len();
    let start = (0..count).map(|_| symmetric_part(&SMatrix::from_fn(|_, _| random()))).collect();
    let found = Tridiagonal::of(&mut Operator::new(state, model), start, tolerance);
    2.0 / libm::sqrt(found.largest)
}

/// Tabulates a state and gives its nodes their masses.
fn prepare<const D: usize>(state: &mut State<D>, model: &Model<D>) -> Result<(), Breakdown> {
    match model.method {
        Method::Otm(_) => otm::start(state, model),
        Method::Mpm(_) => {
            let State { particle, node, shape, mass, scratch, .. } = state;
            steps::tabulate(shape, scratch, particle, model)?;
            steps::transfer(node, mass, particle, shape)
        }
    }
}

/// Says where the particles of a state at k = 0 are moved to.
pub struct Offset<const D: usize> {
    /// All of them by so much (m).
    pub shift: SVector<f64, D>,
    /// Along such an axis what leaves the body at one side comes in at the other.
    pub rounds: [bool; D],
    /// Each of them by a touch more (m); empty for none.
    pub touch: Vec<SVector<f64, D>>,
}

impl<const D: usize> Offset<D> {
    /// Makes the offset by `part` of the distance between particles along each axis.
    pub fn of_spacing(scene: &Scene, model: &Model<D>, part: f64) -> Self {
        let per_cell = |d: usize| scene.grid.particles_per_cell[d] as f64;
        let shift = SVector::from_fn(|d, _| part * model.grid.h[d] / per_cell(d));
        Offset { shift, rounds: [false; D], touch: Vec::new() }
    }

    /// Moves the particles of a state.
    pub fn apply(&self, scene: &Scene, particle: &mut Particles<D>) {
        for (p, x) in particle.x.iter_mut().enumerate() {
            *x += self.shift;
            if let Some(touch) = self.touch.get(p) {
                *x += touch;
            }
            for d in (0..D).filter(|d| self.rounds[*d]) {
                let length = scene.body.length[d];
                x[d] -= libm::floor(x[d] / length) * length;
            }
        }
    }

    /// Makes the same offset with another touch.
    fn touching(&self, touch: Vec<SVector<f64, D>>) -> Self {
        Offset { shift: self.shift, rounds: self.rounds, touch }
    }
}

/// Makes a state at k = 0 with its particles moved, tabulated, with nodal masses.
fn moved<const D: usize>(
    scene: &Scene,
    model: &Model<D>,
    offset: &Offset<D>,
) -> Result<State<D>, Breakdown> {
    let mut state = setup::initial_state(model, scene);
    offset.apply(scene, &mut state.particle);
    prepare(&mut state, model)?;
    Ok(state)
}

/// Predicts the limit of Δt (s) of a scene at its start, with the particles moved
/// by `offset` of their own spacing along each axis.
///
/// Errors: [`Breakdown`] of the first table, or of a singular mass matrix.
pub fn predicted(scene: &Scene, offset: f64) -> Result<f64, Breakdown> {
    match scene.dimension() {
        1 => predicted_in::<1>(scene, offset),
        2 => predicted_in::<2>(scene, offset),
        _ => predicted_in::<3>(scene, offset),
    }
}

fn predicted_in<const D: usize>(scene: &Scene, offset: f64) -> Result<f64, Breakdown> {
    let model = setup::model::<D>(scene);
    least(FINE, scene, &model, &Offset::of_spacing(scene, &model, offset))
}

/// Finds the least limit (s) at a place and with the particles moved by a touch from there.
fn least<const D: usize>(
    tolerance: f64,
    scene: &Scene,
    model: &Model<D>,
    offset: &Offset<D>,
) -> Result<f64, Breakdown> {
    let mut state = moved(scene, model, offset)?;
    let mut least = limit_to(tolerance, &mut state, model);
    for touched in touches(scene, model, offset)? {
        // Outside the grid there is nothing to touch.
        if let Ok(mut state) = moved(scene, model, &touched) {
            least = least.min(limit_to(tolerance, &mut state, model));
        }
    }
    Ok(least)
}

// ANCHOR: touches
/// Lists the offsets that differ by a touch, along every axis and towards every corner, by
/// which a particle sees other nodes: of all particles alike, and of each by itself,
/// at random. There are none where a node counts the less, the less mass it has: but for GIMP
/// and B-splines, and with the leapfrogs and the lumped mass matrix.
///
/// What grows at a touched node depends on the particles around it. Many particles make all
/// their combinations at once, and few need several draws.
pub fn touches<const D: usize>(
    scene: &Scene,
    model: &Model<D>,
    offset: &Offset<D>,
) -> Result<Vec<Offset<D>>, Breakdown> {
    let filtered = time::scheme::<D>(model.method).factor(model.kinematics) == TripFactor::Filtered;
    let smooth =
        (filtered && model.mass == Mass::Lumped) || !model.basis.traits().switches_nodes_on;
    if smooth || model.method.moves_nodes() {
        return Ok(Vec::new());
    }
    let start = moved(scene, model, offset)?;
    let (here, count) = (seen(&start), start.particle.len());
    let sides: [Vec<f64>; D] = std::array::from_fn(|d| {
        let new = |side: &f64| {
            let touch = SVector::from_fn(|i, _| if i == d { side * model.grid.h[d] } else { 0.0 });
            let there = moved(scene, model, &offset.touching(vec![touch; count]));
            there.is_ok_and(|there| seen(&there) != here)
        };
        let mut sides = vec![0.0];
        sides.extend([-TOUCH, TOUCH].into_iter().filter(new));
        sides
    });
    let choices: [usize; D] = std::array::from_fn(|d| sides[d].len());
    let touch = |n: [usize; D]| SVector::from_fn(|d, _| sides[d][n[d]] * model.grid.h[d]);
    let alike = odometer(choices).skip(1).map(|n| vec![touch(n); count]);
    let mut list: Vec<Offset<D>> = alike.map(|touch| offset.touching(touch)).collect();
    if list.is_empty() {
        return Ok(list);
    }
    let mut random = noise();
    let mut any = |n: usize| ((0.5 + 0.5 * random()) * n as f64) as usize % n;
    for _ in 0..(DRAWN / count).clamp(1, MOST_DRAWS) {
        let one = (0..count).map(|_| touch(choices.map(&mut any))).collect();
        list.push(offset.touching(one));
    }
    Ok(list)
}

/// Lists the particle-node pairs whose N is not 0.
fn seen<const D: usize>(state: &State<D>) -> Vec<(usize, usize)> {
    let pairs = state.shape.pairs().filter(|(_, _, N_Ip, _)| *N_Ip > 0.0);
    pairs.map(|(I, p, ..)| (I, p)).collect()
}
// ANCHOR_END: touches

// ANCHOR: over_offsets
/// Finds the least limit of Δt (s) over all offsets: that of a small body like the scene's,
/// moved through a cell along every axis and every diagonal, so that its particles come to
/// stand on the nodes too, or rather beyond them by a little more than round-off.
///
/// The limit of stress-last and generalized-α with the linear basis falls to 0 when a free end
/// passes a node. Theirs is taken half a step beside.
///
/// Errors: [`Breakdown`] of a table, or of a mass matrix that is singular at some offset.
pub fn over_offsets(scene: &Scene) -> Result<f64, Breakdown> {
    let dimension = scene.dimension();
    let per_cell = &scene.grid.particles_per_cell;
    let steps = STEPS[dimension - 1];
    let most = per_cell.iter().max().map_or(1, |n| (steps * n).min(PLACES));
    let factor = time::scheme::<1>(scene.method).factor(scene.kinematics);
    let beside = if factor.fears_light_nodes(&scene.basis) { 0.5 } else { BESIDE };
    let mut least = f64::INFINITY;
    for direction in directions(dimension) {
        for n in 0..most {
            let place = n as f64 + beside;
            let offset = |d: usize| direction[d] * place / (steps * per_cell[d]) as f64;
            let offset: Vec<f64> = (0..dimension).map(offset).collect();
            least = least.min(at_offset(scene, &offset)?);
        }
    }
    Ok(least)
}

/// Lists the axes and diagonals, each once, as −1, 0 and 1 along each axis.
fn directions(dimension: usize) -> Vec<Vec<f64>> {
    let count = 3_usize.pow(dimension as u32);
    let entry = |n: usize, d: usize| (n / 3_usize.pow(d as u32) % 3) as f64 - 1.0;
    let all = (0..count).map(|n| (0..dimension).map(|d| entry(n, d)).collect::<Vec<f64>>());
    all.filter(|one| one.iter().find(|x| **x != 0.0).is_some_and(|x| *x > 0.0)).collect()
}

/// Finds the limit of Δt (s) of a small body like the scene's, moved by `offset` (cells along
/// each axis).
///
/// Between two fixed sides the body stays, and what its particles leave others fill: they go
/// round. Elsewhere it moves as a whole.
pub fn at_offset(scene: &Scene, offset: &[f64]) -> Result<f64, Breakdown> {
    match scene.dimension() {
        1 => at_offset_in::<1>(scene, offset),
        2 => at_offset_in::<2>(scene, offset),
        _ => at_offset_in::<3>(scene, offset),
    }
}

fn at_offset_in<const D: usize>(scene: &Scene, offset: &[f64]) -> Result<f64, Breakdown> {
    let rounds: [bool; D] =
        std::array::from_fn(|d| scene.boundary[d].iter().all(|side| side.fixed[d]));
    let mut small = scene.clone();
    for d in 0..D {
        let cells = scene.grid.cells[d].min(CELLS[D - 1]);
        small.body.length[d] = scene.body.length[d] / scene.grid.cells[d] as f64 * cells as f64;
        small.grid.cells[d] = cells;
        if !rounds[d] {
            small.grid.beyond[d] = [2, 2];
        }
    }
    small.body.balls.clear();
    small.motion = Motion::Regions(Vec::new());
    (small.body_force, small.traction) = (None, None);
    let model = setup::model::<D>(&small);
    let shift = SVector::from_fn(|d, _| offset[d] * model.grid.h[d]);
    least(COARSE, &small, &model, &Offset { shift, rounds, touch: Vec::new() })
}
// ANCHOR_END: over_offsets
