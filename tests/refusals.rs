//! The program as a user meets it: every error by name, and nothing half-written.

use crate::support::program::*;
use std::fs;
use std::process::Command;

/// A bad scene: the bar with `from` replaced by `to`; the error names the
/// file, the line, and `words`; nothing is written.
fn assert_bad_scene(name: &str, from: &str, to: &str, words: &[&str]) {
    let dir = directory(&format!("bad-{name}"));
    let good = fs::read_to_string(DYKA).unwrap();
    assert!(good.contains(from), "`{from}` is not in the scene");
    let bad = good.replacen(from, to, 1);
    fs::write(dir.join("bad.toml"), &bad).unwrap();
    let output = program(&dir, &["run", "bad.toml", "--out", "out"]);
    assert_fails(&output, 2, words);
    assert_eq!(files(&dir), ["bad.toml"], "nothing may be written");
}

#[test]
fn bad_unknown_key() {
    let words =
        ["bad.toml:10:1", "body.densty", "not known", "youngs_modulus", "did you mean `density`?"];
    assert_bad_scene("key", "density = 7833", "densty = 7833", &words);
}

#[test]
fn bad_unknown_table() {
    let words = ["[bodi]", "did you mean `body`?"];
    assert_bad_scene("table", "[body]", "[bodi]", &words);
}

#[test]
fn bad_missing_key() {
    let words = ["bad.toml:14:1", "grid.cells", "missing", "whole number"];
    assert_bad_scene("missing", "cells = 40\n", "", &words);
}

#[test]
fn bad_type() {
    let words = ["bad.toml:10:11", "body.density", "string", "expected a number", "kg/m³"];
    assert_bad_scene("type", "density = 7833", "density = \"heavy\"", &words);
    let words = ["grid.cells", "floating point", "whole number from 1 up"];
    assert_bad_scene("float", "cells = 40", "cells = 40.5", &words);
}

#[test]
fn bad_syntax() {
    assert_bad_scene("syntax", "density = 7833", "density = = 7833", &["bad.toml:10:11"]);
    assert_bad_scene("empty", &fs::read_to_string(DYKA).unwrap(), "", &["title", "missing"]);
}

#[test]
fn bad_ranges() {
    let cases = [
        ("cells", "cells = 40", "cells = 0", &["grid.cells", "from 1 up"]),
        ("cells-negative", "cells = 40", "cells = -4", &["grid.cells", "from 1 up"]),
        ("density", "density = 7833", "density = -1", &["body.density", "above 0"]),
        (
            "nu",
            "poisson_ratio = 0",
            "poisson_ratio = 0.5",
            &["poisson_ratio", "above −1 and below 0.5"],
        ),
        (
            "nu-low",
            "poisson_ratio = 0",
            "poisson_ratio = -1",
            &["poisson_ratio", "above −1 and below 0.5"],
        ),
        ("nan", "density = 7833", "density = nan", &["body.density", "above 0"]),
        ("infinity", "length = 0.1333", "length = inf", &["body.length", "above 0"]),
        ("cfl", "cfl = 0.5", "cfl = 0", &["time.cfl", "above 0"]),
        ("end", "end = 1.0", "end = -1.0", &["time.end", "above 0"]),
        ("every", "every = 1", "every = 0", &["output.every", "from 1 up"]),
        (
            "beyond",
            "[basis]",
            "beyond = { right = -1 }\n\n[basis]",
            &["grid.beyond.right", "from 0 up"],
        ),
        ("probe", "position = 0.1333", "position = 0.2", &["probe[0].position", "of the body"]),
        ("region", "to = 0.1333", "to = 0.2", &["initial_velocity[0].to", "inside the body"]),
        ("axes", "length = 0.1333", "length = [1, 1, 1, 1]", &["body.length", "1 to 3"]),
        ("lists", "cells = 40", "cells = [40, 4]", &["grid.cells", "1 axis"]),
        ("memory", "cells = 40", "cells = 1000000000", &["grid.cells", "GB of memory"]),
        ("history", "cfl = 0.5", "cfl = 1e-6", &["time.end", "GB of memory"]),
        ("work", "cfl = 0.5", "cfl = 1e-8", &["particle-steps", "--max-time"]),
        ("name", "\"velocity_end\"", "\"a/b\"", &["probe[0].name", "a/b"]),
        ("twice", "\"velocity_end\"", "\"stress_three_quarter\"", &["probe[1].name", "taken"]),
        ("column", "\"velocity_end\"", "\"momentum\"", &["probe[0].name", "taken"]),
        ("spin", "velocity = 5", "velocity = 5\nspin = 1", &["initial_velocity[0].spin", "1 axis"]),
        ("nobody", "to = 0.1333", "to = 0.0999751", &["initial_velocity[0].to", "no particle"]),
        ("title", "The Dyka", "The\\u0001Dyka", &["title", "control character"]),
        (
            "heavy",
            "density = 7833\nyoungs_modulus = 200e9",
            "density = 1e300\nyoungs_modulus = 1e-300",
            &["body.youngs_modulus", "impedance"],
        ),
        ("side", "left = \"fixed\"", "top = \"fixed\"", &["boundary.top", "1 axis"]),
    ];
    for (name, from, to, words) in cases {
        assert_bad_scene(name, from, to, words);
    }
}

