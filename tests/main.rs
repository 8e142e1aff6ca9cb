//! All tests as one program: it is built and linked once, and they run side by side.

mod analytical;
mod basis;
mod book;
mod cli;
mod conformance;
mod conservation;
mod convergence;
mod extremes;
mod house;
mod integrators;
mod laws;
mod lme;
mod loads;
mod mass;
mod matrix;
mod otm;
mod port;
mod refusals;
mod regression;
mod scenes;
mod search;
mod stability;
mod steps;
mod studies;
mod support;
mod trace;
