//! Predicts the largest stable time step from one configuration, and measures it by marching.
//!
//! Hold the particles where they are. With M the mass matrix that the scheme
//! divides by, M_C the consistent one and K the stiffness, every scheme here is
//! stable up to Δt = 2/√λ with λ the largest eigenvalue of
//!
//! M⁻¹ K g(A),  A = M⁻¹ M_C,
//!
//! and g a function of the scheme on [0, 1], where the eigenvalues of A lie:
//! g(s) = s for the leapfrogs, 2 − s for stress-last, and for generalized-α
//! g(s) = 2p/l with l = 1 − α_m − α_m s and
//! p = (1 + s)(β − γs/2) − s(1 − s)/2. OTM maps nothing: g = 1.

use crate::method::breakdown::Breakdown;
use crate::method::choice::{Integrator, Method};
use crate::method::continuum::law::symmetric_part;
use crate::method::continuum::sums;
use crate::method::measure;
use crate::method::model::{Model, State};
use crate::method::reading::{Kinematics, StressUpdate};
use crate::method::time::generalized_alpha::Parameters;
use crate::method::time::{self, otm, steps};
use crate::scene::Scene;
use crate::setup;
use nalgebra::{SMatrix, SVector};

/// After so many iterations Lanczos's method stops in any case.
const MOST_ITERATIONS: usize = 300;

/// A particle that has just touched a new node switches it on. For uGIMP and
/// B-splines that node then counts at once, however small its mass, so the limit
/// is also taken with all particles moved by this share of a cell.
const TOUCH: f64 = 1e-7;

/// This is g, what a scheme makes of an eigenvalue s of A.
#[derive(Clone, Copy, Debug, PartialEq)]
enum OfScheme {
    One,
    /// s.
    Filtered,
    /// 2 − s.
    Last,
    /// 2p/l.
    Alpha(Parameters),
    /// A number, for generalized-α with ρ_b = 1.
    Constant(f64),
}

// ANCHOR: factor
impl OfScheme {
    fn of<const D: usize>(model: &Model<D>) -> Self {
        let Method::Mpm(integrator) = model.method else {
            return OfScheme::One;
        };
        match integrator {
            // l and p have the factor 1 − s: 2 for every s < 1, but 1 for s = 1. With
            // the consistent mass matrix both occur, and 2 is on the safe side.
            Integrator::GeneralizedAlpha { rho_b: 1.0 } => OfScheme::Constant(2.0),
            Integrator::GeneralizedAlpha { rho_b } => OfScheme::Alpha(Parameters::new(rho_b)),
            _ if model.kinematics == Kinematics::Consistent => OfScheme::Last,
            Integrator::Newmark(_) | Integrator::CorrectedEuler => OfScheme::Filtered,
            Integrator::ForwardEuler(StressUpdate::Last) => OfScheme::Last,
            Integrator::ForwardEuler(_) => OfScheme::Filtered,
        }
    }

    fn at(&self, s: f64) -> f64 {
        match self {
            OfScheme::One => 1.0,
            OfScheme::Filtered => s,
            OfScheme::Last => 2.0 - s,
            OfScheme::Constant(value) => *value,
            OfScheme::Alpha(Parameters { alpha_m, beta, gamma }) => {
                let l = 1.0 - alpha_m - alpha_m * s;
                let p = (1.0 + s) * (beta - 0.5 * gamma * s) - 0.5 * s * (1.0 - s);
                2.0 * p / l
            }
        }
    }

    /// Gives the coefficients of Chebyshev's polynomials on [0, 1]: two for the linear ones,
    /// eight for generalized-α, which leaves less than 1e-4.
    fn chebyshev(&self) -> Vec<f64> {
        let n = match self {
            OfScheme::One | OfScheme::Constant(_) => 1,
            OfScheme::Filtered | OfScheme::Last => 2,
            OfScheme::Alpha(_) => 8,
        };
        let angle = |j: usize| (j as f64 + 0.5) * std::f64::consts::PI / n as f64;
        (0..n)
            .map(|k| {
                let term = |j: usize| {
                    self.at(0.5 + 0.5 * libm::cos(angle(j))) * libm::cos(k as f64 * angle(j))
                };
                let sum: f64 = (0..n).map(term).sum();
                sum * if k == 0 { 1.0 } else { 2.0 } / n as f64
            })
            .collect()
    }
}
// ANCHOR_END: factor

/// This is the operator Ĝᵀ g(A) M⁻¹ Ĝ on the stresses of the particles, with
/// Ĝ = G √V D^½. It is symmetric and has the eigenvalues of M⁻¹ K g(A).
struct Operator<'a, const D: usize> {
    state: &'a mut State<D>,
    model: &'a Model<D>,
    chebyshev: Vec<f64>,
}