#[test]
fn bad_choices() {
    let cases = [
        ("method", "\"mpm\"", "\"mmp\"", &["method", "allowed: \"mpm\"", "did you mean `mpm`?"]),
        ("mass", "\"lumped\"", "\"lump\"", &["mass", "allowed: \"lumped\"", "mean `lumped`?"]),
        ("basis", "\"linear\"", "\"liner\"", &["basis.kind", "\"linear\"", "mean `linear`?"]),
        ("scheme", "\"newmark\"", "\"newmarc\"", &["time.integrator", "newmark", "did you mean"]),
        (
            "reading",
            "cfl = 0.5",
            "reading = \"second\"\ncfl = 0.5",
            &["time.reading", "as-printed", "did you"],
        ),
        ("fixed", "\"fixed\"", "\"fix\"", &["boundary.left", "\"free\"", "mean `fixed`?"]),
        ("probed", "\"velocity\"", "\"speed\"", &["probe[0].quantity", "\"stress\"", "allowed"]),
    ];
    for (name, from, to, words) in cases {
        assert_bad_scene(name, from, to, words);
    }
}

#[test]
fn bad_overlapping_regions() {
    let more = "velocity = 5\n\n[[initial_velocity]]\nfrom = 0\nto = 0.1\nvelocity = 1\n";
    assert_bad_scene("overlap", "velocity = 5\n", more, &["initial_velocity[1].from", "overlaps"]);
}

/// Errors in `--set` point at the argument.
#[test]
fn bad_set() {
    let dir = directory("bad-set");
    let cases = [
        ("grid.cell=4", &["--set grid.cell=4", "did you mean `cells`?"][..]),
        ("grid.cells=0", &["--set grid.cells=0", "from 1 up"]),
        ("grid.cells", &["--set grid.cells", "KEY=VALUE"]),
        ("", &["--set", "KEY=VALUE"]),
        ("[grid]", &["KEY=VALUE"]),
        ("output=[3]", &["--set output=[3]", "a table"]),
        ("body=3", &["--set body=3", "a table"]),
        ("probe.0=3", &["--set probe.0=3", "a table"]),
        ("time.end=1e10", &["--set time.end=1e10", "steps"]),
        ("probe.7.position=0", &["--set probe.7.position=0", "a number from 0 to 1"]),
        ("grid.cells=", &["grid.cells: this key is missing", "from 1 up"]),
        ("basis.gama=", &["--set basis.gama=", "did you mean `basis.gamma`?"]),
        (
            "probe.component=",
            &["--set probe.component=", "`component` is not an entry of this list"],
        ),
        ("=", &["--set =", "not known"]),
    ];
    for (set, words) in cases {
        assert_fails(&program(&dir, &["run", DYKA, "--set", set, "--out", "out"]), 2, words);
    }
    assert!(files(&dir).is_empty());
}

#[test]
fn bad_files() {
    let dir = directory("bad-files");
    let output = program(&dir, &["run", "nowhere.toml"]);
    assert_fails(&output, 2, &["cannot read nowhere.toml", "No such file"]);
    fs::write(dir.join("taken"), "a file, not a directory").unwrap();
    let output = program(&dir, &["run", DYKA, "--out", "taken/deeper"]);
    assert_fails(&output, 2, &["cannot write taken/deeper"]);
    fs::write(dir.join("binary.toml"), [0xff, 0xfe, 0x00]).unwrap();
    assert_fails(&program(&dir, &["run", "binary.toml"]), 2, &["cannot read binary.toml"]);
    assert_fails(&program(&dir, &["runn"]), 2, &["runn", "run"]);
}

