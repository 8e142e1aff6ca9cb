//! Some scenes ship inside the program.

use super::fault::Fault;
use super::kind::nearest;
use std::path::{Path, PathBuf};

/// A shipped scene is inside the program.
pub struct Shipped {
    /// What it is called on the command line.
    pub name: &'static str,
    /// Its file.
    pub text: &'static str,
}

macro_rules! shipped {
    ($($name:literal),*) => {
        &[$(Shipped {
            name: $name,
            text: include_str!(concat!("../../data/scenes/", $name, ".toml")),
        }),*]
    };
}

/// All of them stand here, the one that runs without a name first.
pub const SHIPPED: &[Shipped] = shipped![
    "dyka",
    "dyka-otm",
    "one-particle",
    "free-flight",
    "vibration",
    "gravity",
    "traction",
    "manufactured",
    "periodic-bar",
    "axis-aligned",
    "vortex",
    "colliding-discs",
    "spinning-bar",
    "column"
];

/// This is the bar of Dyka and Ingel.
pub const DYKA: &str = SHIPPED[0].text;

/// Finds the shipped scene with this name.
pub fn shipped(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().find(|scene| scene.name == name)
}

/// Makes the error of a scene that is neither a file nor shipped; `source` says why it is no
/// file.
pub fn neither(path: &Path, source: std::io::Error) -> Fault {
    let names = || SHIPPED.iter().map(|scene| scene.name);
    let stem = path.file_stem().map_or("".into(), |stem| stem.to_string_lossy());
    Fault::NoScene {
        path: PathBuf::from(path),
        source,
        shipped: names().collect::<Vec<_>>().join(", "),
        suggestion: nearest(&stem, names()),
    }
}
