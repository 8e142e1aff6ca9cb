//! These commands run studies.

use super::arguments::RowArguments;
use super::machine;
use super::terminal::{predicting, print_bytes, print_report, quoted, style};
use indicatif::ProgressBar;
use lme_mpm::output::figure;
use lme_mpm::output::files::{self, prepare, write_all};
use lme_mpm::scene::DYKA;
use lme_mpm::scene::fault::{Fault, unprintable};
use lme_mpm::setup;
use lme_mpm::study::configuration::Template;
use lme_mpm::study::gamma::{self as gammas, AtGamma};
use lme_mpm::study::map;
use lme_mpm::study::orders::{self, Along, Ladder, Volumes};
use lme_mpm::study::rows::{self, Study};
use std::path::{Path, PathBuf};

/// Shows a bar for `length` pieces of work, on stderr, and from the start for how long it has
/// been at it: the first piece may take a while.
pub fn progress(length: usize) -> ProgressBar {
    let bar = ProgressBar::new(length as u64);
    bar.set_style(style("{bar:40} {pos}/{len}, {elapsed} passed, {eta} left"));
    bar.enable_steady_tick(std::time::Duration::from_millis(250));
    bar
}

/// Reads the scene of a study, which is the built-in bar if none is named; its runs have what
/// this machine has.
pub fn template(scene: Option<&Path>) -> Result<Template, Fault> {
    let budget = &machine::budget(true);
    predicting(false, || match scene {
        Some(path) => Template::parse_within(budget, path, &files::scene_text(path)?),
        None => Template::parse(Path::new("dyka.toml (built in)"), DYKA),
    })
}

/// Refuses a scene without an exact solution: there is no error to measure.
pub fn comparable(template: &Template) -> Result<(), Fault> {
    setup::has_exact(&template.scene)
}

/// Prints the command of every row of a study, ready for a shell.
///
/// Errors: [`Fault::Argument`] for a scene whose name does not fit into a line of text.
pub fn list_rows(study: &str, scene: Option<&Path>, names: &[String]) -> Result<(), Fault> {
    let word = |path: &Path| match path.to_str().filter(|name| !name.contains(unprintable)) {
        Some(name) => Ok(format!(" --scene {}", quoted(name))),
        None => Err(Fault::Argument {
            argument: "--scene",
            problem: format!("`{}` cannot stand in a line of a shell", path.display()),
            allowed: "a file whose name is UTF-8 without control characters",
        }),
    };
    let scene = scene.map(word).transpose()?.unwrap_or_default();
    let line = |name: &String| format!("lme-mpm {study}{scene} --row {}\n", quoted(name));
    print_bytes(names.iter().map(line).collect::<String>().as_bytes())
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
    print_report("", "", dir)
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
    print_report("", &fitted(&rows), dir)
}

/// Tells the terminal the orders in h with two particles per cell over one span.
fn fitted(rows: &[orders::Ascent]) -> String {
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
    format!("{table}\nall {} rows are in the file\n", rows.len())
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
    print_report("", &limits(&rows), dir)
}

/// Tells the terminal the map with two particles per cell and no offset.
fn limits(rows: &[map::Mapped]) -> String {
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
         {} combinations, {} without a limit; measured and predicted differ by at most {:.1}%\n",
        rows.len(),
        rows.len() - known,
        100.0 * worst
    )
}
