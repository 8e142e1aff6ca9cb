//! Studies: many runs of one scene, and what can be said before any.

pub mod configuration;
pub mod gamma;
pub mod map;
pub mod pool;
pub mod trade;
