//! Results are committed whole, and only our own are replaced.

use crate::support::dyka;
use crate::support::program::*;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::output::results::{self, MANIFEST};
use lme_mpm::run;
use lme_mpm::scene::fault::Fault;
use std::ffi::OsStr;
use std::fs;
use std::io::Error;
use std::ops::ControlFlow;
use std::os::unix::ffi::OsStrExt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// Files of one run: what distinguishes it stands in each of them.
fn written(word: &str) -> Vec<(String, Vec<u8>)> {
    let names = ["history.csv", word];
    names.map(|name| (name.to_string(), format!("{name} of {word}\n").into_bytes())).to_vec()
}

/// Which of `words` has its files, all of them and no others, in `dir`; `None` without `dir`.
fn whose<'a>(dir: &Path, words: &[&'a str]) -> Option<&'a str> {
    if !dir.exists() {
        return None;
    }
    let found = files(dir);
    let is_whole = |word: &&&str| {
        let mut names: Vec<String> = written(word).into_iter().map(|(name, _)| name).collect();
        names.push(MANIFEST.to_string());
        names.sort();
        names == found && written(word).iter().all(|(n, b)| fs::read(dir.join(n)).unwrap() == *b)
    };
    let word = words.iter().find(is_whole).unwrap_or_else(|| panic!("a mix: {found:?}"));
    Some(word)
}

/// What befalls an operation on a file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mishap {
    /// This one fails.
    Once,
    /// This one and all after it fail, as on a disk that is gone.
    FromThere,
    /// The process is killed before it.
    Killed,
}

/// Writes the files of `word`, with a mishap at operation `at`; tells whether there were so many.
fn commit(dir: &Path, word: &str, mishap: Mishap, at: usize) -> bool {
    let mut count = 0;
    let mut watcher = |_: &Path| {
        count += 1;
        match mishap {
            Mishap::Once if count == at => Err(Error::other("once")),
            Mishap::FromThere if count >= at => Err(Error::other("gone")),
            // No cleaning is done while a panic unwinds; but the lock is given back.
            Mishap::Killed if count == at => resume_unwind(Box::new("killed")),
            _ => Ok(()),
        }
    };
    let commit = || results::commit_watched(dir, &written(word), &mut watcher);
    let done = catch_unwind(AssertUnwindSafe(commit));
    assert_eq!(matches!(done, Ok(Ok(()))), count < at, "{mishap:?} at {at}: {done:?}");
    count >= at
}

/// Whatever operation fails or is the last before a kill: the old results stand there whole or
/// the new ones; between two renames they stand aside, and the next run puts them back. It also
/// clears away all else, killed itself at every operation or not.
#[test]
fn results_survive_every_mishap() {
    let root = directory("mishap");
    let dir = root.join("o");
    let reset = |old: bool| {
        fs::remove_dir_all(&root).unwrap();
        fs::create_dir_all(&root).unwrap();
        if old {
            results::commit(&dir, &written("old")).unwrap();
        }
    };
    for (old, mishap) in [true, false]
        .into_iter()
        .flat_map(|old| [Mishap::Once, Mishap::FromThere, Mishap::Killed].map(|one| (old, one)))
    {
        let mut at = 1;
        loop {
            reset(old);
            let reached = commit(&dir, "new", mishap, at);
            let stands = whose(&dir, &["old", "new"]);
            assert!(!old || mishap != Mishap::Once || stands.is_some(), "{mishap:?} at {at}");
            let litter: Vec<String> = files(&root).into_iter().filter(|name| name != "o").collect();
            assert!(litter.iter().all(|name| name.starts_with(".o.lme-mpm-")), "{litter:?}");
            // The next run is killed as well, as it clears away or later.
            for again in (1..).take_while(|_| old && mishap == Mishap::Killed) {
                let killed = commit(&dir, "newer", Mishap::Killed, again);
                whose(&dir, &["old", "new", "newer"]);
                results::prepare(&dir).unwrap();
                let now = whose(&dir, &["old", "new", "newer"]);
                assert!(now.is_some(), "killed at {at} and at {again}");
                assert_eq!(files(&root), ["o"], "killed at {at} and at {again}");
                reset(old);
                commit(&dir, "new", mishap, at);
                if !killed {
                    break;
                }
            }
            results::prepare(&dir).unwrap();
            let now = whose(&dir, &["old", "new"]);
            assert!(now.is_some() || !old, "{mishap:?} at {at}: the old results are lost");
            assert!(stands.is_none() || stands == now, "{mishap:?} at {at}");
            assert_eq!(files(&root), now.map_or(vec![], |_| vec!["o"]), "{mishap:?} at {at}");
            if !reached {
                break;
            }
            at += 1;
        }
        assert_eq!(at, if old { 13 } else { 6 }, "{mishap:?}: operations");
    }
}

