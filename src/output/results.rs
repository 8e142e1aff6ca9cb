//! The results of a run are one directory, which takes its place whole.
//!
//! They are written into a fresh directory beside their place, the old ones are renamed aside,
//! the fresh one is renamed into the place, and the old ones are removed. While that lasts, two
//! more names stand beside `PLACE`: `.PLACE.lme-mpm-new`, of which nothing is needed, and
//! `.PLACE.lme-mpm-old`, which is whole. So whoever is killed at any moment leaves the old
//! results or the new ones, and the next run into the place knows what to do: it removes the
//! first, and puts the second back where the place is empty, or removes it where it is not. Two
//! renames do that on every file system; one that exchanges would leave the place at no moment
//! empty, but not all have it. Tests: `results_*`.

use super::files::{beside, lock, unwritten, write_new};
use crate::scene::fault::Fault;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// This file in a directory lists what a run has written there.
pub const MANIFEST: &str = "results.txt";

/// The list begins with this line; below it stand bytes and name of each file.
const HEAD: &str =
    "lme-mpm: a run replaces this directory while it holds nothing but this list names:";

/// A watcher hears of each operation on a file before it is done, and can make it fail.
pub type Watcher<'a> = &'a mut dyn FnMut(&Path) -> io::Result<()>;

/// A commit brings results to their place.
struct Commit<'a> {
    /// As the user has it.
    dir: &'a Path,
    /// The same with all links followed.
    here: PathBuf,
    /// All of it may be removed at any time.
    new: PathBuf,
    /// It is whole as long as it has this name.
    old: PathBuf,
    watcher: RefCell<Watcher<'a>>,
    /// No other commit is at work beside the place; `None` where the system has no locks.
    lock: Option<File>,
}

/// Sees to it, before a run spends time, that its results can take the place `dir`, and clears
/// away what a killed run has left there.
///
/// Errors: [`Fault::Foreign`] for a directory that is neither empty nor ours;
/// [`Fault::Argument`] for the current directory; [`Fault::Write`] with the path.
pub fn prepare(dir: &Path) -> Result<(), Fault> {
    let mut watcher = |_: &Path| Ok(());
    let commit = Commit::begin(dir, &mut watcher)?;
    // What cannot be moved, such as a mount, is refused now and not after the run.
    let moves = match is_there(&commit.here) {
        true => commit
            .rename(&commit.here, &commit.old)
            .and_then(|()| commit.rename(&commit.old, &commit.here)),
        false => Ok(()),
    };
    commit.clear().and(moves)
}

/// Lets `files` take the place `dir` of an earlier run's, all or none.
///
/// Errors: those of [`prepare`].
pub fn commit(dir: &Path, files: &[(String, Vec<u8>)]) -> Result<(), Fault> {
    commit_watched(dir, files, &mut |_| Ok(()))
}

/// Does what [`commit`] does, and tells `watcher` each operation before it is done. A test
/// makes each of them fail, or kills the writer there.
///
/// Errors: those of [`prepare`].
pub fn commit_watched(
    dir: &Path,
    files: &[(String, Vec<u8>)],
    watcher: Watcher<'_>,
) -> Result<(), Fault> {
    let commit = Commit::begin(dir, watcher)?;
    commit.fill(files).and_then(|()| commit.take()).inspect_err(|_| {
        // Best effort: the error that matters is the one that led here.
        commit.clear().ok();
    })
}

impl<'a> Commit<'a> {
    /// Locks the folder of the place, clears away what a killed run has left, refuses what is
    /// not ours, and makes the fresh directory.
    fn begin(dir: &'a Path, watcher: Watcher<'a>) -> Result<Self, Fault> {
        let here = resolved(dir).map_err(unwritten(dir))?;
        if fs::canonicalize(".").is_ok_and(|now| now == here) {
            return Err(Fault::Argument {
                argument: "--out",
                problem: format!("`{}` is the current directory", dir.display()),
                allowed: "another folder, which the results can replace",
            });
        }
        let [new, old] = [".lme-mpm-new", ".lme-mpm-old"].map(|ending| beside(&here, ending));
        let lock = here.parent().and_then(lock);
        let commit = Commit { dir, here, new, old, watcher: RefCell::new(watcher), lock };
        commit.recover()?;
        commit.act(&commit.new, |new| fs::create_dir(new))?;
        Ok(commit)
    }

    /// Does one operation on a file, which the watcher hears of.
    fn act(
        &self,
        path: &Path,
        operation: impl FnOnce(&Path) -> io::Result<()>,
    ) -> Result<(), Fault> {
        let heard = (self.watcher.borrow_mut())(path);
        heard.and_then(|()| operation(path)).map_err(unwritten(path))
    }

    fn rename(&self, from: &Path, to: &Path) -> Result<(), Fault> {
        self.act(from, |from| fs::rename(from, to))
    }

