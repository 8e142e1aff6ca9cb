//! Says what a difference usually comes from, and where the book tells more.

use super::entry::{Address, Entry, SYMBOLS, address};
use std::collections::HashMap;

/// Gives the equation and its place in the book, by symbol and, in Newmark's scheme, by step.
pub fn source(entry: &Entry) -> (&'static str, &'static str) {
    match (entry.symbol, entry.step) {
        ("x_p" | "v_p", 0) => ("the start", "dyka-bar.html"),
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

/// Two traces are looked up side by side.
pub struct Traces<'a> {
    pub reference: &'a HashMap<Address, f64>,
    pub theirs: &'a HashMap<Address, f64>,
}

impl Traces<'_> {
    /// Gives the reference's value at the place of `entry`, for another symbol, step or index.
    fn at(&self, entry: &Entry) -> Option<f64> {
        self.reference.get(&address(entry)).copied()
    }

    fn theirs_at(&self, entry: &Entry) -> Option<f64> {
        self.theirs.get(&address(entry)).copied()
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * a.abs().max(b.abs())
}

/// Gives the likely cause of a difference at `entry`, where the port has `theirs`.
pub fn of(entry: &Entry, theirs: f64, reference: &[Entry], traces: Traces) -> Option<&'static str> {
    let by_value = if entry.step == 0 { None } else { value_tells(entry, theirs, reference) };
    by_value.or_else(|| numbering(entry, theirs, &traces)).or_else(|| match entry.node {
        Some(_) => pair(entry, reference),
        None => symbol_tells(entry, theirs).or_else(|| {
            let twice = entry.value != 0.0
                && (near(theirs, 2.0 * entry.value) || near(theirs, 0.5 * entry.value));
            twice.then_some("a factor of two")
        }),
    })
}

/// Finds causes that show in the two values: a fixed node, a sign.
fn value_tells(entry: &Entry, theirs: f64, reference: &[Entry]) -> Option<&'static str> {
    let value = entry.value;
    let kept = value == 0.0 && ["v_I", "f_I", "p_I_advanced"].contains(&entry.symbol);
    let lost = theirs == 0.0 && ["p_I", "f_int_I"].contains(&entry.symbol);
    if (kept || lost) && is_fixed(entry, reference) {
        return Some(match entry.symbol {
            "p_I" => "p_I is what the particles bring; a fixed node is set to 0 after it",
            "f_int_I" => "f_int_I is what the particles bring; a fixed node is set to 0 in f_I",
            _ => "a fixed node keeps its momentum or force: set it to 0 (step 4, step 7)",
        });
    }
    if value == 0.0 || !near(theirs, -value) {
        return None;
    }
    Some(match entry.symbol {
        "f_int_I" | "f_I" => "the sign of the internal force: f_int = −Σ σ ∇N m/ρ",
        "grad_N_Ip" => "the sign of ∇N: it points to where N grows, towards the node",
        "lambda" => "the sign of λ: p_I ∝ exp(−β |x − x_I|² + λ·(x − x_I))",
        _ => "the sign",
    })
}

/// Tells whether a node is fixed: it keeps nothing of what particles bring.
fn is_fixed(entry: &Entry, reference: &[Entry]) -> bool {
    let of_node = |symbol: &'static str| {
        let here = (entry.index, entry.component);
        reference.iter().filter(move |e| e.symbol == symbol && (e.index, e.component) == here)
    };
    let some = |symbol| of_node(symbol).any(|e| e.value != 0.0);
    (some("p_I") && !some("v_I")) || (some("f_int_I") && !some("f_I"))
}

/// Finds particles or nodes that are counted from 1, or nodes from another end.
fn numbering(entry: &Entry, theirs: f64, traces: &Traces) -> Option<&'static str> {
    let Some(node) = entry.node else {
        // This value and the next are their neighbours' in the reference.
        let moved = |by: usize, towards: isize| {
            let index = entry.index.checked_add(by)?;
            let here = Entry { index, ..entry.clone() };
            let there = Entry { index: index.checked_add_signed(towards)?, ..entry.clone() };
            let (own, right) = (traces.theirs_at(&here)?, traces.at(&here)?);
            Some(near(own, traces.at(&there)?) && !near(own, right))
        };
        let all_moved = |towards| (0..2).all(|by| moved(by, towards) == Some(true));
        return (all_moved(1) || all_moved(-1)).then_some("the numbering is off by one");
    };
    let beside = [node.checked_sub(1), node.checked_add(1)].into_iter().flatten();
    let moved = |node: usize| {
        let there = traces.theirs_at(&Entry { node: Some(node), ..entry.clone() });
        there.is_some_and(|x| near(x, entry.value) && !near(x, theirs))
    };
    beside.into_iter().any(moved).then_some("nodes are numbered off by one")
}

