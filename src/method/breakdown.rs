//! All that can go wrong inside a run has a name here.
//!
//! A step says what happened to which particle or node ([`Breakdown`]); the time loop
//! adds once when it was ([`BrokenDown`]).

use super::basis::lme::Failure;
use thiserror::Error;

/// A moment is a point in a run: time step k and time t (s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    pub step: usize,
    pub time: f64,
}

impl Moment {
    /// This is k = 0, t = 0.
    pub const START: Moment = Moment { step: 0, time: 0.0 };

    /// Gives the end of time step `step` with the size `dt` (s).
    pub fn of(step: usize, dt: f64) -> Self {
        Moment { step, time: step as f64 * dt }
    }
}

impl std::fmt::Display for Moment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "step {}, t = {:e} s", self.step, self.time)
    }
}

/// A breakdown says what a step could not do, and for which particle or node.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Breakdown {
    #[error(
        "particle {particle} left the grid: it stands at {position:?} m from the body's lower \
         corner; give it room with `grid.beyond`"
    )]
    LeftGrid { particle: usize, position: Vec<f64> },
    #[error(
        "particle {particle} reaches beyond the grid with its own size: it stands at {position:?} m \
         from the body's lower corner; give it room with `grid.beyond`"
    )]
    ReachesBeyond { particle: usize, position: Vec<f64> },
    #[error(
        "the domain of particle {particle} would be {cells:e} cells long along axis {axis}, and it \
         must be above 0 and at most 2; give the cells more particles, or set basis.kind = \"ugimp\", \
         whose domains keep their size"
    )]
    Domain { particle: usize, axis: usize, cells: f64 },
    #[error(
        "the volume of particle {particle} is used up: in one step it would become {:e} times \
         what it was, and that must stay above 0",
        1.0 + strain
    )]
    Inverted { particle: usize, strain: f64 },
    #[error("the {symbol} of particle {particle} is not a finite number")]
    NotFinite { particle: usize, symbol: &'static str },
    #[error("the {symbol} of node {node} is not a finite number")]
    NodeNotFinite { node: usize, symbol: &'static str },
    #[error("local max-ent cannot serve particle {particle}: {failure}")]
    NoBasis { particle: usize, failure: Failure },
    #[error(
        "the consistent mass matrix is singular: {particles} particles do not determine the \
         velocities of {nodes} nodes; give the cells more particles, or set mass = \"lumped\""
    )]
    SingularMass { particles: usize, nodes: usize },
    #[error(
        "no particle sees node {node} any more, and its renewed mass is zero; set nodal_mass = \
         \"kept\""
    )]
    NoMass { node: usize },
    #[error(
        "the energy is {share:.2e} of the largest that start and loads have given above what they \
         gave, and check.energy allows {bound}; particle {particle} holds the largest share"
    )]
    Diverged { particle: usize, share: f64, bound: f64 },
    #[error(
        "particle {particle} has turned by {angle:.3} rad, and check.rotation allows {bound}: the \
         rate law does not turn its stress; body.law = \"neo-hookean\" or \"hencky\" does"
    )]
    Turned { particle: usize, angle: f64, bound: f64 },
    #[error(
        "the time step {dt:e} s is beyond its limit, which was {start:e} s at the start and is {now:e} \
         s where the particles stand now; what grows has its largest share in particle {particle}; \
         time.fraction_of_critical = {} would have held so far",
        shown(*fraction)
    )]
    BeyondLimit { particle: usize, dt: f64, start: f64, now: f64, fraction: f64 },
    #[error(
        "the energy has grown by {share:.2e} of what start and loads gave, with a time step of {} of \
         the limit over all offsets: it is too large for what it computes, and particle {particle} \
         holds the largest share",
        shown(*part)
    )]
    Gained { particle: usize, share: f64, part: f64 },
    #[error(
        "no equilibrium of the nodes was found: after {iterations} iterations of Newton's method the \
         residual is {residual:.1e} of the forces, and {what}; give the body more supports, more \
         particles, or smaller steps by time.cfl or time.load_steps"
    )]
    NoEquilibrium { iterations: usize, residual: f64, what: &'static str },
    /// No step has failed: whoever listens to the run wants no more of it.
    #[error("the run was interrupted")]
    Interrupted,
    /// No step has failed: the time is over that the run was given.
    #[error("the {seconds} s of --max-time are over")]
    OutOfTime { seconds: f64 },
}

/// Writes a fraction with three digits, rounded down.
fn shown(fraction: f64) -> String {
    if fraction < 0.01 {
        return format!("{fraction:.0e}");
    }
    format!("{}", libm::floor(fraction * 1000.0) / 1000.0)
}

impl Breakdown {
    /// Adds the time step in which it happened.
    pub fn at(self, moment: Moment) -> BrokenDown {
        BrokenDown { breakdown: self, moment }
    }
}

/// A run has broken down: this says what happened, at which step and time.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("at {moment}: {breakdown}")]
pub struct BrokenDown {
    pub breakdown: Breakdown,
    pub moment: Moment,
}