/// Writers at once: one is the last, and its results are whole.
#[test]
fn results_of_runs_at_once_do_not_mix() {
    let root = directory("at-once");
    let dir = root.join("o");
    let words = ["one", "two", "three", "four"];
    std::thread::scope(|scope| {
        for word in words {
            let dir = &dir;
            scope.spawn(move || {
                for _ in 0..25 {
                    results::prepare(dir).unwrap();
                    results::commit(dir, &written(word)).unwrap();
                }
            });
        }
    });
    assert!(whose(&dir, &words).is_some());
    assert_eq!(files(&root), ["o"]);
    // As programs, with other probes.
    let start = |set: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lme-mpm"));
        command.args(["run", DYKA, "--out", "p", "-q", "--set", set]).current_dir(&root);
        command.spawn().unwrap()
    };
    let runs = ["probe.0.name=a", "probe.0.name=b", "probe.0.name=c"].map(start);
    for mut run in runs {
        assert!(run.wait().unwrap().success());
    }
    let names = files(&root.join("p"));
    let own =
        ["a.svg", "b.svg", "c.svg"].into_iter().filter(|name| names.contains(&name.to_string()));
    assert_eq!((own.count(), names.len()), (1, 7), "{names:?}");
    assert_eq!(files(&root), ["o", "p"]);
}

/// What is not ours stays, and is named before the run: files of a user beside ours or alone,
/// also where a header names them; ours that were changed; what is no directory, a pipe in the
/// way of a file, the current directory. An empty directory is taken, as is where a link leads.
#[test]
fn results_replace_only_their_own() {
    let root = directory("own");
    let run = |out: &str| program(&root, &["run", DYKA, "--quiet", "--out", out]);
    let ours = || {
        fs::remove_dir_all(root.join("o")).ok();
        assert!(run("o").status.success());
    };
    let refused = |out: &str, words: &[&str]| {
        let before = files(&root.join(out));
        assert_fails(&run(out), 2, words);
        assert_eq!(files(&root.join(out)), before);
    };
    ours();
    fs::write(root.join("o/notes.txt"), "mine").unwrap();
    refused("o", &["cannot replace o", "notes.txt", "--out", MANIFEST]);
    fs::create_dir(root.join("foreign")).unwrap();
    fs::write(root.join("foreign/history.csv"), "step,t,logo\n").unwrap();
    fs::write(root.join("foreign/logo.svg"), "mine").unwrap();
    refused("foreign", &["cannot replace foreign", "history.csv"]);
    fs::write(root.join("foreign").join(MANIFEST), "12 history.csv\n4 logo.svg\n").unwrap();
    refused("foreign", &["cannot replace foreign", "history.csv"]);
    ours();
    fs::write(root.join("o/velocity_end.svg"), "drawn by hand").unwrap();
    refused("o", &["velocity_end.svg"]);
    ours();
    fs::remove_file(root.join("o/history.csv")).unwrap();
    make_pipe(&root.join("o/history.csv"));
    refused("o", &["history.csv"]);
    make_pipe(&root.join("pipe"));
    assert_fails(&run("pipe"), 2, &["cannot write pipe", "not a directory"]);
    ours();
    let output = program(&root.join("o"), &["run", DYKA, "--out", "."]);
    assert_fails(&output, 2, &["`.` is the current directory"]);

    fs::create_dir(root.join("empty")).unwrap();
    std::os::unix::fs::symlink("empty", root.join("link")).unwrap();
    for out in ["empty", "link", "link/", "o", "o/../o/."] {
        assert!(run(out).status.success(), "{out}");
    }
    assert!(fs::symlink_metadata(root.join("link")).unwrap().is_symlink());
    assert_eq!(files(&root.join("empty")), files(&root.join("o")));
    assert_eq!(files(&root), ["empty", "foreign", "link", "o", "pipe"]);
}

