//! Everything that can go wrong, by name.
//!
//! Two families, two exit codes. Input that cannot be used ([`SceneError`],
//! [`Fault::Read`], …) ends with 2 before anything is written. A run that
//! breaks down ([`Breakdown`]) ends with 1 and leaves its history under a name
//! that says so.

use crate::basis::lme::Failure;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use std::ops::Range;
use std::path::PathBuf;
use thiserror::Error;

/// A point in a run: time step k and time t (s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    pub step: usize,
    pub time: f64,
}

impl Moment {
    /// k = 0, t = 0.
    pub const START: Moment = Moment { step: 0, time: 0.0 };
}

impl std::fmt::Display for Moment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "step {}, t = {:e} s", self.step, self.time)
    }
}

/// A run that cannot go on: which particle, at which step and time.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Breakdown {
    #[error(
        "particle {particle} left the grid at {moment}: it stands at {position:?} m from the \
         body's lower corner; give it room with `grid.beyond`"
    )]
    LeftGrid { particle: usize, moment: Moment, position: Vec<f64> },
    #[error(
        "the volume of particle {particle} is used up at {moment}: in one step it would become \
         {:e} times what it was, and that must stay above 0",
        1.0 + strain
    )]
    Inverted { particle: usize, moment: Moment, strain: f64 },
    #[error("the {symbol} of particle {particle} is not a finite number at {moment}")]
    NotFinite { particle: usize, moment: Moment, symbol: &'static str },
    #[error("the {symbol} of node {node} is not a finite number at {moment}")]
    NodeNotFinite { node: usize, moment: Moment, symbol: &'static str },
    #[error("local max-ent cannot serve particle {particle} at {moment}: {failure}")]
    NoBasis { particle: usize, moment: Moment, failure: Failure },
    #[error(
        "the consistent mass matrix is singular at {moment}: {particles} particles do not \
         determine the velocities of {nodes} nodes; give the cells more particles, or set \
         mass = \"lumped\""
    )]
    SingularMass { particles: usize, nodes: usize, moment: Moment },
    #[error(
        "the run blew up at {moment}: its energy is {ratio:e} times what start and loads gave it, and \
         particle {particle} holds the largest share"
    )]
    Diverged { particle: usize, moment: Moment, ratio: f64 },
}

impl Breakdown {
    /// The step and time of the breakdown.
    pub fn moment(&self) -> Moment {
        match self {
            Breakdown::LeftGrid { moment, .. }
            | Breakdown::Inverted { moment, .. }
            | Breakdown::NotFinite { moment, .. }
            | Breakdown::NodeNotFinite { moment, .. }
            | Breakdown::NoBasis { moment, .. }
            | Breakdown::SingularMass { moment, .. }
            | Breakdown::Diverged { moment, .. } => *moment,
        }
    }
}

/// An error in a scene: where it stands, what is wrong, what is allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError {
    /// The file, or `--set` for a value from the command line.
    pub path: String,
    /// The text that was read.
    pub text: String,
    /// Bytes of `text` that are at fault.
    pub span: Range<usize>,
    /// The key at fault, dotted; empty when the text is not TOML.
    pub key: String,
    /// What is wrong.
    pub problem: String,
    /// What is allowed instead; empty when `problem` says it.
    pub allowed: String,
    /// The nearest valid key or value.
    pub suggestion: Option<String>,
}

impl SceneError {
    /// The error as a picture of the offending line.
    pub fn render(&self, renderer: &Renderer) -> String {
        let title = match self.key.as_str() {
            "" => self.problem.clone(),
            key => format!("{key}: {}", self.problem),
        };
        let snippet = Snippet::source(&self.text)
            .path(&self.path)
            .annotation(AnnotationKind::Primary.span(self.span.clone()));
        let mut group: Group<'_> = Level::ERROR.primary_title(title).element(snippet);
        if !self.allowed.is_empty() {
            group = group.element(Level::NOTE.message(format!("allowed: {}", self.allowed)));
        }
        if let Some(nearest) = &self.suggestion {
            group = group.element(Level::HELP.message(format!("did you mean `{nearest}`?")));
        }
        renderer.render(&[group])
    }
}

impl std::fmt::Display for SceneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.render(&Renderer::plain()))
    }
}

impl std::error::Error for SceneError {}

/// Any error of the program.
#[derive(Debug, Error)]
pub enum Fault {
    #[error("{0}")]
    Scene(Box<SceneError>),
    #[error("cannot read {path}: {source}")]
    Read { path: PathBuf, source: std::io::Error },
    #[error("cannot write {path}: {source}")]
    Write { path: PathBuf, source: std::io::Error },
    #[error("{path}, line {line}: {problem}; allowed: {allowed}")]
    Points { path: String, line: u64, problem: String, allowed: String },
    #[error("{argument}: {problem}; allowed: {allowed}")]
    Argument { argument: &'static str, problem: String, allowed: &'static str },
    #[error(
        "the time step is too large: c Δt / h is {courant:.4}, and {largest:.4} is the most that \
         stays bounded; set a smaller time.cfl, or time.fraction_of_critical = 0.9, or \
         time.allow_unstable = true to see it blow up{}",
        if *singular {
            " (with one particle per cell the consistent mass matrix is nearly singular: give \
             the cells more)"
        } else {
            ""
        }
    )]
    Unstable { courant: f64, largest: f64, singular: bool },
    #[error(
        "no configuration measured reaches a {quantity} error of {error}: the best has {best:.2e}"
    )]
    NothingReaches { quantity: &'static str, error: f64, best: f64 },
    #[error("no exact solution is known for this scene: {why}")]
    NoExact { why: &'static str },
    #[error(
        "{place}: {problem}; allowed: of a symbol in a time step all numbers or none; --part \
         compares what both have"
    )]
    Alone { place: String, problem: String },
    #[error("{0}")]
    Differs(String),
    #[error("{breakdown}\n{advice}")]
    Run {
        breakdown: Breakdown,
        /// What to try, and where the history was left.
        advice: String,
    },
}

impl Fault {
    /// 1 for a run that broke down, 2 for input or output that cannot be used.
    pub fn exit_code(&self) -> u8 {
        match self {
            Fault::Run { .. } | Fault::Differs(_) => 1,
            _ => 2,
        }
    }
}

impl From<Box<SceneError>> for Fault {
    fn from(error: Box<SceneError>) -> Self {
        Fault::Scene(error)
    }
}
