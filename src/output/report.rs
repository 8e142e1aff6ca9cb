//! Runs a scene and writes what came out of it: histories, last state,
//! summary, cost and pictures.

use super::files::{prepare, write_all};
use super::summary::{self, SummaryLine};
use super::{figure, vtk};
use crate::method::breakdown::Breakdown;
use crate::method::choice::Mass;
use crate::run::stability::{self, Critical};
use crate::run::table::{csv, shortest};
use crate::run::{Stopped, run_knowing};
use crate::scene::Scene;
use crate::scene::fault::Fault;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

/// A Δt above this multiple of the predicted limit blows up for certain: the margin
/// is the prediction's own, and that of particles on their first way.
const CERTAIN: f64 = 1.002;

/// The history of a run that broke down is left here.
const FAILED: &str = "history.failed.csv";

/// The particles at the end are drawn here, in 2D and 3D.
const PICTURE: &str = "particles.svg";

/// The list of frames for ParaView stands here.
const SERIES: &str = "particles.pvd";

/// Every complete run leaves these files, besides one SVG for each probe.
const FILES: [&str; 4] = ["history.csv", "particles.csv", "summary.csv", "cost.csv"];

/// Gives the predicted limit of Δt; `None` where it cannot be predicted, and the scene
/// breaks down by its own name.
///
/// Errors: [`Fault::Unstable`] for a scene whose Δt is above that of its start, unless it
/// allows that.
pub fn stable(scene: &Scene) -> Result<Option<Critical>, Fault> {
    let Ok(limit) = stability::critical(scene) else {
        return Ok(None);
    };
    if scene.time.end / scene.sizes().2 <= limit.start * CERTAIN || scene.time.allow_unstable {
        return Ok(Some(limit));
    }
    Err(Fault::Unstable {
        courant: scene.courant_number(),
        largest: scene.courant_number_of(limit.used()),
        singular: scene.mass == Mass::Consistent && scene.grid.particles_per_cell.contains(&1),
    })
}

/// Runs `scene` and writes its results into `dir`; returns the summary.
///
/// A complete run leaves `history.csv`, `particles.csv`, `summary.csv`,
/// `cost.csv` and `<probe>.svg`, in 2D and 3D also `particles.svg` and, if asked
/// for, the series for ParaView; one that breaks down leaves only
/// `history.failed.csv`. Either way the other kind of an earlier run goes.
///
/// Errors: [`Fault::Unstable`] for a Δt above the predicted limit, before anything
/// is written; [`Fault::Write`]; [`Fault::Run`] when the run breaks down, or `progress` ends it.
pub fn run_into(
    dir: &Path,
    scene: &Scene,
    progress: &mut dyn FnMut(usize) -> ControlFlow<String>,
) -> Result<Vec<SummaryLine>, Fault> {
    let limit = stable(scene)?;
    prepare(dir)?;
    free_names(dir, scene)?;
    let start = Instant::now();
    let outcome = match run_knowing(scene, limit, progress) {
        Ok(outcome) => outcome,
        Err(stopped) => return Err(broken(dir, scene, *stopped)?),
    };
    let mut lines = summary::lines(scene, &outcome, start.elapsed().as_secs_f64());
    if let Some(limit) = limit {
        lines.extend(summary::limit_lines(&limit, outcome.dt));
    }
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
    if scene.dimension() > 1 {
        let picture = figure::particles(scene, &outcome.particles, scene.time.end);
        files.push((PICTURE.to_string(), picture.into_bytes()));
    }
    files.extend(vtk::files(&outcome.frames)?);
    let mut stale = earlier(dir);
    stale.push(FAILED.to_string());
    write_all(dir, &files, &stale)?;
    lines.extend(cost);
    Ok(lines)
}

/// Leaves the history up to the breakdown, and names what to try.
fn broken(dir: &Path, scene: &Scene, stopped: Stopped) -> Result<Fault, Fault> {
    write_all(dir, &[(FAILED.to_string(), stopped.history.csv()?)], &earlier(dir))?;
    let courant = scene.courant_number();
    let hint = match stopped.broken.breakdown {
        Breakdown::ReachesBeyond { .. }
        | Breakdown::NoBasis { .. }
        | Breakdown::SingularMass { .. }
        | Breakdown::NoMass { .. }
        | Breakdown::Ended { .. } => String::new(),
        Breakdown::BeyondLimit { .. } | Breakdown::Gained { .. } => {
            "give the time step as a part of the limit with \
             time.fraction_of_critical, or a smaller time.cfl; "
                .to_string()
        }
        Breakdown::LeftGrid { .. } | Breakdown::NotFinite { .. } if courant <= 1.0 => String::new(),
        _ if scene.mass == Mass::Consistent => format!(
            "the Courant number c Δt / h is {courant:.3}: try a smaller time.cfl, or more \
             particles per cell for the consistent mass matrix; "
        ),
        _ => format!("the Courant number c Δt / h is {courant:.3}: try a smaller time.cfl; "),
    };
    let left = dir.join(FAILED);
    Ok(Fault::Run {
        broken: stopped.broken,
        advice: format!("{hint}the history up to there is in {}", left.display()),
    })
}

/// Refuses, before the run, a directory that stands where a file is to be.
fn free_names(dir: &Path, scene: &Scene) -> Result<(), Fault> {
    let mut names: Vec<String> = FILES.map(String::from).to_vec();
    names.push(FAILED.to_string());
    names.extend(scene.probes.iter().map(|probe| format!("{}.svg", probe.name)));
    names.extend([PICTURE, SERIES].map(String::from).into_iter().filter(|_| scene.dimension() > 1));
    let rows = scene.sizes().2 as usize / scene.every + 2;
    names.extend((0..rows).filter(|_| scene.vtk).map(vtk::name));
    for name in names {
        let path = dir.join(name);
        if path.is_dir() {
            let source = std::io::Error::from(std::io::ErrorKind::IsADirectory);
            return Err(Fault::Write { path, source });
        }
    }
    Ok(())
}

/// Lists the files that an earlier complete run has left in `dir`: those of every
/// run, and a picture for each column of its history.
fn earlier(dir: &Path) -> Vec<String> {
    let mut files: Vec<String> = FILES.map(String::from).to_vec();
    let history = std::fs::read_to_string(dir.join(FILES[0])).unwrap_or_default();
    let columns = history.lines().next().unwrap_or("").split(',');
    let plain = |name: &&str| name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    files.extend(columns.filter(plain).map(|name| format!("{name}.svg")));
    files.extend([PICTURE, SERIES].map(String::from));
    let names = std::fs::read_dir(dir).into_iter().flatten().flatten();
    let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
    files.extend(names.filter(|name| vtk::is_frame(name)));
    files
}

/// Writes `quantity,value,unit`.
fn lines_csv(lines: &[SummaryLine]) -> Result<Vec<u8>, Fault> {
    let row = |line: &SummaryLine| {
        vec![line.quantity.clone(), shortest(line.value), line.unit.to_string()]
    };
    csv(&["quantity", "value", "unit"], lines.iter().map(row))
}
