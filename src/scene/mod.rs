//! A scene declares what to compute, in TOML and SI units.
//!
//! It is data only. What a scene does not declare is not computed: no boundary table
//! means free sides, no region of initial velocity means a body at rest, no
//! probe means no probe column. [`keys::KEYS`] says of every key what it may be.

pub mod fault;
mod forces;
mod implicit;
pub mod keys;
pub mod kind;
mod limits;
mod loading;
mod motion;
mod parts;
mod probes;
mod read;
#[cfg(feature = "program")]
pub mod schema;
mod scheme;
mod shipped;
mod sizes;
mod source;
mod travel;
mod values;

pub use limits::Budget;
pub use parts::*;
pub use read::{Declared, declare};
pub use shipped::{DYKA, SHIPPED, Shipped, neither, shipped};
pub use sizes::wave_speed;
pub use source::merged;
