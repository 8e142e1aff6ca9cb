//! These commands trade speed for accuracy, and tell the verdict.

use super::arguments::TradeArguments;
use super::studies::{comparable, list_rows, progress, template};
use super::terminal::{predicting, print_bytes, print_report, quoted};
use lme_mpm::output::figure;
use lme_mpm::output::files::{self, prepare, write_all};
use lme_mpm::run::table::shortest;
use lme_mpm::scene::fault::Fault;
use lme_mpm::study::configuration::{Configuration, Template};
use lme_mpm::study::log::{self, TimedRun};
use lme_mpm::study::measured::Criterion;
use lme_mpm::study::ranking::{self, Among, LEVELS, Price, Question, Tried, VERDICT, cheapest};
use lme_mpm::study::trade as trades;
use lme_mpm::study::verdict::{self, Candidate, Search};
use std::path::{Path, PathBuf};

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
            for path in &arguments.rows.merge {
                files::spare(path, dir, |name| ["trade.csv", "cheapest.csv"].contains(&name))?;
            }
            let runs = log::merged(&arguments.rows.merge, &scene)?;
            prepare(dir)?;
            ranking::summarise(&runs)
        }
    };
    write(dir, &rows)?;
    print_report("", &report(&rows), dir)
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
    let grid = predicting(false, || trades::grid(template, arguments.full))?;
    let names: Vec<String> = grid.iter().map(Configuration::to_string).collect();
    list_rows("trade", arguments.scene.as_deref(), &names)
}

/// Runs what the log in `dir` does not have yet; rows in the order of the grid.
fn tried(template: &Template, dir: &Path, full: bool, jobs: u16) -> Result<Vec<Tried>, Fault> {
    prepare(dir)?;
    let grid = predicting(false, || trades::grid(template, full))?;
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
                work: row.work().unwrap_or_default(),
                error: row.error(criterion),
                group: row.configuration.family(),
            })
            .filter(|effort| effort.error.is_some())
            .collect();
        let front = ranking::front(rows, criterion);
        let front = front.iter().filter_map(|(row, error)| Some((row.work()?, *error))).collect();
        let title = format!("Work and precision: {name}");
        let picture = figure::work_precision(
            &title,
            "counted work of a run [instructions]",
            &efforts,
            &front,
        );
        files.push((format!("{name}.svg"), picture.into_bytes()));
    }
    write_all(dir, &files, &[])
}

/// Heads the columns of [`line`].
const HEAD: &str = "                 error   work [M]      pairs  time [ms]  configuration\n";

/// Writes one line of a verdict: who, its error, what it costs, and how it is set.
fn line(who: &str, row: &Tried, error: f64) -> String {
    let pairs = row.pairs().map_or(String::new(), |pairs| pairs.to_string());
    let work = row.work().map_or(String::new(), |work| format!("{:.3}", work / 1e6));
    let (time, configuration) = (1e3 * row.wall_time.median, &row.configuration);
    format!("{who:>13} {error:>8.1e} {work:>10} {pairs:>10} {time:>10.2}  {configuration}\n")
}

/// Names a line of the verdict.
fn who((among, price): (Among, Price)) -> &'static str {
    match price {
        Price::Pairs => "fewest pairs",
        Price::Work => among.name(),
    }
}

/// Writes what stands in a verdict for one kind of method: its cheapest that reaches the error,
/// or the least error that it has.
fn standing(rows: &[Tried], (among, price): (Among, Price), question: Question) -> String {
    let who = who((among, price));
    match cheapest(rows, among, price, question) {
        Some((row, error)) => line(who, row, error),
        None => match ranking::best(rows, among, question.criterion) {
            Some((_, least)) => {
                format!("{who:>13}        – none reaches it, the least error is {least:.1e}\n")
            }
            None => format!("{who:>13}        – none that came to its end\n"),
        },
    }
}

/// Tells the terminal the verdicts of a trade by level, and what failed.
fn report(rows: &[Tried]) -> String {
    let mut text = format!("The cheapest of {} configurations by error:\n", rows.len());
    for criterion in Criterion::ALL {
        for error in LEVELS {
            let percent = shortest(error * 100.0);
            text += &format!("\n{} to at most {percent}%\n{HEAD}", criterion.name());
            for one in VERDICT {
                text += &standing(rows, one, Question { criterion, error });
            }
        }
    }
    text + &failed(rows) + "\n"
}

/// Names the configurations that failed, each with its reason.
fn failed(rows: &[Tried]) -> String {
    let failed: Vec<(&Configuration, &String)> = rows
        .iter()
        .filter_map(|row| Some((&row.configuration, row.measured.as_ref().err()?)))
        .collect();
    let mut text = String::new();
    if !failed.is_empty() {
        text += &format!("\n{} failed:\n", failed.len());
    }
    for (configuration, problem) in failed {
        text += &format!("  {configuration}: {}\n", problem.lines().next().unwrap_or(""));
    }
    text
}

