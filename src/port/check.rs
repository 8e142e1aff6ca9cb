//! Holds a port's trace against a reference, and finds the first number that differs, in the
//! paper's order.

use super::cause;
use super::entry::{Address, COLUMNS, Entry, PAIRS, SYMBOLS, address, number};
use super::noise::Floors;
use super::patterns::Traces;
use super::rows::{self, Rows, brief};
use crate::scene::fault::Fault;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::io::Read;

/// A tolerance says how far two numbers may be apart: `relative` times the larger of them, plus
/// `absolute` times the largest value that the symbol has in its time step, or its
/// [floor](super::noise) where that is larger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    pub relative: f64,
    pub absolute: f64,
}

/// What is asked of a comparison.
#[derive(Clone, Debug)]
pub struct Asked {
    pub tolerance: Tolerance,
    /// Compare what both have, whatever that is.
    pub part: bool,
    /// Leave these symbols out.
    pub skip: Vec<String>,
    /// Begin with this time step.
    pub from: usize,
    /// Find the first difference of every symbol.
    pub all: bool,
}

impl Asked {
    /// Asks for everything, from the start.
    pub fn whole(tolerance: Tolerance, part: bool) -> Asked {
        Asked { tolerance, part, skip: Vec::new(), from: 0, all: false }
    }

    fn wants(&self, entry: &Entry) -> bool {
        entry.k >= self.from && !self.skip.iter().any(|symbol| symbol == entry.symbol)
    }
}

/// A divergence is the first number that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    pub reference: Entry,
    pub theirs: f64,
    /// The line in which it stands, if in any.
    pub line: Option<u64>,
    /// Numbers between the two.
    pub ulps: u64,
    /// Where the likely cause is known.
    pub cause: Option<String>,
}

/// A report says what a comparison found.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    pub compared: usize,
    pub divergence: Option<Divergence>,
    /// The first difference of each symbol that has one, if that was asked for.
    pub each: Vec<Divergence>,
    /// Symbols of the reference with the number of values that were not there.
    pub missing: BTreeMap<&'static str, usize>,
    /// Time steps of the reference of which nothing was there.
    pub missing_steps: BTreeSet<usize>,
    /// How many numbers the reference does not have; they are left out.
    pub extra: usize,
}

