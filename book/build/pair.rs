//! How prose and the code that it explains share a page: beside each other where both fit, or one
//! under the other where one of the columns would stay empty.

use crate::listing::{Definitions, shown_lines};
use crate::read;
use anyhow::{Context, Result};

/// As many characters fit beside prose on a page of 1400 pixels; longer lines need a wider one.
const NARROW: usize = 82;
/// So many lines more in one of the columns leave a sixth of a page empty.
const UNEVEN: f64 = 18.0;

/// The layout of the pair that begins at the top of `text`: `narrow`, `wide` or `under`.
pub fn layout(definitions: &Definitions, text: &str) -> Result<&'static str> {
    let (pair, _) = text.split_once("{{#end}}").context("has no {{#end}}")?;
    let (prose, code) = pair.split_once("{{#beside}}").context("has no {{#beside}}")?;
    let (left, right) = (column(definitions, prose)?, column(definitions, code)?);
    Ok(match right.widest {
        _ if (left.lines - right.lines).abs() > UNEVEN => "under",
        0..=NARROW => "narrow",
        _ => "wide",
    })
}

#[derive(Default)]
struct Column {
    /// Its height in lines of a listing.
    lines: f64,
    /// Its longest line of code.
    widest: usize,
}

fn column(definitions: &Definitions, text: &str) -> Result<Column> {
    let mut column = Column::default();
    let mut add = |code: &str| {
        column.lines += shown_lines(code).0 as f64 + 3.0;
        let widest = code.lines().map(|line| line.chars().count()).max();
        column.widest = column.widest.max(widest.unwrap_or(0));
    };
    let mut prose = 0;
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("{{#") {
        let (directive, after) = after.split_once("}}").context("a directive without its end")?;
        prose += before.chars().count();
        rest = after;
        if let Some((file, anchor)) =
            directive.strip_prefix("code ").and_then(|place| place.split_once(':'))
        {
            add(&definitions.anchored(file, anchor)?.0);
        } else if let Some(file) = directive.strip_prefix("file ") {
            add(&read(file.trim())?);
        }
    }
    prose += rest.chars().count();
    // Some 55 characters fill a line of prose, which is as high as four thirds of a line of code.
    column.lines += prose as f64 / 55.0 * 4.0 / 3.0;
    Ok(column)
}
