//! Scenes: what to compute, declared in TOML, in SI units.
//!
//! Data only. What a scene does not declare is not computed: no boundary table
//! means free sides, no region of initial velocity means a body at rest, no
//! probe means no probe column. [`keys::KEYS`] lists every key.

mod check;
pub mod fault;
mod file;
pub mod keys;
mod limits;
mod loads;
mod parts;
mod read;
mod scheme;
mod sizes;
mod source;

pub use parts::*;
pub use read::{Declared, declare};
pub use sizes::wave_speed;
pub use source::merged;

/// The Dyka & Ingel bar, which ships inside the program.
pub const DYKA: &str = include_str!("../../data/scenes/dyka.toml");
