//! Orders of convergence while particles cross cells, in one to three dimensions.

use crate::support::*;
use lme_mpm::study::configuration::Template;
use lme_mpm::study::orders::{self, Ascent, Ladder};
use std::fmt::Write;
use std::path::Path;

fn template(name: &str, text: &str) -> Template {
    Template::parse(Path::new(name), text).unwrap()
}

/// Climbs ladders of the study: basis and mass, particles per cell, volumes; one span, along h.
fn climbed(template: &Template, wanted: &[(&str, usize, &str)]) -> Vec<Ascent> {
    let name = |(way, per_cell, volumes): &(&str, usize, &str)| {
        format!("basis.kind={way} particles_per_cell={per_cell} spans=1 volumes={volumes} along=h")
    };
    let find = |one| {
        let name = name(one);
        let found = orders::ladders().into_iter().find(|ladder| ladder.name() == name);
        found.unwrap_or_else(|| panic!("no ladder `{name}`"))
    };
    let ladders: Vec<Ladder> = wanted.iter().map(find).collect();
    orders::study(template, &ladders, 1, &mut || {})
}

/// Errors of the velocity on every grid, or where a run broke.
fn velocity_errors(row: &Ascent) -> Vec<f64> {
    let found = row.climbed.as_ref().unwrap_or_else(|problem| panic!("{problem}"));
    found.errors.iter().map(|error| error[0]).collect()
}

/// Lays rows out: the way, the errors of the velocity from the coarsest grid to the finest,
/// and the orders of velocity, stress and displacement.
fn table(motions: &[(&str, &[Ascent])]) -> String {
    let mut table = String::from(
        "motion,basis and mass,particles per cell,volumes,velocity errors,order of v,of σ,of u\n",
    );
    let rows = motions.iter().flat_map(|(motion, rows)| rows.iter().map(move |row| (motion, row)));
    for (motion, Ascent { ladder, climbed }) in rows {
        let name = ladder.name();
        let part = |key: &str| -> String {
            let from = name.find(key).unwrap() + key.len();
            name[from..].split(' ').next().unwrap().to_string()
        };
        let gamma = if name.contains("gamma") { format!(" {}", part("gamma=")) } else { "".into() };
        let way = format!("{}{gamma}, {}", part("kind="), part("mass="));
        let volumes = part("volumes=");
        write!(table, "{motion},\"{way}\",{},{volumes},", ladder.particles_per_cell).unwrap();
        match climbed {
            Err(_) => writeln!(table, "broke down,,,").unwrap(),
            Ok(found) => {
                let errors: Vec<String> =
                    found.errors.iter().map(|error| format!("{:.1e}", error[0])).collect();
                let orders = found
                    .orders()
                    .map(|order| format!("{:.1} ± {:.1}", order.slope, order.half_width));
                writeln!(table, "{},{}", errors.join(" "), orders.join(",")).unwrap();
            }
        }
    }
    table
}

/// The motion across cells, on 10 to 80 cells with Δt in proportion to h² (at 80 cells five to
/// each side), one period. With two particles per cell only local max-ent with γ = 0.8
/// converges; of the others the linear basis gets worse with every refinement, and uGIMP,
/// B-splines and γ = 1.8 gain less than two. With eight γ = 1.8 converges with order two, and
/// B-splines gain more than eight: what stood in the way was the sum over few particles that
/// stand anywhere in their cells. Exact volumes change none of this. uGIMP and the linear basis do
/// not converge even with eight: their gradients jump or kink where particles cross.
#[test]
fn orders_of_crossing() {
    let crossing = template("crossing", &MANUFACTURED.replace("cells = 160", "cells = 80"));
    let rows = climbed(
        &crossing,
        &[
            ("linear mass=lumped", 2, "own"),
            ("linear mass=lumped", 8, "own"),
            ("ugimp mass=lumped", 2, "own"),
            ("ugimp mass=lumped", 8, "own"),
            ("ugimp mass=lumped", 8, "exact"),
            ("bspline mass=lumped", 2, "own"),
            ("bspline mass=lumped", 2, "exact"),
            ("bspline mass=lumped", 8, "own"),
            ("lme basis.gamma=1.8 mass=lumped", 2, "own"),
            ("lme basis.gamma=1.8 mass=lumped", 2, "exact"),
            ("lme basis.gamma=1.8 mass=lumped", 8, "own"),
            ("lme basis.gamma=0.8 mass=lumped", 2, "own"),
            ("lme basis.gamma=0.8 mass=consistent", 2, "own"),
        ],
    );
    approve("orders__crossing", &table(&[("1D", &rows)]));
    let errors: Vec<Vec<f64>> = rows.iter().map(velocity_errors).collect();
    // How much smaller the error on the finest grid is than on the coarsest.
    let gain = |row: usize| errors[row][0] / errors[row][3];
    assert!(errors[0].windows(2).all(|pair| pair[0] < pair[1]), "linear: {:?}", errors[0]);
    for row in [1, 2, 5, 6, 8, 9] {
        assert!(gain(row) < 2.0, "{row}: {:?}", errors[row]);
    }
    for row in [3, 4] {
        let late = errors[row][1] / errors[row][3];
        assert!(late < 1.5, "uGIMP, eight: {:?}", errors[row]);
    }
    for row in [7, 10, 11, 12] {
        assert!(gain(row) > 8.0, "{row}: {:?}", errors[row]);
    }
    let order = rows[10].climbed.as_ref().unwrap().orders()[0];
    assert!((order.slope - 2.0).abs() < 0.3, "γ = 1.8, eight: {order}");
}

