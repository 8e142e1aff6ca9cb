//! What the conformance kit in `data/conformance/` is made of.

use super::*;
use lme_mpm::method::continuum::law::{self, LinearElastic};
use lme_mpm::method::exact::Fields;
use lme_mpm::method::measure::rms;
use lme_mpm::port::trace::{self, Entry, TraceRecorder, hex, number};
use lme_mpm::run::stability::predicted;
use nalgebra::{Matrix1, Matrix2, SMatrix, Vector1};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The kit's own version: it changes when a number or a column does.
const VERSION: &str = "3.0.0";

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/conformance")
}

/// A number as decimal and hexadecimal cells.
fn both(x: f64) -> String {
    format!("{},{}", lme_mpm::run::table::shortest(x), hex(x))
}

/// One file of the kit.
pub struct Piece {
    pub level: u8,
    pub name: &'static str,
    pub says: &'static str,
    /// `KEY=VALUE` in place of the bar's own values.
    pub scene: Vec<&'static str>,
    /// Tolerance class; see `tolerances` in the manifest.
    pub class: &'static str,
    pub text: String,
}

/// The bar that level 0 tabulates shape functions on: cells of a quarter of a metre, so
/// that places in cells are exact and a forgotten h shows.
const QUARTERS: [&str; 5] =
    ["body.length=2", "grid.cells=8", "time.end=1", "initial_velocity=[]", "probe=[]"];

/// What level 0 gives stands in step 0, what a port makes of it after: a basis at points
/// inside a cell, on nodes, beside them, near the end.
fn basis_values(sets: &[&str]) -> String {
    let model = lme_mpm::setup::model::<1>(&dyka(&[sets, &QUARTERS].concat()));
    let tabulated = |points: &[Vector1<f64>]| on_grid(&model.basis, &model.grid, points);
    let places = [0.25, 0.5, 1.0, 2.75, 3.999, 4.0, 4.001, 6.5, 7.75, 8.0];
    let places = places.map(|cells| Vector1::new(0.25 * cells));
    // uGIMP's particles must not reach beyond the grid.
    let places: Vec<_> = places.into_iter().filter(|x| tabulated(&[*x]).is_ok()).collect();
    let table = tabulated(&places).unwrap();
    let mut kernel = TraceRecorder::default();
    for (p, x) in places.iter().enumerate() {
        kernel.at(0, 0).components("x_p", p, x.as_slice());
    }
    kernel.at(0, 2).shapes(&table.shape);
    kernel.gradients(&table.shape);
    if let Basis::Lme { .. } = model.basis {
        kernel.multipliers(&table.lambda, &model.grid.h);
    }
    in_both(&kernel.entries)
}

/// c = 1 and all numbers are multiples of 1/16: a free bar flies on, and its last
/// particle comes to stand on its last node.
const ON_NODE: [&str; 12] = [
    "body.length=4",
    "body.density=1",
    "body.youngs_modulus=1",
    "grid.cells=4",
    "grid.beyond.left=0",
    "time.end=2",
    "boundary.left=free",
    "initial_velocity.0.from=0",
    "initial_velocity.0.to=4",
    "initial_velocity.0.velocity=0.25",
    "probe.0.position=4",
    "probe.1.position=3",
];

fn law_values<const D: usize>(strains: [SMatrix<f64, D, D>; 3]) -> String {
    let mut kernel = TraceRecorder::default();
    let mut k = 0;
    for (E, nu) in [(200e9, 0.0), (1000.0, 0.3), (7.0, -0.4)] {
        for d_eps in strains {
            let law = LinearElastic::new(E, nu);
            let sigma = law.stress_increment(&d_eps);
            kernel.at(k, 0).components("E", 0, &[E]);
            kernel.at(k, 0).components("nu", 0, &[nu]);
            kernel.at(k, 0).components("d_eps_p", 0, d_eps.as_slice());
            kernel.at(k, 6).components("rho_p", 0, &[law::density(1.0, &d_eps).unwrap()]);
            kernel.at(k, 6).components("sigma_p", 0, sigma.as_slice());
            kernel.at(k, 6).components("W_p", 0, &[law.energy_density(&sigma)]);
            k += 1;
        }
    }
    in_both(&kernel.entries)
}

