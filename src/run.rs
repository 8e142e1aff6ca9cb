//! The time loop: scene → state → step, step, … → history.

use crate::continuum::state::{Particles, State};
use crate::cost::Cost;
use crate::exact::Exact;
use crate::fault::{Breakdown, Moment};
use crate::history::Table;
use crate::measure;
use crate::model::Model;
use crate::scene::{Motion, Quantity, Scene};
use crate::time;
use nalgebra::SVector;

/// Total energy may grow to this multiple of what was there at the start and
/// what loads have brought before a run counts as blown up. A stable run of an
/// elastic body keeps it near 1 or below.
const BLOW_UP: f64 = 10.0;

/// What a run gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// One row for each recorded step; see [`history_columns`].
    pub history: Table,
    /// The last state, one row for each particle.
    pub particles: Table,
    /// The particles at the recorded steps, if the scene asks for them.
    pub frames: Vec<Frame>,
    pub cost: Cost,
    /// Δt (s).
    pub dt: f64,
}

/// A run that broke down, with all that it had recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopped {
    pub breakdown: Breakdown,
    pub history: Table,
}

const AXIS: [&str; 3] = ["x", "y", "z"];

/// `name` in 1D; `name_x`, `name_y`, … in 2D and 3D.
fn per_axis(name: &str, dimension: usize) -> Vec<String> {
    match dimension {
        1 => vec![name.to_string()],
        _ => AXIS[..dimension].iter().map(|axis| format!("{name}_{axis}")).collect(),
    }
}

/// `step`, `t`, energies and, with loads, their work (J), momentum (kg m/s), from
/// 2D on angular momentum (kg m²/s), and each probe followed by its
/// exact value where the scene has an exact solution.
pub fn history_columns(scene: &Scene, with_exact: bool) -> Vec<String> {
    let mut columns: Vec<String> =
        ["step", "t", "kinetic_energy", "strain_energy"].map(String::from).to_vec();
    if loaded(scene) {
        columns.push("work".to_string());
    }
    columns.extend(per_axis("momentum", scene.dimension()));
    match scene.dimension() {
        1 => {}
        2 => columns.push("angular_momentum".to_string()),
        _ => columns.extend(per_axis("angular_momentum", 3)),
    }
    for probe in &scene.probes {
        columns.push(probe.name.clone());
        if with_exact {
            columns.push(format!("{}_exact", probe.name));
        }
    }
    columns
}

/// True for a scene on which forces act from outside.
pub fn loaded(scene: &Scene) -> bool {
    let manufactured = matches!(scene.motion, Motion::Manufactured { .. });
    manufactured || scene.body_force.is_some() || scene.traction.is_some()
}

/// Runs a scene to its end; `progress` hears the number of every finished step.
///
/// Errors: [`Stopped`] when the run breaks down.
pub fn run(scene: &Scene, progress: &mut dyn FnMut(usize)) -> Result<Outcome, Box<Stopped>> {
    match scene.dimension() {
        1 => run_in::<1>(scene, progress),
        2 => run_in::<2>(scene, progress),
        _ => run_in::<3>(scene, progress),
    }
}

fn run_in<const D: usize>(
    scene: &Scene,
    progress: &mut dyn FnMut(usize),
) -> Result<Outcome, Box<Stopped>> {
    let model = Model::<D>::of(scene);
    let mut state = model.initial_state(scene);
    let mut recorder = Recorder::new(scene, &model, &state.particle);
    let bytes = Particles::<D>::BYTES
        + model.basis.bytes_per_particle::<D>()
        + model.method.bytes_per_particle::<D>();
    let mut cost = Cost { bytes_per_particle: bytes as u64, ..Cost::default() };
    match march(scene, &model, &mut state, &mut recorder, &mut cost, progress) {
        Err(breakdown) => Err(Box::new(Stopped { breakdown, history: recorder.history })),
        Ok(()) => {
            let reference = recorder.reference;
            let end = model.steps as f64 * model.dt;
            Ok(Outcome {
                particles: table(scene, &state.particle, &reference, &recorder.exact, end),
                frames: recorder.frames,
                history: recorder.history,
                cost,
                dt: model.dt,
            })
        }
    }
}

