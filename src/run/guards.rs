//! A run guards what it may say: that its energy is what start and loads gave it, that its law
//! holds for how far the material has turned, and that angular momentum is kept where it must be.
//! What is somewhat off is warned of, and what is far off ends the run; neither depends on what
//! is recorded.

use super::stability::{Balance, Critical, Watch};
use super::warning::{Warning, Worst};
use crate::method::breakdown::{Breakdown, Moment};
use crate::method::continuum::state::Carriers;
use crate::method::measure;
use crate::method::model::{Model, State};
use crate::scene::{Check, Scene};
use nalgebra::SVector;

/// The guards look with every so many steps, and with the last.
const EVERY: usize = 10;

/// From this share of growth on the energy is warned of.
const GROWTH: f64 = 0.01;

/// From this angle on the rate law is warned of (rad): a tension that does not turn with the
/// material is then off by √2 sin of it, 14%.
const ANGLE: f64 = 0.1;

/// From this share on a loss of angular momentum is warned of.
const LOSS: f64 = 0.01;

/// Below it the square of a speed may have lost its digits (m²/s²).
const FAINT: f64 = 1e-280;

/// The guards of a run.
pub struct Guards<'a, const D: usize> {
    account: Account<'a, D>,
    check: Check,
    /// Angular momentum at the start, and what it could be by the speeds (kg m²/s); where
    /// nothing from outside turns the body.
    spin: Option<(Vec<f64>, f64)>,
    watch: Option<Watch<'a, D>>,
    locking: Option<Warning>,
    growth: Option<Worst>,
    turned: Option<Worst>,
    lost: Option<Worst>,
}

/// The account of a run's energy: what start and loads have given.
struct Account<'a, const D: usize> {
    model: &'a Model<D>,
    /// Velocities and stresses count so many times what they are: 1, but for motions whose
    /// energy would underflow.
    unit: f64,
    /// Total energy at the start (J).
    start: f64,
    /// The largest energy that start and work together have given so far (J).
    most: f64,
    /// What the loads do; `None` without loads.
    work: Option<LoadWork<D>>,
}

/// This is the work that the loads have done so far.
struct LoadWork<const D: usize> {
    sum: f64,
    /// The same without signs, what the loads have moved to and fro (J).
    moved: f64,
    /// The largest of one step (J).
    step: f64,
    /// u_p of the step before (m).
    before: Vec<SVector<f64, D>>,
}

impl<const D: usize> Account<'_, D> {
    /// Gives the energy of `state` beside what was put in.
    fn balance(&self, state: &State<D>) -> Balance {
        let (sum, moved) = self.work.as_ref().map_or((0.0, 0.0), |work| (work.sum, work.moved));
        let gained = energy(self.model, state, self.unit) - self.start - sum;
        Balance { gained, given: self.start + moved }
    }
}

impl<'a, const D: usize> Guards<'a, D> {
    /// Makes the guards of a run that is about to begin with `state`, whose scheme is prepared, and
    /// of which the limit of Δt may be known.
    pub fn new(
        scene: &'a Scene,
        model: &'a Model<D>,
        state: &State<D>,
        limit: Option<Critical>,
    ) -> Self {
        let carriers = state.carriers(model.method);
        let unit = unit(&carriers, model.loads.is_some());
        let start = energy(model, state, unit);
        let work = model.loads.as_ref().map(|_| LoadWork {
            sum: 0.0,
            moved: 0.0,
            step: 0.0,
            before: state.particle.u.clone(),
        });
        let free = D > 1 && model.fixed.is_empty() && model.loads.is_none();
        Guards {
            account: Account { model, unit, start, most: start, work },
            check: scene.check,
            spin: free.then(|| (measure::angular_momentum(&carriers), measure::turning(&carriers))),
            watch: Watch::new(scene, model, state, limit),
            locking: Warning::locking(scene),
            growth: None,
            turned: None,
            lost: None,
        }
    }

    /// Adds what the loads have done in the step that ends at `moment`, and gives their work so
    /// far (J).
    pub fn add_work(&mut self, state: &State<D>, moment: Moment) -> Option<f64> {
        let Account { model, start, most, work, .. } = &mut self.account;
        let (particle, dt) = (&state.particle, model.dt);
        if let (Some(work), Some(loads)) = (&mut *work, &model.loads)
            && moment.step > 0
        {
            let step = loads.work(particle, &work.before, moment.time - dt, dt);
            work.sum += step;
            work.moved += step.abs();
            work.step = work.step.max(step.abs());
            work.before.copy_from_slice(&particle.u);
            *most = most.max(*start + work.sum);
        }
        work.as_ref().map(|work| work.sum)
    }

