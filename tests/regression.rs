//! Pins: tables and pictures as approved, in `snapshots/`; the histories are
//! pinned in `matrix.rs`.
//!
//! A pin says "same as before". What says "right" stands in `analytical.rs`
//! and `convergence.rs`. After a change that is meant to change results, run
//! the command in the README and give the cause of each difference in the
//! commit message.

use crate::support::*;
use lme_mpm::method::exact::Exact;
use lme_mpm::output::figure;
use lme_mpm::output::summary;
use lme_mpm::run::Outcome;
use lme_mpm::run::table::shortest;
use lme_mpm::scene::Scene;
use std::fmt::Write;

/// Errors of the bar by basis, with energy and cost beside them. Whatever the
/// basis, the errors stay below those of a run that is merely stable, v ≤ 0.25
/// and σ ≤ 0.4, and they fall with the grid.
#[test]
fn dyka_errors_of_every_basis() {
    let mut text = String::from(
        "basis,velocity at L,stress at 3L/4,displacement field,largest energy drift,\
         pairs per particle,exponentials per particle and step\n",
    );
    for (name, sets) in BASES {
        let value = |scene: &Scene, outcome: &Outcome, name: &str| {
            let lines = summary::lines(scene, outcome, 0.0);
            lines.iter().find(|line| line.quantity == name).unwrap().value
        };
        let scene = dyka(sets);
        let outcome = finished(&scene);
        let fine = dyka(&[sets, &["grid.cells=160"]].concat());
        let fine_outcome = finished(&fine);
        write!(text, "{name}").unwrap();
        let bounds =
            [("velocity_end", 0.25), ("stress_three_quarter", 0.4), ("displacement_field", 0.1)];
        for (probe, bound) in bounds {
            let name = format!("{probe}_rms_relative");
            let error = value(&scene, &outcome, &name);
            let error_fine = value(&fine, &fine_outcome, &name);
            assert!(error < bound && error_fine < 0.85 * error, "{name}: {error}, {error_fine}");
            write!(text, ",{error:.4}").unwrap();
        }
        let drift = value(&scene, &outcome, "energy_drift_largest");
        assert!(drift < 0.02, "{name}: {drift}");
        let cost = outcome.cost;
        let per_point = |count: u64| count as f64 / cost.basis_evaluations as f64;
        writeln!(
            text,
            ",{drift:.5},{:.2},{:.2}",
            per_point(cost.particle_node_pairs),
            per_point(cost.exponentials)
        )
        .unwrap();
    }
    approve("dyka__errors_by_basis", &text);
}

/// The picture in the README, and its companion, as the program draws them.
#[test]
fn dyka_figures() {
    let scene = dyka(&[]);
    let history = finished(&scene).history;
    for probe in &scene.probes {
        let svg = figure::probe(&scene, probe, &history);
        approve_picture(&format!("dyka__{}", probe.name), svg);
    }
}

/// Figs. 5 and 6 of the paper, and the fronts behind them.
#[test]
fn exact_figures() {
    let Ok(Exact::Linear { thrown: bar, .. }) = lme_mpm::setup::exact(&dyka(&[])) else {
        panic!("the bar has an exact solution");
    };
    let (length, time) = (bar.length, bar.length / bar.c());
    let velocity = |tau: f64| bar.at(length, tau * time).velocity;
    let title = "Exact velocity at the free end of the Dyka and Ingel bar";
    let svg = figure::exact_history(title, "velocity v [m/s]", 8.0, velocity);
    approve_picture("exact__velocity_end", svg);
    let stress = |tau: f64| bar.at(0.75 * length, tau * time).stress * 1e-6;
    let title = "Exact stress at 3L/4 of the Dyka and Ingel bar";
    let svg = figure::exact_history(title, "stress σ [MPa]", 8.0, stress);
    approve_picture("exact__stress_three_quarter", svg);
    approve_picture("exact__fronts", figure::fronts(&bar, 4.0));
}

/// The same picture twice in one process is the same text.
#[test]
fn figures_are_repeatable() {
    let scene = dyka(&["grid.cells=4"]);
    let history = finished(&scene).history;
    let draw = || figure::probe(&scene, &scene.probes[0], &history);
    assert_eq!(draw(), draw());
    assert!(draw().contains("clip-1") && !draw().contains("kuva-clip"));
}

/// All figures of the bar's summary that do not depend on the machine.
#[test]
fn dyka_summary() {
    let scene = dyka(&[]);
    let outcome = finished(&scene);
    let mut lines = summary::lines(&scene, &outcome, 0.0);
    lines.retain(|line| line.quantity != "wall_time");
    lines.extend(summary::cost_lines(&outcome.cost));
    let mut text = String::from("quantity,value,unit\n");
    for line in lines {
        writeln!(text, "{},{},{}", line.quantity, shortest(line.value), line.unit).unwrap();
    }
    approve("dyka__summary", &text);
}

