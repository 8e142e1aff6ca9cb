//! A port's trace against a reference: the first number that differs, in the paper's
//! order.
#![allow(non_snake_case)]

use crate::fault::Fault;
use crate::trace::{COLUMNS, Entry, SYMBOLS, number};
use std::collections::{BTreeMap, HashMap};
use std::io::Read;

/// How far two numbers may be apart: `relative` of the larger, or `absolute` of the
/// largest value that the symbol has in its time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    pub relative: f64,
    pub absolute: f64,
}

/// The first number that differs.
#[derive(Clone, Debug, PartialEq)]
pub struct Divergence {
    pub reference: Entry,
    pub theirs: f64,
    /// Numbers between the two.
    pub ulps: u64,
    /// Where the likely cause is known.
    pub cause: Option<String>,
}

/// What a comparison found.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    pub compared: usize,
    pub divergence: Option<Divergence>,
    /// Symbols of the reference with the number of values that were not there.
    pub missing: BTreeMap<String, usize>,
}

type Key = (usize, usize, String, usize, Option<usize>, usize);

fn key(entry: &Entry, symbol: &str) -> Key {
    let Entry { k, step, index, node, component, .. } = *entry;
    (k, step, symbol.to_string(), index, node, component)
}

/// Entries of a CSV file with the columns of a trace, in any order of columns.
///
/// Errors: [`Fault::Points`] with the line: a missing column, a value that is not a
/// number or not finite, a symbol that is not known, a line that stands twice.
pub fn read(name: &str, input: impl Read) -> Result<Vec<Entry>, Fault> {
    let fault = |line: u64, problem: String, allowed: String| Fault::Points {
        path: name.to_string(),
        line,
        problem,
        allowed,
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(input);
    let wanted = || format!("the columns {}", COLUMNS.join(","));
    let header = reader.headers().map_err(|e| fault(1, e.to_string(), wanted()))?.clone();
    let mut at = [0; COLUMNS.len()];
    for (place, column) in at.iter_mut().zip(COLUMNS) {
        *place = header
            .iter()
            .position(|found| found == column)
            .ok_or_else(|| fault(1, format!("there is no column `{column}`"), wanted()))?;
    }
    let (mut entries, mut seen) = (Vec::new(), HashMap::new());
    for record in reader.into_records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(0, csv::Position::line);
            fault(line, error.to_string(), wanted())
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |n: usize| record.get(at[n]).unwrap_or("");
        let whole = |n: usize| {
            cell(n).parse::<usize>().map_err(|_| {
                let problem = format!("`{}` is not a value of {}", cell(n), COLUMNS[n]);
                fault(line, problem, "a whole number from 0 up".into())
            })
        };
        let symbol = SYMBOLS.iter().map(|symbol| symbol.0).find(|name| *name == cell(2));
        let symbol = symbol.ok_or_else(|| {
            let names: Vec<&str> = SYMBOLS.iter().map(|symbol| symbol.0).collect();
            fault(line, format!("`{}` is not a symbol", cell(2)), names.join(", "))
        })?;
        let value = number(cell(6)).filter(|x| x.is_finite()).ok_or_else(|| {
            let problem = format!("`{}` is not a value of {symbol}", cell(6));
            fault(line, problem, "a finite number, decimal or hexadecimal".into())
        })?;
        let node = if cell(4).is_empty() { None } else { Some(whole(4)?) };
        let (k, step, index, component) = (whole(0)?, whole(1)?, whole(3)?, whole(5)?);
        let entry = Entry { k, step, symbol, index, node, component, value };
        if let Some(before) = seen.insert(key(&entry, symbol), line) {
            let problem = format!("the same number stands in line {before} already");
            return Err(fault(line, problem, "each number once".into()));
        }
        entries.push(entry);
    }
    Ok(entries)
}

/// The entries of `theirs` that `reference` has, too: for a reference that is a part
/// of what a port prints.
pub fn common(reference: &[Entry], theirs: Vec<Entry>) -> Vec<Entry> {
    let known: std::collections::HashSet<Key> =
        reference.iter().map(|entry| key(entry, entry.symbol)).collect();
    theirs.into_iter().filter(|entry| known.contains(&key(entry, entry.symbol))).collect()
}

