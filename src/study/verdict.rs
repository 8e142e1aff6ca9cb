//! A verdict is the cheapest configuration that reaches an error, and how far it can be
//! trusted: what comes out when nothing changes but a little γ, the particles or the grid.

use super::configuration::{Configuration, Template};
use super::log::{self, Progress};
use super::measured::{Criterion, Measured};
use super::pool;
use super::ranking::{Among, Price, Question, Tried, cheapest, reaching, summarise};
use super::trade;
use crate::run::table::{csv, shortest};
use crate::scene::Scene;
use crate::scene::fault::Fault;
use std::path::Path;

/// A configuration is not tried if it has more than so many times the pairs of the best: the
/// margin for what a pair takes with one basis and matrix over one with another.
const DEAREST: f64 = 8.0;

/// A configuration is fragile if one beside it errs by more than this many times the error that
/// was asked for.
pub const FRAGILE: f64 = 2.0;

/// No more than so many candidates are examined for one that is not fragile.
const MOST_CANDIDATES: usize = 4;

/// A change of one thing leads to a configuration beside another.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbour {
    /// What was changed, as `KEY=VALUE`.
    pub change: String,
    /// The error in the quantity that was asked for, or why there is none.
    pub error: Result<f64, String>,
}

/// A candidate reaches the error; its neighbours tell whether that is luck.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    pub tried: Tried,
    pub error: f64,
    pub neighbours: Vec<Neighbour>,
}

