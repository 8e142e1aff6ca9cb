//! Everything that can go wrong has a name here.
//!
//! There are two families with an exit code each. Input that cannot be used ([`SceneError`],
//! [`Fault::Read`], …) ends with 2 before anything is written. A run that breaks down
//! ([`BrokenDown`]) ends with 1 and leaves its history under a name that says so; one that is
//! interrupted does the same and ends with 130; a port whose trace differs
//! ([`Fault::Differs`]) ends with 1, too, and so do results that are no finite numbers
//! ([`Fault::NotFinite`]).

use crate::method::breakdown::{Breakdown, BrokenDown};
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use std::ops::Range;
use std::path::PathBuf;
use thiserror::Error;

/// An error in a scene says where it stands, what is wrong, and what is allowed.
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
    /// Says what is allowed instead.
    pub fn allowing(mut self: Box<Self>, allowed: impl Into<String>) -> Box<Self> {
        self.allowed = allowed.into();
        self
    }

    /// Draws the offending line with the error below it.
    pub fn render(&self, renderer: &Renderer) -> String {
        let title = match self.key.as_str() {
            "" => visible(&self.problem, &['\n']),
            key => visible(&format!("{key}: {}", self.problem), &[]),
        };
        let path = visible(&self.path, &[]);
        let snippet = Snippet::source(&self.text)
            .path(&path)
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

/// A fault is any error of the program.
#[derive(Debug, Error)]
pub enum Fault {
    #[error("{0}")]
    Scene(Box<SceneError>),
    #[error("cannot read {path}: {source}")]
    Read { path: PathBuf, source: std::io::Error },
    #[error(
        "cannot read {path}: {source}, and no scene of that name ships with the program; \
         shipped: {shipped}{}",
        suggestion.as_ref().map_or(String::new(), |name| format!("; did you mean `{name}`?"))
    )]
    NoScene { path: PathBuf, source: std::io::Error, shipped: String, suggestion: Option<String> },
    #[error("cannot write {path}: {source}")]
    Write { path: PathBuf, source: std::io::Error },
    #[error(
        "cannot replace {dir}: its {file} is not listed, as it stands there, in a {list} of \
         lme-mpm (earlier versions wrote no list); choose another --out, or move away what is there"
    )]
    Foreign { dir: PathBuf, file: PathBuf, list: &'static str },
    #[error("cannot write standard output: {source}; {left}")]
    Output {
        source: std::io::Error,
        /// What is written all the same.
        left: String,
    },
    #[error("{path}, line {line}: {problem}; allowed: {allowed}")]
    Points { path: String, line: u64, problem: String, allowed: String },
    #[error("{argument}: {problem}; allowed: {allowed}")]
    Argument { argument: &'static str, problem: String, allowed: &'static str },
    #[error("{}; set {}", too_large(*courant, *largest), smaller_step(*singular))]
    Unstable { courant: f64, largest: f64, singular: bool },
    #[error(
        "no configuration measured reaches a {quantity} error of {error}: {}",
        best.map_or("none came to its end".to_string(), |best| format!("the best has {best:.2e}"))
    )]
    NothingReaches { quantity: &'static str, error: f64, best: Option<f64> },
    #[error("no exact solution is known for this scene: {why}")]
    NoExact { why: &'static str },
    #[error(
        "{place}: {problem}; allowed: of a symbol in a time step all numbers or none; --part \
         compares what both have"
    )]
    Alone { place: String, problem: String },
    #[error("{quantity} is {value}, which is no finite number and is not written")]
    NotFinite { quantity: String, value: String },
    #[error("{0}")]
    Differs(String),
    #[error("{0}")]
    Warned(String),
    #[error("{broken}\n{advice}")]
    Run {
        broken: BrokenDown,
        /// What to try, and where the history was left.
        advice: String,
    },
}

/// Says that c Δt / h is too large, and how large it may be.
pub fn too_large(courant: f64, largest: f64) -> String {
    format!(
        "the time step is too large: c Δt / h is {courant:.4}, and {largest:.4} is the most that \
         stays bounded"
    )
}

/// Says what makes a time step hold, of a mass matrix that may be nearly `singular`.
pub fn smaller_step(singular: bool) -> String {
    let more = match singular {
        true => {
            " (with one particle per cell the consistent mass matrix is nearly singular: give \
             the cells more)"
        }
        false => "",
    };
    format!(
        "a smaller time.cfl, or time.fraction_of_critical = 0.9, or time.allow_unstable = true to \
         see it blow up{more}"
    )
}

impl Fault {
    /// Gives the exit code: 1 for a run that broke down, or is warned of where that is an error,
    /// and for a port that differs; 130 for a run that was interrupted, as shells have it; 2 for
    /// input or output that cannot be used.
    pub fn exit_code(&self) -> u8 {
        match self {
            Fault::Run { broken, .. } if broken.breakdown == Breakdown::Interrupted => 130,
            Fault::Run { .. } | Fault::Differs(_) | Fault::Warned(_) | Fault::NotFinite { .. } => 1,
            _ => 2,
        }
    }
}

/// Tells whether a terminal may obey this character (a control character, or one that turns the
/// direction of writing), or no SVG may hold it (U+FFFE and U+FFFF).
pub fn unprintable(c: char) -> bool {
    let turns = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns || matches!(c, '\u{fffe}' | '\u{ffff}')
}

/// Writes what is unprintable in a text as `\u{1b}`, `\n` and so on, but for the characters that
/// are `kept`.
pub fn visible(text: &str, kept: &[char]) -> String {
    let plain = |c: char| match unprintable(c) && !kept.contains(&c) {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    };
    text.chars().map(plain).collect()
}

impl From<Box<SceneError>> for Fault {
    fn from(error: Box<SceneError>) -> Self {
        Fault::Scene(error)
    }
}
