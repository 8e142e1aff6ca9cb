//! Studies: one scene computed in many ways, and what that says.

pub mod configuration;
pub mod gamma;
pub mod map;
pub mod pool;
pub mod trade;
