//! The scenes that tests change and run.

use lme_mpm::run::parse;
use lme_mpm::scene::{DYKA, Scene};

pub const FREE_FLIGHT: &str = include_str!("../../data/scenes/free-flight.toml");
pub const VIBRATION: &str = include_str!("../../data/scenes/vibration.toml");
pub const GRAVITY: &str = include_str!("../../data/scenes/gravity.toml");
pub const TRACTION: &str = include_str!("../../data/scenes/traction.toml");
pub const MANUFACTURED: &str = include_str!("../../data/scenes/manufactured.toml");
pub const PERIODIC_BAR: &str = include_str!("../../data/scenes/periodic-bar.toml");
pub const AXIS_ALIGNED: &str = include_str!("../../data/scenes/axis-aligned.toml");
pub const VORTEX: &str = include_str!("../../data/scenes/vortex.toml");
pub const DYKA_OTM: &str = include_str!("../../data/scenes/dyka-otm.toml");
pub const DISCS: &str = include_str!("../../data/scenes/colliding-discs.toml");
pub const COLUMN: &str = include_str!("../../data/scenes/column.toml");

/// L/c of the Dyka bar [s], from c = √(E/ρ).
pub fn transit() -> f64 {
    0.1333 / (200e9_f64 / 7833.0).sqrt()
}

/// A scene from `text` with the changes `KEY=VALUE`.
pub fn scene(text: &str, sets: &[&str]) -> Scene {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    parse("test", "test.toml", text, &sets).unwrap_or_else(|error| panic!("{error}"))
}

/// The Dyka bar with the changes `KEY=VALUE`.
pub fn dyka(sets: &[&str]) -> Scene {
    scene(DYKA, sets)
}

/// `x` for every axis, as a scene has it: `[x,x]`.
pub fn each_axis(dimension: usize, x: &str) -> String {
    format!("[{}]", vec![x; dimension].join(","))
}

/// The changes that put the bar into units in which lengths, times, densities and moduli
/// are these numbers times what they are.
pub fn bar_in_units(length: f64, time: f64, density: f64, modulus: f64) -> Vec<String> {
    vec![
        format!("body.length={:?}", 0.1333 * length),
        format!("body.density={:?}", 7833.0 * density),
        format!("body.youngs_modulus={:?}", 200e9 * modulus),
        format!("time.end={:?}", 1.0552107481257e-4 * time),
        format!("initial_velocity.0.from={:?}", 0.099975 * length),
        format!("initial_velocity.0.to={:?}", 0.1333 * length),
        format!("initial_velocity.0.velocity={:?}", 5.0 * (length / time)),
        format!("probe.0.position={:?}", 0.1333 * length),
        format!("probe.1.position={:?}", 0.099975 * length),
    ]
}

/// Owned changes as `scene` takes them.
pub fn strs(sets: &[String]) -> Vec<&str> {
    sets.iter().map(String::as_str).collect()
}

/// The Dyka bar in 1D, or as a strip in 2D or 3D, ν = 0, free at its long sides.
pub fn strip(dimension: usize, sets: &[&str]) -> Scene {
    let list = |first: &str, other: &str| {
        let mut entries = vec![first];
        entries.resize(dimension, other);
        format!("[{}]", entries.join(","))
    };
    let (x, xx) = if dimension == 1 { ("", "") } else { ("component='x'\n", "component='xx'\n") };
    let text = format!(
        "title = 'strip'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
         body = {{ length = {length}, density = 7833,\n\
                  youngs_modulus = 200e9, poisson_ratio = 0 }}\n\
         grid = {{ cells = {cells}, particles_per_cell = {per_cell} }}\n\
         time = {{ integrator = 'newmark', cfl = 0.5, end = {end} }}\n\
         boundary.left = 'fixed'\n\
         [[initial_velocity]]\nfrom = {from}\nto = {length}\nvelocity = {velocity}\n\
         [[probe]]\nname = 'velocity_end'\nquantity = 'velocity'\n{x}position = {length}\n\
         [[probe]]\nname = 'stress_three_quarter'\nquantity = 'stress'\n{xx}position = {quarter}\n",
        length = list("0.1333", "0.01"),
        cells = list("40", "3"),
        per_cell = list("2", "2"),
        from = list("0.099975", "0"),
        velocity = list("5", "0"),
        quarter = list("0.099975", "0"),
        end = 4.0 * transit(),
    );
    scene(&text, sets)
}

/// A square or cubic block, free on all sides, with the changes of `sets`.
pub fn block(dimension: usize, sets: &[&str]) -> Scene {
    let list = |x: &str| each_axis(dimension, x);
    let text = format!(
        "title = 'block'\nmethod = 'otm'\nmass = 'lumped'\n\
         basis = {{ kind = 'lme', gamma = 1.8 }}\n\
         body = {{ length = {}, density = 1000, youngs_modulus = 1e6, poisson_ratio = 0.3 }}\n\
         grid = {{ cells = {}, particles_per_cell = {} }}\n\
         time = {{ integrator = 'newmark', cfl = 0.4, end = 0.05 }}\n",
        list("1"),
        list(if dimension == 3 { "3" } else { "5" }),
        list("1"),
    );
    scene(&text, sets)
}
