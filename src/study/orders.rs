//! A motion with an exact solution is run on finer and finer grids, or with smaller and smaller
//! time steps: does the error fall, and how fast?
//!
//! Many particles per cell, and volumes that are the exact ones, tell the error of the sums over
//! particles from that of crossing cells.

use super::configuration::{Configuration, Template};
use super::map::BASES;
use super::pool;
use super::rows::size;
use crate::method::continuum::law::volume_change;
use crate::method::exact::{Exact, Moved};
use crate::method::measure::{Order, observed_order};
use crate::method::model::State;
use crate::method::time;
use crate::output::summary::Scales;
use crate::run::table::{csv, shortest};
use crate::scene::Scene;
use crate::scene::fault::Fault;
use crate::setup;
use nalgebra::{SMatrix, SVector};

// ANCHOR: ladder
/// A ladder is one way to compute the motion on every rung: a grid, or a time step.
#[derive(Clone, Debug, PartialEq)]
pub struct Ladder {
    basis: &'static str,
    mass: &'static str,
    pub particles_per_cell: usize,
    /// How many times the scene's own time the motion lasts.
    pub spans: usize,
    pub volumes: Volumes,
    pub along: Along,
}

/// The volumes of the particles may be their own, or put right after every step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Volumes {
    Own,
    Exact,
}

/// A ladder goes down in h, with Δt in proportion to h², or in Δt alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    Spacing,
    TimeStep,
}

// ANCHOR_END: ladder

/// Of every rung these are the relative errors of velocity, stress and displacement: of all
/// particles at the end, against the exact solution, or along Δt against a run with an eighth of
/// the smallest time step.
#[derive(Clone, Debug, PartialEq)]
pub struct Climbed {
    /// h or Δt of every rung, relative to the first.
    pub sizes: Vec<f64>,
    pub errors: Vec<[f64; 3]>,
}

/// An ascent is a ladder with what came of it, or where it broke.
#[derive(Clone, Debug, PartialEq)]
pub struct Ascent {
    pub ladder: Ladder,
    pub climbed: Result<Climbed, String>,
}

const MASSES: [&str; 2] = ["mass=lumped", "mass=consistent"];

impl Ladder {
    /// Gives the name of its row.
    pub fn name(&self) -> String {
        let Ladder { basis, mass, particles_per_cell, spans, .. } = self;
        let volumes = if self.volumes == Volumes::Own { "own" } else { "exact" };
        let along = if self.along == Along::Spacing { "h" } else { "dt" };
        format!(
            "{basis} {mass} particles_per_cell={particles_per_cell} spans={spans} \
             volumes={volumes} along={along}"
        )
    }

    /// Gives what each rung makes of the scene's cells and Courant number: the finest grid and the
    /// largest Courant number are the scene's own; along Δt the grid has half of its cells.
    fn rungs(&self, dimension: usize) -> Vec<[f64; 2]> {
        match (self.along, dimension) {
            (Along::TimeStep, _) => [1.0, 0.5, 0.25, 0.125].map(|step| [0.5, step]).to_vec(),
            (Along::Spacing, 1) => {
                [0.125, 0.25, 0.5, 1.0].map(|fine| [fine, 0.125 / fine]).to_vec()
            }
            (Along::Spacing, _) => [0.25, 0.5, 1.0].map(|fine| [fine, 0.25 / fine]).to_vec(),
        }
    }

    /// Reads the scene of a rung.
    fn scene(&self, template: &Template, [refinement, step]: [f64; 2]) -> Result<Scene, String> {
        let words = |fault: Fault| fault.to_string();
        let grid = template.grid("mpm", refinement, self.particles_per_cell);
        let cfl = shortest(template.scene.time.cfl * step);
        let line = format!(
            "method=mpm {} {} time.integrator=newmark {grid} time.cfl={cfl}",
            self.mass, self.basis
        );
        let configuration: Configuration = line.parse().map_err(words)?;
        let mut scene = template.scene(&configuration).map_err(words)?;
        scene.time.end *= self.spans as f64;
        Ok(scene)
    }
}

