//! The method is everything that a reader needs to understand the paper, and nothing else.
//!
//! This room knows no scene, no file and no terminal, and compiles alone.

pub mod basis;
pub mod breakdown;
pub mod choice;
pub mod continuum;
pub mod cost;
pub mod exact;
pub mod grid;
pub mod measure;
pub mod model;
pub mod one_bar;
pub mod quadrature;
pub mod reading;
pub mod reconstruction;
pub mod time;
