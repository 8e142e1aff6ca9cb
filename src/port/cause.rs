//! Says what a difference usually comes from, and where the book tells more: patterns first,
//! then what a step of a scheme usually suffers from.

use super::entry::{Entry, SYMBOLS};
use super::patterns::{Both, Group, Traces, near};
use super::precision;
use super::scheme::{TracedScheme, of_step};

/// Gives the equation and its place in the book, by symbol and, in Newmark's scheme, by step.
pub fn source(entry: &Entry) -> (&'static str, &'static str) {
    match (entry.symbol, entry.step) {
        ("x_p" | "v_p", 0) => ("the start", "grid.html#particles"),
        ("x_p", 1) => ("(27), step 1", "algorithm.html#step-1"),
        ("v_p", 1) => ("(28), step 1", "algorithm.html#step-1"),
        ("p_I", 3) => ("step 3", "algorithm.html#step-3"),
        ("v_I", 4) => ("step 4", "algorithm.html#step-4"),
        ("p_I_advanced", 8) => ("step 8", "algorithm.html#step-8"),
        ("v_p", 9) => ("(29), step 9", "algorithm.html#step-9"),
        (symbol, _) => SYMBOLS
            .iter()
            .find(|known| known.0 == symbol)
            .map_or((symbol, ""), |(_, equation, link)| (equation, link)),
    }
}

/// Gives the likely cause of a difference at `entry`, with what is as small as `nothing`.
pub fn of(entry: &Entry, theirs: &[Entry], nothing: f64, traces: &Traces) -> Option<String> {
    let group = traces.group(entry, nothing);
    let scheme = TracedScheme::of(traces.all);
    let own = group.list.iter().find(|both| both.entry == entry)?.own;
    let usual = |own: f64| of_step(entry, own, scheme).map(str::to_string);
    let with_usual = |found: String| match usual(own) {
        Some(usual) => format!("{found}; {usual}"),
        None => found,
    };
    let added = group.increments();
    precision::of(theirs, &group.list)
        .or_else(|| group.of_another_time())
        .or_else(|| held(entry, own, &group))
        .or_else(|| group.of_nothing().or_else(|| group.of_a_sum()).map(with_usual))
        .or_else(|| group.of_swapped_axes())
        .or_else(|| {
            group.of_a_factor().filter(|f| near(*f, -1.0)).map(|_| turned(entry.symbol).into())
        })
        .or_else(|| group.of_another_order())
        .or_else(|| group.of_another_symbol())
        .or_else(|| scaled(entry, &group, scheme))
        .or_else(|| group.of_component_factors())
        .or_else(|| shifted(entry, &group))
        .or_else(|| sights(entry, &group))
        .or_else(|| precision::by_size(added.as_ref().map_or(&group.list[..], |added| &added.list)))
        .or_else(|| usual(own))
}

/// Finds a factor, in all that is there or in what this step has added, and says what it is
/// usually.
fn scaled(entry: &Entry, group: &Group, scheme: TracedScheme) -> Option<String> {
    if let Some(factor) = group.of_a_factor() {
        let usual = of_step(entry, factor * entry.value, scheme);
        let usual = usual.map_or(String::new(), |usual| format!("; {usual}"));
        return Some(format!("all have the factor {}{usual}", group.named(factor)));
    }
    let added = group.increments()?;
    let symbol = entry.symbol;
    if let Some(factor) = added.of_a_factor() {
        let usual = of_step(entry, factor * entry.value, scheme);
        let usual = usual.map_or(String::new(), |usual| format!("; {usual}"));
        return Some(format!(
            "what this step adds to {symbol} has the factor {}{usual}",
            added.named(factor)
        ));
    }
    let of_added = |words: String| format!("in what this step adds to {symbol} {words}");
    added.of_swapped_axes().or_else(|| added.of_component_factors()).map(of_added)
}

/// Says what a wrong sign is.
fn turned(symbol: &str) -> &'static str {
    match symbol {
        "f_int_I" | "f_I" => "the sign of the internal force: f_int = −Σ σ ∇N m/ρ",
        "grad_N_Ip" => "the sign of ∇N: it points to where N grows, towards the node",
        "lambda" => "the sign of λ: p_I ∝ exp(−β |x − x_I|² + λ·(x − x_I))",
        _ => "the sign",
    }
}

/// Finds one number that is added to all places: another origin.
fn shifted(entry: &Entry, group: &Group) -> Option<String> {
    let offset = group.of_an_offset()?;
    let place = ["x_p", "x_I"].contains(&entry.symbol);
    place.then(|| {
        format!(
            "all are shifted by {}: places are measured from the body's lower corner",
            group.named(offset)
        )
    })
}

