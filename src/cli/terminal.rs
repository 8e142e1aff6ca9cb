//! Standard input is read and standard output written here.

use lme_mpm::scene::fault::Fault;
use std::io::{Read, Write};
use std::path::Path;

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
