//! Studies: one scene computed in many ways, and what that says.

pub mod configuration;
pub mod gamma;
pub mod log;
pub mod map;
pub mod measured;
pub mod pool;
pub mod ranking;
pub mod trade;