fn measure_values() -> String {
    let mut kernel = TraceRecorder::default();
    let cases: [(&[f64], &[f64]); 3] = [
        (&[3.0, 1.0], &[0.0, 5.0]),
        (&[1.0, -1.0], &[0.0, 0.0]),
        (&[0.1, 0.2, 0.4], &[0.1, 0.25, 0.3]),
    ];
    for (k, (computed, exact)) in cases.into_iter().enumerate() {
        for (n, (phi, phi_exact)) in computed.iter().zip(exact).enumerate() {
            kernel.at(k, 0).components("phi", n, &[*phi]);
            kernel.at(k, 0).components("phi_exact", n, &[*phi_exact]);
        }
        let pairs = computed.iter().copied().zip(exact.iter().copied());
        kernel.at(k, 1).components("rms", 0, &[rms(pairs)]);
    }
    in_both(&kernel.entries)
}

fn exact_values() -> String {
    let exact = lme_mpm::setup::exact(&dyka(&[])).unwrap();
    let mut places = Vec::new();
    for x in [0.0, 0.05, 0.099, 0.12, 0.1333] {
        for tau in [0.1, 0.3, 0.9, 1.6, 2.1, 2.9, 3.6, 3.9, 17.3] {
            places.push((x, tau * transit()));
        }
    }
    let fields: Vec<Fields> = places.iter().map(|(x, t)| exact.at(*x, *t)).collect();
    let mut kernel = TraceRecorder::default();
    let mut column = |step: usize, symbol: &'static str, values: Vec<f64>| {
        for (n, value) in values.into_iter().enumerate() {
            kernel.at(0, step).components(symbol, n, &[value]);
        }
    };
    column(0, "x", places.iter().map(|place| place.0).collect());
    column(0, "t", places.iter().map(|place| place.1).collect());
    column(1, "v", fields.iter().map(|fields| fields.velocity).collect());
    column(1, "sigma", fields.iter().map(|fields| fields.stress).collect());
    column(1, "u", fields.iter().map(|fields| fields.displacement).collect());
    in_both(&kernel.entries)
}

/// A trace with one column more, the value in hexadecimal.
fn in_both(entries: &[Entry]) -> String {
    let decimal = String::from_utf8(trace::csv(entries, false).unwrap()).unwrap();
    let mut lines = decimal.lines();
    let mut text = format!("{},hex\n", lines.next().unwrap());
    for (line, entry) in lines.zip(entries) {
        assert_eq!(number(&hex(entry.value)), Some(entry.value));
        writeln!(text, "{line},{}", hex(entry.value)).unwrap();
    }
    text
}

fn traced(sets: &[&str], steps: usize) -> String {
    in_both(&trace::trace(&dyka(sets), steps).unwrap())
}

/// What the probes of the bar follow: its last particle, and the one nearest to 3L/4.
fn histories(sets: &[&str]) -> String {
    let mut entries = trace::trace(&dyka(sets), 320).unwrap();
    entries.retain(|entry| match (entry.step, entry.symbol) {
        (9, "v_p") => entry.index == 79,
        (6, "sigma_p") => entry.index == 59,
        _ => false,
    });
    in_both(&entries)
}

/// The errors of the two histories with a tenth of room on both sides.
fn bands(lme: &[&str]) -> String {
    let mut text = String::from("basis,quantity,error,lowest,highest\n");
    for (basis, sets) in [("linear", &[][..]), ("lme γ = 0.8", lme)] {
        let scene = dyka(sets);
        let outcome = finished(&scene);
        for quantity in ["velocity_end", "stress_three_quarter"] {
            let error = value(&scene, &outcome, &format!("{quantity}_rms_relative"));
            let (low, high) = (0.9 * error, 1.1 * error);
            writeln!(text, "{basis},{quantity},{error:.6},{low:.6},{high:.6}").unwrap();
        }
    }
    text
}

fn limits() -> String {
    let mut text = String::from("basis,mass,integrator,particles_per_cell,courant,courant_hex\n");
    for (basis, sets) in BASES {
        for mass in ["lumped", "consistent"] {
            for (scheme, more) in SCHEMES {
                let fixed = [format!("mass={mass}"), "grid.cells=8".to_string()];
                let fixed: Vec<&str> = fixed.iter().map(String::as_str).collect();
                let scene = dyka(&[sets, more, &fixed[..]].concat());
                let courant = scene.courant_number_of(predicted(&scene, 0.0).unwrap());
                // Six digits: it comes from an iteration.
                let rounded: f64 = format!("{courant:.5}").parse().unwrap();
                writeln!(text, "{basis},{mass},{scheme},2,{}", both(rounded)).unwrap();
            }
        }
    }
    text
}

