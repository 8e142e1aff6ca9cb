//! The port in plain Python, `tests/port/port.py`: it passes levels 0 to 3 of the
//! conformance kit through `lme-mpm check`, and with one mistake it does not.
//!
//! Where there is no python3 nothing is checked; where CI runs, it must be there.

use crate::support::*;
use lme_mpm::port::check::{self, Report, Tolerance, compare};
use lme_mpm::port::trace::{self, Entry};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// What the port prints, `None` where there is no python3.
fn port(arguments: &[&str]) -> Option<Vec<u8>> {
    let file = root().join("tests/port/port.py");
    let Ok(output) = Command::new("python3").arg(file).args(arguments).output() else {
        assert!(std::env::var_os("CI").is_none(), "python3 is needed in CI");
        eprintln!("python3 is not there: the port was not checked");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(output.stdout)
}

/// A file of the kit with the port's arguments that answer it.
struct Answer {
    file: &'static str,
    arguments: &'static [&'static str],
}

const ANSWERS: [Answer; 16] = [
    answer("level-0/basis_linear.csv", &["basis", "FILE", "2", "8", "linear"]),
    answer("level-0/basis_lme_wide.csv", &["basis", "FILE", "2", "8", "0.8"]),
    answer("level-0/basis_lme_middle.csv", &["basis", "FILE", "2", "8", "1.8"]),
    answer("level-0/basis_lme_narrow.csv", &["basis", "FILE", "2", "8", "4"]),
    answer("level-0/law_1d.csv", &["law", "FILE"]),
    answer("level-0/law_2d.csv", &["law", "FILE"]),
    answer("level-0/measure.csv", &["measure", "FILE"]),
    answer("level-0/exact.csv", &["exact", "FILE"]),
    answer("level-1/linear_1.csv", &["trace", "4", "2", "0.5", "1", "linear"]),
    answer("level-1/lme_1.csv", &["trace", "4", "2", "0.5", "1", "0.8"]),
    answer("level-1/modulus_1.csv", &["trace", "4", "2", "0.5", "1", "linear", "poisson=0.25"]),
    answer("level-2/on_node_3.csv", &FLIGHT),
    answer("level-2/linear_10.csv", &["trace", "4", "2", "0.5", "10", "linear"]),
    answer("level-2/lme_10.csv", &["trace", "4", "2", "0.5", "10", "0.8"]),
    answer("level-3/linear_history.csv", &["trace", "40", "2", "0.5", "320", "linear"]),
    answer("level-3/lme_history.csv", &["trace", "40", "2", "0.5", "320", "0.8"]),
];

/// The bar of `level-2/on_node_3.csv`.
const FLIGHT: [&str; 13] = [
    "trace",
    "4",
    "2",
    "0.5",
    "3",
    "linear",
    "length=4",
    "density=1",
    "modulus=1",
    "speed=0.25",
    "from=0",
    "end=2",
    "fixed=0",
];

