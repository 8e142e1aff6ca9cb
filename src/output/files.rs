//! Files are complete or not there.

use crate::run;
use crate::scene::fault::Fault;
use crate::scene::{Budget, Scene, neither, shipped};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Reads the text of a file.
///
/// Errors: [`Fault::Read`] with the path.
pub fn text(path: &Path) -> Result<String, Fault> {
    fs::read_to_string(path).map_err(|source| Fault::Read { path: path.to_path_buf(), source })
}

/// Gives the text of a scene file; where there is no such file, that of the shipped scene with
/// that name.
///
/// Errors: [`Fault::Read`], [`Fault::NoScene`].
pub fn scene_text(path: &Path) -> Result<String, Fault> {
    let shipped = path.to_str().and_then(shipped).filter(|_| !path.is_file());
    match (shipped, text(path)) {
        (Some(scene), _) => Ok(scene.text.to_string()),
        (None, Err(Fault::Read { source, .. })) if source.kind() == ErrorKind::NotFound => {
            Err(neither(path, source))
        }
        (None, text) => text,
    }
}

/// Reads a scene, a file or a shipped one, with the `KEY=VALUE` of `sets` in place of its
/// own, that needs no more than the `budget`.
///
/// Errors: those of [`scene_text`]; [`Fault::Scene`] with file, line, key and what is
/// allowed.
pub fn scene(path: &Path, sets: &[String], budget: &Budget) -> Result<Scene, Fault> {
    let stem = path.file_stem().map_or("".into(), |stem| stem.to_string_lossy());
    // A name that is no name for a directory of results.
    let name = if stem.trim_matches('.').is_empty() { "scene".into() } else { stem };
    Ok(run::parse_within(budget, &name, &path.display().to_string(), &scene_text(path)?, sets)?)
}

/// Refuses an `input` that a command would overwrite: a file in the folder `dir` with a name
/// that is `taken` by what it writes.
///
/// Errors: [`Fault::Argument`].
pub fn spare(input: &Path, dir: &Path, taken: impl Fn(&str) -> bool) -> Result<(), Fault> {
    let (Ok(input), Ok(dir)) = (input.canonicalize(), dir.canonicalize()) else {
        return Ok(()); // one of them is not there yet
    };
    let name = input.file_name().map_or("".into(), |name| name.to_string_lossy());
    if input.parent() != Some(&dir) || !taken(&name) {
        return Ok(());
    }
    Err(Fault::Argument {
        argument: "--out",
        problem: format!("the results would overwrite the input {}", input.display()),
        allowed: "another folder, or another name for the input",
    })
}

/// Writes all `files` into `dir`, each complete or not at all, and removes the
/// `stale` ones of an earlier run, so that a directory does not mix two runs.
///
/// Errors: [`Fault::Write`] with the path.
pub fn write_all(dir: &Path, files: &[(String, Vec<u8>)], stale: &[String]) -> Result<(), Fault> {
    let fault = |path: &Path, source| Fault::Write { path: path.to_path_buf(), source };
    for (name, _) in files {
        // What is not a file of its own (a device, a pipe, a link) would be replaced by one.
        let path = dir.join(name);
        if fs::symlink_metadata(&path).is_ok_and(|there| !there.is_file()) {
            return Err(fault(&path, std::io::Error::other("it is not a regular file")));
        }
    }
    let temporary = |name: &str| dir.join(format!(".{name}.{}.part", std::process::id()));
    let write = || -> Result<(), Fault> {
        for (name, bytes) in files {
            let path = temporary(name);
            fs::write(&path, bytes).map_err(|source| fault(&path, source))?;
        }
        for (name, _) in files {
            let path = dir.join(name);
            fs::rename(temporary(name), &path).map_err(|source| fault(&path, source))?;
        }
        Ok(())
    };
    write().inspect_err(|_| {
        for (name, _) in files {
            // Best effort: the error that matters is the one that led here.
            fs::remove_file(temporary(name)).ok();
        }
    })?;
    for name in stale.iter().filter(|name| !files.iter().any(|(written, _)| written == *name)) {
        let path = dir.join(name);
        if path.exists() {
            fs::remove_file(&path).map_err(|source| fault(&path, source))?;
        }
    }
    Ok(())
}

/// Makes `dir` and tries to write there, before a run spends time.
///
/// Errors: [`Fault::Write`] with the path.
pub fn prepare(dir: &Path) -> Result<(), Fault> {
    let fault = |source| Fault::Write { path: dir.to_path_buf(), source };
    fs::create_dir_all(dir).map_err(fault)?;
    let probe = dir.join(format!(".writable.{}.part", std::process::id()));
    fs::write(&probe, []).map_err(fault)?;
    fs::remove_file(&probe).map_err(fault)
}
