//! The log of a study has a line for every timed run, so that a study which was
//! interrupted goes on where it stopped.

use super::configuration::{Configuration, Template};
use super::measured::Measured;
use super::pool;
use super::rows::{is_whole, no_number, size};
use crate::output::files;
use crate::run::table::{csv, not_finite, shortest};
use crate::scene::fault::Fault;
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Each configuration is timed as often as this.
pub const PASSES: usize = 3;

/// A run that takes less (s) is made again until it has taken as much.
const SHORT: f64 = 5e-3;

/// Progress hears how many runs of how many are done.
pub type Progress<'a> = dyn FnMut(usize, usize) + 'a;

/// A timed run is one pass of a configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedRun {
    pub configuration: Configuration,
    /// From 1 to [`PASSES`].
    pub pass: usize,
    /// What came out, or why nothing did.
    pub measured: Result<Measured, String>,
    /// Of the run and its errors (s).
    pub wall_time: f64,
}

/// Names the columns of a run's result: why there is none, or its numbers.
pub fn result_columns() -> Vec<&'static str> {
    let numbers = Measured::default().named();
    std::iter::once("problem").chain(numbers.into_iter().map(|(name, _)| name)).collect()
}

/// Fills the cells of [`result_columns`].
pub fn result_cells(measured: &Result<Measured, String>) -> Vec<String> {
    match measured {
        Ok(measured) => {
            let numbers = measured.named().into_iter().map(|(_, x)| shortest(x));
            std::iter::once(String::new()).chain(numbers).collect()
        }
        Err(problem) => {
            let mut cells = vec![String::new(); result_columns().len()];
            cells[0] = problem.clone();
            cells
        }
    }
}

/// Names the columns of the log; `scene` tells one study from another.
fn columns() -> Vec<&'static str> {
    let mut columns = vec!["scene", "configuration", "pass"];
    columns.extend(result_columns());
    columns.push("wall_time");
    columns
}

impl TimedRun {
    /// Runs one configuration, and times the run without the reading of the scene. A run that
    /// is too short for the clock is made again and again, and its time is the mean.
    pub fn of(template: &Template, configuration: &Configuration, pass: usize) -> Self {
        let scene = template.scene(configuration).map_err(|fault| fault.to_string());
        let start = Instant::now();
        let measured = scene.as_ref().map_err(String::clone).and_then(Measured::of);
        let (mut times, mut wall_time) = (1.0, start.elapsed().as_secs_f64());
        if let (Ok(scene), Ok(_)) = (&scene, &measured) {
            while wall_time < SHORT {
                Measured::of(scene).ok(); // the same as before
                (times, wall_time) = (times + 1.0, start.elapsed().as_secs_f64());
            }
        }
        wall_time /= times;
        TimedRun { configuration: configuration.clone(), pass, measured, wall_time }
    }

    fn cells(&self, scene: &str) -> Vec<String> {
        let configuration = self.configuration.to_string();
        let mut cells = vec![scene.to_string(), configuration, self.pass.to_string()];
        cells.extend(result_cells(&self.measured));
        cells.push(shortest(self.wall_time));
        cells
    }

    /// Reads the run of a line, if the line is whole.
    fn read(record: &csv::StringRecord) -> Option<Self> {
        let cell = |name: &str| record.get(columns().iter().position(|column| *column == name)?);
        let number = |name: &str| size(cell(name)?);
        Some(TimedRun {
            configuration: cell("configuration")?.parse().ok()?,
            pass: cell("pass")?.parse().ok().filter(|pass| (1..=PASSES).contains(pass))?,
            measured: match cell("problem")? {
                "" => Ok(Measured::read(number)?),
                problem => Err(problem.to_string()),
            },
            wall_time: number("wall_time")?,
        })
    }
}

/// Writes the log of some runs of the scene with this digest.
pub fn csv_of<'a>(
    scene: &str,
    runs: impl IntoIterator<Item = &'a TimedRun>,
) -> Result<Vec<u8>, Fault> {
    csv(&columns(), runs.into_iter().map(|run| run.cells(scene)))
}

/// Reads the runs of a log that belongs to the scene with this digest; a last line that an
/// interruption has cut short is left out.
///
/// Errors: [`Fault::Read`]; [`Fault::Points`] with the line that is no run, or of another study.
pub fn read(path: &Path, scene: &str) -> Result<Vec<TimedRun>, Fault> {
    let mut lines = lines(path, scene)?;
    lines.pop_if(|(_, run, has_end)| run.is_none() && !*has_end);
    let whole = |(line, run, _): (u64, Option<TimedRun>, bool)| {
        run.ok_or_else(|| fault_at(path, line, NO_RUN, ALLOWED))
    };
    lines.into_iter().map(whole).collect()
}

