//! The ranking tells which configurations are worth what they cost.

use super::configuration::{Configuration, KEYS};
use super::log::{TimedRun, result_cells, result_columns};
use super::measured::{Criterion, Measured};
use crate::run::table::{csv, shortest};
use crate::scene::fault::Fault;

/// The time of a run varies over the passes (s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallTime {
    pub median: f64,
    pub least: f64,
    pub largest: f64,
}

/// A configuration that was tried has all its passes taken together.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    pub configuration: Configuration,
    /// What came out, or why nothing did.
    pub measured: Result<Measured, String>,
    pub wall_time: WallTime,
    pub passes: usize,
}

impl Tried {
    /// Gives the relative error in one quantity; none for a run that failed.
    pub fn error(&self, criterion: Criterion) -> Option<f64> {
        self.measured.as_ref().ok().map(|measured| measured.error(criterion))
    }
}

/// Takes the passes of each configuration together, in the order of first appearance.
pub fn summarise(runs: &[TimedRun]) -> Vec<Tried> {
    let mut order: Vec<&Configuration> = Vec::new();
    for run in runs {
        if !order.contains(&&run.configuration) {
            order.push(&run.configuration);
        }
    }
    let tried = |configuration: &Configuration| {
        let own: Vec<&TimedRun> =
            runs.iter().filter(|run| run.configuration == *configuration).collect();
        let mut times: Vec<f64> = own.iter().map(|run| run.wall_time).collect();
        times.sort_by(f64::total_cmp);
        Tried {
            configuration: configuration.clone(),
            measured: own[0].measured.clone(),
            wall_time: WallTime {
                median: times[times.len() / 2],
                least: times[0],
                largest: times[times.len() - 1],
            },
            passes: own.len(),
        }
    };
    order.into_iter().map(tried).collect()
}

/// Picks those that can be on a front, with their error.
fn judged(rows: &[Tried], criterion: Criterion) -> impl Iterator<Item = (&Tried, f64)> {
    let own = rows.iter().filter(|row| !row.configuration.is_finite_elements());
    own.filter_map(move |row| Some((row, row.error(criterion)?)))
}

/// Picks those that nobody beats in both error and time, by rising time, each with its
/// error.
pub fn front(rows: &[Tried], criterion: Criterion) -> Vec<(&Tried, f64)> {
    let mut list: Vec<(&Tried, f64)> = judged(rows, criterion).collect();
    list.sort_by(|a, b| a.0.wall_time.median.total_cmp(&b.0.wall_time.median));
    let mut least = f64::INFINITY;
    list.retain(|(_, error)| {
        let better = *error < least;
        least = least.min(*error);
        better
    });
    list
}

/// Picks the fastest whose error is at most `error`, with its own.
pub fn cheapest(rows: &[Tried], criterion: Criterion, error: f64) -> Option<(&Tried, f64)> {
    judged(rows, criterion)
        .filter(|(_, found)| *found <= error)
        .min_by(|a, b| a.0.wall_time.median.total_cmp(&b.0.wall_time.median))
}

/// Finds the least error of all, which is infinite if there is none.
pub fn least_error(rows: &[Tried], criterion: Criterion) -> f64 {
    judged(rows, criterion).map(|(_, error)| error).fold(f64::INFINITY, f64::min)
}

/// Writes `trade.csv`: every configuration key by key, errors, cost, times, and on which
/// fronts it stands.
pub fn table(rows: &[Tried]) -> Result<Vec<u8>, Fault> {
    let mut columns = KEYS.to_vec();
    columns.extend(result_columns());
    columns.extend(["wall_time_median", "wall_time_least", "wall_time_largest", "passes", "front"]);
    let fronts = Criterion::ALL.map(|criterion| (criterion.name(), front(rows, criterion)));
    let line = |row: &Tried| {
        let mut cells = KEYS.map(|key| row.configuration.value(key).to_string()).to_vec();
        cells.extend(result_cells(&row.measured));
        let WallTime { median, least, largest } = row.wall_time;
        cells.extend([median, least, largest].map(shortest));
        cells.push(row.passes.to_string());
        let on = |front: &[(&Tried, f64)]| front.iter().any(|(other, _)| std::ptr::eq(*other, row));
        let names = fronts.iter().filter(|(_, front)| on(front)).map(|(name, _)| *name);
        cells.push(names.collect::<Vec<_>>().join(" "));
        cells
    };
    csv(&columns, rows.iter().map(line))
}

/// The table of the cheapest asks for these levels of error.
pub const LEVELS: [f64; 7] = [0.2, 0.1, 0.05, 0.03, 0.01, 0.003, 0.001];

/// Writes `cheapest.csv`: for each criterion and level the fastest configuration that reaches it.
pub fn cheapest_table(rows: &[Tried]) -> Result<Vec<u8>, Fault> {
    let mut lines = Vec::new();
    for criterion in Criterion::ALL {
        for level in LEVELS {
            let mut line = vec![criterion.name().to_string(), shortest(level)];
            line.extend(match cheapest(rows, criterion, level) {
                Some((row, error)) => {
                    let time = shortest(row.wall_time.median);
                    [row.configuration.to_string(), shortest(error), time]
                }
                None => ["none".to_string(), String::new(), String::new()],
            });
            lines.push(line);
        }
    }
    csv(&["quantity", "level", "configuration", "error", "wall_time"], lines.into_iter())
}
