//! Runs a scene and writes what came out of it: histories, last state,
//! summary, cost and pictures.

use super::results::{commit, prepare};
use super::summary::{self, SummaryLine};
use super::{figure, vtk};
use crate::method::breakdown::Breakdown;
use crate::method::choice::Mass;
use crate::run::stability::runnable;
use crate::run::table::{Table, csv, shortest};
use crate::run::{Stopped, Warning, run_knowing};
use crate::scene::Scene;
use crate::scene::fault::Fault;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

/// The history of a run that broke down is left here.
const FAILED: &str = "history.failed.csv";

/// The particles at the end are drawn here, in 2D and 3D.
const PICTURE: &str = "particles.svg";

/// A run is done: its results are written.
#[derive(Debug)]
pub struct Done {
    /// The summary.
    pub lines: Vec<SummaryLine>,
    pub history: Table,
    /// What the results may not be trusted for.
    pub warnings: Vec<Warning>,
}

/// Runs `scene` and writes its results into `dir`.
///
/// A complete run leaves `history.csv`, `particles.csv`, `summary.csv`,
/// `cost.csv` and `<probe>.svg`, in 2D and 3D also `particles.svg` and, if asked
/// for, the series for ParaView; one that breaks down leaves only
/// `history.failed.csv`, and so does one that `progress` breaks off. Either way they take the
/// place of an earlier run's, see [`results`](super::results).
///
/// Errors: [`Fault::Unstable`] for a Δt above the predicted limit and [`Fault::Foreign`] for
/// what is not ours in `dir`, before anything is written; [`Fault::Write`]; [`Fault::Run`]
/// when the run breaks down, or `progress` ends it; [`Fault::NotFinite`] for results that are no
/// numbers, of which nothing is written.
pub fn run_into(
    dir: &Path,
    scene: &Scene,
    progress: &mut dyn FnMut(usize) -> ControlFlow<Breakdown>,
) -> Result<Done, Fault> {
    let limit = runnable(scene)?;
    prepare(dir)?;
    let start = Instant::now();
    let outcome = match run_knowing(scene, limit, progress) {
        Ok(outcome) => outcome,
        Err(stopped) => return Err(broken(dir, scene, *stopped)),
    };
    let mut lines = summary::lines(scene, &outcome, start.elapsed().as_secs_f64());
    if let Some(limit) = limit {
        lines.extend(summary::limit_lines(&limit, outcome.dt));
    }
    let cost = summary::cost_lines(&outcome.cost);
    let mut files = vec![
        ("history.csv".to_string(), outcome.history.csv()?),
        ("particles.csv".to_string(), outcome.particles.csv()?),
        ("summary.csv".to_string(), lines_csv(&lines)?),
        ("cost.csv".to_string(), lines_csv(&cost)?),
    ];
    for probe in &scene.probes {
        let picture = figure::probe(scene, probe, &outcome.history);
        files.push((format!("{}.svg", probe.name), picture.into_bytes()));
    }
    if scene.dimension() > 1 {
        let picture = figure::particles(scene, &outcome.particles, scene.time.end);
        files.push((PICTURE.to_string(), picture.into_bytes()));
    }
    files.extend(vtk::files(&outcome.frames)?);
    commit(dir, &files)?;
    lines.extend(cost);
    Ok(Done { lines, history: outcome.history, warnings: outcome.warnings })
}

/// Leaves the history up to the breakdown, if its numbers are finite, and names what to try.
fn broken(dir: &Path, scene: &Scene, stopped: Stopped) -> Fault {
    let history = stopped.history.csv();
    let left = match history.and_then(|csv| commit(dir, &[(FAILED.to_string(), csv)])) {
        Ok(()) => format!("the history up to there is in {}", dir.join(FAILED).display()),
        Err(fault) => format!("the history up to there may be lost: {fault}"),
    };
    let courant = scene.courant_number();
    let hint = match stopped.broken.breakdown {
        Breakdown::ReachesBeyond { .. }
        | Breakdown::Domain { .. }
        | Breakdown::NoBasis { .. }
        | Breakdown::SingularMass { .. }
        | Breakdown::NoMass { .. }
        | Breakdown::NoEquilibrium { .. }
        | Breakdown::Interrupted
        | Breakdown::OutOfTime { .. } => String::new(),
        Breakdown::BeyondLimit { .. } | Breakdown::Gained { .. } => {
            "give the time step as a part of the limit with \
             time.fraction_of_critical, or a smaller time.cfl; "
                .to_string()
        }
        Breakdown::LeftGrid { .. } | Breakdown::NotFinite { .. } if courant <= 1.0 => String::new(),
        _ if scene.time.load_steps.is_some() => "try more time.load_steps; ".to_string(),
        _ if scene.mass == Mass::Consistent => format!(
            "the Courant number c Δt / h is {courant:.3}: try a smaller time.cfl, or more \
             particles per cell for the consistent mass matrix; "
        ),
        _ => format!("the Courant number c Δt / h is {courant:.3}: try a smaller time.cfl; "),
    };
    Fault::Run { broken: stopped.broken, advice: format!("{hint}{left}") }
}

/// Writes `quantity,value,unit`.
fn lines_csv(lines: &[SummaryLine]) -> Result<Vec<u8>, Fault> {
    let row = |line: &SummaryLine| {
        vec![line.quantity.clone(), shortest(line.value), line.unit.to_string()]
    };
    csv(&["quantity", "value", "unit"], lines.iter().map(row))
}