/// Errors of the bar against the number of cells: table, picture, slopes.
#[test]
fn dyka_convergence() {
    let names = ["velocity_end", "stress_three_quarter", "displacement_field"];
    let labels = ["velocity at L", "stress at 3L/4", "displacement field"];
    let cells = [40.0, 80.0, 160.0, 320.0, 640.0];
    let mut lists: Vec<(&str, Vec<(f64, f64)>)> =
        labels.iter().map(|label| (*label, Vec::new())).collect();
    let mut text = String::from(
        "cells,velocity at L,stress at 3L/4,displacement field,largest energy drift\n",
    );
    for n in cells {
        let scene = dyka(&[&format!("grid.cells={n}")]);
        let lines = summary::lines(&scene, &finished(&scene), 0.0);
        let value = |name: &str| lines.iter().find(|line| line.quantity == name).unwrap().value;
        write!(text, "{n}").unwrap();
        for (list, name) in lists.iter_mut().zip(names) {
            let error = value(&format!("{name}_rms_relative"));
            list.1.push((n, error));
            write!(text, ",{error:.5}").unwrap();
        }
        writeln!(text, ",{:.5}", value("energy_drift_largest")).unwrap();
    }
    approve("dyka__errors", &text);
    approve_picture("dyka__convergence", figure::convergence("Errors of the bar", &lists));
    let h: Vec<f64> = cells.iter().map(|n| 1.0 / n).collect();
    let mut text = String::from("quantity,value,unit\n");
    for ((_, list), name) in lists.iter().zip(names) {
        let errors: Vec<f64> = list.iter().map(|point| point.1).collect();
        writeln!(text, "{name}_order,{:.4},1", slope(&h, &errors)).unwrap();
    }
    approve("dyka__orders", &text);
}

/// What wins where (§6.1): the bases on the bar with both mass matrices, each at
/// its own grid, with energy drift and counted cost beside the errors. The figures
/// of the book's comparison.
#[test]
fn comparison_on_the_bar() {
    let lumped = ["mass=lumped", "time.cfl=0.5"];
    let consistent = ["mass=consistent", "time.cfl=0.2"];
    let mut table = String::from(
        "basis,mass,cells,velocity at L,stress at 3L/4,displacement field,largest energy drift,pairs per particle and step,steps\n",
    );
    let mut lists: Vec<(String, figure::CurvePoints)> = Vec::new();
    for (basis, sets) in BASES.iter().filter(|(name, _)| !name.contains("1.8")) {
        for (mass, mass_sets) in [("lumped", lumped), ("consistent", consistent)] {
            let mut points = Vec::new();
            for cells in [40, 80, 160] {
                let cells_set = format!("grid.cells={cells}");
                let scene = dyka(&[sets, &mass_sets[..], &[cells_set.as_str()]].concat());
                let outcome = finished(&scene);
                let of = |name: &str| value(&scene, &outcome, name);
                let v = of("velocity_end_rms_relative");
                let cost = outcome.cost;
                let pairs = cost.particle_node_pairs as f64 / cost.basis_evaluations as f64;
                writeln!(
                    table,
                    "{basis},{mass},{cells},{v:.4},{:.4},{:.5},{:.4},{pairs:.1},{}",
                    of("stress_three_quarter_rms_relative"),
                    of("displacement_field_rms_relative"),
                    of("energy_drift_largest"),
                    cost.steps
                )
                .unwrap();
                points.push((f64::from(cells), v));
            }
            if ["linear", "bspline", "lme γ = 0.8"].contains(basis) {
                lists.push((format!("{basis}, {mass}"), points));
            }
        }
    }
    approve("comparison__bar", &table);
    let lists: Vec<(&str, figure::CurvePoints)> =
        lists.iter().map(|(name, points)| (name.as_str(), points.clone())).collect();
    let title = "Velocity error of the bar by basis and mass matrix";
    approve_picture("comparison__bar_figure", figure::convergence(title, &lists));
}

/// The velocity of the bar's end: linear basis with the lumped mass matrix
/// against local max-ent with the consistent one.
#[test]
fn comparison_histories() {
    let best = ["mass=consistent", "time.cfl=0.2", "basis.kind=lme", "basis.gamma=0.8"];
    let mut lists = Vec::new();
    for (name, sets) in [("linear, lumped", &[][..]), ("lme γ = 0.8, consistent", &best)] {
        let history = finished(&dyka(sets)).history;
        let column = |name: &str| history.column(name).unwrap();
        let t = column("t").into_iter().map(|t| t * 1e6);
        lists.push((name.to_string(), t.zip(column("velocity_end")).collect()));
    }
    let title = "Velocity at the free end, 40 cells";
    let svg = figure::curves(title, "time t [µs]", "velocity v [m/s]", &lists);
    approve_picture("comparison__velocity_end", svg);
}

/// The manufactured motion of the bar's middle over two periods, by basis.
#[test]
fn comparison_across_cells() {
    let linear = MANUFACTURED.replace("kind = \"lme\"\ngamma = 0.8", "kind = \"linear\"");
    let mut lists = Vec::new();
    for n in [0, 1, 3] {
        let (name, sets) = BASES[n];
        let sets = [sets, &["time.end=0.04", "output.every=20"]].concat();
        let history = finished(&scene(&linear, &sets)).history;
        let column = |name: &str| history.column(name).unwrap();
        let points = column("t").into_iter().map(|t| t * 1e3).zip(column("displacement_middle"));
        lists.push((name.to_string(), points.collect()));
        if n == 3 {
            let exact = column("displacement_middle_exact");
            lists.push(("exact".into(), column("t").iter().map(|t| t * 1e3).zip(exact).collect()));
        }
    }
    let svg = figure::curves(
        "Manufactured motion: the middle of the bar",
        "time t [ms]",
        "displacement u [m]",
        &lists,
    );
    approve_picture("manufactured__displacement", svg);
}

/// The discs when they touch.
#[test]
fn discs_figure() {
    let scene = scene(DISCS, &["time.end=1.9"]);
    let svg = figure::particles(&scene, &finished(&scene).particles, scene.time.end);
    approve_picture("discs__contact", svg);
}
