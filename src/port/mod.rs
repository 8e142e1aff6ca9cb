//! Ports to other languages get traces, their comparison, and values at points.

mod cause;
pub mod check;
mod entry;
pub mod points;
pub mod rows;
pub mod trace;
