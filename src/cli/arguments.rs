//! The command line understands these commands and arguments.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use lme_mpm::method::basis::{Degree, Support};
use lme_mpm::port::trace::SYMBOLS;
use lme_mpm::scene::SHIPPED;
use lme_mpm::study::measured::Criterion;
use std::path::PathBuf;

/// The Material Point Method with local maximum-entropy shape functions.
///
/// Without a command it runs the Dyka and Ingel bar, which ships inside the
/// program, and writes the results to out/dyka.
#[derive(Parser)]
#[command(
    version,
    after_help = "Example:\n  lme-mpm            run the built-in bar\n  lme-mpm scenes     list what else is built in\n  lme-mpm run --help what a run reads and writes"
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,
}

#[derive(Subcommand)]
pub enum Command {
    /// Run a scene and compare it with its exact solution
    ///
    /// Writes history.csv, particles.csv, summary.csv, cost.csv and one SVG
    /// for each probe, and results.txt, which lists them. They replace a directory
    /// that is empty or holds nothing but what its results.txt lists. A run that
    /// breaks down leaves history.failed.csv only, with exit code 1; so does Ctrl-C,
    /// with exit code 130. Shows eight figures of the summary, on a terminal also the
    /// first probe.
    #[command(
        after_help = "Example:\n  lme-mpm run dyka --set grid.cells=160 --set time.cfl=0.9 --out out/fine"
    )]
    Run {
        /// The scene: a file (TOML, SI units), or the name of a shipped one
        scene: PathBuf,
        /// Where to write; out/<scene name> without it
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Replace or add a value of the scene, or take it out with KEY=; may be given again
        #[arg(long, value_name = "KEY=VALUE")]
        set: Vec<String>,
        /// No progress bar and no summary
        #[arg(long, short, conflicts_with = "all")]
        quiet: bool,
        /// Take warnings for errors: the results are written, and the exit code is 1
        #[arg(long)]
        strict: bool,
        /// Show the whole summary, not the eight figures that matter most
        #[arg(long)]
        all: bool,
        /// End the run when so many seconds are over, and leave what it has recorded; such a run
        /// may start however much work it is
        #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
        max_time: Option<f64>,
    },
    /// List the shipped scenes, print one to start from, or the schema of scenes
    #[command(
        after_help = "Example:\n  lme-mpm scenes\n  lme-mpm scenes show dyka > my-bar.toml\n  lme-mpm scenes schema > scene.schema.json"
    )]
    Scenes {
        #[command(subcommand)]
        ask: Option<Scenes>,
    },
    /// Evaluate the exact solution of a scene at points
    ///
    /// Reads CSV with the columns x,t (m, s) and prints CSV
    /// x,t,velocity,stress,displacement (m, s, m/s, Pa, m), where x is the
    /// place of the material point at t = 0.
    #[command(
        after_help = "Example:\n  printf 'x,t\\n0.1333,1e-5\\n' | lme-mpm exact dyka --points -"
    )]
    Exact {
        /// The scene: a file (TOML, SI units), or the name of a shipped one
        scene: PathBuf,
        /// The points; - reads standard input
        #[arg(long, value_name = "FILE|-")]
        points: PathBuf,
    },
    /// Evaluate shape functions and their gradients at points
    ///
    /// Reads two CSV files with the columns x[,y[,z]] (m) and prints CSV
    /// point,node,N,dN_dx[,dN_dy[,dN_dz]], points and nodes counted from 0.
    /// Nodes outside the support are left out. On a full grid with the spacing H these
    /// are the functions of a run with MPM; a point always sees the corners of its cell. lme takes
    /// other nodes, too, and gives what a run with OTM uses: a point sees the nodes within
    /// R = H √(−ln TOL / G), at least H, and where they do not enclose it R is widened.
    #[command(
        after_help = "Example:\n  lme-mpm shape --basis lme --spacing 0.1 --gamma 0.8 --nodes nodes.csv --points points.csv"
    )]
    Shape(ShapeArguments),
    /// Write down every intermediate of the first steps of a scene
    ///
    /// CSV k,step,symbol,index,node,component,value in the paper's order, to hold a
    /// port against; see `lme-mpm check`.
    #[command(
        after_help = "Example:\n  lme-mpm trace dyka --steps 2 --set grid.cells=4 --out trace.csv"
    )]
    Trace {
        /// The scene: a file (TOML, SI units), or the name of a shipped one
        scene: PathBuf,
        /// How many time steps, at most those of the scene
        #[arg(long, value_name = "K", default_value_t = 1)]
        steps: usize,
        /// Replace or add a value of the scene, or take it out with KEY=; may be given again
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
        #[arg(long, default_value_t = 1e-9, value_parser = fraction, allow_negative_numbers = true)]
        rtol: f64,
        /// Allowed besides, relative to the largest value of the symbol in its time step, or its floor
        #[arg(long, default_value_t = 1e-12, value_parser = fraction, allow_negative_numbers = true)]
        atol: f64,
        /// Compare what both have, also where the port has only some numbers of a symbol, or more
        #[arg(long)]
        part: bool,
        /// Leave this symbol out; may be given more than once
        #[arg(long, value_name = "SYMBOL", value_parser = PossibleValuesParser::new(SYMBOLS.map(|known| known.0)))]
        skip: Vec<String>,
        /// Begin with this time step
        #[arg(long, value_name = "K", default_value_t = 0)]
        from: usize,
        /// List the first difference of every symbol, not only the first of all
        #[arg(long)]
        all: bool,
    },
    /// Measure the trade of speed for accuracy on a scene
    ///
    /// Runs many configurations three times each, on grids from a few cells up, and writes
    /// trade.csv (errors, energy drift, counted cost, wall time), cheapest.csv, and a
    /// work-precision diagram for each quantity. runs.csv is its log: a study that was interrupted
    /// goes on where it stopped.
    #[command(
        after_help = "Example:\n  lme-mpm trade --out out/trade\n  lme-mpm trade --list | parallel --jobs 2 '{}' '>' 'rows/{#}.csv'\n  lme-mpm trade --out out/trade --merge rows/*.csv"
    )]
    Trade(TradeArguments),
    /// Find the cheapest configuration that reaches an error on a scene
    ///
    /// Measures as `trade` does, from coarse grids up, until the rest would cost more. Prints
    /// the cheapest with MPM, OTM and finite elements beside it, and what comes out when
    /// nothing changes but a little γ, the particles or the grid. Writes recommended.toml, a
    /// scene file ready to run, neighbours.csv, and where the cheapest is fragile robust.toml.
    #[command(
        after_help = "Example:\n  lme-mpm recommend vibration --error 1% --quantity displacement"
    )]
    Recommend {
        /// The scene, with an exact solution: a file (TOML, SI units), or the name of a shipped one
        scene: PathBuf,
        /// The relative error to reach, as 1% or 0.01
        #[arg(long, value_parser = percent)]
        error: f64,
        /// Which error
        #[arg(long, default_value = "velocity", value_parser = criterion())]
        quantity: Criterion,
        /// Where to write; out/recommend/<scene name> without it
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
    /// Measure what there is to choose on the bar: method, basis, mass matrix, γ, particles, step
    ///
    /// Writes choose.csv: errors, energy drift and counted cost of the bar on 40 to 640 cells by
    /// method, basis and mass matrix; for γ from 0.5 to 4, one to four particles per cell and
    /// Courant numbers from the limit down; with and without a node beyond the free end; and of a
    /// bar that hardly moves. It takes some minutes.
    #[command(
        after_help = "Example:\n  lme-mpm choose --out out/choose --jobs 2\n  lme-mpm choose --list | parallel --jobs 2 '{}' '>' 'rows/{#}.csv'\n  lme-mpm choose --out out/choose --merge rows/*.csv"
    )]
    Choose {
        #[command(flatten)]
        rows: RowArguments,
        /// Where to write
        #[arg(long, value_name = "DIR", default_value = "out/choose")]
        out: PathBuf,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
    /// Hold all methods side by side: the bar, and a motion across cells
    ///
    /// Writes methods.csv: errors, energy and counted cost of every basis, reconstruction, filter
    /// and implicit scheme, on the bar of 80 cells, and where ten of 160 cells are crossed with two
    /// particles per cell and with four. It takes a minute.
    #[command(
        after_help = "Example:\n  lme-mpm methods --out out/methods --jobs 2\n  lme-mpm methods --list | parallel --jobs 2 '{}' '>' 'rows/{#}.csv'\n  lme-mpm methods --out out/methods --merge rows/*.csv"
    )]
    Methods {
        #[command(flatten)]
        rows: RowArguments,
        /// Where to write
        #[arg(long, value_name = "DIR", default_value = "out/methods")]
        out: PathBuf,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
    /// Study the parameter γ of local max-ent on the bar
    ///
    /// Writes gamma.csv and pictures: errors, overshoot, total variation,
    /// dispersion, energy drift, cost and the largest stable time step against γ,
    /// for MPM with both mass matrices and for OTM.
    #[command(
        after_help = "Example:\n  lme-mpm gamma --out out/gamma\n  lme-mpm gamma --list | parallel --jobs 2 '{}' '>' 'rows/{#}.csv'\n  lme-mpm gamma --out out/gamma --merge rows/*.csv"
    )]
    Gamma {
        #[command(flatten)]
        rows: RowArguments,
        /// Where to write
        #[arg(long, value_name = "DIR", default_value = "out/gamma")]
        out: PathBuf,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
    /// Measure the orders of convergence of a motion with an exact solution
    ///
    /// Writes orders.csv: errors and orders in h, with Δt in proportion to h², and in Δt, for
    /// every basis and mass matrix, 1 to 8 particles per cell, one span of the scene's time and
    /// five, and for volumes that are the exact ones.
    #[command(
        after_help = "Example:\n  lme-mpm orders --out out/orders --jobs 2\n  lme-mpm orders --scene vortex --list | parallel --jobs 2 '{}' '>' 'rows/{#}.csv'\n  lme-mpm orders --scene vortex --out out/orders --merge rows/*.csv"
    )]
    Orders {
        #[command(flatten)]
        rows: RowArguments,
        /// The scene, a file or a shipped one; the shipped manufactured motion without it
        #[arg(long, value_name = "FILE", default_value = "manufactured")]
        scene: PathBuf,
        /// Where to write
        #[arg(long, value_name = "DIR", default_value = "out/orders")]
        out: PathBuf,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
    /// Map the largest stable time step, predicted and measured
    ///
    /// Writes stability.csv for every basis, integrator, mass, number of particles
    /// per cell and offset on the grid of a scene.
    #[command(
        after_help = "Example:\n  lme-mpm stability --out out/stability --jobs 2\n  lme-mpm stability --list | parallel --jobs 2 '{}' '>' 'rows/{#}.csv'\n  lme-mpm stability --out out/stability --merge rows/*.csv"
    )]
    Stability {
        #[command(flatten)]
        rows: RowArguments,
        /// The scene, a file or a shipped one; the bar on 10 cells without it
        #[arg(long, value_name = "FILE")]
        scene: Option<PathBuf>,
        /// Where to write
        #[arg(long, value_name = "DIR", default_value = "out/stability")]
        out: PathBuf,
        /// Threads; each run has one of its own
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
    },
    /// Print what makes a shell complete this program's commands
    #[command(
        after_help = "Example:\n  lme-mpm completions bash > ~/.local/share/bash-completion/completions/lme-mpm"
    )]
    Completions { shell: Shell },
}

