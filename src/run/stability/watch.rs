//! A run watches its limit of Δt as the particles move.

use super::lanczos::{Tridiagonal, dot};
use super::noise::noise;
use super::operator::{Operator, Stress};
use super::predict::{self, Critical};
use crate::method::breakdown::{Breakdown, Moment};
use crate::method::choice::Method;
use crate::method::continuum::law::symmetric_part;
use crate::method::continuum::state::Particles;
use crate::method::grid::odometer;
use crate::method::measure;
use crate::method::model::{Model, State};
use crate::method::time::{self, steps};
use crate::scene::Scene;
use nalgebra::{SMatrix, SVector};

/// A look is precise to this share of the square of the limit.
const COARSE: f64 = 1e-3;

/// Near the limit looks come this much closer together.
const CLOSEST: f64 = 0.1;

/// The energy of what grows may become this share of the energy that start and work gave.
const HARM: f64 = 5e-3;

/// All energy that is there beyond start and work may become this share of it ...
const GAIN: f64 = 2.5e-3;

/// ... with a time step that is more than this part of the limit. Below it what a method
/// makes of energy has little to do with its time step.
const LARGE: f64 = 0.5;

/// With such a step a look also comes when the energy has grown by this share since the last.
const JUMP: f64 = 5e-4;

/// A node with less than this share of a particle's mass has hardly any.
const LIGHT: f64 = 1e-2;

/// So many applications of the operator leave of a stress what has the largest eigenvalues.
const POWER: usize = 30;

/// This is the energy of a run beside what was put in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// Kinetic and strain energy, less that of the start and the work of the loads (J).
    pub gained: f64,
    /// That of the start, and the work that loads have done to and fro (J).
    pub given: f64,
}

/// A watch looks at the limit of Δt whenever the particles have moved on.
pub struct Watch<'a, const D: usize> {
    scene: &'a Scene,
    model: &'a Model<D>,
    /// Its own particles, table and masses, so that the run's stay as they are; from the
    /// first look on.
    own: Option<State<D>>,
    /// Where the particles stood at the last look (m).
    seen: Vec<SVector<f64, D>>,
    /// A node with hardly any mass takes the limit to 0.
    light_nodes_harm: bool,
    /// What the energy had gained at the last look (J), if Δt was a large part of the limit.
    gained: Option<f64>,
    /// The lowest limit so far (s).
    lowest: f64,
    /// The predicted limit, once that was asked for; `None` in it where there is none.
    predicted: Option<Option<Critical>>,
    /// The particles may move so far until the next look (cells).
    spacing: f64,
    /// The next look comes with this step at the latest.
    due: usize,
    /// Passes over all particles so far.
    pub applications: u64,
}

impl<'a, const D: usize> Watch<'a, D> {
    /// Makes the watch of a run that begins with `state`; `None` for a scene that wants none, and
    /// for a scheme that has no limit.
    /// The predicted `limit` is found when first asked for, unless it is known.
    pub fn new(
        scene: &'a Scene,
        model: &'a Model<D>,
        state: &State<D>,
        limit: Option<Critical>,
    ) -> Option<Self> {
        let unlimited = model.method.needs().equilibrium || model.reconstruction.is_some();
        if scene.time.watch == 0.0 || scene.time.allow_unstable || unlimited {
            return None;
        }
        Some(Watch {
            scene,
            model,
            own: None,
            seen: state.particle.x.clone(),
            light_nodes_harm: time::scheme::<D>(model.method)
                .factor(model.kinematics)
                .fears_light_nodes(&model.basis),
            gained: None,
            lowest: f64::INFINITY,
            predicted: limit.map(Some),
            spacing: CLOSEST * scene.time.watch,
            due: usize::MAX,
            applications: 0,
        })
    }