/// What `recommend` writes besides tables: the cheapest, and one that is not fragile.
const FILES: [&str; 2] = ["recommended.toml", "robust.toml"];

/// Does `lme-mpm recommend`.
pub fn recommend(
    scene: &Path,
    question: Question,
    out: Option<PathBuf>,
    jobs: u16,
) -> Result<(), Fault> {
    let template = template(Some(scene))?;
    comparable(&template)?;
    let name = scene.file_stem().map_or("scene".into(), |name| name.to_string_lossy());
    let dir = out.unwrap_or_else(|| Path::new("out/recommend").join(name.as_ref()));
    files::spare(scene, &dir, |name| FILES.contains(&name) || name.ends_with(".csv"))?;
    prepare(&dir)?;
    let jobs = usize::from(jobs);
    let bar = progress(0);
    let log = dir.join("runs.csv");
    let search = verdict::search(&template, question, &log, jobs, &mut |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let Search { rows, dearer } = search?;
    write(&dir, &rows)?;
    let candidates = verdict::candidates(&template, &rows, question, jobs)?;
    let ready = write_chosen(&dir, &template, &candidates, question)?;
    let Question { criterion, error } = question;
    let quantity = criterion.name();
    if candidates.is_empty() {
        let best = ranking::best(&rows, Among::Particles, criterion);
        let best = best.map(|(_, error)| error);
        return Err(Fault::NothingReaches { quantity, error, best });
    }
    let text = told(&rows, &candidates, question);
    let (asked, left) = (shortest(error * 100.0), trades::left_out(&template.scene));
    let counted = format!("{} configurations measured, {dearer} dearer ones not", rows.len());
    let head = format!("For a {quantity} error of at most {asked}%:\n{HEAD}");
    print_report("", &format!("{head}{text}\n{counted}; {left}.\n{ready}"), &dir)
}

/// Writes the neighbours and the scenes that were chosen, removes those of an earlier question,
/// and says how to run them.
fn write_chosen(
    dir: &Path,
    template: &Template,
    candidates: &[Candidate],
    question: Question,
) -> Result<String, Fault> {
    let mut files = vec![("neighbours.csv".to_string(), verdict::table(candidates)?)];
    let mut ready = String::new();
    for (file, candidate) in chosen(candidates, question) {
        let text = scene_file(template, candidate, question)?;
        let path = quoted(&dir.join(file).display().to_string());
        ready += &format!("ready to run: lme-mpm run {path}\n");
        files.push((file.to_string(), text.into_bytes()));
    }
    write_all(dir, &files, &FILES.map(String::from))?;
    Ok(ready)
}

/// Chooses what is written: the cheapest, and where it is fragile the first that is not.
fn chosen(
    candidates: &[Candidate],
    question: Question,
) -> impl Iterator<Item = (&'static str, &Candidate)> {
    let first = candidates.first().map(|one| ("recommended.toml", one));
    let robust = candidates.iter().skip(1).find(move |one| !one.is_fragile(question));
    first.into_iter().chain(robust.map(|one| ("robust.toml", one)))
}

/// Writes a candidate as a scene file that says what was measured.
fn scene_file(
    template: &Template,
    candidate: &Candidate,
    question: Question,
) -> Result<String, Fault> {
    let Question { criterion, error } = question;
    let configuration = &candidate.tried.configuration;
    Ok(format!(
        "# For a {} error of at most {error}:\n# {configuration}\n\
         # Measured error {:.3e}; {}.\n\n{}",
        criterion.name(),
        candidate.error,
        trust(candidate, question),
        template.file(configuration)?
    ))
}

/// Says what the neighbours of a candidate are worth.
fn trust(candidate: &Candidate, question: Question) -> String {
    let count = candidate.neighbours.len();
    let fragile = if candidate.is_fragile(question) { ": FRAGILE" } else { "" };
    match candidate.worst() {
        None => "it has no neighbours".to_string(),
        Some((change, worst)) if worst.is_finite() => {
            format!("the worst of {count} neighbours has {worst:.1e} ({change}){fragile}")
        }
        Some((change, _)) => format!("one of {count} neighbours fails ({change}){fragile}"),
    }
}

/// Tells the candidates with their neighbours, what stands beside them, and the front.
fn told(rows: &[Tried], candidates: &[Candidate], question: Question) -> String {
    let mut text = String::new();
    for (n, one) in candidates.iter().enumerate() {
        let who = if n == 0 { "> cheapest" } else { "next" };
        text += &line(who, &one.tried, one.error);
        text += &format!("{:14}{}\n", "", trust(one, question));
    }
    text += "\nbeside it, the cheapest of each kind:\n";
    for one in VERDICT.into_iter().skip(1) {
        text += &standing(rows, one, question);
    }
    text += "\non the front of work and error:\n";
    for (row, error) in ranking::front(rows, question.criterion) {
        text += &line("", row, error);
    }
    text
}