/// A pipe that closes early is no error, a full disk is.
#[test]
fn output_that_cannot_be_written() {
    let dir = directory("full");
    let mut command = Command::new("sh");
    let line = format!("'{}' run '{DYKA}' --out o > /dev/full", env!("CARGO_BIN_EXE_lme-mpm"));
    let output = command.args(["-c", &line]).current_dir(&dir).output().unwrap();
    assert_fails(&output, 2, &["cannot write standard output"]);
    fs::create_dir_all(dir.join("taken/summary.csv")).unwrap();
    let output = program(&dir, &["run", DYKA, "--out", "taken"]);
    assert_fails(&output, 2, &["cannot replace taken", "summary.csv"]);
    assert_eq!(files(&dir.join("taken")), ["summary.csv"]);
}

#[test]
fn bad_points() {
    let dir = directory("bad-points");
    let cases = [
        ("x,time\n0,0\n", &["-, line 1", "columns x,t"][..]),
        ("x,t\n0,0\n0,abc\n", &["-, line 3", "`abc` is not a value of t"]),
        ("x,t\n0.2,0\n", &["-, line 2", "from 0 to 0.1333"]),
        ("x,t\n0,-1\n", &["-, line 2", "`-1` is not a value of t"]),
        ("x,t\n0,1e300\n", &["-, line 2", "`1e300` is not a value of t", "from 0 to "]),
        ("x,t\n0,NaN\n", &["-, line 2", "NaN"]),
        ("x,t\n0,0,0\n", &["-, line 2", "3 cells instead of 2"]),
        ("", &["-, line 1", "columns x,t"]),
    ];
    for (points, words) in cases {
        let output = program_with_input(&dir, &["exact", DYKA, "--points", "-"], points);
        assert_fails(&output, 2, words);
        assert!(output.stdout.is_empty(), "no half answer");
    }
    let output = program(&dir, &["exact", DYKA, "--points", "nowhere.csv"]);
    assert_fails(&output, 2, &["cannot read nowhere.csv"]);
}

#[test]
fn bad_basis_keys() {
    let cases = [
        (
            "no-gamma",
            "\"linear\"",
            "\"lme\"",
            &["basis.gamma", "needs this key", "1e-6 to 1e6"][..],
        ),
        ("gamma", "\"linear\"", "\"linear\"\ngamma = 1", &["basis.gamma", "means nothing"]),
        ("gamma-0", "\"linear\"", "\"lme\"\ngamma = 0", &["basis.gamma", "out of range"]),
        ("cut", "\"linear\"", "\"lme\"\ngamma = 1\ncutoff = 1", &["basis.cutoff", "below 1"]),
    ];
    for (name, from, to, words) in cases {
        assert_bad_scene(name, from, to, words);
    }
    // A support that covers everything must fit into memory, too.
    let dir = directory("bad-wide");
    let sets = "basis.kind=lme basis.gamma=1e-6 basis.cutoff=0 grid.cells=100000";
    let sets: Vec<&str> = sets.split(' ').flat_map(|set| ["--set", set]).collect();
    let output = program(&dir, &[&["run", DYKA][..], &sets].concat());
    assert_fails(&output, 2, &["grid.cells", "GB of memory"]);
}

