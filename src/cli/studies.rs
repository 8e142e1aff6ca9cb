//! The commands that run studies.

use super::arguments::{QuantityName, TradeArguments};
use super::terminal::print_bytes;
use indicatif::{ProgressBar, ProgressStyle};
use lme_mpm::output::figure;
use lme_mpm::output::files::{self, prepare, write_all};
use lme_mpm::run::table::{csv, shortest};
use lme_mpm::scene::DYKA;
use lme_mpm::scene::fault::Fault;
use lme_mpm::study::configuration::{Configuration, Template};
use lme_mpm::study::gamma as gammas;
use lme_mpm::study::map;
use lme_mpm::study::trade::{self, LEVELS, QUANTITIES, Summary};
use std::path::{Path, PathBuf};

/// A bar for `length` pieces of work, on stderr.
fn progress(length: usize) -> ProgressBar {
    let bar = ProgressBar::new(length as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len}, {eta} left") {
        bar.set_style(style);
    }
    bar
}

fn open(path: &Path) -> Result<Template, Fault> {
    Template::parse(path, &files::scene_text(path)?)
}

fn template(scene: Option<&Path>) -> Result<Template, Fault> {
    match scene {
        Some(path) => open(path),
        None => Template::parse(Path::new("dyka.toml (built in)"), DYKA),
    }
}

/// Without an exact solution there is no error to measure.
fn comparable(template: &Template) -> Result<(), Fault> {
    lme_mpm::setup::exact(&template.scene_as_it_is()?).map(|_| ())
}

/// `lme-mpm trade`.
pub fn trade(arguments: &TradeArguments) -> Result<(), Fault> {
    let template = template(arguments.scene.as_deref())?;
    if let Some(row) = &arguments.row {
        let configuration: Configuration = row.parse()?;
        template.scene(&configuration)?;
        let scene = trade::scene_digest(&template);
        let passes = 1..=trade::PASSES;
        let runs = passes.map(|pass| trade::time(&template, &configuration, pass).cells(&scene));
        return print_bytes(&csv(&trade::log_columns(), runs)?);
    }
    if arguments.list {
        let scene = arguments
            .scene
            .as_ref()
            .map_or(String::new(), |path| format!(" --scene '{}'", path.display()));
        let lines: String = trade::grid(&template, arguments.full)?
            .iter()
            .map(|configuration| format!("lme-mpm trade{scene} --row {configuration}\n"))
            .collect();
        return print_bytes(lines.as_bytes());
    }
    comparable(&template)?;
    let dir = &arguments.out;
    let rows = match arguments.merge.is_empty() {
        true => measured(&template, dir, arguments.full, arguments.jobs)?,
        false => {
            prepare(dir)?;
            let scene = trade::scene_digest(&template);
            let mut runs = Vec::new();
            for path in &arguments.merge {
                runs.extend(trade::read_log(path, &scene)?);
            }
            trade::summarise(&runs)
        }
    };
    write(dir, &rows)?;
    print_bytes(report(dir, &rows).as_bytes())
}

