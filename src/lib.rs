//! # lme-mpm
//!
//! The Material Point Method with local maximum-entropy shape functions,
//! written to be read beside the paper it implements: Molinos, Navas, Pastor
//! and Martín Stickle, *Suitability of the local-maximum entropy approximation
//! under the Material Point Method framework for dynamic problems*.
//!
//! Data flows one way: scene → state → (step, step, …) → history → measure →
//! picture.
//!
//! | paper | module | tests |
//! |---|---|---|
//! | §3.1, (2) (3) (17) | [`continuum::law`] | `tests/laws.rs` |
//! | §3.3, (14) (16) (18) (19) | [`continuum::sums`], [`continuum::shape`] | `tests/laws.rs` |
//! | §3.3, (10)-(13) (15) | [`continuum::mass`], [`continuum::loads`] | `tests/mass.rs`, `tests/loads.rs` |
//! | §3.3, N_I and its table | [`basis`], [`grid`] | `tests/basis.rs` |
//! | §5, (30)-(37) | [`basis::lme`], [`basis::support`] | `tests/lme.rs`, `tests/basis.rs` |
//! | §4, (20)-(26) | [`time::euler`], [`time::generalized_alpha`] | `tests/integrators.rs`, `tests/matrix.rs` |
//! | §4, (27)-(29) and the Algorithm | [`time::newmark`], [`time::steps`] | `tests/steps.rs`, `tests/convergence.rs`, `tests/regression.rs` |
//! | §6.2 | [`otm`], [`basis::scattered`] | `tests/otm.rs` |
//! | §6, studies | [`study`] | `tests/studies.rs`, `tests/stability.rs`, `tests/extremes.rs` |
//! | porting | [`trace`], [`check`] | `tests/trace.rs` |
//! | §6, (39) | [`measure`] | `tests/analytical.rs` |
//! | other exact solutions | [`exact::forced`], [`exact::mode`], [`exact::manufactured`] | `tests/loads.rs` |
//! | App. A, (40)-(59) | [`exact::riemann`] | `tests/analytical.rs` |
//! | doubts and misprints | [`reading`] | `tests/convergence.rs` |
//!
//! Around the paper stand [`scene`] (what to compute), [`model`] and [`run`]
//! (the time loop), [`history`], [`summary`], [`figure`], [`vtk`]
//! and [`report`] (what comes out), [`points`] (values at points), [`rows`] (CSV that others write),
//! [`cost`] (what it took) and [`fault`] (what can go wrong).

pub mod basis;
pub mod check;
pub mod continuum;
pub mod cost;
pub mod exact;
pub mod fault;
pub mod figure;
pub mod grid;
pub mod history;
pub mod lattice;
pub mod measure;
pub mod model;
pub mod otm;
pub mod points;
pub mod reading;
pub mod report;
pub mod rows;
pub mod run;
pub mod scene;
pub mod study;
pub mod summary;
pub mod time;
pub mod trace;
pub mod vtk;
