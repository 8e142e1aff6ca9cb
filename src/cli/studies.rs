//! These commands run studies.

use super::arguments::{RowArguments, TradeArguments};
use super::terminal::print_bytes;
use indicatif::{ProgressBar, ProgressStyle};
use lme_mpm::output::figure;
use lme_mpm::output::files::{self, prepare, write_all};
use lme_mpm::run::table::shortest;
use lme_mpm::scene::DYKA;
use lme_mpm::scene::fault::Fault;
use lme_mpm::setup;
use lme_mpm::study::configuration::{Configuration, Template};
use lme_mpm::study::gamma::{self as gammas, AtGamma};
use lme_mpm::study::log::{self, TimedRun};
use lme_mpm::study::map;
use lme_mpm::study::measured::Criterion;
use lme_mpm::study::orders::{self, Along, Ladder, Volumes};
use lme_mpm::study::ranking::{self, LEVELS, Tried};
use lme_mpm::study::rows::{self, Study};
use lme_mpm::study::trade as trades;
use std::path::{Path, PathBuf};

/// Shows a bar for `length` pieces of work, on stderr.
fn progress(length: usize) -> ProgressBar {
    let bar = ProgressBar::new(length as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len}, {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// Reads the scene of a study, which is the built-in bar if none is named.
fn template(scene: Option<&Path>) -> Result<Template, Fault> {
    match scene {
        Some(path) => Template::parse(path, &files::scene_text(path)?),
        None => Template::parse(Path::new("dyka.toml (built in)"), DYKA),
    }
}

/// Refuses a scene without an exact solution: there is no error to measure.
fn comparable(template: &Template) -> Result<(), Fault> {
    setup::has_exact(&template.scene)
}

/// Does `lme-mpm trade`.
pub fn trade(arguments: &TradeArguments) -> Result<(), Fault> {
    let template = template(arguments.scene.as_deref())?;
    comparable(&template)?;
    if let Some(line) = &arguments.rows.row {
        return row(&template, line);
    }
    if arguments.rows.list {
        return list(&template, arguments);
    }
    let dir = &arguments.out;
    let rows = match arguments.rows.merge.is_empty() {
        true => tried(&template, dir, arguments.full, arguments.jobs)?,
        false => {
            let scene = template.digest()?;
            let mut runs = Vec::new();
            for path in &arguments.rows.merge {
                files::spare(path, dir, |name| ["trade.csv", "cheapest.csv"].contains(&name))?;
                runs.extend(log::read_whole(path, &scene)?);
            }
            prepare(dir)?;
            ranking::summarise(&runs)
        }
    };
    write(dir, &rows)?;
    print_bytes(report(dir, &rows).as_bytes())
}

/// Runs one configuration and prints its part of the log.
fn row(template: &Template, line: &str) -> Result<(), Fault> {
    let configuration: Configuration = line.parse()?;
    template.scene(&configuration)?;
    let passes = 1..=log::PASSES;
    let runs: Vec<TimedRun> =
        passes.map(|pass| TimedRun::of(template, &configuration, pass)).collect();
    print_bytes(&log::csv_of(&template.digest()?, &runs)?)
}

/// Prints the command of every configuration, ready for a shell.
fn list(template: &Template, arguments: &TradeArguments) -> Result<(), Fault> {
    let grid = trades::grid(template, arguments.full)?;
    let names: Vec<String> = grid.iter().map(Configuration::to_string).collect();
    list_rows("trade", arguments.scene.as_deref(), &names)
}

/// Prints the command of every row of a study, ready for a shell.
fn list_rows(study: &str, scene: Option<&Path>, names: &[String]) -> Result<(), Fault> {
    let quoted = |text: String| format!("'{}'", text.replace('\'', r"'\''"));
    let scene = scene
        .map_or(String::new(), |path| format!(" --scene {}", quoted(path.display().to_string())));
    let line = |name: &String| format!("lme-mpm {study}{scene} --row {}\n", quoted(name.clone()));
    print_bytes(names.iter().map(line).collect::<String>().as_bytes())
}

/// Runs what the log in `dir` does not have yet; rows in the order of the grid.
fn tried(template: &Template, dir: &Path, full: bool, jobs: u16) -> Result<Vec<Tried>, Fault> {
    prepare(dir)?;
    let grid = trades::grid(template, full)?;
    let bar = progress(grid.len() * log::PASSES);
    let path = dir.join("runs.csv");
    let runs = log::complete(template, &grid, &path, usize::from(jobs), &mut |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let mut own = runs?;
    own.retain(|run| grid.contains(&run.configuration));
    own.sort_by_cached_key(|run| grid.iter().position(|one| *one == run.configuration));
    Ok(ranking::summarise(&own))
}

/// Writes tables and diagrams.
fn write(dir: &Path, rows: &[Tried]) -> Result<(), Fault> {
    let mut files = vec![
        ("trade.csv".to_string(), ranking::table(rows)?),
        ("cheapest.csv".to_string(), ranking::cheapest_table(rows)?),
    ];
    for criterion in Criterion::ALL {
        let name = criterion.name();
        let efforts: Vec<figure::Effort> = rows
            .iter()
            .map(|row| figure::Effort {
                work: row.wall_time.median,
                error: row.error(criterion),
                group: row.configuration.family(),
            })
            .collect();
        let front = ranking::front(rows, criterion);
        let front = front.iter().map(|(row, error)| (row.wall_time.median, *error)).collect();
        let title = format!("Work and precision: {name}");
        let picture = figure::work_precision(&title, "time of a run [s]", &efforts, &front);
        files.push((format!("{name}.svg"), picture.into_bytes()));
    }
    write_all(dir, &files, &[])
}

/// Tells the terminal the cheapest by level, the baseline and what failed.
fn report(dir: &Path, rows: &[Tried]) -> String {
    let mut text = format!("The cheapest of {} configurations by error:\n", rows.len());
    for criterion in Criterion::ALL {
        text += &format!("\n{}\n   at most  time [ms]\n", criterion.name());
        for level in LEVELS {
            let level_text = format!("{}%", shortest(level * 100.0));
            text += &match ranking::cheapest(rows, criterion, level) {
                None => format!("{level_text:>10}          –\n"),
                Some((Tried { configuration, wall_time, .. }, _)) => {
                    format!("{level_text:>10} {:>10.2}  {configuration}\n", 1e3 * wall_time.median)
                }
            };
        }
    }
    let baseline = |row: &&Tried| row.configuration.is_finite_elements();
    text += "\nTo compare, linear finite elements (the three errors, time [ms]):\n";
    for Tried { configuration, measured, wall_time, .. } in rows.iter().filter(baseline) {
        if let Ok(found) = measured {
            let time = 1e3 * wall_time.median;
            let errors = Criterion::ALL.map(|criterion| format!("{:.1e}", found.error(criterion)));
            text += &format!("  {} {time:>10.2}  {configuration}\n", errors.join(" "));
        }
    }
    let failed: Vec<(&Configuration, &String)> = rows
        .iter()
        .filter_map(|row| Some((&row.configuration, row.measured.as_ref().err()?)))
        .collect();
    if !failed.is_empty() {
        text += &format!("\n{} failed:\n", failed.len());
    }
    for (configuration, problem) in failed {
        text += &format!("  {configuration}: {}\n", problem.lines().next().unwrap_or(""));
    }
    text + &format!("\nwritten to {}\n", dir.display())
}

/// Does `lme-mpm recommend`.
pub fn recommend(
    scene: &Path,
    error: f64,
    criterion: Criterion,
    out: Option<PathBuf>,
    jobs: u16,
) -> Result<(), Fault> {
    const FILE: &str = "recommended.toml";
    let template = template(Some(scene))?;
    comparable(&template)?;
    let name = scene.file_stem().map_or("scene".into(), |name| name.to_string_lossy());
    let dir = out.unwrap_or_else(|| Path::new("out/recommend").join(name.as_ref()));
    files::spare(scene, &dir, |name| name == FILE || name.ends_with(".csv"))?;
    let rows = tried(&template, &dir, false, jobs)?;
    write(&dir, &rows)?;
    let quantity = criterion.name();
    let Some((best, found)) = ranking::cheapest(&rows, criterion, error) else {
        write_all(&dir, &[], &[FILE.to_string()])?; // that of an earlier question
        let best = ranking::least_error(&rows, criterion);
        return Err(Fault::NothingReaches { quantity, error, best });
    };
    let text = format!(
        "# The cheapest of {} configurations with a {quantity} error of at most {error}:\n\
         # {}\n# Measured error {found:.3e}.\n\n{}",
        rows.len(),
        best.configuration,
        template.file(&best.configuration)?
    );
    write_all(&dir, &[(FILE.to_string(), text.into_bytes())], &[])?;
    let asked = format!("For a {quantity} error of at most {}%", shortest(error * 100.0));
    let evidence = evidence(&ranking::front(&rows, criterion), best);
    let file = dir.join(FILE);
    let ready = format!("ready to run: lme-mpm run {}", file.display());
    print_bytes(format!("{asked}:\n{}\n\n{evidence}\n{ready}\n", best.configuration).as_bytes())
}

/// Tells the front, with a mark at the `best`.
fn evidence(front: &[(&Tried, f64)], best: &Tried) -> String {
    let mut text =
        "  time [ms]     error configuration (on the front of time and error)\n".to_string();
    for (row, error) in front {
        let mark = if *row == best { ">" } else { " " };
        let time = 1e3 * row.wall_time.median;
        text += &format!("{mark} {time:>9.2} {error:>9.2e} {}\n", row.configuration);
    }
    text
}

/// Does `lme-mpm gamma`.
pub fn gamma(arguments: &RowArguments, dir: &Path, jobs: u16) -> Result<(), Fault> {
    let items = gammas::items();
    let name = |(way, gamma): &gammas::Item| AtGamma::name(way.name, *gamma);
    let names: Vec<String> = items.iter().map(name).collect();
    if arguments.list {
        return list_rows("gamma", None, &names);
    }
    if let Some(row) = &arguments.row {
        let row = gammas::study(&[items[rows::find(&names, row)?]], 1, &mut || {})?;
        return print_bytes(&rows::with_scene(&gammas::digest()?, &gammas::table(&row)?));
    }
    let rows = if arguments.merge.is_empty() {
        prepare(dir)?;
        let bar = progress(items.len());
        let rows = gammas::study(&items, usize::from(jobs), &mut || bar.inc(1));
        bar.finish_and_clear();
        rows?
    } else {
        spare_all(&arguments.merge, dir, "gamma.csv")?;
        let study = Study { scene: gammas::digest()?, columns: &gammas::columns(), names: &names };
        let rows = study.merged(&arguments.merge, AtGamma::read)?;
        prepare(dir)?;
        rows
    };
    let mut files = vec![("gamma.csv".to_string(), gammas::table(&rows)?)];
    for name in gammas::Effect::default().named().map(|(name, _)| name) {
        let words = name.replace('_', " ");
        let title = format!("{words} against γ");
        let axes = figure::Axes::new(&title, "γ [–]", &words, true);
        let picture = figure::curves(&gammas::curves(&rows, name), &axes);
        files.push((format!("{name}.svg"), picture.into_bytes()));
    }
    write_all(dir, &files, &[])?;
    print_bytes(format!("written to {}\n", dir.display()).as_bytes())
}

/// Refuses to write over what is merged: the study's own table in `dir`.
fn spare_all(merge: &[PathBuf], dir: &Path, own: &str) -> Result<(), Fault> {
    merge.iter().try_for_each(|path| files::spare(path, dir, |name| name == own))
}

/// Does `lme-mpm orders`.
pub fn orders(arguments: &RowArguments, scene: &Path, dir: &Path, jobs: u16) -> Result<(), Fault> {
    let template = template(Some(scene))?;
    comparable(&template)?;
    let ladders = orders::ladders();
    let names: Vec<String> = ladders.iter().map(Ladder::name).collect();
    if arguments.list {
        return list_rows("orders", Some(scene), &names);
    }
    if let Some(row) = &arguments.row {
        let one = &ladders[rows::find(&names, row)?];
        let row = orders::study(&template, std::slice::from_ref(one), 1, &mut || {});
        return print_bytes(&rows::with_scene(&template.digest()?, &orders::table(&row)?));
    }
    let rows = if arguments.merge.is_empty() {
        prepare(dir)?;
        let bar = progress(ladders.len());
        let rows = orders::study(&template, &ladders, usize::from(jobs), &mut || bar.inc(1));
        bar.finish_and_clear();
        rows
    } else {
        spare_all(&arguments.merge, dir, "orders.csv")?;
        let study = Study { scene: template.digest()?, columns: &orders::columns(), names: &names };
        let rows = study.merged(&arguments.merge, orders::read)?;
        prepare(dir)?;
        rows
    };
    write_all(dir, &[("orders.csv".to_string(), orders::table(&rows)?)], &[])?;
    print_bytes(fitted(dir, &rows).as_bytes())
}

/// Tells the terminal the orders in h with two particles per cell over one span.
fn fitted(dir: &Path, rows: &[orders::Ascent]) -> String {
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["velocity error at the finest", "its order in h", "way"]);
    for orders::Ascent { ladder, climbed } in rows {
        let shown = ladder.particles_per_cell == 2 && ladder.spans == 1;
        if !shown || ladder.along == Along::TimeStep || ladder.volumes == Volumes::Exact {
            continue;
        }
        let cells = match climbed {
            Ok(found) => {
                let error = found.errors.last().map_or(f64::NAN, |error| error[0]);
                [format!("{error:.1e}"), found.orders()[0].to_string(), ladder.name()]
            }
            Err(problem) => ["–".to_string(), problem.clone(), ladder.name()],
        };
        table.add_row(cells);
    }
    format!("{table}\nall {} rows are written to {}\n", rows.len(), dir.display())
}

/// Does `lme-mpm stability`.
pub fn stability(
    arguments: &RowArguments,
    scene: Option<&Path>,
    dir: &Path,
    jobs: u16,
) -> Result<(), Fault> {
    let template = match scene {
        Some(path) => template(Some(path))?,
        None => {
            let small = DYKA.replace("cells = 40", "cells = 10");
            Template::parse(Path::new("dyka.toml (built in)"), &small)?
        }
    };
    let combinations = map::combinations(&template)?;
    let names: Vec<String> = combinations.iter().map(map::Combination::name).collect();
    if arguments.list {
        return list_rows("stability", scene, &names);
    }
    if let Some(row) = &arguments.row {
        let one = &combinations[rows::find(&names, row)?];
        let row = map::map(&template, std::slice::from_ref(one), 1, &mut || {});
        return print_bytes(&rows::with_scene(&template.digest()?, &map::table(&row)?));
    }
    let rows = if arguments.merge.is_empty() {
        prepare(dir)?;
        let bar = progress(combinations.len());
        let rows = map::map(&template, &combinations, usize::from(jobs), &mut || bar.inc(1));
        bar.finish_and_clear();
        rows
    } else {
        spare_all(&arguments.merge, dir, "stability.csv")?;
        let study = Study { scene: template.digest()?, columns: &map::columns(), names: &names };
        let rows =
            study.merged(&arguments.merge, |cells| map::Mapped::read(&combinations, cells))?;
        prepare(dir)?;
        rows
    };
    write_all(dir, &[("stability.csv".to_string(), map::table(&rows)?)], &[])?;
    print_bytes(limits(dir, &rows).as_bytes())
}

/// Tells the terminal the map with two particles per cell and no offset.
fn limits(dir: &Path, rows: &[map::Mapped]) -> String {
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["method", "mass", "basis", "integrator", "predicted", "measured"]);
    let (mut known, mut worst) = (0, 0.0);
    for map::Mapped { combination, limit } in rows {
        let Ok(map::Limit { predicted, measured }) = limit else {
            continue;
        };
        known += 1;
        worst = f64::max(worst, (measured / predicted - 1.0).abs());
        let configuration = &combination.configuration;
        if combination.offset == 0.0 && combination.particles_per_cell == 2 {
            table.add_row([
                configuration.value("method").to_string(),
                configuration.value("mass").to_string(),
                configuration.words(&["basis.kind", "basis.gamma"]),
                configuration.words(&["time.integrator", "time.stress_update", "time.rho_b"]),
                format!("{predicted:.4}"),
                format!("{measured:.4}"),
            ]);
        }
    }
    format!(
        "Largest stable c Δt / h (two particles per cell, no offset; all in the file):\n{table}\n\
         {} combinations, {} without a limit; measured and predicted differ by at most {:.1}%\n\
         written to {}\n",
        rows.len(),
        rows.len() - known,
        100.0 * worst,
        dir.display()
    )
}