type Stress<const D: usize> = Vec<SMatrix<f64, D, D>>;
type Field<const D: usize> = Vec<SVector<f64, D>>;

impl<const D: usize> Operator<'_, D> {
    /// Applies D^½ to a symmetric tensor: √(dλ + 2μ) on the spherical part, √(2μ) on the
    /// rest.
    fn root(&self, y: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
        let law = &self.model.law;
        let (shear, bulk) = (2.0 * law.mu, D as f64 * law.lambda + 2.0 * law.mu);
        let sphere = SMatrix::<f64, D, D>::identity() * (y.trace() / D as f64);
        sphere * libm::sqrt(bulk) + (y - sphere) * libm::sqrt(shear)
    }

    // ANCHOR: operator
    fn apply(&mut self, y: &Stress<D>) -> Stress<D> {
        let volume = |state: &State<D>, p: usize| state.particle.m[p] / state.particle.rho[p];
        for p in 0..y.len() {
            let share = 1.0 / libm::sqrt(volume(self.state, p));
            self.state.particle.sigma[p] = self.root(&y[p]) * share;
        }
        let State { node, particle, shape, .. } = &mut *self.state;
        node.f.fill(SVector::zeros());
        sums::internal_force(node, particle, shape);
        let mut f = std::mem::take(&mut node.f);
        self.divide(&mut f);
        self.state.node.v = self.scheme(&f);
        self.state.node.f = f;
        let State { node, shape, .. } = &*self.state;
        let z = (0..y.len()).map(|p| symmetric_part(&sums::velocity_gradient(node, shape, p)));
        let z: Stress<D> = z.collect();
        // Internal forces pull back: f = −Ĝy.
        (0..y.len()).map(|p| self.root(&z[p]) * -libm::sqrt(volume(self.state, p))).collect()
    }

    /// Solves q ← M⁻¹ q, 0 where the boundary is fixed.
    fn divide(&mut self, q: &mut Field<D>) {
        for &(I, i) in &self.model.fixed {
            q[I][i] = 0.0;
        }
        let State { node, mass, .. } = &mut *self.state;
        let unsolved = q.clone();
        mass.solve(q, &unsolved, &node.m);
    }

    /// Applies A to u: to the particles and back.
    fn filter(&mut self, u: &Field<D>) -> Field<D> {
        let State { node, particle, shape, .. } = &*self.state;
        let mut q = vec![SVector::zeros(); node.len()];
        for p in 0..particle.len() {
            let v_p = sums::interpolate(u, shape, p);
            for (I, N_Ip, _) in shape.of(p) {
                q[I] += v_p * (particle.m[p] * N_Ip);
            }
        }
        self.divide(&mut q);
        q
    }

    /// Applies g(A) to u by Clenshaw's recurrence, in 2A − 1 on [−1, 1].
    fn scheme(&mut self, u: &Field<D>) -> Field<D> {
        let zero = || vec![SVector::zeros(); u.len()];
        let (mut above, mut now): (Field<D>, Field<D>) = (zero(), zero());
        for k in (0..self.chebyshev.len()).rev() {
            let twice = if k == 0 { 1.0 } else { 2.0 };
            let first = k + 1 == self.chebyshev.len(); // there is nothing to filter yet
            let filtered = if first { zero() } else { self.filter(&now) };
            let next = (0..u.len())
                .map(|I| {
                    let turned = filtered[I] * 2.0 - now[I];
                    u[I] * self.chebyshev[k] + turned * twice - above[I]
                })
                .collect();
            above = std::mem::replace(&mut now, next);
        }
        now
    }
    // ANCHOR_END: operator
}

