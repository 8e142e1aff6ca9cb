//! What to choose: the committed study of the bar to 640 cells, its samples, and what the book
//! says of it.

use crate::orders;
use crate::support::lines::{Dash, Frame, Line, lines, slope_triangle};
use crate::support::*;
use kuva::prelude::MarkerShape::{self, *};
use lme_mpm::study::choice::{self, CELLS, Choice, Chosen, GAMMAS};
use lme_mpm::study::measured::{Criterion, Measured};
use lme_mpm::study::ranking::{self, Tried, WallTime};
use std::fmt::Write;

/// What `lme-mpm choose` has written.
const STUDY: &str = include_str!("../data/choosing/bar.csv");

fn committed() -> Vec<(String, Chosen)> {
    let mut reader = csv::Reader::from_reader(STUDY.as_bytes());
    let row = |record: csv::StringRecord| {
        let cells: Vec<&str> = record.iter().collect();
        choice::read(&cells).unwrap_or_else(|| panic!("{record:?}"))
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

/// The committed study has all rows in their order, one of them failed, and what takes little
/// comes out the same when it is run again: the first of every eight rows on 40 cells.
#[test]
fn choosing_is_current() {
    let study = committed();
    let choices = choice::choices().unwrap();
    let names: Vec<String> = choices.iter().map(Choice::name).collect();
    assert_eq!(study.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>(), names);
    let failed: Vec<&String> =
        study.iter().filter(|(_, row)| row.measured.is_err()).map(|(name, _)| name).collect();
    assert!(failed.len() == 1 && failed[0].contains("mls") && failed[0].contains("cells=640"));
    let cheap = |choice: &&Choice| {
        let value = |key| choice.configuration.value(key);
        let step: f64 = value("time.cfl").parse().unwrap();
        value("grid.cells") == "40" && step >= 0.2
    };
    let sample: Vec<Choice> = choices.iter().filter(cheap).step_by(8).cloned().collect();
    assert!(sample.len() > 12, "{}", sample.len());
    for row in choice::study(&sample, 1, &mut || {}).unwrap() {
        let name = row.choice.name();
        let known = &study.iter().find(|(known, _)| *known == name).unwrap().1;
        assert_eq!(*known, row, "{name}");
    }
    let again = String::from_utf8(
        choice::table(&study.iter().map(|(_, row)| row.clone()).collect::<Vec<_>>()).unwrap(),
    );
    assert_eq!(again.unwrap(), STUDY);
}

/// A way to compute the bar, its name in the book, and its look.
#[derive(Clone, Copy)]
struct Way {
    name: &'static str,
    line: &'static str,
    node: bool,
    per_cell: usize,
    cfl: f64,
    look: (usize, Dash, MarkerShape),
}

const NO_NODE: &str = " grid.beyond={right=0}";
const FINITE_ELEMENTS: &str = "method=otm mass=lumped basis.kind=linear time.integrator=newmark";
const LINEAR_LUMPED: &str = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark";
const LINEAR_CONSISTENT: &str =
    "method=mpm mass=consistent basis.kind=linear time.integrator=newmark";
const SPLINE: &str = "method=mpm mass=consistent basis.kind=bspline time.integrator=newmark";
const WIDE: &str =
    "method=mpm mass=consistent basis.kind=lme basis.gamma=0.8 time.integrator=newmark";

/// The ways that are followed to 640 cells.
const WAYS: [Way; 10] = [
    Way {
        name: "linear MPM lumped",
        line: LINEAR_LUMPED,
        node: true,
        per_cell: 2,
        cfl: 0.5,
        look: (0, Dash::Solid, Circle),
    },
    Way {
        name: "linear MPM consistent",
        line: LINEAR_CONSISTENT,
        node: true,
        per_cell: 2,
        cfl: 0.2,
        look: (4, Dash::Dashed, Plus),
    },
    Way {
        name: "LME γ = 0.8 lumped",
        line: "method=mpm mass=lumped basis.kind=lme basis.gamma=0.8 time.integrator=newmark",
        node: true,
        per_cell: 2,
        cfl: 0.5,
        look: (3, Dash::Solid, Triangle),
    },
    Way {
        name: "B-splines consistent",
        line: SPLINE,
        node: true,
        per_cell: 2,
        cfl: 0.2,
        look: (2, Dash::Solid, Square),
    },
    Way {
        name: "cubic B-splines consistent",
        line: "method=mpm mass=consistent basis.kind=bspline basis.degree=3 time.integrator=newmark",
        node: true,
        per_cell: 2,
        cfl: 0.2,
        look: (9, Dash::Dashed, TriangleDown),
    },
    Way {
        name: "LME γ = 0.8 consistent",
        line: WIDE,
        node: true,
        per_cell: 2,
        cfl: 0.2,
        look: (1, Dash::Solid, Diamond),
    },
    Way {
        name: "LME γ = 0.8 no end node",
        line: WIDE,
        node: false,
        per_cell: 2,
        cfl: 0.2,
        look: (5, Dash::Dashed, Triangle),
    },
    Way {
        name: "LME no end node small step",
        line: WIDE,
        node: false,
        per_cell: 2,
        cfl: 0.05,
        look: (7, Dash::Solid, Circle),
    },
    Way {
        name: "finite elements",
        line: FINITE_ELEMENTS,
        node: true,
        per_cell: 1,
        cfl: 0.5,
        look: (6, Dash::Dashed, Plus),
    },
    Way {
        name: "finite elements near limit",
        line: FINITE_ELEMENTS,
        node: true,
        per_cell: 1,
        cfl: 0.998,
        look: (6, Dash::Solid, Cross),
    },
];

/// What the study has of a way on a grid, or why it has nothing.
fn row(
    study: &[(String, Chosen)],
    speed: &str,
    way: &Way,
    cells: usize,
) -> Result<Measured, String> {
    let Way { line, node, per_cell, cfl, .. } = way;
    let end = if *node { "" } else { NO_NODE };
    let name = format!(
        "speed={speed} {line}{end} grid.cells={cells} grid.particles_per_cell={per_cell} time.cfl={cfl}"
    );
    let row = study.iter().find(|(known, _)| *known == name);
    row.unwrap_or_else(|| panic!("no row `{name}`")).1.measured.clone()
}

fn found(study: &[(String, Chosen)], speed: &str, way: &Way, cells: usize) -> Measured {
    row(study, speed, way, cells).unwrap()
}

fn followed(study: &[(String, Chosen)], speed: &str, way: &Way) -> [f64; 5] {
    CELLS.map(|n| found(study, speed, way, n).velocity)
}

/// What the book says of the bar from 40 to 640 cells. Lumped, the linear basis is never far from
/// the best, and wide functions are never better. With the consistent matrix B-splines have two
/// thirds of the linear basis's error or less on every grid. γ = 0.8 as the scene stands keeps its
/// error within a fifth; cubic B-splines are level with it on 320 cells to a hundredth, and on 640 quadratic ones pass it, too. Without the node beyond the free
/// end its error falls at every step, and with a step a quarter as long to three eighths. Finite
/// elements near their limit have as small an error, to a tenth, with less than a hundredth of
/// the work.
#[test]
fn choosing_on_640_cells() {
    let study = committed();
    let errors: Vec<[f64; 5]> = WAYS.iter().map(|way| followed(&study, "5", way)).collect();
    let [linear, consistent, wide_lumped, spline, cubic, wide, open, small, elements, near] =
        &errors[..]
    else {
        panic!("ten ways")
    };
    for n in 0..5 {
        assert!(wide_lumped[n] > 1.1 * linear[n], "{n}");
        assert!(consistent[n] > 0.8 * linear[n] && consistent[n] < 0.9 * linear[n], "{n}");
        assert!(spline[n] < 0.68 * consistent[n] && cubic[n] < 0.9 * spline[n], "{n}");
        assert!((wide[n] / wide[0] - 1.0).abs() < 0.2, "{wide:?}");
        assert!(near[n] < 1.04 * small[n] && elements[n] < 0.85 * consistent[n], "{n}");
    }
    for n in 0..5 {
        assert!(
            open[n] < spline[n].min(cubic[n]) && small[n] < 0.5 * spline[n],
            "{n}: {open:?} {small:?}"
        );
    }
    assert!(wide[3] < spline[3] && wide[4] > spline[4], "{wide:?} {spline:?}");
    assert!(wide[2] < 0.8 * cubic[2] && wide[4] > 1.1 * cubic[4], "{wide:?} {cubic:?}");
    assert!((cubic[3] / wide[3] - 1.0).abs() < 0.01, "{wide:?} {cubic:?}");
    for falling in [linear, spline, cubic, open, small, elements, near] {
        assert!(falling.windows(2).all(|pair| pair[1] < pair[0]), "{falling:?}");
    }
    assert!(small[4] < 0.375 * small[0] && open[4] > 0.5 * open[0], "{small:?} {open:?}");
    let work = |way: usize| {
        let row = found(&study, "5", &WAYS[way], 640);
        lme_mpm::study::work::work(&row.cost)
    };
    assert!(work(9) < 0.01 * work(7), "{:e} {:e}", work(9), work(7));

    let mut table = String::from("way,c Δt/h,40 cells,80 cells,160 cells,320 cells,640 cells\n");
    for (way, errors) in WAYS.iter().zip(&errors) {
        let list = errors.map(|error| format!("{error:.4}")).join(",");
        writeln!(table, "{},{},{list}", way.name, way.cfl).unwrap();
    }
    approve("choosing__cells", &table);
    approve_picture("choosing__convergence", convergence(WAYS.iter().zip(errors)));
}

/// Draws errors over the number of cells, as many as there are.
fn convergence<'a, E: IntoIterator<Item = f64>>(
    followed: impl Iterator<Item = (&'a Way, E)>,
) -> String {
    let mut drawn: Vec<Line> = followed
        .map(|(way, errors)| {
            let points = CELLS.iter().map(|n| *n as f64).zip(errors).collect();
            let (colour, dash, marker) = way.look;
            Line::new(way.name, points, colour).dashed(dash).marked(marker)
        })
        .collect();
    let (third, third_words) = slope_triangle(230.0, 0.185, 1.0 / 3.0, "1/3");
    let (half, half_words) = slope_triangle(60.0, 0.022, 0.5, "1/2");
    drawn.extend([third, half]);
    let frame = Frame {
        x: "cells along the bar",
        y: "relative velocity error",
        log: true,
        x_range: Some((30.0, 800.0)),
        y_range: Some((0.01, 0.3)),
        notes: vec![third_words, half_words],
    };
    lines(&drawn, &frame)
}

/// Cures of crossing, on this bar where nothing crosses, beside the functions that they start from.
const CURES: [Way; 7] = [
    WAYS[0],
    Way {
        name: "dual domain lumped",
        line: "method=mpm mass=lumped basis.kind=ddmp time.integrator=newmark",
        look: (3, Dash::Solid, Triangle),
        ..WAYS[0]
    },
    WAYS[1],
    Way {
        name: "dual domain consistent",
        line: "method=mpm mass=consistent basis.kind=ddmp time.integrator=newmark",
        look: (1, Dash::Solid, Diamond),
        ..WAYS[1]
    },
    Way {
        name: "implicit linear consistent",
        line: "method=mpm mass=consistent basis.kind=linear time.integrator=implicit-newmark",
        cfl: 0.5,
        look: (7, Dash::Dashed, Cross),
        ..WAYS[1]
    },
    WAYS[3],
    Way {
        name: "B-splines + MLS consistent",
        line: "method=mpm mass=consistent basis.kind=bspline forces.reconstruction=mls \
               time.integrator=newmark",
        look: (9, Dash::Dashed, TriangleDown),
        ..WAYS[3]
    },
];

/// What cures of crossing do on the bar. The dual domain with the consistent matrix has less than two
/// thirds of the linear basis's error on 40 to 160 cells, and does not fall from 80 to 640, to a
/// twelfth. A stress by moving least squares is ahead of the sum over particles by a twelfth and more on
/// 40 to 160 cells, by a fourteenth on 320; on 640 its energy grows beyond what `check.energy` allows, and
/// the run ends. Implicit steps two and a half times as long cost nothing in accuracy: a twentieth to a
/// seventh less error than the explicit ones.
#[test]
fn choosing_cures() {
    let study = committed();
    let errors: Vec<Vec<f64>> = CURES
        .iter()
        .map(|way| CELLS.iter().map_while(|n| row(&study, "5", way, *n).ok()))
        .map(|measured| measured.map(|measured| measured.velocity).collect())
        .collect();
    let [_, _, linear, dual, implicit, spline, fitted] = &errors[..] else { panic!("seven ways") };
    let least = dual[1..].iter().fold(f64::INFINITY, |a, b| a.min(*b));
    assert!((0..3).all(|n| dual[n] < 2.0 / 3.0 * linear[n]), "{dual:?}");
    assert!(dual[1..].iter().all(|error| *error < 13.0 / 12.0 * least), "{dual:?}");
    assert!((0..3).all(|n| fitted[n] < 0.91 * spline[n]), "{fitted:?} {spline:?}");
    assert!(fitted.len() == 4 && fitted[3] < 0.93 * spline[3], "{fitted:?} {spline:?}");
    let problem = row(&study, "5", &CURES[6], 640).unwrap_err();
    assert!(problem.contains("check.energy"), "{problem}");
    let times = |n: usize| implicit[n] / linear[n];
    assert!((0..5).all(|n| times(n) < 0.95 && times(n) > 6.0 / 7.0), "{implicit:?} {linear:?}");
    let mut table = String::from("way,c Δt/h,40 cells,80 cells,160 cells,320 cells,640 cells\n");
    for (way, errors) in CURES.iter().zip(&errors) {
        let mut cells: Vec<String> = errors.iter().map(|error| format!("{error:.4}")).collect();
        cells.resize(5, "ends".to_string());
        writeln!(table, "{},{},{}", way.name, way.cfl, cells.join(",")).unwrap();
    }
    approve("choosing__cures", &table);
    approve_picture("choosing__cures_figure", convergence(CURES.iter().zip(errors)));
}

/// The velocity errors of local max-ent with the consistent matrix over γ.
fn over_gamma(study: &[(String, Chosen)], node: bool, cells: usize, per_cell: usize) -> Vec<f64> {
    let error = |gamma: f64| {
        let line = WIDE.replace("gamma=0.8", &format!("gamma={gamma}"));
        let end = if node { "" } else { NO_NODE };
        let name = format!(
            "speed=5 {line}{end} grid.cells={cells} grid.particles_per_cell={per_cell} time.cfl=0.2"
        );
        let row = study.iter().find(|(known, _)| *known == name).unwrap();
        row.1.measured.as_ref().unwrap().velocity
    };
    GAMMAS.map(error).to_vec()
}

/// γ = 0.8 is a spike where a node stands beyond the free end: with two particles per cell on 40
/// cells the error at 0.7 and 0.9 is half as much again and more; on 160 cells 0.7 is better; with
/// three and four particles its error is a third larger. Without that node there is a plateau:
/// from γ = 0.5 to 1 the error is within a quarter with two to four particles per cell, and on 160
/// cells within two percent.
#[test]
fn choosing_gamma_is_a_spike_or_a_plateau() {
    let study = committed();
    let at = |list: &[f64], gamma: f64| list[GAMMAS.iter().position(|g| *g == gamma).unwrap()];
    let spike = over_gamma(&study, true, 40, 2);
    let least = at(&spike, 0.8);
    assert!(spike.iter().all(|error| *error >= least));
    assert!([0.7, 0.9].iter().all(|gamma| at(&spike, *gamma) > 1.5 * least));
    let fine = over_gamma(&study, true, 160, 2);
    assert!(at(&fine, 0.7) < at(&fine, 0.8), "{fine:?}");
    for per_cell in [3, 4] {
        let many = over_gamma(&study, true, 40, per_cell);
        assert!(at(&many, 0.8) > 1.33 * least && at(&many, 0.9) > 1.6 * at(&many, 0.8));
    }
    let spread = |list: &[f64]| {
        let plateau = GAMMAS.iter().zip(list).filter(|(gamma, _)| **gamma <= 1.0);
        let errors: Vec<f64> = plateau.map(|(_, error)| *error).collect();
        errors.iter().fold(0.0, |a, b| f64::max(a, *b))
            / errors.iter().fold(f64::INFINITY, |a, b| a.min(*b))
    };
    for per_cell in 2..=4 {
        let flat = spread(&over_gamma(&study, false, 40, per_cell));
        assert!(flat < 1.25, "{per_cell}: {flat}");
    }
    assert!(spread(&over_gamma(&study, false, 160, 2)) < 1.02);
    let mut table = String::from("end node,cells,particles per cell");
    GAMMAS.iter().for_each(|gamma| write!(table, ",γ = {gamma}").unwrap());
    let mut drawn = Vec::new();
    for (node, cells, per_cell, colour, marker) in [
        (true, 40, 2, 1, Circle),
        (true, 40, 4, 3, Diamond),
        (true, 160, 2, 0, Square),
        (false, 40, 2, 5, Triangle),
        (false, 40, 4, 7, TriangleDown),
        (false, 160, 2, 4, Plus),
    ] {
        let errors = over_gamma(&study, node, cells, per_cell);
        let end = if node { "with" } else { "without" };
        write!(table, "\n{end},{cells},{per_cell}").unwrap();
        errors.iter().for_each(|error| write!(table, ",{error:.4}").unwrap());
        let name = format!("{end} node, {cells} cells × {per_cell}");
        let points = GAMMAS.iter().copied().zip(errors).collect();
        let dash = if node { Dash::Dashed } else { Dash::Solid };
        drawn.push(Line::new(name, points, colour).dashed(dash).marked(marker));
    }
    approve("choosing__gamma_table", &(table + "\n"));
    let frame = Frame {
        x: "γ of local max-ent",
        y: "relative velocity error",
        x_range: Some((0.4, 2.6)),
        y_range: Some((0.0, 0.14)),
        ..Frame::default()
    };
    for line in &mut drawn {
        line.points.retain(|(gamma, _)| *gamma < 2.6);
    }
    approve_picture("choosing__gamma", lines(&drawn, &frame));
}

/// With a step a quarter as long, 40 cells, no node beyond the end, smaller γ do better: from 1 over
/// 0.8 to 0.5 the error falls by a fifteenth or more each time, and it is within a quarter.
#[test]
fn choosing_gamma_with_a_small_step() {
    let line = |gamma: &str| {
        let way = WIDE.replace("gamma=0.8", &format!("gamma={gamma}"));
        format!("{way}{NO_NODE} grid.cells=40 grid.particles_per_cell=2 time.cfl=0.05")
    };
    let choice = |gamma: &str| Choice { speed: "5", configuration: line(gamma).parse().unwrap() };
    let rows = choice::study(&["0.5", "1.0"].map(choice), 1, &mut || {}).unwrap();
    let error = |row: usize| rows[row].measured.as_ref().unwrap().velocity;
    let middle = found(&committed(), "5", &WAYS[7], 40).velocity;
    assert!(error(0) < 14.0 / 15.0 * middle && middle < 14.0 / 15.0 * error(1), "{rows:?}");
    assert!(error(1) < 1.25 * error(0), "{rows:?}");
}

/// What the time step is worth, on 160 cells: for lumped linear MPM nothing to a fifth; with the
/// consistent matrix the linear basis does not feel it to a twentieth; B-splines, whose waves are
/// late, are better with large steps, which make waves early; for local max-ent, whose waves are
/// right, the step is the error: it falls by more than a half from 0.4 to 0.1.
#[test]
fn choosing_a_step() {
    let study = committed();
    let mut drawn = Vec::new();
    let mut table = String::from("way,c Δt/h,velocity error on 40 cells,on 160 cells\n");
    let mut lists = Vec::new();
    let steps = [0.4, 0.3, 0.2, 0.1, 0.05, 0.025];
    for (n, steps) in [
        (0, vec![1.38, 1.0, 0.7, 0.5, 0.25, 0.1]),
        (1, steps.to_vec()),
        (3, steps.to_vec()),
        (5, steps.to_vec()),
        (6, steps.to_vec()),
        (8, vec![0.998, 0.9, 0.7, 0.5, 0.25, 0.1]),
    ] {
        let mut points = Vec::new();
        for cfl in steps {
            let way = Way { cfl, ..WAYS[n] };
            let [coarse, fine] = [40, 160].map(|cells| found(&study, "5", &way, cells).velocity);
            writeln!(table, "{},{cfl},{coarse:.4},{fine:.4}", way.name).unwrap();
            points.push((cfl, fine));
        }
        lists.push(points.iter().map(|point: &(f64, f64)| point.1).collect::<Vec<_>>());
        let (colour, dash, marker) = WAYS[n].look;
        drawn.push(Line::new(WAYS[n].name, points, colour).dashed(dash).marked(marker));
    }
    let near = |list: &[f64], part: f64| {
        let [a, b] =
            [f64::min, f64::max].map(|pick| list[1..].iter().fold(list[0], |x, y| pick(x, *y)));
        b / a < 1.0 + part
    };
    assert!(near(&lists[0], 0.25) && near(&lists[1], 0.05), "{lists:?}");
    assert!(lists[2][0] < 0.85 * lists[2][3], "{:?}", lists[2]);
    assert!(lists[3][3] < 0.5 * lists[3][0] && lists[4][3] < 0.5 * lists[4][0], "{lists:?}");
    assert!(lists[5].windows(2).all(|pair| pair[0] < pair[1]), "{:?}", lists[5]);
    approve("choosing__steps", &table);
    let frame = Frame {
        x: "time step, c Δt/h",
        y: "relative velocity error",
        log: true,
        x_range: Some((0.02, 2.0)),
        y_range: Some((0.01, 0.2)),
        ..Frame::default()
    };
    approve_picture("choosing__courant", lines(&drawn, &frame));
}

/// The bar's own motion: the exact solution is that of a bar that stays where it is. With 5 m/s its end
/// moves by a sixth of a cell to each side on 640 cells, and what is computed differs from what a bar that
/// hardly moves has by up to a quarter there, by less than two percent on 40 cells. At rest no
/// basis passes local max-ent on any of these grids.
#[test]
fn choosing_knows_that_the_bar_moves() {
    let study = committed();
    let mut table = String::from("way,speed,40 cells,80 cells,160 cells,320 cells,640 cells\n");
    let mut last = Vec::new();
    for way in [0, 1, 3, 5, 6, 7, 8] {
        let lists = ["5", "0.001"].map(|speed| followed(&study, speed, &WAYS[way]));
        for (speed, list) in ["5 m/s", "1 mm/s"].iter().zip(&lists) {
            let cells = list.map(|error| format!("{error:.4}")).join(",");
            writeln!(table, "{},{speed},{cells}", WAYS[way].name).unwrap();
        }
        let off: Vec<f64> = (0..5).map(|n| (lists[0][n] / lists[1][n] - 1.0).abs()).collect();
        assert!(off[0] < 0.02 && off[4] < 0.27, "{}: {off:?}", WAYS[way].name);
        last.push(lists[1]);
    }
    for n in 0..5 {
        assert!(last[5][n] < last[2][n] && last[3][n] < 0.7 * last[2][n], "{last:?}");
    }
    approve("choosing__motion", &table);
}

/// The front of velocity error against work, of MPM and OTM alone and with finite elements, named.
#[test]
fn choosing_front_is_named() {
    let tried = |(_, row): (String, Chosen)| Tried {
        configuration: row.choice.configuration,
        measured: row.measured,
        wall_time: WallTime { median: 1.0, least: 1.0, largest: 1.0 },
        passes: 1,
    };
    let study = committed();
    let rows: Vec<Tried> =
        study.into_iter().filter(|(_, row)| row.choice.speed == "5").map(tried).collect();
    let front = ranking::front(&rows, Criterion::Velocity);
    let mut table = String::from(
        "number,velocity error,work [million],method,mass,basis,end node,cells,particles per cell,c Δt/h\n",
    );
    let mut line = Vec::new();
    for (n, (row, error)) in front.iter().enumerate() {
        let (one, work) = (&row.configuration, row.work().unwrap() / 1e6);
        let value = |key| one.value(key);
        let basis = one.words(&["basis.kind", "basis.gamma", "basis.degree"]);
        let node = if one.to_string().contains("beyond") { "no" } else { "yes" };
        writeln!(
            table,
            "{},{error:.4},{work:.2},{},{},{basis},{node},{},{},{}",
            n + 1,
            value("method"),
            value("mass"),
            value("grid.cells"),
            value("grid.particles_per_cell"),
            value("time.cfl")
        )
        .unwrap();
        line.push((work, *error));
    }
    assert!(front.len() > 5, "{}", front.len());
    // The least errors belong to the consistent matrix without the node beyond the end.
    let last = front.last().unwrap().0.configuration.to_string();
    assert!(last.contains(NO_NODE.trim()), "{last}");
    approve("choosing__front", &table);
    let mut drawn = vec![Line::new("front of the particle methods", line, 6)];
    for (name, family, colour, marker) in [
        ("linear MPM lumped", "linear, lumped", 0, Circle),
        ("linear MPM consistent", "linear, consistent", 4, Circle),
        ("B-splines consistent", "bspline, consistent", 2, Square),
        ("LME lumped", "lme, lumped", 3, Triangle),
        ("LME consistent", "lme, consistent", 1, Diamond),
        ("dual domain consistent", "ddmp, consistent", 9, Plus),
        ("OTM", "otm", 7, TriangleDown),
        ("finite elements", "finite elements", 6, Cross),
    ] {
        let shown = |row: &&Tried| {
            let one = &row.configuration;
            let usual = ["", "0.8", "1.8", "4"].contains(&one.value("basis.gamma"));
            one.family() == family
                && usual
                && ["1", "2"].contains(&one.value("grid.particles_per_cell"))
        };
        let own = rows.iter().filter(shown);
        let point = |row: &Tried| Some((row.work()? / 1e6, row.error(Criterion::Velocity)?));
        let points = own.filter_map(point).collect();
        drawn.push(Line::new(name, points, colour).dashed(Dash::Nothing).marked(marker));
    }
    let frame = Frame {
        x: "counted work of a run [million instructions]",
        y: "relative velocity error",
        log: true,
        x_range: Some((3.0, 2e6)),
        y_range: Some((0.01, 0.3)),
        notes: [
            (6.0, 0.2, "linear"),
            (16.0, 0.052, "OTM"),
            (2e4, 0.0165, "LME consistent"),
            (60.0, 0.0125, "finite elements"),
        ]
        .map(|(x, y, words)| (x, y, words.to_string()))
        .to_vec(),
    };
    approve_picture("choosing__work", lines(&drawn, &frame));
}

/// The error of the velocity of the motion across cells on 160 cells, after one period, by basis and
/// mass and by particles per cell.
fn across_cells(way: &str, per_cell: usize) -> f64 {
    let name =
        format!("basis.kind={way} particles_per_cell={per_cell} spans=1 volumes=own along=h");
    let study = orders::committed(orders::STUDY);
    let (_, row) = study.iter().find(|(known, _)| *known == name).unwrap();
    row.climbed.as_ref().unwrap().errors[3][0]
}

/// The page that decides: what to take for which problem, with what that makes of the velocity and
/// what its rival makes. On the bar each choice has no larger error than its rival on 640 cells, and
/// across cells on 160.
#[test]
fn choosing_verdicts() {
    let study = committed();
    let otm = Way {
        line: "method=otm mass=lumped basis.kind=lme basis.gamma=4 time.integrator=newmark",
        per_cell: 1,
        cfl: 0.95,
        ..WAYS[8]
    };
    let hasty = Way { cfl: 1.38, ..WAYS[0] };
    let bar = |way: &Way, cells: usize| found(&study, "5", way, cells).velocity;
    let mut table = String::from("problem,take,error of v,instead of,its error,measured on\n");
    let mut row = |problem: &str, take: (&str, f64), rival: (&str, f64), place: &str| {
        assert!(take.1 < rival.1, "{problem}: {} {}", take.1, rival.1);
        let number = |x: f64| if x < 1e-3 { format!("{x:.0e}") } else { format!("{x:.3}") };
        let (own, other) = (number(take.1), number(rival.1));
        writeln!(table, "{problem},{},{own},{},{other},{place}", take.0, rival.0).unwrap();
    };
    // More particles do not help a front.
    for way in [0, 1, 6] {
        let of = |per_cell| bar(&Way { per_cell, ..WAYS[way] }, 40);
        assert!([3, 4].into_iter().all(|n| of(n) > 1.05 * of(2)), "{}", WAYS[way].name);
    }
    let on_640 = "the bar with 640 cells";
    row(
        "front; no particle is needed",
        ("finite elements near their limit", bar(&WAYS[9], 640)),
        ("linear MPM with the lumped matrix", bar(&WAYS[0], 640)),
        on_640,
    );
    row(
        "front; the free end stays by its node",
        ("LME 0.8 consistent without end node; c Δt/h = 0.05", bar(&WAYS[7], 640)),
        ("B-splines consistent", bar(&WAYS[3], 640)),
        on_640,
    );
    row(
        "front; the free end passes nodes",
        ("cubic B-splines consistent", bar(&WAYS[4], 640)),
        ("LME 0.8 consistent with end node", bar(&WAYS[5], 640)),
        on_640,
    );
    row(
        "the same on a coarse grid",
        ("LME 0.8 consistent with end node", bar(&WAYS[5], 40)),
        ("cubic B-splines consistent", bar(&WAYS[4], 40)),
        "the bar with 40 cells",
    );
    row(
        "front; at a moderate cost",
        ("OTM with LME 4 at c Δt/h = 0.95", bar(&otm, 640)),
        ("linear MPM with the lumped matrix", bar(&WAYS[0], 640)),
        on_640,
    );
    row(
        "a quick look",
        ("linear MPM lumped near its limit", bar(&hasty, 160)),
        ("the same at c Δt/h = 0.5", bar(&WAYS[0], 160)),
        "the bar with 160 cells",
    );
    let crossed = "the motion across 160 cells";
    let (wide, wide_consistent) =
        ("lme basis.gamma=0.8 mass=lumped", "lme basis.gamma=0.8 mass=consistent");
    row(
        "cells are crossed; two particles per cell",
        ("LME 0.8 consistent", across_cells(wide_consistent, 2)),
        ("B-splines consistent", across_cells("bspline mass=consistent", 2)),
        crossed,
    );
    row(
        "the same with the lumped matrix",
        ("LME 0.8 lumped", across_cells(wide, 2)),
        ("uGIMP lumped", across_cells("ugimp mass=lumped", 2)),
        crossed,
    );
    row(
        "cells are crossed; eight particles per cell",
        ("LME 1.8 lumped", across_cells("lme basis.gamma=1.8 mass=lumped", 8)),
        ("LME 0.8 lumped", across_cells(wide, 8)),
        crossed,
    );
    approve("choosing__verdicts", &table);
}
