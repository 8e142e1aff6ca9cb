//! The values of a scene are found by their path: read as the table of keys says, each with the
//! place where it was written.

use super::fault::SceneError;
use super::keys::{self, AXES, KEYS, SIDES, Without};
use super::kind::{Value, nearest};
use super::source::{Source, join};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

const MISSING: &str = "this key is missing";

/// This holds a scene's values, each of the kind that its key says.
pub struct Values {
    source: Source,
    /// By path, with the entries of lists counted: `probe[0].name`.
    found: BTreeMap<String, (Value, Range<usize>)>,
}

/// A named side is a side of the box that a scene has a key for.
pub struct NamedSide {
    /// Its path, as `boundary.left`.
    pub path: String,
    pub axis: usize,
    /// 0 for the lower side, 1 for the upper one.
    pub upper: usize,
}

impl Values {
    /// Reads all values of `source`.
    ///
    /// Errors: [`SceneError`] for what is no TOML, unknown keys, values that their key does
    /// not allow, missing keys, and keys that go with a word that is not chosen.
    pub fn read(source: Source) -> Result<Self, Box<SceneError>> {
        let mut found = BTreeMap::new();
        let table = source.table()?;
        read_table(&mut found, &source, table.get_ref(), "", table.span())?;
        drop(table);
        let values = Values { source, found };
        for key in KEYS {
            let Some((other, word)) = key.with else { continue };
            let chosen = values.word(other)?;
            if values.has(key.path) && chosen != word {
                let problem = format!("it means nothing with {other} = \"{chosen}\"");
                return Err(values.error(key.path, problem));
            }
            if !values.has(key.path) && chosen == word && matches!(key.without, Without::Refused) {
                let problem = format!("{other} = \"{word}\" needs this key");
                return Err(values.error_at(key.path, other, problem));
            }
        }
        Ok(values)
    }

    /// Makes the error `problem` with the value of `key`, wherever it was written.
    pub fn error(&self, key: &str, problem: impl Into<String>) -> Box<SceneError> {
        self.error_at(key, key, problem)
    }

    /// Makes the error `problem` with `key`, shown at the value of another key.
    pub fn error_at(&self, key: &str, other: &str, problem: impl Into<String>) -> Box<SceneError> {
        let span = self.found.get(other).map_or(0..0, |(_, span)| span.clone());
        self.source.error(key, span, problem)
    }

    /// Tells whether the scene has a value there.
    pub fn has(&self, path: &str) -> bool {
        self.found.contains_key(path)
    }

    /// Tells whether a value is one word where it could be a table.
    pub fn is_word(&self, path: &str) -> bool {
        matches!(self.value(path), Some(Value::Word(_)))
    }

    /// Lists the paths of the entries of a list.
    pub fn entries(&self, list: &str) -> Vec<String> {
        let length = match self.value(list) {
            Some(Value::List(length)) => *length,
            _ => 0,
        };
        (0..length).map(|n| format!("{list}[{n}]")).collect()
    }

    /// Counts the axes.
    pub fn dimension(&self) -> usize {
        match self.value("body.length") {
            Some(Value::Numbers(list)) => list.len(),
            _ => 0,
        }
    }

    /// Lists the sides that stand in a table, in the order of axes.
    ///
    /// Errors: [`SceneError`] for a side of an axis that the scene does not have.
    pub fn sides(&self, table: &str) -> Result<Vec<NamedSide>, Box<SceneError>> {
        let mut sides = Vec::new();
        for (axis, names) in SIDES.iter().enumerate() {
            for (upper, name) in names.iter().enumerate() {
                let path = join(table, name);
                if self.has(&path) {
                    self.on_axis(&path, axis)?;
                    sides.push(NamedSide { path, axis, upper });
                }
            }
        }
        Ok(sides)
    }

    /// Lists the components that stand in a table, as path and axis.
    ///
    /// Errors: [`SceneError`] for an axis that the scene does not have.
    pub fn components(&self, table: &str) -> Result<Vec<(String, usize)>, Box<SceneError>> {
        let paths = AXES.iter().map(|name| join(table, name)).enumerate();
        let given = paths.filter(|(_, path)| self.has(path));
        given.map(|(i, path)| self.on_axis(&path, i).map(|()| (path, i))).collect()
    }

    fn on_axis(&self, path: &str, axis: usize) -> Result<(), Box<SceneError>> {
        if axis < self.dimension() {
            return Ok(());
        }
        let has = counted(self.dimension(), "axis");
        Err(self.error(path, format!("the scene has {has}, and this names another")))
    }

    /// Gives a text, a name, or one of the words of a choice.
    pub fn word(&self, path: &str) -> Result<&str, Box<SceneError>> {
        match (self.value(path), without(path)) {
            (Some(Value::Word(word)), _) => Ok(word),
            (None, Without::Word(word)) => Ok(word),
            _ => Err(self.error(path, MISSING)),
        }
    }

    /// Gives what the chosen word stands for.
    pub fn choose<T: Copy>(
        &self,
        path: &str,
        meanings: &[(&str, T)],
    ) -> Result<T, Box<SceneError>> {
        let word = self.word(path)?;
        let found = meanings.iter().find(|(name, _)| *name == word);
        found.map(|(_, meaning)| *meaning).ok_or_else(|| self.error(path, "it is not known here"))
    }

    /// Gives true or false.
    pub fn flag(&self, path: &str) -> Result<bool, Box<SceneError>> {
        match (self.value(path), without(path)) {
            (Some(Value::Flag(flag)), _) => Ok(*flag),
            (None, Without::Flag(flag)) => Ok(flag),
            _ => Err(self.error(path, MISSING)),
        }
    }