    /// Clears away what a killed run has left, and refuses what is not ours.
    fn recover(&self) -> Result<(), Fault> {
        if self.lock.is_some() {
            // Without a lock another run may be at work there: it is refused, by its name.
            self.clear()?;
        }
        let aside = is_directory(&self.old);
        if aside && (!is_there(&self.here) || fs::remove_dir(&self.here).is_ok()) {
            self.rename(&self.old, &self.here)?;
        }
        check(&self.here, self.dir)?;
        if is_directory(&self.old) {
            self.rename(&self.old, &self.new)?;
            self.clear()?;
        }
        Ok(())
    }

    /// Writes the fresh directory, first the list of what it will hold.
    fn fill(&self, files: &[(String, Vec<u8>)]) -> Result<(), Fault> {
        let lines = files.iter().map(|(name, bytes)| format!("{} {name}\n", bytes.len()));
        let list = format!("{HEAD}\n{}", lines.collect::<String>());
        self.act(&self.new.join(MANIFEST), |path| write_new(path, list.as_bytes()))?;
        files.iter().try_for_each(|(name, bytes)| {
            self.act(&self.new.join(name), |path| write_new(path, bytes))
        })
    }

    /// Lets the fresh directory take the place.
    fn take(&self) -> Result<(), Fault> {
        if !is_there(&self.here) {
            return self.rename(&self.new, &self.here);
        }
        let rights = fs::metadata(&self.here).map_err(unwritten(self.dir))?.permissions();
        self.act(&self.new, |new| fs::set_permissions(new, rights))?;
        self.rename(&self.here, &self.old)?;
        // What came into the old directory at the last moment came before it was renamed.
        check(&self.old, self.dir).and_then(|()| self.rename(&self.new, &self.here)).inspect_err(
            |_| {
                // If this fails, too, the next run does it.
                self.rename(&self.old, &self.here).ok();
            },
        )?;
        self.rename(&self.old, &self.new)?;
        self.clear()
    }

    /// Removes the directory of which nothing is needed. Its list goes last, so that half of it
    /// is still known as ours.
    fn clear(&self) -> Result<(), Fault> {
        if !is_directory(&self.new) {
            return Ok(());
        }
        let mut names = names(&self.new)?;
        if let Some(first) = names.first().filter(|_| !names.contains(&MANIFEST.into())) {
            return Err(foreign(&self.new, first));
        }
        names.sort_by_key(|name| name == MANIFEST);
        for name in names {
            self.act(&self.new.join(name), |path| fs::remove_file(path))?;
        }
        self.act(&self.new, |new| fs::remove_dir(new))
    }
}

/// Follows all links to the place, and makes the folder of one that is not there yet.
fn resolved(dir: &Path) -> io::Result<PathBuf> {
    if let Ok(here) = fs::canonicalize(dir) {
        return Ok(here);
    }
    let name = dir.file_name().ok_or(io::ErrorKind::NotFound)?;
    let folder = dir.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    Ok(fs::canonicalize(folder)?.join(name))
}

fn is_there(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

fn is_directory(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|there| there.is_dir())
}

/// Lists what stands in a directory, in order.
fn names(dir: &Path) -> Result<Vec<OsString>, Fault> {
    let fault = |source| Fault::Read { path: dir.to_path_buf(), source };
    let entries = fs::read_dir(dir).and_then(|entries| {
        entries.map(|entry| entry.map(|entry| entry.file_name())).collect::<io::Result<Vec<_>>>()
    });
    let mut names = entries.map_err(fault)?;
    names.sort();
    Ok(names)
}

fn foreign(dir: &Path, name: &OsStr) -> Fault {
    Fault::Foreign { dir: dir.to_path_buf(), file: PathBuf::from(name), list: MANIFEST }
}

/// Refuses `dir`, which is called `shown`, if anything stands in it but what its list names,
/// as it was written.
fn check(dir: &Path, shown: &Path) -> Result<(), Fault> {
    let refuse = |problem: &str| unwritten(shown)(io::Error::other(problem));
    match fs::symlink_metadata(dir) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(unwritten(shown)(error)),
        Ok(there) if !there.is_dir() => return Err(refuse("it is not a directory")),
        Ok(there) if there.permissions().readonly() => return Err(refuse("it is read-only")),
        Ok(_) => {}
    }
    let listed = listed(&dir.join(MANIFEST)).unwrap_or_default();
    for name in names(dir)? {
        let bytes = fs::symlink_metadata(dir.join(&name)).ok().filter(|file| file.is_file());
        let own = name.to_str().and_then(|name| listed.get(name));
        match (own, bytes.map(|file| file.len())) {
            (Some(own), Some(bytes)) if *own == bytes => {}
            _ => return Err(foreign(shown, &name)),
        }
    }
    Ok(())
}

/// Reads a list with the bytes of each file, itself among them; `None` if it is not ours.
fn listed(path: &Path) -> Option<BTreeMap<String, u64>> {
    fs::symlink_metadata(path).ok().filter(|there| there.is_file())?;
    let text = fs::read_to_string(path).ok()?;
    let lines = text.strip_prefix(HEAD)?.strip_prefix('\n')?.lines();
    let pair = |line: &str| {
        let (bytes, name) = line.split_once(' ')?;
        Some((name.to_string(), bytes.parse().ok()?))
    };
    let own = (MANIFEST.to_string(), text.len() as u64);
    lines.map(pair).chain([Some(own)]).collect()
}