/// The axis-aligned motion in 2D (4 to 16 cells) and 3D (2 to 8), amplitude 0.05 of the side,
/// lumped mass matrix, two particles per cell along each axis: the linear basis gains less than
/// two from two halvings of h in 2D, uGIMP and γ = 1.8 more than four in both.
#[test]
fn orders_in_more_dimensions() {
    let square = AXIS_ALIGNED
        .replace("[8, 8, 8]", "[16, 16]")
        .replace("[2, 2, 2]", "[2, 2]")
        .replace("[1, 1, 1]", "[1, 1]")
        .replace(", 4.1887902047863905]", "]")
        .replace("back = { z = \"fixed\" }\n", "")
        .replace("front = { z = \"fixed\" }\n", "");
    let [linear, ugimp, wide] =
        ["linear mass=lumped", "ugimp mass=lumped", "lme basis.gamma=1.8 mass=lumped"]
            .map(|way| (way, 2, "own"));
    let in_2d = climbed(&template("square", &square), &[linear, ugimp, wide]);
    let in_3d = climbed(&template("cube", AXIS_ALIGNED), &[ugimp, wide]);
    approve("orders__axis_aligned", &table(&[("2D", &in_2d), ("3D", &in_3d)]));
    let gains: Vec<f64> = in_2d
        .iter()
        .chain(&in_3d)
        .map(|row| {
            let errors = velocity_errors(row);
            errors[0] / errors[2]
        })
        .collect();
    assert!(gains[0] < 2.0 && gains[1..].iter().all(|gain| *gain > 4.0), "{gains:?}");
}

/// The vortex, a quarter radian, B-splines, the consistent mass matrix, 10 and 20 cells: shear
/// spoils the sums over particles, so that with two per cell along each axis nothing is gained; with
/// four the error falls by more than two.
#[test]
fn orders_of_the_vortex() {
    let vortex = template("vortex", &VORTEX.replace("[40, 40]", "[20, 20]"));
    let rows = climbed(
        &vortex,
        &[
            ("bspline mass=lumped", 2, "own"),
            ("bspline mass=lumped", 4, "own"),
            ("bspline mass=consistent", 2, "own"),
            ("bspline mass=consistent", 4, "own"),
        ],
    );
    approve("orders__vortex", &table(&[("vortex", &rows)]));
    let [few, many] = [2, 3].map(|row| velocity_errors(&rows[row]));
    assert!(few[2] > 0.9 * few[1], "{few:?}");
    assert!(many[2] < 0.5 * many[1], "{many:?}");
}

/// Reads the rows of a committed study, which are what `orders --row` prints.
pub(crate) fn committed(text: &str) -> Vec<(String, Ascent)> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let records = reader.records().map(|record| record.unwrap());
    let row = |record: csv::StringRecord| {
        let cells: Vec<&str> = record.iter().skip(1).collect();
        orders::read(&cells).unwrap_or_else(|| panic!("{record:?}"))
    };
    records.map(row).collect()
}

pub(crate) const STUDY: &str = include_str!("../data/orders/manufactured.csv");

/// The committed study of the motion across cells, 20 to 160 cells, has all ladders, and those
/// of the linear basis with two particles per cell come out the same when they are climbed again.
#[test]
fn orders_of_the_committed_study_are_current() {
    let study = committed(STUDY);
    let names: Vec<String> = orders::ladders().iter().map(Ladder::name).collect();
    assert_eq!(study.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>(), names);
    let whole = template("manufactured", MANUFACTURED);
    let again = climbed(&whole, &[("linear mass=lumped", 2, "own")]);
    let found = study.iter().find(|(name, _)| *name == again[0].ladder.name()).unwrap();
    assert_eq!(found.1, again[0]);
}

/// The committed study as the book shows it: by basis and mass the error of the velocity on 160
/// cells, and its order in h, by particles per cell, after one period and after five.
#[test]
fn orders_of_the_committed_study_are_laid_out() {
    let study = committed(STUDY);
    let mut text = String::from("basis and mass,periods,1,2,3,4,8\n");
    for (name, row) in &study {
        let ladder = &row.ladder;
        let own = name.ends_with("volumes=own along=h");
        if !own {
            continue;
        }
        if ladder.particles_per_cell == 1 {
            let way = name.split(" particles").next().unwrap();
            let way = ["basis.", "kind=", "gamma=", "mass="]
                .iter()
                .fold(way.to_string(), |way, part| way.replace(part, ""));
            write!(text, "{way},{}", ladder.spans).unwrap();
        }
        let cell = match &row.climbed {
            Err(_) => "broke".to_string(),
            Ok(found) if found.errors[3][0] > 0.3 => "lost".to_string(),
            Ok(found) => {
                format!("{:.0e} ({:.1})", found.errors[3][0], found.orders()[0].slope)
            }
        };
        write!(text, ",{cell}").unwrap();
        if ladder.particles_per_cell == 8 {
            text.push('\n');
        }
    }
    approve("orders__study", &text);
    // What gains a factor of four from 40 to 160 cells in one period and in five, with two
    // particles per cell or more: γ = 0.8, and γ = 1.8 with eight; nothing else, and γ = 1.8 with
    // four only after five periods with the lumped matrix.
    for (name, Ascent { ladder, climbed }) in &study {
        let between = name.contains("gamma=1.8") && ladder.particles_per_cell == 4;
        if between || ladder.particles_per_cell == 1 || !name.ends_with("volumes=own along=h") {
            continue;
        }
        let gains = climbed.as_ref().is_ok_and(|found| {
            let late = found.errors[1][0] / found.errors[3][0];
            late > 4.0
        });
        let expected = name.contains("gamma=0.8")
            || (name.contains("gamma=1.8") && ladder.particles_per_cell == 8);
        assert_eq!(gains, expected, "{name}: {climbed:?}");
    }
}