fn orders() -> String {
    let mut text = String::from("basis,mass,quantity,lowest,highest\n");
    for (quantity, order) in [("velocity", 2.0), ("displacement", 2.0), ("stress", 1.0)] {
        for mass in ["lumped", "consistent"] {
            writeln!(text, "linear,{mass},{quantity},{},{}", order - 0.05, order + 0.05).unwrap();
        }
    }
    text
}

/// Scenes that must be refused, or must break down, with what the reason is about.
pub const MUST_FAIL: [(&str, &str, &str); 8] = [
    ("density = 7833", "density = -7833", "body.density"),
    ("cells = 40", "cells = 0", "grid.cells"),
    ("poisson_ratio = 0", "poisson_ratio = 0.5", "body.poisson_ratio"),
    ("kind = \"linear\"", "kind = \"lme\"\ngamma = 0", "basis.gamma"),
    ("cfl = 0.5", "cfl = nan", "time.cfl"),
    ("velocity = 5", "velocity = inf", "initial_velocity.velocity"),
    ("to = 0.1333", "to = 0.2", "initial_velocity.to"),
    ("velocity = 5", "velocity = -1e7", "a breakdown in the first steps"),
];

fn must_fail() -> String {
    let mut text = String::from("replace,by,must_name\n");
    for (from, to, names) in MUST_FAIL {
        writeln!(
            text,
            "{},{},{names}",
            from.replace('"', "'"),
            to.replace('"', "'").replace('\n', " / ")
        )
        .unwrap();
    }
    text
}

