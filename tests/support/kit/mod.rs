//! What the conformance kit in `data/conformance/` is made of.

pub mod texts;

use super::*;
use lme_mpm::method::choice::Law;
use lme_mpm::port::noise::FLOORS;
use lme_mpm::scene::DYKA;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use texts::{BOXES, CELLS, QUARTERS};

/// The kit's own version: it changes when a number or a column does.
const VERSION: &str = "4.0.0";

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/conformance")
}

/// One file of the kit.
pub struct Piece {
    pub level: u8,
    pub name: &'static str,
    pub says: &'static str,
    /// The scene that it starts from.
    pub base: Base,
    /// `KEY=VALUE` in place of that scene's own values.
    pub scene: Vec<&'static str>,
    pub class: Class,
    pub text: String,
}

/// A scene of the kit: its file beside the manifest, and its text.
#[derive(Clone, Copy)]
pub struct Base {
    pub file: &'static str,
    pub text: &'static str,
}

pub const BAR: Base = Base { file: "../scenes/dyka.toml", text: DYKA };
pub const STRIP: Base =
    Base { file: "strip.toml", text: include_str!("../../../data/conformance/strip.toml") };
pub const BLOCK: Base =
    Base { file: "block.toml", text: include_str!("../../../data/conformance/block.toml") };
pub const TWO_DISCS: Base =
    Base { file: "discs.toml", text: include_str!("../../../data/conformance/discs.toml") };

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
pub const ON_NODE: [&str; 12] = [
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
    kit.extend(kernels_in_more_dimensions());
    kit.extend(traces());
    kit.extend(traces_of_methods());
    kit.extend(traces_in_more_dimensions());
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
    Piece { level, name, says, base: BAR, scene: scene.to_vec(), class, text }
}

