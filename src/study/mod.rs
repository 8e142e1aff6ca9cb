//! Studies: many runs of one scene, and what can be said before any.

pub mod configuration;
pub mod gamma;
pub mod log;
pub mod map;
pub mod measured;
pub mod pool;
pub mod ranking;
pub mod trade;