pub fn kit() -> Vec<Piece> {
    let small = "grid.cells=4";
    let piece = |level, name, says, scene: &[&'static str], class, text| Piece {
        level,
        name,
        says,
        scene: scene.to_vec(),
        class,
        text,
    };
    let mut kit = Vec::new();
    for (name, says, sets) in [
        ("basis_linear.csv", "linear shape functions", BASES[0].1),
        ("basis_ugimp.csv", "uGIMP", BASES[1].1),
        ("basis_bspline.csv", "quadratic B-splines", BASES[2].1),
        ("basis_lme_wide.csv", "local max-ent, γ = 0.8", BASES[3].1),
        ("basis_lme_middle.csv", "local max-ent, γ = 1.8", BASES[4].1),
        ("basis_lme_narrow.csv", "local max-ent, γ = 4", BASES[5].1),
    ] {
        let scene = [sets, &QUARTERS].concat();
        kit.push(piece(0, name, says, &scene, "kernel", basis_values(sets)));
    }
    let line = law_values([1e-3, 0.1, -0.2].map(Matrix1::new));
    let plane = law_values(
        [[1e-3, 2e-4, -4e-4], [0.0, 0.1, 0.0], [-0.2, 0.0, 0.3]]
            .map(|[xx, xy, yy]| Matrix2::new(xx, xy, xy, yy)),
    );
    for (name, says, text) in [
        ("law_1d.csv", "elastic law in uniaxial strain from σ = 0, density from ρ = 1", line),
        ("law_2d.csv", "the same in plane strain", plane),
        ("measure.csv", "root mean square (39)", measure_values()),
        ("exact.csv", "the exact bar by Riemann invariants", exact_values()),
    ] {
        kit.push(piece(0, name, says, &[], "kernel", text));
    }
    let lme: &[&'static str] = &["basis.kind=lme", "basis.gamma=0.8"];
    for (name, ten, says, sets) in [
        ("linear_1.csv", "linear_10.csv", "linear basis", &[][..]),
        ("lme_1.csv", "lme_10.csv", "local max-ent, γ = 0.8", lme),
    ] {
        let scene = [sets, &[small]].concat();
        kit.push(piece(1, name, says, &scene, "step", traced(&scene, 1)));
        kit.push(piece(2, ten, says, &scene, "steps", traced(&scene, 10)));
    }
    let modulus = [small, "body.poisson_ratio=0.25"];
    kit.push(piece(
        1,
        "modulus_1.csv",
        "linear basis, Poisson's ratio 1/4: the modulus is λ + 2μ",
        &modulus,
        "step",
        traced(&modulus, 1),
    ));
    kit.push(piece(
        2,
        "on_node_3.csv",
        "a free bar in uniform motion, whose last particle stands on a node at k = 2: the node \
         behind it has no mass",
        &ON_NODE,
        "steps",
        traced(&ON_NODE, 3),
    ));
    for (name, says, sets) in [
        ("as_printed_3.csv", "step 8 as printed", &["time.reading=as-printed"][..]),
        ("stress_first_3.csv", "forward Euler, stress first", SCHEMES[2].1),
        ("stress_last_3.csv", "forward Euler, stress last", SCHEMES[3].1),
        ("modified_last_3.csv", "forward Euler, stress modified-last", SCHEMES[4].1),
        (
            "cutoff_3.csv",
            "local max-ent cut off at one percent",
            &["basis.kind=lme", "basis.gamma=0.8", "basis.cutoff=0.01"],
        ),
    ] {
        let scene = [sets, &[small]].concat();
        kit.push(piece(2, name, says, &scene, "steps", traced(&scene, 3)));
    }
    kit.push(piece(
        3,
        "linear_history.csv",
        "velocity at L and stress at 3L/4 over 4 L/c, 40 cells",
        &[],
        "history",
        histories(&[]),
    ));
    kit.push(piece(
        3,
        "lme_history.csv",
        "the same, local max-ent, γ = 0.8",
        lme,
        "history",
        histories(lme),
    ));
    kit.push(piece(
        3,
        "bands.csv",
        "relative errors of the two histories against the exact solution, between",
        &[],
        "order",
        bands(lme),
    ));
    kit.push(piece(
        4,
        "limits.csv",
        "largest stable c Δt / h, 8 cells",
        &["grid.cells=8"],
        "limit",
        limits(),
    ));
    kit.push(piece(
        4,
        "orders.csv",
        "order in h on the vibrating bar, between",
        &[],
        "order",
        orders(),
    ));
    kit.push(piece(
        5,
        "must_fail.csv",
        "changes of the bar's scene that must be refused by name",
        &[],
        "none",
        must_fail(),
    ));
    kit
}

/// Tolerance classes: relative, absolute (of the largest value), and why.
pub const CLASSES: [(&str, f64, f64, &str); 7] = [
    (
        "kernel",
        1e-12,
        1e-14,
        "one evaluation; λ of local max-ent may end one iteration earlier or later",
    ),
    ("step", 1e-11, 1e-13, "sums of a few terms in another order"),
    ("steps", 1e-10, 1e-12, "round-off of ten steps"),
    (
        "history",
        1e-6,
        1e-7,
        "round-off of some hundred steps, amplified by the jump of the cut-off",
    ),
    ("limit", 1e-4, 0.0, "an iteration for an eigenvalue"),
    ("order", 0.0, 0.0, "between the lowest and the highest that are given"),
    ("none", 0.0, 0.0, "no numbers"),
];

/// `manifest.json`.
#[derive(Serialize)]
struct Manifest {
    version: &'static str,
    tolerances: BTreeMap<&'static str, Class>,
    files: Vec<File>,
}

#[derive(Serialize)]
struct Class {
    relative: f64,
    absolute: f64,
    reason: &'static str,
}

#[derive(Serialize)]
struct File {
    level: u8,
    file: String,
    says: &'static str,
    scene: Vec<&'static str>,
    columns: Vec<String>,
    rows: usize,
    tolerance: &'static str,
}

pub fn manifest(kit: &[Piece]) -> String {
    let class = |(name, relative, absolute, reason)| (name, Class { relative, absolute, reason });
    let file = |piece: &Piece| File {
        level: piece.level,
        file: format!("level-{}/{}", piece.level, piece.name),
        says: piece.says,
        scene: piece.scene.clone(),
        columns: piece.text.lines().next().unwrap().split(',').map(String::from).collect(),
        rows: piece.text.lines().count() - 1,
        tolerance: piece.class,
    };
    let manifest = Manifest {
        version: VERSION,
        tolerances: CLASSES.into_iter().map(class).collect(),
        files: kit.iter().map(file).collect(),
    };
    serde_json::to_string_pretty(&manifest).unwrap() + "\n"
}
