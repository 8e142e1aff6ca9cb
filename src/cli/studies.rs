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
use lme_mpm::study::choice;
use lme_mpm::study::configuration::Template;
use lme_mpm::study::gamma::{self as gammas, AtGamma};
use lme_mpm::study::map;
use lme_mpm::study::methods;
use lme_mpm::study::orders::{self, Along, Ladder, Volumes};
use lme_mpm::study::rows::{self, Study};
use std::path::Path;

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

/// A study by rows is computed as a whole, or row by row; an item of it makes a row.
struct ByRows<'a, Item, Row> {
    /// What its command is called, and its table.
    study: &'static str,
    scene: Option<&'a Path>,
    items: &'a [Item],
    name: fn(&Item) -> String,
    columns: &'a [&'a str],
    digest: String,
    /// Computes the rows of some items by so many threads, and tells of each.
    compute: &'a Compute<'a, Item, Row>,
    table: fn(&[Row]) -> Result<Vec<u8>, Fault>,
    /// Reads a row and its name from the cells of a line.
    read: &'a Read<'a, Row>,
}

type Compute<'a, Item, Row> =
    dyn Fn(&[Item], usize, &mut dyn FnMut()) -> Result<Vec<Row>, Fault> + 'a;

type Read<'a, Row> = dyn Fn(&[&str]) -> Option<(String, Row)> + 'a;

impl<Item, Row: Clone> ByRows<'_, Item, Row> {
    /// Gives all rows, computed or merged; `None` where the list of rows or one of them was
    /// asked for, and is printed.
    fn rows(
        &self,
        arguments: &RowArguments,
        dir: &Path,
        jobs: u16,
    ) -> Result<Option<Vec<Row>>, Fault> {
        let names: Vec<String> = self.items.iter().map(self.name).collect();
        if arguments.list {
            return list_rows(self.study, self.scene, &names).map(|()| None);
        }
        if let Some(row) = &arguments.row {
            let one = std::slice::from_ref(&self.items[rows::find(&names, row)?]);
            let row = (self.table)(&(self.compute)(one, 1, &mut || {})?)?;
            return print_bytes(&rows::with_scene(&self.digest, &row)).map(|()| None);
        }
        if arguments.merge.is_empty() {
            prepare(dir)?;
            let bar = progress(self.items.len());
            let rows = (self.compute)(self.items, usize::from(jobs), &mut || bar.inc(1));
            bar.finish_and_clear();
            return rows.map(Some);
        }
        let own = format!("{}.csv", self.study);
        arguments.merge.iter().try_for_each(|path| files::spare(path, dir, |name| name == own))?;
        let study = Study { scene: self.digest.clone(), columns: self.columns, names: &names };
        let rows = study.merged(&arguments.merge, self.read)?;
        prepare(dir)?;
        Ok(Some(rows))
    }
}

/// Does `lme-mpm choose`.
pub fn choose(arguments: &RowArguments, dir: &Path, jobs: u16) -> Result<(), Fault> {
    let study = ByRows {
        study: "choose",
        scene: None,
        items: &choice::choices()?,
        name: choice::Choice::name,
        columns: &choice::columns(),
        digest: choice::digest()?,
        compute: &choice::study,
        table: choice::table,
        read: &choice::read,
    };
    let Some(rows) = study.rows(arguments, dir, jobs)? else { return Ok(()) };
    write_all(dir, &[("choose.csv".to_string(), choice::table(&rows)?)], &[])?;
    print_report("", "", dir)
}

/// Does `lme-mpm methods`.
pub fn methods(arguments: &RowArguments, dir: &Path, jobs: u16) -> Result<(), Fault> {
    let study = ByRows {
        study: "methods",
        scene: None,
        items: &methods::pairings()?,
        name: methods::Pairing::name,
        columns: &methods::columns(),
        digest: methods::digest()?,
        compute: &methods::study,
        table: methods::table,
        read: &methods::read,
    };
    let Some(rows) = study.rows(arguments, dir, jobs)? else { return Ok(()) };
    write_all(dir, &[("methods.csv".to_string(), methods::table(&rows)?)], &[])?;
    print_report("", "", dir)
}

/// Does `lme-mpm gamma`.
pub fn gamma(arguments: &RowArguments, dir: &Path, jobs: u16) -> Result<(), Fault> {
    let study = ByRows {
        study: "gamma",
        scene: None,
        items: &gammas::items(),
        name: |(way, gamma)| AtGamma::name(way.name, *gamma),
        columns: &gammas::columns(),
        digest: gammas::digest()?,
        compute: &gammas::study,
        table: gammas::table,
        read: &AtGamma::read,
    };
    let Some(rows) = study.rows(arguments, dir, jobs)? else { return Ok(()) };
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

/// Does `lme-mpm orders`.
pub fn orders(arguments: &RowArguments, scene: &Path, dir: &Path, jobs: u16) -> Result<(), Fault> {
    let template = template(Some(scene))?;
    comparable(&template)?;
    let study = ByRows {
        study: "orders",
        scene: Some(scene),
        items: &orders::ladders(),
        name: Ladder::name,
        columns: &orders::columns(),
        digest: template.digest()?,
        compute: &|ladders, jobs, tell| Ok(orders::study(&template, ladders, jobs, tell)),
        table: orders::table,
        read: &orders::read,
    };
    let Some(rows) = study.rows(arguments, dir, jobs)? else { return Ok(()) };
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
    let study = ByRows {
        study: "stability",
        scene,
        items: &combinations,
        name: map::Combination::name,
        columns: &map::columns(),
        digest: template.digest()?,
        compute: &|some, jobs, tell| Ok(map::map(&template, some, jobs, tell)),
        table: map::table,
        read: &|cells| map::Mapped::read(&combinations, cells),
    };
    let Some(rows) = study.rows(arguments, dir, jobs)? else { return Ok(()) };
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
                configuration.words(&["basis.kind", "basis.degree", "basis.gamma"]),
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
