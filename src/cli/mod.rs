//! The commands of the program stand here: what a user types, and what the terminal shows.

mod arguments;
mod studies;
mod terminal;
mod verdicts;

use arguments::{Arguments, BasisName, Command, Scenes, ShapeArguments};
use clap::{CommandFactory, Parser};
use clap_complete::Shell;
use comfy_table::{CellAlignment, Table, presets};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lme_mpm::method::basis::{Basis, Support};
use lme_mpm::output::summary::SummaryLine;
use lme_mpm::output::{files, report};
use lme_mpm::port::check::{self, Asked, Tolerance};
use lme_mpm::port::points::{self, Points};
use lme_mpm::scene::fault::Fault;
use lme_mpm::scene::schema::schema;
use lme_mpm::scene::{DYKA, SHIPPED, Scene, declare, shipped};
use lme_mpm::study::ranking::Question;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use terminal::{open, print_bytes};

const BOLD: anstyle::Style = anstyle::Style::new().bold();
const RED: anstyle::Style =
    anstyle::Style::new().bold().fg_color(Some(anstyle::Color::Ansi(anstyle::AnsiColor::Red)));

/// Does the command that was typed, and tells what went wrong.
pub fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        None => built_in(),
        Some(Command::Run { scene, out, set, quiet }) => {
            files::scene(&scene, &set).and_then(|read| run(&read, Some(&scene), out, quiet))
        }
        Some(Command::Scenes { ask }) => scenes(ask),
        Some(Command::Completions { shell }) => completions(shell),
        Some(Command::Exact { scene, points }) => exact(&scene, &points),
        Some(Command::Shape(arguments)) => shape(&arguments),
        Some(Command::Trace { scene, steps, set, hex, out }) => {
            trace(&scene, steps, &set, hex, out.as_deref())
        }
        Some(Command::Check { reference, theirs, rtol, atol, part, skip, from, all }) => {
            let tolerance = Tolerance { relative: rtol, absolute: atol };
            compare(&reference, &theirs, &Asked { tolerance, part, skip, from, all })
        }
        Some(Command::Trade(arguments)) => verdicts::trade(&arguments),
        Some(Command::Recommend { scene, error, quantity, out, jobs }) => {
            verdicts::recommend(&scene, Question { criterion: quantity, error }, out, jobs)
        }
        Some(Command::Gamma { rows, out, jobs }) => studies::gamma(&rows, &out, jobs),
        Some(Command::Orders { rows, scene, out, jobs }) => {
            studies::orders(&rows, &scene, &out, jobs)
        }
        Some(Command::Stability { rows, scene, out, jobs }) => {
            studies::stability(&rows, scene.as_deref(), &out, jobs)
        }
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
    let scene = lme_mpm::run::parse("dyka", "dyka.toml (built in)", DYKA, &[])?;
    run(&scene, None, None, false)
}

