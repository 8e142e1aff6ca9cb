//! The keys that a scene file may hold: the contract in one table.

/// One key: its dotted path (entries of a list share one path), whether its
/// table is incomplete without it, and what its value may be.
pub struct Key {
    pub path: &'static str,
    pub required: bool,
    pub allowed: &'static str,
}

const fn must(path: &'static str, allowed: &'static str) -> Key {
    Key { path, required: true, allowed }
}

const fn may(path: &'static str, allowed: &'static str) -> Key {
    Key { path, required: false, allowed }
}

const SIDE: &str =
    "\"fixed\" or \"free\", or one of them for each component, as in { x = \"fixed\" }";
const COMPONENT: &str = "\"fixed\" or \"free\"";
const BEYOND: &str = "a whole number of cells from 0 up; without it 0 beyond a fixed side, 1 beyond a free one and for uGIMP";

const TRACTION: &str = "t in Pa, one number for each axis, 0 where the side is fixed";
const RAMP: &str = "a time from 0 up in s over which it grows linearly; 0 without it";

/// All keys, in the order in which a scene is read aloud.
pub const KEYS: &[Key] = &[
    must("title", "a text without control characters"),
    must("method", "\"mpm\" or \"otm\""),
    must("mass", "\"lumped\" or \"consistent\""),
    must("body", "a table"),
    must(
        "body.length",
        "a length above 0 in m, one for each axis: their number is the dimension, 1 to 3",
    ),
    may("body.origin", "the body's lower corner in m, one number for each axis; 0 without it"),
    must("body.density", "a number above 0, in kg/m³"),
    must("body.youngs_modulus", "a number above 0, in Pa"),
    must("body.poisson_ratio", "a number ν with −1 < ν < 0.5"),
    may("body.ball", "a list, [[body.ball]]: the material is inside these, in 2D and 3D"),
    must("body.ball.centre", "a point of the body's box in m, one number for each axis"),
    must("body.ball.radius", "a length above 0 in m that keeps the ball inside the body's box"),
    must("grid", "a table"),
    must("grid.cells", "a whole number from 1 up over the body's length, one for each axis"),
    must("grid.particles_per_cell", "a whole number from 1 to 64, one for each axis"),
    may(
        "grid.beyond",
        "a table of cells beyond the body, with the keys left, right, bottom, top, back, front",
    ),
    may("grid.beyond.left", BEYOND),
    may("grid.beyond.right", BEYOND),
    may("grid.beyond.bottom", BEYOND),
    may("grid.beyond.top", BEYOND),
    may("grid.beyond.back", BEYOND),
    may("grid.beyond.front", BEYOND),
    must("basis", "a table"),
    must("basis.kind", "\"linear\", \"ugimp\", \"lme\" or \"bspline\""),
    may("basis.gamma", "for lme: γ = βh², a number from 1e-6 to 1e6"),
    may(
        "basis.cutoff",
        "for lme: exp(−γ|ξ|²) below it is cut off, a number from 0 up to and below 1; 1e-6 without it",
    ),
    must("time", "a table"),
    must(
        "time.integrator",
        "\"newmark\", \"forward-euler\", \"corrected-euler\" or \"generalized-alpha\"",
    ),
    may("time.reading", "of newmark, step 8: \"second-order\" (without it) or \"as-printed\""),
    may("time.stress_update", "of forward-euler: \"first\", \"last\" or \"modified-last\""),
    may("time.rho_b", "of generalized-alpha: a number from 0 to 1"),
    may("time.cfl", "a number above 0: the largest c Δt / h; this key, or the next, or both"),
    may(
        "time.fraction_of_critical",
        "a number above 0: the largest Δt, as a part of the limit that is predicted at the start",
    ),
    may("time.allow_unstable", "true runs what the predicted limit says must blow up"),
    must("time.end", "a time above 0, in s"),
    may("boundary", "a table of sides: left, right (x); bottom, top (y); back, front (z)"),
    may("boundary.left", SIDE),
    may("boundary.left.x", COMPONENT),
    may("boundary.left.y", COMPONENT),
    may("boundary.left.z", COMPONENT),
    may("boundary.right", SIDE),
    may("boundary.right.x", COMPONENT),
    may("boundary.right.y", COMPONENT),
    may("boundary.right.z", COMPONENT),
    may("boundary.bottom", SIDE),
    may("boundary.bottom.x", COMPONENT),
    may("boundary.bottom.y", COMPONENT),
    may("boundary.bottom.z", COMPONENT),
    may("boundary.top", SIDE),
    may("boundary.top.x", COMPONENT),
    may("boundary.top.y", COMPONENT),
    may("boundary.top.z", COMPONENT),
    may("boundary.back", SIDE),
    may("boundary.back.x", COMPONENT),
    may("boundary.back.y", COMPONENT),
    may("boundary.back.z", COMPONENT),
    may("boundary.front", SIDE),
    may("boundary.front.x", COMPONENT),
    may("boundary.front.y", COMPONENT),
    may("boundary.front.z", COMPONENT),
    may("initial_velocity", "a list of regions, [[initial_velocity]]"),
    must(
        "initial_velocity.from",
        "the region's lower corner in m, inside the body, one number for each axis",
    ),
    must("initial_velocity.to", "the region's upper corner in m, above `from`, inside the body"),
    must("initial_velocity.velocity", "a velocity in m/s, one number for each axis"),
    may("vibration", "a table, in 1D, in place of initial_velocity: v = V φ(x), a natural mode"),
    must("vibration.mode", "a whole number from 1 to 1000, at most half of the particles"),
    must("vibration.velocity", "V, a velocity in m/s"),
    may(
        "manufactured",
        "a table, in 1D, in place of initial_velocity: u = A φ(X) sin ωt, kept by a body force",
    ),
    must("manufactured.mode", "a whole number from 1 to 1000, at most half of the particles"),
    must("manufactured.amplitude", "A in m with |A| k < 1, so that no material turns inside out"),
    may("body_force", "a table"),
    must("body_force.acceleration", "b in m/s², one number for each axis"),
    may("body_force.ramp", RAMP),
    may("traction", "a table of sides as in `boundary`, each with its traction"),
    may("traction.left", TRACTION),
    may("traction.right", TRACTION),
    may("traction.bottom", TRACTION),
    may("traction.top", TRACTION),
    may("traction.back", TRACTION),
    may("traction.front", TRACTION),
    may("traction.ramp", RAMP),
    may("probe", "a list of probes, [[probe]]"),
    must(
        "probe.name",
        "a name of at most 64 letters, digits and _, used once, and not that of another column",
    ),
    must("probe.quantity", "\"velocity\", \"stress\" or \"displacement\""),
    may("probe.component", "in 2D and 3D: x, y, z, for stress two of them as in \"xy\""),
    must(
        "probe.position",
        "a point of the body in m, one number for each axis; the nearest particle is read",
    ),
    may("output", "a table"),
    may("output.every", "a whole number from 1 up: record every so many steps; 1 without it"),
    may(
        "output.vtk",
        "in 2D and 3D: true writes the particles of every recorded step for ParaView",
    ),
];

/// Keys whose value is a list of tables.
pub const LISTS: &[&str] = &["initial_velocity", "probe", "body.ball"];

/// The key with this path, list indices dropped.
pub fn find(path: &str) -> Option<&'static Key> {
    KEYS.iter().find(|key| key.path == path)
}

/// The names that may stand directly in table `parent`.
pub fn children(parent: &str) -> impl Iterator<Item = &'static Key> {
    let depth = if parent.is_empty() { 0 } else { parent.len() + 1 };
    KEYS.iter().filter(move |key| {
        let inside = match parent {
            "" => true,
            _ => key.path.strip_prefix(parent).is_some_and(|rest| rest.starts_with('.')),
        };
        inside && !key.path[depth.min(key.path.len())..].contains('.')
    })
}

/// The candidate that `word` was probably meant to be.
pub fn nearest<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<String> {
    // The first measure favours a common beginning, the second swapped letters.
    let likeness = |candidate: &str| {
        strsim::jaro_winkler(word, candidate)
            .max(strsim::normalized_damerau_levenshtein(word, candidate))
    };
    candidates
        .map(|candidate| (likeness(candidate), candidate))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness > 0.65)
        .map(|(_, candidate)| candidate.to_string())
}
