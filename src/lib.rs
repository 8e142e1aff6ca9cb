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
//! ```
//! # #[cfg(feature = "scenes")]
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use lme_mpm::method::time;
//! use lme_mpm::{run, scene, setup};
//!
//! // A scene, here the bar that ships with the program, on fewer cells.
//! let sets = ["grid.cells=10".to_string()];
//! let scene = run::parse("dyka", "dyka.toml", scene::DYKA, &sets)?;
//!
//! // Its whole run, and one column of its history.
//! let outcome = run::run(&scene, &mut |_| {})?;
//! let velocity = outcome.history.column("velocity_end").unwrap_or_default();
//! assert_eq!(velocity[0], 5.0);
//!
//! // Or step by step: what never changes, what does, and the nine steps.
//! let model = setup::model::<1>(&scene);
//! let mut state = setup::initial_state(&model, &scene);
//! time::start(&mut state, &model, &mut |_, _| {})?;
//! for k in 1..=model.steps {
//!     time::advance(&mut state, &model, k as f64 * model.dt, &mut |_, _| {})?;
//! }
//! assert_eq!(state.particle.v[19][0], velocity[model.steps]);
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "scenes"))]
//! # fn main() {}
//! ```
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
