//! The conformance kit in `data/conformance/`: made anew and compared, byte by byte.
//!
//! `KIT_UPDATE=1 cargo test --test conformance` writes it.

#![allow(non_snake_case)]

mod support;

use lme_mpm::basis::{Scratch, tabulate};
use lme_mpm::check::{self, Tolerance, compare};
use lme_mpm::continuum::law::{self, LinearElastic};
use lme_mpm::continuum::shape::Shape;
use lme_mpm::cost::Cost;
use lme_mpm::exact::Exact;
use lme_mpm::measure::rms;
use lme_mpm::model::Model;
use lme_mpm::scene::{DYKA, Scene};
use lme_mpm::study::stability::predicted;
use lme_mpm::trace::{self, Entry, hex};
use nalgebra::{Matrix2, Vector1};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::*;

/// The kit's own version: it changes when a number or a column does.
const VERSION: &str = "1.0.0";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/conformance")
}

/// A number as decimal and hexadecimal cells.
fn both(x: f64) -> String {
    format!("{},{}", lme_mpm::history::shortest(x), hex(x))
}

/// One file of the kit.
struct Piece {
    level: u8,
    name: &'static str,
    says: &'static str,
    /// `KEY=VALUE` in place of the bar's own values.
    scene: Vec<&'static str>,
    /// Tolerance class; see `tolerances` in the manifest.
    class: &'static str,
    text: String,
}

/// Every basis at points inside a cell, on nodes, beside them, near the end.
fn basis_values() -> String {
    let mut text = String::from("basis,x_over_h,node,N,N_hex,dN_dx_times_h,dN_dx_times_h_hex\n");
    for (name, sets) in BASES {
        let scene = dyka(&[sets, &["grid.cells=8", "body.length=8", "time.end=1"], BAR].concat());
        let model = Model::<1>::of(&scene);
        for x in [0.25, 0.5, 1.0, 2.75, 3.999, 4.0, 4.001, 6.5, 7.75, 8.0] {
            let (mut shape, mut scratch) = (Shape::blank(0), Scratch::default());
            let points = [Vector1::new(x)];
            let cost = &mut Cost::default();
            let table =
                tabulate(&mut shape, &mut scratch, cost, &model.basis, &model.grid, &points);
            if table.is_err() {
                continue; // uGIMP's particle would reach beyond the grid
            }
            for (I, N, grad) in shape.of(0) {
                writeln!(text, "{name},{x},{I},{},{}", both(N), both(grad[0])).unwrap();
            }
        }
    }
    text
}

/// The bar's regions and probes on a body of length 8.
const BAR: &[&str] = &["initial_velocity=[]", "probe=[]"];

fn law_values() -> String {
    let mut text = String::from("E,nu,eps_xx,eps_xy,eps_yy,symbol,value,value_hex\n");
    for (E, nu) in [(200e9, 0.0), (1000.0, 0.3), (7.0, -0.4)] {
        for [xx, xy, yy] in [[1e-3, 2e-4, -4e-4], [0.0, 0.1, 0.0], [-0.2, 0.0, 0.3]] {
            let d_eps = Matrix2::new(xx, xy, xy, yy);
            let law = LinearElastic::new(E, nu);
            let sigma = law.stress_increment(&d_eps);
            let rho = law::density(1.0, &d_eps).unwrap();
            for (symbol, value) in [
                ("d_sigma_xx", sigma[(0, 0)]),
                ("d_sigma_xy", sigma[(0, 1)]),
                ("d_sigma_yy", sigma[(1, 1)]),
                ("rho_over_rho_before", rho),
                ("energy_density_of_d_sigma", law.energy_density(&sigma)),
            ] {
                writeln!(text, "{E:e},{nu},{xx},{xy},{yy},{symbol},{}", both(value)).unwrap();
            }
        }
    }
    text
}

fn measure_values() -> String {
    let mut text = String::from("computed,exact,rms,rms_hex\n");
    for (a, b) in [
        (vec![3.0, 1.0], vec![0.0, 5.0]),
        (vec![1.0, -1.0], vec![0.0, 0.0]),
        (vec![0.1, 0.2, 0.4], vec![0.1, 0.25, 0.3]),
    ] {
        let value = rms(a.iter().copied().zip(b.iter().copied()));
        let list = |list: &[f64]| list.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        writeln!(text, "{},{},{}", list(&a), list(&b), both(value)).unwrap();
    }
    text
}

