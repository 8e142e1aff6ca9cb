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

/// A bar that the port marches, with two particles in each cell.
#[derive(Clone, Copy)]
struct Bar {
    cells: usize,
    courant: f64,
    steps: usize,
    /// `linear`, or γ of local max-ent.
    basis: &'static str,
    /// `KEY=VALUE` of the port.
    more: &'static [&'static str],
}

const fn bar(cells: usize, steps: usize, basis: &'static str) -> Bar {
    Bar { cells, courant: 0.5, steps, basis, more: &[] }
}

/// The bar of `level-2/on_node_3.csv`.
const FLIGHT: Bar = Bar {
    more: &["length=4", "density=1", "modulus=1", "speed=0.25", "from=0", "end=2", "fixed=0"],
    ..bar(4, 3, "linear")
};

/// What the port is asked for; kernels are evaluated at what a file of the kit gives.
#[derive(Clone, Copy)]
enum Task {
    Basis(&'static str),
    Law,
    Measure,
    Exact,
    Trace(Bar),
}

impl Task {
    /// The basis that the answer needs, if any.
    fn basis(self) -> Option<&'static str> {
        match self {
            Task::Basis(basis) | Task::Trace(Bar { basis, .. }) => Some(basis),
            Task::Law | Task::Measure | Task::Exact => None,
        }
    }

    /// The port's answer, with one mistake in it.
    fn answer(self, file: &Path, bug: &str) -> Option<Vec<u8>> {
        let (file, bug) = (file.to_str().unwrap(), format!("bug={bug}"));
        match self {
            Task::Basis(basis) => port(&["basis", file, "2", "8", basis, &bug]),
            Task::Law => port(&["law", file, &bug]),
            Task::Measure => port(&["measure", file, &bug]),
            Task::Exact => port(&["exact", file, &bug]),
            Task::Trace(bar) => marched("trace", bar, &bug),
        }
    }
}

/// What the port prints of a bar that it marches with one mistake.
fn marched(
    what: &str,
    Bar { cells, courant, steps, basis, more }: Bar,
    bug: &str,
) -> Option<Vec<u8>> {
    let [cells, courant, steps] = [cells.to_string(), courant.to_string(), steps.to_string()];
    port(&[&[what, &cells, "2", &courant, &steps, basis], more, &[bug]].concat())
}

/// A file of the kit with the task that answers it.
struct Answer {
    file: &'static str,
    task: Task,
}

const fn answer(file: &'static str, task: Task) -> Answer {
    Answer { file, task }
}

const ANSWERS: [Answer; 16] = [
    answer("level-0/basis_linear.csv", Task::Basis("linear")),
    answer("level-0/basis_lme_wide.csv", Task::Basis("0.8")),
    answer("level-0/basis_lme_middle.csv", Task::Basis("1.8")),
    answer("level-0/basis_lme_narrow.csv", Task::Basis("4")),
    answer("level-0/law_1d.csv", Task::Law),
    answer("level-0/law_2d.csv", Task::Law),
    answer("level-0/measure.csv", Task::Measure),
    answer("level-0/exact.csv", Task::Exact),
    answer("level-1/linear_1.csv", Task::Trace(bar(4, 1, "linear"))),
    answer("level-1/lme_1.csv", Task::Trace(bar(4, 1, "0.8"))),
    answer(
        "level-1/modulus_1.csv",
        Task::Trace(Bar { more: &["poisson=0.25"], ..bar(4, 1, "linear") }),
    ),
    answer("level-2/on_node_3.csv", Task::Trace(FLIGHT)),
    answer("level-2/linear_10.csv", Task::Trace(bar(4, 10, "linear"))),
    answer("level-2/lme_10.csv", Task::Trace(bar(4, 10, "0.8"))),
    answer("level-3/linear_history.csv", Task::Trace(bar(40, 320, "linear"))),
    answer("level-3/lme_history.csv", Task::Trace(bar(40, 320, "0.8"))),
];

