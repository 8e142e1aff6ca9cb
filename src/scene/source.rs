//! The text of a scene: a file with the `--set` values merged in, and the way
//! back from a byte to the place where it was written.

use super::keys::{self, KEYS};
use crate::scene::fault::SceneError;
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// One piece of text and where it begins in the run of all spans.
struct Piece {
    path: String,
    text: String,
    start: usize,
}

/// The table of a scene with the `sets` merged in: known keys, none missing, values not
/// checked.
///
/// Errors: [`SceneError`] with file, line, key and what is allowed.
pub fn merged(path: &str, text: &str, sets: &[String]) -> Result<toml::Table, Box<SceneError>> {
    Ok(Source::new(path, text, sets).read()?.0)
}

/// A scene's text: the file first, then one piece for each `--set`.
///
/// Every piece is parsed as if it followed the pieces before it, so that one
/// number, the span, says both which piece and where in it.
pub struct Source {
    pieces: Vec<Piece>,
}

impl Source {
    /// The pieces of a scene; `sets` are the arguments of `--set`: `KEY=VALUE` gives a
    /// value, `KEY=` takes it out.
    pub fn new(path: &str, text: &str, sets: &[String]) -> Self {
        let mut source = Source { pieces: Vec::new() };
        source.add(path.to_string(), text.to_string());
        for set in sets {
            let text = match set.split_once('=') {
                // A bare word is a string, so that shells need no quotes.
                Some((key, word)) if DeTable::parse(set).is_err() && is_word(word) => {
                    format!("{key}=\"{}\"", word.trim())
                }
                _ => set.clone(),
            };
            source.add(format!("--set {set}"), text);
        }
        source
    }

    fn add(&mut self, path: String, text: String) {
        let start = self.pieces.last().map_or(0, |last| last.start + last.text.len() + 1);
        self.pieces.push(Piece { path, text, start });
    }

    /// The error `problem` with the value of `key` at `span`.
    pub fn error(
        &self,
        key: &str,
        span: Range<usize>,
        problem: impl Into<String>,
    ) -> Box<SceneError> {
        let piece =
            self.pieces.iter().rfind(|piece| piece.start <= span.start).unwrap_or(&self.pieces[0]);
        let end = piece.text.len();
        let local = |at: usize| at.saturating_sub(piece.start).min(end);
        Box::new(SceneError {
            path: piece.path.clone(),
            text: piece.text.clone(),
            span: local(span.start)..local(span.end),
            key: key.to_string(),
            problem: problem.into(),
            allowed: keys::find(&without_indices(key))
                .map_or(String::new(), |key| key.allowed.to_string()),
            suggestion: None,
        })
    }

    /// Reads the text as a `T`: syntax, unknown keys, missing keys, types.
    pub fn read<T: for<'de> Deserialize<'de>>(&self) -> Result<(T, Spans), Box<SceneError>> {
        let mut padded = Vec::new();
        for piece in &self.pieces {
            padded.push(format!("{}{}", " ".repeat(piece.start), piece.text));
        }
        let mut merged: Option<Spanned<DeTable<'_>>> = None;
        for (text, piece) in padded.iter().zip(&self.pieces) {
            if let (Some(merged), Some(key)) = (&mut merged, piece.text.strip_suffix('=')) {
                self.take_out(merged.get_mut(), key, piece.start)?;
                continue;
            }
            let table = DeTable::parse(text).map_err(|error| {
                let mut error = self.error(
                    "",
                    error.span().unwrap_or(piece.start..piece.start),
                    error.message(),
                );
                if merged.is_some() {
                    error.allowed = "KEY=VALUE, for example grid.cells=80".to_string();
                }
                error
            })?;
            let single = table.get_ref().len() == 1
                && piece.text.contains('=')
                && !piece.text.trim_start().starts_with('[')
                && !piece.text.contains('\n');
            if merged.is_some() && !single {
                let span = piece.start..piece.start + piece.text.len();
                let mut error = self.error("", span, "this is not one KEY=VALUE");
                error.allowed = "KEY=VALUE, for example grid.cells=80".to_string();
                return Err(error);
            }
            match &mut merged {
                None => merged = Some(table),
                Some(merged) => self.merge_table(merged.get_mut(), table.into_inner(), "")?,
            }
        }
        let Some(table) = merged else {
            return Err(self.error("", 0..0, "the scene is empty"));
        };
        self.known_keys(table.get_ref(), "", table.span())?;
        let spans = Spans(key_spans(table.get_ref(), ""));
        match T::deserialize(toml::Deserializer::from(table)) {
            Ok(file) => Ok((file, spans)),
            Err(error) => {
                let span = error.span().unwrap_or(0..0);
                let plain = error.message().replace("expected f64", "expected a number");
                let plain = plain.replace("expected i64", "expected a whole number");
                Err(self.error(spans.key_at(span.start), span, plain))
            }
        }
    }