    /// Judges the state at `moment`, whose work has been added.
    ///
    /// Errors: [`Breakdown::Diverged`], [`Breakdown::Turned`], [`Breakdown::NotFinite`], and those
    /// of the watch.
    pub fn judge(&mut self, state: &State<D>, moment: Moment) -> Result<(), Breakdown> {
        let Guards { watch, account, .. } = self;
        if let Some(watch) = watch {
            watch.follow(state, moment, &|| account.balance(state))?;
        }
        if !moment.step.is_multiple_of(EVERY) && moment.step != account.model.steps {
            return Ok(());
        }
        self.energy(state, moment)?;
        self.rotation(state, moment)?;
        self.angular_momentum(state, moment);
        Ok(())
    }

    // ANCHOR: energy_contract
    /// Holds kinetic and strain energy, less what start and loads gave, against the largest that
    /// they have given so far. No scheme may make energy; one that damps may lose it. The work of
    /// one step does not count: velocity and stress stand up to a step apart.
    fn energy(&mut self, state: &State<D>, moment: Moment) -> Result<(), Breakdown> {
        let gained = self.account.balance(state).gained;
        let most_energetic = || measure::most_energetic(&state.particle, &self.account.model.law);
        if !gained.is_finite() {
            return Err(Breakdown::NotFinite { particle: most_energetic(), symbol: "energy" });
        }
        let slack = self.account.work.as_ref().map_or(0.0, |work| work.step);
        // Where nothing was given there is nothing, or all of it is too much.
        let share = if gained > slack { (gained - slack) / self.account.most } else { 0.0 };
        if share > self.check.energy {
            let bound = self.check.energy;
            return Err(Breakdown::Diverged { particle: most_energetic(), share, bound });
        }
        if share > self.growth.map_or(0.0, |seen| seen.value) {
            let particle = if share > GROWTH { most_energetic() } else { 0 };
            self.growth = Some(Worst { value: share, particle, moment });
        }
        Ok(())
    }
    // ANCHOR_END: energy_contract

    /// Holds how far the material has turned against what the rate law bears.
    fn rotation(&mut self, state: &State<D>, moment: Moment) -> Result<(), Breakdown> {
        let Some((particle, value)) = measure::largest_rotation(&state.particle) else {
            return Ok(());
        };
        if value > self.check.rotation {
            return Err(Breakdown::Turned { particle, angle: value, bound: self.check.rotation });
        }
        if value > self.turned.map_or(0.0, |seen| seen.value) {
            self.turned = Some(Worst { value, particle, moment });
        }
        Ok(())
    }

    /// Notes how much angular momentum a free body has lost or gained.
    fn angular_momentum(&mut self, state: &State<D>, moment: Moment) {
        let Some((start, scale)) = &self.spin else { return };
        let now = measure::angular_momentum(&state.carriers(self.account.model.method));
        let square: f64 =
            now.iter().zip(start).map(|(now, start)| (now - start) * (now - start)).sum();
        let value = libm::sqrt(square) / scale;
        if value > self.lost.map_or(0.0, |seen| seen.value) {
            self.lost = Some(Worst { value, particle: 0, moment });
        }
    }

    /// Counts the passes over all particles that the watch has taken.
    pub fn limit_applications(&self) -> u64 {
        self.watch.as_ref().map_or(0, |watch| watch.applications)
    }

    /// Gives the largest growth of the energy, as a share of what was given (–).
    pub fn growth(&self) -> f64 {
        self.growth.map_or(0.0, |seen| seen.value)
    }

    /// Lists what is to be warned of.
    pub fn warnings(&self) -> Vec<Warning> {
        let beyond = |seen: Option<Worst>, least: f64| seen.filter(|seen| seen.value > least);
        [
            self.locking,
            beyond(self.growth, GROWTH).map(Warning::EnergyGrew),
            beyond(self.turned, ANGLE).map(Warning::Turned),
            beyond(self.lost, LOSS).map(Warning::AngularMomentum),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

/// Gives the unit of velocities in which the largest of a faint motion without loads is 1, and
/// else 1.
fn unit<const D: usize>(carriers: &Carriers<D>, is_loaded: bool) -> f64 {
    let largest = carriers.v.iter().flatten().fold(0.0, |largest: f64, v| largest.max(v.abs()));
    let is_faint = largest > 0.0 && largest * largest < FAINT && !is_loaded;
    if is_faint { 1.0 / largest.max(f64::MIN_POSITIVE) } else { 1.0 }
}

/// Sums kinetic and strain energy (J), with velocities and stresses `unit` times what they are.
/// Strains so faint that this matters leave a hyperelastic body as it is.
fn energy<const D: usize>(model: &Model<D>, state: &State<D>, unit: f64) -> f64 {
    if unit != 1.0 {
        let mut state = state.clone();
        state.particle.v.iter_mut().for_each(|v| *v *= unit);
        state.node.v.iter_mut().for_each(|v| *v *= unit);
        state.particle.sigma.iter_mut().for_each(|sigma| *sigma *= unit);
        return energy(model, &state, 1.0);
    }
    measure::kinetic_energy(&state.carriers(model.method))
        + measure::strain_energy(&state.particle, &model.law)
}
