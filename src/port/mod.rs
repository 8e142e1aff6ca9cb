//! Ports to other languages get traces, their comparison, and values at points.

mod cause;
pub mod check;
mod entry;
pub mod noise;
mod patterns;
pub mod points;
mod precision;
mod report;
pub mod rows;
mod scheme;
pub mod trace;