/// Finds causes of shape functions and gradients.
fn pair(entry: &Entry, reference: &[Entry]) -> Option<&'static str> {
    let max_ent = reference.iter().any(|e| e.symbol == "lambda");
    Some(match (entry.symbol, max_ent) {
        _ if entry.value == 0.0 && max_ent => {
            "the particle does not see that node: numbering off by one, cut-off, or γ = βh²"
        }
        _ if entry.value == 0.0 => {
            "the particle does not see that node: another cell, or numbering"
        }
        ("grad_N_Ip", true) => {
            "the gradient: is the factor 1/h there, and is λ solved on this set of nodes?"
        }
        ("grad_N_Ip", false) => "the gradient: is the factor 1/h there?",
        (_, true) => "the set of nodes (cut-off), γ = βh², or λ not converged on this set",
        (_, false) => "N is made anew wherever the particle stands after its move",
    })
}

/// Says what a symbol usually suffers from: one table, which is why this function is long.
fn symbol_tells(entry: &Entry, theirs: f64) -> Option<&'static str> {
    Some(match (entry.symbol, entry.step) {
        ("dt", _) => "Δt = T/n, n the next whole number from T c/(CFL h) up",
        ("x_p", 0) => {
            "the start: h = L/cells, each particle in the middle of its equal share of a cell, \
             numbers of 64 bits"
        }
        ("v_p", 0) => "the start: the velocity of the region that the particle stands in",
        ("x_p", 1) => {
            "(27) moves with the nodes, not with v_p: Σ N (Δt p_I/m_I + ½ Δt² f_I/m_I), p_I as \
             step 8 has left it, N of the step before"
        }
        ("v_p", 1) => "(28) is half a step, ½ Δt Σ N f_I/m_I, with f_I and N of the step before",
        ("v_p", 9) => "(29) is half a step, ½ Δt Σ N f_I/m_I, with the new f_I and the new N",
        ("v_p" | "x_p", _) => "shares of nodal values: which of them, and N of which place?",
        ("rms", _) => "(39) as printed has no square: √(1/N Σ (φ − φ̂)²)",
        ("v" | "sigma" | "u", _) => {
            "the ends: a fixed one turns the invariant's sign, a free one does not, and both give \
             back the whole wave"
        }
        ("lambda", _) => "λ: γ = βh² (not β/h²), solved on the set that the cut-off leaves",
        ("m_I", _) => "the mass of a particle is ρ times its share of the cell",
        ("p_I", _) => "p_I = Σ m v N with the velocity that the particles have by now",
        ("f_int_I", _) => {
            "σ and ρ are of another moment (time.stress_update), or the volume is not m/ρ"
        }
        ("v_I", _) => "v_I = p_I/m_I; or is one of the two with the consistent mass matrix?",
        ("rho_p", _) => {
            "the density is updated with the strain increment of this step: ρ/(1 + tr Δε)"
        }
        ("d_eps_p", _) if entry.k == 0 => "at k = 0 Δt is 0, and so is every increment",
        ("d_eps_p", _) if entry.value == 0.0 && theirs != 0.0 => {
            "all nodes move alike: one without mass has no velocity, and moves with the others (16)"
        }
        ("d_eps_p", _) => {
            "the nodal velocity that the strain is taken from: before or after the momentum is \
             advanced, or mapped anew (time.stress_update)"
        }
        ("sigma_p", _) => "σ grows by Δσ = λ tr(Δε) 1 + 2μ Δε, with Δε of this step",
        ("p_I_advanced", 8) => "step 8 adds γ f Δt; as printed, f Δt (time.reading)",
        _ => return None,
    })
}
