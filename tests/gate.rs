//! No number that is not finite leaves the program or enters it: every table goes through one
//! gate, and so does every log that is read back.

use crate::support::program::*;
use crate::support::{TRACTION, VIBRATION, finished, scene};
use lme_mpm::output::summary::Scales;
use lme_mpm::output::{summary, vtk};
use lme_mpm::run::Frame;
use lme_mpm::run::stability::Critical;
use lme_mpm::run::table::{Table, csv};
use lme_mpm::scene::DYKA as DYKA_SCENE;
use lme_mpm::scene::fault::Fault;
use std::fs;
use std::path::Path;

/// The writer of all tables refuses by column and row: a number, one of a list; not the words
/// of a problem.
#[test]
fn gate_of_all_tables() {
    let write = |cells: [&str; 3]| {
        csv(&["name", "x", "problem"], std::iter::once(cells.map(String::from).to_vec()))
    };
    for bad in ["NaN", "inf", "-inf", "1e999", "1 2 NaN"] {
        match write(["first", bad, ""]) {
            Err(Fault::NotFinite { quantity, value }) => {
                assert_eq!(quantity, "x where name is first");
                assert!(bad.ends_with(&value), "{value}");
            }
            other => panic!("{bad}: {other:?}"),
        }
    }
    assert_eq!(write(["first", "", "x is NaN"]).unwrap(), b"name,x,problem\nfirst,,x is NaN\n");
    assert_eq!(write(["infinite", "1e300", ""]).unwrap(), b"name,x,problem\ninfinite,1e300,\n");
    // Frames for ParaView are no text, and refused alike.
    let mut table = Table::new();
    table.put(|| "particle".into(), 7.0);
    table.put(|| "velocity_x".into(), f64::NEG_INFINITY);
    table.end_row();
    let fault = vtk::files(&[Frame { time: 0.0, particles: table }]).unwrap_err();
    assert!(fault.to_string().starts_with("velocity_x where particle is 7 is -inf"), "{fault}");
    assert_eq!(fault.exit_code(), 1);
    // Where there is no limit there is no line.
    let free = Critical { start: f64::INFINITY, over_offsets: None };
    assert_eq!(summary::limit_lines(&free, 1.0), []);
}

/// Scenes whose numbers overflow are refused by the name of the quantity, and leave nothing.
#[test]
fn gate_of_results() {
    let dir = directory("gate-results");
    let heavy = ["body.density=1e200", "body.youngs_modulus=1e200", "body.law=neo-hookean"];
    let slow = ["time.end=0.5332", "initial_velocity.0.velocity=1e-3"];
    let sets: Vec<&str> = heavy.iter().chain(&slow).flat_map(|set| ["--set", set]).collect();
    let output = program(&dir, &[&["run", "dyka", "--out", "heavy"][..], &sets].concat());
    assert_fails(&output, 1, &["stress_three_quarter_rms is inf", "no finite number"]);
    assert!(!dir.join("heavy").exists());
    // A bar as long as numbers go is refused by its length, so that its exact solution is none.
    let long = fs::read_to_string(DYKA).unwrap();
    let long = long
        .replace("length = 0.1333", "length = 1.75e308")
        .replace("density = 7833", "density = 1")
        .replace("youngs_modulus = 200e9", "youngs_modulus = 1")
        .replace("end = 1.05521074812570e-4", "end = 1e308")
        .replace("from = 0.099975", "from = 1e308")
        .replace("to = 0.1333", "to = 1.75e308");
    fs::write(dir.join("long.toml"), long).unwrap();
    let points = "x,t\n1.7e308,0\n1.7e308,1.7e308\n";
    let output = program_with_input(&dir, &["exact", "long.toml", "--points", "-"], points);
    assert_fails(&output, 2, &["body.length", "a wave takes"]);
    assert!(output.stdout.is_empty());
}

