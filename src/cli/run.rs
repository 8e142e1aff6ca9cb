//! The command `lme-mpm run`: what it does with a scene, and what it shows.

use super::terminal::{self, BOLD, print_report, spinner, style};
use comfy_table::{CellAlignment, presets};
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::output::report::Done;
use lme_mpm::output::summary::SummaryLine;
use lme_mpm::output::{figure, files, report};
use lme_mpm::run::Warning;
use lme_mpm::run::table::Table;
use lme_mpm::scene::fault::{Fault, smaller_step, too_large};
use lme_mpm::scene::{DYKA, Scene, declare};
use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

/// What a run shows of itself.
#[derive(Clone, Copy, PartialEq)]
pub enum Show {
    Chief,
    All,
    Nothing,
}

pub fn built_in() -> Result<(), Fault> {
    let scene = lme_mpm::run::parse("dyka", "dyka.toml (built in)", DYKA, &[])?;
    terminal::warn(&run(&scene, Request { out: None, show: Show::Chief, end: None })?, false)
}

/// This is what a run is asked for besides its scene.
pub struct Request {
    /// Where to write; out/<scene name> without it.
    pub out: Option<PathBuf>,
    pub show: Show,
    /// When it began, and the seconds that it may take from there.
    pub end: Option<(Instant, f64)>,
}

/// Runs a scene, writes its results, and gives what they are warned of.
pub fn run(scene: &Scene, asked: Request) -> Result<Vec<Warning>, Fault> {
    let Request { out, show, end } = asked;
    let dir = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    let interrupted = terminal::interrupted()?;
    let steps = scene.sizes().2 as u64;
    let bar = spinner(show == Show::Nothing);
    bar.set_length(steps);
    let tell = (steps / 200).max(1);
    let done = report::run_into(&dir, scene, &mut |step| {
        if step == 1 {
            bar.disable_steady_tick();
            bar.set_style(style("{bar:40} {pos}/{len} steps, {eta} left"));
        }
        if (step as u64).is_multiple_of(tell) {
            bar.set_position(step as u64);
        }
        match end {
            _ if interrupted.load(Ordering::Relaxed) => ControlFlow::Break(Breakdown::Interrupted),
            Some((start, seconds)) if start.elapsed().as_secs_f64() >= seconds => {
                ControlFlow::Break(Breakdown::OutOfTime { seconds })
            }
            _ => ControlFlow::Continue(()),
        }
    });
    bar.finish_and_clear();
    let Done { lines, history, warnings } = done?;
    if show != Show::Nothing {
        print_report(&shown(scene, &lines, &history, show), "", &dir)?;
    }
    Ok(warnings)
}

/// Writes what a run shows: its title, on a terminal its first probe, and figures.
fn shown(scene: &Scene, lines: &[SummaryLine], history: &Table, show: Show) -> String {
    let plot = match scene.probes.first().filter(|_| std::io::stdout().is_terminal()) {
        Some(probe) => figure::in_terminal(scene, probe, history),
        None => String::new(),
    };
    let figures: Vec<&SummaryLine> = match show {
        Show::All => lines.iter().collect(),
        _ => chief(scene, lines),
    };
    format!("{BOLD}{}{BOLD:#}\n{plot}{}\n", scene.title, table(&figures))
}

/// Puts a time step that is too large where it was written: file, line and key.
pub fn placed(fault: Fault, scene: &Scene, path: &Path, sets: &[String]) -> Fault {
    let (Fault::Unstable { courant, largest, singular }, Ok(text)) =
        (&fault, files::scene_text(path))
    else {
        return fault;
    };
    let Ok(declared) = declare(&scene.name, &path.display().to_string(), &text, sets) else {
        return fault;
    };
    let key = match scene.time.cfl < declared.scene.time.cfl {
        true => "time.fraction_of_critical",
        false => "time.cfl",
    };
    let mut error = declared.error(key, too_large(*courant, *largest));
    error.allowed = smaller_step(*singular);
    Fault::Scene(error)
}

/// Picks the figures that matter, at most eight: the first probe's error, or its peak where no
/// exact solution is known, the errors of all particles at the end, the energy, the part of the
/// limit that the time step is, and what the run took.
fn chief<'a>(scene: &Scene, lines: &'a [SummaryLine]) -> Vec<&'a SummaryLine> {
    let of_probe = scene.probes.first().and_then(|probe| {
        let names = ["rms_relative", "peak"].map(|what| format!("{}_{what}", probe.name));
        names.iter().find_map(|name| lines.iter().find(|line| line.quantity == *name))
    });
    let names = [
        "velocity_field_rms_relative",
        "stress_field_rms_relative",
        "displacement_field_rms_relative",
        "energy_growth_largest",
        "fraction_of_critical",
        "particle_node_pairs",
        "wall_time",
    ];
    let rest = lines.iter().filter(|line| names.contains(&line.quantity.as_str()));
    of_probe.into_iter().chain(rest).collect()
}

/// Lays out the summary as a table for the terminal.
fn table(lines: &[&SummaryLine]) -> comfy_table::Table {
    let mut table = comfy_table::Table::new();
    table.load_style(presets::NOTHING).set_header(["quantity", "value", "unit"]);
    for line in lines {
        let value = match line.value {
            whole if whole == whole.trunc() && whole.abs() < 1e15 => format!("{whole}"),
            small if small.abs() < 1e-3 || small.abs() >= 1e6 => format!("{small:.4e}"),
            x => format!("{x:.5}"),
        };
        let unit = if line.unit == "1" { "" } else { line.unit };
        table.add_row([&line.quantity.replace('_', " "), &value, unit]);
    }
    if let Some(column) = table.column_mut(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