/// Runs the port on a file of the kit, and `lme-mpm check` on what it prints, with the
/// tolerance that the manifest gives.
fn checked(Answer { file, task }: &Answer, bug: &str) -> Option<Output> {
    let path = kit::folder().join(file);
    Some(checked_text(file, &program::text(&task.answer(&path, bug)?)))
}

/// Runs `lme-mpm check` on what a port has printed for a file of the kit.
fn checked_text(file: &str, printed: &str) -> Output {
    let path = kit::folder().join(file);
    let manifest = fs::read_to_string(kit::folder().join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    let files = manifest["files"].as_array().unwrap();
    let entry = files.iter().find(|entry| entry["file"] == file).unwrap();
    let class = &manifest["tolerances"][entry["tolerance"].as_str().unwrap()];
    // Of whole histories the kit has two particles.
    let part: &[&str] = if file.starts_with("level-3") { &["--part"] } else { &[] };
    let [rtol, atol] = ["relative", "absolute"].map(|kind| class[kind].to_string());
    let own = path.to_str().unwrap();
    let check = [&["check", own, "-", "--rtol", &rtol, "--atol", &atol], part].concat();
    program::program_with_input(root(), &check, printed)
}

/// What the port in MATLAB prints, run by Octave; `None` where there is none.
fn matlab(call: &str) -> Option<Vec<u8>> {
    let folder = root().join("tests/port");
    let arguments = ["--no-gui", "--quiet", "--norc", "--path", folder.to_str().unwrap(), "--eval"];
    let Ok(output) = Command::new("octave-cli").args(arguments).arg(call).output() else {
        assert!(std::env::var_os("CI").is_none(), "octave-cli is needed in CI");
        eprintln!("octave-cli is not there: the port in MATLAB was not checked");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(output.stdout)
}

/// The files of the kit that the port in MATLAB answers, each with its call; FILE stands for the
/// file's own path.
const MATLAB: [(&str, &str); 10] = [
    ("level-0/basis_2d_linear.csv", "port('basis', 'FILE', 0, 3, 4)"),
    ("level-0/basis_2d_lme_wide.csv", "port('basis', 'FILE', 0.8, 3, 4)"),
    ("level-0/basis_2d_lme_narrow.csv", "port('basis', 'FILE', 12, 3, 4)"),
    ("level-0/law_2d.csv", "port('law', 'FILE')"),
    ("level-1/strip_linear_1.csv", "port('trace', 1, 0)"),
    ("level-1/strip_lme_1.csv", "port('trace', 1, 0.8)"),
    ("level-2/strip_linear_3.csv", "port('trace', 3, 0)"),
    ("level-2/strip_lme_2.csv", "port('trace', 2, 0.8)"),
    ("level-2/strip_narrow_2.csv", "port('trace', 2, 12, 'cells', [2 1], 'per_cell', [8 1])"),
    ("level-2/strip_rollers_3.csv", "port('trace', 3, 0, 'held', {1, [], 2, 1}, 'top', [0 3e4])"),
];

/// The port in MATLAB passes levels 0 to 2 in two dimensions: every number but what level 0
/// gives.
#[test]
fn port_in_matlab_passes_the_kit() {
    for (file, call) in MATLAB {
        let path = kit::folder().join(file);
        let Some(printed) = matlab(&call.replace("FILE", path.to_str().unwrap())) else { return };
        let output = checked_text(file, &program::text(&printed));
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{file}: {}", String::from_utf8_lossy(&output.stderr));
        let numbers = said.split(" numbers agree").next().unwrap();
        let (some, all) = numbers.split_once(" of ").unwrap();
        assert!(file.starts_with("level-0") || some == all, "{file}: {said}");
    }
}

/// The port passes levels 0 to 3: every number that the kit has and it prints, and what
/// is not compared is only what the kit gives.
#[test]
fn port_passes_the_kit() {
    const GIVEN: [&str; 8] = ["E", "nu", "d_eps_p", "phi", "phi_exact", "x", "t", "x_p"];
    for answer in ANSWERS {
        let Some(output) = checked(&answer, "") else { return };
        let file = answer.file;
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
    for (basis, name) in [("linear", LINEAR.name), ("0.8", LME_WIDE.name)] {
        let Some(printed) = marched("errors", bar(40, 320, basis), "bug=") else { return };
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
    let as_printed = answer("level-2/as_printed_3.csv", Task::Trace(bar(4, 3, "linear")));
    let output = checked(&as_printed, "step-8-as-printed").unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

const USUAL: Tolerance = Tolerance { relative: 1e-9, absolute: 1e-12 };

/// A bar as a scene of this program and as the port has it.
#[derive(Clone, Copy)]
struct Pair {
    sets: &'static [&'static str],
    port: Bar,
}

/// The port's trace, with one mistake, against that of the scene.
fn held_against(Pair { sets, port }: Pair, bug: &str) -> Option<Report> {
    let printed = marched("trace", port, &format!("bug={bug}"))?;
    let theirs =
        check::read("port.py", printed.as_slice()).unwrap_or_else(|fault| panic!("{fault}"));
    let reference = trace::trace(&dyka(sets), port.steps).unwrap();
    Some(compare(&reference, &theirs, USUAL, false).unwrap())
}

/// What the port prints for a file of the kit, with one mistake, against that file.
fn held_against_file(file: &str, task: Task, bug: &str) -> Report {
    let path = kit::folder().join(file);
    let printed = task.answer(&path, bug).unwrap();
    let theirs = check::read("port.py", printed.as_slice()).unwrap();
    let reference = check::read(file, fs::File::open(path).unwrap()).unwrap();
    compare(&reference.entries, &theirs, USUAL, false).unwrap()
}

/// Every intermediate of forty steps on 8 cells agrees, with the linear basis and with
/// local max-ent, γ = 0.8 and 4.
#[test]
fn port_agrees() {
    for (sets, basis) in [
        (&["grid.cells=8"][..], "linear"),
        (&["grid.cells=8", "basis.kind=lme", "basis.gamma=0.8"], "0.8"),
        (&["grid.cells=8", "basis.kind=lme", "basis.gamma=4"], "4"),
    ] {
        let pair = Pair { sets, port: bar(8, 40, basis) };
        let Some(report) = held_against(pair, "") else { return };
        assert!(report.divergence.is_none(), "{basis}: {}", report.text());
        assert!(report.compared > 5000 && report.missing.is_empty(), "{}", report.text());
    }
}

/// The lowest level of the kit whose check a mistake does not pass, among the files that
/// need no basis or this one.
fn lowest_level(bug: &str, basis: Option<&str>) -> &'static str {
    let own = |answer: &Answer| answer.task.basis().is_none_or(|own| basis == Some(own));
    for answer in ANSWERS.into_iter().filter(own) {
        let output = checked(&answer, bug).unwrap();
        if !output.status.success() {
            assert_eq!(output.status.code(), Some(1), "{}", answer.file);
            return &answer.file["level-".len()..][..1];
        }
    }
    panic!("{bug} passes the kit");
}

/// A mistake of a port, with the step and the symbol where it shows first.
struct Mistake {
    bug: &'static str,
    shows_in: (usize, &'static str),
}

const fn mistake(bug: &'static str, step: usize, symbol: &'static str) -> Mistake {
    Mistake { bug, shows_in: (step, symbol) }
}

/// Ports with one mistake each: every one is found, in the step where it is made, and by
/// the kit. Twenty time steps on 6 cells, and the files of level 0.
#[test]
fn port_mistakes_are_found() {
    let mut table = String::from("mistake,level,found at k,step,symbol,likely cause as reported\n");
    let mut line = |bug: &str, level: &str, report: Report| {
        let Some(found) = report.divergence else { panic!("{bug} was not found") };
        let Entry { k, step, symbol, .. } = found.reference;
        let cause = found.cause.as_deref().unwrap_or("–").replace(',', ";");
        writeln!(table, "{bug},{level},{k},{step},{symbol},{cause}").unwrap();
        (step, symbol)
    };
    let linear = Pair { sets: &["grid.cells=6"], port: bar(6, 20, "linear") };
    let wide = Pair {
        sets: &["grid.cells=6", "basis.kind=lme", "basis.gamma=0.8"],
        port: bar(6, 20, "0.8"),
    };
    let quarter = Pair {
        sets: &["grid.cells=6", "body.poisson_ratio=0.25"],
        port: Bar { more: &["poisson=0.25"], ..linear.port },
    };
    for (pair, Mistake { bug, shows_in }) in [
        (linear, mistake("gradient-without-h", 2, "grad_N_Ip")),
        (wide, mistake("node-off-by-one", 2, "N_Ip")),
        (wide, mistake("gamma-is-beta-over-h2", 2, "N_Ip")),
        (wide, mistake("cut-after-solving", 2, "N_Ip")),
        (linear, mistake("mass-of-the-whole-cell", 0, "m_p")),
        (wide, mistake("fixed-node-moves", 4, "v_I")),
        (quarter, mistake("modulus-is-E", 6, "sigma_p")),
        (linear, mistake("stress-of-this-step", 6, "sigma_p")),
        (linear, mistake("density-before-strain", 6, "rho_p")),
        (linear, mistake("old-stress", 7, "f_int_I")),
        (linear, mistake("first-density", 7, "f_int_I")),
        (linear, mistake("sign-of-force", 7, "f_int_I")),
        (linear, mistake("force-on-fixed-node", 7, "f_I")),
        (linear, mistake("step-8-as-printed", 8, "p_I_advanced")),
        (linear, mistake("old-N-in-corrector", 9, "a_p")),
        (linear, mistake("predictor-takes-mapped-momentum", 1, "x_p")),
        (linear, mistake("whole-predictor", 1, "v_p")),
        (linear, mistake("no-half-dt2", 1, "x_p")),
    ] {
        let Some(report) = held_against(pair, bug) else { return };
        let level = lowest_level(bug, Some(pair.port.basis));
        assert_eq!(line(bug, level, report), shows_in, "{bug}");
    }
    for (file, task, Mistake { bug, shows_in }) in [
        ("level-0/law_2d.csv", Task::Law, mistake("plane-stress", 6, "sigma_p")),
        ("level-0/measure.csv", Task::Measure, mistake("missing-square", 1, "rms")),
        ("level-0/exact.csv", Task::Exact, mistake("half-reflection", 1, "v")),
    ] {
        let report = held_against_file(file, task, bug);
        assert_eq!(line(bug, lowest_level(bug, None), report), shows_in, "{bug}");
    }
    // What shows only where a node has no mass.
    let bug = "node-without-mass-stands";
    let report = held_against_file("level-2/on_node_3.csv", Task::Trace(FLIGHT), bug);
    assert_eq!(line(bug, lowest_level(bug, Some("linear")), report), (5, "d_eps_p"));
    // The port has another mass matrix, or another order of the stress, than the
    // reference.
    let pair = Pair {
        sets: &["grid.cells=6", "time.cfl=0.3", "mass=consistent"],
        port: Bar { courant: 0.3, ..bar(6, 3, "linear") },
    };
    let report = held_against(pair, "").unwrap();
    assert_eq!(line("lumped for consistent", "–", report), (4, "v_I"));
    let [first, last] = [STRESS_FIRST, STRESS_LAST]
        .map(|scheme| trace::trace(&dyka(&[scheme.sets, &["grid.cells=6"]].concat()), 3).unwrap());
    let report = compare(&last, &first.into(), USUAL, true).unwrap();
    assert_eq!(line("stress first for stress last", "–", report), (4, "f_int_I"));
    approve("port__mistakes", &table);
}
