//! Writes the history of a run.

use super::columns::per_axis;
use super::outcome::Frame;
use super::particles;
use super::table::Table;
use crate::method::breakdown::{Breakdown, Moment};
use crate::method::continuum::state::Particles;
use crate::method::exact::Exact;
use crate::method::measure;
use crate::method::model::{Model, State};
use crate::scene::{Quantity, Scene};
use crate::setup;
use nalgebra::SVector;

/// The recorder writes the history.
pub struct Recorder<'a, const D: usize> {
    pub history: Table,
    /// The particles at the recorded steps, if asked for.
    pub frames: Vec<Frame>,
    scene: &'a Scene,
    model: &'a Model<D>,
    exact: Option<Exact<D>>,
    /// The particle that each probe follows.
    followed: Vec<usize>,
    /// X_p, from which displacements count (m).
    reference: Vec<SVector<f64, D>>,
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
        let work = model.loads.as_ref().map(|_| 0.0);
        let mut recorder = Recorder {
            history: Table::new(),
            frames: Vec::new(),
            scene,
            model,
            exact: setup::exact(scene).ok(),
            followed,
            reference,
        };
        // Names the columns, which a run that breaks down at once has, too.
        recorder.row(state, Moment::START, [0.0; 2], work);
        recorder.history.clear();
        recorder
    }

    /// Takes up the step that ends at `moment`, and records it if it is one to record; `work`
    /// of the loads so far (J).
    ///
    /// Errors: those of [`Recorder::record`].
    pub fn follow(
        &mut self,
        state: &State<D>,
        moment: Moment,
        work: Option<f64>,
    ) -> Result<(), Breakdown> {
        let last = moment.step == self.model.steps;
        if moment.step.is_multiple_of(self.scene.every) || last {
            self.record(state, moment, work)?;
        }
        Ok(())
    }

    /// Records the state at `moment`, and the `work` of the loads so far (J).
    ///
    /// Errors: [`Breakdown::NotFinite`] by its energy.
    pub fn record(
        &mut self,
        state: &State<D>,
        moment: Moment,
        work: Option<f64>,
    ) -> Result<(), Breakdown> {
        let particle = &state.particle;
        let kinetic = measure::kinetic_energy(&state.carriers(self.model.method));
        let strain = measure::strain_energy(particle, &self.model.law);
        if !(kinetic + strain).is_finite() {
            let particle = measure::most_energetic(particle, &self.model.law);
            return Err(Breakdown::NotFinite { particle, symbol: "energy" });
        }
        self.row(state, moment, [kinetic, strain], work);
        if self.scene.vtk {
            let particles = self.particles(state, moment.time);
            self.frames.push(Frame { time: moment.time, particles });
        }
        Ok(())
    }

    /// Writes a row: `step`, `t`, energies and, with loads, their work (J), of an implicit step its
    /// iterations and the residual that is left (–), momentum (kg m/s), from 2D on angular momentum
    /// (kg m²/s), and the probes.
    fn row(
        &mut self,
        state: &State<D>,
        moment: Moment,
        [kinetic, strain]: [f64; 2],
        work: Option<f64>,
    ) {
        let carriers = state.carriers(self.model.method);
        let history = &mut self.history;
        history.put(|| "step".into(), moment.step as f64);
        history.put(|| "t".into(), moment.time);
        history.put(|| "kinetic_energy".into(), kinetic);
        history.put(|| "strain_energy".into(), strain);
        if let Some(work) = work {
            history.put(|| "work".into(), work);
        }
        if let Some(system) = &state.equilibrium {
            let residuals = &system.residuals;
            let iterations = residuals.len().saturating_sub(1);
            history.put(|| "equilibrium_iterations".into(), iterations as f64);
            let residual = residuals.last().copied().unwrap_or(0.0);
            history.put(|| "equilibrium_residual".into(), residual);
        }
        for (i, p_i) in measure::momentum(&carriers).iter().enumerate() {
            history.put(|| per_axis("momentum", D, i), *p_i);
        }
        for (i, l_i) in measure::angular_momentum(&carriers).iter().enumerate() {
            let axes = if D == 3 { 3 } else { 1 };
            history.put(|| per_axis("angular_momentum", axes, i), *l_i);
        }
        self.probes(&state.particle, moment.time);
        self.history.end_row();
    }

    /// Writes each probe at time `t` (s), followed by its exact value where the scene has an exact
    /// solution.
    fn probes(&mut self, particle: &Particles<D>, t: f64) {
        let history = &mut self.history;
        for (probe, p) in self.scene.probes.iter().zip(&self.followed) {
            let (p, reference) = (*p, self.reference[*p]);
            let value = match probe.quantity {
                Quantity::Velocity(i) => particle.v[p][i],
                Quantity::Stress(i, j) => particle.sigma[p][(i, j)],
                Quantity::Displacement(i) => particle.u[p][i],
            };
            history.put(|| probe.name.clone(), value);
            if let Some(exact) = &self.exact {
                let fields = exact.at(&reference, t);
                let value = match probe.quantity {
                    Quantity::Velocity(i) => fields.velocity[i],
                    Quantity::Stress(i, j) => fields.stress[(i, j)],
                    Quantity::Displacement(i) => fields.displacement[i],
                };
                history.put(|| format!("{}_exact", probe.name), value);
            }
        }
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
