//! All methods side by side: the committed study, its sample, and what an independent program
//! found.

use crate::support::*;
use lme_mpm::scene::DYKA;
use lme_mpm::study::configuration::Template;
use lme_mpm::study::methods::{self, Judged, MOTIONS, Pairing};
use lme_mpm::study::work::work;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// What `lme-mpm methods` has written.
const STUDY: &str = include_str!("../data/methods/methods.csv");

/// What an independent program found, written in numpy from the papers alone; a run that had no
/// end says so.
const EXPECTED: &str = include_str!("../data/methods/expected.csv");

/// The columns of what was expected: the bar, and cells crossed with two and four particles per cell.
const COLUMNS: [&str; 10] = [
    "bar_velocity",
    "bar_stress",
    "bar_displacement",
    "bar_energy",
    "two_velocity",
    "two_stress",
    "two_displacement",
    "four_velocity",
    "four_stress",
    "four_displacement",
];

fn committed() -> Vec<Judged> {
    let mut reader = csv::Reader::from_reader(STUDY.as_bytes());
    let row = |record: csv::StringRecord| {
        let cells: Vec<&str> = record.iter().collect();
        methods::read(&cells).unwrap_or_else(|| panic!("{record:?}")).1
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

/// Each method with its mass matrix: the bar, and the motion with two particles per cell and four.
fn by_method(study: &[Judged]) -> Vec<&[Judged]> {
    let three: Vec<&[Judged]> = study.chunks(3).collect();
    for rows in &three {
        let motions: Vec<&str> = rows.iter().map(|row| row.pairing.motion).collect();
        assert_eq!(motions, [MOTIONS[0], MOTIONS[1], MOTIONS[1]]);
    }
    three
}

/// What was found of a method, in the order of [`COLUMNS`]; nothing of a run that has no end.
fn found(rows: &[Judged]) -> [Option<f64>; 10] {
    let numbers = rows.iter().enumerate().flat_map(|(n, row)| {
        let worth = row.worth.as_ref().ok();
        let errors = worth.map_or([None; 3], |worth| worth.errors.map(Some));
        let energy = worth.map(|worth| worth.energy);
        errors.into_iter().chain((n == 0).then_some(energy))
    });
    numbers.collect::<Vec<_>>().try_into().unwrap()
}

fn expected() -> BTreeMap<(String, String), [Option<f64>; 10]> {
    let mut reader = csv::Reader::from_reader(EXPECTED.as_bytes());
    assert_eq!(reader.headers().unwrap().iter().skip(2).collect::<Vec<_>>(), COLUMNS);
    let row = |record: csv::StringRecord| {
        let numbers = std::array::from_fn(|n| match &record[n + 2] {
            "ends" => None,
            number => Some(number.parse::<f64>().unwrap()),
        });
        ((record[0].to_string(), record[1].to_string()), numbers)
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

/// The committed study has all rows in their order, and what takes little comes out the same when it
/// is run again: the bar with every seventh method.
#[test]
fn methods_are_current() {
    let (study, pairings) = (committed(), methods::pairings().unwrap());
    assert_eq!(study.iter().map(|row| row.pairing.clone()).collect::<Vec<_>>(), pairings);
    let sample: Vec<Pairing> =
        pairings.iter().filter(|one| one.motion == MOTIONS[0]).step_by(7).cloned().collect();
    for row in methods::study(&sample, 1, &mut || {}).unwrap() {
        assert!(study.contains(&row), "{}", row.pairing.name());
    }
    assert_eq!(String::from_utf8(methods::table(&study).unwrap()).unwrap(), STUDY);
}

/// A number as the tables show it, beside the expected one in brackets.
fn shown(found: Option<f64>, expected: Option<&Option<f64>>) -> String {
    let number = |x: Option<f64>| match x {
        None => "ends".to_string(),
        Some(x) if libm::fabs(x) >= 0.01 => format!("{x:.3}"),
        Some(x) => format!("{x:.1e}"),
    };
    match expected {
        None => number(found),
        Some(other) => format!("{} ({})", number(found), number(*other)),
    }
}

/// How many figures of a method are off by more than a fifth of the expected ones. Linear functions
/// across cells were run on after their energy had grown beyond `check.energy`, which ends them here.
/// The pieces of quadratic B-splines meet in the middle of cells here, and fits belong to cells.
const OFF: [(&str, &str, usize); 6] = [
    ("linear", "lumped", 6),
    ("linear", "consistent", 3),
    ("B-spline 2", "consistent", 1),
    ("B-spline 3", "consistent", 2),
    ("B-spline 2 + TLS 1", "lumped", 5),
    ("B-spline 2 + MLS 2", "lumped", 4),
];

/// The two kinds of motion on small grids: the digest of every history, so that a change of a bit in any
/// method shows. That they are right is the business of [`methods_side_by_side`], which judges the same methods.
#[test]
fn methods_have_these_histories() {
    let mut table = String::from("method,mass,bar of 20 cells,motion across 40 cells\n");
    let scenes = [DYKA, MANUFACTURED];
    for three in methods::pairings().unwrap().chunks(3) {
        write!(table, "{},{}", three[0].method, three[0].mass).unwrap();
        for (pairing, (text, cells)) in three.iter().zip(scenes.iter().zip(["20", "40"])) {
            let template = Template::parse(Path::new("scene.toml"), text).unwrap();
            let scene = template.scene(&pairing.configuration.with("grid.cells", cells)).unwrap();
            match outcome(&scene) {
                Ok(outcome) => {
                    let all: Vec<f64> = outcome.history.rows().flatten().copied().collect();
                    write!(table, ",{:016x}", digest(&all)).unwrap();
                }
                Err(stopped) => {
                    write!(table, ",ends at step {}", stopped.broken.moment.step).unwrap();
                }
            }
        }
        table.push('\n');
    }
    approve("methods__histories", &table);
}

/// What was found beside what was expected. All but those of [`OFF`] agree to a fifth; the work is that of
/// the counters, over that of the linear basis with the lumped mass matrix in the same motion.
#[test]
fn methods_side_by_side() {
    let (study, expected) = (committed(), expected());
    let methods = by_method(&study);
    let works = |row: &Judged| row.worth.as_ref().ok().map(|worth| work(&worth.cost));
    let mut bar = String::from("method,mass,velocity,stress,displacement,energy,work\n");
    let mut crossing = String::from(
        "method,mass,velocity (2),stress (2),displacement (2),velocity (4),stress (4),\
         displacement (4),work (4)\n",
    );
    let mut off = BTreeMap::new();
    for rows in &methods {
        let Pairing { method, mass, .. } = rows[0].pairing;
        let known = expected.get(&(method.to_string(), mass.to_string()));
        let found = found(rows);
        let cells: Vec<String> =
            (0..10).map(|n| shown(found[n], known.map(|known| &known[n]))).collect();
        let price = |n: usize, of: &[Judged]| works(&rows[n]).zip(works(&of[n]));
        let cheap = [methods[0], methods[2]]; // linear ends across cells, uGIMP does not
        let times = [price(0, cheap[0]), price(2, cheap[1])]
            .map(|price| price.map_or(String::new(), |(own, cheap)| format!("{:.1}", own / cheap)));
        writeln!(bar, "{method},{mass},{},{}", cells[..4].join(","), times[0]).unwrap();
        writeln!(crossing, "{method},{mass},{},{}", cells[4..].join(","), times[1]).unwrap();
        for n in (0..10).filter(|n| *n != 3) {
            let far = match (found[n], known.map(|known| known[n])) {
                (_, None) | (None, Some(None)) => false,
                (Some(own), Some(Some(other))) => libm::fabs(own / other - 1.0) > 0.2,
                _ => true,
            };
            if far {
                *off.entry((method, mass)).or_insert(0) += 1;
            }
        }
    }
    let listed: BTreeMap<_, _> = OFF.into_iter().map(|(name, mass, n)| ((name, mass), n)).collect();
    approve("methods__bar", &bar);
    approve("methods__crossing", &crossing);
    assert_eq!(off, listed);
}