fn march<const D: usize>(
    scene: &Scene,
    model: &Model<D>,
    state: &mut State<D>,
    recorder: &mut Recorder<D>,
    cost: &mut Cost,
    progress: &mut dyn FnMut(usize),
) -> Result<(), Breakdown> {
    time::start(state, model, cost)?;
    recorder.record(scene, state, model, Moment::START)?;
    for step in 1..=model.steps {
        let moment = Moment { step, time: step as f64 * model.dt };
        time::advance(state, model, moment, cost)?;
        recorder.load(&state.particle, model, moment);
        if step % scene.every == 0 || step == model.steps {
            recorder.record(scene, state, model, moment)?;
        }
        progress(step);
    }
    Ok(())
}

/// A probe tied to its particle.
struct Follow<const D: usize> {
    quantity: Quantity,
    particle: usize,
    /// Where the particle stood at t = 0 (m).
    reference: SVector<f64, D>,
}

/// Writes the history.
struct Recorder<const D: usize> {
    history: Table,
    follow: Vec<Follow<D>>,
    exact: Option<Exact>,
    /// Total energy at the start (J).
    energy: f64,
    /// What the loads do; `None` without loads.
    work: Option<Work<D>>,
    /// The particles at the recorded steps, if asked for.
    frames: Vec<Frame>,
    /// Where the particles stood at t = 0 (m).
    reference: Vec<SVector<f64, D>>,
}

/// The work of the loads so far.
struct Work<const D: usize> {
    sum: f64,
    /// The same without signs, what the loads have moved to and fro (J).
    moved: f64,
    /// x_p of the step before (m).
    before: Vec<SVector<f64, D>>,
}

/// The particles at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// (s).
    pub time: f64,
    /// One row for each particle.
    pub particles: Table,
}

impl<const D: usize> Recorder<D> {
    fn new(scene: &Scene, model: &Model<D>, particle: &Particles<D>) -> Self {
        let exact = Exact::of(scene).ok();
        let follow = scene.probes.iter().map(|probe| {
            let position = SVector::from_fn(|d, _| probe.position[d]);
            let p = nearest(&particle.x, &position);
            Follow { quantity: probe.quantity, particle: p, reference: particle.x[p] }
        });
        Recorder {
            follow: follow.collect(),
            history: Table::new(
                history_columns(scene, exact.is_some()),
                model.steps / scene.every + 2,
            ),
            exact,
            energy: 0.0,
            work: loaded(scene).then(|| Work { sum: 0.0, moved: 0.0, before: particle.x.clone() }),
            frames: Vec::new(),
            reference: particle.x.clone(),
        }
    }

    /// Adds the work of the loads over the step that ends at `moment`.
    fn load(&mut self, particle: &Particles<D>, model: &Model<D>, moment: Moment) {
        if let (Some(work), Some(loads)) = (&mut self.work, &model.loads) {
            let step = loads.work(particle, &work.before, moment.time - model.dt, model.dt);
            work.sum += step;
            work.moved += step.abs();
            work.before.copy_from_slice(&particle.x);
        }
    }

