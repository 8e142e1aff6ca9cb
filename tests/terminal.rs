//! The program in a shell and on a terminal: what it prints can be trusted there, and says what
//! is written.

use crate::support::program::*;
use lme_mpm::scene::fault::visible;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs a line in sh, with the program on the PATH.
fn shell(dir: &Path, line: &str) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_lme-mpm")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    Command::new("sh").args(["-c", line]).current_dir(dir).env("PATH", path).output().unwrap()
}

/// Runs the program on a terminal of its own, and gives what it shows there.
fn on_terminal(dir: &Path, arguments: &[&str]) -> String {
    let spawn = "import pty, sys; sys.exit(pty.spawn(sys.argv[1:]) >> 8)";
    let output = Command::new("python3")
        .args(["-c", spawn, env!("CARGO_BIN_EXE_lme-mpm")])
        .args(arguments)
        .current_dir(dir)
        .env("TERM", "xterm")
        .env_remove("NO_COLOR")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stdout));
    text(&output.stdout)
}

/// A scene may have any name: the line that a list prints runs that scene and nothing else, and
/// so does what `recommend` says is ready to run. A name that would break the line is refused.
#[test]
fn printed_commands_are_quoted() {
    let dir = directory("quoted");
    let name = "x'; touch PWNED; '$(touch PWNED)`touch PWNED`.toml";
    let vibration = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/vibration.toml");
    fs::copy(vibration, dir.join(name)).unwrap();
    for study in ["trade", "orders", "stability"] {
        let list = text(&program(&dir, &[study, "--list", "--scene", name]).stdout);
        let line = list.lines().last().unwrap();
        let output = shell(&dir, line);
        assert!(output.status.success(), "{line}: {}", text(&output.stderr));
        assert!(text(&output.stdout).lines().count() > 1, "{line}");
    }
    let recommend = ["recommend", name, "--error", "10%", "--quantity", "displacement"];
    let told = text(&program(&dir, &recommend).stdout);
    let ready = told.lines().find_map(|line| line.strip_prefix("ready to run: ")).unwrap();
    let output = shell(&dir, ready);
    assert!(output.status.success(), "{ready}: {}", text(&output.stderr));
    assert_eq!(files(&dir), ["out", name]);
    let broken = "two\nlines.toml";
    fs::copy(vibration, dir.join(broken)).unwrap();
    let output = program(&dir, &["trade", "--list", "--scene", broken]);
    assert_fails(&output, 2, &["--scene: `two\\nlines.toml` cannot stand in a line of a shell"]);
}

/// Escapes of a file, a cell, a name or the command line are shown, not obeyed.
#[test]
fn messages_have_no_control_characters() {
    assert_eq!(visible("a\u{1b}[31m\u{9b}\u{202e}\n", &['\n']), "a\\u{1b}[31m\\u{9b}\\u{202e}\n");
    let dir = directory("control");
    let esc = "\u{1b}]0;owned\u{7}\u{9b}31m";
    let named = format!("{esc}\nerror.toml");
    let dyka = fs::read_to_string(DYKA).unwrap();
    fs::write(dir.join(&named), format!("{dyka}\n# {esc}\nx = 1 # {esc}\n")).unwrap();
    fs::write(dir.join("title.toml"), dyka.replace("The Dyka", "\\u001bThe Dyka")).unwrap();
    fs::write(dir.join("key.toml"), format!("{dyka}\n\"\\u001b\\u009b\" = 1\n")).unwrap();
    let header = "k,step,symbol,index,node,component,value";
    fs::write(dir.join("a.csv"), format!("{header}\n0,0,{esc},0,,0,1\n")).unwrap();
    fs::write(dir.join("points.csv"), format!("x,t\n{esc},0\n")).unwrap();
    fs::write(dir.join("columns.csv"), format!("x,{esc}\n0,0\n")).unwrap();
    fs::write(dir.join("log.csv"), format!("{esc},b\n0,0\n")).unwrap();
    let set = format!("title={esc}");
    let key = format!("{esc}=1");
    for arguments in [
        &["run", &named][..],
        &["run", "title.toml"],
        &["run", "key.toml"],
        &["run", esc],
        &["run", "dyka", "--set", &set],
        &["run", "dyka", "--set", &key],
        &["run", "dyka", "--set", esc],
        &["check", "a.csv", "a.csv"],
        &["exact", "dyka", "--points", "points.csv"],
        &["exact", "dyka", "--points", "columns.csv"],
        &["trade", "--row", esc],
        &["trade", "--merge", "log.csv"],
        &["gamma", "--row", esc],
        &["gamma", "--merge", "log.csv", esc],
        &[esc],
        &["run", "dyka", esc],
    ] {
        let output = program(&dir, arguments);
        assert_fails(&output, 2, &[]);
        for printed in [&output.stderr, &output.stdout].map(|bytes| text(bytes)) {
            let bad = printed.chars().find(|c| c.is_control() && *c != '\n');
            assert_eq!(bad, None, "{arguments:?}: {printed:?}");
        }
    }
    // What is told of a run that went well, too.
    let output = program(&dir, &["run", "dyka", "--out", &format!("o{esc}\n")]);
    let told = text(&output.stdout);
    assert!(told.ends_with("written to o\\u{1b}]0;owned\\u{7}\\u{9b}31m\\n\n"), "{told:?}");
}

