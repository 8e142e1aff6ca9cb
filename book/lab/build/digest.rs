//! One number stands for all that the solver in the page is compiled from.

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

/// FNV-1a begins with this.
pub const START: u64 = 0xcbf2_9ce4_8422_2325;

/// Takes FNV-1a on from `hash` over `bytes`.
pub fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    let one = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    bytes.iter().fold(hash, one)
}

/// Gives FNV-1a over names and bytes of all sources below `root`, in hexadecimal digits.
#[allow(dead_code)] // not by `bits`
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
