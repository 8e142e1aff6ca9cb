//! The studies: their configurations, their logs, and what they find on the bar.

use crate::support::lines::{Dash, Frame, Line, lines};
use crate::support::*;
use kuva::prelude::MarkerShape::*;
use lme_mpm::method::cost::Cost;
use lme_mpm::run::table::shortest;
use lme_mpm::scene::DYKA;
use lme_mpm::scene::fault::Fault;
use lme_mpm::study::configuration::{Configuration, Template};
use lme_mpm::study::gamma::{self, AtGamma, Effect};
use lme_mpm::study::log::{self, PASSES, TimedRun};
use lme_mpm::study::measured::{Criterion, Measured};
use lme_mpm::study::ranking::{
    self, Among, LEVELS, Price, Question, Tried, VERDICT, WallTime, cheapest, front, summarise,
};
use lme_mpm::study::trade::grid;
use lme_mpm::study::{map, pool};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

fn dyka_template() -> Template {
    Template::parse(Path::new("dyka.toml"), DYKA).unwrap()
}

fn configuration(text: &str) -> Configuration {
    text.parse().unwrap_or_else(|fault| panic!("{fault}"))
}

fn directory(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::remove_dir_all(&dir).ok();
    fs::create_dir_all(&dir).unwrap();
    dir
}

/// A configuration is written and read as one line, and makes the scene that `--set` makes
/// of the same list, computed or written into a file.
#[test]
fn configurations_make_scenes() {
    let template = dyka_template();
    for line in [
        "method=mpm mass=lumped basis.kind=linear time.integrator=newmark grid.cells=80 \
         grid.particles_per_cell=3 time.cfl=0.25",
        "method=mpm mass=consistent basis.kind=lme basis.gamma=0.8 basis.cutoff=1e-3 \
         time.integrator=forward-euler time.stress_update=last grid.cells=40 \
         grid.particles_per_cell=2 time.fraction_of_critical=0.5",
        "method=mpm mass=lumped basis.kind=ugimp time.integrator=generalized-alpha \
         time.rho_b=0.8 grid.cells=20 grid.particles_per_cell=2 \
         grid.beyond={left=1,right=3} time.cfl=0.5",
        "method=otm mass=lumped basis.kind=lme basis.gamma=4 time.integrator=newmark \
         grid.cells=40 grid.particles_per_cell=1 time.cfl=0.9",
    ] {
        let one = configuration(line);
        assert_eq!(one.to_string(), line);
        let sets: Vec<&str> = line.split(' ').collect();
        let none = DYKA.replace("cfl = 0.5\n", "");
        let mut expected = scene(&none, &sets);
        expected.name = "scene".into();
        assert_eq!(template.scene(&one).unwrap(), expected, "{line}");
        let file = template.file(&one).unwrap();
        let mut written = scene(&file, &[]);
        written.name = "scene".into();
        assert_eq!(written, expected, "{file}");
    }
}

/// What a configuration says nothing of is not left from the scene: keys of another basis,
/// integrator, method or time step are gone.
#[test]
fn configurations_leave_nothing_of_the_scene() {
    let text = DYKA
        .replace("kind = \"linear\"", "kind = \"lme\"\ngamma = 2\ncutoff = 1e-4")
        .replace("integrator = \"newmark\"", "integrator = \"generalized-alpha\"\nrho_b = 0.5")
        .replace("cfl = 0.5", "cfl = 0.1\nfraction_of_critical = 0.1")
        .replace("cells = 40", "cells = 40\nbeyond = { left = 0, right = 3 }");
    let template = Template::parse(Path::new("other.toml"), &text).unwrap();
    let parts = "basis.kind=linear time.integrator=newmark time.cfl=0.5";
    let with = |method: &str, refinement: f64| {
        let grid = template.grid(method, refinement, 2);
        configuration(&format!("method={method} mass=lumped {parts} {grid}"))
    };
    let plain = dyka_template();
    for method in ["mpm", "otm"] {
        let scene = template.scene(&with(method, 2.0)).unwrap();
        let grid = plain.grid(method, 2.0, 2);
        let one = configuration(&format!("method={method} mass=lumped {parts} {grid}"));
        let mut expected = plain.scene(&one).unwrap();
        if method == "mpm" {
            expected.grid.beyond = vec![[0, 6]];
        }
        assert_eq!(scene, expected);
    }
    // A coarser grid keeps a cell where there was one.
    assert_eq!(template.scene(&with("mpm", 0.01)).unwrap().grid.beyond, [[0, 1]]);
    assert_eq!(with("mpm", 0.01).value("grid.cells"), "1");
    let flat = Template::parse(Path::new("discs.toml"), DISCS).unwrap();
    let cells: Vec<String> = flat.scene.grid.cells.iter().map(|n| (2 * n).to_string()).collect();
    let expected = format!("grid.cells=[{}] grid.particles_per_cell=[3,3]", cells.join(","));
    assert_eq!(flat.grid("otm", 2.0, 3), expected);
    // The digest of a study is that of what configurations do not change.
    let digest = |text: String| Template::parse(Path::new("x"), &text).unwrap().digest().unwrap();
    let own = digest(DYKA.to_string());
    assert_eq!(digest(DYKA.replace("cfl = 0.5", "cfl = 0.4")), own);
    assert_ne!(digest(DYKA.replace("cells = 40", "cells = 41")), own);
    assert_ne!(digest(DYKA.replace("density = ", "density = 1")), own);
}