/// Loads, modes, balls, masses and methods that do not fit the scene.
#[test]
fn bad_loads_and_motions() {
    let gravity = "\n[body_force]\nacceleration = 9.81\n";
    let cases: [(&str, String, &[&str]); 16] = [
        ("pull-fixed", "[traction]\nleft = 1e6\n".into(), &["traction.left", "0 where the side"]),
        ("pull-top", "[traction]\ntop = 1e6\n".into(), &["traction.top", "1 axis"]),
        ("pull-late", "[traction]\nright = 1\nramp = -1\n".into(), &["traction.ramp", "from 0 up"]),
        ("push-nan", gravity.replace("9.81", "nan"), &["body_force.acceleration", "m/s²"]),
        ("push-two", gravity.replace("9.81", "[1, 2]"), &["body_force.acceleration", "2 numbers"]),
        ("push-none", "[body_force]\nramp = 1\n".into(), &["body_force.acceleration", "missing"]),
        (
            "two-motions",
            "[vibration]\nmode = 1\nvelocity = 1\n".into(),
            &["initial_velocity", "`vibration`", "only one"],
        ),
        (
            "ball-1d",
            "[[body.ball]]\ncentre = 0.1\nradius = 0.01\n".into(),
            &["body.ball[0]", "1 axis"],
        ),
        ("vtk-1d", "vtk = true\n".into(), &["output.vtk", "nothing in 1D"]),
        (
            "mode-0",
            "[vibration]\nmode = 0\nvelocity = 1\n".into(),
            &["vibration.mode", "from 1 to"],
        ),
        (
            "mode-far",
            "[manufactured]\nmode = 1\namplitude = 0.1\n".into(),
            &["manufactured.amplitude", "|A| k < 1"],
        ),
        (
            "mode-pushed",
            format!("[manufactured]\nmode = 1\namplitude = 1e-3\n{gravity}"),
            &["body_force.acceleration", "brings its own"],
        ),
        ("mass-none", "mass".into(), &["mass", "\"consistent\""]),
        (
            "otm-euler",
            "otm-euler".into(),
            &["time.integrator", "central differences", "\"newmark\""],
        ),
        ("otm-ugimp", "otm-ugimp".into(), &["basis.kind", "moving nodes", "\"lme\""]),
        ("otm-gimp", "otm-gimp".into(), &["basis.kind", "moving nodes", "\"lme\""]),
    ];
    let good = fs::read_to_string(DYKA).unwrap();
    for (name, more, words) in cases {
        let dir = directory(&format!("bad-{name}"));
        let bad = match more.as_str() {
            "mass" => good.replace("\"lumped\"", "\"constant\""),
            "otm-euler" => {
                good.replace("\"mpm\"", "\"otm\"").replace("\"newmark\"", "\"corrected-euler\"")
            }
            "otm-ugimp" => good.replace("\"mpm\"", "\"otm\"").replace("\"linear\"", "\"ugimp\""),
            "otm-gimp" => good.replace("\"mpm\"", "\"otm\"").replace("\"linear\"", "\"gimp\""),
            // A scene with one motion keeps it; a mode takes its place.
            _ if more.contains("mode = ") && !name.starts_with("two") => {
                let start = good.find("[[initial_velocity]]").unwrap();
                let end = good.find("[[probe]]").unwrap();
                format!("{}{more}\n{}", &good[..start], &good[end..])
            }
            _ => format!("{good}{more}"),
        };
        fs::write(dir.join("bad.toml"), &bad).unwrap();
        let output = program(&dir, &["run", "bad.toml", "--out", "out"]);
        assert_fails(&output, 2, words);
        assert_fails(&output, 2, &["bad.toml:"]);
        assert_eq!(files(&dir), ["bad.toml"], "{name}: nothing may be written");
    }
}

/// Balls must lie in the box and hold a particle.
#[test]
fn bad_balls() {
    let dir = directory("bad-balls");
    let discs = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/colliding-discs.toml");
    for (set, words) in [
        ("body.ball.0.radius=0.3", &["body.ball[0].radius", "inside the body's box"][..]),
        ("body.ball.0.radius=0", &["body.ball[0].radius", "above 0"]),
        ("body.ball.0.radius=1e-3", &["body.ball[0].radius", "no particle"]),
        ("body.ball.1.centre=[2,2]", &["body.ball[1].centre", "a point of the body's box"]),
        ("traction={right=[1,0]}", &["traction.right", "no plane side"]),
    ] {
        let output = program(&dir, &["run", discs, "--set", set, "--out", "out"]);
        assert_fails(&output, 2, words);
    }
    assert!(files(&dir).is_empty());
}

/// A singular mass matrix ends the run by name.
#[test]
fn singular_mass_is_named() {
    let dir = directory("singular");
    let sets = "mass=consistent grid.particles_per_cell=1 boundary.left=free";
    let sets: Vec<&str> = sets.split(' ').flat_map(|set| ["--set", set]).collect();
    let output = program(&dir, &[&["run", DYKA, "--out", "out"][..], &sets].concat());
    assert_fails(&output, 1, &["singular", "step 0", "40 particles", "41 nodes", "lumped"]);
    assert_eq!(files(&dir.join("out")), ["history.failed.csv", "results.txt"]);
}

