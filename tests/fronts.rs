//! What the error of a front is made of: waves that do not travel together, in space and in time,
//! and what a free end makes of them.

use crate::dispersion;
use crate::support::lines::{Dash, Frame, Line, lines};
use crate::support::*;
use kuva::prelude::MarkerShape::{self, *};
use lme_mpm::scene::Scene;
use std::f64::consts::PI;
use std::fmt::Write;

/// A way to compute a front: basis, mass matrix, c Δt/h, and its look.
struct Case {
    name: &'static str,
    basis: Sets,
    mass: MassCase,
    cfl: f64,
    finest: usize,
    look: (usize, MarkerShape),
}

const CASES: [Case; 5] = [
    Case {
        name: "linear lumped, c Δt/h = 0.5",
        basis: &[],
        mass: LUMPED,
        cfl: 0.5,
        finest: 320,
        look: (0, Circle),
    },
    Case {
        name: "linear consistent, 0.2",
        basis: &[],
        mass: CONSISTENT,
        cfl: 0.2,
        finest: 320,
        look: (4, Triangle),
    },
    Case {
        name: "B-splines consistent, 0.2",
        basis: &["basis.kind=bspline"],
        mass: CONSISTENT,
        cfl: 0.2,
        finest: 320,
        look: (2, Square),
    },
    Case {
        name: "LME γ = 0.8 consistent, 0.2",
        basis: &["basis.kind=lme", "basis.gamma=0.8"],
        mass: CONSISTENT,
        cfl: 0.2,
        finest: 320,
        look: (1, Diamond),
    },
    Case {
        name: "LME γ = 0.8 consistent, 0.05",
        basis: &["basis.kind=lme", "basis.gamma=0.8"],
        mass: CONSISTENT,
        cfl: 0.05,
        finest: 160,
        look: (7, TriangleDown),
    },
];

/// The fronts have run this part of the bar, from its middle, and have met no end.
const PART: f64 = 0.3;

/// The Dyka bar, free at both ends, its left half thrown so slowly that nothing moves.
fn halves(sets: &[&str], part: f64) -> Scene {
    let slow = [
        "initial_velocity.0.from=0",
        "initial_velocity.0.to=0.06665",
        "initial_velocity.0.velocity=1e-6",
        "boundary.left=free",
        "boundary.right=free",
    ];
    let end = format!("time.end={:?}", part * transit());
    dyka(&[sets, &slow, &[&end]].concat())
}

/// The error of the velocity of all particles over the speed, measured.
fn measured(case: &Case, cells: usize) -> f64 {
    let more = [format!("grid.cells={cells}"), format!("time.cfl={}", case.cfl)];
    let sets = [case.basis, case.mass.sets, &strs(&more), &["output.every=100000"]].concat();
    let scene = halves(&sets, PART);
    field_errors(&scene, &finished(&scene)).v
}

/// The same, predicted from the speeds of waves alone. A wave of θ is off by the phase N θ δ after N
/// cells, with 1 + δ its speed over c, in space and in time; of a jump J it has the part 1/θ. So a
/// front misses J² h (4/π) ∫ sin²(Nθδ/2)/θ² dθ. Waves of less than two cells stay where they are: J² h 2/π².
/// There are two fronts, each of half of the speed.
fn predicted(speeds: &[f64], cfl: f64, cells: usize) -> f64 {
    let n = cells as f64;
    let d = PI / speeds.len() as f64;
    let miss: f64 = speeds
        .iter()
        .enumerate()
        .map(|(k, speed)| {
            let theta = (k as f64 + 0.5) * d;
            let seen = 2.0 / cfl * (0.5 * cfl * speed * theta).asin() / theta;
            let phase = PART * n * theta * (seen - 1.0);
            ((0.5 * phase).sin() / theta).powi(2) * d
        })
        .sum();
    (2.0 * 0.25 / n * (4.0 / PI * miss + 2.0 / (PI * PI))).sqrt()
}

fn speeds(case: &Case) -> Vec<f64> {
    const WAVES: usize = 300;
    let theta = |k: usize| (k as f64 + 0.5) * PI / WAVES as f64;
    (0..WAVES).map(|k| dispersion::predicted(case.basis, &case.mass, theta(k))).collect()
}

