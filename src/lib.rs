//! # lme-mpm
//!
//! The Material Point Method with local maximum-entropy shape functions,
//! written to be read beside the paper it implements: Molinos, Navas, Pastor
//! and Martín Stickle, *Suitability of the local-maximum entropy approximation
//! under the Material Point Method framework for dynamic problems*.
//!
//! Data flows one way: scene → model → (step, step, …) → history → measure →
//! picture. The rooms of the house, from the ground up; each uses only those above it in
//! this list:
//!
//! | room | what it holds | feature |
//! |---|---|---|
//! | [`method`] | the paper: continuum, bases, time, exact solutions | – |
//! | [`scene`] | what to compute, declared in TOML | `scenes` |
//! | [`setup`] | from a scene to model, state and exact solution | `scenes` |
//! | [`run`] | the time loop, its history, the limit of Δt | `scenes` |
//! | [`port`] | traces and their comparison | `program` |
//! | [`output`] | summary, files, pictures | `scenes`, `program` |
//! | [`study`] | many runs of one scene | `program` |
//!
//! Where an equation of the paper stands is told by `data/equations.csv`, and by the
//! book's index of equations.

pub mod method;
#[cfg(feature = "scenes")]
pub mod output;
#[cfg(feature = "program")]
pub mod port;
#[cfg(feature = "scenes")]
pub mod run;
#[cfg(feature = "scenes")]
pub mod scene;
#[cfg(feature = "scenes")]
pub mod setup;
#[cfg(feature = "program")]
pub mod study;