fn exact_values() -> String {
    let scene = dyka(&[]);
    let exact = Exact::of(&scene).unwrap();
    let mut text =
        String::from("x,t,velocity,velocity_hex,stress,stress_hex,displacement,displacement_hex\n");
    let transit = transit();
    for x in [0.0, 0.05, 0.099, 0.12, 0.1333] {
        for tau in [0.1, 0.3, 0.9, 1.6, 2.1, 2.9, 3.6, 3.9, 17.3] {
            let t = tau * transit;
            let f = exact.at(x, t);
            writeln!(
                text,
                "{x},{t:?},{},{},{}",
                both(f.velocity),
                both(f.stress),
                both(f.displacement)
            )
            .unwrap();
        }
    }
    text
}

/// A trace with one column more, the value in hexadecimal.
fn traced(sets: &[&str], steps: usize, keep: impl Fn(&Entry) -> bool) -> String {
    let entries = trace::trace(&dyka(sets), steps).unwrap();
    let kept: Vec<Entry> = entries.into_iter().filter(keep).collect();
    let decimal = String::from_utf8(trace::csv(&kept, false).unwrap()).unwrap();
    let mut lines = decimal.lines();
    let mut text = format!("{},hex\n", lines.next().unwrap());
    for (line, entry) in lines.zip(&kept) {
        writeln!(text, "{line},{}", hex(entry.value)).unwrap();
    }
    text
}

/// What the probes of the bar follow: its last particle, and the one nearest to 3L/4.
fn followed(entry: &Entry) -> bool {
    let last = |symbol: &str| entry.symbol == symbol && (entry.step == 9 || entry.step == 6);
    (last("v_p") && entry.index == 79) || (last("sigma_p") && entry.index == 59)
}

/// The errors of the two histories with a tenth of room on both sides.
fn bands(lme: &[&str]) -> String {
    let mut text = String::from("basis,quantity,error,lowest,highest\n");
    for (basis, sets) in [("linear", &[][..]), ("lme γ = 0.8", lme)] {
        let scene = dyka(sets);
        let outcome = finished(&scene);
        for quantity in ["velocity_end", "stress_three_quarter"] {
            let error = value(&scene, &outcome, &format!("{quantity}_rms_relative"));
            let (low, high) = (0.9 * error, 1.1 * error);
            writeln!(text, "{basis},{quantity},{error:.6},{low:.6},{high:.6}").unwrap();
        }
    }
    text
}

fn limits() -> String {
    let mut text = String::from("basis,mass,integrator,particles_per_cell,courant,courant_hex\n");
    for (basis, sets) in BASES {
        for mass in ["lumped", "consistent"] {
            for (scheme, more) in SCHEMES {
                let fixed = [format!("mass={mass}"), "grid.cells=8".to_string()];
                let fixed: Vec<&str> = fixed.iter().map(String::as_str).collect();
                let scene = dyka(&[sets, more, &fixed[..]].concat());
                let courant = scene.courant_number_of(predicted(&scene, 0.0).unwrap());
                // Six digits: it comes from an iteration.
                let rounded: f64 = format!("{courant:.5}").parse().unwrap();
                writeln!(text, "{basis},{mass},{scheme},2,{}", both(rounded)).unwrap();
            }
        }
    }
    text
}

fn orders() -> String {
    let mut text = String::from("basis,mass,quantity,lowest,highest\n");
    for (quantity, order) in [("velocity", 2.0), ("displacement", 2.0), ("stress", 1.0)] {
        for mass in ["lumped", "consistent"] {
            writeln!(text, "linear,{mass},{quantity},{},{}", order - 0.05, order + 0.05).unwrap();
        }
    }
    text
}

/// Scenes that must be refused, or must break down, with what the reason is about.
const MUST_FAIL: [(&str, &str, &str); 8] = [
    ("density = 7833", "density = -7833", "body.density"),
    ("cells = 40", "cells = 0", "grid.cells"),
    ("poisson_ratio = 0", "poisson_ratio = 0.5", "body.poisson_ratio"),
    ("kind = \"linear\"", "kind = \"lme\"\ngamma = 0", "basis.gamma"),
    ("cfl = 0.5", "cfl = nan", "time.cfl"),
    ("velocity = 5", "velocity = inf", "initial_velocity.velocity"),
    ("to = 0.1333", "to = 0.2", "initial_velocity.to"),
    ("velocity = 5", "velocity = -1e7", "a breakdown in the first steps"),
];