    /// Takes the value of `key`, whose name stands at `start`, out of the table; one that
    /// is not there is no error, one that no scene can have is.
    fn take_out(
        &self,
        table: &mut DeTable<'_>,
        key: &str,
        start: usize,
    ) -> Result<(), Box<SceneError>> {
        let span = start..start + key.len();
        if keys::find(key).is_none() {
            let mut error = self.error(key, span, "this key is not known");
            error.suggestion = keys::nearest(key, KEYS.iter().map(|key| key.path));
            return Err(error);
        }
        let (mut table, mut rest) = (table, key);
        while let Some((parent, inside)) = rest.split_once('.') {
            match table.get_mut(parent).map(Spanned::get_mut) {
                Some(DeValue::Table(inner)) => (table, rest) = (inner, inside),
                Some(_) => {
                    let problem = format!("`{parent}` is not a table here");
                    return Err(self.error(key, span, problem));
                }
                None => return Ok(()),
            }
        }
        table.remove(rest);
        Ok(())
    }

    fn merge_table<'i>(
        &self,
        target: &mut DeTable<'i>,
        patch: DeTable<'i>,
        parent: &str,
    ) -> Result<(), Box<SceneError>> {
        for (name, value) in patch {
            let path = join(parent, name.get_ref());
            match target.get_mut(name.get_ref().as_ref()) {
                Some(old) => self.merge_value(old, value, &path)?,
                None => {
                    target.insert(name, value);
                }
            }
        }
        Ok(())
    }

    fn merge_value<'i>(
        &self,
        target: &mut Spanned<DeValue<'i>>,
        patch: Spanned<DeValue<'i>>,
        path: &str,
    ) -> Result<(), Box<SceneError>> {
        let span = patch.span();
        match (target.get_mut(), patch.into_inner()) {
            (DeValue::Table(old), DeValue::Table(new)) => self.merge_table(old, new, path),
            (DeValue::Array(list), DeValue::Table(new)) => {
                let length = list.len();
                for (index, value) in new {
                    let entry = index.get_ref().parse::<usize>().ok().filter(|i| *i < length);
                    let Some(i) = entry else {
                        let problem = format!("`{}` is not an entry of this list", index.get_ref());
                        let mut error = self.error(path, index.span(), problem);
                        error.allowed = format!("a number from 0 to {}", length.saturating_sub(1));
                        return Err(error);
                    };
                    self.merge_value(&mut list.as_mut()[i], value, &format!("{path}[{i}]"))?;
                }
                Ok(())
            }
            (_, new) => {
                *target = Spanned::new(span, new);
                Ok(())
            }
        }
    }

    /// Every key is known, and no table lacks a required one.
    fn known_keys(
        &self,
        table: &DeTable<'_>,
        parent: &str,
        span: Range<usize>,
    ) -> Result<(), Box<SceneError>> {
        let bare_parent = without_indices(parent);
        for (name, value) in table {
            let path = join(parent, name.get_ref());
            if keys::find(&without_indices(&path)).is_none() {
                let mut error = self.error(&path, name.span(), "this key is not known");
                let siblings = || keys::children(&bare_parent).map(|key| last(key.path));
                error.allowed = siblings().collect::<Vec<_>>().join(", ");
                // The right name in the wrong table is worth a thought, too.
                error.suggestion = keys::nearest(name.get_ref(), siblings()).or_else(|| {
                    KEYS.iter()
                        .find(|key| last(key.path) == name.get_ref())
                        .map(|key| key.path.to_string())
                });
                return Err(error);
            }
            let wants_table = keys::children(&without_indices(&path)).next().is_some();
            let is_list = keys::LISTS.contains(&path.as_str());
            match value.get_ref() {
                DeValue::Table(inner) => self.known_keys(inner, &path, value.span())?,
                DeValue::Array(list) if is_list => {
                    if let Some(entry) = list.iter().find(|entry| !entry.get_ref().is_table()) {
                        let problem = "each entry must be a table with its keys";
                        return Err(self.error(&path, entry.span(), problem));
                    }
                    for (i, entry) in list.iter().enumerate() {
                        if let DeValue::Table(inner) = entry.get_ref() {
                            self.known_keys(inner, &format!("{path}[{i}]"), entry.span())?;
                        }
                    }
                }
                // A side of the boundary may be one word for all components.
                DeValue::String(_) if path.starts_with("boundary.") => {}
                _ if wants_table => {
                    let wanted = if is_list { "a list of tables" } else { "a table with keys" };
                    return Err(self.error(&path, value.span(), format!("this must be {wanted}")));
                }
                _ => {}
            }
        }
        for key in keys::children(&bare_parent).filter(|key| key.required) {
            if table.get(last(key.path)).is_none() {
                let path = join(parent, last(key.path));
                return Err(self.error(&path, span.start..span.start, "this key is missing"));
            }
        }
        Ok(())
    }
}

