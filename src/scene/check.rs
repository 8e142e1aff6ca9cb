//! Range checks of single values.

use super::file::PerAxis;
use super::keys::nearest;
use super::source::Source;
use crate::scene::fault::SceneError;
use std::fmt;
use std::ops::Range;
use toml::Spanned;

/// Range checks that know where every value was written.
pub struct Check<'a> {
    pub source: &'a Source,
    pub dimension: usize,
}

impl Check<'_> {
    pub fn number(
        &self,
        key: &str,
        value: &Spanned<f64>,
        good: impl Fn(f64) -> bool,
    ) -> Result<f64, Box<SceneError>> {
        let x = *value.get_ref();
        if x.is_finite() && good(x) {
            return Ok(x);
        }
        Err(self.source.error(key, value.span(), format!("{x:?} is out of range")))
    }

    /// One entry for each axis, all good.
    pub fn axes<T: Copy + fmt::Debug>(
        &self,
        key: &str,
        value: &Spanned<PerAxis<T>>,
        good: impl Fn(usize, T) -> bool,
    ) -> Result<Vec<T>, Box<SceneError>> {
        let list = &value.get_ref().0;
        if list.len() != self.dimension {
            let problem = format!(
                "{} given, but the scene has {}, as body.length has {}",
                counted(list.len(), "number"),
                counted(self.dimension, "axis"),
                counted(self.dimension, "entry")
            );
            return Err(self.source.error(key, value.span(), problem));
        }
        match list.iter().enumerate().find(|&(d, x)| !good(d, *x)) {
            None => Ok(list.clone()),
            Some((_, x)) => {
                Err(self.source.error(key, value.span(), format!("{x:?} is out of range")))
            }
        }
    }

    /// The choice that the text names.
    pub fn choose<T: Copy>(
        &self,
        key: &str,
        text: &str,
        span: Range<usize>,
        choices: &[(&str, T)],
    ) -> Result<T, Box<SceneError>> {
        if let Some((_, choice)) = choices.iter().find(|(name, _)| *name == text) {
            return Ok(*choice);
        }
        let mut error = self.source.error(key, span, format!("\"{text}\" is not known here"));
        error.suggestion = nearest(text, choices.iter().map(|(name, _)| *name));
        Err(error)
    }
}

pub fn counted(n: usize, word: &str) -> String {
    match (n, word) {
        (1, _) => format!("1 {word}"),
        (_, "axis") => format!("{n} axes"),
        (_, "entry") => format!("{n} entries"),
        _ => format!("{n} {word}s"),
    }
}