fn must_fail() -> String {
    let mut text = String::from("replace,by,must_name\n");
    for (from, to, names) in MUST_FAIL {
        writeln!(
            text,
            "{},{},{names}",
            from.replace('"', "'"),
            to.replace('"', "'").replace('\n', " / ")
        )
        .unwrap();
    }
    text
}

fn kit() -> Vec<Piece> {
    let small = "grid.cells=4";
    let piece = |level, name, says, scene: &[&'static str], class, text| Piece {
        level,
        name,
        says,
        scene: scene.to_vec(),
        class,
        text,
    };
    let mut kit = vec![
        piece(
            0,
            "basis.csv",
            "shape functions on a bar of 8 cells with one cell beyond its free end",
            &[],
            "kernel",
            basis_values(),
        ),
        piece(0, "law.csv", "elastic law and density in plane strain", &[], "kernel", law_values()),
        piece(0, "measure.csv", "root mean square (39)", &[], "kernel", measure_values()),
        piece(0, "exact.csv", "the exact bar by Riemann invariants", &[], "kernel", exact_values()),
    ];
    let lme: &[&'static str] = &["basis.kind=lme", "basis.gamma=0.8"];
    for (name, ten, says, sets) in [
        ("linear_1.csv", "linear_10.csv", "linear basis", &[][..]),
        ("lme_1.csv", "lme_10.csv", "local max-ent, γ = 0.8", lme),
    ] {
        let scene = [sets, &[small]].concat();
        kit.push(piece(1, name, says, &scene, "step", traced(&scene, 1, |_| true)));
        kit.push(piece(2, ten, says, &scene, "steps", traced(&scene, 10, |e| e.k > 1)));
    }
    for (name, says, sets) in [
        ("as_printed_3.csv", "step 8 as printed", &["time.reading=as-printed"][..]),
        ("stress_first_3.csv", "forward Euler, stress first", SCHEMES[2].1),
        ("stress_last_3.csv", "forward Euler, stress last", SCHEMES[3].1),
        ("modified_last_3.csv", "forward Euler, stress modified-last", SCHEMES[4].1),
        (
            "cutoff_3.csv",
            "local max-ent cut off at one percent",
            &["basis.kind=lme", "basis.gamma=0.8", "basis.cutoff=0.01"],
        ),
    ] {
        let scene = [sets, &[small]].concat();
        kit.push(piece(2, name, says, &scene, "steps", traced(&scene, 3, |e| e.k > 0)));
    }
    kit.push(piece(
        3,
        "linear_history.csv",
        "velocity at L and stress at 3L/4 over 4 L/c, 40 cells",
        &[],
        "history",
        traced(&[], 320, followed),
    ));
    kit.push(piece(
        3,
        "lme_history.csv",
        "the same, local max-ent, γ = 0.8",
        lme,
        "history",
        traced(lme, 320, followed),
    ));
    kit.push(piece(
        3,
        "bands.csv",
        "relative errors of the two histories against the exact solution, between",
        &[],
        "order",
        bands(lme),
    ));
    kit.push(piece(
        4,
        "limits.csv",
        "largest stable c Δt / h, 8 cells",
        &["grid.cells=8"],
        "limit",
        limits(),
    ));
    kit.push(piece(
        4,
        "orders.csv",
        "order in h on the vibrating bar, between",
        &[],
        "order",
        orders(),
    ));
    kit.push(piece(
        5,
        "must_fail.csv",
        "changes of the bar's scene that must be refused by name",
        &[],
        "none",
        must_fail(),
    ));
    kit
}

/// Tolerance classes: relative, absolute (of the largest value), and why.
const CLASSES: [(&str, f64, f64, &str); 7] = [
    (
        "kernel",
        1e-12,
        1e-14,
        "one evaluation; λ of local max-ent may end one iteration earlier or later",
    ),
    ("step", 1e-11, 1e-13, "sums of a few terms in another order"),
    ("steps", 1e-10, 1e-12, "round-off of ten steps"),
    (
        "history",
        1e-6,
        1e-7,
        "round-off of some hundred steps, amplified by the jump of the cut-off",
    ),
    ("limit", 1e-4, 0.0, "an iteration for an eigenvalue"),
    ("order", 0.0, 0.0, "between the lowest and the highest that are given"),
    ("none", 0.0, 0.0, "no numbers"),
];

fn manifest(kit: &[Piece]) -> String {
    let quote = |text: &str| format!("\"{}\"", text.replace('"', "\\\""));
    let mut text = format!("{{\n  \"version\": \"{VERSION}\",\n  \"tolerances\": {{\n");
    for (n, (class, relative, absolute, why)) in CLASSES.iter().enumerate() {
        let comma = if n + 1 < CLASSES.len() { "," } else { "" };
        writeln!(
            text,
            "    {}: {{ \"relative\": {relative:e}, \"absolute\": {absolute:e}, \"reason\": {} }}{comma}",
            quote(class),
            quote(why)
        )
        .unwrap();
    }
    text += "  },\n  \"files\": [\n";
    for (n, piece) in kit.iter().enumerate() {
        let columns: Vec<String> =
            piece.text.lines().next().unwrap().split(',').map(quote).collect();
        let sets: Vec<String> = piece.scene.iter().map(|set| quote(set)).collect();
        let comma = if n + 1 < kit.len() { "," } else { "" };
        writeln!(
            text,
            "    {{\n      \"level\": {},\n      \"file\": {},\n      \"says\": {},\n      \
             \"scene\": [{}],\n      \"columns\": [{}],\n      \"rows\": {},\n      \
             \"tolerance\": {}\n    }}{comma}",
            piece.level,
            quote(&format!("level-{}/{}", piece.level, piece.name)),
            quote(piece.says),
            sets.join(", "),
            columns.join(", "),
            piece.text.lines().count() - 1,
            quote(piece.class)
        )
        .unwrap();
    }
    text + "  ]\n}\n"
}

/// The files of the kit are what this program makes; with `KIT_UPDATE` set it writes
/// them.
#[test]
fn conformance_kit_is_current() {
    let kit = kit();
    let mut files: BTreeMap<PathBuf, String> = BTreeMap::new();
    for piece in &kit {
        let path = folder().join(format!("level-{}", piece.level)).join(piece.name);
        assert!(files.insert(path, piece.text.clone()).is_none());
        assert!(CLASSES.iter().any(|class| class.0 == piece.class));
    }
    files.insert(folder().join("manifest.json"), manifest(&kit));
    for (path, text) in &files {
        if std::env::var_os("KIT_UPDATE").is_some() {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let found = fs::read_to_string(path).unwrap_or_default();
        assert_eq!(&found, text, "{} is not current: KIT_UPDATE=1 writes it", path.display());
    }
    // Nothing else lies there but what is written by hand.
    for level in 0..=5 {
        for entry in fs::read_dir(folder().join(format!("level-{level}"))).unwrap() {
            let path = entry.unwrap().path();
            assert!(files.contains_key(&path), "{} belongs to nothing", path.display());
        }
    }
}

/// The manifest has what its schema requires, and nothing else.
#[test]
fn conformance_manifest_keeps_its_form() {
    let text = fs::read_to_string(folder().join("manifest.json")).unwrap();
    let script = "import json, sys; m = json.load(open(sys.argv[1])); \
                  s = json.load(open(sys.argv[2])); \
                  assert set(m) == set(s['required']); \
                  item = s['properties']['files']['items']; \
                  assert all(set(f) == set(item['required']) for f in m['files']); \
                  assert all(f['tolerance'] in m['tolerances'] for f in m['files']); \
                  print(len(m['files']))";
    let arguments = ["manifest.json", "manifest.schema.json"].map(|name| folder().join(name));
    let Ok(output) = Command::new("python3").args(["-c", script]).args(&arguments).output() else {
        assert!(std::env::var_os("CI").is_none(), "python3 is needed in CI");
        return;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let files = String::from_utf8_lossy(&output.stdout).trim().parse::<usize>().unwrap();
    assert_eq!(files, text.matches("\"level\":").count());
}

/// What must fail, fails, and says why.
#[test]
fn conformance_must_fail() {
    for (from, to, names) in MUST_FAIL {
        assert!(DYKA.contains(from), "{from}");
        let text = DYKA.replacen(from, to, 1);
        match Scene::parse("bad", "bad.toml", &text, &[]) {
            Err(error) => {
                let plain = error.key.replace("[0]", "");
                assert!(plain == names, "{to}: {plain}");
            }
            Ok(scene) => {
                let stopped = lme_mpm::run::run(&scene, &mut |_| {}).unwrap_err();
                assert!(names.contains("breakdown") && stopped.breakdown.moment().step < 5, "{to}");
            }
        }
    }
}

/// The demonstration port passes levels 1 to 3, each with the tolerance of its class.
#[test]
fn conformance_of_the_port() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/port/port.py");
    for piece in kit().iter().filter(|piece| {
        (1..=3).contains(&piece.level)
            && !piece.name.ends_with("_3.csv")
            && piece.name != "bands.csv"
    }) {
        let basis = if piece.name.starts_with("lme") { "0.8" } else { "linear" };
        let (cells, steps) = match piece.level {
            1 => ("4", "1"),
            2 => ("4", "10"),
            _ => ("40", "320"),
        };
        let arguments = [cells, "2", "0.5", steps, basis];
        let Ok(output) = Command::new("python3").arg(&file).args(arguments).output() else {
            assert!(std::env::var_os("CI").is_none(), "python3 is needed in CI");
            return;
        };
        let theirs = check::read("port.py", output.stdout.as_slice()).unwrap();
        let reference = check::read(piece.name, piece.text.as_bytes()).unwrap();
        // The reference is a part of what the port prints.
        let theirs = check::common(&reference, theirs);
        let class = CLASSES.iter().find(|class| class.0 == piece.class).unwrap();
        let tolerance = Tolerance { relative: class.1, absolute: class.2 };
        let report = compare(&reference, &theirs, tolerance).unwrap();
        assert!(report.divergence.is_none(), "{}: {}", piece.name, report.text());
        assert!(report.missing.is_empty(), "{}: {}", piece.name, report.text());
    }
}

/// What `tests/port/kernels.py` prints for a file of level 0, row by row.
fn kernels(what: &str, bug: &str) -> Option<Vec<Vec<f64>>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/port/kernels.py");
    let table = folder().join(format!("level-0/{what}.csv"));
    let output = Command::new("python3").arg(file).arg(what).arg(table).arg(bug).output().ok()?;
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let row = |line: &str| line.split(' ').map(|x| x.parse().unwrap()).collect();
    Some(text.lines().map(row).collect())
}

/// The largest difference of a port's kernels from level 0, relative to the largest
/// value of each column.
fn off_by(what: &str, columns: &[&str], bug: &str) -> Option<f64> {
    let theirs = kernels(what, bug)?;
    let text = fs::read_to_string(folder().join(format!("level-0/{what}.csv"))).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), theirs.len());
    let mut worst = 0.0_f64;
    for (n, column) in columns.iter().enumerate() {
        let at = header.iter().position(|name| name == *column).unwrap();
        let values: Vec<f64> = rows.iter().map(|row| row[at].parse().unwrap()).collect();
        let hex_at = header.iter().position(|name| name == format!("{column}_hex")).unwrap();
        let largest = values.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        for (row, value) in rows.iter().zip(&values).map(|(row, value)| (&row[hex_at], value)) {
            assert_eq!(trace::number(row), Some(*value), "hexadecimal and decimal differ");
        }
        for (value, row) in values.iter().zip(&theirs) {
            worst = worst.max((value - row[n]).abs() / largest);
        }
    }
    Some(worst)
}

/// The measure and the exact bar of the port pass level 0; without the square, or with
/// ends that give back half of a wave, they do not.
#[test]
fn conformance_of_the_kernels() {
    let exact = ["velocity", "stress", "displacement"];
    for (what, columns, bug) in
        [("measure", &["rms"][..], "missing-square"), ("exact", &exact, "half-reflection")]
    {
        let Some(right) = off_by(what, columns, "") else {
            assert!(std::env::var_os("CI").is_none(), "python3 is needed in CI");
            return;
        };
        assert!(right < 1e-12, "{what}: {right:e}");
        let wrong = off_by(what, columns, bug).unwrap();
        assert!(wrong > 0.1, "{bug} was not found: {wrong:e}");
    }
}