fn run(scene: &Scene, path: Option<&Path>, out: Option<PathBuf>, quiet: bool) -> Result<(), Fault> {
    let dir = out.unwrap_or_else(|| Path::new("out").join(&scene.name));
    if let Some(path) = path {
        let endings = [".csv", ".svg", ".vtu", ".pvd"];
        files::spare(path, &dir, |name| endings.iter().any(|ending| name.ends_with(ending)))?;
    }
    let steps = scene.sizes().2 as u64;
    let bar = ProgressBar::with_draw_target(
        Some(steps),
        if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() },
    );
    let template =
        |text: &str| ProgressStyle::with_template(text).unwrap_or(ProgressStyle::default_bar());
    // With wide functions in 3D this takes as long as some steps.
    bar.set_style(template("predicting the largest stable time step ({elapsed})"));
    bar.enable_steady_tick(std::time::Duration::from_millis(250));
    let tell = (steps / 200).max(1);
    let lines = report::run_into(&dir, scene, &mut |step| {
        if step == 1 {
            bar.disable_steady_tick();
            bar.set_style(template("{bar:40} {pos}/{len} steps, {eta} left"));
        }
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

/// Lays out the summary as a table for the terminal.
fn table(lines: &[SummaryLine]) -> Table {
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

/// Does `lme-mpm scenes`.
fn scenes(ask: Option<Scenes>) -> Result<(), Fault> {
    match ask {
        None => {
            let mut list = String::new();
            for scene in SHIPPED {
                let title = declare(scene.name, scene.name, scene.text, &[])?.scene.title;
                list += &format!("{:16} {title}\n", scene.name);
            }
            print_bytes(list.as_bytes())
        }
        Some(Scenes::Show { name }) => {
            print_bytes(shipped(&name).map_or("", |scene| scene.text).as_bytes())
        }
        Some(Scenes::Schema) => print_bytes(format!("{:#}\n", schema()).as_bytes()),
    }
}

/// Does `lme-mpm completions`.
fn completions(shell: Shell) -> Result<(), Fault> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "lme-mpm", &mut script);
    print_bytes(&script)
}

fn exact(scene: &Path, points: &Path) -> Result<(), Fault> {
    let scene = files::scene(scene, &[])?;
    let answer = points::exact_at(&scene, &points.display().to_string(), open(points)?)?;
    print_bytes(&answer)
}

fn shape(arguments: &ShapeArguments) -> Result<(), Fault> {
    let spacing = arguments.spacing;
    let (lme, ugimp) = (arguments.basis == BasisName::Lme, arguments.basis == BasisName::Ugimp);
    for (argument, foreign, allowed) in [
        ("--gamma", arguments.gamma.is_some() && !lme, "with --basis lme only"),
        ("--cutoff", arguments.cutoff.is_some() && !lme, "with --basis lme only"),
        ("--half-length", arguments.half_length.is_some() && !ugimp, "with --basis ugimp only"),
    ] {
        if foreign {
            let problem = "it means nothing to this basis".to_string();
            return Err(Fault::Argument { argument, problem, allowed });
        }
    }
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
        BasisName::Lme => Basis::Lme {
            gamma: arguments.gamma.unwrap_or(1.0),
            cutoff: arguments.cutoff.unwrap_or(1e-6),
            support: Support::Ball,
        },
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
    let scene = files::scene(path, sets)?;
    lme_mpm::port::trace::affordable(&scene, steps)?;
    report::stable(&scene)?;
    let place = match out {
        Some(out) if out != Path::new("-") => Some(place_beside(path, out)?),
        _ => None,
    };
    let entries = lme_mpm::port::trace::trace(&scene, steps)
        .map_err(|broken| Fault::Run { broken, advice: "nothing was written".to_string() })?;
    let text = lme_mpm::port::trace::csv(&entries, hex)?;
    match place {
        None => print_bytes(&text),
        Some((folder, name)) => files::write_all(&folder, &[(name, text)], &[]),
    }
}

/// Gives the folder, made if need be, and the name of a file to write, which is not the
/// `input`.
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
    files::prepare(folder)?;
    Ok((folder.to_path_buf(), name.to_string_lossy().into_owned()))
}

fn compare(reference: &Path, theirs: &Path, asked: &Asked) -> Result<(), Fault> {
    if reference == Path::new("-") && theirs == Path::new("-") {
        return Err(Fault::Argument {
            argument: "THEIRS",
            problem: "standard input cannot be both".to_string(),
            allowed: "a file, or - if the reference is one",
        });
    }
    let read = |path: &Path| check::read(&path.display().to_string(), open(path)?);
    let (reference, theirs) = (read(reference)?, read(theirs)?);
    let report = check::compare_as(&reference.entries, &theirs, asked)?;
    match report.divergence {
        None => print_bytes(report.text().as_bytes()),
        Some(_) => Err(Fault::Differs(report.text().trim_end().to_string())),
    }
}