/// Finds causes at nodes that are held: which of them, and in which symbol it shows.
fn held(entry: &Entry, own: f64, group: &Group) -> Option<String> {
    let of_node = ["v_I", "f_I", "p_I_advanced", "p_I", "f_int_I", "a_I"].contains(&entry.symbol);
    let off: Vec<&Both> = group.off().collect();
    let kept = |both: &&Both| both.right == 0.0 && both.own != 0.0;
    let lost = |both: &&Both| both.right != 0.0 && both.own == 0.0;
    let nothing = group.list.iter().all(|both| both.own == 0.0);
    if !of_node || nothing || off.is_empty() {
        return None;
    }
    // What is not fixed may be lost, but where only what particles bring is printed.
    let brings = ["p_I", "f_int_I"].contains(&entry.symbol);
    let fixed = group.traces.fixed();
    let fits = |both: &&Both| match fixed.contains(&(both.entry.index, both.entry.component)) {
        true => kept(both) || lost(both),
        false => lost(both) && !brings,
    };
    if !off.iter().all(fits) {
        return None;
    }
    let set =
        "set to 0 in p_I (step of v_I) and in f_I, and in the components that the side holds alone";
    Some(match (off.iter().any(kept), off.iter().any(lost)) {
        (true, true) => format!("other components or sides are fixed than should be: {set}"),
        (false, _) if brings => format!(
            "{} is what the particles bring; a fixed node is set to 0 after it",
            entry.symbol
        ),
        (false, _) => format!("too much is fixed: a node is {set}"),
        (true, _) if own == 0.0 || brings => return None,
        (true, _) => format!("a fixed node keeps its momentum or force: it is {set}"),
    })
}

/// Finds nodes that a particle of the port sees and that of the reference does not, or the other
/// way round; and sums of N and ∇N.
fn sights(entry: &Entry, group: &Group) -> Option<String> {
    entry.node?;
    if entry.k > 0
        && let Some(words) = on_an_edge(entry, group)
    {
        return Some(words);
    }
    let more = group.list.iter().any(|both| both.right == 0.0 && both.own != 0.0);
    let fewer = group.list.iter().any(|both| both.right != 0.0 && both.own == 0.0);
    let here = |e: &Entry| (e.index, e.component) == (entry.index, entry.component);
    let row = || group.list.iter().filter(|both| here(both.entry));
    let sum = |of: &dyn Fn(&Both) -> f64| row().map(of).sum::<f64>();
    let size = sum(&|both| both.right.abs());
    let whole = (sum(&|both| both.own) - sum(&|both| both.right)).abs() < 1e-9 * size;
    let same = !more && !fewer;
    if same && whole && precision::by_size(&group.list).is_some() {
        return None;
    }
    let which = match (more, fewer) {
        (true, true) => "particles see other nodes",
        (true, false) => "particles see more nodes",
        (false, true) => "particles see fewer nodes",
        (false, false) => "particles see the right nodes",
    };
    let sums = if whole { "and N still sums up to 1" } else { "and N no longer sums up to 1" };
    let max_ent = group.traces.all.iter().any(|e| e.symbol == "lambda");
    let why = match entry.symbol {
        "N_Ip" if same && whole && entry.k > 0 => {
            "N was right before: it is made anew wherever the particle stands after its move, with \
             OTM on the nodes where they stand now"
        }
        "N_Ip" if max_ent => of_max_ent(same, whole),
        "N_Ip" => of_other_bases(same, whole),
        _ if max_ent => {
            "the gradient: the factor 1/h of each axis, J with r ⊗ r taken off, λ solved on this \
             set of nodes"
        }
        _ => {
            "the gradient: the factor 1/h of each axis, and the product rule: slope of one axis, N \
             of the others"
        }
    };
    Some(format!("{which}, {sums}: {why}"))
}

/// Says what N of local max-ent suffers from: on the same nodes or others, whole if N sums up to
/// what it should.
fn of_max_ent(same: bool, whole: bool) -> &'static str {
    match (same, whole) {
        (false, true) => {
            "the cut-off: a box or a ball (basis.support), R = h √(−ln(cut-off)/γ), with γ = βh² \
             and the h of each axis"
        }
        (false, false) => {
            "nodes are cut off before λ is solved, and the set stays the same while it is"
        }
        (true, false) => "λ is not solved on this set: the sum over all nodes divides each (32)",
        (true, true) => "γ = βh² with the h of each axis, or λ is not that of (37) on this set",
    }
}

/// Says what N of the other bases suffers from.
fn of_other_bases(same: bool, whole: bool) -> &'static str {
    match (same, whole) {
        (false, _) => {
            "another cell, cells beyond the body that are missing or too many, or uGIMP's \
             half-length, half of the particle's share of the cell"
        }
        (true, false) => "N is a product over the axes of functions that sum up to 1",
        (true, true) => "N is that of the particle's place in its cell",
    }
}

/// Finds a particle that stands on a node, to round-off: which cell it belongs to is then chance.
fn on_an_edge(entry: &Entry, group: &Group) -> Option<String> {
    let of_particle = |e: &&Entry| (e.k, e.symbol, e.index) == (entry.k, "x_p", entry.index);
    let stands = |e: &Entry| {
        let cells = group.traces.given("h", e.component).map(|h| e.value / h);
        cells.is_some_and(|x| (x - x.round()).abs() < 1e-11 * x.abs().max(1.0))
    };
    let on_node = group.traces.all.iter().filter(of_particle).any(stands);
    on_node.then(|| {
        "the particle stands on a node to the last digits: it belongs to the cell above, ξ is \
         measured from the node's own coordinate; from here on both may be right"
            .into()
    })
}
