//! The trade of speed for accuracy: many configurations of one scene, what each
//! costs and how wrong it is.

use super::configuration::{Configuration, Template};
use super::{map, pool};
use crate::output::summary;
use crate::run::run;
use crate::run::stability;
use crate::run::table::{csv, shortest};
use crate::scene::fault::Fault;
use crate::scene::{Quantity, Scene};
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// How often each run is timed.
pub const PASSES: usize = 3;

/// The quantities whose error is measured, relative.
pub const QUANTITIES: [&str; 3] = ["velocity", "stress", "displacement"];

/// Counters of a run in the log, after the errors and the energy drift.
const COUNTERS: [&str; 8] = [
    "steps",
    "particle_node_pairs",
    "exponentials",
    "newton_iterations",
    "factorizations",
    "solves",
    "candidates",
    "bytes_per_particle",
];

/// One timed run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    pub configuration: String,
    pub pass: usize,
    /// Errors of [`QUANTITIES`], the largest energy drift, and the counters; or why
    /// there are none.
    pub result: Result<Vec<f64>, String>,
    /// (s).
    pub wall_time: f64,
}

/// Columns of a run's result: why there is none, the errors, the energy drift, the
/// counters.
fn result_columns() -> impl Iterator<Item = &'static str> {
    let drift = std::iter::once("energy_drift");
    std::iter::once("problem").chain(QUANTITIES).chain(drift).chain(COUNTERS)
}

/// The cells of [`result_columns`].
fn result_cells(result: &Result<Vec<f64>, String>) -> Vec<String> {
    let mut cells = vec![String::new(); result_columns().count()];
    match result {
        Ok(list) => {
            for (cell, x) in cells[1..].iter_mut().zip(list) {
                *cell = shortest(*x);
            }
        }
        Err(problem) => cells[0] = problem.clone(),
    }
    cells
}

/// Columns of the log; `scene` tells one study from another.
pub fn log_columns() -> Vec<&'static str> {
    let mut columns = vec!["scene", "configuration", "pass"];
    columns.extend(result_columns());
    columns.push("wall_time");
    columns
}

impl Run {
    /// The run as a line of the log.
    pub fn cells(&self, scene: &str) -> Vec<String> {
        let mut cells = vec![scene.to_string(), self.configuration.clone(), self.pass.to_string()];
        cells.extend(result_cells(&self.result));
        cells.push(shortest(self.wall_time));
        cells
    }

    fn of(record: &csv::StringRecord) -> Option<Run> {
        let numbers = || record.iter().skip(4).map(|text| text.parse::<f64>().ok());
        let wall_time = record.get(record.len().checked_sub(1)?)?.parse().ok()?;
        let result = match record.get(3)? {
            "" => {
                let mut list = numbers().collect::<Option<Vec<f64>>>()?;
                list.pop();
                Ok(list)
            }
            problem => Err(problem.to_string()),
        };
        let (configuration, pass) = (record.get(1)?.to_string(), record.get(2)?.parse().ok()?);
        Some(Run { configuration, pass, result, wall_time })
    }
}

