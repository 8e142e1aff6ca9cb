//! The two indexes: every equation of the paper, and every symbol.

use crate::listing::{Definitions, page_of};
use crate::read;
use anyhow::{Context, Result};
use std::collections::BTreeMap;

/// `data/equations.csv` as a table with links: equation → chapter → code → test.
pub fn equations(definitions: &Definitions, to_root: &str) -> Result<String> {
    let text = read("data/equations.csv")?;
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut out = String::from("| equation | says | code | test |\n|---|---|---|---|\n");
    for row in reader.records() {
        let row = row?;
        let [number, step, says, code, chapter, test] =
            std::array::from_fn(|at| row.get(at).unwrap_or("").to_string());
        let name = match step.as_str() {
            "" => format!("({number})"),
            step => format!("step {step}"),
        };
        let place = |link: &str, text: &str| format!("[{text}]({to_root}{link})");
        let name = match chapter.as_str() {
            "" => name,
            chapter => place(chapter, &name),
        };
        let code = linked(definitions, &code, to_root)
            .with_context(|| format!("data/equations.csv, equation {number}, step {step}"))?;
        let test = linked(definitions, &test, to_root)
            .with_context(|| format!("data/equations.csv, equation {number}, step {step}"))?;
        out.push_str(&format!("| {name} | {says} | {code} | {test} |\n"));
    }
    Ok(out)
}

/// `src/a.rs::item` or `tests/a.rs::name` as a link to the line; other text,
/// the reason why there is none, as it is.
fn linked(definitions: &Definitions, place: &str, to_root: &str) -> Result<String> {
    let Some((file, item)) = place.split_once("::") else { return Ok(place.to_string()) };
    let line = definitions
        .line_of(file, item)
        .with_context(|| format!("`{item}` is not defined in {file}"))?;
    Ok(format!("[`{item}`]({to_root}{}#L{line})", page_of(file)))
}

/// "(16)" → `weak-form.html#eq-16`, for every equation that stands in the book.
pub fn places() -> Result<BTreeMap<String, String>> {
    let text = read("data/equations.csv")?;
    let mut places = BTreeMap::new();
    for row in csv::Reader::from_reader(text.as_bytes()).records() {
        let row = row?;
        if !row[0].is_empty() && !row[4].is_empty() {
            places.insert(format!("({})", &row[0]), row[4].to_string());
        }
    }
    Ok(places)
}

/// `data/symbols.csv` as a table; "(14)" in its last column becomes a link as everywhere.
pub fn symbols() -> Result<String> {
    let text = read("data/symbols.csv")?;
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let mut out = String::from(
        "| paper | code | unit | shape | meaning | first in |\n|---|---|---|---|---|---|\n",
    );
    for row in reader.records() {
        let row = row?;
        let [paper, code, unit, shape, meaning, first] =
            std::array::from_fn(|at| row.get(at).unwrap_or("").to_string());
        out.push_str(&format!(
            "| ${paper}$ | `{code}` | {unit} | {shape} | {meaning} | {first} |\n"
        ));
    }
    Ok(out)
}
