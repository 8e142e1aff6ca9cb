//! `cargo lab`: compiles the solver for the book's page, and notes what it was compiled from.
//!
//! Further arguments go to `cargo build`.

mod digest;
mod fnv;

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// What the page runs on.
const TARGET: &str = "wasm32-unknown-unknown";

const HELP: &str = "the solver was not compiled. Where the target is missing: \
    `rustup target add wasm32-unknown-unknown`, or without rustup as the book says in its \
    chapter \"How this code is tested\"";

fn main() -> ExitCode {
    match build() {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn build() -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let root = root.canonicalize().map_err(|error| format!("no workspace: {error}"))?;
    let target = root.join("target/lab");
    let done = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(&root)
        .args(["build", "--locked", "--package", "lme-mpm-lab", "--lib", "--profile", "lab"])
        .args(["--target", TARGET, "--target-dir"])
        .arg(&target)
        .args(env::args_os().skip(1))
        .env("CARGO_ENCODED_RUSTFLAGS", remapped(&root))
        .status();
    if !done.is_ok_and(|status| status.success()) {
        return Err(HELP.to_string());
    }
    let from = target.join(TARGET).join("lab/lme_mpm_lab.wasm");
    let beside = root.join("book/lab");
    let bytes = fs::read(&from).map_err(|error| format!("no compiled solver: {error}"))?;
    let digest = digest::of_sources(&root).map_err(|error| format!("no sources: {error}"))?;
    for (name, content) in [("lab.wasm", &bytes[..]), ("lab.digest", digest.as_bytes())] {
        let path = beside.join(name);
        fs::write(&path, content).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    println!("book/lab/lab.wasm has {} bytes, of sources {digest}", bytes.len());
    Ok(())
}

/// Gives the flags that keep the paths of this machine out of the compiled file, so that it has
/// the same bytes wherever it is compiled.
fn remapped(root: &Path) -> OsString {
    let home = env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(PathBuf::from(env::var_os("HOME")?).join(".cargo")));
    let registry = home.map(|home| home.join("registry/src"));
    let inside = registry.into_iter().flat_map(|path| fs::read_dir(path).into_iter().flatten());
    let folders = inside.flatten().map(|entry| entry.path());
    let mut flags = OsString::new();
    for folder in folders.chain([root.to_path_buf()]) {
        if !flags.is_empty() {
            flags.push("\x1f");
        }
        flags.push("--remap-path-prefix=");
        flags.push(folder);
        flags.push("=");
    }
    flags
}
