//! Every intermediate of the first steps of a run, in the paper's order: what a port
//! is held against.
//!
//! A trace takes the steps of a scheme one by one, as the scheme's own function does,
//! and writes down what each of them has made. `tests/trace.rs` holds the two
//! together: after the same number of steps they have the same bits.
#![allow(non_snake_case)]

mod entry;

use crate::continuum::shape::Shape;
use crate::continuum::state::{Nodes, Particles, State};
use crate::cost::Cost;
use crate::fault::{Breakdown, Fault, Moment};
use crate::model::Model;
use crate::otm;
use crate::reading::{StepEight, StressUpdate};
use crate::scene::{Method, Scene};
use crate::time::generalized_alpha::{self, Parameters};
use crate::time::steps::*;
use crate::time::{self, Integrator};
use nalgebra::SVector;

pub use entry::{COLUMNS, Entry, PAIRS, Recorder, SYMBOLS, csv, hex, number};

/// That a trace of `steps` steps has an end in sight.
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
    let D = scene.dimension() as f64;
    let of_particle = scene.pairs_per_particle() * (1.0 + D) + 3.0 * D + 2.0 * D * D + 1.0;
    let numbers = (steps as f64 + 1.0) * (particles * of_particle + nodes * (1.0 + 5.0 * D));
    if numbers > MOST_NUMBERS {
        let problem = format!("{steps} steps of this scene make {numbers:.0e} numbers");
        return refuse(problem, "so many steps that a trace has 30 million numbers at most");
    }
    Ok(())
}

/// Some gigabytes.
const MOST_NUMBERS: f64 = 3e7;

/// Runs the first `steps` steps of a scene and returns everything that they made.
///
/// Errors: [`Breakdown`].
pub fn trace(scene: &Scene, steps: usize) -> Result<Vec<Entry>, Breakdown> {
    match scene.dimension() {
        1 => trace_in::<1>(scene, steps).map(|(entries, _)| entries),
        2 => trace_in::<2>(scene, steps).map(|(entries, _)| entries),
        _ => trace_in::<3>(scene, steps).map(|(entries, _)| entries),
    }
}

/// The same with the state at the end.
pub fn trace_in<const D: usize>(
    scene: &Scene,
    steps: usize,
) -> Result<(Vec<Entry>, State<D>), Breakdown> {
    let model = Model::<D>::of(scene);
    let mut state = model.initial_state(scene);
    let mut recorder = Recorder::default();
    recorder.numbers("dt", &[model.dt]);
    recorder.vectors("x_p", &state.particle.x);
    recorder.vectors("v_p", &state.particle.v);
    let cost = &mut Cost::default();
    match model.method {
        Method::Otm => {
            otm::start(&mut state, &model, cost)?;
            recorder.numbers("m_I", &state.node.m);
            recorder.vectors("v_I", &state.node.v);
        }
        Method::Mpm(Integrator::Newmark(reading)) => {
            newmark(&mut recorder, &mut state, &model, reading, 0.0, Moment::START, cost)?;
        }
        Method::Mpm(_) => time::start(&mut state, &model, cost)?,
    }
    recorder.finite(Moment::START)?;
    for k in 1..=steps {
        recorder.k = k;
        let moment = Moment { step: k, time: k as f64 * model.dt };
        let (r, s, m, dt) = (&mut recorder, &mut state, &model, model.dt);
        match model.method {
            Method::Otm => otm_step(r, s, m, moment, cost)?,
            Method::Mpm(integrator) => match integrator {
                Integrator::Newmark(reading) => newmark(r, s, m, reading, dt, moment, cost)?,
                Integrator::ForwardEuler(order) => {
                    euler(r, s, m, order, move_with_nodes, moment, cost)?;
                }
                Integrator::CorrectedEuler => {
                    let order = StressUpdate::ModifiedLast;
                    euler(r, s, m, order, move_with_shares, moment, cost)?;
                }
                Integrator::GeneralizedAlpha { rho_b } => alpha(r, s, m, rho_b, moment, cost)?,
            },
        }
        recorder.finite(moment)?;
    }
    Ok((recorder.entries, state))
}

fn newmark<const D: usize>(
    r: &mut Recorder,
    State { particle, node, shape, mass, scratch }: &mut State<D>,
    model: &Model<D>,
    reading: StepEight,
    dt: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    r.step = 1;
    predict(particle, node, shape, dt);
    r.vectors("x_p", &particle.x);
    r.vectors("v_p", &particle.v);
    r.step = 2;
    discard(node);
    tabulate(shape, scratch, particle, model, moment, cost)?;
    r.shapes(shape, &scratch.lambda, &model.grid.h);
    r.step = 3;
    transfer(node, mass, particle, shape, moment, cost)?;
    r.numbers("m_I", &node.m);
    r.vectors("p_I", &node.p);
    r.step = 4;
    impose_essential(node, mass, &model.fixed, cost);
    r.vectors("v_I", &node.v);
    r.step = 5;
    increment_strain(particle, node, shape, dt);
    r.tensors("d_eps_p", &particle.d_eps);
    r.step = 6;
    update_density(particle, moment)?;
    r.numbers("rho_p", &particle.rho);
    update_stress(particle, &model.law);
    r.tensors("sigma_p", &particle.sigma);
    r.step = 7;
    balance_forces(node, mass, particle, shape, model, moment.time, cost);
    r.forces(node, particle, shape, model, moment.time);
    r.step = 8;
    integrate_momentum(node, dt, reading);
    r.vectors("p_I_advanced", &node.p);
    r.step = 9;
    correct(particle, node, shape, dt);
    r.vectors("v_p", &particle.v);
    Ok(())
}

