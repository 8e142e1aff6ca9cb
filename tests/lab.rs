//! The solver in the book's page: the committed WebAssembly against the program itself.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::run::parse;
use lme_mpm::scene::{DYKA, SHIPPED};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use wasmi::{Engine, Instance, Linker, Memory, Module, Store};

#[path = "../book/lab/build/digest.rs"]
mod digest;
#[path = "../book/lab/build/fnv.rs"]
mod fnv;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The page's solver under an interpreter.
struct Lab {
    store: Store<()>,
    instance: Instance,
    memory: Memory,
}

impl Lab {
    fn new() -> Self {
        let engine = Engine::default();
        let bytes = fs::read(root().join("book/lab/lab.wasm")).unwrap();
        let module = Module::new(&engine, bytes).unwrap();
        let mut store = Store::new(&engine, ());
        // It imports nothing, so a linker without a definition will do.
        let instance = Linker::new(&engine).instantiate_and_start(&mut store, &module).unwrap();
        let memory = instance.get_memory(&store, "memory").unwrap();
        Lab { store, instance, memory }
    }

    /// Calls a function of the interface, and takes its answer apart.
    fn ask(&mut self, name: &str, request: &[&str]) -> Parts {
        let request = request.join("\0");
        let length = request.len() as i32;
        let alloc = self.instance.get_typed_func::<i32, i32>(&self.store, "alloc").unwrap();
        let start = alloc.call(&mut self.store, length).unwrap();
        self.memory.write(&mut self.store, start as usize, request.as_bytes()).unwrap();
        let function = self.instance.get_typed_func::<(i32, i32), i32>(&self.store, name).unwrap();
        let at = function.call(&mut self.store, (start, length)).unwrap();
        self.take(at)
    }

    /// Takes the run that has begun on by so many steps.
    fn go_on(&mut self, steps: i32) -> Parts {
        let function = self.instance.get_typed_func::<i32, i32>(&self.store, "go_on").unwrap();
        let at = function.call(&mut self.store, steps).unwrap();
        self.take(at)
    }

    /// Takes an answer apart, and gives it back.
    fn take(&mut self, at: i32) -> Parts {
        let all = self.memory.data(&self.store)[at as usize..].to_vec();
        let number = |at: usize| u32::from_le_bytes(all[at..at + 4].try_into().unwrap()) as usize;
        let (mut next, end) = (4, number(0) + 4);
        let mut piece = || {
            let length = number(next);
            next += 4 + length;
            (all[next - length..next].to_vec(), next)
        };
        let mut parts = BTreeMap::new();
        loop {
            let name = String::from_utf8(piece().0).unwrap();
            let (content, next) = piece();
            parts.insert(name, content);
            if next == end {
                break;
            }
        }
        let free = self.instance.get_typed_func::<(i32, i32), ()>(&self.store, "free").unwrap();
        free.call(&mut self.store, (at, end as i32)).unwrap();
        parts
    }
}

/// The parts of an answer by name.
type Parts = BTreeMap<String, Vec<u8>>;

fn text(parts: &Parts, name: &str) -> String {
    parts.get(name).map_or(String::new(), |part| String::from_utf8(part.clone()).unwrap())
}

/// With it nobody predicts a limit, which in 2D and 3D would take longer than the run.
const FREE: &str = "time.allow_unstable=true";

