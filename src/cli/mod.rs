//! The commands of the program stand here: what a user types, and what the terminal shows.

mod arguments;
mod machine;
mod run;
mod studies;
mod terminal;
mod verdicts;

use arguments::{Arguments, BasisName, Command, Scenes, ShapeArguments};
use clap::{CommandFactory, Parser};
use clap_complete::Shell;
use lme_mpm::method::basis::{Basis, Degree, Support};
use lme_mpm::output::files;
use lme_mpm::port::check::{self, Asked, Tolerance};
use lme_mpm::port::points::{self, Points};
use lme_mpm::run::stability;
use lme_mpm::scene::fault::Fault;
use lme_mpm::scene::schema::schema;
use lme_mpm::scene::{SHIPPED, declare, shipped};
use lme_mpm::study::ranking::Question;
use run::{Request, Show, built_in, placed, run};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;
use terminal::{open, predicting, print_bytes};

/// Does the command that was typed, and tells what went wrong.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return ExitCode::from(terminal::tell_usage(&error)),
    };
    match dispatch(arguments.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            terminal::tell(&fault);
            ExitCode::from(fault.exit_code())
        }
    }
}

fn dispatch(command: Option<Command>) -> Result<(), Fault> {
    match command {
        None => built_in(),
        Some(Command::Run { scene, out, set, quiet, strict, all, max_time }) => {
            let end = max_time.map(|seconds| (Instant::now(), seconds));
            let show = [Show::Chief, Show::All, Show::Nothing];
            let show = show[if quiet { 2 } else { usize::from(all) }];
            let budget = machine::budget(max_time.is_none());
            let read = predicting(quiet, || files::scene(&scene, &set, &budget))?;
            let warnings = run(&read, Request { out, show, end })
                .map_err(|fault| placed(fault, &read, &scene, &set))?;
            terminal::warn(&warnings, strict)
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
        Some(Command::Choose { rows, out, jobs }) => studies::choose(&rows, &out, jobs),
        Some(Command::Methods { rows, out, jobs }) => studies::methods(&rows, &out, jobs),
        Some(Command::Gamma { rows, out, jobs }) => studies::gamma(&rows, &out, jobs),
        Some(Command::Orders { rows, scene, out, jobs }) => {
            studies::orders(&rows, &scene, &out, jobs)
        }
        Some(Command::Stability { rows, scene, out, jobs }) => {
            studies::stability(&rows, scene.as_deref(), &out, jobs)
        }
    }
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
    let scene = predicting(false, || files::scene(scene, &[], &machine::budget(false)))?;
    let answer = points::exact_at(&scene, &points.display().to_string(), open(points)?)?;
    print_bytes(&answer)
}

/// Gives l of uGIMP and GIMP in spacings.
fn half_length(arguments: &ShapeArguments) -> Result<f64, Fault> {
    let half = arguments.half_length.map_or(0.5, |half| half / arguments.spacing);
    if half > 0.5 {
        return Err(Fault::Argument {
            argument: "--half-length",
            problem: format!("half a particle is {half} times as long as the spacing"),
            allowed: "at most half of the spacing",
        });
    }
    Ok(half)
}

fn shape(arguments: &ShapeArguments) -> Result<(), Fault> {
    let spacing = arguments.spacing;
    let is = |name: BasisName| arguments.basis == name;
    let (lme, gimp, bspline) = (is(BasisName::Lme), is(BasisName::Gimp), is(BasisName::Bspline));
    let sized = gimp || is(BasisName::Ugimp);
    for (argument, foreign, allowed) in [
        ("--gamma", arguments.gamma.is_some() && !lme, "with --basis lme only"),
        ("--cutoff", arguments.cutoff.is_some() && !lme, "with --basis lme only"),
        ("--support", arguments.support.is_some() && !lme, "with --basis lme only"),
        (
            "--half-length",
            arguments.half_length.is_some() && !sized,
            "with --basis ugimp and gimp only",
        ),
        ("--stretch", arguments.stretch.is_some() && !gimp, "with --basis gimp only"),
        ("--degree", arguments.degree.is_some() && !bspline, "with --basis bspline only"),
    ] {
        if foreign {
            let problem = "it means nothing to this basis".to_string();
            return Err(Fault::Argument { argument, problem, allowed });
        }
    }
    let half = half_length(arguments)?;
    let basis = match arguments.basis {
        BasisName::Linear => Basis::Linear,
        BasisName::Ugimp => Basis::Ugimp { half_length: [half; 3] },
        BasisName::Gimp => Basis::Gimp { half_length: [half; 3] },
        BasisName::Ddmp => Basis::Ddmp,
        BasisName::Bspline => Basis::BSpline(arguments.degree.unwrap_or(Degree::Quadratic)),
        BasisName::Lme => Basis::Lme {
            gamma: arguments.gamma.unwrap_or(1.0),
            cutoff: arguments.cutoff.unwrap_or(1e-6),
            support: arguments.support.unwrap_or(Support::Box),
        },
    };
    let read =
        |path: &Path| Points::read(&path.display().to_string(), open(path)?, &points::COORDINATES);
    let (nodes, points) = (read(&arguments.nodes)?, read(&arguments.points)?);
    let needs_grid = arguments.support == Some(Support::Box);
    let stretch = gimp.then(|| arguments.stretch.unwrap_or(1.0));
    let asked = points::ShapeQuery { basis, needs_grid, spacing, stretch };
    print_bytes(&points::shape_at(&asked, &nodes, &points)?)
}

fn trace(
    path: &Path,
    steps: usize,
    sets: &[String],
    hex: bool,
    out: Option<&Path>,
) -> Result<(), Fault> {
    let scene = predicting(false, || {
        let scene = files::scene(path, sets, &machine::budget(false))?;
        lme_mpm::port::trace::affordable(&scene, steps)?;
        stability::runnable(&scene).map_err(|fault| placed(fault, &scene, path, sets))?;
        Ok::<_, Fault>(scene)
    })?;
    let place = out.filter(|out| *out != Path::new("-"));
    if let Some(out) = place {
        writable(path, out)?;
        // If this trace fails, an earlier one must not pass for it.
        files::remove(out.to_path_buf())?;
    }
    let entries = lme_mpm::port::trace::trace(&scene, steps)
        .map_err(|broken| Fault::Run { broken, advice: "nothing was written".to_string() })?;
    let text = lme_mpm::port::trace::csv(&entries, hex)?;
    match place {
        None => print_bytes(&text),
        Some(out) => files::write(&[(out.to_path_buf(), &text)]),
    }
}

/// Refuses to write at `out` what is to be no directory and not the `input`, and makes its
/// folder if need be.
fn writable(input: &Path, out: &Path) -> Result<(), Fault> {
    let refuse = |problem: &str| Fault::Argument {
        argument: "--out",
        problem: format!("`{}` is {problem}", out.display()),
        allowed: "a file to write, or - for standard output",
    };
    if out.file_name().is_none() || out.is_dir() {
        return Err(refuse("a directory"));
    }
    if let (Ok(input), Ok(out)) = (input.canonicalize(), out.canonicalize())
        && input == out
    {
        return Err(refuse("the scene itself"));
    }
    files::is_file(out)?;
    files::prepare(out.parent().filter(|p| *p != Path::new("")).unwrap_or(Path::new(".")))
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
