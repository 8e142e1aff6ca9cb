//! The map of stability has the largest stable time step of every basis, scheme, mass,
//! number of particles and offset, predicted and measured.

use super::configuration::{Configuration, KEYS, Template};
use super::pool;
use super::rows::size;
use crate::method::breakdown::Breakdown;
use crate::run::stability;
use crate::run::table::{csv, shortest};
use crate::scene::fault::Fault;

/// A run that is asked whether it grows takes so many steps, and the limit is bracketed to this
/// width, relative to itself.
const STEPS: usize = 1500;
const TOLERANCE: f64 = 2e-3;

/// Every basis stands here with what it needs.
pub const BASES: [&str; 6] = [
    "basis.kind=linear",
    "basis.kind=ugimp",
    "basis.kind=bspline",
    "basis.kind=lme basis.gamma=0.8",
    "basis.kind=lme basis.gamma=1.8",
    "basis.kind=lme basis.gamma=4",
];

/// Every integrator stands here with what it needs; Newmark's is the first.
pub const INTEGRATORS: [&str; 6] = [
    "time.integrator=newmark",
    "time.integrator=forward-euler time.stress_update=first",
    "time.integrator=forward-euler time.stress_update=last",
    "time.integrator=corrected-euler",
    "time.integrator=generalized-alpha time.rho_b=0.5",
    "time.integrator=generalized-alpha time.rho_b=0.8",
];

/// A combination is what the map asks the limit of.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    pub configuration: Configuration,
    pub particles_per_cell: usize,
    /// Of the particles, in units of their distance.
    pub offset: f64,
}

/// A limit is the largest stable c Δt / h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    pub predicted: f64,
    pub measured: f64,
}

/// A place on the map is a combination with its limit, or with a reason why there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapped {
    pub combination: Combination,
    pub limit: Result<Limit, String>,
}

/// Lists all combinations that a map of the scene has.
pub fn combinations(template: &Template) -> Result<Vec<Combination>, Fault> {
    let mut all = Vec::new();
    let mut add = |method: &str, parts: &str, particles_per_cell: usize, offset: f64| {
        let grid = template.grid(method, 1.0, particles_per_cell);
        let configuration = format!("method={method} {parts} {grid} time.cfl=0.5").parse()?;
        all.push(Combination { configuration, particles_per_cell, offset });
        Ok::<(), Fault>(())
    };
    for basis in BASES {
        for integrator in INTEGRATORS {
            for mass in ["mass=lumped", "mass=consistent"] {
                for per_cell in [1, 2, 4] {
                    for offset in [0.0, 0.25] {
                        add("mpm", &format!("{mass} {basis} {integrator}"), per_cell, offset)?;
                    }
                }
            }
        }
    }
    // The points of OTM are where its nodes want them, and its nodes are scattered.
    let on_nodes = |basis: &&str| match template.scene.dimension() {
        1 => basis.contains("lme") || basis.contains("linear"),
        _ => basis.contains("lme"),
    };
    for basis in BASES.iter().filter(|basis| on_nodes(basis)) {
        for per_cell in [1, 2, 4] {
            add("otm", &format!("mass=lumped {basis} {}", INTEGRATORS[0]), per_cell, 0.0)?;
        }
    }
    Ok(all)
}

/// Predicts and measures the limit of one combination.
fn limit(
    template: &Template,
    Combination { configuration, offset, .. }: &Combination,
) -> Result<Limit, String> {
    let scene = template.scene(configuration).map_err(|fault| fault.to_string())?;
    let words = |breakdown: Breakdown| breakdown.to_string();
    let predicted = stability::predicted(&scene, *offset).map_err(words)?;
    if !predicted.is_finite() {
        return Err("nothing strains this body: there is no limit".to_string());
    }
    let measured =
        stability::measured(&scene, *offset, predicted, STEPS, TOLERANCE).map_err(words)?;
    if !measured.is_finite() {
        return Err("no step up to a thousand times the predicted limit grows".to_string());
    }
    let [predicted, measured] = [predicted, measured].map(|dt| scene.courant_number_of(dt));
    Ok(Limit { predicted, measured })
}

/// Finds the limits of some combinations; `progress` hears of every one.
pub fn map(
    template: &Template,
    combinations: &[Combination],
    jobs: usize,
    progress: &mut dyn FnMut(),
) -> Vec<Mapped> {
    let work = |one: &Combination| Mapped { combination: one.clone(), limit: limit(template, one) };
    pool::all(combinations, jobs, work, progress)
}

/// Writes every combination key by key, then `offset,predicted,measured,problem`.
pub fn table(rows: &[Mapped]) -> Result<Vec<u8>, Fault> {
    let line = |Mapped { combination, limit }: &Mapped| {
        let value = |key| combination.configuration.value(key).to_string();
        let mut cells = KEYS.map(value).to_vec();
        cells.push(shortest(combination.offset));
        cells.extend(match limit {
            Ok(limit) => [shortest(limit.predicted), shortest(limit.measured), String::new()],
            Err(problem) => [String::new(), String::new(), problem.clone()],
        });
        cells
    };
    csv(&columns(), rows.iter().map(line))
}

/// Names the columns of the table.
pub fn columns() -> Vec<&'static str> {
    KEYS.into_iter().chain(["offset", "predicted", "measured", "problem"]).collect()
}

impl Combination {
    /// Gives the name of its row: its `KEY=VALUE`, and the offset.
    pub fn name(&self) -> String {
        row_name(KEYS.map(|key| self.configuration.value(key)), self.offset)
    }
}

impl Mapped {
    /// Reads a row of the table, with its name; it is one of `all`.
    pub fn read(all: &[Combination], cells: &[&str]) -> Option<(String, Self)> {
        let (keys, rest) = cells.split_at_checked(KEYS.len())?;
        let [offset, predicted, measured, problem] = rest else { return None };
        let offset: f64 = offset.parse().ok()?;
        let name = row_name(keys.iter().copied(), offset);
        let combination = all.iter().find(|one| one.name() == name)?.clone();
        let limit = match *problem {
            "" => Ok(Limit { predicted: size(predicted)?, measured: size(measured)? }),
            problem => Err(problem.to_string()),
        };
        Some((name, Mapped { combination, limit }))
    }
}

/// Names a row by the values of all keys, in their order, and the offset.
fn row_name<'a>(values: impl IntoIterator<Item = &'a str>, offset: f64) -> String {
    let known = KEYS.iter().zip(values).filter(|(_, value)| !value.is_empty());
    let words: String = known.map(|(key, value)| format!("{key}={value} ")).collect();
    format!("{words}offset={}", shortest(offset))
}
