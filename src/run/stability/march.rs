//! The limit of Δt is measured by marching: whether a run grows.

use super::noise::noise;
use super::predict::{Offset, touches};
use crate::method::breakdown::Breakdown;
use crate::method::model::{Model, State};
use crate::method::{measure, time};
use crate::scene::Scene;
use crate::setup;
use nalgebra::SVector;

/// Says whether a run with Δt = `dt` (s) grows. It starts from random velocities so small
/// that no particle moves by more than 1e-9 of a cell, without loads.
pub fn grows(scene: &Scene, offset: f64, dt: f64, step_count: usize) -> Result<bool, Breakdown> {
    match scene.dimension() {
        1 => grows_in::<1>(scene, offset, dt, step_count),
        2 => grows_in::<2>(scene, offset, dt, step_count),
        _ => grows_in::<3>(scene, offset, dt, step_count),
    }
}

fn grows_in<const D: usize>(
    scene: &Scene,
    offset: f64,
    dt: f64,
    step_count: usize,
) -> Result<bool, Breakdown> {
    let model = Model { dt, loads: None, ..setup::model::<D>(scene) };
    let offset = Offset::of_spacing(scene, &model, offset);
    if grows_at(scene, &model, &offset, step_count)? {
        return Ok(true);
    }
    let touches = touches(scene, &model, &offset)?;
    Ok(touches.iter().any(|touched| {
        let there = grows_at(scene, &model, touched, step_count);
        there.unwrap_or(false) // outside the grid there is nothing to touch
    }))
}

fn grows_at<const D: usize>(
    scene: &Scene,
    model: &Model<D>,
    offset: &Offset<D>,
    step_count: usize,
) -> Result<bool, Breakdown> {
    let dt = model.dt;
    let mut state = setup::initial_state(model, scene);
    let mut random = noise();
    let speed = 1e-12 * model.grid.h.min() / dt;
    offset.apply(scene, &mut state.particle);
    for p in 0..state.particle.len() {
        state.particle.v[p] = SVector::from_fn(|_, _| speed * random());
    }
    time::start(&mut state, model, &mut |_, _| {})?;
    let energy = |state: &State<D>| {
        measure::kinetic_energy(&state.carriers(model.method))
            + measure::strain_energy(&state.particle, &model.law)
    };
    let start = energy(&state);
    for step in 1..=step_count {
        let t = step as f64 * dt;
        let stopped = time::advance(&mut state, model, t, &mut |_, _| {}).is_err();
        if stopped || energy(&state) > 1e6 * start {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Finds the limit of Δt (s) by bisection on growth, to `tolerance`, from a guess; infinite where
/// nothing grows up to a thousand times the guess.
pub fn measured(
    scene: &Scene,
    offset: f64,
    guess: f64,
    step_count: usize,
    tolerance: f64,
) -> Result<f64, Breakdown> {
    if !guess.is_finite() {
        return Ok(guess); // nothing grows
    }
    let (mut low, mut high) = (0.5 * guess, 1.5 * guess);
    while grows(scene, offset, low, step_count)? {
        (low, high) = (0.5 * low, low);
    }
    while !grows(scene, offset, high, step_count)? {
        if high > 1e3 * guess {
            return Ok(f64::INFINITY);
        }
        (low, high) = (high, 2.0 * high);
    }
    while high - low > tolerance * high {
        let middle = 0.5 * (low + high);
        if grows(scene, offset, middle, step_count)? { high = middle } else { low = middle }
    }
    Ok(0.5 * (low + high))
}