/// Runs what the log in `dir` does not have yet.
fn measured(template: &Template, dir: &Path, full: bool, jobs: u16) -> Result<Vec<Summary>, Fault> {
    prepare(dir)?;
    let grid = trade::grid(template, full)?;
    let bar = progress(grid.len() * trade::PASSES);
    let log = dir.join("runs.csv");
    let runs = trade::runs(template, &grid, &log, usize::from(jobs), &mut |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let names: Vec<String> = grid.iter().map(Configuration::to_string).collect();
    let runs = runs?;
    let own: Vec<trade::Run> =
        runs.into_iter().filter(|run| names.contains(&run.configuration)).collect();
    Ok(trade::summarise(&own))
}

/// Tables and diagrams.
fn write(dir: &Path, rows: &[Summary]) -> Result<(), Fault> {
    let mut files = vec![
        ("trade.csv".to_string(), trade::table(rows)?),
        ("cheapest.csv".to_string(), trade::cheapest_table(rows)?),
    ];
    for (n, quantity) in QUANTITIES.iter().enumerate() {
        let works: Vec<figure::Work> = rows
            .iter()
            .map(|row| {
                let group = trade::family(&row.configuration);
                figure::Work { work: row.wall_time[0], error: row.error(n), group }
            })
            .collect();
        let front = trade::front(rows, n);
        let front = front.iter().filter_map(|row| Some((row.wall_time[0], row.error(n)?)));
        let title = format!("Work and precision: {quantity}");
        let picture = figure::work_precision(&title, "time of a run [s]", &works, &front.collect());
        files.push((format!("{quantity}.svg"), picture.into_bytes()));
    }
    write_all(dir, &files, &[])
}

/// The cheapest by level, and what failed, for the terminal.
fn report(dir: &Path, rows: &[Summary]) -> String {
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["error at most", "velocity", "stress", "displacement"]);
    for level in LEVELS {
        let mut cells = vec![format!("{}%", shortest(level * 100.0))];
        for quantity in 0..QUANTITIES.len() {
            let found = trade::cheapest(rows, quantity, level);
            cells.push(found.map_or("–".into(), |row| {
                format!("{} ({:.1} ms)", row.configuration, 1e3 * row.wall_time[0])
            }));
        }
        table.add_row(cells);
    }
    let failed: Vec<String> = rows
        .iter()
        .filter_map(|row| {
            let problem = row.result.as_ref().err()?;
            let short = problem.lines().next().unwrap_or("");
            Some(format!("  {}: {short}\n", row.configuration))
        })
        .collect();
    let failed = match failed.len() {
        0 => String::new(),
        n => format!("{n} failed:\n{}", failed.concat()),
    };
    let baseline: String = rows
        .iter()
        .filter(|row| trade::is_baseline(&row.configuration))
        .filter_map(|row| {
            let [v, stress, u] = [0, 1, 2].map(|quantity| row.error(quantity));
            let time = 1e3 * row.wall_time[0];
            Some(format!(
                "  {}: {:.1e}, {:.1e}, {:.1e} ({time:.1} ms)\n",
                row.configuration, v?, stress?, u?
            ))
        })
        .collect();
    format!(
        "The cheapest of {} configurations by error:\n{table}\n\n\
         To compare, linear finite elements (errors of velocity, stress, displacement):\n\
         {baseline}{failed}written to {}\n",
        rows.len(),
        dir.display()
    )
}

/// `lme-mpm recommend`.
pub fn recommend(
    scene: &Path,
    error: f64,
    quantity: QuantityName,
    out: Option<PathBuf>,
    jobs: u16,
) -> Result<(), Fault> {
    let template = open(scene)?;
    comparable(&template)?;
    let name = scene.file_stem().map_or("scene".into(), |name| name.to_string_lossy());
    let dir = out.unwrap_or_else(|| Path::new("out/recommend").join(name.as_ref()));
    let rows = measured(&template, &dir, false, jobs)?;
    write(&dir, &rows)?;
    let (number, name) = match quantity {
        QuantityName::Velocity => (0, QUANTITIES[0]),
        QuantityName::Stress => (1, QUANTITIES[1]),
        QuantityName::Displacement => (2, QUANTITIES[2]),
    };
    let Some(best) = trade::cheapest(&rows, number, error) else {
        let own = rows.iter().filter(|row| !trade::is_baseline(&row.configuration));
        let errors = own.filter_map(|row| row.error(number));
        write_all(&dir, &[], &["recommended.toml".to_string()])?; // that of an earlier question
        return Err(Fault::NothingReaches {
            quantity: name,
            error,
            best: errors.fold(f64::INFINITY, f64::min),
        });
    };
    let configuration: Configuration = best.configuration.parse()?;
    let found = best.error(number).unwrap_or(f64::NAN);
    let text = format!(
        "# The cheapest of {} configurations with a {name} error of at most {error}:\n\
         # {}, measured error {found:.3e}.\n\n{}",
        rows.len(),
        best.configuration,
        template.text(&configuration)
    );
    write_all(&dir, &[("recommended.toml".to_string(), text.into_bytes())], &[])?;
    let mut evidence = format!(
        "For a {name} error of at most {}%: {}\n\n",
        shortest(error * 100.0),
        best.configuration
    );
    evidence += "  time [ms]   error   configuration (on the front of time and error)\n";
    for row in trade::front(&rows, number) {
        let mark = if row.configuration == best.configuration { ">" } else { " " };
        let error = row.error(number).unwrap_or(f64::NAN);
        let time = 1e3 * row.wall_time[0];
        evidence += &format!("{mark} {time:>9.2} {error:>9.2e} {}\n", row.configuration);
    }
    let file = dir.join("recommended.toml");
    evidence += &format!("\nready to run: lme-mpm run {}\n", file.display());
    print_bytes(evidence.as_bytes())
}