const fn answer(file: &'static str, arguments: &'static [&'static str]) -> Answer {
    Answer { file, arguments }
}

/// Runs the port on a file of the kit, and `lme-mpm check` on what it prints, with the
/// tolerance that the manifest gives.
fn checked(file: &str, arguments: &[&str], bug: &str) -> Option<Output> {
    let path = kit::folder().join(file);
    let (bug, own) = (format!("bug={bug}"), path.to_str().unwrap());
    let mut arguments: Vec<&str> =
        arguments.iter().map(|a| if *a == "FILE" { own } else { a }).collect();
    arguments.push(&bug);
    let printed = program::text(&port(&arguments)?);
    let manifest = fs::read_to_string(kit::folder().join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    let files = manifest["files"].as_array().unwrap();
    let entry = files.iter().find(|entry| entry["file"] == file).unwrap();
    let class = &manifest["tolerances"][entry["tolerance"].as_str().unwrap()];
    // Of whole histories the kit has two particles.
    let part: &[&str] = if file.starts_with("level-3") { &["--part"] } else { &[] };
    let [rtol, atol] = ["relative", "absolute"].map(|kind| class[kind].to_string());
    let check = [&["check", own, "-", "--rtol", &rtol, "--atol", &atol], part].concat();
    Some(program::program_with_input(root(), &check, &printed))
}

/// The port passes levels 0 to 3: every number that the kit has and it prints, and what
/// is not compared is only what the kit gives.
#[test]
fn port_passes_the_kit() {
    const GIVEN: [&str; 8] = ["E", "nu", "d_eps_p", "phi", "phi_exact", "x", "t", "x_p"];
    for Answer { file, arguments } in ANSWERS {
        let Some(output) = checked(file, arguments, "") else { return };
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{file}: {}", String::from_utf8_lossy(&output.stderr));
        let (agree, rest) = said.split_once('\n').unwrap();
        let counts = agree.strip_suffix(" numbers agree").unwrap().split_once(" of ").unwrap();
        if file.starts_with("level-0") {
            let list = rest.trim_end().rsplit_once(": ").unwrap().1;
            for symbol in list.split(", ") {
                let symbol = symbol.split(' ').next().unwrap();
                assert!(GIVEN.contains(&symbol), "{file}: {said}");
            }
        } else {
            assert_eq!(counts.0, counts.1, "{file}");
            assert_eq!(rest.is_empty(), !file.starts_with("level-3"), "{file}: {said}");
        }
    }
}

/// The errors of the port's histories are within the bands of level 3, and its
/// alternative reading of step 8 is that of level 2.
#[test]
fn port_keeps_the_bands() {
    let bands = fs::read_to_string(kit::folder().join("level-3/bands.csv")).unwrap();
    for (basis, name) in [("linear", "linear"), ("0.8", "lme γ = 0.8")] {
        let Some(printed) = port(&["errors", "40", "2", "0.5", "320", basis]) else { return };
        let printed = String::from_utf8(printed).unwrap();
        assert_eq!(printed.lines().count(), 2);
        for line in printed.lines() {
            let (quantity, error) = line.split_once(' ').unwrap();
            let start = format!("{name},{quantity},");
            let band = bands.lines().find(|line| line.starts_with(&start)).unwrap();
            let cells: Vec<f64> = band.split(',').skip(2).map(|x| x.parse().unwrap()).collect();
            let error: f64 = error.parse().unwrap();
            assert!(cells[1] < error && error < cells[2], "{band}: {error}");
            assert!((error - cells[0]).abs() < 1e-6, "{band}: {error}");
        }
    }
    let arguments = ["trace", "4", "2", "0.5", "3", "linear"];
    let Some(output) = checked("level-2/as_printed_3.csv", &arguments, "step-8-as-printed") else {
        return;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

const USUAL: Tolerance = Tolerance { relative: 1e-9, absolute: 1e-12 };

/// The port's trace against that of a scene.
fn held_against(sets: &[&str], arguments: &[&str]) -> Option<Report> {
    let printed = port(arguments)?;
    let theirs =
        check::read("port.py", printed.as_slice()).unwrap_or_else(|fault| panic!("{fault}"));
    let reference = trace::trace(&dyka(sets), arguments[4].parse().unwrap()).unwrap();
    Some(compare(&reference, &theirs, USUAL, false).unwrap())
}

/// Every intermediate of forty steps agrees, with the linear basis and with local
/// max-ent.
#[test]
fn port_agrees() {
    for (sets, basis) in [
        (&["grid.cells=8"][..], "linear"),
        (&["grid.cells=8", "basis.kind=lme", "basis.gamma=0.8"], "0.8"),
        (&["grid.cells=8", "basis.kind=lme", "basis.gamma=4"], "4"),
    ] {
        let arguments = ["trace", "8", "2", "0.5", "40", basis];
        let Some(report) = held_against(sets, &arguments) else { return };
        assert!(report.divergence.is_none(), "{basis}: {}", report.text());
        assert!(report.compared > 5000 && report.missing.is_empty(), "{}", report.text());
    }
}

/// The lowest level of the kit whose check a mistake does not pass, in `basis`.
fn lowest_level(bug: &str, basis: &str) -> String {
    let of_basis = |answer: &&Answer| {
        answer.arguments.contains(&basis)
            || ["law", "measure", "exact"].contains(&answer.arguments[0])
    };
    for Answer { file, arguments } in ANSWERS.iter().filter(of_basis) {
        let output = checked(file, arguments, bug).unwrap();
        if !output.status.success() {
            assert_eq!(output.status.code(), Some(1), "{file}");
            return file["level-".len()..].split('/').next().unwrap().to_string();
        }
    }
    panic!("{bug} passes the kit");
}

/// Ports with one mistake each: every one is found, in the step where it is made, and by
/// the kit.
#[test]
fn port_mistakes_are_found() {
    let mut table = String::from("mistake,level,found at k,step,symbol,likely cause as reported\n");
    let mut line = |bug: &str, level: &str, report: Report| {
        let Some(found) = report.divergence else { panic!("{bug} was not found") };
        let Entry { k, step, symbol, .. } = found.reference;
        let cause = found.cause.unwrap_or("–").replace(',', ";");
        writeln!(table, "{bug},{level},{k},{step},{symbol},{cause}").unwrap();
        (step, symbol)
    };
    let linear = &["grid.cells=6"][..];
    let wide = &["grid.cells=6", "basis.kind=lme", "basis.gamma=0.8"][..];
    let quarter = &["grid.cells=6", "body.poisson_ratio=0.25"][..];
    type Mistake<'a> = (&'a str, &'a str, &'a [&'a str], (usize, &'a str));
    let of_time_steps: [Mistake; 18] = [
        ("gradient-without-h", "linear", linear, (2, "grad_N_Ip")),
        ("node-off-by-one", "0.8", wide, (2, "N_Ip")),
        ("gamma-is-beta-over-h2", "0.8", wide, (2, "N_Ip")),
        ("cut-after-solving", "0.8", wide, (2, "N_Ip")),
        ("mass-of-the-whole-cell", "linear", linear, (3, "m_I")),
        ("fixed-node-moves", "0.8", wide, (4, "v_I")),
        ("modulus-is-E", "linear", quarter, (6, "sigma_p")),
        ("stress-of-this-step", "linear", linear, (6, "sigma_p")),
        ("density-before-strain", "linear", linear, (6, "rho_p")),
        ("old-stress", "linear", linear, (7, "f_int_I")),
        ("first-density", "linear", linear, (7, "f_int_I")),
        ("sign-of-force", "linear", linear, (7, "f_int_I")),
        ("force-on-fixed-node", "linear", linear, (7, "f_I")),
        ("step-8-as-printed", "linear", linear, (8, "p_I_advanced")),
        ("old-N-in-corrector", "linear", linear, (9, "v_p")),
        ("predictor-takes-mapped-momentum", "linear", linear, (1, "x_p")),
        ("whole-predictor", "linear", linear, (1, "v_p")),
        ("no-half-dt2", "linear", linear, (1, "x_p")),
    ];
    for (bug, basis, sets, expected) in of_time_steps {
        let argument = format!("bug={bug}");
        let poisson = if sets == quarter { "poisson=0.25" } else { "poisson=0" };
        let arguments = ["trace", "6", "2", "0.5", "20", basis, poisson, &argument];
        let Some(report) = held_against(sets, &arguments) else { return };
        assert_eq!(line(bug, &lowest_level(bug, basis), report), expected, "{bug}");
    }
    // Of kernels, in a file of level 0.
    for (bug, what, expected) in [
        ("plane-stress", "law_2d", (6, "sigma_p")),
        ("missing-square", "measure", (1, "rms")),
        ("half-reflection", "exact", (1, "v")),
    ] {
        let path = kit::folder().join(format!("level-0/{what}.csv"));
        let printed =
            port(&[what.split('_').next().unwrap(), path.to_str().unwrap(), &format!("bug={bug}")])
                .unwrap();
        let theirs = check::read("port.py", printed.as_slice()).unwrap();
        let reference = check::read(what, fs::File::open(path).unwrap()).unwrap();
        let report = compare(&reference.entries, &theirs, USUAL, false).unwrap();
        assert_eq!(line(bug, &lowest_level(bug, ""), report), expected, "{bug}");
    }
    // What shows only where a node has no mass.
    let bug = "node-without-mass-stands";
    let file = kit::folder().join("level-2/on_node_3.csv");
    let printed = port(&[&FLIGHT[..], &[&format!("bug={bug}")]].concat()).unwrap();
    let theirs = check::read("port.py", printed.as_slice()).unwrap();
    let reference = check::read("on_node_3", fs::File::open(file).unwrap()).unwrap();
    let report = compare(&reference.entries, &theirs, USUAL, false).unwrap();
    assert_eq!(line(bug, &lowest_level(bug, "linear"), report), (5, "d_eps_p"));
    // The port has another mass matrix, or another order of the stress, than the
    // reference.
    let arguments = ["trace", "6", "2", "0.3", "3", "linear"];
    let consistent = ["grid.cells=6", "time.cfl=0.3", "mass=consistent"];
    let report = held_against(&consistent, &arguments).unwrap();
    assert_eq!(line("lumped for consistent", "–", report), (4, "v_I"));
    let [first, last] = [SCHEMES[2].1, SCHEMES[3].1]
        .map(|sets| trace::trace(&dyka(&[sets, &["grid.cells=6"]].concat()), 3).unwrap());
    let report = compare(&last, &first.into(), USUAL, true).unwrap();
    assert_eq!(line("stress first for stress last", "–", report), (4, "f_int_I"));
    approve("port__mistakes", &table);
}