/// A row is all numbers of a particle or node that one step makes of a symbol.
type RowPlace = (usize, usize, &'static str, usize);

fn row(entry: &Entry) -> RowPlace {
    (entry.k, entry.step, entry.symbol, entry.index)
}

/// This is what a port has printed.
#[derive(Clone, Debug)]
pub struct Printed {
    name: String,
    pub entries: Vec<Entry>,
    /// The line of each entry; empty if they were never in a file.
    lines: Vec<u64>,
}

impl Printed {
    /// Gives the line of entry `n`, if it was ever in a file.
    fn line(&self, n: usize) -> Option<u64> {
        self.lines.get(n).copied()
    }

    fn alone(&self, line: Option<u64>, problem: String) -> Fault {
        let line = line.map_or(String::new(), |line| format!(", line {line}"));
        Fault::Alone { place: format!("{}{line}", self.name), problem }
    }
}

impl From<Vec<Entry>> for Printed {
    fn from(entries: Vec<Entry>) -> Self {
        Printed { name: "theirs".to_string(), entries, lines: Vec::new() }
    }
}

/// Reads a CSV file with the columns of a trace, in any order; other columns are not
/// read.
///
/// Errors: [`Fault::Read`]; [`Fault::Points`] with the line: a missing column, a value
/// that is not a number or not finite, a symbol that is not known, a node where none
/// belongs or none where one does, a line that stands twice.
pub fn read(name: &str, input: impl Read) -> Result<Printed, Fault> {
    let text = rows::text(name, input)?;
    let wanted = format!("the columns {}", COLUMNS.join(","));
    let mut rows = Rows::of(name, &text, wanted)?;
    let mut at = [0; COLUMNS.len()];
    for (at, column) in at.iter_mut().zip(COLUMNS) {
        *at = rows
            .header
            .iter()
            .position(|found| found == column)
            .ok_or_else(|| rows.no_header(format!("there is no column `{column}`")))?;
    }
    let (mut entries, mut lines, mut seen) = (Vec::new(), Vec::new(), HashMap::new());
    while let Some((line, record)) = rows.next_row()? {
        let fault = |problem: String, allowed: String| rows.fault(line, problem, allowed);
        let entry = entry(&at.map(|n| record.get(n).unwrap_or("")), &fault)?;
        if let Some(before) = seen.insert(address(&entry), line) {
            let problem = format!("the same number stands in line {before} already");
            return Err(fault(problem, "each number once".into()));
        }
        entries.push(entry);
        lines.push(line);
    }
    Ok(Printed { name: name.to_string(), entries, lines })
}

/// Reads the entry of one line, whose cells stand in the order of [`COLUMNS`]; `fault` makes the
/// fault of this line from what is wrong and what is allowed.
fn entry(
    cells: &[&str; COLUMNS.len()],
    fault: &dyn Fn(String, String) -> Fault,
) -> Result<Entry, Fault> {
    let [k, step, symbol, index, node, component, value] = *cells;
    let whole = |column: &str, text: &str| {
        text.parse::<usize>().map_err(|_| {
            let problem = format!("`{}` is not a value of {column}", brief(text));
            fault(problem, "a whole number from 0 up".into())
        })
    };
    let names = || SYMBOLS.iter().map(|symbol| symbol.0);
    let symbol = names().find(|name| *name == symbol).ok_or_else(|| {
        let problem = format!("`{}` is not a symbol", brief(symbol));
        fault(problem, names().collect::<Vec<_>>().join(", "))
    })?;
    let value = number(value).filter(|x| x.is_finite()).ok_or_else(|| {
        let problem = format!("`{}` is not a value of {symbol}", brief(value));
        fault(problem, "a finite number, decimal or hexadecimal".into())
    })?;
    let node = match (PAIRS.contains(&symbol), node) {
        (true, _) => Some(whole("node", node)?),
        (false, "") => None,
        (false, node) => {
            let problem = format!("{symbol} is not a pair, and has the node `{}`", brief(node));
            return Err(fault(problem, "an empty cell for the node".into()));
        }
    };
    let (k, step) = (whole("k", k)?, whole("step", step)?);
    let (index, component) = (whole("index", index)?, whole("component", component)?);
    Ok(Entry { k, step, symbol, index, node, component, value })
}

/// Counts the numbers between a and b, as steps of the last bit.
pub fn ulps(a: f64, b: f64) -> u64 {
    // Ordered like the numbers: negative ones mirrored.
    let order = |x: f64| {
        let bits = (x + 0.0).to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    order(a).abs_diff(order(b))
}

/// Compares all of two traces: [`compare_as`] with [`Asked::whole`].
///
/// Errors: those of [`compare_as`].
pub fn compare(
    reference: &[Entry],
    theirs: &Printed,
    tolerance: Tolerance,
    part: bool,
) -> Result<Report, Fault> {
    compare_as(reference, theirs, &Asked::whole(tolerance, part))
}

// ANCHOR: compare
/// Compares what both have, in the paper's order, up to the first difference.
///
/// A port may leave out time steps, or symbols of a time step. Of a symbol that it
/// prints in a time step it prints all numbers, and no others; nodes that a particle
/// does not see may be there with 0, or not. With [`Asked::part`] only what both have is
/// compared.
///
/// Errors, where nothing differs: [`Fault::Alone`] for a number that only one of them
/// has, or if they have nothing in common.
pub fn compare_as(reference: &[Entry], theirs: &Printed, asked: &Asked) -> Result<Report, Fault> {
    let (given, own) = (by_place(reference), Own::new(theirs));
    let (all, mut extra) = with_unseen_nodes(reference, &given, theirs);
    extra.retain(|n| asked.wants(&theirs.entries[*n]));
    let wanted: Vec<&Entry> = all.iter().filter(|entry| asked.wants(entry)).collect();
    let mut report = Report {
        compared: 0,
        divergence: None,
        each: Vec::new(),
        missing: BTreeMap::new(),
        missing_steps: wanted.iter().map(|entry| entry.k).collect(),
        extra: extra.len(),
    };
    let floors = Floors::of(reference, &theirs.entries);
    let (found, gap) = report.walk(&wanted, &own, &floors, asked.tolerance);
    let traces = Traces { reference: &given, theirs: &own.values, all: &all };
    let many = if asked.all { found.len() } else { 1 };
    report.each = found
        .into_iter()
        .take(many)
        .map(|(entry, value)| Divergence {
            reference: entry.clone(),
            theirs: value,
            line: own.line(entry),
            ulps: ulps(entry.value, value),
            cause: {
                let nothing = asked.tolerance.absolute * floors.scale(entry);
                cause::of(entry, &theirs.entries, nothing, &traces)
            },
        })
        .collect();
    report.divergence = report.each.first().cloned();
    if report.divergence.is_some() {
        return Ok(report);
    }
    match alone(theirs, extra.first().copied(), gap).filter(|_| !asked.part) {
        Some(fault) => Err(fault),
        None if report.compared == 0 => {
            Err(theirs.alone(None, "it has nothing that the reference has".into()))
        }
        None => Ok(report),
    }
}
// ANCHOR_END: compare

/// Names a number that only one of two traces has: entry `extra` of `theirs`, or
/// the reference's `gap`.
fn alone(theirs: &Printed, extra: Option<usize>, gap: Option<&Entry>) -> Option<Fault> {
    let too_much = extra.map(|n| {
        let entry = spelled(&theirs.entries[n]);
        theirs.alone(theirs.line(n), format!("there is {entry}, which the reference has not"))
    });
    too_much.or_else(|| {
        let problem = format!("there is no {}, but others of its kind", spelled(gap?));
        Some(theirs.alone(None, problem))
    })
}

fn by_place(entries: &[Entry]) -> HashMap<Address, f64> {
    entries.iter().map(|entry| (address(entry), entry.value)).collect()
}

/// This looks up what a port has printed.
struct Own<'a> {
    values: HashMap<Address, f64>,
    lines: HashMap<Address, u64>,
    rows: HashSet<RowPlace>,
    symbols: HashSet<(usize, usize, &'a str)>,
}

impl<'a> Own<'a> {
    fn new(theirs: &'a Printed) -> Self {
        let places = || theirs.entries.iter().map(address);
        Own {
            values: by_place(&theirs.entries),
            lines: places().zip(theirs.lines.iter().copied()).collect(),
            rows: theirs.entries.iter().map(row).collect(),
            symbols: theirs.entries.iter().map(|e| (e.k, e.step, e.symbol)).collect(),
        }
    }

    /// Gives its value; 0 for a node that is not among those of its particle.
    fn value(&self, entry: &Entry) -> Option<f64> {
        let unseen = || (entry.node.is_some() && self.rows.contains(&row(entry))).then_some(0.0);
        self.values.get(&address(entry)).copied().or_else(unseen)
    }

    fn line(&self, entry: &Entry) -> Option<u64> {
        self.lines.get(&address(entry)).copied()
    }

    fn has_symbol(&self, entry: &Entry) -> bool {
        self.symbols.contains(&(entry.k, entry.step, entry.symbol))
    }
}

/// Puts the reference into the paper's order, with a 0 for every node that only `theirs` has
/// at a particle; and which entries else only `theirs` has.
fn with_unseen_nodes(
    reference: &[Entry],
    given: &HashMap<Address, f64>,
    theirs: &Printed,
) -> (Vec<Entry>, Vec<usize>) {
    let rows: HashSet<(RowPlace, usize)> =
        reference.iter().map(|e| (row(e), e.component)).collect();
    let (mut all, mut extra) = (reference.to_vec(), Vec::new());
    for (n, entry) in theirs.entries.iter().enumerate() {
        if given.contains_key(&address(entry)) {
            continue;
        }
        if entry.node.is_some() && rows.contains(&(row(entry), entry.component)) {
            all.push(Entry { value: 0.0, ..entry.clone() });
        } else {
            extra.push(n);
        }
    }
    let order = |symbol: &str| SYMBOLS.iter().position(|known| known.0 == symbol);
    all.sort_by_key(|e| (e.k, e.step, order(e.symbol), e.index, e.node, e.component));
    (all, extra)
}

/// Says in words where an entry stands.
fn spelled(entry: &Entry) -> String {
    let Entry { k, step, symbol, index, node, component, .. } = entry;
    let node = node.map_or(String::new(), |node| format!(", node {node}"));
    format!("{symbol} of k = {k}, step {step}, index {index}{node}, component {component}")
}

impl Report {
    /// Goes through the entries `all` of the reference and counts what is there; returns the
    /// first entry of each symbol that differs, with the port's value, and the first entry that
    /// is missing among others of its symbol.
    fn walk<'a>(
        &mut self,
        all: &[&'a Entry],
        own: &Own,
        floors: &Floors,
        tolerance: Tolerance,
    ) -> (Vec<(&'a Entry, f64)>, Option<&'a Entry>) {
        let (mut found, mut gap): (Vec<(&Entry, f64)>, _) = (Vec::new(), None);
        for entry in all.iter().copied() {
            let Some(value) = own.value(entry) else {
                gap = gap.or(Some(entry).filter(|_| own.has_symbol(entry)));
                *self.missing.entry(entry.symbol).or_insert(0) += 1;
                continue;
            };
            self.compared += 1;
            self.missing_steps.remove(&entry.k);
            let size = entry.value.abs().max(value.abs());
            let room = tolerance.relative * size + tolerance.absolute * floors.scale(entry);
            let apart = (value - entry.value).abs() > room;
            if apart && !found.iter().any(|(first, _)| first.symbol == entry.symbol) {
                found.push((entry, value));
            }
        }
        (found, gap)
    }
}