/// A file that came while the run was at work is seen when its results are to take the place;
/// the directory stays as it is.
#[test]
fn results_that_are_foreign_in_the_end_are_refused() {
    let root = directory("foreign-in-the-end");
    let dir = root.join("o");
    results::commit(&dir, &written("old")).unwrap();
    for at in 1..=6 {
        let mut count = 0;
        let mut watcher = |path: &Path| {
            count += 1;
            // At the last one it is about to be renamed aside.
            if count == at {
                assert!(at < 6 || path.ends_with("foreign-in-the-end/o"), "{path:?}");
                fs::write(dir.join("mine"), "mine").unwrap();
            }
            Ok(())
        };
        let fault = results::commit_watched(&dir, &written("new"), &mut watcher).unwrap_err();
        let named = matches!(&fault, Fault::Foreign { dir, file, .. }
            if dir.ends_with("o") && file == Path::new("mine"));
        assert!(named, "{at}: {fault}");
        assert_eq!(fs::read(dir.join("mine")).unwrap(), b"mine");
        fs::remove_file(dir.join("mine")).unwrap();
        assert_eq!((whose(&dir, &["old"]), files(&root)), (Some("old"), vec!["o".to_string()]));
    }
}

fn make_pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

/// Links that lie in wait under a temporary name are not followed, and pipes not waited for:
/// of a run, of a trace, of a study.
#[test]
fn results_follow_no_link_and_wait_for_no_pipe() {
    let root = directory("links");
    fs::create_dir(root.join("victim")).unwrap();
    fs::write(root.join("victim/file"), "mine").unwrap();
    let link = |to: &str, at: &str| std::os::unix::fs::symlink(to, root.join(at)).unwrap();
    link("victim", ".o.lme-mpm-new");
    let output = program(&root, &["run", DYKA, "--quiet", "--out", "o"]);
    assert_fails(&output, 2, &[".o.lme-mpm-new"]);
    link("victim/file", ".trace.csv.lme-mpm-new");
    let trace = |out: &str| program(&root, &["trace", DYKA, "--steps", "0", "--out", out]);
    assert_fails(&trace("trace.csv"), 2, &[".trace.csv.lme-mpm-new", "not a regular file"]);
    link("victim/file", "t.csv");
    assert_fails(&trace("t.csv"), 2, &["t.csv", "not a regular file"]);
    fs::create_dir(root.join("study")).unwrap();
    for name in ["pipe", "study/runs.csv", "study/orders.csv"] {
        make_pipe(&root.join(name));
    }
    assert_fails(&trace("pipe"), 2, &["pipe", "not a regular file"]);
    let output = program(&root, &["trade", "--out", "study"]);
    assert_fails(&output, 2, &["study/runs.csv", "not a regular file"]);
    assert_eq!(fs::read(root.join("victim/file")).unwrap(), b"mine");
    assert_eq!(files(&root.join("victim")), ["file"]);
}

/// Runs the program where no file may be larger than `blocks` of 512 bytes: what is larger is an
/// error, or kills the program as it writes.
fn limited(dir: &Path, blocks: usize, kills: bool, arguments: &str) -> Output {
    let ignore = if kills { "" } else { "trap '' XFSZ; " };
    let program = env!("CARGO_BIN_EXE_lme-mpm");
    let line = format!("{ignore}ulimit -f {blocks}; exec '{program}' {arguments}");
    Command::new("sh").args(["-c", &line]).current_dir(dir).output().unwrap()
}

