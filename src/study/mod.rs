//! A study computes one scene in many ways, and says what comes of it.

pub mod choice;
pub mod configuration;
pub mod gamma;
pub mod log;
pub mod map;
pub mod measured;
pub mod methods;
pub mod orders;
pub mod pool;
pub mod ranking;
pub mod rows;
pub mod trade;
pub mod verdict;
pub mod work;
