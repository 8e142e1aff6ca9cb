//! Says what the value of a key may be, in words and as a check.

use super::fault::unprintable;
use std::ops::Bound::{self, Excluded, Included, Unbounded};
use std::ops::{Range, RangeBounds};
use toml::Spanned;
use toml::de::DeValue;

/// A kind says what a value may be, whatever the rest of the scene says.
#[derive(Clone, Copy)]
pub enum Kind {
    /// A table with keys of its own.
    Table,
    /// A list of tables.
    List,
    Text,
    /// The name of a column and a file, and none of these.
    Name(&'static [&'static str]),
    Choice(&'static [&'static str]),
    /// One of these words, or a table with one of them for each component.
    ChoiceOrTable(&'static [&'static str]),
    Flag,
    One(Number),
    /// A list with one number for each axis; in 1D the bare number, too.
    PerAxis(Number),
}

/// This is the number that a key wants: whole or not, within bounds.
#[derive(Clone, Copy)]
pub struct Number {
    pub whole: bool,
    pub least: Bound<f64>,
    pub most: Bound<f64>,
    /// Empty for what has none.
    pub unit: &'static str,
}

/// A value has been read, and is of the right kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Table,
    List(usize),
    Word(String),
    Flag(bool),
    Numbers(Vec<f64>),
    Wholes(Vec<usize>),
}

/// This says what is wrong with a value, and where.
pub struct Wrong {
    pub span: Range<usize>,
    pub problem: String,
    /// The word that was probably meant.
    pub suggestion: Option<String>,
}

/// Wants a number without bounds, in `unit`.
pub const fn any(unit: &'static str) -> Number {
    Number { whole: false, least: Unbounded, most: Unbounded, unit }
}

/// Wants a number above 0, in `unit`.
pub const fn positive(unit: &'static str) -> Number {
    Number { least: Excluded(0.0), ..any(unit) }
}

/// Wants a number between two bounds, without a unit.
pub const fn between(least: Bound<f64>, most: Bound<f64>) -> Number {
    Number { least, most, ..any("") }
}

/// Wants a whole number from `least` on.
pub const fn whole(least: f64, most: Bound<f64>) -> Number {
    Number { whole: true, least: Included(least), most, unit: "" }
}

impl Kind {
    /// Says what is allowed, as a phrase.
    pub fn words(&self) -> String {
        match self {
            Kind::Table => "a table".into(),
            Kind::List => "a list of tables".into(),
            Kind::Text => "a text without control characters and U+FFFE, U+FFFF".into(),
            Kind::Name(_) => {
                "a name of at most 64 letters, digits and _, not that of another column or file"
                    .into()
            }
            Kind::Choice(words) => quoted(words),
            Kind::ChoiceOrTable(words) => {
                format!("{}, or a table with one of them for each component", quoted(words))
            }
            Kind::Flag => "true or false".into(),
            Kind::One(number) => number.words(),
            Kind::PerAxis(number) => format!("{}, one for each axis", number.words()),
        }
    }

    /// Reads a value as it is written, and checks it.
    ///
    /// Errors: [`Wrong`] with the place, down to the entry of a list.
    pub fn read(&self, value: &Spanned<DeValue>) -> Result<Value, Wrong> {
        let wrong = |problem: &str| Wrong::new(value, problem.to_string());
        match (self, value.get_ref()) {
            (Kind::Table | Kind::ChoiceOrTable(_), DeValue::Table(_)) => Ok(Value::Table),
            (Kind::List, DeValue::Array(list)) => {
                match list.iter().find(|entry| !entry.get_ref().is_table()) {
                    None => Ok(Value::List(list.len())),
                    Some(entry) => Err(Wrong::new(
                        entry,
                        "each entry must be a table with its keys".to_string(),
                    )),
                }
            }
            (Kind::Text, DeValue::String(text)) => match text.chars().find(|c| unprintable(*c)) {
                None => Ok(Value::Word(text.to_string())),
                Some(bad) => Err(wrong(&format!("it holds the character {bad:?}"))),
            },
            (Kind::Name(taken), DeValue::String(name)) => match unfit(name, taken) {
                None => Ok(Value::Word(name.to_string())),
                Some(problem) => Err(wrong(&format!("\"{name}\" {problem}"))),
            },
            (Kind::Choice(words) | Kind::ChoiceOrTable(words), DeValue::String(word)) => {
                if words.contains(&word.as_ref()) {
                    return Ok(Value::Word(word.to_string()));
                }
                let suggestion = nearest(word, words.iter().copied());
                Err(Wrong { suggestion, ..wrong(&format!("\"{word}\" is not known here")) })
            }
            (Kind::Flag, DeValue::Boolean(flag)) => Ok(Value::Flag(*flag)),
            (Kind::PerAxis(number), DeValue::Array(list)) => number.read(list),
            (Kind::One(number) | Kind::PerAxis(number), _) => {
                number.read(std::slice::from_ref(value))
            }
            (kind, _) => Err(wrong(&mismatch(value, kind.noun()))),
        }
    }