/// Every key of a scene with the span of its value.
pub struct Spans(Vec<(String, Range<usize>)>);

impl Spans {
    /// Where the value of `key` stands; the beginning for a key that is not there.
    pub fn of(&self, key: &str) -> Range<usize> {
        let found = self.0.iter().find(|(name, _)| name == key);
        found.map_or(0..0, |(_, span)| span.clone())
    }

    /// The innermost key whose value holds byte `at`; empty outside of all.
    fn key_at(&self, at: usize) -> &str {
        let around = self.0.iter().filter(|(_, span)| span.contains(&at));
        around.min_by_key(|(_, span)| span.len()).map_or("", |(key, _)| key)
    }
}

/// A word that TOML would want in quotes.
fn is_word(text: &str) -> bool {
    !text.trim().is_empty() && !text.contains(['"', '\'', '[', '{', '=', '\n'])
}

fn join(parent: &str, name: &str) -> String {
    if parent.is_empty() { name.to_string() } else { format!("{parent}.{name}") }
}

fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// `probe[1].name` → `probe.name`.
fn without_indices(path: &str) -> String {
    let mut inside = false;
    path.chars()
        .filter(|c| {
            inside = (inside || *c == '[') && *c != ']';
            !inside && *c != ']'
        })
        .collect()
}

/// Every key with the span of its value.
fn key_spans(table: &DeTable<'_>, parent: &str) -> Vec<(String, Range<usize>)> {
    let mut spans = Vec::new();
    for (name, value) in table {
        let path = join(parent, name.get_ref());
        match value.get_ref() {
            DeValue::Table(inner) => spans.extend(key_spans(inner, &path)),
            DeValue::Array(list) => {
                for (i, entry) in list.iter().enumerate() {
                    if let DeValue::Table(inner) = entry.get_ref() {
                        spans.extend(key_spans(inner, &format!("{path}[{i}]")));
                    }
                }
            }
            _ => {}
        }
        spans.push((path, value.span()));
    }
    spans
}