impl Candidate {
    /// Gives the worst error among the neighbours, and what was changed there; infinite for one
    /// that failed, none without neighbours.
    pub fn worst(&self) -> Option<(&str, f64)> {
        let error = |one: &Neighbour| one.error.as_ref().copied().unwrap_or(f64::INFINITY);
        let all = self.neighbours.iter().map(|one| (one.change.as_str(), error(one)));
        all.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Tells whether a neighbour misses the error by more than [`FRAGILE`].
    pub fn is_fragile(&self, question: Question) -> bool {
        self.worst().is_some_and(|(_, worst)| worst > FRAGILE * question.error)
    }
}

/// What was tried of all there is to try.
pub struct Search {
    pub rows: Vec<Tried>,
    /// How many configurations were left out because they cost more than what was found.
    pub dearer: usize,
}

/// Tries configurations from the coarsest grid up, with the log at `path`, until all that are
/// left would cost more: their pairs alone, estimated from below, are more than eight
/// times the least that reaches the error.
///
/// Errors: those of [`log::complete`].
pub fn search(
    template: &Template,
    question: Question,
    path: &Path,
    jobs: usize,
    progress: &mut Progress<'_>,
) -> Result<Search, Fault> {
    let mut search = Search { rows: Vec::new(), dearer: 0 };
    let mut grid: Vec<Configuration> = Vec::new();
    for level in trade::levels(template, false)? {
        let least = cheapest(&search.rows, Among::Particles, Price::Pairs, question);
        let most = match least.and_then(|(row, _)| row.pairs()) {
            Some(pairs) => DEAREST * pairs as f64,
            None => f64::INFINITY,
        };
        let is_dear = |one: &Configuration| {
            trade::least_pairs(template, one).is_none_or(|pairs| pairs > most)
        };
        let (dear, affordable): (Vec<_>, Vec<_>) =
            level.into_iter().partition(|one| most.is_finite() && is_dear(one));
        search.dearer += dear.len();
        grid.extend(affordable);
        let mut runs = log::complete(template, &grid, path, jobs, progress)?;
        runs.retain(|run| grid.contains(&run.configuration));
        runs.sort_by_cached_key(|run| grid.iter().position(|one| *one == run.configuration));
        search.rows = summarise(&runs);
    }
    Ok(search)
}

/// Examines those that reach the error from the least work on, until one is not fragile.
///
/// Errors: [`Fault::Scene`] for a scene that cannot be read.
pub fn candidates(
    template: &Template,
    rows: &[Tried],
    question: Question,
    jobs: usize,
) -> Result<Vec<Candidate>, Fault> {
    let mut candidates = Vec::new();
    let reaching = reaching(rows, Among::Particles, Price::Work, question);
    for (tried, error) in reaching.into_iter().take(MOST_CANDIDATES) {
        let neighbours = neighbours(template, &tried.configuration, question.criterion, jobs)?;
        let candidate = Candidate { tried: tried.clone(), error, neighbours };
        let fragile = candidate.is_fragile(question);
        candidates.push(candidate);
        if !fragile {
            break;
        }
    }
    Ok(candidates)
}

/// Runs the configurations beside one: γ by 10% and 20% to both sides, a particle per cell more
/// and less, a cell more and less, and the particles moved by a quarter of their distance,
/// towards and away from each other in turn, each alone.
///
/// With the consistent matrix there is no neighbour of one particle per cell, with which that is
/// nearly singular. The points of OTM are those of a quadrature, and are not moved.
///
/// Errors: [`Fault::Scene`] for a scene that cannot be read.
pub fn neighbours(
    template: &Template,
    configuration: &Configuration,
    criterion: Criterion,
    jobs: usize,
) -> Result<Vec<Neighbour>, Fault> {
    let mut changed: Vec<(String, Result<Scene, String>)> = Vec::new();
    let mut add = |key: &str, value: String| {
        let scene = template.scene(&configuration.with(key, &value));
        changed.push((format!("{key}={value}"), scene.map_err(|fault| fault.to_string())));
    };
    if let Ok(gamma) = configuration.value("basis.gamma").parse::<f64>() {
        for percent in [80.0, 90.0, 110.0, 120.0] {
            add("basis.gamma", shortest(libm::round(10.0 * gamma * percent) / 1000.0));
        }
    }
    for key in ["grid.particles_per_cell", "grid.cells"] {
        let least = match (key, configuration.value("mass")) {
            ("grid.particles_per_cell", "consistent") => 2,
            _ => 1,
        };
        for more in [-1, 1] {
            let value = beside(configuration.value(key), more, least);
            value.into_iter().for_each(|value| add(key, value));
        }
    }
    if configuration.value("method") == "mpm" {
        for offset in [-0.25, 0.25] {
            let mut scene = template.scene(configuration)?;
            scene.grid.offset = offset;
            changed.push((format!("offset={offset}"), Ok(scene)));
        }
    }
    let work = |(change, scene): &(String, Result<Scene, String>)| Neighbour {
        change: change.clone(),
        error: scene.clone().and_then(|scene| Ok(Measured::of(&scene)?.error(criterion))),
    };
    Ok(pool::all(&changed, jobs, work, &mut || {}))
}

/// Writes a number, or a list of them, with `more` added to each; none if one would be below
/// `least`.
fn beside(value: &str, more: i64, least: i64) -> Option<String> {
    let list: Option<Vec<String>> = value
        .trim_matches(['[', ']'])
        .split(',')
        .map(|n| n.parse::<i64>().ok().map(|n| n + more).filter(|n| *n >= least))
        .map(|n| n.map(|n| n.to_string()))
        .collect();
    let list = list?.join(",");
    Some(if value.starts_with('[') { format!("[{list}]") } else { list })
}

/// Writes `neighbours.csv`: every candidate, its error, and the error of each neighbour.
pub fn table(candidates: &[Candidate]) -> Result<Vec<u8>, Fault> {
    let mut lines = Vec::new();
    for Candidate { tried, error, neighbours } in candidates {
        let own = tried.configuration.to_string();
        lines.push([own.clone(), String::new(), shortest(*error), String::new()]);
        for Neighbour { change, error } in neighbours {
            let [error, problem] = match error {
                Ok(error) => [shortest(*error), String::new()],
                Err(problem) => [String::new(), problem.clone()],
            };
            lines.push([own.clone(), change.clone(), error, problem]);
        }
    }
    csv(&["configuration", "change", "error", "problem"], lines.into_iter().map(Vec::from))
}