/// What is no configuration is refused by name; one that is complete but wrong, by the
/// scene.
#[test]
fn configurations_are_checked() {
    for (bad, words) in [
        ("", "nothing is given"),
        ("method", "`method` is not KEY=VALUE"),
        ("method=mpm mass=", "`mass=` is not KEY=VALUE"),
        ("method=mpm body.density=3", "`body.density` is not one of method, mass"),
        ("method=mpm method=otm", "`method` stands there twice"),
    ] {
        let error = bad.parse::<Configuration>().unwrap_err().to_string();
        assert!(error.contains(words) && error.contains("--list"), "{bad}: {error}");
    }
    let template = dyka_template();
    let whole = "method=mpm mass=lumped basis.kind=cubic time.integrator=newmark \
                 grid.cells=4 grid.particles_per_cell=1 time.cfl=0.5";
    for (wrong, key, words) in [
        (whole.to_string(), "basis.kind", "cubic"),
        (whole.replace("cubic", "lme"), "basis.gamma", "needs this key"),
        (whole.replace("cubic", "linear basis.gamma=1"), "basis.gamma", "means nothing"),
        (whole.replace("cubic", "linear").replace("mass=lumped ", ""), "mass", "missing"),
        (whole.replace("cubic", "linear").replace(" time.cfl=0.5", ""), "time.cfl", "missing"),
    ] {
        match template.scene(&configuration(&wrong)) {
            Err(Fault::Scene(error)) => {
                assert_eq!(error.key, key);
                assert!(error.to_string().contains(words), "{error}");
            }
            other => panic!("{wrong}: {other:?}"),
        }
    }
}

/// The map has every combination once, and every one is a scene, but for the consistent
/// matrix of one particle per cell, which may be singular.
#[test]
fn map_has_every_combination() {
    let template = dyka_template();
    let all = map::combinations(&template).unwrap();
    // 6 bases × 6 integrators × 2 masses × 3 numbers × 2 offsets; OTM with 4 × 3.
    assert_eq!(all.len(), 6 * 6 * 2 * 3 * 2 + 4 * 3);
    for (n, one) in all.iter().enumerate() {
        template.scene(&one.configuration).unwrap();
        assert!(!all[..n].contains(one), "{one:?}");
    }
    let flat = Template::parse(Path::new("discs.toml"), DISCS).unwrap();
    assert_eq!(map::combinations(&flat).unwrap().len(), 6 * 6 * 2 * 3 * 2 + 3 * 3);
}

/// The pool does every piece once, with any number of threads, and stops at the first
/// error.
#[test]
fn pool_does_everything_once() {
    let items: Vec<u64> = (0..100).collect();
    for jobs in [1, 2, 7, 1000] {
        let mut seen = vec![0; 100];
        let square = |n: &u64| n * n;
        let done = pool::run(&items, jobs, square, |n, result| {
            assert_eq!(result, items[n] * items[n]);
            seen[n] += 1;
            Ok::<(), ()>(())
        });
        assert_eq!(done, Ok(()));
        assert_eq!(seen, vec![1; 100]);
    }
    let mut heard = 0;
    let stopped = pool::run(
        &items,
        2,
        |n| *n,
        |_, n| {
            heard += 1;
            if n >= 10 { Err(n) } else { Ok(()) }
        },
    );
    assert!(stopped.is_err() && heard < 100);
    assert_eq!(pool::run(&[] as &[u64], 3, |n| *n, |_, _| Ok::<(), ()>(())), Ok(()));
}