    /// Says what a value of another type should have been.
    fn noun(&self) -> &'static str {
        match self {
            Kind::Table => "a table with keys",
            Kind::List => "a list of tables",
            Kind::Text | Kind::Name(_) | Kind::Choice(_) => "a string",
            Kind::ChoiceOrTable(_) => "a string or a table of components",
            Kind::Flag => "true or false",
            Kind::One(number) | Kind::PerAxis(number) => number.noun(),
        }
    }
}

impl Number {
    fn noun(&self) -> &'static str {
        if self.whole { "a whole number" } else { "a number" }
    }

    fn words(&self) -> String {
        let least = match self.least {
            Included(a) => format!(" from {}", plain(a)),
            Excluded(a) => format!(" above {}", plain(a)),
            Unbounded => String::new(),
        };
        let most = match (self.most, self.least) {
            (Included(b), _) => format!(" to {}", plain(b)),
            (Excluded(b), Included(_)) => format!(" up to and below {}", plain(b)),
            (Excluded(b), _) => format!(" and below {}", plain(b)),
            (Unbounded, Included(_)) => " up".into(),
            (Unbounded, _) => String::new(),
        };
        let comma = if least.is_empty() { "" } else { "," };
        let unit = match self.unit {
            "" => String::new(),
            unit => format!("{comma} in {unit}"),
        };
        format!("{}{least}{most}{unit}", self.noun())
    }

    fn read(&self, list: &[Spanned<DeValue>]) -> Result<Value, Wrong> {
        if self.whole {
            return list
                .iter()
                .map(|entry| self.whole(entry))
                .collect::<Result<_, _>>()
                .map(Value::Wholes);
        }
        list.iter().map(|entry| self.real(entry)).collect::<Result<_, _>>().map(Value::Numbers)
    }

    fn real(&self, entry: &Spanned<DeValue>) -> Result<f64, Wrong> {
        let (text, x) = match entry.get_ref() {
            DeValue::Float(x) => (x.as_str(), x.as_str().parse().ok()),
            DeValue::Integer(n) => {
                (n.as_str(), i128::from_str_radix(n.as_str(), n.radix()).ok().map(|n| n as f64))
            }
            _ => return Err(Wrong::new(entry, mismatch(entry, self.noun()))),
        };
        let good = |x: &f64| x.is_finite() && (self.least, self.most).contains(x);
        x.filter(good).ok_or_else(|| out_of_range(entry, text))
    }

    fn whole(&self, entry: &Spanned<DeValue>) -> Result<usize, Wrong> {
        let DeValue::Integer(n) = entry.get_ref() else {
            return Err(Wrong::new(entry, mismatch(entry, self.noun())));
        };
        let good = |n: &usize| (self.least, self.most).contains(&(*n as f64));
        let whole = usize::from_str_radix(n.as_str(), n.radix()).ok();
        whole.filter(good).ok_or_else(|| out_of_range(entry, n.as_str()))
    }
}

impl Wrong {
    fn new(value: &Spanned<DeValue>, problem: String) -> Self {
        Wrong { span: value.span(), problem, suggestion: None }
    }
}

/// Says why no column and file of a run can have this name, if so.
fn unfit(name: &str, taken: &[&str]) -> Option<&'static str> {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if !((1..=64).contains(&name.len()) && name.chars().all(plain)) {
        return Some("cannot name a column and a file");
    }
    // Files on some systems do not tell upper from lower case.
    let name = name.to_ascii_lowercase();
    (taken.contains(&name.as_str()) || name.ends_with("_exact")).then_some("is taken")
}

fn out_of_range(entry: &Spanned<DeValue>, text: &str) -> Wrong {
    Wrong::new(entry, format!("{text} is out of range"))
}

fn mismatch(value: &Spanned<DeValue>, wanted: &str) -> String {
    let is = match value.get_ref() {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "an integer",
        DeValue::Float(_) => "a floating point number",
        DeValue::Boolean(_) => "a boolean",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    };
    format!("this is {is}, expected {wanted}")
}

/// Puts words side by side: `"a", "b" or "c"`.
fn quoted(words: &[&str]) -> String {
    let all: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match all.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

/// Writes a number as one would by hand: 0.5, 64, 1e-6, −1.
pub fn plain(x: f64) -> String {
    let short = x == 0.0 || (1e-3..1e5).contains(&x.abs());
    let text = if short { format!("{x}") } else { format!("{x:e}") };
    match text.strip_prefix('-') {
        Some(size) => format!("−{size}"),
        None => text,
    }
}

/// Finds the candidate that `word` was probably meant to be.
pub fn nearest<'a>(word: &str, candidates: impl Iterator<Item = &'a str>) -> Option<String> {
    // The first measure favours a common beginning, the second swapped letters.
    let likeness = |candidate: &str| {
        strsim::jaro_winkler(word, candidate)
            .max(strsim::normalized_damerau_levenshtein(word, candidate))
    };
    candidates
        .map(|candidate| (likeness(candidate), candidate))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness > 0.65)
        .map(|(_, candidate)| candidate.to_string())
}