/// A time step above the predicted limit is refused before anything is written, and
/// the summary of a run says how far it is from that limit.
#[test]
fn unstable_step_is_refused() {
    let dir = directory("unstable");
    let output = program(&dir, &["run", DYKA, "--out", "o", "--set", "time.cfl=1.75"]);
    let words = ["c Δt / h is 1.7", "1.7321", "fraction_of_critical", "allow_unstable"];
    assert_fails(&output, 2, &words);
    assert!(files(&dir).is_empty());
    let output = program(&dir, &["run", DYKA, "--out", "o", "--set", "time.cfl=1.73"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let summary = fs::read_to_string(dir.join("o/summary.csv")).unwrap();
    let line = summary.lines().find(|line| line.starts_with("fraction_of_critical,")).unwrap();
    let fraction: f64 = line.split(',').nth(1).unwrap().parse().unwrap();
    assert!((0.98..1.0).contains(&fraction), "{line}");
}

/// `shape` refuses what a basis cannot serve, with the line of the file.
#[test]
fn bad_shape_input() {
    let dir = directory("bad-shape");
    fs::write(dir.join("line.csv"), "x\n0\n0.1\n0.2\n0.3\n").unwrap();
    fs::write(dir.join("gap.csv"), "x\n0\n0.1\n0.3\n").unwrap();
    fs::write(dir.join("plane.csv"), "x,y\n0,0\n1,1\n2,2\n").unwrap();
    fs::write(dir.join("nan.csv"), "x\n0\nNaN\n").unwrap();
    let shape = |basis: &[&str], nodes: &str, points: &str| {
        let files = ["--spacing", "0.1", "--nodes", nodes, "--points", "-"];
        program_with_input(&dir, &[&["shape", "--basis"][..], basis, &files].concat(), points)
    };
    let lme = ["lme", "--gamma", "1"];
    let cases = [
        (shape(&["linear"], "line.csv", "x\n0.5\n"), &["-, line 2", "point 0", "inside"][..]),
        (shape(&lme, "line.csv", "x\n0.1\n0.5\n"), &["-, line 3", "point 1", "outside the grid"]),
        (shape(&lme, "gap.csv", "x\n0.5\n"), &["-, line 2", "point 0", "convex hull"]),
        (shape(&["linear"], "gap.csv", "x\n0\n"), &["gap.csv", "do not fill a box"]),
        (shape(&lme, "plane.csv", "x,y\n0.5,0.5\n"), &["-, line 2", "convex hull"]),
        (shape(&lme, "plane.csv", "x\n0.5\n"), &["1 coordinates", "2, as the nodes"]),
        (shape(&lme, "nan.csv", "x\n0\n"), &["nan.csv, line 3", "`NaN`", "finite"]),
        (shape(&lme, "line.csv", "x,y,z,w\n"), &["-, line 1", "x or x,y or x,y,z"]),
        (shape(&["lme"], "line.csv", "x\n0\n"), &["--gamma"]),
        (shape(&["linear", "--gamma", "1"], "line.csv", "x\n0\n"), &["--gamma", "lme only"]),
        (shape(&["linear", "--support", "ball"], "line.csv", "x\n0\n"), &["--support", "lme only"]),
        (
            shape(&["lme", "--gamma", "1", "--support", "box"], "gap.csv", "x\n0\n"),
            &["gap.csv", "do not fill a box", "where --support is not box"],
        ),
        (shape(&["bspline", "--cutoff", "0"], "line.csv", "x\n0\n"), &["--cutoff", "lme only"]),
        (
            shape(&["lme", "--gamma", "1", "--half-length", "0.02"], "line.csv", "x\n0\n"),
            &["--half-length", "ugimp and gimp only"],
        ),
        (shape(&["lme", "--gamma", "-1"], "line.csv", "x\n0\n"), &["above 0"]),
        (shape(&["lme", "--gamma", "1e-310"], "line.csv", "x\n0\n"), &["at least 1e-307"]),
        (shape(&["ugimp", "--half-length", "0.06"], "line.csv", "x\n0\n"), &["--half-length"]),
        (shape(&["ugimp", "--half-length", "0.02"], "line.csv", "x\n0\n"), &["point 0"]),
        (shape(&["cubic"], "line.csv", "x\n0\n"), &["cubic", "bspline"]),
    ];
    for (output, words) in cases {
        assert_fails(&output, 2, words);
        assert!(output.stdout.is_empty(), "no half answer");
    }
}

#[test]
fn bad_scene_without_exact_solution() {
    let dir = directory("bad-exact");
    let scene = "title='b'\nmethod='mpm'\nmass='lumped'\nbasis.kind='linear'\n\
        body={length=[1,1],density=1,youngs_modulus=1,poisson_ratio=0}\n\
        grid={cells=[2,2],particles_per_cell=[1,1]}\n\
        time={integrator='newmark',cfl=0.5,end=1}\n";
    fs::write(dir.join("block.toml"), scene).unwrap();
    let output = program_with_input(&dir, &["exact", "block.toml", "--points", "-"], "x,t\n");
    assert_fails(&output, 2, &["no exact solution", "more than one dimension"]);
    // It runs all the same, and says nothing of an exact solution.
    let output = program(&dir, &["run", "block.toml"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(!text(&output.stdout).contains("exact"));
}

/// A Δt above the limit: step, time and particle, exit code 1, and the history
/// up to there under a name that says so, instead of an earlier run's files.
#[test]
fn breakdown_blows_up() {
    let dir = directory("blow-up");
    assert!(program(&dir, &["run", DYKA, "--out", "o", "--quiet"]).status.success());
    let sets = ["--set", "time.cfl=1.9", "--set", "time.allow_unstable=true"];
    let output = program(&dir, &[&["run", DYKA, "--out", "o"][..], &sets].concat());
    let words =
        ["at step ", "t = ", "check.energy", "particle ", "Courant number", "smaller time.cfl"];
    assert_fails(&output, 1, &words);
    assert_eq!(files(&dir.join("o")), ["history.failed.csv", "results.txt"]);
    let history = fs::read_to_string(dir.join("o/history.failed.csv")).unwrap();
    assert!(history.starts_with("step,t,") && history.lines().count() > 2);
    assert!(!history.contains("NaN") && !history.contains("inf"));
    // A good run takes the place of the failed one.
    assert!(program(&dir, &["run", DYKA, "--out", "o", "--quiet"]).status.success());
    assert!(!dir.join("o/history.failed.csv").exists());
}

/// A flight whose limit falls below its Δt as the particles move stops by name, with exit
/// code 1, and leaves nothing but the history up to there; with `time.watch = 0` nothing
/// looks.
#[test]
fn breakdown_beyond_the_limit() {
    let dir = directory("beyond-the-limit");
    let sets = "--set time.cfl=1.6 --set time.end=1 --set grid.particles_per_cell=1 \
                --set initial_velocity.0.velocity=0.3";
    let sets: Vec<&str> = sets.split_whitespace().collect();
    let output = program(&dir, &[&["run", FLIGHT, "--out", "o"][..], &sets].concat());
    let words = ["at step ", "t = ", "particle ", "beyond its limit", "time.fraction_of_critical"];
    assert_fails(&output, 1, &words);
    assert_eq!(files(&dir.join("o")), ["history.failed.csv", "results.txt"]);
    let off = ["--set", "time.watch=0"];
    let output = program(&dir, &[&["run", FLIGHT, "--out", "o"][..], &sets, &off].concat());
    assert_fails(&output, 1, &["check.energy"]);
}

/// Recorded seldom, the blow-up is still caught, by the particle.
#[test]
fn breakdown_between_records() {
    let dir = directory("blow-up-between");
    let sets = "--set time.cfl=1.9 --set output.every=1000000 --set time.allow_unstable=true";
    let sets: Vec<&str> = sets.split(' ').collect();
    let output = program(&dir, &[&["run", DYKA, "--out", "o"][..], &sets].concat());
    assert_fails(&output, 1, &["particle ", "at step ", "t = ", "Courant number"]);
}

#[test]
fn breakdown_leaves_the_grid() {
    let dir = directory("leaves");
    let output = program(&dir, &["run", FLIGHT, "--out", "o", "--set", "time.end=0.5"]);
    let words =
        ["at step ", "t = ", "particle 19 left the grid: ", "grid.beyond", "history.failed.csv"];
    assert_fails(&output, 1, &words);
}

/// Traces and comparisons that make no sense are refused before anything is written.
#[test]
fn bad_traces() {
    let dir = directory("bad-traces");
    let mine = dir.join("mine.toml");
    fs::copy(DYKA, &mine).unwrap();
    let before = fs::read(&mine).unwrap();
    let run = |arguments: &[&str]| program(&dir, arguments);
    let trace = |more: &[&str]| run(&[&["trace", "mine.toml"], more].concat());
    for (arguments, words) in [
        (&["--out", "mine.toml"][..], "is the scene itself"),
        (&["--out", "."], "is a directory"),
        (&["--out", "/dev/null"], "not a regular file"),
        (&["--steps", "321"], "the scene has 320"),
        (&["--steps", "320", "--set", "grid.cells=40000", "--set", "time.cfl=500"], "30 million"),
        (&["--set", "time.cfl=1.75"], "time step is too large"),
    ] {
        assert_fails(&trace(arguments), 2, &[words]);
    }
    // Numbers that are none: of a node, of a particle.
    let loads = ["--steps", "0", "--set", "body_force.acceleration=1e308", "--out", "nan.csv"];
    assert_fails(&trace(&loads), 1, &["at step 0", "f_ext_I of node 0 is not a finite number"]);
    let light = ["body.density=1e-300", "body.youngs_modulus=1e-300", "traction.right=1e308"];
    let light: Vec<&str> = light.iter().flat_map(|set| ["--set", set]).collect();
    assert_fails(&trace(&[&["--steps", "0"], &light[..]].concat()), 1, &["a_p of particle 76"]);
    assert_eq!(files(&dir), ["mine.toml"]);
    assert_eq!(fs::read(&mine).unwrap(), before);

    let written = trace(&["--out", "ref.csv", "--set", "grid.cells=4"]);
    assert!(written.status.success(), "{}", text(&written.stderr));
    for (arguments, words) in [
        (&["ref.csv", "ref.csv", "--rtol", "nan"][..], "a number from 0 up to and below 1"),
        (&["ref.csv", "ref.csv", "--atol=-1"], "a number from 0 up to and below 1"),
        (&["-", "-"], "standard input cannot be both"),
        (&["ref.csv", "."], "cannot read ."),
        (&["ref.csv", "mine.toml"], "mine.toml, line"),
        (&["ref.csv", "none.csv"], "cannot read none.csv"),
    ] {
        assert_fails(&run(&[&["check"], arguments].concat()), 2, &[words]);
    }
    let mut port = fs::read_to_string(dir.join("ref.csv")).unwrap();
    port += "1,9,v_p,99,,0,1\n";
    let line = format!("port.csv, line {}: there is v_p of k = 1", port.lines().count());
    fs::write(dir.join("port.csv"), &port).unwrap();
    assert_fails(&run(&["check", "ref.csv", "port.csv"]), 2, &[&line]);
    // A difference: 1, on standard error, with the line.
    let port = port.replace("\n0,9,v_p,0,,0,0\n", "\n0,9,v_p,0,,0,2\n");
    fs::write(dir.join("port.csv"), &port).unwrap();
    let at = port.lines().position(|line| line == "0,9,v_p,0,,0,2").unwrap() + 1;
    let words = ["first difference: k = 0, step 9", &format!("2.0 in line {at}")];
    assert_fails(&run(&["check", "ref.csv", "port.csv"]), 1, &words);
}

/// No command writes over what it reads: a scene among the results, a log among the tables.
#[test]
fn inputs_are_not_overwritten() {
    let dir = directory("inputs");
    for (name, arguments) in [
        (
            "recommended.toml",
            &["recommend", "recommended.toml", "--error", "30%", "--out", "."][..],
        ),
        ("trade.csv", &["trade", "--merge", "trade.csv", "--out", "."]),
    ] {
        fs::copy(DYKA, dir.join(name)).unwrap();
        let output = program(&dir, arguments);
        assert_fails(&output, 2, &["would overwrite the input", name, "allowed: another folder"]);
        assert_eq!(fs::read(dir.join(name)).unwrap(), fs::read(DYKA).unwrap());
    }
    // A run replaces a whole directory, and a scene in it is none of its results.
    fs::create_dir(dir.join("mine")).unwrap();
    fs::copy(DYKA, dir.join("mine/history.csv")).unwrap();
    let output = program(&dir, &["run", "mine/history.csv", "--quiet", "--out", "mine"]);
    assert_fails(&output, 2, &["cannot replace mine", "history.csv"]);
    assert_eq!(fs::read(dir.join("mine/history.csv")).unwrap(), fs::read(DYKA).unwrap());
    assert_eq!(files(&dir), ["mine", "recommended.toml", "trade.csv"]);
}

/// Logs that are merged must be whole: no run, a line cut short, a number that is none are
/// named with their line, and no folder is made.
#[test]
fn merged_logs_are_whole() {
    let dir = directory("merged");
    let row = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark grid.cells=4 \
               grid.particles_per_cell=1 time.cfl=0.5";
    let log = text(&program(&dir, &["trade", "--row", row]).stdout);
    assert_eq!(log.lines().count(), 4, "{log}");
    let time = log.trim_end().rsplit(',').next().unwrap();
    for (bad, words) in [
        (String::new(), &["line 1", "there is no run"][..]),
        (format!("{}\n", log.lines().next().unwrap()), &["line 1", "there is no run"]),
        (log[..log.len() - 9].to_string(), &["line 4", "not a whole run"]),
        (log.replace(time, "nan"), &["line 4", "`nan` of wall_time is no finite number"]),
        (log.replace(time, "-1"), &["line 4", "not a whole run"]),
    ] {
        fs::write(dir.join("log.csv"), bad).unwrap();
        let merged = program(&dir, &["trade", "--merge", "log.csv", "--out", "out"]);
        assert_fails(&merged, 2, &[&["log.csv"], words].concat());
    }
    // The same row twice, in one log or in two; a log of another scene after one of this.
    let lines: Vec<&str> = log.lines().collect();
    let foreign = log.replace(lines[1].split(',').next().unwrap(), "0123456789abcdef");
    fs::write(dir.join("log.csv"), &log).unwrap();
    for (other, words) in [
        (log.clone(), &["other.csv, line 2", "a second time"][..]),
        (format!("{}\n{}\n", lines[0], lines[3]), &["other.csv, line 2", "a second time"]),
        (format!("{}\n{}\n", lines[0], lines[3].replace("cells=4", "cells=5")), &[]),
        (foreign, &["other.csv, line 2", "another scene"]),
        ("x,y\n1,2\n".to_string(), &["other.csv, line 1", "other columns"]),
    ] {
        fs::write(dir.join("other.csv"), other).unwrap();
        let arguments = ["trade", "--out", "out", "--merge", "log.csv", "other.csv"];
        let merged = program(&dir, &arguments);
        match words {
            [] => {
                assert!(merged.status.success(), "{}", text(&merged.stderr));
                fs::remove_dir_all(dir.join("out")).unwrap();
            }
            words => assert_fails(&merged, 2, words),
        }
    }
    fs::write(dir.join("log.csv"), format!("{log}{}\n", lines[2])).unwrap();
    let merged = program(&dir, &["trade", "--out", "out", "--merge", "log.csv"]);
    assert_fails(&merged, 2, &["log.csv, line 5", "a second time"]);
    assert_eq!(files(&dir), ["log.csv", "other.csv"]);
    let unmeasured = program(&dir, &["trade", "--list", "--scene", "colliding-discs"]);
    assert_fails(&unmeasured, 2, &["no exact solution"]);
}

/// `--set KEY=` takes a value out, also of an entry of a list, in both ways to count it.
#[test]
fn values_are_taken_out() {
    let parsed = |set: &str| scene_of(&[set]);
    assert_eq!(parsed("probe=").unwrap().probes.len(), 0);
    assert_eq!(parsed("grid.beyond=").unwrap(), scene_of(&[]).unwrap());
    for (set, words) in [
        ("probe[0].position=", "probe[0].position: this key is missing"),
        ("probe.0.position=", "probe[0].position: this key is missing"),
        ("probe[0]=", "one entry of a list cannot be taken out, only all: probe="),
        ("probe[9].name=", "`9` is not an entry of this list"),
        ("grid[0].cells=", "there is no list here"),
        ("title.x=", "this key is not known"),
        ("foo=", "this key is not known"),
    ] {
        let error = parsed(set).unwrap_err().to_string();
        assert!(error.contains(words), "{set}: {error}");
    }
    assert_eq!(parsed("probe[0].name=mine").unwrap(), parsed("probe.0.name=mine").unwrap());
}

/// The bar's scene with changes.
fn scene_of(
    sets: &[&str],
) -> Result<lme_mpm::scene::Scene, Box<lme_mpm::scene::fault::SceneError>> {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    lme_mpm::run::parse("dyka", "dyka.toml", lme_mpm::scene::DYKA, &sets)
}
