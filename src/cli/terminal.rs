//! Standard input is read, standard output written, and Ctrl-C heard here.

use lme_mpm::scene::fault::Fault;
use std::io::{Read, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

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