/// With any number of threads results come in the order of the items.
#[test]
fn pool_keeps_the_order() {
    let items: Vec<u64> = (0..100).collect();
    for jobs in [1, 3] {
        let mut told = 0;
        let squares = pool::all(&items, jobs, |n| n * n, &mut || told += 1);
        assert_eq!(squares, items.iter().map(|n| n * n).collect::<Vec<_>>());
        assert_eq!(told, 100);
    }
}

/// Linear finite elements, two configurations that run, and one beyond its limit.
fn small_grid() -> Vec<Configuration> {
    [
        ("otm", "linear time.integrator=newmark", 1, 0.99),
        ("mpm", "linear time.integrator=newmark", 2, 0.5),
        ("mpm", "lme basis.gamma=0.8 time.integrator=newmark", 2, 0.5),
        ("mpm", "ugimp time.integrator=generalized-alpha time.rho_b=0.5", 2, 0.9),
    ]
    .map(|(method, parts, per_cell, cfl)| {
        configuration(&format!(
            "method={method} mass=lumped basis.kind={parts} grid.cells=10 \
             grid.particles_per_cell={per_cell} time.cfl={cfl}"
        ))
    })
    .to_vec()
}

/// Runs without their times, in an order of their own.
fn plain(runs: &[TimedRun]) -> Vec<(String, usize, Result<Measured, String>)> {
    let mut list: Vec<_> = runs
        .iter()
        .map(|run| (run.configuration.to_string(), run.pass, run.measured.clone()))
        .collect();
    list.sort_by(|a, b| (&a.0, a.1).cmp(&(&b.0, b.1)));
    list
}