/// Name, text and changes of a scene.
type Case = (String, &'static str, Vec<String>);

/// Every basis with every scheme and both mass matrices on the bar, the ways of OTM, and all
/// shipped scenes, made small.
fn cases() -> Vec<Case> {
    let owned = |sets: &[&str]| sets.iter().map(|set| set.to_string()).collect::<Vec<_>>();
    let mut cases = Vec::new();
    for (mass, cfl) in [(LUMPED, "time.cfl=0.5"), (CONSISTENT, "time.cfl=0.35")] {
        for basis in BASES {
            for scheme in SCHEMES {
                let sets = [&["grid.cells=8", cfl], mass.sets, basis.sets, scheme.sets].concat();
                let name = format!("{}, {}, {}", basis.name, scheme.name, mass.name);
                cases.push((name, DYKA, owned(&sets)));
            }
        }
    }
    for mass in ["kept", "renewed-keeping-velocity", "renewed-keeping-momentum"] {
        let sets = [format!("nodal_mass={mass}"), "grid.cells=16".to_string()];
        cases.push((format!("OTM, {mass}"), DYKA_OTM, sets.to_vec()));
    }
    for shipped in SHIPPED {
        let sets: &[&str] = match shipped.name {
            "manufactured" | "free-flight" | "periodic-bar" => &["grid.cells=16"],
            "axis-aligned" => &[FREE, "grid.cells=[3,3,3]", "time.end=0.004"],
            "vortex" => &[FREE, "grid.cells=[6,6]", "time.end=0.2"],
            "colliding-discs" => &[FREE, "grid.cells=[6,6]", "time.end=1"],
            "spinning-bar" => &[FREE, "grid.cells=[8,2]", "time.end=1"],
            _ => &["grid.cells=20"],
        };
        cases.push((shipped.name.to_string(), shipped.text, owned(sets)));
    }
    let ball = &[
        FREE,
        "grid.cells=[6,6]",
        "time.end=1",
        "basis.kind=lme",
        "basis.gamma=1.8",
        "basis.support=ball",
    ];
    cases.push(("discs, LME in a ball".to_string(), DISCS, owned(ball)));
    let far = &["time.cfl=1.75", "time.allow_unstable=true", "check.energy=1e6"];
    cases.push(("one percent above √3".to_string(), DYKA, owned(far)));
    cases
}

/// Every history of the page has the bits of the program's own: all columns, all recorded steps,
/// and the words of a run that breaks down.
#[test]
fn lab_has_the_same_bits() {
    let mut lab = Lab::new();
    let cases = cases();
    assert!(cases.len() > 90, "{}", cases.len());
    for (name, scene, sets) in &cases {
        let request: Vec<&str> = ["0", scene].into_iter().chain(strs(sets)).collect();
        let parts = lab.ask("history", &request);
        let own = parse("test", "scene", scene, sets).unwrap_or_else(|error| panic!("{error}"));
        let (history, broken) = match outcome(&own) {
            Ok(outcome) => (outcome.history, String::new()),
            Err(stopped) => (stopped.history.clone(), stopped.broken.to_string()),
        };
        assert_eq!(text(&parts, "error"), "", "{name}");
        assert_eq!(text(&parts, "broken"), broken, "{name}");
        assert_eq!(text(&parts, "history.columns"), history.columns.join("\n"), "{name}");
        let bits: Vec<u8> = history.rows().flatten().flat_map(|x| x.to_le_bytes()).collect();
        assert!(bits.len() > 300, "{name}");
        assert_eq!(parts["history"], bits, "{name}");
        assert_eq!(parts["csv"], history.csv().unwrap(), "{name}");
    }
}

/// The digests of some shipped scenes as they stand are those that were compared between platforms.
#[test]
fn lab_digests_are_current() {
    let noted = fs::read_to_string(root().join("data/bits/digests.csv")).unwrap();
    let scenes = SHIPPED.iter().map(|shipped| format!("{}.toml,", shipped.name));
    assert!(scenes.clone().all(|scene| noted.contains(&scene)), "{noted}");
    for name in ["dyka", "dyka-otm", "periodic-bar", "vibration"] {
        let text = lme_mpm::scene::shipped(name).unwrap().text;
        let csv = finished(&scene(text, &[])).history.csv().unwrap();
        let line = format!("{name}.toml,{:016x}", fnv::fnv(fnv::START, &csv));
        assert!(noted.contains(&line), "{line}: run `node book/lab/bits.mjs` again");
    }
}

/// What the page refuses it refuses in the program's own words, and it serves the next request.
#[test]
fn lab_refuses_in_the_program_s_words() {
    let mut lab = Lab::new();
    let wrong = lab.ask("begin", &["100", DYKA, "basis.kind=cubic"]);
    let own = parse("lab", "scene", DYKA, &["basis.kind=cubic".to_string()]).unwrap_err();
    assert_eq!(text(&wrong, "error"), own.to_string());
    let unstable = text(&lab.ask("begin", &["100", DYKA, "time.cfl=1.75"]), "error");
    assert!(unstable.starts_with("the time step is too large: c Δt / h is 1.7"), "{unstable}");
    assert!(text(&lab.ask("begin", &["many"]), "error").contains("not a number"));
    assert!(text(&lab.ask("shape", &["9", DISCS]), "error").contains("one axis"));
    assert_eq!(text(&lab.go_on(1), "error"), "no run has begun");
    assert!(lab.ask("limit", &["0", DYKA]).contains_key("limit"));
}

/// Numbers of a part.
fn numbers(parts: &Parts, name: &str) -> Vec<f64> {
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    parts[name].chunks_exact(8).map(number).collect()
}

/// A run that is taken on in pieces has the moments that were asked for, the first and the last
/// among them, and shows the program's own last state, history and summary; a limit is the
/// program's own; functions are those of the table.
#[test]
fn lab_shows_what_the_program_has() {
    let mut lab = Lab::new();
    let begun = lab.ask("begin", &["50", DYKA, "grid.cells=10"]);
    let scene = dyka(&["grid.cells=10"]);
    let own = finished(&scene);
    let (mut t, mut particles, mut history) = (Vec::new(), Vec::new(), Vec::new());
    let last = loop {
        let piece = lab.go_on(7);
        t.extend(numbers(&piece, "t"));
        particles.extend(numbers(&piece, "particles"));
        history.extend(numbers(&piece, "history"));
        if piece.contains_key("done") {
            break piece;
        }
    };
    assert!((40..=52).contains(&t.len()) && t[0] == 0.0, "{}", t.len());
    assert_eq!((numbers(&begun, "sizes")[3], *t.last().unwrap()), (scene.time.end, scene.time.end));
    let names = ["position", "displacement", "velocity", "stress"];
    let columns = names.map(|name| own.particles.column(name).unwrap());
    let rows = (0..columns[0].len()).flat_map(|p| columns.iter().map(move |column| column[p]));
    let rows: Vec<f64> = rows.collect();
    assert_eq!(particles[particles.len() - rows.len()..], rows);
    assert_eq!(history, own.history.rows().flatten().copied().collect::<Vec<_>>());
    let summary = text(&last, "summary.names");
    let place = summary.lines().position(|name| name == "velocity_end_rms_relative").unwrap();
    let lines = lme_mpm::output::summary::lines(&scene, &own, 0.0);
    let line = lines.iter().find(|line| line.quantity == "velocity_end_rms_relative").unwrap();
    assert_eq!(numbers(&last, "summary")[place], line.value);
    let run = begun;
    let limit = lme_mpm::run::stability::critical(&scene).unwrap();
    assert_eq!(numbers(&run, "limit")[1], scene.courant_number_of(limit.used()));
    let shape = lab.ask("shape", &["81", DYKA, "grid.cells=8", "basis.kind=bspline"]);
    let (x, N) = (numbers(&shape, "x"), numbers(&shape, "N"));
    let nodes = numbers(&shape, "nodes").len();
    let model = lme_mpm::setup::model::<1>(&dyka(&["grid.cells=8", "basis.kind=bspline"]));
    let at: Vec<_> = x.iter().map(|x| nalgebra::SVector::repeat(*x)).collect();
    for (I, n, own, _) in on_grid(&model.basis, &model.grid, &at).unwrap().shape.pairs() {
        assert_eq!(N[n * nodes + I], own);
    }
}

/// Exact fields and histories of the page are those of the program.
#[test]
fn lab_knows_the_exact_solution() {
    let mut lab = Lab::new();
    let exact = lme_mpm::setup::exact::<1>(&dyka(&[])).unwrap();
    let fields = numbers(&lab.ask("moment", &["4e-5", DYKA]), "exact");
    let all = numbers(&lab.ask("exact", &["5", DYKA]), "exact");
    let history = numbers(&lab.ask("point", &["0.05", DYKA]), "exact");
    for n in [0, 100, 240] {
        let (X, end) = (0.1333 * n as f64 / 240.0, dyka(&[]).time.end);
        let [at, later] = [4e-5, 0.5 * end].map(|t| exact.along(X, t));
        assert_eq!(fields[3 * n..3 * n + 3], [X + at.displacement, at.velocity, at.stress]);
        assert_eq!(all[3 * (2 * 241 + n) + 1], later.velocity);
        let row = &history[4 * n..4 * n + 4];
        let at = exact.along(0.05, row[0]);
        assert_eq!(row[1..], [at.velocity, at.stress, at.displacement]);
    }
}

/// The steps that the page goes through are those of the plain file, number by number: what
/// particles are after the ninth of each of them.
#[test]
fn lab_steps_are_those_of_one_bar() {
    use lme_mpm::method::one_bar::{OneBar, one_bar};
    let mut lab = Lab::new();
    let scene = dyka(&["grid.cells=4"]);
    let bar = OneBar {
        length: 0.1333,
        density: 7833.0,
        youngs_modulus: 200e9,
        thrown_from: 0.099975,
        velocity: 5.0,
        cells: 4,
        particles_per_cell: 2,
        dt: scene.time.end / scene.step_count(),
        steps: 3,
    };
    let own = one_bar(&bar, None).unwrap();
    for k in 1..=3 {
        let steps = lab.ask("steps", &[&k.to_string(), DYKA, "grid.cells=4"]);
        for (name, own) in ["x_p", "v_p", "sigma_p", "rho_p"].iter().zip(&own[k]) {
            let all = numbers(&steps, name);
            assert_eq!(all.len(), 10 * 8, "before and after nine steps, eight particles");
            for (own, x) in own.iter().zip(&all[9 * 8..]) {
                assert_relative_eq!(x, own, max_relative = 1e-12, epsilon = 1e-12);
            }
        }
        // Step 3 fills the nodes that step 2 has emptied.
        let m = numbers(&steps, "m_I");
        assert!(
            m[2 * 6..3 * 6].iter().all(|m| *m == 0.0)
                && m[3 * 6..3 * 6 + 5].iter().all(|m| *m > 0.0)
        );
    }
}

/// The committed solver is compiled from the sources as they stand.
#[test]
fn lab_is_current() {
    let noted = fs::read_to_string(root().join("book/lab/lab.digest")).unwrap();
    let now = digest::of_sources(root()).unwrap();
    assert_eq!(
        noted.trim(),
        now,
        "book/lab/lab.wasm was compiled from other sources; compile it again with `cargo lab`"
    );
}
