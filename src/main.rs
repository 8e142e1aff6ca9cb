//! The command line. No numerics here.

mod studies;

use clap::{Args, Parser, Subcommand, ValueEnum};
use comfy_table::{CellAlignment, Table, presets};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lme_mpm::basis::Basis;
use lme_mpm::check::{self, Tolerance};
use lme_mpm::fault::Fault;
use lme_mpm::points::{self, Points};
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
    /// Evaluate shape functions and their gradients at points
    ///
    /// Reads two CSV files with the columns x[,y[,z]] (m) and prints CSV
    /// point,node,N,dN_dx[,dN_dy[,dN_dz]], points and nodes counted from 0.
    /// Nodes outside the support are left out. lme takes any set of nodes, the
    /// others a regular grid.
    #[command(
        after_help = "Example:\n  lme-mpm shape --basis lme --spacing 0.1 --gamma 0.8 --nodes nodes.csv --points points.csv"
    )]
    Shape(ShapeArguments),
    /// Write down every intermediate of the first steps of a scene
    ///
    /// CSV k,step,symbol,index,node,component,value in the paper's order, to hold a
    /// port against; see `lme-mpm check`.
    #[command(
        after_help = "Example:\n  lme-mpm trace data/scenes/dyka.toml --steps 2 --set grid.cells=4 --out trace.csv"
    )]
    Trace {
        /// The scene file (TOML, SI units)
        scene: PathBuf,
        /// How many time steps, at most those of the scene
        #[arg(long, value_name = "K", default_value_t = 1)]
        steps: usize,
        /// Replace or add a value of the scene; may be given again
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// Numbers in hexadecimal, as C prints them with %a
        #[arg(long)]
        hex: bool,
        /// Where to write, folders are made; without it, or with -, standard output
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Hold a port's trace against a reference
    ///
    /// Reads two CSV files with the columns of a trace. The port may leave out time
    /// steps, or symbols of a time step, and is told so. Reports the first number
    /// that differs, in the paper's order, with its equation and the likely cause;
    /// the exit code is then 1, and 2 for files that cannot be compared.
    #[command(
        after_help = "Example:\n  lme-mpm check data/conformance/level-1/linear_1.csv port.csv --rtol 1e-11 --atol 1e-13"
    )]
    Check {
        /// What `lme-mpm trace` wrote, or a file of the conformance kit; - reads standard input
        reference: PathBuf,
        /// What the port wrote; - reads standard input
        theirs: PathBuf,
        /// Allowed difference, relative to the number
        #[arg(long, default_value_t = 1e-9, value_parser = fraction)]
        rtol: f64,
        /// Allowed besides, relative to the largest value of the symbol in its time step
        #[arg(long, default_value_t = 1e-12, value_parser = fraction)]
        atol: f64,
        /// Compare what both have, also where the port has only some numbers of a symbol, or more
        #[arg(long)]
        part: bool,
    },
    /// Measure the trade of speed for accuracy on a scene
    ///
    /// Runs many configurations three times each and writes trade.csv (errors,
    /// energy drift, counted cost, wall time), cheapest.csv, and a work-precision
    /// diagram for each quantity. runs.csv is its log: a study that was interrupted
    /// goes on where it stopped.
    #[command(
        after_help = "Example:\n  lme-mpm trade --out out/trade\n  lme-mpm trade --list | parallel --jobs 2 '{}' '>' 'rows/{#}.csv'\n  lme-mpm trade --out out/trade --merge rows/*.csv"
    )]
    Trade(TradeArguments),
    /// Find the cheapest configuration that reaches an error on a scene
    ///
    /// Measures as `trade` does, prints the evidence, and writes
    /// recommended.toml, a scene file ready to run.
    #[command(
        after_help = "Example:\n  lme-mpm recommend data/scenes/vibration.toml --error 1% --quantity displacement"
    )]
    Recommend {
        /// The scene file (TOML, SI units); it needs an exact solution
        scene: PathBuf,
        /// The relative error to reach, as 1% or 0.01
        #[arg(long, value_parser = percent)]
        error: f64,
        /// Which error
        #[arg(long, default_value = "velocity")]
        quantity: QuantityName,
        /// Where to write; out/recommend/<scene name> without it
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
    /// Study the parameter γ of local max-ent on the bar
    ///
    /// Writes gamma.csv and pictures: errors, overshoot, total variation,
    /// dispersion, energy drift, cost and the largest stable time step against γ,
    /// for MPM with both mass matrices and for OTM.
    #[command(after_help = "Example:\n  lme-mpm gamma --out out/gamma")]
    Gamma {
        /// Where to write
        #[arg(long, value_name = "DIR", default_value = "out/gamma")]
        out: PathBuf,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
    /// Map the largest stable time step, predicted and measured
    ///
    /// Writes stability.csv for every basis, integrator, mass, number of particles
    /// per cell and offset on the grid of a scene.
    #[command(after_help = "Example:\n  lme-mpm stability --out out/stability --jobs 2")]
    Stability {
        /// The scene file; the built-in bar on 10 cells without it
        #[arg(long, value_name = "FILE")]
        scene: Option<PathBuf>,
        /// Where to write
        #[arg(long, value_name = "DIR", default_value = "out/stability")]
        out: PathBuf,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
}

#[derive(Args)]
struct TradeArguments {
    /// The scene file; the built-in bar without it
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Where to write
    #[arg(long, value_name = "DIR", default_value = "out/trade")]
    out: PathBuf,
    /// The large grid, which takes hours
    #[arg(long)]
    full: bool,
    /// Threads; each run has one of its own
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: u16,
    /// Print the command of every row and do nothing
    #[arg(long, conflicts_with_all = ["row", "merge"])]
    list: bool,
    /// Run one row of --list and print its part of the log
    #[arg(long, value_name = "CONFIGURATION", conflicts_with = "merge")]
    row: Option<String>,
    /// Gather logs that --row has printed
    #[arg(long, value_name = "FILE", num_args = 1..)]
    merge: Vec<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum QuantityName {
    Velocity,
    Stress,
    Displacement,
}

#[derive(Args)]
struct ShapeArguments {
    #[arg(long)]
    basis: BasisName,
    /// h, the spacing of the nodes (m)
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    spacing: f64,
    /// γ = βh² of lme
    #[arg(long, value_name = "G", required_if_eq("basis", "lme"), value_parser = positive, allow_negative_numbers = true)]
    gamma: Option<f64>,
    /// lme leaves out nodes with exp(−γ|ξ|²) below it; 0 leaves out none
    #[arg(long, value_name = "TOL", default_value_t = 1e-6, value_parser = fraction, allow_negative_numbers = true)]
    cutoff: f64,
    /// Half the length of a particle of ugimp (m), at most H/2
    #[arg(long, value_name = "LP", required_if_eq("basis", "ugimp"), value_parser = positive, allow_negative_numbers = true)]
    half_length: Option<f64>,
    /// The nodes
    #[arg(long, value_name = "FILE")]
    nodes: PathBuf,
    /// The points; - reads standard input
    #[arg(long, value_name = "FILE|-")]
    points: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum BasisName {
    Linear,
    Ugimp,
    Lme,
    Bspline,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_normal() && x.recip().is_normal() => Ok(x),
        _ => Err("a number above 0, at least 1e-307 and at most 1e307, is allowed".to_string()),
    }
}

fn fraction(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (0.0..1.0).contains(&x) => Ok(x),
        _ => Err("a number from 0 up to and below 1 is allowed".to_string()),
    }
}

fn percent(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    match number.parse::<f64>() {
        Ok(x) if x > 0.0 && x * unit < 10.0 => Ok(x * unit),
        _ => Err("a number above 0 is allowed, as 1% or 0.01".to_string()),
    }
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        None => built_in(),
        Some(Command::Run { scene, out, set, quiet }) => {
            Scene::open(&scene, &set).and_then(|scene| run(&scene, out, quiet))
        }
        Some(Command::Exact { scene, points }) => exact(&scene, &points),
        Some(Command::Shape(arguments)) => shape(&arguments),
        Some(Command::Trace { scene, steps, set, hex, out }) => {
            trace(&scene, steps, &set, hex, out.as_deref())
        }
        Some(Command::Check { reference, theirs, rtol, atol, part }) => {
            compare(&reference, &theirs, Tolerance { relative: rtol, absolute: atol }, part)
        }
        Some(Command::Trade(arguments)) => studies::trade(&arguments),
        Some(Command::Recommend { scene, error, quantity, out, jobs }) => {
            studies::recommend(&scene, error, quantity, out, jobs)
        }
        Some(Command::Gamma { out, jobs }) => studies::gamma(&out, jobs),
        Some(Command::Stability { scene, out, jobs }) => studies::stability(scene, &out, jobs),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            let message = match &fault {
                Fault::Scene(error) => error.render(&annotate_snippets::Renderer::styled()),
                _ => format!("{RED}error{RED:#}: {fault}"),
            };
            // If even this cannot be said, the exit code says it.
            writeln!(anstream::stderr(), "{message}").ok();
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
        let text = format!(
            "{BOLD}{}{BOLD:#}\n{}\nwritten to {}\n",
            scene.title,
            table(&lines),
            dir.display()
        );
        print_bytes(text.as_bytes())?;
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
    let answer = points::exact_at(&scene, &points.display().to_string(), open(points)?)?;
    print_bytes(&answer)
}

fn shape(arguments: &ShapeArguments) -> Result<(), Fault> {
    let spacing = arguments.spacing;
    let half = arguments.half_length.map_or(0.5, |half| half / spacing);
    if half > 0.5 {
        return Err(Fault::Argument {
            argument: "--half-length",
            problem: format!("{half} of the spacing"),
            allowed: "at most half of the spacing",
        });
    }
    let basis = match arguments.basis {
        BasisName::Linear => Basis::Linear,
        BasisName::Ugimp => Basis::Ugimp { half_length: [half; 3] },
        BasisName::Bspline => Basis::BSpline,
        BasisName::Lme => {
            Basis::Lme { gamma: arguments.gamma.unwrap_or(1.0), cutoff: arguments.cutoff }
        }
    };
    let read =
        |path: &Path| Points::read(&path.display().to_string(), open(path)?, &points::COORDINATES);
    let (nodes, points) = (read(&arguments.nodes)?, read(&arguments.points)?);
    print_bytes(&points::shape_at(&basis, spacing, &nodes, &points)?)
}

fn trace(
    path: &Path,
    steps: usize,
    sets: &[String],
    hex: bool,
    out: Option<&Path>,
) -> Result<(), Fault> {
    let scene = Scene::open(path, sets)?;
    lme_mpm::trace::affordable(&scene, steps)?;
    report::stable(&scene)?;
    let place = match out {
        Some(out) if out != Path::new("-") => Some(place_beside(path, out)?),
        _ => None,
    };
    let entries = lme_mpm::trace::trace(&scene, steps)
        .map_err(|breakdown| Fault::Run { breakdown, advice: "nothing was written".to_string() })?;
    let text = lme_mpm::trace::csv(&entries, hex)?;
    match place {
        None => print_bytes(&text),
        Some((folder, name)) => lme_mpm::history::write_all(&folder, &[(name, text)], &[]),
    }
}

/// Folder, made if need be, and name of a file to write, which is not the `input`.
fn place_beside(input: &Path, out: &Path) -> Result<(PathBuf, String), Fault> {
    let refuse = |problem: &str| Fault::Argument {
        argument: "--out",
        problem: format!("`{}` is {problem}", out.display()),
        allowed: "a file to write, or - for standard output",
    };
    let folder = out.parent().filter(|p| *p != Path::new("")).unwrap_or(Path::new("."));
    let Some(name) = out.file_name().filter(|_| !out.is_dir()) else {
        return Err(refuse("a directory"));
    };
    if let (Ok(input), Ok(out)) = (input.canonicalize(), out.canonicalize())
        && input == out
    {
        return Err(refuse("the scene itself"));
    }
    lme_mpm::history::prepare(folder)?;
    Ok((folder.to_path_buf(), name.to_string_lossy().into_owned()))
}

fn compare(reference: &Path, theirs: &Path, tolerance: Tolerance, part: bool) -> Result<(), Fault> {
    if reference == Path::new("-") && theirs == Path::new("-") {
        return Err(Fault::Argument {
            argument: "THEIRS",
            problem: "standard input cannot be both".to_string(),
            allowed: "a file, or - if the reference is one",
        });
    }
    let read = |path: &Path| check::read(&path.display().to_string(), open(path)?);
    let (reference, theirs) = (read(reference)?, read(theirs)?);
    let report = check::compare(&reference.entries, &theirs, tolerance, part)?;
    match report.divergence {
        None => print_bytes(report.text().as_bytes()),
        Some(_) => Err(Fault::Differs(report.text().trim_end().to_string())),
    }
}

/// A file, or standard input for `-`.
fn open(path: &Path) -> Result<Box<dyn Read>, Fault> {
    if path == Path::new("-") {
        return Ok(Box::new(std::io::stdin()));
    }
    let file = std::fs::File::open(path)
        .map_err(|source| Fault::Read { path: path.to_path_buf(), source })?;
    Ok(Box::new(file))
}

/// Prints, without colours unless on a terminal. A reader that has seen enough
/// and closed the pipe is no error.
fn print_bytes(bytes: &[u8]) -> Result<(), Fault> {
    let mut out = anstream::stdout();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(source) if source.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Fault::Write { path: "standard output".into(), source })
        }
        _ => Ok(()),
    }
}