/// Numbers between a and b, counted as steps of the last bit.
pub fn ulps(a: f64, b: f64) -> u64 {
    // Ordered like the numbers: negative ones mirrored.
    let order = |x: f64| {
        let bits = (x + 0.0).to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    order(a).abs_diff(order(b))
}

// ANCHOR: compare
/// Compares what both have, in the order of the reference, up to the first
/// difference.
///
/// Errors: [`Fault::Argument`] for entries that the reference does not have, or if
/// they have nothing in common.
pub fn compare(
    reference: &[Entry],
    theirs: &[Entry],
    tolerance: Tolerance,
) -> Result<Report, Fault> {
    let known: HashMap<Key, f64> =
        reference.iter().map(|entry| (key(entry, entry.symbol), entry.value)).collect();
    let mut scales: HashMap<(usize, &str), f64> = HashMap::new();
    for entry in reference.iter() {
        let scale = scales.entry((entry.k, entry.symbol)).or_insert(0.0);
        *scale = scale.max(entry.value.abs());
    }
    let mut own: HashMap<Key, f64> = HashMap::new();
    let mut reference = reference.to_vec();
    for entry in theirs {
        let key = key(entry, entry.symbol);
        if !known.contains_key(&key) {
            let place = |r: &Entry| (r.k, r.step, r.symbol) == (entry.k, entry.step, entry.symbol);
            match reference.iter().position(place).filter(|_| entry.node.is_some()) {
                // A node that the particle does not see: its function is 0 there.
                Some(at) => reference.insert(at, Entry { value: 0.0, ..entry.clone() }),
                None => {
                    return Err(Fault::Argument {
                        argument: "theirs",
                        problem: format!(
                            "k = {}, step {}: {} has index {}{}, component {}, which the reference has not",
                            entry.k,
                            entry.step,
                            entry.symbol,
                            entry.index,
                            entry.node.map_or(String::new(), |node| format!(", node {node}")),
                            entry.component
                        ),
                        allowed: "a part of what the reference has",
                    });
                }
            }
        }
        own.insert(key, entry.value);
    }
    let mut report = Report { compared: 0, divergence: None, missing: BTreeMap::new() };
    for entry in &reference {
        let Some(&value) = own.get(&key(entry, entry.symbol)) else {
            *report.missing.entry(entry.symbol.to_string()).or_insert(0) += 1;
            continue;
        };
        report.compared += 1;
        if report.divergence.is_some() {
            continue;
        }
        let scale = scales.get(&(entry.k, entry.symbol)).copied().unwrap_or(0.0);
        let size = entry.value.abs().max(value.abs());
        let room = tolerance.relative * size + tolerance.absolute * scale;
        if (value - entry.value).abs() > room {
            let cause = cause(entry, value, &reference, &own);
            let ulps = ulps(entry.value, value);
            let reference = entry.clone();
            report.divergence = Some(Divergence { reference, theirs: value, ulps, cause });
        }
    }
    match report.compared {
        0 => Err(Fault::Argument {
            argument: "theirs",
            problem: "it has nothing that the reference has".into(),
            allowed: "a part of what the reference has",
        }),
        _ => Ok(report),
    }
}
// ANCHOR_END: compare

/// What such a difference usually comes from.
fn cause(
    entry: &Entry,
    theirs: f64,
    reference: &[Entry],
    own: &HashMap<Key, f64>,
) -> Option<String> {
    let value = entry.value;
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * a.abs().max(b.abs());
    let of = |symbol: &str, index: usize| {
        let same = |e: &&Entry| {
            (e.k, e.symbol, e.index, e.component) == (entry.k, symbol, index, entry.component)
        };
        reference.iter().find(same).map(|e| e.value)
    };
    let say = |text: &str| Some(text.to_string());
    if value == 0.0 && ["p_I", "v_I", "f_I", "p_I_advanced"].contains(&entry.symbol) {
        return say("a fixed node keeps its momentum or force: set it to 0 (step 4, step 7)");
    }
    if value != 0.0 && near(theirs, -value) {
        return match entry.symbol {
            "f_int_I" | "f_I" => say("the sign of the internal force: f_int = −Σ σ ∇N m/ρ"),
            _ => say("the sign"),
        };
    }
    // Shifted by one: this value and the next are their neighbours' in the reference.
    let theirs_at = |index: usize| {
        let symbol = entry.symbol.to_string();
        own.get(&(entry.k, entry.step, symbol, index, entry.node, entry.component)).copied()
    };
    let shifted = |by: isize| {
        [entry.index, entry.index + 1].into_iter().all(|index| {
            let here = (theirs_at(index), of(entry.symbol, index));
            let there = of(entry.symbol, index.wrapping_add_signed(by));
            match (here, there) {
                ((Some(theirs), Some(here)), Some(there)) => {
                    near(theirs, there) && !near(theirs, here)
                }
                _ => false,
            }
        })
    };
    if entry.node.is_none() && (shifted(1) || shifted(-1)) {
        return say("the numbering is off by one");
    }
    if entry.node.is_some() && value == 0.0 {
        return say(
            "the particle does not see that node: numbering off by one, cut-off, or γ = βh²",
        );
    }
    if let Some(node) = entry.node {
        let with = |node: usize| {
            own.get(&(
                entry.k,
                entry.step,
                entry.symbol.to_string(),
                entry.index,
                Some(node),
                entry.component,
            ))
        };
        let shifted = [node.wrapping_sub(1), node + 1];
        if shifted.iter().any(|n| with(*n).is_some_and(|x| near(*x, value) && !near(*x, theirs))) {
            return say("nodes are numbered off by one");
        }
        if entry.symbol == "grad_N_Ip" {
            return say(
                "the gradient: is the factor 1/h there, and is λ solved on this set of nodes?",
            );
        }
        return say("the set of nodes (cut-off), γ = βh², or λ not converged on this set");
    }
    match entry.symbol {
        "rms" => say("(39) as printed has no square: √(1/N Σ (φ − φ̂)²)"),
        "v" | "sigma" | "u" => say(
            "the ends: a fixed one turns the invariant's sign, a free one does not, and both give \
             back the whole wave",
        ),
        "lambda" => say("λ: γ = βh² (not β/h²), solved on the set that the cut-off leaves"),
        "m_I" => say("the mass of a particle is ρ times its share of the cell"),
        "f_int_I" => {
            say("σ and ρ are of another moment (time.stress_update), or the volume is not m/ρ")
        }
        "v_I" => say("v_I = p_I/m_I; or is one of the two with the consistent mass matrix?"),
        "rho_p" => {
            say("the density is updated with the strain increment of this step: ρ/(1 + tr Δε)")
        }
        "d_eps_p" => say(
            "the nodal velocity that the strain is taken from: before or after the momentum is \
             advanced, or mapped anew (time.stress_update)",
        ),
        "sigma_p" => say("Δσ = λ tr(Δε) 1 + 2μ Δε with Δε of this step; in 2D plane strain"),
        "p_I_advanced" if entry.step == 8 => {
            say("step 8 adds γ f Δt; as printed, f Δt (time.reading)")
        }
        "v_p" | "x_p" => {
            say("old and new N, or half and whole steps, mixed: the corrector uses all at k+1")
        }
        _ if value != 0.0 && (near(theirs, 2.0 * value) || near(theirs, 0.5 * value)) => {
            say("a factor of two")
        }
        _ => None,
    }
}

impl Report {
    /// The report for a reader; `reference` and `theirs` are the files.
    pub fn text(&self) -> String {
        let mut text = match &self.divergence {
            None => format!("{} numbers agree\n", self.compared),
            Some(Divergence { reference: r, theirs, ulps, cause }) => {
                let (_, equation, link) =
                    SYMBOLS.iter().find(|s| s.0 == r.symbol).copied().unwrap_or((r.symbol, "", ""));
                let node = r.node.map_or(String::new(), |node| format!(", node {node}"));
                let relative = (theirs - r.value).abs() / r.value.abs().max(theirs.abs());
                let cause = cause.as_ref().map_or(String::new(), |c| format!("  likely: {c}\n"));
                format!(
                    "first difference: k = {}, step {}, {} of {equation}, index {}{node}, \
                     component {}\n  reference {:?}\n  theirs    {:?}\n  relative {relative:.1e}, \
                     {ulps} numbers apart\n{cause}  book: {link}\n",
                    r.k, r.step, r.symbol, r.index, r.component, r.value, theirs
                )
            }
        };
        if !self.missing.is_empty() {
            let list: Vec<String> =
                self.missing.iter().map(|(symbol, n)| format!("{symbol} ({n})")).collect();
            text += &format!("not compared, since they are not there: {}\n", list.join(", "));
        }
        text
    }
}
