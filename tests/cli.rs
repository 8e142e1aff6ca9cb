//! The program as a user meets it: what every command prints and writes.

use crate::support::dyka;
use crate::support::program::*;
use std::fs;

/// Alone, it runs the built-in bar from any directory.
#[test]
fn alone_runs_the_bar() {
    let dir = directory("alone");
    let output = program(&dir, &[]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let stdout = text(&output.stdout);
    for word in ["The Dyka and Ingel bar", "velocity end rms", "energy growth", "out/dyka"] {
        assert!(stdout.contains(word), "{stdout}");
    }
    let expected = [
        "cost.csv",
        "history.csv",
        "particles.csv",
        "results.txt",
        "stress_three_quarter.svg",
        "summary.csv",
        "velocity_end.svg",
    ];
    assert_eq!(files(&dir.join("out/dyka")), expected);
}

/// The files of a run hold what they promise.
#[test]
fn run_writes_complete_files() {
    let dir = directory("run");
    let output = program(&dir, &["run", DYKA, "--out", "here", "--quiet"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty() && output.stderr.is_empty(), "--quiet is quiet");
    let read = |name: &str| fs::read_to_string(dir.join("here").join(name)).unwrap();
    let history = read("history.csv");
    assert!(history.starts_with(
        "step,t,kinetic_energy,strain_energy,momentum,velocity_end,velocity_end_exact,\
         stress_three_quarter,stress_three_quarter_exact\n0,0,"
    ));
    assert_eq!(history.lines().count(), 1 + 321);
    assert_eq!(read("particles.csv").lines().count(), 1 + 80);
    assert!(read("summary.csv").starts_with("quantity,value,unit\nvelocity_end_rms,0.82"));
    assert!(read("cost.csv").contains("particle_node_pairs,51360,1\n"));
    assert!(read("cost.csv").contains("bytes_per_particle,64,B\n"));
    let svg = read("velocity_end.svg");
    for word in ["<svg", "time t [µs]", "velocity nearest to 0.1333 m [m/s]", "exact", "computed"]
    {
        assert!(svg.contains(word), "`{word}` is not in the picture");
    }
    assert!(!history.contains("NaN") && !history.contains("inf"));
}

/// `--set` replaces, adds, reaches into lists and takes bare words.
#[test]
fn run_set_changes_the_scene() {
    let dir = directory("set");
    let sets = [
        "run",
        DYKA,
        "--out",
        "here",
        "--set",
        "grid.cells=20",
        "--set",
        "output.every=10",
        "--set",
        "time.reading=as-printed",
        "--set",
        "probe.0.name=tip",
        "--set",
        "title=Short",
    ];
    let output = program(&dir, &sets);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("Short"));
    let history = fs::read_to_string(dir.join("here/history.csv")).unwrap();
    assert_eq!(history.lines().count(), 1 + 17);
    assert!(history.contains(",tip,tip_exact,"));
}

/// `--set KEY=` takes a value out, or a whole table; one that is not there stays away, and
/// what is set later counts.
#[test]
fn run_set_takes_values_out() {
    assert_eq!(dyka(&["time.reading=as-printed", "time.reading="]), dyka(&[]));
    assert_eq!(dyka(&["traction.ramp=", "body_force="]), dyka(&[]));
    assert_eq!(dyka(&["boundary.left=", "boundary.left=fixed"]), dyka(&[]));
    let free = dyka(&["boundary.left=free"]);
    assert_ne!(free, dyka(&[]));
    assert_eq!(dyka(&["boundary.left="]), free);
    assert_eq!(dyka(&["boundary="]), free);
}

/// The free flight is free of stress, and keeps its velocity to the last bit.
#[test]
fn run_free_flight() {
    let dir = directory("flight");
    let output = program(&dir, &["run", FLIGHT]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let summary = fs::read_to_string(dir.join("out/free-flight/summary.csv")).unwrap();
    assert!(summary.contains("stress_middle_peak,0,Pa\n"), "{summary}");
    assert!(summary.contains("velocity_middle_rms,0,m/s\n"), "{summary}");
}

/// Two runs give the same bytes, but for the wall time, and the size of the summary that has it.
#[test]
fn run_is_repeatable() {
    let dir = directory("repeat");
    for out in ["one", "two"] {
        assert!(program(&dir, &["run", DYKA, "--out", out, "--quiet"]).status.success());
    }
    for name in files(&dir.join("one")) {
        let read = |out: &str| fs::read_to_string(dir.join(out).join(&name)).unwrap();
        let without_wall_time = |text: String| {
            text.lines()
                .filter(|line| !line.starts_with("wall_time") && !line.ends_with(" summary.csv"))
                .map(String::from)
                .collect::<Vec<_>>()
        };
        assert_eq!(without_wall_time(read("one")), without_wall_time(read("two")), "{name}");
    }
}

/// `exact` answers points in order, with shortest round-trip numbers.
#[test]
fn exact_from_standard_input_and_from_a_file() {
    let dir = directory("exact");
    let points = "x,t\n0.1333,1e-6\n0,2e-5\n0.05,0\n";
    let piped = program_with_input(&dir, &["exact", DYKA, "--points", "-"], points);
    assert!(piped.status.success(), "{}", text(&piped.stderr));
    let answer = text(&piped.stdout);
    let lines: Vec<&str> = answer.lines().collect();
    assert_eq!(lines[0], "x,t,velocity,stress,displacement");
    assert!(lines[1].starts_with("0.1333,1e-6,5,0,"), "{answer}");
    assert_eq!(lines[2], "0,0.00002,0,197901490.64623034,0".replace("0.00002", "2e-5"));
    assert_eq!(lines[3], "0.05,0,0,0,0");
    fs::write(dir.join("points.csv"), points).unwrap();
    let file = program(&dir, &["exact", DYKA, "--points", "points.csv"]);
    assert_eq!(text(&file.stdout), answer);
}

/// `shape` prints N and its gradient by point and node; the order of the nodes
/// in the file does not matter but for their numbers.
#[test]
fn shape_prints_values() {
    let dir = directory("shape");
    fs::write(dir.join("nodes.csv"), "x\n0.75\n0\n0.5\n0.25\n1\n").unwrap();
    let shape = |basis: &[&str]| {
        let files = ["--spacing", "0.25", "--nodes", "nodes.csv", "--points", "-"];
        let arguments = [&["shape", "--basis"][..], basis, &files].concat();
        let output = program_with_input(&dir, &arguments, "x\n0.3125\n0.5\n");
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let linear = "point,node,N,dN_dx\n0,3,0.75,-4\n0,2,0.25,4\n1,2,1,-4\n1,0,0,4\n";
    assert_eq!(shape(&["linear"]), linear);
    let ugimp = "point,node,N,dN_dx\n0,3,0.75,-4\n0,2,0.25,4\n\
                 1,3,0.0625,-2\n1,2,0.875,0\n1,0,0.0625,2\n";
    let computed = shape(&["ugimp", "--half-length", "0.0625"]);
    assert_eq!(computed, ugimp);
    let bspline = "point,node,N,dN_dx\n0,1,0.03125,-1\n0,3,0.6875,-2\n0,2,0.28125,3\n\
                   1,3,0.125,-2\n1,2,0.75,0\n1,0,0.125,2\n";
    assert_eq!(shape(&["bspline"]), bspline);
    // Far on the side of finite elements local max-ent is the linear basis.
    assert_eq!(
        shape(&["lme", "--gamma", "800", "--cutoff", "0"]).lines().nth(1),
        Some("0,3,0.75,-4")
    );
    assert_eq!(shape(&["lme", "--gamma", "0.8"]).lines().count(), 1 + 5 + 5);
}

/// Every `--help` shows an example.
#[test]
fn help_shows_examples() {
    let dir = directory("help");
    for command in ["--help", "run", "exact", "shape", "scenes", "completions"] {
        let output = program(&dir, &[command, "--help"]);
        assert!(output.status.success());
        let stdout = text(&output.stdout);
        assert!(stdout.contains("Example:\n  "), "{stdout}");
    }
}

/// A directory does not mix two runs, even of other probes.
#[test]
fn run_replaces_an_earlier_run() {
    let dir = directory("mixed");
    let run =
        |sets: &[&str]| program(&dir, &[&["run", DYKA, "--out", "o", "-q"][..], sets].concat());
    assert!(run(&[]).status.success());
    assert!(run(&["--set", "probe.0.name=tip"]).status.success());
    let expected = [
        "cost.csv",
        "history.csv",
        "particles.csv",
        "results.txt",
        "stress_three_quarter.svg",
        "summary.csv",
        "tip.svg",
    ];
    assert_eq!(files(&dir.join("o")), expected);
    assert_eq!(run(&["--set", "time.cfl=2", "--set", "probe=[]"]).status.code(), Some(2));
    assert_eq!(files(&dir.join("o")), expected, "refused before anything was written");
    let grow = ["--set", "time.cfl=2", "--set", "probe=[]", "--set", "time.allow_unstable=true"];
    assert_eq!(run(&grow).status.code(), Some(1));
    assert_eq!(files(&dir.join("o")), ["history.failed.csv", "results.txt"]);
}

/// 2D writes its picture and, asked for it, the series for ParaView, which a reader
/// opens; a later run in the same place leaves no old frame.
#[test]
fn discs_write_pictures_and_frames() {
    let dir = directory("discs");
    let discs = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/colliding-discs.toml");
    let run = |sets: &[&str]| {
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
        let output = program(&dir, &[&["run", discs, "--out", "out"][..], &sets].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        files(&dir.join("out"))
    };
    let names = run(&["time.end=0.2", "output.vtk=true", "output.every=5"]);
    let frames = names.iter().filter(|name| name.ends_with(".vtu")).count();
    assert_eq!(frames, 6, "{names:?}"); // steps 0, 5, 10, 15, 20 and the last, 24
    assert!(names.contains(&"particles.pvd".into()) && names.contains(&"particles.svg".into()));
    let pvd = fs::read_to_string(dir.join("out/particles.pvd")).unwrap();
    assert_eq!(pvd.matches("<DataSet timestep=").count(), frames);
    let path = dir.join("out/particles_000003.vtu");
    let vtk = vtkio::Vtk::import(&path).unwrap();
    let vtkio::model::DataSet::UnstructuredGrid { pieces, .. } = vtk.data else {
        panic!("an unstructured grid was written");
    };
    let piece = pieces[0].load_piece_data(None).unwrap();
    assert_eq!(piece.num_points(), 416);
    let vtkio::IOBuffer::F64(points) = &piece.points else { panic!("doubles were written") };
    // At 0.13 s the discs have flown, and the first particle with them.
    let csv = fs::read_to_string(dir.join("out/particles.csv")).unwrap();
    let first: f64 = csv.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!(points[0] < first && first - points[0] < 0.1 * 0.2, "{} and {first}", points[0]);
    let names = run(&["time.end=0.1"]);
    assert!(!names.iter().any(|name| name.starts_with("particles_")), "{names:?}");
}

/// The studies as commands: list, row, merge, recommend; and what they refuse.
#[test]
fn studies_as_commands() {
    let dir = directory("studies");
    let vibration = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/vibration.toml");
    let output = program(&dir, &["trade", "--list", "--scene", vibration]);
    let list = text(&output.stdout);
    let first = list.lines().next().unwrap();
    assert!(
        first.starts_with("lme-mpm trade --scene '") && first.contains(" --row 'method=otm "),
        "{first}"
    );
    assert!(list.lines().count() > 100);
    let mut parts = Vec::new();
    for (n, basis) in ["linear", "bspline"].into_iter().enumerate() {
        let row = format!(
            "method=mpm mass=lumped basis.kind={basis} time.integrator=newmark grid.cells=8 \
             grid.particles_per_cell=2 time.cfl=0.5"
        );
        let output = program(&dir, &["trade", "--scene", vibration, "--row", &row]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let name = format!("{n}.csv");
        fs::write(dir.join(&name), &output.stdout).unwrap();
        parts.push(name);
    }
    let merge = ["trade", "--scene", vibration, "--out", "o", "--merge", &parts[0], &parts[1]];
    let output = program(&dir, &merge);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("The cheapest of 2 configurations"));
    let expected = ["cheapest.csv", "displacement.svg", "stress.svg", "trade.csv", "velocity.svg"];
    assert_eq!(files(&dir.join("o")), expected);
    // Refused by name.
    let output = program(&dir, &["trade", "--row", "method=mpm lumped"]);
    assert_fails(&output, 2, &["--row", "`lumped` is not KEY=VALUE", "as --list prints it"]);
    let output = program(&dir, &["trade", "--row", "method=mpm"]);
    assert_fails(&output, 2, &["basis.kind: this key is missing"]);
    let output = program(&dir, &["trade", "--merge", &parts[0], "--out", "p"]);
    assert_fails(&output, 2, &["0.csv, line 2", "another scene"]);
    let output = program(&dir, &["recommend", vibration, "--error", "0"]);
    assert_fails(&output, 2, &["--error", "above 0"]);
    let discs = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/colliding-discs.toml");
    let output = program(&dir, &["recommend", discs, "--error", "1%"]);
    assert_fails(&output, 2, &["no exact solution", "more than one dimension"]);
}

/// A study whose rows run one by one, each a command of `--list`, is the study: γ, all of its
/// 36 rows, the merged table byte for byte.
#[test]
fn studies_run_row_by_row() {
    let dir = directory("rows");
    let whole = program(&dir, &["gamma", "--out", "whole"]);
    assert!(whole.status.success(), "{}", text(&whole.stderr));
    let list = text(&program(&dir, &["gamma", "--list"]).stdout);
    let mut merge = vec!["gamma".to_string(), "--out".into(), "merged".into(), "--merge".into()];
    for (n, line) in list.lines().enumerate() {
        let row = line.strip_prefix("lme-mpm gamma --row '").unwrap().strip_suffix('\'').unwrap();
        let output = program(&dir, &["gamma", "--row", row]);
        assert!(output.status.success(), "{row}: {}", text(&output.stderr));
        fs::write(dir.join(format!("{n}.csv")), &output.stdout).unwrap();
        merge.push(format!("{n}.csv"));
    }
    assert_eq!(merge.len(), 4 + 36);
    let merge: Vec<&str> = merge.iter().map(String::as_str).collect();
    let output = program(&dir, &merge);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(files(&dir.join("merged")), files(&dir.join("whole")));
    for name in files(&dir.join("whole")) {
        let read = |folder: &str| fs::read(dir.join(folder).join(&name)).unwrap();
        assert!(read("merged") == read("whole"), "{name}");
    }
    // A row of the map of stability is found by its name, on any scene.
    let scene = ["stability", "--scene", "vibration"];
    let list = text(&program(&dir, &[&scene[..], &["--list"]].concat()).stdout);
    let row = list.lines().next().unwrap().split_once("--row '").unwrap().1.trim_end_matches('\'');
    let output = program(&dir, &[&scene[..], &["--row", row]].concat());
    let printed = text(&output.stdout);
    assert!(printed.starts_with("scene,method,") && printed.lines().count() == 2, "{printed}");
    fs::write(dir.join("map.csv"), &printed).unwrap();
    // Refused by name, and nothing written.
    let lines: Vec<String> =
        fs::read_to_string(dir.join("0.csv")).unwrap().lines().map(String::from).collect();
    fs::write(dir.join("cut.csv"), format!("{}\n{}", lines[0], &lines[1][..60])).unwrap();
    let scene = lines[1].split(',').next().unwrap();
    fs::write(dir.join("other.csv"), lines.join("\n").replace(scene, "0") + "\n").unwrap();
    fs::write(dir.join("none.csv"), format!("{}\n", lines[0])).unwrap();
    for (study, parts, words) in [
        (
            "gamma",
            &["0.csv", "1.csv"][..],
            &["--merge", "34 of 36 rows are missing, the first is `mpm lumped 0.8`"][..],
        ),
        ("gamma", &["0.csv", "0.csv"], &["0.csv, line 2", "a second time"]),
        ("gamma", &["cut.csv"], &["cut.csv, line 2", "not a whole row"]),
        ("gamma", &["other.csv"], &["other.csv, line 2", "another scene"]),
        ("gamma", &["none.csv"], &["none.csv, line 1", "there is no row"]),
        ("gamma", &["map.csv"], &["map.csv, line 1", "other columns"]),
        ("stability", &["map.csv"], &["map.csv, line 2", "another scene"]),
    ] {
        let arguments = [&[study, "--out", "bad", "--merge"], parts].concat();
        assert_fails(&program(&dir, &arguments), 2, words);
    }
    assert_fails(&program(&dir, &["gamma", "--row", "otm 7"]), 2, &["--row", "no row `otm 7`"]);
    assert!(!dir.join("bad").exists());
    fs::copy(dir.join("0.csv"), dir.join("gamma.csv")).unwrap();
    let output = program(&dir, &["gamma", "--out", ".", "--merge", "gamma.csv"]);
    assert_fails(&output, 2, &["gamma.csv"]);
}

/// `recommend` writes a scene that runs and keeps its promise.
#[test]
fn recommended_scene_reaches_the_error() {
    let dir = directory("recommend");
    let small = fs::read_to_string(DYKA).unwrap().replace("cells = 40", "cells = 8");
    fs::write(dir.join("small.toml"), small).unwrap();
    let ask = |error: &str| {
        let out = ["--out", "o", "--jobs", "2", "--quantity", "displacement"];
        program(&dir, &[&["recommend", "small.toml", "--error", error][..], &out].concat())
    };
    let output = ask("4%");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    assert!(printed.contains("For a displacement error of at most 4%"), "{printed}");
    for words in [
        "> cheapest ",
        " neighbours ",
        "beside it, the cheapest of each kind:\n fewest pairs ",
        "\n          mpm ",
        "\n          otm ",
        "\nfinite elements ",
        "grids of fewer than 4 cells are left out (one to a patch of initial velocity",
        "ready to run: lme-mpm run 'o/recommended.toml'",
    ] {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let robust = printed.contains("robust.toml");
    let written = files(&dir.join("o"));
    assert!(written.contains(&"neighbours.csv".to_string()), "{written:?}");
    assert_eq!(written.contains(&"robust.toml".to_string()), robust);
    let neighbours = fs::read_to_string(dir.join("o/neighbours.csv")).unwrap();
    assert!(neighbours.contains(",grid.cells=") && neighbours.lines().count() > 4, "{neighbours}");
    let output = program(&dir, &["run", "o/recommended.toml", "--out", "r"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let summary = fs::read_to_string(dir.join("r/summary.csv")).unwrap();
    let name = "displacement_field_rms_relative,";
    let line = summary.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(line.split(',').nth(1).unwrap().parse::<f64>().unwrap() <= 0.04, "{line}");
    let output = ask("0.00001%");
    assert_fails(&output, 2, &["no configuration measured", "displacement", "the best has"]);
    assert!(!files(&dir.join("o")).iter().any(|name| name.ends_with(".toml")));
}