/// What a study of this template has: a common time step for all, and one that is a
/// fixed part of each one's own limit.
///
/// In 1D the first row of each grid is the baseline: linear finite elements with
/// central differences, just below cΔt/h = 1, where they are exact on the bar. (At 1
/// itself an element that is compressed by a thousandth is beyond its limit.)
pub fn grid(template: &Template, full: bool) -> Result<Vec<Configuration>, Fault> {
    let refinements: &[f64] =
        if full { &[0.25, 0.5, 1.0, 2.0, 4.0, 8.0] } else { &[1.0, 2.0, 4.0] };
    let mut all: Vec<Configuration> = Vec::new();
    for &refinement in refinements {
        let mut add =
            |method: &str, mass: &str, basis: &str, integrator: &str, per_cell, step: f64| {
                let mut configuration = Configuration {
                    method: method.into(),
                    mass: mass.into(),
                    basis: basis.into(),
                    integrator: integrator.into(),
                    refinement,
                    particles_per_cell: per_cell,
                    cfl: libm::fabs(step),
                };
                // A negative step is a part of the limit.
                if step < 0.0 {
                    let scene = template.scene(&configuration);
                    let limit = scene.ok().and_then(|scene| {
                        let limit = stability::predicted(&scene, 0.0).ok()?;
                        Some(scene.courant_number_of(limit))
                    });
                    // Two digits, so that a configuration has a short name.
                    match limit.filter(|limit| limit.is_finite()) {
                        Some(limit) => {
                            let courant = libm::floor(-step * limit * 100.0) / 100.0;
                            configuration.cfl = courant.max(0.01);
                        }
                        None => return, // no limit, or no such scene: the common step tells
                    }
                }
                if !all.contains(&configuration) {
                    all.push(configuration);
                }
            };
        if template.dimension() == 1 {
            add("otm", "lumped", "linear", "newmark", 1, 0.998);
        }
        let bases: &[&str] = match full {
            true => &[
                "linear",
                "ugimp",
                "bspline",
                "lme-0.4",
                "lme-0.8",
                "lme-0.8-0.01",
                "lme-1.8",
                "lme-1.8-0.01",
                "lme-4",
                "lme-4-0.01",
                "lme-6",
            ],
            false => &["linear", "ugimp", "bspline", "lme-0.8", "lme-0.8-0.01", "lme-1.8", "lme-4"],
        };
        let integrators: &[&str] = match full {
            true => &map::INTEGRATORS,
            false => &["newmark", "forward-euler-last", "generalized-alpha-0.8"],
        };
        let per_cells: &[usize] = if full { &[1, 2, 4] } else { &[2] };
        for basis in bases {
            for &per_cell in per_cells {
                for (n, integrator) in integrators.iter().enumerate() {
                    // The quick study varies one thing at a time.
                    if n == 0 || full || *basis == "linear" || *basis == "ugimp" {
                        add("mpm", "lumped", basis, integrator, per_cell, 0.5);
                        add("mpm", "lumped", basis, integrator, per_cell, -0.8);
                    }
                    let wide = ["linear", "bspline", "lme-0.8", "lme-1.8"].contains(basis);
                    if per_cell > 1 && (full || (n == 0 && wide)) {
                        add("mpm", "consistent", basis, integrator, per_cell, 0.2);
                        add("mpm", "consistent", basis, integrator, per_cell, -0.8);
                    }
                }
            }
        }
        for basis in ["lme-0.8", "lme-1.8", "lme-4", "lme-6"] {
            for per_cell in [1, 2] {
                if per_cell == 1 || full {
                    add("otm", "lumped", basis, "newmark", per_cell, 0.5);
                    add("otm", "lumped", basis, "newmark", per_cell, -0.95);
                }
            }
        }
    }
    Ok(all)
}

/// The relative errors of a finished run: of a quantity's probes together, or of its
/// field at the end where no probe follows it.
fn errors(scene: &Scene, lines: &[summary::Line]) -> Vec<f64> {
    let value = |name: &str| lines.iter().find(|line| line.quantity == name).map(|line| line.value);
    let named = |quantity: Quantity| quantity.name_unit().0;
    QUANTITIES
        .iter()
        .map(|quantity| {
            let probes = scene.probes.iter().filter(|probe| named(probe.quantity) == *quantity);
            let list: Vec<f64> =
                probes.filter_map(|probe| value(&format!("{}_rms_relative", probe.name))).collect();
            match list.is_empty() {
                true => value(&format!("{quantity}_field_rms_relative")).unwrap_or(f64::NAN),
                false => libm::sqrt(list.iter().map(|x| x * x).sum::<f64>() / list.len() as f64),
            }
        })
        .collect()
}

/// Runs one configuration once.
pub fn time(template: &Template, configuration: &Configuration, pass: usize) -> Run {
    let start = Instant::now();
    let result =
        template.scene(configuration).map_err(|fault| fault.to_string()).and_then(|scene| {
            let outcome = run(&scene, &mut |_| {}).map_err(|stopped| stopped.broken.to_string())?;
            let lines = summary::lines(&scene, &outcome, 0.0);
            let mut list = errors(&scene, &lines);
            let drift = |name: &str| lines.iter().find(|l| l.quantity == name).map(|l| l.value);
            let drift = drift("energy_drift_largest").or(drift("energy_balance_largest"));
            list.push(drift.unwrap_or(0.0));
            let counts: BTreeMap<&str, u64> = outcome.cost.named().into_iter().collect();
            list.extend(COUNTERS.iter().map(|name| counts.get(name).map_or(0.0, |n| *n as f64)));
            match list.iter().all(|x| x.is_finite()) {
                true => Ok(list),
                false => Err("no exact solution to compare with".to_string()),
            }
        });
    let wall_time = start.elapsed().as_secs_f64();
    Run { configuration: configuration.to_string(), pass, result, wall_time }
}

