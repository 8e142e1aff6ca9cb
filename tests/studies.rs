//! The studies: their configurations, their logs, and what they find on the bar.

use crate::support::*;
use lme_mpm::output::figure;
use lme_mpm::scene::DYKA;
use lme_mpm::scene::fault::Fault;
use lme_mpm::study::configuration::{Configuration, Template};
use lme_mpm::study::gamma;
use lme_mpm::study::pool;
use lme_mpm::study::trade::{
    self, LEVELS, QUANTITIES, Run, Summary, cheapest, front, grid, read_log, runs, scene_digest,
    summarise,
};
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

/// A configuration is its name, and the scene that it makes is what it says; keys of
/// the template that mean nothing to it are gone.
#[test]
fn configurations_make_scenes() {
    let template = dyka_template();
    for (text, expected) in [
        (
            "mpm/lumped/linear/newmark/2/3/0.25",
            &["grid.cells=80", "grid.particles_per_cell=3", "time.cfl=0.25"][..],
        ),
        (
            "mpm/consistent/lme-0.8-1e-3/forward-euler-last/1/2/0.5",
            &[
                "mass=consistent",
                "basis={ kind = 'lme', gamma = 0.8, cutoff = 1e-3 }",
                "time.integrator=forward-euler",
                "time.stress_update=last",
            ],
        ),
        (
            "mpm/lumped/ugimp/generalized-alpha-0.8/0.5/2/0.5",
            &[
                "grid.cells=20",
                "basis.kind=ugimp",
                "time.integrator=generalized-alpha",
                "time.rho_b=0.8",
            ],
        ),
        (
            "otm/lumped/lme-4/newmark/1/1/0.9",
            &[
                "method=otm",
                "basis={kind='lme',gamma=4}",
                "grid.particles_per_cell=1",
                "time.cfl=0.9",
            ],
        ),
    ] {
        let one = configuration(text);
        assert_eq!(one.to_string(), text);
        let mut expected = dyka(expected);
        expected.name = "scene".into();
        assert_eq!(template.scene(&one).unwrap(), expected, "{text}");
    }
    // From a scene with another basis, integrator and room beyond the body.
    let text = DYKA
        .replace("kind = \"linear\"", "kind = \"lme\"\ngamma = 2\ncutoff = 1e-4")
        .replace("integrator = \"newmark\"", "integrator = \"generalized-alpha\"\nrho_b = 0.5")
        .replace("cells = 40", "cells = 40\nbeyond = { left = 2, right = 3 }");
    let template = Template::parse(Path::new("other.toml"), &text).unwrap();
    let scene = template.scene(&configuration("mpm/lumped/linear/newmark/2/2/0.5")).unwrap();
    assert_eq!(scene.grid.beyond, [[4, 6]]);
    template.scene(&configuration("otm/lumped/lme-4/newmark/1/1/0.5")).unwrap();
    for bad in
        ["", "mpm/lumped", "mpm/lumped/linear/newmark/0/1/1", "mpm/lumped/linear/newmark/1/x/1"]
    {
        assert!(matches!(bad.parse::<Configuration>(), Err(Fault::Argument { .. })), "{bad}");
    }
    let bad = configuration("mpm/lumped/cubic/newmark/1/2/0.5");
    assert!(matches!(template.scene(&bad), Err(Fault::Scene(_))));
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

fn small_grid() -> Vec<Configuration> {
    [
        "otm/lumped/linear/newmark/0.25/1/0.99",
        "mpm/lumped/linear/newmark/0.25/2/0.5",
        "mpm/lumped/lme-0.8/newmark/0.25/2/0.5",
        "mpm/lumped/ugimp/generalized-alpha-0.5/0.25/2/0.9", // beyond its limit
    ]
    .map(configuration)
    .to_vec()
}

fn plain(runs: &[Run]) -> Vec<(String, usize, Result<Vec<f64>, String>)> {
    let mut list: Vec<_> =
        runs.iter().map(|run| (run.configuration.clone(), run.pass, run.result.clone())).collect();
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
    let whole = runs(&template, &grid, &path, 2, &mut |_, _| told += 1).unwrap();
    assert_eq!((whole.len(), told), (grid.len() * trade::PASSES, grid.len() * trade::PASSES));
    let text = fs::read_to_string(&path).unwrap();
    for cut in [0, 9, text.len() / 3, text.len() / 2, text.len() - 5] {
        fs::write(&path, &text[..cut]).unwrap();
        let lines = text[..cut].lines().count();
        let mut told = 0;
        let again = runs(&template, &grid, &path, 1, &mut |_, _| told += 1).unwrap();
        assert!(told <= whole.len() && told + lines >= whole.len());
        assert_eq!(plain(&again), plain(&whole));
        let read = read_log(&path, &scene_digest(&template)).unwrap();
        assert_eq!(plain(&read), plain(&whole));
    }
    let rows = summarise(&whole);
    assert_eq!(rows.len(), 4);
    assert!(rows.iter().all(|row| row.passes == trade::PASSES));
    let failed: Vec<&Summary> = rows.iter().filter(|row| row.result.is_err()).collect();
    assert_eq!(failed.len(), 1);
    assert!(failed[0].configuration.contains("generalized"));
    let table = String::from_utf8(trade::table(&rows).unwrap()).unwrap();
    assert_eq!(table.lines().count(), 5);
    assert!(table.contains("blew up") || table.contains("used up"), "{table}");
    // Another scene's log is refused, and so is another file.
    let other = Template::parse(Path::new("v.toml"), VIBRATION).unwrap();
    assert!(matches!(runs(&other, &grid, &path, 1, &mut |_, _| {}), Err(Fault::Argument { .. })));
    fs::write(&path, "x,y\n1,2\n").unwrap();
    assert!(matches!(
        runs(&template, &grid, &path, 1, &mut |_, _| {}),
        Err(Fault::Argument { .. })
    ));
}

fn made_up(configuration: &str, time: f64, error: f64) -> Summary {
    let result = if error.is_nan() { Err("blew up".into()) } else { Ok(vec![error; 12]) };
    let configuration = configuration.to_string();
    Summary { configuration, result, wall_time: [time; 3], passes: 3 }
}

/// The median of the passes, their least and largest.
#[test]
fn trade_takes_the_median() {
    let run = |pass, wall_time| {
        let result = Ok(vec![0.1; 12]);
        Run { configuration: "mpm/a".into(), pass, result, wall_time }
    };
    let rows = summarise(&[run(1, 5.0), run(2, 1.0), run(3, 2.0)]);
    assert_eq!((rows.len(), rows[0].wall_time, rows[0].passes), (1, [2.0, 1.0, 5.0], 3));
}

/// With two probes of one quantity its error is the root of their mean square; with
/// loads the balance of energy stands for its drift.
#[test]
fn trade_takes_all_probes_and_loads() {
    let two = GRAVITY.replace(
        "[[probe]]",
        "[[probe]]\nname = \"displacement_middle\"\nquantity = \"displacement\"\nposition = 5\n\n[[probe]]",
    );
    let two = two.replacen(
        "[[probe]]\nname = \"displacement_middle\"\nquantity = \"displacement\"\nposition = 5\n\n",
        "",
        1,
    );
    let template = Template::parse(Path::new("two.toml"), &two).unwrap();
    let one = configuration("mpm/lumped/linear/newmark/1/2/0.5");
    let list = trade::time(&template, &one, 1).result.unwrap();
    let scene = template.scene(&one).unwrap();
    assert_eq!(scene.probes.len(), 3);
    let outcome = finished(&scene);
    let of = |name: &str| crate::support::value(&scene, &outcome, name);
    let (end, middle) =
        (of("displacement_end_rms_relative"), of("displacement_middle_rms_relative"));
    let mean = f64::sqrt(0.5 * (end * end + middle * middle));
    assert!((list[2] / mean - 1.0).abs() < 1e-12 && end != middle);
    assert!(list[3] > 0.0 && list[3] == of("energy_balance_largest"));
}

/// The front holds those that nobody beats; the cheapest is the fastest below the
/// level; finite elements are neither.
#[test]
fn trade_front_and_cheapest() {
    let rows = [
        made_up("mpm/a", 3.0, 0.1),
        made_up("mpm/b", 1.0, 0.3),
        made_up("mpm/c", 2.0, 0.35), // slower and worse than b
        made_up("mpm/d", 9.0, 0.1),  // slower than a, no better
        made_up("mpm/e", 10.0, 0.01),
        made_up("mpm/f", 0.1, f64::NAN),
        made_up("otm/lumped/linear/newmark/1/1/1", 0.01, 1e-6),
    ];
    let names = |list: Vec<&Summary>| {
        list.iter().map(|row| row.configuration.as_str()).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(names(front(&rows, 0)), "mpm/b mpm/a mpm/e");
    for (level, name) in [(0.4, "mpm/b"), (0.3, "mpm/b"), (0.2, "mpm/a"), (0.05, "mpm/e")] {
        assert_eq!(cheapest(&rows, 0, level).unwrap().configuration, name);
    }
    assert_eq!(cheapest(&rows, 0, 1e-3), None);
    let table = String::from_utf8(trade::cheapest_table(&rows).unwrap()).unwrap();
    assert_eq!(table.lines().count(), 1 + LEVELS.len() * QUANTITIES.len());
    assert!(table.contains("velocity,0.001,none,,"), "{table}");
}

/// The quick study on the grid of the scene itself: errors and counted cost, which are
/// the same on every machine; a table and a diagram for the book.
#[test]
fn trade_on_the_bar() {
    let template = dyka_template();
    let all = grid(&template, false).unwrap();
    assert!(all.len() > 100, "{}", all.len());
    let own: Vec<Configuration> = all.into_iter().filter(|one| one.refinement == 1.0).collect();
    let mut timed: Vec<Option<Run>> = vec![None; own.len()];
    let work = |one: &Configuration| trade::time(&template, one, 1);
    pool::run(&own, 2, work, |n, run| {
        timed[n] = Some(run);
        Ok::<(), ()>(())
    })
    .unwrap();
    let mut table = String::from(
        "configuration,velocity,stress,displacement,energy drift,pairs,exponentials,steps\n",
    );
    let mut works = Vec::new();
    for run in timed.into_iter().map(Option::unwrap) {
        match &run.result {
            Ok(list) => {
                let (pairs, exponentials, steps) = (list[5], list[6], list[4]);
                writeln!(
                    table,
                    "{},{:.4},{:.4},{:.5},{:.4},{pairs},{exponentials},{steps}",
                    run.configuration, list[0], list[1], list[2], list[3]
                )
                .unwrap();
                let group = trade::family(&run.configuration);
                works.push(figure::Work { work: pairs, error: Some(list[0]), group });
            }
            Err(problem) => writeln!(
                table,
                "{},{},,,,,,",
                run.configuration,
                problem.split_once("s: ").map_or(problem.as_str(), |(_, what)| what)
            )
            .unwrap(),
        }
    }
    approve("trade__bar", &table);
    let title = "Velocity error against counted work, 40 cells";
    let x_label = "pairs of particle and node";
    let svg = figure::work_precision(title, x_label, &works, &Vec::new());
    approve_picture("trade__bar_figure", svg);
}

/// The study of γ: the finite-element end is the linear basis; with the consistent
/// mass matrix there is a best γ in the middle, where waves of eight cells travel at
/// the right speed to a thousandth; lumped, they are late.
#[test]
fn gamma_from_end_to_end() {
    let rows = gamma::rows(2, &mut || {}).unwrap();
    let value = |way: &str, gamma: f64, name: &str| {
        let row = rows.iter().find(|row| row.way == way && row.gamma == gamma).unwrap();
        let column = gamma::COLUMNS.iter().position(|column| *column == name).unwrap();
        row.values.as_ref().unwrap()[column]
    };
    let linear = dyka(&[]);
    let error = crate::support::value(&linear, &finished(&linear), "velocity_end_rms_relative");
    let end = value("mpm lumped", 50.0, "velocity");
    assert!((end / error - 1.0).abs() < 1e-9, "{end} and {error}");
    let best = gamma::GAMMAS
        .into_iter()
        .min_by(|a, b| {
            let of = |gamma| value("mpm consistent", gamma, "velocity");
            of(*a).total_cmp(&of(*b))
        })
        .unwrap();
    assert_eq!(best, 0.8);
    assert!(value("mpm consistent", 0.8, "dispersion").abs() < 1e-3);
    assert!(value("mpm lumped", 0.8, "dispersion") < -0.1);
    assert!((value("otm", 50.0, "critical_courant") - 1.0).abs() < 1e-3);
    let mut table = String::from("way,γ");
    for name in gamma::COLUMNS {
        write!(table, ",{}", name.replace('_', " ")).unwrap();
    }
    for row in &rows {
        let list = row.values.as_ref().unwrap();
        write!(table, "\n{},{}", row.way, row.gamma).unwrap();
        for x in list {
            write!(
                table,
                ",{}",
                if x.abs() < 0.01 { format!("{x:.1e}") } else { format!("{x:.3}") }
            )
            .unwrap();
        }
    }
    approve("gamma__study", &(table + "\n"));
    let curves = |column: usize| -> Vec<(String, figure::Points)> {
        gamma::WAYS
            .iter()
            .map(|way| {
                let own = rows.iter().filter(|row| row.way == way.0);
                let point =
                    |row: &gamma::Row| (row.gamma, row.values.as_ref().unwrap()[column].abs());
                (way.0.to_string(), own.map(point).collect())
            })
            .collect()
    };
    let title = "Velocity error of the bar against γ, 40 cells";
    let svg = figure::log_curves(title, "γ [–]", "relative error [–]", &curves(0));
    approve_picture("gamma__velocity", svg);
    let title = "Frequency error of a wave of eight cells";
    let svg = figure::log_curves(title, "γ [–]", "relative error, size [–]", &curves(5));
    approve_picture("gamma__dispersion", svg);
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