/// Lists all ladders of the study.
pub fn ladders() -> Vec<Ladder> {
    let mut all = Vec::new();
    for basis in BASES {
        for mass in MASSES {
            let one = |particles_per_cell, spans, volumes, along| Ladder {
                basis,
                mass,
                particles_per_cell,
                spans,
                volumes,
                along,
            };
            for spans in [1, 5] {
                all.extend([1, 2, 3, 4, 8].map(|n| one(n, spans, Volumes::Own, Along::Spacing)));
            }
            all.extend([2, 8].map(|n| one(n, 1, Volumes::Exact, Along::Spacing)));
            all.extend([2, 4].map(|n| one(n, 1, Volumes::Own, Along::TimeStep)));
        }
    }
    all
}

/// Climbs some ladders on a scene; `progress` hears of every one.
pub fn study(
    template: &Template,
    ladders: &[Ladder],
    jobs: usize,
    progress: &mut dyn FnMut(),
) -> Vec<Ascent> {
    let work = |ladder: &Ladder| {
        let climbed = match template.scene.dimension() {
            1 => climb::<1>(template, ladder),
            2 => climb::<2>(template, ladder),
            _ => climb::<3>(template, ladder),
        };
        Ascent { ladder: ladder.clone(), climbed }
    };
    pool::all(ladders, jobs, work, progress)
}

/// Runs all rungs of one ladder.
fn climb<const D: usize>(template: &Template, ladder: &Ladder) -> Result<Climbed, String> {
    let rungs = ladder.rungs(D);
    let scenes =
        rungs.iter().map(|rung| ladder.scene(template, *rung)).collect::<Result<Vec<_>, _>>()?;
    let reference = match (ladder.along, rungs.last()) {
        (Along::TimeStep, Some([refinement, step])) => {
            let scene = ladder.scene(template, [*refinement, step / 8.0])?;
            Some(ended::<D>(&scene, ladder.volumes)?)
        }
        _ => None,
    };
    let (mut sizes, mut errors) = (Vec::new(), Vec::new());
    for ([refinement, step], scene) in rungs.iter().zip(&scenes) {
        let state = ended::<D>(scene, ladder.volumes)?;
        errors.push(match &reference {
            None => from_exact(scene, &state)?,
            Some(reference) => between(scene, &state, reference),
        });
        if errors.last().is_some_and(|error| error.iter().any(|x| !x.is_finite())) {
            return Err("its relative errors are no finite numbers".to_string());
        }
        let [first, first_step] = rungs[0];
        sizes.push(match ladder.along {
            Along::Spacing => first / refinement,
            Along::TimeStep => step / first_step,
        });
    }
    Ok(Climbed { sizes, errors })
}

/// Runs a scene to its end, with its own volumes or exact ones.
fn ended<const D: usize>(scene: &Scene, volumes: Volumes) -> Result<State<D>, String> {
    let model = setup::model::<D>(scene);
    let mut state = setup::initial_state(&model, scene);
    let exact = match (volumes, setup::exact::<D>(scene)) {
        (Volumes::Exact, Ok(Exact::Moved(moved))) => Some((moved, setup::material_points(scene))),
        _ => None,
    };
    let cells = scene.grid.cells[0];
    let at = |step: usize| move |what| format!("{cells} cells, step {step}: {what}");
    time::start(&mut state, &model, &mut |_, _| {}).map_err(at(0))?;
    for step in 1..=model.steps {
        let t = step as f64 * model.dt;
        time::advance(&mut state, &model, t, &mut |_, _| {}).map_err(at(step))?;
        if let Some((moved, X)) = &exact {
            put_right(&mut state, moved, X, scene.body.density, t);
        }
    }
    Ok(state)
}

/// Gives the particles their exact densities ρ_0/J, and so their exact volumes.
fn put_right<const D: usize>(
    state: &mut State<D>,
    moved: &Moved<D>,
    X: &[SVector<f64, D>],
    density: f64,
    t: f64,
) {
    for p in 0..X.len() {
        let H = moved.deformation(&X[p], t) - SMatrix::identity();
        state.particle.rho[p] = density / (1.0 + volume_change(&H));
    }
}

/// Gives the errors against the exact solution.
fn from_exact<const D: usize>(scene: &Scene, state: &State<D>) -> Result<[f64; 3], String> {
    let exact = setup::exact::<D>(scene).map_err(|fault| fault.to_string())?;
    let (t, X) = (scene.time.end, setup::material_points::<D>(scene));
    Ok(errors(scene, state, |p| {
        let fields = exact.at(&X[p], t);
        (fields.velocity, fields.stress, X[p] + fields.displacement)
    }))
}

