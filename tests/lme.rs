//! Local max-ent against 60-digit references.
#![allow(non_snake_case)]

use lme_mpm::basis::{Basis, Scratch, lme_at, tabulate};
use lme_mpm::continuum::shape::Shape;
use lme_mpm::cost::Cost;
use lme_mpm::grid::Grid;
use nalgebra::SVector;
use std::collections::BTreeMap;

fn rows(name: &str) -> Vec<Vec<String>> {
    let path = format!("{}/data/reference/{name}", env!("CARGO_MANIFEST_DIR"));
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect()
}

fn vector<const D: usize>(cells: &[String]) -> SVector<f64, D> {
    SVector::from_fn(|d, _| cells[d].parse().unwrap())
}

/// The distance in units of the last place of `expected`.
fn ulps(x: f64, expected: f64) -> f64 {
    let ulp = expected.abs().next_up() - expected.abs();
    (x - expected).abs() / ulp
}

#[derive(Default)]
struct Errors {
    points: usize,
    N: f64,
    grad: f64,
    ulp: f64,
    ulp_sum: f64,
    values: usize,
}

type Reference = BTreeMap<(usize, usize), Vec<f64>>;

fn reference() -> Reference {
    rows("lme_values.csv")
        .into_iter()
        .map(|row| {
            let values = row[2..].iter().filter(|cell| !cell.is_empty());
            let values = values.map(|cell| cell.parse().unwrap()).collect();
            ((row[0].parse().unwrap(), row[1].parse().unwrap()), values)
        })
        .collect()
}

fn nodes<const D: usize>(set: &str) -> Vec<SVector<f64, D>> {
    let all = rows("lme_nodes.csv");
    all.iter().filter(|row| row[0] == set).map(|row| vector(&row[2..])).collect()
}

fn compare<const D: usize>(
    errors: &mut Errors,
    point: usize,
    h: f64,
    computed: &[(usize, f64, SVector<f64, D>)],
    reference: &Reference,
) {
    errors.points += 1;
    let mut seen = 0;
    for (I, N, grad) in computed {
        let zero = vec![0.0; D + 1];
        let known = reference.get(&(point, *I));
        seen += usize::from(known.is_some());
        let expected = known.unwrap_or(&zero);
        errors.N = errors.N.max((N - expected[0]).abs());
        if expected[0] > 1e-8 {
            let distance = ulps(*N, expected[0]);
            errors.ulp = errors.ulp.max(distance);
            errors.ulp_sum += distance;
            errors.values += 1;
        }
        for d in 0..D {
            errors.grad = errors.grad.max(h * (grad[d] - expected[d + 1]).abs());
        }
    }
    let all = reference.range((point, 0)..(point + 1, 0)).count();
    assert_eq!(seen, all, "point {point}: a node is missing");
}

fn check<const D: usize>(
    set: &str,
    table: &mut BTreeMap<(String, String), Errors>,
    reference: &Reference,
) {
    let nodes = nodes::<D>(set);
    for row in rows("lme_points.csv").iter().filter(|row| row[1] == set) {
        let (point, gamma, h): (usize, f64, f64) =
            (row[0].parse().unwrap(), row[3].parse().unwrap(), row[4].parse().unwrap());
        let x = vector::<D>(&row[5..]);
        let label = format!("{}", row[2]);
        let (values, _) = lme_at(&nodes, h, gamma, 0.0, &x).unwrap_or_else(|failure| {
            panic!("point {point} ({set}, {label}, γ = {gamma}): {failure}")
        });
        let errors = table.entry((label.clone(), format!("{D}D"))).or_default();
        compare(errors, point, h, &values, reference);
        if set.starts_with("grid") || set == "line" {
            let top = nodes.last().unwrap();
            let cells: [usize; D] = std::array::from_fn(|d| (top[d] / h).round() as usize);
            let grid = Grid { h: SVector::repeat(h), cells, before: [0; D], upper: *top };
            let (mut shape, mut cost) = (Shape::blank(0), Cost::default());
            let basis = Basis::Lme { gamma, cutoff: 0.0 };
            tabulate(&mut shape, &mut Scratch::default(), &mut cost, &basis, &grid, &[x])
                .unwrap_or_else(|trouble| panic!("point {point}: {trouble:?}"));
            let values: Vec<_> = shape.of(0).map(|(I, N, grad)| (I, N, *grad)).collect();
            let errors = table.entry((label, format!("{D}D grid"))).or_default();
            compare(errors, point, h, &values, reference);
        }
    }
}

#[test]
fn lme_against_60_digits() {
    let reference = reference();
    let mut table = BTreeMap::new();
    for set in ["line", "far", "huge", "tiny"] {
        check::<1>(set, &mut table, &reference);
    }
    check::<2>("grid2", &mut table, &reference);
    check::<3>("grid3", &mut table, &reference);
    check::<2>("scattered2", &mut table, &reference);
    check::<3>("scattered3", &mut table, &reference);
    for ((domain, kind), e) in &table {
        println!(
            "{domain:20} {kind:10} points {:4} N {:.2e} grad {:.2e} ulp max {:8.1} mean {:.2}",
            e.points,
            e.N,
            e.grad,
            e.ulp,
            e.ulp_sum / e.values as f64
        );
    }
    for ((domain, kind), e) in &table {
        assert!(e.N < 1e-14, "{domain} {kind} N {:e}", e.N);
        assert!(e.grad < 1e-13, "{domain} {kind} grad {:e}", e.grad);
    }
}
