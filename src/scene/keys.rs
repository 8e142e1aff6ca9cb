//! The keys that a scene may hold are written once: each with what its value may be, what holds
//! without it, and a line of help. Reading, refusing, the JSON Schema and the book's scene
//! reference all ask this table.

use super::kind::Kind::{self, *};
use super::kind::{Number, any, between, plain, positive, whole};
use crate::method::basis::Basis;
use std::ops::Bound::{Excluded, Included, Unbounded};

/// A key of a scene has a path, and all that is to be known about its value.
#[derive(Clone, Copy)]
pub struct Key {
    /// Its dotted path. The entries of a list share one; `<side>` stands for a name of
    /// [`SIDES`], `<axis>` for one of [`AXES`].
    pub path: &'static str,
    pub kind: Kind,
    pub without: Without,
    /// What else the value must be, with regard to the rest of the scene; may be empty.
    pub besides: &'static str,
    /// The key and its word that this one goes with; it means nothing with another word.
    pub with: Option<(&'static str, &'static str)>,
    pub help: &'static str,
}

/// This says what holds where a scene does not have a key.
#[derive(Clone, Copy)]
pub enum Without {
    /// The table is incomplete; for a key that goes with a word, where that word is chosen.
    Refused,
    Number(f64),
    Word(&'static str),
    Flag(bool),
    /// What these words say.
    Says(&'static str),
}

/// The axes have these names.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// The lower and the upper side along each axis have these names.
pub const SIDES: [[&str; 2]; 3] = [["left", "right"], ["bottom", "top"], ["back", "front"]];

/// Columns and files of a run, and the lines of its summary, have these names already.
const TAKEN: &[&str] = &[
    "step",
    "t",
    "kinetic_energy",
    "strain_energy",
    "work",
    "equilibrium_iterations",
    "equilibrium_residual",
    "momentum",
    "momentum_x",
    "momentum_y",
    "momentum_z",
    "angular_momentum",
    "angular_momentum_x",
    "angular_momentum_y",
    "angular_momentum_z",
    "particles",
    "displacement_field",
    "velocity_field",
    "stress_field",
    "energy",
];

const STATES: &[&str] = &["fixed", "free"];
const COMPONENTS: &[&str] = &["x", "y", "z", "xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];
const FROM_1: Number = whole(1.0, Unbounded);
const MODE: Number = whole(1.0, Included(1000.0));
const RAMP: Number = Number { least: Included(0.0), ..any("s") };

/// All keys stand here, in the order of the book's reference.
pub const KEYS: &[Key] = &[
    must("title", Text, "What summary and pictures are headed with"),
    must("method", Choice(&["mpm", "otm"]), "Particles on a grid, or on nodes that move"),
    may(
        "nodal_mass",
        Choice(&["kept", "renewed-keeping-velocity", "renewed-keeping-momentum"]),
        Without::Word("kept"),
        "Whether nodes take their mass from the particles once, or in every step",
    )
    .with("method", "otm"),
    must("mass", Choice(&["lumped", "consistent"]), "The mass matrix of the nodes"),
    may(
        "filter",
        Choice(&["none", "null-space"]),
        Without::Word("none"),
        "What is taken out of the stresses after each update: nothing, or what no node feels",
    )
    .besides("\"none\" with the method \"otm\", a hyperelastic law or an implicit integrator"),
    must("body", Table, "A box of elastic material"),
    must("body.length", PerAxis(positive("m")), "The size of the box, L in 1D")
        .besides("their number is the dimension, 1 to 3"),
    may("body.origin", PerAxis(any("m")), Without::Number(0.0), "Its lower corner"),
    must("body.density", One(positive("kg/m³")), "ρ at the start"),
    may(
        "body.law",
        Choice(&["rate", "neo-hookean", "hencky"]),
        Without::Word("rate"),
        "The stress by its rate, (3), or from the deformation gradient",
    ),
    must("body.youngs_modulus", One(positive("Pa")), "E, Young's modulus"),
    must("body.poisson_ratio", One(between(Excluded(-1.0), Excluded(0.5))), "ν, Poisson's ratio"),
    may("body.ball", List, Without::Says("all of the box"), "Discs or balls of material")
        .besides("in 2D and 3D, each with a particle in it"),
    must("body.ball.centre", PerAxis(any("m")), "The middle of a ball")
        .besides("a point of the body's box"),
    must("body.ball.radius", One(positive("m")), "The radius of a ball")
        .besides("it keeps the ball inside the body's box"),
    must("grid", Table, "Cells and particles"),
    must("grid.cells", PerAxis(FROM_1), "Cells over the length of the body"),
    must(
        "grid.particles_per_cell",
        PerAxis(whole(1.0, Included(64.0))),
        "Particles of a cell along each axis",
    )
    .besides("with the method \"otm\" at most 4"),
    may("grid.beyond", Table, Without::Says("as below"), "Cells beyond the body")
        .besides("not with the method \"otm\""),
    may(
        "grid.beyond.<side>",
        One(whole(0.0, Unbounded)),
        Without::Says("0 beyond a side that holds a component, 1 beyond a free one and for uGIMP"),
        "Cells beyond this side",
    ),
    must("basis", Table, "The shape functions"),
    must(
        "basis.kind",
        Choice(&Basis::WORDS),
        "Linear, uGIMP, GIMP whose domains stretch, local max-ent, B-splines, dual domain",
    )
    .besides("with the method \"otm\" \"lme\", in 1D also \"linear\""),
    may(
        "basis.degree",
        One(whole(2.0, Included(3.0))),
        Without::Number(2.0),
        "The degree of B-splines",
    )
    .with("basis.kind", "bspline"),
    must("basis.gamma", One(between(Included(1e-6), Included(1e6))), "γ = βh²")
        .with("basis.kind", "lme"),
    may(
        "basis.cutoff",
        One(between(Included(0.0), Excluded(1.0))),
        Without::Number(1e-6),
        "Nodes with exp(−γ|ξ|²) below it are cut off",
    )
    .with("basis.kind", "lme"),
    may(
        "basis.support",
        Choice(&["box", "ball"]),
        Without::Word("box"),
        "Whether the cut-off leaves the nodes of a box or of a ball, which in 1D are one",
    )
    .with("basis.kind", "lme")
    .besides("not with the method \"otm\", whose nodes stand on no grid"),
    may(
        "basis.metric",
        Choice(&["fixed", "updated"]),
        Without::Word("fixed"),
        "Whether distances are those of the present body, or B ← f⁻ᵀ B f⁻¹ goes with the material",
    )
    .with("basis.kind", "lme")
    .besides("\"updated\" with the method \"otm\" only"),
    may("forces", Table, Without::Says("as below"), "How the internal forces are integrated"),
    may(
        "forces.reconstruction",
        Choice(&["tls", "mls"]),
        Without::Says("the sum over particles"),
        "The stress at Gauss's points by least squares of a cell, or moving about each point",
    )
    .besides("with a linear basis \"tls\", with B-splines either; explicit schemes of \"mpm\" only"),
    may(
        "forces.degree",
        One(whole(0.0, Included(2.0))),
        Without::Says("1 with \"tls\", 2 with \"mls\""),
        "The degree of the polynomials",
    )
    .besides("only with forces.reconstruction"),
    must("time", Table, "The scheme and its time step"),
    must(
        "time.integrator",
        Choice(&[
            "newmark",
            "forward-euler",
            "corrected-euler",
            "generalized-alpha",
            "implicit-newmark",
            "quasi-static",
        ]),
        "The scheme that carries the particles through time",
    )
    .besides("with the method \"otm\" \"newmark\""),
    may(
        "time.reading",
        Choice(&["second-order", "as-printed"]),
        Without::Word("second-order"),
        "How step 8 is read",
    )
    .with("time.integrator", "newmark"),
    must(
        "time.stress_update",
        Choice(&["first", "last", "modified-last"]),
        "When the stress is updated",
    )
    .with("time.integrator", "forward-euler"),
    must(
        "time.rho_b",
        One(between(Included(0.0), Included(1.0))),
        "ρ_b, the spectral radius at the bifurcation",
    )
    .with("time.integrator", "generalized-alpha"),
    must("time.load_steps", One(whole(1.0, Included(1e9))), "The steps in which the loads grow")
        .with("time.integrator", "quasi-static"),
    may(
        "time.kinematics",
        Choice(&["as-printed", "consistent"]),
        Without::Word("as-printed"),
        "The strain as printed, or that of the map which moves the particles",
    )
    .besides(
        "not with the method \"otm\", whose strain is always that of the map; \"consistent\" with an \
         implicit integrator, which has no other",
    ),
    may(
        "time.cfl",
        One(positive("")),
        Without::Says("time.fraction_of_critical bounds it"),
        "The largest c Δt / h",
    )
    .besides("this key, time.fraction_of_critical, or both; not with \"quasi-static\""),
    may(
        "time.fraction_of_critical",
        One(positive("")),
        Without::Says("time.cfl bounds it"),
        "The largest Δt, as a part of the limit that is predicted, over all offsets if particles move",
    )
    .besides("not with an implicit integrator, which has no limit"),
    may(
        "time.allow_unstable",
        Flag,
        Without::Flag(false),
        "Run what the predicted limit says must blow up, without a watch",
    )
    .besides("not with an implicit integrator"),
    may(
        "time.watch",
        One(between(Included(0.0), Included(1.0))),
        Without::Number(0.25),
        "The cells that particles may move until the limit of Δt is looked at again; 0 for no watch",
    )
    .besides("not with an implicit integrator"),
    must("time.end", One(positive("s")), "The end of the run"),
    may(
        "check",
        Table,
        Without::Says("as below"),
        "What ends a run whose result is not to be trusted",
    ),
    may(
        "check.energy",
        One(positive("")),
        Without::Number(0.25),
        "The energy may grow by this share of the largest that start and loads have given",
    ),
    may(
        "check.rotation",
        One(positive("rad")),
        Without::Number(0.5),
        "The material may turn by this angle with the rate law in 2D and 3D",
    ),
    may("boundary", Table, Without::Says("free sides"), "The sides of the box")
        .besides("left, right (x); bottom, top (y); back, front (z)"),
    may("boundary.<side>", ChoiceOrTable(STATES), Without::Word("free"), "What holds this side"),
    may(
        "boundary.<side>.<axis>",
        Choice(STATES),
        Without::Word("free"),
        "What holds this component of the velocity there",
    ),
    may("initial_velocity", List, Without::Says("at rest"), "Regions that are thrown")
        .besides("in place of vibration, manufactured and vortex"),
    must("initial_velocity.from", PerAxis(any("m")), "The region's lower corner")
        .besides("inside the body"),
    must("initial_velocity.to", PerAxis(any("m")), "The region's upper corner")
        .besides("above `from`, inside the body, with a particle in between"),
    must("initial_velocity.velocity", PerAxis(any("m/s")), "The velocity there"),
    may(
        "initial_velocity.spin",
        One(any("rad/s")),
        Without::Says("none"),
        "ω, how fast it turns about the region's middle besides",
    )
    .besides("in 2D"),
    may("vibration", Table, Without::Says("no mode"), "A natural mode: v = V φ(x)")
        .besides("in 1D, in place of initial_velocity, manufactured and vortex"),
    must("vibration.mode", One(MODE), "The number of the mode")
        .besides("at most half of the particles"),
    must("vibration.velocity", One(any("m/s")), "V, the largest velocity"),
    may(
        "manufactured",
        Table,
        Without::Says("no such motion"),
        "u_i = A φ(X_i) sin(ωt + θ_i) along every axis, kept by a body force",
    )
    .besides(
        "in place of initial_velocity, vibration and vortex; in 2D and 3D with sides that hold \
         their normal component alone",
    ),
    must("manufactured.mode", One(MODE), "The number of the mode")
        .besides("at most half of the particles"),
    must("manufactured.amplitude", One(any("m")), "A, the largest displacement")
        .besides("|A| k < 1, so that no material turns inside out"),
    may("manufactured.frequency", One(any("rad/s")), Without::Says("c k"), "ω, how fast it swings"),
    may("manufactured.phase", PerAxis(any("rad")), Without::Number(0.0), "θ along each axis"),
    may(
        "vortex",
        Table,
        Without::Says("no such motion"),
        "A ring about the middle of the body turns",
    )
    .besides(
        "in 2D with body.law = \"neo-hookean\", in place of initial_velocity, vibration and \
             manufactured",
    ),
    must("vortex.radius", One(positive("m")), "R_0, where the ring turns most; it is R_0/2 wide")
        .besides("so that 5/4 of it is inside the body"),
    must("vortex.angle", One(any("rad")), "A, the largest angle"),
    must("vortex.frequency", One(positive("rad/s")), "ω of the angle A sin ωt"),
    may("body_force", Table, Without::Says("none"), "A force per mass, everywhere the same")
        .besides("not with manufactured or vortex"),
    must("body_force.acceleration", PerAxis(any("m/s²")), "b, the acceleration"),
    may("body_force.ramp", One(RAMP), Without::Number(0.0), "The time over which it grows")
        .besides("not with \"quasi-static\", where loads grow until time.end"),
    may("traction", Table, Without::Says("none"), "Forces on the sides of the box")
        .besides("not with manufactured, vortex or balls"),
    may(
        "traction.<side>",
        PerAxis(any("Pa")),
        Without::Says("none on this side"),
        "The traction on this side",
    )
    .besides("0 where the side is fixed"),
    may("traction.ramp", One(RAMP), Without::Number(0.0), "The time over which they grow")
        .besides("not with \"quasi-static\", where loads grow until time.end"),
    may("probe", List, Without::Says("none"), "Particles whose history is recorded"),
    must("probe.name", Name(TAKEN), "The name of its column and picture").besides("used once"),
    must("probe.quantity", Choice(&["velocity", "stress", "displacement"]), "What is recorded"),
    may(
        "probe.component",
        Choice(COMPONENTS),
        Without::Says("in 1D the only one"),
        "Which component",
    )
    .besides("two letters for a stress, one otherwise; 2D and 3D need it"),
    must("probe.position", PerAxis(any("m")), "The particle nearest to it is followed")
        .besides("a point of the body"),
    may("output", Table, Without::Says("as below"), "What is recorded"),
    may("output.every", One(FROM_1), Without::Number(1.0), "Record every so many steps"),
    may(
        "output.vtk",
        Flag,
        Without::Flag(false),
        "Write the particles of every recorded step for ParaView",
    )
    .besides("in 2D and 3D"),
];

const fn must(path: &'static str, kind: Kind, help: &'static str) -> Key {
    may(path, kind, Without::Refused, help)
}

const fn may(path: &'static str, kind: Kind, without: Without, help: &'static str) -> Key {
    Key { path, kind, without, besides: "", with: None, help }
}

impl Key {
    const fn besides(self, besides: &'static str) -> Key {
        Key { besides, ..self }
    }

    const fn with(self, key: &'static str, word: &'static str) -> Key {
        Key { with: Some((key, word)), ..self }
    }

    /// Says in words what its value may be.
    pub fn allowed(&self) -> String {
        let with = self.with.map(|(key, word)| format!("only with {key} = \"{word}\""));
        let besides = Some(self.besides.to_string()).filter(|besides| !besides.is_empty());
        let all = [Some(self.kind.words()), besides, with];
        all.into_iter().flatten().collect::<Vec<_>>().join("; ")
    }

    /// Says in words what holds without it.
    pub fn without_words(&self) -> String {
        match self.without {
            Without::Refused if self.with.is_some() => "needed there".into(),
            Without::Refused => "needed".into(),
            Without::Number(x) => plain(x),
            Without::Word(word) => format!("\"{word}\""),
            Without::Flag(flag) => flag.to_string(),
            Without::Says(words) => words.into(),
        }
    }

    /// Tells whether its table must have it, whatever else the scene says.
    pub fn is_required(&self) -> bool {
        matches!(self.without, Without::Refused) && self.with.is_none()
    }

    /// Gives the table that it stands in, and its name there.
    pub fn place(&self) -> (&'static str, &'static str) {
        self.path.rsplit_once('.').unwrap_or(("", self.path))
    }

    /// Lists the names that it stands for: its own, or those of all sides or axes.
    pub fn names(&self) -> Vec<&'static str> {
        match self.place().1 {
            "<side>" => SIDES.concat(),
            "<axis>" => AXES.to_vec(),
            name => vec![name],
        }
    }
}

/// Finds the key with this path, which may hold indices of lists and names of sides.
pub fn find(path: &str) -> Option<&'static Key> {
    let plain = without_indices(path);
    KEYS.iter().find(|key| stands_for(key.path, &plain))
}

/// Lists the keys that may stand directly in the table at `path`.
pub fn children(path: &str) -> impl Iterator<Item = &'static Key> {
    let plain = without_indices(path);
    KEYS.iter().filter(move |key| stands_for(key.place().0, &plain))
}

/// Tells whether `pattern`, the path of a key, means `path`.
fn stands_for(pattern: &str, path: &str) -> bool {
    let same = |(pattern, name): (&str, &str)| match pattern {
        "<side>" => SIDES.as_flattened().contains(&name),
        "<axis>" => AXES.contains(&name),
        _ => pattern == name,
    };
    pattern.split('.').count() == path.split('.').count()
        && pattern.split('.').zip(path.split('.')).all(same)
}

/// Takes the indices out of a path: `probe[1].name` → `probe.name`.
fn without_indices(path: &str) -> String {
    let mut inside = false;
    path.chars()
        .filter(|c| {
            inside = (inside || *c == '[') && *c != ']';
            !inside && *c != ']'
        })
        .collect()
}