/// On a full disk the old results stay whole, and killed as it writes the program leaves what
/// the next run clears; a breakdown says particle, step and time all the same.
#[test]
fn results_on_a_full_disk() {
    let root = directory("full-disk");
    let run = format!("run '{DYKA}' --quiet --out o");
    assert!(limited(&root, 1000, false, &run).status.success());
    let before = fs::read(root.join("o/history.csv")).unwrap();
    let finer = format!("{run} --set grid.cells=20");
    assert_fails(&limited(&root, 30, false, &finer), 2, &["cannot write", "history.csv"]);
    assert_eq!((files(&root), files(&root.join("o")).len()), (vec!["o".to_string()], 7));
    assert_eq!(limited(&root, 30, true, &finer).status.code(), None);
    assert_eq!(files(&root), [".o.lme-mpm-new", "o"]);
    let broken = format!("{run} --set time.cfl=1.9 --set time.allow_unstable=true");
    let words = ["at step ", "t = ", "check.energy", "particle ", "may be lost: cannot write"];
    assert_fails(&limited(&root, 0, false, &broken), 1, &words);
    assert_eq!(files(&root), ["o"]);
    assert_eq!(fs::read(root.join("o/history.csv")).unwrap(), before);
    assert!(limited(&root, 1000, false, &finer).status.success());
    assert_ne!(fs::read(root.join("o/history.csv")).unwrap(), before);
    assert_eq!(files(&root), ["o"]);
}

/// A name that is no UTF-8 is a name like others.
#[test]
fn results_go_where_bytes_say() {
    let root = directory("bytes");
    let (dir, file) = (OsStr::from_bytes(b"o\xff"), OsStr::from_bytes(b"t\xfe.csv"));
    let ask = |command: &str, out: &OsStr| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_lme-mpm"));
        program.args([command, DYKA, "--out"]).arg(out).current_dir(&root);
        assert!(program.output().unwrap().status.success());
    };
    ask("run", dir);
    ask("run", dir);
    ask("trace", file);
    let mut names: Vec<_> = fs::read_dir(&root).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, [dir, file]);
    assert!(root.join(dir).join(MANIFEST).is_file());
}

/// A run goes on as long as its listener says so; then it stops with what it has recorded.
#[test]
fn results_of_a_run_that_is_broken_off() {
    let mut listener = |step| match step < 7 {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(Breakdown::Interrupted),
    };
    let stopped = run::run_knowing(&dyka(&[]), None, &mut listener).unwrap_err();
    assert_eq!(stopped.broken.breakdown, Breakdown::Interrupted);
    assert_eq!((stopped.broken.moment.step, stopped.history.rows().len()), (7, 8));
    // After its last step it is complete.
    let mut listener = |step| match step < 320 {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(Breakdown::Interrupted),
    };
    assert!(run::run_knowing(&dyka(&[]), None, &mut listener).is_ok());
}

/// Ctrl-C ends a run with its history up to there, step and time named, and exit code 130.
#[test]
fn results_of_an_interrupted_run() {
    let root = directory("interrupted");
    let long = ["run", DYKA, "--out", "out/o", "--set", "grid.cells=20000", "--set", "probe=[]"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_lme-mpm"))
        .args(long)
        .current_dir(&root)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The folder is made right before the run.
    while !root.join("out").exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it began");
        std::thread::sleep(Duration::from_millis(10));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let output = child.wait_with_output().unwrap();
    let words = ["at step ", ", t = ", "the run was interrupted", "out/o/history.failed.csv"];
    assert_fails(&output, 130, &words);
    assert_eq!(files(&root.join("out/o")), ["history.failed.csv", MANIFEST]);
    let history = fs::read_to_string(root.join("out/o/history.failed.csv")).unwrap();
    let last = history.lines().last().unwrap().split(',').next().unwrap();
    assert!(text(&output.stderr).contains(&format!("at step {last}, ")), "{history}");
}

/// A trace that fails leaves no earlier one in its place; one that is refused leaves it.
#[test]
fn results_of_a_trace_are_its_own() {
    let root = directory("trace-fails");
    let trace = |more: &[&str]| {
        program(&root, &[&["trace", DYKA, "--steps", "0", "--out", "t.csv"], more].concat())
    };
    assert!(trace(&[]).status.success());
    assert_fails(&trace(&["--set", "time.cfl=1.75"]), 2, &["time step is too large"]);
    assert_eq!(files(&root), ["t.csv"]);
    assert_fails(&trace(&["--set", "body_force.acceleration=1e308"]), 1, &["at step 0"]);
    assert!(files(&root).is_empty());
}