/// The trace of `steps` time steps from another scene than the bar.
fn trace_of(
    base: Base,
    level: u8,
    name: &'static str,
    says: &'static str,
    sets: &[&'static str],
    steps: usize,
) -> Piece {
    let class = if level == 1 { STEP } else { STEPS };
    let text = texts::traced(base.text, sets, steps);
    Piece { base, ..piece(level, name, says, sets, (class, text)) }
}

/// Level 0: what is evaluated at a point.
fn kernels() -> Vec<Piece> {
    let mut kit = Vec::new();
    let dual = "dual domain: cells count that hold a point of this list";
    let list: [(_, _, &[&str]); 8] = [
        ("basis_linear.csv", "linear shape functions", LINEAR.sets),
        ("basis_ugimp.csv", "uGIMP", UGIMP.sets),
        ("basis_bspline.csv", "quadratic B-splines", BSPLINE.sets),
        ("basis_cubic.csv", "cubic B-splines", &CUBIC),
        ("basis_ddmp.csv", dual, &["basis.kind=ddmp"]),
        ("basis_lme_wide.csv", "local max-ent, γ = 0.8", LME_WIDE.sets),
        ("basis_lme_middle.csv", "local max-ent, γ = 1.8", LME_MIDDLE.sets),
        ("basis_lme_narrow.csv", "local max-ent, γ = 4", LME_NARROW.sets),
    ];
    for (name, says, sets) in list {
        let scene = [sets, &QUARTERS].concat();
        kit.push(piece(0, name, says, &scene, (KERNEL, texts::basis(sets))));
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

/// Level 0 in 2D and 3D: points inside, on nodes and faces, on sides and corners of the grid.
fn kernels_in_more_dimensions() -> Vec<Piece> {
    let mut kit = Vec::new();
    let in_2d: [(_, _, &[&str]); 9] = [
        ("basis_2d_cubic.csv", "cubic B-splines", &CUBIC),
        ("basis_2d_ddmp.csv", "dual domain, as in 1D", &["basis.kind=ddmp"]),
        ("basis_2d_linear.csv", "linear shape functions", &[]),
        ("basis_2d_ugimp.csv", "uGIMP", &["basis.kind=ugimp"]),
        ("basis_2d_bspline.csv", "quadratic B-splines", &["basis.kind=bspline"]),
        ("basis_2d_lme_wide.csv", "local max-ent, γ = 0.8, in a box", &WIDE),
        ("basis_2d_lme_wide_ball.csv", "the same in a ball", &WIDE_BALL),
        ("basis_2d_lme_narrow.csv", "local max-ent, γ = 12, in a box", &NARROW),
        ("basis_2d_lme_narrow_ball.csv", "the same in a ball", &NARROW_BALL),
    ];
    for (name, says, sets) in in_2d {
        let scene = [sets, &CELLS].concat();
        let text = texts::basis_in::<2>(STRIP.text, &scene, &texts::PLACES_2D);
        kit.push(Piece { base: STRIP, ..piece(0, name, says, &scene, (KERNEL, text)) });
    }
    for (name, says, sets) in [
        ("basis_3d_linear.csv", "linear shape functions", &[][..]),
        ("basis_3d_lme.csv", "local max-ent, γ = 4, in a box", LME_NARROW.sets),
    ] {
        let scene = [sets, &BOXES].concat();
        let text = texts::basis_in::<3>(BLOCK.text, &scene, &texts::PLACES_3D);
        kit.push(Piece { base: BLOCK, ..piece(0, name, says, &scene, (KERNEL, text)) });
    }
    let says = "elastic law and density in three dimensions";
    kit.push(piece(0, "law_3d.csv", says, &[], (KERNEL, texts::law_3d())));
    for (name, says, law) in [
        ("law_neo_hookean.csv", "neo-Hookean stress of F in plane strain", Law::NeoHookean),
        ("law_hencky.csv", "Hencky's stress of F in plane strain", Law::Hencky),
    ] {
        kit.push(piece(0, name, says, &[], (KERNEL, texts::law_of_deformation(law))));
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
        kit.push(piece(1, one, says, &scene, (STEP, texts::traced(DYKA, &scene, 1))));
        kit.push(piece(2, ten, says, &scene, (STEPS, texts::traced(DYKA, &scene, 10))));
    }
    let modulus = [small, "body.poisson_ratio=0.25"];
    let says = "linear basis, Poisson's ratio 1/4: the modulus is λ + 2μ";
    kit.push(piece(1, "modulus_1.csv", says, &modulus, (STEP, texts::traced(DYKA, &modulus, 1))));
    let says = "a free bar in uniform motion, whose last particle stands on a node at k = 2: the \
                node behind it has no mass";
    kit.push(piece(2, "on_node_3.csv", says, &ON_NODE, (STEPS, texts::traced(DYKA, &ON_NODE, 3))));
    let cut_off = [LME_WIDE.sets, &["basis.cutoff=0.01"]].concat();
    for (name, says, sets) in [
        ("as_printed_3.csv", "step 8 as printed", &["time.reading=as-printed"][..]),
        ("stress_first_3.csv", "forward Euler, stress first", STRESS_FIRST.sets),
        ("stress_last_3.csv", "forward Euler, stress last", STRESS_LAST.sets),
        ("modified_last_3.csv", "forward Euler, stress modified-last", MODIFIED_LAST.sets),
        ("cutoff_3.csv", "local max-ent cut off at one percent", &cut_off),
    ] {
        let scene = [sets, &[small]].concat();
        kit.push(piece(2, name, says, &scene, (STEPS, texts::traced(DYKA, &scene, 3))));
    }
    kit
}

const CUBIC: [&str; 2] = ["basis.kind=bspline", "basis.degree=3"];
const WIDE: [&str; 2] = ["basis.kind=lme", "basis.gamma=0.8"];
const WIDE_BALL: [&str; 3] = ["basis.kind=lme", "basis.gamma=0.8", "basis.support=ball"];
const NARROW: [&str; 2] = ["basis.kind=lme", "basis.gamma=12"];
const NARROW_BALL: [&str; 3] = ["basis.kind=lme", "basis.gamma=12", "basis.support=ball"];
/// Particles so near to a node along x that a box and a ball leave other nodes.
const NEAR_NODES: [&str; 2] = ["grid.cells=[2,1]", "grid.particles_per_cell=[8,1]"];

/// Level 2: three time steps of the bar with each basis, scheme, mass and method.
fn traces_of_methods() -> Vec<Piece> {
    let otm = ["method=otm", "basis.kind=lme", "basis.gamma=4"];
    let one = [&otm[..], &["grid.particles_per_cell=1"]].concat();
    let renewed = [&otm[..], &["nodal_mass=renewed-keeping-momentum"]].concat();
    let wide_consistent = [LME_WIDE.sets, &["mass=consistent"]].concat();
    let hencky = ["body.law=hencky", "time.kinematics=consistent"];
    let updated = [&otm[..], &["basis.metric=updated"]].concat();
    let fitted = ["basis.kind=bspline", "forces.reconstruction=mls"];
    let list: [(_, _, &[&str]); 18] = [
        ("cubic_3.csv", "cubic B-splines", &CUBIC),
        ("gimp_3.csv", "GIMP, whose domains stretch", &["basis.kind=gimp"]),
        ("ddmp_3.csv", "dual domain", &["basis.kind=ddmp"]),
        ("null_space_3.csv", "the mean of each cell's stresses", &["filter=null-space"]),
        ("tls_3.csv", "a stress fitted in each cell", &["forces.reconstruction=tls"]),
        ("mls_3.csv", "quadratic B-splines, a stress fitted about each Gauss point", &fitted),
        ("implicit_3.csv", "implicit Newmark", &["time.integrator=implicit-newmark"]),
        ("otm_updated_3.csv", "OTM, γ = 4, with the updated metric", &updated),
        ("ugimp_3.csv", "uGIMP", UGIMP.sets),
        ("bspline_3.csv", "quadratic B-splines", BSPLINE.sets),
        ("generalized_alpha_3.csv", "generalized-α with ρ_b = 0.8", GENERALIZED_ALPHA.sets),
        ("corrected_euler_3.csv", "corrected Euler", CORRECTED_EULER.sets),
        ("consistent_3.csv", "consistent mass matrix", CONSISTENT.sets),
        ("consistent_lme_3.csv", "the same, local max-ent, γ = 0.8", &wide_consistent),
        ("otm_one_3.csv", "OTM with one point in a cell, γ = 4", &one),
        ("otm_two_3.csv", "OTM with two points in a cell, γ = 4", &otm),
        ("otm_renewed_3.csv", "the same with masses renewed, keeping momentum", &renewed),
        ("hencky_3.csv", "Hencky's law with consistent kinematics", &hencky),
    ];
    let piece = |(name, says, sets): (_, _, &[&'static str])| {
        trace_of(BAR, 2, name, says, &[sets, &["grid.cells=4", "time.cfl=0.2"]].concat(), 3)
    };
    list.into_iter().map(piece).collect()
}

/// Levels 1 and 2 in 2D and 3D.
fn traces_in_more_dimensions() -> Vec<Piece> {
    let roller = ["boundary.left={x='fixed'}", "boundary.top={x='fixed'}", "traction.top=[0,3e4]"];
    let near = |sets: &[&'static str]| [sets, &NEAR_NODES].concat();
    let (near_box, near_ball) = (near(&NARROW), near(&NARROW_BALL));
    let otm = ["method=otm", "basis.kind=lme", "basis.gamma=4"];
    let finite = ["body.law=neo-hookean", "time.kinematics=consistent"];
    let list: [(Base, u8, _, _, &[&str], usize); 20] = [
        (STRIP, 2, "strip_gimp_2.csv", "GIMP, whose domains stretch", &["basis.kind=gimp"], 2),
        (STRIP, 2, "strip_ddmp_2.csv", "dual domain", &["basis.kind=ddmp"], 2),
        (STRIP, 2, "strip_cubic_2.csv", "cubic B-splines", &CUBIC, 2),
        (STRIP, 1, "strip_linear_1.csv", "linear basis", &[], 1),
        (STRIP, 1, "strip_lme_1.csv", "local max-ent, γ = 0.8, in a box", &WIDE, 1),
        (BLOCK, 1, "block_linear_1.csv", "linear basis in 3D", &[], 1),
        (BLOCK, 1, "block_lme_1.csv", "local max-ent in 3D, γ = 4", LME_NARROW.sets, 1),
        (STRIP, 2, "strip_linear_3.csv", "linear basis", &[], 3),
        (STRIP, 2, "strip_ugimp_2.csv", "uGIMP", UGIMP.sets, 2),
        (STRIP, 2, "strip_bspline_2.csv", "quadratic B-splines", BSPLINE.sets, 2),
        (STRIP, 2, "strip_lme_2.csv", "local max-ent, γ = 0.8, in a box", &WIDE, 2),
        (STRIP, 2, "strip_lme_ball_2.csv", "the same in a ball", &WIDE_BALL, 2),
        (STRIP, 2, "strip_narrow_2.csv", "local max-ent, γ = 12, in a box", &near_box, 2),
        (STRIP, 2, "strip_narrow_ball_2.csv", "the same in a ball", &near_ball, 2),
        (STRIP, 2, "strip_rollers_3.csv", "sides that hold one component each", &roller, 3),
        (STRIP, 2, "strip_consistent_2.csv", "consistent mass matrix", CONSISTENT.sets, 2),
        (STRIP, 2, "strip_alpha_2.csv", "generalized-α, ρ_b = 0.8", GENERALIZED_ALPHA.sets, 2),
        (STRIP, 2, "strip_neo_hookean_2.csv", "neo-Hookean law, consistent kinematics", &finite, 2),
        (STRIP, 2, "strip_otm_2.csv", "OTM, γ = 4", &otm, 2),
        (TWO_DISCS, 2, "discs_2.csv", "discs in flight: strains are round-off", &[], 2),
    ];
    let piece =
        |(base, level, name, says, sets, steps)| trace_of(base, level, name, says, sets, steps);
    list.into_iter().map(piece).collect()
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
    /// Scales below which the absolute tolerance of a symbol does not go, in words.
    floors: BTreeMap<&'static str, &'static str>,
    files: Vec<File>,
}

#[derive(Serialize)]
struct File {
    level: u8,
    file: String,
    says: &'static str,
    base: &'static str,
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
        base: piece.base.file,
        scene: piece.scene.clone(),
        columns: piece.text.lines().next().unwrap().split(',').map(String::from).collect(),
        rows: piece.text.lines().count() - 1,
        tolerance: piece.class.name,
    };
    let manifest = Manifest {
        version: VERSION,
        tolerances: CLASSES.map(|class| (class.name, class)).into(),
        floors: FLOORS.into(),
        files: kit.iter().map(file).collect(),
    };
    serde_json::to_string_pretty(&manifest).unwrap() + "\n"
}
