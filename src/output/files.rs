//! Files are complete or not there.

use crate::run;
use crate::scene::fault::Fault;
use crate::scene::{Budget, Scene, neither, shipped};
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

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

/// Tells whether a file stands at `path`. A directory, a pipe, a device or a link is none: who
/// opens or replaces it waits for ever, or writes elsewhere.
///
/// Errors: [`Fault::Write`] for what is there and not a regular file.
pub fn is_file(path: &Path) -> Result<bool, Fault> {
    match fs::symlink_metadata(path) {
        Ok(there) if !there.is_file() => {
            Err(unwritten(path)(io::Error::other("it is not a regular file")))
        }
        there => Ok(there.is_ok()),
    }
}

/// Writes all `files` into `dir`, each complete or not at all, and removes the `stale` ones of
/// an earlier question.
///
/// Errors: [`Fault::Write`] with the path.
pub fn write_all(dir: &Path, files: &[(String, Vec<u8>)], stale: &[String]) -> Result<(), Fault> {
    let files: Vec<_> = files.iter().map(|(name, bytes)| (dir.join(name), &bytes[..])).collect();
    write(&files)?;
    let stale = stale.iter().map(|name| dir.join(name));
    stale.filter(|path| files.iter().all(|(written, _)| written != path)).try_for_each(remove)
}

/// Writes files of one folder, each complete or not at all.
///
/// Errors: [`Fault::Write`] with the path.
pub fn write(files: &[(PathBuf, &[u8])]) -> Result<(), Fault> {
    let fresh = |path: &Path| beside(path, ".lme-mpm-new");
    let lock = files.first().and_then(|(path, _)| lock(path.parent()?));
    let write = || -> Result<(), Fault> {
        for (path, bytes) in files {
            is_file(path)?;
            if lock.is_some() {
                remove(fresh(path))?; // a killed command has left it
            }
            write_new(&fresh(path), bytes).map_err(unwritten(path))?;
        }
        let rename = |(path, _): &(PathBuf, _)| fs::rename(fresh(path), path);
        files.iter().try_for_each(|file| rename(file).map_err(unwritten(&file.0)))
    };
    write().inspect_err(|_| {
        for (path, _) in files {
            // Best effort: the error that matters is the one that led here.
            remove(fresh(path)).ok();
        }
    })
}

/// Removes a file if it is there.
///
/// Errors: [`Fault::Write`] for what is not a regular file, or stays.
pub fn remove(path: PathBuf) -> Result<(), Fault> {
    match is_file(&path)? {
        true => fs::remove_file(&path).map_err(unwritten(&path)),
        false => Ok(()),
    }
}

/// Writes a file that is not there yet: no link is followed. What the disk refuses late, it
/// refuses here.
///
/// Errors: what the system says.
pub fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Waits until no other command writes in `folder`, and keeps others out as long as what it
/// gives lives; a process that dies gives it back. `None` where the system has no such locks,
/// or after ten seconds: then whoever meets what another is making stops, and names it.
pub fn lock(folder: &Path) -> Option<File> {
    let folder = if folder == Path::new("") { Path::new(".") } else { folder };
    let file = File::open(folder).ok()?;
    for _ in 0..1000 {
        match file.try_lock() {
            Ok(()) => return Some(file),
            Err(TryLockError::Error(_)) => return None,
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(10)),
        }
    }
    None
}

/// Names what stands hidden beside `path` while it is made: `.NAME` and `ending`.
pub fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(ending);
    path.with_file_name(name)
}

/// Makes the fault of a path that could not be written.
pub fn unwritten(path: &Path) -> impl Fn(io::Error) -> Fault {
    move |source| Fault::Write { path: path.to_path_buf(), source }
}

/// Makes `dir` and tries to write there, before a command spends time.
///
/// Errors: [`Fault::Write`] with the path.
pub fn prepare(dir: &Path) -> Result<(), Fault> {
    fs::create_dir_all(dir).map_err(unwritten(dir))?;
    let _lock = lock(dir);
    let probe = dir.join(".lme-mpm-new");
    remove(probe.clone())?;
    write_new(&probe, &[]).map_err(unwritten(dir))?;
    remove(probe)
}
