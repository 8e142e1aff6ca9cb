//! Verdicts: which grids are tried, that the cheapest is the cheapest, and what its neighbours
//! say of it.

use crate::support::program;
use crate::support::*;
use lme_mpm::method::cost::Cost;
use lme_mpm::scene::DYKA;
use lme_mpm::setup;
use lme_mpm::study::configuration::{Configuration, Template};
use lme_mpm::study::log::TimedRun;
use lme_mpm::study::measured::{Criterion, Measured};
use lme_mpm::study::pool;
use lme_mpm::study::ranking::{Among, Price, Question, Tried, WallTime, cheapest, summarise};
use lme_mpm::study::trade::{grid, least_pairs, left_out, levels};
use lme_mpm::study::verdict::{self, Candidate, FRAGILE, Neighbour};
use lme_mpm::study::work::work;
use std::fmt::Write;
use std::fs;
use std::path::Path;

fn template(text: &str) -> Template {
    Template::parse(Path::new("scene.toml"), text).unwrap()
}

fn configuration(text: &str) -> Configuration {
    text.parse().unwrap_or_else(|fault| panic!("{fault}"))
}

/// Grids come from the coarsest up, a cell larger by √2 from one to the next, as long as they
/// know what moves the body: half a wave, a ring, a patch of initial velocity.
#[test]
fn verdicts_begin_with_coarse_grids() {
    let cells = |text: &str| -> Vec<String> {
        let levels = levels(&template(text), false).unwrap();
        let of = |level: &Vec<Configuration>| {
            let cells = level[0].value("grid.cells").to_string();
            assert!(level.iter().all(|one| one.value("grid.cells") == cells));
            cells
        };
        levels.iter().map(of).collect()
    };
    let gravity = ["4", "5", "7", "10", "14", "20", "28", "40", "80", "160"];
    assert_eq!(cells(GRAVITY), gravity);
    assert_eq!(cells(&VIBRATION.replace("mode = 1", "mode = 5"))[0], "10");
    // A quarter of the bar is thrown; an eighth.
    assert_eq!(cells(DYKA)[0], "4");
    assert_eq!(cells(&DYKA.replace("from = 0.099975", "from = 0.1166375"))[0], "10");
    assert_eq!(cells(MANUFACTURED)[..4], ["4", "5", "7", "10"]);
    for (text, words) in [
        (GRAVITY, "fewer than 4 cells are left out (a few along the body"),
        (
            &VIBRATION.replace("mode = 1", "mode = 5"),
            "fewer than 9 cells are left out (two to half",
        ),
        (DYKA, "fewer than 4 cells are left out (one to a patch of initial velocity"),
        (VORTEX, "fewer than 10×10 cells are left out (two across the ring"),
        (AXIS_ALIGNED, "fewer than 4×4×4 cells are left out (two to half a wave"),
    ] {
        let told = left_out(&template(text).scene);
        assert!(told.contains(words), "{told}");
    }
    assert!(left_out(&strip(2, &[])).contains("than 4×1 cells"));
}

/// What `recommend` finds has the fewest pairs of all configurations, though it tries only some
/// of them: sudden gravity, where 1000 pairs reach 2% and no configuration of the scene's own
/// grid does with 10 times as many, the vibration, and the motion across cells, by every
/// quantity. The estimate of pairs that lets it leave out the rest is never too high.
#[test]
fn verdicts_find_the_cheapest() {
    for (text, errors) in [(GRAVITY, &[0.02][..]), (VIBRATION, &[0.02, 0.003])] {
        let template = template(text);
        let mut all = grid(&template, false).unwrap();
        all.retain(|one| one.value("grid.cells").parse::<f64>().unwrap() <= 40.0);
        let runs = pool::all(&all, 2, |one| TimedRun::of(&template, one, 1), &mut || {});
        let rows = summarise(&runs);
        for row in &rows {
            let least = least_pairs(&template, &row.configuration).unwrap();
            assert!(row.pairs().is_none_or(|pairs| pairs as f64 >= least), "{row:?}");
        }
        let own: Vec<Tried> = rows.iter().filter(|row| is_own(row)).cloned().collect();
        let questions = errors.iter().flat_map(|error| Criterion::ALL.map(|one| (one, *error)));
        for (criterion, error) in questions {
            let question = Question { criterion, error };
            let path = directory("verdict").join("runs.csv");
            let search = verdict::search(&template, question, &path, 2, &mut |_, _| {}).unwrap();
            assert!(search.dearer > 0);
            let least = |rows: &[Tried]| {
                let found = cheapest(rows, Among::Particles, Price::Pairs, question);
                found.map(|(row, _)| (row.configuration.clone(), row.pairs().unwrap()))
            };
            let (found, expected) = (least(&search.rows), least(&rows));
            assert_eq!(found, expected);
            if text == GRAVITY {
                let (pairs, on_own) = (found.unwrap().1, least(&own).unwrap().1);
                assert!(pairs < 1000 && on_own > 10 * pairs, "{pairs} and {on_own}");
            }
        }
    }
}