    // ANCHOR: watch
    /// Looks at the limit if the particles have moved on since the last look, if one of them
    /// comes to a node that had no mass, or if something grows; `balance` gives the energy.
    ///
    /// Errors: [`Breakdown::BeyondLimit`], [`Breakdown::Gained`].
    pub fn follow(
        &mut self,
        state: &State<D>,
        moment: Moment,
        balance: &dyn Fn() -> Balance,
    ) -> Result<(), Breakdown> {
        let due = moment.step >= self.due || self.touches(state) || self.jumps(balance);
        if !due && self.way(&state.particle) < self.spacing {
            return Ok(());
        }
        self.seen.copy_from_slice(&state.particle.x);
        self.due = usize::MAX;
        let Some(limit) = self.limit(state) else {
            return Ok(()); // the run itself will say what is wrong with the next table
        };
        self.lowest = self.lowest.min(limit);
        let balance = balance();
        self.gained = (self.model.dt > LARGE * limit).then_some(balance.gained);
        let gains = balance.gained > GAIN * balance.given;
        if self.model.dt > limit {
            if gains {
                return Err(self.stop(state, limit));
            }
            // What would grow after the last step does no harm.
            let last = moment.step == self.model.steps;
            return if last { Ok(()) } else { self.beyond(state, moment, limit, balance) };
        }
        if gains && self.part() > LARGE {
            let particle = measure::most_energetic(&state.particle, &self.model.law);
            let share = balance.gained / balance.given;
            return Err(Breakdown::Gained { particle, share, part: self.part() });
        }
        let room = 2.0 * (limit / self.model.dt - 1.0);
        self.spacing = self.scene.time.watch * room.clamp(CLOSEST, 1.0);
        Ok(())
    }
    // ANCHOR_END: watch

    /// Tells whether the energy has grown much since the last look; asked for only with a step
    /// that was a large part of the limit then.
    fn jumps(&self, balance: &dyn Fn() -> Balance) -> bool {
        let Some(gained) = self.gained else { return false };
        let balance = balance();
        balance.gained - gained > JUMP * balance.given
    }

    /// Gives the predicted limit, found when first asked for.
    fn predicted(&mut self) -> Option<Critical> {
        let scene = self.scene;
        *self.predicted.get_or_insert_with(|| predict::critical(scene).ok())
    }

    /// Gives the part of the predicted limit over all offsets that Δt is; 0 for a scene that
    /// does not move.
    fn part(&mut self) -> f64 {
        let limit = self.predicted().and_then(|critical| critical.over_offsets);
        limit.map_or(0.0, |limit| self.model.dt / limit)
    }

    /// Gives how far a particle has come since the last look, in cells along an axis.
    fn way(&self, particle: &Particles<D>) -> f64 {
        let mut way: f64 = 0.0;
        for (x, seen) in particle.x.iter().zip(&self.seen) {
            for d in 0..D {
                way = way.max((x[d] - seen[d]).abs() * self.model.grid.per_h[d]);
            }
        }
        way
    }

    /// Tells whether a particle has come into a cell with a corner that has hardly any mass:
    /// none in the last table of most schemes, which is that of a step before; next to none in
    /// that of Newmark's method, which is current.
    fn touches(&self, state: &State<D>) -> bool {
        let grid = &self.model.grid;
        let current = self.model.method.needs().current_table;
        let share = if current { LIGHT } else { 0.0 };
        let bare = |p: usize| {
            let Some(at) = grid.locate(&state.particle.x[p]) else { return false };
            let most = share * state.particle.m[p];
            let corner = |n: [usize; D]| grid.node(std::array::from_fn(|d| at.cell[d] + n[d]));
            let N = |n: [usize; D]| -> f64 {
                (0..D).map(|d| if n[d] == 0 { 1.0 - at.xi[d] } else { at.xi[d] }).product()
            };
            odometer([2; D]).any(|n| state.node.m[corner(n)] <= most && N(n) > 0.0)
        };
        self.light_nodes_harm && (0..state.particle.len()).any(bare)
    }

    /// Gives the limit of Δt (s) where the particles stand now, or a lower bound of it that
    /// is at least Δt.
    fn limit(&mut self, state: &State<D>) -> Option<f64> {
        self.copy(state).ok()?;
        let mut operator = Operator::new(self.own.as_mut()?, self.model);
        let bound = operator.bound().map(|square| 2.0 / libm::sqrt(square));
        let found = match bound.filter(|bound| *bound >= self.model.dt) {
            Some(bound) => bound,
            None => {
                let mut random = noise();
                let start = state.particle.m.iter().map(|_| SMatrix::from_fn(|_, _| random()));
                let start: Stress<D> = start.map(|y| symmetric_part(&y)).collect();
                let found = Tridiagonal::of(&mut operator, start, COARSE);
                2.0 / libm::sqrt(found.largest)
            }
        };
        self.applications += operator.applications;
        Some(found)
    }

