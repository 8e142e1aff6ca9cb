//! Standard input is read here, standard output and error are written, and Ctrl-C is heard.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lme_mpm::run::Warning;
use lme_mpm::scene::fault::{Fault, unprintable, visible};
use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

pub const BOLD: anstyle::Style = anstyle::Style::new().bold();
const RED: anstyle::Style =
    anstyle::Style::new().bold().fg_color(Some(anstyle::Color::Ansi(anstyle::AnsiColor::Red)));

/// Opens a file, or standard input for `-`.
pub fn open(path: &Path) -> Result<Box<dyn Read>, Fault> {
    if path == Path::new("-") {
        return Ok(Box::new(std::io::stdin()));
    }
    let file = std::fs::File::open(path)
        .map_err(|source| Fault::Read { path: path.to_path_buf(), source })?;
    Ok(Box::new(file))
}

/// Prints what is all that a command gives.
pub fn print_bytes(bytes: &[u8]) -> Result<(), Fault> {
    let left = "what it has may be cut short, and nothing else is written".to_string();
    put(bytes).map_err(|source| Fault::Output { source, left })
}

/// Prints what a command tells of the files that it has written into `dir`: its `own` text, with
/// colours, and one that may hold anything. A reader that has seen enough and closed the pipe is
/// no error, but what is written is said on standard error.
pub fn print_report(own: &str, text: &str, dir: &Path) -> Result<(), Fault> {
    let left = format!("all results are in {}", dir.display());
    let place = visible(&dir.display().to_string(), &[]);
    let text = format!("{own}{}written to {place}\n", visible(text, &['\n']));
    match put(text.as_bytes()) {
        Err(source) if source.kind() == ErrorKind::BrokenPipe => {
            say(&visible(&format!("standard output was closed before its end; {left}"), &[]));
            Ok(())
        }
        put => put.map_err(|source| Fault::Output { source, left }),
    }
}

/// Gives a flag that the first Ctrl-C sets; the second ends the program at once, with 130.
pub fn interrupted() -> Result<Arc<AtomicBool>, Fault> {
    use signal_hook::{consts::SIGINT, flag};
    let set = Arc::new(AtomicBool::new(false));
    // What is registered first is done first: the first Ctrl-C finds the flag not set.
    flag::register_conditional_shutdown(SIGINT, 130, set.clone())
        .and_then(|_| flag::register(SIGINT, set.clone()))
        .map_err(|source| Fault::Read { path: "the signal of Ctrl-C".into(), source })?;
    Ok(set)
}

/// Says what a run is warned of; with `strict` that is an error.
pub fn warn(warnings: &[Warning], strict: bool) -> Result<(), Fault> {
    if strict && !warnings.is_empty() {
        let list: Vec<String> = warnings.iter().map(Warning::to_string).collect();
        return Err(Fault::Warned(list.join("\n")));
    }
    for warning in warnings {
        say(&format!("{BOLD}warning{BOLD:#}: {warning}"));
    }
    Ok(())
}

/// Writes to standard output, without colours unless on a terminal.
fn put(bytes: &[u8]) -> std::io::Result<()> {
    let mut out = anstream::stdout();
    out.write_all(bytes).and_then(|()| out.flush())
}

/// Says a message on standard error. If even this cannot be said, the exit code says it.
fn say(message: &str) {
    writeln!(anstream::stderr(), "{message}").ok();
}

/// Tells a fault. Here messages leave the program, and no control character of a file, a cell or
/// a name goes with them: only lines that the program ends itself, and its own colours.
pub fn tell(fault: &Fault) {
    say(&match fault {
        Fault::Scene(error) => {
            let message = error.render(&annotate_snippets::Renderer::styled());
            visible(&message, &['\n', '\u{1b}'])
        }
        Fault::Run { .. } | Fault::Differs(_) | Fault::Warned(_) => {
            format!("{RED}error{RED:#}: {}", visible(&fault.to_string(), &['\n']))
        }
        _ => format!("{RED}error{RED:#}: {}", visible(&fault.to_string(), &[])),
    });
}

/// Tells what is wrong with the command line, or the help that it asks for, and gives the exit
/// code.
pub fn tell_usage(error: &clap::Error) -> u8 {
    match std::env::args_os().any(|word| word.to_string_lossy().contains(unprintable)) {
        true => say(visible(&error.to_string(), &['\n']).trim_end()),
        false => error.print().unwrap_or_default(),
    }
    error.exit_code() as u8
}

/// Quotes a word for a shell: what stands between two ' is taken as it is.
pub fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', r"'\''"))
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