/// A standard output that is full or closed does not hide what was written.
#[test]
fn output_that_is_full_or_closed() {
    let dir = directory("full-or-closed");
    let full = shell(&dir, "lme-mpm run dyka --out o > /dev/full");
    assert_fails(&full, 2, &["cannot write standard output", "all results are in o"]);
    let whole = files(&dir.join("o"));
    assert!(whole.contains(&"summary.csv".to_string()), "{whole:?}");
    let full = shell(&dir, "printf 'x,t\\n0,0\\n' | lme-mpm exact dyka --points - > /dev/full");
    assert_fails(&full, 2, &["cannot write standard output", "may be cut short"]);
    let closed = "{ sleep 0.3; lme-mpm run dyka --out p; echo $? > code; } | true";
    let told = shell(&dir, closed);
    assert_eq!(fs::read_to_string(dir.join("code")).unwrap(), "0\n");
    let words = "standard output was closed before its end; all results are in p";
    assert!(text(&told.stderr).contains(words), "{}", text(&told.stderr));
    assert_eq!(files(&dir.join("p")), whole);
    let closed = "{ sleep 0.3; lme-mpm scenes; echo $? > code; } | true";
    let told = shell(&dir, closed);
    assert_eq!(fs::read_to_string(dir.join("code")).unwrap(), "2\n");
    assert!(text(&told.stderr).contains("may be cut short"), "{}", text(&told.stderr));
    let head = shell(&dir, "lme-mpm run dyka --out q | head -n 1");
    assert_eq!(text(&head.stdout), "The Dyka and Ingel bar\n");
    assert_eq!(files(&dir.join("q")), whole);
}