fn is_own(row: &Tried) -> bool {
    row.configuration.value("grid.cells") == "40"
}

fn directory(name: &str) -> std::path::PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::remove_dir_all(&dir).ok();
    fs::create_dir_all(&dir).unwrap();
    dir
}

/// The neighbours of a configuration differ from it in one thing each, and have the error that a
/// run of that has.
#[test]
fn verdicts_ask_the_neighbours() {
    let template = template(DYKA);
    let changes = |line: &str| -> Vec<String> {
        let found = verdict::neighbours(&template, &configuration(line), Criterion::Velocity, 2);
        found.unwrap().into_iter().map(|one| one.change).collect()
    };
    let line = "method=mpm mass=consistent basis.kind=lme basis.gamma=0.8 \
                time.integrator=newmark grid.cells=10 grid.particles_per_cell=2 time.cfl=0.2";
    let expected = [
        "basis.gamma=0.64",
        "basis.gamma=0.72",
        "basis.gamma=0.88",
        "basis.gamma=0.96",
        "grid.particles_per_cell=3",
        "grid.cells=9",
        "grid.cells=11",
        "offset=-0.25",
        "offset=0.25",
    ];
    assert_eq!(changes(line), expected);
    let lumped = changes(&line.replace("consistent", "lumped"));
    assert_eq!(lumped[4..6], ["grid.particles_per_cell=1", "grid.particles_per_cell=3"]);
    let otm = line.replace("method=mpm mass=consistent", "method=otm mass=lumped");
    assert!(!changes(&otm).iter().any(|change| change.starts_with("offset")));
    let own = verdict::neighbours(&template, &configuration(line), Criterion::Velocity, 1);
    for Neighbour { change, error } in own.unwrap() {
        let (key, value) = change.split_once('=').unwrap();
        let mut scene = template.scene(&configuration(line).with(key, value)).unwrap();
        if key == "offset" {
            scene.grid.offset = value.parse().unwrap();
        }
        assert_eq!(error, Ok(Measured::of(&scene).unwrap().velocity), "{change}");
    }
    // In 2D cells and particles are lists.
    let flat = Template::parse(Path::new("flat.toml"), FLAT).unwrap();
    let line = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark \
                grid.cells=[6,4] grid.particles_per_cell=[2,1] time.cfl=0.2";
    let found = verdict::neighbours(&flat, &configuration(line), Criterion::Velocity, 2).unwrap();
    let changes: Vec<&str> = found.iter().map(|one| one.change.as_str()).collect();
    let expected =
        ["grid.particles_per_cell=[3,2]", "grid.cells=[5,3]", "grid.cells=[7,5]", "offset=-0.25"];
    assert_eq!(changes[..4], expected);
    assert!(found.iter().all(|one| one.error.is_ok()), "{found:?}");
}

const FLAT: &str = "title = 'flat'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
     body = { length = [1, 1], density = 1, youngs_modulus = 1, poisson_ratio = 0.3, \
     law = 'neo-hookean' }\ngrid = { cells = [8, 8], particles_per_cell = [2, 2] }\n\
     time = { integrator = 'newmark', cfl = 0.2, end = 0.1, kinematics = 'consistent' }\n\
     boundary.left.x = 'fixed'\nboundary.right.x = 'fixed'\n\
     boundary.bottom.y = 'fixed'\nboundary.top.y = 'fixed'\n\
     manufactured = { mode = 1, amplitude = 0.01, frequency = 3.0, phase = [0, 1] }\n";