/// Runs of a log that belong to `scene`; a last line that an interruption has cut
/// short is left out.
///
/// Errors: [`Fault::Read`]; [`Fault::Argument`] for another study's log.
pub fn read_log(path: &Path, scene: &str) -> Result<Vec<Run>, Fault> {
    let fault = |source| Fault::Read { path: path.to_path_buf(), source };
    let text = fs::read_to_string(path).map_err(fault)?;
    let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
    if whole.is_empty() {
        return Ok(Vec::new()); // cut short before its first line was whole
    }
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(whole.as_bytes());
    let columns = log_columns();
    let header = reader.headers().map_err(|error| fault(error.into()))?.clone();
    if header.iter().ne(columns.iter().copied()) {
        return Err(Fault::Argument {
            argument: "log",
            problem: format!("{} has other columns", path.display()),
            allowed: "a log of `lme-mpm trade`",
        });
    }
    let mut runs = Vec::new();
    for record in reader.records().map_while(Result::ok) {
        if record.len() != columns.len() {
            continue;
        }
        if &record[0] != scene {
            return Err(Fault::Argument {
                argument: "log",
                problem: format!("{} belongs to another scene", path.display()),
                allowed: "a log of this scene, or another --out",
            });
        }
        runs.extend(Run::of(&record));
    }
    Ok(runs)
}

/// What tells one scene from another: a digest of the template.
pub fn scene_digest(template: &Template) -> String {
    let any = Configuration {
        method: "mpm".into(),
        mass: "lumped".into(),
        basis: "linear".into(),
        integrator: "newmark".into(),
        refinement: 1.0,
        particles_per_cell: 1,
        cfl: 1.0,
    };
    let digest = template.text(&any).bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    format!("{digest:016x}")
}

/// All runs of a grid: those that the log at `path` has, and the others, each
/// written there as it ends. Passes are interleaved: all configurations once, then
/// all again.
///
/// Errors: those of [`read_log`]; [`Fault::Write`].
pub fn runs(
    template: &Template,
    grid: &[Configuration],
    path: &Path,
    jobs: usize,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Vec<Run>, Fault> {
    let scene = scene_digest(template);
    let fault = |source| Fault::Write { path: path.to_path_buf(), source };
    let mut known = match path.exists() {
        true => read_log(path, &scene)?,
        false => Vec::new(),
    };
    let text = |run: &Run| csv(&log_columns(), std::iter::once(run.cells(&scene)));
    // Written anew, so that a line cut short does not stay.
    let mut bytes = csv(&log_columns(), known.iter().map(|run| run.cells(&scene)))?;
    let new = path.with_extension("csv.part");
    fs::write(&new, &bytes).and_then(|()| fs::rename(&new, path)).map_err(fault)?;
    let mut log = fs::OpenOptions::new().append(true).open(path).map_err(fault)?;
    let mut open = Vec::new();
    for pass in 1..=PASSES {
        for configuration in grid {
            let name = configuration.to_string();
            if !known.iter().any(|run| run.pass == pass && run.configuration == name) {
                open.push((configuration.clone(), pass));
            }
        }
    }
    let (mut done, all) = (0, open.len());
    pool::run(
        &open,
        jobs,
        |(configuration, pass)| time(template, configuration, *pass),
        |_, run| {
            bytes = text(&run)?;
            // Without the header line.
            let start = bytes.iter().position(|b| *b == b'\n').map_or(0, |at| at + 1);
            log.write_all(&bytes[start..]).map_err(fault)?;
            known.push(run);
            done += 1;
            progress(done, all);
            Ok::<(), Fault>(())
        },
    )?;
    Ok(known)
}

/// A configuration with all its passes taken together.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    pub configuration: String,
    pub result: Result<Vec<f64>, String>,
    /// Median, least and largest of the passes (s).
    pub wall_time: [f64; 3],
    pub passes: usize,
}

impl Summary {
    /// The relative error of a quantity.
    pub fn error(&self, quantity: usize) -> Option<f64> {
        self.result.as_ref().ok().map(|list| list[quantity])
    }
}