/// No title breaks a picture: what XML does not allow is refused, and what it needs escaped is.
#[test]
fn titles_do_not_break_pictures() {
    let dir = directory("titles");
    for bad in ["\\uFFFE", "\\uFFFF", "\\u0000", "\\u0085", "\\u202E"] {
        let set = format!("title=\"a{bad}b\"");
        let output = program(&dir, &["run", "dyka", "--out", "o", "--set", &set]);
        assert_fails(&output, 2, &["title: it holds the character", "U+FFFE, U+FFFF"]);
    }
    let set = "title=\"</text><script>&\\uFFFD\\U0001FFFE\"";
    let output = program(&dir, &["run", "dyka", "--out", "o", "--set", set]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let parse = "import sys, xml.dom.minidom as m; m.parse(sys.argv[1])";
    let mut python = Command::new("python3");
    let python = python.args(["-c", parse, "o/velocity_end.svg"]).current_dir(&dir);
    let output = python.output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// A time step that is too large is shown where it was asked for: file, line and key.
#[test]
fn too_large_a_step_has_its_place() {
    let dir = directory("too-large");
    let dyka = fs::read_to_string(DYKA).unwrap();
    let by = |key: &str| dyka.replace("cfl = 0.5", key);
    fs::write(dir.join("cfl.toml"), by("cfl = 1.75")).unwrap();
    fs::write(dir.join("part.toml"), by("fraction_of_critical = 1.5")).unwrap();
    let both = by("cfl = 100\nfraction_of_critical = 1.5");
    fs::write(dir.join("both.toml"), both).unwrap();
    let line = dyka.lines().position(|line| line.starts_with("cfl = ")).unwrap() + 1;
    for (file, key, line) in [
        ("cfl.toml", "time.cfl", line),
        ("part.toml", "time.fraction_of_critical", line),
        ("both.toml", "time.fraction_of_critical", line + 1),
    ] {
        let place = format!("{file}:{line}:");
        let words = [&format!("{key}: the time step is too large")[..], &place, "allowed: "];
        assert_fails(&program(&dir, &["run", file]), 2, &words);
        assert_fails(&program(&dir, &["trace", file]), 2, &words);
    }
    let output = program(&dir, &["run", "dyka", "--set", "time.cfl=1.75"]);
    assert_fails(&output, 2, &["--set time.cfl=1.75:1:10", "too large", "a smaller time.cfl"]);
}

/// A pipe gets the figures that matter, at most eight, or with `--all` the whole summary; a
/// terminal gets the first probe before them. The file has them all.
#[test]
fn a_run_shows_what_matters() {
    let dir = directory("shown");
    let piped = text(&program(&dir, &["run", "dyka", "--out", "o"]).stdout);
    assert_eq!(piped.lines().count(), 1 + 1 + 8 + 1, "{piped}");
    for name in ["velocity end rms relative", "energy growth largest", "particle node pairs"] {
        assert!(piped.contains(name), "{piped}");
    }
    let all = text(&program(&dir, &["run", "dyka", "--out", "o", "--all"]).stdout);
    let count = |file: &str| fs::read_to_string(dir.join(file)).unwrap().lines().count() - 1;
    let lines = count("o/summary.csv") + count("o/cost.csv");
    assert_eq!(all.lines().count(), 1 + 1 + lines + 1, "{all}");
    assert!(lines > 30);
    let shown = on_terminal(&dir, &["run", "dyka", "--out", "o"]);
    for word in ["computed (blue) over exact (grey)", "time t", "velocity end rms relative"] {
        assert!(shown.contains(word), "{shown}");
    }
    assert!(shown.chars().any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)), "no curve:\n{shown}");
    assert!(!piped.contains("computed (blue)"));
    // Without an exact solution the probe's peak stands for its error.
    let set = ["--set", "time.end=0.2"];
    let discs = program(&dir, &[&["run", "colliding-discs", "--out", "p"][..], &set].concat());
    let discs = text(&discs.stdout);
    assert!(discs.contains("velocity first peak") && !discs.contains("rms"), "{discs}");
    let both = program(&dir, &["run", "dyka", "--all", "--quiet"]);
    assert_fails(&both, 2, &["--all", "--quiet"]);
}

/// What `shape` cannot do it says in sentences.
#[test]
fn shape_refuses_in_sentences() {
    let dir = directory("shape-sentences");
    fs::write(dir.join("nodes.csv"), "x\n0\n1\n2\n").unwrap();
    let shape = |basis: &[&str], points: &str| {
        let files = ["--spacing", "1", "--nodes", "nodes.csv", "--points", "-"];
        program_with_input(&dir, &[&["shape", "--basis"][..], basis, &files].concat(), points)
    };
    let long = shape(&["ugimp", "--half-length", "0.7"], "x\n1\n");
    assert_fails(&long, 2, &["half a particle is 0.7 times as long as the spacing"]);
    let outside = shape(&["lme", "--gamma", "1"], "x\n1\n9\n");
    let words = ["-, line 3: point 1 stands outside the grid"];
    assert_fails(&outside, 2, &words);
    let outside = shape(&["linear"], "x\n9\n");
    assert_fails(&outside, 2, &["-, line 2: point 0 stands outside the grid"]);
}