    /// Gives a number.
    pub fn number(&self, path: &str) -> Result<f64, Box<SceneError>> {
        match (self.value(path), without(path)) {
            (Some(Value::Numbers(list)), _) if list.len() == 1 => Ok(list[0]),
            (None, Without::Number(x)) => Ok(x),
            _ => Err(self.error(path, MISSING)),
        }
    }

    /// Gives a number of which the rest of the scene asks that it is `good`.
    pub fn number_if(
        &self,
        path: &str,
        good: impl Fn(f64) -> bool,
    ) -> Result<f64, Box<SceneError>> {
        let x = self.number(path)?;
        if good(x) { Ok(x) } else { Err(self.error(path, format!("{x:?} is out of range"))) }
    }

    /// Gives a whole number.
    pub fn whole(&self, path: &str) -> Result<usize, Box<SceneError>> {
        match (self.value(path), without(path)) {
            (Some(Value::Wholes(list)), _) if list.len() == 1 => Ok(list[0]),
            (None, Without::Number(n)) => Ok(n as usize),
            _ => Err(self.error(path, MISSING)),
        }
    }

    /// Gives one number for each axis.
    pub fn axes(&self, path: &str) -> Result<Vec<f64>, Box<SceneError>> {
        match (self.value(path), without(path)) {
            (Some(Value::Numbers(list)), _) => self.one_for_each_axis(path, list),
            (None, Without::Number(x)) => Ok(vec![x; self.dimension()]),
            _ => Err(self.error(path, MISSING)),
        }
    }

    /// Gives one number for each axis, of which the rest of the scene asks that all are `good`.
    pub fn axes_if(
        &self,
        path: &str,
        good: impl Fn(usize, f64) -> bool,
    ) -> Result<Vec<f64>, Box<SceneError>> {
        let list = self.axes(path)?;
        match list.iter().enumerate().find(|&(d, x)| !good(d, *x)) {
            None => Ok(list),
            Some((_, x)) => Err(self.error(path, format!("{x:?} is out of range"))),
        }
    }

    /// Gives one whole number for each axis.
    pub fn wholes(&self, path: &str) -> Result<Vec<usize>, Box<SceneError>> {
        match self.value(path) {
            Some(Value::Wholes(list)) => self.one_for_each_axis(path, list),
            _ => Err(self.error(path, MISSING)),
        }
    }

    fn one_for_each_axis<T: Copy>(
        &self,
        path: &str,
        list: &[T],
    ) -> Result<Vec<T>, Box<SceneError>> {
        if list.len() == self.dimension() {
            return Ok(list.to_vec());
        }
        let problem = format!(
            "{} given, but the scene has {}, as body.length has {}",
            counted(list.len(), "number"),
            counted(self.dimension(), "axis"),
            counted(self.dimension(), "entry")
        );
        Err(self.error(path, problem))
    }

    fn value(&self, path: &str) -> Option<&Value> {
        self.found.get(path).map(|(value, _)| value)
    }
}

/// Reads the keys of one table and of those inside it.
fn read_table(
    found: &mut BTreeMap<String, (Value, Range<usize>)>,
    source: &Source,
    table: &DeTable<'_>,
    parent: &str,
    span: Range<usize>,
) -> Result<(), Box<SceneError>> {
    for (name, value) in table {
        let path = join(parent, name.get_ref());
        // A name in quotes may hold what a path is made of.
        let key = keys::find(&path).filter(|_| !name.get_ref().contains(['.', '[', ']']));
        let key = key.ok_or_else(|| unknown(source, parent, name.get_ref(), name.span()))?;
        let checked = key.kind.read(value).map_err(|wrong| {
            let mut error = source.error(&path, wrong.span, wrong.problem);
            error.suggestion = wrong.suggestion;
            error
        })?;
        match value.get_ref() {
            DeValue::Table(inner) => read_table(found, source, inner, &path, value.span())?,
            DeValue::Array(list) if matches!(checked, Value::List(_)) => {
                for (n, entry) in list.iter().enumerate() {
                    if let DeValue::Table(inner) = entry.get_ref() {
                        let path = format!("{path}[{n}]");
                        read_table(found, source, inner, &path, entry.span())?;
                    }
                }
            }
            _ => {}
        }
        found.insert(path, (checked, value.span()));
    }
    for key in keys::children(parent).filter(|key| key.is_required()) {
        let name = key.place().1;
        if table.get(name).is_none() {
            return Err(source.error(&join(parent, name), span.start..span.start, MISSING));
        }
    }
    Ok(())
}

fn unknown(source: &Source, parent: &str, name: &str, span: Range<usize>) -> Box<SceneError> {
    let siblings: Vec<&str> = keys::children(parent).flat_map(|key| key.names()).collect();
    let mut error = source.error(&join(parent, name), span, "this key is not known");
    error.allowed = siblings.join(", ");
    // The right name in the wrong table is worth a thought, too.
    let elsewhere = || KEYS.iter().find(|key| key.place().1 == name);
    error.suggestion = nearest(name, siblings.iter().copied())
        .or_else(|| elsewhere().map(|key| key.path.to_string()));
    error
}

/// Says what holds without the key at `path`.
fn without(path: &str) -> Without {
    keys::find(path).map_or(Without::Refused, |key| key.without)
}

/// Writes a number with its noun, as "1 axis" or "2 entries".
pub fn counted(n: usize, word: &str) -> String {
    match (n, word) {
        (1, _) => format!("1 {word}"),
        (_, "axis") => format!("{n} axes"),
        (_, "entry") => format!("{n} entries"),
        _ => format!("{n} {word}s"),
    }
}