/// A cell that nothing holds has no limit: its row says so, with empty cells.
#[test]
fn gate_of_limits_that_are_none() {
    let dir = directory("gate-limits");
    let one = fs::read_to_string(DYKA).unwrap();
    let one = one
        .replace("cells = 40", "cells = 1")
        .replace("left = \"fixed\"", "left = \"free\"")
        .replace("from = 0.099975", "from = 0")
        .replace("particles_per_cell = 2", "particles_per_cell = 1");
    fs::write(dir.join("one.toml"), one).unwrap();
    let output = program(&dir, &["stability", "--scene", "one.toml", "--out", "o", "--jobs", "2"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = fs::read_to_string(dir.join("o/stability.csv")).unwrap();
    for reason in ["nothing strains this body", "no step up to a thousand times"] {
        let row = table.lines().find(|line| line.contains(reason)).unwrap();
        assert!(row.contains(&format!(",,,{reason}")), "{row}");
    }
    assert!(!table.contains("inf,") && !table.contains("NaN"));
}

/// Writes what `row` of a study prints, with one cell after the other replaced by what is no
/// number of a run, and merges it: each is refused by file, line and what is wrong.
fn edited(dir: &Path, study: &[&str], row: &str, cells: &[(&str, &[&str])]) {
    let output = program(dir, &[study, &["--row", row]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    let lines: Vec<&str> = printed.lines().collect();
    let header: Vec<&str> = lines[0].split(',').collect();
    for (column, values) in cells {
        let at = header.iter().position(|name| name == column).unwrap();
        for value in *values {
            let mut own: Vec<&str> = lines[1].split(',').collect();
            own[at] = value;
            let rest: String = lines[2..].iter().map(|line| format!("{line}\n")).collect();
            let edited = format!("{}\n{}\n{rest}", lines[0], own.join(","));
            fs::write(dir.join("edited.csv"), edited).unwrap();
            let merge = ["--merge", "edited.csv", "--out", "o"];
            let output = program(dir, &[study, &merge].concat());
            let finite = value.split(' ').all(|x| x.parse::<f64>().unwrap().is_finite());
            let words = if finite { "not a whole r" } else { "no finite number" };
            assert_fails(&output, 2, &["edited.csv, line 2", words]);
            assert!(!dir.join("o").exists(), "{study:?} {column} {value}");
        }
    }
}

/// Logs of every study that are merged pass the gate.
#[test]
fn gate_of_merged_logs() {
    let dir = directory("gate-logs");
    let all: &[&str] = &["NaN", "inf", "1e999", "-inf", "-1"];
    let none: &[&str] = &["NaN", "inf", "1e999"];
    let run = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark grid.cells=4 \
               grid.particles_per_cell=1 time.cfl=0.5";
    let count: &[&str] = &["NaN", "-1", "0.5", "1e999"];
    let cells = [
        ("velocity", all),
        ("displacement", all),
        ("particle_node_pairs", count),
        ("wall_time", all),
        ("pass", &["-1", "7", "NaN"]),
    ];
    edited(&dir, &["trade"], run, &cells);
    let cells = [("velocity", all), ("overshoot", none), ("critical_courant", all)];
    edited(&dir, &["gamma"], "mpm lumped 0.8", &cells);
    let stability = ["stability", "--scene", "vibration", "--jobs", "1"];
    let list = text(&program(&dir, &[&stability[..], &["--list"]].concat()).stdout);
    let name = |list: &str| {
        let line = list.lines().next().unwrap();
        line.split_once("--row '").unwrap().1.trim_end_matches('\'').to_string()
    };
    let cells = [("offset", none), ("predicted", all), ("measured", all)];
    edited(&dir, &stability, &name(&list), &cells);
    let list = text(&program(&dir, &["orders", "--list"]).stdout);
    let cells: [(&str, &[&str]); 3] = [
        ("velocity_errors", &["0.1 0.2 0.3 NaN", "0.1 -0.2 0.3 0.1", "0.1 0.2"]),
        ("sizes", &["1 0.5 inf 0.125", "-1 0.5 0.2 0.1"]),
        ("velocity_order", none),
    ];
    edited(&dir, &["orders"], &name(&list), &cells);
}

/// The log that a study goes on with is no other: a line that has its end is a run, or the study
/// stops there; only a last line that was cut short is made again.
#[test]
fn gate_of_a_log_to_go_on_with() {
    let dir = directory("gate-runs");
    let run = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark grid.cells=4 \
               grid.particles_per_cell=1 time.cfl=0.5";
    let log = text(&program(&dir, &["trade", "--row", run]).stdout);
    let time = log.trim_end().rsplit(',').next().unwrap();
    fs::create_dir_all(dir.join("o")).unwrap();
    for (value, words) in [
        ("NaN", "`NaN` of wall_time is no finite number"),
        ("1e999", "`1e999` of wall_time is no finite number"),
        ("-1", "this is not a whole run"),
        ("soon", "this is not a whole run"),
    ] {
        let edited = log.replace(time, value);
        fs::write(dir.join("o/runs.csv"), &edited).unwrap();
        let output = program(&dir, &["trade", "--out", "o"]);
        assert_fails(&output, 2, &["o/runs.csv, line 4", words, "finite numbers from 0 up"]);
        assert_eq!(fs::read_to_string(dir.join("o/runs.csv")).unwrap(), edited);
    }
}

/// Sizes that overflow whole numbers are refused as any that do not fit, with and without the
/// checks of a debug build.
#[test]
fn sizes_do_not_overflow() {
    let dir = directory("gate-sizes");
    let most = "9223372036854775807";
    let lists = |value: &str, n: usize| format!("[{}]", vec![value; n].join(","));
    let refuse = |scene: &str, sets: &[String], key: &str| {
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
        let output = program(&dir, &[&["run", scene, "--out", "o"][..], &sets].concat());
        assert_fails(&output, 2, &[key, "need", "GB"]);
    };
    let per_cell = |n: String| format!("grid.particles_per_cell={n}");
    refuse("dyka", &[format!("grid.cells={most}"), per_cell("4".into())], "grid.cells");
    let cells = format!("grid.cells={}", lists(most, 2));
    refuse("vortex", &[cells, per_cell(lists("64", 2))], "mass");
    for basis in ["linear", "lme"] {
        let gamma = format!("basis.gamma={}", if basis == "lme" { "0.8" } else { "" });
        let beyond = "grid.beyond.right=18446744073709551615".to_string();
        refuse("dyka", &[format!("basis.kind={basis}"), gamma, beyond], "grid.cells");
    }
    assert_eq!(files(&dir), [""; 0]);
}

/// Errors are relative to what acts: a throw or a mode, and loads beside it; no load leaves a
/// body without scales, and what nothing moves has none.
#[test]
fn summary_scales_by_what_acts() {
    let of = |text: &str, more: &str| Scales::of(&scene(&format!("{text}\n{more}"), &[]));
    let gravity = "[body_force]\nacceleration = 1000\n";
    let (thrown, loaded) = (of(DYKA_SCENE, ""), of(DYKA_SCENE, gravity));
    // b L/c of the bar is small beside its throw of 5 m/s, and the stress Z b L/c beside Z v/2.
    let c = (200e9_f64 / 7833.0).sqrt();
    let pulled = 1000.0 * 0.1333 / c;
    assert!((loaded.velocity - thrown.velocity - pulled).abs() < 1e-12);
    assert!(((loaded.stress - thrown.stress) / (7833.0 * c * pulled) - 1.0).abs() < 1e-9);
    let transit = pulled * 0.1333 / c;
    assert!(((loaded.displacement - thrown.displacement) / transit - 1.0).abs() < 1e-9);
    // Alone, loads give every scale; a traction by t/Z.
    let alone = of(TRACTION, "");
    assert!(alone.velocity > 0.0 && alone.stress > 0.0 && alone.displacement > 0.0);
    let (mode, pulled) = (of(VIBRATION, ""), of(VIBRATION, gravity));
    assert!(pulled.velocity > mode.velocity && pulled.stress > mode.stress);
    let still = DYKA_SCENE.replace("velocity = 5", "velocity = 0");
    assert_eq!(of(&still, ""), Scales { velocity: 0.0, stress: 0.0, displacement: 0.0 });
    let summary = |text: &str| {
        let scene = scene(text, &[]);
        summary::lines(&scene, &finished(&scene), 0.0)
    };
    let relative = |lines: &[summary::SummaryLine]| {
        lines.iter().filter(|line| line.quantity.ends_with("_relative")).count()
    };
    let loaded = summary(&format!("{still}\n{gravity}"));
    assert_eq!((relative(&summary(&still)), relative(&loaded)), (0, 5));
}