#[derive(Subcommand)]
pub enum Scenes {
    /// Print a shipped scene
    Show {
        #[arg(value_parser = PossibleValuesParser::new(SHIPPED.iter().map(|scene| scene.name)))]
        name: String,
    },
    /// Print the JSON Schema of a scene, for editors
    Schema,
}

#[derive(Args)]
pub struct TradeArguments {
    /// The scene, a file or a shipped one; the bar without it
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// Where to write
    #[arg(long, value_name = "DIR", default_value = "out/trade")]
    pub out: PathBuf,
    /// The large grid, which takes hours
    #[arg(long)]
    pub full: bool,
    /// Threads; each run has one of its own
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: u16,
    #[command(flatten)]
    pub rows: RowArguments,
}

/// Where one machine is not enough, the rows of a study run by themselves.
#[derive(Args)]
pub struct RowArguments {
    /// Print the command of every row and do nothing
    #[arg(long, conflicts_with_all = ["row", "merge"])]
    pub list: bool,
    /// Run one row of --list and print what comes out
    #[arg(long, value_name = "ROW", conflicts_with = "merge")]
    pub row: Option<String>,
    /// Gather what --row has printed
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub merge: Vec<PathBuf>,
}

#[derive(Args)]
pub struct ShapeArguments {
    #[arg(long)]
    pub basis: BasisName,
    /// h, the spacing of the nodes (m)
    #[arg(long, value_name = "H", value_parser = positive, allow_negative_numbers = true)]
    pub spacing: f64,
    /// γ = βh² of lme
    #[arg(long, value_name = "G", required_if_eq("basis", "lme"), value_parser = positive, allow_negative_numbers = true)]
    pub gamma: Option<f64>,
    /// lme leaves out nodes with exp(−γ|ξ|²) below it, 1e-6 without it; 0 leaves out none
    #[arg(long, value_name = "TOL", value_parser = fraction, allow_negative_numbers = true)]
    pub cutoff: Option<f64>,
    /// The cut-off of lme on a full grid leaves a box of nodes or a ball, as basis.support of a
    /// scene; box without it
    #[arg(long, value_parser = support())]
    pub support: Option<Support>,
    /// The degree of bspline, as basis.degree of a scene; 2 without it
    #[arg(long, value_parser = degree())]
    pub degree: Option<Degree>,
    /// Half the length of a particle of ugimp and gimp at the start (m), at most H/2
    #[arg(long, value_name = "LP", required_if_eq_any([("basis", "ugimp"), ("basis", "gimp")]), value_parser = positive, allow_negative_numbers = true)]
    pub half_length: Option<f64>,
    /// How far the particles of gimp have stretched along each axis; 1 without it
    #[arg(long, value_name = "F", value_parser = positive, allow_negative_numbers = true)]
    pub stretch: Option<f64>,
    /// The nodes
    #[arg(long, value_name = "FILE")]
    pub nodes: PathBuf,
    /// The points; - reads standard input
    #[arg(long, value_name = "FILE|-")]
    pub points: PathBuf,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BasisName {
    Linear,
    Ugimp,
    Gimp,
    Lme,
    Bspline,
    Ddmp,
}

/// Reads the name of a support.
fn support() -> impl TypedValueParser<Value = Support> {
    PossibleValuesParser::new(["box", "ball"])
        .map(|name| if name == "box" { Support::Box } else { Support::Ball })
}

/// Reads a degree.
fn degree() -> impl TypedValueParser<Value = Degree> {
    PossibleValuesParser::new(["2", "3"])
        .map(|name| if name == "3" { Degree::Cubic } else { Degree::Quadratic })
}

/// Reads the name of the quantity whose error is asked for.
fn criterion() -> impl TypedValueParser<Value = Criterion> {
    PossibleValuesParser::new(Criterion::ALL.map(Criterion::name)).try_map(|name| {
        let mut known = Criterion::ALL.into_iter();
        known.find(|one| one.name() == name).ok_or("it is not known")
    })
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