/// `lme-mpm gamma`.
pub fn gamma(dir: &Path, jobs: u16) -> Result<(), Fault> {
    prepare(dir)?;
    let bar = progress(gammas::WAYS.len() * gammas::GAMMAS.len());
    let rows = gammas::rows(usize::from(jobs), &mut || bar.inc(1));
    bar.finish_and_clear();
    let rows = rows?;
    let mut files = vec![("gamma.csv".to_string(), gammas::table(&rows)?)];
    for (n, name) in gammas::COLUMNS.iter().enumerate() {
        let lists = curves(&rows, n);
        let title = format!("{} against γ", name.replace('_', " "));
        let picture = figure::log_curves(&title, "γ [–]", &name.replace('_', " "), &lists);
        files.push((format!("{name}.svg"), picture.into_bytes()));
    }
    write_all(dir, &files, &[])?;
    print_bytes(format!("written to {}\n", dir.display()).as_bytes())
}

/// The curves of one column, by way; what has no logarithm by its size.
fn curves(rows: &[gammas::Row], column: usize) -> Vec<(String, figure::Points)> {
    let of = |way: &str| {
        let own = rows.iter().filter(|row| row.way == way);
        let value = |row: &gammas::Row| row.values.as_ref().ok().map(|list| list[column].abs());
        own.filter_map(|row| Some((row.gamma, value(row).filter(|x| *x > 0.0)?))).collect()
    };
    gammas::WAYS.iter().map(|way| (way.0.to_string(), of(way.0))).collect()
}

/// `lme-mpm stability`.
pub fn stability(scene: Option<PathBuf>, dir: &Path, jobs: u16) -> Result<(), Fault> {
    let template = match &scene {
        Some(path) => open(path)?,
        None => {
            let small = DYKA.replace("cells = 40", "cells = 10");
            Template::parse(Path::new("dyka.toml (built in)"), &small)?
        }
    };
    prepare(dir)?;
    let dimension = template.dimension();
    let bar = progress(map::combinations(dimension).len());
    let rows = map::map(&template, dimension, usize::from(jobs), &mut || bar.inc(1));
    bar.finish_and_clear();
    write_all(dir, &[("stability.csv".to_string(), map::table(&rows)?)], &[])?;
    let known: Vec<(&map::Row, f64, f64)> =
        rows.iter().filter_map(|row| row.limit.as_ref().ok().map(|(a, b)| (row, *a, *b))).collect();
    let worst = known.iter().map(|(_, a, b)| (b / a - 1.0).abs()).fold(0.0, f64::max);
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["mass", "basis", "integrator", "per cell", "predicted", "measured"]);
    for (row, predicted, measured) in &known {
        let c = &row.configuration;
        if row.offset == 0.0 && c.particles_per_cell == 2 {
            let method = if c.method == "otm" { "otm" } else { &c.integrator };
            table.add_row([
                c.mass.clone(),
                c.basis.clone(),
                method.to_string(),
                c.particles_per_cell.to_string(),
                format!("{predicted:.4}"),
                format!("{measured:.4}"),
            ]);
        }
    }
    let text = format!(
        "Largest stable c Δt / h (two particles per cell, no offset; all in the file):\n{table}\n\
         {} combinations, {} without a limit; measured and predicted differ by at most {:.1}%\n\
         written to {}\n",
        rows.len(),
        rows.len() - known.len(),
        100.0 * worst,
        dir.display()
    );
    print_bytes(text.as_bytes())
}