    fn record(
        &mut self,
        scene: &Scene,
        state: &State<D>,
        model: &Model<D>,
        moment: Moment,
    ) -> Result<(), Breakdown> {
        let (particle, carriers) = (&state.particle, state.carriers());
        let kinetic = measure::kinetic_energy(&carriers);
        let strain = measure::strain_energy(particle, &model.law);
        if !(kinetic + strain).is_finite() {
            let particle = most_energetic(particle, model);
            return Err(Breakdown::NotFinite { particle, moment, symbol: "energy" });
        }
        if moment.step == 0 {
            self.energy = kinetic + strain;
        }
        let available = self.energy + self.work.as_ref().map_or(0.0, |work| work.moved);
        if available > 0.0 && kinetic + strain > BLOW_UP * available {
            return Err(Breakdown::Diverged {
                particle: most_energetic(particle, model),
                moment,
                ratio: (kinetic + strain) / available,
            });
        }
        self.history.push(moment.step as f64);
        self.history.push(moment.time);
        self.history.push(kinetic);
        self.history.push(strain);
        if let Some(work) = &self.work {
            self.history.push(work.sum);
        }
        for p_i in measure::momentum(&carriers).iter() {
            self.history.push(*p_i);
        }
        for l_i in measure::angular_momentum(&carriers) {
            self.history.push(l_i);
        }
        for follow in &self.follow {
            let p = follow.particle;
            self.history.push(match follow.quantity {
                Quantity::Velocity(i) => particle.v[p][i],
                Quantity::Stress(i, j) => particle.sigma[p][(i, j)],
                Quantity::Displacement(i) => particle.x[p][i] - follow.reference[i],
            });
            if let Some(exact) = &self.exact {
                let fields = exact.at(follow.reference[0], moment.time);
                self.history.push(match follow.quantity {
                    Quantity::Velocity(_) => fields.velocity,
                    Quantity::Stress(..) => fields.stress,
                    Quantity::Displacement(_) => fields.displacement,
                });
            }
        }
        if scene.vtk {
            let particles = table(scene, particle, &self.reference, &self.exact, moment.time);
            self.frames.push(Frame { time: moment.time, particles });
        }
        Ok(())
    }
}

/// The particle nearest to `position`; of equally near ones the first.
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

fn most_energetic<const D: usize>(particle: &Particles<D>, model: &Model<D>) -> usize {
    let energy = |p: usize| {
        let v: SVector<f64, D> = particle.v[p];
        0.5 * particle.m[p] * v.dot(&v) + measure::strain_energy_of(particle, &model.law, p)
    };
    (0..particle.len()).max_by(|a, b| energy(*a).total_cmp(&energy(*b))).unwrap_or(0)
}

/// `particles.csv`: every particle in the scene's own coordinates at time `t`.
fn table<const D: usize>(
    scene: &Scene,
    particle: &Particles<D>,
    reference: &[SVector<f64, D>],
    exact: &Option<Exact>,
    t: f64,
) -> Table {
    let mut columns = vec!["particle".to_string()];
    for name in ["position", "displacement", "velocity"] {
        columns.extend(per_axis(name, D));
    }
    let pairs: Vec<(usize, usize)> = (0..D).flat_map(|i| (i..D).map(move |j| (i, j))).collect();
    match D {
        1 => columns.push("stress".to_string()),
        _ => columns.extend(pairs.iter().map(|(i, j)| format!("stress_{}{}", AXIS[*i], AXIS[*j]))),
    }
    columns.extend(["density", "mass"].map(String::from));
    if exact.is_some() {
        columns.extend(["displacement", "velocity", "stress"].map(|name| format!("{name}_exact")));
    }
    let mut table = Table::new(columns, particle.len());
    for p in 0..particle.len() {
        table.push(p as f64);
        for i in 0..D {
            table.push(scene.body.origin[i] + particle.x[p][i]);
        }
        for i in 0..D {
            table.push(particle.x[p][i] - reference[p][i]);
        }
        for i in 0..D {
            table.push(particle.v[p][i]);
        }
        for (i, j) in &pairs {
            table.push(particle.sigma[p][(*i, *j)]);
        }
        table.push(particle.rho[p]);
        table.push(particle.m[p]);
        if let Some(exact) = exact {
            let fields = exact.at(reference[p][0], t);
            table.push(fields.displacement);
            table.push(fields.velocity);
            table.push(fields.stress);
        }
    }
    table
}
