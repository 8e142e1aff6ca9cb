//! Prints the digest of the history of every shipped scene, for `book/lab/bits.mjs`.

mod fnv;

use lme_mpm::run::{parse, run};
use lme_mpm::scene::SHIPPED;
use std::process::ExitCode;

fn main() -> ExitCode {
    for scene in SHIPPED {
        match of_history(scene.name, scene.text) {
            Ok(digest) => println!("{},{digest:016x}", scene.name),
            Err(problem) => {
                eprintln!("error: {}: {problem}", scene.name);
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

fn of_history(name: &str, text: &str) -> Result<u64, String> {
    let scene = parse(name, name, text, &[]).map_err(|error| error.to_string())?;
    let outcome = run(&scene, &mut |_| {}).map_err(|stopped| stopped.to_string())?;
    let csv = outcome.history.csv().map_err(|fault| fault.to_string())?;
    Ok(fnv::fnv(fnv::START, &csv))
}