/// A log cut anywhere, even inside a line, is taken up: the same runs, none twice, and
/// what was there is kept. An unstable run is a row, too.
#[test]
fn trade_goes_on_where_it_stopped() {
    let (template, grid) = (dyka_template(), small_grid());
    let dir = directory("trade-log");
    let path = dir.join("runs.csv");
    let mut told = 0;
    let whole = log::complete(&template, &grid, &path, 2, &mut |_, _| told += 1).unwrap();
    assert_eq!((whole.len(), told), (grid.len() * PASSES, grid.len() * PASSES));
    let text = fs::read_to_string(&path).unwrap();
    for cut in [0, 9, text.len() / 3, text.len() / 2, text.len() - 5] {
        fs::write(&path, &text[..cut]).unwrap();
        let lines = text[..cut].lines().count();
        let mut told = 0;
        let again = log::complete(&template, &grid, &path, 1, &mut |_, _| told += 1).unwrap();
        assert!(told <= whole.len() && told + lines >= whole.len());
        assert_eq!(plain(&again), plain(&whole));
        let read = log::read(&path, &template.digest().unwrap()).unwrap();
        assert_eq!(plain(&read), plain(&whole));
    }
    let rows = summarise(&whole);
    assert_eq!(rows.len(), 4);
    assert!(rows.iter().all(|row| row.passes == PASSES));
    let failed: Vec<&Tried> = rows.iter().filter(|row| row.measured.is_err()).collect();
    assert_eq!(failed.len(), 1);
    assert_eq!(failed[0].configuration, grid[3]);
    let table = String::from_utf8(ranking::table(&rows).unwrap()).unwrap();
    assert_eq!(table.lines().count(), 5);
    assert!(table.contains("beyond its limit") || table.contains("used up"), "{table}");
    assert!(table.contains("\nmpm,lumped,lme,,0.8,,,,,,,newmark,,,,10,2,,0.5,,"), "{table}");
    // Another scene's log is refused, and so is another file.
    let other = Template::parse(Path::new("v.toml"), VIBRATION).unwrap();
    let refused = |template: &Template| {
        let outcome = log::complete(template, &grid, &path, 1, &mut |_, _| {});
        match outcome {
            Err(Fault::Points { path, line, problem, .. }) => {
                assert!(path.ends_with("runs.csv"), "{path}");
                (line, problem)
            }
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(&other), (2, "this run belongs to another scene".to_string()));
    fs::write(&path, "x,y\n1,2\n").unwrap();
    assert_eq!(refused(&template), (1, "these are other columns".to_string()));
}

/// Every number is written and read back under its own name.
#[test]
fn measured_is_written_and_read() {
    let cost = Cost { steps: 5, exponentials: 7, bytes_per_particle: 9, ..Cost::default() };
    let measured =
        Measured { velocity: 0.1, stress: 0.2, displacement: 0.3, energy_drift: 0.4, cost };
    let named = measured.named();
    let number = |name: &str| named.iter().find(|(own, _)| *own == name).map(|(_, x)| *x);
    assert_eq!(Measured::read(number), Some(measured));
    for (criterion, error) in Criterion::ALL.into_iter().zip([0.1, 0.2, 0.3]) {
        assert_eq!((measured.error(criterion), number(criterion.name())), (error, Some(error)));
    }
    assert_eq!(number("energy_drift"), Some(0.4));
    assert_eq!(number("exponentials"), Some(7.0));
    assert_eq!(Measured::read(|name| number(name).filter(|_| name != "solves")), None);
}

/// The median of the passes, their least and largest.
#[test]
fn trade_takes_the_median() {
    let run = |pass, wall_time| {
        let (configuration, measured) = (configuration("method=mpm"), Ok(Measured::default()));
        TimedRun { configuration, pass, measured, wall_time }
    };
    let rows = summarise(&[run(1, 5.0), run(2, 1.0), run(3, 2.0)]);
    assert_eq!((rows.len(), rows[0].passes), (1, 3));
    assert_eq!(rows[0].wall_time, WallTime { median: 2.0, least: 1.0, largest: 5.0 });
}

/// With two probes of one quantity its error is the root of their mean square; with
/// loads the balance of energy stands for its drift.
#[test]
fn trade_takes_all_probes_and_loads() {
    let more = "[[probe]]\nname = 'displacement_middle'\nquantity = 'displacement'\nposition = 5\n";
    let template = Template::parse(Path::new("two.toml"), &format!("{GRAVITY}\n{more}")).unwrap();
    let parts = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark time.cfl=0.5";
    let one = configuration(&format!("{parts} {}", template.grid("mpm", 1.0, 2)));
    let measured = TimedRun::of(&template, &one, 1).measured.unwrap();
    let scene = template.scene(&one).unwrap();
    assert_eq!(scene.probes.len(), 3);
    let outcome = finished(&scene);
    let of = |name: &str| crate::support::value(&scene, &outcome, name);
    let (end, middle) =
        (of("displacement_end_rms_relative"), of("displacement_middle_rms_relative"));
    let mean = f64::sqrt(0.5 * (end * end + middle * middle));
    assert!((measured.displacement / mean - 1.0).abs() < 1e-12 && end != middle);
    assert!(measured.energy_drift > 0.0);
    assert_eq!(measured.energy_drift, of("energy_balance_largest"));
    assert_eq!(measured.cost, outcome.cost);
}

/// The front holds those that nobody beats; the cheapest has the least work below the level, or
/// the one with the fewest pairs; finite elements stand on no front and are asked by themselves,
/// as MPM and OTM are.
#[test]
fn trade_front_and_cheapest() {
    let made_up = |line: &str, time: f64, error: f64| Tried {
        configuration: configuration(line),
        measured: match error.is_nan() {
            true => Err("blew up".into()),
            false => {
                let pairs = if line == "time.cfl=4" { 1 } else { 5 };
                let newton_iterations = (1e3 * time) as u64;
                let cost =
                    Cost { particle_node_pairs: pairs, newton_iterations, ..Cost::default() };
                Ok(Measured { velocity: error, cost, ..Measured::default() })
            }
        },
        wall_time: WallTime { median: time, least: 0.0, largest: 99.0 },
        passes: 3,
    };
    let rows = [
        made_up("time.cfl=1", 3.0, 0.1),
        made_up("time.cfl=2", 1.0, 0.3),
        made_up("time.cfl=3", 2.0, 0.35), // slower and worse than the second
        made_up("time.cfl=4", 9.0, 0.1),  // slower than the first, no better
        made_up("method=mpm time.cfl=5", 10.0, 0.01),
        made_up("time.cfl=6", 0.1, f64::NAN),
        made_up("method=otm mass=lumped basis.kind=linear", 0.01, 1e-6),
        made_up("method=otm basis.kind=lme time.cfl=8", 11.0, 0.1),
    ];
    let judged = Criterion::Velocity;
    let names =
        front(&rows, judged).into_iter().map(|(row, _)| row.configuration.value("time.cfl"));
    assert_eq!(names.collect::<Vec<_>>(), ["2", "1", "5"]);
    let asked =
        |among, price, error| cheapest(&rows, among, price, Question { criterion: judged, error });
    for (level, n, error) in [(0.4, 1, 0.3), (0.3, 1, 0.3), (0.2, 0, 0.1), (0.05, 4, 0.01)] {
        assert_eq!(asked(Among::Particles, Price::Work, level), Some((&rows[n], error)));
    }
    // The fourth has the fewest pairs; finite elements and OTM are asked by themselves.
    assert_eq!(asked(Among::Particles, Price::Pairs, 0.2), Some((&rows[3], 0.1)));
    assert_eq!(asked(Among::FiniteElements, Price::Work, 1e-3), Some((&rows[6], 1e-6)));
    assert_eq!(asked(Among::Otm, Price::Work, 0.2), Some((&rows[7], 0.1)));
    assert_eq!(asked(Among::Mpm, Price::Work, 0.2), Some((&rows[4], 0.01)));
    for among in [Among::Particles, Among::Mpm, Among::Otm] {
        assert_eq!(asked(among, Price::Work, 1e-3), None);
    }
    assert_eq!(ranking::best(&rows, Among::Particles, judged), Some((&rows[4], 0.01)));
    let table = String::from_utf8(ranking::cheapest_table(&rows).unwrap()).unwrap();
    let lines = LEVELS.len() * Criterion::ALL.len() * VERDICT.len();
    assert_eq!(table.lines().count(), 1 + lines);
    let work = |n: usize| shortest(rows[n].work().unwrap());
    for line in [
        "velocity,0.001,mpm and otm,work,none,0.01,,,".to_string(),
        "velocity,0.001,otm,work,none,0.1,,,".to_string(),
        format!(
            "velocity,0.001,finite elements,work,method=otm mass=lumped basis.kind=linear,1e-6,\
             0.01,{},5",
            work(6)
        ),
        format!("velocity,0.05,mpm and otm,work,method=mpm time.cfl=5,0.01,10,{},5", work(4)),
        format!("velocity,0.1,mpm and otm,pairs,time.cfl=4,0.1,9,{},1", work(3)),
    ] {
        assert!(table.contains(&format!("\n{line}\n")), "{line}: {table}");
    }
    let families = ["linear, lumped", "otm", "finite elements"];
    let lines = ["method=mpm mass=lumped basis.kind=linear", "method=otm basis.kind=lme"];
    let own = lines.map(|line| configuration(line).family());
    assert_eq!([&own[0], &own[1], &rows[6].configuration.family()], families);
}

/// The quick study on the grid of the scene itself: errors and counted cost, which are
/// the same on every machine; a table and a diagram for the book.
#[test]
fn trade_on_the_bar() {
    let template = dyka_template();
    let all = grid(&template, false).unwrap();
    assert!(all.len() > 100, "{}", all.len());
    let mut own = all;
    own.retain(|one| one.value("grid.cells") == "40");
    let runs = pool::all(&own, 2, |one| TimedRun::of(&template, one, 1), &mut || {});
    let mut table = String::from(
        "configuration,velocity,stress,displacement,energy drift,pairs,exponentials,steps\n",
    );
    what_the_bar_shows(&runs);
    let mut efforts = Vec::new();
    for TimedRun { configuration, measured, .. } in runs {
        match measured {
            Ok(Measured { velocity, stress, displacement, energy_drift, cost }) => {
                let (pairs, exponentials) = (cost.particle_node_pairs, cost.exponentials);
                writeln!(
                    table,
                    "{configuration},{velocity:.4},{stress:.4},{displacement:.5},{energy_drift:.4},{pairs},\
                     {exponentials},{}",
                    cost.steps
                )
                .unwrap();
                efforts.push((configuration.family(), (pairs as f64, velocity)));
            }
            Err(problem) => {
                let what = problem.split_once("s: ").map_or(problem.as_str(), |(_, what)| what);
                writeln!(table, "{configuration},{what},,,,,,").unwrap();
            }
        }
    }
    approve("trade__bar", &table);
    approve_picture("trade__bar_figure", traded(efforts));
}

/// Draws groups of (pairs, error), and the front of all that are no finite elements.
fn traded(mut efforts: Vec<(String, (f64, f64))>) -> String {
    efforts.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
    let mut front: Vec<(f64, f64)> = Vec::new();
    for (_, point) in efforts.iter().filter(|(group, _)| group != "finite elements") {
        if front.last().is_none_or(|last| point.1 < last.1) {
            front.push(*point);
        }
    }
    let mut drawn = vec![Line::new("front of the particle methods", front, 6)];
    let markers = [Circle, Plus, Square, Cross, Diamond, Triangle, TriangleDown];
    let words = [
        ("lme", "LME"),
        ("ugimp", "uGIMP"),
        ("gimp", "GIMP"),
        ("ddmp", "DDMP"),
        ("bspline", "B-splines"),
        ("otm", "OTM"),
    ];
    for (group, point) in efforts {
        let group = words.iter().fold(group, |group, (key, word)| group.replace(key, word));
        let known = drawn.iter().position(|line| line.name == group).unwrap_or_else(|| {
            let n = drawn.len() - 1;
            let line = Line::new(group, Vec::new(), n % 10).dashed(Dash::Nothing);
            drawn.push(line.marked(markers[n % markers.len()]));
            n + 1
        });
        drawn[known].points.push(point);
    }
    let frame = Frame {
        x: "pairs of particle and node",
        y: "relative velocity error",
        log: true,
        x_range: Some((1e4, 1e6)),
        y_range: Some((0.03, 0.3)),
        ..Frame::default()
    };
    lines(&drawn, &frame)
}

/// What the book says of the trade on the bar, 40 cells.
fn what_the_bar_shows(runs: &[TimedRun]) {
    let of = |words: &[&str]| -> Measured {
        let has = |run: &&TimedRun| {
            let line = format!("{} ", run.configuration);
            words.iter().all(|word| line.contains(&format!("{word} ")))
        };
        let found: Vec<&TimedRun> = runs.iter().filter(has).collect();
        assert_eq!(found.len(), 1, "{words:?}");
        found[0].measured.clone().unwrap()
    };
    let pairs = |one: &Measured| one.cost.particle_node_pairs as f64;
    // Finite elements have the fewest pairs, and in the velocity one row is better.
    let elements = of(&["otm", "linear", "time.cfl=0.998"]);
    let best = of(&["consistent", "basis.gamma=0.8", "time.cfl=0.2"]);
    for run in runs.iter().filter(|run| !run.configuration.is_finite_elements()) {
        let one = run.measured.clone().unwrap();
        assert!(pairs(&one) > pairs(&elements), "{}", run.configuration);
        assert!(one == best || one.velocity > elements.velocity, "{}", run.configuration);
        assert!(one.velocity >= best.velocity && one.stress >= best.stress);
    }
    // A step near the limit costs no accuracy, and saves more than half of the work.
    let newmark = "time.integrator=newmark";
    let usual = of(&["mpm", "lumped", "linear", newmark, "time.cfl=0.5"]);
    let large = of(&["mpm", "lumped", "linear", newmark, "time.cfl=1.38"]);
    assert!((large.velocity / usual.velocity - 1.0).abs() < 0.05);
    assert!((large.stress / usual.stress - 1.0).abs() < 0.05);
    assert!(pairs(&large) < 0.4 * pairs(&usual));
    // Of the lumped rows that are no finite elements OTM near its limit has the least errors.
    let otm = of(&["otm", "basis.gamma=6", "time.cfl=0.95"]);
    for run in runs.iter().filter(|run| !run.configuration.is_finite_elements()) {
        let one = run.measured.clone().unwrap();
        if run.configuration.value("mass") == "lumped" {
            assert!(one.velocity >= otm.velocity && one.stress >= otm.stress);
        }
    }
    assert!(pairs(&best) > 10.0 * pairs(&otm));
    let hasty = of(&["consistent", "basis.gamma=0.8", "time.cfl=0.51"]);
    assert!(hasty.velocity > 2.0 * best.velocity);
    // The short cut-off saves a third of the pairs, and costs nothing here.
    let lumped = of(&[
        "mpm",
        "lumped",
        "basis.gamma=0.8",
        newmark,
        "time.cfl=0.5",
        "lme basis.gamma=0.8 time.integrator=newmark",
    ]);
    let short = of(&["mpm", "lumped", "basis.cutoff=0.01", "time.cfl=0.5"]);
    assert!(pairs(&short) < 0.67 * pairs(&lumped));
    assert!((short.velocity / lumped.velocity - 1.0).abs() < 0.05);
    assert!(short.cost.exponentials < lumped.cost.exponentials * 101 / 100);
    // A tenth less velocity error for ten times the drift.
    for words in ["time.stress_update=last", "time.rho_b=0.8"] {
        let one = of(&["mpm", "lumped", "linear", words, "time.cfl=0.5"]);
        assert!(one.velocity < 0.9 * usual.velocity && one.velocity > 0.8 * usual.velocity);
        assert!(one.energy_drift > 10.0 * usual.energy_drift);
    }
}

/// The study of γ: the finite-element end is the linear basis; with the consistent
/// mass matrix there is a best γ in the middle, where waves of eight cells travel at
/// the right speed to a thousandth; lumped, they are late.
#[test]
fn gamma_from_end_to_end() {
    let rows = gamma::study(&gamma::items(), 2, &mut || {}).unwrap();
    let effect = |way: &str, gamma: f64| -> Effect {
        let row = rows.iter().find(|row| row.way == way && row.gamma == gamma).unwrap();
        *row.effect.as_ref().unwrap()
    };
    let linear = dyka(&[]);
    let error = crate::support::value(&linear, &finished(&linear), "velocity_end_rms_relative");
    let end = effect("mpm lumped", 50.0).velocity;
    assert!((end / error - 1.0).abs() < 1e-9, "{end} and {error}");
    let of = |gamma| effect("mpm consistent", gamma).velocity;
    let best = gamma::GAMMAS.into_iter().min_by(|a, b| of(*a).total_cmp(&of(*b)));
    assert_eq!(best, Some(0.8));
    assert!(effect("mpm consistent", 0.8).dispersion.abs() < 1e-3);
    assert!(effect("mpm lumped", 0.8).dispersion < -0.1);
    assert!((effect("otm", 50.0).critical_courant - 1.0).abs() < 1e-3);
    let mut table = String::from("way,γ");
    for (name, _) in Effect::default().named() {
        write!(table, ",{}", name.replace('_', " ")).unwrap();
    }
    for AtGamma { way, gamma, effect } in &rows {
        write!(table, "\n{way},{gamma}").unwrap();
        for (_, x) in effect.as_ref().unwrap().named() {
            let short = if x.abs() < 0.01 { format!("{x:.1e}") } else { format!("{x:.3}") };
            write!(table, ",{short}").unwrap();
        }
    }
    approve("gamma__study", &(table + "\n"));
    for (name, y) in [
        ("velocity", "relative velocity error, 40 cells"),
        ("dispersion", "frequency error of a wave of 8 cells"),
    ] {
        let looks = [
            ("MPM lumped", 0, Dash::Solid, Circle),
            ("MPM consistent", 1, Dash::Dashed, Diamond),
            ("OTM", 2, Dash::Solid, Square),
        ];
        let curve = |((_, points), (words, colour, dash, marker))| {
            Line::new(words, points, colour).dashed(dash).marked(marker)
        };
        let drawn: Vec<Line> =
            gamma::curves(&rows, name).into_iter().zip(looks).map(curve).collect();
        let frame = Frame { x: "γ of local max-ent", y, log: true, ..Frame::default() };
        approve_picture(&format!("gamma__{name}"), lines(&drawn, &frame));
    }
}

/// A time step given as a part of the predicted limit, and a limit in the summary.
#[test]
fn fraction_of_critical_sets_the_step() {
    let text = DYKA.replace("cfl = 0.5", "fraction_of_critical = 0.8");
    let courant = |sets: &[&str]| scene(&text, sets).courant_number();
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 0.02, "{a} and {b}");
    close(courant(&[]), 0.8 * 3.0_f64.sqrt());
    close(courant(&["time.integrator=forward-euler", "time.stress_update=last"]), 0.8 * 0.757);
    close(courant(&["mass=consistent"]), 0.8 * 0.502);
    // With both keys the smaller step counts.
    close(courant(&["time.cfl=0.3"]), 0.3);
    close(courant(&["time.cfl=3"]), 0.8 * 3.0_f64.sqrt());
    let none = DYKA.replace("cfl = 0.5\n", "");
    let error = lme_mpm::run::parse("x", "x.toml", &none, &[]).unwrap_err();
    assert!(error.problem.contains("time.fraction_of_critical"), "{error}");
}
