//! All tests as one program: it is built and linked once, and they run side by side.

mod analytical;
mod basis;
mod book;
mod budget;
#[path = "bench/cases.rs"]
mod cases;
mod cli;
mod conformance;
mod conservation;
mod convergence;
mod exact;
mod extremes;
mod extremes_of_scenes;
mod finite;
mod fuzz;
mod gate;
mod guards;
mod house;
mod hull;
mod integrators;
mod lab;
mod laws;
mod lme;
mod lme_box;
mod loads;
mod locking;
mod mass;
mod matrix;
mod one_bar;
mod orders;
mod otm;
mod otm_action;
mod otm_bar;
mod port;
mod published;
mod refusals;
mod regression;
#[cfg(unix)] // pipes, links, signals, names that are bytes
mod results;
mod riemann;
#[path = "bench/rows.rs"]
mod rows;
mod runs;
mod scenes;
mod search;
mod shape;
mod sides;
mod stability;
mod steps;
mod studies;
mod support;
mod table;
mod terminal;
mod trace;
mod verdicts;
mod watch;
