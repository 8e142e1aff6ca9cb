//! The text of a scene is a file with the `--set` values merged in, and knows the way back from
//! a byte to the place where it was written.

use super::fault::SceneError;
use super::keys::{self, KEYS};
use super::kind::nearest;
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// This may follow `--set`.
const SET: &str = "KEY=VALUE, for example grid.cells=80";

/// A passage is a piece of the text that knows where it begins in the run of all spans.
struct Passage {
    path: String,
    /// The text behind as many blanks as `start` says.
    padded: String,
    start: usize,
}

impl Passage {
    fn text(&self) -> &str {
        &self.padded[self.start..]
    }
}

/// Makes the table of a scene with the `sets` merged in; nothing of it is checked.
///
/// Errors: [`SceneError`] for what is no TOML, or no `KEY=VALUE`.
pub fn merged(path: &str, text: &str, sets: &[String]) -> Result<toml::Table, Box<SceneError>> {
    let source = Source::new(path, text, sets);
    let table = toml::Table::deserialize(toml::Deserializer::from(source.table()?));
    table.map_err(|error| source.error("", error.span().unwrap_or(0..0), error.message()))
}

/// A source is a scene's text: the file first, then one passage for each `--set`.
///
/// Every passage is parsed as if it followed those before it, so that one
/// number, the span, says both which passage and where in it.
pub struct Source {
    passages: Vec<Passage>,
}

impl Source {
    /// Makes the passages of a scene; `sets` are the arguments of `--set`: `KEY=VALUE` gives a
    /// value, `KEY=` takes it out.
    pub fn new(path: &str, text: &str, sets: &[String]) -> Self {
        let mut source = Source { passages: Vec::new() };
        source.add(path.to_string(), text);
        for set in sets {
            let set = &dotted(set);
            let quoted = match set.split_once('=') {
                // A bare word is a string, so that shells need no quotes.
                Some((key, word)) if DeTable::parse(set).is_err() && is_word(word) => {
                    format!("{key}=\"{}\"", word.trim())
                }
                _ => set.clone(),
            };
            source.add(format!("--set {set}"), &quoted);
        }
        source
    }

    fn add(&mut self, path: String, text: &str) {
        let start = self.passages.last().map_or(0, |last| last.padded.len() + 1);
        let padded = " ".repeat(start) + text;
        self.passages.push(Passage { path, padded, start });
    }

    /// Makes the error `problem` with the value of `key` at `span`.
    pub fn error(
        &self,
        key: &str,
        span: Range<usize>,
        problem: impl Into<String>,
    ) -> Box<SceneError> {
        let found = self.passages.iter().rfind(|passage| passage.start <= span.start);
        let passage = found.unwrap_or(&self.passages[0]);
        let end = passage.text().len();
        let local = |at: usize| at.saturating_sub(passage.start).min(end);
        Box::new(SceneError {
            path: passage.path.clone(),
            text: passage.text().to_string(),
            span: local(span.start)..local(span.end),
            key: key.to_string(),
            problem: problem.into(),
            allowed: keys::find(key).map_or(String::new(), |key| key.allowed()),
            suggestion: None,
        })
    }

    /// Merges all passages into one table.
    ///
    /// Errors: [`SceneError`] for what is no TOML, or no `KEY=VALUE`.
    pub fn table(&self) -> Result<Spanned<DeTable<'_>>, Box<SceneError>> {
        let (file, sets) = (&self.passages[0], &self.passages[1..]);
        let mut merged = self.parse(file)?;
        for set in sets {
            let with_help = |mut error: Box<SceneError>| {
                error.allowed = SET.to_string();
                error
            };
            let text = set.text();
            if let Some(key) = text.strip_suffix('=') {
                self.take_out(merged.get_mut(), key, set.start)?;
                continue;
            }
            let table = self.parse(set).map_err(with_help)?.into_inner();
            let line = !text.trim_start().starts_with('[') && !text.contains('\n');
            if table.len() != 1 || !text.contains('=') || !line {
                let span = set.start..set.padded.len();
                return Err(with_help(self.error("", span, "this is not one KEY=VALUE")));
            }
            self.merge_table(merged.get_mut(), table, "")?;
        }
        Ok(merged)
    }

    fn parse<'a>(&self, passage: &'a Passage) -> Result<Spanned<DeTable<'a>>, Box<SceneError>> {
        DeTable::parse(&passage.padded).map_err(|error| {
            let span = error.span().unwrap_or(passage.start..passage.start);
            self.error("", span, error.message())
        })
    }

    /// Takes the value of `key`, whose name stands at `start`, out of the table; one that
    /// is not there is no error, one that no scene can have is.
    fn take_out(
        &self,
        table: &mut DeTable<'_>,
        key: &str,
        start: usize,
    ) -> Result<(), Box<SceneError>> {
        let refuse = |problem: String| self.error(key, start..start + key.len(), problem);
        let names: Vec<&str> = key.split('.').collect();
        let is_number = |name: &&str| name.parse::<usize>().is_ok();
        let path: Vec<&str> = names.iter().copied().filter(|name| !is_number(name)).collect();
        if keys::find(&path.join(".")).is_none() {
            let mut error = refuse("this key is not known".to_string());
            error.suggestion = nearest(key, KEYS.iter().map(|key| key.path));
            return Err(error);
        }
        remove(table, &names).map_err(refuse)
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
}

/// Tells whether this is a word that TOML would want in quotes.
fn is_word(text: &str) -> bool {
    !text.trim().is_empty() && !text.contains(['"', '\'', '[', '{', '=', '\n'])
}

/// Gives the path of `name` in the table `parent`.
pub fn join(parent: &str, name: &str) -> String {
    if parent.is_empty() { name.to_string() } else { format!("{parent}.{name}") }
}

/// Removes the value behind `names` from a table, if it is there; entries of lists are
/// counted. Returns what is wrong with names that lead nowhere.
fn remove(table: &mut DeTable<'_>, names: &[&str]) -> Result<(), String> {
    let [name, inside @ ..] = names else { return Ok(()) };
    if inside.is_empty() {
        table.remove(*name);
        return Ok(());
    }
    match (table.get_mut(*name).map(Spanned::get_mut), inside) {
        (None, _) if name.parse::<usize>().is_ok() => Err("there is no list here".to_string()),
        (None, _) => Ok(()),
        (Some(DeValue::Table(inner)), _) => remove(inner, inside),
        (Some(DeValue::Array(_)), [n]) if n.parse::<usize>().is_ok() => {
            Err(format!("one entry of a list cannot be taken out, only all: {name}="))
        }
        (Some(DeValue::Array(list)), [n, inside @ ..]) => {
            let entry = n.parse().ok().and_then(|n: usize| list.as_mut().get_mut(n));
            match entry.map(Spanned::get_mut) {
                Some(DeValue::Table(inner)) => remove(inner, inside),
                _ => Err(format!("`{n}` is not an entry of this list")),
            }
        }
        (Some(_), _) => Err(format!("`{name}` is not a table here")),
    }
}

/// Writes the entries of lists in the key of a `KEY=VALUE` as `probe.0.name`, where messages
/// have `probe[0].name`.
fn dotted(set: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_.[]".contains(c);
    match set.split_once('=') {
        Some((key, value)) if key.contains('[') && key.chars().all(plain) => {
            format!("{}={value}", key.replace('[', ".").replace(']', ""))
        }
        _ => set.to_string(),
    }
}
