//! Writes the history of a run, and watches its energy.

use super::columns::per_axis;
use super::outcome::Frame;
use super::particles;
use super::stability::Balance;
use super::table::Table;
use crate::method::breakdown::{Breakdown, Moment};
use crate::method::exact::Exact;
use crate::method::measure;
use crate::method::model::{Model, State};
use crate::scene::{Quantity, Scene};
use crate::setup;
use nalgebra::SVector;

/// Total energy may grow to this multiple of what was there at the start and
/// what loads have brought before a run counts as blown up. A stable run of an
/// elastic body keeps it near 1 or below.
const BLOW_UP: f64 = 10.0;

/// The recorder writes the history, and watches the energy.
pub struct Recorder<'a, const D: usize> {
    pub history: Table,
    /// The particles at the recorded steps, if asked for.
    pub frames: Vec<Frame>,
    scene: &'a Scene,
    model: &'a Model<D>,
    exact: Option<Exact<D>>,
    /// The particle that each probe follows.
    followed: Vec<usize>,
    /// Total energy at the start (J).
    energy: f64,
    /// What the loads do; `None` without loads.
    work: Option<LoadWork<D>>,
    /// X_p, from which displacements count (m).
    reference: Vec<SVector<f64, D>>,
}

/// This is the work that the loads have done so far.
struct LoadWork<const D: usize> {
    sum: f64,
    /// The same without signs, what the loads have moved to and fro (J).
    moved: f64,
    /// x_p of the step before (m).
    before: Vec<SVector<f64, D>>,
}

impl<'a, const D: usize> Recorder<'a, D> {
    /// Makes a recorder before the first step, with its columns named.
    pub fn new(scene: &'a Scene, model: &'a Model<D>, state: &State<D>) -> Self {
        let reference = setup::material_points(scene);
        let followed = scene.probes.iter().map(|probe| {
            let position = SVector::from_fn(|d, _| probe.position[d]);
            nearest(&reference, &position)
        });
        let followed = followed.collect();
        let loaded = model.loads.is_some();
        let mut recorder = Recorder {
            history: Table::new(),
            frames: Vec::new(),
            scene,
            model,
            exact: setup::exact(scene).ok(),
            followed,
            energy: 0.0,
            work: loaded.then(|| LoadWork {
                sum: 0.0,
                moved: 0.0,
                before: state.particle.x.clone(),
            }),
            reference,
        };
        // Names the columns, which a run that breaks down at once has, too.
        recorder.row(state, Moment::START, [0.0; 2]);
        recorder.history.clear();
        recorder
    }

    /// Takes up the step that ends at `moment`, and records it if it is one to record.
    ///
    /// Errors: those of [`Recorder::record`].
    pub fn follow(&mut self, state: &State<D>, moment: Moment) -> Result<(), Breakdown> {
        let (particle, dt) = (&state.particle, self.model.dt);
        if let (Some(work), Some(loads)) = (&mut self.work, &self.model.loads) {
            let step = loads.work(particle, &work.before, moment.time - dt, dt);
            work.sum += step;
            work.moved += step.abs();
            work.before.copy_from_slice(&particle.x);
        }
        let last = moment.step == self.model.steps;
        if moment.step.is_multiple_of(self.scene.every) || last {
            self.record(state, moment)?;
        }
        Ok(())
    }

    /// Gives the energy of `state` beside what was put in.
    pub fn balance(&self, state: &State<D>) -> Balance {
        let kinetic = measure::kinetic_energy(&state.carriers(self.model.method));
        let strain = measure::strain_energy(&state.particle, &self.model.law);
        let (sum, moved) = self.work.as_ref().map_or((0.0, 0.0), |work| (work.sum, work.moved));
        Balance { gained: kinetic + strain - self.energy - sum, given: self.energy + moved }
    }

