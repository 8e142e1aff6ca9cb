//! The map of stability: every basis, scheme, mass, number of particles and offset,
//! predicted and measured.

use super::configuration::{Configuration, Template};
use super::pool;
use crate::run::stability;
use crate::run::table::{csv, shortest};
use crate::scene::fault::Fault;

/// Steps of a run that is asked whether it grows, and the width of the answer.
const STEPS: usize = 1500;
const TOLERANCE: f64 = 2e-3;

pub const BASES: [&str; 6] = ["linear", "ugimp", "bspline", "lme-0.8", "lme-1.8", "lme-4"];
pub const INTEGRATORS: [&str; 6] = [
    "newmark",
    "forward-euler-first",
    "forward-euler-last",
    "corrected-euler",
    "generalized-alpha-0.5",
    "generalized-alpha-0.8",
];

/// One combination and its limit as c Δt / h.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub configuration: Configuration,
    /// Of the particles, in units of their distance.
    pub offset: f64,
    /// Predicted and measured, or why there is none.
    pub limit: Result<(f64, f64), String>,
}

/// All combinations that a map has.
pub fn combinations(dimension: usize) -> Vec<(Configuration, f64)> {
    let mut all = Vec::new();
    for method in ["mpm", "otm"] {
        for basis in BASES {
            if method == "otm"
                && !(basis.starts_with("lme") || (basis == "linear" && dimension == 1))
            {
                continue;
            }
            for integrator in INTEGRATORS {
                for mass in ["lumped", "consistent"] {
                    if method == "otm" && (integrator != "newmark" || mass != "lumped") {
                        continue;
                    }
                    for particles_per_cell in [1, 2, 4] {
                        for offset in [0.0, 0.25] {
                            if method == "otm" && offset > 0.0 {
                                continue; // its points are where its nodes want them
                            }
                            let configuration = Configuration {
                                method: method.into(),
                                mass: mass.into(),
                                basis: basis.into(),
                                integrator: integrator.into(),
                                refinement: 1.0,
                                particles_per_cell,
                                cfl: 0.5,
                            };
                            all.push((configuration, offset));
                        }
                    }
                }
            }
        }
    }
    all
}

/// The limit of one combination.
fn row(template: &Template, (configuration, offset): &(Configuration, f64)) -> Row {
    let limit = || -> Result<(f64, f64), String> {
        let scene = template.scene(configuration).map_err(|fault| fault.to_string())?;
        let name = |breakdown: crate::method::breakdown::Breakdown| breakdown.to_string();
        let predicted = stability::predicted(&scene, *offset).map_err(name)?;
        if !predicted.is_finite() {
            return Err("nothing strains this body: there is no limit".to_string());
        }
        let measured = stability::measured(&scene, *offset, predicted, STEPS, TOLERANCE);
        let measured = measured.map_err(name)?;
        Ok((scene.courant_number_of(predicted), scene.courant_number_of(measured)))
    };
    Row { configuration: configuration.clone(), offset: *offset, limit: limit() }
}

/// The whole map; `progress` hears of every row.
pub fn map(
    template: &Template,
    dimension: usize,
    jobs: usize,
    progress: &mut dyn FnMut(),
) -> Vec<Row> {
    let all = combinations(dimension);
    let mut rows: Vec<Option<Row>> = vec![None; all.len()];
    let never: Result<(), std::convert::Infallible> = pool::run(
        &all,
        jobs,
        |one| row(template, one),
        |n, row| {
            rows[n] = Some(row);
            progress();
            Ok(())
        },
    );
    let Ok(()) = never;
    rows.into_iter().flatten().collect()
}

/// `method,mass,basis,integrator,particles_per_cell,offset,predicted,measured,problem`.
pub fn table(rows: &[Row]) -> Result<Vec<u8>, Fault> {
    let line = |row: &Row| {
        let c = &row.configuration;
        let mut cells =
            vec![c.method.clone(), c.mass.clone(), c.basis.clone(), c.integrator.clone()];
        cells.extend([c.particles_per_cell.to_string(), shortest(row.offset)]);
        cells.extend(match &row.limit {
            Ok((predicted, measured)) => [shortest(*predicted), shortest(*measured), String::new()],
            Err(problem) => [String::new(), String::new(), problem.clone()],
        });
        cells
    };
    let columns = [
        "method",
        "mass",
        "basis",
        "integrator",
        "particles_per_cell",
        "offset",
        "predicted",
        "measured",
        "problem",
    ];
    csv(&columns, rows.iter().map(line))
}