/// The steps that the Euler forms and generalized-α begin with.
fn begin<const D: usize>(
    r: &mut Recorder,
    State { particle, node, shape, mass, scratch }: &mut State<D>,
    model: &Model<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    r.step = 1;
    discard(node);
    tabulate(shape, scratch, particle, model, moment, cost)?;
    r.shapes(shape, &scratch.lambda, &model.grid.h);
    r.step = 2;
    transfer(node, mass, particle, shape, moment, cost)?;
    r.numbers("m_I", &node.m);
    r.vectors("p_I", &node.p);
    Ok(())
}

/// How an Euler form moves its particles.
type Mover<const D: usize> = fn(&mut Particles<D>, &Nodes<D>, &Shape<D>, f64);

/// Forward Euler and its corrected form, which moves the particles with shares and
/// has the order of `modified-last`.
fn euler<const D: usize>(
    r: &mut Recorder,
    state: &mut State<D>,
    model: &Model<D>,
    order: StressUpdate,
    move_particles: Mover<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    begin(r, state, model, moment, cost)?;
    let (State { particle, node, shape, mass, .. }, dt) = (state, model.dt);
    r.step = 3;
    impose_essential(node, mass, &model.fixed, cost);
    r.vectors("v_I", &node.v);
    if order == StressUpdate::First {
        update_material(particle, node, shape, model, dt, moment)?;
        r.material(particle);
    }
    r.step = 4;
    balance_forces(node, mass, particle, shape, model, moment.time - dt, cost);
    r.forces(node, particle, shape, model, moment.time - dt);
    r.step = 5;
    advance_momentum(node, dt);
    r.vectors("p_I_advanced", &node.p);
    r.step = 6;
    move_particles(particle, node, shape, dt);
    r.vectors("v_p", &particle.v);
    r.vectors("x_p", &particle.x);
    r.step = 7;
    if order == StressUpdate::ModifiedLast {
        map_momentum_anew(node, particle, shape);
        impose_essential(node, mass, &model.fixed, cost);
        r.vectors("v_I", &node.v);
    }
    if order != StressUpdate::First {
        update_material(particle, node, shape, model, dt, moment)?;
        r.material(particle);
    }
    Ok(())
}

fn alpha<const D: usize>(
    r: &mut Recorder,
    state: &mut State<D>,
    model: &Model<D>,
    rho_b: f64,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    begin(r, state, model, moment, cost)?;
    let State { particle, node, shape, mass, .. } = state;
    let (parameters, dt) = (Parameters::new(rho_b), model.dt);
    r.step = 3;
    map_acceleration(node, mass, particle, shape, &model.fixed, cost);
    r.vectors("a_I", &node.a);
    impose_essential(node, mass, &model.fixed, cost);
    r.vectors("v_I", &node.v);
    r.step = 4;
    balance_forces(node, mass, particle, shape, model, moment.time - dt, cost);
    r.forces(node, particle, shape, model, moment.time - dt);
    r.step = 5;
    generalized_alpha::balance_accelerations(node, &parameters);
    r.vectors("a_I", &node.a_next);
    r.step = 6;
    generalized_alpha::move_particles(particle, node, shape, &parameters, dt);
    r.vectors("v_p", &particle.v);
    r.vectors("x_p", &particle.x);
    r.step = 7;
    generalized_alpha::average_velocity(node, &parameters, dt);
    update_material(particle, node, shape, model, dt, moment)?;
    r.material(particle);
    Ok(())
}

fn otm_step<const D: usize>(
    r: &mut Recorder,
    state: &mut State<D>,
    model: &Model<D>,
    moment: Moment,
    cost: &mut Cost,
) -> Result<(), Breakdown> {
    let dt = model.dt;
    let State { particle, node, shape, .. } = state;
    r.step = 1;
    otm::kick(node, 0.5 * dt);
    r.vectors("v_I", &node.v);
    r.step = 2;
    otm::move_nodes(node, dt);
    r.vectors("x_I", &node.x);
    r.step = 3;
    otm::move_particles(particle, node, shape, dt);
    r.vectors("x_p", &particle.x);
    r.step = 4;
    otm::deform(particle, node, shape, model, dt, moment)?;
    r.material(particle);
    r.step = 5;
    otm::tabulate(state, model, moment, cost)?;
    let State { particle, node, shape, mass, scratch } = state;
    r.shapes(shape, &scratch.lambda, &model.grid.h);
    r.step = 6;
    node.f.fill(SVector::zeros());
    balance_forces(node, mass, particle, shape, model, moment.time, cost);
    r.forces(node, particle, shape, model, moment.time);
    r.step = 7;
    otm::kick(node, 0.5 * dt);
    r.vectors("v_I", &node.v);
    otm::show_velocity(particle, node, shape);
    r.vectors("v_p", &particle.v);
    Ok(())
}