    /// Records the state at `moment`.
    ///
    /// Errors: [`Breakdown::NotFinite`], [`Breakdown::Diverged`] by its energy.
    pub fn record(&mut self, state: &State<D>, moment: Moment) -> Result<(), Breakdown> {
        let particle = &state.particle;
        let kinetic = measure::kinetic_energy(&state.carriers(self.model.method));
        let strain = measure::strain_energy(particle, &self.model.law);
        if !(kinetic + strain).is_finite() {
            let particle = measure::most_energetic(particle, &self.model.law);
            return Err(Breakdown::NotFinite { particle, symbol: "energy" });
        }
        if moment.step == 0 {
            self.energy = kinetic + strain;
        }
        let available = self.energy + self.work.as_ref().map_or(0.0, |work| work.moved);
        if available > 0.0 && kinetic + strain > BLOW_UP * available {
            return Err(Breakdown::Diverged {
                particle: measure::most_energetic(particle, &self.model.law),
                ratio: (kinetic + strain) / available,
            });
        }
        self.row(state, moment, [kinetic, strain]);
        if self.scene.vtk {
            let particles = self.particles(state, moment.time);
            self.frames.push(Frame { time: moment.time, particles });
        }
        Ok(())
    }

    /// Writes a row: `step`, `t`, energies and, with loads, their work (J), momentum (kg
    /// m/s), from 2D on angular momentum (kg m²/s), and each probe followed by its exact
    /// value where the scene has an exact solution.
    fn row(&mut self, state: &State<D>, moment: Moment, [kinetic, strain]: [f64; 2]) {
        let (particle, carriers) = (&state.particle, state.carriers(self.model.method));
        let history = &mut self.history;
        history.put(|| "step".into(), moment.step as f64);
        history.put(|| "t".into(), moment.time);
        history.put(|| "kinetic_energy".into(), kinetic);
        history.put(|| "strain_energy".into(), strain);
        if let Some(work) = &self.work {
            history.put(|| "work".into(), work.sum);
        }
        for (i, p_i) in measure::momentum(&carriers).iter().enumerate() {
            history.put(|| per_axis("momentum", D, i), *p_i);
        }
        for (i, l_i) in measure::angular_momentum(&carriers).iter().enumerate() {
            let axes = if D == 3 { 3 } else { 1 };
            history.put(|| per_axis("angular_momentum", axes, i), *l_i);
        }
        for (probe, p) in self.scene.probes.iter().zip(&self.followed) {
            let (p, reference) = (*p, self.reference[*p]);
            let value = match probe.quantity {
                Quantity::Velocity(i) => particle.v[p][i],
                Quantity::Stress(i, j) => particle.sigma[p][(i, j)],
                Quantity::Displacement(i) => particle.x[p][i] - reference[i],
            };
            history.put(|| probe.name.clone(), value);
            if let Some(exact) = &self.exact {
                let fields = exact.at(&reference, moment.time);
                let value = match probe.quantity {
                    Quantity::Velocity(i) => fields.velocity[i],
                    Quantity::Stress(i, j) => fields.stress[(i, j)],
                    Quantity::Displacement(i) => fields.displacement[i],
                };
                history.put(|| format!("{}_exact", probe.name), value);
            }
        }
        history.end_row();
    }

    /// Makes the table of the particles at time `t` (s).
    pub fn particles(&self, state: &State<D>, t: f64) -> Table {
        particles::table(self.scene, &state.particle, &self.reference, &self.exact, t)
    }
}

/// Finds the particle nearest to `position`; of equally near ones the first.
///
/// A point midway between two particles is equally near to both up to
/// round-off, hence the margin.
fn nearest<const D: usize>(x: &[SVector<f64, D>], position: &SVector<f64, D>) -> usize {
    let (mut best, mut least) = (0, f64::INFINITY);
    for (p, x_p) in x.iter().enumerate() {
        let r = x_p - position;
        let square = r.dot(&r);
        if square < least * (1.0 - 1e-9) {
            (best, least) = (p, square);
        }
    }
    best
}