/// One line for each configuration, in the order of first appearance.
pub fn summarise(runs: &[Run]) -> Vec<Summary> {
    let mut order: Vec<&str> = Vec::new();
    for run in runs {
        if !order.contains(&run.configuration.as_str()) {
            order.push(&run.configuration);
        }
    }
    order
        .into_iter()
        .map(|name| {
            let own: Vec<&Run> = runs.iter().filter(|run| run.configuration == name).collect();
            let mut times: Vec<f64> = own.iter().map(|run| run.wall_time).collect();
            times.sort_by(f64::total_cmp);
            let median = times[times.len() / 2];
            Summary {
                configuration: name.to_string(),
                result: own[0].result.clone(),
                wall_time: [median, times[0], times[times.len() - 1]],
                passes: own.len(),
            }
        })
        .collect()
}

/// Linear finite elements, of which a study has some rows to compare with. They stand
/// on no front and are never the cheapest: where no particle is needed, they win.
pub fn is_baseline(configuration: &str) -> bool {
    configuration.starts_with("otm/lumped/linear/")
}

/// The group of a configuration in a diagram: its basis and mass, or its method.
pub fn family(configuration: &str) -> String {
    let parts: Vec<&str> = configuration.split('/').collect();
    let basis = parts.get(2).and_then(|basis| basis.split('-').next()).unwrap_or("");
    match parts.first() {
        _ if is_baseline(configuration) => "finite elements".to_string(),
        Some(&"otm") => "otm".to_string(),
        _ => format!("{basis}, {}", parts.get(1).unwrap_or(&"")),
    }
}

/// Those that nobody beats in both error and time, by rising time.
pub fn front(rows: &[Summary], quantity: usize) -> Vec<&Summary> {
    let own = |row: &&Summary| row.error(quantity).is_some() && !is_baseline(&row.configuration);
    let mut list: Vec<&Summary> = rows.iter().filter(own).collect();
    list.sort_by(|a, b| a.wall_time[0].total_cmp(&b.wall_time[0]));
    let mut least = f64::INFINITY;
    list.retain(|row| match row.error(quantity) {
        Some(error) if error < least => {
            least = error;
            true
        }
        _ => false,
    });
    list
}

/// The fastest whose error is at most `error`.
pub fn cheapest(rows: &[Summary], quantity: usize, error: f64) -> Option<&Summary> {
    let good = |row: &&Summary| {
        row.error(quantity).is_some_and(|found| found <= error) && !is_baseline(&row.configuration)
    };
    rows.iter().filter(good).min_by(|a, b| a.wall_time[0].total_cmp(&b.wall_time[0]))
}

/// `trade.csv`: every configuration with its parts, errors, cost, times, and on which
/// fronts it stands.
pub fn table(rows: &[Summary]) -> Result<Vec<u8>, Fault> {
    let mut columns =
        vec!["method", "mass", "basis", "integrator", "refinement", "particles_per_cell", "cfl"];
    columns.extend(result_columns());
    columns.extend(["wall_time_median", "wall_time_least", "wall_time_largest", "passes", "front"]);
    let fronts: Vec<Vec<&Summary>> = (0..QUANTITIES.len()).map(|q| front(rows, q)).collect();
    let line = |row: &Summary| {
        let mut cells: Vec<String> = row.configuration.split('/').map(String::from).collect();
        cells.extend(result_cells(&row.result));
        cells.extend(row.wall_time.iter().map(|x| shortest(*x)));
        cells.push(row.passes.to_string());
        let on = QUANTITIES.iter().zip(&fronts).filter(|(_, front)| front.contains(&row));
        cells.push(on.map(|(name, _)| *name).collect::<Vec<_>>().join(" "));
        cells
    };
    csv(&columns, rows.iter().map(line))
}

/// Error levels of the table of the cheapest.
pub const LEVELS: [f64; 7] = [0.2, 0.1, 0.05, 0.03, 0.01, 0.003, 0.001];

/// `cheapest.csv`: for each quantity and level the fastest configuration that
/// reaches it.
pub fn cheapest_table(rows: &[Summary]) -> Result<Vec<u8>, Fault> {
    let mut lines = Vec::new();
    for (quantity, name) in QUANTITIES.iter().enumerate() {
        for level in LEVELS {
            let found = cheapest(rows, quantity, level);
            let cells = found.map(|row| {
                let error = row.error(quantity).unwrap_or(f64::NAN);
                [row.configuration.clone(), shortest(error), shortest(row.wall_time[0])]
            });
            let mut line = vec![name.to_string(), shortest(level)];
            line.extend(cells.unwrap_or(["none".into(), String::new(), String::new()]));
            lines.push(line);
        }
    }
    csv(&["quantity", "level", "configuration", "error", "wall_time"], lines.into_iter())
}
