//! Runs a scene and writes what came out of it: histories, last state,
//! summary, cost and pictures.

use crate::exact::Exact;
use crate::fault::{Breakdown, Fault};
use crate::figure;
use crate::history::{csv, prepare, shortest, write_all};
use crate::run::{Stopped, run};
use crate::scene::Scene;
use crate::summary::{self, Line};
use std::path::Path;
use std::time::Instant;

/// The history of a run that broke down.
const FAILED: &str = "history.failed.csv";

/// Files of every complete run, besides one SVG for each probe.
const FILES: [&str; 4] = ["history.csv", "particles.csv", "summary.csv", "cost.csv"];

/// Runs `scene` and writes its results into `dir`; returns the summary.
///
/// A complete run leaves `history.csv`, `particles.csv`, `summary.csv`,
/// `cost.csv` and `<probe>.svg`; one that breaks down leaves only
/// `history.failed.csv`. Either way the other kind of an earlier run goes.
///
/// Errors: [`Fault::Write`]; [`Fault::Run`] when the run breaks down.
pub fn run_into(
    dir: &Path,
    scene: &Scene,
    progress: &mut dyn FnMut(usize),
) -> Result<Vec<Line>, Fault> {
    prepare(dir)?;
    let start = Instant::now();
    let outcome = match run(scene, progress) {
        Ok(outcome) => outcome,
        Err(stopped) => return Err(broken(dir, scene, *stopped)?),
    };
    let mut lines = summary::lines(scene, &outcome, start.elapsed().as_secs_f64());
    let cost = summary::cost_lines(&outcome.cost);
    let mut files = vec![
        (FILES[0].to_string(), outcome.history.csv()?),
        (FILES[1].to_string(), outcome.particles.csv()?),
        (FILES[2].to_string(), lines_csv(&lines)?),
        (FILES[3].to_string(), lines_csv(&cost)?),
    ];
    for probe in &scene.probes {
        let picture = figure::probe(scene, probe, &outcome.history);
        files.push((format!("{}.svg", probe.name), picture.into_bytes()));
    }
    write_all(dir, &files, &[FAILED.to_string()])?;
    lines.extend(cost);
    Ok(lines)
}

/// Leaves the history up to the breakdown, and names what to try.
fn broken(dir: &Path, scene: &Scene, stopped: Stopped) -> Result<Fault, Fault> {
    let mut stale: Vec<String> = FILES.map(String::from).to_vec();
    stale.extend(scene.probes.iter().map(|probe| format!("{}.svg", probe.name)));
    write_all(dir, &[(FAILED.to_string(), stopped.history.csv()?)], &stale)?;
    let courant = scene.courant_number();
    let hint = match stopped.breakdown {
        Breakdown::LeftGrid { .. } if courant <= 1.0 => String::new(),
        _ => format!("the Courant number c Δt / h is {courant:.3}: try a smaller time.cfl; "),
    };
    let left = dir.join(FAILED);
    Ok(Fault::Run {
        breakdown: stopped.breakdown,
        advice: format!("{hint}the history up to there is in {}", left.display()),
    })
}

/// `quantity,value,unit`.
fn lines_csv(lines: &[Line]) -> Result<Vec<u8>, Fault> {
    let row =
        |line: &Line| vec![line.quantity.clone(), shortest(line.value), line.unit.to_string()];
    csv(&["quantity", "value", "unit"], lines.iter().map(row))
}

/// Reads points `x,t` and gives `x,t,velocity,stress,displacement` of the
/// scene's exact solution; x in the scene's coordinates, at t = 0.
///
/// Errors: [`Fault::NoExact`]; [`Fault::Points`] with the line of the first
/// point that is not a number, outside the body, or before t = 0.
pub fn exact_at(scene: &Scene, name: &str, points: impl std::io::Read) -> Result<Vec<u8>, Fault> {
    let exact = Exact::of(scene)?;
    let (origin, length) = (scene.body.origin[0], scene.body.length[0]);
    let fault = |line: u64, problem: String, allowed: String| Fault::Points {
        path: name.to_string(),
        line,
        problem,
        allowed,
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(points);
    let header = "a header line with the columns x and t".to_string();
    let names = reader.headers().map_err(|error| fault(1, error.to_string(), header.clone()))?;
    let column = |wanted: &str| names.iter().position(|name| name == wanted);
    let (Some(x_at), Some(t_at)) = (column("x"), column("t")) else {
        let found: Vec<&str> = names.iter().collect();
        return Err(fault(1, format!("the columns are `{}`", found.join(",")), header));
    };
    let mut rows = Vec::new();
    for record in reader.into_records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(0, csv::Position::line);
            fault(line, error.to_string(), "two numbers in each line".to_string())
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |at: usize, what: &str, low: f64, high: f64| {
            let text = record.get(at).unwrap_or("");
            match text.parse::<f64>() {
                Ok(x) if low <= x && x <= high && x.is_finite() => Ok(x),
                _ => Err(fault(
                    line,
                    format!("`{text}` is not a value of {what}"),
                    format!("a finite number from {} to {}", shortest(low), shortest(high)),
                )),
            }
        };
        let x = number(x_at, "x", origin, origin + length)?;
        let t = number(t_at, "t", 0.0, f64::INFINITY)?;
        // At the body's own upper corner, to the last bit, as in a scene.
        let from_corner = if x == origin + length { length } else { x - origin };
        let fields = exact.at(from_corner, t);
        let values = [x, t, fields.velocity, fields.stress, fields.displacement];
        rows.push(values.map(shortest).to_vec());
    }
    csv(&["x", "t", "velocity", "stress", "displacement"], rows.into_iter())
}