/// Finds the largest eigenvalue of a symmetric tridiagonal matrix, by bisection on the
/// number of negative pivots (Sturm).
fn largest_eigenvalue(diagonal: &[f64], beside: &[f64]) -> f64 {
    let bound = |k: usize| {
        let left = if k > 0 { beside[k - 1] } else { 0.0 };
        let right = beside.get(k).copied().unwrap_or(0.0);
        diagonal[k] + left.abs() + right.abs()
    };
    let mut high = (0..diagonal.len()).map(bound).fold(f64::NEG_INFINITY, f64::max);
    let mut low = diagonal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let all_below = |x: f64| {
        let mut pivot = diagonal[0] - x;
        for k in 1..diagonal.len() {
            if pivot >= 0.0 {
                return false;
            }
            pivot = diagonal[k] - x - beside[k - 1] * beside[k - 1] / pivot;
        }
        pivot < 0.0
    };
    while high - low > 1e-13 * high.abs() {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if all_below(middle) { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// Makes numbers between −1 and 1 that are the same everywhere.
pub fn noise() -> impl FnMut() -> f64 {
    let mut state: u64 = 0x9e37_79b9_7f4a_7c15;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

// ANCHOR: lanczos
/// Finds the largest stable Δt (s) of a tabulated state with masses, by Lanczos's method.
/// Infinite for a body that nothing can strain.
///
/// Round-off makes copies of the eigenvalues, but adds none above the largest, so
/// three vectors are enough.
pub fn limit<const D: usize>(state: &mut State<D>, model: &Model<D>) -> f64 {
    let chebyshev = OfScheme::of(model).chebyshev();
    let count = state.particle.len();
    let mut operator = Operator { state, model, chebyshev };
    let dot = |a: &Stress<D>, b: &Stress<D>| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    let mut random = noise();
    let mut y: Stress<D> =
        (0..count).map(|_| symmetric_part(&SMatrix::from_fn(|_, _| random()))).collect();
    let mut before: Stress<D> = vec![SMatrix::zeros(); count];
    let (mut diagonal, mut beside): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let (mut largest, mut settled) = (0.0, 0);
    for iteration in 0..MOST_ITERATIONS {
        let size = libm::sqrt(dot(&y, &y));
        if iteration > 0 {
            if size <= 1e-10 * largest {
                break; // the space that the start spans is used up
            }
            beside.push(size);
        }
        for y in &mut y {
            *y /= size;
        }
        let mut next = operator.apply(&y);
        let alpha = dot(&next, &y);
        let beta = beside.last().copied().unwrap_or(0.0);
        for p in 0..count {
            next[p] -= y[p] * alpha + before[p] * beta;
        }
        diagonal.push(alpha);
        before = std::mem::replace(&mut y, next);
        let found = largest_eigenvalue(&diagonal, &beside);
        settled = if found - largest <= 1e-7 * found { settled + 1 } else { 0 };
        largest = found;
        if settled >= 3 {
            break;
        }
    }
    2.0 / libm::sqrt(largest)
}
// ANCHOR_END: lanczos

/// Makes a state at k = 0 with its particles moved by `offset` (m) along every axis,
/// tabulated, with nodal masses.
fn moved<const D: usize>(
    scene: &Scene,
    model: &Model<D>,
    offset: &SVector<f64, D>,
) -> Result<State<D>, Breakdown> {
    let mut state = setup::initial_state(model, scene);
    for x in &mut state.particle.x {
        *x += offset;
    }
    match model.method {
        Method::Otm => otm::start(&mut state, model)?,
        Method::Mpm(_) => {
            let State { particle, node, shape, mass, scratch, .. } = &mut state;
            steps::tabulate(shape, scratch, particle, model)?;
            steps::transfer(node, mass, particle, shape)?;
        }
    }
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
    let mut least = f64::INFINITY;
    for (n, shift) in shifts(scene, &model, offset).iter().enumerate() {
        match moved(scene, &model, shift) {
            Ok(mut state) => least = least.min(limit(&mut state, &model)),
            Err(breakdown) if n == 0 => return Err(breakdown),
            Err(_) => {} // outside the grid there is nothing to touch
        }
    }
    Ok(least)
}

/// Says where particles are moved to: by `offset`, and where it matters by a touch more
/// and less.
fn shifts<const D: usize>(scene: &Scene, model: &Model<D>, offset: f64) -> Vec<SVector<f64, D>> {
    let per_cell = |d: usize| scene.grid.particles_per_cell[d] as f64;
    let shift: SVector<f64, D> = SVector::from_fn(|d, _| offset * model.grid.h[d] / per_cell(d));
    match model.method {
        Method::Mpm(_) if model.basis.switches_nodes_on() => {
            [0.0, -TOUCH, TOUCH].map(|side| shift + model.grid.h * side).to_vec()
        }
        _ => vec![shift],
    }
}

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
    for (n, shift) in shifts(scene, &model, offset).iter().enumerate() {
        match grows_at(scene, &model, shift, step_count) {
            Ok(true) => return Ok(true),
            Err(breakdown) if n == 0 => return Err(breakdown),
            _ => {}
        }
    }
    Ok(false)
}

fn grows_at<const D: usize>(
    scene: &Scene,
    model: &Model<D>,
    shift: &SVector<f64, D>,
    step_count: usize,
) -> Result<bool, Breakdown> {
    let dt = model.dt;
    let mut state = setup::initial_state(model, scene);
    let mut random = noise();
    let speed = 1e-12 * model.grid.h.min() / dt;
    for p in 0..state.particle.len() {
        state.particle.x[p] += shift;
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

/// Finds the limit of Δt (s) by bisection on growth, to `tolerance`, from a guess.
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
        (low, high) = (high, 2.0 * high);
    }
    while high - low > tolerance * high {
        let middle = 0.5 * (low + high);
        if grows(scene, offset, middle, step_count)? { high = middle } else { low = middle }
    }
    Ok(0.5 * (low + high))
}