/// A candidate is fragile if a neighbour misses the error by more than twice, or fails; the
/// search goes on to the next then, and stops at the first that is not.
#[test]
fn verdicts_mark_what_is_fragile() {
    let question = Question { criterion: Criterion::Velocity, error: 0.1 };
    let with = |errors: &[Result<f64, &str>]| Candidate {
        tried: Tried {
            configuration: configuration("method=mpm"),
            measured: Ok(Measured::default()),
            wall_time: WallTime { median: 1.0, least: 1.0, largest: 1.0 },
            passes: 1,
        },
        error: 0.05,
        neighbours: errors
            .iter()
            .enumerate()
            .map(|(n, error)| Neighbour {
                change: format!("{n}"),
                error: error.map_err(String::from),
            })
            .collect(),
    };
    assert_eq!(FRAGILE, 2.0);
    for (errors, fragile, worst) in [
        (&[][..], false, None),
        (&[Ok(0.01), Ok(0.19), Ok(0.1)], false, Some(("1", 0.19))),
        (&[Ok(0.21), Ok(0.05)], true, Some(("0", 0.21))),
        (&[Ok(0.05), Err("blew up")], true, Some(("1", f64::INFINITY))),
    ] {
        let candidate = with(errors);
        assert_eq!(candidate.is_fragile(question), fragile);
        assert_eq!(candidate.worst(), worst);
    }
    // Just below its limit with two particles per cell a run dies with three.
    let template = template(VIBRATION);
    let lines = [1.70, 1.0].map(|cfl| {
        let line = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark \
                    grid.cells=20 grid.particles_per_cell=2";
        configuration(&format!("{line} time.cfl={cfl}"))
    });
    let mut rows = summarise(&lines.map(|one| TimedRun::of(&template, &one, 1)));
    (rows[0].wall_time.median, rows[1].wall_time.median) = (1.0, 2.0);
    let question = Question { criterion: Criterion::Displacement, error: 0.02 };
    let found = verdict::candidates(&template, &rows, question, 2).unwrap();
    let fragile: Vec<bool> = found.iter().map(|one| one.is_fragile(question)).collect();
    assert_eq!(fragile, [true, false], "{found:?}");
    let table = String::from_utf8(verdict::table(&found).unwrap()).unwrap();
    assert_eq!(table.lines().count(), 1 + 2 * (1 + 6), "{table}");
}

/// Particles that are moved aside are the same body: mass and its centre stay, and each stays in
/// its own share.
#[test]
fn moved_particles_are_the_same_body() {
    for offset in [-0.25, 0.25] {
        let plain = dyka(&[]);
        let mut moved = plain.clone();
        moved.grid.offset = offset;
        let [before, after] = [&plain, &moved].map(|scene| {
            let (_, state) = at_start::<1>(scene);
            (setup::material_points::<1>(scene), state.particle)
        });
        let distance = 0.1333 / 80.0;
        let centre = |x: &[nalgebra::Vector1<f64>]| x.iter().map(|x| x[0]).sum::<f64>();
        assert!((centre(&before.0) / centre(&after.0) - 1.0).abs() < 1e-14);
        assert_eq!(before.1.m, after.1.m);
        for p in 0..before.0.len() {
            let aside = (after.0[p][0] - before.0[p][0]) / distance;
            let expected = if p % 2 == 0 { offset } else { -offset };
            assert!((aside - expected).abs() < 1e-9, "{p}: {aside}");
            assert_eq!(after.0[p], after.1.x[p]);
        }
    }
}