    /// Takes over the places of particles and nodes with their table, which Newmark's method
    /// and OTM have made where the particles stand now, and sums up the nodal masses.
    fn copy(&mut self, state: &State<D>) -> Result<(), Breakdown> {
        let (own, model) = (self.own.get_or_insert_with(|| state.clone()), self.model);
        own.particle.x.copy_from_slice(&state.particle.x);
        own.particle.rho.copy_from_slice(&state.particle.rho);
        own.particle.stretch.copy_from_slice(&state.particle.stretch);
        match model.method.needs().current_table {
            true => own.shape.clone_from(&state.shape),
            false => {
                own.particle.lambda.clone_from(&state.particle.lambda);
                steps::tabulate(&mut own.shape, &mut own.scratch, &mut own.particle, model)?;
            }
        }
        self.applications += 1; // the table
        own.node.m.copy_from_slice(&state.node.m); // of OTM, which keeps them
        if let Method::Mpm(_) = model.method {
            steps::discard(&mut own.node);
            steps::transfer(&mut own.node, &mut own.mass, &own.particle, &own.shape)?;
        }
        Ok(())
    }

    // ANCHOR: beyond
    /// Looks at what Δt beyond the limit does: the energy U of what grows is multiplied by
    /// e^2μ with every step, cosh(μ/2) = Δt/limit. The next look comes in half the steps
    /// after which it could do harm.
    ///
    /// Errors: [`Breakdown::BeyondLimit`] if there is no time left.
    fn beyond(
        &mut self,
        state: &State<D>,
        moment: Moment,
        limit: f64,
        balance: Balance,
    ) -> Result<(), Breakdown> {
        self.spacing = CLOSEST * self.scene.time.watch;
        let dt = self.model.dt;
        let Some(own) = &mut self.own else { return Ok(()) };
        let mut operator = Operator::new(own, self.model);
        let stress = operator.stress(&state.particle.sigma);
        let strain_energy = 0.5 * dot(&stress, &stress);
        if strain_energy == 0.0 || balance.given == 0.0 {
            return Ok(());
        }
        let found = Tridiagonal::of(&mut operator, stress, COARSE);
        self.applications += operator.applications;
        let growing = 2.0 * strain_energy * found.share_above(4.0 / (dt * dt));
        let rate = 4.0 * libm::acosh(dt / limit);
        let steps = libm::log(HARM * balance.given / growing) / rate;
        if steps < 1.0 {
            return Err(self.stop(state, limit));
        }
        self.due = moment.step + (0.5 * steps).clamp(1.0, 1e9) as usize;
        Ok(())
    }
    // ANCHOR_END: beyond

    /// Finds the particle that has the most of what grows: the stress to which the operator
    /// was applied so often that little else is left of it.
    fn particle(&mut self, state: &State<D>) -> usize {
        let Some(own) = &mut self.own else { return 0 };
        let mut operator = Operator::new(own, self.model);
        let mut y = operator.stress(&state.particle.sigma);
        for _ in 0..POWER {
            y = operator.apply(&y);
            let size = libm::sqrt(dot(&y, &y));
            for y in &mut y {
                *y /= size;
            }
        }
        let square = |p: &usize| y[*p].dot(&y[*p]);
        (0..y.len()).max_by(|a, b| square(a).total_cmp(&square(b))).unwrap_or(0)
    }

    /// Says by name that Δt is beyond the limit.
    fn stop(&mut self, state: &State<D>, limit: f64) -> Breakdown {
        let predicted = self.predicted();
        let start = predicted.map_or(limit, |critical| critical.start);
        let used = predicted.map_or(limit, |critical| critical.used());
        Breakdown::BeyondLimit {
            particle: self.particle(state),
            dt: self.model.dt,
            start,
            now: limit,
            fraction: (self.lowest / used).min(1.0),
        }
    }
}
