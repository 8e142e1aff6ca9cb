//! How many instructions a time step takes: counted by callgrind, so the same on a busy machine.
//!
//! `cargo bench --bench instructions` prints the counts of this build;
//! `cargo bench --bench instructions -- --write` writes them to `data/instructions/`, from where the
//! book takes them, and `-- --work` counts the runs of `data/instructions/work.csv` again, to which the weights
//! of the work are fitted. Needs valgrind.

mod cases;
mod counted;
mod rows;

use cases::{CASES, Case, advance, one_step, scene, warm};
use rows::{HEADER, row};
use std::path::Path;
use std::process::{Command, ExitCode};

/// What is counted: a whole time step, or one of the nine.
const WHOLE: usize = 0;

/// The counts of so many repetitions and of three times as many are subtracted, and what is
/// done once is gone.
const FEW: usize = 2;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["--do", dimension, case, what, times] => {
            let number = |text: &str| text.parse::<usize>().unwrap();
            let (case, what, times) = (CASES[number(case)], number(what), number(times));
            match dimension {
                "1" => repeat::<1>(case, what, times),
                "2" => repeat::<2>(case, what, times),
                _ => repeat::<3>(case, what, times),
            }
            ExitCode::SUCCESS
        }
        ["--run", body, configuration, count] => {
            let cost = counted::steps(body, configuration, count.parse().unwrap());
            cost.named().into_iter().for_each(|(name, count)| println!("{name},{count}"));
            ExitCode::SUCCESS
        }
        ["--work"] => written(&[("work.csv", work())]),
        ["--write"] | [] => report(arguments.len() == 1),
        _ => {
            eprintln!("error: unknown argument; allowed: --write, --work");
            ExitCode::FAILURE
        }
    }
}

/// Does the work that is counted, `times` times.
fn repeat<const D: usize>(case: Case, what: usize, times: usize) {
    let (model, mut state) = warm::<D>(&scene::<D>(case));
    for time in 1..=times {
        match what {
            WHOLE => advance(&model, &mut state, 10 + time),
            n => one_step(n, &model, &mut state),
        }
    }
}

/// Counts the instructions of one repetition for each particle.
fn count(dimension: usize, case: usize, what: usize) -> std::io::Result<f64> {
    let particles = [800, 1600, 4096][dimension - 1] as f64;
    let total = |times: usize| -> std::io::Result<f64> {
        let numbers = [dimension, case, what, times].map(|number| number.to_string());
        let numbers: Vec<&str> = numbers.iter().map(String::as_str).collect();
        Ok(callgrind(&[&["--do"], &numbers[..]].concat())?.0)
    };
    Ok((total(3 * FEW)? - total(FEW)?) / (2 * FEW) as f64 / particles)
}

/// Runs this program under callgrind: the instructions that it took, and what it printed.
fn callgrind(arguments: &[&str]) -> std::io::Result<(f64, String)> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe()?)
        .args(arguments)
        .output()?;
    // The total stands at the end: "==1== Collected : 123".
    let text = String::from_utf8_lossy(&output.stderr);
    let found = text.lines().rev().find_map(|line| line.split_once("Collected : "));
    let total = found.and_then(|(_, count)| count.trim().parse().ok());
    let nothing = || std::io::Error::other(format!("callgrind counted nothing:\n{text}"));
    Ok((total.ok_or_else(nothing)?, String::from_utf8_lossy(&output.stdout).into_owned()))
}

fn report(write: bool) -> ExitCode {
    let (whole, steps) = (whole(), steps());
    if write {
        return written(&[("time-step.csv", whole), ("nine-steps.csv", steps)]);
    }
    match (whole, steps) {
        (Ok(whole), Ok(steps)) => {
            print!("{whole}\n{steps}");
            ExitCode::SUCCESS
        }
        (Err(error), _) | (_, Err(error)) => uncounted(&error),
    }
}

fn uncounted(error: &std::io::Error) -> ExitCode {
    eprintln!("error: no instructions are counted: {error}\nis valgrind installed?");
    ExitCode::FAILURE
}

/// Writes tables to `data/instructions/`.
fn written(files: &[(&str, std::io::Result<String>)]) -> ExitCode {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/instructions");
    for (name, text) in files {
        let text = match text {
            Ok(text) => text,
            Err(error) => return uncounted(error),
        };
        print!("{text}");
        if let Err(error) = std::fs::write(folder.join(name), text) {
            eprintln!("error: {}: {error}", folder.join(name).display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

/// Makes the table of runs, with the counters that it has.
fn work() -> std::io::Result<String> {
    let mut reader = csv::Reader::from_reader(counted::FILE.as_bytes());
    let header = reader.headers()?.clone();
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header)?;
    for record in reader.records() {
        let record = record?;
        let (body, configuration, few) = (&record[0], &record[1], counted::few(&record[0]));
        let of = |count: usize| callgrind(&["--run", body, configuration, &count.to_string()]);
        let ((one, before), (three, after)) = (of(few)?, of(3 * few)?);
        let counter = |name: &str| {
            let value = |text: &str| {
                let own = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(','));
                own.and_then(|value| value.parse::<f64>().ok()).unwrap_or(f64::NAN)
            };
            value(&after) - value(&before)
        };
        let mut row = vec![body.to_string(), configuration.to_string()];
        row.extend(header.iter().skip(2).map(|name| match name {
            "instructions" => format!("{:.0}", three - one),
            name => format!("{:.0}", counter(name)),
        }));
        writer.write_record(&row)?;
    }
    let bytes = writer.into_inner().map_err(|error| std::io::Error::other(error.to_string()))?;
    String::from_utf8(bytes).map_err(std::io::Error::other)
}

/// Makes the table of a whole time step by basis and dimension.
fn whole() -> std::io::Result<String> {
    let mut text = String::from(HEADER);
    for n in 0..CASES.len() {
        for (dimension, row) in [(1, row::<1>(n)), (2, row::<2>(n)), (3, row::<3>(n))] {
            text += &format!("{row},{:.0}\n", count(dimension, n, WHOLE)?);
        }
    }
    Ok(text)
}

/// Makes the table of the nine steps, with the linear basis and with local max-ent.
fn steps() -> std::io::Result<String> {
    let mut text =
        String::from("step,linear 1D,linear 2D,linear 3D,lme 0.8 1D,lme 0.8 2D,lme 0.8 3D\n");
    for n in 1..=9 {
        text += &n.to_string();
        for case in [0, 3] {
            for dimension in 1..=3 {
                text += &format!(",{:.0}", count(dimension, case, n)?);
            }
        }
        text += "\n";
    }
    Ok(text)
}
