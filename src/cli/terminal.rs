//! Standard input is read and standard output written here.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lme_mpm::scene::fault::Fault;
use std::io::{Read, Write};
use std::path::Path;
use std::time::Duration;

/// Opens a file, or standard input for `-`.
pub fn open(path: &Path) -> Result<Box<dyn Read>, Fault> {
    if path == Path::new("-") {
        return Ok(Box::new(std::io::stdin()));
    }
    let file = std::fs::File::open(path)
        .map_err(|source| Fault::Read { path: path.to_path_buf(), source })?;
    Ok(Box::new(file))
}

/// Prints bytes, without colours unless on a terminal. A reader that has seen enough and closed
/// the pipe is no error.
pub fn print_bytes(bytes: &[u8]) -> Result<(), Fault> {
    let mut out = anstream::stdout();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(source) if source.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Fault::Write { path: "standard output".into(), source })
        }
        _ => Ok(()),
    }
}

/// Does what may predict a limit of Δt, and shows on a terminal's stderr, unless `quiet`, for how
/// long it has been at it.
pub fn predicting<T>(quiet: bool, what: impl FnOnce() -> T) -> T {
    let bar = spinner(quiet);
    let done = what();
    bar.finish_and_clear();
    done
}

/// Shows for how long a limit has been predicted; hidden if `quiet`, or without a terminal.
pub fn spinner(quiet: bool) -> ProgressBar {
    let hidden = || ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    let bar = if quiet { hidden() } else { ProgressBar::new_spinner() };
    bar.set_style(style("predicting the largest stable time step ({elapsed})"));
    bar.enable_steady_tick(Duration::from_millis(250));
    bar
}

/// Makes the style of a bar.
pub fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or(ProgressStyle::default_bar())
}
