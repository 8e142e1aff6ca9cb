//! The command line. No numerics here.

use anstream::{eprintln, println};
use clap::{Parser, Subcommand};
use comfy_table::{CellAlignment, Table, presets};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lme_mpm::fault::Fault;
use lme_mpm::report;
use lme_mpm::scene::{DYKA, Scene};
use lme_mpm::summary::Line;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const BOLD: anstyle::Style = anstyle::Style::new().bold();
const RED: anstyle::Style =
    anstyle::Style::new().bold().fg_color(Some(anstyle::Color::Ansi(anstyle::AnsiColor::Red)));

/// The Material Point Method with local maximum-entropy shape functions.
///
/// Without a command it runs the Dyka and Ingel bar, which ships inside the
/// program, and writes the results to out/dyka.
#[derive(Parser)]
#[command(
    version,
    after_help = "Example:\n  lme-mpm            run the built-in bar\n  lme-mpm run --help what a run reads and writes"
)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Run a scene and compare it with its exact solution
    ///
    /// Writes history.csv, particles.csv, summary.csv, cost.csv and one SVG
    /// for each probe. A run that breaks down leaves history.failed.csv only.
    #[command(
        after_help = "Example:\n  lme-mpm run data/scenes/dyka.toml --set grid.cells=160 --set time.cfl=0.9 --out out/fine"
    )]
    Run {
        /// The scene file (TOML, SI units)
        scene: PathBuf,
        /// Where to write; out/<scene name> without it
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Replace or add a value of the scene; may be given again
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// No progress bar and no summary
        #[arg(long, short)]
        quiet: bool,
    },
    /// Evaluate the exact solution of a scene at points
    ///
    /// Reads CSV with the columns x,t (m, s) and prints CSV
    /// x,t,velocity,stress,displacement (m, s, m/s, Pa, m), where x is the
    /// place of the material point at t = 0.
    #[command(
        after_help = "Example:\n  printf 'x,t\\n0.1333,1e-5\\n' | lme-mpm exact data/scenes/dyka.toml --points -"
    )]
    Exact {
        /// The scene file (TOML, SI units)
        scene: PathBuf,
        /// The points; - reads standard input
        #[arg(long, value_name = "FILE|-")]
        points: PathBuf,
    },
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        None => built_in(),
        Some(Command::Run { scene, out, set, quiet }) => {
            Scene::open(&scene, &set).and_then(|scene| run(&scene, out, quiet))
        }
        Some(Command::Exact { scene, points }) => exact(&scene, &points),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            match &fault {
                Fault::Scene(error) => {
                    eprintln!("{}", error.render(&annotate_snippets::Renderer::styled()));
                }
                _ => eprintln!("{RED}error{RED:#}: {fault}"),
            }
            ExitCode::from(fault.exit_code())
        }
    }
}

fn built_in() -> Result<(), Fault> {
    let scene = Scene::parse("dyka", "dyka.toml (built in)", DYKA, &[])?;
    run(&scene, None, false)
}

fn run(scene: &Scene, out: Option<PathBuf>, quiet: bool) -> Result<(), Fault> {
    let dir = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    let steps = scene.sizes().2 as u64;
    let bar = ProgressBar::with_draw_target(
        Some(steps),
        if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() },
    );
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} steps, {eta} left") {
        bar.set_style(style);
    }
    let tell = (steps / 200).max(1);
    let lines = report::run_into(&dir, scene, &mut |step| {
        if (step as u64).is_multiple_of(tell) {
            bar.set_position(step as u64);
        }
    });
    bar.finish_and_clear();
    let lines = lines?;
    if !quiet {
        println!("{BOLD}{}{BOLD:#}", scene.title);
        println!("{}", table(&lines));
        println!("written to {}", dir.display());
    }
    Ok(())
}

/// The summary as a table for the terminal.
fn table(lines: &[Line]) -> Table {
    let mut table = Table::new();
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

fn exact(scene: &Path, points: &Path) -> Result<(), Fault> {
    let scene = Scene::open(scene, &[])?;
    let name = points.display().to_string();
    let input: Box<dyn Read> = match name.as_str() {
        "-" => Box::new(std::io::stdin()),
        _ => Box::new(
            std::fs::File::open(points)
                .map_err(|source| Fault::Read { path: points.to_path_buf(), source })?,
        ),
    };
    let answer = report::exact_at(&scene, &name, input)?;
    std::io::stdout()
        .write_all(&answer)
        .map_err(|source| Fault::Write { path: "standard output".into(), source })
}