/// Verdicts on the shipped scenes, for an error of 2% in the displacement, by counted pairs: the
/// cheapest of each kind, and the worst of its neighbours.
#[test]
fn verdicts_on_shipped_scenes() {
    let mut table = String::from("scene,of,error,pairs,worst neighbour,its change,configuration\n");
    let question = Question { criterion: Criterion::Displacement, error: 0.02 };
    for (name, text) in [
        ("dyka", DYKA),
        ("vibration", VIBRATION),
        ("gravity", GRAVITY),
        ("traction", TRACTION),
        ("manufactured", MANUFACTURED),
    ] {
        let template = template(text);
        let path = directory("verdicts").join("runs.csv");
        let search = verdict::search(&template, question, &path, 2, &mut |_, _| {}).unwrap();
        for among in [Among::Mpm, Among::Otm, Among::FiniteElements] {
            let Some((tried, error)) = cheapest(&search.rows, among, Price::Pairs, question) else {
                writeln!(table, "{name},{},none,,,,", among.name()).unwrap();
                continue;
            };
            let one = &tried.configuration;
            let neighbours = verdict::neighbours(&template, one, question.criterion, 2).unwrap();
            let candidate = Candidate { tried: tried.clone(), error, neighbours };
            let (change, worst) = candidate.worst().unwrap();
            let fragile = if candidate.is_fragile(question) { " (fragile)" } else { "" };
            let worst = if worst.is_finite() { format!("{worst:.1e}") } else { "fails".into() };
            let pairs = tried.pairs().unwrap();
            writeln!(
                table,
                "{name},{},{error:.1e},{pairs},{worst}{fragile},{change},{one}",
                among.name()
            )
            .unwrap();
        }
    }
    approve("verdicts__shipped", &table);
}

/// Asked twice, the program gives one answer: all that it writes is the same but for times, and so
/// is what it recommends, though the times of runs differ. The work is the sum of the counters,
/// each times its weight.
#[test]
fn verdicts_are_the_same_twice() {
    let dir = program::directory("twice");
    let ask = |out: &str| {
        let question = ["recommend", "vibration", "--error", "1%", "--quantity", "displacement"];
        let output = program::program(&dir, &[&question[..], &["--out", out]].concat());
        assert!(output.status.success(), "{}", program::text(&output.stderr));
        let read = |name: &str| fs::read_to_string(dir.join(out).join(name)).unwrap();
        let table = read("cheapest.csv");
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let header = reader.headers().unwrap().clone();
        let time = header.iter().position(|name| name == "wall_time").unwrap();
        let untimed = |record: Result<csv::StringRecord, csv::Error>| -> Vec<String> {
            let cells = record.unwrap();
            let own = cells.iter().enumerate().filter(|(n, _)| *n != time);
            own.map(|(_, cell)| cell.to_string()).collect()
        };
        let cheapest: Vec<Vec<String>> = reader.records().map(untimed).collect();
        let runs = read("runs.csv");
        assert!(runs.lines().count() > 100);
        (read("recommended.toml"), read("neighbours.csv"), cheapest, read("displacement.svg"))
    };
    assert_eq!(ask("one"), ask("two"));
    let mut cost = Cost { steps: 2, particle_node_pairs: 30, exponentials: 5, ..Cost::default() };
    let before = work(&cost);
    cost.particle_node_pairs += 1;
    let pair = work(&cost) - before;
    assert!(
        pair > 1.0
            && (work(&Cost { particle_node_pairs: 7, ..Cost::default() }) / pair - 7.0).abs()
                < 1e-9
    );
}

/// The weights of the work meet the instructions that they were fitted to: four of five runs to a
/// fifth, the worst to two thirds.
#[test]
fn work_is_near_to_instructions() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/instructions/work.csv");
    let text = fs::read_to_string(path).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let off = |record: Result<csv::StringRecord, csv::Error>| -> f64 {
        let cells = record.unwrap();
        let count = |name: &str| {
            let at = header.iter().position(|column| column == name)?;
            cells[at].parse::<u64>().ok()
        };
        let mut cost = Cost::default();
        for (name, place) in cost.places() {
            *place = count(name).unwrap_or(0);
        }
        (work(&cost) / count("instructions").unwrap() as f64 - 1.0).abs()
    };
    let mut off: Vec<f64> = reader.records().map(off).collect();
    off.sort_by(f64::total_cmp);
    assert!(off.len() > 100 && off[off.len() * 4 / 5] < 0.2, "{off:?}");
    assert!(off[off.len() - 1] < 0.667, "{off:?}");
}