const NO_RUN: &str = "this is not a whole run";
const ALLOWED: &str =
    "runs as `lme-mpm trade --row` prints them, with finite numbers from 0 up, each once";

/// Reads logs of which every line must be whole, and every pass of a configuration stand
/// there once; each log has at least one run.
///
/// Errors: those of [`read`]; [`Fault::Points`] with the line that is not a run, or a second
/// time the same.
pub fn merged(paths: &[PathBuf], scene: &str) -> Result<Vec<TimedRun>, Fault> {
    let (mut runs, mut known) = (Vec::new(), BTreeSet::new());
    for path in paths {
        let lines = lines(path, scene)?;
        if lines.is_empty() {
            return Err(fault_at(path, 1, "there is no run", ALLOWED));
        }
        for (line, run, _) in lines {
            let Some(run) = run else {
                return Err(fault_at(path, line, NO_RUN, ALLOWED));
            };
            if !known.insert((run.configuration.to_string(), run.pass)) {
                return Err(fault_at(path, line, "this run stands here a second time", ALLOWED));
            }
            runs.push(run);
        }
    }
    Ok(runs)
}

/// Makes the fault of a line.
fn fault_at(path: &Path, line: u64, problem: &str, allowed: &str) -> Fault {
    Fault::Points {
        path: path.display().to_string(),
        line,
        problem: problem.to_string(),
        allowed: allowed.to_string(),
    }
}

/// Reads the lines of a log with their numbers, each with its run if it is whole, and whether the
/// line has an end.
fn lines(path: &Path, scene: &str) -> Result<Vec<(u64, Option<TimedRun>, bool)>, Fault> {
    let fault = |source| Fault::Read { path: path.to_path_buf(), source };
    let text = fs::read_to_string(path).map_err(fault)?;
    if !text.contains('\n') {
        return Ok(Vec::new()); // cut short before its first line was whole
    }
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| fault(error.into()))?.clone();
    if header.iter().ne(columns()) {
        return Err(fault_at(path, 1, "these are other columns", "a log of `lme-mpm trade`"));
    }
    let mut lines = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| fault(error.into()))?;
        let line = record.position().map_or(0, |position| position.line());
        let (whole, has_end) = is_whole(&record, &text, header.len());
        if let Some((column, value)) = not_finite(&columns(), record.iter()).filter(|_| has_end) {
            return Err(fault_at(path, line, &no_number(&column, &value), ALLOWED));
        }
        if whole && &record[0] != scene {
            let allowed = "a log of this scene, or another --out";
            return Err(fault_at(path, line, "this run belongs to another scene", allowed));
        }
        lines.push((line, TimedRun::read(&record).filter(|_| whole), has_end));
    }
    Ok(lines)
}

/// Completes the runs of a grid: takes those that the log at `path` has and makes the
/// others, each written there as it ends. Passes are interleaved: all configurations once, then
/// all again. `progress` hears how many of how many are done.
///
/// Errors: those of [`read`]; [`Fault::Write`].
pub fn complete(
    template: &Template,
    grid: &[Configuration],
    path: &Path,
    jobs: usize,
    progress: &mut Progress<'_>,
) -> Result<Vec<TimedRun>, Fault> {
    let scene = template.digest()?;
    let fault = |source| Fault::Write { path: path.to_path_buf(), source };
    let mut known = match files::is_file(path)? {
        true => read(path, &scene)?,
        false => Vec::new(),
    };
    // The log is written anew, so that a line cut short does not stay.
    files::write(&[(path.to_path_buf(), &csv_of(&scene, &known)?)])?;
    let mut log = fs::OpenOptions::new().append(true).open(path).map_err(fault)?;
    let is_known = |pass: usize, configuration: &Configuration| {
        known.iter().any(|run| run.pass == pass && run.configuration == *configuration)
    };
    let all = (1..=PASSES).flat_map(|pass| grid.iter().map(move |one| (one, pass)));
    let open: Vec<_> = all.filter(|(one, pass)| !is_known(*pass, one)).collect();
    let mut done = 0;
    let work = |(one, pass): &(&Configuration, usize)| TimedRun::of(template, one, *pass);
    pool::run(&open, jobs, work, |_, run| {
        let bytes = csv_of(&scene, [&run])?;
        // The header line stands there already.
        let start = bytes.iter().position(|b| *b == b'\n').map_or(0, |at| at + 1);
        log.write_all(&bytes[start..]).map_err(fault)?;
        known.push(run);
        done += 1;
        progress(done, open.len());
        Ok::<(), Fault>(())
    })?;
    Ok(known)
}
