//! The parametric study of γ: from the mesh-free end to the finite-element end.

use super::configuration::{Configuration, Template};
use super::pool;
use crate::output::summary;
use crate::run::stability;
use crate::run::table::{csv, shortest};
use crate::run::{self, run};
use crate::scene::DYKA;
use crate::scene::fault::Fault;
use std::path::Path;

/// The values of γ.
pub const GAMMAS: [f64; 12] = [0.3, 0.5, 0.8, 1.0, 1.4, 1.8, 2.5, 4.0, 6.0, 10.0, 20.0, 50.0];

/// What is varied beside γ: method, mass, particles per cell, cΔt/h.
pub const WAYS: [(&str, &str, &str, usize, f64); 3] = [
    ("mpm lumped", "mpm", "lumped", 2, 0.5),
    ("mpm consistent", "mpm", "consistent", 2, 0.2),
    ("otm", "otm", "lumped", 1, 0.5),
];

/// Columns of [`Row::values`].
pub const COLUMNS: [&str; 10] = [
    "velocity",
    "stress",
    "displacement",
    "overshoot",
    "total_variation",
    "dispersion",
    "energy_drift",
    "pairs_per_particle",
    "exponentials_per_particle",
    "critical_courant",
];

/// One γ in one way; values as in [`COLUMNS`], or why there are none.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub way: &'static str,
    pub gamma: f64,
    pub values: Result<Vec<f64>, String>,
}

/// The bar of Dyka and Ingel at every γ in every way.
pub fn rows(jobs: usize, progress: &mut dyn FnMut()) -> Result<Vec<Row>, Fault> {
    let template = Template::parse(Path::new("dyka.toml"), DYKA)?;
    let items: Vec<(usize, f64)> =
        (0..WAYS.len()).flat_map(|way| GAMMAS.map(|gamma| (way, gamma))).collect();
    let mut rows: Vec<Option<Row>> = vec![None; items.len()];
    pool::run(
        &items,
        jobs,
        |(way, gamma)| Row {
            way: WAYS[*way].0,
            gamma: *gamma,
            values: values(&template, *way, *gamma),
        },
        |n, row| {
            rows[n] = Some(row);
            progress();
            Ok::<(), Fault>(())
        },
    )?;
    Ok(rows.into_iter().flatten().collect())
}

fn values(template: &Template, way: usize, gamma: f64) -> Result<Vec<f64>, String> {
    let (_, method, mass, particles_per_cell, cfl) = WAYS[way];
    let configuration = Configuration {
        method: method.into(),
        mass: mass.into(),
        basis: format!("lme-{gamma}"),
        integrator: "newmark".into(),
        refinement: 1.0,
        particles_per_cell,
        cfl,
    };
    let scene = template.scene(&configuration).map_err(|fault| fault.to_string())?;
    let outcome = run(&scene, &mut |_| {}).map_err(|stopped| stopped.broken.to_string())?;
    let lines = summary::lines(&scene, &outcome, 0.0);
    let line = |name: &str| lines.iter().find(|l| l.quantity == name).map_or(f64::NAN, |l| l.value);
    let column = |name: &str| outcome.history.column(name).unwrap_or_default();
    let variation =
        |list: &[f64]| list.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>();
    let probe = "stress_three_quarter";
    let (stress, exact) = (column(probe), column(&format!("{probe}_exact")));
    let cost = outcome.cost;
    let per_particle = |count: u64| count as f64 / cost.basis_evaluations as f64;
    let limit = stability::predicted(&scene, 0.0).map_err(|breakdown| breakdown.to_string())?;
    Ok(vec![
        line("velocity_end_rms_relative"),
        line(&format!("{probe}_rms_relative")),
        line("displacement_field_rms_relative"),
        line(&format!("{probe}_peak")) / line(&format!("{probe}_peak_exact")) - 1.0,
        variation(&stress) / variation(&exact),
        dispersion(&configuration)?,
        line("energy_drift_largest"),
        per_particle(cost.particle_node_pairs),
        per_particle(cost.exponentials),
        scene.courant_number_of(limit),
    ])
}

/// The relative error of the frequency of a wave that is eight cells long, small time
/// steps: the phase of its mode after a quarter of its period, over π/2, less 1. (After
/// a whole period a slow wave could be taken for a fast one.)
fn dispersion(configuration: &Configuration) -> Result<f64, String> {
    let (cells, mode) = (32, 8);
    let text = format!(
        "title = 'wave'\nmethod = '{}'\nmass = '{}'\n\
         body = {{ length = 1, density = 1, youngs_modulus = 1, poisson_ratio = 0 }}\n\
         grid = {{ cells = {cells}, particles_per_cell = {} }}\n\
         basis = {{ kind = 'lme', gamma = {} }}\n\
         time = {{ integrator = 'newmark', cfl = 0.02, end = {:?} }}\n\
         boundary = {{ left = 'fixed', right = 'fixed' }}\n\
         vibration = {{ mode = {mode}, velocity = 1e-7 }}\n",
        configuration.method,
        configuration.mass,
        configuration.particles_per_cell,
        configuration.basis.trim_start_matches("lme-"),
        0.5 / f64::from(mode),
    );
    let scene = run::parse("wave", "wave", &text, &[]).map_err(|error| error.problem.clone())?;
    let outcome = run(&scene, &mut |_| {}).map_err(|stopped| stopped.broken.to_string())?;
    let column = |name: &str| outcome.particles.column(name).unwrap_or_default();
    let k = f64::from(mode) * std::f64::consts::PI;
    let (x, u, v) = (column("position"), column("displacement"), column("velocity"));
    let onto = |list: &[f64]| -> f64 {
        list.iter().zip(x.iter().zip(&u)).map(|(y, (x, u))| y * libm::sin(k * (x - u))).sum()
    };
    Ok(libm::atan2(onto(&u) * k, onto(&v)) / std::f64::consts::FRAC_PI_2 - 1.0)
}

/// The study as CSV.
pub fn table(rows: &[Row]) -> Result<Vec<u8>, Fault> {
    let line = |row: &Row| {
        let mut cells = vec![row.way.to_string(), shortest(row.gamma)];
        match &row.values {
            Ok(list) => {
                cells.extend(list.iter().map(|x| shortest(*x)));
                cells.push(String::new());
            }
            Err(problem) => {
                cells.extend(vec![String::new(); COLUMNS.len()]);
                cells.push(problem.clone());
            }
        }
        cells
    };
    let mut columns = vec!["way", "gamma"];
    columns.extend(COLUMNS);
    columns.push("problem");
    csv(&columns, rows.iter().map(line))
}
