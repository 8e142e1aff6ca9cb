//! What the conformance kit in `data/conformance/` is made of.

pub mod texts;

use super::*;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use texts::QUARTERS;

/// The kit's own version: it changes when a number or a column does.
const VERSION: &str = "3.0.0";

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/conformance")
}

/// One file of the kit.
pub struct Piece {
    pub level: u8,
    pub name: &'static str,
    pub says: &'static str,
    /// `KEY=VALUE` in place of the bar's own values.
    pub scene: Vec<&'static str>,
    pub class: Class,
    pub text: String,
}

/// How far a port's numbers may be from those of the kit.
#[derive(Clone, Copy, Serialize)]
pub struct Class {
    #[serde(skip)]
    pub name: &'static str,
    pub relative: f64,
    /// Of the largest value.
    pub absolute: f64,
    pub reason: &'static str,
}

const fn class(name: &'static str, relative: f64, absolute: f64, reason: &'static str) -> Class {
    Class { name, relative, absolute, reason }
}

const KERNEL: Class = class(
    "kernel",
    1e-12,
    1e-14,
    "one evaluation; λ of local max-ent may end one iteration earlier or later",
);
const STEP: Class = class("step", 1e-11, 1e-13, "sums of a few terms in another order");
const STEPS: Class = class("steps", 1e-10, 1e-12, "round-off of ten steps");
const HISTORY: Class = class(
    "history",
    1e-6,
    1e-7,
    "round-off of some hundred steps, amplified by the jump of the cut-off",
);
const LIMIT: Class = class("limit", 1e-4, 0.0, "an iteration for an eigenvalue");
const ORDER: Class = class("order", 0.0, 0.0, "between the lowest and the highest that are given");
const NONE: Class = class("none", 0.0, 0.0, "no numbers");
const CLASSES: [Class; 7] = [KERNEL, STEP, STEPS, HISTORY, LIMIT, ORDER, NONE];

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

/// The files of the kit, level by level.
pub fn kit() -> Vec<Piece> {
    let mut kit = kernels();
    kit.extend(traces());
    kit.extend(whole_runs());
    kit
}

fn piece(
    level: u8,
    name: &'static str,
    says: &'static str,
    scene: &[&'static str],
    (class, text): (Class, String),
) -> Piece {
    Piece { level, name, says, scene: scene.to_vec(), class, text }
}

/// Level 0: what is evaluated at a point.
fn kernels() -> Vec<Piece> {
    let mut kit = Vec::new();
    for (name, says, basis) in [
        ("basis_linear.csv", "linear shape functions", LINEAR),
        ("basis_ugimp.csv", "uGIMP", UGIMP),
        ("basis_bspline.csv", "quadratic B-splines", BSPLINE),
        ("basis_lme_wide.csv", "local max-ent, γ = 0.8", LME_WIDE),
        ("basis_lme_middle.csv", "local max-ent, γ = 1.8", LME_MIDDLE),
        ("basis_lme_narrow.csv", "local max-ent, γ = 4", LME_NARROW),
    ] {
        let scene = [basis.sets, &QUARTERS].concat();
        kit.push(piece(0, name, says, &scene, (KERNEL, texts::basis(basis.sets))));
    }
    let line = "elastic law in uniaxial strain from σ = 0, density from ρ = 1";
    for (name, says, text) in [
        ("law_1d.csv", line, texts::law_1d()),
        ("law_2d.csv", "the same in plane strain", texts::law_2d()),
        ("measure.csv", "root mean square (39)", texts::measure()),
        ("exact.csv", "the exact bar by Riemann invariants", texts::exact()),
    ] {
        kit.push(piece(0, name, says, &[], (KERNEL, text)));
    }
    kit
}

/// Levels 1 and 2: what is computed in one time step, and in some.
fn traces() -> Vec<Piece> {
    let small = "grid.cells=4";
    let mut kit = Vec::new();
    for (one, ten, says, basis) in [
        ("linear_1.csv", "linear_10.csv", "linear basis", LINEAR),
        ("lme_1.csv", "lme_10.csv", "local max-ent, γ = 0.8", LME_WIDE),
    ] {
        let scene = [basis.sets, &[small]].concat();
        kit.push(piece(1, one, says, &scene, (STEP, texts::traced(&scene, 1))));
        kit.push(piece(2, ten, says, &scene, (STEPS, texts::traced(&scene, 10))));
    }
    let modulus = [small, "body.poisson_ratio=0.25"];
    let says = "linear basis, Poisson's ratio 1/4: the modulus is λ + 2μ";
    kit.push(piece(1, "modulus_1.csv", says, &modulus, (STEP, texts::traced(&modulus, 1))));
    let says = "a free bar in uniform motion, whose last particle stands on a node at k = 2: the \
                node behind it has no mass";
    kit.push(piece(2, "on_node_3.csv", says, &ON_NODE, (STEPS, texts::traced(&ON_NODE, 3))));
    let cut_off = [LME_WIDE.sets, &["basis.cutoff=0.01"]].concat();
    for (name, says, sets) in [
        ("as_printed_3.csv", "step 8 as printed", &["time.reading=as-printed"][..]),
        ("stress_first_3.csv", "forward Euler, stress first", STRESS_FIRST.sets),
        ("stress_last_3.csv", "forward Euler, stress last", STRESS_LAST.sets),
        ("modified_last_3.csv", "forward Euler, stress modified-last", MODIFIED_LAST.sets),
        ("cutoff_3.csv", "local max-ent cut off at one percent", &cut_off),
    ] {
        let scene = [sets, &[small]].concat();
        kit.push(piece(2, name, says, &scene, (STEPS, texts::traced(&scene, 3))));
    }
    kit
}

/// Levels 3 to 5: histories, limits and orders, and what must fail.
fn whole_runs() -> Vec<Piece> {
    let wide = LME_WIDE.sets;
    let linear = "velocity at L and stress at 3L/4 over 4 L/c, 40 cells";
    let lme = "the same, local max-ent, γ = 0.8";
    let bands = "relative errors of the two histories against the exact solution, between";
    let limits = "largest stable c Δt / h, 8 cells";
    let orders = "order in h on the vibrating bar, between";
    let must_fail = "changes of the bar's scene that must be refused by name";
    vec![
        piece(3, "linear_history.csv", linear, &[], (HISTORY, texts::histories(&[]))),
        piece(3, "lme_history.csv", lme, wide, (HISTORY, texts::histories(wide))),
        piece(3, "bands.csv", bands, &[], (ORDER, texts::bands())),
        piece(4, "limits.csv", limits, &["grid.cells=8"], (LIMIT, texts::limits())),
        piece(4, "orders.csv", orders, &[], (ORDER, texts::orders())),
        piece(5, "must_fail.csv", must_fail, &[], (NONE, texts::must_fail())),
    ]
}

/// `manifest.json`.
#[derive(Serialize)]
struct Manifest {
    version: &'static str,
    tolerances: BTreeMap<&'static str, Class>,
    files: Vec<File>,
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
    let file = |piece: &Piece| File {
        level: piece.level,
        file: format!("level-{}/{}", piece.level, piece.name),
        says: piece.says,
        scene: piece.scene.clone(),
        columns: piece.text.lines().next().unwrap().split(',').map(String::from).collect(),
        rows: piece.text.lines().count() - 1,
        tolerance: piece.class.name,
    };
    let manifest = Manifest {
        version: VERSION,
        tolerances: CLASSES.map(|class| (class.name, class)).into(),
        files: kit.iter().map(file).collect(),
    };
    serde_json::to_string_pretty(&manifest).unwrap() + "\n"
}
