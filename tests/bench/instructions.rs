//! How many instructions a time step takes: counted by callgrind, so the same on a busy machine.
//!
//! `cargo bench --bench instructions` prints the counts of this build;
//! `cargo bench --bench instructions -- --write` writes them to `data/instructions/`, from where the
//! book takes them. Needs valgrind.

mod cases;
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
        ["--write"] | [] => report(arguments.len() == 1),
        _ => {
            eprintln!("error: unknown argument; allowed: --write");
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
        let output = Command::new("valgrind")
            .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
            .arg(std::env::current_exe()?)
            .arg("--do")
            .args(numbers)
            .output()?;
        // The total stands at the end: "==1== Collected : 123".
        let text = String::from_utf8_lossy(&output.stderr);
        let found = text.lines().rev().find_map(|line| line.split_once("Collected : "));
        let total = found.and_then(|(_, count)| count.trim().parse().ok());
        total.ok_or_else(|| std::io::Error::other(format!("callgrind counted nothing:\n{text}")))
    };
    Ok((total(3 * FEW)? - total(FEW)?) / (2 * FEW) as f64 / particles)
}

fn report(write: bool) -> ExitCode {
    let answer = whole().and_then(|whole| Ok((whole, steps()?)));
    let (whole, steps) = match answer {
        Ok(tables) => tables,
        Err(error) => {
            eprintln!("error: no instructions are counted: {error}\nis valgrind installed?");
            return ExitCode::FAILURE;
        }
    };
    print!("{whole}\n{steps}");
    if write {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/instructions");
        let files = [("time-step.csv", whole), ("nine-steps.csv", steps)];
        for (name, text) in files {
            if let Err(error) = std::fs::write(folder.join(name), text) {
                eprintln!("error: {}: {error}", folder.join(name).display());
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
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