/// A front in the middle of a bar has the error that the speeds of waves predict, to a fifth on 40 to
/// 320 cells, for linear functions with both matrices, B-splines and local max-ent with two time
/// steps. So the error falls as h^(1/3) where waves are off as θ², to 0.06 from 80 to 320 cells, and with local
/// max-ent, whose waves are right, and a small step, nearly as h^(1/2), as a jump between two nodes does.
#[test]
fn fronts_miss_what_dispersion_predicts() {
    let mut table = String::from("way,cells,measured,predicted\n");
    let mut drawn = Vec::new();
    let four_cells = dispersion::predicted(CASES[3].basis, &CONSISTENT, 0.5 * PI);
    assert!((four_cells - 1.0).abs() < 1e-4, "{four_cells}");
    for case in &CASES {
        let speeds = speeds(case);
        let (mut dots, mut curve) = (Vec::new(), Vec::new());
        for cells in [40, 80, 160, 320].into_iter().filter(|n| *n <= case.finest) {
            let (found, theory) = (measured(case, cells), predicted(&speeds, case.cfl, cells));
            let name = case.name.replace(',', ";");
            writeln!(table, "{name},{cells},{found:.4},{theory:.4}").unwrap();
            assert!((found / theory - 1.0).abs() < 0.2, "{name}, {cells}: {found} {theory}");
            dots.push((cells as f64, found));
        }
        let h: Vec<f64> = dots.iter().skip(1).map(|dot| 1.0 / dot.0).collect();
        let errors: Vec<f64> = dots.iter().skip(1).map(|dot| dot.1).collect();
        let expected = if case.cfl == 0.05 { 0.46 } else { 1.0 / 3.0 };
        let order = slope(&h, &errors);
        assert!((order - expected).abs() < 0.06, "{}: {order}", case.name);
        for n in 0..=40 {
            let cells = (32.0 * 20.0_f64.powf(f64::from(n) / 40.0)).round() as usize;
            curve.push((cells as f64, predicted(&speeds, case.cfl, cells)));
        }
        let (colour, marker) = case.look;
        drawn.push(Line::new("", curve, colour));
        drawn.push(Line::new(case.name, dots, colour).dashed(Dash::Nothing).marked(marker));
    }
    approve("fronts__errors", &table);
    let frame = Frame {
        x: "cells along the bar",
        y: "velocity error of the fronts",
        log: true,
        x_range: Some((30.0, 700.0)),
        y_range: Some((0.01, 0.2)),
        ..Frame::default()
    };
    approve_picture("fronts__predicted", lines(&drawn, &frame));
}

/// What the free end at the right shows after the front has come (in h/c) until 8 + `until`.
fn at_the_end(gamma: &str, sets: &[&str], until: f64) -> Vec<(f64, f64)> {
    let gamma = format!("basis.gamma={gamma}");
    let own = ["basis.kind=lme", &gamma, "grid.cells=80", "time.cfl=0.1"];
    let scene = halves(&[CONSISTENT.sets, &own, sets].concat(), 0.5 + until / 80.0);
    let history = finished(&scene).history;
    let (t, v) = (column(&history, "t"), column(&history, "velocity_end"));
    let exact = column(&history, "velocity_end_exact");
    let since = |t: f64| t / transit() * 80.0 - 40.0;
    let rows = t.iter().zip(v.iter().zip(&exact));
    rows.map(|(t, (v, exact))| (since(*t), (v - exact) / 1e-6)).filter(|row| row.0 > -4.0).collect()
}

/// A node beyond a free end rings. A front that has come to the end leaves an oscillation there that
/// hardly dies away: between 10 and 30 h/c later its root mean square is more than 4% of the speed with γ = 0.9,
/// more than 1% with 0.7, and below 0.2% with 0.8. Without that node it is below 0.5% with all three.
#[test]
fn fronts_ring_at_a_node_beyond_a_free_end() {
    let no_node = ["grid.beyond={left=0,right=0}"];
    let mut drawn = Vec::new();
    let mut table = String::from("γ,with the node,without\n");
    for (gamma, colour) in [("0.7", 0), ("0.8", 1), ("0.9", 2)] {
        let runs = [&[][..], &no_node].map(|sets| at_the_end(gamma, sets, 30.0));
        let [with, without] = runs.each_ref().map(|run| {
            let late = run.iter().filter(|row| row.0 > 10.0).map(|row| row.1 * row.1);
            (late.clone().sum::<f64>() / late.count() as f64).sqrt()
        });
        writeln!(table, "{gamma},{with:.1e},{without:.1e}").unwrap();
        let rings = match gamma {
            "0.7" => with > 0.01,
            "0.8" => with < 2e-3,
            _ => with > 0.04,
        };
        assert!(rings && without < 5e-3, "{gamma}: {with:e} {without:e}");
        let [with, without] = runs;
        drawn.push(Line::new(format!("γ = {gamma}, node beyond the end"), with, colour));
        if gamma == "0.9" {
            let line = Line::new("γ = 0.9, no node beyond it", without, 6);
            drawn.push(line.dashed(Dash::Dashed));
        }
    }
    approve("fronts__ringing", &table);
    drawn.swap(0, 2);
    let frame = Frame {
        x: "time since the front came, c t/h",
        y: "velocity error at the end / speed",
        x_range: Some((-4.0, 30.0)),
        y_range: Some((-0.2, 0.2)),
        ..Frame::default()
    };
    approve_picture("fronts__ringing_figure", lines(&drawn, &frame));
}
