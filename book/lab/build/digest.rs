//! One number stands for all that the solver in the page is compiled from.

use super::fnv::{START, fnv};
use std::fs;
use std::path::{Path, PathBuf};

/// The solver is compiled from these files, and from all in these folders.
const SOURCES: [&str; 9] = [
    "Cargo.lock",
    "book/lab/src",
    "data/scenes",
    "src/lib.rs",
    "src/method",
    "src/output/summary.rs",
    "src/run",
    "src/scene",
    "src/setup",
];

/// Gives FNV-1a over names and bytes of all sources below `root`, in hexadecimal digits.
pub fn of_sources(root: &Path) -> std::io::Result<String> {
    let mut hash = START;
    for source in SOURCES {
        let mut files = Vec::new();
        below(&root.join(source), &mut files)?;
        files.sort();
        for file in files {
            let name = file.strip_prefix(root).unwrap_or(&file).to_string_lossy();
            hash = fnv(fnv(hash, name.as_bytes()), &fs::read(&file)?);
        }
    }
    Ok(format!("{hash:016x}"))
}

/// Adds `path`, or all files below it.
fn below(path: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    if !path.is_dir() {
        files.push(path.to_path_buf());
        return Ok(());
    }
    for entry in fs::read_dir(path)? {
        below(&entry?.path(), files)?;
    }
    Ok(())
}