/// Gives the differences from another run.
fn between<const D: usize>(scene: &Scene, state: &State<D>, other: &State<D>) -> [f64; 3] {
    let other = &other.particle;
    errors(scene, state, |p| (other.v[p], other.sigma[p], other.x[p]))
}

/// Gives the roots of the mean squares of what v, σ and x of all particles are off, relative to
/// the scene's own scales.
fn errors<const D: usize>(
    scene: &Scene,
    state: &State<D>,
    expected: impl Fn(usize) -> (SVector<f64, D>, SMatrix<f64, D, D>, SVector<f64, D>),
) -> [f64; 3] {
    let particle = &state.particle;
    let mut squares = [0.0; 3];
    for p in 0..particle.len() {
        let (v, sigma, x) = expected(p);
        squares[0] += (particle.v[p] - v).norm_squared();
        squares[1] += (particle.sigma[p] - sigma).norm_squared();
        squares[2] += (particle.x[p] - x).norm_squared();
    }
    let Scales { velocity, stress, displacement } = Scales::of(scene);
    let scales = [velocity, stress, displacement];
    let root = |n: usize| libm::sqrt(squares[n] / particle.len() as f64) / scales[n];
    std::array::from_fn(root)
}

impl Climbed {
    /// Fits the orders of velocity, stress and displacement.
    pub fn orders(&self) -> [Order; 3] {
        std::array::from_fn(|n| {
            let errors: Vec<f64> = self.errors.iter().map(|error| error[n]).collect();
            observed_order(&self.sizes, &errors)
        })
    }
}

/// Names the columns of the table.
pub fn columns() -> Vec<&'static str> {
    vec![
        "ladder",
        "sizes",
        "velocity_errors",
        "stress_errors",
        "displacement_errors",
        "velocity_order",
        "velocity_interval",
        "stress_order",
        "stress_interval",
        "displacement_order",
        "displacement_interval",
        "problem",
    ]
}

/// Writes the study as CSV; sizes and errors as lists with spaces between the numbers.
pub fn table(rows: &[Ascent]) -> Result<Vec<u8>, Fault> {
    let list = |numbers: Vec<f64>| numbers.into_iter().map(shortest).collect::<Vec<_>>().join(" ");
    let line = |row: &Ascent| {
        let mut cells = vec![row.ladder.name()];
        match &row.climbed {
            Ok(climbed) => {
                cells.push(list(climbed.sizes.clone()));
                cells
                    .extend([0, 1, 2].map(|n| list(climbed.errors.iter().map(|e| e[n]).collect())));
                // Errors of 0 have no order.
                let cell = |x: f64| if x.is_finite() { shortest(x) } else { String::new() };
                for Order { slope, half_width } in climbed.orders() {
                    cells.extend([slope, half_width].map(cell));
                }
                cells.push(String::new());
            }
            Err(problem) => {
                cells.extend(vec![String::new(); columns().len() - 2]);
                cells.push(problem.clone());
            }
        }
        cells
    };
    csv(&columns(), rows.iter().map(line))
}

/// Reads a row of the table, with its name.
pub fn read(cells: &[&str]) -> Option<(String, Ascent)> {
    let [name, sizes, v, sigma, u, .., problem] = cells else { return None };
    let ladder = ladders().into_iter().find(|ladder| ladder.name() == *name)?;
    let list = |text: &str| -> Option<Vec<f64>> { text.split(' ').map(size).collect() };
    let climbed = match *problem {
        "" => {
            let (sizes, v, sigma, u) = (list(sizes)?, list(v)?, list(sigma)?, list(u)?);
            if [v.len(), sigma.len(), u.len()] != [sizes.len(); 3] {
                return None;
            }
            let errors = v.iter().zip(&sigma).zip(&u).map(|((v, sigma), u)| [*v, *sigma, *u]);
            Ok(Climbed { sizes, errors: errors.collect() })
        }
        problem => Err(problem.to_string()),
    };
    Some((name.to_string(), Ascent { ladder, climbed }))
}
