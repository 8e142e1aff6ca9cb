//! This is what comes out of a run.

use super::table::Table;
use super::warning::Warning;
use crate::method::breakdown::BrokenDown;
use crate::method::cost::Cost;
use thiserror::Error;

/// The outcome is what a finished run gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// One row for each recorded step.
    pub history: Table,
    /// The last state, one row for each particle.
    pub particles: Table,
    /// The particles at the recorded steps, if the scene asks for them.
    pub frames: Vec<Frame>,
    /// The largest growth of the energy beyond what start and loads gave, as a share of the
    /// largest that they have given (–).
    pub growth: f64,
    /// What the result may not be trusted for.
    pub warnings: Vec<Warning>,
    pub cost: Cost,
    /// Δt (s).
    pub dt: f64,
}

/// A frame holds the particles at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// (s).
    pub time: f64,
    /// One row for each particle.
    pub particles: Table,
}

/// A run that broke down stops with all that it had recorded.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{broken}")]
pub struct Stopped {
    pub broken: BrokenDown,
    pub history: Table,
    /// The particles at the recorded steps, if the scene asks for them.
    pub frames: Vec<Frame>,
}
